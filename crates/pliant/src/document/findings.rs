//! What is unusual about an opened mesh, where, and what is made of it.
//!
//! Opening repairs nothing: the file stays as it is, and the solver takes any list of triangles. A finding therefore
//! says what was found, how bending treats it, and which vertices are concerned, so that they can be looked at.

use pliant_meshfile::MeshFile;
use pliant_solver::{Defect, Mesh, VertexId};

/// One thing that was found, at least once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Stable name for programs.
    pub kind: &'static str,
    /// How often.
    pub count: usize,
    /// What was found, with its number: `3 faces without area`.
    pub found: String,
    /// What is made of it.
    pub treatment: &'static str,
    /// Whether it can spoil what bending looks like; the rest is only good to know.
    pub is_suspect: bool,
    defect: Option<Defect>,
}

/// What is asked of every mesh: name, singular, plural, treatment, whether it is suspect.
const DEFECTS: [(Defect, &str, &str, &str, &str, bool); 7] = [
    (
        Defect::NonManifoldEdge,
        "non_manifold_edges",
        "edge with more than two faces",
        "edges with more than two faces",
        "kept: all faces at an edge bend together",
        true,
    ),
    (
        Defect::NonManifoldVertex,
        "non_manifold_vertices",
        "vertex at which separate fans of faces touch",
        "vertices at which separate fans of faces touch",
        "kept: the fans stay together in this point, and can turn about it",
        true,
    ),
    (
        Defect::Degenerate,
        "degenerate_faces",
        "face without area",
        "faces without area",
        "kept: they count as slivers a hair wide, and one with a repeated corner not at all",
        true,
    ),
    (
        Defect::Duplicate,
        "duplicate_faces",
        "face that repeats an earlier one",
        "faces that repeat earlier ones",
        "kept: the surface is that much stiffer there",
        true,
    ),
    (
        Defect::Inconsistent,
        "inconsistent_edges",
        "edge between faces of opposite orientation",
        "edges between faces of opposite orientation",
        "kept: bending does not depend on orientation, shading and normals do",
        true,
    ),
    (Defect::Boundary, "boundary_edges", "edge with one face", "edges with one face", "kept open", false),
    (
        Defect::Unreferenced,
        "unreferenced_vertices",
        "vertex in no face",
        "vertices in no face",
        "kept: they move like a part without a handle",
        false,
    ),
];

/// Everything that was found, what may spoil the result first.
pub fn findings(file: &MeshFile, mesh: &Mesh) -> Vec<Finding> {
    let defects = mesh.defects();
    let mut all = Vec::new();
    for (defect, kind, one, many, treatment, is_suspect) in DEFECTS {
        let count = defects.count(defect);
        let mut found = counted(count, one, many);
        if defect == Defect::Boundary {
            found += &format!(", in {}", counted(defects.borders, "border", "borders"));
        }
        all.push(Finding { kind, count, found, treatment, is_suspect, defect: Some(defect) });
    }
    let mut note = |kind, count, found, treatment| {
        all.push(Finding { kind, count, found, treatment, is_suspect: false, defect: None });
    };
    let parts = mesh.n_components() - defects.unreferenced_vertices;
    note(
        "components",
        if parts > 1 { parts } else { 0 },
        counted(parts, "separate part", "separate parts"),
        "kept: a part without a handle stays, or follows the nearest handle",
    );
    let copies = file.positions.len() - mesh.n_vertices();
    note(
        "welded_vertices",
        copies,
        counted(copies, "copy of a vertex at its place", "copies of vertices at their places"),
        "bent as one vertex, saved apart as they were",
    );
    all.retain(|finding| finding.count > 0);
    all
}

impl Finding {
    /// The vertices concerned, ascending; empty where none stand out.
    pub fn vertices(&self, mesh: &Mesh) -> Vec<VertexId> {
        self.defect.map(|defect| mesh.vertices_with(defect)).unwrap_or_default()
    }

    /// Whether there are vertices to look at.
    pub fn has_place(&self) -> bool {
        self.defect.is_some()
    }
}

/// One sentence about what may spoil the result, if anything was found that may.
pub fn caution(findings: &[Finding]) -> Option<String> {
    let suspects: Vec<&str> =
        findings.iter().filter(|finding| finding.is_suspect).map(|finding| finding.found.as_str()).collect();
    (!suspects.is_empty()).then(|| format!("This mesh has {}. See Mesh at the right.", suspects.join(", ")))
}

fn counted(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn of(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> (Vec<Finding>, Mesh) {
        let file = MeshFile::from_triangles("sheet", positions, triangles);
        let mesh = Mesh::new(file.points(), file.point_triangles()).expect("valid");
        (findings(&file, &mesh), mesh)
    }

    #[test]
    fn a_closed_surface_has_nothing_to_report() {
        let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let (found, _) = of(corners, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
        assert_eq!(found, []);
        assert_eq!(caution(&found), None);
    }

    #[test]
    fn findings_name_number_treatment_and_place() {
        let square = vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y, DVec3::X, DVec3::X + DVec3::Y];
        let (found, mesh) = of(square, vec![[0, 1, 2], [0, 3, 5], [0, 4, 4]]);
        let said: Vec<&str> = found.iter().map(|finding| finding.found.as_str()).collect();
        let expected = [
            "1 face without area",
            "1 edge between faces of opposite orientation",
            "4 edges with one face, in 1 border",
            "2 copies of vertices at their places",
        ];
        assert_eq!(said, expected);
        assert_eq!(found[1].vertices(&mesh), [VertexId(0), VertexId(2)]);
        let caution = caution(&found).expect("two of them may spoil the result");
        assert!(caution.starts_with("This mesh has 1 face without area, 1 edge between"), "{caution}");
    }
}
