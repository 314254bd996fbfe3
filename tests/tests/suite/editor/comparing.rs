//! Methods: chosen, compared, and made the document's.

use super::*;
use glam::{DAffine3, DMat4};
use pliant::document::{Method, MethodKind};
use pliant::editor::PaneKind;
use pliant_tests::program::{Folder, pliant};
use pliant_tests::shapes;

/// A session with a bar that is held at one end and turned up at the other; and where both ends are, by vertex.
fn bent_bar(path: &str) -> (Session, [Vec<usize>; 2], DAffine3) {
    let bar = shapes::bar([12, 3, 3], [4.0, 1.0, 1.0]);
    std::fs::write(path, bar.obj()).expect("a folder to write to");
    let ends = [bar.vertices(|p| p[0] == 0.0), bar.vertices(|p| p[0] == 4.0)];
    let mut session = Session::new(|| {}).expect("a solver thread");
    session.show(Opened::new(Arc::new(Model::open(Path::new(path)).expect("a good mesh"))), None);
    for (kind, end) in [GroupKind::Anchor, GroupKind::Handle].into_iter().zip(&ends) {
        let vertices = end.iter().map(|&v| VertexId(v as u32)).collect();
        session.apply(Command::Hold { kind, vertices });
    }
    let motion = DAffine3::from_translation(DVec3::new(-0.6, 0.2, 1.2)) * DAffine3::from_rotation_y(-0.7);
    let group = document(&session).scene().groups[1].id;
    session.apply(Command::Move { group, motion });
    session.apply(Command::FillAll(2));
    (session, ends, motion)
}

fn settle_panes(session: &mut Session) {
    wait_until(session, "all panes settle", |session| session.compare().is_some_and(|compare| compare.is_settled()));
}

/// Energy at the end, by the command line.
fn deformed(folder: &Folder, ends: &[Vec<usize>; 2], motion: DAffine3, method: &[&str]) -> f64 {
    let handles = serde_json::json!({
        "fixed": ends[0],
        "groups": [{ "vertices": ends[1], "matrix": DMat4::from(motion).to_cols_array() }],
    });
    let [mesh, handles_path, out, report] =
        ["bar.obj", "handles.json", "out.obj", "report.json"].map(|name| folder.path(name));
    std::fs::write(&handles_path, handles.to_string()).expect("a folder to write to");
    let arguments = ["deform", &mesh, "--handles", &handles_path, "-o", &out, "--report", &report];
    pliant(arguments.iter().chain(&["--tolerance", "1e-8"]).chain(method)).expect_done();
    let text = std::fs::read_to_string(&report).expect("it was written");
    let report: serde_json::Value = serde_json::from_str(&text).expect("a report");
    report["energies"].as_array().and_then(|energies| energies.last()?.as_f64()).expect("iterations")
}

#[test]
fn panes_come_to_the_energies_of_the_command_line() {
    let folder = Folder::new();
    let (mut session, ends, motion) = bent_bar(&folder.path("bar.obj"));
    session.apply(Command::SetMethod(Method { nodes: 80, ..Method::default() }));
    session.open_compare();
    session.compare_with_rigidity(4);
    settle_panes(&mut session);
    for (kind, method) in [
        (PaneKind::Painted, &["--rigidity", "2"][..]),
        (PaneKind::Uniform, &["--rigidity", "4"]),
        (PaneKind::Arap, &["--method", "arap"]),
        (PaneKind::SrArap, &["--method", "sr-arap"]),
        (PaneKind::Embedded, &["--method", "embedded", "--nodes", "80"]),
    ] {
        let panes = session.compare().expect("open").panes();
        let pane = panes.iter().find(|pane| pane.kind == kind).expect("all kinds are there");
        let expected = deformed(&folder, &ends, motion, method);
        // The pane has settled when three iterations lower the energy by less than 1e-6: some tens of that are left.
        assert!((pane.energy - expected).abs() < 1e-3 * expected, "{kind:?}: {}, expected {expected}", pane.energy);
        let volume = pane.measures.expect("settled").volume.expect("a closed surface");
        assert!((0.5..1.5).contains(&volume), "{kind:?}: volume {volume} of that at rest");
    }
}

#[test]
fn using_a_pane_is_one_step_that_undo_takes_back() {
    let folder = Folder::new();
    let (mut session, ..) = bent_bar(&folder.path("bar.obj"));
    settle(&mut session);
    let (before, steps) = (document(&session).scene().clone(), document(&session).history().len());
    session.open_compare();
    session.compare_with_rigidity(5);
    for (kind, method, r) in [
        (PaneKind::Uniform, MethodKind::RRing, 5),
        (PaneKind::SrArap, MethodKind::SrArap, 2),
        (PaneKind::Embedded, MethodKind::Embedded, 2),
        (PaneKind::Arap, MethodKind::Arap, 2),
    ] {
        session.use_pane(kind);
        let scene = document(&session).scene();
        assert_eq!((scene.method.kind, scene.rigidity.max()), (method, r), "{kind:?}");
        settle(&mut session);
        assert_eq!(state(&session), Some(SolveState::Settled), "{kind:?}");
        assert_eq!(document(&session).history().len(), steps + 1, "{kind:?}");
        session.undo();
        assert_eq!(document(&session).scene(), &before, "{kind:?}");
    }
    session.use_pane(PaneKind::Painted);
    assert_eq!(document(&session).history().len(), steps, "it is the document's already");
}

#[test]
fn escape_ends_a_drag_first_and_the_comparison_next() {
    let mut session = session_with(sheet(20));
    place_two_handles(&mut session);
    session.open_compare();
    let from = on_screen(&session, middle(17));
    press_and_move(&mut session, from, from + Vec2::new(40.0, 30.0));
    session.escape();
    assert!(session.compare().is_some() && !session.tool_is_active());
    session.input(Input::Release(pointer(from)));
    session.escape();
    assert!(session.compare().is_none());
    session.toggle_compare();
    settle_panes(&mut session);
    session.show(Opened::new(Arc::new(Model::from_file(sheet(4)).expect("a good mesh"))), None);
    assert!(session.compare().is_none(), "another mesh is not compared");
}

#[test]
fn painting_that_does_not_count_is_told_while_a_painting_tool_is_in_hand() {
    let mut session = session_with(sheet(4));
    session.take_tool(ToolKind::Brush);
    assert_eq!((session.idle_rigidity(), session.idle_painting()), (None, None));
    session.choose_method(MethodKind::SrArap);
    assert!(session.idle_painting().is_some_and(|why| why.starts_with("SR-ARAP")));
    session.take_tool(ToolKind::Handle);
    assert_eq!((session.idle_rigidity().is_some(), session.idle_painting()), (true, None));
    let method = session.method().expect("open");
    session.apply(Command::SetMethod(Method { alpha: -1.0, ..method }));
    assert_eq!(session.method(), Some(method));
    let notices: Vec<_> = session.notices.list().iter().map(|notice| notice.text.clone()).collect();
    assert!(notices.iter().any(|text| text.contains("from 0 to 10")), "{notices:?}");
}
