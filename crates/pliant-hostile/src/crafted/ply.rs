//! PLY files: headers, text and bytes of both orders, lists.

use super::{Case, Expected};

fn case(name: impl AsRef<str>, bytes: impl Into<Vec<u8>>, expected: impl Into<Expected>) -> Case {
    Case::new(format!("ply {}", name.as_ref()), "ply", bytes, expected)
}

const VERTEX: &str = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const FACE: &str = "element face 1\nproperty list uchar int vertex_indices\n";
const BODY: &str = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

fn ascii(declarations: &str, body: &str) -> String {
    format!("ply\nformat ascii 1.0\n{declarations}end_header\n{body}")
}

/// A sound file of bytes, with the list's count and items given.
fn binary(big: bool, n: u8, corners: [i32; 3], x: f32) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let mut bytes = format!("ply\nformat binary_{order}_endian 1.0\n{VERTEX}{FACE}end_header\n").into_bytes();
    for number in [x, 0., 0., 1., 0., 0., 0., 1., 0.] {
        bytes.extend(if big { number.to_be_bytes() } else { number.to_le_bytes() });
    }
    bytes.push(n);
    for corner in corners {
        bytes.extend(if big { corner.to_be_bytes() } else { corner.to_le_bytes() });
    }
    bytes
}

pub(super) fn cases() -> Vec<Case> {
    [headers(), texts(), bytes()].concat()
}

fn headers() -> Vec<Case> {
    let sound = ascii(&format!("{VERTEX}{FACE}"), BODY);
    let with = |from: &str, to: &str| sound.replacen(from, to, 1);
    let mut cases = vec![
        case("sound", sound.clone(), 3),
        case("with CR LF", sound.replace('\n', "\r\n"), 3),
        case("with CR", sound.replace('\n', "\r"), 3),
        case("with comments", with("element", "comment x\nobj_info y\nelement"), 3),
        case("with a line of another kind", with("element", "nothing of PLY\nelement"), 3),
        case("of no bytes", "", "does not begin with the line ply"),
        case("of another kind", "play\n", "does not begin with the line ply"),
        case("in upper case", sound.to_uppercase(), "does not begin with the line ply"),
        case("of its first line", "ply\n", "is cut off in its header"),
        case("without the end of its header", sound.replace("end_header\n", ""), "is cut off in its header"),
        case("without a format", with("format ascii 1.0\n", ""), "names no format"),
        case("of an unknown format", with("ascii", "utf8"), "the format is utf8"),
        case("of version 2", with("1.0", "2.0"), "is PLY version 2.0"),
        case("without a version", with(" 1.0", ""), "is PLY version nothing"),
        case("without vertices", ascii(FACE, "3 0 1 2\n"), "declares no element vertex"),
        case("without faces", ascii(VERTEX, "0 0 0\n1 0 0\n0 1 0\n"), ""),
        case("without x", with("property float x\n", ""), "has no numbers x, y and z"),
        case("with a list for x", with("property float x", "property list uchar float x"), "has no numbers x, y and z"),
        case("with its vertices twice", with("element face", "element vertex"), "element vertex is declared twice"),
        case("with a property before any element", with("element", "property float x\nelement"), "before any element"),
        case("with an element without a count", with("vertex 3", "vertex"), "element vertex has no count"),
        case("with an element without a name", with("vertex 3", ""), "an element without a name"),
        case("with a property without a name", with("float x", "float"), "a property without a name"),
        case("with a property without a type", with("property float x", "property"), "a property without a type"),
        case("with an unknown type", with("float x", "quad x"), "quad is no type of PLY"),
        case("with a list counted in floats", with("uchar int", "float int"), "a list cannot be counted in float"),
        case(
            "with a list without items",
            with("list uchar int vertex_indices", "list uchar"),
            "a property without a type",
        ),
        case(
            "with faces without a list",
            with("list uchar int vertex_indices", "int flags"),
            "has no list vertex_indices",
        ),
        case(
            "with a thousand properties",
            with("property float x", &format!("{}property float x", "property char p\n".repeat(1_000))),
            "is cut off",
        ),
        case(
            "with too many properties",
            with("property float x", &"property char p\n".repeat(20_000)),
            "elements and properties in the header are more",
        ),
        case("with many comments", with("element", &format!("{}element", "comment\n".repeat(200_000))), 3),
        case("with a long comment", with("element", &format!("comment {}\nelement", "x".repeat(1_000_000))), 3),
    ];
    for count in ["-1", "x", "1.5", "18446744073709551615", "٣", "0x3"] {
        cases.push(case(
            format!("with {count} vertices"),
            with("vertex 3", &format!("vertex {count}")),
            "is no count of elements",
        ));
    }
    for count in ["4294967295", "20000001"] {
        cases.push(case(
            format!("with {count} vertices"),
            with("vertex 3", &format!("vertex {count}")),
            "vertices are more than the limit",
        ));
        cases.push(case(
            format!("with {count} faces"),
            with("face 1", &format!("face {count}")),
            "is cut off: the header counts",
        ));
    }
    for count in ["20000000", "1000", "1e3"] {
        cases.push(case(
            format!("with {count} vertices"),
            with("vertex 3", &format!("vertex {count}")),
            "is cut off: the header counts",
        ));
    }
    for count in ["4294967295", "9000000000000000"] {
        let with_element = with("element face", &format!("element empty {count}\nelement face"));
        cases.push(case(format!("with {count} elements of nothing"), with_element, 3));
        let with_element = with("element face", &format!("element some {count}\nproperty char c\nelement face"));
        cases.push(case(format!("with {count} elements of something"), with_element, "is cut off: the header counts"));
    }
    cases
}

fn texts() -> Vec<Case> {
    let text = |body: &str| ascii(&format!("{VERTEX}{FACE}"), body);
    let mut cases = vec![
        case("on one line", text(&BODY.replace('\n', " ")), ""),
        case("with more behind", text(&format!("{BODY}and more")), 3),
        case(
            "with one number too many",
            text(&BODY.replacen("0 0 0", "0 0 0 0", 1)),
            "more numbers than the header says",
        ),
        case("with a face too short", text("0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), "breaks off"),
        case("with a face of two corners", text("0 0 0\n1 0 0\n0 1 0\n2 0 1\n"), ""),
        case("with a face of no corners", text("0 0 0\n1 0 0\n0 1 0\n0\n"), ""),
    ];
    for (corner, expected) in [
        ("3", "names vertex 3, the file has 3"),
        ("-1", "is no number of a vertex"),
        ("0.5", "is no number of a vertex"),
        ("4294967296", "is no number of a vertex"),
        ("nan", "is no number of a vertex"),
        ("inf", "is no number of a vertex"),
        ("x", "is not a number"),
    ] {
        cases.push(case(
            format!("with corner {corner}"),
            text(&format!("0 0 0\n1 0 0\n0 1 0\n3 0 1 {corner}\n")),
            expected,
        ));
    }
    for (n, expected) in [
        ("-3", "is no count of a list"),
        ("2.5", "is no count of a list"),
        ("nan", "is no count of a list"),
        ("1e300", "a list says it has"),
        ("4294967295", "a list says it has 4294967295 items"),
        ("4", "breaks off"),
    ] {
        cases.push(case(format!("with a list of {n}"), text(&format!("0 0 0\n1 0 0\n0 1 0\n{n} 0 1 2\n")), expected));
    }
    for (number, expected) in [
        ("nan", "is not finite"),
        ("inf", "is not finite"),
        ("1e999", "is not finite"),
        ("x", "x is not a number"),
        ("1,5", "is not a number"),
    ] {
        cases.push(case(
            format!("with coordinate {number}"),
            text(&BODY.replacen("1 0 0", &format!("1 {number} 0"), 1)),
            expected,
        ));
    }
    let extra = |property: &str, values: [&str; 3]| {
        let [a, b, c] = values;
        let declarations = format!("{VERTEX}{property}{FACE}");
        ascii(&declarations, &format!("0 0 0 {a}\n1 0 0 {b}\n0 1 0 {c}\n3 0 1 2\n"))
    };
    let colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    cases.extend([
        case("with colors out of range", extra(colors, ["999 -1 1e300", "nan inf -inf", "0 0 0"]), 3),
        case(
            "with normals that are none",
            extra("property float nx\nproperty float ny\nproperty float nz\n", ["nan inf 0"; 3]),
            3,
        ),
        case("with r", extra("property int rigidity\n", ["1", "2", "1000"]), 3),
        case("with r that is none", extra("property float rigidity\n", ["0", "nan", "1e9"]), 3),
        case("with a list in its vertices", extra("property list uchar int more\n", ["0", "1 5", "2 5 6"]), 3),
        case(
            "with a huge list in its vertices",
            extra("property list uint int more\n", ["0", "4000000000", "0"]),
            "a list says it has",
        ),
    ]);
    cases
}

fn bytes() -> Vec<Case> {
    let mut cases = Vec::new();
    for big in [false, true] {
        let order = if big { "big" } else { "little" };
        let mut add = |name: &str, bytes: Vec<u8>, expected: Expected| {
            cases.push(case(format!("{order} end first, {name}"), bytes, expected));
        };
        let sound = binary(big, 3, [0, 1, 2], 0.5);
        add("sound", sound.clone(), 3.into());
        add("with more behind", [sound.as_slice(), &[0; 100]].concat(), 3.into());
        add("with corner 3", binary(big, 3, [0, 1, 3], 0.5), "names vertex 3, the file has 3".into());
        add("with corner -1", binary(big, 3, [0, 1, -1], 0.5), "is no number of a vertex".into());
        add("with the largest corner", binary(big, 3, [0, 1, i32::MAX], 0.5), "names vertex 2147483647".into());
        add("with a list of 255", binary(big, 255, [0, 1, 2], 0.5), "a list says it has 255 items".into());
        add("with a list of 4", binary(big, 4, [0, 1, 2], 0.5), "a list says it has 4 items".into());
        add("with a list of none", binary(big, 0, [0, 1, 2], 0.5), "".into());
        add("with a coordinate that is none", binary(big, 3, [0, 1, 2], f32::NAN), "is not finite".into());
        add("with an endless coordinate", binary(big, 3, [0, 1, 2], f32::INFINITY), "is not finite".into());
        add("with the largest coordinate", binary(big, 3, [0, 1, 2], f32::MAX), 3.into());
        for left in [1, 4, 12, 13, 14, 20, 40, 48] {
            add(&format!("cut {left} bytes before its end"), sound[..sound.len() - left].to_vec(), "".into());
        }
        // What programs that copy files as text do to bytes.
        let torn: Vec<u8> = sound.iter().flat_map(|&b| if b == b'\n' { vec![b'\r', b'\n'] } else { vec![b] }).collect();
        add("with CR LF", torn, 3.into());
    }
    cases
}
