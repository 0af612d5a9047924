//! Lengths as style files write them.

use std::fmt;
use std::str::FromStr;

/// A length in one of five units. Only who knows the scene and the picture can turn it into scene units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Length {
    /// In radii of the scene's bounding sphere: a plain number.
    Radii(f64),
    /// In points, `"2pt"`: picture height / 1080.
    Points(f64),
    /// In median radii of the drawn atoms, `"3r"`.
    MedianRadii(f64),
    /// In angstrom, `"1.5A"`.
    Angstrom(f64),
    /// In millimetres, `"2mm"`.
    Millimetre(f64),
}

impl Length {
    /// The number without its unit.
    pub fn number(self) -> f64 {
        match self {
            Self::Radii(n) | Self::Points(n) | Self::MedianRadii(n) | Self::Angstrom(n) | Self::Millimetre(n) => n,
        }
    }

    /// The unit as it is written; empty for radii of the scene.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Radii(_) => "",
            Self::Points(_) => "pt",
            Self::MedianRadii(_) => "r",
            Self::Angstrom(_) => "A",
            Self::Millimetre(_) => "mm",
        }
    }
}

/// The text is not a number followed by a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a length is a number, \"2pt\", \"3r\", \"1.5A\" or \"2mm\"")]
pub struct BadLength;

impl FromStr for Length {
    type Err = BadLength;

    /// Reads `2pt`, `3r`, `1.5A` (or `Å`) and `2mm`; a space before the unit is fine.
    /// A text without a unit is refused: in files, radii of the scene are plain numbers.
    fn from_str(text: &str) -> Result<Self, BadLength> {
        let text = text.trim();
        let end = text
            .char_indices()
            .find(|(at, c)| !(c.is_ascii_digit() || *c == '.' || (*at == 0 && matches!(c, '-' | '+'))))
            .map_or(text.len(), |(at, _)| at);
        let (digits, unit) = text.split_at(end);
        let number: f64 = digits.parse().map_err(|_| BadLength)?;
        match unit.trim_start() {
            "pt" => Ok(Self::Points(number)),
            "r" => Ok(Self::MedianRadii(number)),
            "A" | "\u{c5}" | "\u{212b}" => Ok(Self::Angstrom(number)),
            "mm" => Ok(Self::Millimetre(number)),
            _ => Err(BadLength),
        }
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.number(), self.unit())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_is_read_and_shown() {
        for (text, length) in [
            ("2pt", Length::Points(2.0)),
            ("3r", Length::MedianRadii(3.0)),
            ("1.5A", Length::Angstrom(1.5)),
            ("0.25mm", Length::Millimetre(0.25)),
            ("-1pt", Length::Points(-1.0)),
        ] {
            assert_eq!(text.parse(), Ok(length));
            assert_eq!(length.to_string(), text);
        }
        assert_eq!(Length::Radii(0.5).to_string(), "0.5");
        assert_eq!(" 2 pt ".parse(), Ok(Length::Points(2.0)));
        assert_eq!("1\u{c5}".parse(), Ok(Length::Angstrom(1.0)));
    }

    #[test]
    fn anything_else_is_refused() {
        for text in ["", "2", "pt", "2px", "2 p t", "1e3pt", "..pt", "1-2pt", "nanpt", "infmm", "2PT", "\u{661}pt"] {
            assert_eq!(text.parse::<Length>(), Err(BadLength), "{text}");
        }
    }
}
