//! The parts of an iteration beside the time in which the memory could deliver what they must read and write.

use super::clock::{timed, timed_median};
use super::scene::{Scene, analyze, solver};
use super::stages::name;
use super::table::{Table, digits, ms};
use pliant_solver::measure::{Counts, Faer, Kernel, counts, run};
use pliant_solver::{Rigidity, SolveError, Solver};
use std::time::Duration;

/// Iterations before anything is timed.
const WARM: usize = 5;

/// What the page says about the bytes, which [`bytes`] computes.
const FORMULAS: &str = "Bytes count every array once, however often it is used, with n vertices, m edges, the runs of all \
neighborhoods (none at r = 1) and the values of L:

| kernel | bytes |
| --- | --- |
| gradient | n (p' 24 + R 72 + right-hand side 32) + m (e 24 + w 8 + d w 8 + ends 8); r > 1: + m (pulls 2 × 32) + runs × 8 |
| solve | L 2 × 8 + n (right-hand side 2 × 32) |
| local | n (p' 24 + quaternion 2 × 32 + R 72) + m (e 24 + w 8 + ends 8); r > 1: + m (prefix sums 2 × 72) + runs × 8 |

";

/// The table, a row for every scene, r and kernel; `bandwidth` in bytes a second.
pub(crate) fn table(scenes: &[(Scene, Vec<u16>)], bandwidth: f64) -> Result<String, SolveError> {
    let header = [
        "mesh",
        "vertices",
        "r",
        "runs / n",
        "L / n",
        "gradient",
        "of floor",
        "solve",
        "of floor",
        "faer / ours",
        "local",
        "of floor",
    ];
    let mut table = Table::new(1, &header);
    for (scene, sizes) in scenes {
        let analysis = analyze(&scene.mesh());
        for &r in sizes {
            eprintln!("kernels: {} of {} vertices, r = {r}", scene.name, scene.n_vertices());
            let mut solver = solver(scene, &analysis, &Rigidity::uniform(scene.n_vertices(), r))?;
            (0..WARM).for_each(|_| {
                solver.step();
            });
            let counts = counts(&solver);
            let per_vertex = |n: usize| digits(n as f64 / counts.vertices as f64);
            let mut cells = vec![r.to_string(), per_vertex(counts.runs), per_vertex(counts.factor)];
            for kernel in [Kernel::Gradient, Kernel::Solve, Kernel::Local] {
                let time = kernel_time(&mut solver, kernel);
                let share = bytes(kernel, counts) / bandwidth / time.as_secs_f64();
                cells.extend([ms(time), format!("{:.0} %", 100.0 * share)]);
                if kernel == Kernel::Solve {
                    // The structure, and so the time, is the same for every r.
                    cells.push(if r == 1 { by_faer(&solver, time) } else { String::new() });
                }
            }
            table.row(name(scene).into_iter().chain(cells));
        }
    }
    Ok(format!(
        "Milliseconds of the parts of an iteration, and how much of each is the floor: the bytes that must move at least, \
         at the measured bandwidth of two threads. Small meshes stay in the cache and may beat it. *Gradient*: Q and the \
         pull on every vertex. *Solve*: both triangles, three right-hand sides; *faer / ours*: how many times longer faer's own solve \
         takes, on the same matrix in the same order. *Local*: S, rotations, energy.\n\n\
         {FORMULAS}{}",
        table.into_text()
    ))
}

/// How many times longer faer's own solve takes.
fn by_faer(solver: &Solver, ours: Duration) -> String {
    match Faer::new(solver) {
        Some(mut faer) => digits(timed_median(|| timed(|| faer.solve()).1).as_secs_f64() / ours.as_secs_f64()),
        None => "–".to_owned(),
    }
}

fn kernel_time(solver: &mut Solver, kernel: Kernel) -> Duration {
    timed_median(|| {
        if kernel == Kernel::Solve {
            // What was solved would be solved again and again, and shrink.
            run(solver, Kernel::Gradient);
        }
        timed(|| run(solver, kernel)).1
    })
}

fn bytes(kernel: Kernel, counts: Counts) -> f64 {
    let Counts { vertices: n, edges: m, runs, factor } = counts;
    let overlap = |per_edge: usize| if runs > 0 { per_edge * m + 8 * runs } else { 0 };
    let bytes = match kernel {
        Kernel::Gradient => 128 * n + 48 * m + overlap(2 * 32),
        Kernel::Solve => 16 * factor + 64 * n,
        Kernel::Local => 160 * n + 40 * m + overlap(2 * 72),
    };
    bytes as f64
}
