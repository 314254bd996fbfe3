//! Numbers and entries in words.

use crate::cli::args::Way;

use super::super::facts::{EntryFacts, Facts};

/// What an entry is called; `file`: where its rigidity is from.
pub(super) fn title(entry: &EntryFacts, file: Option<&str>) -> String {
    match (&entry.way, file) {
        (Way::Rring(_), Some(file)) => format!("Rigidity from {file}"),
        (Way::Rring(None), None) if entry.is_painted => "Rigidity of the mesh".into(),
        (Way::Rring(_), None) => {
            let r = entry.rigidity.map_or(1, |rigidity| rigidity.max());
            format!("Rigidity {r} everywhere")
        }
        (Way::Arap, _) => "ARAP".into(),
        (Way::SrArap { alpha }, _) => format!("SR-ARAP, α\u{a0}=\u{a0}{alpha}"),
        (Way::Embedded { nodes, node_neighbors }, _) => {
            format!("Embedded, {} nodes, {node_neighbors} a vertex", whole(*nodes))
        }
    }
}

pub(super) fn weights(name: &str) -> &'static str {
    match name {
        "cotangent" => "cotangents as they are",
        "uniform" => "1 for every edge",
        _ => "cotangents, slivers and negative ones tamed",
    }
}

pub(super) fn solver(name: &str) -> &'static str {
    match name {
        "local-global" => "local and global steps in turn (embedded: Gauss–Newton)",
        _ => "L-BFGS over local and global steps (embedded: Gauss–Newton)",
    }
}

pub(super) fn start(name: &str) -> &'static str {
    match name {
        "rest" => "every rotation the identity",
        _ => "the best of several",
    }
}

/// When iterations end.
pub(super) fn end(facts: &Facts) -> String {
    let most = whole(facts.max_iterations as usize);
    match facts.tolerance {
        0.0 => format!("after {most} iterations"),
        tolerance => {
            format!("when the energy falls by less than {} %, or after {most} iterations", number(100.0 * tolerance))
        }
    }
}

/// A number with its noun.
pub(super) fn count(n: usize, one: &str, several: &str) -> String {
    format!("{} {}", whole(n), if n == 1 { one } else { several })
}

/// A whole number, with thin spaces between thousands.
pub(super) fn whole(n: usize) -> String {
    let digits = n.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().map(|group| std::str::from_utf8(group).unwrap_or_default()).collect();
    groups.join("\u{202f}")
}

/// Milliseconds as one reads times.
pub(super) fn time(ms: f64) -> String {
    match ms {
        ..0.1 => "0 ms".to_owned(),
        0.1..10.0 => format!("{ms:.1} ms"),
        10.0..999.5 => format!("{ms:.0} ms"),
        _ if ms < 99_950.0 => format!("{:.1} s", ms / 1e3),
        _ => format!("{:.0} s", ms / 1e3),
    }
}

/// Four significant digits, with a power of ten where there would be many zeros.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{value:.3e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let power: i32 = exponent.parse().unwrap_or_default();
    if !(-3..5).contains(&power) {
        let raised: String = exponent.chars().map(raised).collect();
        return format!("{mantissa} × 10{raised}");
    }
    let digits = usize::try_from(3 - power).unwrap_or_default();
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn raised(c: char) -> char {
    match c {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        // 4 to 9 follow each other.
        _ => c.to_digit(10).and_then(|digit| char::from_u32('⁰' as u32 + digit)).unwrap_or(c),
    }
}

/// A part of a hundred, with as many digits as say something.
pub(super) fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    match percent.abs() {
        0.0 => "0 %".to_owned(),
        ..0.01 => "< 0.01 %".to_owned(),
        0.01..1.0 => format!("{percent:.2} %"),
        1.0..100.0 => format!("{percent:.1} %"),
        _ => format!("{} %", number(percent)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_read_easily() {
        let shown = [0.0, 1.0, 0.00123456, 12345.678, 123456.0, -1.5e-7, 6.02e23, 0.5].map(number);
        assert_eq!(shown, ["0", "1", "0.001235", "12346", "1.235 × 10⁵", "-1.500 × 10⁻⁷", "6.020 × 10²³", "0.5"]);
        assert_eq!([7, 1000, 1_234_567].map(whole), ["7", "1\u{202f}000", "1\u{202f}234\u{202f}567"]);
        assert_eq!([0.0, 3.21, 321.4, 4321.0, 123_456.0].map(time), ["0 ms", "3.2 ms", "321 ms", "4.3 s", "123 s"]);
        assert_eq!([0.0, 1e-5, 0.00123, 0.12345, 3.0].map(percent), ["0 %", "< 0.01 %", "0.12 %", "12.3 %", "300 %"]);
        assert_eq!([count(1, "way", "ways"), count(5, "way", "ways")], ["1 way", "5 ways"]);
    }
}
