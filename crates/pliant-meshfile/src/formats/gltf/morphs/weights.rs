//! Weights of morph targets: defaults, the animations that were there, and the one that goes through the new targets.

use super::super::access::Data;
use super::super::builder::Builder;
use super::super::json as look;
use super::super::source::GltfSource;
use super::{nodes, weights_of};
use crate::Fault;
use crate::mesh_file::Morphs;
use serde_json::{Value, json};
use std::collections::HashMap;

/// Makes room for the weights of the new targets everywhere, and adds the animation. `counts`: how many targets each
/// changed mesh had.
pub(super) fn extend(
    document: &mut Value,
    source: &GltfSource,
    (counts, morphs): (&HashMap<usize, usize>, &Morphs<'_>),
    added: &mut Builder,
) -> Result<(), Fault> {
    let n_new = morphs.shapes.len();
    refuse_pointers(document)?;
    for (&mesh, &before) in counts {
        let Some(object) = document.pointer_mut(&format!("/meshes/{mesh}")) else { continue };
        let defaults = weights_of(object, before + n_new).unwrap_or_else(|| vec![0.0; before + n_new]);
        object["weights"] = defaults.into();
    }
    // Node by node, which mesh of those it shows.
    let shown: Vec<Option<usize>> = nodes(document).iter().map(|node| mesh_of(node, counts)).collect();
    for (node, mesh) in shown.iter().enumerate() {
        let (Some(mesh), Some(object)) = (mesh, document.pointer_mut(&format!("/nodes/{node}"))) else { continue };
        if let Some(weights) = weights_of(object, counts[mesh] + n_new) {
            object["weights"] = weights.into();
        }
    }
    lengthen(document, source, (&shown, counts, n_new), added)?;
    if !morphs.keys.is_empty() {
        animate(document, &shown, (counts, morphs), added);
    }
    Ok(())
}

fn mesh_of(node: &Value, counts: &HashMap<usize, usize>) -> Option<usize> {
    let mesh = node.get("mesh")?.as_f64()? as usize;
    counts.contains_key(&mesh).then_some(mesh)
}

/// Weights that are animated by a pointer would have to be found among everything such a pointer can name.
fn refuse_pointers(document: &Value) -> Result<(), Fault> {
    for (index, animation) in look::list(document, "animations")?.iter().enumerate() {
        for channel in animation.get("channels").and_then(Value::as_array).into_iter().flatten() {
            let pointer = channel.pointer("/target/extensions/KHR_animation_pointer/pointer").and_then(Value::as_str);
            if pointer.is_some_and(|pointer| pointer.contains("/weights")) {
                let problem = "animates weights by KHR_animation_pointer, which cannot be kept with further targets";
                return Err(Fault::at(format!("animation {index}"), problem));
            }
        }
    }
    Ok(())
}

/// Fills the keys of animations that were there with zeros for the new targets.
fn lengthen(
    document: &mut Value,
    source: &GltfSource,
    (shown, counts, n_new): (&[Option<usize>], &HashMap<usize, usize>, usize),
    added: &mut Builder,
) -> Result<(), Fault> {
    let n_animations = look::list(document, "animations")?.len();
    for index in 0..n_animations {
        let place = format!("animation {index}");
        let Some(animation) = document.pointer_mut(&format!("/animations/{index}")) else { continue };
        let channels = animation.get("channels").and_then(Value::as_array).cloned().unwrap_or_default();
        for (k, channel) in channels.iter().enumerate() {
            let path = channel.pointer("/target/path").and_then(Value::as_str);
            let node = channel.pointer("/target/node").and_then(Value::as_f64).map(|node| node as usize);
            let mesh = node.and_then(|node| shown.get(node).copied().flatten());
            let (Some("weights"), Some(mesh)) = (path, mesh) else { continue };
            let sampler = channel.get("sampler").and_then(Value::as_f64).map(|sampler| sampler as usize);
            let sampler = sampler.and_then(|sampler| animation.get("samplers")?.get(sampler)).cloned();
            let broken = || Fault::at(place.as_str(), format!("channel {k} has no sampler that can be read"));
            let mut sampler = sampler.ok_or_else(broken)?;
            let output = sampler.get("output").and_then(Value::as_f64).ok_or_else(broken)? as usize;
            let numbers = Data::from(source).accessor(output)?.in_fractions().numbers();
            let before = counts[&mesh];
            if before == 0 || numbers.len() % before != 0 {
                return Err(broken());
            }
            let rows = numbers.chunks_exact(before);
            let longer: Vec<f32> =
                rows.flat_map(|row| row.iter().map(|&x| x as f32).chain(std::iter::repeat_n(0.0, n_new))).collect();
            sampler["output"] = added.keys(&longer, false).into();
            // Another channel may use the old one.
            if let Some(samplers) = animation.get_mut("samplers").and_then(Value::as_array_mut) {
                samplers.push(sampler);
                let last = samplers.len() - 1;
                animation["channels"][k]["sampler"] = last.into();
            }
        }
    }
    Ok(())
}

/// The animation that goes through the shapes, in every node that shows one of the meshes.
fn animate(
    document: &mut Value,
    shown: &[Option<usize>],
    (counts, morphs): (&HashMap<usize, usize>, &Morphs<'_>),
    added: &mut Builder,
) {
    let times: Vec<f32> = morphs.keys.iter().map(|key| key.0).collect();
    let n_new = morphs.shapes.len();
    let input = added.keys(&times, true);
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    for (node, mesh) in shown.iter().enumerate() {
        let Some(mesh) = mesh else { continue };
        let before = counts[mesh];
        let at = |pointer: String| document.pointer(&pointer).and_then(|object| weights_of(object, before));
        let own = at(format!("/nodes/{node}")).or_else(|| at(format!("/meshes/{mesh}"))).unwrap_or_default();
        let mut rows: Vec<f32> = Vec::with_capacity(times.len() * (before + n_new));
        for &(_, shape) in morphs.keys {
            rows.extend(own.iter().map(|&weight| weight as f32));
            rows.extend((0..n_new).map(|k| if shape == Some(k) { 1.0 } else { 0.0 }));
        }
        let interpolation = if morphs.stepped { "STEP" } else { "LINEAR" };
        samplers.push(json!({"input": input, "output": added.keys(&rows, false), "interpolation": interpolation}));
        channels.push(json!({"sampler": samplers.len() - 1, "target": {"node": node, "path": "weights"}}));
    }
    // Meshes that no node shows cannot be animated.
    if channels.is_empty() {
        return;
    }
    let animation = json!({"name": morphs.animation, "samplers": samplers, "channels": channels});
    match document.get_mut("animations").and_then(Value::as_array_mut) {
        Some(list) => list.push(animation),
        None => document["animations"] = json!([animation]),
    }
}
