//! The bytes of a glTF file's buffers: the binary chunk, data URIs, files beside it [Gltf2 §3.6.1].

use std::borrow::Cow;

use serde_json::Value;

use super::super::Import;
use super::super::lines::quote;
use super::json::{EXPORT_AGAIN, list, text};

/// The bytes of a buffer, or why there are none: only who uses it needs them.
pub(super) type Buffer<'a> = Result<Cow<'a, [u8]>, String>;

/// All buffers of a file.
pub(super) fn read<'a>(
    import: &mut Import<'_>,
    json: &Value,
    binary: Option<&'a [u8]>,
) -> Result<Vec<Buffer<'a>>, String> {
    let buffers = list(json, "buffers", "")?;
    Ok(buffers.iter().enumerate().map(|(index, buffer)| one(import, index, buffer, binary)).collect())
}

fn one<'a>(import: &mut Import<'_>, index: usize, buffer: &Value, binary: Option<&'a [u8]>) -> Buffer<'a> {
    let uri = text(buffer, "uri");
    if uri.is_empty() {
        let compressed = buffer.get("extensions").and_then(Value::as_object).and_then(|all| all.keys().next());
        return match (binary, compressed) {
            (Some(binary), _) if index == 0 => Ok(Cow::Borrowed(binary)),
            (_, Some(name)) => {
                Err(format!("buffer {index} exists only as {}; export without compression", quote(name.as_bytes())))
            }
            _ => Err(format!("buffer {index} has no data: the file has no binary chunk for it; {EXPORT_AGAIN}")),
        };
    }
    if let Some(data) = uri.get(..5).filter(|start| start.eq_ignore_ascii_case("data:")).map(|_| &uri[5..]) {
        let (head, data) = data.split_once(',').unwrap_or((data, ""));
        return if head.trim_end().ends_with(";base64") {
            base64(data.as_bytes()).map(Cow::Owned).map_err(|at| {
                let found = quote(data.as_bytes().get(at..=at).unwrap_or_default());
                format!("buffer {index}: character {} of its base64 data is {found}; {EXPORT_AGAIN}", at + 1)
            })
        } else {
            Ok(Cow::Owned(percent_decoded(data)))
        };
    }
    let path = String::from_utf8_lossy(&percent_decoded(uri)).into_owned();
    import.side_file(&path).map(Cow::Owned).map_err(|why| {
        let way_out = match why.0.as_str() {
            why if why.contains(';') => "",
            why if why.contains("network") => "; export as .glb, which holds everything",
            _ => "; put it there, or export as .glb, which holds everything",
        };
        format!("the file {} of buffer {index} {}{way_out}", quote(path.as_bytes()), why.0)
    })
}

/// Bytes of base64 with or without padding [RFC4648 §4], white space skipped; else where a character is none.
fn base64(text: &[u8]) -> Result<Vec<u8>, usize> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 3);
    let (mut bits, mut num_bits, mut is_padded) = (0_u32, 0, false);
    for (at, &character) in text.iter().enumerate() {
        let value = match character {
            b'A'..=b'Z' => character - b'A',
            b'a'..=b'z' => character - b'a' + 26,
            b'0'..=b'9' => character - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b'=' => {
                is_padded = true;
                continue;
            }
            b' ' | b'\t' | b'\r' | b'\n' => continue,
            _ => return Err(at),
        };
        if is_padded {
            return Err(at);
        }
        bits = bits << 6 | u32::from(value);
        num_bits += 6;
        if num_bits >= 8 {
            num_bits -= 8;
            bytes.push((bits >> num_bits) as u8);
        }
    }
    Ok(bytes)
}

/// A URI's bytes with `%20` and the like resolved; a `%` without two digits stays.
fn percent_decoded(uri: &str) -> Vec<u8> {
    let digit = |byte: Option<&u8>| byte.and_then(|&byte| (byte as char).to_digit(16));
    let mut rest = uri.as_bytes();
    let mut bytes = Vec::with_capacity(rest.len());
    while let Some((&byte, after)) = rest.split_first() {
        match (byte, digit(after.first()), digit(after.get(1))) {
            (b'%', Some(high), Some(low)) => {
                bytes.push((high * 16 + low) as u8);
                rest = &after[2..];
            }
            _ => {
                bytes.push(byte);
                rest = after;
            }
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_decoded_or_its_wrong_character_named() {
        assert_eq!(base64(b"Zm9vYmFy"), Ok(b"foobar".to_vec()));
        assert_eq!(base64(b"Zm9vYg=="), Ok(b"foob".to_vec()));
        assert_eq!(base64(b"Zm9v\nYg"), Ok(b"foob".to_vec()));
        assert_eq!(base64(b"-_8="), Ok(vec![0xfb, 0xff]));
        assert_eq!(base64(b"Zm9*"), Err(3));
        assert_eq!(base64(b"Zg==Zg=="), Err(4));
    }

    #[test]
    fn escaped_characters_of_a_uri_are_resolved() {
        assert_eq!(percent_decoded("a%20b%C3%A9.bin"), "a b\u{e9}.bin".as_bytes());
        assert_eq!(percent_decoded("100%"), b"100%");
        assert_eq!(percent_decoded("%zz"), b"%zz");
    }
}
