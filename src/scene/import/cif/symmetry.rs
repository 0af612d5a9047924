//! Symmetry operations as CIF writes them: `-x+1/2, y, -z+1/2`.

use super::super::number;
use glam::{DMat3, DVec3};

/// An operation on fractions of the cell's edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Operation {
    matrix: DMat3,
    shift: DVec3,
}

impl Operation {
    /// What leaves everything where it is.
    pub(super) const IDENTITY: Self = Self { matrix: DMat3::IDENTITY, shift: DVec3::ZERO };

    /// Where a point goes.
    pub(super) fn apply(&self, point: DVec3) -> DVec3 {
        self.matrix * point + self.shift
    }

    /// Reads an operation; none if the text is not one.
    pub(super) fn parse(text: &[u8]) -> Option<Self> {
        let mut rows = [DVec3::ZERO; 3];
        let mut shift = DVec3::ZERO;
        let mut parts = text.split(|&byte| byte == b',');
        for axis in 0..3 {
            (rows[axis], shift[axis]) = parse_component(parts.next()?)?;
        }
        let matrix = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
        let keeps_volume = (matrix.determinant().abs() - 1.0).abs() < 1e-6;
        (parts.next().is_none() && keeps_volume && shift.abs().max_element() <= 100.0).then_some(Self { matrix, shift })
    }
}

/// The factors of x, y and z in a component, and its shift.
fn parse_component(text: &[u8]) -> Option<(DVec3, f64)> {
    let (mut factors, mut shift) = (DVec3::ZERO, 0.0);
    let mut rest = text.trim_ascii();
    if rest.is_empty() {
        return None;
    }
    while let Some((&first, _)) = rest.split_first() {
        let sign = if first == b'-' { -1.0 } else { 1.0 };
        if matches!(first, b'+' | b'-') {
            rest = rest[1..].trim_ascii_start();
        }
        let end = rest.iter().position(|&byte| matches!(byte, b'+' | b'-')).unwrap_or(rest.len());
        let (term, after) = rest.split_at(end);
        rest = after;
        let term = term.trim_ascii();
        let axis = |byte: &u8| memchr::memchr(byte.to_ascii_lowercase(), b"xyz");
        match term.split_last() {
            Some((last, factor)) if axis(last).is_some() => {
                let factor = factor.trim_ascii();
                let factor = factor.strip_suffix(b"*").unwrap_or(factor);
                factors[axis(last)?] += sign * if factor.is_empty() { 1.0 } else { fraction(factor)? };
            }
            _ => shift += sign * fraction(term)?,
        }
    }
    Some((factors, shift))
}

/// A number such as `1/2` or `0.25`.
fn fraction(text: &[u8]) -> Option<f64> {
    let (numerator, denominator) = match memchr::memchr(b'/', text) {
        Some(slash) => (number::float(&text[..slash])?, number::float(&text[slash + 1..])?),
        None => (number::float(text)?, 1.0),
    };
    let value = numerator / denominator;
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(text: &str) -> Option<[f64; 3]> {
        Operation::parse(text.as_bytes()).map(|operation| operation.apply(DVec3::new(0.1, 0.2, 0.4)).to_array())
    }

    fn assert_near(text: &str, expected: [f64; 3]) {
        let found = image(text).unwrap_or_else(|| panic!("{text}"));
        assert!((DVec3::from(found) - DVec3::from(expected)).abs().max_element() < 1e-12, "{text}: {found:?}");
    }

    #[test]
    fn every_way_of_writing_is_read() {
        assert_near("x,y,z", [0.1, 0.2, 0.4]);
        assert_near("-x+1/2, y, -z+1/2", [0.4, 0.2, 0.1]);
        assert_near("1/2-X,+Y,.25 + Z", [0.4, 0.2, 0.65]);
        assert_near("-y,x-y,z+2/3", [-0.2, -0.1, 0.4 + 2.0 / 3.0]);
        assert_near("+z,+x,+y", [0.4, 0.1, 0.2]);
        assert_near("- x , 1*y , z-0.5", [-0.1, 0.2, -0.1]);
    }

    #[test]
    fn nonsense_is_no_operation() {
        for text in
            ["", "x,y", "x,y,z,x", "x,x,z", "2x,y,z", "x,y,q", "x,y,1/0", "x,y,", "x,y,z+1e9", "+,y,z", "x,y,z+nan"]
        {
            assert_eq!(image(text), None, "{text}");
        }
    }
}
