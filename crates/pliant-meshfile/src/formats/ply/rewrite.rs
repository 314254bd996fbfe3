//! The same PLY file with other numbers in its vertices.

use super::PlySource;
use super::body::Body;
use super::header::Encoding;
use super::roles::{NORMAL, POSITION, R, RIGIDITY};
use super::scalar::Scalar;
use crate::formats::words::{shortest, shortest_single};
use crate::formats::{Edit, Output, turning};
use crate::{SaveError, Warning, normals};
use glam::{DQuat, Vec3};
use std::path::Path;

/// The file again; a number is touched only if it changed.
pub(super) fn rewrite(source: &PlySource, edit: &Edit<'_>, to: &Path) -> Result<Output, SaveError> {
    let mut plan = Plan::new(source, edit);
    plan.positions(to)?;
    plan.rigidity(to)?;
    let bytes = if plan.changes_nothing() { source.bytes.clone() } else { plan.write() };
    Ok(Output { bytes, beside: Vec::new(), warnings: plan.warnings, origin: None })
}

/// What changes, and how.
struct Plan<'a> {
    source: &'a PlySource,
    edit: &'a Edit<'a>,
    moved: bool,
    /// Type of each vertex property in the new file, where that is another.
    retyped: Vec<Option<Scalar>>,
    turns: Vec<Option<DQuat>>,
    /// The new r, where it is another.
    rigidity: Option<&'a [u16]>,
    warnings: Vec<Warning>,
}

impl<'a> Plan<'a> {
    fn new(source: &'a PlySource, edit: &'a Edit<'a>) -> Plan<'a> {
        let moved = (0..edit.positions.len()).any(|vertex| edit.moved(vertex));
        let turns = if moved && !source.normals.is_empty() {
            turning::vertex_turns(edit, &source.normals)
        } else {
            vec![None; edit.positions.len()]
        };
        let retyped = vec![None; source.header.elements[source.vertex].properties.len()];
        let rigidity = edit.rigidity.as_deref().filter(|&new| edit.mesh.rigidity.as_deref() != Some(new));
        Plan { source, edit, moved, retyped, turns, rigidity, warnings: Vec::new() }
    }

    fn changes_nothing(&self) -> bool {
        !self.moved && self.rigidity.is_none()
    }

    /// The property and type of a role that the file has.
    fn property(&self, role: usize) -> (usize, Scalar) {
        self.source.roles.property[role].expect("every vertex has a position")
    }

    /// Whole numbers cannot hold a bent surface: they become the floating point numbers that hold them all.
    fn positions(&mut self, to: &Path) -> Result<(), SaveError> {
        let mut all_fit = true;
        for axis in 0..3 {
            let (_, scalar) = self.property(POSITION + axis);
            for vertex in (0..self.edit.positions.len()).filter(|&vertex| self.edit.moved(vertex)) {
                if scalar.holds(self.edit.positions[vertex][axis]) {
                    continue;
                }
                if scalar.whole_range().is_none() {
                    return Err(SaveError::NotFinite { path: to.to_owned(), vertex });
                }
                all_fit = false;
            }
        }
        if all_fit {
            return Ok(());
        }
        let in_single = self.edit.positions.iter().all(|position| position.as_vec3().is_finite());
        for axis in 0..3 {
            let (property, scalar) = self.property(POSITION + axis);
            // Single precision holds whole numbers up to 2²⁴.
            let wide = if scalar.size() < 4 && in_single { Scalar::F32 } else { Scalar::F64 };
            if scalar.whole_range().is_some() {
                self.retyped[property] = Some(wide);
                let name = &self.source.header.elements[self.source.vertex].properties[property].name;
                let text = format!(
                    "the whole numbers ({}) of {name} became {} to hold the new positions",
                    scalar.name(),
                    wide.name()
                );
                self.warnings.push(Warning(text));
            }
        }
        Ok(())
    }

    /// Makes room for r where the file's property is too narrow.
    fn rigidity(&mut self, to: &Path) -> Result<(), SaveError> {
        let Some(new) = self.rigidity else { return Ok(()) };
        let vertex = &self.source.header.elements[self.source.vertex];
        match self.source.roles.property[R] {
            Some((property, scalar)) => {
                if !new.iter().all(|&r| scalar.holds(f64::from(r))) {
                    self.retyped[property] = Some(Scalar::U16);
                }
                if self.edit.mesh.rigidity.is_none() {
                    self.warnings.push(Warning(format!("the property {RIGIDITY}, which was not read, was replaced")));
                }
            }
            None if vertex.property(&[RIGIDITY]).is_some() => {
                let reason =
                    format!("it has a list {RIGIDITY} in its vertices, which leaves no place for the rigidity");
                return Err(SaveError::Encode { path: to.to_owned(), reason });
            }
            None => {}
        }
        Ok(())
    }

    /// The new number of a role of a vertex, if it is another.
    fn number(&self, role: usize, vertex: usize, scalar: Scalar) -> Option<f64> {
        match role {
            POSITION..NORMAL => {
                let axis = role - POSITION;
                let [old, new] = [self.edit.mesh.positions[vertex][axis], self.edit.positions[vertex][axis]];
                (new != old).then_some(new)
            }
            NORMAL..6 => {
                let old = self.source.normals[vertex];
                let new = self.turns[vertex].map(|turn| normals::turned(old, turn))?;
                Some(stored_direction(old, new, scalar)[role - NORMAL])
            }
            R => {
                let old = self.edit.mesh.rigidity.as_ref().map(|rigidity| rigidity[vertex]);
                let new = self.rigidity?[vertex];
                (old != Some(new)).then_some(f64::from(new))
            }
            _ => None,
        }
    }

    fn write(&self) -> Vec<u8> {
        let PlySource { bytes, header, roles, .. } = self.source;
        let element = &header.elements[self.source.vertex];
        let appended = if roles.has(R) { None } else { self.rigidity };
        let mut out = Vec::with_capacity(bytes.len() + bytes.len() / 8);
        let mut copied = self.write_header(appended.is_some(), &mut out);
        let mut body = Body::new(bytes, self.source.vertex_at, header.encoding);
        for vertex in 0..element.count as usize {
            body.begin().expect("the file was read before");
            for (i, property) in element.properties.iter().enumerate() {
                let range = body.skip(property.kind).expect("the file was read before");
                let super::header::Kind::Scalar(old) = property.kind else { continue };
                let Some(role) = roles.role[i] else { continue };
                let scalar = self.retyped[i].unwrap_or(old);
                let number = self.number(role, vertex, scalar);
                // Bytes of another type are written anew also where the number is the same; text serves both.
                let again = || match header.encoding {
                    Encoding::Binary { big } if scalar != old => Some(old.read(&bytes[range.clone()], big)),
                    _ => None,
                };
                if let Some(number) = number.or_else(again) {
                    out.extend_from_slice(&bytes[copied..range.start]);
                    put(header.encoding, scalar, number, &mut out);
                    copied = range.end;
                }
            }
            if let Some(rigidity) = appended {
                out.extend_from_slice(&bytes[copied..body.at()]);
                copied = body.at();
                if header.encoding == Encoding::Ascii {
                    out.push(b' ');
                }
                put(header.encoding, Scalar::U16, f64::from(rigidity[vertex]), &mut out);
            }
        }
        out.extend_from_slice(&bytes[copied..]);
        out
    }

    /// Writes the header with its new types and properties, and gives the place in the old file behind what was written.
    fn write_header(&self, appends: bool, out: &mut Vec<u8>) -> usize {
        let PlySource { bytes, header, .. } = self.source;
        let element = &header.elements[self.source.vertex];
        let mut copied = 0;
        for (property, retyped) in element.properties.iter().zip(&self.retyped) {
            if let Some(scalar) = retyped {
                out.extend_from_slice(&bytes[copied..property.type_at.start]);
                out.extend_from_slice(scalar.name().as_bytes());
                copied = property.type_at.end;
            }
        }
        if appends {
            out.extend_from_slice(&bytes[copied..element.end]);
            out.extend_from_slice(format!("property ushort {RIGIDITY}{}", header.line_end).as_bytes());
            copied = element.end;
        }
        copied
    }
}

/// A direction in the numbers of a file: of unit length, or of the old length where it is made of whole numbers.
fn stored_direction(old: Vec3, new: Vec3, scalar: Scalar) -> [f64; 3] {
    let Some([low, high]) = scalar.whole_range() else { return new.as_dvec3().to_array() };
    (new.as_dvec3() * old.as_dvec3().length()).to_array().map(|x| x.round().clamp(low, high))
}

/// Appends a number as the file stores it.
fn put(encoding: Encoding, scalar: Scalar, x: f64, out: &mut Vec<u8>) {
    let text = match (encoding, scalar) {
        (Encoding::Binary { big }, _) => return scalar.write(x, big, out),
        (_, Scalar::F32) => shortest_single(x as f32),
        (_, Scalar::F64) => shortest(x),
        _ => (x as i64).to_string(),
    };
    out.extend_from_slice(text.as_bytes());
}
