//! `restyle compare`: figures, the difference picture, limits, and pictures that cannot be compared.

use serde_json::Value as Json;

use super::rig::{Folder, Picture};

/// A PNG of one colour with an 8x8 square of another in the middle.
fn square(size: u32, ground: &[u8], color: &[u8]) -> Vec<u8> {
    let (start, end) = (size / 2 - 4, size / 2 + 4);
    let inside = |x: u32, y: u32| (start..end).contains(&x) && (start..end).contains(&y);
    let places = (0..size * size).map(|index| (index % size, index / size));
    let bytes = places.flat_map(|(x, y)| if inside(x, y) { color } else { ground }).copied().collect();
    encoded(size, ground.len(), bytes)
}

fn encoded(size: u32, channels: usize, bytes: Vec<u8>) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, size, size);
    encoder.set_color(if channels == 4 { png::ColorType::Rgba } else { png::ColorType::Rgb });
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&bytes).unwrap();
    writer.finish().unwrap();
    file
}

const WHITE: &[u8] = &[255; 3];

/// A folder with `a.png`, `same.png`, and `b.png`, whose square is a fifth redder.
fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    let a = square(32, WHITE, &[100, 50, 50]);
    folder.write("a.png", &a).write("same.png", &a).write("b.png", square(32, WHITE, &[151, 50, 50]));
    folder
}

fn json_of(folder: &Folder, args: &str) -> Json {
    let outcome = folder.run(&format!("compare {args} --json")).done();
    assert_eq!(outcome.out.lines().count(), 1);
    serde_json::from_str(&outcome.out).unwrap_or_else(|error| panic!("{error}: {outcome:?}"))
}

/// A figure of a comparison.
#[track_caller]
fn figure(document: &Json, name: &str) -> f64 {
    document[name].as_f64().unwrap_or_else(|| panic!("{name} of {document}"))
}

#[test]
fn figures_are_told_to_people_and_to_tools() {
    let folder = folder("compare");
    let table = folder.run("compare a.png b.png").done().out;
    let squeezed: Vec<String> = table.lines().map(|l| l.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    assert_eq!(squeezed[0], "all red green blue");
    // 64 of the 144 pixels that count differ.
    for line in ["rmse 0.07698 0.13333 0.00000 0.00000", "max 0.20000 0.20000 0.00000 0.00000", "psnr 22.272 dB"] {
        assert!(squeezed.iter().any(|found| found == line), "{line}\n{table}");
    }
    assert_eq!(squeezed.last().unwrap(), "pixels 144 of 1024");
    let document = json_of(&folder, "a.png b.png");
    assert!((figure(&document, "max") - 0.2).abs() < 1e-6 && figure(&document, "flip") > 0.05);
    assert!(document["rmse_linear_rgb"][0].as_f64().unwrap() > 0.1, "{document}");
    let all = json_of(&folder, "a.png b.png --all-pixels");
    assert!((figure(&all, "rmse") - 0.2 / 48f64.sqrt()).abs() < 1e-6 && all["pixels"] == 1024, "{all}");
    assert!(figure(&all, "ssim") > figure(&document, "ssim"));
    assert_eq!(folder.names(), ["a.png", "b.png", "same.png"]);
}

#[test]
fn the_same_picture_passes_every_limit() {
    let folder = folder("compare-same");
    let limits = "--limit rmse=0 --limit max=0 --limit psnr=1000 --limit ssim=1 --limit flip=0 --limit max_linear=0";
    let outcome = folder.run(&format!("compare a.png same.png {limits}")).done();
    assert!(outcome.out.contains("inf dB") && outcome.err.is_empty(), "{outcome:?}");
    folder.run("compare a.png a.png").done();
    assert_eq!(json_of(&folder, "a.png same.png")["psnr"], "inf");
}

#[test]
fn a_limit_that_is_passed_is_exit_code_4() {
    let folder = folder("compare-limits");
    let run = |limits: &str| folder.run(&format!("compare a.png b.png {limits}"));
    run("--limit max=0.21 --limit psnr=22 --limit ssim=0.5").done();
    run("--limit max=0.15").refused(4, "b.png: is too far from a.png: max is 0.20000, 0.05000 above the limit of 0.15");
    run("--limit psnr=30").refused(4, "psnr is 22.27244, 7.72756 below the limit of 30");
    run("--limit psnr=30 --limit flip=0").refused(4, "below the limit of 30; flip is ");
    // All else is done as well.
    let outcome = run("--json -o d.png --limit rmse=0").refused(4, "rmse is 0.07698");
    let document: Json = serde_json::from_str(&outcome.out).unwrap();
    assert_eq!(document["limits_passed"].as_array().unwrap().len(), 1);
    assert_eq!(folder.names(), ["a.png", "b.png", "d.png", "same.png"]);
}

#[test]
fn the_difference_picture_is_bright_where_they_differ() {
    let folder = folder("compare-picture");
    folder.run("compare a.png b.png -o d.png").done();
    let picture = Picture::read(&folder, "d.png");
    assert_eq!((picture.info.0, picture.info.1, picture.info.2), (32, 32, png::ColorType::Rgb));
    let pixel = |x: usize, y: usize| &picture.bytes[(y * 32 + x) * 3..][..3];
    assert_eq!(pixel(0, 0), [0, 0, 4]);
    assert!(pixel(16, 16)[0] > 40, "{:?}", pixel(16, 16));
    folder.run("compare a.png same.png -o d.png").done();
    assert_eq!(Picture::read(&folder, "d.png").num_colors(), 1);
}

#[test]
fn transparent_pictures_are_laid_over_a_background() {
    let folder = folder("compare-alpha");
    folder
        .write("clear.png", square(32, &[0; 4], &[100, 50, 50, 255]))
        .write("nothing.png", square(32, &[0; 4], &[0; 4]))
        .write("black.png", square(32, &[0; 4], &[0, 0, 0, 255]));
    // The opaque one says what lies behind.
    assert_eq!(figure(&json_of(&folder, "a.png clear.png"), "max"), 0.0);
    // Black is not nothing, though it looks so over black.
    assert_eq!(figure(&json_of(&folder, "nothing.png black.png"), "max"), 1.0);
    assert_eq!(figure(&json_of(&folder, "nothing.png black.png --background black"), "max"), 0.0);
    assert!(figure(&json_of(&folder, "a.png clear.png --background #0000ff"), "max") > 0.9);
}

#[test]
fn pictures_that_cannot_be_compared_are_one_message() {
    let folder = folder("compare-bad");
    let whole = folder.read("a.png");
    folder
        .write("small.png", square(16, WHITE, WHITE))
        .write("cut.png", &whole[..whole.len() / 2])
        .write("head.png", &whole[..20])
        .write("empty.png", "")
        .write("text.png", "not a picture")
        .write("photo.png", [0xff, 0xd8, 0xff, 0xe0, 0, 0]);
    std::fs::create_dir(folder.path("folder")).unwrap();
    folder
        .run("compare a.png small.png")
        .refused(1, "small.png: 16x16 pixels, but a.png: 32x32 pixels; draw both in one size");
    folder.run("compare a.png nope.png").refused(1, "nope.png: no such file; check the spelling");
    folder.run("compare a.png cut.png").refused(1, "cut.png: ");
    folder.run("compare head.png a.png").refused(1, "head.png: ends before the picture does; copy or save it again");
    folder.run("compare a.png empty.png").refused(1, "empty.png: is empty; was it saved completely?");
    folder.run("compare a.png text.png").refused(1, "text.png: is another kind of file, not a PNG picture");
    folder.run("compare photo.png a.png").refused(1, "photo.png: is a JPEG, not a PNG picture; export it as PNG");
    folder.run("compare a.png folder").refused(1, "folder: is a folder; give one of the pictures in it");
}

#[test]
fn command_lines_of_a_comparison_that_are_wrong() {
    let folder = folder("compare-usage");
    for (args, words) in [
        ("compare a.png", "<B.png>"),
        ("compare a.png b.png --limit flip", "write it as FIGURE=X, FIGURE one of rmse, max, "),
        ("compare a.png b.png --limit flap=1", "there is no \"flap\"; there are rmse, max, "),
        ("compare a.png b.png --limit flip=nan", "a limit of flip is a number from 0 to 1"),
        ("compare a.png b.png --limit flip=-1", "a limit of flip is a number from 0 to 1"),
        ("compare a.png b.png --limit ssim=2", "a limit of ssim is a number from -1 to 1"),
        ("compare a.png b.png --limit psnr=NaN", "a limit of psnr is a number from 0 up"),
        ("compare a.png b.png --limit psnr=inf", "a limit of psnr is a number from 0 up"),
        ("compare a.png b.png --limit max=", "a limit of max is a number from 0 to 1"),
        ("compare a.png b.png --background nocolor", "written as #rrggbb or by its CSS name"),
        ("compare a.png b.png --background #ffffff80", "a background is opaque"),
        ("compare a.png b.png -o a.png", "a.png: is the first picture itself; write to another file"),
        ("compare a.png b.png -o ./b.png", "./b.png: is the second picture itself"),
        ("compare a.png b.png -o d.jpg", "d.jpg: pictures are written as PNG, not as JPG"),
    ] {
        folder.run(args).refused(2, words);
    }
    folder.run("compare a.png b.png -o no/d.png").refused(1, "no/d.png: the folder no does not exist");
    folder.run("compare a.png b.png -o .").refused(1, ".: is a folder; name a file in it");
    assert_eq!(folder.names(), ["a.png", "b.png", "same.png"]);
}

#[cfg(unix)]
#[test]
fn a_difference_picture_that_cannot_be_written_is_told() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder("compare-locked");
    folder.write("locked.png", "former");
    std::fs::set_permissions(folder.path("locked.png"), std::fs::Permissions::from_mode(0o444)).unwrap();
    folder.run("compare a.png b.png -o locked.png").refused(1, "locked.png: no permission to write there");
    assert_eq!(folder.read("locked.png"), b"former");
}

#[cfg(target_os = "linux")]
#[test]
fn pictures_may_come_through_pipes_and_never_end() {
    let folder = folder("compare-pipes");
    let args = "compare a.png /dev/stdin --limit max=0";
    let mut child = std::process::Command::new("cat");
    let mut child = child.arg(folder.path("same.png")).stdout(std::process::Stdio::piped()).spawn().unwrap();
    folder.start(args.split_whitespace(), &[], child.stdout.take().unwrap().into(), None).done();
    assert!(child.wait().unwrap().success());
    folder.run("compare a.png /dev/zero").refused(1, "/dev/zero: is another kind of file, not a PNG picture");
}
