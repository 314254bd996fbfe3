//! A surface to look at while handles move faster than iterations follow: the last exact one, bent by some hundred nodes.
//!
//! On a million vertices an iteration takes a quarter of a second, and three of them hardly bend the surface after a fast
//! hand. Embedded deformation does not depend on the number of vertices until the surface is asked for. So while only
//! targets move, the worker shows its surface; as soon as they rest, iterations go on from there, and nothing of it is
//! left in what they come to.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use pliant_solver::{Analysis, DeformationGraph, Embedded, LooseComponents, SolveError, VertexId};

use crate::document::Pose;

/// Nodes and how many carry a vertex: at 500 a step takes 5 ms and more nodes show no more (measured on 250,000 vertices).
const NODES: usize = 400;
const CARRIERS: usize = 4;

/// When previews are worth their memory and their looks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// The graph is made in the background for meshes of so many vertices.
    pub(super) vertices: usize,
    /// Previews are shown when an iteration takes longer, milliseconds.
    pub(super) iteration_ms: f64,
}

/// Two frames of a screen at 60 Hz without a surface are seen as a stutter. Below that, iterations in the same time end
/// up lower (measured: at 14 ms an iteration, previews ended 15 % higher; at 64 ms, 40 % lower). Meshes of 100,000
/// vertices reach it at r = 10.
pub(super) const LIMITS: Limits = Limits { vertices: 100_000, iteration_ms: 33.0 };

/// Previews of one mesh with one set of weights.
pub(super) struct Previews {
    limits: Limits,
    /// None for small meshes; empty until it is made.
    graph: Option<Arc<OnceLock<Arc<DeformationGraph>>>>,
    bent: Option<Embedded>,
    /// The surface on screen, while it is one of these.
    shown: Option<Pose>,
}

impl Previews {
    /// Begins to make what previews need, if the mesh is large.
    pub(super) fn new(analysis: &Arc<Analysis>, limits: Limits) -> Previews {
        let is_large = analysis.mesh().n_vertices() >= limits.vertices;
        Previews { limits, graph: is_large.then(|| made_in_background(analysis.clone())), bent: None, shown: None }
    }

    /// Never any.
    pub(super) fn none() -> Previews {
        Previews { limits: LIMITS, graph: None, bent: None, shown: None }
    }

    /// Whether a preview can be had where an iteration takes so long.
    pub(super) fn serve(&self, iteration_ms: f64) -> bool {
        iteration_ms > self.limits.iteration_ms && self.graph.as_ref().is_some_and(|graph| graph.get().is_some())
    }

    /// The preview on screen.
    pub(super) fn shown(&self) -> Option<&Pose> {
        self.shown.as_ref()
    }

    /// Takes the preview off: the pose from which iterations go on.
    pub(super) fn leave(&mut self) -> Option<Pose> {
        self.shown.take()
    }

    /// A surface whose held vertices are at their targets, bent from the last one that is not a preview, which `exact`
    /// gives.
    pub(super) fn show(
        &mut self,
        analysis: &Arc<Analysis>,
        (held, targets): (&[VertexId], &[DVec3]),
        loose: LooseComponents,
        exact: impl FnOnce() -> Pose,
    ) -> Result<(), SolveError> {
        let Some(graph) = self.graph.as_ref().and_then(|graph| graph.get()) else { return Ok(()) };
        let mut bent = match self.bent.take().filter(|bent| bent.held() == held && self.shown.is_some()) {
            Some(bent) => bent,
            None => {
                let mut bent = Embedded::new(analysis.clone(), graph.clone(), held, loose)?;
                bent.set_rest(exact().positions)?;
                bent
            }
        };
        bent.set_targets(targets)?;
        bent.step();
        let mut positions: Arc<[DVec3]> = std::iter::repeat_n(DVec3::ZERO, analysis.mesh().n_vertices()).collect();
        if let Some(positions) = Arc::get_mut(&mut positions) {
            bent.positions_into(positions);
            // Nodes hold them softly, some ten-thousandths of the surface off.
            held.iter().zip(targets).for_each(|(v, &target)| positions[v.index()] = target);
        }
        (self.bent, self.shown) = (Some(bent), Some(Pose { positions }));
        Ok(())
    }

    /// Waits until previews can be had.
    #[cfg(test)]
    pub(super) fn wait(&self) {
        while self.graph.as_ref().is_some_and(|graph| graph.get().is_none()) {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
    }
}

/// A place that will hold the graph. Should no thread be had, there are no previews.
fn made_in_background(analysis: Arc<Analysis>) -> Arc<OnceLock<Arc<DeformationGraph>>> {
    let place = Arc::new(OnceLock::new());
    let kept = Arc::downgrade(&place);
    let make = move || {
        // Not for a mesh that has been closed meanwhile.
        if kept.strong_count() > 0 {
            let graph = Arc::new(DeformationGraph::new(&analysis, NODES, CARRIERS));
            if let Some(place) = kept.upgrade() {
                let _ = place.set(graph);
            }
        }
    };
    if let Err(error) = std::thread::Builder::new().name("preview".into()).spawn(make) {
        log::warn!("no thread for previews: {error}");
    }
    place
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use glam::DAffine3;

    use super::*;
    use crate::document::{Command, Document, GroupKind};
    use crate::solving::{Engine, SolveReport, SolveRequest, SolveState};
    use crate::test_scenes::{flat_sheet, held_at_two_sides, move_handle};

    const ROW: u32 = 21;

    /// A flat sheet held along one side, with a handle on the other.
    fn sheet() -> Document {
        held_at_two_sides(flat_sheet(ROW), ROW)
    }

    /// Lifts the handle.
    fn lift(document: &mut Document, height: f64) {
        move_handle(document, DAffine3::from_translation(DVec3::new(0.0, -0.1 * height, height)));
    }

    fn adopt(engine: &mut Engine, document: &Document) {
        let turned = engine.adopt(SolveRequest::of(document, None), &mut |_| ControlFlow::Continue(()));
        assert!(turned.is_continue());
    }

    /// An engine that has seen one iteration, and shows previews of any mesh if they are wanted.
    fn engine(document: &mut Document, with_previews: bool) -> Engine {
        let vertices = if with_previews { 0 } else { usize::MAX };
        let limits = Limits { vertices, iteration_ms: 0.0 };
        let mut engine = Engine::with_previews(&SolveRequest::of(document, None), limits);
        engine.wait_for_previews();
        lift(document, 0.5);
        adopt(&mut engine, document);
        assert!(!engine.is_previewing(), "no iteration is known to be slow yet");
        engine.step(&mut || true);
        engine
    }

    fn settled(engine: &mut Engine) -> SolveReport {
        while engine.is_busy() {
            engine.step(&mut || true);
        }
        engine.report()
    }

    fn positions(report: &SolveReport) -> &[DVec3] {
        &report.pose.as_ref().expect("a new surface").positions
    }

    #[test]
    fn what_a_drag_settles_on_does_not_depend_on_previews() {
        let [with, without] = [true, false].map(|with_previews| {
            let mut document = sheet();
            let mut engine = engine(&mut document, with_previews);
            for k in 2..=12 {
                lift(&mut document, 0.5 * f64::from(k));
                adopt(&mut engine, &document);
                assert_eq!(engine.is_previewing(), with_previews, "move {k}");
                if !with_previews {
                    engine.step(&mut || true);
                }
            }
            engine.leave_preview();
            settled(&mut engine)
        });
        assert_eq!((&with.state, &without.state), (&SolveState::Settled, &SolveState::Settled));
        // Settled is a decrease below 1e-6 in three iterations: what is left of a slow descent is some tens of that.
        let difference = (with.energy - without.energy).abs() / without.energy;
        assert!(difference < 1e-3, "{} with previews, {} without", with.energy, without.energy);
        let farthest =
            positions(&with).iter().zip(positions(&without)).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(farthest < 0.02 * f64::from(ROW), "{farthest}");
    }

    #[test]
    fn previews_follow_every_move_with_held_vertices_at_their_targets() {
        let mut document = sheet();
        let mut engine = engine(&mut document, true);
        let mut before = positions(&engine.report()).to_vec();
        for k in 2..=6 {
            lift(&mut document, 0.5 * f64::from(k));
            adopt(&mut engine, &document);
            let report = engine.report();
            assert_eq!((report.revision, &report.state), (document.revision(), &SolveState::Iterating));
            let after = positions(&report);
            for group in document.scene().groups.iter() {
                for (v, target) in group.vertices.iter().zip(group.targets()) {
                    assert_eq!(after[v.index()], target, "vertex {} in move {k}", v.0);
                }
            }
            let middle = (ROW * ROW / 2) as usize;
            assert!(after[middle].z > before[middle].z, "the middle stays behind in move {k}");
            before = after.to_vec();
        }
    }

    #[test]
    fn undo_other_sizes_and_other_handles_end_a_preview() {
        type Change = fn(&mut Document);
        let changes: [Change; 3] = [
            |document| assert!(document.undo().is_some()),
            |document| document.apply(Command::FillAll(2)).expect("a good size"),
            |document| {
                let vertices = vec![VertexId(ROW * 10)];
                document.apply(Command::Hold { kind: GroupKind::Anchor, vertices }).expect("it exists");
            },
        ];
        for change in changes {
            let mut document = sheet();
            let mut engine = engine(&mut document, true);
            lift(&mut document, 3.0);
            adopt(&mut engine, &document);
            assert!(engine.is_previewing());
            change(&mut document);
            adopt(&mut engine, &document);
            assert!(!engine.is_previewing());
            assert_eq!(settled(&mut engine).state, SolveState::Settled);
        }
    }
}
