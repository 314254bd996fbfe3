//! Accessors: typed lists inside buffers, checked before they are read.

use super::compressed::{Decoded, Plain};
use super::source::GltfSource;
use super::{buffers::Buffer, container::Container, json};
use crate::{Fault, budget};
use serde_json::Value;

/// A document with its bytes.
#[derive(Clone, Copy)]
pub(super) struct Data<'a> {
    pub(super) document: &'a Value,
    pub(super) buffers: &'a [Buffer],
    pub(super) container: &'a Container,
    pub(super) decoded: &'a Decoded,
}

impl<'a> From<&'a GltfSource> for Data<'a> {
    fn from(source: &'a GltfSource) -> Self {
        let GltfSource { document, buffers, container, decoded, .. } = source;
        Data { document, buffers, container, decoded }
    }
}

/// How one number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(code: u64) -> Option<Component> {
        Some(match code {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return None,
        })
    }

    pub(super) fn size(self) -> u64 {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// The number at the start of `b`, with the divisor that normalization applies.
    fn read(self, b: &[u8]) -> (f64, f64) {
        match self {
            Component::I8 => (f64::from(b[0] as i8), 127.0),
            Component::U8 => (f64::from(b[0]), 255.0),
            Component::I16 => (f64::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
            Component::U16 => (f64::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
            Component::U32 => (f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])), 1.0),
            Component::F32 => (f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])), 1.0),
        }
    }
}

impl Component {
    /// The number at the start of `b`, as it is stored.
    pub(super) fn stored(self, b: &[u8]) -> f64 {
        self.read(b).0
    }

    /// Appends a number as it is stored, the nearest that can be.
    pub(super) fn write(self, number: f64, out: &mut Vec<u8>) {
        match self {
            Component::I8 => out.extend((number as i8).to_le_bytes()),
            Component::U8 => out.push(number as u8),
            Component::I16 => out.extend((number as i16).to_le_bytes()),
            Component::U16 => out.extend((number as u16).to_le_bytes()),
            Component::U32 => out.extend((number as u32).to_le_bytes()),
            Component::F32 => out.extend((number as f32).to_le_bytes()),
        }
    }
}

/// Bytes of a view, and how far apart its elements are where it says so.
pub(super) struct ViewBytes<'a> {
    pub(super) bytes: &'a [u8],
    stride: Option<u64>,
}

/// Bytes that hold `count` elements, every one of them inside.
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// A checked accessor: reading it cannot fail.
pub(super) struct Accessor<'a> {
    pub(super) component: Component,
    /// Numbers in an element.
    pub(super) width: usize,
    pub(super) count: usize,
    normalized: bool,
    dense: Option<Strided<'a>>,
    sparse: Option<(Vec<u32>, Strided<'a>)>,
}

impl<'a> Data<'a> {
    /// Checks an accessor of numbers or vectors.
    pub(super) fn accessor(self, index: usize) -> Result<Accessor<'a>, Fault> {
        let types = [("SCALAR", 1), ("VEC2", 2), ("VEC3", 3), ("VEC4", 4)];
        self.accessor_of(index, &types, "SCALAR, VEC2, VEC3 or VEC4")
    }

    /// Checks an accessor of matrices, 16 numbers each, column by column.
    pub(super) fn matrices(self, index: usize) -> Result<Accessor<'a>, Fault> {
        let checked = self.accessor_of(index, &[("MAT4", 16)], "MAT4")?;
        // Columns of shorter types are padded, which the format allows for no matrix of vertices.
        if checked.component != Component::F32 {
            return Err(Fault::at(format!("accessor {index}"), "matrices are not floating-point numbers"));
        }
        Ok(checked)
    }

    /// Component type, numbers in an element and number of elements as an accessor states them.
    pub(super) fn declared(self, index: usize) -> Result<(Component, usize, usize), Fault> {
        let types = [("SCALAR", 1), ("VEC2", 2), ("VEC3", 3), ("VEC4", 4)];
        let (_, declared) = self.declared_of(index, &types, "SCALAR, VEC2, VEC3 or VEC4")?;
        Ok(declared)
    }

    fn declared_of(
        self,
        index: usize,
        types: &[(&str, usize)],
        words: &str,
    ) -> Result<(&'a Value, (Component, usize, usize)), Fault> {
        let place = format!("accessor {index}");
        let accessors = json::list(self.document, "accessors")?;
        let accessor = accessors
            .get(index)
            .ok_or_else(|| Fault::at(place.as_str(), format!("does not exist, the file has {}", accessors.len())))?;
        let code = json::number(accessor, "componentType", &place)?.unwrap_or(0);
        let component = Component::of(code)
            .ok_or_else(|| Fault::at(place.as_str(), format!("component type {code} is not known")))?;
        let named = accessor.get("type").and_then(Value::as_str);
        let width = types.iter().find(|(name, _)| Some(*name) == named);
        let width = width.ok_or_else(|| Fault::at(place.as_str(), format!("its type is not {words}")))?.1;
        let count = json::number(accessor, "count", &place)?.unwrap_or(0);
        budget::check("elements in an accessor", count, budget::CORNERS)?;
        Ok((accessor, (component, width, count as usize)))
    }

    fn accessor_of(self, index: usize, types: &[(&str, usize)], words: &str) -> Result<Accessor<'a>, Fault> {
        let place = format!("accessor {index}");
        let (accessor, (component, width, count)) = self.declared_of(index, types, words)?;
        // Floating-point numbers are what they are, and so are 32-bit ones: the flag is for shorter types only.
        let short = !matches!(component, Component::U32 | Component::F32);
        let normalized = short && accessor.get("normalized") == Some(&Value::Bool(true));
        if let Some(Plain { component, count, bytes }) = self.decoded.accessor(index) {
            let dense = Some(Strided { bytes, stride: width * component.size() as usize });
            return Ok(Accessor { component: *component, width, count: *count, normalized, dense, sparse: None });
        }
        let size = component.size() * width as u64;
        let offset = json::number(accessor, "byteOffset", &place)?.unwrap_or(0);
        let dense = match accessor.get("bufferView") {
            // Zeros out of nothing: no file behind them bounds their number.
            None => {
                budget::check("elements in an accessor without data", count as u64, budget::VERTICES)?;
                None
            }
            Some(_) => Some(self.strided(accessor, &place, offset, size, count as u64)?),
        };
        let sparse = match accessor.get("sparse") {
            None => None,
            Some(sparse) => Some(self.sparse(sparse, &place, size, count as u64)?),
        };
        Ok(Accessor { component, width, count, normalized, dense, sparse })
    }

    fn sparse(self, sparse: &Value, place: &str, size: u64, count: u64) -> Result<(Vec<u32>, Strided<'a>), Fault> {
        let place = format!("{place}, sparse");
        let n = json::number(sparse, "count", &place)?.unwrap_or(0);
        if n > count {
            return Err(Fault::at(place, format!("replaces {n} elements of {count}")));
        }
        let part = |key| sparse.get(key).ok_or_else(|| Fault::at(place.as_str(), format!("has no {key}")));
        let (indices, values) = (part("indices")?, part("values")?);
        let code = json::number(indices, "componentType", &place)?.unwrap_or(0);
        let component = Component::of(code)
            .filter(|c| matches!(c, Component::U8 | Component::U16 | Component::U32))
            .ok_or_else(|| Fault::at(place.as_str(), format!("index type {code} is not unsigned")))?;
        let offset = json::number(indices, "byteOffset", &place)?.unwrap_or(0);
        let at = self.strided(indices, &place, offset, component.size(), n)?;
        let offset = json::number(values, "byteOffset", &place)?.unwrap_or(0);
        let values = self.strided(values, &place, offset, size, n)?;
        let mut targets = Vec::with_capacity(n as usize);
        for i in 0..n as usize {
            let target = component.read(&at.bytes[i * at.stride..]).0 as u32;
            if u64::from(target) >= count {
                return Err(Fault::at(place, format!("replaces element {target} of {count}")));
            }
            targets.push(target);
        }
        Ok((targets, values))
    }

    /// The bytes of `count` elements of `size` bytes from `offset` in the view that `holder` names.
    fn strided(self, holder: &Value, place: &str, offset: u64, size: u64, count: u64) -> Result<Strided<'a>, Fault> {
        let views = json::list(self.document, "bufferViews")?;
        let index = json::reference(holder, "bufferView", place, "view", views.len())?
            .ok_or_else(|| Fault::at(place, "names no bufferView"))?;
        let ViewBytes { bytes, stride } = self.view(index, place)?;
        let (stride, length) = (stride.unwrap_or(size), bytes.len() as u64);
        if stride < size || stride > 252.max(size) {
            let problem = format!("byteStride {stride} does not fit elements of {size} bytes");
            return Err(Fault::at(format!("bufferView {index}"), problem));
        }
        let needed = match count {
            0 => Some(offset),
            _ => (count - 1).checked_mul(stride).and_then(|n| n.checked_add(size)).and_then(|n| n.checked_add(offset)),
        };
        if needed.is_none_or(|needed| needed > length) {
            return Err(Fault::at(place, format!("reaches beyond bufferView {index} of {length} bytes")));
        }
        Ok(Strided { bytes: &bytes[offset as usize..], stride: stride as usize })
    }

    /// The bytes of a view, decoded where it is compressed.
    pub(super) fn view(self, index: usize, place: &str) -> Result<ViewBytes<'a>, Fault> {
        let views = json::list(self.document, "bufferViews")?;
        let view = views.get(index).ok_or_else(|| Fault::at(place, format!("names no view: {index}")))?;
        let place = format!("bufferView {index}");
        let stride = json::number(view, "byteStride", &place)?;
        if let Some(decoded) = self.decoded.view(index) {
            let bytes = decoded.map_err(|fault| Fault::Container(fault.to_owned()))?;
            return Ok(ViewBytes { bytes, stride });
        }
        let buffer = json::reference(view, "buffer", &place, "buffer", self.buffers.len())?;
        let buffer = buffer.ok_or_else(|| Fault::at(place.as_str(), "names no buffer"))?;
        let start = json::number(view, "byteOffset", &place)?.unwrap_or(0);
        let length = json::number(view, "byteLength", &place)?.unwrap_or(0);
        Ok(ViewBytes { bytes: self.range(buffer, start, length, &place)?, stride })
    }

    /// `length` bytes of a buffer from `start`.
    pub(super) fn range(self, buffer: usize, start: u64, length: u64, place: &str) -> Result<&'a [u8], Fault> {
        let bytes = self.buffers[buffer].bytes(self.container);
        let end = start.checked_add(length).filter(|&end| end <= bytes.len() as u64);
        end.map(|end| &bytes[start as usize..end as usize])
            .ok_or_else(|| Fault::at(place, format!("reaches beyond its buffer of {} bytes", bytes.len())))
    }
}

impl Accessor<'_> {
    /// Whether its numbers are in the file; otherwise they are zeros but for the sparse ones.
    pub(super) fn has_data(&self) -> bool {
        self.dense.is_some()
    }

    /// The same numbers as fractions, when they are of a short type: those of weights and of animations are never meant
    /// as they stand, and not every writer sets the flag.
    pub(super) fn in_fractions(mut self) -> Self {
        self.normalized = !matches!(self.component, Component::U32 | Component::F32);
        self
    }

    /// The same without what is behind the first `n` elements.
    pub(super) fn first(mut self, n: usize) -> Self {
        self.count = self.count.min(n);
        self
    }

    /// How many elements it took to check the accessor.
    pub(super) fn n_checked(&self) -> usize {
        self.sparse.as_ref().map_or(0, |(targets, _)| targets.len())
    }

    /// All numbers, element after element, normalized ones as fractions.
    pub(super) fn numbers(&self) -> Vec<f64> {
        let mut numbers = match &self.dense {
            None => vec![0.0; self.count * self.width],
            Some(dense) => {
                let mut numbers = Vec::with_capacity(self.count * self.width);
                for i in 0..self.count {
                    self.push_element(&dense.bytes[i * dense.stride..], &mut numbers);
                }
                numbers
            }
        };
        if let Some((targets, values)) = &self.sparse {
            let mut element = Vec::with_capacity(self.width);
            for (i, &target) in targets.iter().enumerate().filter(|&(_, &target)| (target as usize) < self.count) {
                element.clear();
                self.push_element(&values.bytes[i * values.stride..], &mut element);
                let at = target as usize * self.width;
                numbers[at..at + self.width].copy_from_slice(&element);
            }
        }
        numbers
    }

    fn push_element(&self, bytes: &[u8], out: &mut Vec<f64>) {
        for k in 0..self.width {
            let (number, divisor) = self.component.read(&bytes[k * self.component.size() as usize..]);
            out.push(if self.normalized { (number / divisor).max(-1.0) } else { number });
        }
    }
}
