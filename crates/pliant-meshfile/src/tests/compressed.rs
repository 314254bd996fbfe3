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
        for key in ["extensionsUsed", "extensionsRequired", "nodes", "materials"] {
            assert_eq!(new[key], old[key], "{name}: {key}");
        }
        let views = |document: &Value| document["bufferViews"].as_array().expect("views").clone();
        assert_eq!(views(&new)[..views(&old).len()], views(&old)[..], "{name}: views");
        let draco = |document: &Value| {
            let listed = &document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
            listed["attributes"].as_object().map(|listed| listed.keys().cloned().collect::<Vec<_>>())
        };
        if let Some(listed) = draco(&old) {
            assert!(listed.contains(&"POSITION".to_owned()), "{name}: {listed:?}");
            let left = draco(&new).expect("the extension stays");
            let changed = |name: &String| ["POSITION", "NORMAL"].contains(&name.as_str());
            assert!(!left.iter().any(changed), "{name}: still taken from compressed data: {left:?}");
            assert_eq!(left.len() + 2, listed.len(), "{name}: {left:?}");
        }
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
