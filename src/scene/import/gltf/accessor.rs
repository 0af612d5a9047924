//! Typed views into buffers [Gltf2 §3.6.2]. Whether the bytes are really there is checked when a view is made, in 64 bits;
//! nothing is read or allocated by what the file announces.

use serde_json::Value;

use super::Document;
use super::json::{EXPORT_AGAIN, list, text, whole};

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of_code(code: u64) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    const fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

/// Elements at a constant distance; that all of them are there was checked.
#[derive(Clone, Copy)]
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// Elements that replace others.
struct Sparse<'a> {
    /// Which are replaced, each with its number in `values`; sorted.
    places: Vec<(u32, u32)>,
    values: Strided<'a>,
}

/// A list of elements in a buffer.
pub(super) struct Accessor<'a> {
    /// How many elements it has.
    pub(super) count: usize,
    /// Numbers in each.
    pub(super) components: usize,
    /// How they are stored.
    pub(super) component: Component,
    normalized: bool,
    /// None where all elements are zero.
    base: Option<Strided<'a>>,
    sparse: Option<Sparse<'a>>,
}

impl Accessor<'_> {
    /// Whether the file holds any of its elements; those of others are zero.
    pub(super) fn has_values(&self) -> bool {
        self.base.is_some() || self.sparse.is_some()
    }

    /// The same numbers, integers as shares: colours can be nothing else, though exporters forget to say so.
    pub(super) fn into_share(mut self) -> Self {
        self.normalized = true;
        self
    }

    /// Element `index`, as numbers; zeros for what it does not have.
    #[inline]
    pub(super) fn floats<const N: usize>(&self, index: usize) -> [f64; N] {
        let bytes = self.element(index);
        let size = self.component.bytes();
        let mut numbers = [0.0; N];
        for (number, bytes) in numbers.iter_mut().zip(bytes.chunks_exact(size).take(self.components)) {
            *number = self.number(bytes);
        }
        numbers
    }

    /// Element `index` of a list of indices.
    #[inline]
    pub(super) fn index(&self, index: usize) -> u32 {
        match (self.component, self.element(index)) {
            (Component::U8, &[byte, ..]) => u32::from(byte),
            (Component::U16, &[a, b, ..]) => u32::from(u16::from_le_bytes([a, b])),
            (Component::U32, &[a, b, c, d, ..]) => u32::from_le_bytes([a, b, c, d]),
            _ => 0,
        }
    }

    #[inline]
    fn element(&self, index: usize) -> &[u8] {
        if let Some(sparse) = &self.sparse
            && let found = sparse.places.partition_point(|&(place, _)| (place as usize) < index)
            && let Some(&(place, number)) = sparse.places.get(found)
            && place as usize == index
        {
            return sparse.values.bytes.get(number as usize * sparse.values.stride..).unwrap_or_default();
        }
        let base = self.base.and_then(|base| base.bytes.get(index.checked_mul(base.stride)?..));
        base.unwrap_or_default()
    }

    /// One number; integers that stand for 0..1 or -1..1 are divided by their largest [Gltf2 §3.11].
    #[inline]
    fn number(&self, bytes: &[u8]) -> f64 {
        let (value, largest) = match (self.component, bytes) {
            (Component::F32, &[a, b, c, d]) => return f64::from(f32::from_le_bytes([a, b, c, d])),
            (Component::I8, &[a]) => (f64::from(a as i8), 127.0),
            (Component::U8, &[a]) => (f64::from(a), 255.0),
            (Component::I16, &[a, b]) => (f64::from(i16::from_le_bytes([a, b])), 32_767.0),
            (Component::U16, &[a, b]) => (f64::from(u16::from_le_bytes([a, b])), 65_535.0),
            (Component::U32, &[a, b, c, d]) => (f64::from(u32::from_le_bytes([a, b, c, d])), 4_294_967_295.0),
            _ => return 0.0,
        };
        if self.normalized { (value / largest).max(-1.0) } else { value }
    }
}

impl Document<'_> {
    /// The accessor of a number.
    ///
    /// # Errors
    /// In words, if it, its view or its buffer does not exist, or the buffer ends before it.
    pub(super) fn accessor(&self, index: u64) -> Result<Accessor<'_>, String> {
        let place = format!("accessors[{index}]");
        let json = entry(list(&self.json, "accessors", "")?, index)
            .ok_or_else(|| format!("{place} is used but does not exist; {EXPORT_AGAIN}"))?;
        let count = whole(json, "count", &place)?.unwrap_or(0);
        let code = whole(json, "componentType", &place)?.unwrap_or(0);
        let component = Component::of_code(code)
            .ok_or_else(|| format!("{place}.componentType is {code}, which does not exist; {EXPORT_AGAIN}"))?;
        let components = match text(json, "type") {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => return Err(format!("{place}.type is none that vertices can have; {EXPORT_AGAIN}")),
        };
        let size = component.bytes() * components;
        let base = match whole(json, "bufferView", &place)? {
            Some(view) => {
                let offset = whole(json, "byteOffset", &place)?.unwrap_or(0);
                Some(self.strided(view, offset, count, size, &place)?)
            }
            None => None,
        };
        let sparse = match json.get("sparse") {
            Some(sparse) => Some(self.sparse(sparse, size, &format!("{place}.sparse"))?),
            None => None,
        };
        let count = usize::try_from(count).map_err(|_| format!("{place}.count is {count}; {EXPORT_AGAIN}"))?;
        let normalized = json.get("normalized").and_then(Value::as_bool).unwrap_or(false);
        Ok(Accessor { count, components, component, normalized, base, sparse })
    }

    fn sparse(&self, json: &Value, size: usize, place: &str) -> Result<Sparse<'_>, String> {
        let nothing = Value::Null;
        let count = whole(json, "count", place)?.unwrap_or(0);
        let part = |key: &str| (json.get(key).unwrap_or(&nothing), format!("{place}.{key}"));
        let view = |(part, place): &(&Value, String), size: usize| {
            let view = whole(part, "bufferView", place)?
                .ok_or_else(|| format!("{place}.bufferView is missing; {EXPORT_AGAIN}"))?;
            let offset = whole(part, "byteOffset", place)?.unwrap_or(0);
            self.strided(view, offset, count, size, place)
        };
        let indices = part("indices");
        let code = whole(indices.0, "componentType", &indices.1)?.unwrap_or(0);
        let component = Component::of_code(code)
            .filter(|component| matches!(component, Component::U8 | Component::U16 | Component::U32))
            .ok_or_else(|| format!("{}.componentType is {code}, which is no index; {EXPORT_AGAIN}", indices.1))?;
        let base = Some(view(&indices, component.bytes())?);
        let values = view(&part("values"), size)?;
        // The bytes of `count` indices are there, so it is no more than the file's size.
        let count = count as usize;
        let indices = Accessor { count, components: 1, component, normalized: false, base, sparse: None };
        let mut places: Vec<(u32, u32)> = (0..count).map(|i| (indices.index(i), i as u32)).collect();
        places.sort_unstable();
        Ok(Sparse { places, values })
    }

    /// `count` elements of `size` bytes in a view of a buffer.
    fn strided(&self, view: u64, offset: u64, count: u64, size: usize, user: &str) -> Result<Strided<'_>, String> {
        let place = format!("bufferViews[{view}]");
        let json = entry(list(&self.json, "bufferViews", "")?, view)
            .ok_or_else(|| format!("{place} is used by {user} but does not exist; {EXPORT_AGAIN}"))?;
        let number = |key: &str| whole(json, key, &place);
        let buffer = number("buffer")?.unwrap_or(0);
        let bytes = match entry(&self.buffers, buffer) {
            Some(Ok(bytes)) => bytes,
            Some(Err(why)) => return Err(why.clone()),
            None => return Err(format!("buffer {buffer} is used by {place} but does not exist; {EXPORT_AGAIN}")),
        };
        let start = number("byteOffset")?.unwrap_or(0);
        let length = number("byteLength")?.unwrap_or(0);
        let end = start.checked_add(length).filter(|&end| end <= bytes.len() as u64);
        let Some(end) = end else {
            return Err(format!(
                "{place} ends at byte {} of buffer {buffer}, which has {}; it was cut short: get it again",
                u128::from(start) + u128::from(length),
                bytes.len()
            ));
        };
        let stride = number("byteStride")?.filter(|&stride| stride > 0).unwrap_or(size as u64);
        let needed = match count {
            0 => 0,
            _ => u128::from(offset) + u128::from(count - 1) * u128::from(stride) + size as u128,
        };
        if needed > u128::from(length) {
            return Err(format!(
                "{user} needs {needed} bytes of {place}, which has {length}; {EXPORT_AGAIN}, or get it again"
            ));
        }
        // All of these are below the buffer's length, unless there is no element.
        let bytes = bytes.get(start as usize..end as usize).unwrap_or_default();
        Ok(Strided { bytes: bytes.get(offset as usize..).unwrap_or_default(), stride: stride as usize })
    }
}

/// An entry of a list by a number of the file.
pub(super) fn entry<T>(values: &[T], index: u64) -> Option<&T> {
    values.get(usize::try_from(index).ok()?)
}
