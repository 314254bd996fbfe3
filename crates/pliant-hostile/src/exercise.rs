//! Everything the program does with a file that opens, and what must then hold.

use glam::DVec3;
use pliant_meshfile::poses::{Found, PoseOptions, Poses};
use pliant_meshfile::{Format, MeshFile, from_bytes, open};
use std::path::Path;

/// Poses looked at in one file: enough to pass through morph targets into animations.
const MAX_POSES: usize = 40;

/// What became of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It opened with so many file vertices, and was saved and opened again.
    Opened(usize),
    /// It was refused with this message.
    Refused(String),
}

/// Opens a file from memory, saves it unedited and with a vertex moved into `folder`, opens what was saved, and asks for
/// its poses.
///
/// # Panics
///
/// Where something that was promised does not hold.
pub fn in_memory(bytes: &[u8], format: Format, folder: &Path) -> Outcome {
    match from_bytes(bytes, format, "input") {
        Ok(file) => opened(&file, folder, &|_, _| ()),
        Err(error) => refused(&error.to_string()),
    }
}

/// Looks at a file that was opened and at what was saved of it.
pub type Look<'a> = &'a dyn Fn(&MeshFile, &[u8]);

/// The same with a file on the disk, whose references are followed.
///
/// # Panics
///
/// Where something that was promised does not hold.
pub fn on_disk(path: &Path, folder: &Path, look: Look<'_>) -> Outcome {
    match open(path) {
        Ok(file) => opened(&file, folder, look),
        Err(error) => refused(&error.to_string()),
    }
}

fn refused(message: &str) -> Outcome {
    assert!(!message.contains('\n'), "a message of several lines: {message}");
    assert!(message.chars().count() < 1000, "a message of {} characters: {message}", message.chars().count());
    Outcome::Refused(message.to_owned())
}

fn opened(file: &MeshFile, folder: &Path, look: Look<'_>) -> Outcome {
    is_sound(file);
    let points = file.points();
    saves(file, &points, None, folder, look);
    let mut moved = points.clone();
    if let Some(point) = moved.first_mut() {
        *point += DVec3::new(0.5, -0.25, 0.125);
    }
    let rigidity: Vec<u16> = (0..points.len()).map(|point| 1 + (point % 7) as u16).collect();
    saves(file, &moved, Some(&rigidity), folder, look);
    let poses = Poses::of_reference(file, PoseOptions { frames: 3, ..PoseOptions::default() });
    for found in poses.into_iter().flatten().take(MAX_POSES) {
        if let Ok(Found::Pose(pose)) = found {
            assert_eq!(pose.points.len(), points.len(), "points of pose {}", pose.name);
            assert!(pose.points.iter().all(|p| p.is_finite()), "pose {} is not finite", pose.name);
        }
    }
    Outcome::Opened(file.positions.len())
}

/// What holds of every mesh that was opened.
fn is_sound(file: &MeshFile) {
    let n = file.positions.len();
    assert!(!file.triangles.is_empty(), "opened without a triangle");
    assert!(file.positions.iter().all(|p| p.is_finite()), "a position is not finite");
    for (t, triangle) in file.triangles.iter().enumerate() {
        assert!(triangle.iter().all(|&v| (v as usize) < n), "triangle {t} is {triangle:?} of {n} vertices");
    }
    let mut covered = 0;
    for part in &file.parts {
        assert_eq!(part.triangles.start, covered, "part {} begins elsewhere", part.name);
        covered = part.triangles.end;
    }
    assert_eq!(covered, file.triangles.len(), "triangles in parts");
    let n_points = file.weld.n_points();
    assert_eq!(file.weld.point_of_vertex.len(), n, "welded vertices");
    assert!(file.weld.point_of_vertex.iter().all(|&point| (point as usize) < n_points), "a point of a vertex");
    assert!(file.weld.vertex_of_point.iter().all(|&vertex| (vertex as usize) < n), "a vertex of a point");
    let lengths =
        [file.rigidity.as_ref().map(Vec::len), file.uvs.as_ref().map(Vec::len), file.colors.as_ref().map(Vec::len)];
    assert!(lengths.iter().flatten().all(|&length| length == n), "attributes of {lengths:?} for {n} vertices");
}

/// Saves in the file's own format; what was saved opens with as many vertices and faces.
fn saves(file: &MeshFile, points: &[DVec3], rigidity: Option<&[u16]>, folder: &Path, look: Look<'_>) {
    let path = folder.join("saved").with_extension(file.format.extension());
    match file.save(&path, points, rigidity) {
        Err(error) => drop(refused(&error.to_string())),
        Ok(_) => {
            let again = open(&path).unwrap_or_else(|error| panic!("what was saved does not open: {error}"));
            assert_eq!(again.positions.len(), file.positions.len(), "vertices of what was saved");
            assert_eq!(again.triangles.len(), file.triangles.len(), "triangles of what was saved");
            look(file, &std::fs::read(&path).expect("what was saved"));
        }
    }
    for left in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let _ = std::fs::remove_file(left.path());
    }
}

/// A folder to save into, in memory where the system has a place for that: thousands of saves wait for no disk.
pub fn scratch() -> std::io::Result<tempfile::TempDir> {
    let in_memory = Path::new("/dev/shm");
    if in_memory.is_dir() { tempfile::tempdir_in(in_memory) } else { tempfile::tempdir() }
}
