//! The source line under a message, for files as editors write them and as nobody should.

use restyle::config::{Severity, Source, load};

use super::catalog::CATALOG;

/// The source lines under the mistakes of a style.
fn lines(style: impl Into<Vec<u8>>) -> Vec<String> {
    lines_with(style, false)
}

fn lines_with(style: impl Into<Vec<u8>>, styled: bool) -> Vec<String> {
    let mistakes = load(&Source::new("s.json", style), &CATALOG).expect_err("this style should not load");
    let line = |place| mistakes.texts.source_line(place, Severity::Mistake, styled).unwrap_or_default();
    mistakes.list.iter().map(|mistake| line(&mistake.place)).collect()
}

#[test]
fn the_key_or_value_is_marked() {
    assert_eq!(
        lines("{\n  \"camera\": { \"fovv\": 30,\n    \"zoom\": \"large\" }\n}\n"),
        [
            "2 |   \"camera\": { \"fovv\": 30,\n  |               ^^^^^^",
            "3 |     \"zoom\": \"large\" }\n  |             ^^^^^^^",
        ]
    );
}

#[test]
fn tabs_are_four_columns() {
    let expected = ["1 |     {    \"fov\": 1 }\n  |          ^^^^^"];
    assert_eq!(lines("\t{\t\"fov\": 1 }"), expected);
}

#[test]
fn wide_letters_move_the_marker_two_columns() {
    assert_eq!(
        lines("{ \"$schema\": \"\u{6c34}\u{1f600}\", \"fov\": 1 }"),
        ["1 | { \"$schema\": \"\u{6c34}\u{1f600}\", \"fov\": 1 }\n  |                      ^^^^^"]
    );
    assert_eq!(
        lines("{ \"e\u{301}\": 1, \"fov\": 1 }"),
        ["1 | { \"e\u{301}\": 1, \"fov\": 1 }\n  |   ^^^", "1 | { \"e\u{301}\": 1, \"fov\": 1 }\n  |           ^^^^^"]
    );
}

#[test]
fn a_wide_letter_is_marked_over_both_columns() {
    assert_eq!(lines("{ \"\u{6c34}\": 1 }"), ["1 | { \"\u{6c34}\": 1 }\n  |   ^^^^"]);
}

#[test]
fn what_is_no_utf8_is_marked_where_it_begins() {
    // The text that holds it is no mistake of its own; that its key is unknown is.
    let shown = lines(b"{ \"x\": \"\xe9\" }");
    assert_eq!(shown, ["1 | { \"x\": \"\u{2421}\" }\n  |   ^^^", "1 | { \"x\": \"\u{2421}\" }\n  |         ^"]);
}

#[test]
fn every_place_of_a_text_can_be_shown() {
    let text = "{\t\"a\u{301}\u{6c34}\u{1f469}\u{200d}\u{1f52c}\": [\r\n\n \u{5d0}\u{202e}\u{1b} /* ".to_owned()
        + &"x\u{1f600}".repeat(80)
        + " */ \"\r\" ]}\n";
    let mistakes = load(&Source::new("s.json", text.as_str()), &CATALOG).unwrap_err();
    let mut place = mistakes.list[0].place.clone();
    for start in 0..=text.len() + 1 {
        for end in [start.saturating_sub(1), start, start + 1, start + 7, text.len() + 2] {
            (place.start, place.end, place.line) = (start, end, 7);
            let Some(shown) = mistakes.texts.source_line(&place, Severity::Warning, false) else {
                assert!(start > text.len());
                continue;
            };
            let (line, marker) = shown.split_once('\n').unwrap();
            assert!(line.starts_with("7 |") && !line.contains(|c: char| c.is_control()), "{line:?}");
            assert!(marker.starts_with("  |") && marker.ends_with('^'), "{start} to {end}: {marker:?}");
        }
    }
}

#[test]
fn right_to_left_letters_stay_and_marks_that_turn_text_go() {
    let shown = lines("{ \"$schema\": \"\u{5e9}\u{5dc}\u{202e}\u{2066}\u{200f}\", \"fov\": 1 }");
    let expected =
        "1 | { \"$schema\": \"\u{5e9}\u{5dc}\u{fffd}\u{fffd}\u{fffd}\", \"fov\": 1 }\n  |                       ^^^^^";
    assert_eq!(shown, [expected]);
}

#[test]
fn control_characters_are_pictures_of_themselves() {
    for (control, picture) in [('\u{1b}', '\u{241b}'), ('\0', '\u{2400}'), ('\u{7}', '\u{2407}'), ('\r', '\u{240d}')] {
        let shown = lines(format!("{{ \"$schema\": \"a{control}b\" }}")).join("\n");
        assert!(shown.starts_with(&format!("1 | {{ \"$schema\": \"a{picture}b\" }}\n")), "{shown:?}");
    }
    // In comments they are no mistake.
    for (control, shown) in [('\u{9b}', '\u{fffd}'), ('\u{7f}', '\u{2421}'), ('\u{2028}', '\u{fffd}')] {
        let expected = format!("1 | /* {shown} */ {{ \"fov\": 1 }}\n  |           ^^^^^");
        assert_eq!(lines(format!("/* {control} */ {{ \"fov\": 1 }}")), [expected]);
    }
}

#[test]
fn marks_and_line_ends_of_windows_are_not_shown() {
    let expected = ["2 |   \"fov\": 1\n  |   ^^^^^"];
    assert_eq!(lines("\u{feff}{\r\n  \"fov\": 1\r\n}\r\n"), expected);
    assert_eq!(lines("{\n  \"fov\": 1\n}"), expected);
}

#[test]
fn a_value_over_several_lines_is_marked_on_its_first() {
    assert_eq!(
        lines("{ \"camera\": { \"bgcolor\": [\n  1,\n  2\n] } }"),
        ["1 | { \"camera\": { \"bgcolor\": [\n  |                          ^"]
    );
}

#[test]
fn the_end_of_a_file_can_be_marked() {
    assert_eq!(lines("{ \"camera\": {"), ["1 | { \"camera\": {\n  |             ^"]);
    let shown = lines("{ \"camera\": 3\n");
    // What is not closed, and what cannot be a camera.
    assert!(shown.len() == 2 && shown.iter().all(|line| line.ends_with('^')), "{shown:?}");
    // A file as a whole has no line.
    assert_eq!(lines(""), [""]);
}

#[test]
fn deep_indentation_is_shortened() {
    let shown = lines(format!("{{\n{}\"fov\": 1 }}", " ".repeat(80)));
    let (line, marker) = shown[0].split_once('\n').unwrap();
    assert!(line.chars().count() < 40 && line.contains("... "), "{line}");
    assert_eq!(line.find("\"fov\""), marker.find('^'), "{shown:?}");
}

#[test]
fn a_line_of_16_megabytes_is_cut_before_it_is_shown() {
    let filler = "\"$schema\": \"".to_owned() + &"\u{6c34}\u{1b}".replace('\u{1b}', "x").repeat(3 << 20);
    let text = format!("{{ {filler}\", \"fov\": 1, \"zoom\": 2 }}");
    assert!(text.len() > 12 << 20);
    let mistakes = load(&Source::new("s.json", text), &CATALOG).unwrap_err();
    let shown: Vec<String> = (0..1000)
        .flat_map(|_| &mistakes.list)
        .map(|mistake| mistakes.texts.source_line(&mistake.place, Severity::Mistake, false).unwrap())
        .collect();
    // A thousand times two: looking at whole lines would take minutes.
    for shown in &shown {
        let (line, marker) = shown.split_once('\n').unwrap();
        assert!(line.starts_with("1 | \u{2026}") && line.chars().count() < 120, "{line}");
        assert!(marker.trim_end().ends_with('^'), "{marker}");
    }
}

#[test]
fn colours_come_only_on_request() {
    assert!(!lines("{ \"fov\": 1 }").concat().contains('\u{1b}'));
    let styled = lines_with("{ \"fov\": \"\u{1b}[31m\" }", true).concat();
    assert!(styled.contains("\u{1b}[91m"), "the marker is red: {styled:?}");
    assert!(!styled.contains("\u{1b}[31m"), "the file's own colours are not obeyed: {styled:?}");
    let style =
        load(&Source::new("s.json", r#"{ "shaders": [{ "name": "a", "shader": "toon" }] }"#), &CATALOG).unwrap();
    let warning = style.texts.source_line(&style.warnings[0].place, Severity::Warning, true).unwrap();
    assert!(warning.contains("\u{1b}[33m"), "the marker is yellow: {warning:?}");
}
