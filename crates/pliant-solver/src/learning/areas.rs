//! The part of the surface that belongs to each vertex: mixed Voronoi areas (Meyer, Desbrun, Schröder and Barr 2003).
//!
//! In a face without an obtuse angle a corner owns what is nearer to it than to the others: an eighth of
//! ‖side‖² cot(angle opposite to the side), summed over its two sides. In an obtuse face that region would leave the
//! face, so the obtuse corner gets half of the face and the others a quarter each. Either way the parts of a face add up
//! to its area, and a face without area has no parts.

use crate::Mesh;
use crate::analysis::weights::unit_sides;

/// Mixed Voronoi area of every vertex, in the caller's numbering; 0 where there are no faces, or flat ones only.
pub(crate) fn mixed_areas(mesh: &Mesh) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.n_vertices()];
    for face in mesh.triangles() {
        let corners = face.map(|v| mesh.positions()[v as usize]);
        let size = (corners[1] - corners[0]).abs().max((corners[2] - corners[1]).abs());
        let size = size.max((corners[0] - corners[2]).abs()).max_element();
        for (&v, part) in face.iter().zip(parts(unit_sides(corners))) {
            areas[v as usize] += part * size * size;
        }
    }
    areas
}

/// What each corner owns of a face with these sides, each opposite to its corner.
fn parts(sides: [glam::DVec3; 3]) -> [f64; 3] {
    let twice = sides[0].cross(sides[1]).length();
    if twice == 0.0 {
        return [0.0; 3];
    }
    // Products of the sides at a corner: negative at an obtuse angle.
    let dots: [f64; 3] = std::array::from_fn(|corner| -sides[(corner + 1) % 3].dot(sides[(corner + 2) % 3]));
    if let Some(obtuse) = dots.iter().position(|&dot| dot < 0.0) {
        return std::array::from_fn(|corner| if corner == obtuse { 0.25 * twice } else { 0.125 * twice });
    }
    let shares: [f64; 3] = std::array::from_fn(|corner| sides[corner].length_squared() * dots[corner] / twice);
    std::array::from_fn(|corner| 0.125 * (shares[(corner + 1) % 3] + shares[(corner + 2) % 3]))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::test_support::bumpy_sheet;

    #[test]
    fn parts_of_a_face_are_those_of_its_circumcenter_or_of_its_obtuse_corner() {
        let sides = |points: [[f64; 3]; 3]| unit_sides(points.map(DVec3::from));
        // Right isosceles: the circumcenter is the middle of the long side, so half and two quarters.
        let right = parts(sides([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
        assert!(right.iter().zip([0.25, 0.125, 0.125]).all(|(a, b)| (a - b).abs() < 1e-15), "{right:?}");
        // Just beyond, the other rule: nearly the same parts.
        let obtuse = parts(sides([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1e-9, 1.0, 0.0]]));
        assert!(obtuse.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-8), "{obtuse:?} {right:?}");
        let equilateral = parts(sides([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.75f64.sqrt(), 0.0]]));
        assert!(equilateral.iter().all(|a| (a - 3f64.sqrt() / 12.0).abs() < 1e-15), "{equilateral:?}");
        assert_eq!(parts(sides([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])), [0.0; 3]);
        assert_eq!(parts(sides([[0.0; 3]; 3])), [0.0; 3]);
    }

    #[test]
    fn areas_add_up_to_the_surface_at_any_scale() {
        let sheet = bumpy_sheet(20);
        for scale in [1e-3, 1.0, 1e3] {
            let points = sheet.positions().iter().map(|&p| p * scale).collect();
            let mesh = Mesh::new(points, sheet.triangles().to_vec()).expect("valid");
            let face_area = |face: &[u32; 3]| {
                let [a, b, c] = face.map(|v| mesh.positions()[v as usize]);
                0.5 * (b - a).cross(c - a).length()
            };
            let (whole, parts): (f64, f64) =
                (mesh.triangles().iter().map(face_area).sum(), mixed_areas(&mesh).iter().sum());
            assert!((whole - parts).abs() < 1e-12 * whole, "scale {scale}: {parts} instead of {whole}");
        }
    }
}
