//! Several shapes of a mesh in one file: as morph targets, with an animation that goes through them.

use super::MeshFile;
use crate::formats::{Output, entry, with_morphs};
use crate::{Format, SaveError, Warning, saving};
use glam::DVec3;
use std::ops::ControlFlow;
use std::path::Path;

/// A shape beside the mesh's own.
#[derive(Clone, Copy, Debug)]
pub struct MorphShape<'a> {
    /// What it is called.
    pub name: &'a str,
    /// World position of every surface point.
    pub points: &'a [DVec3],
}

/// Shapes beside the mesh's own, and how they follow one another.
#[derive(Clone, Copy, Debug)]
pub struct Morphs<'a> {
    /// The shapes; what a file holds besides its shape stays before them.
    pub shapes: &'a [MorphShape<'a>],
    /// What the animation is called.
    pub animation: &'a str,
    /// Seconds from the beginning, ascending, and the shape that is there then; `None` is the mesh's own. Without any
    /// there is no animation.
    pub keys: &'a [(f32, Option<usize>)],
    /// Whether a shape stays until the next comes, instead of turning into it.
    pub stepped: bool,
}

impl MeshFile {
    /// Writes this file at rest as glTF or GLB with further shapes as morph targets and an animation of them. Morph targets,
    /// animations and skins of the file stay. `progress` is told the fraction that is done; where it breaks, nothing is
    /// written and there is no answer.
    pub fn save_morphs(
        &self,
        to: &Path,
        rigidity: Option<&[u16]>,
        morphs: &Morphs<'_>,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Option<Vec<Warning>>, SaveError> {
        let format = Format::of(to).ok_or_else(|| SaveError::UnknownFormat { path: to.to_owned() })?;
        if !matches!(format, Format::Gltf | Format::Glb) {
            return Err(SaveError::NoMorphs {
                path: to.to_owned(),
                reason: "only glTF and GLB hold several shapes".into(),
            });
        }
        let base = self.output((to, format), &self.points(), rigidity)?;
        // Numbers are the same in both kinds, and text takes longer.
        let beside = to.with_extension("glb");
        let n = morphs.shapes.len().max(1) as f64;
        let mut canceled = false;
        let mut shape = |k: usize| {
            canceled |= progress(k as f64 / n).is_break();
            if canceled {
                return Ok(None);
            }
            self.output((&beside, Format::Glb), morphs.shapes[k].points, None).map(|output| Some(output.bytes))
        };
        let Some(mut output) = with_morphs(base, (to, format), morphs, &mut shape)? else { return Ok(None) };
        output.warnings.extend(saving::write(to, &output.bytes, &output.beside, Some(&self.known))?);
        Ok(Some(output.warnings))
    }

    /// The file with new positions, not yet on the disk.
    fn output(
        &self,
        (to, format): (&Path, Format),
        points: &[DVec3],
        rigidity: Option<&[u16]>,
    ) -> Result<Output, SaveError> {
        let edit = self.edit(to, points, rigidity)?;
        debug_assert!(!entry(format).rigidity_in_sidecar, "glTF holds rigidity itself");
        match self.source.rewrite(&edit, to, format) {
            Some(output) => output,
            None => self.convert(&edit, to, format),
        }
    }
}
