//! Embedded deformation against its formulas, written out plainly.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use super::affine::{Affine, affine, dot, linear, shift};
use super::*;
use crate::test_support::{Random, arc, box_bar, bumpy_sheet, farthest};
use crate::{Analysis, LooseComponents, Mesh, Start, VertexId, Weights};

/// The bar of the paper: 1154 vertices.
fn bar() -> Mesh {
    box_bar([45, 6, 6], DVec3::new(7.5, 1.0, 1.0))
}

fn embedded(mesh: Mesh, nodes: usize, held: &[VertexId]) -> Embedded {
    let analysis = Arc::new(Analysis::new(Arc::new(mesh), Weights::Clamped));
    let graph = Arc::new(DeformationGraph::new(&analysis, nodes, 4));
    Embedded::new(analysis, graph, held, LooseComponents::KeepAtRest).expect("solvable")
}

fn random_state(n: usize, size: f64, seed: u64) -> Vec<Affine> {
    let mut random = Random::new(seed);
    let mut node = || {
        let turn = DMat3::from_quat(DQuat::from_scaled_axis(random.vector() * 3.0 * size));
        let stretch = DMat3::from_cols(random.vector(), random.vector(), random.vector()) * (0.3 * size);
        affine(turn + stretch, random.vector() * size)
    };
    (0..n).map(|_| node()).collect()
}

/// All residuals, times the roots of their weights, by the formulas of the paper: g, R, t of the nodes, links, and by held
/// vertex its place, nodes with weights, target.
fn residuals(e: &Embedded, x: &[Affine]) -> Vec<f64> {
    let mesh = e.analysis.mesh();
    let unit = |p: DVec3| (p - e.graph.center) / e.graph.size;
    let layout = &e.analysis.layout;
    let place = |node: usize| unit(mesh.positions()[layout.to_caller[e.graph.nodes[node] as usize] as usize]);
    let mut all = Vec::new();
    for x in x {
        let r = linear(x);
        let [a, b, c] = [r.col(0), r.col(1), r.col(2)];
        all.extend([a.dot(b), a.dot(c), b.dot(c), a.dot(a) - 1.0, b.dot(b) - 1.0, c.dot(c) - 1.0]);
    }
    for &[j, k] in &e.graph.links {
        for (j, k) in [(j as usize, k as usize), (k as usize, j as usize)] {
            let r = linear(&x[j]) * (place(k) - place(j)) + place(j) + shift(&x[j]) - (place(k) + shift(&x[k]));
            all.extend(r.to_array().map(|r| r * e.terms.weights.regularity.sqrt()));
        }
    }
    for (v, &target) in e.held.vertices.iter().zip(&e.held.targets) {
        let p = unit(mesh.positions()[v.index()]);
        let mut at = DVec3::ZERO;
        for (j, w) in e.graph.carriers_of(v.index()) {
            let j = j as usize;
            at += w * (linear(&x[j]) * (p - place(j)) + place(j) + shift(&x[j]));
        }
        all.extend((at - unit(target)).to_array().map(|r| r * e.terms.weights.constraint.sqrt()));
    }
    all
}

fn energy_of(residuals: &[f64]) -> f64 {
    residuals.iter().map(|r| r * r).sum()
}

fn bent_sheet(nodes: usize) -> Embedded {
    let mesh = bumpy_sheet(12);
    let held: Vec<VertexId> = (0..144).step_by(13).map(VertexId).collect();
    let mut random = Random::new(21);
    let targets: Vec<DVec3> = held.iter().map(|v| mesh.positions()[v.index()] + random.vector() * 3.0).collect();
    let mut e = embedded(mesh, nodes, &held);
    e.set_targets(&targets).expect("finite");
    e
}

#[test]
fn energy_and_gradient_are_those_of_the_paper_at_random_states() {
    let mut e = bent_sheet(20);
    assert_eq!(e.terms.weights, EnergyWeights { regularity: 10.0, constraint: 100.0 });
    for seed in 0..5 {
        if seed == 3 {
            e.set_weights(EnergyWeights { regularity: 3.0, constraint: 700.0 });
        }
        let mut x = random_state(20, 1.0, seed);
        let expected = energy_of(&residuals(&e, &x));
        let got = e.terms.energy(&x);
        assert!((got - expected).abs() <= 1e-13 * expected, "state {seed}: {got}, expected {expected}");
        let mut gradient = vec![affine::ZERO; 20];
        e.terms.gradient(&x, &mut gradient);
        let size = dot(&gradient, &gradient).sqrt();
        for (j, gradient) in gradient.iter().enumerate() {
            for place in 0..12 {
                let (c, a) = (place / 4, place % 4);
                let at = |x: &mut [Affine], h: f64| {
                    x[j][c][a] += h;
                    let energy = energy_of(&residuals(&e, x));
                    x[j][c][a] -= h;
                    energy
                };
                // E is of fourth degree: a central difference is off by h² times its third derivative.
                let h = 1e-5;
                let slope = (at(&mut x, h) - at(&mut x, -h)) / (2.0 * h);
                let got = 2.0 * gradient[c][a];
                assert!((got - slope).abs() < 1e-7 * size, "state {seed}, node {j}, {c}{a}: {got}, expected {slope}");
            }
        }
    }
}

/// Solves a dense symmetric positive definite system.
fn dense_solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for j in 0..n {
        for i in j + 1..n {
            let factor = a[i][j] / a[j][j];
            let (above, below) = a.split_at_mut(i);
            below[0][j..].iter_mut().zip(&above[j][j..]).for_each(|(x, y)| *x -= factor * y);
            b[i] -= factor * b[j];
        }
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|k| a[i][k] * b[k]).sum();
        b[i] = (b[i] - sum) / a[i][i];
    }
    b
}

#[test]
fn the_step_is_that_of_gauss_newton() {
    let mut e = bent_sheet(12);
    for (seed, size) in [(0, 0.0), (1, 0.05), (2, 0.5)] {
        if seed == 2 {
            e.set_weights(EnergyWeights { regularity: 3.0, constraint: 700.0 });
        }
        let x = random_state(12, size, seed);
        let at = residuals(&e, &x);
        let columns: Vec<Vec<f64>> = (0..144)
            .map(|place| {
                let (j, c, a) = (place / 12, place % 12 / 4, place % 4);
                let moved = |h: f64| {
                    let mut x = x.clone();
                    x[j][c][a] += h;
                    residuals(&e, &x)
                };
                // Residuals are of second degree: a central difference is exact but for rounding.
                let h = 1e-3;
                moved(h).iter().zip(moved(-h)).map(|(a, b)| (a - b) / (2.0 * h)).collect()
            })
            .collect();
        let product = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let matrix: Vec<Vec<f64>> = columns.iter().map(|a| columns.iter().map(|b| product(a, b)).collect()).collect();
        let expected = dense_solve(matrix.clone(), columns.iter().map(|a| -product(a, &at)).collect());
        let mut gradient = vec![affine::ZERO; 12];
        let mut step = vec![affine::ZERO; 12];
        e.terms.gradient(&x, &mut gradient);
        let direction = e.direction.as_mut().expect("nodes are active");
        assert!(direction.find((&e.terms, &e.quadratic), (&x, &gradient), &mut step));
        let got = step.as_flattened().as_flattened();
        // Distance in the norm of the matrix, in which the inner iteration ends at 1e-2 up to the square root of the
        // condition of the preconditioned matrix, below 10.
        let off: Vec<f64> = got.iter().zip(&expected).map(|(a, b)| a - b).collect();
        let size_of = |d: &[f64]| d.iter().zip(&matrix).map(|(x, row)| x * product(row, d)).sum::<f64>().sqrt();
        let (off, whole) = (size_of(&off), size_of(&expected));
        assert!(off < 3e-2 * whole, "state {seed}: off by {off} of {whole}, {} rounds", e.rounds());
    }
}

#[test]
fn a_bar_bent_by_170_degrees_is_settled_after_15_steps_and_energy_never_rises() {
    for nodes in [100, 500] {
        let mesh = bar();
        assert_eq!(mesh.n_vertices(), 1154);
        let (held, targets) = arc(&mesh, 7.5, 170f64.to_radians());
        let mut e = embedded(mesh, nodes, &held);
        e.set_targets(&targets).expect("finite");
        e.start(Start::Auto);
        let mut energies = vec![e.energy()];
        for step in 0..40 {
            let report = e.step();
            assert!(report.energy <= energies[step], "step {step}: {} after {}", report.energy, energies[step]);
            energies.push(report.energy);
        }
        let (after, last) = (energies[15], energies[40]);
        assert!(after - last <= 1e-3 * last, "{nodes} nodes: {after} after 15 steps, {last} after 40: {energies:?}");
        // Handles are soft, but not so soft that the eye sees it: a fiftieth of the bar's thickness from the mean.
        let error = e.largest_handle_error();
        assert!(error < 0.1, "{nodes} nodes: a handle is off by {error}");
    }
}

#[test]
fn rest_is_reproduced_to_the_last_bit() {
    let mesh = bumpy_sheet(30);
    let rest = mesh.positions().to_vec();
    let held = [0, 17, 400].map(VertexId);
    let mut e = embedded(mesh, 50, &held);
    assert_eq!(e.energy(), 0.0);
    assert_eq!(e.step().energy, 0.0);
    assert_eq!(e.positions(), rest);
    assert!(e.largest_handle_error() < 1e-13);
}

#[test]
fn a_rigid_motion_of_the_handles_moves_all() {
    let mesh = bumpy_sheet(30);
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 2.0);
    let expected: Vec<DVec3> = mesh.positions().iter().map(|&p| turn * p + DVec3::new(30.0, -4.0, 7.0)).collect();
    let held = [0, 29, 450, 870].map(VertexId);
    let targets = held.map(|v| expected[v.index()]);
    let mut e = embedded(mesh, 50, &held);
    e.set_targets(&targets).expect("finite");
    e.start(Start::Auto);
    assert_eq!(e.energy(), 0.0, "recognized at once");
    let (v, off) = farthest(&e.positions(), &expected);
    assert!(off < 1e-12 * 50.0, "vertex {v} is off by {off}");
    // And found by steps alone from rest.
    e.start(Start::Rest);
    (0..60).for_each(|_| _ = e.step());
    let (v, off) = farthest(&e.positions(), &expected);
    assert!(off < 1e-6, "vertex {v} is off by {off} after steps from rest, energy {}", e.energy());
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let bent = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mesh = bumpy_sheet(80);
            let held = [0, 79, 3000, 6399].map(VertexId);
            let targets = held.map(|v| mesh.positions()[v.index()] * 1.3);
            let mut e = embedded(mesh, 150, &held);
            e.set_targets(&targets).expect("finite");
            (0..4).for_each(|_| _ = e.step());
            e.positions()
        })
    };
    assert_eq!(bent(1), bent(3));
}

/// Two bars side by side, closer than their nodes are to each other, and a single vertex.
fn two_bars() -> Mesh {
    let one = box_bar([16, 4, 4], DVec3::new(4.0, 1.0, 1.0));
    let n = one.n_vertices() as u32;
    let mut positions = one.positions().to_vec();
    positions.extend(one.positions().iter().map(|&p| p + DVec3::Y * 1.01));
    positions.push(DVec3::new(2.0, 2.0, 5.0));
    let mut triangles = one.triangles().to_vec();
    triangles.extend(one.triangles().iter().map(|t| t.map(|v| v + n)));
    Mesh::new(positions, triangles).expect("two boxes are valid")
}

#[test]
fn components_have_nodes_of_their_own_and_do_not_drag_each_other() {
    let mesh = two_bars();
    let rest = mesh.positions().to_vec();
    let n = (rest.len() - 1) / 2;
    let (held, targets) = arc(&mesh, 4.0, 1.0);
    let below: Vec<_> = held.iter().zip(targets).filter(|(v, _)| v.index() < n).collect();
    let held: Vec<VertexId> = below.iter().map(|(v, _)| **v).collect();
    let targets: Vec<DVec3> = below.iter().map(|(_, target)| *target).collect();
    for (nodes, expected) in [(0, 3), (2, 3), (60, 60), (10_000, rest.len())] {
        let mut e = embedded(two_bars(), nodes, &held);
        assert_eq!(e.graph().n_nodes(), expected, "asked for {nodes}");
        let component = |node: u32| e.analysis.layout.component[e.graph.nodes[node as usize] as usize];
        for &[j, k] in &e.graph.links {
            assert_eq!(component(j), component(k), "link {j} {k}");
        }
        e.set_targets(&targets).expect("finite");
        e.start(Start::Auto);
        (0..5).for_each(|_| _ = e.step());
        let positions = e.positions();
        assert!(positions.iter().all(|p| p.is_finite()), "{nodes} nodes");
        assert_eq!(positions[n..], rest[n..], "{nodes} nodes: what is not held stays");
        assert_ne!(positions[..n], rest[..n], "{nodes} nodes: what is held moves");
    }
}

#[test]
fn other_handles_keep_the_pose_and_bring_the_same_end() {
    let mesh = bar();
    let (held, targets) = arc(&mesh, 7.5, 1.0);
    let mut e = embedded(mesh, 60, &held[..10]);
    (0..3).for_each(|_| _ = e.step());
    e.set_held(&held).expect("in range");
    assert_eq!(e.energy(), 0.0, "targets are where the vertices are");
    e.set_targets(&targets).expect("finite");
    (0..40).for_each(|_| _ = e.step());
    let mut fresh = embedded(bar(), 60, &held);
    fresh.set_targets(&targets).expect("finite");
    (0..40).for_each(|_| _ = fresh.step());
    let (v, off) = farthest(&e.positions(), &fresh.positions());
    assert!(off < 1e-5, "vertex {v} is off by {off}");
}

#[test]
fn from_a_bent_surface_taken_as_rest_nothing_moves_until_a_handle_does() {
    let mesh = bar();
    let (held, targets) = arc(&mesh, 7.5, 1.0);
    let mut e = embedded(mesh, 60, &held);
    e.set_targets(&targets).expect("finite");
    (0..10).for_each(|_| _ = e.step());
    let bent: Arc<[DVec3]> = e.positions().into();
    e.set_rest(bent.clone()).expect("finite");
    let at: Vec<DVec3> = held.iter().map(|v| bent[v.index()]).collect();
    e.set_targets(&at).expect("finite");
    assert_eq!(e.step().energy, 0.0);
    assert_eq!(e.positions(), *bent);
    let lifted: Vec<DVec3> = at.iter().map(|&p| p + DVec3::Z).collect();
    e.set_targets(&lifted).expect("finite");
    (0..15).for_each(|_| _ = e.step());
    for (v, (got, rest)) in e.positions().iter().zip(&*bent).enumerate() {
        assert!(got.distance(*rest + DVec3::Z) < 1e-6, "vertex {v}: {got}, expected {}", *rest + DVec3::Z);
    }
}
