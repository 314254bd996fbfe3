//! One pose after the other out of one file.

use super::alike::alike;
use super::matching::Matching;
use super::{PoseError, PoseFault, PoseOptions, scale};
use crate::formats::{Broken, Motion};
use crate::{Fault, MeshFile, Warning};
use glam::DVec3;
use std::path::{Path, PathBuf};

/// How far apart, in diagonals of the reference's bounds, the vertices of two frames may be for them to count as one
/// shape. A thousandth is about a tenth of an edge on a mesh of 10,000 vertices.
const SAME_FRAME: f64 = 1e-3;
/// The same for shapes that a person listed as files: only what single precision makes of one shape counts as one.
const SAME_SHAPE: f64 = 1e-6;

/// A place for every surface point of the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// The file, and what the file calls the pose.
    pub name: String,
    /// World-space position of every surface point, in the file's unit unless its scale was divided out. Finite.
    pub points: Vec<DVec3>,
    /// Set when vertices of one surface point lie apart.
    pub parted: Option<Parted>,
}

/// Surface points whose vertices lie apart in a pose, and were put in the middle of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parted {
    /// How many.
    pub points: usize,
    /// The largest distance of a vertex from its middle.
    pub widest: f64,
}

/// What a stream comes upon.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// A pose.
    Pose(Pose),
    /// A pose that shows the shape of the reference, or of a frame taken before, and is passed over.
    Alike {
        /// The file, and what the file calls the pose.
        name: String,
    },
}

/// The poses of one file, one at a time.
///
/// A pose that is broken is an error, after which the stream goes on with the next.
#[derive(Debug)]
pub struct Poses<'a> {
    reference: &'a MeshFile,
    /// Of the reference's surface points.
    rest: Vec<DVec3>,
    diagonal: f64,
    path: PathBuf,
    matching: Matching,
    scale: f64,
    /// The file's own shape, until it was given.
    shape: Option<Vec<DVec3>>,
    motion: Option<Box<dyn Motion>>,
    next: usize,
    /// The first frame taken and the last one.
    taken: [Option<Vec<DVec3>>; 2],
    warnings: Vec<Warning>,
}

impl<'a> Poses<'a> {
    /// The poses of another file: its own shape unless that is the reference's, then its morph targets, then frames of
    /// its animations.
    pub fn open(path: &Path, reference: &'a MeshFile, options: PoseOptions) -> Result<Poses<'a>, PoseError> {
        let mut file = crate::open(path)?;
        let refused = |fault| PoseError::File { path: path.to_owned(), fault };
        let motion = file.motion(options.frames.max(1)).map_err(|fault| fault.in_file(path))?;
        let matching = Matching::new(&file, reference, options.reference_faces).map_err(refused)?;
        let mut poses = Poses::new(path, reference, matching, motion);
        poses.warnings = std::mem::take(&mut file.warnings);
        let shape = std::mem::take(&mut file.positions);
        if options.match_scale {
            let placed = poses.matching.apply(shape.clone(), reference);
            let ratio = scale::ratio(&placed, &reference.positions, &reference.triangles);
            poses.scale = ratio.ok_or_else(|| refused(PoseFault::NoScale))?;
        }
        poses.shape = Some(shape);
        Ok(poses)
    }

    /// The poses that the reference's own file holds: its morph targets, then frames of its animations.
    pub fn of_reference(reference: &'a MeshFile, options: PoseOptions) -> Result<Poses<'a>, PoseError> {
        let path = reference.path.as_deref().unwrap_or(Path::new("the mesh"));
        let motion = reference.motion(options.frames.max(1)).map_err(|fault| fault.in_file(path))?;
        if motion.is_none() {
            return Err(PoseError::File { path: path.to_owned(), fault: PoseFault::Nothing });
        }
        Ok(Poses::new(path, reference, Matching::Same, motion))
    }

    /// How many poses [`Poses::of_reference`] finds at most, with so many frames of each animation.
    ///
    /// Answered by what the file says of its targets and animations, without reading any of them: cheap, and no promise
    /// that they are sound.
    pub fn count_of_reference(reference: &MeshFile, frames: usize) -> usize {
        reference.n_poses(frames.max(1))
    }

    fn new(path: &Path, reference: &'a MeshFile, matching: Matching, motion: Option<Box<dyn Motion>>) -> Poses<'a> {
        let rest = reference.points();
        let bounds = rest.iter().fold([rest.first().copied().unwrap_or_default(); 2], |[low, high], point| {
            [low.min(*point), high.max(*point)]
        });
        Poses {
            reference,
            rest,
            diagonal: bounds[0].distance(bounds[1]),
            path: path.to_owned(),
            matching,
            scale: 1.0,
            shape: None,
            motion,
            next: 0,
            taken: [None, None],
            warnings: Vec::new(),
        }
    }

    /// How many items are left at most.
    pub fn n_left(&self) -> usize {
        let n_moved = self.motion.as_ref().map_or(0, |motion| motion.n_poses() - self.next.min(motion.n_poses()));
        n_moved + usize::from(self.shape.is_some())
    }

    /// What was divided out of the file's coordinates; 1 unless matching was asked for.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// What was skipped or changed so far, each said once.
    pub fn warnings(&mut self) -> Vec<Warning> {
        let mut warnings = std::mem::take(&mut self.warnings);
        warnings.extend(self.motion.iter_mut().flat_map(|motion| motion.warnings()));
        warnings
    }

    /// The file's own shape; none when it is the reference's and the file holds other poses.
    fn shape(&mut self) -> Option<Result<Found, PoseError>> {
        let shape = self.shape.take()?;
        match self.placed(None, shape) {
            Ok(pose) if alike(&self.rest, &pose.points, SAME_SHAPE * self.diagonal) => {
                self.motion.is_none().then_some(Ok(Found::Alike { name: pose.name }))
            }
            pose => Some(pose.map(Found::Pose)),
        }
    }

    fn moved(&mut self) -> Option<Result<Found, PoseError>> {
        let motion = self.motion.as_mut()?;
        while self.next < motion.n_poses() {
            let index = self.next;
            self.next += 1;
            let (name, is_frame) = (motion.name(index), motion.is_frame(index));
            let pose = match motion.pose(index) {
                Ok(None) => continue,
                Ok(Some(positions)) => self.placed(Some(&name), positions),
                Err(Broken { what, fault }) => Err(PoseError::Pose { path: self.path.clone(), pose: what, fault }),
            };
            return Some(pose.map(|pose| self.sifted(pose, is_frame)));
        }
        None
    }

    /// Passes over what shows no new shape.
    fn sifted(&mut self, pose: Pose, is_frame: bool) -> Found {
        let tolerance = self.diagonal * if is_frame { SAME_FRAME } else { SAME_SHAPE };
        let taken = self.taken.iter().flatten().filter(|_| is_frame);
        if [&self.rest].into_iter().chain(taken).any(|known| alike(known, &pose.points, tolerance)) {
            return Found::Alike { name: pose.name };
        }
        if is_frame {
            let at = usize::from(self.taken[0].is_some());
            self.taken[at] = Some(pose.points.clone());
        }
        Found::Pose(pose)
    }

    /// Positions of the file's vertices as a pose of the reference's surface points; `what` names one of several poses.
    fn placed(&self, what: Option<&str>, positions: Vec<DVec3>) -> Result<Pose, PoseError> {
        let mut of_vertex = self.matching.apply(positions, self.reference);
        if self.scale != 1.0 {
            of_vertex.iter_mut().for_each(|p| *p /= self.scale);
        }
        let (points, parted) = self.welded(&of_vertex);
        if let Some(point) = points.iter().position(|p| !p.is_finite()) {
            let vertex = self.reference.weld.vertex_of_point[point];
            let fault = Fault::at(format!("vertex {vertex}"), "position is too large");
            let pose = what.unwrap_or("its shape").to_owned();
            return Err(PoseError::Pose { path: self.path.clone(), pose, fault });
        }
        let path = self.path.display();
        let name = what.map_or_else(|| path.to_string(), |what| format!("{path}: {what}"));
        Ok(Pose { name, points, parted })
    }

    /// The middle of each surface point's vertices, but for those that were welded to it from beside its place.
    fn welded(&self, of_vertex: &[DVec3]) -> (Vec<DVec3>, Option<Parted>) {
        let weld = &self.reference.weld;
        let first: Vec<DVec3> = weld.vertex_of_point.iter().map(|&vertex| of_vertex[vertex as usize]).collect();
        if first.len() == of_vertex.len() {
            return (first, None);
        }
        // By differences from the first, so that vertices at one place stay there to the bit.
        let mut sums = vec![(DVec3::ZERO, 0.0); first.len()];
        let at_place =
            |&(vertex, &point): &(usize, &u32)| self.reference.positions[vertex] == self.rest[point as usize];
        let members = || weld.point_of_vertex.iter().enumerate().filter(at_place);
        for (vertex, &point) in members() {
            let position = of_vertex[vertex];
            let sum = &mut sums[point as usize];
            sum.0 += position - first[point as usize];
            sum.1 += 1.0;
        }
        let points: Vec<DVec3> = first.iter().zip(&sums).map(|(first, (sum, n))| first + sum / n).collect();
        let mut distances = vec![0.0_f64; points.len()];
        for (vertex, &point) in members() {
            let position = of_vertex[vertex];
            let distance = &mut distances[point as usize];
            *distance = distance.max(position.distance(points[point as usize]));
        }
        let apart = distances.into_iter().filter(|&distance| distance > SAME_SHAPE * self.diagonal);
        let parted = apart.fold(Parted { points: 0, widest: 0.0 }, |parted, distance| Parted {
            points: parted.points + 1,
            widest: parted.widest.max(distance),
        });
        (points, (parted.points > 0).then_some(parted))
    }
}

impl Iterator for Poses<'_> {
    type Item = Result<Found, PoseError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.shape().or_else(|| self.moved())
    }
}
