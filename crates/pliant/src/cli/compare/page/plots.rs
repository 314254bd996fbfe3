//! Plots as SVG within the page: colors come from the style sheet, sizes from the space there is.

use std::fmt::Write;

use maud::{Markup, html};

use super::COLORS;
use super::words::number;
use crate::viewport::{energy_color, rigidity_color};

/// Points of a curve at most: more than there are pixels would only make the file larger.
const MOST_POINTS: usize = 300;

/// Parts below this are not told apart (of histograms), nor energies that are above their end by less (of curves).
const LEAST: f64 = 1e-4;

/// Curves begin at this many times their end at most.
const MOST_EXCESS: f64 = 1e4;

/// The place of the axes within a plot, in its own units.
struct Frame {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

impl Frame {
    /// From parts of the width and height, counted from the lower left corner.
    fn at(&self, x: f64, y: f64) -> (f64, f64) {
        (self.left + self.width * x.clamp(0.0, 1.0), self.top + self.height * (1.0 - y.clamp(0.0, 1.0)))
    }

    /// A line across with its label on the left.
    fn level(&self, y: f64, label: &str) -> Markup {
        let (x, y) = self.at(0.0, y);
        html! {
            line.grid x1=(x) x2=(x + self.width) y1=(short(y)) y2=(short(y)) {}
            text x=(x - 6.0) y=(short(y + 4.0)) text-anchor="end" { (label) }
        }
    }

    /// A mark at the bottom with its label below.
    fn tick(&self, x: f64, label: &str) -> Markup {
        let (x, y) = self.at(x, 0.0);
        html! {
            line.axis x1=(short(x)) x2=(short(x)) y1=(y) y2=(y + 4.0) {}
            text x=(short(x)) y=(y + 17.0) text-anchor="middle" { (label) }
        }
    }

    fn baseline(&self) -> Markup {
        let (x, y) = self.at(0.0, 0.0);
        html! { line.axis x1=(x) x2=(x + self.width) y1=(y) y2=(y) {} }
    }
}

/// A tenth of a unit is less than can be seen.
fn short(value: f64) -> String {
    format!("{value:.1}")
}

/// Energies above their end, as a part of it, by iteration, all on logarithmic axes.
pub(super) fn convergence(curves: &[(usize, &[f64])]) -> Markup {
    let frame = Frame { left: 62.0, top: 12.0, width: 640.0, height: 250.0 };
    let most = curves.iter().map(|(_, energies)| energies.len()).max().unwrap_or(1).max(2);
    let excesses = || curves.iter().flat_map(|(_, energies)| energies.iter().filter_map(|&e| excess(e, energies)));
    let top = excesses().fold(0.1, f64::max).clamp(LEAST, MOST_EXCESS).log10().ceil();
    let bottom = LEAST.log10();
    let height = |part: f64| (part.max(LEAST).log10() - bottom) / (top - bottom);
    let x = |iteration: usize| (iteration as f64).ln() / (most as f64).ln();
    let decades = (bottom as i32..=top as i32).map(|power| (f64::from(power), percent_of_ten(power)));
    html! {
        svg viewBox="0 0 720 310" role="img" aria-label="Energy above its end, by iteration" {
            @for (power, label) in decades { (frame.level((power - bottom) / (top - bottom), &label)) }
            @for iteration in round_numbers(most) { (frame.tick(x(iteration), &iteration.to_string())) }
            (frame.baseline())
            text x=(frame.left + frame.width / 2.0) y="304" text-anchor="middle" { "iteration" }
            @for &(k, energies) in curves {
                @let points: Vec<(f64, f64)> = some(energies.len())
                    .filter_map(|i| Some(frame.at(x(i + 1), height(excess(energies[i], energies)?))))
                    .collect();
                g class=(series(k)) {
                    path.curve d=(path(&points)) {}
                    @if let Some((x, y)) = points.last() { circle cx=(short(*x)) cy=(short(*y)) r="3.5" {} }
                }
            }
        }
    }
}

/// How far an energy is above the last one, as a part of it; none where it ended at nothing.
fn excess(energy: f64, energies: &[f64]) -> Option<f64> {
    let end = energies.last().copied()?;
    let excess = (energy - end) / end.abs();
    (excess.is_finite()).then_some(excess.max(0.0))
}

/// Indices of a curve with so many points, at most [`MOST_POINTS`] of them, denser at the beginning; the last is among them.
fn some(n: usize) -> impl Iterator<Item = usize> {
    let exponent = |k: usize| k as f64 / (MOST_POINTS - 1) as f64;
    let place = move |k: usize| ((n as f64).powf(exponent(k)).round() as usize).clamp(1, n.max(1)) - 1;
    let mut places: Vec<usize> =
        if n <= MOST_POINTS { (0..n).collect() } else { (0..MOST_POINTS).map(place).collect() };
    places.dedup();
    places.into_iter()
}

/// 1, 2, 5, 10, 20 … up to a number.
fn round_numbers(most: usize) -> impl Iterator<Item = usize> {
    let decades = (0..12).map(|power| 10_usize.pow(power));
    decades.flat_map(|decade| [1, 2, 5].map(|digit| digit * decade)).take_while(move |&n| n <= most)
}

/// A power of ten in percent.
fn percent_of_ten(power: i32) -> String {
    format!("{} %", number(100.0 * 10_f64.powi(power)))
}

fn path(points: &[(f64, f64)]) -> String {
    let mut text = String::new();
    for (k, (x, y)) in points.iter().enumerate() {
        let _ = write!(text, "{}{x:.1} {y:.1}", if k == 0 { 'M' } else { 'L' });
    }
    text
}

/// The axes of a row of histograms.
pub(super) struct Histogram {
    /// Part of the width, and what stands there.
    ticks: Vec<(f64, String)>,
    unit: &'static str,
}

impl Histogram {
    /// Ratios of length whose logarithm goes from `-end` to `end`.
    pub(super) fn stretch(end: f64) -> Histogram {
        let tick = |part: f64| (0.5 + 0.5 * part, format!("×{}", number_of((end * part).exp())));
        Histogram { ticks: [-1.0, -0.5, 0.0, 0.5, 1.0].map(tick).into(), unit: "length, compared with that at rest" }
    }

    /// Degrees up to `end`.
    pub(super) fn bending(end: f64) -> Histogram {
        // Into parts that are round numbers of degrees.
        let parts = match end {
            45.0.. => 3,
            5.0..=10.0 => 5,
            _ => 4,
        };
        let tick = |k: u32| {
            (f64::from(k) / f64::from(parts), format!("{}°", number_of(end * f64::from(k) / f64::from(parts))))
        };
        Histogram { ticks: (0..=parts).map(tick).collect(), unit: "change of the angle" }
    }

    /// Bars for parts of the whole, on a logarithmic scale.
    pub(super) fn draw(&self, k: usize, shares: &[f64], of: &str) -> Markup {
        let frame = Frame { left: 52.0, top: 10.0, width: 254.0, height: 128.0 };
        let bottom = LEAST.log10();
        let height = |share: f64| if share > 0.0 { 1.0 - share.max(LEAST).log10() / bottom } else { 0.0 };
        let step = 1.0 / shares.len().max(1) as f64;
        let bars = shares.iter().enumerate().filter(|(_, share)| **share > 0.0).map(|(bin, &share)| {
            // The smallest bar is still seen.
            let (left, top) = frame.at(bin as f64 * step, height(share).max(0.012));
            let (right, base) = frame.at((bin + 1) as f64 * step, 0.0);
            format!("M{left:.1} {base:.1}V{top:.1}H{:.1}V{base:.1}Z", right - 0.6)
        });
        html! {
            svg viewBox="0 0 320 190" role="img" aria-label=(format!("{}: {of}", self.unit)) {
                @for power in bottom as i32..=0 {
                    (frame.level(1.0 - f64::from(power) / bottom, &percent_of_ten(power)))
                }
                g class=(series(k)) { path.bars d=(bars.collect::<String>()) {} }
                @for (x, label) in &self.ticks { (frame.tick(*x, label)) }
                (frame.baseline())
                text x=(frame.left + frame.width / 2.0) y="184" text-anchor="middle" { (self.unit) }
            }
        }
    }
}

/// At most two decimals.
fn number_of(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The class of an entry's color; from the second round on its curves are dashed.
fn series(k: usize) -> String {
    let color = k % COLORS;
    match k / COLORS {
        0 => format!("series s{color}"),
        round => format!("series s{color} dash{}", (round - 1) % 2 + 1),
    }
}

/// A small line in an entry's color.
pub(super) fn swatch(k: usize) -> Markup {
    html! {
        svg.swatch viewBox="0 0 22 10" aria-hidden="true" {
            g class=(series(k)) { path.curve d="M1 5H21" {} }
        }
    }
}

/// What the colors of strain stand for.
pub(super) fn energy_legend(end: f64) -> Markup {
    let colors = (0..=16_u8).map(|k| energy_color(f32::from(k) / 16.0));
    let label = format!("{} and more (the most strained vertices of all entries)", number(end));
    html! { p.ramp { "0 " (band(colors.collect())) " " (label) } }
}

/// What the colors of rigidity stand for.
pub(super) fn rigidity_legend(most: u16) -> Markup {
    let color = |k: u16| rigidity_color((1.0 + f32::from(most - 1) * f32::from(k) / 16.0).round() as u16, most);
    html! { p.ramp { "r = 1 (soft) " (band((0..=16).map(color).collect())) " r = " (most) " (stiff)" } }
}

fn band(colors: Vec<[u8; 3]>) -> Markup {
    let width = 160.0 / colors.len() as f64;
    html! {
        svg viewBox="0 0 160 12" aria-hidden="true" {
            @for (k, [r, g, b]) in colors.iter().enumerate() {
                // A little wider: no seams between them.
                rect x=(short(k as f64 * width)) y="0" width=(short(width + 0.5)) height="12" fill={ "rgb(" (r) "," (g) "," (b) ")" } {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_keep_their_ends_however_long_they_are() {
        for n in [0, 1, 2, 300, 301, 5000, 1_000_000] {
            let places: Vec<usize> = some(n).collect();
            assert!(places.len() <= MOST_POINTS && places.is_sorted_by(|a, b| a < b), "{n}");
            assert_eq!(
                (places.first().copied(), places.last().copied()),
                ((n > 0).then_some(0), n.checked_sub(1)),
                "{n}"
            );
        }
    }

    #[test]
    fn an_energy_that_ended_at_nothing_has_no_curve_and_a_negative_one_has() {
        assert_eq!(excess(1.0, &[1.0, 0.0]), None);
        assert_eq!(excess(0.0, &[0.0]), None);
        assert_eq!(excess(3.0, &[3.0, 2.0]), Some(0.5));
        assert_eq!(excess(-1.0, &[-1.0, -2.0]), Some(0.5));
    }

    #[test]
    fn plots_of_nothing_are_drawn() {
        for curves in [&[][..], &[(0, &[][..])], &[(0, &[0.0][..])], &[(9, &[1e300, 1e-300][..])]] {
            let drawn = convergence(curves).into_string();
            assert!(drawn.starts_with("<svg") && !drawn.contains("NaN") && !drawn.contains("inf"), "{drawn}");
        }
        let drawn = Histogram::bending(45.0).draw(0, &[0.0, 1.0], "nothing").into_string();
        assert!(drawn.contains("45°") && drawn.contains("class=\"bars\"") && !drawn.contains("NaN"));
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(round_numbers(60).collect::<Vec<_>>(), [1, 2, 5, 10, 20, 50]);
        assert_eq!([percent_of_ten(-4), percent_of_ten(0), percent_of_ten(2)], ["0.01 %", "100 %", "10000 %"]);
    }
}
