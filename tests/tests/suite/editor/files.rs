//! Opening and exporting.

use super::*;

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
fn what_is_exported_opens_again_with_the_same_shape_and_rigidity() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = session_with(sheet(20));
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: (0..21).map(VertexId).collect() });
    let from = on_screen(&session, middle(18));
    drag(&mut session, from, from + Vec2::new(70.0, 20.0));
    session.apply(Command::Fill { vertices: (100..200).map(VertexId).collect(), r: 7 });
    settle(&mut session);
    for name in ["bent.glb", "bent.obj"] {
        let to = folder.path().join(name);
        export(&mut session, &to);
        let saved = document(&session).snapshot();
        let again = Model::open(&to).expect("opens again");
        assert_eq!(again.rigidity, saved.scene.rigidity, "{name}");
        for (v, (got, expected)) in again.mesh.positions().iter().zip(saved.pose.positions.iter()).enumerate() {
            // glTF keeps single precision: half a unit in the last place of a coordinate below 2.
            assert!(got.distance(*expected) < 3e-7, "{name}: vertex {v} is at {got}, expected {expected}");
        }
    }
}

fn export(session: &mut Session, to: &Path) {
    session.export(to.to_owned());
    wait_until(session, "exported", |session| session.running_job().is_none());
    let last = session.notices.list().last().expect("a notice");
    assert!(to.is_file(), "{} was not written: {last:?}", to.display());
}

#[test]
fn rigidity_painted_back_to_1_is_1_again_in_the_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let to = folder.path().join("bent.obj");
    let mut session = session_with(sheet(4));
    session.apply(Command::FillAll(6));
    export(&mut session, &to);
    session.apply(Command::FillAll(1));
    export(&mut session, &to);
    assert_eq!(Model::open(&to).expect("opens again").rigidity.max(), 1);
}

#[test]
fn a_save_that_ends_after_another_mesh_was_opened_does_not_concern_that_mesh() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = session_with(sheet(20));
    session.apply(Command::FillAll(3));
    session.save_project(folder.path().join("first.pliant"), pliant::project::Mesh::Packed);
    session.export(folder.path().join("first.glb"));
    session.show(Opened::new(Arc::new(Model::from_file(sheet(4)).expect("a good mesh"))), None);
    wait_until(&mut session, "saved", |session| session.running_job().is_none());
    let open = session.open().expect("open");
    assert_eq!(open.project, None, "saving would now overwrite the first project");
    assert!(open.exported.is_none(), "exporting would now overwrite the first mesh");
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
fn an_opening_that_is_canceled_leaves_the_document_and_says_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("other.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let mut session = session_with(sheet(4));
    session.start(Job::Open(path.clone()));
    assert!(session.opening().is_some_and(|done| (0.0..=1.0).contains(&done)));
    session.cancel_opening();
    assert_eq!((session.opening(), session.running_job()), (None, None));
    // The next one is not confused with it.
    session.welding = pliant_meshfile::Welding::Never;
    session.start(Job::Open(path));
    wait_until(&mut session, "the mesh is open", |session| session.running_job().is_none());
    assert_eq!(document(&session).model().mesh.n_vertices(), 3);
    assert_eq!(document(&session).model().file.welding, pliant_meshfile::Welding::Never);
    assert!(session.notices.list().iter().all(|notice| notice.kind != NoticeKind::Error));
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
fn what_may_spoil_a_bend_is_said_on_opening_and_can_be_looked_at() {
    let mut positions = vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
    positions.push(DVec3::X * 2.0);
    let file = MeshFile::from_triangles("folded", positions, vec![[0, 1, 2], [0, 3, 2], [1, 4, 2], [1, 4, 2]]);
    let mut session = session_with(file);
    let said = &session.notices.list()[0].text;
    assert!(
        said.contains("1 edge with more than two faces, 1 face that repeats an earlier one, 3 edges between"),
        "{said}"
    );
    let findings = &document(&session).model().findings;
    let finding = findings.iter().find(|finding| finding.kind == "duplicate_faces").expect("found");
    let vertices = finding.vertices(&document(&session).model().mesh);
    session.apply(Command::Select(vertices, SelectMode::Replace));
    let selected: Vec<u32> = document(&session).scene().selection.vertices().iter().map(|v| v.0).collect();
    assert_eq!(selected, [1, 2, 4], "the corners of the repeated face");
}
