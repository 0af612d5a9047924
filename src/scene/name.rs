//! Short labels of atoms and residues, kept inline.

use std::fmt;

/// A label of at most six printable ASCII bytes: `CA`, `HG11`, `HOH`.
///
/// Six bytes make an [`Atom`](super::Atom) exactly 24 bytes. Longer labels are cut, other bytes become `?`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Name([u8; Self::MAX_LEN]);

impl Name {
    /// Bytes that fit.
    pub const MAX_LEN: usize = 6;

    /// Makes a label of the bytes without the spaces around them.
    pub fn new(bytes: &[u8]) -> Self {
        let mut label = [0; Self::MAX_LEN];
        for (to, &from) in label.iter_mut().zip(bytes.trim_ascii()) {
            *to = if from.is_ascii_graphic() || from == b' ' { from } else { b'?' };
        }
        Self(label)
    }

    /// The label as text, empty if the file gives none.
    pub fn as_str(&self) -> &str {
        let length = self.0.iter().position(|&byte| byte == 0).unwrap_or(Self::MAX_LEN);
        std::str::from_utf8(&self.0[..length]).unwrap_or_default()
    }

    /// The label with primes where older files have stars: `O5'` for `O5*`.
    pub fn with_primes(self) -> Self {
        Self(self.0.map(|byte| if byte == b'*' { b'\'' } else { byte }))
    }

    /// The label in the lower 48 bits of a number: equal for equal labels.
    pub const fn bits(self) -> u64 {
        let [a, b, c, d, e, f] = self.0;
        u64::from_le_bytes([a, b, c, d, e, f, 0, 0])
    }

    /// The label in upper case.
    pub fn to_uppercase(self) -> Self {
        Self(self.0.map(|byte| byte.to_ascii_uppercase()))
    }
}

impl fmt::Debug for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self.as_str(), f)
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_lose_spaces_and_never_break_text() {
        assert_eq!(Name::new(b" CA ").as_str(), "CA");
        assert_eq!(Name::new(b"").as_str(), "");
        assert_eq!(Name::new(b"TOOLONGNAME").as_str(), "TOOLON");
        assert_eq!(Name::new(&[b'A', 0xff, 0, b'B']).as_str(), "A??B");
        assert_eq!(Name::new(b"O5*").with_primes().as_str(), "O5'");
        assert_eq!(format!("{:>4}", Name::new(b"N")), "   N");
    }
}
