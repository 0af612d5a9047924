//! What style files may hold beyond strict JSON, replaced by spaces: comments and trailing commas.
//!
//! No byte moves, so that every later offset is one of the file.

use super::syntax::MAX_DEPTH;

/// A text without comments and trailing commas, as long as before.
pub(super) struct Blanked {
    pub(super) text: String,
    /// The innermost bracket that is never closed, and its offset.
    pub(super) unclosed: Option<(u8, usize)>,
}

/// Replaces comments and trailing commas by spaces, and bounds the depth. Line breaks stay.
pub(super) fn blank(text: &str) -> Result<Blanked, (usize, String)> {
    let mut bytes = text.as_bytes().to_vec();
    let mut open: Vec<(u8, usize)> = Vec::new();
    // The last byte that is neither space nor comment, its offset, and the one before it.
    let (mut last, mut last_at, mut before_last) = (0u8, 0usize, 0u8);
    let mut i = 0;
    while i < bytes.len() {
        let byte = bytes[i];
        let start = i;
        match (byte, bytes.get(i + 1)) {
            (b'"', _) => i = end_of_string(&bytes, i),
            (b'/', Some(b'/')) => {
                i += bytes[i..].iter().position(|b| *b == b'\n').unwrap_or(bytes.len() - i);
                fill(&mut bytes[start..i]);
                continue;
            }
            (b'/', Some(b'*')) => {
                let Some(length) = bytes[i + 2..].windows(2).position(|pair| pair == b"*/") else {
                    return Err((start, "this comment is never closed: */ is missing".to_owned()));
                };
                i += length + 4;
                fill(&mut bytes[start..i]);
                continue;
            }
            (b'{' | b'[', _) => {
                open.push((byte, i));
                if open.len() > MAX_DEPTH {
                    return Err((i, format!("lists and objects are nested deeper than {MAX_DEPTH} levels")));
                }
                i += 1;
            }
            (b'}' | b']', _) => {
                // After an opening bracket, a colon or another comma it is a mistake and stays one.
                if last == b',' && !matches!(before_last, 0 | b',' | b':' | b'{' | b'[') {
                    bytes[last_at] = b' ';
                }
                open.pop();
                i += 1;
            }
            _ => i += 1,
        }
        if !byte.is_ascii_whitespace() {
            (before_last, last, last_at) = (last, byte, start);
        }
    }
    let text = String::from_utf8(bytes).map_err(|_| (0, "this comment is cut inside a character".to_owned()))?;
    Ok(Blanked { text, unclosed: open.pop() })
}

/// One past the closing quote of the string that begins at `start`, or the end of the text.
fn end_of_string(bytes: &[u8], start: usize) -> usize {
    let mut i = start + 1;
    while i < bytes.len() {
        match bytes[i] {
            b'"' => return i + 1,
            // No text goes over a line break: the strict check will say so.
            b'\n' => return i,
            b'\\' if bytes.get(i + 1) != Some(&b'\n') => i += 2,
            _ => i += 1,
        }
    }
    bytes.len()
}

fn fill(bytes: &mut [u8]) {
    for byte in bytes.iter_mut().filter(|byte| !matches!(byte, b'\n' | b'\r')) {
        *byte = b' ';
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blanking_keeps_every_offset() {
        let text = "// \u{e9}\r\n[1, /* , */ \"//,]\", {\"a\": 1 , }, // x\n]";
        let blanked = blank(text).unwrap();
        assert_eq!(blanked.text.len(), text.len());
        assert_eq!(blanked.text.replace(' ', ""), "\r\n[1,\"//,]\",{\"a\":1}\n]");
        let positions = |text: &str| text.match_indices('\n').map(|(at, _)| at).collect::<Vec<_>>();
        assert_eq!(positions(&blanked.text), positions(text));
    }
}
