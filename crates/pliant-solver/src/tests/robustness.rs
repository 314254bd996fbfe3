//! Whatever the mesh: an answer with finite numbers, or an error that says what to do.

use std::sync::Arc;

use glam::DVec3;

use crate::test_support::{box_bar, bumpy_sheet, solver};
use crate::{Analysis, LooseComponents, Mesh, Neighborhoods, Rigidity, SolveError, Solver, Start, VertexId, Weights};

/// A tetrahedron; beside it collinear, repeated, duplicate and non-manifold faces, a second component, a straight chain
/// of collapsed faces, and unreferenced vertices.
fn broken_mesh() -> Mesh {
    let mut p = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    p.extend([DVec3::X * 2.0, DVec3::X * 3.0, DVec3::X, DVec3::splat(9.0)]);
    p.extend((0..4).map(|i| DVec3::new(5.0, i as f64, (i % 2) as f64)));
    p.extend((0..4).map(|i| DVec3::new(0.0, 0.0, 2.0 + i as f64)));
    let faces = vec![
        [0, 2, 1],
        [0, 1, 3],
        [1, 2, 3],
        [0, 3, 2],
        [0, 3, 2],
        [0, 1, 2],
        [1, 4, 5],
        [1, 6, 4],
        [5, 5, 4],
        [8, 9, 10],
        [9, 11, 10],
        [3, 12, 12],
        [12, 13, 13],
        [13, 14, 14],
        [14, 15, 15],
    ];
    Mesh::new(p, faces).expect("valid")
}

#[test]
fn broken_meshes_give_finite_poses() {
    for weights in [Weights::Clamped, Weights::Uniform] {
        for r in [1, 2, 5] {
            let mesh = broken_mesh();
            let n = mesh.n_vertices();
            let mut solver = solver(mesh, weights, &Rigidity::uniform(n, r), &[VertexId(0), VertexId(5)]);
            assert_eq!(solver.loose_components(), &[(1, VertexId(7)), (4, VertexId(8))]);
            solver.set_targets(&[DVec3::ZERO, DVec3::new(-2.0, 2.0, 1.0)]).expect("finite");
            for start in [Start::Keep, Start::Rest, Start::Auto] {
                solver.start(start);
                (0..10).for_each(|_| {
                    solver.step();
                });
                assert!(solver.energy().is_finite());
                for (v, p) in solver.positions().iter().enumerate() {
                    assert!(p.is_finite(), "{weights:?}, r = {r}, {start:?}: vertex {v} at {p}");
                }
            }
        }
    }
}

#[test]
fn loose_components_stay_or_follow_as_asked() {
    let mesh = Arc::new(broken_mesh());
    let rigidity = Rigidity::uniform(mesh.n_vertices(), 2);
    let analysis = Arc::new(Analysis::new(mesh.clone(), Weights::Clamped));
    for (policy, shift) in [(LooseComponents::KeepAtRest, DVec3::ZERO), (LooseComponents::FollowNearest, DVec3::Y)] {
        let neighborhoods = Neighborhoods::new(&analysis, &rigidity).expect("one size per vertex");
        let mut solver =
            Solver::new(analysis.clone(), neighborhoods, &rigidity, &[VertexId(5)], policy).expect("solvable");
        solver.set_targets(&[mesh.positions()[5] + DVec3::Y]).expect("finite");
        solver.step();
        for v in 7..12 {
            let (got, expected) = (solver.positions()[v], mesh.positions()[v] + shift);
            assert!(got.distance(expected) < 1e-14, "{policy:?}: vertex {v} at {got} instead of {expected}");
        }
    }
}

#[test]
fn refused_changes_leave_the_solver_as_it_was() {
    let mesh = broken_mesh();
    let n = mesh.n_vertices();
    let mut solver = solver(mesh, Weights::Clamped, &Rigidity::uniform(n, 2), &[VertexId(0)]);
    let before = solver.positions();
    assert_eq!(solver.set_held(&[]), Err(SolveError::NoHandles));
    assert_eq!(solver.set_held(&[VertexId(99)]), Err(SolveError::HeldOutOfRange { vertex: 99, n_vertices: n }));
    assert_eq!(solver.set_held(&[VertexId(1), VertexId(1)]), Err(SolveError::HeldTwice { vertex: 1 }));
    assert_eq!(solver.set_targets(&[DVec3::NAN]), Err(SolveError::TargetNotFinite { vertex: 0 }));
    assert!(matches!(solver.set_targets(&[]), Err(SolveError::WrongLength { got: 0, expected: 1, .. })));
    assert!(matches!(solver.set_rigidity(&Rigidity::uniform(3, 1)), Err(SolveError::WrongLength { .. })));
    assert_eq!(solver.held(), &[VertexId(0)]);
    solver.step();
    assert_eq!(solver.positions(), before);
}

#[test]
fn handles_pulled_to_one_point_give_finite_poses() {
    let mesh = bumpy_sheet(12);
    let n = mesh.n_vertices();
    let held = [VertexId(0), VertexId(1), VertexId(70), VertexId(140)];
    for r in [1, 3] {
        let mut solver = solver(bumpy_sheet(12), Weights::Clamped, &Rigidity::uniform(n, r), &held);
        solver.set_targets(&[DVec3::splat(2.0); 4]).expect("finite");
        for start in [Start::Keep, Start::Rest, Start::Auto] {
            solver.start(start);
            let mut before = f64::INFINITY;
            for _ in 0..10 {
                let energy = solver.step().energy;
                assert!(energy > 0.0 && energy <= before, "r = {r}, {start:?}: {energy} after {before}");
                before = energy;
            }
            for (v, p) in solver.positions().iter().enumerate() {
                assert!(p.is_finite(), "r = {r}, {start:?}: vertex {v} at {p}");
            }
        }
    }
}

#[test]
fn a_vertex_of_no_face_far_away_takes_no_digit_from_the_energy() {
    let bar = box_bar([2, 2, 10], DVec3::new(1.0, 1.0, 5.0));
    let energy_with = |stray: Option<DVec3>| {
        let points = bar.positions().iter().copied().chain(stray).collect();
        let mesh = Mesh::new(points, bar.triangles().to_vec()).expect("valid");
        let ends = (0..bar.n_vertices()).filter(|&v| [0.0, 5.0].contains(&bar.positions()[v].z));
        let held: Vec<VertexId> = ends.map(|v| VertexId(v as u32)).collect();
        let lifted = |v: &VertexId| {
            let p = bar.positions()[v.index()];
            if p.z == 0.0 { p } else { p + DVec3::X * 0.01 }
        };
        let targets: Vec<DVec3> = held.iter().map(lifted).collect();
        let n = mesh.n_vertices();
        let mut solver = solver(mesh, Weights::Clamped, &Rigidity::uniform(n, 1), &held);
        solver.set_targets(&targets).expect("finite");
        (0..5).map(|_| solver.step().energy).last().expect("five steps")
    };
    let (alone, beside) = (energy_with(None), energy_with(Some(DVec3::splat(1e12))));
    assert!(alone > 0.0);
    // The stray vertex changes the order of sums only.
    assert!((alone - beside).abs() <= 1e-9 * alone, "got {beside}, expected {alone}");
}

#[test]
fn a_mesh_without_any_edge_only_moves_what_is_held() {
    // Enough vertices for the factorization of large systems.
    let p: Vec<DVec3> = (0..600).map(|v| DVec3::new(f64::from(v), 0.0, 1.0)).collect();
    let faces = (0..600).map(|v| [v, v, v]).collect();
    let mesh = Mesh::new(p.clone(), faces).expect("valid");
    let mut solver = solver(mesh, Weights::Clamped, &Rigidity::uniform(600, 2), &[VertexId(7)]);
    assert_eq!(solver.loose_components().len(), 599);
    solver.set_targets(&[DVec3::splat(-1.0)]).expect("finite");
    for start in [Start::Keep, Start::Rest, Start::Auto] {
        solver.start(start);
        assert_eq!(solver.step().energy, 0.0, "{start:?}");
        for (v, now) in solver.positions().into_iter().enumerate() {
            let expected = if v == 7 { DVec3::splat(-1.0) } else { p[v] };
            assert_eq!(now, expected, "{start:?}: vertex {v}");
        }
    }
}

/// Two faces that are obtuse at vertices 2 and 3: the weight of their common edge is negative. Held spikes at both of
/// its ends, with r = 2, count it twice as often as the other sides.
fn spiked_pair() -> (Mesh, Vec<VertexId>) {
    let mut p = vec![DVec3::ZERO, DVec3::X * 4.0, DVec3::new(2.0, 0.3, 0.0), DVec3::new(2.0, -0.3, 0.0)];
    let mut faces = vec![[0, 1, 2], [1, 0, 3]];
    let mut held = vec![VertexId(2), VertexId(3)];
    for spike in 4..24 {
        p.push(DVec3::new(f64::from(spike), 1.0, 1.0));
        faces.push([spike % 2, spike, spike]);
        held.push(VertexId(spike));
    }
    (Mesh::new(p, faces).expect("valid"), held)
}

#[test]
fn indefinite_raw_weights_are_an_error_that_names_the_way_out() {
    let (mesh, held) = spiked_pair();
    let rigidity = Rigidity::uniform(mesh.n_vertices(), 2);
    let analysis = Arc::new(Analysis::new(Arc::new(mesh), Weights::Cotangent));
    let neighborhoods = Neighborhoods::new(&analysis, &rigidity).expect("one size per vertex");
    let error = Solver::new(analysis, neighborhoods, &rigidity, &held, LooseComponents::KeepAtRest).err();
    let error = error.expect("the negative weight is counted twice");
    assert!(matches!(error, SolveError::Indefinite { .. }));
    assert!(error.to_string().contains("clamped weights"), "{error}");
}

#[test]
fn a_change_refused_as_indefinite_leaves_the_next_step_bitwise_the_same() {
    // There is nothing indefinite with one end of the negative edge held, or with r = 1.
    for by_rigidity in [true, false] {
        let new = || {
            let (mesh, mut held) = spiked_pair();
            let n = mesh.n_vertices();
            let bad_held = held.clone();
            if !by_rigidity {
                held.push(VertexId(0));
            }
            let r = if by_rigidity { 1 } else { 2 };
            let mut solver = solver(mesh, Weights::Cotangent, &Rigidity::uniform(n, r), &held);
            let rest = solver.positions();
            let targets: Vec<DVec3> = held.iter().map(|v| rest[v.index()] + DVec3::Z * f64::from(v.0 % 3)).collect();
            solver.set_targets(&targets).expect("finite");
            solver.step();
            (solver, bad_held, Rigidity::uniform(n, 2))
        };
        let (mut untouched, ..) = new();
        let (mut refused, bad_held, bad_rigidity) = new();
        let error = if by_rigidity { refused.set_rigidity(&bad_rigidity) } else { refused.set_held(&bad_held) };
        assert!(matches!(error, Err(SolveError::Indefinite { .. })), "by rigidity {by_rigidity}: {error:?}");
        assert_eq!(refused.step(), untouched.step(), "by rigidity {by_rigidity}");
        assert_eq!(refused.positions(), untouched.positions(), "by rigidity {by_rigidity}");
        assert_eq!(refused.rotations(), untouched.rotations(), "by rigidity {by_rigidity}");
    }
}
