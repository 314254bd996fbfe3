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
fn compressed_files_come_back_untouched_and_bent_ones_lose_nothing() {
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

/// Attributes that a primitive has in Draco's data.
fn in_draco(document: &Value, mesh: usize) -> Option<Vec<String>> {
    let primitive = &document["meshes"][mesh]["primitives"][0];
    let extension = primitive.get("extensions")?.get("KHR_draco_mesh_compression")?;
    extension["attributes"].as_object().map(|listed| listed.keys().cloned().collect())
}

fn draco_files() -> impl Iterator<Item = (&'static str, &'static [u8])> {
    FILES.into_iter().filter(|(name, _)| name.starts_with("draco"))
}

/// What another reader, which knows no Draco, finds in a mesh: indices and attributes.
fn plain(bytes: &[u8], mesh: usize) -> (Vec<u32>, Vec<[f32; 3]>, Vec<[f32; 3]>) {
    // Its validation knows no accessors without data, which is what the compressed ones left behind.
    let theirs = ::gltf::Gltf::from_slice_without_validation(bytes).expect("the gltf crate reads it");
    let primitive = theirs.meshes().nth(mesh).and_then(|mesh| mesh.primitives().next()).expect("a primitive");
    let reader = primitive.reader(|_| theirs.blob.as_deref());
    let indices = reader.read_indices().expect("indices").into_u32().collect();
    let positions = reader.read_positions().expect("positions").collect();
    (indices, positions, reader.read_normals().expect("normals").collect())
}

#[test]
fn bent_primitives_leave_draco_as_a_whole() {
    for (name, bytes) in draco_files() {
        let file = opened(bytes, name);
        // Moved without turning, so that normals stay what they were decoded to, and twice that.
        let moved: Vec<DVec3> = file.points().iter().map(|p| *p + DVec3::X).collect();
        let (once, again) = saved(&file, "moved.glb", &moved, None);
        let back: Vec<DVec3> = moved.iter().map(|p| *p - DVec3::X).collect();
        let (twice, _) = saved(&again, "back.glb", &back, None);
        for out in [&once, &twice] {
            assert_eq!(in_draco(&document(out), 0), None, "{name}");
            for key in ["extensionsUsed", "extensionsRequired"] {
                assert_eq!(document(out).get(key), None, "{name}: {key}");
            }
        }
        let (indices, positions, normals) = plain(&once, 0);
        assert!(indices == file.triangles.as_flattened(), "{name}: other indices");
        let got: Vec<DVec3> = positions.iter().map(|p| glam::Vec3::from(*p).as_dvec3()).collect();
        let expected: Vec<DVec3> = file.positions.iter().map(|p| *p + DVec3::X).collect();
        assert_near(&got, &expected, extent(&file.points()) * f64::from(f32::EPSILON));
        // There and back in single precision turns faces by rounding: some steps of it over edges a fraction long.
        let vectors =
            |normals: &[[f32; 3]]| -> Vec<DVec3> { normals.iter().map(|n| glam::Vec3::from(*n).as_dvec3()).collect() };
        assert_near(&vectors(&plain(&twice, 0).2), &vectors(&normals), 1e-4);
        let length = |n: &[f32; 3]| glam::Vec3::from(*n).length();
        // Ten bits a coordinate of the octahedron, decoded in single precision.
        assert!(normals.iter().all(|n| (length(n) - 1.0).abs() < 1e-5), "{name}: normals are none");
    }
}

#[test]
fn unbent_primitives_and_their_rigidity_stay_in_draco() {
    for (name, bytes) in draco_files() {
        // A second mesh out of the same compressed data, 5 to the side.
        let mut two = document(bytes);
        let accessors = two["accessors"].as_array().expect("accessors").clone();
        two["accessors"].as_array_mut().expect("accessors").extend(accessors);
        let mut mesh = two["meshes"][0].clone();
        mesh["primitives"][0]["attributes"] = serde_json::json!({"POSITION": 4, "NORMAL": 5});
        mesh["primitives"][0]["indices"] = 3.into();
        two["meshes"].as_array_mut().expect("meshes").push(mesh);
        two["nodes"] = serde_json::json!([{"mesh": 0}, {"mesh": 1, "translation": [0, 5, 0]}]);
        two["scenes"] = serde_json::json!([{"nodes": [0, 1]}]);
        let length = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
        let two = super::support::glb(&two, &bytes[28 + length..]);
        let file = opened(&two, name);
        let n = file.weld.n_points();
        let mut points = file.points();
        points[n / 2..].iter_mut().for_each(|p| p.x += 1.0);
        let (out, again) = saved(&file, "two.glb", &points, Some(&vec![4; n]));
        let (new, old) = (document(&out), document(&two));
        assert_eq!(in_draco(&new, 0), in_draco(&old, 0), "{name}: the first mesh");
        assert_eq!(in_draco(&new, 1), None, "{name}: the second");
        assert_eq!(new["extensionsRequired"], old["extensionsRequired"], "{name}");
        assert_near(&again.points(), &points, 10.0 * extent(&points) * f64::from(f32::EPSILON));
        assert_eq!(again.triangles, file.triangles, "{name}");
        assert_eq!(again.rigidity, Some(vec![4; file.positions.len()]), "{name}");
        let moved: Vec<DVec3> = again.points().iter().map(|p| *p + DVec3::Y).collect();
        let (all, _) = saved(&again, "all.glb", &moved, None);
        assert_eq!(document(&all).get("extensionsRequired"), None, "{name}");
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
