//! Decoder of the extensions `EXT_meshopt_compression` and `KHR_meshopt_compression`, which compress single views.
//!
//! Written from the text of the latter, whose first version of each stream is the former's. What a stream may hold is
//! checked byte by byte: a broken one gives an error, and room is made only for what is really decoded.
//!
//! The crates that exist either bind the C++ original or had been in the registry for weeks only when this was written.

mod attributes;
mod filters;
mod indices;
#[cfg(test)]
mod tests;

use super::super::json;
use crate::Fault;
use serde_json::Value;

/// Names of the extension.
pub(in super::super) const EXTENSIONS: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// The extension's object in a view or a buffer.
pub(in super::super) fn extension(object: &Value) -> Option<&Value> {
    let extensions = object.get("extensions")?;
    EXTENSIONS.iter().find_map(|name| extensions.get(name))
}

/// How a view is compressed.
pub(super) struct View {
    pub(super) buffer: usize,
    pub(super) offset: u64,
    pub(super) length: u64,
    stride: usize,
    count: usize,
    mode: Mode,
    filter: Filter,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Filter {
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl View {
    /// Reads and checks the extension of a view.
    pub(super) fn of(extension: &Value, place: &str, n_buffers: usize) -> Result<View, Fault> {
        let fault = |problem: String| Fault::at(place, problem);
        let needed = |key| json::number(extension, key, place)?.ok_or_else(|| fault(format!("has no {key}")));
        let buffer = json::reference(extension, "buffer", place, "buffer", n_buffers)?;
        let text = |key| extension.get(key).and_then(Value::as_str);
        let mode = match text("mode") {
            Some("ATTRIBUTES") => Mode::Attributes,
            Some("TRIANGLES") => Mode::Triangles,
            Some("INDICES") => Mode::Indices,
            _ => return Err(fault("its mode is not ATTRIBUTES, TRIANGLES or INDICES".into())),
        };
        let filter = match text("filter").unwrap_or("NONE") {
            "NONE" => Filter::None,
            "OCTAHEDRAL" => Filter::Octahedral,
            "QUATERNION" => Filter::Quaternion,
            "EXPONENTIAL" => Filter::Exponential,
            "COLOR" => Filter::Color,
            other => return Err(fault(format!("filter {} is not known", crate::rigidity::quoted(other)))),
        };
        let (stride, count) = (needed("byteStride")?, needed("count")?);
        let fits = match (mode, filter) {
            (Mode::Attributes, Filter::Octahedral | Filter::Color) => stride == 4 || stride == 8,
            (Mode::Attributes, Filter::Quaternion) => stride == 8,
            (Mode::Attributes, _) => stride % 4 == 0 && (4..=256).contains(&stride),
            (_, Filter::None) => stride == 2 || stride == 4,
            _ => false,
        };
        if !fits {
            return Err(fault(format!("byteStride {stride} does not fit its mode and filter")));
        }
        if mode == Mode::Triangles && count % 3 != 0 {
            return Err(fault(format!("{count} indices are no triangles")));
        }
        Ok(View {
            buffer: buffer.ok_or_else(|| fault("names no buffer".into()))?,
            offset: json::number(extension, "byteOffset", place)?.unwrap_or(0),
            length: needed("byteLength")?,
            stride: stride as usize,
            count: usize::try_from(count).map_err(|_| fault("count is too large".into()))?,
            mode,
            filter,
        })
    }

    /// Bytes it decodes to.
    pub(super) fn decoded_bytes(&self) -> u64 {
        (self.count as u64).saturating_mul(self.stride as u64)
    }

    /// Decodes the view's bytes.
    pub(super) fn decode(&self, bytes: &[u8]) -> Result<Vec<u8>, &'static str> {
        match self.mode {
            Mode::Attributes => {
                let mut decoded = attributes::decode(bytes, self.count, self.stride)?;
                match self.filter {
                    Filter::None => {}
                    Filter::Octahedral => filters::octahedral(&mut decoded, self.stride),
                    Filter::Quaternion => filters::quaternion(&mut decoded),
                    Filter::Exponential => filters::exponential(&mut decoded),
                    Filter::Color => filters::color(&mut decoded, self.stride),
                }
                Ok(decoded)
            }
            Mode::Triangles => indices::triangles(bytes, self.count, self.stride),
            Mode::Indices => indices::sequence(bytes, self.count, self.stride),
        }
    }
}

/// What is left of a stream.
struct Stream<'a>(&'a [u8]);

impl<'a> Stream<'a> {
    fn take(&mut self, n: usize) -> Result<&'a [u8], &'static str> {
        let (taken, rest) = self.0.split_at_checked(n).ok_or("breaks off")?;
        self.0 = rest;
        Ok(taken)
    }

    fn byte(&mut self) -> Result<u8, &'static str> {
        Ok(self.take(1)?[0])
    }

    /// A number in groups of seven bits, the lowest first; what is beyond 32 bits is dropped.
    fn varint(&mut self) -> Result<u32, &'static str> {
        let mut value = 0;
        for group in 0..5 {
            let byte = self.byte()?;
            value |= u32::from(byte & 0x7f).wrapping_shl(7 * group);
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err("holds a number of more than five bytes")
    }

    fn end(&self) -> Result<(), &'static str> {
        if self.0.is_empty() { Ok(()) } else { Err("holds more than its elements") }
    }
}
