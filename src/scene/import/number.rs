//! Numbers as they stand in molecule files: fixed columns, Fortran exponents, hybrid-36.

/// Coordinates beyond this, in angstrom, are no positions: single precision ends at 3.4e38 and squares must not overflow.
pub(super) const ABSURD: f64 = 1e30;

/// A decimal number with spaces around it; `D` and `d` are exponents, too. May give NaN or infinity, as written.
pub(super) fn float(field: &[u8]) -> Option<f64> {
    let field = field.trim_ascii();
    fixed_point(field).or_else(|| any_float(field))
}

/// Plain digits with a point, by far the most common: both digits and power of ten are exact in f64, so is the rounding.
fn fixed_point(field: &[u8]) -> Option<f64> {
    const POWERS: [f64; 16] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
    let (negative, digits) = match field {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] | digits => (false, digits),
    };
    let (mut value, mut decimals) = (0_u64, None);
    if digits.len() > 16 {
        return None;
    }
    for &byte in digits {
        match (byte, &mut decimals) {
            (b'0'..=b'9', decimals) => {
                value = value * 10 + u64::from(byte - b'0');
                if let Some(decimals) = decimals {
                    *decimals += 1;
                }
            }
            (b'.', decimals @ None) => *decimals = Some(0_usize),
            _ => return None,
        }
    }
    // With the point at most 15 digits remain; without one, the general reader takes over at 16.
    let decimals = match decimals {
        Some(decimals) if digits.len() > 1 => decimals,
        None if (1..16).contains(&digits.len()) => 0,
        _ => return None,
    };
    let value = value as f64 / POWERS[decimals];
    Some(if negative { -value } else { value })
}

/// Whatever Rust reads, with Fortran's exponent letter.
fn any_float(field: &[u8]) -> Option<f64> {
    let mut buffer = [0; 64];
    let text = buffer.get_mut(..field.len())?;
    for (to, &from) in text.iter_mut().zip(field) {
        *to = if matches!(from, b'd' | b'D') { b'e' } else { from };
    }
    std::str::from_utf8(text).ok()?.parse().ok()
}

/// An integer with spaces around it.
pub(super) fn integer(field: &[u8]) -> Option<i64> {
    std::str::from_utf8(field.trim_ascii()).ok()?.parse().ok()
}

/// An integer in a column of fixed width, decimal or hybrid-36: past all nines come `A000`, ..., `ZZZZ`, `a000`, ...
/// [Hybrid36, cci.lbl.gov/hybrid_36].
pub(super) fn hybrid36(field: &[u8]) -> Option<i64> {
    if let Some(number) = integer(field) {
        return Some(number);
    }
    let first = *field.first()?;
    let lower = first.is_ascii_lowercase();
    if !(2..=6).contains(&field.len()) || !first.is_ascii_alphabetic() {
        return None;
    }
    let digit = |byte: u8| match byte {
        b'0'..=b'9' => Some(i64::from(byte - b'0')),
        b'A'..=b'Z' if !lower => Some(i64::from(byte - b'A') + 10),
        b'a'..=b'z' if lower => Some(i64::from(byte - b'a') + 10),
        _ => None,
    };
    let value = field.iter().try_fold(0, |value, &byte| Some(value * 36 + digit(byte)?))?;
    let width = field.len() as u32 - 1;
    // The first letter is A = 10; lower-case numbers follow the 26 upper-case letters.
    let before = if lower { 26 - 10 } else { -10 };
    Some(value + before * 36_i64.pow(width) + 10_i64.pow(width + 1))
}

/// A PDB atom's serial number: decimal, hybrid-36, or hexadecimal as VMD writes it past 99999.
pub(super) fn serial(field: &[u8]) -> Option<u32> {
    let number = hybrid36(field).or_else(|| {
        let is_hex = field.len() == 5 && field[0].is_ascii_digit() && field.iter().all(u8::is_ascii_hexdigit);
        let text = std::str::from_utf8(field).ok().filter(|_| is_hex)?;
        i64::from_str_radix(text, 16).ok()
    })?;
    u32::try_from(number).ok().filter(|&number| number != u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fast_path_equals_the_library() {
        for text in [
            "0",
            "1.5",
            "-0.000",
            "+3.25",
            "99999.999",
            "  -12.345 ",
            ".5",
            "5.",
            "123456789.012345",
            "999999999999999",
        ] {
            let expected: f64 = text.trim().parse().expect("a number");
            assert_eq!(fixed_point(text.trim().as_bytes()), Some(expected), "{text}");
            assert_eq!(float(text.as_bytes()), Some(expected), "{text}");
        }
        for text in ["", ".", "-", "1..2", "1e5", "1 2", "--1", "1234567890123456789"] {
            assert_eq!(fixed_point(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn fortran_exponents_are_read_and_words_are_not() {
        assert_eq!(float(b"1.0D+00"), Some(1.0));
        assert_eq!(float(b" 2.5d-1"), Some(0.25));
        assert!(float(b"nan").is_some_and(f64::is_nan));
        assert_eq!(float(b"********"), None);
        assert_eq!(float(&[b'1'; 200]), None);
        assert_eq!(float(b"1,5"), None);
    }

    #[test]
    fn hybrid_36_counts_on_without_a_gap() {
        let pairs: [(&[u8], i64); 8] = [
            (b"99999", 99_999),
            (b"A0000", 100_000),
            (b"A0001", 100_001),
            (b"ZZZZZ", 43_770_015),
            (b"a0000", 43_770_016),
            (b"zzzzz", 87_440_031),
            (b"A000", 10_000),
            (b" -12", -12),
        ];
        for (text, number) in pairs {
            assert_eq!(hybrid36(text), Some(number));
        }
        assert_eq!(hybrid36(b"A00a0"), None);
        assert_eq!(hybrid36(b"*****"), None);
        assert_eq!(hybrid36(b""), None);
    }

    #[test]
    fn serials_past_99999_may_be_hexadecimal() {
        assert_eq!(serial(b"186a0"), Some(100_000));
        assert_eq!(serial(b"   12"), Some(12));
        assert_eq!(serial(b"   -1"), None);
        assert_eq!(serial(b"   ab"), None);
    }
}
