//! Whatever the mesh: an answer with finite numbers, or an error that says what to do.

use std::sync::Arc;

use glam::DVec3;

use crate::test_support::solver;
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
fn indefinite_raw_weights_are_an_error_that_names_the_way_out() {
    // Two faces that are obtuse at vertices 2 and 3: the weight of their common edge is negative. Held spikes at both of
    // its ends, with r = 2, count it twice as often as the other sides.
    let mut p = vec![DVec3::ZERO, DVec3::X * 4.0, DVec3::new(2.0, 0.3, 0.0), DVec3::new(2.0, -0.3, 0.0)];
    let mut faces = vec![[0, 1, 2], [1, 0, 3]];
    let mut held = vec![VertexId(2), VertexId(3)];
    for spike in 4..24 {
        p.push(DVec3::new(f64::from(spike), 1.0, 1.0));
        faces.push([spike % 2, spike, spike]);
        held.push(VertexId(spike));
    }
    let rigidity = Rigidity::uniform(p.len(), 2);
    let mesh = Arc::new(Mesh::new(p, faces).expect("valid"));
    let analysis = Arc::new(Analysis::new(mesh, Weights::Cotangent));
    let neighborhoods = Neighborhoods::new(&analysis, &rigidity).expect("one size per vertex");
    let error = Solver::new(analysis, neighborhoods, &rigidity, &held, LooseComponents::KeepAtRest).err();
    let error = error.expect("the negative weight is counted twice");
    assert!(matches!(error, SolveError::Indefinite { .. }));
    assert!(error.to_string().contains("clamped weights"), "{error}");
}
