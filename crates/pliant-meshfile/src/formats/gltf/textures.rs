//! Base color pictures of the materials.

use super::access::Data;
use super::read::base_color;
use super::source::GltfSource;
use super::{base64, json};
use crate::formats::Before;
use crate::shape::NO_MATERIAL;
use crate::textures::{Gatherer, Run, Textures, Wrapping};
use crate::{files, rigidity};
use glam::{Mat2, Vec2};
use serde_json::Value;
use std::collections::HashMap;

/// A picture of a material, and where its corners move to first (KHR_texture_transform).
#[derive(Clone, Copy)]
struct Laid {
    picture: usize,
    transform: Option<(Vec2, Mat2)>,
}

/// The pictures of a file on its triangles.
pub(super) fn textures(source: &GltfSource, mesh: Before<'_>) -> Textures {
    let materials = json::list(&source.document, "materials").unwrap_or_default();
    let mut reader = Reader { source, gatherer: Gatherer::new(), known: HashMap::new() };
    let has_uv = mesh.uvs.is_some();
    let laid: Vec<Option<Laid>> =
        materials.iter().map(|material| if has_uv { reader.of_material(material) } else { None }).collect();
    let material_of = |k: Option<usize>| k.and_then(|k| Some((materials.get(k)?, *laid.get(k)?)));
    let run = |primitive: &super::source::Primitive| {
        let (material, laid) = material_of(primitive.material).unzip();
        Run {
            triangles: primitive.triangles.clone(),
            picture: laid.flatten().filter(|_| primitive.uv.is_some()).map(|laid| laid.picture),
            tint: material.map_or(NO_MATERIAL, base_color),
        }
    };
    let runs = source.primitives.iter().map(run).collect();
    let uvs = || {
        let empty = Vec::new();
        let of_vertex = mesh.uvs.as_ref().unwrap_or(&empty);
        let corner = |&vertex: &u32| of_vertex.get(vertex as usize).copied().unwrap_or_default();
        let mut uvs: Vec<[Vec2; 3]> = mesh.triangles.iter().map(|t| t.each_ref().map(corner)).collect();
        for primitive in &source.primitives {
            let moved = material_of(primitive.material).and_then(|(_, laid)| laid?.transform);
            if let Some((offset, matrix)) = moved {
                for uv in uvs[primitive.triangles.clone()].as_flattened_mut() {
                    // The file counts from the top.
                    let there = offset + matrix * Vec2::new(uv.x, 1.0 - uv.y);
                    *uv = Vec2::new(there.x, 1.0 - there.y);
                }
            }
        }
        uvs
    };
    reader.gatherer.on(runs, mesh.triangles.len(), uvs)
}

struct Reader<'a> {
    source: &'a GltfSource,
    gatherer: Gatherer,
    /// Pictures by image, wrapping and the bits of their cutout; `None` for those that cannot be had.
    known: HashMap<(usize, [Wrapping; 2], Option<u32>), Option<usize>>,
}

impl Reader<'_> {
    fn of_material(&mut self, material: &Value) -> Option<Laid> {
        let metal = material.pointer("/pbrMetallicRoughness/baseColorTexture");
        let glossy = "/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture";
        let info = metal.or_else(|| material.pointer(glossy))?;
        let index = info.get("index")?.as_u64()? as usize;
        let transform = info.pointer("/extensions/KHR_texture_transform");
        let set = transform.and_then(|transform| transform.get("texCoord")).or_else(|| info.get("texCoord"));
        if set.and_then(Value::as_u64).is_some_and(|set| set > 0) {
            let reason = "it needs a second set of texture coordinates";
            self.gatherer.missing.push(format!("texture {index} ({reason})"));
            return None;
        }
        let picture = self.of_texture(index, cutout(material))?;
        Some(Laid { picture, transform: transform.map(transform_of) })
    }

    fn of_texture(&mut self, index: usize, cutout: Option<f32>) -> Option<usize> {
        let document = &self.source.document;
        let texture = json::list(document, "textures").ok()?.get(index)?;
        let of_extension = |name: &str| texture.get("extensions")?.get(name)?.get("source")?.as_u64();
        let source = texture.get("source").and_then(Value::as_u64);
        let Some(image) = source.or_else(|| of_extension("EXT_texture_webp")) else {
            let other = OTHER_FORMATS.iter().find_map(|(name, format)| Some((of_extension(name)?, *format)));
            let (what, format) = match other {
                Some((image, format)) => (self.name(image as usize), format),
                None => (format!("texture {index}"), "a format"),
            };
            self.gatherer.missing.push(format!("{what} (it is in {format} that cannot be shown)"));
            return None;
        };
        let wrapping = wrapping(document, texture);
        let key = (image as usize, wrapping, cutout.map(f32::to_bits));
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let (name, bytes) = self.image(key.0);
        let picture = self.gatherer.take(name, bytes, (wrapping, cutout));
        self.known.insert(key, picture);
        picture
    }

    /// What an image is called, for messages.
    fn name(&self, index: usize) -> String {
        let image = json::list(&self.source.document, "images").unwrap_or_default().get(index);
        let uri = image.and_then(|image| image.get("uri")).and_then(Value::as_str);
        let file = uri.filter(|uri| !uri.starts_with("data:")).map(rigidity::quoted);
        let name = || image.and_then(json::name).map(rigidity::quoted);
        file.or_else(name).unwrap_or_else(|| format!("image {index}"))
    }

    /// Name and bytes of an image.
    fn image(&self, index: usize) -> (String, Result<Vec<u8>, String>) {
        let image = json::list(&self.source.document, "images").unwrap_or_default().get(index);
        let Some(image) = image else { return (format!("image {index}"), Err("it does not exist".into())) };
        let name = json::name(image).map_or_else(|| format!("image {index}"), rigidity::quoted);
        let uri = image.get("uri").and_then(Value::as_str);
        if let Some(uri) = uri.filter(|uri| !uri.starts_with("data:")) {
            let path = files::percent_decoded(uri).ok_or_else(|| "its name is no text".to_owned());
            let folder = self.source.folder.as_ref();
            return (rigidity::quoted(uri), path.and_then(|path| self.gatherer.read(folder, &path)));
        }
        if let Some((_, data)) = uri.and_then(|uri| uri.split_once(";base64,")) {
            return (name, base64::decode(data).ok_or_else(|| "its data URI is not base64".to_owned()));
        }
        let view = image.get("bufferView").and_then(Value::as_u64);
        let bytes = view.ok_or_else(|| "it names no data".to_owned()).and_then(|view| {
            let place = format!("image {index}");
            let bytes = Data::from(self.source).view(view as usize, &place).map_err(|fault| fault.to_string())?;
            Ok(bytes.bytes.to_vec())
        });
        (name, bytes)
    }
}

/// Extensions that bring pictures in formats that are not decoded.
const OTHER_FORMATS: [(&str, &str); 3] = [
    ("KHR_texture_basisu", "KTX2, a format"),
    ("MSFT_texture_dds", "DDS, a format"),
    ("EXT_texture_avif", "AVIF, a format"),
];

/// The opacity of the picture below which nothing of a material is there, if it is of that kind. What the file asks of the
/// product of picture and color is asked of the picture alone.
fn cutout(material: &Value) -> Option<f32> {
    let is_mask = material.get("alphaMode").and_then(Value::as_str) == Some("MASK");
    let cutoff = material.get("alphaCutoff").and_then(Value::as_f64).unwrap_or(0.5) as f32;
    let [.., opacity] = base_color(material);
    is_mask.then(|| cutoff / opacity.max(f32::MIN_POSITIVE))
}

/// Where the corners of a picture move: an offset, and a rotation of what was scaled.
fn transform_of(transform: &Value) -> (Vec2, Mat2) {
    let pair = |key, default: f64| {
        let numbers = json::numbers::<2>(transform, key, "").ok().flatten().unwrap_or([default; 2]);
        Vec2::from_array(numbers.map(|x| x as f32))
    };
    let angle = transform.get("rotation").and_then(Value::as_f64).unwrap_or(0.0) as f32;
    let scale = pair("scale", 1.0);
    // Counterclockwise where v points down.
    (pair("offset", 0.0), Mat2::from_angle(-angle) * Mat2::from_diagonal(scale))
}

/// How a texture goes on beyond its picture.
fn wrapping(document: &Value, texture: &Value) -> [Wrapping; 2] {
    let samplers = json::list(document, "samplers").unwrap_or_default();
    let sampler = texture.get("sampler").and_then(Value::as_u64).and_then(|k| samplers.get(k as usize));
    ["wrapS", "wrapT"].map(|key| match sampler.and_then(|sampler| sampler.get(key)).and_then(Value::as_u64) {
        Some(33071) => Wrapping::Clamp,
        Some(33648) => Wrapping::Mirror,
        _ => Wrapping::Repeat,
    })
}
