//! Rigidity learned from poses: what is known to be stiff comes out stiff, and it predicts poses better than any r that is
//! the same everywhere.

use std::fmt::Write;
use std::ops::ControlFlow;
use std::sync::Arc;

use pliant::learning::leave_one_out::{Options, Report, leave_one_out};
use pliant_solver::{Analysis, Learned, PoseLearner, Weights};
use pliant_tests::pose_sets::PoseSet;

const SETS: [&str; 2] = ["gecko", "jointed-bar"];
/// A joint that bends by less in all poses cannot be told from a bone.
const BENT: f64 = 30.0;
/// Of what may be random motion, in mean edge lengths.
const NOISE: f64 = 0.02;

fn learn(set: &PoseSet, poses: &[usize]) -> Learned {
    let analysis = Arc::new(Analysis::new(set.mesh.clone(), Weights::default()));
    let learner = PoseLearner::new(analysis, 1..=6, &mut |_| ControlFlow::Continue(()));
    let Ok(ControlFlow::Continue(mut learner)) = learner else { panic!("a good range that nobody stopped") };
    poses.iter().for_each(|&pose| learner.add(&set.poses[pose]).expect("a good pose"));
    let table = learner.table().expect("there are poses");
    table.learn(table.auto_omega(), 1..=6)
}

/// Of the vertices more than six edges from all joints the share with r ≥ 5, and of those inside joints, whose edges do
/// not move as one piece, the share with r ≤ 2.
fn shares(set: &PoseSet, learned: &Learned) -> [f64; 2] {
    let r = learned.rigidity.as_slice();
    let share = |of: &dyn Fn(usize) -> bool, wanted: &dyn Fn(u16) -> bool| {
        let of: Vec<usize> = (0..r.len()).filter(|&v| of(v)).collect();
        of.iter().filter(|&&v| wanted(r[v])).count() as f64 / of.len() as f64
    };
    [share(&|v| set.rings[v] > 6, &|r| r >= 5), share(&|v| set.bone[v] < 0, &|r| r <= 2)]
}

/// Checks all sets, spoiled, with three, seven and twelve poses.
#[track_caller]
fn assert_bones_and_joints_are_found(noise: f64, rest_too: bool, scale: f64) {
    let mut failures = String::new();
    for name in SETS {
        let whole = PoseSet::open(name);
        let set = whole.spoiled(noise, rest_too, scale);
        for n in [3, 7, 12] {
            let poses = set.poses_that_bend_every_joint(n, BENT);
            let [stiff, soft] = shares(&set, &learn(&set, &poses));
            if stiff < 0.95 || soft < 0.90 {
                writeln!(failures, "{name}, poses {poses:?}: {stiff:.3} of bones stiff, {soft:.3} of joints soft")
                    .expect("writing to a string");
            }
        }
    }
    assert!(failures.is_empty(), "\n{failures}");
}

#[test]
fn bones_come_out_stiff_and_joints_soft_from_few_and_many_poses() {
    assert_bones_and_joints_are_found(0.0, false, 1.0);
}

#[test]
fn noise_in_the_poses_hides_neither_bones_nor_joints() {
    assert_bones_and_joints_are_found(NOISE, false, 1.0);
}

#[test]
fn noise_in_the_reference_too_hides_neither_bones_nor_joints() {
    assert_bones_and_joints_are_found(NOISE, true, 1.0);
}

#[test]
fn small_and_large_units_change_nothing() {
    assert_bones_and_joints_are_found(NOISE, false, 1e-3);
    assert_bones_and_joints_are_found(NOISE, false, 1e3);
}

fn predictions(name: &str, options: &Options) -> Report {
    let set = PoseSet::open(name);
    let analysis = Arc::new(Analysis::new(set.mesh.clone(), Weights::default()));
    match leave_one_out(&analysis, &set.poses, options, &mut |_| ControlFlow::Continue(())) {
        Ok(ControlFlow::Continue(report)) => report,
        other => panic!("{other:?}"),
    }
}

#[test]
fn learned_rigidity_predicts_left_out_poses_better_than_any_uniform_one() {
    for name in SETS {
        let report = predictions(name, &Options::default());
        for (r, error) in report.uniform() {
            assert!(report.learned() < error, "{name}: {} with learned r, {error} with r = {r}", report.learned());
        }
    }
}

#[test]
fn progress_ascends_to_one_and_the_check_can_be_stopped_anywhere() {
    let set = PoseSet::open("jointed-bar");
    let analysis = Arc::new(Analysis::new(set.mesh.clone(), Weights::default()));
    let options = Options { range: 1..=2, left_out: Some(vec![1]), ..Options::default() };
    let mut told = Vec::new();
    let done = leave_one_out(&analysis, &set.poses[..3], &options, &mut |fraction| {
        told.push(fraction);
        ControlFlow::Continue(())
    });
    assert!(matches!(done, Ok(ControlFlow::Continue(_))), "{done:?}");
    assert!(told.windows(2).all(|pair| pair[0] <= pair[1] + 1e-12), "{told:?}");
    assert!((told[told.len() - 1] - 1.0).abs() < 1e-12, "{told:?}");
    for share in [0.0, 0.3, 0.7] {
        let last = (told.len() as f64 * share) as usize;
        let mut n_calls = 0;
        let stopped = leave_one_out(&analysis, &set.poses[..3], &options, &mut |_| {
            n_calls += 1;
            if n_calls > last { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert!(matches!(stopped, Ok(ControlFlow::Break(()))), "after {last} calls: {stopped:?}");
    }
}

#[test]
fn what_cannot_be_compared_is_refused_in_words() {
    let set = PoseSet::open("jointed-bar");
    let analysis = Arc::new(Analysis::new(set.mesh.clone(), Weights::default()));
    let check = |poses: &[Vec<glam::DVec3>], left_out: Vec<usize>| {
        let options = Options { left_out: Some(left_out), ..Options::default() };
        leave_one_out(&analysis, poses, &options, &mut |_| ControlFlow::Continue(())).expect_err("a reason").to_string()
    };
    let said = check(&set.poses[..1], vec![0]);
    assert!(said.contains("two poses") && said.contains("1"), "{said}");
    let said = check(&set.poses[..3], vec![3]);
    assert!(said.contains("no pose 3") && said.contains("there are 3"), "{said}");
    let said = check(&set.poses[..3], vec![]);
    assert!(said.contains("no pose is to be left out"), "{said}");
    let short = vec![set.poses[0].clone(), set.poses[1][..5].to_vec()];
    let said = check(&short, vec![0]);
    assert!(said.contains("5 vertices"), "{said}");
}
