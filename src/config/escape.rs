//! What stands between the quotes of a text: characters and `\` escapes.

use std::ops::Range;

/// What is wrong between the quotes, and where.
pub(super) type BadText = (Range<usize>, String);

/// Reads `text[inside]`, the part of a text between its quotes.
pub(super) fn unescape(text: &str, inside: Range<usize>) -> Result<String, BadText> {
    let raw = &text[inside.clone()];
    if !raw.bytes().any(|byte| byte == b'\\' || byte < 0x20) {
        return Ok(raw.to_owned());
    }
    let mut read = String::with_capacity(raw.len());
    let mut rest = raw;
    while let Some(special) = rest.bytes().position(|byte| byte == b'\\' || byte < 0x20) {
        read.push_str(&rest[..special]);
        rest = &rest[special..];
        let start = inside.end - rest.len();
        if !rest.starts_with('\\') {
            return Err((start..start + 1, control(rest.as_bytes()[0])));
        }
        let (character, length) = escape(rest).map_err(|(length, words)| (start..start + length, words))?;
        read.push(character);
        rest = &rest[length..];
    }
    read.push_str(rest);
    Ok(read)
}

fn control(byte: u8) -> String {
    match byte {
        b'\t' => "a text cannot hold a tab: write \\t or a space".to_owned(),
        byte => format!("a text cannot hold the control character U+{byte:04X}: remove it"),
    }
}

/// The character of the escape that the text begins with, and the length of the escape; or the length of what is none.
fn escape(text: &str) -> Result<(char, usize), (usize, String)> {
    let Some(letter) = text[1..].chars().next() else {
        return Err((1, "a backslash itself is written \\\\".to_owned()));
    };
    let plain = match letter {
        '"' | '\\' | '/' => letter,
        'b' => '\u{8}',
        'f' => '\u{c}',
        'n' => '\n',
        'r' => '\r',
        't' => '\t',
        'u' => return unicode(text),
        letter => {
            let shown = super::hint::shorten(&letter.to_string());
            let words = format!("there is no escape \\{shown}: a backslash itself is written \\\\");
            return Err((1 + letter.len_utf8(), words));
        }
    };
    Ok((plain, 2))
}

/// `\u00e9`, or two such halves for a character beyond U+FFFF.
fn unicode(text: &str) -> Result<(char, usize), (usize, String)> {
    let bad = |length: usize| {
        let words = "this \\u escape is no character: write the character itself, or \\\\ for a backslash";
        (length, words.to_owned())
    };
    let first = unit(text).ok_or_else(|| bad(2))?;
    if let Some(character) = char::from_u32(u32::from(first)) {
        return Ok((character, 6));
    }
    let second = unit(&text[6..]).ok_or_else(|| bad(6))?;
    match char::decode_utf16([first, second]).next() {
        Some(Ok(character)) => Ok((character, 12)),
        _ => Err(bad(6)),
    }
}

/// The number of a `\uXXXX` that the text begins with.
fn unit(text: &str) -> Option<u16> {
    let digits = text.strip_prefix("\\u")?.get(..4)?;
    digits.bytes().all(|byte| byte.is_ascii_hexdigit()).then(|| u16::from_str_radix(digits, 16).ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes_are_characters() {
        let text = r#"\"\\\/\b\f\n\r\t\u00e9\ud83d\ude00é"#;
        assert_eq!(unescape(text, 0..text.len()).unwrap(), "\"\\/\u{8}\u{c}\n\r\t\u{e9}\u{1F600}\u{e9}");
    }

    #[test]
    fn halves_of_characters_are_refused() {
        for text in ["\\ud800", "\\udc00", "\\ud800\\u0041", "\\ud800\\n", "\\u12", "\\u+123", "\\u12é4", "\\x", "\\"]
        {
            assert!(unescape(text, 0..text.len()).is_err(), "{text}");
        }
    }
}
