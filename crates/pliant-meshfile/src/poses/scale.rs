//! How much larger a pose is than the reference.
//!
//! Measured by lengths of edges: bending hardly changes them, whereas it changes everything that spans the mesh (a bar
//! bent into a ring has a third of its length from end to end, and about half of the mean distance from its middle).
//! Of the ratios pose / reference over all edges the median is taken, so that parts that do stretch do not count.

use glam::DVec3;

/// The median ratio of edge lengths; none when no edge has a length in both.
pub(super) fn ratio(pose: &[DVec3], reference: &[DVec3], triangles: &[[u32; 3]]) -> Option<f64> {
    let length = |points: &[DVec3], a: u32, b: u32| points[a as usize].distance(points[b as usize]);
    let edges = triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    let mut ratios: Vec<f64> = edges.map(|(a, b)| length(pose, a, b) / length(reference, a, b)).collect();
    ratios.retain(|ratio| ratio.is_finite() && *ratio > 0.0);
    if ratios.is_empty() {
        return None;
    }
    let middle = ratios.len() / 2;
    Some(*ratios.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_of_a_bent_and_partly_stretched_strip_is_that_of_its_unit() {
        let strip = |i: u32| DVec3::new(f64::from(i / 2), f64::from(i % 2), 0.0);
        // Rolled up on a circle with the same arc length between neighbors, in another unit; one end pulled out.
        let rolled = |i: u32| {
            let (sin, cos) = (f64::from(i / 2) * 0.1).sin_cos();
            let pulled = if i > 38 { 3.0 } else { 0.0 };
            100.0 * DVec3::new(10.0 * sin, f64::from(i % 2) + pulled, 10.0 * cos)
        };
        let triangles: Vec<[u32; 3]> = (0..40).map(|i| [i, i + 1, i + 2]).collect();
        let (rest, pose): (Vec<DVec3>, Vec<DVec3>) = (0..42).map(|i| (strip(i), rolled(i))).unzip();
        let got = ratio(&pose, &rest, &triangles).expect("edges");
        // A chord of 0.1 of the circle is 1/2400 shorter than its arc.
        assert!((got / 100.0 - 1.0).abs() < 1.0 / 2000.0, "{got}");
        assert_eq!(ratio(&vec![DVec3::ONE; 42], &rest, &triangles), None);
    }
}
