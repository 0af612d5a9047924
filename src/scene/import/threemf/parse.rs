//! A `.model` entry, read element by element [ThreeMfCore §3-5].

use std::io::BufRead;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use quick_xml::events::attributes::Attribute;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::super::lines::quote;
use super::super::number::{ABSURD, float};
use super::super::tree_path::short_name;
use super::model::{Group, Model, Object, Placement, Property};
use crate::scene::mesh::MeshMaterial;
use crate::scene::report::{NoteKind, Report};

/// Elements within each other; the format needs six.
const MAX_DEPTH: usize = 256;

/// Elements that are read, each known by its name and the one around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Tag {
    Model,
    Resources,
    BaseMaterials,
    Base,
    ColorGroup,
    Color,
    Texture,
    Object,
    Mesh,
    Vertices,
    Vertex,
    Triangles,
    Triangle,
    Components,
    Component,
    Build,
    Item,
    Other,
}

impl Tag {
    fn of(parent: Option<Self>, name: &str) -> Self {
        match (parent, name) {
            (None, "model") => Self::Model,
            (Some(Self::Model), "resources") => Self::Resources,
            (Some(Self::Model), "build") => Self::Build,
            (Some(Self::Build), "item") => Self::Item,
            (Some(Self::Resources), "object") => Self::Object,
            (Some(Self::Resources), "basematerials") => Self::BaseMaterials,
            (Some(Self::Resources), "colorgroup") => Self::ColorGroup,
            (Some(Self::Resources), "texture2d") => Self::Texture,
            (Some(Self::BaseMaterials), "base") => Self::Base,
            (Some(Self::ColorGroup), "color") => Self::Color,
            (Some(Self::Object), "mesh") => Self::Mesh,
            (Some(Self::Object), "components") => Self::Components,
            (Some(Self::Components), "component") => Self::Component,
            (Some(Self::Mesh), "vertices") => Self::Vertices,
            (Some(Self::Mesh), "triangles") => Self::Triangles,
            (Some(Self::Vertices), "vertex") => Self::Vertex,
            (Some(Self::Triangles), "triangle") => Self::Triangle,
            _ => Self::Other,
        }
    }
}

/// What is read so far.
struct Parser<'p> {
    model: Model,
    materials: &'p mut Vec<MeshMaterial>,
    report: &'p mut Report,
    /// Millimetres in the entry's unit.
    millimetres: f64,
    /// The object, group of materials or group of colours around what is read.
    object: Option<(u32, Object)>,
    group: u32,
    is_model: bool,
}

/// Reads an entry; its materials are added to those of the file.
///
/// # Errors
/// In words, without the entry's name: it is no XML, or no model.
pub(super) fn parse(
    entry: impl BufRead,
    materials: &mut Vec<MeshMaterial>,
    report: &mut Report,
) -> Result<Model, String> {
    let model = Model::default();
    let mut parser = Parser { model, materials, report, millimetres: 1.0, object: None, group: 0, is_model: false };
    let mut reader = Reader::from_reader(entry);
    let mut buffer = Vec::new();
    let mut tags: Vec<Tag> = Vec::new();
    loop {
        buffer.clear();
        let event = match reader.read_event_into(&mut buffer) {
            Ok(event) => event,
            Err(error) => return Err(format!("byte {}: {}", reader.error_position(), what_is_wrong(&error))),
        };
        match event {
            Event::Start(element) => {
                let tag = Tag::of(tags.last().copied(), element.local_name().as_ref());
                parser.open(tag, &element);
                if tags.len() >= MAX_DEPTH {
                    return Err(format!("more than {MAX_DEPTH} elements stand in each other; export the file again"));
                }
                tags.push(tag);
            }
            Event::Empty(element) => {
                let tag = Tag::of(tags.last().copied(), element.local_name().as_ref());
                parser.open(tag, &element);
                parser.close(tag);
            }
            Event::End(_) => {
                if let Some(tag) = tags.pop() {
                    parser.close(tag);
                }
            }
            Event::Eof if tags.is_empty() && parser.is_model => return Ok(parser.model),
            Event::Eof if parser.is_model => return Err("it ends too early; get the file again".to_owned()),
            Event::Eof => return Err("it has no <model>; export the file again".to_owned()),
            _ => {}
        }
    }
}

impl Parser<'_> {
    fn open(&mut self, tag: Tag, element: &BytesStart<'_>) {
        match tag {
            Tag::Vertex => self.vertex(element),
            Tag::Triangle => self.triangle(element),
            Tag::Model => self.unit(element),
            Tag::Object => self.begin_object(element),
            Tag::Component | Tag::Item => {
                let placement = self.placement(element);
                match (&mut self.object, tag) {
                    (_, Tag::Item) => self.model.items.push(placement),
                    (Some((_, object)), _) => object.components.push(placement),
                    _ => {}
                }
            }
            Tag::BaseMaterials => {
                self.group = id(element);
                let group = Group::Materials { first: self.materials.len() as u32, count: 0 };
                self.model.groups.insert(self.group, group);
            }
            Tag::ColorGroup => {
                self.group = id(element);
                self.model.groups.insert(self.group, Group::Colors(Vec::new()));
            }
            Tag::Base => self.material(element),
            Tag::Color => {
                let color =
                    attributes(element).find(|(name, _)| *name == "color").map(|(_, value)| color(&value.value));
                let [red, green, blue, _] = self.known_color(color.flatten());
                if let Some(Group::Colors(colors)) = self.model.groups.get_mut(&self.group) {
                    colors.push([red, green, blue]);
                }
            }
            Tag::Texture => self.report.note(NoteKind::TextureNotDrawn, None, String::new),
            _ => {}
        }
    }

    fn close(&mut self, tag: Tag) {
        if tag == Tag::Object
            && let Some((id, object)) = self.object.take()
        {
            self.model.objects.insert(id, object);
        }
    }

    fn unit(&mut self, element: &BytesStart<'_>) {
        self.is_model = true;
        let Some((_, unit)) = attributes(element).find(|(name, _)| *name == "unit") else { return };
        self.millimetres = match unit.value.trim() {
            "micron" => 0.001,
            "millimeter" | "" => return,
            "centimeter" => 10.0,
            "inch" => 25.4,
            "foot" => 304.8,
            "meter" => 1000.0,
            other => {
                self.report.note(NoteKind::UnitUnknown, None, || quote(other.as_bytes()));
                return;
            }
        };
        self.report.note(NoteKind::UnitConverted, None, || unit.value.trim().to_owned());
    }

    fn begin_object(&mut self, element: &BytesStart<'_>) {
        let mut object = Object::default();
        let (mut id, mut group, mut entry) = (0, None, None);
        for (name, value) in attributes(element) {
            match name {
                "id" => id = whole(&value).unwrap_or(0),
                "name" => object.name = text(&value),
                "partnumber" => object.part_number = text(&value),
                "pid" => group = whole(&value),
                "pindex" => entry = whole(&value),
                _ => {}
            }
        }
        object.property = group.map(|group| (group, entry.unwrap_or(0)));
        self.object = Some((id, object));
    }

    fn vertex(&mut self, element: &BytesStart<'_>) {
        let mut position = DVec3::NAN;
        for (name, value) in attributes(element) {
            let axis = match name {
                "x" => 0,
                "y" => 1,
                "z" => 2,
                _ => continue,
            };
            let value = float(value.value.as_bytes()).map(|value| value * self.millimetres);
            position[axis] = value.filter(|value| value.abs() <= ABSURD).unwrap_or(f64::NAN);
        }
        if let Some((_, object)) = &mut self.object {
            object.mesh.positions.push(position);
        }
    }

    fn triangle(&mut self, element: &BytesStart<'_>) {
        let Some((_, object)) = &mut self.object else { return };
        let mut corners = [u32::MAX; 3];
        let (mut group, mut entries) = (None, [None; 3]);
        for (name, value) in attributes(element) {
            let value = whole(&value);
            match name {
                "v1" => corners[0] = value.unwrap_or(u32::MAX),
                "v2" => corners[1] = value.unwrap_or(u32::MAX),
                "v3" => corners[2] = value.unwrap_or(u32::MAX),
                "p1" => entries[0] = value,
                "p2" => entries[1] = value,
                "p3" => entries[2] = value,
                "pid" => group = value,
                _ => {}
            }
        }
        let mesh = &mut object.mesh;
        // Where only the first corner has a property, all have it; where only entries are given, the object has the group.
        if let Some(first) = entries[0]
            && let Some(group) = group.or(object.property.map(|(group, _)| group))
        {
            let corners = [first, entries[1].unwrap_or(first), entries[2].unwrap_or(first)];
            mesh.properties.resize(mesh.triangles.len(), None);
            mesh.properties.push(Some(Property { group, corners }));
        }
        mesh.triangles.push(corners);
    }

    fn placement(&mut self, element: &BytesStart<'_>) -> Placement {
        let parent_from_object = DAffine3::IDENTITY;
        let mut placement = Placement { object: 0, path: None, part_number: String::new(), parent_from_object };
        for (name, value) in attributes(element) {
            match name {
                "objectid" => placement.object = whole(&value).unwrap_or(0),
                "path" => placement.path = Some(text(&value)),
                "partnumber" => placement.part_number = text(&value),
                "transform" => placement.parent_from_object = self.transform(&value.value),
                _ => {}
            }
        }
        placement
    }

    /// Twelve numbers, row by row, of a matrix that stands behind a row [ThreeMfCore §3.3]; NaN where they are not.
    fn transform(&self, text: &str) -> DAffine3 {
        let mut m = [f64::NAN; 12];
        let mut words = text.split_ascii_whitespace();
        for (value, word) in m.iter_mut().zip(&mut words) {
            *value = float(word.as_bytes()).unwrap_or(f64::NAN);
        }
        let row = |at: usize| DVec3::new(m[at], m[at + 1], m[at + 2]);
        DAffine3::from_mat3_translation(DMat3::from_cols(row(0), row(3), row(6)), row(9) * self.millimetres)
    }

    fn material(&mut self, element: &BytesStart<'_>) {
        let (mut name, mut display_color) = (String::new(), None);
        for (key, value) in attributes(element) {
            match key {
                "name" => name = text(&value),
                "displaycolor" => display_color = color(&value.value),
                _ => {}
            }
        }
        let [red, green, blue, alpha] = self.known_color(display_color);
        let base_color = Vec3::from([red, green, blue].map(linear));
        let opacity = match alpha {
            // Some exporters leave the alpha of solid parts at zero.
            0 => {
                self.report.note(NoteKind::InvisibleMended, None, || quote(name.as_bytes()));
                1.0
            }
            alpha => f32::from(alpha) / 255.0,
        };
        self.materials.push(MeshMaterial { name, base_color, metallic: None, roughness: None, opacity });
        if let Some(Group::Materials { count, .. }) = self.model.groups.get_mut(&self.group) {
            *count += 1;
        }
    }

    /// A colour, or white where the file has none that can be read.
    fn known_color(&mut self, color: Option<[u8; 4]>) -> [u8; 4] {
        color.unwrap_or_else(|| {
            self.report.note(NoteKind::ColorUnknown, None, String::new);
            [255; 4]
        })
    }
}

/// What the XML reader says, and the way out.
fn what_is_wrong(error: &quick_xml::Error) -> String {
    match error {
        quick_xml::Error::Io(error) => format!("{error}; get the file again"),
        quick_xml::Error::Encoding(_) => "it is not in UTF-8; export the file again".to_owned(),
        error => {
            let message: String =
                error.to_string().chars().filter(|c| c.is_ascii() && !c.is_ascii_control()).take(120).collect();
            format!("{message}; export the file again")
        }
    }
}

/// Attributes by their names without prefix. Broken ones end the list.
fn attributes<'e>(element: &'e BytesStart<'_>) -> impl Iterator<Item = (&'e str, Attribute<'e>)> {
    let mut all = element.attributes();
    all.with_checks(false);
    all.map_while(Result::ok).map(|attribute| (attribute.key.local_name().into_inner(), attribute))
}

/// The id of a resource; 0 where it has none, which nothing refers to.
fn id(element: &BytesStart<'_>) -> u32 {
    attributes(element).find(|(name, _)| *name == "id").and_then(|(_, value)| whole(&value)).unwrap_or(0)
}

fn whole(value: &Attribute<'_>) -> Option<u32> {
    value.value.trim().parse().ok()
}

/// A value with its entities resolved.
fn text(value: &Attribute<'_>) -> String {
    let text = value.normalized_value(XmlVersion::Explicit1_0).unwrap_or_else(|_| value.value.clone());
    short_name(text.trim()).to_owned()
}

/// `#RRGGBB` or `#RRGGBBAA`.
fn color(text: &str) -> Option<[u8; 4]> {
    let digits = text.trim().strip_prefix('#')?;
    let is_hex = digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    let value = u32::from_str_radix(digits, 16).ok().filter(|_| is_hex)?;
    match digits.len() {
        6 => Some((value << 8 | 0xff).to_be_bytes()),
        8 => Some(value.to_be_bytes()),
        _ => None,
    }
}

/// A share in sRGB as a linear one [IEC61966 §5.2].
fn linear(encoded: u8) -> f32 {
    let encoded = f32::from(encoded) / 255.0;
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_have_three_or_four_bytes() {
        assert_eq!(color("#CAD1EE00"), Some([0xca, 0xd1, 0xee, 0]));
        assert_eq!(color(" #cad1ee"), Some([0xca, 0xd1, 0xee, 255]));
        assert_eq!([color("#cad"), color("red"), color("#+12345"), color("")], [None; 4]);
        assert!((linear(188) - 0.5).abs() < 0.005 && linear(255) == 1.0);
    }
}
