//! Many numbers as a few: how large they are in the middle and at worst, and histograms.
//!
//! Histograms can be compared only over the same axis, and which axis holds all surfaces is known only when the last one is
//! bent. So each [`Spread`] counts for every end that its [`Ruler`] offers; nothing is kept of the numbers themselves.

/// The axes that histograms of one measure may have: each from 0, or from the negative end, to one of these ends.
#[derive(Debug)]
pub struct Ruler {
    ends: &'static [f64],
    bins: usize,
    is_signed: bool,
}

/// Ratios of length that an axis of [`Ruler::stretch`] may end at, as in the editor's legend.
const RATIOS: [f64; 9] = [1.02, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0];

/// Their logarithms.
static LOGARITHMS: std::sync::LazyLock<[f64; 9]> = std::sync::LazyLock::new(|| RATIOS.map(f64::ln));

/// The part of the numbers that an axis covers at least; the rest is counted at its ends.
const COVERED: f64 = 0.999;
/// *Worst* is what this part of the numbers stays below: single broken edges say little about a method.
const NEARLY_ALL: f64 = 0.99;

impl Ruler {
    /// Logarithms of ratios of length: both ways, with a bin in the middle for what is unchanged.
    pub fn stretch() -> Ruler {
        Ruler { ends: &*LOGARITHMS, bins: 41, is_signed: true }
    }

    /// Degrees of changes of angles.
    pub fn bending() -> Ruler {
        Ruler { ends: &[1.0, 2.0, 5.0, 10.0, 20.0, 45.0, 90.0, 180.0], bins: 40, is_signed: false }
    }

    /// Where the axis of all these spreads ends: as near as holds nearly all of each.
    pub fn common<'a>(&self, spreads: impl Iterator<Item = &'a Spread>) -> Axis {
        let scale = spreads.map(|spread| spread.scale).max().unwrap_or_default();
        Axis { scale, end: self.ends[scale], is_signed: self.is_signed }
    }

    fn bin(&self, value: f64, end: f64) -> usize {
        let part = if self.is_signed { 0.5 + 0.5 * value / end } else { value / end };
        // What is beyond the ends belongs to the last bins.
        ((part * self.bins as f64).max(0.0) as usize).min(self.bins - 1)
    }
}

/// An axis for several histograms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    scale: usize,
    /// Its last value.
    pub end: f64,
    /// Whether it begins at `-end` rather than at 0.
    pub is_signed: bool,
}

/// What is known of many numbers.
#[derive(Clone, Debug)]
pub struct Spread {
    /// How many numbers there were.
    pub count: usize,
    /// Mean of their magnitudes; 0 for none.
    pub mean: f64,
    /// What 99 % of their magnitudes do not exceed; 0 for none.
    pub worst: f64,
    /// Counts by bin, for every end of the ruler.
    counts: Vec<Vec<u64>>,
    /// The first end that holds nearly all.
    scale: usize,
}

impl Spread {
    /// Counts finite numbers.
    pub fn new(ruler: &Ruler, mut values: Vec<f64>) -> Spread {
        let mut counts = vec![vec![0; ruler.bins]; ruler.ends.len()];
        for &value in &values {
            for (counts, &end) in counts.iter_mut().zip(ruler.ends) {
                counts[ruler.bin(value, end)] += 1;
            }
        }
        values.iter_mut().for_each(|value| *value = value.abs());
        let count = values.len();
        let mean = values.iter().sum::<f64>() / count.max(1) as f64;
        let reached = quantile(&mut values, COVERED);
        let scale = ruler.ends.iter().position(|&end| end >= reached).unwrap_or(ruler.ends.len() - 1);
        Spread { count, mean, worst: quantile(&mut values, NEARLY_ALL), counts, scale }
    }

    /// The part of the numbers in each bin of the axis; what is beyond its ends is in the outermost bins.
    pub fn shares(&self, axis: &Axis) -> Vec<f64> {
        let count = self.count.max(1) as f64;
        self.counts[axis.scale].iter().map(|&n| n as f64 / count).collect()
    }
}

/// The value that this part of all values does not exceed; 0 for none. Leaves them in another order.
fn quantile(values: &mut [f64], part: f64) -> f64 {
    let Some(last) = values.len().checked_sub(1) else { return 0.0 };
    let rank = ((values.len() as f64 * part) as usize).min(last);
    *values.select_nth_unstable_by(rank, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_worst_are_those_of_the_magnitudes() {
        let values = (0..1000).map(|i| if i % 2 == 0 { f64::from(i) } else { -f64::from(i) } / 1000.0).collect();
        let spread = Spread::new(&Ruler::stretch(), values);
        assert_eq!((spread.count, spread.worst), (1000, 0.99));
        assert!((spread.mean - 0.4995).abs() < 1e-12, "{}", spread.mean);
        let none = Spread::new(&Ruler::bending(), Vec::new());
        assert_eq!((none.count, none.mean, none.worst), (0, 0.0, 0.0));
        assert!(none.shares(&Ruler::bending().common([&none].into_iter())).iter().all(|&share| share == 0.0));
    }

    #[test]
    fn the_common_axis_holds_the_widest_and_every_number_is_in_a_bin() {
        let ruler = Ruler::bending();
        let of = |value: f64| Spread::new(&ruler, vec![value; 10]);
        let spreads = [of(0.5), of(7.0), of(0.0)];
        let axis = ruler.common(spreads.iter());
        assert_eq!((axis.end, axis.is_signed), (10.0, false));
        // 40 bins of a quarter of a degree.
        for (spread, bin) in spreads.iter().zip([2, 28, 0]) {
            let shares = spread.shares(&axis);
            assert_eq!((shares.len(), shares.iter().sum::<f64>(), shares[bin]), (40, 1.0, 1.0));
        }
        assert_eq!(ruler.common([of(400.0)].iter()).end, 180.0, "and what is beyond all axes, at the end of the last");
    }

    #[test]
    fn what_is_unchanged_lies_in_the_middle_and_single_numbers_do_not_widen_the_axis() {
        let ruler = Ruler::stretch();
        let mut values = vec![0.0; 5000];
        values[7] = -40.0;
        let spread = Spread::new(&ruler, values);
        let axis = ruler.common([&spread].into_iter());
        assert_eq!(axis.end, 1.02_f64.ln());
        let shares = spread.shares(&axis);
        assert_eq!((shares[20], shares[0]), (4999.0 / 5000.0, 1.0 / 5000.0));
    }
}
