//! Edge weights w_ij (paper eq. 2), raw or made fit for any mesh.
//!
//! Half the sum of the cotangents opposite to an edge. The raw sum is negative where angles are obtuse and infinite
//! where a face has no area. With neighborhoods of different sizes the weights are multiplied by unequal counts d_ij,
//! which breaks the guarantee that the cotangent Laplacian is positive semidefinite; hence the default:
//!
//! - the sides of a face that is nearly flat are lengthened a little, for the weights only;
//! - cotangents are capped;
//! - what remains below a small fraction of the median weight is raised to it.
//!
//! On a mesh without slivers and obtuse angles nothing of this changes a weight.

use glam::DVec3;

use crate::Mesh;
use crate::analysis::topology::NO_EDGE;

/// How edges are weighted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weights {
    /// Cotangents, with slivers tamed and clamped to a small positive fraction of the median: never fails.
    #[default]
    Clamped,
    /// Cotangents as in the paper (eq. 2): no clamp, cap or mollification. May make the system indefinite.
    Cotangent,
    /// 1 for every edge.
    Uniform,
}

/// Excess of two sides over the third, in longest sides, below which a face is lengthened: an angle of about 0.3°
/// (by eye: far below what meshes have on purpose).
const MOLLIFY: f64 = 1e-5;
/// Cotangent of one degree: no angle counts for more.
const LARGEST_COTANGENT: f64 = 57.289_961_630_759_42;
/// The smallest clamped weight as a fraction of the median of the positive ones. By eye: small enough to leave the
/// right angles of a grid (cotangent 0) without influence, large enough for a well-conditioned system.
const SMALLEST_OF_MEDIAN: f64 = 1e-3;

/// One weight per edge of the mesh, in the order of [`Mesh::edges`]; always finite, and positive unless raw.
/// `sides`: edges at the sides of every face, see [`sides_of_faces`](crate::analysis::topology::sides_of_faces).
pub(crate) fn edge_weights(mesh: &Mesh, sides: &[[u32; 3]], weights: Weights) -> Vec<f64> {
    match weights {
        Weights::Uniform => vec![1.0; mesh.n_edges()],
        Weights::Cotangent => summed(mesh, sides, raw_cotangents),
        Weights::Clamped => {
            let mut w = summed(mesh, sides, |corners| {
                tame_cotangents(corners).map(|c| c.clamp(-LARGEST_COTANGENT, LARGEST_COTANGENT))
            });
            clamp(&mut w);
            w
        }
    }
}

/// Sums half of each face's cotangents (given its sides) over its edges; values that are not finite contribute nothing.
fn summed(mesh: &Mesh, sides: &[[u32; 3]], cotangents: impl Fn([DVec3; 3]) -> [f64; 3]) -> Vec<f64> {
    let mut w = vec![0.0; mesh.n_edges()];
    for (&face, edges) in mesh.triangles().iter().zip(sides) {
        if edges.contains(&NO_EDGE) {
            continue;
        }
        let cot = cotangents(unit_sides(face.map(|v| mesh.positions()[v as usize])));
        for (corner, cot) in cot.into_iter().enumerate() {
            if cot.is_finite() {
                w[edges[(corner + 1) % 3] as usize] += 0.5 * cot;
            }
        }
    }
    w
}

/// The sides opposite to the corners of a face, one after the other around it, divided by the largest coordinate of
/// any: products of lengths neither overflow nor vanish, whatever the unit.
pub(crate) fn unit_sides(p: [DVec3; 3]) -> [DVec3; 3] {
    let sides: [DVec3; 3] = std::array::from_fn(|corner| p[(corner + 2) % 3] - p[(corner + 1) % 3]);
    let size = sides.iter().map(|s| s.abs().max_element()).fold(0.0, f64::max);
    // By division: the reciprocal of a very small number overflows.
    if size > 0.0 { sides.map(|s| s / size) } else { sides }
}

/// Cotangent of the angle at each corner; not finite for a face without area.
fn raw_cotangents(sides: [DVec3; 3]) -> [f64; 3] {
    std::array::from_fn(|corner| {
        let (u, v) = (sides[(corner + 2) % 3], -sides[(corner + 1) % 3]);
        u.dot(v) / u.cross(v).length()
    })
}

/// As [`raw_cotangents`], from lengthened sides where the face is nearly flat.
fn tame_cotangents(sides: [DVec3; 3]) -> [f64; 3] {
    let side = sides.map(DVec3::length);
    let [a, b, c] = side;
    let longest = a.max(b).max(c);
    if longest == 0.0 {
        // All corners in one place: as good as equilateral.
        return [1.0 / 3f64.sqrt(); 3];
    }
    let lacking = MOLLIFY * longest - (a + b + c - 2.0 * longest);
    if lacking <= 0.0 {
        return raw_cotangents(sides);
    }
    let [a, b, c] = side.map(|s| (s + lacking) / longest);
    let area = (0.25 * ((a + b + c) * (b + c - a) * (c + a - b) * (a + b - c)).max(0.0)).sqrt() * 0.5;
    [(b * b + c * c - a * a), (c * c + a * a - b * b), (a * a + b * b - c * c)].map(|x| x / (4.0 * area))
}

/// Raises what is too small; all ones if nothing is positive.
fn clamp(w: &mut [f64]) {
    let mut positive: Vec<f64> = w.iter().copied().filter(|&x| x > 0.0).collect();
    if positive.is_empty() {
        w.fill(1.0);
        return;
    }
    let middle = positive.len() / 2;
    let (_, median, _) = positive.select_nth_unstable_by(middle, f64::total_cmp);
    let smallest = SMALLEST_OF_MEDIAN * *median;
    w.iter_mut().for_each(|x| *x = x.max(smallest));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::topology::sides_of_faces;

    fn weights_of(points: &[[f64; 3]], faces: &[[u32; 3]], weights: Weights) -> Vec<f64> {
        let mesh = Mesh::new(points.iter().map(|&p| p.into()).collect(), faces.to_vec()).expect("valid");
        edge_weights(&mesh, &sides_of_faces(&mesh), weights)
    }

    #[test]
    fn an_equilateral_triangle_has_half_the_cotangent_of_sixty_degrees() {
        let h = 0.75f64.sqrt();
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, h, 0.0]];
        for kind in [Weights::Clamped, Weights::Cotangent] {
            for w in weights_of(&points, &[[0, 1, 2]], kind) {
                assert!((w - 0.5 / 3f64.sqrt()).abs() < 1e-15, "{w}");
            }
        }
    }

    #[test]
    fn clamped_weights_are_positive_and_finite_on_any_face() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1e-9, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
        let faces = [[0, 1, 2], [0, 1, 3], [0, 4, 1], [0, 0, 4], [4, 4, 4]];
        for w in weights_of(&points, &faces, Weights::Clamped) {
            assert!(w.is_finite() && w > 0.0, "{w}");
        }
        for w in weights_of(&points, &faces, Weights::Cotangent) {
            assert!(w.is_finite(), "{w}");
        }
    }

    #[test]
    fn mollified_and_exact_cotangents_agree_at_the_border() {
        // A face whose sides lack exactly nothing, and one that lacks a little: no jump between the two formulas.
        let border = (0.5 * MOLLIFY * (0.5 * MOLLIFY + 1.0) * 0.25 * 4.0).sqrt() / 2f64.sqrt();
        let face = |factor: f64| unit_sides([DVec3::ZERO, DVec3::X, DVec3::new(0.5, border * factor, 0.0)]);
        let (above, below) = (tame_cotangents(face(1.001)), tame_cotangents(face(0.999)));
        for corner in 0..3 {
            let jump = (above[corner] - below[corner]).abs() / above[corner].abs();
            assert!(jump < 0.01, "corner {corner}: {above:?} {below:?}");
        }
    }
}
