//! Promises about whole files: what comes back after opening and saving.

mod bad_files;
mod compressed;
mod conversion;
mod gltf_beyond;
mod gltf_reading;
mod gltf_saving;
mod lossless;
mod morphs;
mod mutation;
mod obj_details;
mod obj_reading;
mod obj_saving;
mod off;
mod packs;
mod ply;
mod poses;
mod stl;
mod support;
mod textures;
mod welding;

pub(crate) use mutation::{Numbers, mutated};
