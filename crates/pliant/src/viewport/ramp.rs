//! Color ramps: a value becomes a color whose steps look equally large.
//!
//! All ramps run through a few stops chosen by eye and are interpolated in OKLab, a space in which equal distances
//! look about equally different. Rigidity goes from blue (soft) over a pale middle to vermilion (stiff): blue against orange stays apart for
//! every common kind of color blindness, and the two halves differ in hue, not only in lightness. Energy goes from night blue
//! over magenta to light yellow with steadily rising lightness, so it reads in gray as well. Stretch goes from violet
//! (compressed) over near white (unchanged) to green (stretched). The tests look at each ramp through the eyes of people who
//! lack one of the three cone pigments.
//!
//! Colors are mixed on the CPU, once for legend and surface alike: between a vertex of r = 1 and one of r = 6 the surface shows
//! a blend of the two colors and never the ones of values between them, which nobody painted.

use glam::{Mat3, Vec3};

/// Stops of the rigidity ramp from r = 1 to the ramp's end, sRGB, evenly spaced (by eye).
const RIGIDITY_STOPS: [[u8; 3]; 5] = [[38, 92, 196], [96, 174, 224], [240, 232, 206], [244, 160, 64], [204, 52, 32]];
/// Stops of the energy ramp from 0 to 1, sRGB, evenly spaced (by eye).
const ENERGY_STOPS: [[u8; 3]; 5] = [[34, 32, 74], [104, 40, 124], [190, 60, 104], [242, 132, 64], [252, 240, 168]];

/// Stops of the stretch ramp from compressed over unchanged to stretched, sRGB, evenly spaced (by eye).
const STRETCH_STOPS: [[u8; 3]; 5] = [[78, 42, 140], [160, 128, 204], [240, 238, 232], [112, 188, 120], [10, 100, 52]];
/// Soft and stiff where two colors are enough: those of the rigidity ramp near its ends, sRGB.
const SOFT_STIFF: [[u8; 3]; 2] = [[116, 182, 230], [206, 76, 36]];

/// Color of r as shown on the legend and the surface (sRGB). The ramp runs from 1 to `ramp_max`; beyond it, the end's color.
pub fn rigidity_color(r: u16, ramp_max: u16) -> [u8; 3] {
    let steps = f32::from(ramp_max.max(2) - 1);
    ramp(&RIGIDITY_STOPS, f32::from(r.max(1) - 1) / steps)
}

/// Color of a normalized energy in 0..=1 as shown on the surface (sRGB); values outside (and NaN) are clamped.
pub fn energy_color(value: f32) -> [u8; 3] {
    ramp(&ENERGY_STOPS, value)
}

/// Color of a normalized stretch in 0..=1 as shown on the surface (sRGB): 0 compressed, 0.5 unchanged, 1 stretched. Values
/// outside are clamped, NaN is compressed.
pub fn stretch_color(value: f32) -> [u8; 3] {
    ramp(&STRETCH_STOPS, value)
}

/// Color of what is soft or stiff where two colors are enough (sRGB).
pub fn soft_stiff_color(is_stiff: bool) -> [u8; 3] {
    SOFT_STIFF[usize::from(is_stiff)]
}

/// Color at `t` in 0..=1 along evenly spaced stops.
fn ramp(stops: &[[u8; 3]], t: f32) -> [u8; 3] {
    let last = stops.len() - 1;
    let at = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) } * last as f32;
    let index = (at as usize).min(last - 1);
    let (a, b) = (oklab_from_linear(linear(stops[index])), oklab_from_linear(linear(stops[index + 1])));
    encode(linear_from_oklab(a.lerp(b, at - index as f32)))
}

/// Linear light from sRGB bytes.
pub(super) fn linear(srgb: [u8; 3]) -> Vec3 {
    Vec3::from_array(srgb.map(|byte| {
        let v = f32::from(byte) / 255.0;
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    }))
}

/// sRGB bytes from linear light, clamped to the displayable range.
pub(super) fn encode(linear: Vec3) -> [u8; 3] {
    linear.to_array().map(|v| {
        let v = v.clamp(0.0, 1.0);
        let v = if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
        (v * 255.0).round() as u8
    })
}

/// Linear sRGB to cone responses, rows of the definition of OKLab (B. Ottosson, 2020).
const CONES: [[f32; 3]; 3] = [
    [0.412_221_47, 0.536_332_54, 0.051_445_99],
    [0.211_903_5, 0.680_699_5, 0.107_396_96],
    [0.088_302_46, 0.281_718_84, 0.629_978_7],
];
/// Cube roots of cone responses to lightness and two color axes, rows of the same definition.
const OPPONENTS: [[f32; 3]; 3] = [
    [0.210_454_26, 0.793_617_8, -0.004_072_047],
    [1.977_998_5, -2.428_592_2, 0.450_593_7],
    [0.025_904_037, 0.782_771_77, -0.808_675_77],
];

fn matrix(rows: &[[f32; 3]; 3]) -> Mat3 {
    Mat3::from_cols_array_2d(rows).transpose()
}

fn oklab_from_linear(linear: Vec3) -> Vec3 {
    let cones = matrix(&CONES) * linear;
    matrix(&OPPONENTS) * Vec3::new(cones.x.cbrt(), cones.y.cbrt(), cones.z.cbrt())
}

fn linear_from_oklab(lab: Vec3) -> Vec3 {
    let roots = matrix(&OPPONENTS).inverse() * lab;
    matrix(&CONES).inverse() * (roots * roots * roots)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linear light as seen without the pigment for long, middle or short waves, rows of the matrices of G. Machado, M.
    /// Oliveira and L. Fernandes (2009) at full severity.
    const BLIND: [(&str, [[f32; 3]; 3]); 3] = [
        (
            "protan",
            [
                [0.152_286, 1.052_583, -0.204_868],
                [0.114_503, 0.786_281, 0.099_216],
                [-0.003_882, -0.048_116, 1.051_998],
            ],
        ),
        (
            "deutan",
            [[0.367_322, 0.860_646, -0.227_968], [0.280_085, 0.672_501, 0.047_413], [-0.011_820, 0.042_940, 0.968_881]],
        ),
        (
            "tritan",
            [
                [1.255_528, -0.076_749, -0.178_779],
                [-0.078_411, 0.930_809, 0.147_602],
                [0.004_733, 0.691_367, 0.303_900],
            ],
        ),
    ];
    /// About the smallest difference in OKLab that is seen between neighboring patches.
    const SEEN: f32 = 0.02;

    fn lab(color: [u8; 3]) -> Vec3 {
        oklab_from_linear(linear(color))
    }

    /// The color in OKLab as different eyes see it.
    fn seen(color: [u8; 3]) -> [(&'static str, Vec3); 4] {
        let [protan, deutan, tritan] = BLIND.map(|(eye, rows)| {
            let light = matrix(&rows) * linear(color);
            (eye, oklab_from_linear(light.clamp(Vec3::ZERO, Vec3::ONE)))
        });
        [("all", lab(color)), protan, deutan, tritan]
    }

    #[test]
    fn ramps_of_two_directions_tell_their_ends_apart_for_all_eyes() {
        for (name, stops) in [("stretch", STRETCH_STOPS), ("rigidity", RIGIDITY_STOPS)] {
            let color = |t| ramp(&stops, t);
            // Darker and darker away from the middle, equally fast on both sides, and never alike at equal distance.
            for step in 1..=16 {
                let away = step as f32 / 32.0;
                let [low, high] = [seen(color(0.5 - away)), seen(color(0.5 + away))];
                let before = away - 1.0 / 32.0;
                let [low_before, high_before] = [seen(color(0.5 - before)), seen(color(0.5 + before))];
                for (k, (eye, _)) in low.iter().enumerate() {
                    let (low, high) = (low[k].1, high[k].1);
                    let darker = low.x < low_before[k].1.x + 2e-3 && high.x < high_before[k].1.x + 2e-3;
                    assert!(darker, "{name}, {eye}: lighter again at {away} from the middle");
                    // An eighth of the ramp from the middle on, where colors are more than tinted.
                    let apart = low.distance(high);
                    assert!(away < 0.125 || apart > 3.0 * SEEN, "{name}, {eye}: {apart} apart at {away}");
                }
            }
        }
    }

    #[test]
    fn heat_gets_lighter_for_all_eyes() {
        for step in 0..64 {
            let at = |step: i32| seen(energy_color(step as f32 / 64.0));
            for ((eye, before), (_, after)) in at(step).into_iter().zip(at(step + 1)) {
                assert!(after.x > before.x - 1e-3, "{eye}: step {step} from {} to {}", before.x, after.x);
            }
        }
        for ((eye, low), (_, high)) in seen(energy_color(0.0)).into_iter().zip(seen(energy_color(1.0))) {
            assert!(high.x - low.x > 0.5, "{eye}: from {} to {}", low.x, high.x);
        }
    }

    #[test]
    fn soft_and_stiff_differ_in_lightness_and_hue_for_all_eyes() {
        for ((eye, soft), (_, stiff)) in seen(soft_stiff_color(false)).into_iter().zip(seen(soft_stiff_color(true))) {
            assert!(soft.x - stiff.x > 3.0 * SEEN, "{eye}: lightness {} and {}", soft.x, stiff.x);
            assert!(soft.distance(stiff) > 8.0 * SEEN, "{eye}: {soft} and {stiff}");
        }
    }

    #[test]
    fn rigidity_starts_blue_and_ends_warm() {
        for max in [2, 6, 20, u16::MAX] {
            let (soft, stiff) = (rigidity_color(1, max), rigidity_color(max, max));
            assert_eq!(soft, RIGIDITY_STOPS[0], "max {max}");
            assert_eq!(stiff, RIGIDITY_STOPS[4], "max {max}");
        }
        assert_eq!(rigidity_color(9, 6), rigidity_color(6, 6), "beyond the end");
        assert_eq!(rigidity_color(0, 6), rigidity_color(1, 6), "below the start");
        assert_eq!(rigidity_color(3, 0), rigidity_color(3, 2), "a ramp without length");
    }

    #[test]
    fn neighboring_rigidities_look_different() {
        for max in [2, 3, 6, 10] {
            for r in 1..max {
                let step = lab(rigidity_color(r, max)).distance(lab(rigidity_color(r + 1, max)));
                assert!(step > 2.0 * SEEN, "r {r} to {} of {max}: step {step}", r + 1);
            }
        }
    }

    #[test]
    fn values_outside_a_ramp_have_the_color_of_its_end() {
        for color in [energy_color, stretch_color] {
            assert_eq!(color(f32::NAN), color(0.0));
            assert_eq!(color(-3.0), color(0.0));
            assert_eq!(color(7.0), color(1.0));
        }
    }

    #[test]
    fn colors_survive_the_way_through_oklab() {
        for color in RIGIDITY_STOPS.into_iter().chain([[0, 0, 0], [255, 255, 255], [255, 0, 0], [12, 200, 9]]) {
            let back = encode(linear_from_oklab(oklab_from_linear(linear(color))));
            for (got, expected) in back.into_iter().zip(color) {
                assert!(got.abs_diff(expected) <= 1, "got {back:?}, expected {color:?}");
            }
        }
    }
}
