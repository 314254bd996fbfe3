//! Numbered files: one a frame.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::ops::ControlFlow;
use std::path::Path;

use pliant_meshfile::SaveOptions;

use super::staging::Staging;
use super::{Canceled, Export, Progress, each_frame, rigidity};
use crate::posing::Solved;
use crate::viewport::{Headless, Renderer, ViewScene};

/// Samples a pixel: pictures may take their time.
const SAMPLES: u32 = 4;

type Outcome = Result<Result<Vec<String>, Canceled>, String>;

pub(super) fn meshes(work: &Export, progress: &Progress<'_>) -> Outcome {
    let file = &work.template.model.file;
    let is_home = file.path.as_deref().is_some_and(|path| path.parent() == work.plan.to.parent());
    let mut warnings = BTreeSet::new();
    let mut write = |solved: Solved, to: &Path| {
        let options = SaveOptions { backup: false };
        let saved = file.save_with(to, &solved.pose.positions, rigidity(work), options);
        let told = saved.map_err(|error| error.to_string())?;
        // Where the files will lie their materials lie already.
        let told = told.iter().map(ToString::to_string).filter(|text| !(is_home && text.contains("stays in")));
        warnings.extend(told);
        Ok(())
    };
    let done = staged(work, progress, &mut write)?;
    Ok(done.map(|()| warnings.into_iter().collect()))
}

pub(super) fn pictures(work: &Export, progress: &Progress<'_>) -> Outcome {
    let look = work.look.as_ref().ok_or("there is no picture to draw like")?;
    let headless = Headless::new().map_err(|error| error.to_string())?;
    let mut renderer = Renderer::new(&headless.device, &headless.queue, SAMPLES);
    let size = work.plan.size;
    let mut write = |solved: Solved, to: &Path| {
        let mut bounds = look.bounds;
        for &p in &solved.frame.positions {
            bounds = (bounds.0.min(p), bounds.1.max(p));
        }
        renderer.render(&ViewScene { frame: solved.frame, bounds, ..look.clone() }, size);
        let picture = renderer.try_read_pixels().map_err(|error| error.to_string())?;
        if let Some(why) = headless.lost().or_else(|| headless.take_error()) {
            return Err(why);
        }
        if picture.dimensions() != (size[0], size[1]) {
            return Err(format!("this machine cannot draw {} × {} pixels: choose a smaller size", size[0], size[1]));
        }
        picture.save_with_format(to, image::ImageFormat::Png).map_err(|error| error.to_string())
    };
    let done = staged(work, progress, &mut write)?;
    Ok(done.map(|()| Vec::new()))
}

/// Writes every frame into a folder of its own beside the place of the files, then moves them there.
fn staged(
    work: &Export,
    progress: &Progress<'_>,
    write: &mut dyn FnMut(Solved, &Path) -> Result<(), String>,
) -> Result<Result<(), Canceled>, String> {
    let files = work.plan.files(work.poses.len());
    let folder = work.plan.to.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let failed = |error: std::io::Error| format!("{}: cannot be written: {error}", folder.display());
    let staging = Staging::new(folder).map_err(failed)?;
    let mut failure = None;
    let mut frame = |number: usize, solved: Solved| {
        let name = files[number].file_name().unwrap_or_default();
        match write(solved, &staging.path().join(name)) {
            Ok(()) => ControlFlow::Continue(()),
            Err(why) => {
                failure = Some(why);
                ControlFlow::Break(())
            }
        }
    };
    let done = each_frame(work, progress, &mut frame)?;
    if let Some(why) = failure {
        return Err(why);
    }
    if done.is_none() {
        return Ok(Err(Canceled));
    }
    // What lies beside a file comes before it, so that none is ever there without.
    let mut names = staging.names().map_err(failed)?;
    let is_main = |name: &OsString| files.iter().any(|file| file.file_name() == Some(name));
    names.sort_by_key(|name| (is_main(name), name.clone()));
    for name in names {
        std::fs::rename(staging.path().join(&name), folder.join(&name)).map_err(failed)?;
    }
    Ok(Ok(()))
}
