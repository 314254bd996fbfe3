//! PLY files into geometry.

use super::body::Body;
use super::header::{Element, Header, Kind};
use super::roles::{COLOR, N_ROLES, NORMAL, POSITION, R, RIGIDITY, Roles, UV};
use super::scalar::Scalar;
use crate::formats::faces::{self, Cut, Faces};
use crate::watch::Stage;
use crate::{Fault, Warning, budget, rigidity};
use glam::{DVec3, Vec2, Vec3};

/// Names of the list of a face's vertices.
const INDICES: &[&str] = &["vertex_indices", "vertex_index"];

/// What is read of a file.
pub(super) struct Parsed {
    pub(super) header: Header,
    pub(super) roles: Roles,
    /// The element with the vertices, and where its numbers begin.
    pub(super) vertex: usize,
    pub(super) vertex_at: usize,
    pub(super) vertices: Vertices,
    pub(super) cut: Cut,
    pub(super) rigidity: Option<Vec<u16>>,
    pub(super) warnings: Vec<Warning>,
}

/// Lists with an entry a vertex, or empty.
#[derive(Default)]
pub(super) struct Vertices {
    pub(super) positions: Vec<DVec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) colors: Vec<[f32; 4]>,
    rigidity: Vec<f64>,
}

pub(super) fn parse(bytes: &[u8], stage: Stage<'_>) -> Result<Parsed, Fault> {
    let mut header = Header::parse(bytes)?;
    let vertex = header.element("vertex").ok_or_else(|| Fault::Container("declares no element vertex".into()))?;
    let roles = Roles::of(&header.elements[vertex]);
    if !roles.has(POSITION) {
        return Err(Fault::Container("has no numbers x, y and z in its element vertex".into()));
    }
    let n_vertices = header.elements[vertex].count;
    budget::check("vertices", n_vertices, budget::VERTICES)?;
    let mut body = Body::new(bytes, header.body, header.encoding).watched(stage);
    let (mut vertices, mut vertex_at) = (Vertices::default(), header.body);
    let mut faces = Faces::new(n_vertices as usize);
    for (i, element) in header.elements.iter().enumerate() {
        body.check_room(element)?;
        let indices = element.property(INDICES).filter(|&p| matches!(element.properties[p].kind, Kind::List { .. }));
        match (element.name.as_str(), indices) {
            _ if i == vertex => {
                vertex_at = body.at();
                vertices = Vertices::read(&mut body, element, &roles)?;
            }
            ("face", Some(indices)) => read_faces(&mut body, element, indices, &mut faces, false)?,
            ("tristrips", Some(indices)) => read_faces(&mut body, element, indices, &mut faces, true)?,
            ("face", None) if element.count > 0 => {
                return Err(Fault::Container("has no list vertex_indices in its element face".into()));
            }
            _ => body.skip_element(element)?,
        }
    }
    let mut warnings = std::mem::take(&mut header.warnings);
    let rigidity = vertices.checked_rigidity(&mut warnings);
    let cut = faces.cut(&vertices.positions);
    if cut.triangles.is_empty() {
        let edges = header.element("edge").map_or(0, |edge| header.elements[edge].count);
        let others = if edges > 0 { format!(", {edges} edges") } else { String::new() };
        return Err(faces::none(vertices.positions.len(), &others));
    }
    let surplus = body.surplus();
    if surplus > 0 {
        warnings.push(Warning(format!("{surplus} bytes after the last element are kept and not read")));
    }
    Ok(Parsed { header, roles, vertex, vertex_at, vertices, cut, rigidity, warnings })
}

impl Vertices {
    fn read(body: &mut Body<'_>, element: &Element, roles: &Roles) -> Result<Vertices, Fault> {
        let mut out = Vertices::default();
        out.positions.reserve_exact(element.count as usize);
        let full: [f64; 4] = std::array::from_fn(|channel| roles.full(COLOR + channel));
        let mut row = [0.0; N_ROLES];
        row[COLOR + 3] = full[3];
        for index in 0..element.count {
            body.tell(index)?;
            read_row(body, element, roles, &mut row).map_err(|problem| body.fault(element, index, &problem))?;
            let position = DVec3::new(row[POSITION], row[POSITION + 1], row[POSITION + 2]);
            if !position.is_finite() {
                return Err(body.fault(element, index, &format!("its position {position} is not finite")));
            }
            out.positions.push(position);
            if roles.has(NORMAL) {
                out.normals.push(Vec3::from_array(std::array::from_fn(|axis| single(row[NORMAL + axis]))));
            }
            if roles.has(UV) {
                out.uvs.push(Vec2::new(single(row[UV]), single(row[UV + 1])));
            }
            if roles.has(COLOR) {
                out.colors.push(std::array::from_fn(|channel| single(row[COLOR + channel] / full[channel])));
            }
            if roles.has(R) {
                out.rigidity.push(row[R]);
            }
        }
        Ok(out)
    }

    /// r, unless the property of that name is something else.
    fn checked_rigidity(&mut self, warnings: &mut Vec<Warning>) -> Option<Vec<u16>> {
        let values = std::mem::take(&mut self.rigidity);
        let allowed = |&r: &f64| (1.0..=f64::from(rigidity::MAX)).contains(&r) && r.fract() == 0.0;
        if let Some(vertex) = values.iter().position(|r| !allowed(r)) {
            let text = format!(
                "the property {RIGIDITY} is {} at vertex {vertex}, not a whole number from 1 to {}: it is not read",
                values[vertex],
                rigidity::MAX
            );
            warnings.push(Warning(text));
            return None;
        }
        (!values.is_empty()).then(|| values.iter().map(|&r| r as u16).collect())
    }
}

/// A number for display, zero where it is none that single precision holds.
fn single(x: f64) -> f32 {
    let x = x as f32;
    if x.is_finite() { x } else { 0.0 }
}

/// The numbers of one vertex that mean something, the rest passed.
fn read_row(body: &mut Body<'_>, element: &Element, roles: &Roles, row: &mut [f64; N_ROLES]) -> Result<(), String> {
    body.begin()?;
    for (property, role) in element.properties.iter().zip(&roles.role) {
        match (property.kind, role) {
            (Kind::Scalar(scalar), Some(role)) => {
                row[*role] = body.value(scalar).map_err(|problem| format!("{}: {problem}", property.name))?;
            }
            (kind, _) => {
                body.skip(kind)?;
            }
        }
    }
    Ok(())
}

/// Reads the list `indices` of each face, or of strips of triangles.
fn read_faces(
    body: &mut Body<'_>,
    element: &Element,
    indices: usize,
    faces: &mut Faces,
    strips: bool,
) -> Result<(), Fault> {
    let (mut numbers, mut corners) = (Vec::new(), Vec::new());
    budget::check("faces", element.count, budget::TRIANGLES)?;
    let limit = if strips { budget::TRIANGLES } else { budget::POLYGON_CORNERS };
    for index in 0..element.count {
        body.tell(index)?;
        let mut read = || -> Result<(), String> {
            body.begin()?;
            for (i, property) in element.properties.iter().enumerate() {
                match property.kind {
                    Kind::List { count, item } if i == indices => body.list([count, item], limit, &mut numbers)?,
                    kind => {
                        body.skip(kind)?;
                    }
                }
            }
            if strips {
                return numbers.split(|&x| x == -1.0).try_for_each(|strip| push_strip(strip, &mut corners, faces));
            }
            vertices_of(&numbers, &mut corners)?;
            faces.push(&corners)
        };
        read().map_err(|problem| body.fault(element, index, &problem))?;
    }
    Ok(())
}

fn vertices_of(numbers: &[f64], out: &mut Vec<u32>) -> Result<(), String> {
    out.clear();
    for &x in numbers {
        if !Scalar::U32.holds(x) {
            return Err(format!("{x} is no number of a vertex"));
        }
        out.push(x as u32);
    }
    Ok(())
}

/// Triangles of a strip, every other one turned over. Those with a corner twice only lead the strip elsewhere.
fn push_strip(strip: &[f64], corners: &mut Vec<u32>, faces: &mut Faces) -> Result<(), String> {
    vertices_of(strip, corners)?;
    for (i, &[a, b, c]) in corners.array_windows().enumerate() {
        if a != b && b != c && c != a {
            faces.push(&if i % 2 == 0 { [a, b, c] } else { [b, a, c] })?;
        } else if let Some(&loose) = [a, b, c].iter().find(|&&v| v as usize >= faces.n_vertices()) {
            return Err(format!("names vertex {loose}, the file has {}", faces.n_vertices()));
        }
    }
    Ok(())
}
