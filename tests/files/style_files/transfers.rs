//! Transfer functions as styles say them: presets, points and pictures.

use std::path::{Path, PathBuf};

use png::BitDepth::{Eight, One, Sixteen};
use png::ColorType::{Grayscale, GrayscaleAlpha, Indexed, Rgb, Rgba};
use restyle::config::transfer::{COLOR_SIZE, OPACITY_SIZE};
use restyle::config::{
    Catalog, CatalogEntry, ObjectKind, Param, Role, Source, Style, Transfer, TransferKind, explain, load, load_file,
    load_with,
};

/// What a shader of curvature has.
pub const CURVATURE: CatalogEntry = CatalogEntry {
    name: "curvature",
    role: Role::Object,
    doc: "Draws.",
    params: &[
        Param::opacity_transfer("opacity_transfer", "fig7a").doc("Opacity.").examples(&[
            "\"xray\"",
            "[[0, 0.1], [1, 1]]",
            "[[0, 0.1, 0.9]]",
        ]),
        Param::color_transfer("color_transfer", "fig6a").doc("Colour.").examples(&["\"ink\"", "[[-1, 1], [1, 0.5]]"]),
    ],
};

/// A version that draws it.
pub const GLASS: Catalog<'_> = Catalog {
    shaders: &[CatalogEntry { name: "basic", role: Role::Object, doc: "Draws.", params: &[] }, CURVATURE],
    kinds: &[ObjectKind::Mesh],
};

/// A style whose shader has these properties.
fn style(properties: &str) -> String {
    format!(
        r#"{{ "mapping": {{ "*": "g" }}, "shaders": [{{ "name": "g", "shader": "curvature", "properties": {{ {properties} }} }}] }}"#
    )
}

fn loaded(properties: &str) -> Style {
    load(&Source::new("s.json", style(properties)), &GLASS).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// The transfer function of the one property that is written.
fn transfer(style: &Style) -> &Transfer {
    let values = &style.shaders.iter().find(|used| used.name == "g").expect("the style has it").values;
    let name = if values.is_set("opacity_transfer") { "opacity_transfer" } else { "color_transfer" };
    values.transfer(name)
}

fn opacity(value: &str) -> Transfer {
    transfer(&loaded(&format!("\"opacity_transfer\": {value}"))).clone()
}

fn color(value: &str) -> Transfer {
    transfer(&loaded(&format!("\"color_transfer\": {value}"))).clone()
}

#[test]
fn the_table_is_sound() {
    assert_eq!(GLASS.check(), Vec::<String>::new());
}

#[test]
fn presets_are_found_by_name() {
    for preset in TransferKind::Opacity.presets() {
        assert_eq!(Some(opacity(&format!("{:?}", preset.name))), Transfer::preset(TransferKind::Opacity, preset.name));
    }
    for preset in TransferKind::Color.presets() {
        assert_eq!(Some(color(&format!("{:?}", preset.name))), Transfer::preset(TransferKind::Color, preset.name));
    }
    let values = &loaded("").shaders[0].values;
    assert_eq!(Some(values.transfer("opacity_transfer")), Transfer::preset(TransferKind::Opacity, "fig7a").as_ref());
    assert_eq!(Some(values.transfer("color_transfer")), Transfer::preset(TransferKind::Color, "fig6a").as_ref());
}

#[test]
fn points_are_joined_by_straight_lines() {
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} is not {b}");
    let two = opacity("[[0.25, 0.2], [0.75, 0.8]]");
    for (curvature, due) in [(0.0, 0.2), (0.25, 0.2), (0.5, 0.5), (-0.5, 0.5), (0.75, 0.8), (1.0, 0.8)] {
        near(two.opacity(curvature, 0.0), due);
        near(two.opacity(curvature, 1.0), due);
    }
    let deep = opacity("[[0, 0, 1], [1, 0.5, 0.5]]");
    for (curvature, depth, due) in [(0.0, 0.5, 0.5), (0.0, 1.0, 1.0), (0.5, 0.0, 0.25), (0.5, 0.25, 0.375)] {
        near(deep.opacity(curvature, depth), due);
    }
    near(opacity("[[0.3, 0.7]]").opacity(0.9, 0.1), 0.7);
    let grey = color("[[-1, 2], [0, 1], [1, 0]]");
    for (curvature, due) in [(-1.0, 2.0), (-0.25, 1.25), (0.0, 1.0), (0.5, 0.5)] {
        grey.color(curvature).into_iter().for_each(|factor| near(factor, due));
    }
    assert_eq!(color("[[0, 0.5, 1, 2]]").color(0.7), [0.5, 1.0, 2.0]);
    let most: Vec<String> = (0..256).map(|i| format!("[{}, 1]", f64::from(i) / 255.0)).collect();
    assert_eq!(opacity(&format!("[{}]", most.join(", "))).opacity(0.5, 0.5), 1.0);
}

#[test]
fn functions_are_equal_where_they_are_written_and_come_to_the_same() {
    assert_eq!(opacity("[[0, 0.5]]"), opacity(" [ [0.0, 0.50] ]"));
    assert_ne!(opacity("[[0, 0.5]]"), opacity("[[0, 0.25]]"));
    assert_ne!(opacity("\"constant\""), opacity("\"xray\""));
}

#[test]
fn explaining_shows_what_is_written() {
    let style = loaded("\"opacity_transfer\": [[0, 0.5], [1, 1]], \"color_transfer\": \"ink\"");
    let text = explain::text(&style);
    assert!(text.contains("opacity_transfer  2 points  s.json:1:"), "{text}");
    assert!(text.contains("color_transfer    ink       s.json:1:"), "{text}");
    let json = explain::json(&style);
    assert_eq!(
        json["shaders"][0]["properties"]["opacity_transfer"]["value"],
        serde_json::json!([[0.0, 0.5], [1.0, 1.0]])
    );
    assert_eq!(json["shaders"][0]["properties"]["color_transfer"]["value"], "ink");
}

#[test]
fn every_mistake_has_its_message() {
    for (properties, expected) in BROKEN {
        let text = format!(
            "{{ \"shaders\": [{{ \"name\": \"g\", \"shader\": \"curvature\", \"properties\": {{\n{properties} }} }}] }}"
        );
        let mistakes = load(&Source::new("s.json", text), &GLASS).map(drop).unwrap_err();
        assert_eq!(mistakes.to_string().replace("shaders[0].properties.", "~"), *expected, "\nfor {properties}");
    }
}

#[rustfmt::skip]
const BROKEN: &[(&str, &str)] = &[
    (
        r#""opacity_transfer": "fig7""#,
        r#"s.json:2:21 (~opacity_transfer): "opacity_transfer" cannot be "fig7"; did you mean "fig7a"? allowed: fig7a, fig7b, fig8d, constant, glass, xray, ghost, a picture that ends in .png, a list of points"#,
    ),
    (
        r#""color_transfer": "fig7a""#,
        r#"s.json:2:19 (~color_transfer): "color_transfer" cannot be "fig7a"; did you mean "fig6a"? allowed: fig6a, fig6b, none, warm_cool, ink, a picture that ends in .png, a list of points"#,
    ),
    (
        r#""color_transfer": "curve.JPG""#,
        r#"s.json:2:19 (~color_transfer): "color_transfer" must be a picture that ends in .png, not the text "curve.JPG": write "curve.png", exported as PNG"#,
    ),
    (
        r#""opacity_transfer": "mine.png""#,
        r#"s.json:2:21 (~opacity_transfer): "opacity_transfer" cannot use "mine.png": only a style that is a file can name a picture"#,
    ),
    (
        r#""opacity_transfer": 0.5"#,
        r#"s.json:2:21 (~opacity_transfer): "opacity_transfer" must be the name of a preset, the path of a PNG picture, or a list of 1 to 256 points, not the number 0.5"#,
    ),
    (
        r#""opacity_transfer": null"#,
        r#"s.json:2:21 (~opacity_transfer): "opacity_transfer" must be the name of a preset, the path of a PNG picture, or a list of 1 to 256 points, not null"#,
    ),
    (
        r#""opacity_transfer": []"#,
        r#"s.json:2:21 (~opacity_transfer): "opacity_transfer" must be a list of 1 to 256 points [curvature, opacity] or [curvature, opacity near, opacity far], not an empty list"#,
    ),
    (
        r#""opacity_transfer": [0, 0.5]"#,
        r#"s.json:2:21 (~opacity_transfer): "opacity_transfer" must be a list of points [curvature, opacity] or [curvature, opacity near, opacity far], not a list of 2 values: write [[0, 0.5]]"#,
    ),
    (
        r#""opacity_transfer": [0, 0.5, 1, 0.5]"#,
        r#"s.json:2:22 (~opacity_transfer[0]): "opacity_transfer" must be a list of points [curvature, opacity] or [curvature, opacity near, opacity far], not the number 0"#,
    ),
    (
        r#""opacity_transfer": [[0, 0.5], [1, 0.5, 0.6, 0.7]]"#,
        r#"s.json:2:32 (~opacity_transfer[1]): "opacity_transfer" must be a list of points [curvature, opacity] or [curvature, opacity near, opacity far], not a list of 4 values"#,
    ),
    (
        r#""color_transfer": [[0, 0.5, 0.5]]"#,
        r#"s.json:2:20 (~color_transfer[0]): "color_transfer" must be a list of points [curvature, factor] or [curvature, red, green, blue], not a list of 3 values"#,
    ),
    (
        r#""opacity_transfer": [[0, "0.5"]]"#,
        r#"s.json:2:26 (~opacity_transfer[0][1]): "opacity_transfer" must be points of numbers [curvature, opacity] or [curvature, opacity near, opacity far], not the text "0.5""#,
    ),
    (
        r#""opacity_transfer": [[-0.5, 1]]"#,
        r#"s.json:2:23 (~opacity_transfer[0][0]): "opacity_transfer" is -0.5, but must lie in 0 to 1, being a curvature without its sign"#,
    ),
    (
        r#""opacity_transfer": [[0, 1], [1, 1.5]]"#,
        r#"s.json:2:34 (~opacity_transfer[1][1]): "opacity_transfer" is 1.5, but must lie in 0 to 1, being an opacity"#,
    ),
    (
        r#""color_transfer": [[-1.5, 1]]"#,
        r#"s.json:2:21 (~color_transfer[0][0]): "color_transfer" is -1.5, but must lie in -1 to 1, being a curvature"#,
    ),
    (
        r#""color_transfer": [[-1, 1, 1, 3]]"#,
        r#"s.json:2:31 (~color_transfer[0][3]): "color_transfer" is 3, but must lie in 0 to 2, being a factor"#,
    ),
    (
        r#""opacity_transfer": [[0, 1], [0.5, 1], [0.25, 1]]"#,
        r#"s.json:2:41 (~opacity_transfer[2][0]): this curvature is below that of the point before it: put the points in order of curvature"#,
    ),
    (
        r#""opacity_transfer": [[0, 1], [0.5, 1], [0.5, 0]]"#,
        r#"s.json:2:41 (~opacity_transfer[2][0]): this curvature is that of the point before it: keep one of the two, or move one by 0.02 to make a step"#,
    ),
    (
        r#""opacity_transfer": [[0, 1], [0.5, 1, 1]]"#,
        r#"s.json:2:30 (~opacity_transfer[1]): this point has more or fewer numbers than the first one: give all points of a list the same count"#,
    ),
];

#[test]
fn too_many_points_are_refused() {
    let points: Vec<String> = (0..257).map(|i| format!("[{}, 1]", f64::from(i) / 256.0)).collect();
    let text = style(&format!("\"opacity_transfer\": [{}]", points.join(", ")));
    let mistakes = load(&Source::new("s.json", text), &GLASS).map(drop).unwrap_err().to_string();
    assert!(mistakes.ends_with("must be a list of 1 to 256 points [curvature, opacity] or [curvature, opacity near, opacity far], not a list of 257 values"), "{mistakes}");
}

/// A folder of styles and pictures, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("restyle_transfer_{test}_{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("there is room");
        Self(folder.canonicalize().expect("it is there"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("it lies in the folder")).expect("there is room");
        std::fs::write(path, bytes).expect("there is room");
    }

    /// Loads the style `s.json` of these properties.
    fn load(&self, properties: &str) -> Result<Style, restyle::config::Mistakes> {
        self.write("s.json", style(properties));
        load_file(&self.path("s.json"), &GLASS)
    }

    /// What `p.png` comes to.
    fn read(&self, property: &str) -> Transfer {
        let style = self.load(&format!("{property:?}: \"p.png\"")).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        transfer(&style).clone()
    }

    fn opacity(&self) -> Transfer {
        self.read("opacity_transfer")
    }

    fn color(&self) -> Transfer {
        self.read("color_transfer")
    }

    /// What is said of `p.png`, behind the place.
    fn message(&self, property: &str) -> String {
        let mistakes = self.load(&format!("{property:?}: \"p.png\"")).map(drop).expect_err("it is unusable");
        mistakes.list[0].problem.to_string()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A PNG file.
fn png(size: [u32; 2], color: png::ColorType, depth: png::BitDepth, bytes: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(depth);
    // As painting programs write it; the numbers are taken as they are all the same.
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    if color == png::ColorType::Indexed {
        encoder.set_palette(vec![0, 0, 0, 255, 255, 255]);
    }
    let mut writer = encoder.write_header().expect("memory takes all");
    writer.write_image_data(bytes).expect("the pixels have the size");
    writer.finish().expect("memory takes all");
    file
}

/// 2x1 grey pixels, 51 and 153, in the passes of Adam7, which the encoder does not write.
const INTERLACED: &[u8] = &[
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 2, 0, 0, 0, 1, 8, 0, 0, 0, 1, 166, 78, 16,
    192, 0, 0, 0, 12, 73, 68, 65, 84, 120, 156, 99, 48, 102, 152, 9, 0, 1, 54, 0, 205, 63, 53, 141, 210, 0, 0, 0, 0,
    73, 69, 78, 68, 174, 66, 96, 130,
];

#[test]
fn pictures_of_every_kind_are_read_as_numbers() {
    let folder = Folder::new("kinds");
    // Two pixels: 0.2 at the left, 0.6 at the right.
    for (color, depth, bytes) in [
        (Grayscale, Eight, &[51, 153][..]),
        (GrayscaleAlpha, Eight, &[51, 0, 153, 9]),
        (Rgb, Eight, &[51, 1, 2, 153, 3, 4]),
        (Rgba, Eight, &[51, 1, 2, 0, 153, 3, 4, 0]),
        (Grayscale, Sixteen, &[51, 51, 153, 153]),
        (GrayscaleAlpha, Sixteen, &[51, 51, 0, 0, 153, 153, 0, 1]),
        (Rgb, Sixteen, &[51, 51, 0, 0, 0, 0, 153, 153, 0, 0, 0, 0]),
        (Rgba, Sixteen, &[51, 51, 0, 0, 0, 0, 9, 9, 153, 153, 0, 0, 0, 0, 0, 0]),
    ] {
        folder.write("p.png", png([2, 1], color, depth, bytes));
        let read = folder.opacity();
        let at = [0.0, 0.5, -1.0].map(|curvature| (read.opacity(curvature, 0.3) * 1e6).round() / 1e6);
        assert_eq!(at, [0.2, 0.4, 0.6], "{color:?} {depth:?}");
    }
    for (color, bytes) in [(Grayscale, [0b0100_0000]), (Indexed, [0b0100_0000])] {
        folder.write("p.png", png([2, 1], color, One, &bytes));
        assert_eq!(folder.opacity().opacity(1.0, 0.0), 1.0, "{color:?}");
    }
    folder.write("p.png", INTERLACED);
    assert!((folder.opacity().opacity(0.5, 0.5) - 0.4).abs() < 1e-6);
    folder.write("p.png", png([2, 1], Rgba, Eight, &[0, 51, 255, 0, 255, 51, 0, 7]));
    let read = folder.color();
    assert_eq!((read.color(-1.0)[0], read.color(0.0)[0], read.color(1.0)[0]), (0.0, 1.0, 2.0));
    assert!((read.color(0.3)[1] - 0.4).abs() < 1e-6);
    assert_eq!(read.color(1.0)[2], 0.0);
    folder.write("p.png", png([1, 1], Grayscale, Sixteen, &[0xFF, 0xFF]));
    assert_eq!(folder.color().color(0.123), [2.0; 3]);
}

#[test]
fn near_is_at_the_bottom_and_one_pixel_is_constant() {
    let folder = Folder::new("near");
    folder.write("p.png", png([1, 2], Grayscale, Eight, &[255, 0]));
    let read = folder.opacity();
    assert_eq!([0.0, 0.5, 1.0].map(|depth| read.opacity(0.7, depth)), [0.0, 0.5, 1.0]);
    folder.write("p.png", png([1, 1], Grayscale, Eight, &[51]));
    let read = folder.opacity();
    assert!(read.opacity_nodes().iter().all(|node| *node == 0.2));
    // As many pixels as nodes are the nodes.
    let [columns, rows] = OPACITY_SIZE;
    let bytes: Vec<u8> = (0..columns * rows).map(|i| (i * 7 % 256) as u8).collect();
    folder.write("p.png", png([columns as u32, rows as u32], Grayscale, Eight, &bytes));
    let read = folder.opacity();
    for (i, node) in read.opacity_nodes().iter().enumerate() {
        let (column, row) = (i % columns, i / columns);
        assert!((node * 255.0 - f32::from(bytes[(rows - 1 - row) * columns + column])).abs() < 1e-4);
    }
    // A ramp that is larger than the table stays one.
    let ramp: Vec<u8> = (0..1000).flat_map(|i: u32| (i * 65535 / 999).to_be_bytes()[2..].to_vec()).collect();
    folder.write("p.png", png([1000, 1], Grayscale, Sixteen, &ramp));
    let read = folder.color();
    assert_eq!(read.color_nodes().len(), COLOR_SIZE);
    for (i, node) in read.color_nodes().iter().enumerate() {
        assert!((f64::from(node[0]) - i as f64 / 32.0).abs() < 2e-3, "{i}: {node:?}");
    }
}

#[test]
fn pictures_that_cannot_be_used_say_why() {
    let folder = Folder::new("unusable");
    let said = |property: &str| folder.message(property);
    let unusable = |property: &str, reason: &str| format!("{property:?} cannot use \"p.png\": {reason}");
    assert_eq!(
        said("opacity_transfer"),
        unusable("opacity_transfer", "there is no such file; a picture is found beside the style that names it")
    );
    folder.write("p.png", "");
    assert_eq!(said("opacity_transfer"), unusable("opacity_transfer", "this file is empty: save the picture again"));
    folder.write("p.png", "\u{ff}\u{d8}\u{ff} JFIF");
    assert_eq!(
        said("opacity_transfer"),
        unusable("opacity_transfer", "this is no PNG picture, whatever its name says: export it as PNG")
    );
    let whole = png([2, 3], Grayscale, Eight, &[1, 2, 3, 4, 5, 6]);
    for end in 8..whole.len() {
        folder.write("p.png", &whole[..end]);
        let said = said("opacity_transfer");
        assert!(said.starts_with("\"opacity_transfer\" cannot use \"p.png\": this PNG is broken ("), "{end}: {said}");
    }
    folder.write("p.png", &whole);
    assert_eq!(
        said("color_transfer"),
        unusable(
            "color_transfer",
            "this picture is 3 pixels high, but one of colours has the height 1: crop it to one row"
        )
    );
    // The header alone: nothing of the size that it states is there.
    let wide = png([4097, 1], Grayscale, Eight, &[0; 4097]);
    folder.write("p.png", &wide[..40]);
    assert_eq!(
        said("color_transfer"),
        unusable("color_transfer", "this picture is 4097x1 pixels: make it at most 4096 pixels wide and high")
    );
    folder.write("p.png", png([1, 4097], Grayscale, Eight, &[0; 4097]));
    assert_eq!(
        said("opacity_transfer"),
        unusable("opacity_transfer", "this picture is 1x4097 pixels: make it at most 4096 pixels wide and high")
    );
    folder.write("p.png", png([4096, 1], Grayscale, Eight, &[0; 4096]));
    assert!(folder.color().color(0.5) == [0.0; 3]);
    std::fs::remove_file(folder.path("p.png")).unwrap();
    std::fs::create_dir(folder.path("p.png")).unwrap();
    assert_eq!(said("opacity_transfer"), unusable("opacity_transfer", "this is a folder, not a picture"));
    let mistakes = folder.load("\"opacity_transfer\": \"a\\u0000.png\"").map(drop).unwrap_err();
    assert!(mistakes.to_string().ends_with("no file name can hold the character U+0000: remove it"), "{mistakes}");
    assert_eq!(mistakes.files, [folder.path("s.json")]);
}

#[test]
fn damaged_pictures_never_panic() {
    let folder = Folder::new("damaged");
    let whole = png([3, 2], Rgba, Sixteen, &[7; 48]);
    let mut random = super::mutations::Random(0x1CED_CAFE);
    for _ in 0..300 {
        let mut bytes = whole.clone();
        for _ in 0..=random.below(3) {
            let at = random.below(bytes.len());
            bytes[at] = random.below(256) as u8;
        }
        folder.write("p.png", &bytes);
        let _ = folder.load("\"opacity_transfer\": \"p.png\", \"color_transfer\": \"p.png\"");
    }
}

#[test]
fn pictures_are_found_beside_the_file_that_names_them_and_are_watched() {
    let folder = Folder::new("beside");
    folder.write("bases/p.png", png([1, 1], Grayscale, Eight, &[51]));
    folder.write("bases/base.json", style("\"opacity_transfer\": \"p.png\""));
    folder.write(
        "s.json",
        r#"{ "extends": "bases/base.json", "shaders": [{ "name": "g", "properties": { "color_transfer": "c.PNG" } }] }"#,
    );
    let load = || load_file(&folder.path("s.json"), &GLASS);
    // One that is missing is looked for where it will be.
    let mistakes = load().map(drop).unwrap_err();
    let expected = ["s.json", "bases/base.json", "c.PNG", "bases/p.png"].map(|name| folder.path(name));
    let sorted = |files: &[PathBuf]| {
        let mut files = files.to_vec();
        files.sort();
        files
    };
    assert_eq!(sorted(&mistakes.files), sorted(&expected));
    let message = mistakes.to_string();
    assert!(message.contains("s.json:1:") && message.contains("there is no such file"), "{message}");
    folder.write("c.PNG", png([1, 1], Grayscale, Eight, &[255]));
    let first = load().unwrap();
    assert_eq!(sorted(&first.files), sorted(&expected));
    assert!((transfer(&first).opacity(0.5, 0.5) - 0.2).abs() < 1e-6);
    assert_eq!(first, load().unwrap());
    // Another content under the same name is another style.
    folder.write("bases/p.png", png([1, 1], Grayscale, Eight, &[52]));
    assert_ne!(first, load().unwrap());
}

#[cfg(unix)]
#[test]
fn a_link_to_a_picture_is_watched_beside_it() {
    let folder = Folder::new("link");
    folder.write("real.png", png([1, 1], Grayscale, Eight, &[255]));
    std::os::unix::fs::symlink("real.png", folder.path("p.png")).unwrap();
    let style = folder.load("\"opacity_transfer\": \"p.png\"").unwrap();
    assert_eq!(style.files, ["s.json", "real.png", "p.png"].map(|name| folder.path(name)));
}

#[test]
fn only_a_file_can_name_a_picture() {
    let base = style("\"opacity_transfer\": \"p.png\"");
    let loader = |_: &str, _: &Source| Ok(Source::new("look", base.clone()));
    let own = Source {
        path: Some(Path::new("/tmp/own.json").to_owned()),
        ..Source::new("own.json", r#"{ "extends": "look" }"#)
    };
    let mistakes = load_with(&own, &GLASS, &loader).map(drop).unwrap_err();
    assert!(
        mistakes
            .to_string()
            .ends_with("\"opacity_transfer\" cannot use \"p.png\": only a style that is a file can name a picture"),
        "{mistakes}"
    );
}

#[test]
fn many_pictures_are_refused_without_being_read() {
    let folder = Folder::new("many");
    let entry = |i: usize| {
        format!(r#"{{ "name": "g{i}", "shader": "curvature", "properties": {{ "opacity_transfer": "p{i}.png" }} }}"#)
    };
    let entries: Vec<String> = (0..1000).map(entry).collect();
    folder.write("s.json", format!("{{ \"shaders\": [{}] }}", entries.join(",\n")));
    let mistakes = load_file(&folder.path("s.json"), &GLASS).map(drop).unwrap_err();
    assert_eq!(mistakes.files.len(), 65);
    assert!(
        mistakes.list[64]
            .to_string()
            .ends_with("cannot use \"p64.png\": a style can name 64 pictures, and no more: use one of those again"),
        "{}",
        mistakes.list[64]
    );
}
