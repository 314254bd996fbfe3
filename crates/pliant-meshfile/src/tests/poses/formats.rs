//! Poses of a mesh in files of every format.

use super::super::support::{assert_near, bent, obj};
use super::model::collect;
use crate::open;
use crate::poses::{PoseOptions, Poses};

/// Three triangles around a corner.
const FAN: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\nf 1 4 5\n";

#[test]
fn a_file_of_any_format_is_a_pose_of_one_of_any_other() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let start = obj(FAN);
    let names = ["obj", "gltf", "glb", "ply", "stl", "off"];
    for name in names {
        start.save(&folder.path().join(format!("rest.{name}")), &start.points(), None).expect("saved");
        start.save(&folder.path().join(format!("pose.{name}")), &bent(&start.points()), None).expect("saved");
    }
    for first in names {
        let reference = open(&folder.path().join(format!("rest.{first}"))).expect("a mesh");
        for second in names {
            let path = folder.path().join(format!("pose.{second}"));
            let poses = Poses::open(&path, &reference, PoseOptions::default());
            let (poses, _) = collect(poses.unwrap_or_else(|error| panic!("{first} and {second}: {error}")));
            assert_eq!(poses.len(), 1, "{first} and {second}");
            // All numbers are quarters, which every format holds to the bit.
            assert_near(&poses[0].points, &bent(&reference.points()), 0.0);
        }
    }
}
