//! Holds what Pliant writes against the glTF validator of the Khronos Group, an npm package.
//!
//! Every file is opened, saved untouched (which must give it back), and saved bent, with rigidity, as GLB and as glTF. A
//! saved file may have no more errors of any kind than the one it was made of, and none where it was made of another
//! format. What tests in Rust can hold they hold; this asks a judge that shares nothing with them.

mod oracle;

use crate::assets;
use crate::failure::Failure;
use glam::DVec3;
use oracle::Report;
use pliant_meshfile::{Format, MeshFile, MorphShape, Morphs, SaveError};
use serde_json::Value;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// A saved file and what it was made of; none where a document was made anew.
struct Pair {
    before: Option<PathBuf>,
    after: PathBuf,
}

/// Validates what is saved from these files, from the samples and the test data without any.
pub(crate) fn run(files: &[PathBuf]) -> Result<(), Failure> {
    let target = oracle::target();
    let validator = oracle::install(&target)?;
    let folder = target.join("validate");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).map_err(|source| Failure::File { path: folder.clone(), source })?;
    let own = files.is_empty();
    let files = if own { own_files(&folder)? } else { files.to_vec() };
    let (mut pairs, mut n_refused) = (Vec::new(), 0);
    for (i, file) in files.iter().enumerate() {
        let mesh = match pliant_meshfile::open(file) {
            Ok(mesh) => mesh,
            Err(error) if own => return Err(Failure::Open(error)),
            Err(error) => {
                eprintln!("refused: {error}");
                n_refused += 1;
                continue;
            }
        };
        let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        pairs.extend(saved(&mesh, file, &folder.join(format!("{i:03}-{stem}")))?);
    }
    let mut named: Vec<&PathBuf> = pairs.iter().flat_map(|pair| pair.before.iter().chain([&pair.after])).collect();
    named.sort();
    named.dedup();
    let reports = oracle::validate(&validator, &named)?;
    let mut n_worse = 0;
    for pair in &pairs {
        let of = |file: &PathBuf| reports.get(file).cloned().unwrap_or_default();
        let (before, after) = (pair.before.as_ref().map(of), of(&pair.after));
        for problem in worse(before.as_ref(), &after) {
            eprintln!("{}: {problem}", pair.after.display());
            n_worse += 1;
        }
    }
    eprintln!("{} files read, {n_refused} refused, {} saved, {n_worse} new errors", files.len(), pairs.len());
    if n_worse > 0 { Err(Failure::Invalid(n_worse)) } else { Ok(()) }
}

/// The samples, the test data of the mesh files, and each of them as OBJ.
fn own_files(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    let data = assets::folder().join("../crates/pliant-meshfile/src/tests/data");
    for from in [assets::folder(), data] {
        let listed = fs::read_dir(&from).map_err(|source| Failure::File { path: from.clone(), source })?;
        files.extend(listed.flatten().map(|entry| entry.path()).filter(|path| is_gltf(path)));
    }
    files.sort();
    for file in files.clone() {
        let mesh = pliant_meshfile::open(&file).map_err(Failure::Open)?;
        let path = folder.join(file.file_stem().unwrap_or_default()).with_extension("obj");
        mesh.save(&path, &mesh.points(), None).map_err(Failure::Save)?;
        files.push(path);
    }
    Ok(files)
}

fn is_gltf(path: &Path) -> bool {
    matches!(Format::of(path), Some(Format::Gltf | Format::Glb))
}

/// Saves a mesh in every way that matters, and checks that untouched it comes back.
fn saved(mesh: &MeshFile, file: &Path, stem: &Path) -> Result<Vec<Pair>, Failure> {
    let mut pairs = Vec::new();
    let name = |ending: &str| {
        stem.with_file_name(format!("{}{ending}", stem.file_name().unwrap_or_default().to_string_lossy()))
    };
    let before = is_gltf(file).then(|| file.to_owned());
    if before.is_some() {
        let extension = file.extension().unwrap_or_default().to_string_lossy();
        let after = name(&format!(".same.{extension}"));
        mesh.save(&after, &mesh.points(), None).map_err(Failure::Save)?;
        if !is_same(file, &after)? {
            return Err(Failure::Changed(file.to_owned()));
        }
    }
    let points = bent(&mesh.points());
    let rigidity: Vec<u16> = (0..points.len()).map(|point| 1 + (point % 9) as u16).collect();
    for (ending, rigidity) in [(".bent.glb", Some(rigidity.as_slice())), (".bent.gltf", None)] {
        let after = name(ending);
        mesh.save(&after, &points, rigidity).map_err(Failure::Save)?;
        // What was written is read.
        let again = pliant_meshfile::open(&after).map_err(Failure::Open)?;
        if again.positions.len() < mesh.positions.len() || again.triangles.len() != mesh.triangles.len() {
            return Err(Failure::Changed(file.to_owned()));
        }
        pairs.push(Pair { before: before.clone(), after });
    }
    for ending in [".poses.glb", ".poses.gltf"] {
        let after = name(ending);
        if with_poses(mesh, &points, &after)? {
            pairs.push(Pair { before: before.clone(), after });
        }
    }
    Ok(pairs)
}

/// Saves a mesh with two shapes and an animation of them; whether it can hold them.
fn with_poses(mesh: &MeshFile, points: &[DVec3], after: &Path) -> Result<bool, Failure> {
    let half: Vec<DVec3> = mesh.points().iter().zip(points).map(|(a, b)| a.lerp(*b, 0.5)).collect();
    let shapes = [MorphShape { name: "Half", points: &half }, MorphShape { name: "Bent", points }];
    let keys = [(0.0, None), (0.5, Some(0)), (1.0, Some(1))];
    let morphs = Morphs { shapes: &shapes, animation: "Poses", keys: &keys, stepped: false };
    match mesh.save_morphs(after, None, &morphs, &mut |_| ControlFlow::Continue(())) {
        Ok(_) => Ok(true),
        Err(SaveError::NoMorphs { .. }) => Ok(false),
        Err(error) => Err(Failure::Save(error)),
    }
}

/// Whether a file saved untouched is the one it came from; text in another folder takes the files beside it along.
fn is_same(file: &Path, saved: &Path) -> Result<bool, Failure> {
    let read = |path: &Path| fs::read(path).map_err(|source| Failure::File { path: path.to_owned(), source });
    let (old, new) = (read(file)?, read(saved)?);
    let document = |bytes: &[u8]| {
        let mut document: Value = serde_json::from_slice(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)).ok()?;
        for key in ["buffers", "images"] {
            for item in document.get_mut(key).and_then(Value::as_array_mut).into_iter().flatten() {
                item.as_object_mut()?.remove("uri");
            }
        }
        Some(document)
    };
    // Padding behind the last chunk, and chunks whose length is no multiple of four, are put in order.
    Ok(old == new || document(&old).is_some_and(|old| document(&new) == Some(old)))
}

/// A bend that moves every point a little, as far as the shape is large.
fn bent(points: &[DVec3]) -> Vec<DVec3> {
    let least = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let most = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let size = (most - least).max_element();
    if size == 0.0 || !size.is_finite() {
        return points.to_vec();
    }
    let wave = |p: &DVec3| {
        let at = (*p - least) / size;
        *p + 0.1 * size * DVec3::new(at.y * at.y, at.z * at.x, at.x * at.x)
    };
    points.iter().map(wave).collect()
}

/// Kinds of errors of which a saved file has more than the one it was made of, with an example each.
fn worse(before: Option<&Report>, after: &Report) -> Vec<String> {
    let mut problems = Vec::new();
    for (code, examples) in after {
        let n = before.and_then(|before| before.get(code)).map_or(0, Vec::len);
        if examples.len() > n {
            problems.push(format!("{} of {code}, {n} before: {}", examples.len(), examples[examples.len() - 1]));
        }
    }
    problems
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_of_an_error_is_worse_and_less_is_not() {
        let report = |errors: &[(&str, usize)]| -> Report {
            errors.iter().map(|&(code, n)| (code.to_owned(), vec!["where".to_owned(); n])).collect()
        };
        let before = report(&[("A", 2), ("B", 1)]);
        assert!(worse(Some(&before), &report(&[("A", 2)])).is_empty());
        assert_eq!(worse(Some(&before), &report(&[("A", 3), ("C", 1)])).len(), 2);
        assert_eq!(worse(None, &before).len(), 2, "what is made anew has no excuse");
    }
}
