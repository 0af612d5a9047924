//! Colours as style files write them: sRGB with straight alpha.

use std::fmt;

/// A colour as written: sRGB, 0 to 1, straight alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Srgba {
    /// Red, green, blue, alpha.
    pub rgba: [f32; 4],
}

impl Srgba {
    /// An opaque colour from bytes.
    pub const fn from_bytes([r, g, b]: [u8; 3]) -> Self {
        Self { rgba: [r as f32 / 255.0, g as f32 / 255.0, b as f32 / 255.0, 1.0] }
    }

    /// The colour as shading needs it: linear light, straight alpha [IEC61966, part 2-1].
    pub fn to_linear(self) -> [f32; 4] {
        let [r, g, b, a] = self.rgba;
        let linear = |c: f32| {
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        [linear(r), linear(g), linear(b), a]
    }

    /// Reads `#rgb`, `#rgba`, `#rrggbb`, `#rrggbbaa` or a CSS name; letters of either case.
    /// The wider CSS syntax (`rgb(…)`, hex without `#`) is refused: one way to write a thing is enough.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let is_hex = |digits: &str| digits.bytes().all(|b| b.is_ascii_hexdigit());
        let accepted = match text.strip_prefix('#') {
            Some(digits) => is_hex(digits),
            None => text.bytes().all(|b| b.is_ascii_alphabetic()) && !is_hex(text),
        };
        let color = accepted.then(|| csscolorparser::parse(text).ok()).flatten()?;
        Some(Self { rgba: [color.r, color.g, color.b, color.a] })
    }
}

impl Srgba {
    /// The colour that was meant by what other programs write: `rgb(255, 0, 0)`, `255, 0, 0` or `ff0000`.
    pub(super) fn meant(text: &str) -> Option<Self> {
        /// Longer than any way to write a colour.
        const LONGEST: usize = 64;
        let text = text.trim();
        if text.len() > LONGEST {
            return None;
        }
        let is_bare = text.starts_with(|c: char| c.is_ascii_digit()) && text.contains(',');
        let written = if is_bare { format!("rgb({text})") } else { text.to_owned() };
        let color = csscolorparser::parse(&written).ok()?;
        Some(Self { rgba: [color.r, color.g, color.b, color.a] })
    }
}

/// The CSS names of colours.
pub fn css_names() -> impl Iterator<Item = &'static str> {
    csscolorparser::NAMED_COLORS.keys().map(|name| name.as_str())
}

impl fmt::Display for Srgba {
    /// `#rrggbb`, or `#rrggbbaa` if it is not opaque.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b, a] = self.rgba.map(|c| (c * 255.0).round() as u8);
        write!(f, "#{r:02x}{g:02x}{b:02x}")?;
        if a == 255 { Ok(()) } else { write!(f, "{a:02x}") }
    }
}

/// Where the colour of an object's surface comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BaseColor {
    /// The element's colour (CPK as Jmol has it).
    Element,
    /// One colour per chain.
    Chain,
    /// One colour per residue type.
    Residue,
    /// One colour per part of a mesh.
    Part,
    /// The material that came with the mesh.
    Material,
    /// One colour for all.
    Color(Srgba),
}

impl BaseColor {
    /// The sources of colour by name; anything else is a colour.
    pub const NAMES: [&str; 5] = ["element", "chain", "residue", "part", "material"];

    /// The source of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        let sources = [Self::Element, Self::Chain, Self::Residue, Self::Part, Self::Material];
        Self::NAMES.iter().position(|n| *n == name).map(|i| sources[i])
    }
}

impl fmt::Display for BaseColor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Element => f.write_str("element"),
            Self::Chain => f.write_str("chain"),
            Self::Residue => f.write_str("residue"),
            Self::Part => f.write_str("part"),
            Self::Material => f.write_str("material"),
            Self::Color(color) => color.fmt(f),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hex_and_names_are_read() {
        let red = Srgba::from_bytes([255, 0, 0]);
        for text in ["#f00", "#FF0000", "#ff0000ff", "red", "Red", " red "] {
            assert_eq!(Srgba::parse(text), Some(red), "{text}");
        }
        assert_eq!(Srgba::parse("#c0392b").map(|c| c.to_string()).as_deref(), Some("#c0392b"));
        assert_eq!(Srgba::parse("#c0392b80").map(|c| c.to_string()).as_deref(), Some("#c0392b80"));
        assert_eq!(Srgba::parse("transparent").map(|c| c.rgba[3]), Some(0.0));
    }

    #[test]
    fn the_wider_css_syntax_is_refused() {
        for text in
            ["", "#", "#12", "#12345", "abc", "123456", "fade", "rgb(1,2,3)", "hsl(0,0%,0%)", "redd", "#\u{e9}00"]
        {
            assert_eq!(Srgba::parse(text), None, "{text}");
        }
    }

    #[test]
    fn linear_light_has_known_values() {
        let [black, grey, white, alpha] = Srgba { rgba: [0.0, 0.5, 1.0, 0.25] }.to_linear();
        assert_eq!((black, white, alpha), (0.0, 1.0, 0.25));
        assert!((grey - 0.214_041_14).abs() < 1e-6);
    }

    #[test]
    fn every_source_of_colour_has_its_name() {
        for name in BaseColor::NAMES {
            assert_eq!(BaseColor::from_name(name).map(|c| c.to_string()).as_deref(), Some(name));
        }
    }
}
