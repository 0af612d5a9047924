//! Command lines that are wrong: exit code 2, and nothing is read or written.

use super::rig::Folder;

#[test]
fn wrong_command_lines_say_what_would_be_right() {
    let folder = Folder::new("commands");
    for (args, words) in [
        ("", "Usage: restyle"),
        ("rendr c60", "'render'"),
        ("render", "<SCENE>"),
        ("render c60", "nothing to write: give -o OUT.png"),
        ("render c60 -o a.png --size 0x10", "a picture is at least 1x1"),
        ("render c60 -o a.png --size 10x0", "a picture is at least 1x1"),
        ("render c60 -o a.png --size abc", "two whole numbers, such as 1920x1080"),
        ("render c60 -o a.png --size 10x", "two whole numbers"),
        ("render c60 -o a.png --size 10x10x10", "two whole numbers"),
        ("render c60 -o a.png --size 1.5x2", "two whole numbers"),
        ("render c60 -o a.png --size 99999999999x1", "two whole numbers"),
        ("render c60 -o a.png --size -1x5", "--"),
        ("render c60 -o a.png --samples 0", "0 is not in 1..=4096"),
        ("render c60 -o a.png --samples 1000000", "1000000 is not in 1..=4096"),
        ("render c60 -o a.png --samples many", "many"),
        ("render c60 -o a.png --bits 12", "8, 16"),
        ("render c60 -o a.png --frames 1000000000", "not in 0..=10000"),
        ("render c60 -o a.png --model x", "a model is its number, or all"),
        ("render c60 --aov depht=a.exr", "there are depth, normal, id, color"),
        ("render c60 --aov depth=", "the file name is missing"),
        ("render c60 --aov depth", "NAME=FILE.exr"),
        ("render c60 -o a --aov depth=a", "a: is named for two outputs"),
        ("render c60 --aov depth=a.exr --aov normal=./a.exr", "a.exr: is named for two outputs"),
        ("info", "<SCENE>"),
        ("gallery --samples 0", "0 is not in 1..=1024"),
        ("gallery --size 0x0", "a picture is at least 1x1"),
    ] {
        folder.run(args).refused(2, words);
    }
    folder.run_all(&["render", "c60", "-o", ""]).refused(2, "a value is required");
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[cfg(unix)]
#[test]
fn an_argument_that_is_no_text_is_refused() {
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::new("notext");
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_restyle"))
        .args(["render".as_ref(), std::ffi::OsStr::from_bytes(b"\xff.xyz"), "-o".as_ref(), "a.png".as_ref()])
        .current_dir(folder.path(""))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("invalid UTF-8"));
}

#[test]
fn a_name_that_nothing_has_finds_its_nearest() {
    let folder = Folder::new("names");
    folder.draw("caffiene").refused(1, "no molecule or mesh of this name; did you mean \"caffeine\"? shipped: c60, ");
    folder.draw("c60 -s educaton").refused(1, "no look of this name; did you mean \"education\"? shipped: ");
    folder.run("check ./Education.json").refused(1, "did you mean \"education\"? shipped: ");
    folder.draw("zzzzzzzz").refused(1, "no molecule or mesh of this name; shipped: c60, ");
    folder.draw("nope.xyz").refused(1, "nope.xyz: no such file; check the spelling");
    folder.draw("no/nope.pdb").refused(1, "no/nope.pdb: no such file");
    folder.draw("c60 -s nope.json").refused(1, "nope.json: no such file, and no look of this name");
    folder.run_all(&["render", "", "-o", "a.png"]).refused(1, "no such file");
    folder.run_all(&["render", "c60", "-s", "", "-o", "a.png"]).refused(1, "no such file");
    folder.run_all(&["render", "a\nb", "-o", "a.png"]).refused(1, "a\\nb");
    folder.run_all(&["render", "\u{1b}[31m", "-o", "a.png"]).refused(1, "no such file");
    folder.run_all(&["render", &"a".repeat(5000), "-o", "a.png"]).refused(1, "no such file");
    folder.run_all(&["render", &format!("{}.xyz", "a".repeat(5000)), "-o", "a.png"]).refused(1, "too long");
    folder.draw("c60 --model 9").refused(1, "has no model 9; it has only model 1");
    assert!(folder.names().is_empty());
}
