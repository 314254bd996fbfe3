//! What a person feels: during a drag on the start sample at mixed r, surfaces a second from the solver and the window's
//! own work a frame; on 100,000 vertices, the window's work over a minute, and the wait for a surface after a dab of the brush
//! and after a new handle; on 250,000 and a million, surfaces a second. Run by `cargo bench -p pliant-tests --bench editor`.
//! `-- drag`, `-- window`, `-- minute`, `-- waits` or `-- large` runs one part.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

mod large;
mod sheet;
mod waits;
mod window;

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::{DAffine3, DVec3};
use pliant::document::{Command, GroupId, GroupKind};
use pliant::editor::{Job, Sample, Session};
use pliant::solving::SolveState;
use pliant_solver::VertexId;

/// A drag of this many frames at this rate.
const FRAMES: u32 = 180;
const FRAME: Duration = Duration::from_nanos(16_666_667);

fn main() {
    let chosen: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let parts: [(&str, fn()); 5] = [
        ("drag", session_drag),
        ("waits", waits::waits),
        ("large", large::large_drags),
        ("window", window::drag),
        ("minute", window::minute),
    ];
    for (name, part) in parts {
        if chosen.is_empty() || chosen.iter().any(|one| one == name) {
            part();
        }
    }
}

/// The session without drawing: what two cores can give to the solver.
fn session_drag() {
    let mut session = Session::new(|| {}).expect("a solver thread");
    session.start(Job::OpenSample(Sample::Creature));
    let handle = prepare(&mut session, |session| {
        session.poll();
        std::thread::sleep(Duration::from_millis(1));
    });
    let (mut surfaces, mut work) = (0_u32, Vec::new());
    let mut last = None;
    let start = Instant::now();
    for frame in 0..FRAMES {
        let begun = Instant::now();
        session.apply(Command::Move { group: handle, motion: motion(frame) });
        session.poll();
        let marks = session.marks();
        assert!(marks.outline.is_empty());
        work.push(begun.elapsed());
        while begun.elapsed() < FRAME {
            std::thread::sleep(Duration::from_millis(1));
            let frame = session.open().map(|open| Arc::as_ptr(open.surface.frame()));
            if frame != last {
                surfaces += 1;
                last = frame;
            }
            session.poll();
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    let vertices = session.document().map_or(0, |document| document.model().mesh.n_vertices());
    println!("drag without drawing: {vertices} vertices, r 1 to 6, {FRAMES} frames at 60 Hz");
    println!("  surfaces a second        {:8.1}", f64::from(surfaces) / seconds);
    print_times("  session's work a frame", &mut work);
    let ms = session.status.report.as_ref().map_or(0.0, |report| report.iteration_ms);
    println!("  solver iteration, median {ms:8.2} ms");
}

/// Waits for the sample, gives it mixed r from its own file, and holds a patch far from the anchors.
fn prepare(session: &mut Session, mut wait: impl FnMut(&mut Session)) -> GroupId {
    while session.document().is_none() {
        wait(session);
    }
    let document = session.document().expect("just opened");
    let positions = document.model().mesh.positions();
    let highest = (0..positions.len()).max_by(|&a, &b| positions[a].y.total_cmp(&positions[b].y)).expect("a vertex");
    let top = positions[highest];
    let near = (0..positions.len() as u32).filter(|&v| positions[v as usize].distance(top) < 0.1);
    let vertices = near.map(VertexId).collect();
    let mixed = (0..positions.len() as u32).map(|v| (VertexId(v), 1 + (v / 97 % 6) as u16)).collect();
    session.apply(Command::Paint { values: mixed });
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices });
    let handle = session.document().and_then(|document| document.scene().groups.last()).expect("just placed").id;
    let revision = session.document().map_or(0, |document| document.revision());
    while !has_answered(session, revision) {
        wait(session);
    }
    handle
}

/// Whether the solver has made a surface for this revision of the document.
fn has_answered(session: &Session, revision: u64) -> bool {
    session.status.report.as_ref().is_some_and(|report| {
        report.revision == revision && matches!(report.state, SolveState::Iterating | SolveState::Settled)
    })
}

fn answered_in(session: &mut Session, command: Command) -> Duration {
    let begun = Instant::now();
    session.apply(command);
    let revision = session.document().map_or(0, |document| document.revision());
    while !has_answered(session, revision) {
        std::thread::sleep(Duration::from_micros(200));
        session.poll();
    }
    begun.elapsed()
}

fn motion(frame: u32) -> DAffine3 {
    let t = f64::from(frame) / f64::from(FRAMES) * std::f64::consts::TAU;
    DAffine3::from_translation(DVec3::new(0.5 * t.sin(), 0.2 * (t.cos() - 1.0), 0.3 * (2.0 * t).sin()))
}

fn print_times(what: &str, times: &mut [Duration]) {
    times.sort_unstable();
    let at = |fraction: f64| times[((times.len() - 1) as f64 * fraction) as usize].as_secs_f64() * 1e3;
    println!("{what}   median {:6.2} ms, 99 % {:6.2} ms, largest {:6.2} ms", at(0.5), at(0.99), at(1.0));
}
