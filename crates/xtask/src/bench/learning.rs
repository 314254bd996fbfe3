//! What learning rigidity from poses costs.

use super::clock::{median, median_of, timed};
use super::scene::{Scene, analyze};
use super::stages::name;
use super::table::{Table, digits, ms};
use glam::{DQuat, DVec3};
use pliant_solver::{LearnError, PoseLearner};
use std::hint::black_box;
use std::ops::{ControlFlow, RangeInclusive};

/// The paper's range of r.
const SIZES: RangeInclusive<u16> = 1..=6;
/// Poses that are timed. A pose more takes as long as any other.
const POSES: usize = 5;

/// A row for every mesh.
pub(crate) fn table(scenes: &[&Scene]) -> Result<String, LearnError> {
    let header =
        ["mesh", "vertices", "neighborhoods", "a pose", "µs per vertex and pose", "means", "auto ω", "r for an ω"];
    let mut table = Table::new(1, &header);
    for scene in scenes {
        eprintln!("learning: {} of {} vertices", scene.name, scene.n_vertices());
        let analysis = analyze(&scene.mesh());
        let (made, neighborhoods) = timed(|| PoseLearner::new(analysis, SIZES, &mut |_| ControlFlow::Continue(())));
        let ControlFlow::Continue(mut learner) = made? else { continue };
        let mut times = Vec::new();
        for way in 1..=POSES {
            let pose = pose(scene, way as f64 / POSES as f64);
            let (added, time) = timed(|| learner.add(&pose));
            added?;
            times.push(time);
        }
        let one = median(times);
        let means = learner.table()?;
        let omega = means.auto_omega();
        let cells = [
            ms(neighborhoods),
            ms(one),
            digits(1e6 * one.as_secs_f64() / scene.n_vertices() as f64),
            result_time(|| learner.table()),
            result_time(|| means.auto_omega()),
            result_time(|| means.learn(omega, SIZES)),
        ];
        table.row(name(scene).into_iter().chain(cells));
    }
    Ok(format!(
        "Milliseconds for r = 1 to 6, all threads. *Neighborhoods* once a mesh, *a pose* for each: energies of all \
         vertices for all r. *Means* and *auto ω* once all poses are there; *r for an ω* for every place of a slider.\n\n{}",
        table.into_text()
    ))
}

/// How long it takes to compute something that is not needed.
fn result_time<T>(mut run: impl FnMut() -> T) -> String {
    ms(median_of(|| {
        black_box(run());
    }))
}

/// The shape bent and twisted, then turned and moved as a whole.
fn pose(scene: &Scene, way: f64) -> Vec<DVec3> {
    let (bend, twist) = (0.4 * way, 0.3 * way);
    let deformed = |p: DVec3| {
        let twisted = DQuat::from_rotation_x(twist * p.x) * p;
        let (sin, cos) = (bend * p.x).sin_cos();
        let radius = 1.0 / bend - twisted.y;
        DVec3::new(radius * sin, 1.0 / bend - radius * cos, twisted.z)
    };
    let turn = DQuat::from_scaled_axis(DVec3::new(1.0, -2.0, 0.5) * way);
    scene.shape.positions.iter().map(|&p| turn * deformed(p) + DVec3::splat(way)).collect()
}
