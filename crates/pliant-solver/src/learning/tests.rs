//! Energies against slow, direct sums, and what must hold for any poses.

use std::ops::{ControlFlow, RangeInclusive};
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use crate::analysis::topology::sides_of_faces;
use crate::analysis::weights::edge_weights;
use crate::test_support::{Random, box_bar, bumpy_sheet, plain_neighborhood};
use crate::{Analysis, EnergyTable, LearnError, Mesh, PoseLearner, Rigidity, VertexId, Weights};

fn learner(mesh: &Arc<Mesh>, weights: Weights, range: RangeInclusive<u16>) -> PoseLearner {
    let analysis = Arc::new(Analysis::new(mesh.clone(), weights));
    match PoseLearner::new(analysis, range, &mut |_| ControlFlow::Continue(())).expect("a good range") {
        ControlFlow::Continue(learner) => learner,
        ControlFlow::Break(()) => panic!("nobody stopped it"),
    }
}

fn table(mesh: &Arc<Mesh>, weights: Weights, range: RangeInclusive<u16>, poses: &[Vec<DVec3>]) -> EnergyTable {
    let mut learner = learner(mesh, weights, range);
    poses.iter().for_each(|pose| learner.add(pose).expect("a good pose"));
    learner.table().expect("there are poses")
}

/// The best rotation by a one-sided Jacobi singular value decomposition, as in the paper.
fn rotation_by_svd(t: DMat3) -> DMat3 {
    let (mut a, mut v) = (t.to_cols_array_2d().map(DVec3::from), [DVec3::X, DVec3::Y, DVec3::Z]);
    for _ in 0..60 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let (x, y, z) = (a[p].length_squared(), a[q].length_squared(), a[p].dot(a[q]));
            if z.abs() <= 1e-17 * (x * y).sqrt() {
                continue;
            }
            let angle = 0.5 * (2.0 * z).atan2(x - y);
            let (sin, cos) = angle.sin_cos();
            (a[p], a[q]) = (a[p] * cos + a[q] * sin, a[q] * cos - a[p] * sin);
            (v[p], v[q]) = (v[p] * cos + v[q] * sin, v[q] * cos - v[p] * sin);
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| a[j].length().total_cmp(&a[i].length()));
    let [first, second, _] = order.map(|i| v[i]);
    let one = a[order[0]].normalize();
    let other = a[order[1]] - one * one.dot(a[order[1]]);
    let other = other.try_normalize().unwrap_or_else(|| one.any_orthonormal_vector());
    // A third axis by the cross product on both sides: a rotation, whatever the sign of the smallest singular value.
    DMat3::from_cols(one, other, one.cross(other)) * DMat3::from_cols(first, second, first.cross(second)).transpose()
}

/// Mixed Voronoi areas from the angles of every face.
fn areas_by_angles(mesh: &Mesh) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.n_vertices()];
    for face in mesh.triangles() {
        let p = face.map(|v| mesh.positions()[v as usize]);
        let whole = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).length();
        let angle: [f64; 3] = std::array::from_fn(|c| (p[(c + 1) % 3] - p[c]).angle_between(p[(c + 2) % 3] - p[c]));
        for c in 0..3 {
            let (next, last) = ((c + 1) % 3, (c + 2) % 3);
            areas[face[c] as usize] += match angle.iter().position(|&a| a > std::f64::consts::FRAC_PI_2) {
                Some(obtuse) if obtuse == c => whole / 2.0,
                Some(_) => whole / 4.0,
                None => {
                    ((p[next] - p[c]).length_squared() / angle[last].tan()
                        + (p[last] - p[c]).length_squared() / angle[next].tan())
                        / 8.0
                }
            };
        }
    }
    areas
}

/// Eq. of 3.4 by its definition: E(k, r, m) / A(k, r), and Σ |w| (‖e'‖² + ‖e‖²) / A(k, r), which says what rounding is.
fn plain_energy(mesh: &Mesh, w: &[f64], areas: &[f64], (k, r): (u32, u16), pose: &[DVec3]) -> (f64, f64) {
    let edges = plain_neighborhood(mesh, k, r);
    let vectors = |e: usize| {
        let [i, j] = mesh.edges()[e].map(|v| v as usize);
        (mesh.positions()[i] - mesh.positions()[j], pose[i] - pose[j])
    };
    let mut t = DMat3::ZERO;
    let mut vertices = vec![k];
    for &e in &edges {
        let (rest, now) = vectors(e);
        t += DMat3::from_cols(now * rest.x, now * rest.y, now * rest.z) * w[e];
        vertices.extend(mesh.edges()[e]);
    }
    vertices.sort_unstable();
    vertices.dedup();
    let area: f64 = vertices.iter().map(|&v| areas[v as usize]).sum();
    let rotation = rotation_by_svd(t);
    let (mut energy, mut size) = (0.0, 0.0);
    for &e in &edges {
        let (rest, now) = vectors(e);
        energy += w[e] * (now - rotation * rest).length_squared();
        size += w[e].abs() * (now.length_squared() + rest.length_squared());
    }
    (energy / area, size / area)
}

/// A pose of a mesh: bent along x by `bend` radians per unit, with noise, turned, scaled and shifted.
fn pose(mesh: &Mesh, (bend, noise): (f64, f64), turn: DQuat, (scale, shift): (f64, DVec3)) -> Vec<DVec3> {
    let mut random = Random::new(5);
    let bent = |p: DVec3| {
        let (sin, cos) = (bend * p.x).sin_cos();
        if bend == 0.0 { p } else { DVec3::new((1.0 / bend - p.y) * sin, 1.0 / bend - (1.0 / bend - p.y) * cos, p.z) }
    };
    mesh.positions().iter().map(|&p| turn * (bent(p) + random.vector() * noise) * scale + shift).collect()
}

/// All entries of a table against the definition. Edge vectors are differences of rounded numbers, once in the solver and
/// once here, so δ may be off by some 8 units ε of ‖e'‖, and E by 2 √(E · size) ε + size ε².
fn assert_exact(mesh: &Arc<Mesh>, weights: Weights, range: RangeInclusive<u16>, pose: &[DVec3], what: &str) {
    let table = table(mesh, weights, range.clone(), &[pose.to_vec()]);
    let w = edge_weights(mesh, &sides_of_faces(mesh), weights);
    let areas = areas_by_angles(mesh);
    for k in 0..mesh.n_vertices() as u32 {
        for (&got, r) in table.energies(VertexId(k)).iter().zip(range.clone()) {
            let (expected, size) = plain_energy(mesh, &w, &areas, (k, r), pose);
            let unit = 8.0 * f64::EPSILON;
            let floor = 2.0 * (expected.abs() * size).sqrt() * unit + size * unit * unit;
            // Negative weights make E a difference of sums, in the solver as here.
            let floor = if w.iter().any(|&w| w < 0.0) { floor + 64.0 * unit * size } else { floor };
            let tolerance = 1e-9 * expected.abs() + floor;
            assert!(
                (got - expected).abs() <= tolerance,
                "{what}, vertex {k}, r = {r}: {got:e} instead of {expected:e}"
            );
        }
    }
}

#[test]
fn energies_are_those_of_the_definition_wherever_the_pose_lies() {
    let sheet = bumpy_sheet(16);
    let bar = box_bar([14, 3, 3], DVec3::new(4.0, 1.0, 1.0));
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 2.8);
    for (name, mesh) in [("sheet", sheet), ("bar", bar)] {
        for scale in [1e-3, 1.0, 1e3] {
            let points = mesh.positions().iter().map(|&p| p * scale).collect();
            let scaled = Arc::new(Mesh::new(points, mesh.triangles().to_vec()).expect("valid"));
            let shift = DVec3::new(1e4, -3e4, 2e4);
            for (bend, noise) in [(0.0, 0.02), (0.5, 0.0), (-0.3, 1e-6), (0.0, 0.0), (0.0, 3.0)] {
                for (turn, shift) in [(DQuat::IDENTITY, DVec3::ZERO), (turn, shift)] {
                    let pose: Vec<DVec3> =
                        pose(&mesh, (bend, noise), turn, (1.0, shift)).iter().map(|&p| p * scale).collect();
                    let what = format!("{name} × {scale}, bend {bend}, noise {noise}, at {shift}");
                    assert_exact(&scaled, Weights::Clamped, 1..=6, &pose, &what);
                }
            }
        }
    }
}

#[test]
fn raw_weights_may_make_energies_negative_and_they_are_still_those_of_the_definition() {
    let mesh = Arc::new(bumpy_sheet(14));
    let pose = pose(&mesh, (0.4, 0.3), DQuat::from_rotation_y(2.0), (1.0, DVec3::X * 50.0));
    assert_exact(&mesh, Weights::Cotangent, 1..=6, &pose, "raw weights");
    let w = edge_weights(&mesh, &sides_of_faces(&mesh), Weights::Cotangent);
    assert!(w.iter().any(|&w| w < 0.0), "the sheet should have obtuse angles");
    // Seen from one end of the long diagonal of a flat kite, only that edge is longer; its weight is negative.
    let kite = [[-1.0, 0.0], [1.0, 0.0], [0.0, 0.2], [0.0, -0.2]].map(|[x, y]| DVec3::new(x, y, 0.0));
    let mesh = Arc::new(Mesh::new(kite.to_vec(), vec![[0, 1, 2], [1, 0, 3]]).expect("valid"));
    let mut pose = kite.to_vec();
    pose[1].x += 0.1;
    let first = |weights| table(&mesh, weights, 1..=1, &[pose.clone()]).energies(VertexId(0))[0];
    assert!(first(Weights::Cotangent) < 0.0 && first(Weights::Clamped) > 0.0);
}

#[test]
fn any_range_of_r_has_the_columns_of_the_whole() {
    let mesh = Arc::new(bumpy_sheet(20));
    let poses = [pose(&mesh, (0.2, 0.05), DQuat::from_rotation_x(1.0), (1.0, DVec3::ZERO))];
    let whole = table(&mesh, Weights::Clamped, 1..=9, &poses);
    // More columns than a lot has places, and one alone.
    for range in [3..=5, 6..=6, 2..=90] {
        let part = table(&mesh, Weights::Clamped, range.clone(), &poses);
        for v in (0..mesh.n_vertices() as u32).map(VertexId) {
            for (r, &energy) in range.clone().zip(part.energies(v)).filter(|&(r, _)| r <= 9) {
                let expected = whole.energies(v)[usize::from(r) - 1];
                assert!((energy - expected).abs() <= 1e-12 * expected, "{v:?}, r = {r}: {energy} and {expected}");
            }
        }
    }
}

/// Everything that may be wrong with a mesh, in several components.
fn odd_mesh() -> Mesh {
    let sheet = bumpy_sheet(7);
    let mut points = sheet.positions().to_vec();
    let mut faces = sheet.triangles().to_vec();
    let first = points.len() as u32;
    // A book of three faces, one of them twice; a flat strip; a face of one point; a vertex alone.
    points.extend([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, -DVec3::Y].map(|p| p * 2.0 + DVec3::splat(20.0)));
    faces.extend([[0, 1, 2], [0, 1, 3], [1, 0, 4], [0, 1, 2]].map(|face| face.map(|v| v + first)));
    let second = points.len() as u32;
    points.extend((0..4).map(|i| DVec3::new(f64::from(i), 0.0, -5.0)));
    faces.extend([[0, 1, 2], [1, 2, 3]].map(|face| face.map(|v| v + second)));
    points.extend([DVec3::splat(9.0); 4]);
    let third = second + 4;
    faces.push([third, third + 1, third + 2]);
    Mesh::new(points, faces).expect("odd, but valid")
}

#[test]
fn odd_meshes_and_mirrored_or_squashed_poses_give_finite_energies() {
    let mesh = Arc::new(odd_mesh());
    let n = mesh.n_vertices();
    let mirrored: Vec<DVec3> = mesh.positions().iter().map(|&p| p * DVec3::new(-1.0, 1.0, 1.0)).collect();
    let squashed: Vec<DVec3> = mesh.positions().iter().map(|p| DVec3::new(p.x, 0.0, 0.0)).collect();
    let point = vec![DVec3::ONE; n];
    let huge: Vec<DVec3> = mesh.positions().iter().map(|&p| p * 1e98).collect();
    for weights in [Weights::Clamped, Weights::Cotangent, Weights::Uniform] {
        for (pose, name) in [(&mirrored, "mirrored"), (&squashed, "squashed"), (&point, "a point"), (&huge, "huge")] {
            let table = table(&mesh, weights, 1..=12, std::slice::from_ref(pose));
            for v in (0..n as u32).map(VertexId) {
                let row = table.energies(v);
                assert!(row.iter().all(|energy| energy.is_finite()), "{name}, {weights:?}, {v:?}: {row:?}");
            }
            // Without area there is nothing to be measured by, and nothing against the largest r.
            for v in n as u32 - 8..n as u32 {
                assert_eq!(table.energies(VertexId(v)), [0.0; 12], "{name}, {weights:?}, {v}");
                assert_eq!(table.learn(0.1, 1..=12).rigidity.as_slice()[v as usize], 12);
            }
            assert!(table.auto_omega().is_finite() && table.auto_omega() > 0.0);
        }
    }
}

#[test]
fn a_pose_that_is_refused_or_stopped_changes_nothing() {
    let mesh = Arc::new(bumpy_sheet(30));
    let n = mesh.n_vertices();
    let good = pose(&mesh, (0.1, 0.1), DQuat::IDENTITY, (1.0, DVec3::ZERO));
    let mut learner = learner(&mesh, Weights::Clamped, 1..=6);
    assert_eq!(learner.table().err(), Some(LearnError::NoPoses));
    learner.add(&good).expect("a good pose");
    let before = learner.table().expect("one pose");
    assert_eq!(learner.add(&good[1..]), Err(LearnError::WrongLength { got: n - 1, expected: n }));
    for bad in [f64::NAN, f64::INFINITY, 1e101] {
        let mut pose = good.clone();
        pose[7].z = bad;
        assert_eq!(learner.add(&pose), Err(LearnError::NotFinite { vertex: 7 }));
    }
    for stop_at in [0.0, 0.4, 1.0] {
        let mut told = Vec::new();
        let stopped = learner.add_with_progress(mesh.positions(), &mut |fraction| {
            told.push(fraction);
            if fraction >= stop_at { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert_eq!(stopped, Ok(ControlFlow::Break(())));
        assert!(told.is_sorted_by(|a, b| a < b), "{told:?}");
    }
    assert_eq!(learner.table(), Ok(before.clone()));
    let mut told = Vec::new();
    let added = learner.add_with_progress(mesh.positions(), &mut |fraction| {
        told.push(fraction);
        ControlFlow::Continue(())
    });
    assert_eq!((added, told.last()), (Ok(ControlFlow::Continue(())), Some(&1.0)));
    assert_eq!(learner.n_poses(), 2);
    learner.clear();
    learner.add(&good).expect("a good pose");
    assert_eq!(learner.table(), Ok(before));
}

#[test]
fn a_learner_can_be_stopped_or_refused_while_it_is_made() {
    let analysis = Arc::new(Analysis::new(Arc::new(bumpy_sheet(30)), Weights::Clamped));
    let make = |range, answer: ControlFlow<()>| {
        PoseLearner::new(analysis.clone(), range, &mut |_| answer).map(|made| made.is_break())
    };
    assert_eq!(make(1..=6, ControlFlow::Break(())), Ok(true));
    assert_eq!(make(1..=6, ControlFlow::Continue(())), Ok(false));
    let reversed = RangeInclusive::new(4, 3);
    for range in [0..=6, reversed, 1..=Rigidity::MAX + 1] {
        let (first, last) = (*range.start(), *range.end());
        let refused = Err(LearnError::BadRange { first, last, max: Rigidity::MAX });
        assert_eq!(make(range, ControlFlow::Continue(())), refused);
    }
}

#[test]
fn tables_have_the_same_bits_for_any_number_of_threads_and_whether_or_not_shells_are_kept() {
    let mesh = Arc::new(bumpy_sheet(70));
    let poses = [0.1, 0.3].map(|bend| pose(&mesh, (bend, 0.02), DQuat::from_rotation_z(bend), (1.0, DVec3::Y)));
    let expected = table(&mesh, Weights::Clamped, 1..=6, &poses);
    for n_threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().expect("threads");
        let got = pool.install(|| {
            let mut learner = learner(&mesh, Weights::Clamped, 1..=6);
            if n_threads == 3 {
                learner.forget_shells();
            }
            poses.iter().for_each(|pose| learner.add(pose).expect("a good pose"));
            learner.table()
        });
        assert!(got.as_ref() == Ok(&expected), "{n_threads} threads");
    }
}

#[test]
fn poses_left_out_are_as_if_they_had_never_been_added() {
    let mesh = Arc::new(bumpy_sheet(20));
    let poses = [0.1, 0.2, 0.4].map(|bend| pose(&mesh, (bend, 0.02), DQuat::IDENTITY, (1.0, DVec3::ZERO)));
    let all = table(&mesh, Weights::Clamped, 1..=4, &poses);
    let one = table(&mesh, Weights::Clamped, 1..=4, &poses[1..2]);
    let expected = table(&mesh, Weights::Clamped, 1..=4, &[poses[0].clone(), poses[2].clone()]);
    let got = all.without(&one).expect("two poses are left");
    assert_eq!(got.n_poses(), 2);
    for v in (0..mesh.n_vertices() as u32).map(VertexId) {
        for ((got, expected), all) in got.energies(v).iter().zip(expected.energies(v)).zip(all.energies(v)) {
            assert!((got - expected).abs() <= 1e-14 * all, "{v:?}: {got} instead of {expected}");
        }
    }
    assert_eq!(one.without(&one), None);
    assert_eq!(all.without(&table(&mesh, Weights::Clamped, 1..=3, &poses[..1])), None);
}

#[test]
fn learned_sizes_are_the_arg_min_and_the_larger_of_equals() {
    let rows = [[0.0, 0.0, 0.0, 0.0], [0.1, 0.3, 0.6, 1.0], [0.1, 0.12, 0.5, 0.51], [0.0, 0.25, 0.5, 0.75]];
    let table = EnergyTable::new(2..=5, rows.concat(), 1);
    let sizes = |omega: f64, range| table.learn(omega, range).rigidity.as_slice().to_vec();
    assert_eq!(sizes(0.25, 2..=5), [5, 3, 5, 5], "of 0.3 + 0.5 and 0.1 + 0.75 the first, of equals the largest");
    assert_eq!(sizes(0.05, 2..=5), [5, 2, 3, 2]);
    assert_eq!(sizes(0.25, 3..=4), [4, 3, 3, 4]);
    assert_eq!(sizes(0.05, 7..=9), sizes(0.05, 2..=5), "a range that the table does not have");
    for nonsense in [0.0, -1.0, f64::NAN] {
        assert_eq!(sizes(nonsense, 2..=5), [5, 2, 2, 2], "ω = {nonsense}");
    }
    assert_eq!(sizes(f64::INFINITY, 2..=5), [5, 5, 5, 5]);
    let confidence = table.learn(0.25, 2..=5).confidence;
    let expected = [1.0, 0.2, 0.44, 0.0];
    for (v, (got, expected)) in confidence.iter().zip(expected).enumerate() {
        assert!((got - expected).abs() < 1e-6, "vertex {v}: {got} instead of {expected}");
    }
    assert_eq!(table.learn(0.25, 3..=3).confidence, [1.0; 4]);
}
