//! `render --renderer reference`: stills by exact ray casts.

use super::rig::{Folder, Picture};

#[test]
fn it_draws_what_the_style_says_and_needs_no_adapter() {
    let folder = Folder::new("reference");
    let args = "render water -s education --size 40x30 --samples 4 --renderer reference";
    let outcome = folder.run(&format!("{args} -o a.png --json")).done();
    let line: serde_json::Value = serde_json::from_str(&outcome.out).expect("one line of JSON");
    assert_eq!((&line["renderer"], &line["adapter"]), (&"reference".into(), &serde_json::Value::Null));
    assert_eq!(line["size"], serde_json::json!([40, 30]));
    folder.run(&format!("{args} -o b.png")).done();
    assert_eq!(folder.read("a.png"), folder.read("b.png"), "the same bytes each time");
    let picture = Picture::read(&folder, "a.png");
    assert!(picture.num_colors() > 10);
    folder.run(&format!("{args} -o t.png --turntable 2")).done();
    assert_eq!(folder.names(), ["a.png", "b.png", "t_0001.png", "t_0002.png"]);
}

#[test]
fn what_it_alone_draws_is_no_warning() {
    let folder = Folder::new("reference-effects");
    folder.write(
        "glass.json",
        r#"{ "mapping": { "*": "glass", "post_effects": ["ssaoPost", "dofPost"] },
             "shaders": [ { "name": "glass", "shader": "toon", "properties": { "opacity": 0.5 } } ] }"#,
    );
    let outcome =
        folder.run("render water -s glass.json --size 16x16 --samples 4 --renderer reference -o a.png").done();
    assert_eq!(outcome.messages(), Vec::<&str>::new());
    folder.write(
        "bad.json",
        r#"{ "shaders": [ { "name": "a", "shader": "dofPost", "properties": { "layers": [0, 1] } } ] }"#,
    );
    folder.run("render water -s bad.json --renderer reference -o b.png").refused(1, "layers");
    folder.run("render water --renderer cpu -o b.png").refused(2, "reference");
}
