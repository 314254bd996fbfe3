//! Cutting polygons into triangles without turning one over.
//!
//! **Idea.** Project along the polygon's own normal (Newell's, which exists for bent polygons too) and cut off ears: a
//! convex corner whose triangle contains no other corner. Every corner of the polygon stays a corner of some triangle,
//! also where it lies on a straight edge, since its neighbor across that edge may be attached to it; this is why no
//! triangulation library is used, they drop such corners.

use glam::{DVec2, DVec3};

/// Corner-in-triangle tests spent on the polygons of one file before the rest is fanned. A concave quad takes less than
/// ten, so that any mesh within the triangle budget is cut with care, and hostile outlines take about a second.
pub(crate) const MAX_TESTS: u64 = 300_000_000;

/// Appends `corners.len() - 2` triangles of local corner indices (0-based) that cover the polygon, in its orientation.
///
/// The first triangle begins with corner 0, so that the polygon can be listed as it was. Takes what it needs from
/// `tests`; without any left it cuts a fan.
pub(crate) fn triangulate(corners: &[DVec3], tests: &mut u64, out: &mut Vec<[u32; 3]>) {
    let n = corners.len();
    if n == 3 {
        out.push([0, 1, 2]);
        return;
    }
    if n < 3 {
        return;
    }
    let flat = project(corners);
    let convex = |[a, b, c]: [usize; 3]| cross(flat[a], flat[b], flat[c]) > 0.0;
    let reflex: Vec<usize> = (0..n).filter(|&i| !convex([(i + n - 1) % n, i, (i + 1) % n])).collect();
    if reflex.is_empty() {
        fan(&(0..n).collect::<Vec<_>>(), out);
        return;
    }
    let start = out.len();
    clip_ears(&flat, reflex, tests, out);
    let cut = &mut out[start..];
    if let Some(first) = cut.iter().position(|triangle| triangle.contains(&0)) {
        cut.swap(0, first);
        let turns = cut[0].iter().position(|&corner| corner == 0).unwrap_or(0);
        cut[0].rotate_left(turns);
    }
}

/// Fan around corner 0 of `ring`.
fn fan(ring: &[usize], out: &mut Vec<[u32; 3]>) {
    for pair in ring[1..].windows(2) {
        out.push([ring[0] as u32, pair[0] as u32, pair[1] as u32]);
    }
}

fn clip_ears(flat: &[DVec2], mut reflex: Vec<usize>, tests: &mut u64, out: &mut Vec<[u32; 3]>) {
    let n = flat.len();
    let mut next: Vec<usize> = (0..n).map(|i| (i + 1) % n).collect();
    let mut previous: Vec<usize> = (0..n).map(|i| (i + n - 1) % n).collect();
    let (mut corner, mut left, mut refused) = (0, n, 0);
    while left > 3 && *tests > 0 {
        let (a, b, c) = (previous[corner], corner, next[corner]);
        *tests = tests.saturating_sub(reflex.len() as u64 + 1);
        let is_ear = cross(flat[a], flat[b], flat[c]) > 0.0
            && !reflex.iter().any(|&i| i != a && i != b && i != c && contains(flat, [a, b, c], i));
        // An outline that crosses itself may have no ear; cutting any corner then still ends.
        if is_ear || refused > left {
            out.push([a as u32, b as u32, c as u32]);
            (next[a], previous[c]) = (c, a);
            left -= 1;
            refused = 0;
            reflex.retain(|&i| i != b && cross(flat[previous[i]], flat[i], flat[next[i]]) <= 0.0);
            // Step over the next corner, so that round outlines are not cut into a fan of slivers.
            corner = next[c];
        } else {
            refused += 1;
            corner = c;
        }
    }
    let mut ring = vec![corner];
    while ring.len() < left {
        corner = next[corner];
        ring.push(corner);
    }
    fan(&ring, out);
}

fn contains(flat: &[DVec2], [a, b, c]: [usize; 3], point: usize) -> bool {
    let (a, b, c, p) = (flat[a], flat[b], flat[c], flat[point]);
    // A corner that touches the outline twice coincides with a corner of the ear and does not block it.
    p != a && p != c && cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0
}

fn cross(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - b)
}

/// Drops the coordinate along which the polygon's normal is largest, keeping its orientation counterclockwise.
fn project(corners: &[DVec3]) -> Vec<DVec2> {
    let origin = corners[0];
    let mut normal = DVec3::ZERO;
    for (i, &corner) in corners.iter().enumerate() {
        normal += (corner - origin).cross(corners[(i + 1) % corners.len()] - origin);
    }
    let size = normal.abs();
    let flat = |p: DVec3| {
        let p = p - origin;
        if size.x >= size.y && size.x >= size.z {
            DVec2::new(p.y, p.z * normal.x.signum())
        } else if size.y >= size.z {
            DVec2::new(p.z, p.x * normal.y.signum())
        } else {
            DVec2::new(p.x, p.y * normal.z.signum())
        }
    };
    corners.iter().map(|&p| flat(p)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn areas(outline: &[DVec3]) -> Vec<f64> {
        let mut triangles = Vec::new();
        triangulate(outline, &mut MAX_TESTS.clone(), &mut triangles);
        assert_eq!(triangles.len(), outline.len() - 2);
        assert_eq!(triangles[0][0], 0, "the first triangle begins with the first corner");
        triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| outline[i as usize]);
                (b - a).cross(c - a).z / 2.0
            })
            .collect()
    }

    #[test]
    fn concave_polygons_are_covered_without_a_flip() {
        let arrow = [(0.0, 0.0), (2.0, -1.0), (0.0, 3.0), (-2.0, -1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        for start in 0..4 {
            let mut outline = arrow;
            outline.rotate_left(start);
            let areas = areas(&outline);
            assert!(areas.iter().all(|&a| a > 0.0), "start {start}: areas {areas:?}");
            assert!((areas.iter().sum::<f64>() - 6.0).abs() < 1e-12, "start {start}: areas {areas:?}");
        }
    }

    #[test]
    fn a_corner_on_a_straight_edge_stays_attached() {
        let outline = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let areas = areas(&outline);
        assert!(areas.iter().all(|&a| a > 0.0), "areas {areas:?}");
        assert!((areas.iter().sum::<f64>() - 4.0).abs() < 1e-12);
    }

    #[test]
    fn hostile_outlines_end_soon() {
        let zigzag: Vec<DVec3> =
            (0..65_536).map(|i| DVec3::new(f64::from(i), f64::from(i % 2) * 1e-3, f64::from(i % 3))).collect();
        // A tenth of the allowance, for the sake of unoptimized tests.
        let (mut triangles, mut tests) = (Vec::new(), MAX_TESTS / 10);
        for round in 1..=3 {
            triangulate(&zigzag, &mut tests, &mut triangles);
            assert_eq!(triangles.len(), round * 65_534);
            assert_eq!(tests, 0, "all polygons of a file share one allowance");
        }
    }
}
