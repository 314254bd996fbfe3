//! Writes the samples to `assets/`, or compares what is there with what would be written.
//!
//! NAME.glb is the mesh, NAME.handles.json what to do with it (`pliant deform assets/NAME.glb --handles …`), and
//! NAME.rigidity.json, where there is one, r of every vertex. Sets of poses are a NAME.glb whose morph targets are the
//! poses, with handles for yet another pose, and a NAME.truth.json that says what moves with which bone.

use crate::failure::Failure;
use crate::shapes::{self, Sample, Shape};
use pliant_meshfile::MeshFile;
use std::fs;
use std::path::{Path, PathBuf};

/// Writes the samples, or with `check` only compares.
pub(crate) fn run(check: bool) -> Result<(), Failure> {
    let folder = folder();
    if check {
        let made = tempfile::tempdir().map_err(|source| Failure::File { path: std::env::temp_dir(), source })?;
        let names = write_all(made.path())?;
        let differs = |name: &String| fs::read(made.path().join(name)).ok() != fs::read(folder.join(name)).ok();
        let stale: Vec<String> = names.iter().filter(|name| differs(name)).cloned().collect();
        if !stale.is_empty() {
            return Err(Failure::Stale(stale));
        }
        eprintln!("assets: {} files are up to date", names.len());
    } else {
        fs::create_dir_all(&folder).map_err(|source| Failure::File { path: folder.clone(), source })?;
        let names = write_all(&folder)?;
        eprintln!("assets: {} files written to {}", names.len(), folder.display());
    }
    Ok(())
}

/// The folder `assets` of this workspace.
pub(crate) fn folder() -> PathBuf {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2);
    workspace.expect("this crate lies in crates/xtask").join("assets")
}

/// Writes all files of all samples; returns their names.
fn write_all(folder: &Path) -> Result<Vec<String>, Failure> {
    let mut names = Vec::new();
    for sample in shapes::ALL {
        let shape = (sample.make)();
        let mesh = MeshFile::from_triangles(sample.name, shape.positions.clone(), shape.triangles.clone());
        names.push(format!("{}.glb", sample.name));
        let path = folder.join(format!("{}.glb", sample.name));
        mesh.save(&path, &mesh.points(), None).map_err(|source| Failure::Sample { name: sample.name, source })?;
        for (name, text) in texts(&sample, &shape) {
            let path = folder.join(&name);
            fs::write(&path, text).map_err(|source| Failure::File { path, source })?;
            names.push(name);
        }
    }
    for set in shapes::POSED {
        let posed = (set.make)();
        let handles = posed.handles().to_json().into_bytes();
        let truth = posed.truth_json().into_bytes();
        let files = [("glb", posed.glb(set.name)), ("handles.json", handles), ("truth.json", truth)];
        for (ending, bytes) in files {
            let name = format!("{}.{ending}", set.name);
            let path = folder.join(&name);
            fs::write(&path, bytes).map_err(|source| Failure::File { path, source })?;
            names.push(name);
        }
    }
    Ok(names)
}

/// Names and contents of the text files beside a mesh.
fn texts(sample: &Sample, shape: &Shape) -> Vec<(String, String)> {
    let handles = (sample.handles)(shape).into_iter();
    let mut texts: Vec<(String, String)> =
        handles.map(|(suffix, h)| (format!("{}{suffix}.handles.json", sample.name), h.to_json())).collect();
    if let Some(rigidity) = sample.rigidity {
        texts.push((format!("{}.rigidity.json", sample.name), format!("{}\n", serde_json::json!(rigidity(shape)))));
    }
    texts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_made_anew_byte_for_byte() {
        if let Err(failure) = run(true) {
            panic!("{failure}");
        }
    }

    #[test]
    fn all_samples_together_are_small() {
        let files = fs::read_dir(folder()).expect("assets/ is there");
        let sizes = files.map(|file| file.and_then(|f| f.metadata()).expect("readable").len());
        assert!(sizes.sum::<u64>() <= 8_000_000);
    }
}
