//! L-BFGS: never up, to the same minima, in fewer iterations, remembering what still holds.

use glam::{DQuat, DVec3};

use crate::test_support::{Random, arc, box_bar, bumpy_sheet, farthest, mixed_rigidity, solver};
use crate::{Mesh, Minimizer, Rigidity, Solver, Start, VertexId, Weights};

/// A sheet with mixed r and three patches held.
fn sheet(weights: Weights, most: u16) -> Solver {
    let mesh = bumpy_sheet(17);
    let n = mesh.n_vertices();
    let held: Vec<VertexId> = [3, 4, 5, 120, 121, 200, 280].map(VertexId).to_vec();
    let mut solver = solver(mesh, weights, &mixed_rigidity(n, most), &held);
    solver.set_minimizer(Minimizer::Lbfgs);
    solver
}

fn held_positions(solver: &Solver) -> Vec<DVec3> {
    let now = solver.positions();
    solver.held().iter().map(|v| now[v.index()]).collect()
}

#[test]
fn the_energy_never_rises_in_any_drag() {
    for (weights, most) in [(Weights::Clamped, 1), (Weights::Clamped, 4), (Weights::Uniform, 2)] {
        let mut solver = sheet(weights, most);
        let rest = held_positions(&solver);
        let mut random = Random::new(u64::from(most) + 40);
        for frame in 0..40 {
            // From small moves to wild ones.
            let size = [0.01, 0.3, 2.0, 20.0][frame % 4];
            let targets: Vec<DVec3> = rest.iter().map(|&p| p + random.vector() * size).collect();
            solver.set_targets(&targets).expect("finite");
            if frame % 10 == 9 {
                solver.start(Start::Auto);
            }
            let mut before = f64::INFINITY;
            for step in 0..12 {
                let report = solver.step();
                let case = format!("{weights:?}, r to {most}, frame {frame}, step {step}");
                assert!(report.energy <= before, "{case}: {} after {before}", report.energy);
                let shares: f64 = solver.vertex_energies().iter().sum();
                assert!((report.energy - shares).abs() <= 1e-9 * shares, "{case}: {} is {shares}", report.energy);
                before = report.energy;
            }
            assert_eq!(held_positions(&solver), targets, "{weights:?}, r to {most}, frame {frame}");
        }
    }
}

/// A slender bar bent by 70°.
fn bent_bar(r: u16) -> Solver {
    let bar = box_bar([36, 3, 3], DVec3::new(12.0, 1.0, 1.0));
    let n = bar.n_vertices();
    let (held, targets) = arc(&bar, 12.0, 70f64.to_radians());
    let mut solver = solver(bar, Weights::Clamped, &Rigidity::uniform(n, r), &held);
    solver.set_targets(&targets).expect("finite");
    solver
}

fn energies_from_rest(solver: &mut Solver, minimizer: Minimizer, count: usize) -> Vec<f64> {
    solver.set_minimizer(minimizer);
    solver.start(Start::Rest);
    (0..count).map(|_| solver.step().energy).collect()
}

#[test]
fn it_arrives_at_least_as_low_in_less_than_half_as_many_iterations() {
    for r in [1, 2] {
        let mut solver = bent_bar(r);
        let plain = energies_from_rest(&mut solver, Minimizer::LocalGlobal, 1000);
        let quick = energies_from_rest(&mut solver, Minimizer::Lbfgs, 200);
        let (slow_end, end) = (plain[plain.len() - 1], quick[quick.len() - 1]);
        assert!(end <= slow_end * (1.0 + 1e-6), "r = {r}: {end} after 200, {slow_end} after 1000 plain ones");
        let arrival = |energies: &[f64]| energies.iter().position(|&energy| energy <= 1.01 * slow_end);
        let (slow, fast) = (arrival(&plain), arrival(&quick));
        let is_faster = slow.zip(fast).is_some_and(|(slow, fast)| 2 * fast < slow);
        assert!(is_faster, "r = {r}: within 1 % at {fast:?} and plainly at {slow:?}");
    }
}

#[test]
fn set_back_to_plain_it_is_as_if_it_had_never_been_otherwise() {
    let mut switched = bent_bar(1);
    energies_from_rest(&mut switched, Minimizer::Lbfgs, 7);
    switched.set_minimizer(Minimizer::LocalGlobal);
    assert_eq!(switched.minimizer(), Minimizer::LocalGlobal);
    let mut untouched = bent_bar(1);
    untouched.start(Start::Rest);
    untouched.set_pose(&switched.positions()).expect("finite");
    switched.set_pose(&untouched.positions()).expect("finite");
    untouched.start(Start::Keep);
    switched.start(Start::Keep);
    for _ in 0..5 {
        assert_eq!(switched.step(), untouched.step());
    }
    assert_eq!(switched.positions(), untouched.positions());
    let again = energies_from_rest(&mut switched, Minimizer::LocalGlobal, 5);
    assert_eq!(again, energies_from_rest(&mut untouched, Minimizer::LocalGlobal, 5));
}

#[test]
fn what_was_learned_stays_while_targets_move_and_goes_with_system_and_pose() {
    let learned = |solver: &mut Solver| {
        solver.start(Start::Keep);
        (0..5).for_each(|_| {
            solver.step();
        });
        assert!(solver.n_pairs() >= 3, "only {} pairs after five steps", solver.n_pairs());
    };
    let mut solver = sheet(Weights::Clamped, 2);
    let pull = |solver: &Solver| -> Vec<DVec3> {
        held_positions(solver).iter().enumerate().map(|(i, &p)| p + DVec3::Z * (i % 2) as f64).collect()
    };
    solver.set_targets(&pull(&solver)).expect("finite");
    learned(&mut solver);
    let before = solver.n_pairs();
    solver.set_targets(&pull(&solver)).expect("finite");
    solver.step();
    assert!(solver.n_pairs() >= before, "{} of {before} pairs after targets moved", solver.n_pairs());
    solver.step();

    let n = solver.positions().len();
    solver.set_rigidity(&mixed_rigidity(n, 3)).expect("one size per vertex");
    assert_eq!(solver.n_pairs(), 0, "after other rigidity");
    learned(&mut solver);
    solver.set_pose(&solver.positions()).expect("finite");
    assert_eq!(solver.n_pairs(), 0, "after another pose");
    learned(&mut solver);
    solver.start(Start::Rest);
    assert_eq!(solver.n_pairs(), 0, "after a start from rest");
    learned(&mut solver);
    solver.set_held(&[VertexId(3), VertexId(200)]).expect("in range");
    assert_eq!(solver.n_pairs(), 0, "after other handles");
}

#[test]
fn one_rigid_motion_of_all_handles_is_kept_with_no_energy() {
    let mut solver = sheet(Weights::Clamped, 4);
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 2.9);
    let moved: Vec<DVec3> = solver.positions().iter().map(|&p| turn * p + DVec3::new(30.0, -5.0, 8.0)).collect();
    let targets: Vec<DVec3> = solver.held().iter().map(|v| moved[v.index()]).collect();
    solver.set_targets(&targets).expect("finite");
    solver.start(Start::Auto);
    for step in 0..10 {
        assert_eq!(solver.step().energy, 0.0, "step {step}");
        let (vertex, distance) = farthest(&solver.positions(), &moved);
        assert!(distance < 1e-10, "step {step}: vertex {vertex} is off by {distance}");
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    // Large enough for every loop to be shared.
    let run = |n_threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().expect("threads are to be had");
        pool.install(|| {
            let mesh = bumpy_sheet(71);
            let n = mesh.n_vertices();
            let held: Vec<VertexId> = [3, 4, 5, 2500, 4500].map(VertexId).to_vec();
            let pull = |(i, v): (usize, &VertexId)| mesh.positions()[v.index()] + DVec3::Z * (i % 2) as f64;
            let targets: Vec<DVec3> = held.iter().enumerate().map(pull).collect();
            let mut solver = solver(mesh, Weights::Clamped, &Rigidity::uniform(n, 1), &held);
            solver.set_minimizer(Minimizer::Lbfgs);
            solver.set_targets(&targets).expect("finite");
            let energies: Vec<u64> = (0..9).map(|_| solver.step().energy.to_bits()).collect();
            (solver.positions(), energies)
        })
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn tiny_and_huge_meshes_bend_like_others() {
    let bend = |scale: f64| {
        let bar = box_bar([20, 3, 3], DVec3::new(6.0, 1.0, 1.0));
        let (held, targets) = arc(&bar, 6.0, 1.5);
        let scaled = bar.positions().iter().map(|&p| p * scale).collect();
        let mesh = Mesh::new(scaled, bar.triangles().to_vec()).expect("finite");
        let n = mesh.n_vertices();
        let mut solver = solver(mesh, Weights::Clamped, &Rigidity::uniform(n, 1), &held);
        solver.set_targets(&targets.iter().map(|&p| p * scale).collect::<Vec<_>>()).expect("finite");
        energies_from_rest(&mut solver, Minimizer::Lbfgs, 20).iter().map(|e| e / scale / scale).collect::<Vec<_>>()
    };
    let plain = bend(1.0);
    // Powers of two change no digit, only exponents.
    for scale in [2f64.powi(300), 2f64.powi(-300)] {
        for (step, (got, expected)) in bend(scale).iter().zip(&plain).enumerate() {
            assert!((got - expected).abs() < 1e-9 * expected, "scale {scale}, step {step}: {got}, not {expected}");
        }
    }
}

#[test]
fn an_iteration_that_gives_way_leaves_the_pose_and_the_next_one_goes_on_downwards() {
    for minimizer in [Minimizer::LocalGlobal, Minimizer::Lbfgs] {
        let mut solver = bent_bar(2);
        solver.set_minimizer(minimizer);
        assert!(solver.step_while(&mut || false).is_some(), "{minimizer:?}: the first after new targets");
        let mut energy = solver.energy();
        for round in 0..20 {
            let (before, iteration) = (solver.positions(), solver.iteration);
            let mut asked = 0;
            let outcome = solver.step_while(&mut || {
                asked += 1;
                asked <= round % 3
            });
            let case = format!("{minimizer:?}, round {round}");
            match outcome {
                None => {
                    assert!(round % 3 < 2, "{case}: it gave way unasked");
                    assert_eq!(solver.positions(), before, "{case}");
                    assert_eq!((solver.energy(), solver.iteration), (energy, iteration), "{case}");
                }
                Some(report) => {
                    assert!(round % 3 == 2, "{case}: it did not give way");
                    assert!(report.energy <= energy, "{case}: {} after {energy}", report.energy);
                    energy = report.energy;
                }
            }
        }
    }
}

#[test]
fn a_local_step_before_new_targets_are_reached_says_nothing_of_the_next() {
    let mut solver = bent_bar(1);
    solver.set_minimizer(Minimizer::Lbfgs);
    (0..5).for_each(|_| {
        solver.step();
    });
    let targets: Vec<DVec3> = held_positions(&solver).iter().map(|&p| p * 1.5).collect();
    solver.set_targets(&targets).expect("finite");
    solver.local_step();
    let report = solver.step();
    assert_eq!(report.relative_decrease, 1.0, "the energy with other targets is no lower or higher: {report:?}");
    assert!(solver.step().relative_decrease >= 0.0);
}
