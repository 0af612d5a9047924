//! What the parser takes, refuses and keeps: against another parser, and against hostile texts.

use serde_json::Value;

use super::*;

fn parsed(text: &str) -> (Text, Mistakes) {
    let mut mistakes = Mistakes::default();
    let text = parse(&Source::new("s.json", text), 0, &mut mistakes);
    (text, mistakes)
}

fn tree(text: &str) -> Tree {
    let (text, mistakes) = parsed(text);
    assert!(mistakes.is_empty(), "{mistakes}");
    text.root.value
}

#[test]
fn only_one_comma_may_trail() {
    let items = |text: &str| match tree(text) {
        Tree::List(items) => items.len(),
        other => panic!("{other:?} is no list"),
    };
    assert_eq!((items("[1,]"), items("[1 /**/ , // x\n ]")), (1, 1));
    for text in ["[,]", "[1,,]", "{,}", "{\"a\":,}", "[1],", ",", "[1,/**/,]", "{\"a\":1,,}"] {
        assert!(parsed(text).1.to_string().starts_with("s.json:1:"), "{text}");
    }
}

#[test]
fn spans_cover_keys_and_values() {
    let text = "{ \"a\" : [10, \"\u{e9}\"] }";
    let Tree::Object(members) = tree(text) else { panic!("this is an object") };
    let of = |span: Span| &text[span.start as usize..span.end as usize];
    assert_eq!((of(members[0].key_span), of(members[0].value.span)), ("\"a\"", "[10, \"\u{e9}\"]"));
}

#[test]
fn every_duplicate_is_found() {
    let (_, mistakes) = parsed("{\"a\":1,\n\"a\":{\"b\":1,\"b\":2,\"b\":3}}");
    assert_eq!(
        mistakes.to_string(),
        "s.json:2:1 (a): duplicate key \"a\": it is already at 1:2; keep one of them\n\
         s.json:2:12 (a.b): duplicate key \"b\": it is already at 2:6; keep one of them\n\
         s.json:2:18 (a.b): duplicate key \"b\": it is already at 2:6; keep one of them"
    );
}

#[test]
fn spans_of_broken_values_cover_what_holds_them() {
    let (text, _) = parsed("{ \"a\": [1, x], \"b\": , \"c\": [2] }");
    let Tree::Object(members) = &text.root.value else { panic!("this is an object") };
    let held: Vec<bool> = members.iter().map(|member| text.holds_broken(member.value.span)).collect();
    assert_eq!(held, [true, true, false]);
    assert!(members.iter().all(|member| !text.holds_broken(member.key_span)));
}

/// What stands between `,` and a closing bracket may go; all else is what another parser must take as well.
fn without_trailing_commas(text: &str) -> String {
    let mut kept: Vec<char> = Vec::new();
    let mut chars = text.chars();
    // The last two characters outside texts that are no blanks, each with its index.
    let mut last = [(' ', 0); 2];
    while let Some(c) = chars.next() {
        if matches!(c, ']' | '}') && last[1].0 == ',' && !matches!(last[0].0, ' ' | ',' | ':' | '[' | '{') {
            kept[last[1].1] = ' ';
        }
        if !matches!(c, ' ' | '\t' | '\n' | '\r') {
            last = [last[1], (c, kept.len())];
        }
        kept.push(c);
        let mut is_text = c == '"';
        while is_text {
            let Some(inner) = chars.next() else { break };
            kept.push(inner);
            if inner == '\\' {
                kept.extend(chars.next());
            }
            is_text = inner != '"';
        }
    }
    kept.into_iter().collect()
}

/// Of a key that is there twice, the later value counts, as there.
fn value_of(node: &Node) -> Value {
    match &node.value {
        Tree::Null | Tree::Broken => Value::Null,
        Tree::Bool(value) => Value::Bool(*value),
        Tree::Number(number) => Value::from(*number),
        Tree::Text(text) => Value::from(text.as_str()),
        Tree::List(items) => items.iter().map(value_of).collect(),
        Tree::Object(members) => {
            Value::Object(members.iter().map(|member| (member.key.clone(), value_of(&member.value))).collect())
        }
    }
}

/// Equal, but for the last digits of numbers, which the other parser rounds more quickly.
fn are_equal(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
            (a - b).abs() <= 1e-15 * a.abs().max(b.abs())
        }
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| are_equal(a, b)),
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len() && a.iter().all(|(key, a)| b.get(key).is_some_and(|b| are_equal(a, b)))
        }
        (a, b) => a == b,
    }
}

#[test]
fn another_parser_takes_the_same_texts() {
    const SEEDS: [&str; 4] = [
        "{\"a\": [1, -2.5e3, 0.25, {\"b\": null, \"c\": [true, false]}], \"d\\n\": \"\\u00e9\\ud83d\\ude00\", \"\": {}}",
        "[\"x\", \"\\\\ \\/ \\b\\f\\r\\t \\\" \", 1e-7, 120E+2, -0, 0.0, [[], [[]], {}], 123456789012345678901234567890]",
        "{\r\n\t\"camera\": {\"fov\": 35, \"bgcolor\": [255, 255, 255]},\r\n\t\"mapping\": {\"atom[element=O]\": \"a\"}\n}",
        " \"\u{e9}\u{1F600}\" ",
    ];
    const PIECES: [&str; 44] = [
        "{",
        "}",
        "[",
        "]",
        ",",
        ":",
        "\"",
        "\\",
        "null",
        "true",
        "1e999",
        "-1",
        "0.5",
        "1e308",
        "\u{e9}",
        "\r\n",
        " ",
        "\t",
        "\"a\"",
        "\\u0000",
        "\\ud83d",
        "\\ude00",
        "0",
        "00",
        "-",
        "+",
        ".",
        "e",
        "E5",
        "'",
        "=",
        ";",
        "#",
        "NaN",
        "\"a\":1,",
        "\u{feff}",
        "\u{a0}",
        "\u{1}",
        "\u{7f}",
        "\\n",
        "\\x",
        "[1,]",
        "{\"a\":1,}",
        ",,",
    ];
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut below = |end: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) as usize % end
    };
    let (mut taken, mut refused) = (0, 0);
    for i in 0..60_000 {
        let mut chars: Vec<char> = SEEDS[i % SEEDS.len()].chars().collect();
        for _ in 0..=below(3) {
            let at = below(chars.len() + 1);
            let end = (at + below(4)).min(chars.len());
            match below(4) {
                0 => drop(chars.drain(at..end)),
                1 => drop(chars.splice(at..end, PIECES[below(PIECES.len())].chars())),
                2 => drop(chars.splice(at..at, PIECES[below(PIECES.len())].chars())),
                _ => {
                    let from = below(chars.len() + 1);
                    let copy: Vec<char> = chars[from..(from + below(30)).min(chars.len())].to_vec();
                    chars.splice(at..at, copy);
                }
            }
        }
        // A mark is ours to pass over, and so are comments.
        let text: String = chars.iter().collect();
        if text.starts_with('\u{feff}') || text.contains('/') && !text.contains("\\/") {
            continue;
        }
        let (ours, mistakes) = parsed(&text);
        let is_taken = mistakes.list.iter().all(|mistake| mistake.problem.code() == "duplicate_key");
        match serde_json::from_str::<Value>(&without_trailing_commas(&text)) {
            Ok(theirs) => {
                assert!(is_taken, "{text:?} is JSON, but: {mistakes}");
                assert!(ours.is_whole && are_equal(&value_of(&ours.root), &theirs), "{text:?}: {:?}", ours.root);
                taken += 1;
            }
            Err(error) => {
                assert!(!is_taken, "{text:?} is no JSON: {error}");
                refused += 1;
            }
        }
    }
    assert!(taken > 5_000 && refused > 20_000, "{taken} taken, {refused} refused");
}

#[test]
fn hostile_texts_take_little_time_and_few_words() {
    // Quadratic work on this much would never end.
    let flood = |piece: &str| piece.repeat(400_000 / piece.len());
    for piece in [
        "[",
        "]",
        "{",
        "}",
        "\"",
        "\\",
        ",",
        ":",
        "'",
        "#",
        "/",
        "[]",
        "[],",
        "{}",
        "\"\"",
        "\"a\"b",
        "\"a:\"",
        "\"\\",
        "a ",
        "a\"",
        "'a\"",
        "a(",
        "a[",
        "[}",
        "{]",
        "{\"a\":",
        "{\"a\":[",
        "\"a\":",
        "=",
        ";",
        "1,",
        "1 ",
        "\u{201c}",
        "\u{201c}\"",
        "\u{a0}",
        "\u{1}",
        "/*",
        "*/",
        "//",
        "\"//\"a",
        "\"/*\"a",
        "\"a,",
        "\"a}",
        "a:",
        "[\"a\":1,",
        "\n\"a",
        "\"a\n",
        "0x",
        "\"\\u",
        ",\"",
        ", \"a\"x",
        "\u{1F600}",
        "\u{202e}",
    ] {
        let text = flood(piece);
        let (_, mistakes) = parsed(&text);
        assert!(mistakes.list.len() <= 100, "{piece}");
        parsed(&format!("{{\"lights\": [{text}"));
        parsed(&format!("{{\"camera\": {{{text}"));
        let (_, mistakes) = parsed(&format!("{{\"a\": \"{text}"));
        assert!(!mistakes.is_empty(), "{piece}");
    }
}
