//! STL files: text and bytes, and which of the two they are.

use super::{Case, Expected};

fn case(name: impl AsRef<str>, bytes: impl Into<Vec<u8>>, expected: impl Into<Expected>) -> Case {
    Case::new(format!("stl {}", name.as_ref()), "stl", bytes, expected)
}

const FACET: &str = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

fn text(facets: &str) -> String {
    format!("solid a\n{facets}endsolid a\n")
}

/// A file of bytes that says it has `count` triangles and has `n`.
fn bytes(header: &[u8], count: u32, n: usize, x: f32) -> Vec<u8> {
    let mut file = header.to_vec();
    file.resize(80, 0);
    file.extend(count.to_le_bytes());
    for _ in 0..n {
        for number in [0., 0., 1., x, 0., 0., 1., 0., 0., 0., 1., 0.] {
            file.extend(number.to_le_bytes());
        }
        file.extend([7, 0]);
    }
    file
}

pub(super) fn cases() -> Vec<Case> {
    [texts(), binaries()].concat()
}

fn texts() -> Vec<Case> {
    let sound = text(FACET);
    let with = |from: &str, to: &str| sound.replacen(from, to, 1);
    let mut cases = vec![
        case("text, sound", sound.clone(), 3),
        case("text in upper case", sound.to_uppercase(), 3),
        case("text with CR", sound.replace('\n', "\r"), 3),
        case("text with CR LF", sound.replace('\n', "\r\n"), 3),
        case("text on one line", sound.replace('\n', " "), ""),
        case("text with a mark", format!("\u{feff}{sound}"), 3),
        case("text after blanks", format!(" \n\t{sound}"), 3),
        case("text of two solids", format!("{sound}{sound}"), 6),
        case("text of a thousand solids", sound.repeat(1_000), 3_000),
        case("text without a name", with("solid a", "solid"), 3),
        case("text without an end", with("endsolid a\n", ""), 3),
        case("text with bytes that are no text", [b"solid \xff\xfe\n".as_slice(), FACET.as_bytes()].concat(), 3),
        case(
            "text with a name of a million characters",
            with("solid a", &format!("solid {}", "a".repeat(1_000_000))),
            3,
        ),
        case("text that names a facet", with("solid a", "solid facet normal"), 3),
        case("text without facets", text(""), "holds no faces"),
        case("text of one word", "solid", "holds no faces"),
        case("text with a facet of four corners", with("endloop", "vertex 1 1 0\nendloop"), "more than three corners"),
        case("text with a facet of two corners", with("vertex 0 1 0\n", ""), "stands where vertex is expected"),
        case("text without normals", with(" 0 0 1", ""), 3),
        case("text with a normal of two numbers", with("normal 0 0 1", "normal 0 0"), "expected"),
        case("text with a normal that is none", with("normal 0 0 1", "normal nan inf x"), 3),
        case(
            "text with a word too many",
            with("outer loop", "outer inner loop"),
            "inner stands where loop is expected",
        ),
        case("text with another keyword", with("facet normal", "face normal"), "stands where solid, facet or endsolid"),
        case("text with a loop that does not end", with("endloop\n", ""), "stands where endloop is expected"),
        case("text with a facet in a facet", with("outer loop", FACET), "stands where outer is expected"),
    ];
    for length in [10, 30, 40, 80, 90] {
        cases.push(case(format!("text cut at {length}"), &sound.as_bytes()[..length], "expected"));
    }
    for length in [20, 60] {
        cases.push(case(format!("text cut at {length}"), &sound.as_bytes()[..length], "breaks off"));
    }
    for number in ["nan", "inf", "-inf", "1e999", "x", "1,5", "", "0x1", "--1", "1e"] {
        let expected = match number {
            "" => "expected",
            "nan" | "inf" | "-inf" | "1e999" => "not finite",
            _ => "is not a number",
        };
        cases.push(case(
            format!("text with coordinate {number}"),
            with("vertex 1 0 0", &format!("vertex 1 {number} 0")),
            expected,
        ));
    }
    cases
}

fn binaries() -> Vec<Case> {
    let whole = "is no STL file that is whole";
    let mut cases = vec![
        case("bytes, sound", bytes(b"made by hand", 2, 2, 0.0), 6),
        case("bytes that begin with solid", bytes(b"solid a", 2, 2, 0.0), 6),
        case("bytes whose header is all text", bytes(&[b's'; 80], 1, 1, 0.0), 3),
        case("bytes with more behind", [bytes(b"", 1, 1, 0.0), vec![1; 33]].concat(), 3),
        case("bytes that begin with solid and have more behind", [bytes(b"solid", 1, 1, 0.0), vec![1; 33]].concat(), 3),
        case("bytes of no triangles", bytes(b"", 0, 0, 0.0), "holds no faces"),
        case("bytes that count none of two", bytes(b"", 0, 2, 0.0), "holds no faces"),
        case("bytes that count one of two", bytes(b"", 1, 2, 0.0), 3),
        case("bytes that count three of two", bytes(b"", 3, 2, 0.0), whole),
        case("bytes that count beyond memory", bytes(b"", u32::MAX, 2, 0.0), whole),
        case("bytes that count beyond signs", bytes(b"", 1 << 31, 2, 0.0), whole),
        case("bytes with a coordinate that is none", bytes(b"", 1, 1, f32::NAN), "not finite"),
        case("bytes with an endless coordinate", bytes(b"", 1, 1, f32::INFINITY), "not finite"),
        case("bytes with the largest coordinate", bytes(b"", 1, 1, f32::MAX), 3),
        case("bytes of a thousand triangles at one place", bytes(b"", 1_000, 1_000, 1.0), 3_000),
        case("of no bytes", "", "is not an STL file"),
        case("of another kind", "ply\nformat ascii 1.0\n", "is not an STL file"),
    ];
    let sound = bytes(b"x", 2, 2, 0.0);
    for length in [1, 79, 80, 83, 84, 100, 133, 134, 183] {
        let expected = if length < 84 { "is not an STL file" } else { whole };
        cases.push(case(format!("bytes cut at {length}"), &sound[..length], expected));
    }
    cases
}
