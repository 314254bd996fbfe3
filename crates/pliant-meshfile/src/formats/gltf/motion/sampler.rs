//! Values over time: keys, and what lies between them.
//!
//! With u = (t − tᵢ) / (tᵢ₊₁ − tᵢ) and d = tᵢ₊₁ − tᵢ between keys i and i + 1:
//!
//! | interpolation | value |
//! |---|---|
//! | step | vᵢ |
//! | linear | (1 − u) vᵢ + u vᵢ₊₁; along the shorter arc for rotations |
//! | cubic spline | (2u³ − 3u² + 1) vᵢ + d (u³ − 2u² + u) bᵢ + (3u² − 2u³) vᵢ₊₁ + d (u³ − u²) aᵢ₊₁, a and b the tangents into and out of a key; of rotations by component, then made unit |
//!
//! Before the first key and behind the last the value stays.

use super::super::access::Data;
use super::super::json;
use super::super::nodes::unit;
use crate::{Fault, budget};
use glam::DQuat;
use serde_json::Value;
use std::collections::HashMap;
use std::sync::Arc;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Interpolation {
    Step,
    Linear,
    CubicSpline,
}

/// Keys of one animated property.
#[derive(Clone, Debug)]
pub(super) struct Sampler {
    /// Never falling, at least one.
    pub(super) times: Arc<[f64]>,
    /// `width` numbers a key; of cubic splines three times as many: tangent in, value, tangent out.
    pub(super) values: Arc<[f64]>,
    pub(super) width: usize,
    pub(super) interpolation: Interpolation,
}

/// Reads the samplers of one animation, each list of numbers once.
pub(super) struct Reading<'a> {
    data: Data<'a>,
    numbers: budget::Purse,
    /// Those that no data lies behind.
    zeros: budget::Purse,
    times: HashMap<usize, Arc<[f64]>>,
    values: HashMap<usize, Arc<[f64]>>,
}

impl<'a> Reading<'a> {
    pub(super) fn new(data: Data<'a>) -> Self {
        let numbers = budget::Purse::new("numbers in the keys of an animation", budget::KEY_NUMBERS);
        let zeros = budget::Purse::new("numbers in keys without data", budget::ZEROS);
        Reading { data, numbers, zeros, times: HashMap::new(), values: HashMap::new() }
    }

    /// The sampler that `place` describes, of a property of `width` numbers, stored `wide` to an element.
    pub(super) fn sampler(&mut self, sampler: &Value, place: &str, of: [usize; 2]) -> Result<Sampler, Fault> {
        let [width, wide] = of;
        let interpolation = match sampler.get("interpolation").map(|name| name.as_str().unwrap_or_default()) {
            None | Some("LINEAR") => Interpolation::Linear,
            Some("STEP") => Interpolation::Step,
            Some("CUBICSPLINE") => Interpolation::CubicSpline,
            Some(_) => return Err(Fault::at(place, "its interpolation is not LINEAR, STEP or CUBICSPLINE")),
        };
        let n = json::list(self.data.document, "accessors")?.len();
        let accessor = |key: &str| {
            let index = json::reference(sampler, key, place, "accessor", n)?;
            index.ok_or_else(|| Fault::at(place, format!("has no {key}")))
        };
        let times = self.times(accessor("input")?)?;
        let values = self.values(accessor("output")?, wide)?;
        let per_key = if interpolation == Interpolation::CubicSpline { 3 * width } else { width };
        let expected = times.len().saturating_mul(per_key);
        if values.len() != expected {
            let problem = format!("has {} numbers for {} keys, {expected} are needed", values.len(), times.len());
            return Err(Fault::at(place, problem));
        }
        Ok(Sampler { times, values, width, interpolation })
    }

    fn times(&mut self, accessor: usize) -> Result<Arc<[f64]>, Fault> {
        if let Some(times) = self.times.get(&accessor) {
            return Ok(times.clone());
        }
        let place = format!("accessor {accessor}");
        let times = self.numbers(accessor, 1, false)?;
        if times.is_empty() {
            return Err(Fault::at(place, "holds no keys"));
        }
        // Some writers repeat a time for a jump, against the letter of the format.
        if let Some(key) = times.windows(2).position(|pair| pair[1] < pair[0]) {
            return Err(Fault::at(place, format!("time of key {} is before that of key {key}", key + 1)));
        }
        self.times.insert(accessor, times.clone());
        Ok(times)
    }

    fn values(&mut self, accessor: usize, wide: usize) -> Result<Arc<[f64]>, Fault> {
        let values = match self.values.get(&accessor) {
            Some(values) => values.clone(),
            None => self.numbers(accessor, wide, true)?,
        };
        self.values.insert(accessor, values.clone());
        Ok(values)
    }

    fn numbers(&mut self, accessor: usize, width: usize, fractions: bool) -> Result<Arc<[f64]>, Fault> {
        let checked = self.data.accessor(accessor)?;
        let place = || format!("accessor {accessor}");
        if checked.width != width {
            return Err(Fault::at(place(), format!("its elements have {} numbers, not {width}", checked.width)));
        }
        if !checked.has_data() {
            self.zeros.spend(checked.count.saturating_mul(width))?;
        }
        self.numbers.spend(checked.count.saturating_mul(width).saturating_add(checked.n_checked()))?;
        let checked = if fractions { checked.in_fractions() } else { checked };
        let numbers = checked.numbers();
        if let Some(i) = numbers.iter().position(|x| !x.is_finite()) {
            return Err(Fault::at(place(), format!("number {i} is not finite")));
        }
        Ok(numbers.into())
    }
}

impl Sampler {
    /// Number `k` of the value at time `t`.
    pub(super) fn number(&self, t: f64, k: usize) -> f64 {
        let (i, u) = self.place(t);
        let spread = if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let at = |key: usize, part: usize| self.values[(spread * key + part) * self.width + k];
        match self.interpolation {
            Interpolation::Step => at(i, 0),
            Interpolation::Linear if u == 0.0 => at(i, 0),
            Interpolation::Linear => (1.0 - u) * at(i, 0) + u * at(i + 1, 0),
            Interpolation::CubicSpline if u == 0.0 => at(i, 1),
            Interpolation::CubicSpline => {
                let (d, u2, u3) = (self.times[i + 1] - self.times[i], u * u, u * u * u);
                let values = (2.0 * u3 - 3.0 * u2 + 1.0) * at(i, 1) + (3.0 * u2 - 2.0 * u3) * at(i + 1, 1);
                values + d * ((u3 - 2.0 * u2 + u) * at(i, 2) + (u3 - u2) * at(i + 1, 0))
            }
        }
    }

    /// The first three numbers at time `t`.
    pub(super) fn vector(&self, t: f64) -> [f64; 3] {
        [0, 1, 2].map(|k| self.number(t, k))
    }

    /// The rotation at time `t`, of unit length.
    pub(super) fn rotation(&self, t: f64) -> DQuat {
        if self.interpolation == Interpolation::CubicSpline {
            return unit(DQuat::from_array([0, 1, 2, 3].map(|k| self.number(t, k))));
        }
        let (i, u) = self.place(t);
        let key = |i: usize| unit(DQuat::from_array([0, 1, 2, 3].map(|k| self.values[4 * i + k])));
        match self.interpolation {
            Interpolation::Linear if u > 0.0 => key(i).slerp(key(i + 1), u),
            _ => key(i),
        }
    }

    /// The last key not behind `t`, and how far the next one is reached; 0 beyond the keys.
    fn place(&self, t: f64) -> (usize, f64) {
        let behind = self.times.partition_point(|&key| key <= t);
        if behind == 0 || behind == self.times.len() {
            return (behind.saturating_sub(1), 0.0);
        }
        let (from, to) = (self.times[behind - 1], self.times[behind]);
        (behind - 1, (t - from) / (to - from))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampler(interpolation: Interpolation, width: usize, times: &[f64], values: &[f64]) -> Sampler {
        Sampler { times: times.into(), values: values.into(), width, interpolation }
    }

    #[test]
    fn values_between_keys_follow_the_interpolation() {
        // From 1 at time 2, leaving at a slope of 3, to 5 at time 4, arriving at a slope of -1.
        let keys = [2.0, 4.0];
        let spline = sampler(Interpolation::CubicSpline, 1, &keys, &[9.0, 1.0, 3.0, -1.0, 5.0, 9.0]);
        let linear = sampler(Interpolation::Linear, 1, &keys, &[1.0, 5.0]);
        let step = sampler(Interpolation::Step, 1, &keys, &[1.0, 5.0]);
        // At a quarter of the way the four polynomials are 27/32, 9/64, 5/32 and -3/64.
        let quarter = 27.0 / 32.0 + 2.0 * 3.0 * 9.0 / 64.0 + 5.0 * 5.0 / 32.0 + 2.0 * 3.0 / 64.0;
        let cases = [
            (1.0, [1.0, 1.0, 1.0]),
            (2.0, [1.0, 1.0, 1.0]),
            (2.5, [quarter, 2.0, 1.0]),
            (3.0, [0.5 + 2.0 * 3.0 / 8.0 + 2.5 + 2.0 / 8.0, 3.0, 1.0]),
            (4.0, [5.0, 5.0, 5.0]),
            (7.0, [5.0, 5.0, 5.0]),
        ];
        for (t, expected) in cases {
            let got = [&spline, &linear, &step].map(|sampler| sampler.number(t, 0));
            for (got, expected) in got.iter().zip(expected) {
                assert!((got - expected).abs() < 1e-14, "at {t}: got {got:?}, expected {expected:?}");
            }
        }
    }

    #[test]
    fn several_numbers_a_key_stay_apart() {
        let keys = [0.0, 1.0];
        // Two numbers: tangents in, values, tangents out.
        let values = [0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 6.0, 0.0, 0.0];
        let spline = sampler(Interpolation::CubicSpline, 2, &keys, &values);
        assert_eq!([0, 1].map(|k| spline.number(0.5, k)), [2.0, 4.0]);
    }

    #[test]
    fn rotations_take_the_shorter_arc_and_splines_are_made_unit() {
        let quarter = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
        let (from, to) = ([0.0, 0.0, 0.0, 1.0], (-quarter).to_array());
        let linear = sampler(Interpolation::Linear, 4, &[0.0, 1.0], &[from, to].concat());
        let expected = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2 / 3.0);
        let got = linear.rotation(1.0 / 3.0);
        assert!(got.abs_diff_eq(expected, 1e-14), "got {got}, expected {expected}");
        // Without tangents the middle of a spline is the middle of the components, whatever their signs.
        let zero = [0.0; 4];
        let values = [zero, from, zero, zero, to, zero].concat();
        let spline = sampler(Interpolation::CubicSpline, 4, &[0.0, 1.0], &values);
        let expected = (DQuat::IDENTITY + -quarter).normalize();
        let got = spline.rotation(0.5);
        assert!(got.abs_diff_eq(expected, 1e-14), "got {got}, expected {expected}");
    }

    #[test]
    fn a_time_given_twice_is_a_jump() {
        let linear = sampler(Interpolation::Linear, 1, &[0.0, 1.0, 1.0, 2.0], &[0.0, 1.0, 5.0, 6.0]);
        assert_eq!([0.5, 1.0, 1.5].map(|t| linear.number(t, 0)), [0.5, 5.0, 5.5]);
    }
}
