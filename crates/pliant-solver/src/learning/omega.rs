//! An ω from the table itself, at which bones come out stiff and joints soft.
//!
//! Energies rise with r, and mostly ever less so: then r_k is r_max where the slope
//! s_k = (Ẽ(k, r_max) − Ẽ(k, r_min)) / (r_max − r_min) is below ω, and small where it is well above. So ω has to lie
//! between the slopes of two kinds of vertices:
//!
//! - bones have the slope of noise. Noise adds to Ẽ(k, r) what is proportional to g(r) = |N(k, r)| / (vertices of it), on
//!   a regular mesh (9 r² − 3 r) / (3 r² + 3 r + 1). Its size shows where nothing else is to be seen: at r_min, in the
//!   stillest quarter of the vertices, for bending reaches the smallest neighborhoods only at the joints themselves;
//! - joints and what is near them have the slopes of bending, of which the mean of all slopes has a share.
//!
//! ω = ¼ mean slope + 2½ noise slopes. The shares come from three sources:
//!
//! - known bones and joints: 32 sets of bent tubes (even, and three times finer in places; none to two joints, bent in all
//!   of 2 or 11 poses or in one only; noise of 0 and 2 % of the mean edge). 95 % of the insides of bones get r ≥ 5 and
//!   90 % of the joints r ≤ 2 on all 24 that have joints, where with noise ω may lie within a factor of 1.3 to 20. Without
//!   joints all is stiff on even meshes, 85 to 90 % where noise is stronger in fine places. The mean slope alone failed on
//!   4 of the 24, Otsu's split of log s on 2, half of the mean and 1¼ lower quartiles of the slopes on 1;
//! - poses left out and predicted from the others by 25 patches as handles: errors were least from an eighth to a quarter of
//!   the mean slope (0.41 to 0.43 % of the diagonal on a body of 13,380 vertices, 0.033 % on a creature of 7,800), and 0.63
//!   and 0.039 % at the mean slope itself;
//! - noise: to be above it takes some 1.5 of its slopes on even meshes and up to 2.5 on uneven ones.

use std::ops::RangeInclusive;

use crate::learning::table::EnergyTable;

/// Shares of the mean slope and of that of noise, see above.
const OF_MEAN: f64 = 0.25;
const OF_NOISE: f64 = 2.5;
/// The stillest vertices: the lower quartile.
const STILL: f64 = 0.25;
/// Slopes count no more than that of this share of the vertices: a few broken ones must not decide.
const LARGEST_QUANTILE: f64 = 0.99;
/// The least ω, where nothing is strained: slopes of strains of some hundred-thousandths of an edge, as single
/// precision leaves them on a large mesh.
const LEAST: f64 = 1e-9;
/// The largest ω: still a number when multiplied by any r.
const MOST: f64 = 1e300;

/// ω as described above; positive and finite.
pub(crate) fn auto_omega(table: &EnergyTable) -> f64 {
    let n_steps = table.r_range().count() - 1;
    let (mut slopes, mut first): (Vec<f64>, Vec<f64>) =
        table.rows().map(|row| (((row[n_steps] - row[0]) / n_steps.max(1) as f64).max(0.0), row[0].max(0.0))).unzip();
    if slopes.is_empty() {
        return LEAST;
    }
    let largest = quantile(&mut slopes, LARGEST_QUANTILE).min(MOST / slopes.len() as f64);
    let mean = slopes.iter().map(|s| s.min(largest)).sum::<f64>() / slopes.len() as f64;
    let noise = quantile(&mut first, STILL) * noise_slope(table.r_range());
    (OF_MEAN * mean + OF_NOISE * noise).clamp(LEAST, MOST)
}

/// The slope of noise whose energy is 1 at the smallest r.
fn noise_slope(range: RangeInclusive<u16>) -> f64 {
    let [first, last] = [*range.start(), *range.end()].map(f64::from);
    let size = |r: f64| (9.0 * r * r - 3.0 * r) / (3.0 * r * r + 3.0 * r + 1.0);
    if first < last { (size(last) / size(first) - 1.0) / (last - first) } else { 0.0 }
}

fn quantile(numbers: &mut [f64], share: f64) -> f64 {
    let place = (share * (numbers.len() - 1) as f64) as usize;
    *numbers.select_nth_unstable_by(place, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::sync::Arc;

    use glam::{DQuat, DVec3};

    use crate::test_support::{Random, box_bar};
    use crate::{Analysis, EnergyTable, Mesh, PoseLearner, Weights};

    /// Two joints, at these x, along a bar, and from where to where they bend it: as far as it is wide.
    const JOINTS: [f64; 2] = [20.0, 40.0];
    const WIDTH: f64 = 6.0;

    /// A bar of 60 × 6 × 6 cells of size 1.
    fn bar(scale: f64) -> Mesh {
        let bar = box_bar([60, 6, 6], DVec3::new(60.0, 6.0, 6.0));
        Mesh::new(bar.positions().iter().map(|&p| p * scale).collect(), bar.triangles().to_vec()).expect("valid")
    }

    /// The bar, its parts turned about the joints, and with noise, in units of `scale`.
    fn pose(mesh: &Mesh, scale: f64, angles: [f64; 2], noise: f64, random: &mut Random) -> Vec<DVec3> {
        let bend = |p: DVec3| {
            // The outer joint first, then what is beyond the inner one is carried along.
            [1, 0].iter().fold(p, |now, &joint| {
                let center = DVec3::new(JOINTS[joint], 3.0, 3.0);
                let share = ((p.x - JOINTS[joint]) / WIDTH + 0.5).clamp(0.0, 1.0);
                let axis = [DVec3::Y, DVec3::Z][joint];
                center + DQuat::from_axis_angle(axis, angles[joint] * share) * (now - center)
            })
        };
        mesh.positions().iter().map(|&p| (bend(p / scale) + random.vector() * noise) * scale).collect()
    }

    /// Shares of bones with r ≥ 5 and of joints with r ≤ 2.
    fn shares(mesh: &Arc<Mesh>, scale: f64, poses: &[Vec<DVec3>]) -> (f64, f64, f64) {
        let analysis = Arc::new(Analysis::new(mesh.clone(), Weights::Clamped));
        let made = PoseLearner::new(analysis, 1..=6, &mut |_| ControlFlow::Continue(())).expect("a good range");
        let ControlFlow::Continue(mut learner) = made else { panic!("nobody stopped it") };
        poses.iter().for_each(|pose| learner.add(pose).expect("a good pose"));
        let table = learner.table().expect("there are poses");
        let omega = table.auto_omega();
        let learned = table.learn(omega, 1..=6).rigidity;
        let share = |is_kind: &dyn Fn(f64) -> bool, is_good: &dyn Fn(u16) -> bool| {
            let kind = (0..mesh.n_vertices()).filter(|&v| is_kind(mesh.positions()[v].x / scale));
            let sizes: Vec<u16> = kind.map(|v| learned.as_slice()[v]).collect();
            sizes.iter().filter(|&&r| is_good(r)).count() as f64 / sizes.len() as f64
        };
        let from_joint = |x: f64| JOINTS.iter().map(|joint| (x - joint).abs()).fold(f64::INFINITY, f64::min);
        (
            share(&|x| from_joint(x) > 0.5 * WIDTH + 6.5, &|r| r >= 5),
            share(&|x| from_joint(x) < 2.5, &|r| r <= 2),
            omega,
        )
    }

    #[test]
    fn bones_come_out_stiff_and_joints_soft_whatever_noise_scale_and_number_of_poses() {
        let angles = [[0.7, -0.4], [-0.3, 0.9], [0.1, -0.6]];
        for (scale, noise) in [(1.0, 0.0), (1e-3, 0.02), (1e3, 0.02), (1.0, 0.04)] {
            let mesh = Arc::new(bar(scale));
            for n_poses in [2, 6, 11] {
                let mut random = Random::new(n_poses as u64);
                // Noise is uniform in ± that much of an edge, whose mean is 1.1.
                let poses: Vec<Vec<DVec3>> = (0..n_poses)
                    .map(|m| pose(&mesh, scale, angles[m % 3], noise * 1.1 * 3f64.sqrt(), &mut random))
                    .collect();
                let (bones, joints, omega) = shares(&mesh, scale, &poses);
                let what = format!("{n_poses} poses, noise {noise}, scale {scale}: ω = {omega}");
                assert!(bones >= 0.95, "{what}: {bones} of the bones are stiff");
                assert!(joints >= 0.9, "{what}: {joints} of the joints are soft");
            }
        }
    }

    #[test]
    fn without_joints_all_is_stiff() {
        let mesh = Arc::new(bar(1.0));
        for noise in [0.0, 1e-9, 1e-3, 0.02] {
            let mut random = Random::new(3);
            let turn = DQuat::from_rotation_x(2.0);
            let mut rigid = || {
                let noisy = pose(&mesh, 1.0, [0.0; 2], noise, &mut random);
                noisy.into_iter().map(|p| turn * p + DVec3::splat(1e3)).collect::<Vec<_>>()
            };
            let poses = [rigid(), rigid(), rigid()];
            let (bones, joints, omega) = shares(&mesh, 1.0, &poses);
            assert!(bones >= 0.95 && joints <= 0.05, "noise {noise}, ω = {omega}: {bones} of the bones, {joints} soft");
        }
    }

    #[test]
    fn a_few_broken_vertices_do_not_decide() {
        // Noise, one in ten at a joint, and one in two hundred anywhere.
        let row = |broken: f64, k: usize| match k % 200 {
            0 => vec![0.0, broken],
            1..=20 => vec![0.02, 0.1],
            _ => vec![0.0001, 0.0003],
        };
        let omega =
            |broken: f64| EnergyTable::new(1..=2, (0..2000).flat_map(|k| row(broken, k)).collect(), 1).auto_omega();
        let expected = omega(0.05);
        for broken in [1e9, f64::MAX, f64::INFINITY] {
            let got = omega(broken);
            assert!((got - expected).abs() < 0.1 * expected, "{broken}: {got} instead of {expected}");
        }
    }
}
