//! OBJ files that ask for much with few bytes, or repeat something many times.

use super::{Case, Expected};
use std::fmt::Write;

pub(super) fn cases() -> Vec<Case> {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let case = |name: &str, text: String, expected: Expected| Case::new(format!("obj {name}"), "obj", text, expected);
    let many = |line: &str, n: usize| format!("{vertices}{}f 1 2 3\n", line.repeat(n));
    vec![
        case("polygon of the most corners", ring(65_536), 65_536.into()),
        case("polygon of too many corners", ring(65_537), "65537 corners of one polygon are more than".into()),
        case("polygon without an ear", polygon(5_000, spiral), 5_000.into()),
        case("polygon like a comb", polygon(5_000, comb), 5_000.into()),
        case("polygon like a star", polygon(5_000, star), 5_000.into()),
        case("many polygons like combs", combs(40, 1_500), 60_000.into()),
        case("polygon of one place", polygon(5_000, |_| [1.0, 1.0]), 5_000.into()),
        case("polygon beyond numbers", polygon(500, |i| [1e308 * f64::from(i % 3 - 1), 1e308]), 500.into()),
        case("a hundred thousand groups", groups("g", 100_000), 3.into()),
        case("a hundred thousand materials", groups("usemtl", 100_000), 3.into()),
        case("a hundred thousand names without faces", many("g a\no b\nusemtl c\n", 100_000), 3.into()),
        case("a hundred thousand libraries", many("mtllib a.mtl b.mtl\n", 100_000), 3.into()),
        case("a hundred thousand faces of one place", many("f 1 1 1\n", 100_000), 3.into()),
        case("a hundred thousand times the same face", many("f 1 2 3\n", 100_000), 3.into()),
        case("a million blanks", many(&" ".repeat(1_000_000), 1), 3.into()),
        case("a million line ends", many("\n", 1_000_000), 3.into()),
        case("a comment of ten million characters", many(&format!("#{}\n", "x".repeat(10_000_000)), 1), 3.into()),
        case("a word of a million digits", many(&format!("v {} 0 0\n", "1".repeat(1_000_000)), 1), "not finite".into()),
        case("a fraction of a million digits", many(&format!("v 0.{} 0 0\n", "1".repeat(1_000_000)), 1), 4.into()),
        case("long names on many faces", long_names(2_000), 3.into()),
    ]
}

fn ring(n: u32) -> String {
    polygon(n, |i| {
        let angle = f64::from(i) / 10_000.0;
        [angle.cos(), angle.sin()]
    })
}

/// One polygon with corners at given places.
fn polygon(n: u32, place: impl Fn(i32) -> [f64; 2]) -> String {
    let mut text = String::new();
    for i in 0..n as i32 {
        let [x, y] = place(i);
        writeln!(text, "v {x} {y} 0").expect("strings can be written");
    }
    text.push('f');
    (1..=n).for_each(|i| write!(text, " {i}").expect("strings can be written"));
    text.push('\n');
    text
}

/// Winds inwards, so that nearly every corner hides another.
fn spiral(i: i32) -> [f64; 2] {
    let (angle, radius) = (f64::from(i) * 0.7, 1.0 / (1.0 + f64::from(i)));
    [radius * angle.cos(), radius * angle.sin()]
}

fn comb(i: i32) -> [f64; 2] {
    [f64::from(i), if i % 2 == 0 { 0.0 } else { 100.0 + f64::from(i % 7) }]
}

fn star(i: i32) -> [f64; 2] {
    let (angle, radius) = (f64::from(i) * 2.4, 1.0 + f64::from(i % 2));
    [radius * angle.cos(), radius * angle.sin()]
}

fn combs(n: usize, corners: u32) -> String {
    let one = polygon(corners, comb);
    let (vertices, _) = one.split_once('f').expect("a polygon has a face");
    let face: String = (1..=corners).map(|i| format!(" -{i}")).collect();
    format!("{vertices}f{face}\n").repeat(n)
}

fn groups(keyword: &str, n: usize) -> String {
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    for i in 0..n {
        writeln!(text, "{keyword} {i}\nf 1 2 3").expect("strings can be written");
    }
    text
}

/// Names that would take gigabytes if each face kept its own.
fn long_names(n: usize) -> String {
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    let name = "n".repeat(10_000);
    for i in 0..n {
        writeln!(text, "g {name}{i}\nf 1 2 3").expect("strings can be written");
    }
    text
}
