//! Accessors, views and data to be put into a document.

use super::relocate::data_uri;
use serde_json::{Value, json};

/// A view that vertex attributes are read from.
const ATTRIBUTES: u32 = 34962;
/// A view that indices are read from.
const INDICES: u32 = 34963;

/// Collects accessors and their data, numbered behind those that a document has.
#[derive(Default)]
pub(super) struct Builder {
    n_accessors: usize,
    n_views: usize,
    buffer: usize,
    /// Length of what is in the buffer already.
    start: usize,
    pub(super) accessors: Vec<Value>,
    pub(super) views: Vec<Value>,
    pub(super) data: Vec<u8>,
}

impl Builder {
    /// For what is to be appended to a document: to the binary chunk that is given, or else to a new buffer inside it.
    pub(super) fn after(document: &Value, chunk: Option<&[u8]>) -> Builder {
        let n = |key: &str| document.get(key).and_then(Value::as_array).map_or(0, Vec::len);
        let (buffer, start) = chunk.map_or((n("buffers"), 0), |chunk| (0, chunk.len()));
        let start = start.next_multiple_of(4);
        Builder { n_accessors: n("accessors"), n_views: n("bufferViews"), buffer, start, ..Builder::default() }
    }

    fn push(
        &mut self,
        bytes: &[u8],
        target: impl Into<Option<u32>>,
        stride: Option<u32>,
        mut accessor: Value,
    ) -> usize {
        self.data.resize(self.data.len().next_multiple_of(4), 0);
        let offset = self.start + self.data.len();
        let mut view = json!({"buffer": self.buffer, "byteOffset": offset, "byteLength": bytes.len()});
        if let Some(stride) = stride {
            view["byteStride"] = stride.into();
        }
        if let Some(target) = target.into() {
            view["target"] = target.into();
        }
        accessor["bufferView"] = (self.n_views + self.views.len()).into();
        self.views.push(view);
        self.data.extend_from_slice(bytes);
        self.accessors.push(accessor);
        self.n_accessors + self.accessors.len() - 1
    }

    /// Vectors of `width` numbers, with the least and largest of each where `bounds` are wanted.
    pub(super) fn floats(&mut self, numbers: &[f32], width: usize, bounds: bool) -> usize {
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][width - 1];
        let mut accessor = json!({"componentType": 5126, "count": numbers.len() / width, "type": kind});
        if bounds {
            let of = |pick: fn(f32, f32) -> f32| -> Vec<f64> {
                let column = |k: usize| numbers.iter().skip(k).step_by(width).copied().reduce(pick);
                (0..width).map(|k| f64::from(column(k).unwrap_or(0.0))).collect()
            };
            accessor["min"] = of(f32::min).into();
            accessor["max"] = of(f32::max).into();
        }
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.push(&bytes, ATTRIBUTES, None, accessor)
    }

    /// Numbers of animations, which no vertex attribute reads, with the least and largest where `bounds` are wanted.
    pub(super) fn keys(&mut self, numbers: &[f32], bounds: bool) -> usize {
        let mut accessor = json!({"componentType": 5126, "count": numbers.len(), "type": "SCALAR"});
        if bounds {
            let of = |pick: fn(f32, f32) -> f32| f64::from(numbers.iter().copied().reduce(pick).unwrap_or(0.0));
            (accessor["min"], accessor["max"]) = (json!([of(f32::min)]), json!([of(f32::max)]));
        }
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.push(&bytes, None, None, accessor)
    }

    /// So many vectors of three zeros. They are written out: not every program reads accessors without data.
    pub(super) fn zeros(&mut self, count: usize) -> usize {
        self.floats(&vec![0.0; 3 * count], 3, true)
    }

    /// Sixteen-bit numbers four bytes apart: vertex attributes begin at multiples of four.
    pub(super) fn rigidity(&mut self, r: &[u16]) -> usize {
        let bytes: Vec<u8> = r.iter().flat_map(|r| u32::from(*r).to_le_bytes()).collect();
        self.push(&bytes, ATTRIBUTES, Some(4), json!({"componentType": 5123, "count": r.len(), "type": "SCALAR"}))
    }

    /// Vertex attributes as they are stored, in elements of so many bytes, for an accessor that says the rest.
    pub(super) fn stored(&mut self, bytes: &[u8], size: usize, accessor: Value) -> usize {
        let stride = size.next_multiple_of(4);
        if stride == size {
            return self.push(bytes, ATTRIBUTES, None, accessor);
        }
        let mut spaced = Vec::with_capacity(bytes.len() / size * stride);
        for element in bytes.chunks_exact(size) {
            spaced.extend_from_slice(element);
            spaced.resize(spaced.len().next_multiple_of(4), 0);
        }
        self.push(&spaced, ATTRIBUTES, Some(stride as u32), accessor)
    }

    /// Indices in the shortest type that spares the largest number, which means 'restart'.
    pub(super) fn indices(&mut self, indices: &[u32]) -> usize {
        let short = indices.iter().all(|&index| index < u32::from(u16::MAX));
        let (kind, bytes): (u32, Vec<u8>) = if short {
            (5123, indices.iter().flat_map(|&i| (i as u16).to_le_bytes()).collect())
        } else {
            (5125, indices.iter().flat_map(|i| i.to_le_bytes()).collect())
        };
        self.push(&bytes, INDICES, None, json!({"componentType": kind, "count": indices.len(), "type": "SCALAR"}))
    }

    /// Appends everything to the document, and to the binary chunk it was begun after.
    pub(super) fn attach(self, document: &mut Value, chunk: Option<&mut Vec<u8>>) {
        extend(document, "accessors", self.accessors);
        if self.data.is_empty() {
            return;
        }
        extend(document, "bufferViews", self.views);
        match chunk {
            Some(chunk) => {
                chunk.resize(self.start, 0);
                chunk.extend_from_slice(&self.data);
                let length = Value::from(chunk.len());
                match document.pointer_mut("/buffers/0").and_then(Value::as_object_mut) {
                    Some(buffer) => {
                        buffer.insert("byteLength".into(), length);
                    }
                    None => extend(document, "buffers", vec![json!({"byteLength": length})]),
                }
            }
            None => {
                let uri = data_uri("application/octet-stream", &self.data);
                extend(document, "buffers", vec![json!({"byteLength": self.data.len(), "uri": uri})]);
            }
        }
    }
}

/// Appends to a list of the document, which appears if it was not there.
fn extend(document: &mut Value, key: &str, items: Vec<Value>) {
    if items.is_empty() {
        return;
    }
    match document.get_mut(key).and_then(Value::as_array_mut) {
        Some(list) => list.extend(items),
        None => document[key] = items.into(),
    }
}
