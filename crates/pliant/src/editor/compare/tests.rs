//! What the panes come to, without a window.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use glam::{DAffine3, DVec3};
use pliant_meshfile::MeshFile;
use pliant_solver::{Analysis, LooseComponents, Method as SolverMethod, Minimizer, Rigidity, Start, Weights};

use super::*;
use crate::document::{Command, Document, Method, Model, held_by};
use crate::solving::SolveState;
use crate::test_scenes::{held_at_two_sides, move_handle, uneven_sheet};

const ROW: u32 = 13;

/// An uneven sheet held along one side, with a handle on the other that is lifted.
fn document() -> Document {
    let mut document = held_at_two_sides(uneven_sheet(ROW), ROW);
    document.apply(Command::FillAll(2)).expect("a good size");
    let method = Method { nodes: 30, ..Method::default() };
    document.apply(Command::SetMethod(method)).expect("in range");
    lift(&mut document, 5.0);
    document
}

fn lift(document: &mut Document, height: f64) {
    move_handle(document, DAffine3::from_translation(DVec3::new(0.0, -0.3 * height, height)));
}

/// A comparison that counts how often it wakes the window.
fn compare(uniform: u16) -> (Compare, Arc<AtomicUsize>) {
    let wakes = Arc::new(AtomicUsize::new(0));
    let counted = wakes.clone();
    let wake = move || {
        counted.fetch_add(1, Ordering::Relaxed);
    };
    (Compare::start(uniform, None, wake).expect("a thread"), wakes)
}

fn settle(compare: &mut Compare) {
    let begun = Instant::now();
    while !compare.is_settled() {
        assert!(begun.elapsed() < Duration::from_secs(60), "waited in vain until all panes settle");
        compare.poll();
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn pane(compare: &Compare, kind: PaneKind) -> &Pane {
    compare.panes().iter().find(|pane| pane.kind == kind).expect("all kinds are there")
}

/// Energy by the solver crate alone, from rest.
fn alone(document: &Document, method: &SolverMethod) -> f64 {
    let analysis = Arc::new(Analysis::new(document.model().mesh.clone(), Weights::Clamped));
    let (held, targets) = held_by(&document.scene().groups);
    let prepared = method.prepare(analysis, &held, LooseComponents::FollowNearest, Minimizer::Lbfgs);
    let mut deformer = prepared.expect("solvable");
    deformer.set_targets(&targets).expect("finite");
    deformer.start(Start::Auto);
    (0..300).map(|_| deformer.step().energy).last().expect("steps")
}

#[test]
fn every_pane_settles_on_the_energy_of_its_method() {
    let document = document();
    let (mut compare, _) = compare(4);
    compare.tell(&document, None);
    settle(&mut compare);
    let sizes = |r| SolverMethod::RRing(Rigidity::uniform((ROW * ROW) as usize, r));
    for (kind, method) in [
        (PaneKind::Painted, sizes(2)),
        (PaneKind::Uniform, sizes(4)),
        (PaneKind::Arap, sizes(1)),
        (PaneKind::SrArap, SolverMethod::SrArap { alpha: SolverMethod::ALPHA }),
        (PaneKind::Embedded, SolverMethod::Embedded { nodes: 30, neighbors: 4 }),
    ] {
        let pane = pane(&compare, kind);
        assert_eq!(pane.state, Some(SolveState::Settled), "{kind:?}");
        let expected = alone(&document, &method);
        // Settled is a decrease below 1e-6 in three iterations: what is left of a slow descent is some tens of that.
        assert!((pane.energy - expected).abs() < 1e-3 * expected, "{kind:?}: {}, expected {expected}", pane.energy);
        let measures = pane.measures.expect("settled");
        assert_eq!((measures.crossings, measures.volume), (0, None), "{kind:?}: an open sheet");
        assert_eq!(measures.handle_error == 0.0, kind != PaneKind::Embedded, "{kind:?}: {}", measures.handle_error);
        assert!(pane.iterations > 0 && pane.frame.is_some() && pane.spent > Duration::ZERO, "{kind:?}");
    }
    // What lowers the ARAP energy is ARAP: the common measure is its own there, and no less anywhere else.
    let arap = pane(&compare, PaneKind::Arap);
    let least = arap.measures.expect("settled").strain;
    assert!((least - arap.energy).abs() < 1e-9 * arap.energy, "{least}, expected {}", arap.energy);
    for kind in [PaneKind::Painted, PaneKind::Uniform, PaneKind::SrArap] {
        assert!(pane(&compare, kind).measures.expect("settled").strain > 0.999 * least, "{kind:?}");
    }
}

#[test]
fn panes_answer_again_when_handles_and_sizes_change() {
    let mut document = document();
    let (mut compare, _) = compare(3);
    compare.tell(&document, None);
    settle(&mut compare);
    let before = PaneKind::ALL.map(|kind| pane(&compare, kind).energy);
    lift(&mut document, 8.0);
    compare.tell(&document, None);
    assert!(!compare.is_settled(), "what is shown is about other handles");
    settle(&mut compare);
    for (kind, before) in PaneKind::ALL.into_iter().zip(before) {
        assert!(pane(&compare, kind).energy > before, "{kind:?} is lifted higher");
    }
    let before = PaneKind::ALL.map(|kind| pane(&compare, kind).energy);
    compare.set_uniform(5);
    compare.tell(&document, None);
    settle(&mut compare);
    for (kind, before) in PaneKind::ALL.into_iter().zip(before) {
        let changed = (pane(&compare, kind).energy - before).abs() > 1e-3 * before;
        assert_eq!(changed, kind == PaneKind::Uniform, "{kind:?}");
    }
}

#[test]
fn from_rest_everything_is_found_again() {
    let mut document = document();
    let (mut compare, _) = compare(3);
    compare.tell(&document, None);
    settle(&mut compare);
    let before = PaneKind::ALL.map(|kind| pane(&compare, kind).energy);
    for height in [7.0, 9.0, 5.0] {
        lift(&mut document, height);
        compare.tell(&document, None);
    }
    compare.begin_anew();
    compare.tell(&document, None);
    settle(&mut compare);
    assert_eq!(PaneKind::ALL.map(|kind| pane(&compare, kind).energy), before);
}

#[test]
fn nothing_is_done_and_nobody_is_woken_when_all_have_settled() {
    let document = document();
    let (mut compare, wakes) = compare(3);
    compare.tell(&document, None);
    settle(&mut compare);
    std::thread::sleep(Duration::from_millis(20));
    let before = wakes.load(Ordering::Relaxed);
    for _ in 0..5 {
        compare.tell(&document, None);
        assert!(!compare.poll(), "nothing is new");
        std::thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(wakes.load(Ordering::Relaxed), before);
}

#[test]
fn closing_it_on_the_way_ends_its_thread() {
    let document = document();
    let (mut compare, wakes) = compare(3);
    compare.tell(&document, None);
    while !compare.poll() {
        std::thread::sleep(Duration::from_millis(1));
    }
    drop(compare);
    let begun = Instant::now();
    // The thread holds the other half of the counter.
    while Arc::strong_count(&wakes) > 1 {
        assert!(begun.elapsed() < Duration::from_secs(60), "the thread goes on");
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn without_handles_all_panes_rest() {
    let file = MeshFile::from_triangles("flake", vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]]);
    let document = Document::new(Arc::new(Model::from_file(file).expect("a good mesh")));
    let (mut compare, _) = compare(3);
    compare.tell(&document, None);
    settle(&mut compare);
    for pane in compare.panes() {
        assert_eq!((&pane.state, pane.frame.is_some()), (&Some(SolveState::Resting), true), "{:?}", pane.kind);
    }
}
