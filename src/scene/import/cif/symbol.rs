//! Elements and charges as CIF writes them: `FE`, `Fe3+`, `O2-`, or only a label such as `C1A`.

use crate::scene::element::Element;
use crate::scene::guess::from_pdb_name;

/// The element and the charge of a type symbol; the element is unknown where no element begins the symbol.
pub(super) fn from_type_symbol(symbol: &[u8]) -> (Element, f32) {
    let length = symbol.iter().take_while(|byte| byte.is_ascii_alphabetic()).count();
    let (letters, rest) = symbol.split_at(length);
    (from_letters(letters), charge(rest))
}

/// The element that the first two letters are, or else the first.
fn from_letters(letters: &[u8]) -> Element {
    let first = |count: usize| letters.get(..count).and_then(Element::from_symbol);
    match letters.len() {
        0..=2 => Element::from_symbol(letters).unwrap_or_default(),
        _ => first(2).or_else(|| first(1)).unwrap_or_default(),
    }
}

/// The charge behind a symbol: `3+`, `+3`, `-` or nothing.
fn charge(text: &[u8]) -> f32 {
    let is_negative = text.contains(&b'-');
    if !is_negative && !text.contains(&b'+') {
        return 0.0;
    }
    let is_digit = |byte: &&u8| byte.is_ascii_digit();
    let digits = text
        .iter()
        .filter(is_digit)
        .take(2)
        .fold(None, |number: Option<u8>, digit| Some(number.unwrap_or(0) * 10 + (digit - b'0')));
    let charge = f32::from(digits.unwrap_or(1));
    if is_negative { -charge } else { charge }
}

/// The element that the label of an atom in a crystal suggests: `Zr1`, `O7'`, `C1A`; of `OW` the first letter.
pub(super) fn from_label(label: &[u8]) -> Element {
    let length = label.iter().take_while(|byte| byte.is_ascii_alphabetic()).count();
    let letters = &label[..length];
    let first = || letters.get(..1).and_then(Element::from_symbol).unwrap_or_default();
    match from_letters(letters) {
        // `CA1` is rather carbon than calcium; who means the metal writes `Ca1`.
        element if letters.len() >= 2 && letters[1].is_ascii_uppercase() && first().is_known() => {
            if LIKELY_IN_CAPITALS.contains(&&letters[..2]) { element } else { first() }
        }
        element if element.is_known() => element,
        _ => first(),
    }
}

/// Elements that labels in capitals mean although their first letter is an element, too.
const LIKELY_IN_CAPITALS: &[&[u8]] = &[b"CL", b"BR", b"FE", b"CU", b"SI", b"NI", b"PT", b"PD", b"BA", b"IR", b"SE"];

/// The element that the name of an atom in a residue suggests. The format has no columns, which PDB files tell elements by.
pub(super) fn from_name(name: &[u8], residue: &str) -> Element {
    let starts = |start: &&[u8]| name.get(..2).is_some_and(|letters| letters.eq_ignore_ascii_case(start));
    let is_left =
        name.len() >= 4 || [b"CL".as_slice(), b"BR", b"FE", b"ZN", b"MG", b"MN", b"CU", b"SE"].iter().any(starts);
    let mut columns = [b' '; 4];
    columns[usize::from(!is_left)..].iter_mut().zip(name).for_each(|(to, &from)| *to = from);
    from_pdb_name(columns, residue)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_may_have_charges() {
        for (text, symbol, charge) in [
            ("Fe3+", "Fe", 3.0),
            ("O2-", "O", -2.0),
            ("Cl-", "Cl", -1.0),
            ("FE", "Fe", 0.0),
            ("Zr+4", "Zr", 4.0),
            ("D", "H", 0.0),
            ("Cval", "C", 0.0),
            ("Zr0+", "Zr", 0.0),
            ("", "X", 0.0),
            ("5", "X", 0.0),
        ] {
            let (element, found) = from_type_symbol(text.as_bytes());
            assert_eq!((element.symbol(), found), (symbol, charge), "{text}");
        }
    }

    #[test]
    fn labels_begin_with_their_element() {
        for (label, symbol) in [
            ("Zr1", "Zr"),
            ("O7'", "O"),
            ("C1A", "C"),
            ("CA1", "C"),
            ("Ca1", "Ca"),
            ("CL1", "Cl"),
            ("OW", "O"),
            ("1", "X"),
        ] {
            assert_eq!(from_label(label.as_bytes()).symbol(), symbol, "{label}");
        }
    }

    #[test]
    fn names_in_residues_are_read_as_in_pdb_files() {
        for (name, residue, symbol) in [
            ("CA", "ALA", "C"),
            ("CA", "CA", "Ca"),
            ("FE", "HEM", "Fe"),
            ("NA", "HEM", "N"),
            ("HG11", "VAL", "H"),
            ("ZN", "ZN", "Zn"),
            ("OXT", "ALA", "O"),
        ] {
            assert_eq!(from_name(name.as_bytes(), residue).symbol(), symbol, "{name} {residue}");
        }
    }
}
