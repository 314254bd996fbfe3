//! What the methods to compare with cost.

use super::clock::{median, timed};
use super::scene::{Scene, analyze};
use super::stages::name;
use super::table::{Table, digits, ms};
use glam::DVec3;
use pliant_solver::{DeformationGraph, Embedded, LooseComponents, Method, Minimizer, SolveError, SrArap, Start};
use std::hint::black_box;
use std::sync::Arc;

/// Frames of the drag for embedded deformation: half a second.
const FRAMES: usize = 30;
/// Iterations of SR-ARAP, the last of which counts as its minimum.
const ITERATIONS: usize = 60;
/// How near to the minimum is near enough.
const NEAR: f64 = 1e-3;

/// A row for every mesh.
pub(crate) fn table(scenes: &[&Scene]) -> Result<String, SolveError> {
    let header = [
        "mesh",
        "vertices",
        "graph",
        "step",
        "positions",
        "frames a second",
        "SR-ARAP: set-up",
        "iteration",
        "iterations",
    ];
    let mut table = Table::new(1, &header);
    for scene in scenes {
        eprintln!("other methods: {} of {} vertices", scene.name, scene.n_vertices());
        table.row(name(scene).into_iter().chain(embedded(scene)?).chain(sr_arap(scene)?));
    }
    Ok(format!(
        "Milliseconds, all threads. Embedded deformation with {} nodes, in a drag to 70°: *graph* once a mesh; each \
         frame takes a *step* of Gauss–Newton and the *positions* of all vertices. SR-ARAP with α = {} and L-BFGS, from \
         rest to 70° at once: *iterations* until the energy is within {NEAR} of that after {ITERATIONS}.\n\n{}",
        Method::NODES,
        Method::ALPHA,
        table.into_text()
    ))
}

fn embedded(scene: &Scene) -> Result<[String; 4], SolveError> {
    let analysis = analyze(&scene.mesh());
    let (held, targets) = scene.held();
    let rest: Vec<DVec3> = held.iter().map(|v| scene.shape.positions[v.index()]).collect();
    let (graph, graph_time) = timed(|| DeformationGraph::new(&analysis, Method::NODES, Method::NODE_NEIGHBORS));
    let mut embedded = Embedded::new(analysis, Arc::new(graph), &held, LooseComponents::KeepAtRest)?;
    let mut positions = vec![DVec3::ZERO; scene.n_vertices()];
    let (mut steps, mut passes, mut frames) = (Vec::new(), Vec::new(), Vec::new());
    for frame in 1..=FRAMES {
        let way = frame as f64 / FRAMES as f64;
        let now: Vec<DVec3> = rest.iter().zip(&targets).map(|(a, b)| a.lerp(*b, way)).collect();
        embedded.set_targets(&now)?;
        let (_, step) = timed(|| black_box(embedded.step()));
        let (_, pass) = timed(|| embedded.positions_into(&mut positions));
        steps.push(step);
        passes.push(pass);
        frames.push(step + pass);
    }
    let hertz = 1.0 / median(frames).as_secs_f64();
    Ok([ms(graph_time), ms(median(steps)), ms(median(passes)), digits(hertz)])
}

fn sr_arap(scene: &Scene) -> Result<[String; 3], SolveError> {
    let analysis = analyze(&scene.mesh());
    let (held, targets) = scene.held();
    let (made, set_up) = timed(|| SrArap::new(analysis, Method::ALPHA, &held, LooseComponents::KeepAtRest));
    let mut solver = made?;
    solver.set_minimizer(Minimizer::Lbfgs);
    solver.set_targets(&targets)?;
    solver.start(Start::Rest);
    let (mut energies, mut times) = (Vec::new(), Vec::new());
    for _ in 0..ITERATIONS {
        let (report, time) = timed(|| solver.step());
        energies.push(report.energy);
        times.push(time);
    }
    let last = energies.last().copied().unwrap_or_default();
    let near = energies.iter().position(|energy| energy - last <= NEAR * last).map_or(ITERATIONS, |place| place + 1);
    Ok([ms(set_up), ms(median(times)), near.to_string()])
}
