//! Coordinates in text meshes, and positions that are written more than once.

use glam::DVec3;

use super::lines::quote;
use super::number::float;
use super::{Import, SceneError};
use crate::scene::report::NoteKind;

/// The largest coordinate that is read: products of three still fit double precision.
const LARGEST: f64 = 1e100;

/// Whether a position is one: neither NaN nor infinite nor absurd.
pub(super) fn is_place(position: DVec3) -> bool {
    position.abs().cmple(DVec3::splat(LARGEST)).all()
}

impl Import<'_> {
    /// The place of three words; none if one is no finite number. Nothing is noted: the face that needs it is.
    ///
    /// # Errors
    /// `Malformed` for a decimal comma, and for a number that no picture can hold.
    pub(super) fn vertex(&self, line: u32, words: [&[u8]; 3]) -> Result<Option<DVec3>, SceneError> {
        let mut place = DVec3::ZERO;
        for (axis, word) in words.into_iter().enumerate() {
            match float(word) {
                Some(value) if value.abs() <= LARGEST => place[axis] = value,
                Some(value) if value.is_finite() => {
                    let what =
                        format!("{} is no coordinate, being larger than 1e100; scale the model down", quote(word));
                    return Err(self.malformed(line, what));
                }
                None if is_decimal_comma(word) => {
                    let what = format!("{} has a decimal comma; export the model with decimal points", quote(word));
                    return Err(self.malformed(line, what));
                }
                _ => return Ok(None),
            }
        }
        Ok(Some(place))
    }

    /// The error of a file without a triangle: why, as far as faces were left out.
    pub(super) fn no_triangles(&self) -> SceneError {
        let file = self.file.to_string();
        let kinds = [
            (NoteKind::FaceOutOfRange, "the vertices of this one are not there"),
            (NoteKind::FaceNowhere, "a coordinate of this one is no number"),
            (NoteKind::ShortFace, "this one has fewer than three vertices"),
        ];
        let entries = self.report.entries.iter();
        let first =
            entries.filter_map(|note| Some((note, kinds.iter().find(|(kind, _)| *kind == note.kind)?.1))).next();
        let count: u64 = kinds.iter().map(|&(kind, _)| u64::from(self.report.count(kind))).sum();
        match first {
            None => SceneError::NoTriangles { file },
            Some((note, why)) => {
                let what = format!("none of {count} faces can be drawn: {why}; export the model again");
                match note.line {
                    Some(line) => SceneError::Malformed { file, line, what },
                    None => SceneError::Unsupported { file, what: format!("{}: {what}", note.text) },
                }
            }
        }
    }
}

/// Whether a word would be a number if its comma were a point.
pub(super) fn is_decimal_comma(word: &[u8]) -> bool {
    let mut parts = word.split(|&byte| byte == b',');
    let (Some(whole), Some(decimals), None) = (parts.next(), parts.next(), parts.next()) else {
        return false;
    };
    float(&[whole, b".", decimals].concat()).is_some()
}

/// Positions, each once: those of equal coordinates share a number. An open table of numbers, at most half full.
#[derive(Default)]
pub(super) struct UniquePositions {
    positions: Vec<DVec3>,
    /// Numbers of positions, from 1; 0 is free.
    table: Vec<u32>,
}

impl UniquePositions {
    /// The number of a position, new or not. Zero has one sign.
    pub(super) fn number(&mut self, position: DVec3) -> u32 {
        if self.table.len() < (self.positions.len() + 1) * 2 {
            self.grow();
        }
        let position = position + DVec3::ZERO;
        let mut slot = self.slot(position);
        loop {
            match self.table[slot] {
                0 => break,
                number if self.positions[number as usize - 1] == position => return number - 1,
                _ => slot = (slot + 1) & (self.table.len() - 1),
            }
        }
        self.positions.push(position);
        self.table[slot] = self.positions.len() as u32;
        self.positions.len() as u32 - 1
    }

    /// All positions, by number.
    pub(super) fn take(&mut self) -> Vec<DVec3> {
        self.table = Vec::new();
        std::mem::take(&mut self.positions)
    }

    fn slot(&self, position: DVec3) -> usize {
        // Multiplied and folded word by word: the high half of a product depends on all bits of both factors.
        let hash = position.to_array().iter().fold(0x9e37_79b9_7f4a_7c15_u64, |hash, value| {
            let product = u128::from(hash ^ value.to_bits()) * 0xa076_1d64_78bd_642f;
            (product >> 64) as u64 ^ product as u64
        });
        (hash ^ hash >> 32) as usize & (self.table.len() - 1)
    }

    fn grow(&mut self) {
        self.table = vec![0; (self.table.len() * 2).max(64)];
        for index in 0..self.positions.len() {
            let mut slot = self.slot(self.positions[index]);
            while self.table[slot] != 0 {
                slot = (slot + 1) & (self.table.len() - 1);
            }
            self.table[slot] = index as u32 + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_positions_share_a_number_and_zero_has_one_sign() {
        let mut unique = UniquePositions::default();
        let grid = |i: u32| DVec3::new(f64::from(i % 30), f64::from(i / 30 % 30), f64::from(i / 900)) * 0.1;
        for _ in 0..2 {
            for i in 0..9000 {
                assert_eq!(unique.number(grid(i)), i);
            }
        }
        assert_eq!(unique.number(DVec3::new(-0.0, 0.0, -0.0)), 0);
        assert_eq!(unique.take().len(), 9000);
    }

    #[test]
    fn nan_is_nowhere_on_any_axis() {
        for axis in 0..3 {
            for (value, is_there) in [(f64::NAN, false), (f64::NEG_INFINITY, false), (-1e101, false), (-1e100, true)] {
                let mut position = DVec3::ONE;
                position[axis] = value;
                assert_eq!(is_place(position), is_there, "{position}");
            }
        }
    }

    #[test]
    fn only_numbers_have_decimal_commas() {
        for word in [&b"1,5"[..], b"-0,25e3", b",5"] {
            assert!(is_decimal_comma(word));
        }
        for word in [&b"1.5"[..], b"1,2,3", b"x,5", b","] {
            assert!(!is_decimal_comma(word));
        }
    }
}
