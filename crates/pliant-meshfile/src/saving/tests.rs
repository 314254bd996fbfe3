//! Interrupted savings, leftovers and backups.

use super::staged::{Group, Staged, create_locked};
use super::unfinished::Note;
use super::{SaveOptions, stale};
use crate::{MeshFile, open};
use glam::DVec3;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};
use tempfile::TempDir;

const OLD: &[u8] = b"mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const NEW: &[u8] = b"mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 9\nf 1 2 3\nf 1 2 4\n";

/// An old set of mesh, sidecar and material library, and the files of a new set with more vertices.
fn sets() -> (TempDir, PathBuf, Vec<(PathBuf, Vec<u8>)>) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("m.obj"), OLD).expect("a file");
    fs::write(at("m.rigidity.json"), "[2,2,2]").expect("a file");
    fs::write(at("m.mtl"), "newmtl a\nKd 0.25 0 0\n").expect("a file");
    let beside =
        vec![(at("m.rigidity.json"), b"[3,3,3,3]".to_vec()), (at("m.mtl"), b"newmtl a\nKd 0.75 0 0\n".to_vec())];
    let mesh = at("m.obj");
    (folder, mesh, beside)
}

/// Vertices, r and red of a mesh, which are 3, 2, 0.25 in the old set and 4, 3, 0.75 in the new one.
fn look(mesh: &Path) -> (usize, u16, f32) {
    let file = open(mesh).unwrap_or_else(|error| panic!("{error}"));
    (file.positions.len(), file.rigidity.expect("a sidecar")[0], file.parts[0].base_color[0])
}

/// Does the first `steps` steps of a saving and stops as a killed process does.
fn stopped_after(steps: usize, mesh: &Path, beside: &[(PathBuf, Vec<u8>)]) {
    let group = Group::new();
    let stage = |path: &Path, bytes: &[u8], i| Staged::new(path.to_owned(), bytes, &group, i).expect("a temporary");
    let mut all = vec![stage(mesh, NEW, 0)];
    all.extend(beside.iter().enumerate().map(|(i, (path, bytes))| stage(path, bytes, i + 1)));
    let paths: Vec<&Path> = beside.iter().map(|(path, _)| path.as_path()).collect();
    if steps > 0 {
        Note::write(mesh, NEW, &group, &paths).expect("a note").leave();
    }
    for (i, file) in all.iter_mut().enumerate() {
        if i + 1 < steps {
            file.publish().expect("a name");
        }
        file.leave();
    }
}

#[test]
fn a_set_of_files_is_the_old_or_the_new_one_wherever_saving_stops() {
    for (steps, expected) in
        [(0, (3, 2, 0.25)), (1, (3, 2, 0.25)), (2, (4, 3, 0.75)), (3, (4, 3, 0.75)), (4, (4, 3, 0.75))]
    {
        let (folder, mesh, beside) = sets();
        stopped_after(steps, &mesh, &beside);
        assert_eq!(look(&mesh), expected, "stopped after {steps} steps");
        // Looking changed nothing, and the next saving comes to the same set.
        let file = open(&mesh).expect("a set");
        let warnings = file.save(&mesh, &file.points(), None).expect("a set to save over");
        assert!(warnings.is_empty(), "{warnings:?}");
        assert_eq!(look(&mesh), expected, "saved after being stopped after {steps} steps");
        let notes = names(folder.path()).into_iter().filter(|name| name.ends_with(".note")).count();
        assert_eq!(notes, 0, "notes after saving");
        let left = names(folder.path()).into_iter().filter(|name| name.ends_with(".tmp")).count();
        assert_eq!(left, if steps == 0 { 3 } else { 0 }, "young temporaries after {steps} steps");
    }
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder").flatten();
    let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_note_that_is_broken_or_a_trap_is_passed_over() {
    let (folder, mesh, beside) = sets();
    stopped_after(2, &mesh, &beside);
    let note = names(folder.path()).into_iter().find(|name| name.ends_with(".note")).expect("a note");
    let note = folder.path().join(note);
    let text = fs::read_to_string(&note).expect("a note");
    for bad in ["", "x", "1-2 3", &text.replace(".mtl", "/../../m.mtl"), &text.replace(' ', "  ")] {
        fs::write(&note, bad).expect("a file");
        let error = open(&mesh).expect_err("the old sidecar has three entries").to_string();
        assert!(error.contains("3 rigidities"), "{error}");
    }
    #[cfg(unix)]
    {
        let elsewhere = tempfile::tempdir().expect("a temporary folder");
        fs::write(elsewhere.path().join("note"), &text).expect("a file");
        fs::remove_file(&note).expect("a file");
        std::os::unix::fs::symlink(elsewhere.path().join("note"), &note).expect("a link");
        assert!(open(&mesh).is_err(), "a note outside the folder was read");
    }
}

#[test]
fn two_programs_do_not_save_one_set_at_once() {
    let (_folder, mesh, beside) = sets();
    let paths: Vec<&Path> = beside.iter().map(|(path, _)| path.as_path()).collect();
    let other = Note::write(&mesh, NEW, &Group::new(), &paths).expect("a note");
    let file = open(&mesh).expect("the old set");
    let error = file.save(&mesh, &file.points(), None).expect_err("another program is at it").to_string();
    assert!(error.ends_with("another program is saving it right now"), "{error}");
    drop(other);
    file.save(&mesh, &file.points(), None).expect("nobody else is at it");
}

#[test]
fn temporaries_of_stopped_processes_are_cleared_away() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    let long_ago = SystemTime::now() - Duration::from_secs(600);
    let age = |file: &File| file.set_modified(long_ago).expect("our own file");
    for name in [".pliant-1-0-0.tmp", ".pliant-1-2-998.tmp", ".pliant-x-0-0.tmp", ".other-1-0-0.tmp"] {
        age(&File::create(at(name)).expect("a file"));
    }
    File::create(at(".pliant-2-0-0.tmp")).expect("a young file");
    let held = create_locked(&at(".pliant-3-0-0.tmp")).expect("a file");
    age(&held);
    stale::clear(folder.path());
    let expected = [".other-1-0-0.tmp", ".pliant-2-0-0.tmp", ".pliant-3-0-0.tmp", ".pliant-x-0-0.tmp"];
    assert_eq!(names(folder.path()), expected);
}

fn opened(folder: &Path) -> (MeshFile, PathBuf, Vec<DVec3>) {
    let mesh = folder.join("m.obj");
    fs::write(&mesh, OLD).expect("a file");
    let file = open(&mesh).expect("a mesh");
    let points = file.points().iter().map(|p| *p + DVec3::Z).collect();
    (file, mesh, points)
}

#[test]
fn the_file_that_was_opened_is_kept_once() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (file, mesh, mut points) = opened(folder.path());
    let backup = folder.path().join("m.obj~");
    fs::write(&backup, "from before").expect("a file");
    file.save(&mesh, &file.points(), None).expect("saved unedited");
    assert_eq!(fs::read(&backup).expect("a backup"), b"from before");
    for height in [1.0, 2.0, 3.0] {
        points[0].z = height;
        let warnings = file.save(&mesh, &points, None).expect("saved");
        assert!(warnings.is_empty(), "{warnings:?}");
        assert_eq!(fs::read(&backup).expect("a backup"), OLD, "after saving height {height}");
    }
    assert_eq!(names(folder.path()), ["m.obj", "m.obj~"]);
    // What another program wrote meanwhile is worth keeping too.
    fs::write(&mesh, "by another program").expect("a file");
    file.save(&mesh, &points, None).expect("saved");
    assert_eq!(fs::read(&backup).expect("a backup"), b"by another program");
}

#[test]
fn other_targets_get_no_backup_and_the_option_is_kept() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (file, mesh, points) = opened(folder.path());
    let other = folder.path().join("other.obj");
    fs::write(&other, "old").expect("a file");
    file.save(&other, &points, None).expect("saved");
    file.save_with(&mesh, &points, None, SaveOptions { backup: false }).expect("saved");
    assert_eq!(names(folder.path()), ["m.obj", "other.obj"]);
}

#[test]
fn a_backup_that_cannot_be_made_is_a_warning() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (file, mesh, points) = opened(folder.path());
    fs::create_dir(folder.path().join("m.obj~")).expect("a folder");
    let warnings = file.save(&mesh, &points, None).expect("saved");
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].0.ends_with("m.obj~: something else has this name"), "{}", warnings[0]);
    assert_eq!(names(folder.path()), ["m.obj", "m.obj~"]);
}

#[test]
#[cfg(unix)]
fn a_link_is_saved_through_with_its_backup_beside_the_file() {
    let (folder, elsewhere) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let (_, real, _) = opened(elsewhere.path());
    let link = folder.path().join("link.obj");
    std::os::unix::fs::symlink(&real, &link).expect("a link");
    let file = open(&link).expect("a mesh");
    let points: Vec<DVec3> = file.points().iter().map(|p| *p + DVec3::Z).collect();
    file.save(&link, &points, Some(&[1, 2, 3])).expect("saved");
    assert!(link.is_symlink());
    assert_eq!(names(elsewhere.path()), ["m.obj", "m.obj~"]);
    assert_eq!(names(folder.path()), ["link.obj", "link.rigidity.json"]);
    assert_eq!(open(&link).expect("a mesh").rigidity, Some(vec![1, 2, 3]));
}
