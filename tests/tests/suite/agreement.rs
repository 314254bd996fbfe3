//! `pliant deform` against the independent reference of eq. (1): same positions, same energies, same refusals.

use pliant_tests::program::{Folder, handles_json, pliant, read_json, read_positions};
use pliant_tests::reference::{Indefinite, ReferenceWeights, run};
use pliant_tests::shapes::{
    Chance, Shape, Vector, arc_end, bumpy_ball, distance, irregular_sheet, paper_bar, thin_bar,
};

/// Positions agree to this part of the bounding box: OBJ text holds more digits than that, and 25 iterations amplify
/// rounding by far less than the 1e10 between this and 64-bit precision.
const POSITION_TOLERANCE: f64 = 1e-6;
/// Energies are sums without cancellation on the reference's side.
const ENERGY_TOLERANCE: f64 = 1e-8;
const ITERATIONS: usize = 25;

struct Case {
    shape: Shape,
    weights: ReferenceWeights,
    handles: Vec<(usize, Vector)>,
}

impl Case {
    /// Runs both at rigidity `r` (one a vertex) and compares them.
    #[track_caller]
    fn check(&self, r: &[u16]) {
        let label = format!("r from {:?} to {:?}", r.iter().min(), r.iter().max());
        let folder = Folder::new();
        let outcome = self.deform(&folder, r);
        match run(&self.shape, self.weights, r, &self.handles, ITERATIONS) {
            Ok(expected) => {
                assert_eq!(outcome.code, 0, "{label}: {}", outcome.err);
                self.compare_positions(&label, &read_positions(folder.path("out.obj")), &expected.positions);
                compare_energies(&label, &read_json(folder.path("report.json")), &expected.energies);
            }
            Err(Indefinite) => {
                assert_eq!(outcome.code, 1, "{label}: the reference finds no minimum");
                assert!(outcome.err.contains("clamped"), "{label}: {}", outcome.err);
                assert_eq!(folder.names(), ["handles.json", "mesh.obj", "r.json"], "{label}");
            }
        }
    }

    fn check_uniform(&self, r: u16) {
        self.check(&vec![r; self.shape.positions.len()]);
    }

    /// r by chance between 1 and 6, in patches a few vertex numbers long.
    fn check_mixed(&self) {
        let mut chance = Chance::new(7);
        let mut r = Vec::new();
        while r.len() < self.shape.positions.len() {
            let (value, length) = (1 + chance.below(6), 1 + chance.below(20));
            r.extend(vec![value as u16; length as usize]);
        }
        r.truncate(self.shape.positions.len());
        self.check(&r);
    }

    fn deform(&self, folder: &Folder, r: &[u16]) -> pliant_tests::program::Outcome {
        let mesh = folder.write("mesh.obj", self.shape.obj());
        let handles = folder.write("handles.json", handles_json(&self.handles));
        let rigidity = folder.write("r.json", serde_json::to_string(r).expect("a list of numbers"));
        let weights = match self.weights {
            ReferenceWeights::Cotangent => "cotangent",
            ReferenceWeights::Uniform => "uniform",
        };
        let (out, report) = (folder.path("out.obj"), folder.path("report.json"));
        let iterations = ITERATIONS.to_string();
        let mut arguments = vec!["deform", &mesh, "--handles", &handles, "-o", &out, "--report", &report];
        arguments.extend(["--rigidity", &rigidity, "--weights", weights, "--solver", "local-global"]);
        arguments.extend(["--start", "rest", "--tolerance", "0", "--max-iterations", &iterations]);
        pliant(arguments)
    }

    #[track_caller]
    fn compare_positions(&self, label: &str, got: &[Vector], expected: &[Vector]) {
        assert_eq!(got.len(), expected.len(), "{label}: number of vertices");
        let tolerance = POSITION_TOLERANCE * self.shape.diagonal();
        for (vertex, (&got, &expected)) in got.iter().zip(expected).enumerate() {
            let off = distance(got, expected);
            assert!(off <= tolerance, "{label}: vertex {vertex} is {off:e} off: {got:?}, expected {expected:?}");
        }
    }
}

#[track_caller]
fn compare_energies(label: &str, report: &serde_json::Value, expected: &[f64]) {
    let energies = report["energies"].as_array().expect("a list of energies");
    let energies: Vec<f64> = energies.iter().map(|energy| energy.as_f64().expect("a number")).collect();
    assert_eq!(energies.len(), expected.len(), "{label}: number of iterations");
    for (iteration, (got, expected)) in energies.iter().zip(expected).enumerate() {
        let off = ((got - expected) / expected).abs();
        assert!(off <= ENERGY_TOLERANCE, "{label}: iteration {iteration}: {got} is {off:e} off {expected}");
    }
    for (iteration, pair) in energies.windows(2).enumerate() {
        assert!(pair[1] <= pair[0], "{label}: the energy rose after iteration {iteration}: {pair:?}");
    }
}

fn bent_bar(shape: Shape, length: f64) -> Case {
    let fixed = shape.vertices(|position| position[0] == 0.0);
    let carried = shape.vertices(|position| position[0] == length);
    let rest = |&vertex: &usize| (vertex, shape.positions[vertex]);
    let bent = |&vertex: &usize| (vertex, arc_end(shape.positions[vertex], length, 150.0));
    let handles = fixed.iter().map(rest).chain(carried.iter().map(bent)).collect();
    Case { shape, weights: ReferenceWeights::Cotangent, handles }
}

fn twisted_ball(jitter: f64, weights: ReferenceWeights) -> Case {
    let shape = bumpy_ball(3, jitter, 5);
    let bottom = shape.vertices(|position| position[2] < -0.75);
    let top = shape.vertices(|position| position[2] > 0.75);
    // Half a radian about z, then up and aside.
    let (s, c) = 0.5_f64.sin_cos();
    let moved = |[x, y, z]: Vector| [c * x - s * y + 0.4, s * x + c * y, z + 0.5];
    let mut handles: Vec<_> = bottom.iter().map(|&vertex| (vertex, shape.positions[vertex])).collect();
    handles.extend(top.iter().map(|&vertex| (vertex, moved(shape.positions[vertex]))));
    Case { shape, weights, handles }
}

fn lifted_sheet(jitter: f64, weights: ReferenceWeights) -> Case {
    let shape = irregular_sheet(22, 16, jitter, 3);
    let near = shape.vertices(|position| position[0] < 1.5);
    let far = shape.vertices(|position| position[0] > 20.5);
    let mut handles: Vec<_> = near.iter().map(|&vertex| (vertex, shape.positions[vertex])).collect();
    let lifted = |[x, y, z]: Vector| [x - 6.0, y + 1.0, z + 9.0];
    handles.extend(far.iter().map(|&vertex| (vertex, lifted(shape.positions[vertex]))));
    Case { shape, weights, handles }
}

#[test]
fn the_bent_bar_agrees_at_every_rigidity() {
    let case = bent_bar(paper_bar(), 7.5);
    for r in [1, 2, 4, 6, 10] {
        case.check_uniform(r);
    }
    case.check_mixed();
}

#[test]
fn the_bent_thin_bar_agrees_at_every_rigidity() {
    let case = bent_bar(thin_bar(), 36.0);
    for r in [1, 2, 4, 6, 10] {
        case.check_uniform(r);
    }
    case.check_mixed();
}

#[test]
fn irregular_closed_meshes_agree_with_raw_cotangents() {
    let case = twisted_ball(0.15, ReferenceWeights::Cotangent);
    for r in [1, 2, 4, 6, 10] {
        case.check_uniform(r);
    }
    case.check_mixed();
}

#[test]
fn irregular_open_meshes_agree_with_uniform_weights() {
    let case = lifted_sheet(0.35, ReferenceWeights::Uniform);
    for r in [1, 2, 4, 6, 10] {
        case.check_uniform(r);
    }
    case.check_mixed();
}

#[test]
fn raw_cotangents_without_a_minimum_are_refused_exactly_where_the_reference_finds_none() {
    let case = lifted_sheet(0.8, ReferenceWeights::Cotangent);
    let n = case.shape.positions.len();
    let refused = |r: u16| run(&case.shape, case.weights, &vec![r; n], &case.handles, 0).is_err();
    assert!([1, 2, 4].into_iter().any(refused), "the sheet is too tame to show anything");
    for r in [1, 2, 4] {
        case.check_uniform(r);
    }
}
