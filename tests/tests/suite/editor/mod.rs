//! The editor without a window: what its session promises, driven by the same input a window would give.

mod actions;
mod bending;
mod comparing;
mod files;
mod handles;
mod inspecting;
mod learning;
mod monkey;
mod painting;
mod poses;
mod projects;
mod regions;
mod selecting;
mod views;

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::{DVec3, Vec2};
use pliant::document::{Command, Document, GroupKind, Model, SelectMode, held_by};
use pliant::editor::{Action, Job, NoticeKind, Opened, Sample, Session};
use pliant::solving::SolveState;
use pliant::tools::{BrushMode, Input, Modifiers, Pointer, SelectShape, ToolKey, ToolKind};
use pliant_meshfile::MeshFile;
use pliant_solver::VertexId;

/// A sheet of `n` by `n` cells over the unit square, centered on the origin and facing the camera (+z).
fn sheet(n: usize) -> MeshFile {
    let at = |i: usize, j: usize| DVec3::new(i as f64 / n as f64 - 0.5, j as f64 / n as f64 - 0.5, 0.0);
    let positions = (0..=n).flat_map(|j| (0..=n).map(move |i| at(i, j))).collect();
    let id = |i: usize, j: usize| (j * (n + 1) + i) as u32;
    let triangles = (0..n)
        .flat_map(|j| (0..n).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let (a, b, c, d) = (id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1));
            [[a, b, c], [a, c, d]]
        })
        .collect();
    MeshFile::from_triangles("sheet", positions, triangles)
}

fn session_with(file: MeshFile) -> Session {
    let mut session = Session::new(|| {}).expect("a solver thread");
    let model = Model::from_file(file).expect("a good mesh");
    session.show(Opened::new(Arc::new(model)), None);
    session.set_viewport_size(Vec2::new(800.0, 600.0));
    session
}

fn document(session: &Session) -> &Document {
    session.document().expect("an open document")
}

/// Polls until `done` says so. A minute is an eternity here: a failure, not a slow machine.
fn wait_until(session: &mut Session, what: &str, done: impl Fn(&Session) -> bool) {
    let start = Instant::now();
    while !done(session) {
        assert!(start.elapsed() < Duration::from_secs(60), "waited in vain until {what}");
        session.poll();
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn state(session: &Session) -> Option<SolveState> {
    session.status.report.as_ref().map(|report| report.state.clone())
}

fn settle(session: &mut Session) {
    let revision = document(session).revision();
    wait_until(session, "the surface settles", |session| {
        let report = session.status.report.as_ref();
        report.is_some_and(|report| {
            report.revision == revision
                && matches!(report.state, SolveState::Settled | SolveState::Resting | SolveState::Failed(_))
        })
    });
}

fn on_screen(session: &Session, v: u32) -> Vec2 {
    let open = session.open().expect("an open document");
    let position = open.surface.frame().positions[v as usize];
    open.camera.project(position, session.viewport_size()).expect("in front of the eye").0
}

fn pointer(px: Vec2) -> Pointer {
    Pointer { px, modifiers: Modifiers::default() }
}

fn drag(session: &mut Session, from: Vec2, to: Vec2) {
    press_and_move(session, from, to);
    session.input(Input::Release(pointer(to)));
}

fn press_and_move(session: &mut Session, from: Vec2, to: Vec2) {
    session.input(Input::Hover(pointer(from)));
    session.input(Input::Press(pointer(from)));
    for k in 1..=8 {
        session.input(Input::Drag(pointer(from.lerp(to, k as f32 / 8.0))));
    }
}

fn click(session: &mut Session, at: Vec2) {
    session.input(Input::Hover(pointer(at)));
    session.input(Input::Press(pointer(at)));
    session.input(Input::Release(pointer(at)));
}

/// Vertex in the middle of row `j` of a sheet of 20 cells.
fn middle(j: u32) -> u32 {
    j * 21 + 10
}

/// Clicks near both ends of a sheet of 20 cells: a handle each, one step each.
fn place_two_handles(session: &mut Session) {
    for j in [2, 17] {
        let at = on_screen(session, middle(j));
        click(session, at);
    }
}
