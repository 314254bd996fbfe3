//! glTF morph targets, skins and animations that are broken: the mesh opens, since its shape is sound; the poses are
//! passed over.

use super::Case;
use super::gltf::changed;
use super::model::N_VERTICES;
use serde_json::{Value, json};

pub(super) fn cases() -> Vec<Case> {
    let values = |list: &[Value]| list.to_vec();
    let any = values(&[json!(99), json!(-1), json!("x"), json!({}), json!(u64::MAX), json!([]), json!(1e300)]);
    let mut cases = Vec::new();
    for pointer in [
        "/meshes/0/primitives/0/targets/0",
        "/meshes/0/primitives/0/targets/0/POSITION",
        "/meshes/0/primitives/0/attributes/JOINTS_0",
        "/meshes/0/primitives/0/attributes/WEIGHTS_0",
        "/meshes/0/weights",
        "/skins/0",
        "/skins/0/joints",
        "/skins/0/joints/0",
        "/skins/0/inverseBindMatrices",
        "/nodes/2/skin",
        "/animations/0",
        "/animations/0/channels",
        "/animations/0/channels/0/sampler",
        "/animations/0/channels/0/target",
        "/animations/0/channels/0/target/node",
        "/animations/0/channels/0/target/path",
        "/animations/0/samplers/0",
        "/animations/0/samplers/0/input",
        "/animations/0/samplers/0/output",
        "/animations/0/samplers/0/interpolation",
        "/accessors/9/count",
        "/accessors/10/count",
        "/accessors/13/count",
        "/accessors/6/sparse/indices/bufferView",
    ] {
        for value in &any {
            // One container is enough: they differ in nothing here.
            cases.extend(changed(pointer, value.clone(), N_VERTICES).into_iter().take(1));
        }
    }
    cases
}
