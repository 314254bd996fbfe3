//! The color of each vertex, mixed on the CPU from base color, ramp and opacity: one place for the truth the legend shows too.
//!
//! Colors are handed over as square roots of linear light in eight bits: about as fine as sRGB, and decoding is a product.

use super::super::ramp::linear;
use super::super::{Coloring, Theme, ViewScene, energy_color, rigidity_color, soft_stiff_color, stretch_color};
use glam::Vec3;

/// Unpainted clay, sRGB: light before dark ground, a shade darker before light ground (by eye).
const CLAY: [[u8; 3]; 2] = [[206, 203, 198], [190, 192, 196]];
/// Percent of gray in the color of locked vertices, and of light left (by eye: paler, yet the r can be told).
const LOCKED_GRAY: u32 = 55;
const LOCKED_LIGHT: u32 = 84;
/// Percent of the new color in the preview of a fill, and of white over it (by eye: seen on any ramp, also on its own color).
const PREVIEW_SHARE: u32 = 75;
const PREVIEW_GLOW: u32 = 24;
/// Entries of a tabulated ramp; ramps with more rigidities than this are sampled.
const RAMP_ENTRIES: usize = 256;

/// Color and selection (0 or 255) of each of `n_vertices` vertices into `out`. Beyond the end of arrays that are too short: r = 1,
/// energy 0, not selected, clay. Of a textured surface the ramp's colors alone: they are laid over the texture when it is drawn.
pub(super) fn vertex_colors(scene: &ViewScene, n_vertices: usize, is_textured: bool, out: &mut Vec<[u8; 4]>) {
    let clay = linear(CLAY[usize::from(scene.theme == Theme::Light)]);
    let ramp = ramp_table(scene);
    let opacity = if is_textured { 1.0 } else { scene.color_opacity.clamp(0.0, 1.0) };
    let mix = |base: Vec3, entry: usize| match ramp.get(entry) {
        Some(color) => roots(base.lerp(*color, opacity)),
        None => roots(base),
    };
    out.clear();
    match &scene.base_colors {
        Some(bases) => out.extend((0..n_vertices).map(|vertex| {
            let base = bases.get(vertex).map_or(clay, base_light);
            mix(base, ramp_entry(scene, vertex))
        })),
        None => {
            let mixed: Vec<_> = (0..ramp.len().max(1)).map(|entry| mix(clay, entry)).collect();
            out.extend((0..n_vertices).map(|vertex| mixed[ramp_entry(scene, vertex)]));
        }
    }
    lay_over(scene, out);
    if let Some(flags) = &scene.selected {
        for (color, selected) in out.iter_mut().zip(flags.iter()) {
            color[3] = if *selected { 255 } else { 0 };
        }
    }
}

/// Pales what is locked, and shows what a click would fill in the color it would get.
fn lay_over(scene: &ViewScene, colors: &mut [[u8; 4]]) {
    if let Some(locked) = &scene.locked {
        for (color, _) in colors.iter_mut().zip(locked.iter()).filter(|(_, locked)| **locked) {
            let [r, g, b, _] = color.map(u32::from);
            let gray = (r + g + b) / 3;
            let pale = [r, g, b].map(|c| (c * (100 - LOCKED_GRAY) + gray * LOCKED_GRAY) * LOCKED_LIGHT / 10_000);
            color[..3].copy_from_slice(&pale.map(|c| c as u8));
        }
    }
    if let Some(preview) = &scene.preview {
        let new = roots(linear(rigidity_color(preview.r, scene.ramp_max))).map(u32::from);
        for (color, _) in colors.iter_mut().zip(preview.vertices.iter()).filter(|(_, shown)| **shown) {
            for (c, new) in color.iter_mut().zip(new).take(3) {
                let mixed = (u32::from(*c) * (100 - PREVIEW_SHARE) + new * PREVIEW_SHARE) / 100;
                *c = (mixed + (255 - mixed) * PREVIEW_GLOW / 100) as u8;
            }
        }
    }
}

/// What lies under the textures of so many vertices: base colors, white where there are none.
pub(super) fn base_roots(scene: &ViewScene, n_vertices: usize) -> Vec<[u8; 4]> {
    let bases = scene.base_colors.as_deref().unwrap_or_default();
    let base = |vertex| bases.get(vertex).map_or(Vec3::ONE, base_light);
    let mut colors: Vec<_> = (0..n_vertices).map(|vertex| roots(base(vertex))).collect();
    lay_over(scene, &mut colors);
    colors
}

/// Linear light of a base color.
fn base_light([r, g, b, _]: &[u8; 4]) -> Vec3 {
    Vec3::new(f32::from(*r), f32::from(*g), f32::from(*b)) / 255.0
}

/// Square roots of linear light, not selected.
fn roots(linear: Vec3) -> [u8; 4] {
    let [r, g, b] = linear.to_array().map(|light| (light.clamp(0.0, 1.0).sqrt() * 255.0).round() as u8);
    [r, g, b, 0]
}

/// The ramp of the scene's coloring in linear light; empty for plain.
fn ramp_table(scene: &ViewScene) -> Vec<Vec3> {
    let last = RAMP_ENTRIES - 1;
    match scene.coloring {
        Coloring::Plain => Vec::new(),
        Coloring::Rigidity => {
            let max = scene.ramp_max.max(2);
            let last = rigidity_entry(max, max);
            let r = |entry: usize| 1 + (entry * usize::from(max - 1) / last) as u16;
            (0..=last).map(|entry| linear(rigidity_color(r(entry), max))).collect()
        }
        Coloring::SoftStiff { .. } => [false, true].map(|is_stiff| linear(soft_stiff_color(is_stiff))).into(),
        Coloring::Energy => (0..=last).map(|entry| linear(energy_color(entry as f32 / last as f32))).collect(),
        Coloring::Stretch => (0..=last).map(|entry| linear(stretch_color(entry as f32 / last as f32))).collect(),
    }
}

/// Entry of a vertex in the table of the scene's coloring; 0 for plain.
fn ramp_entry(scene: &ViewScene, vertex: usize) -> usize {
    match scene.coloring {
        Coloring::Plain => 0,
        Coloring::Rigidity => rigidity_entry(scene.rigidity.get(vertex).copied().unwrap_or(1), scene.ramp_max),
        Coloring::SoftStiff { stiff_from } => {
            usize::from(scene.rigidity.get(vertex).copied().unwrap_or(1).max(1) >= stiff_from)
        }
        Coloring::Energy | Coloring::Stretch => {
            let missing = if scene.coloring == Coloring::Stretch { 0.5 } else { 0.0 };
            let value = scene.values.as_ref().and_then(|values| values.get(vertex)).copied().unwrap_or(missing);
            // A NaN becomes entry 0 here.
            (value.clamp(0.0, 1.0) * (RAMP_ENTRIES - 1) as f32).round() as usize
        }
    }
}

/// Entry of r: r − 1, or a sample of a ramp too long to tabulate.
fn rigidity_entry(r: u16, ramp_max: u16) -> usize {
    let most = usize::from(ramp_max.max(2) - 1);
    let steps = usize::from(r.max(1) - 1).min(most);
    if most < RAMP_ENTRIES { steps } else { steps * (RAMP_ENTRIES - 1) / most }
}

#[cfg(test)]
mod tests {
    use super::super::super::{Camera, Preview, SurfaceFrame};
    use super::*;
    use std::sync::Arc;

    /// Vertices of these rigidities, colored by them.
    fn painted(rigidity: &[u16], ramp_max: u16, opacity: f32) -> ViewScene {
        let bounds = (Vec3::NEG_ONE, Vec3::ONE);
        let camera = Camera::framing(bounds.0, bounds.1);
        ViewScene {
            rigidity: rigidity.into(),
            coloring: Coloring::Rigidity,
            ramp_max,
            color_opacity: opacity,
            ..ViewScene::plain(Arc::new([]), Arc::new(SurfaceFrame::default()), camera, bounds)
        }
    }

    fn colors(scene: &ViewScene, n: usize) -> Vec<[u8; 4]> {
        let mut out = vec![[9; 4]; 3];
        vertex_colors(scene, n, false, &mut out);
        out
    }

    #[test]
    fn the_surface_has_the_colors_of_the_legend() {
        for max in [2, 6, 20, 300, u16::MAX] {
            let rs = [1, 2, max / 2 + 1, max, u16::MAX, 0];
            for (index, color) in colors(&painted(&rs, max, 1.0), rs.len()).into_iter().enumerate() {
                let expected = linear(rigidity_color(rs[index], max));
                // Half a step of eight bits in the root, and half a table step of ramps that are sampled.
                let tolerance = if max > 256 { 4 } else { 1 };
                for (got, expected) in color.into_iter().zip(roots(expected)) {
                    assert!(got.abs_diff(expected) <= tolerance, "r {} of {max}: {color:?}", rs[index]);
                }
            }
        }
    }

    #[test]
    fn opacity_mixes_with_what_is_under_the_ramp() {
        let clay = colors(&painted(&[6], 6, 0.0), 1)[0];
        assert_eq!(clay, roots(linear(CLAY[0])));
        let mut scene = painted(&[6], 6, 0.5);
        scene.base_colors = Some(Arc::new([[255, 255, 255, 255]]));
        let expected = roots((linear(rigidity_color(6, 6)) + 1.0) * 0.5);
        assert_eq!(colors(&scene, 1)[0], expected);
        scene.coloring = Coloring::Plain;
        assert_eq!(colors(&scene, 1)[0], [255, 255, 255, 0]);
    }

    #[test]
    fn locked_vertices_are_paler_and_a_preview_shows_the_color_to_come() {
        let mut scene = painted(&[1, 1, 6], 6, 1.0);
        let plain = colors(&scene, 3);
        scene.locked = Some(Arc::new([true, false, false]));
        scene.preview = Some(Preview { vertices: Arc::new([false, true, false]), r: 6 });
        let got = colors(&scene, 3);
        let spread = |c: [u8; 4]| c[..3].iter().max().unwrap_or(&0) - c[..3].iter().min().unwrap_or(&0);
        assert!(spread(got[0]) < spread(plain[0]) / 2, "locked: {:?} from {:?}", got[0], plain[0]);
        let apart = |a: [u8; 4], b: [u8; 4]| (0..3).map(|c| u32::from(a[c].abs_diff(b[c]))).sum::<u32>();
        assert!(apart(got[1], plain[2]) < apart(got[1], plain[1]), "nearer to r = 6 than to r = 1: {:?}", got[1]);
        assert_eq!(got[2], plain[2], "all else stays");
    }

    #[test]
    fn short_arrays_leave_the_rest_plain() {
        let mut scene = painted(&[6], 6, 1.0);
        scene.selected = Some(Arc::new([true]));
        let got = colors(&scene, 3);
        assert_eq!(got.len(), 3);
        assert_eq!((got[0][3], got[1][3]), (255, 0));
        assert_eq!(got[1], roots(linear(rigidity_color(1, 6))));
        scene.coloring = Coloring::Energy;
        scene.values = Some(Arc::new([f32::NAN, 2.0]));
        let got = colors(&scene, 3);
        assert_eq!(got[0][..3], got[2][..3], "NaN and missing are zero");
        assert_eq!(got[1], roots(linear(energy_color(1.0))));
        scene.coloring = Coloring::Stretch;
        scene.values = Some(Arc::new([0.5, 2.0]));
        let got = colors(&scene, 3);
        assert_eq!(got[0][..3], got[2][..3], "missing is unchanged");
        assert_eq!(got[1], roots(linear(stretch_color(1.0))));
    }

    #[test]
    fn two_colors_part_at_the_threshold() {
        for stiff_from in [1, 2, 4, 20] {
            let rs = [1, 2, 3, 4, 19, 20, 1000, 0];
            let scene = ViewScene { coloring: Coloring::SoftStiff { stiff_from }, ..painted(&rs, 6, 1.0) };
            for (r, color) in rs.into_iter().zip(colors(&scene, rs.len())) {
                let expected = roots(linear(soft_stiff_color(r.max(1) >= stiff_from)));
                assert_eq!(color, expected, "r {r}, stiff from {stiff_from}");
            }
        }
    }
}
