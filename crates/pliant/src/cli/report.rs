//! What `--report` writes: facts, energies and times of one command, in the order of the documented format.

use pliant_meshfile::MeshFile;
use pliant_solver::{Mesh, Rigidity};
use serde::Serialize;

/// How large a mesh is.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct MeshCounts {
    /// As numbered in the file.
    vertices: usize,
    /// After joining vertices at one place.
    surface_points: usize,
    /// Triangles.
    faces: usize,
    edges: usize,
    /// Connected parts; a point that no face uses counts as one.
    components: usize,
}

impl MeshCounts {
    pub(super) fn new(file: &MeshFile, mesh: &Mesh) -> Self {
        MeshCounts {
            vertices: file.positions.len(),
            surface_points: mesh.n_vertices(),
            faces: mesh.n_faces(),
            edges: mesh.n_edges(),
            components: mesh.n_components(),
        }
    }
}

impl MeshCounts {
    pub(super) fn surface_points(&self) -> usize {
        self.surface_points
    }

    pub(super) fn faces(&self) -> usize {
        self.faces
    }

    pub(super) fn components(&self) -> usize {
        self.components
    }
}

impl std::fmt::Display for MeshCounts {
    /// One indented line a count.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "  {:<12}{} ({} surface points)", "vertices", self.vertices, self.surface_points)?;
        writeln!(f, "  {:<12}{}", "faces", self.faces)?;
        writeln!(f, "  {:<12}{}", "edges", self.edges)?;
        writeln!(f, "  {:<12}{}", "components", self.components)
    }
}

/// r over all surface points.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct RigiditySummary {
    min: u16,
    max: u16,
    mean: f64,
}

impl RigiditySummary {
    pub(super) fn new(rigidity: &Rigidity) -> Self {
        RigiditySummary { min: rigidity.min(), max: rigidity.max(), mean: rigidity.mean() }
    }
}

impl RigiditySummary {
    pub(super) fn max(&self) -> u16 {
        self.max
    }
}

impl std::fmt::Display for RigiditySummary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} to {}, mean {:.2}", self.min, self.max, self.mean)
    }
}

/// The report of `deform`; fields in the order in which they are written.
#[derive(Debug, Serialize)]
pub(super) struct DeformReport {
    pub(super) mesh: MeshCounts,
    pub(super) method: &'static str,
    pub(super) solver: &'static str,
    pub(super) weights: &'static str,
    pub(super) threads: usize,
    pub(super) rigidity: RigiditySummary,
    pub(super) converged: bool,
    pub(super) iterations: usize,
    /// Energy after each iteration: eq. (1) in the file's units squared, or that of another method; embedded deformation
    /// measures in extents of the surface.
    pub(super) energies: Vec<f64>,
    /// Largest distance of a held vertex from its target, in the file's units.
    pub(super) max_handle_error: f64,
    /// Pairs of triangles without a common vertex that cross; null unless asked for.
    pub(super) self_intersections: Option<usize>,
    pub(super) times_ms: DeformTimes,
    /// Largest resident size of the process so far; null where the system does not tell.
    pub(super) peak_memory_bytes: Option<u64>,
    pub(super) warnings: Vec<String>,
}

/// Wall-clock times of the stages in milliseconds.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct DeformTimes {
    /// Reading and checking all files.
    pub(super) load: f64,
    /// N(k, r_k) of every vertex.
    pub(super) neighborhoods: f64,
    /// Weights, order and symbolic analysis.
    pub(super) order: f64,
    /// Assembly and numeric factorization.
    pub(super) factorize: f64,
    /// The start and all iterations.
    pub(super) iterate: f64,
    pub(super) iteration_median: f64,
    pub(super) local_median: f64,
    pub(super) global_median: f64,
    pub(super) save: f64,
    /// From the start of the command until OUT is in place, the check for crossings included.
    pub(super) total: f64,
}

/// The report of `learn`; fields in the order in which they are written.
#[derive(Debug, Serialize)]
pub(super) struct LearnReport {
    /// As numbered in the file.
    pub(super) vertices: usize,
    pub(super) poses: usize,
    pub(super) r_min: u16,
    pub(super) r_max: u16,
    pub(super) omega: f64,
    pub(super) omega_mode: &'static str,
    /// How many of the vertices got each r, from `r_min`.
    pub(super) histogram: Vec<usize>,
    /// Mean over the surface of the energies for each r, from `r_min`.
    pub(super) mean_energy: Vec<f64>,
    pub(super) times_ms: LearnTimes,
    /// Largest resident size of the process so far; null where the system does not tell.
    pub(super) peak_memory_bytes: Option<u64>,
    pub(super) warnings: Vec<String>,
}

/// Wall-clock times of the stages in milliseconds.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct LearnTimes {
    /// Reading the reference and all poses; all but the first while energies are computed.
    pub(super) load: f64,
    /// Weights, and N(k, r) of every vertex for every r.
    pub(super) neighborhoods: f64,
    /// Energies of all poses, and the choice of r.
    pub(super) energies: f64,
    /// From the start of the command until OUT is in place.
    pub(super) total: f64,
}

/// Bytes by which a report grows after it was first written: digits of times, and what OUT's format could not hold, a
/// few sentences of about 100 bytes.
pub(super) const ROOM_FOR_NEWS: usize = 16 << 10;

/// A report as the text of its file.
pub(super) fn to_json(report: &impl Serialize) -> Vec<u8> {
    let mut json = serde_json::to_vec_pretty(report).expect("numbers, texts and lists always have a JSON form");
    json.push(b'\n');
    json
}

/// The middle value, the mean of the middle two for an even number, 0 for none. `values` ends up in another order.
pub(super) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[middle],
        _ => (values[middle - 1] + values[middle]) / 2.0,
    }
}

/// The largest resident size the process has had, from Linux's own accounts.
#[cfg(target_os = "linux")]
pub(super) fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// Elsewhere the system tells only through calls that need unsafe code.
#[cfg(not(target_os = "linux"))]
pub(super) fn peak_memory_bytes() -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle_value() {
        assert_eq!(median(&mut []), 0.0);
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), 2.5);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn peak_memory_is_at_least_what_was_touched() {
        let touched = vec![1_u8; 8 << 20];
        let peak = peak_memory_bytes().expect("Linux tells");
        assert!(peak >= touched.len() as u64, "{peak}");
    }
}
