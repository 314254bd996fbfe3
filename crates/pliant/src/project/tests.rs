//! What a project promises: everything comes back, and nothing but what was written is taken for it.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_meshfile::OpenOptions;
use pliant_solver::{LooseComponents, VertexId, Weights};

use super::container::{Reader, Writer};
use super::{Contents, Loaded, Mesh, MeshChoice, ProjectError, open, save, summary};
use crate::document::{
    Command, Document, GroupColor, GroupId, GroupKind, Method, MethodKind, Model, Pose, PoseChange, SelectMode,
    SetChange, SetId, Snapshot,
};
use crate::viewport::{Axis, Camera, Projection};

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nv 0.5 0.5 2\nf 1 2 3\nf 1 3 4\nf 1 2 5\nf 2 3 5\n";

fn document(folder: &Path) -> Document {
    let path = folder.join("mesh.obj");
    std::fs::write(&path, OBJ).expect("a file");
    let file = OpenOptions { keep: true, ..OpenOptions::default() }.open(&path).expect("opens");
    Document::new(Arc::new(Model::from_file(file).expect("a good mesh")))
}

/// A document in which everything is something else than at first.
fn rich(folder: &Path) -> Document {
    let mut document = document(folder);
    let hold = |kind, v: &[u32]| Command::Hold { kind, vertices: v.iter().map(|&v| VertexId(v)).collect() };
    let id = document.next_group();
    let other = GroupId(id.0 + 1);
    for command in [
        hold(GroupKind::Handle, &[0, 3]),
        hold(GroupKind::Anchor, &[2]),
        Command::Rename(id, "Left “hand”".into()),
        Command::Move {
            group: id,
            motion: DAffine3::from_rotation_x(0.1) * DAffine3::from_scale(DVec3::splat(1.0 / 3.0)),
        },
        Command::Paint { values: vec![(VertexId(1), 7), (VertexId(4), 1000)] },
        Command::Select(vec![VertexId(4), VertexId(1)], SelectMode::Replace),
        Command::Sets(SetChange::Store),
        Command::Sets(SetChange::Rename(SetId(1), "Fingers".into())),
        Command::Select(vec![VertexId(2)], SelectMode::Add),
        Command::Sets(SetChange::Store),
        Command::SetWeights(Weights::Uniform),
        Command::SetLoose(LooseComponents::KeepAtRest),
        Command::SetColor(id, GroupColor::Purple),
        Command::SetMethod(Method { alpha: 0.3, ..Method::default().with(MethodKind::SrArap) }),
        Command::Lock(vec![VertexId(2), VertexId(3)], SelectMode::Add),
        Command::ActivateSeveral(vec![other, id]),
    ] {
        document.apply(command).expect("a good command");
    }
    let positions = (0..5).map(|k| DVec3::new(0.1, 1.0 / 3.0, 1e-300) * f64::from(k)).collect();
    let (model, epoch) = (document.model().clone(), document.epoch());
    assert!(document.accept(&model, epoch, Some(&Pose { positions })));
    document.apply(Command::Poses(PoseChange::Keep)).expect("a pose is kept");
    document.apply(Command::Release(vec![other])).expect("lets go");
    document.apply(Command::Poses(PoseChange::Keep)).expect("a pose is kept");
    let first = document.scene().poses[0].id;
    document.apply(Command::Poses(PoseChange::Rename(first, "Größe 1".into()))).expect("renamed");
    document
}

fn contents(document: &Document) -> Contents {
    let mut camera = Camera::framing(document.model().bounds.0, document.model().bounds.1);
    camera.look_along(Axis::Top);
    camera.projection = Projection::Orthographic;
    let settings = serde_json::json!({"options": {"rigidity": 4}});
    Contents { settings, ..Contents::of(document, camera) }
}

fn reopened(path: &Path, choice: &MeshChoice) -> Result<Loaded, ProjectError> {
    open(path, choice, &mut |_| ControlFlow::Continue(()))
}

fn assert_is(loaded: &Loaded, snapshot: &Snapshot) {
    assert_eq!(loaded.scene, snapshot.scene);
    assert_eq!(loaded.pose, snapshot.pose, "positions differ");
}

fn failure(path: &Path, choice: &MeshChoice) -> ProjectError {
    reopened(path, choice).err().expect("refused")
}

#[test]
fn everything_comes_back_to_the_last_bit_without_the_file_of_the_mesh() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let document = rich(folder.path());
    let saved = contents(&document);
    let to = folder.path().join("a.pliant");
    assert_eq!(save(&saved, &to).expect("saved"), Vec::<String>::new());
    std::fs::remove_file(folder.path().join("mesh.obj")).expect("removed");
    let loaded = reopened(&to, &MeshChoice::Named).expect("opens");
    assert_is(&loaded, &saved.snapshot);
    assert_eq!(loaded.model.name, "mesh");
    assert_eq!(loaded.next_group, document.next_group().0);
    assert_eq!(loaded.camera, Some(saved.camera));
    assert_eq!(loaded.settings, saved.settings);
    assert_eq!(loaded.model.mesh.positions(), document.model().mesh.positions());
    // And again, from what was packed.
    let twice = folder.path().join("b.pliant");
    let again = Document::reopened(Arc::new(loaded.model), saved.snapshot.clone(), loaded.next_group);
    save(&contents(&again), &twice).expect("saved");
    assert_is(&reopened(&twice, &MeshChoice::Named).expect("opens"), &saved.snapshot);
}

#[test]
fn a_mesh_that_no_file_held_comes_back_too() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let positions = vec![DVec3::ZERO, DVec3::X / 3.0, DVec3::Y];
    let file = pliant_meshfile::MeshFile::from_triangles("made", positions.clone(), vec![[0, 1, 2]]);
    let document = Document::new(Arc::new(Model::from_file(file).expect("a good mesh")));
    let to = folder.path().join("a.pliant");
    save(&contents(&document), &to).expect("saved");
    let loaded = reopened(&to, &MeshChoice::Named).expect("opens");
    assert_eq!(loaded.model.mesh.positions(), positions);
}

#[test]
fn wherever_a_byte_is_changed_or_the_file_is_cut_it_is_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let to = folder.path().join("a.pliant");
    save(&contents(&rich(folder.path())), &to).expect("saved");
    let whole = std::fs::read(&to).expect("read");
    let broken = folder.path().join("broken.pliant");
    for at in 0..whole.len() {
        let mut changed = whole.clone();
        changed[at] ^= 1 << (at % 8);
        for bytes in [&changed, &whole[..at]] {
            std::fs::write(&broken, bytes).expect("written");
            assert!(summary(&broken).is_err(), "byte {at}, {} bytes in all: taken for whole", bytes.len());
        }
    }
    assert!(matches!(failure(&broken, &MeshChoice::Named), ProjectError::Damaged { .. }));
    std::fs::write(&broken, "v 0 0 0\n").expect("written");
    assert!(matches!(failure(&broken, &MeshChoice::Named), ProjectError::NotAProject { .. }));
}

/// A project of other blocks, sealed like a sound one.
fn sealed(header: &[u8], blocks: &[Vec<u8>]) -> Vec<u8> {
    let mut writer = Writer::default();
    for block in blocks {
        writer.put(block.clone());
    }
    let mut file = Vec::new();
    writer.write(header, &mut file).expect("memory takes it");
    file
}

#[test]
fn what_is_sealed_but_makes_no_sense_is_refused_or_opens_sound() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let to = folder.path().join("a.pliant");
    save(&contents(&rich(folder.path())), &to).expect("saved");
    let reader = Reader::new(std::fs::read(&to).expect("read")).expect("whole");
    let blocks: Vec<Vec<u8>> = reader.all().map(<[u8]>::to_vec).collect();
    let broken = folder.path().join("broken.pliant");
    let (mut random, mut refused) = (0x9e37_79b9_7f4a_7c15_u64, 0);
    let mut below = |end: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random % end as u64) as usize
    };
    for _ in 0..4000 {
        let mut changed = blocks.clone();
        // Half of the time the header, where digits make numbers that are sound by themselves.
        let which = if below(2) == 0 { 0 } else { below(changed.len()) };
        let block = &mut changed[which];
        match below(4) {
            _ if block.is_empty() => block.push(0),
            0 => drop(block.remove(below(block.len()))),
            1 => block.truncate(below(block.len())),
            _ => {
                let at = below(block.len());
                block[at] = if which == 0 { b"0123456789-e,\"[]{}"[below(18)] } else { below(256) as u8 };
            }
        }
        std::fs::write(&broken, sealed(&changed[0], &changed[1..])).expect("written");
        match reopened(&broken, &MeshChoice::Named) {
            Err(_) => refused += 1,
            Ok(loaded) => {
                let n = loaded.model.mesh.n_vertices();
                assert_eq!((loaded.pose.positions.len(), loaded.scene.rigidity.as_slice().len()), (n, n));
                let (held, targets) = crate::document::held_by(&loaded.scene.groups);
                assert!(held.iter().all(|v| v.index() < n) && targets.iter().all(|p| p.is_finite()));
            }
        }
    }
    assert!(refused > 1000, "only {refused} of 4000 were refused");
}

#[test]
fn a_linked_mesh_is_found_beside_a_project_that_was_moved_with_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (old, new) = (folder.path().join("old"), folder.path().join("new"));
    std::fs::create_dir_all(old.join("meshes")).expect("a folder");
    let document = rich(&old.join("meshes"));
    let linked = Contents { mesh: Mesh::Linked, ..contents(&document) };
    save(&linked, &old.join("a.pliant")).expect("saved");
    let bytes = std::fs::read(old.join("a.pliant")).expect("there");
    assert!(!bytes.windows(OBJ.len()).any(|window| window == OBJ.as_bytes()), "the mesh is inside");
    std::fs::rename(&old, &new).expect("moved");
    let loaded = reopened(&new.join("a.pliant"), &MeshChoice::Named).expect("opens");
    assert_is(&loaded, &linked.snapshot);
    assert_eq!(loaded.mesh, Mesh::Linked);
}

#[test]
fn a_linked_mesh_that_is_missing_changed_or_another_is_said_and_can_be_chosen() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let to = folder.path().join("a.pliant");
    let document = rich(folder.path());
    let linked = Contents { mesh: Mesh::Linked, ..contents(&document) };
    save(&linked, &to).expect("saved");
    let mesh = folder.path().join("mesh.obj");
    // Of the same length, and longer.
    for text in [OBJ.replace("v 0 0 0", "v 0 0 9"), OBJ.replace("v 0 0 0", "v 0.25 0 0")] {
        std::fs::write(&mesh, text).expect("written");
        assert!(matches!(failure(&to, &MeshChoice::Named), ProjectError::MeshChanged { .. }));
        let loaded = reopened(&to, &MeshChoice::Chosen(mesh.clone())).expect("opens as it is now");
        assert_is(&loaded, &linked.snapshot);
    }
    let elsewhere = folder.path().join("elsewhere.obj");
    std::fs::rename(&mesh, &elsewhere).expect("renamed");
    match failure(&to, &MeshChoice::Named) {
        ProjectError::MeshMissing { mesh: told, .. } => assert!(told.ends_with("mesh.obj"), "{}", told.display()),
        other => panic!("{other}"),
    }
    assert!(reopened(&to, &MeshChoice::Chosen(elsewhere.clone())).is_ok());
    std::fs::write(&elsewhere, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let wrong = failure(&to, &MeshChoice::Chosen(elsewhere));
    assert!(matches!(wrong, ProjectError::OtherMesh { found: 3, expected: 5, .. }), "{wrong}");
}

#[test]
fn a_mesh_that_was_saved_over_since_it_was_opened_is_packed_as_it_was() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let to = folder.path().join("a.pliant");
    let document = rich(folder.path());
    std::fs::write(folder.path().join("mesh.obj"), OBJ.replace('5', "6")).expect("written");
    let linked = Contents { mesh: Mesh::Linked, ..contents(&document) };
    let warnings = save(&linked, &to).expect("saved");
    assert_eq!(warnings, ["the mesh was packed into the project: its file is no longer what was opened"]);
    let loaded = reopened(&to, &MeshChoice::Named).expect("opens");
    assert_eq!(loaded.model.mesh.positions(), document.model().mesh.positions());
}

#[test]
fn a_summary_tells_what_an_autosave_is_about() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let to = folder.path().join("a.pliant");
    let belongs_to = Some(PathBuf::from("/somewhere/b.pliant"));
    save(&Contents { belongs_to: belongs_to.clone(), ..contents(&document(folder.path())) }, &to).expect("saved");
    let told = summary(&to).expect("whole");
    assert_eq!((told.name.as_str(), told.belongs_to), ("mesh", belongs_to));
    assert!(told.saved_at.elapsed().is_ok_and(|age| age.as_secs() < 600));
}
