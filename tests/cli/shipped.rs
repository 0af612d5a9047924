//! `restyle copy`, and what is refused where no driver answers.

use super::rig::{Folder, Picture};
use std::process::Stdio;

#[test]
fn copy_gives_the_look_and_never_overwrites() {
    let folder = Folder::new("copy");
    let outcome = folder.run("copy education mine.json").done();
    assert_eq!(outcome.out, "mine.json\n");
    let look = restyle::shipped::find(restyle::shipped::LOOKS, "education").unwrap();
    assert_eq!(folder.read("mine.json"), look.bytes);
    folder.write("mine.json", "changed");
    folder.run("copy future mine.json").refused(1, "mine.json: is there already");
    assert_eq!(folder.read("mine.json"), b"changed");
    folder.run("copy educaton new.json").refused(1, "did you mean \"education\"?");
    folder.run("copy education no/new.json").refused(1, "no/new.json: its folder does not exist; make it first");
    folder.run("copy education").refused(2, "<FILE>");
    assert_eq!(folder.names(), ["mine.json", "style-v1.json"]);
}

#[test]
fn copy_brings_the_schema_and_spares_what_is_not_ours() {
    let folder = Folder::new("schema");
    let schema = folder.run("schema").done().out.into_bytes();
    assert_eq!(folder.run("copy education a.json").done().err, "");
    assert_eq!(folder.read("style-v1.json"), schema);
    folder.write("style-v1.json", "{ \"$id\": \"urn:restyle:style:1\", \"title\": \"older\" }");
    assert_eq!(folder.run("copy education b.json").done().err, "");
    assert_eq!(folder.read("style-v1.json"), schema);
    folder.write("style-v1.json", "{ \"mine\": true }");
    let outcome = folder.run("copy education c.json").done();
    assert!(outcome.err.starts_with("warning: style-v1.json: is another file and is left"), "{}", outcome.err);
    assert_eq!(folder.read("style-v1.json"), b"{ \"mine\": true }");
    // The style itself may have taken the name.
    let own = Folder::new("schema-name");
    let outcome = own.run("copy education style-v1.json").done();
    assert!(outcome.err.contains("is another file"), "{}", outcome.err);
    assert_eq!(own.names(), ["style-v1.json"]);
}

#[test]
fn the_schema_in_place_of_a_style_is_told() {
    let folder = Folder::new("schema-style");
    folder.run("copy education mine.json").done();
    let outcome = folder.run("render water -s style-v1.json -o out.png");
    outcome.refused(1, "this is the schema that editors check styles with, not a style");
}

#[test]
fn without_an_adapter_the_reference_renderer_draws_and_says_so() {
    let folder = Folder::new("none");
    let none = [("VK_DRIVER_FILES", "/nonexistent"), ("VK_ICD_FILENAMES", "/nonexistent")];
    let run = |args: &str| folder.start(args.split_whitespace(), &none, Stdio::null(), None);
    let told = "no graphics adapter was found: the reference renderer draws";
    let outcome = run("render c60 -o out.png --size 24x24 --samples 4").done();
    assert!(outcome.messages().iter().any(|line| line.starts_with(told)), "{}", outcome.err);
    assert!(Picture::read(&folder, "out.png").num_colors() > 20);
    let outcome = run("gallery water -s education -s scientific -o sheet --size 16x16").done();
    assert!(outcome.messages().iter().any(|line| line.starts_with(told)), "{}", outcome.err);
    assert!(folder.path("sheet/water.scientific.png").is_file() && folder.path("sheet/index.html").is_file());
    // What asks for an adapter is told how to get one.
    run("render c60 --renderer gpu -o no.png").refused(3, "mesa-vulkan-drivers");
    folder.write("mine.json", "{}");
    run("render c60 -s mine.json --watch -o no.png").refused(3, "mesa-vulkan-drivers");
    run("render c60 -s nope.json -o no.png").refused(1, "nope.json");
    run("render c60 --aov depth=no.exr").refused(2, "--watch and --aov are of the adapter");
    assert_eq!(folder.names(), ["mine.json", "out.png", "sheet"]);
}

#[test]
fn help_and_version_need_nothing() {
    let folder = Folder::new("help");
    let help = folder.run("--help").done().out;
    assert!(["render", "gallery", "info", "copy", "schema"].iter().all(|command| help.contains(command)), "{help}");
    assert_eq!(folder.run("--version").done().out, format!("restyle {}\n", env!("CARGO_PKG_VERSION")));
}
