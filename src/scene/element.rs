//! Chemical elements: atomic number, symbol, radii, colour.
//!
//! The numbers and their sources are in `element_table.rs`; this file looks them up.

use super::element_table::TABLE;

/// What is known of one element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementInfo {
    /// Symbol as chemists write it: `Cl`. `X` for the unknown element.
    pub symbol: &'static str,
    /// English name in lower case.
    pub name: &'static str,
    /// Covalent radius in angstrom.
    pub covalent_radius: f32,
    /// Van der Waals radius in angstrom.
    pub vdw_radius: f32,
    /// Colour in sRGB, 0 to 255.
    pub color: [u8; 3],
    /// Whether it is a metal; metalloids (B, Si, Ge, As, Sb, Te) count as non-metals.
    pub is_metal: bool,
}

/// A chemical element by atomic number: 1 to 118, or 0 for an unknown one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Element(u8);

impl Element {
    /// An atom whose element the file does not tell.
    pub const UNKNOWN: Self = Self(0);
    /// Hydrogen; deuterium and tritium count as hydrogen.
    pub const HYDROGEN: Self = Self(1);
    /// Carbon.
    pub const CARBON: Self = Self(6);
    /// The largest atomic number in the table.
    pub const MAX_NUMBER: u8 = 118;

    /// The element of an atomic number; anything outside 1 to 118 is unknown.
    pub const fn from_number(number: u8) -> Self {
        if number <= Self::MAX_NUMBER { Self(number) } else { Self::UNKNOWN }
    }

    /// The element of a symbol, in any case, without spaces around it: `b"CL"` is chlorine. `D` and `T` are hydrogen.
    pub fn from_symbol(symbol: &[u8]) -> Option<Self> {
        match symbol {
            [a] => lookup(a.to_ascii_uppercase(), 0),
            [a, b] if b.is_ascii_alphabetic() => lookup(a.to_ascii_uppercase(), b.to_ascii_lowercase()),
            _ => None,
        }
    }

    /// Atomic number, 0 for the unknown element.
    pub const fn number(self) -> u8 {
        self.0
    }

    /// Whether the element is one of the 118.
    pub const fn is_known(self) -> bool {
        self.0 != 0
    }

    /// The row of the table.
    pub const fn info(self) -> &'static ElementInfo {
        &TABLE[self.0 as usize]
    }

    /// Symbol as chemists write it.
    pub const fn symbol(self) -> &'static str {
        self.info().symbol
    }

    /// Covalent radius in angstrom.
    pub const fn covalent_radius(self) -> f32 {
        self.info().covalent_radius
    }

    /// Van der Waals radius in angstrom.
    pub const fn vdw_radius(self) -> f32 {
        self.info().vdw_radius
    }

    /// Colour in sRGB, 0 to 255.
    pub const fn color(self) -> [u8; 3] {
        self.info().color
    }

    /// Whether it is a metal.
    pub const fn is_metal(self) -> bool {
        self.info().is_metal
    }

    /// Whether it forms ions rather than bonds: the alkali metals, and calcium and what stands below it.
    ///
    /// Their contacts are as long as bonds would be, so distances alone must not bond them: rock salt is no molecule.
    pub const fn is_ionic(self) -> bool {
        matches!(self.0, 3 | 11 | 19 | 37 | 55 | 87 | 20 | 38 | 56 | 88)
    }
}

/// Symbols by their letters: a row per first letter, column 0 for one-letter symbols, then `a` to `z`.
const LOOKUP: [[u8; 27]; 26] = {
    let mut table = [[0; 27]; 26];
    let mut number = 1;
    while number < TABLE.len() {
        let symbol = TABLE[number].symbol.as_bytes();
        let column = if symbol.len() > 1 { symbol[1] - b'a' + 1 } else { 0 };
        table[(symbol[0] - b'A') as usize][column as usize] = number as u8;
        number += 1;
    }
    table[(b'D' - b'A') as usize][0] = 1;
    table[(b'T' - b'A') as usize][0] = 1;
    table
};

/// Finds a symbol given as an upper-case letter and a lower-case one, or 0 for none.
fn lookup(first: u8, second: u8) -> Option<Element> {
    let row = LOOKUP.get(first.checked_sub(b'A')? as usize)?;
    let column = if second == 0 { 0 } else { second.checked_sub(b'a')? + 1 };
    match row.get(column as usize) {
        Some(&number) if number != 0 => Some(Element(number)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_symbol_finds_its_own_row_in_any_case() {
        for number in 1..=Element::MAX_NUMBER {
            let symbol = Element::from_number(number).symbol();
            for text in [symbol.to_string(), symbol.to_uppercase(), symbol.to_lowercase()] {
                assert_eq!(Element::from_symbol(text.as_bytes()), Some(Element(number)), "{text}");
            }
        }
    }

    #[test]
    fn other_texts_are_no_symbols() {
        for text in ["", "X", "Qz", "Foo", "C1", "1", "{", "\u{e9}", "C ", "Jj"] {
            assert_eq!(Element::from_symbol(text.as_bytes()), None, "{text:?}");
        }
        assert_eq!(Element::from_symbol(b"D"), Some(Element::HYDROGEN));
    }

    #[test]
    fn every_row_has_sane_radii() {
        for number in 0..=Element::MAX_NUMBER {
            let info = Element::from_number(number).info();
            assert!((0.25..=2.65).contains(&info.covalent_radius), "{}", info.symbol);
            assert!((1.05..=3.5).contains(&info.vdw_radius), "{}", info.symbol);
            assert!(!info.name.is_empty());
        }
        assert_eq!(Element::from_number(200), Element::UNKNOWN);
    }

    #[test]
    fn well_known_numbers_are_in_their_rows() {
        let carbon = Element::CARBON.info();
        assert_eq!((carbon.covalent_radius, carbon.vdw_radius, carbon.color), (0.76, 1.70, [144, 144, 144]));
        let gold = Element::from_number(79).info();
        assert_eq!((gold.symbol, gold.vdw_radius, gold.is_metal), ("Au", 1.66, true));
    }
}
