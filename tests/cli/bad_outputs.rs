//! Outputs that cannot be, or must not be, written.

use super::rig::{Folder, Picture};

const ATOM: &str = "1\n\nC 0 0 0\n";

#[test]
fn outputs_without_a_place_are_refused_before_any_work() {
    let folder = Folder::new("places");
    folder.write("me.xyz", ATOM);
    folder.draw("c60 -o .").refused(2, "-o");
    folder.run("render c60 -o .").refused(1, ".: is a folder; name a file in it");
    folder.run("render c60 -o ..").refused(1, "..: is a folder");
    folder.run("render c60 -o new/").refused(1, "new/: is a folder");
    folder.run("render c60 -o no/a.png").refused(1, "no/a.png: the folder no does not exist; make it first");
    folder.run("render c60 -o me.xyz/a.png").refused(1, "the folder me.xyz is a file, not a folder");
    folder.run("render c60 --aov depth=.").refused(1, ".: is a folder");
    assert_eq!(folder.names(), ["me.xyz"]);
}

#[test]
fn a_name_of_another_format_is_refused() {
    let folder = Folder::new("formats");
    folder.run("render c60 -o a.jpg").refused(2, "a.jpg: pictures are written as PNG, not as JPG; write to a.png");
    folder.run("render c60 -o a.EXR").refused(2, "a.EXR: pictures are written as PNG, not as EXR");
    folder
        .run("render c60 --aov depth=d.png")
        .refused(2, "d.png: AOVs are written as OpenEXR, not as PNG; write to d.exr");
    folder.run("render c60 -o t.mp4 --turntable 3").refused(2, "t.mp4: pictures are written as PNG, not as MP4");
    assert!(folder.names().is_empty());
}

#[test]
fn inputs_are_never_overwritten() {
    let folder = Folder::new("inputs");
    folder.write("me.xyz", ATOM).write("base.json", "{}").write("me.json", "{\"extends\":\"base.json\"}");
    folder.run("render me.xyz -o me.xyz").refused(2, "me.xyz: is the scene itself; write to another file");
    folder.run("render c60 -s me.json -o ./me.json").refused(2, "./me.json: is the style itself");
    folder.run("render c60 -s me.json --aov id=base.json").refused(2, "base.json: is the style's base itself");
    folder.write("index.html", ATOM);
    folder.run("gallery index.html -o .").refused(2, "index.html: is the scene itself");
    assert_eq!(folder.read("me.xyz"), ATOM.as_bytes());
    assert_eq!(folder.names(), ["base.json", "index.html", "me.json", "me.xyz"]);
}

#[test]
fn a_picture_beyond_the_adapter_leaves_the_former_file() {
    let Some(folder) = Folder::with_adapter("former") else { return };
    folder.write("a.png", "former");
    for size in ["4294967295x4294967295", "1x1000000"] {
        folder.run(&format!("render c60 -o a.png --samples 1 --size {size}")).refused(3, "at most");
    }
    assert_eq!(folder.read("a.png"), b"former");
    folder.run("gallery c60 -s education -o a.png").refused(1, "a.png: there is a file where a folder is needed");
    folder.run("gallery c60 -s education -o a.png/b").refused(1, "there is a file where a folder is needed");
}

#[cfg(unix)]
#[test]
fn links_permissions_and_long_names_are_kept() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let Some(folder) = Folder::with_adapter("links") else { return };
    folder.write("target.png", "former").write("mode.png", "former").write("locked.png", "former");
    symlink("target.png", folder.path("link.png")).unwrap();
    symlink("gone.png", folder.path("dangling.png")).unwrap();
    symlink("circle.png", folder.path("circle.png")).unwrap();
    let mode = |name: &str| std::fs::metadata(folder.path(name)).unwrap().permissions().mode() & 0o777;
    let set = |name: &str, mode| {
        std::fs::set_permissions(folder.path(name), std::fs::Permissions::from_mode(mode)).unwrap();
    };
    set("mode.png", 0o600);
    set("locked.png", 0o444);
    let long = format!("{}.png", "n".repeat(251));
    for name in ["link.png", "dangling.png", "mode.png", &long] {
        folder.run(&format!("render c60 -o {name} --size 8x8 --samples 1")).done();
        assert_eq!(Picture::read(&folder, name).info.0, 8);
    }
    assert!(folder.path("link.png").is_symlink() && folder.path("dangling.png").is_symlink());
    assert_eq!(Picture::read(&folder, "gone.png").info.0, 8);
    assert_eq!(mode("mode.png"), 0o600);
    let refuse = |name: &str, words| {
        folder.run(&format!("render c60 -o {name} --size 8x8 --samples 1")).refused(1, words);
    };
    refuse("locked.png", "locked.png: no permission to write there");
    refuse("circle.png", "circle.png: cannot be written");
    refuse(&format!("{}.png", "n".repeat(300)), "this name is too long");
    assert_eq!(folder.read("locked.png"), b"former");
}

#[cfg(target_os = "linux")]
#[test]
fn devices_and_pipes_are_written_to_and_stay_what_they_are() {
    use std::fs::File;
    use std::os::unix::fs::{FileTypeExt, symlink};
    let Some(folder) = Folder::with_adapter("devices") else { return };
    // A link in a folder of ours: a mistake here would otherwise replace the machine's own.
    symlink("/dev/null", folder.path("null")).unwrap();
    symlink("/dev/full", folder.path("full")).unwrap();
    symlink("/dev/stdout", folder.path("stdout")).unwrap();
    folder.run("render c60 -o null --aov depth=null --size 8x8 --samples 1").done();
    folder.run("render c60 -o full --size 8x8 --samples 1").refused(1, "full: the disk is full; free some space");
    let picture = folder.path("piped.png");
    let args = "render c60 -o stdout --size 8x8 --samples 1";
    folder
        .start(args.split_whitespace(), &[], std::process::Stdio::null(), Some(File::create(&picture).unwrap().into()))
        .done();
    assert_eq!(Picture::read(&folder, "piped.png").info.0, 8);
    for device in ["/dev/null", "/dev/full"] {
        assert!(std::fs::metadata(device).unwrap().file_type().is_char_device());
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_nobody_takes_is_no_panic() {
    use std::fs::File;
    use std::process::Stdio;
    let folder = Folder::new("answers");
    let run = |args: &str, stdout: Stdio| folder.start(args.split_whitespace(), &[], Stdio::null(), Some(stdout));
    let full = File::options().write(true).open("/dev/full").unwrap();
    run("copy education a.json", full.into()).refused(1, "standard output: cannot be written");
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    run("copy education b.json", writer.into()).done();
}
