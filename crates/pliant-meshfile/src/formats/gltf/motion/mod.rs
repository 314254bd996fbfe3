//! The poses that a glTF file holds besides its shape: morph targets, and frames of its animations.
//!
//! **Idea.** Nothing is kept but what every pose needs: the vertices in their own coordinates, the graph of nodes, who
//! is bound to which joint. A pose is then computed from the file's bytes when it is asked for, so that memory does not
//! grow with the number of poses.
//!
//! | pose | what moves |
//! |---|---|
//! | morph target | p = M (p₀ + Δᵢ), at rest in all else; M places the mesh as on opening |
//! | frame, without skin | p = M(t) (p₀ + Σ wᵢ(t) Δᵢ), M(t) the world transform of the mesh's node |
//! | frame, with skin | p = Σⱼ aⱼ Jⱼ(t) Bⱼ (p₀ + Σ wᵢ(t) Δᵢ) / s, a the weights of the vertex, J a joint's world transform, B its inverse bind matrix |
//!
//! A skinned mesh is opened in bind pose, whose unit need not be that of the world its joints live in: many exporters
//! stand a mesh in meters on a skeleton in centimeters. s is what the skeleton at rest makes of a length of the bind
//! pose (the median over the joints); dividing it out gives poses in the unit of the mesh.
//!
//! Evaluated here because the crates that do so belong to renderers, in single precision on the GPU.

mod binding;
mod bound;
mod carried;
mod clip;
mod morph;
mod rig;
mod sampler;
mod skin;

pub(super) use bound::bindings;

use super::access::Data;
use super::json;
use super::source::GltfSource;
use crate::formats::{Broken, Motion};
use crate::{Fault, Warning, budget};
use clip::{Clip, ClipChannels};
use glam::DVec3;
use morph::Target;
use rig::Rig;
use std::sync::Arc;

/// What moves in a document, before anything but the document is read.
#[derive(Debug)]
struct Outline {
    rig: Rig,
    targets: Vec<Target>,
    clips: Vec<Clip>,
}

impl Outline {
    /// None when there are neither targets nor animations that move a mesh.
    fn new(source: &GltfSource, frames: usize) -> Result<Option<Outline>, Fault> {
        let document = &source.document;
        let mut has_any = !json::list(document, "animations")?.is_empty();
        for mesh in json::list(document, "meshes")? {
            has_any |= morph::n_targets(mesh) > 0;
        }
        if !has_any {
            return Ok(None);
        }
        let rig = Rig::outline(source)?;
        let (targets, clips) = (morph::targets(source)?, clip::clips(document, &rig)?);
        let outline = Outline { rig, targets, clips };
        let n = outline.targets.len() as u64 + (outline.clips.len() as u64).saturating_mul(frames as u64);
        budget::check("poses in one file", n, budget::POSES)?;
        Ok((n > 0).then_some(outline))
    }

    fn n_poses(&self, frames: usize) -> usize {
        self.targets.len() + self.clips.len() * frames
    }

    /// Steps of computation for all poses: a file can ask for any number of poses that each move any number of vertices.
    fn work(&self, frames: usize) -> u64 {
        let of_rig = self.rig.work();
        let one_each = self.targets.len().saturating_mul(self.rig.n_vertices()) as u64;
        let of_targets = one_each.saturating_add(if self.targets.is_empty() { 0 } else { of_rig });
        self.clips.iter().fold(of_targets, |work, clip| {
            let of_frame = of_rig.saturating_add(clip.work);
            work.saturating_add(of_frame.saturating_mul(frames as u64)).saturating_add(clip.n_numbers)
        })
    }
}

/// How many poses [`of`] finds at most.
pub(super) fn n_poses(source: &GltfSource, frames: usize) -> usize {
    match Outline::new(source, frames) {
        Ok(Some(outline)) => outline.n_poses(frames),
        // Reading them would end the same way.
        Ok(None) | Err(_) => 0,
    }
}

/// The poses of a document; none when it has neither targets nor animations that move its meshes.
pub(super) fn of(source: Arc<GltfSource>, frames: usize) -> Result<Option<Box<dyn Motion>>, Fault> {
    let Some(mut outline) = Outline::new(&source, frames)? else { return Ok(None) };
    outline.rig.load(&source)?;
    budget::check("steps to compute all poses in one file", outline.work(frames), budget::POSE_WORK)?;
    Ok(Some(Box::new(GltfMotion { source, outline, frames, playing: None, told: None, flattened: (0, 0) })))
}

#[derive(Debug)]
struct GltfMotion {
    source: Arc<GltfSource>,
    outline: Outline,
    /// Frames of each clip.
    frames: usize,
    /// The clip that the last frame was of, with its keys; without them where they cannot be read.
    playing: Option<(usize, Option<ClipChannels>)>,
    /// What was last found wrong with a frame, and the clip: it is wrong with many.
    told: Option<(usize, String)>,
    /// How many frames were passed over because a node flattens what it carries, and the first such node.
    flattened: (usize, usize),
}

impl GltfMotion {
    /// Clip and frame of a pose behind the targets.
    fn frame(&self, index: usize) -> (usize, usize) {
        let index = index - self.outline.targets.len();
        (index / self.frames, index % self.frames)
    }

    /// The frame; none where it shows nothing to learn from, or what is wrong with it was said of another.
    fn play(&mut self, index: usize) -> Result<Option<Vec<DVec3>>, Broken> {
        let (clip, frame) = self.frame(index);
        let rig = &self.outline.rig;
        if self.playing.as_ref().is_none_or(|(playing, _)| *playing != clip) {
            // What was played is dropped before the next is read, and what cannot be read is read once.
            self.playing = Some((clip, None));
            let read = self.outline.clips[clip].read(Data::from(&*self.source), rig);
            let channels = read.map_err(|fault| Broken { what: self.outline.clips[clip].name.clone(), fault })?;
            self.playing = Some((clip, Some(channels)));
        }
        let Some((_, Some(channels))) = &self.playing else { return Ok(None) };
        let state = channels.at(channels.time(frame, self.frames), rig);
        let world = rig.world(&state.locals);
        if let Some(node) = rig.flattening(&world) {
            let (n, first) = self.flattened;
            self.flattened = (n + 1, if n == 0 { node } else { first });
            return Ok(None);
        }
        match rig.pose(&self.source, &state, &world) {
            Ok(positions) => Ok(Some(positions)),
            Err(fault) => {
                let told = Some((clip, fault.to_string()));
                let known = self.told == told;
                self.told = told;
                if known { Ok(None) } else { Err(Broken { what: self.name(index), fault }) }
            }
        }
    }

    fn name(&self, index: usize) -> String {
        if let Some(target) = self.outline.targets.get(index) {
            return target.name.clone();
        }
        let (clip, frame) = self.frame(index);
        format!("{}, frame {} of {}", self.outline.clips[clip].name, frame + 1, self.frames)
    }
}

impl Motion for GltfMotion {
    fn n_poses(&self) -> usize {
        self.outline.n_poses(self.frames)
    }

    fn is_frame(&self, index: usize) -> bool {
        index >= self.outline.targets.len()
    }

    fn name(&self, index: usize) -> String {
        GltfMotion::name(self, index)
    }

    fn pose(&mut self, index: usize) -> Result<Option<Vec<DVec3>>, Broken> {
        let positions = match self.outline.targets.get(index) {
            Some(target) => {
                let morphed = self.outline.rig.morphed(&self.source, target);
                morphed.map(Some).map_err(|fault| Broken { what: target.name.clone(), fault })?
            }
            None => self.play(index)?,
        };
        let Some(vertex) = positions.iter().flatten().position(|p| !p.is_finite()) else { return Ok(positions) };
        let fault = Fault::at(format!("vertex {vertex}"), "position is not finite");
        Err(Broken { what: self.name(index), fault })
    }

    fn warnings(&mut self) -> Vec<Warning> {
        let mut warnings = std::mem::take(&mut self.outline.rig.warnings);
        let (n, node) = std::mem::take(&mut self.flattened);
        if n > 0 {
            let noun = if n == 1 { "frame" } else { "frames" };
            let text = format!("{n} {noun} in which a node flattens what it carries (first: node {node}): passed over");
            warnings.push(Warning(text));
        }
        warnings
    }
}
