//! Poses out of their files, one after the other and one in memory at a time.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use pliant_meshfile::poses::{Found, Parted, Pose, PoseError, PoseOptions, Poses};
use pliant_meshfile::{Fault, MeshFile};
use pliant_solver::LARGEST_COORDINATE;

/// Where poses come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// Morph targets and animations of the reference's own file.
    Reference,
    /// A file.
    File(PathBuf),
}

impl Source {
    /// As shown in lists.
    pub fn name(&self) -> String {
        match self {
            Source::Reference => "poses in the file itself".into(),
            Source::File(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
        }
    }
}

/// The poses of some sources, with coordinates that can be computed with.
///
/// A file or a pose that cannot be used is an error, after which the others go on.
pub struct Sources<'a> {
    reference: &'a MeshFile,
    options: PoseOptions,
    /// Those that were not opened yet, and how many there were.
    closed: &'a [Source],
    n_sources: usize,
    at_hand: Option<AtHand<'a>>,
    load: Duration,
    notes: Vec<Note<'a>>,
}

/// What is said of a file, and of how many more.
struct Note<'a> {
    path: &'a Path,
    n_more: usize,
    text: String,
}

/// A file that is being read.
struct AtHand<'a> {
    path: &'a Path,
    poses: Poses<'a>,
    seen: Seen,
    n_poses: usize,
}

impl<'a> Sources<'a> {
    /// Nothing is opened before the first pose is asked for.
    pub fn new(reference: &'a MeshFile, sources: &'a [Source], options: PoseOptions) -> Self {
        let (load, notes) = (Duration::ZERO, Vec::new());
        Sources { reference, options, closed: sources, n_sources: sources.len(), at_hand: None, load, notes }
    }

    /// How many poses are left, as far as is known: files not opened yet count as one each.
    pub fn n_left(&self) -> usize {
        self.closed.len() + self.at_hand.as_ref().map_or(0, |at_hand| at_hand.poses.n_left())
    }

    /// The part that has been given out, from 0 to 1; every source is as long as the others.
    pub fn fraction(&self) -> f64 {
        let at_hand = self.at_hand.as_ref();
        let open = at_hand.map_or(0.0, |at| at.poses.n_left() as f64 / at.n_poses.max(1) as f64);
        1.0 - (self.closed.len() as f64 + open) / self.n_sources.max(1) as f64
    }

    /// Time spent on reading.
    pub fn load_time(&self) -> Duration {
        self.load
    }

    /// What there is to say about the files that were read to their end, a sentence each. What many files have in common
    /// is said once.
    pub fn into_notes(self) -> Vec<String> {
        let say = |Note { path, n_more, text }: Note<'_>| match n_more {
            0 => format!("{}: {text}", path.display()),
            1 => format!("{} and another file: {text}", path.display()),
            n => format!("{} and {n} more files: {text}", path.display()),
        };
        self.notes.into_iter().map(say).collect()
    }

    fn note(&mut self, path: &'a Path, text: String) {
        match self.notes.iter_mut().find(|note| note.text == text) {
            Some(note) => note.n_more += 1,
            None => self.notes.push(Note { path, n_more: 0, text }),
        }
    }

    /// Opens the next file; false when there is none.
    fn open_next(&mut self) -> Result<bool, PoseError> {
        let Some((source, closed)) = self.closed.split_first() else { return Ok(false) };
        self.closed = closed;
        let (path, poses) = match source {
            Source::Reference => {
                let path = self.reference.path.as_deref().unwrap_or(Path::new("the mesh"));
                (path, Poses::of_reference(self.reference, self.options)?)
            }
            Source::File(path) => (path.as_path(), Poses::open(path, self.reference, self.options)?),
        };
        self.at_hand = Some(AtHand { path, n_poses: poses.n_left(), poses, seen: Seen::default() });
        Ok(true)
    }

    fn read(&mut self) -> Option<Result<Option<Pose>, PoseError>> {
        loop {
            let Some(AtHand { path, poses, seen, .. }) = &mut self.at_hand else {
                match self.open_next() {
                    Ok(true) => continue,
                    Ok(false) => return None,
                    Err(error) => return Some(Err(error)),
                }
            };
            match poses.next() {
                Some(Ok(Found::Pose(pose))) => {
                    seen.note(&pose);
                    return Some(computable(self.reference, path, pose).map(Some));
                }
                Some(Ok(Found::Alike { .. })) => {
                    seen.n_alike += 1;
                    return Some(Ok(None));
                }
                Some(Err(error)) => return Some(Err(error)),
                None => {
                    let (path, of_file, own) = (*path, poses.warnings(), seen.notes(poses.scale()));
                    of_file.iter().map(ToString::to_string).chain(own).for_each(|text| self.note(path, text));
                    self.at_hand = None;
                }
            }
        }
    }
}

impl Iterator for Sources<'_> {
    /// `None` for a pose that shows a shape seen before and is passed over.
    type Item = Result<Option<Pose>, PoseError>;

    fn next(&mut self) -> Option<Self::Item> {
        let clock = Instant::now();
        let found = self.read();
        self.load += clock.elapsed();
        found
    }
}

/// The file layer lets any finite number through, the solver those that can be squared.
fn computable(reference: &MeshFile, path: &Path, pose: Pose) -> Result<Pose, PoseError> {
    let Some(point) = pose.points.iter().position(|p| p.abs().max_element() > LARGEST_COORDINATE) else {
        return Ok(pose);
    };
    let place = format!("vertex {}", reference.weld.vertex_of_point[point]);
    let fault = Fault::Malformed { place, problem: "position is too large to compute with".to_owned() };
    let what = pose.name.strip_prefix(&format!("{}: ", path.display())).unwrap_or("its shape");
    Err(PoseError::Pose { path: path.to_owned(), pose: what.to_owned(), fault })
}

/// What is said once of all poses of a file.
#[derive(Default)]
struct Seen {
    n_alike: usize,
    n_parted: usize,
    widest: f64,
}

impl Seen {
    fn note(&mut self, pose: &Pose) {
        if let Some(Parted { widest, .. }) = pose.parted {
            self.n_parted += 1;
            self.widest = self.widest.max(widest);
        }
    }

    fn notes(&self, scale: f64) -> Vec<String> {
        let noun = |n: usize| if n == 1 { "pose" } else { "poses" };
        let mut notes = Vec::new();
        if scale != 1.0 {
            notes.push(format!("is {scale} times as large as the reference, which was divided out"));
        }
        if self.n_alike > 0 {
            let (n, noun) = (self.n_alike, noun(self.n_alike));
            notes.push(format!("{n} {noun} of a shape that was known: passed over"));
        }
        if self.n_parted > 0 {
            let (n, noun, widest) = (self.n_parted, noun(self.n_parted), self.widest);
            let what = "vertices of one surface point lie apart";
            notes.push(format!("in {n} {noun} {what} (by up to {widest:.3e}); their middle counts"));
        }
        notes
    }
}

/// How many poses a mesh file has of its own, at most: morph targets, and frames of animations.
pub fn n_own_poses(reference: &MeshFile, options: PoseOptions) -> usize {
    Poses::count_of_reference(reference, options.frames)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_many_files_have_in_common_is_said_once() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let reference = folder.path().join("rest.obj");
        let text = |height: usize| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 {height}\nf 1/9 2/9 3/9\nf 1/9 4/9 2/9\n");
        std::fs::write(&reference, text(1)).expect("a writable folder");
        let reference = pliant_meshfile::open(&reference).expect("a mesh");
        let listed: Vec<Source> = (2..5)
            .map(|height| {
                let path = folder.path().join(format!("{height}.obj"));
                std::fs::write(&path, text(height)).expect("a writable folder");
                Source::File(path)
            })
            .collect();
        let mut sources = Sources::new(&reference, &listed, PoseOptions::default());
        assert_eq!(sources.by_ref().filter(|found| matches!(found, Ok(Some(_)))).count(), 3);
        assert_eq!(sources.fraction(), 1.0);
        let notes = sources.into_notes();
        assert_eq!(notes.len(), 1, "{notes:?}");
        assert!(notes[0].contains("2.obj and 2 more files: 6 corners name"), "{notes:?}");
    }
}
