//! Curves in a coordinate system, as SVG: a dozen lines of text that every browser draws.

use std::fmt::Write as _;

/// Size of the whole, and the room that labels need around the axes, in pixels (by eye).
const SIZE: [f64; 2] = [560.0, 340.0];
const LEFT: f64 = 64.0;
const RIGHT: f64 = 26.0;
const TOP: f64 = 16.0;
const BOTTOM: f64 = 48.0;
/// Colors of curves that differ for all eyes: dark blue, orange, green, magenta, brown (by eye).
const COLORS: [&str; 5] = ["#1f4fa8", "#e07b1a", "#2f9e6e", "#b0337a", "#7a5a3a"];

/// How an axis counts.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Scale {
    Even,
    /// Every step is ten times the one before, or a part of that.
    Logarithmic,
}

/// An axis with its label.
pub(crate) struct Axis {
    pub(crate) label: &'static str,
    pub(crate) scale: Scale,
}

/// A curve with its name in the legend.
pub(crate) struct Curve {
    pub(crate) name: String,
    pub(crate) points: Vec<[f64; 2]>,
    /// Points themselves are shown, too.
    pub(crate) dotted: bool,
}

/// A coordinate system.
pub(crate) struct Chart {
    pub(crate) axes: [Axis; 2],
    pub(crate) curves: Vec<Curve>,
}

impl Chart {
    /// The picture. Points that a logarithmic axis cannot show are left out.
    pub(crate) fn to_svg(&self) -> String {
        let spans: [Span; 2] = [0, 1].map(|k| Span::new(self.axes[k].scale, self.visible().map(|point| point[k])));
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" \
             font-family=\"sans-serif\" font-size=\"12\" fill=\"#333\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
            SIZE[0], SIZE[1]
        );
        let [x, y] =
            [|x: f64| LEFT + x * (SIZE[0] - LEFT - RIGHT), |y: f64| SIZE[1] - BOTTOM - y * (SIZE[1] - TOP - BOTTOM)];
        self.draw_axes(&mut svg, &spans, [&x, &y]);
        for (curve, color) in self.curves.iter().zip(COLORS.iter().cycle()) {
            let place = |&[a, b]: &[f64; 2]| [x(spans[0].part(a)), y(spans[1].part(b))];
            let places: Vec<[f64; 2]> = curve.points.iter().filter(|point| self.shows(point)).map(place).collect();
            let list: Vec<String> = places.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
            put(
                &mut svg,
                format_args!(
                    "<polyline fill=\"none\" stroke=\"{color}\" stroke-width=\"1.8\" points=\"{}\"/>",
                    list.join(" ")
                ),
            );
            for [x, y] in places.iter().filter(|_| curve.dotted) {
                put(&mut svg, format_args!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.8\" fill=\"{color}\"/>"));
            }
        }
        self.draw_legend(&mut svg);
        svg.push_str("</svg>\n");
        svg
    }

    fn shows(&self, point: &[f64; 2]) -> bool {
        let fits = |k: usize| point[k].is_finite() && (self.axes[k].scale == Scale::Even || point[k] > 0.0);
        fits(0) && fits(1)
    }

    fn visible(&self) -> impl Iterator<Item = [f64; 2]> {
        self.curves.iter().flat_map(|curve| curve.points.iter().copied()).filter(|point| self.shows(point))
    }

    fn draw_axes(&self, svg: &mut String, spans: &[Span; 2], [x, y]: [&dyn Fn(f64) -> f64; 2]) {
        for tick in spans[0].ticks() {
            let (at, low) = (x(spans[0].part(tick)), y(0.0));
            put(svg, format_args!("<path d=\"M{at:.1} {:.1}V{low:.1}\" stroke=\"#e4e4e8\"/>", y(1.0)));
            put(
                svg,
                format_args!(
                    "<text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                    low + 17.0,
                    short(tick)
                ),
            );
        }
        for tick in spans[1].ticks() {
            let (at, left) = (y(spans[1].part(tick)), x(0.0));
            put(svg, format_args!("<path d=\"M{left:.1} {at:.1}H{:.1}\" stroke=\"#e4e4e8\"/>", x(1.0)));
            put(
                svg,
                format_args!(
                    "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                    left - 7.0,
                    at + 4.0,
                    short(tick)
                ),
            );
        }
        put(
            svg,
            format_args!(
                "<path d=\"M{0:.1} {1:.1}V{2:.1}H{3:.1}\" fill=\"none\" stroke=\"#555\"/>",
                x(0.0),
                y(1.0),
                y(0.0),
                x(1.0)
            ),
        );
        let middle = [x(0.5), y(0.5)];
        put(
            svg,
            format_args!(
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                middle[0],
                SIZE[1] - 10.0,
                self.axes[0].label
            ),
        );
        put(
            svg,
            format_args!(
                "<text transform=\"translate(16 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
                middle[1], self.axes[1].label
            ),
        );
    }

    /// Top right, where falling curves are not.
    fn draw_legend(&self, svg: &mut String) {
        for (row, (curve, color)) in self.curves.iter().zip(COLORS.iter().cycle()).enumerate() {
            let y = TOP + 16.0 + 18.0 * row as f64;
            let right = SIZE[0] - RIGHT - 10.0;
            put(
                svg,
                format_args!(
                    "<path d=\"M{:.1} {1:.1}H{right:.1}\" stroke=\"{color}\" stroke-width=\"2.4\"/>",
                    right - 22.0,
                    y - 4.0
                ),
            );
            put(
                svg,
                format_args!("<text x=\"{:.1}\" y=\"{y:.1}\" text-anchor=\"end\">{}</text>", right - 28.0, curve.name),
            );
        }
    }
}

/// A line of the file. A string takes whatever is written to it.
fn put(svg: &mut String, line: std::fmt::Arguments<'_>) {
    let _ = writeln!(svg, "{line}");
}

/// From where to where an axis goes.
struct Span {
    scale: Scale,
    from: f64,
    to: f64,
    step: f64,
}

impl Span {
    /// Wide enough for the values, with ends and steps that are short numbers.
    fn new(scale: Scale, values: impl Iterator<Item = f64>) -> Span {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (1.0, 1.0) };
        if scale == Scale::Logarithmic {
            let (from, to) = (low.log10().floor(), high.log10().ceil());
            return Span { scale, from, to: to.max(from + 1.0), step: 1.0 };
        }
        let low = low.min(0.0);
        let reach = if high > low { high - low } else { 1.0 };
        let power = 10_f64.powf((reach / 5.0).log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|step| step * power).into_iter().find(|step| reach / step <= 6.0);
        let step = step.unwrap_or(power);
        Span { scale, from: low, to: (high / step).ceil().max(1.0) * step, step }
    }

    /// How far along the axis a value lies, from 0 to 1.
    fn part(&self, value: f64) -> f64 {
        let value = if self.scale == Scale::Logarithmic { value.log10() } else { value };
        (value - self.from) / (self.to - self.from)
    }

    fn ticks(&self) -> Vec<f64> {
        let n = ((self.to - self.from) / self.step).round() as usize;
        let at = |i: usize| self.from + i as f64 * self.step;
        (0..=n).map(|i| if self.scale == Scale::Logarithmic { 10_f64.powf(at(i)) } else { at(i) }).collect()
    }
}

/// A number without needless digits.
fn short(value: f64) -> String {
    if value != 0.0 && (value.abs() >= 1e6 || value.abs() < 1e-3) {
        return format!("{value:.0e}");
    }
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(scale: Scale, points: Vec<[f64; 2]>) -> String {
        let axes = [Axis { label: "x", scale: Scale::Even }, Axis { label: "y", scale }];
        Chart { axes, curves: vec![Curve { name: "curve".to_owned(), points, dotted: true }] }.to_svg()
    }

    #[test]
    fn axes_hold_all_values_between_short_numbers() {
        let span = Span::new(Scale::Even, [1.0, 507.0].into_iter());
        assert_eq!((span.from, span.to, span.step), (0.0, 600.0, 100.0));
        let span = Span::new(Scale::Logarithmic, [0.3, 507.0].into_iter());
        assert_eq!(span.ticks(), [0.1, 1.0, 10.0, 100.0, 1000.0]);
        assert!((span.part(10.0) - 0.5).abs() < 1e-12);
        assert_eq!([0.0, 0.25, 600.0, 1e-5].map(short), ["0", "0.25", "600", "1e-5"]);
    }

    #[test]
    fn what_an_axis_cannot_show_is_left_out() {
        let svg = chart(Scale::Logarithmic, vec![[0.0, 0.0], [1.0, 1.0], [2.0, f64::NAN], [3.0, 100.0]]);
        assert_eq!(svg.matches("<circle").count(), 2, "{svg}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(!chart(Scale::Even, Vec::new()).contains("NaN"), "nothing at all");
    }
}
