//! What must hold for any shape: identities of the energy and its two steps.

use glam::{DQuat, DVec3};

use crate::analysis::topology::sides_of_faces;
use crate::analysis::weights::edge_weights;
use crate::test_support::{Random, arc, box_bar, bumpy_sheet, farthest, mixed_rigidity, plain_energy, solver};
use crate::{Mesh, Rigidity, Solver, Start, VertexId, Weights};

/// A sheet with mixed r, three patches held, pulled apart at random.
fn pulled_sheet(weights: Weights) -> (Mesh, Solver, Vec<DVec3>) {
    let mesh = || bumpy_sheet(17);
    let n = mesh().n_vertices();
    let held: Vec<VertexId> = [3, 4, 5, 120, 121, 200, 280].map(VertexId).to_vec();
    let mut random = Random::new(3);
    let targets: Vec<DVec3> = held.iter().map(|v| mesh().positions()[v.index()] + random.vector() * 3.0).collect();
    let mut solver = solver(mesh(), weights, &mixed_rigidity(n, 5), &held);
    solver.set_targets(&targets).expect("finite");
    (mesh(), solver, targets)
}

#[test]
fn handles_at_rest_give_the_rest_pose() {
    let mesh = bumpy_sheet(15);
    let rest = mesh.positions().to_vec();
    let mut solver = solver(mesh, Weights::Clamped, &mixed_rigidity(rest.len(), 4), &[VertexId(0), VertexId(99)]);
    for start in [Start::Keep, Start::Rest, Start::Auto] {
        solver.start(start);
        let report = solver.step();
        assert_eq!(report.energy, 0.0, "{start:?}");
        let (vertex, distance) = farthest(&solver.positions(), &rest);
        assert!(distance < 1e-12, "{start:?}: vertex {vertex} is off by {distance}");
    }
}

#[test]
fn one_rigid_motion_of_all_handles_is_found_with_no_energy() {
    one_rigid_motion_is_found(DVec3::ZERO, 1e-10);
}

#[test]
fn far_from_the_origin_rounded_coordinates_are_no_energy() {
    // Coordinates are rounded by 1e-6 there; a solve spreads that over the sheet.
    one_rigid_motion_is_found(DVec3::splat(1e10), 1e-4);
}

/// `tolerance` is how far vertices may be off.
fn one_rigid_motion_is_found(shift: DVec3, tolerance: f64) {
    let sheet = bumpy_sheet(15);
    let rest: Vec<DVec3> = sheet.positions().iter().map(|&p| p + shift).collect();
    let mesh = Mesh::new(rest.clone(), sheet.triangles().to_vec()).expect("finite");
    let held = [VertexId(0), VertexId(50), VertexId(99), VertexId(200)];
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 2.9);
    let moved: Vec<DVec3> = rest.iter().map(|&p| turn * (p - shift) + shift + DVec3::new(30.0, -5.0, 8.0)).collect();
    let mut solver = solver(mesh, Weights::Clamped, &mixed_rigidity(rest.len(), 4), &held);
    solver.set_targets(&held.map(|v| moved[v.index()])).expect("finite");
    solver.start(Start::Auto);
    let report = solver.step();
    let (vertex, distance) = farthest(&solver.positions(), &moved);
    assert!(distance < tolerance, "vertex {vertex} is off by {distance}");
    assert_eq!(report.energy, 0.0);
}

#[test]
fn a_rigid_motion_of_everything_is_kept_as_it_is() {
    let mesh = bumpy_sheet(15);
    let rest = mesh.positions().to_vec();
    let held = [VertexId(0), VertexId(50), VertexId(99), VertexId(200)];
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 2.9);
    let moved: Vec<DVec3> = rest.iter().map(|&p| turn * p + DVec3::new(30.0, -5.0, 8.0)).collect();
    let mut solver = solver(mesh, Weights::Clamped, &mixed_rigidity(rest.len(), 4), &held);
    solver.set_pose(&moved).expect("finite");
    solver.set_targets(&held.map(|v| moved[v.index()])).expect("finite");
    solver.start(Start::Keep);
    for step in 0..20 {
        assert_eq!(solver.step().energy, 0.0, "step {step}");
        let (vertex, distance) = farthest(&solver.positions(), &moved);
        assert!(distance < 1e-11, "step {step}: vertex {vertex} is off by {distance}");
    }
}

#[test]
fn the_energy_never_rises_after_the_best_start_was_chosen() {
    let (_, mut solver, targets) = pulled_sheet(Weights::Clamped);
    for jump in [1.0, -1.0, 4.0] {
        solver.set_targets(&targets.iter().map(|&t| t * jump).collect::<Vec<_>>()).expect("finite");
        solver.start(Start::Auto);
        let mut before = solver.energy();
        for step in 0..30 {
            let report = solver.step();
            assert!(report.energy <= before, "jump {jump}, step {step}: {} after {before}", report.energy);
            assert!((0.0..1.0).contains(&report.relative_decrease), "jump {jump}, step {step}: {report:?}");
            before = report.energy;
        }
    }
}

#[test]
fn the_energy_never_rises_and_is_that_of_a_direct_sum() {
    for weights in [Weights::Clamped, Weights::Uniform] {
        let (mesh, mut solver, targets) = pulled_sheet(weights);
        let w = edge_weights(&mesh, &sides_of_faces(&mesh), weights);
        let mut before = f64::INFINITY;
        for _ in 0..30 {
            let report = solver.step();
            assert!(report.energy <= before, "{} after {before}", report.energy);
            before = report.energy;
            let r = solver.rigidity().as_slice().to_vec();
            let plain = plain_energy(&mesh, &w, &r, &solver.positions(), &solver.rotations());
            assert!((report.energy - plain).abs() <= 1e-10 * plain, "{} instead of {plain}", report.energy);
            let shares: f64 = solver.vertex_energies().iter().sum();
            assert!((shares - plain).abs() <= 1e-10 * plain, "shares: {shares} instead of {plain}");
        }
        let now = solver.positions();
        for (held, target) in solver.held().iter().zip(targets) {
            assert_eq!(now[held.index()], target, "handle {held:?}");
        }
    }
}

#[test]
fn small_energies_of_large_neighborhoods_keep_eight_digits() {
    // Two sheets, each turned as a whole by another rotation, so that E is far below the sums that cancel.
    let sheet = bumpy_sheet(13);
    let n = sheet.n_vertices();
    let mut positions = sheet.positions().to_vec();
    positions.extend(sheet.positions().iter().map(|&p| p + DVec3::X * 100.0));
    let mut triangles = sheet.triangles().to_vec();
    triangles.extend(sheet.triangles().iter().map(|t| t.map(|v| v + n as u32)));
    let mesh = || Mesh::new(positions.clone(), triangles.clone()).expect("two sheets are valid");
    let w = edge_weights(&mesh(), &sides_of_faces(&mesh()), Weights::Clamped);
    let turns = [DQuat::from_rotation_x(2.0), DQuat::from_rotation_y(-1.0)];
    let held: Vec<VertexId> = [0, 60, 61, 150, n, n + 61, n + 120].map(|v| VertexId(v as u32)).to_vec();
    for r in [6, 10] {
        let mut solver = solver(mesh(), Weights::Clamped, &Rigidity::uniform(2 * n, r), &held);
        for strain in [1e-2, 1e-3, 1e-4, 1e-5] {
            let mut random = Random::new(5);
            let mut moved = |v: &VertexId| turns[v.index() / n] * positions[v.index()] + random.vector() * strain;
            solver.set_targets(&held.iter().map(&mut moved).collect::<Vec<_>>()).expect("finite");
            solver.start(Start::Auto);
            let mut before = f64::INFINITY;
            for _ in 0..5 {
                let got = solver.step().energy;
                assert!(got <= before, "r = {r}, strain {strain}: {got} after {before}");
                before = got;
                let plain =
                    plain_energy(&mesh(), &w, solver.rigidity().as_slice(), &solver.positions(), &solver.rotations());
                assert!(got > 0.0, "r = {r}, strain {strain}: no energy instead of {plain}");
                // Positions of size 100 are rounded by 1e-14: at a strain of 1e-5 that alone is 1e-9 of an edge's share.
                let error = (got - plain).abs() / plain;
                assert!(error <= 1e-8, "r = {r}, strain {strain}: {got} instead of {plain}, off by {error}");
            }
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_bit_and_shared_sums_are_right() {
    // Large enough for every loop to be shared.
    let run = |n_threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().expect("threads are to be had");
        pool.install(|| {
            let mesh = bumpy_sheet(101);
            let n = mesh.n_vertices();
            let held: Vec<VertexId> = [3, 4, 5, 5000, 9000].map(VertexId).to_vec();
            let pull = |(i, v): (usize, &VertexId)| mesh.positions()[v.index()] + DVec3::Z * (i % 2) as f64;
            let targets: Vec<DVec3> = held.iter().enumerate().map(pull).collect();
            let mut solver = solver(mesh, Weights::Clamped, &mixed_rigidity(n, 5), &held);
            solver.set_targets(&targets).expect("finite");
            for _ in 0..4 {
                solver.step();
                let plain: f64 = solver.vertex_energies().iter().sum();
                let energy = solver.energy();
                assert!((energy - plain).abs() <= 1e-9 * plain, "{n_threads} threads: {energy} instead of {plain}");
            }
            (solver.positions(), solver.rotations(), solver.energy().to_bits())
        })
    };
    let (one, two) = (run(1), run(2));
    for v in 0..one.0.len() {
        assert_eq!((one.0[v], one.1[v]), (two.0[v], two.1[v]), "vertex {v}");
    }
    assert_eq!(one.2, two.2);
}

#[test]
fn after_a_global_step_the_gradient_of_the_energy_vanishes() {
    let (mesh, mut solver, _) = pulled_sheet(Weights::Clamped);
    let w = edge_weights(&mesh, &sides_of_faces(&mesh), Weights::Clamped);
    solver.step();
    solver.global_step();
    let (r, rotations) = (solver.rigidity().as_slice().to_vec(), solver.rotations());
    let at = solver.positions();
    let energy = |p: &[DVec3]| plain_energy(&mesh, &w, &r, p, &rotations);
    for vertex in [17usize, 133, 250] {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            // The energy is quadratic: central differences are exact but for rounding.
            let shifted = |h: f64| {
                let mut p = at.clone();
                p[vertex] += axis * h;
                energy(&p)
            };
            let slope = (shifted(0.1) - shifted(-0.1)) / 0.2;
            let curvature = (shifted(0.1) - 2.0 * energy(&at) + shifted(-0.1)) / 0.01;
            assert!(slope.abs() < 1e-9 * curvature, "vertex {vertex}: slope {slope}, curvature {curvature}");
        }
    }
}

#[test]
fn other_sizes_and_handles_later_are_as_good_as_from_the_beginning() {
    let (mesh, mut late, _) = pulled_sheet(Weights::Clamped);
    let n = mesh.n_vertices();
    let held: Vec<VertexId> = [9, 77, 150].map(VertexId).to_vec();
    let targets: Vec<DVec3> = held.iter().map(|v| mesh.positions()[v.index()] * 1.5).collect();
    let rigidity = mixed_rigidity(n, 3);
    late.step();
    late.set_rigidity(&rigidity).expect("one size per vertex");
    late.set_held(&held).expect("in range");
    let mut fresh = solver(mesh, Weights::Clamped, &rigidity, &held);
    for solver in [&mut late, &mut fresh] {
        solver.set_targets(&targets).expect("finite");
        solver.start(Start::Rest);
        (0..5).for_each(|_| {
            solver.step();
        });
    }
    assert_eq!(late.positions(), fresh.positions());
    assert_eq!(late.energy().to_bits(), fresh.energy().to_bits());
}

#[test]
fn moving_and_scaling_the_scene_moves_and_scales_the_answer() {
    let solve = |map: &dyn Fn(DVec3) -> DVec3| {
        let bar = box_bar([20, 3, 3], DVec3::new(6.0, 1.0, 1.0));
        let (held, targets) = arc(&bar, 6.0, 1.5);
        let moved = bar.positions().iter().map(|&p| map(p)).collect();
        let mesh = Mesh::new(moved, bar.triangles().to_vec()).expect("finite");
        assert_eq!(mesh.defects().degenerate_faces, 0);
        let n = mesh.n_vertices();
        let mut solver = solver(mesh, Weights::Clamped, &Rigidity::uniform(n, 2), &held);
        solver.set_targets(&targets.iter().map(|&p| map(p)).collect::<Vec<_>>()).expect("finite");
        solver.start(Start::Rest);
        (0..20).for_each(|_| {
            solver.step();
        });
        solver.positions()
    };
    let plain = solve(&|p| p);
    // Far away, coordinates have only ten digits after the point left; strains of that size are amplified by the solve.
    for (scale, shift, tolerance) in
        [(1e6, 0.0, 1e-9), (1e-6, 0.0, 1e-9), (1e90, 0.0, 1e-9), (1e-90, 0.0, 1e-9), (1.0, 1e6, 1e-6)]
    {
        let shift = DVec3::splat(shift);
        let back: Vec<DVec3> = solve(&|p| p * scale + shift).iter().map(|&p| (p - shift) / scale).collect();
        let (vertex, distance) = farthest(&back, &plain);
        assert!(distance < tolerance, "scale {scale}, shift {shift}: vertex {vertex} is off by {distance}");
    }
}

#[test]
fn relabeled_vertices_relabel_the_answer() {
    let (mesh, mut solver, targets) = pulled_sheet(Weights::Clamped);
    let n = mesh.n_vertices();
    let name = |v: usize| (v * 10 + 3) % n;
    let mut positions = vec![DVec3::ZERO; n];
    let mut r = vec![1; n];
    for v in 0..n {
        positions[name(v)] = mesh.positions()[v];
        r[name(v)] = solver.rigidity().as_slice()[v];
    }
    let triangles = mesh.triangles().iter().map(|t| t.map(|v| name(v as usize) as u32)).collect();
    let other = Mesh::new(positions, triangles).expect("finite");
    let held: Vec<VertexId> = solver.held().iter().map(|v| VertexId(name(v.index()) as u32)).collect();
    let rigidity = Rigidity::new(r).expect("in range");
    let mut renamed = crate::test_support::solver(other, Weights::Clamped, &rigidity, &held);
    renamed.set_targets(&targets).expect("finite");
    (0..20).for_each(|_| {
        solver.step();
        renamed.step();
    });
    let there = renamed.positions();
    let back: Vec<DVec3> = (0..n).map(|v| there[name(v)]).collect();
    let (vertex, distance) = farthest(&back, &solver.positions());
    assert!(distance < 1e-9, "vertex {vertex} is off by {distance}");
}
