//! How edges changed in length.

use glam::DVec3;
use pliant_solver::Mesh;
use rayon::prelude::*;

/// Edges to a task: tens of microseconds of work, far above the cost of handing it out.
const PER_TASK: usize = 4096;
/// The largest ratio of lengths that is told apart (by eye: beyond that it is only broken).
const MOST: f64 = 1e6;

/// ln(length now / length at rest) of every edge that has a length at rest. One that lost it altogether counts as shrunk a
/// millionfold.
pub fn stretches(mesh: &Mesh, now: &[DVec3]) -> Vec<f64> {
    let rest = mesh.positions();
    let length = |positions: &[DVec3], [a, b]: [u32; 2]| positions[a as usize].distance(positions[b as usize]);
    let stretch = |&edge: &[u32; 2]| {
        let before = length(rest, edge);
        (before > 0.0).then(|| (length(now, edge) / before).clamp(1.0 / MOST, MOST).ln())
    };
    mesh.edges().par_iter().with_min_len(PER_TASK).filter_map(stretch).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stretch_is_the_logarithm_of_the_ratio_of_lengths() {
        // Vertices 2 and 3 are at one place: the edge between them says nothing.
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Y];
        let mesh = Mesh::new(points, vec![[0, 1, 2], [0, 2, 3]]).expect("sound indices");
        let now = [DVec3::ZERO, 2.0 * DVec3::X, DVec3::ZERO, 0.5 * DVec3::Y];
        let got = stretches(&mesh, &now);
        // 0–1 doubled, 0–2 vanished, 0–3 halved, 1–2 from √2 to 2.
        let expected = [2.0_f64.ln(), -MOST.ln(), -2.0_f64.ln(), 2.0_f64.sqrt().ln()];
        assert_eq!(got.len(), expected.len(), "{got:?}");
        for (got, expected) in got.iter().zip(expected) {
            assert!((got - expected).abs() < 1e-15, "{got}, expected {expected}");
        }
    }
}
