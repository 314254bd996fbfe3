//! Files with compressed geometry: made by the original encoders from one of the samples.

use super::mutation::{Numbers, mutated};
use super::support::{assert_near, bent, document, saved};
use crate::{Format, MeshFile, from_bytes};
use glam::DVec3;
use serde_json::Value;

const SAMPLE: &[u8] = include_bytes!("../../../../assets/thin-bar.glb");
/// Name, bytes, and how far quantization moved the vertices of a bar 6 long: half a step of 14 bits, with some rounding.
const FILES: [(&str, &[u8]); 4] = [
    ("meshopt-medium", include_bytes!("data/meshopt-medium.glb")),
    ("meshopt-high", include_bytes!("data/meshopt-high.glb")),
    ("draco-edgebreaker", include_bytes!("data/draco-edgebreaker.glb")),
    ("draco-sequential", include_bytes!("data/draco-sequential.glb")),
];

fn opened(bytes: &[u8], name: &str) -> MeshFile {
    from_bytes(bytes, Format::Glb, name).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn extent(points: &[DVec3]) -> f64 {
    let least = points.iter().copied().reduce(DVec3::min).expect("points");
    let most = points.iter().copied().reduce(DVec3::max).expect("points");
    (most - least).max_element()
}

#[test]
fn compressed_files_show_the_surface_that_was_compressed() {
    let sample = opened(SAMPLE, "thin-bar");
    let points = sample.points();
    // Fourteen bits over the longest side: half a step along each axis, and twice that for good measure of rounding.
    let tolerance = 3f64.sqrt() * extent(&points) / f64::from(1 << 14);
    for (name, bytes) in FILES {
        let file = opened(bytes, name);
        assert_eq!(file.triangles.len(), sample.triangles.len(), "{name}: triangles");
        assert_eq!(file.weld.n_points(), points.len(), "{name}: surface points");
        assert_eq!(file.uvs.is_some(), sample.uvs.is_some(), "{name}: texture coordinates");
        let nearest = |p: &DVec3| {
            let (at, distance) = (0..points.len())
                .map(|i| (i, points[i].distance(*p)))
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .expect("points");
            assert!(distance <= tolerance, "{name}: {p} is {distance} from the sample, not {tolerance}");
            at as u32
        };
        let place: Vec<u32> = file.points().iter().map(nearest).collect();
        let around = |t: [u32; 3]| {
            let first = (0..3).min_by_key(|&k| t[k]).expect("three");
            [t[first], t[(first + 1) % 3], t[(first + 2) % 3]]
        };
        let mut got: Vec<[u32; 3]> =
            file.point_triangles().iter().map(|t| around(t.map(|v| place[v as usize]))).collect();
        let mut expected: Vec<[u32; 3]> = sample.point_triangles().into_iter().map(around).collect();
        got.sort_unstable();
        expected.sort_unstable();
        assert!(got == expected, "{name}: the triangles join other points");
    }
}

#[test]
fn compressed_files_come_back_untouched_and_bent_ones_keep_the_rest_compressed() {
    for (name, bytes) in FILES {
        let file = opened(bytes, name);
        let (same, _) = saved(&file, "same.glb", &file.points(), None);
        assert!(same == bytes, "{name}: saving it untouched changed it");
        let points = bent(&file.points());
        let (out, again) = saved(&file, "bent.glb", &points, Some(&vec![3; points.len()]));
        assert_near(&again.points(), &points, extent(&points) * f64::from(f32::EPSILON));
        assert_eq!(again.triangles, file.triangles, "{name}");
        assert_eq!(again.uvs, file.uvs, "{name}");
        assert_eq!(again.rigidity, Some(vec![3; file.positions.len()]), "{name}");
        let (new, old) = (document(&out), document(bytes));
        for key in ["nodes", "materials"] {
            assert_eq!(new[key], old[key], "{name}: {key}");
        }
        let views = |document: &Value| document["bufferViews"].as_array().expect("views").clone();
        assert_eq!(views(&new)[..views(&old).len()], views(&old)[..], "{name}: views");
        if name.starts_with("meshopt") {
            assert_eq!(new["extensionsRequired"], old["extensionsRequired"], "{name}");
        }
    }
}

#[test]
fn bent_attributes_leave_draco_and_the_last_takes_the_indices_along() {
    let compressed = |document: &Value| {
        let extension = document["meshes"][0]["primitives"][0].get("extensions")?.get("KHR_draco_mesh_compression")?;
        extension["attributes"].as_object().map(|listed| listed.keys().cloned().collect::<Vec<_>>())
    };
    for (name, bytes) in FILES.into_iter().filter(|(name, _)| name.starts_with("draco")) {
        let file = opened(bytes, name);
        let points = bent(&file.points());
        // With positions and normals bent nothing is left to decode.
        let (out, _) = saved(&file, "bent.glb", &points, None);
        assert_eq!(compressed(&document(&out)), None, "{name}");
        for key in ["extensionsUsed", "extensionsRequired"] {
            assert_eq!(document(&out).get(key), None, "{name}: {key}");
        }
        // Its validation knows no accessors without data, which is what the compressed ones left behind.
        let theirs = ::gltf::Gltf::from_slice_without_validation(&out).expect("the gltf crate reads it");
        let primitive = theirs.meshes().next().and_then(|mesh| mesh.primitives().next()).expect("a primitive");
        let reader = primitive.reader(|_| theirs.blob.as_deref());
        let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
        assert!(indices == file.triangles.as_flattened(), "{name}: other indices");
        // Moved without turning, normals stay as they are, and in compressed data.
        let moved: Vec<DVec3> = file.points().iter().map(|p| *p + DVec3::X).collect();
        let (out, again) = saved(&file, "moved.glb", &moved, None);
        assert_eq!(compressed(&document(&out)), Some(vec!["NORMAL".to_owned()]), "{name}");
        assert_eq!(document(&out)["extensionsRequired"], document(bytes)["extensionsRequired"], "{name}");
        assert_eq!(again.triangles, file.triangles, "{name}");
        let (twice, _) = saved(&again, "twice.glb", &bent(&again.points()), None);
        assert_eq!(compressed(&document(&twice)), None, "{name}");
    }
}

#[test]
fn compressed_files_turn_into_text_and_back() {
    for (name, bytes) in FILES {
        let file = opened(bytes, name);
        let points = bent(&file.points());
        let (_, text) = saved(&file, "a.gltf", &points, None);
        let (_, binary) = saved(&text, "b.glb", &text.points(), None);
        assert_eq!(binary.positions, text.positions, "{name}");
        assert_eq!(binary.triangles, file.triangles, "{name}");
        assert_eq!(binary.uvs, file.uvs, "{name}");
    }
}

#[test]
fn damaged_compressed_files_are_opened_or_refused() {
    let mut numbers = Numbers(0x5eed_0011);
    for (name, bytes) in FILES {
        for round in 0..150 {
            let bytes = mutated(bytes, &mut numbers);
            let Ok(file) = from_bytes(&bytes, Format::Glb, "mutated") else { continue };
            assert!(file.positions.iter().all(|p| p.is_finite()), "{name}, round {round}");
            let n = file.positions.len();
            assert!(file.triangles.iter().flatten().all(|&v| (v as usize) < n), "{name}, round {round}");
        }
    }
}

#[test]
fn damaged_compressed_data_is_refused_by_name() {
    for (name, bytes) in FILES {
        // The whole of the compressed bytes wrong, the document right.
        let length = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
        let mut bytes = bytes.to_vec();
        bytes[28 + length..].fill(0x55);
        let error = from_bytes(&bytes, Format::Glb, "bad").expect_err(name).to_string();
        let expected = if name.starts_with("meshopt") { "meshopt compression" } else { "Draco compression" };
        assert!(error.contains(expected), "{name}: got {error}, expected {expected}");
        assert!(!error.contains('\n'), "{name}: {error}");
    }
}
