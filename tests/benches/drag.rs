//! What a person feels: during a drag on the start sample at mixed r, surfaces a second from the solver and the window's
//! own work a frame; on 100,000 vertices, the wait for a surface after a dab of the brush and after a new handle; on 250,000
//! and a million, surfaces a second. Run by `cargo bench -p pliant-tests --bench drag`; needs a graphics adapter for the
//! window. `-- drag`, `-- window`, `-- waits` or `-- large` runs one part.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::{DAffine3, DVec3};
use pliant::document::{Command, GroupId, GroupKind, Model};
use pliant::editor::{EditorApp, Job, Opened, Sample, Session};
use pliant::solving::SolveState;
use pliant_meshfile::MeshFile;
use pliant_solver::VertexId;

/// A drag of this many frames at this rate.
const FRAMES: u32 = 180;
const FRAME: Duration = Duration::from_nanos(16_666_667);

fn main() {
    let chosen: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let parts: [(&str, fn()); 4] =
        [("drag", session_drag), ("waits", waits), ("large", large_drags), ("window", window_drag)];
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

/// The whole window: its own work, excluding what the renderer does. The window is so narrow that next to nothing is left
/// of the viewport: a software adapter would otherwise take the cores whose time is measured.
fn window_drag() {
    let mut window: Harness<'_, EditorApp> = Harness::builder()
        .with_size([400.0, 800.0])
        .wgpu()
        .build_eframe(|cc| EditorApp::new(cc, Vec::new()).unwrap_or_else(|error| panic!("{error}")));
    while window.state_mut().session().document().is_none() {
        window.step();
    }
    let handle = prepare(window.state_mut().session(), |session| {
        session.poll();
        std::thread::sleep(Duration::from_millis(1));
    });
    let corner = window.get_by_label("viewport").rect().center();
    let (mut ui, mut drawing, mut on_core) = (Vec::new(), Vec::new(), Vec::new());
    for frame in 0..FRAMES {
        let begun = Instant::now();
        window.state_mut().session().apply(Command::Move { group: handle, motion: motion(frame) });
        window.hover_at(corner + egui::vec2(frame as f32 * 0.5, 0.0));
        let before = time_on_core();
        window.step();
        on_core.extend(time_on_core().zip(before).map(|(after, before)| after - before));
        let work = window.state_mut().last_frame_work();
        ui.push(work.ui.saturating_sub(work.drawing));
        drawing.push(work.drawing);
        std::thread::sleep(FRAME.saturating_sub(begun.elapsed()));
    }
    println!("drag in the window, {FRAMES} frames");
    print_times("  window's own work", &mut ui);
    print_times("  renderer's work  ", &mut drawing);
    if !on_core.is_empty() {
        print_times("  both, on a core  ", &mut on_core);
    }
}

/// Time this thread has spent on a core, where Linux tells: without the waits for a core that the solver has.
fn time_on_core() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().next()?.parse().ok().map(Duration::from_nanos)
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

/// Drags on meshes whose iterations are slower than the screen: surfaces a second, and the longest wait for one.
fn large_drags() {
    for cells in [500, 1000] {
        let mut session = Session::new(|| {}).expect("a solver thread");
        let model = Model::from_file(bumpy_sheet(cells)).expect("a good mesh");
        session.show(Opened::new(Arc::new(model)), None);
        session.apply(Command::FillAll(2));
        session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: (0..=cells).map(VertexId).collect() });
        let last_row = (cells * (cells + 1)..(cells + 1) * (cells + 1)).map(VertexId).collect();
        answered_in(&mut session, Command::Hold { kind: GroupKind::Handle, vertices: last_row });
        let handle = session.document().and_then(|document| document.scene().groups.last()).expect("just placed").id;
        // What is needed to follow is made in the background; a person looks at the mesh for longer before dragging.
        for frame in 0..3 {
            answered_in(&mut session, Command::Move { group: handle, motion: motion(frame) });
            std::thread::sleep(Duration::from_secs(2));
            session.poll();
        }
        let (mut shown, mut waits) = (Instant::now(), Vec::new());
        let mut last = None;
        let start = Instant::now();
        for frame in 3..FRAMES {
            let begun = Instant::now();
            session.apply(Command::Move { group: handle, motion: motion(frame) });
            while begun.elapsed() < FRAME {
                session.poll();
                let frame = session.open().map(|open| Arc::as_ptr(open.surface.frame()));
                if frame != last {
                    waits.push(shown.elapsed());
                    (shown, last) = (Instant::now(), frame);
                }
                std::thread::sleep(Duration::from_micros(500));
            }
        }
        let rate = waits.len() as f64 / start.elapsed().as_secs_f64();
        println!("drag on {} vertices, r 2, without drawing", (cells + 1) * (cells + 1));
        println!("  surfaces a second        {rate:8.1}");
        print_times("  wait for a surface    ", &mut waits);
        let ms = session.status.report.as_ref().map_or(0.0, |report| report.iteration_ms);
        println!("  solver iteration, median {ms:8.2} ms");
    }
}

/// From a wish to the surface that knows of it, while the surface before is still on its way.
fn waits() {
    let mut session = Session::new(|| {}).expect("a solver thread");
    let model = Model::from_file(bumpy_sheet(CELLS)).expect("a good mesh");
    session.show(Opened::new(Arc::new(model)), None);
    let rim = (0..=CELLS).map(VertexId).collect();
    session.apply(Command::FillAll(2));
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: rim });
    let first = answered_in(&mut session, Command::Hold { kind: GroupKind::Handle, vertices: patch(150, 300, 2) });
    let group = session.document().and_then(|document| document.scene().groups.last()).expect("just placed").id;
    let motion = DAffine3::from_translation(DVec3::new(0.0, 0.1, 0.2));
    answered_in(&mut session, Command::Move { group, motion });
    let dabs = (0..9).map(|k| {
        let values = patch(30 + 30 * k, 40 + 25 * k, 12).into_iter().map(|v| (v, 6)).collect();
        answered_in(&mut session, Command::Paint { values })
    });
    let mut dabs: Vec<Duration> = dabs.collect();
    let handles = (0..9).map(|k| {
        let vertices = patch(285 - 30 * k, 40 + 20 * k, 2);
        answered_in(&mut session, Command::Hold { kind: GroupKind::Handle, vertices })
    });
    let mut handles: Vec<Duration> = handles.collect();
    let report = session.status.report.as_ref().expect("it has answered");
    println!("waits for a surface: {} vertices, r 2", (CELLS + 1) * (CELLS + 1));
    println!("  first build              {:8.1} ms", first.as_secs_f64() * 1e3);
    print_times("  dab of 469 to r 6     ", &mut dabs);
    print_times("  handle of 19          ", &mut handles);
    println!("  solver iteration, median {:8.2} ms", report.iteration_ms);
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

/// Cells along each side: 100,489 vertices.
const CELLS: u32 = 316;

/// A sheet with small hills, two triangles a cell.
fn bumpy_sheet(n: u32) -> MeshFile {
    let at = |i: u32, j: u32| {
        let (x, y) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
        DVec3::new(x, y, 0.02 * (31.0 * x).sin() * (23.0 * y).cos())
    };
    let positions = (0..=n).flat_map(|j| (0..=n).map(move |i| at(i, j))).collect();
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| j * (n + 1) + i);
        [[a, b, c], [a, c, d]]
    });
    MeshFile::from_triangles("hills", positions, triangles.collect())
}

/// The vertices within so many rings of a vertex of the sheet: a hexagon.
fn patch(i: i64, j: i64, rings: i64) -> Vec<VertexId> {
    let around = (-rings..=rings).flat_map(|y| (-rings..=rings).map(move |x| (x, y)));
    let inside = around.filter(|(x, y)| (x - y).abs() <= rings).map(|(x, y)| (i + x, j + y));
    inside.map(|(i, j)| VertexId((j * i64::from(CELLS + 1) + i) as u32)).collect()
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
