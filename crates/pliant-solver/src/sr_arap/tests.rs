//! SR-ARAP against its formula, and on the bar.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use super::*;
use crate::analysis::topology::sides_of_faces;
use crate::analysis::weights::edge_weights;
use crate::kernels::rotations::{Ties, best_rotation};
use crate::kernels::sums::outer;
use crate::test_support::{arc, box_bar, bumpy_sheet, farthest};
use crate::{Mesh, Weights};

/// The bar of the paper: 1154 vertices.
fn bar() -> Mesh {
    box_bar([45, 6, 6], DVec3::new(7.5, 1.0, 1.0))
}

fn sr_arap(mesh: Mesh, alpha: f64, held: &[VertexId]) -> SrArap {
    let analysis = Arc::new(Analysis::new(Arc::new(mesh), Weights::Clamped));
    SrArap::new(analysis, alpha, held, LooseComponents::KeepAtRest).expect("solvable")
}

/// The formula, by vertices and their neighbors.
fn plain_energy(mesh: &Mesh, alpha: f64, positions: &[DVec3], rotations: &[DMat3]) -> f64 {
    let w = edge_weights(mesh, &sides_of_faces(mesh), Weights::Clamped);
    let rest = mesh.positions();
    let area: f64 = mesh
        .triangles()
        .iter()
        .map(|t| t.map(|v| rest[v as usize]))
        .map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0)
        .sum();
    let mut energy = 0.0;
    for i in 0..mesh.n_vertices() {
        let neighbors = mesh.neighbors(VertexId(i as u32));
        for &j in neighbors {
            let edge = [j.min(i as u32), j.max(i as u32)];
            let w = w[mesh.edges().binary_search(&edge).expect("neighbors have an edge")];
            let j = j as usize;
            energy += w * (positions[i] - positions[j] - rotations[i] * (rest[i] - rest[j])).length_squared();
            let unlike = (rotations[i] - rotations[j]).to_cols_array();
            energy += alpha * area / neighbors.len() as f64 * unlike.iter().map(|x| x * x).sum::<f64>();
        }
    }
    energy
}

fn bend(mesh: Mesh, minimizer: Minimizer, start: Start, angle: f64) -> SrArap {
    let length = mesh.positions().iter().fold(0.0, |most: f64, p| most.max(p.x));
    let (held, targets) = arc(&mesh, length, angle);
    let mut s = sr_arap(mesh, 0.02, &held);
    s.set_minimizer(minimizer);
    s.set_targets(&targets).expect("finite");
    s.start(start);
    s
}

#[test]
fn energy_is_the_formula_and_falls_with_every_step() {
    for minimizer in [Minimizer::LocalGlobal, Minimizer::Lbfgs] {
        let mut s = bend(box_bar([16, 4, 4], DVec3::new(4.0, 1.0, 1.0)), minimizer, Start::Rest, 2.0);
        let mut last = f64::INFINITY;
        for step in 0..60 {
            let energy = s.step().energy;
            assert!(energy <= last * (1.0 + 1e-12), "{minimizer:?}, step {step}: {energy} after {last}");
            last = energy;
            let expected = plain_energy(s.analysis.mesh(), 0.02, &s.positions(), &s.rotations());
            let off = (energy - expected).abs();
            assert!(off <= 1e-12 * expected, "{minimizer:?}, step {step}: {energy}, expected {expected}");
        }
    }
}

/// Alternating steps with a dense solver and sweeps in the caller's numbering, until nothing moves.
fn reference(mesh: &Mesh, alpha: f64, held: &[VertexId], targets: &[DVec3]) -> (f64, Vec<DVec3>) {
    let n = mesh.n_vertices();
    let rest = mesh.positions();
    let weights = edge_weights(mesh, &sides_of_faces(mesh), Weights::Clamped);
    let mut w = vec![vec![0.0; n]; n];
    for (edge, &weight) in mesh.edges().iter().zip(&weights) {
        let [i, j] = edge.map(|v| v as usize);
        (w[i][j], w[j][i]) = (weight, weight);
    }
    let near: Vec<Vec<usize>> =
        (0..n).map(|v| mesh.neighbors(VertexId(v as u32)).iter().map(|&j| j as usize).collect()).collect();
    let area: f64 = mesh
        .triangles()
        .iter()
        .map(|t| t.map(|v| rest[v as usize]))
        .map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0)
        .sum();
    let mut p = rest.to_vec();
    held.iter().zip(targets).for_each(|(v, &target)| p[v.index()] = target);
    let is_held = |v: usize| held.iter().any(|held| held.index() == v);
    let mut r = vec![DQuat::IDENTITY; n];
    for _ in 0..4000 {
        // Relaxation instead of a solver: five sweeps of Gauss–Seidel over the positions.
        for _ in 0..5 {
            for i in (0..n).filter(|&i| !is_held(i)) {
                let (mut sum, mut pull) = (0.0, DVec3::ZERO);
                for &j in &near[i] {
                    let turned = r[i] * (rest[i] - rest[j]) + r[j] * (rest[i] - rest[j]);
                    pull += w[i][j] * (2.0 * p[j] + turned);
                    sum += 2.0 * w[i][j];
                }
                p[i] = pull / sum;
            }
        }
        for i in 0..n {
            let mut t = DMat3::ZERO;
            for &j in &near[i] {
                t += outer((p[i] - p[j]) * w[i][j], rest[i] - rest[j]);
                let coupling = alpha * area * (1.0 / near[i].len() as f64 + 1.0 / near[j].len() as f64);
                t += DMat3::from_quat(r[j]) * coupling;
            }
            r[i] = best_rotation(t, r[i], Ties::Nearest);
        }
    }
    let rotations: Vec<DMat3> = r.iter().map(|&r| DMat3::from_quat(r)).collect();
    (plain_energy(mesh, alpha, &p, &rotations), p)
}

#[test]
fn the_end_is_that_of_a_plain_iteration_in_another_order() {
    for (mesh, held) in [
        (bumpy_sheet(7), vec![0, 6, 24, 42, 48]),
        (box_bar([6, 2, 2], DVec3::new(3.0, 1.0, 1.0)), vec![0, 1, 20, 40, 41]),
    ] {
        let held: Vec<VertexId> = held.into_iter().map(VertexId).collect();
        let turn = DQuat::from_rotation_z(0.5);
        let half = |p: DVec3| if p.x > 1.5 { turn * p + DVec3::Z * 0.3 } else { p };
        let targets: Vec<DVec3> = held.iter().map(|v| half(mesh.positions()[v.index()])).collect();
        let (expected, at) = reference(&mesh, 0.02, &held, &targets);
        let mut s = sr_arap(mesh, 0.02, &held);
        s.set_minimizer(Minimizer::Lbfgs);
        s.set_targets(&targets).expect("finite");
        s.start(Start::Rest);
        (0..300).for_each(|_| _ = s.step());
        let energy = s.energy();
        assert!((energy - expected).abs() <= 1e-6 * expected, "{energy}, expected {expected}");
        let (v, off) = farthest(&s.positions(), &at);
        assert!(off < 1e-3, "vertex {v} is off by {off}");
    }
}

/// Volume inside a closed surface.
fn volume(positions: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let corners = triangles.iter().map(|t| t.map(|v| positions[v as usize]));
    corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

/// The largest angle between the normals of two faces that share an edge, in degrees.
fn sharpest_fold(positions: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let mut sides = std::collections::BTreeMap::new();
    let mut most: f64 = 0.0;
    for &t in triangles {
        let [a, b, c] = t.map(|v| positions[v as usize]);
        let normal = (b - a).cross(c - a);
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            if let Some(other) = sides.insert((a.min(b), a.max(b)), normal) {
                most = most.max(normal.angle_between(other).to_degrees());
            }
        }
    }
    most
}

#[test]
fn the_bar_bent_by_170_degrees_keeps_its_volume_and_folds_nowhere() {
    for start in [Start::Auto, Start::Rest] {
        let mut s = bend(bar(), Minimizer::Lbfgs, start, 170f64.to_radians());
        let mut iterations = 0;
        let mut quiet = 0;
        while quiet < 3 && iterations < 1000 {
            quiet = if s.step().relative_decrease < 1e-6 { quiet + 1 } else { 0 };
            iterations += 1;
        }
        assert!(iterations < 100, "{start:?}: {iterations} iterations");
        let mesh = s.analysis.mesh().clone();
        let kept = volume(&s.positions(), mesh.triangles()) / volume(mesh.positions(), mesh.triangles());
        assert!(kept >= 0.9, "{start:?}: {kept} of the volume is left");
        let fold = sharpest_fold(&s.positions(), mesh.triangles());
        assert!(fold <= 150.0, "{start:?}: two faces meet at {fold} degrees");
    }
}

#[test]
fn a_rigid_motion_costs_nothing_and_rest_stays() {
    let mesh = bumpy_sheet(20);
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 1.0, -2.0).normalize(), 2.5);
    let expected: Vec<DVec3> = mesh.positions().iter().map(|&p| turn * p + DVec3::new(5.0, 1.0, 2.0)).collect();
    let held = [0, 19, 210, 399].map(VertexId);
    let rest = mesh.positions().to_vec();
    let mut s = sr_arap(mesh, 0.02, &held);
    assert_eq!(s.step().energy, 0.0);
    let (v, off) = farthest(&s.positions(), &rest);
    assert!(off < 1e-12, "vertex {v} is off by {off}");
    s.set_targets(&held.map(|v| expected[v.index()])).expect("finite");
    s.start(Start::Auto);
    assert_eq!(s.energy(), 0.0);
    let (v, off) = farthest(&s.positions(), &expected);
    assert!(off < 1e-10, "vertex {v} is off by {off}");
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let bent = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mesh = bumpy_sheet(80);
            let held = [0, 79, 3000, 6399].map(VertexId);
            let targets = held.map(|v| mesh.positions()[v.index()] * 1.3);
            let mut s = sr_arap(mesh, 0.02, &held);
            s.set_minimizer(Minimizer::Lbfgs);
            s.set_targets(&targets).expect("finite");
            (0..5).for_each(|_| _ = s.step());
            s.positions()
        })
    };
    assert_eq!(bent(1), bent(3));
}
