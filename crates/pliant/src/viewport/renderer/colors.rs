//! The color of each vertex, mixed on the CPU from base color, ramp and opacity: one place for the truth the legend shows too.

use super::super::ramp::{encode, linear};
use super::super::{Coloring, Theme, ViewScene, energy_color, rigidity_color};
use glam::Vec3;
use std::sync::LazyLock;

/// Unpainted clay, sRGB: light before dark ground, a shade darker before light ground (by eye).
const CLAY: [[u8; 3]; 2] = [[206, 203, 198], [190, 192, 196]];
/// Entries of a tabulated ramp; ramps with more rigidities than this are sampled.
const RAMP_ENTRIES: usize = 256;
/// Steps of linear light in the table to sRGB: fine enough that no sRGB byte above the darkest few is skipped.
const ENCODE_STEPS: usize = 4096;

static ENCODED: LazyLock<Vec<u8>> = LazyLock::new(|| {
    (0..=ENCODE_STEPS)
        .map(|step| encode(Vec3::splat(step as f32 / ENCODE_STEPS as f32))[0])
        .collect()
});

/// sRGB and the selection (0 or 255) of each of `n_vertices` vertices into `out`. Arrays of the scene that are too short count as
/// zeros beyond their end.
pub(super) fn vertex_colors(scene: &ViewScene, n_vertices: usize, out: &mut Vec<[u8; 4]>) {
    out.clear();
    out.reserve(n_vertices);
    let ramp = ramp_table(scene);
    let opacity = if ramp.is_empty() {
        0.0
    } else {
        scene.color_opacity.clamp(0.0, 1.0)
    };
    let entry = |vertex: usize| match scene.coloring {
        Coloring::Plain => 0,
        Coloring::Rigidity => rigidity_entry(
            scene.rigidity.get(vertex).copied().unwrap_or(1),
            scene.ramp_max,
        ),
        Coloring::Energy => energy_entry(
            scene
                .values
                .as_ref()
                .and_then(|values| values.get(vertex))
                .copied()
                .unwrap_or(0.0),
        ),
    };
    let selected = |vertex: usize| match &scene.selected {
        Some(flags) if flags.get(vertex).copied().unwrap_or(false) => 255,
        _ => 0,
    };
    match &scene.base_colors {
        Some(bases) => out.extend((0..n_vertices).map(|vertex| {
            let [r, g, b, _] = bases.get(vertex).copied().unwrap_or([255; 4]);
            let base = Vec3::new(f32::from(r), f32::from(g), f32::from(b)) / 255.0;
            let color = if opacity > 0.0 {
                base.lerp(ramp[entry(vertex)], opacity)
            } else {
                base
            };
            with_selection(
                color
                    .to_array()
                    .map(|v| ENCODED[(v * ENCODE_STEPS as f32) as usize]),
                selected(vertex),
            )
        })),
        None => {
            let clay = linear(CLAY[usize::from(scene.theme == Theme::Light)]);
            let mut mixed: Vec<[u8; 3]> = ramp
                .iter()
                .map(|color| encode(clay.lerp(*color, opacity)))
                .collect();
            if mixed.is_empty() {
                mixed.push(encode(clay));
            }
            out.extend(
                (0..n_vertices)
                    .map(|vertex| with_selection(mixed[entry(vertex)], selected(vertex))),
            );
        }
    }
}

fn with_selection([r, g, b]: [u8; 3], selected: u8) -> [u8; 4] {
    [r, g, b, selected]
}

/// The ramp of the scene's coloring in linear light; empty for plain.
fn ramp_table(scene: &ViewScene) -> Vec<Vec3> {
    match scene.coloring {
        Coloring::Plain => Vec::new(),
        Coloring::Rigidity => {
            let last = rigidity_entry(u16::MAX, scene.ramp_max);
            let steps = f32::from(scene.ramp_max.max(2) - 1);
            let r = |entry: usize| 1 + (entry as f32 * steps / last as f32).round() as u16;
            (0..=last)
                .map(|entry| linear(rigidity_color(r(entry), scene.ramp_max)))
                .collect()
        }
        Coloring::Energy => (0..RAMP_ENTRIES)
            .map(|entry| linear(energy_color(entry as f32 / (RAMP_ENTRIES - 1) as f32)))
            .collect(),
    }
}

/// Table entry of r: r − 1, or a sample of a ramp too long to tabulate.
fn rigidity_entry(r: u16, ramp_max: u16) -> usize {
    let most = usize::from(ramp_max.max(2) - 1);
    let steps = usize::from(r.max(1) - 1).min(most);
    if most < RAMP_ENTRIES {
        steps
    } else {
        steps * (RAMP_ENTRIES - 1) / most
    }
}

/// Table entry of a normalized value; NaN is zero.
fn energy_entry(value: f32) -> usize {
    (value.clamp(0.0, 1.0) * (RAMP_ENTRIES - 1) as f32).round() as usize
}
