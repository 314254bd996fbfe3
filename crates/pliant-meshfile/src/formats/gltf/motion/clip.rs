//! Animations: which properties of which nodes their channels drive.

use super::super::access::Data;
use super::super::json;
use super::super::nodes::Local;
use super::rig::{Rig, State};
use super::sampler::{Reading, Sampler};
use crate::{Fault, budget};
use glam::DVec3;
use serde_json::Value;

/// An animation that moves a mesh.
#[derive(Debug)]
pub(super) struct Clip {
    pub(super) name: String,
    index: usize,
    /// Numbers in its keys as far as the document tells, those shared by channels for each of them.
    pub(super) n_numbers: u64,
    /// Steps of computation for one frame besides those of the rig.
    pub(super) work: u64,
}

/// The animations that move the meshes of a rig, by name; cameras and lights of their own do not.
pub(super) fn clips(document: &Value, rig: &Rig) -> Result<Vec<Clip>, Fault> {
    let mut clips = Vec::new();
    let mut names = budget::Purse::of_names();
    for (index, animation) in json::list(document, "animations")?.iter().enumerate() {
        let name = json::name(animation).map_or_else(|| format!("animation {index}"), str::to_owned);
        let mut clip = Clip { name: budget::short_name(name), index, n_numbers: 0, work: 0 };
        names.spend(clip.name.len())?;
        let driven = clip.driven(document, rig)?;
        for channel in &driven {
            clip.n_numbers = clip.n_numbers.saturating_add(channel.n_numbers(document));
            clip.work = clip.work.saturating_add(channel.property.width() as u64);
        }
        if !driven.is_empty() {
            clips.push(clip);
        }
    }
    Ok(clips)
}

/// A property of the rig that is animated.
#[derive(Clone, Copy, Debug)]
enum Property {
    /// Of the transform in a slot.
    Translation(usize),
    Rotation(usize),
    Scale(usize),
    /// The weights of a node's mesh, and how many.
    Weights(usize, usize),
}

impl Property {
    /// How many numbers it has.
    fn width(self) -> usize {
        match self {
            Property::Translation(_) | Property::Scale(_) => 3,
            Property::Rotation(_) => 4,
            Property::Weights(_, n) => n,
        }
    }
}

/// A channel that drives the rig.
struct Driven<'a> {
    property: Property,
    sampler: &'a Value,
    place: String,
}

impl Driven<'_> {
    /// Numbers in its keys as the document tells; of what it does not tell, reading will complain.
    fn n_numbers(&self, document: &Value) -> u64 {
        let wide = if let Property::Weights(..) = self.property { 1 } else { self.property.width() as u64 };
        let accessors = json::list(document, "accessors").unwrap_or_default();
        let count = |key: &str| {
            let accessor = accessors.get(self.sampler.get(key)?.as_u64()? as usize)?;
            json::number(accessor, "count", "").ok()?
        };
        let [times, values] = ["input", "output"].map(|key| count(key).unwrap_or(0));
        times.saturating_add(values.saturating_mul(wide))
    }
}

impl Clip {
    fn driven<'a>(&self, document: &'a Value, rig: &Rig) -> Result<Vec<Driven<'a>>, Fault> {
        let animation = &json::list(document, "animations")?[self.index];
        let list = |key: &str| animation.get(key).and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        let (samplers, n_nodes) = (list("samplers"), json::list(document, "nodes")?.len());
        let mut driven = Vec::new();
        for (c, channel) in list("channels").iter().enumerate() {
            let place = format!("animation {}, channel {c}", self.index);
            // Without a node, or with a path of some extension, it drives nothing that is known here.
            let Some(target) = channel.get("target") else { continue };
            let Some(node) = json::reference(target, "node", &place, "node", n_nodes)? else { continue };
            let property = match target.get("path").and_then(Value::as_str) {
                Some("translation") => rig.slot(node).map(Property::Translation),
                Some("rotation") => rig.slot(node).map(Property::Rotation),
                Some("scale") => rig.slot(node).map(Property::Scale),
                Some("weights") => rig.n_weights(node).map(|n| Property::Weights(node, n)),
                _ => None,
            };
            let Some(property) = property else { continue };
            let sampler = json::reference(channel, "sampler", &place, "sampler", samplers.len())?
                .ok_or_else(|| Fault::at(place.as_str(), "names no sampler"))?;
            let place = format!("animation {}, sampler {sampler}", self.index);
            driven.push(Driven { property, sampler: &samplers[sampler], place });
        }
        Ok(driven)
    }

    /// Reads its keys.
    pub(super) fn read(&self, data: Data<'_>, rig: &Rig) -> Result<ClipChannels, Fault> {
        let mut reading = Reading::new(data);
        let mut read = ClipChannels { channels: Vec::new(), start: f64::INFINITY, end: f64::NEG_INFINITY };
        for Driven { property, sampler, place } in self.driven(data.document, rig)? {
            let width = property.width();
            let of = if let Property::Weights(..) = property { [width, 1] } else { [width, width] };
            if let Property::Translation(slot) | Property::Rotation(slot) | Property::Scale(slot) = property {
                rig.animated(slot)?;
            }
            let sampler = reading.sampler(sampler, &place, of)?;
            read.start = read.start.min(sampler.times[0]);
            read.end = read.end.max(sampler.times[sampler.times.len() - 1]);
            read.channels.push((property, sampler));
        }
        Ok(read)
    }
}

/// The channels of a clip with their keys.
#[derive(Debug)]
pub(super) struct ClipChannels {
    channels: Vec<(Property, Sampler)>,
    /// First and last key.
    start: f64,
    end: f64,
}

impl ClipChannels {
    /// Time of one of `n` frames: evenly from the first key to the last; the middle for a single one.
    pub(super) fn time(&self, frame: usize, n: usize) -> f64 {
        let part = if n > 1 { frame as f64 / (n - 1) as f64 } else { 0.5 };
        // Not by the difference, which may be more than a number holds.
        (1.0 - part) * self.start + part * self.end
    }

    /// The rig's state at time `t`.
    pub(super) fn at(&self, t: f64, rig: &Rig) -> State {
        let mut state = rig.at_rest();
        for (property, sampler) in &self.channels {
            match *property {
                Property::Weights(node, n) => {
                    state.weights.insert(node, (0..n).map(|k| sampler.number(t, k)).collect());
                }
                Property::Translation(slot) | Property::Rotation(slot) | Property::Scale(slot) => {
                    let Some(mut parts) = state.locals[slot].parts() else { continue };
                    match property {
                        Property::Rotation(_) => parts.rotation = sampler.rotation(t),
                        Property::Scale(_) => parts.scale = DVec3::from_array(sampler.vector(t)),
                        _ => parts.translation = DVec3::from_array(sampler.vector(t)),
                    }
                    state.locals[slot] = Local::Parts(parts);
                }
            }
        }
        state
    }
}
