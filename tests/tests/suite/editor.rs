//! The editor without a window: what its session promises, driven by the same input a window would give.

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

#[test]
fn dragging_a_handle_bends_the_surface_and_holds_the_anchor() {
    let mut session = session_with(sheet(20));
    let rest = document(&session).model().mesh.positions().to_vec();
    session.take_tool(ToolKind::Anchor);
    let at = on_screen(&session, middle(2));
    click(&mut session, at);
    session.take_tool(ToolKind::Handle);
    let from = on_screen(&session, middle(17));
    drag(&mut session, from, from + Vec2::new(60.0, -40.0));
    settle(&mut session);
    let document = document(&session);
    assert_eq!(document.scene().groups.len(), 2);
    let now = &document.pose().positions;
    for (group, moved) in document.scene().groups.iter().zip([false, true]) {
        for (v, target) in group.vertices.iter().zip(group.targets()) {
            assert_eq!(now[v.index()], target, "vertex {} is not exactly where {} holds it", v.0, group.name);
            assert_eq!(target != rest[v.index()], moved, "vertex {} of {}", v.0, group.name);
        }
    }
    let follower = middle(10) as usize;
    assert!(now[follower].distance(rest[follower]) > 1e-3, "the middle of the sheet did not follow");
    assert!(now.iter().all(|p| p.is_finite()));
}

#[test]
fn a_press_without_a_move_places_a_handle_in_one_step() {
    let mut session = session_with(sheet(20));
    let at = on_screen(&session, middle(10));
    click(&mut session, at);
    let document = document(&session);
    assert_eq!(document.scene().groups.len(), 1);
    assert_eq!(document.history().len(), 1);
    let group = &document.scene().groups[0];
    assert!(group.vertices.contains(&VertexId(middle(10))), "{:?}", group.vertices);
    // Two rings of a six-connected grid around the center.
    assert_eq!(group.vertices.len(), 19);
}

#[test]
fn undoing_everything_gives_back_the_start_bit_for_bit() {
    let mut session = session_with(sheet(20));
    let start = document(&session).snapshot();
    for j in [2, 17] {
        let at = on_screen(&session, middle(j));
        click(&mut session, at);
    }
    let from = on_screen(&session, middle(17));
    drag(&mut session, from, from + Vec2::new(80.0, -30.0));
    settle(&mut session);
    session.take_tool(ToolKind::Brush);
    let from = on_screen(&session, middle(9));
    drag(&mut session, from, from + Vec2::new(30.0, 0.0));
    settle(&mut session);
    session.take_tool(ToolKind::Fill);
    session.choose_rigidity(3);
    click(&mut session, from);
    session.take_tool(ToolKind::Select);
    drag(&mut session, Vec2::new(300.0, 200.0), Vec2::new(500.0, 400.0));
    session.apply(Command::FillAll(2));
    session.apply(Command::ResetPose);
    settle(&mut session);
    let end = document(&session).snapshot();
    let steps = document(&session).history().len();
    assert!(steps >= 7, "only {steps} steps were kept");
    for _ in 0..steps {
        session.undo();
    }
    settle(&mut session);
    let undone = document(&session);
    assert_eq!(undone.pose().positions, start.pose.positions, "positions differ from the start");
    assert_eq!(undone.scene().rigidity, start.scene.rigidity);
    assert_eq!(undone.scene().groups, start.scene.groups);
    assert_eq!(undone.scene().selection, start.scene.selection);
    for _ in 0..steps {
        session.redo();
    }
    assert_eq!(document(&session).scene().rigidity, end.scene.rigidity);
    assert_eq!(document(&session).scene().groups, end.scene.groups);
    assert!(!document(&session).history().is_empty());
}

#[test]
fn escape_takes_back_the_drag_under_way() {
    let mut session = session_with(sheet(20));
    for j in [2, 17] {
        let at = on_screen(&session, middle(j));
        click(&mut session, at);
    }
    settle(&mut session);
    let before = document(&session).snapshot();
    let from = on_screen(&session, middle(17));
    press_and_move(&mut session, from, from + Vec2::new(90.0, 50.0));
    assert_ne!(document(&session).scene().groups, before.scene.groups);
    session.input(Input::Key(ToolKey::Escape));
    session.input(Input::Release(pointer(from)));
    settle(&mut session);
    assert_eq!(document(&session).scene().groups, before.scene.groups);
    assert_eq!(document(&session).pose().positions, before.pose.positions, "the surface is not where it was");
    assert_eq!(document(&session).history().len(), 2, "the canceled drag left a step");
}

#[test]
fn undo_in_the_middle_of_a_drag_takes_back_the_drag_and_nothing_more() {
    let mut session = session_with(sheet(20));
    for j in [2, 17] {
        let at = on_screen(&session, middle(j));
        click(&mut session, at);
    }
    let before = document(&session).scene().groups.clone();
    let from = on_screen(&session, middle(17));
    press_and_move(&mut session, from, from + Vec2::new(50.0, 0.0));
    session.undo();
    assert_eq!(document(&session).scene().groups, before);
    assert_eq!(document(&session).history().len(), 2);
}

#[test]
fn resetting_the_pose_during_a_drag_ends_at_rest_whatever_the_solver_still_reports() {
    let mut session = session_with(sheet(20));
    let rest = document(&session).pose().positions.clone();
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: (0..21).map(VertexId).collect() });
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: vec![VertexId(middle(18))] });
    let group = document(&session).scene().groups[1].id;
    for round in 0..20_u32 {
        let way = DVec3::new(0.0, 0.0, 0.1 + 0.01 * f64::from(round));
        session.apply(Command::Move { group, motion: glam::DAffine3::from_translation(way) });
        std::thread::sleep(Duration::from_millis(round.into()));
        session.apply(Command::ResetPose);
        settle(&mut session);
        assert_eq!(document(&session).pose().positions, rest, "round {round}");
    }
}

#[test]
fn choosing_and_naming_things_does_not_disturb_the_solver() {
    let mut session = session_with(sheet(20));
    let at = on_screen(&session, middle(10));
    click(&mut session, at);
    settle(&mut session);
    let revision = document(&session).revision();
    let group = document(&session).scene().groups[0].id;
    session.apply(Command::Select(vec![VertexId(3)], SelectMode::Replace));
    session.apply(Command::Rename(group, "Ear".into()));
    session.apply(Command::Activate(None));
    assert_eq!(document(&session).revision(), revision);
    assert_eq!(document(&session).scene().groups[0].name, "Ear");
}

#[test]
fn front_only_selection_leaves_the_far_side_in_both_projections() {
    use pliant::viewport::Projection;
    for projection in [Projection::Perspective, Projection::Orthographic] {
        let mut session = session_with(ball());
        session.open_mut().expect("open").camera.projection = projection;
        session.options.select_through = false;
        session.take_tool(ToolKind::Select);
        drag(&mut session, Vec2::new(1.0, 1.0), Vec2::new(799.0, 599.0));
        let open = session.open().expect("open");
        let positions = &open.surface.frame().positions;
        let forward = open.camera.forward();
        let selected = &document(&session).scene().selection;
        for (v, position) in positions.iter().enumerate() {
            // The ball has radius 1; a band around the outline may fall either way.
            let depth = position.dot(forward);
            let expected = if depth < -0.5 { Some(true) } else { (depth > 0.2).then_some(false) };
            let got = selected.contains(VertexId(v as u32));
            assert!(
                expected.is_none_or(|expected| expected == got),
                "{projection:?}: vertex {v} at depth {depth}: {got}"
            );
        }
    }
}

/// An octahedron, each face cut into 64 and pushed out to radius 1.
fn ball() -> MeshFile {
    let corners = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    let faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    let n = 8;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for [a, b, c] in faces.map(|face| face.map(|corner| corners[corner])) {
        let mut vertex = |i: i32, j: i32| {
            positions.push((a * f64::from(n - i - j) + b * f64::from(i) + c * f64::from(j)).normalize());
            positions.len() as u32 - 1
        };
        for i in 0..n {
            for j in 0..n - i {
                triangles.push([vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)]);
                if i + j + 1 < n {
                    triangles.push([vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
                }
            }
        }
    }
    MeshFile::from_triangles("ball", positions, triangles)
}

#[test]
fn escape_takes_back_the_stroke_under_way() {
    let mut session = session_with(sheet(20));
    session.take_tool(ToolKind::Brush);
    let before = document(&session).scene().rigidity.clone();
    let from = on_screen(&session, middle(10));
    press_and_move(&mut session, from, from + Vec2::new(50.0, 0.0));
    assert_ne!(document(&session).scene().rigidity, before);
    session.input(Input::Key(ToolKey::Escape));
    assert_eq!(document(&session).scene().rigidity, before);
    assert!(document(&session).history().is_empty());
}

#[test]
fn painting_while_a_pose_is_held_changes_the_shape() {
    let mut session = session_with(sheet(20));
    let bottom: Vec<_> = (0..21).map(VertexId).collect();
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: bottom });
    let from = on_screen(&session, middle(18));
    drag(&mut session, from, from + Vec2::new(120.0, 60.0));
    settle(&mut session);
    let soft = document(&session).pose().positions.clone();
    session.take_tool(ToolKind::Brush);
    session.choose_rigidity(6);
    session.options.brush_radius_px = 90.0;
    let middle = on_screen(&session, middle(10));
    drag(&mut session, middle, middle + Vec2::new(40.0, 0.0));
    settle(&mut session);
    let stiff = &document(&session).pose().positions;
    let change = soft.iter().zip(stiff.iter()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(change > 1e-4, "painting r = 6 moved nothing farther than {change}");
    assert_eq!(document(&session).scene().rigidity.max(), 6);
}

#[test]
fn the_brush_stays_within_its_radius_along_the_surface() {
    let mut session = session_with(sheet(20));
    session.take_tool(ToolKind::Brush);
    session.options.brush_radius_px = 40.0;
    let center = on_screen(&session, middle(10));
    click(&mut session, center);
    let r = document(&session).scene().rigidity.clone();
    for v in 0..441 {
        let painted = r.as_slice()[v as usize] == 6;
        let distance = on_screen(&session, v).distance(center);
        // The camera looks at the sheet from an angle, so a circle on it is an ellipse on screen.
        assert!(!painted || distance < 48.0, "vertex {v} at {distance} px was painted");
        assert!(painted || distance > 12.0, "vertex {v} at {distance} px was not painted");
    }
}

#[test]
fn softer_and_stiffer_change_each_vertex_once_a_stroke() {
    let mut session = session_with(sheet(20));
    session.apply(Command::FillAll(4));
    session.take_tool(ToolKind::Brush);
    session.options.brush_mode = BrushMode::Stiffer;
    let at = on_screen(&session, middle(10));
    // In one go: several dabs fall on the same vertices before any of them is carried out.
    session.input(Input::Press(pointer(at)));
    session.input(Input::Drag(pointer(at + Vec2::new(60.0, 0.0))));
    session.input(Input::Release(pointer(at + Vec2::new(60.0, 0.0))));
    let stiffer = document(&session).scene().rigidity.as_slice()[middle(10) as usize];
    assert_eq!((document(&session).scene().rigidity.max(), stiffer), (5, 5));
    session.options.brush_mode = BrushMode::Softer;
    drag(&mut session, at, at + Vec2::new(60.0, 0.0));
    assert_eq!((document(&session).scene().rigidity.min(), document(&session).scene().rigidity.max()), (4, 4));
}

#[test]
fn fill_takes_the_selection_or_else_the_region_of_equal_rigidity() {
    let mut session = session_with(sheet(20));
    let lower: Vec<_> = (0..21 * 8).map(VertexId).collect();
    session.apply(Command::Fill { vertices: lower.clone(), r: 3 });
    session.take_tool(ToolKind::Fill);
    session.choose_rigidity(9);
    let at = on_screen(&session, middle(4));
    click(&mut session, at);
    let count =
        |session: &Session, r| document(session).scene().rigidity.as_slice().iter().filter(|&&x| x == r).count();
    assert_eq!(count(&session, 9), lower.len(), "the region of r = 3, and no more, was to become 9");
    session.apply(Command::Select((0..50).map(VertexId).collect(), SelectMode::Replace));
    session.choose_rigidity(2);
    let at = on_screen(&session, middle(1));
    click(&mut session, at);
    assert_eq!(count(&session, 2), 50, "the selection, and no more, was to become 2");
}

#[test]
fn box_and_lasso_select_what_they_enclose() {
    let mut session = session_with(sheet(20));
    session.take_tool(ToolKind::Select);
    let (lo, hi) = (on_screen(&session, middle(10)) - 30.0, on_screen(&session, middle(10)) + 30.0);
    drag(&mut session, lo, hi);
    let selected = |session: &Session| document(session).scene().selection.clone();
    let expected: Vec<VertexId> = (0..441)
        .filter(|&v| {
            let p = on_screen(&session, v);
            p.cmpge(lo).all() && p.cmple(hi).all()
        })
        .map(VertexId)
        .collect();
    assert!(expected.len() > 3);
    assert_eq!(selected(&session).vertices(), expected);
    session.options.select_shape = SelectShape::Lasso;
    let corners = [lo, Vec2::new(hi.x, lo.y), hi, Vec2::new(lo.x, hi.y)];
    session.input(Input::Press(pointer(lo)));
    corners[1..].iter().for_each(|&p| session.input(Input::Drag(pointer(p))));
    session.input(Input::Release(pointer(corners[3])));
    assert_eq!(selected(&session).vertices(), expected, "the same outline drawn as a lasso");
}

#[test]
fn holding_everything_else_leaves_only_the_selection_free() {
    let mut session = session_with(sheet(20));
    session.apply(Command::Select((100..200).map(VertexId).collect(), SelectMode::Replace));
    session.hold_everything_else();
    let group = &document(&session).scene().groups[0];
    assert_eq!((group.kind, group.vertices.len()), (GroupKind::Anchor, 441 - 100));
}

#[test]
fn a_vertex_is_never_held_by_two_groups() {
    let mut session = session_with(sheet(20));
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: (0..50).map(VertexId).collect() });
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: (40..90).map(VertexId).collect() });
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: (0..10).map(VertexId).collect() });
    let sizes: Vec<_> = document(&session).scene().groups.iter().map(|group| group.vertices.len()).collect();
    assert_eq!(sizes, [30, 50, 10]);
    settle(&mut session);
    assert_eq!(state(&session), Some(SolveState::Settled));
}

#[test]
fn refused_commands_become_notices_and_change_nothing() {
    let mut session = session_with(sheet(4));
    let before = document(&session).snapshot().scene;
    session.apply(Command::FillAll(0));
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: vec![VertexId(9000)] });
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: Vec::new() });
    assert_eq!(document(&session).scene(), &before);
    assert!(document(&session).history().is_empty());
    let errors = session.notices.list().iter().filter(|notice| notice.kind == NoticeKind::Error).count();
    assert_eq!(errors, 3, "{:?}", session.notices.list());
}

#[test]
fn a_file_that_cannot_be_opened_leaves_the_document_and_says_why() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let broken = folder.path().join("broken.obj");
    std::fs::write(&broken, "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n").expect("written");
    let mut session = session_with(sheet(4));
    session.apply(Command::FillAll(5));
    for path in [broken, folder.path().join("missing.glb"), folder.path().join("picture.png")] {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        session.start(Job::Open(path));
        wait_until(&mut session, "the job ends", |session| session.running_job().is_none());
        let last = session.notices.list().last().expect("a notice").clone();
        assert_eq!(last.kind, NoticeKind::Error);
        assert!(last.text.contains(&name), "{name} is not named in: {}", last.text);
        assert_eq!(document(&session).scene().rigidity.max(), 5, "the document changed");
    }
}

#[test]
fn what_is_saved_opens_again_with_the_same_shape_and_rigidity() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = session_with(sheet(20));
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: (0..21).map(VertexId).collect() });
    let from = on_screen(&session, middle(18));
    drag(&mut session, from, from + Vec2::new(70.0, 20.0));
    session.apply(Command::Fill { vertices: (100..200).map(VertexId).collect(), r: 7 });
    settle(&mut session);
    for name in ["bent.glb", "bent.obj"] {
        let to = folder.path().join(name);
        save(&mut session, &to);
        assert!(!document(&session).is_modified(), "still marked as modified after saving {name}");
        let saved = document(&session).snapshot();
        let again = Model::open(&to).expect("opens again");
        assert_eq!(again.rigidity, saved.scene.rigidity, "{name}");
        for (v, (got, expected)) in again.mesh.positions().iter().zip(saved.pose.positions.iter()).enumerate() {
            // glTF keeps single precision: half a unit in the last place of a coordinate below 2.
            assert!(got.distance(*expected) < 3e-7, "{name}: vertex {v} is at {got}, expected {expected}");
        }
    }
}

fn save(session: &mut Session, to: &Path) {
    let (model, snapshot) = (document(session).model().clone(), document(session).snapshot());
    session.start(Job::Save { model, snapshot, to: to.to_owned() });
    wait_until(session, "saved", |session| session.running_job().is_none());
    let last = session.notices.list().last().expect("a notice");
    assert!(to.is_file(), "{} was not written: {last:?}", to.display());
}

#[test]
fn rigidity_painted_back_to_1_is_1_again_in_the_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let to = folder.path().join("bent.obj");
    let mut session = session_with(sheet(4));
    session.apply(Command::FillAll(6));
    save(&mut session, &to);
    session.apply(Command::FillAll(1));
    save(&mut session, &to);
    assert_eq!(Model::open(&to).expect("opens again").rigidity.max(), 1);
}

#[test]
fn a_save_that_ends_after_another_mesh_was_opened_does_not_concern_that_mesh() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = session_with(sheet(20));
    session.apply(Command::FillAll(3));
    let (model, snapshot) = (document(&session).model().clone(), document(&session).snapshot());
    session.start(Job::Save { model, snapshot, to: folder.path().join("first.glb") });
    session.show(Opened::new(Arc::new(Model::from_file(sheet(4)).expect("a good mesh"))), None);
    wait_until(&mut session, "saved", |session| session.running_job().is_none());
    assert_eq!(session.open().expect("open").save_path, None, "saving would now overwrite the first mesh");
}

#[test]
fn a_mesh_that_arrives_after_further_changes_is_not_shown_without_asking() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("other.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let mut session = session_with(sheet(4));
    session.start(Job::Open(path));
    session.apply(Command::FillAll(5));
    let start = Instant::now();
    let mut events = Vec::new();
    while events.is_empty() {
        assert!(start.elapsed() < Duration::from_secs(60), "the mesh never arrived");
        events = session.poll();
    }
    assert!(matches!(events[..], [pliant::editor::JobEvent::Opened { .. }]));
    assert_eq!(document(&session).model().mesh.n_vertices(), 25);
}

#[test]
fn every_sample_opens_and_bends() {
    for sample in Sample::ALL {
        let mut session = Session::new(|| {}).expect("a solver thread");
        session.start(Job::OpenSample(sample));
        wait_until(&mut session, "the sample is open", |session| session.document().is_some());
        let n = document(&session).model().mesh.n_vertices();
        let held = held_by(&document(&session).scene().groups).0;
        let rest = document(&session).pose().clone();
        assert!(!held.is_empty(), "{sample:?} comes without anchors");
        assert!(document(&session).history().is_empty() && !document(&session).is_modified());
        let free = (0..n as u32).map(VertexId).find(|v| !held.contains(v)).expect("a free vertex");
        session.apply(Command::Hold { kind: GroupKind::Handle, vertices: vec![free] });
        let group = document(&session).scene().groups.last().expect("placed").id;
        let motion = glam::DAffine3::from_translation(DVec3::splat(0.01));
        session.apply(Command::Move { group, motion });
        let revision = document(&session).revision();
        wait_until(&mut session, "the surface follows", |session| {
            let report = session.status.report.as_ref();
            report.is_some_and(|report| report.revision == revision) && *document(session).pose() != rest
        });
        assert!(document(&session).pose().positions.iter().all(|p| p.is_finite()), "{sample:?}");
    }
}

#[test]
fn deleting_all_handles_and_placing_new_ones_keeps_the_pose() {
    let mut session = session_with(sheet(20));
    for j in [2, 17] {
        let at = on_screen(&session, middle(j));
        click(&mut session, at);
    }
    let from = on_screen(&session, middle(17));
    drag(&mut session, from, from + Vec2::new(80.0, -30.0));
    settle(&mut session);
    let bent = document(&session).pose().positions.clone();
    let groups: Vec<_> = document(&session).scene().groups.iter().map(|group| group.id).collect();
    session.apply(Command::Release(groups));
    settle(&mut session);
    assert_eq!(state(&session), Some(SolveState::Resting));
    assert_eq!(document(&session).pose().positions, bent, "letting go moved the surface");
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: vec![VertexId(middle(17))] });
    assert_eq!(document(&session).scene().groups[0].base[0], bent[middle(17) as usize]);
}

#[test]
fn every_action_without_a_document_says_what_to_do() {
    let session = Session::new(|| {}).expect("a solver thread");
    for &action in Action::ALL {
        let needs_document = !matches!(
            action,
            Action::Open | Action::OpenSample(_) | Action::Quit | Action::Tool(_) | Action::ToggleTheme | Action::Keys
        );
        assert_eq!(action.obstacle(&session).is_some(), needs_document, "{action:?}");
        assert!(!action.label().is_empty() && !action.tooltip().is_empty(), "{action:?}");
    }
}

#[test]
fn no_two_actions_share_a_shortcut() {
    let mut seen = Vec::new();
    for &action in Action::ALL {
        if let Some(shortcut) = action.shortcut() {
            assert!(!seen.contains(&shortcut), "{action:?} has a shortcut that is taken: {shortcut:?}");
            seen.push(shortcut);
        }
    }
}
