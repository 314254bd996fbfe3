//! Geometry out of a glTF document.

mod attributes;

use super::super::{Input, Opened};
use super::access::{Accessor, Component, Data};
use super::compressed::Decoded;
use super::source::{Block, GltfSource, Primitive};
use super::{buffers, container, json, nodes};
use crate::folder::Folder;
use crate::shape::{NO_MATERIAL, Part};
use crate::watch::Stage;
use crate::{Fault, Warning, budget, rigidity};
use attributes::{Attribute, finite};
use glam::{DMat3, DMat4, DVec3, Vec2};
use serde_json::Value;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

/// Vertices or triangles between two looks at whether the file is still wanted: some milliseconds.
const PIECE: usize = 1 << 16;

/// Reads a glTF or GLB file.
pub(crate) fn read(input: Input<'_>) -> Result<Opened, Fault> {
    read_both(input).map(|(opened, _)| opened)
}

/// A file that was just written, as it came.
pub(super) fn source_of(bytes: Vec<u8>, folder: &Path) -> Result<Arc<GltfSource>, Fault> {
    let folder = Folder::on_disk(folder, false);
    let input = Input { bytes, folder: Some(&folder), unfinished: None, name: "", stage: Stage::unwatched() };
    read_both(input).map(|(_, source)| source)
}

fn read_both(input: Input<'_>) -> Result<(Opened, Arc<GltfSource>), Fault> {
    let container = container::parse(input.bytes)?;
    let document = parse_document(&container.json)?;
    let buffers = buffers::load(&document, &container, input.folder)?;
    let mut warnings = Vec::new();
    let n_meshes = json::list(&document, "meshes")?.len();
    let placements = nodes::placements(&document, n_meshes, &mut warnings)?;
    let transforms = placements.into_iter().map(|placement| placement.transform).collect();
    let none = Decoded::default();
    let data = Data { document: &document, buffers: &buffers, container: &container, decoded: &none };
    let decoded = Decoded::of(data)?;
    let data = Data { decoded: &decoded, ..data };
    let mut reader = Reader::new(data, transforms, input.name, input.stage);
    reader.meshes()?;
    let Reader { blocks, primitives, positions, triangles, rigidity, uvs, colors, parts, .. } = reader;
    let n = positions.len();
    warnings.extend(reader.warnings);
    let folder = input.folder.cloned();
    let source = Arc::new(GltfSource { blocks, primitives, folder, container, document, buffers, decoded });
    let opened = Opened {
        positions,
        triangles,
        rigidity: filled(rigidity, n, 1),
        uvs: filled(uvs, n, Vec2::ZERO),
        colors: filled(colors, n, [1.0; 4]),
        parts,
        warnings,
        source: source.clone(),
    };
    Ok((opened, source))
}

/// An attribute of some vertices, completed for all; `None` when no vertex has it.
fn filled<T: Copy>(mut values: Vec<T>, n: usize, rest: T) -> Option<Vec<T>> {
    if values.is_empty() {
        return None;
    }
    values.resize(n, rest);
    Some(values)
}

/// Base color factor of a material: white where it says none.
pub(super) fn base_color(material: &Value) -> [f32; 4] {
    let rough = material.get("pbrMetallicRoughness");
    let factor = rough.and_then(|rough| json::numbers::<4>(rough, "baseColorFactor", "").ok().flatten());
    factor.unwrap_or([1.0; 4]).map(|x| finite(x, 1.0))
}

fn parse_document(bytes: &[u8]) -> Result<Value, Fault> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let document: Value = serde_json::from_slice(text).map_err(|error| {
        let place = format!("line {}, column {} of the JSON", error.line(), error.column());
        let problem = error.to_string();
        let problem = problem.split(" at line").next().unwrap_or_default().to_owned();
        Fault::at(place, problem)
    })?;
    if !document.is_object() {
        return Err(Fault::Container("is not a glTF file: its JSON is not an object".into()));
    }
    let version = document.get("asset").and_then(|asset| asset.get("version")).and_then(Value::as_str);
    match version {
        Some(version) if version.starts_with("2.") => {}
        Some(version) => {
            let problem = format!("is glTF version {}; only 2.x can be read", rigidity::quoted(version));
            return Err(Fault::Container(problem));
        }
        None => return Err(Fault::Container("is not a glTF file: it names no asset version".into())),
    }
    Ok(document)
}

struct Reader<'a> {
    data: Data<'a>,
    transforms: Vec<DMat4>,
    name: &'a str,
    stage: Stage<'a>,
    /// Elements of all accessors, to tell how far reading is.
    n_elements: u64,
    block_of: HashMap<usize, usize>,
    /// Attributes that a primitive has given for a block; they are read once however often they are named.
    given: HashSet<(usize, Attribute)>,
    /// Whether an accessor holds directions for a block, of so many numbers each.
    turnable: HashMap<(usize, usize, usize), bool>,
    elements: budget::Purse,
    zeros: budget::Purse,
    names: budget::Purse,
    n_without_positions: usize,
    blocks: Vec<Block>,
    primitives: Vec<Primitive>,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    rigidity: Vec<u16>,
    uvs: Vec<Vec2>,
    colors: Vec<[f32; 4]>,
    parts: Vec<Part>,
    warnings: Vec<Warning>,
}

impl<'a> Reader<'a> {
    fn new(data: Data<'a>, transforms: Vec<DMat4>, name: &'a str, stage: Stage<'a>) -> Self {
        let accessors = json::list(data.document, "accessors").unwrap_or_default();
        let counts = accessors.iter().filter_map(|accessor| accessor.get("count")?.as_u64());
        Reader {
            data,
            transforms,
            name,
            stage,
            n_elements: counts.fold(0, u64::saturating_add),
            block_of: HashMap::new(),
            given: HashSet::new(),
            turnable: HashMap::new(),
            elements: budget::Purse::new("elements read from accessors", budget::ELEMENTS),
            zeros: budget::Purse::new("vertices without data", budget::ZEROS),
            names: budget::Purse::of_names(),
            n_without_positions: 0,
            blocks: Vec::new(),
            primitives: Vec::new(),
            positions: Vec::new(),
            triangles: Vec::new(),
            rigidity: Vec::new(),
            uvs: Vec::new(),
            colors: Vec::new(),
            parts: Vec::new(),
            warnings: Vec::new(),
        }
    }

    fn meshes(&mut self) -> Result<(), Fault> {
        for (m, mesh) in json::list(self.data.document, "meshes")?.iter().enumerate() {
            let primitives = mesh.get("primitives").and_then(Value::as_array);
            for (p, primitive) in primitives.into_iter().flatten().enumerate() {
                self.primitive(mesh, m, primitive, p)?;
            }
        }
        if self.n_without_positions > 0 {
            let text = format!("{} primitives have no positions and are not shown", self.n_without_positions);
            self.warnings.push(Warning(text));
        }
        Ok(())
    }

    fn primitive(&mut self, mesh: &Value, m: usize, primitive: &'a Value, p: usize) -> Result<(), Fault> {
        let place = format!("mesh {m}, primitive {p}");
        let attribute = |name: &str| -> Result<Option<usize>, Fault> {
            let Some(attributes) = primitive.get("attributes") else { return Ok(None) };
            let n = json::list(self.data.document, "accessors")?.len();
            json::reference(attributes, name, &place, "accessor", n)
        };
        let Some(position) = attribute("POSITION")? else {
            self.n_without_positions += 1;
            return Ok(());
        };
        let (normal, tangent, uv) = (attribute("NORMAL")?, attribute("TANGENT")?, attribute("TEXCOORD_0")?);
        let (color, r) = (attribute("COLOR_0")?, attribute("_RIGIDITY")?);
        let block = self.block(position, m)?;
        let n_materials = json::list(self.data.document, "materials")?.len();
        let material = json::reference(primitive, "material", &place, "material", n_materials)?;
        let start = self.triangles.len();
        self.faces(primitive, block, &place)?;
        let triangles = start..self.triangles.len();
        self.attribute_of(block, r, Attribute::Rigidity)?;
        for (accessor, what) in [(uv, Attribute::Uv), (color, Attribute::Color)] {
            // What only matters to the eye is passed over where it is broken.
            if let Err(fault) = self.attribute_of(block, accessor, what) {
                if matches!(fault, Fault::Canceled) {
                    return Err(fault);
                }
                self.warnings.push(Warning(format!("{} are not shown: {fault}", what.words())));
            }
        }
        let n_primitives = mesh.get("primitives").and_then(Value::as_array).map_or(1, Vec::len);
        if !triangles.is_empty() {
            let name = json::name(mesh).map_or_else(|| format!("{} {m}", self.name), str::to_owned);
            let name = budget::short_name(name);
            let name = if n_primitives > 1 { format!("{name}.{p}") } else { name };
            self.names.spend(name.len())?;
            self.parts.push(Part { name, triangles: triangles.clone(), base_color: self.base_color(material) });
        }
        let normal = self.turnable(normal, block, 3)?;
        let tangent = self.turnable(tangent, block, 4)?;
        self.primitives.push(Primitive { mesh: m, index: p, block, normal, tangent, uv, material, triangles });
        Ok(())
    }

    /// A directional attribute that can be rewritten; a broken one is kept as it is.
    fn turnable(&mut self, accessor: Option<usize>, block: usize, width: usize) -> Result<Option<usize>, Fault> {
        let Some(accessor) = accessor else { return Ok(None) };
        let key = (block, accessor, width);
        if let Some(&readable) = self.turnable.get(&key) {
            return Ok(readable.then_some(accessor));
        }
        let count = self.blocks[block].vertices.len();
        let checked = self.data.accessor(accessor).ok().filter(|a| a.count == count && a.width == width);
        match &checked {
            // Read on saving.
            Some(checked) => self.elements.spend(checked.count + checked.n_checked())?,
            None => {
                let text = format!("accessor {accessor} cannot be read as directions and stays");
                self.warnings.push(Warning(text));
            }
        }
        self.turnable.insert(key, checked.is_some());
        Ok(checked.map(|_| accessor))
    }

    /// Tells how far reading is; a fault when it is no longer wanted.
    fn tell(&self) -> Result<(), Fault> {
        let done = self.elements.spent().min(self.n_elements);
        self.stage.tell(done as usize, self.n_elements as usize)
    }

    /// A checked accessor, paid for.
    fn accessor(&mut self, index: usize) -> Result<Accessor<'a>, Fault> {
        let checked = self.data.accessor(index)?;
        self.elements.spend(checked.n_checked())?;
        Ok(checked)
    }

    /// The numbers of an accessor, paid for.
    fn numbers(&mut self, checked: &Accessor<'_>) -> Result<Vec<f64>, Fault> {
        self.tell()?;
        self.elements.spend(checked.count)?;
        Ok(checked.numbers())
    }

    /// The file vertices of a POSITION accessor, numbered at its first use.
    fn block(&mut self, accessor: usize, mesh: usize) -> Result<usize, Fault> {
        if let Some(&block) = self.block_of.get(&accessor) {
            return Ok(block);
        }
        let checked = self.accessor(accessor)?;
        let place = format!("accessor {accessor}");
        let readable = checked.width == 3 && checked.component != Component::U32;
        if !readable {
            return Err(Fault::at(place, "positions are not three numbers of a type that positions may have"));
        }
        if !checked.has_data() {
            self.zeros.spend(checked.count)?;
        }
        let first = self.positions.len();
        budget::check("vertices", (first + checked.count) as u64, budget::VERTICES)?;
        let world_from_local = self.transforms[mesh];
        let vertices = first..first + checked.count;
        let block = Block { accessor, vertices, world_from_local, local_from_world: world_from_local.inverse() };
        let numbers = self.numbers(&checked)?;
        self.positions.reserve_exact(checked.count);
        for (i, local) in numbers.chunks_exact(3).enumerate() {
            if i % PIECE == 0 {
                self.tell()?;
            }
            let local = DVec3::new(local[0], local[1], local[2]);
            // Unplaced meshes keep their numbers to the bit, negative zeros too.
            let world = if world_from_local == DMat4::IDENTITY { local } else { block.to_world(local) };
            if !world.is_finite() {
                let place = format!("vertex {} (element {i} of accessor {accessor})", first + i);
                return Err(Fault::at(place, "position is not finite"));
            }
            self.positions.push(world);
        }
        self.blocks.push(block);
        self.block_of.insert(accessor, self.blocks.len() - 1);
        Ok(self.blocks.len() - 1)
    }

    fn faces(&mut self, primitive: &Value, block: usize, place: &str) -> Result<(), Fault> {
        let mode = json::number(primitive, "mode", place)?.unwrap_or(4);
        if mode > 6 {
            return Err(Fault::at(place, format!("mode {mode} is not known")));
        }
        if mode < 4 {
            return Ok(());
        }
        let Block { vertices, world_from_local, .. } = self.blocks[block].clone();
        let n_accessors = json::list(self.data.document, "accessors")?.len();
        let indices = json::reference(primitive, "indices", place, "accessor", n_accessors)?;
        let corners: Vec<u32> = match indices {
            None => {
                self.elements.spend(vertices.len())?;
                (0..vertices.len() as u32).collect()
            }
            Some(accessor) => self.indices(accessor, vertices.len(), place)?,
        };
        let n_triangles = if mode == 4 { corners.len() / 3 } else { corners.len().saturating_sub(2) };
        budget::check("triangles", (self.triangles.len() + n_triangles) as u64, budget::TRIANGLES)?;
        let mirrored = DMat3::from_mat4(world_from_local).determinant() < 0.0;
        self.triangles.reserve(n_triangles);
        for t in 0..n_triangles {
            if t % PIECE == 0 {
                self.tell()?;
            }
            let [a, b, c] = match mode {
                4 => [corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]],
                5 => [corners[t], corners[t + 1 + t % 2], corners[t + 2 - t % 2]],
                _ => [corners[t + 1], corners[t + 2], corners[0]],
            };
            // Strips are stitched with triangles of no extent.
            if mode != 4 && (a == b || b == c || c == a) {
                continue;
            }
            let triangle = if mirrored { [a, c, b] } else { [a, b, c] };
            self.triangles.push(triangle.map(|local| vertices.start as u32 + local));
        }
        Ok(())
    }

    fn indices(&mut self, accessor: usize, n_vertices: usize, place: &str) -> Result<Vec<u32>, Fault> {
        let checked = self.accessor(accessor)?;
        let unsigned = matches!(checked.component, Component::U8 | Component::U16 | Component::U32);
        if !checked.has_data() {
            return Err(Fault::at(format!("accessor {accessor}"), "indices are in no bufferView"));
        }
        if checked.width != 1 || !unsigned {
            return Err(Fault::at(format!("accessor {accessor}"), "indices are not unsigned whole numbers"));
        }
        let indices: Vec<u32> = self.numbers(&checked)?.into_iter().map(|x| x as u32).collect();
        if let Some(i) = indices.iter().position(|&index| index as usize >= n_vertices) {
            let problem = format!("index {i} names vertex {}, the primitive has {n_vertices}", indices[i]);
            return Err(Fault::at(place, problem));
        }
        Ok(indices)
    }

    fn base_color(&self, material: Option<usize>) -> [f32; 4] {
        let materials = json::list(self.data.document, "materials").unwrap_or_default();
        material.and_then(|m| materials.get(m)).map_or(NO_MATERIAL, base_color)
    }
}
