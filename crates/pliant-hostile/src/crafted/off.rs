//! OFF files: first lines, counts, faces, colors.

use super::{Case, Expected};

fn case(name: impl AsRef<str>, text: impl Into<Vec<u8>>, expected: impl Into<Expected>) -> Case {
    Case::new(format!("off {}", name.as_ref()), "off", text, expected)
}

const SOUND: &str = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

pub(super) fn cases() -> Vec<Case> {
    [firsts(), bodies()].concat()
}

fn firsts() -> Vec<Case> {
    let with = |from: &str, to: &str| SOUND.replacen(from, to, 1);
    let foreign = "is not an OFF file";
    let mut cases = vec![
        case("sound", SOUND, 3),
        case("with CR LF", SOUND.replace('\n', "\r\n"), 3),
        case("with CR", SOUND.replace('\n', "\r"), 3),
        case("with a mark", format!("\u{feff}{SOUND}"), 3),
        case("without its first word", with("OFF\n", ""), 3),
        case("with counts behind its first word", with("OFF\n", "OFF "), 3),
        case("with comments", SOUND.replace('\n', " # x\n# y\n"), 3),
        case("in lower case", with("OFF", "off"), 3),
        case("of no bytes", "", foreign),
        case("of blanks", " \n\t\n", foreign),
        case("of comments", "# OFF\n", foreign),
        case("of another kind", "solid a\n", foreign),
        case("of another first word", with("OFF", "OFFICE"), foreign),
        case("of four dimensions", with("OFF", "4OFF"), "only points of three dimensions"),
        case("of n dimensions", with("OFF", "nOFF"), "only points of three dimensions"),
        case("of bytes", with("OFF\n", "OFF BINARY\n"), "is a binary OFF file"),
        case("of its first word", "OFF", "the number of vertices is expected"),
        case("with one count", "OFF\n3", "the number of faces is expected"),
        case("with four counts", with("3 1 0", "3 1 0 9"), "follows the numbers"),
    ];
    for count in ["-3", "x", "1.5", "nan", "18446744073709551615", "0x3"] {
        cases.push(case(
            format!("with {count} vertices"),
            with("3 1 0", &format!("{count} 1 0")),
            "the number of vertices is expected",
        ));
        cases.push(case(
            format!("with {count} faces"),
            with("3 1 0", &format!("3 {count} 0")),
            "the number of faces is expected",
        ));
    }
    for count in ["20000001", "4294967295"] {
        cases.push(case(
            format!("with {count} vertices"),
            with("3 1 0", &format!("{count} 1 0")),
            "vertices are more than the limit",
        ));
        cases.push(case(format!("with {count} edges"), with("3 1 0", &format!("3 1 {count}")), 3));
    }
    for count in ["40000001", "4294967295"] {
        cases.push(case(
            format!("with {count} faces"),
            with("3 1 0", &format!("3 {count} 0")),
            "faces are more than the limit",
        ));
    }
    for (counts, name) in [
        ("20000000 1 0", "vertices"),
        ("3 40000000 0", "faces"),
        ("100 1 0", "few vertices"),
        ("1e3 1 0", "vertices in floats"),
    ] {
        cases.push(case(format!("that claims many {name}"), with("3 1 0", counts), "is cut off: it counts"));
    }
    cases
}

fn bodies() -> Vec<Case> {
    let with = |from: &str, to: &str| SOUND.replacen(from, to, 1);
    let mut cases = vec![
        case("with a vertex more than it says", with("3 1 0", "2 1 0"), ""),
        case("with a vertex less than it says", with("3 1 0", "4 1 0"), ""),
        case("with a face less than it says", with("3 1 0", "3 2 0"), "breaks off"),
        case("with no faces", with("3 1 0", "3 0 0"), ""),
        case("with numbers behind a vertex", with("1 0 0\n", "1 0 0 5 5\n"), 3),
        case(
            "with too many numbers behind a vertex",
            with("1 0 0\n", &format!("1 0 0{}\n", " 5".repeat(20))),
            "more than the 12 numbers",
        ),
        case("with a color behind a face", with("3 0 1 2", "3 0 1 2 255 0 0"), 3),
        case("with nonsense behind a face", with("3 0 1 2", "3 0 1 2 nan red ?"), 3),
        case("with colors of every kind", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 nan inf x y\n0 1 0\n3 0 1 2\n", 3),
        case("with texture coordinates that lack", SOUND.replacen("OFF", "STOFF", 1), "texture coordinates"),
        case("with normals that lack", SOUND.replacen("OFF", "NOFF", 1), ""),
        case("with normals that are none", "NOFF\n3 1 0\n0 0 0 nan inf x\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n", 3),
        case("with zero bytes", SOUND.replace(' ', "\0"), 3),
    ];
    for number in ["nan", "inf", "-inf", "1e999", "x", "1,5", "--1", "0x1"] {
        let expected = match number {
            "nan" | "inf" | "-inf" | "1e999" => "not finite",
            _ => "is not a number",
        };
        cases.push(case(format!("with coordinate {number}"), with("1 0 0", &format!("1 {number} 0")), expected));
    }
    for corner in ["3", "-1", "0.5", "4294967296", "nan", "x", "99999999999999999999"] {
        cases.push(case(
            format!("with corner {corner}"),
            with("3 0 1 2", &format!("3 0 1 {corner}")),
            "line 6, face 0: ",
        ));
    }
    for n in ["-3", "2.5", "nan", "4294967295", "65537", "x", "4"] {
        cases.push(case(format!("with a face of {n}"), with("3 0 1 2", &format!("{n} 0 1 2")), ""));
    }
    for length in [4, 8, 12, 20, 27, 33] {
        cases.push(case(format!("cut at {length}"), &SOUND.as_bytes()[..length], ""));
    }
    cases
}
