//! The window's own work: a scripted minute of turning the view, painting and dragging on 100,000 vertices, and a drag on the
//! start sample. A frame's work is the time that the window's thread spends on a core, all of it but the waits. The graphics
//! adapter is one that does nothing: a software adapter would do some of its work on the window's thread.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui_wgpu::{WgpuSetup, WgpuSetupCreateNew};
use eframe::wgpu;
use egui::{Event, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::Vec2;
use pliant::document::{Command, GroupId, GroupKind, Model};
use pliant::editor::{EditorApp, Opened, Session};
use pliant::tools::{Input, Modifiers as Keys, Pointer, ToolKind, View};
use pliant_solver::VertexId;

use crate::sheet::{CELLS, bumpy_sheet, patch};
use crate::{FRAME, FRAMES, motion, prepare, print_times};

type Window = Harness<'static, EditorApp>;

/// Frames of each part of the minute: 20 seconds.
const PART: u32 = 1200;
/// Frames of one stroke of the brush.
const STROKE: u32 = 60;
/// Times that something short is done to be measured.
const REPEATS: u32 = 200;

fn window(size: [f32; 2]) -> Window {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = wgpu::Backends::NOOP;
    setup.instance_descriptor.backend_options.noop = wgpu::NoopBackendOptions {
        device_type: Some(wgpu::DeviceType::DiscreteGpu), // pictures are made as for hardware
        ..wgpu::NoopBackendOptions::enabled()
    };
    Harness::builder()
        .with_size(size)
        .wgpu_setup(WgpuSetup::CreateNew(setup))
        .build_eframe(|cc| EditorApp::new(cc, Vec::new()).unwrap_or_else(|error| panic!("{error}")))
}

/// The whole window on the start sample.
pub(crate) fn drag() {
    let mut window = window([400.0, 800.0]);
    while window.state_mut().session().document().is_none() {
        window.step();
    }
    let handle = prepare(window.state_mut().session(), wait);
    let corner = window.get_by_label("viewport").rect().center();
    let mut work = Work::default();
    for frame in 0..FRAMES {
        window.state_mut().session().apply(Command::Move { group: handle, motion: motion(frame) });
        window.hover_at(corner + vec2(frame as f32 * 0.5, 0.0));
        work.step(&mut window);
    }
    work.print(&format!("drag in the window, {FRAMES} frames"));
}

/// Twenty seconds each of turning, painting and dragging, with the mouse, on the sheet of 100,489 vertices.
pub(crate) fn minute() {
    let mut window = window([640.0, 560.0]);
    let handle = show_sheet(&mut window);
    let view = window.get_by_label("viewport").rect();
    let around = |frame: u32, radius: f32| {
        let angle = frame as f32 / 97.0 * std::f32::consts::TAU;
        view.center() + radius * vec2(angle.cos(), angle.sin())
    };

    let mut turning = Work::default();
    press(&window, view.center(), PointerButton::Secondary, true);
    for frame in 0..PART {
        window.hover_at(around(frame, 60.0));
        turning.step(&mut window);
    }
    press(&window, view.center(), PointerButton::Secondary, false);
    window.step();

    let mut painting = Work::default();
    window.state_mut().session().take_tool(ToolKind::Brush);
    for frame in 0..PART {
        let at = around(frame, 20.0 + 60.0 * (frame / STROKE) as f32 / (PART / STROKE) as f32);
        if frame % STROKE == 0 {
            window.state_mut().session().choose_rigidity(1 + (frame / STROKE % 6) as u16);
            press(&window, at, PointerButton::Primary, true);
        }
        window.hover_at(at);
        if frame % STROKE == STROKE - 1 {
            press(&window, at, PointerButton::Primary, false);
        }
        painting.step(&mut window);
    }

    let mut dragging = Work::default();
    window.state_mut().session().take_tool(ToolKind::Handle);
    let start = middle(&mut window, handle, view.min);
    window.hover_at(start);
    window.step();
    press(&window, start, PointerButton::Primary, true);
    for frame in 0..PART {
        window.hover_at(start + (around(frame, 30.0) - around(0, 30.0)));
        dragging.step(&mut window);
    }
    press(&window, start, PointerButton::Primary, false);
    window.step();

    println!("a minute in the window, {} vertices, r 1 to 6", (CELLS + 1) * (CELLS + 1));
    turning.print("turning the view");
    painting.print("painting");
    dragging.print("dragging a handle");
    let mut all = turning;
    all.extend(painting);
    all.extend(dragging);
    all.print("the whole minute");
    short_things(window.state_mut().session());
}

/// One dab of the brush with all that follows from it in the window's thread, and one look for what is under the pointer.
fn short_things(session: &mut Session) {
    let size = session.viewport_size();
    let at = |k: u32| size * 0.5 + 0.2 * size.min_element() * Vec2::from_angle(k as f32);
    session.take_tool(ToolKind::Brush);
    let (mut dabs, mut on_core) = (Vec::new(), Vec::new());
    for k in 0..REPEATS {
        let pointer = Pointer { px: at(k), modifiers: Keys::default() };
        session.choose_rigidity(1 + (k % 6) as u16);
        let (begun, before) = (Instant::now(), time_on_core());
        session.input(Input::Press(pointer));
        dabs.push(begun.elapsed());
        on_core.extend(time_on_core().zip(before).map(|(after, before)| after - before));
        session.input(Input::Release(pointer));
        session.poll();
    }
    print_times("  dab of the brush    ", &mut dabs);
    if !on_core.is_empty() {
        print_times("  the same, on a core ", &mut on_core);
    }
    let open = session.open_mut().expect("open");
    let view = View { camera: open.camera, size };
    open.surface.pick(at(0), &view); // catches up with the surface, once for each that arrives
    let looks = (0..REPEATS).map(|k| {
        let begun = Instant::now();
        std::hint::black_box(open.surface.pick(at(k), &view));
        begun.elapsed()
    });
    let mut looks: Vec<Duration> = looks.collect();
    print_times("  looking under the pointer", &mut looks);
}

/// The sheet with its rim held, a handle in the middle, and r in stripes.
fn show_sheet(window: &mut Window) -> GroupId {
    while window.state_mut().session().document().is_none() {
        window.step();
    }
    let session = window.state_mut().session();
    let model = Model::from_file(bumpy_sheet(CELLS)).expect("a good mesh");
    session.show(Opened::new(Arc::new(model)), None);
    session.dismiss_welcome();
    let n = (CELLS + 1) * (CELLS + 1);
    let mixed = (0..n).map(|v| (VertexId(v), 1 + (v / 3000 % 6) as u16)).collect();
    session.apply(Command::Paint { values: mixed });
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: (0..=CELLS).map(VertexId).collect() });
    let middle = i64::from(CELLS / 2);
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: patch(middle, middle, 3) });
    let handle = session.document().and_then(|document| document.scene().groups.last()).expect("just placed").id;
    let revision = session.document().map_or(0, |document| document.revision());
    while !crate::has_answered(session, revision) {
        wait(session);
    }
    for _ in 0..5 {
        window.step();
    }
    handle
}

/// Where the middle of a group is in the window.
fn middle(window: &mut Window, group: GroupId, corner: Pos2) -> Pos2 {
    let session = window.state_mut().session();
    let size = session.viewport_size();
    let open = session.open().expect("open");
    let group = open.document.scene().group(group).expect("held");
    let center = open.document.model().to_view(group.center());
    let (px, _) = open.camera.project(center, size).expect("in front of the eye");
    corner + vec2(px.x, px.y)
}

fn press(window: &Window, pos: Pos2, button: PointerButton, pressed: bool) {
    window.event(Event::PointerMoved(pos));
    window.event(Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
}

fn wait(session: &mut Session) {
    session.poll();
    std::thread::sleep(Duration::from_millis(1));
}

/// What frames cost.
#[derive(Default)]
struct Work {
    /// By the clock, without the renderer.
    ui: Vec<Duration>,
    /// The renderer's, by the clock.
    drawing: Vec<Duration>,
    /// Both, on a core.
    on_core: Vec<Duration>,
}

impl Work {
    /// One frame, no sooner than a screen of 60 Hz would show it.
    fn step(&mut self, window: &mut Window) {
        let begun = Instant::now();
        let before = time_on_core();
        window.step();
        self.on_core.extend(time_on_core().zip(before).map(|(after, before)| after - before));
        let work = window.state_mut().last_frame_work();
        self.ui.push(work.ui.saturating_sub(work.drawing));
        self.drawing.push(work.drawing);
        std::thread::sleep(FRAME.saturating_sub(begun.elapsed()));
    }

    fn extend(&mut self, other: Work) {
        self.ui.extend(other.ui);
        self.drawing.extend(other.drawing);
        self.on_core.extend(other.on_core);
    }

    fn print(&mut self, what: &str) {
        println!("{what}");
        print_times("  window's own work  ", &mut self.ui);
        print_times("  renderer's work    ", &mut self.drawing);
        if !self.on_core.is_empty() {
            print_times("  both, on a core    ", &mut self.on_core);
        }
    }
}

/// Time this thread has spent on a core: without the waits for a core that the solver has.
fn time_on_core() -> Option<Duration> {
    #[cfg(target_os = "linux")]
    return Duration::try_from(rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime)).ok();
    #[cfg(not(target_os = "linux"))]
    return None;
}
