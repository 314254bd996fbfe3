//! Decoder of the extension `KHR_draco_mesh_compression`, which compresses indices and attributes of a primitive.
//!
//! The bitstream is the business of the crate `draco-core`; this file carries its numbers to the accessors that they
//! stand for. The original library is C++.

use super::super::access::{Component, Data};
use super::super::json;
use super::Plain;
use crate::{Fault, budget};
use draco_core::decoder_buffer::DecoderBuffer;
use draco_core::geometry_attribute::PointAttribute;
use draco_core::geometry_indices::PointIndex;
use draco_core::mesh::Mesh;
use draco_core::mesh_decoder::MeshDecoder;
use draco_core::{DataType, decode_limits::DecodeLimits};
use serde_json::Value;
use std::collections::{HashMap, HashSet};

/// Name of the extension.
pub(in super::super) const EXTENSION: &str = "KHR_draco_mesh_compression";

/// Triangles that the streams of any file may hold, and how many more for each of their bytes. A stream of three
/// kilobytes can stand for millions, so that its length alone bounds neither time nor memory: two million took 0.9 s and
/// 130 MB to decode. A wavy sheet was measured to have 5 triangles a byte; beyond 32 there are only large flat ones.
const FACES: u64 = 2_000_000;
const FACES_PER_BYTE: u64 = 32;

/// Decodes every primitive that uses the extension, by accessor.
pub(super) fn decode(data: Data<'_>, purse: &mut budget::Purse) -> Result<HashMap<usize, Plain>, Fault> {
    let mut decoder = Decoder {
        data,
        purse,
        last: None,
        seen: HashSet::new(),
        faces_left: FACES,
        sources: HashMap::new(),
        accessors: HashMap::new(),
    };
    for (m, mesh) in json::list(data.document, "meshes")?.iter().enumerate() {
        let primitives = mesh.get("primitives").and_then(Value::as_array);
        for (p, primitive) in primitives.into_iter().flatten().enumerate() {
            if let Some(extension) = primitive.get("extensions").and_then(|all| all.get(EXTENSION)) {
                decoder.primitive(primitive, extension, &format!("mesh {m}, primitive {p}, Draco compression"))?;
            }
        }
    }
    Ok(decoder.accessors)
}

/// Where an accessor's numbers come from: view, and the attribute's number in it; none for the indices.
type Origin = (usize, Option<u64>);

struct Decoder<'a, 'b> {
    data: Data<'a>,
    purse: &'b mut budget::Purse,
    /// The last view decoded: primitives may share one.
    last: Option<(usize, Mesh)>,
    /// Views that were decoded, and how many triangles may still come.
    seen: HashSet<usize>,
    faces_left: u64,
    sources: HashMap<usize, Origin>,
    accessors: HashMap<usize, Plain>,
}

impl Decoder<'_, '_> {
    fn primitive(&mut self, primitive: &Value, extension: &Value, place: &str) -> Result<(), Fault> {
        let fault = |problem: String| Fault::at(place, problem);
        if json::number(primitive, "mode", place)?.unwrap_or(4) != 4 {
            return Err(fault("its mode is not that of separate triangles, others are not read".into()));
        }
        let n_views = json::list(self.data.document, "bufferViews")?.len();
        let view = json::reference(extension, "bufferView", place, "view", n_views)?;
        let view = view.ok_or_else(|| fault("names no bufferView".into()))?;
        let n_accessors = json::list(self.data.document, "accessors")?.len();
        let indices = json::reference(primitive, "indices", place, "accessor", n_accessors)?;
        self.accessor(indices.ok_or_else(|| fault("has no indices".into()))?, (view, None), place)?;
        let Some(attributes) = primitive.get("attributes") else { return Ok(()) };
        for name in extension.get("attributes").and_then(Value::as_object).into_iter().flat_map(|map| map.keys()) {
            let Some(accessor) = json::reference(attributes, name, place, "accessor", n_accessors)? else { continue };
            let id = json::number(&extension["attributes"], name, place)?.unwrap_or(0);
            self.accessor(accessor, (view, Some(id)), place)?;
        }
        Ok(())
    }

    fn accessor(&mut self, accessor: usize, origin: Origin, place: &str) -> Result<(), Fault> {
        match self.sources.get(&accessor) {
            Some(known) if *known == origin => return Ok(()),
            Some(_) => {
                let problem = "stands for two different pieces of compressed data";
                return Err(Fault::at(format!("accessor {accessor}"), problem));
            }
            None => self.sources.insert(accessor, origin),
        };
        let (view, attribute) = origin;
        self.decode(view, place)?;
        let Some((_, mesh)) = &self.last else { return Ok(()) };
        let plain = match attribute {
            None => indices(mesh),
            Some(id) => {
                let (component, width, count) = self.data.declared(accessor)?;
                let wrong = |problem| Fault::at(place, format!("{problem} for accessor {accessor}"));
                if count != mesh.num_points() {
                    let problem = format!("holds {} vertices, not the {count}", mesh.num_points());
                    return Err(wrong(problem));
                }
                let id = u32::try_from(id).ok();
                let attribute = id.and_then(|id| mesh.attribute_by_unique_id(id));
                let attribute = attribute.ok_or_else(|| wrong("holds no attribute of the number given".into()))?;
                let bytes = numbers(attribute, component, width, count);
                Plain { component, count, bytes: bytes.map_err(wrong)? }
            }
        };
        self.purse.spend(plain.bytes.len())?;
        self.accessors.insert(accessor, plain);
        Ok(())
    }

    /// Decodes a view, unless it is the last one.
    fn decode(&mut self, view: usize, place: &str) -> Result<(), Fault> {
        if self.last.as_ref().is_some_and(|(last, _)| *last == view) {
            return Ok(());
        }
        self.last = None;
        let bytes = self.data.view(view, place)?.bytes;
        if self.seen.insert(view) {
            self.faces_left = self.faces_left.saturating_add(FACES_PER_BYTE.saturating_mul(bytes.len() as u64));
        }
        let limits = DecodeLimits::default()
            .with_max_points(budget::VERTICES)
            .with_max_faces(self.faces_left.min(budget::TRIANGLES))
            .with_max_decoded_bytes(self.purse.left());
        let mut mesh = Mesh::new();
        MeshDecoder::new()
            .decode(&mut DecoderBuffer::new(bytes).with_limits(limits), &mut mesh)
            .map_err(|error| Fault::at(place, format!("cannot be decoded: {error}")))?;
        self.faces_left = self.faces_left.saturating_sub(mesh.num_faces() as u64);
        budget::check("vertices", mesh.num_points() as u64, budget::VERTICES)?;
        let attributes = (0..mesh.num_attributes()).map(|i| mesh.attribute(i).buffer().data().len());
        self.purse.spend(attributes.sum::<usize>() + 12 * mesh.num_faces())?;
        self.last = Some((view, mesh));
        Ok(())
    }
}

/// The triangles, in a type that holds them whatever the accessor says.
fn indices(mesh: &Mesh) -> Plain {
    let bytes: Vec<u8> = mesh.faces().iter().flatten().flat_map(|corner| corner.0.to_le_bytes()).collect();
    Plain { component: Component::U32, count: 3 * mesh.num_faces(), bytes }
}

/// The numbers of an attribute for each vertex, in the type that the accessor declares.
fn numbers(attribute: &PointAttribute, to: Component, width: usize, count: usize) -> Result<Vec<u8>, String> {
    let from = attribute.data_type();
    let found = usize::from(attribute.num_components());
    if found != width {
        return Err(format!("holds {found} numbers a vertex, not the {width}"));
    }
    let (size, stride) = (from.byte_length(), attribute.byte_stride() as usize);
    let values = attribute.buffer().data();
    let mut bytes = Vec::with_capacity(count * width * to.size() as usize);
    for vertex in 0..count {
        let index = attribute.mapped_index(PointIndex(vertex as u32)).0 as usize;
        let start = index.checked_mul(stride).filter(|_| index < attribute.size());
        let value = start.and_then(|start| values.get(start..)?.get(..size * width));
        let value = value.ok_or_else(|| format!("vertex {vertex} has no value"))?;
        for number in value.chunks_exact(size) {
            let number = scalar(from, number).ok_or("holds numbers of a type that accessors cannot have")?;
            to.write(number, &mut bytes);
        }
    }
    Ok(bytes)
}

/// A number of one of the types that accessors may declare.
fn scalar(kind: DataType, b: &[u8]) -> Option<f64> {
    Some(match kind {
        DataType::Int8 => f64::from(b[0] as i8),
        DataType::Uint8 | DataType::Bool => f64::from(b[0]),
        DataType::Int16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
        DataType::Uint16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
        DataType::Int32 => f64::from(i32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        DataType::Uint32 => f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        DataType::Float32 => f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::super::super::{access::Data, buffers, container};
    use super::super::Decoded;
    use serde_json::Value;

    /// The script beside the data made both files with the original encoder and the checksums with its decoder.
    #[test]
    fn decoded_numbers_are_those_of_the_original_decoder() {
        let checksums: Value =
            serde_json::from_str(include_str!("../../../tests/data/draco-checksums.json")).expect("JSON");
        let edgebreaker = include_bytes!("../../../tests/data/draco-edgebreaker.glb").as_slice();
        let sequential = include_bytes!("../../../tests/data/draco-sequential.glb").as_slice();
        for (name, bytes) in [("draco-edgebreaker", edgebreaker), ("draco-sequential", sequential)] {
            let container = container::parse(bytes.to_vec()).expect("a GLB file");
            let document: Value = serde_json::from_slice(&container.json).expect("JSON");
            let buffers = buffers::load(&document, &container, None).expect("buffers");
            let none = Decoded::default();
            let data = Data { document: &document, buffers: &buffers, container: &container, decoded: &none };
            let decoded = Decoded::of(data).expect("Draco data");
            let primitive = &document["meshes"][0]["primitives"][0];
            let places = ["/attributes/POSITION", "/attributes/NORMAL", "/indices"];
            let bytes = places.iter().flat_map(|place| {
                let accessor = primitive.pointer(place).and_then(Value::as_u64).expect(place);
                &decoded.accessor(accessor as usize).expect(place).bytes
            });
            // Fowler, Noll and Vo's checksum.
            let sum = |sum: u64, &byte: &u8| (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            let got = bytes.fold(0xcbf2_9ce4_8422_2325, sum);
            assert_eq!(format!("{got:x}"), checksums[name], "{name}");
        }
    }
}
