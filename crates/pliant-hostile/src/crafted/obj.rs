//! Small OBJ files: numbers, corners, names and line ends.

use super::{Case, Expected};

/// Three vertices, so that a face may follow at line 4.
const VERTICES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const FACE: &str = "f 1 2 3\n";

pub(super) fn cases() -> Vec<Case> {
    [numbers(), corners(), statements(), lines(), attributes()].concat()
}

fn case(name: impl Into<String>, text: impl Into<Vec<u8>>, expected: impl Into<Expected>) -> Case {
    Case::new(format!("obj {}", name.into()), "obj", text, expected)
}

/// Words in place of a coordinate.
fn numbers() -> Vec<Case> {
    let digits = "9".repeat(400);
    let words: &[(&str, bool)] = &[
        ("-0", true),
        ("+1", true),
        (".5", true),
        ("5.", true),
        ("1E3", true),
        ("1e-400", true),
        ("1e308", true),
        ("-1.7976931348623157e308", true),
        ("0.1000000000000000055511151231257827021181583404541015625", true),
        ("00000000000000000000000000000001", true),
        ("nan", false),
        ("NaN", false),
        ("-nan", false),
        ("inf", false),
        ("-inf", false),
        ("infinity", false),
        ("1e309", false),
        ("1e999999999999", false),
        (&digits, false),
        ("0x10", false),
        ("1e", false),
        ("e5", false),
        ("--1", false),
        ("1..2", false),
        ("1,5", false),
        ("1_000", false),
        ("1f", false),
        ("١", false),
        ("∞", false),
        ("1\u{a0}", false),
        ("v", false),
        ("-", false),
        (".", false),
        ("%s%n", false),
        ("\u{7f}", false),
    ];
    let mut cases = Vec::new();
    for (i, &(word, opens)) in words.iter().enumerate() {
        let expected: Expected = if opens { 4.into() } else { "line 4, vertex 3: ".into() };
        let shown: String = word.chars().take(30).collect();
        let text = |fill: [&str; 3]| format!("{VERTICES}v {} {} {}\n{FACE}", fill[0], fill[1], fill[2]);
        let mut fill = ["0"; 3];
        fill[i % 3] = word;
        cases.push(case(format!("coordinate {shown}"), text(fill), expected));
    }
    cases.extend([
        case("vertex without coordinates", format!("{VERTICES}v\n{FACE}"), "vertex 3: has 0 coordinates"),
        case("vertex with one coordinate", format!("{VERTICES}v 1\n{FACE}"), "vertex 3: has 1 coordinates"),
        case("vertex with two coordinates", format!("{VERTICES}v 1 2 # 3\n{FACE}"), "vertex 3: has 2 coordinates"),
        case("vertex with a weight", format!("{VERTICES}v 1 2 3 0.5\n{FACE}"), 4),
        case("vertex with a bad weight", format!("{VERTICES}v 1 2 3 nan\n{FACE}"), 4),
        case("vertex with a color that is none", format!("{VERTICES}v 1 2 3 nan inf red\n{FACE}"), 4),
        case("vertex with a color beyond singles", format!("{VERTICES}v 1 2 3 1e99 -1e99 0\n{FACE}"), 4),
        case("vertex with a thousand numbers", format!("{VERTICES}v 1 2 3{}\n{FACE}", " 1".repeat(1000)), 4),
    ]);
    cases
}

/// Words in place of a face's corner.
fn corners() -> Vec<Case> {
    let words: &[(&str, Expected)] = &[
        ("3", 3.into()),
        ("-1", 3.into()),
        ("+3", 3.into()),
        ("003", 3.into()),
        ("3/", 3.into()),
        ("3//", 3.into()),
        ("3/9/9", 3.into()),
        ("3/-9/-9", 3.into()),
        ("3/0/0", 3.into()),
        ("3/4294967295/4294967296", 3.into()),
        ("3/9223372036854775807", 3.into()),
        ("0", "line 4, face corner 0: vertices are numbered from 1".into()),
        ("-0", "vertices are numbered from 1".into()),
        ("4", "line 4: face names vertex 4, the file has 3".into()),
        ("-4", "line 4, face corner -4: there are 3 vertices so far".into()),
        ("4294967295", "line 4, face corner 4294967295: there are 3".into()),
        ("4294967296", "line 4, face corner 4294967296: there are 3".into()),
        ("4294967297", "line 4, face corner 4294967297: there are 3".into()),
        ("9223372036854775807", "there are 3 vertices so far".into()),
        ("-9223372036854775808", "there are 3 vertices so far".into()),
        ("9223372036854775808", "is not a vertex number".into()),
        ("99999999999999999999999", "is not a vertex number".into()),
        ("1.5", "is not a vertex number".into()),
        ("1e0", "is not a vertex number".into()),
        ("nan", "is not a vertex number".into()),
        ("0x3", "is not a vertex number".into()),
        ("x", "line 4, face corner x: is not a vertex number".into()),
        ("/1", "is not a vertex number".into()),
        ("//", "is not a vertex number".into()),
        ("３", "is not a vertex number".into()),
        ("3/x", "is not a vertex number".into()),
        ("3//x", "is not a vertex number".into()),
        ("3/1.5", "is not a vertex number".into()),
        ("3/1/1/1", "has more than three indices".into()),
        ("3////////", "has more than three indices".into()),
        ("3\\1", "is not a vertex number".into()),
        ("--1", "is not a vertex number".into()),
        ("-", "is not a vertex number".into()),
    ];
    let with = |(word, expected): &(&str, Expected)| {
        case(format!("corner {word}"), format!("{VERTICES}f 1 2 {word}\n"), expected.clone())
    };
    words.iter().map(with).collect()
}

/// Statements in odd places and numbers.
fn statements() -> Vec<Case> {
    let odd = |name: &str, after: &str, expected: Expected| case(name, format!("{VERTICES}{after}"), expected);
    vec![
        case("of no bytes", "", "holds no faces"),
        case("of vertices alone", VERTICES, "holds no faces"),
        case("of a face alone", FACE, "line 1: face names vertex 1, the file has 0"),
        case("of a negative face alone", "f -1 -2 -3\n", "there are 0 vertices so far"),
        case("with its face first", format!("{FACE}{VERTICES}"), 3),
        case("with a negative face first", format!("f -1 -2 -3\n{VERTICES}"), "there are 0 vertices so far"),
        case("of comments", "# nothing\n".repeat(1000), "holds no faces"),
        case("of blanks", " \t\n".repeat(1000), "holds no faces"),
        case("of another kind", "solid x\nfacet normal 0 0 1\n", "holds no faces"),
        case("that is a picture", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".as_slice(), "holds no faces"),
        odd("face without corners", "f\nf 1 2 3\n", 3.into()),
        odd("face of one corner", "f 1\nf 1 2 3\n", 3.into()),
        odd("faces of two corners alone", "f 1 2\nf 2 3\n", "holds no faces".into()),
        odd("face of one vertex thrice", "f 1 1 1\n", 3.into()),
        odd("face of one vertex a hundred times", &format!("f{}\n", " 1".repeat(100)), 3.into()),
        odd("face in a bow tie", "v 1 1 0\nf 1 4 2 3\n", 4.into()),
        odd("face along a line", "v 2 0 0\nv 3 0 0\nf 1 2 4 5\n", 5.into()),
        odd("face given twice and turned", "f 1 2 3\nf 1 2 3\nf 3 2 1\n", 3.into()),
        odd("edge of five faces", &"f 1 2 3\n".repeat(5), 3.into()),
        odd("face with another keyword", "fo 1 2 3\n", 3.into()),
        odd("face in upper case", "F 1 2 3\n", "holds no faces".into()),
        odd("keyword that goes on", "faces 1 2 3\n", "holds no faces".into()),
        odd("face without a blank", "f1 2 3\n", "holds no faces".into()),
        odd("lines and points", "l 1 2\np 1\nl 99 -99\nf 1 2 3\n", 3.into()),
        odd("curves", "cstype bspline\ndeg 3\ncurv 0 1 1 2 3 99\nend\nf 1 2 3\n", 3.into()),
        odd("calls of other files", "call /etc/passwd\ncsh rm\nf 1 2 3\n", 3.into()),
        odd("group without a name", "g\no\nusemtl\ns\nmtllib\nf 1 2 3\n", 3.into()),
        odd("name with control characters", "o a\u{1b}[2J\u{7}\u{8}\nf 1 2 3\n", 3.into()),
        odd("name from right to left", "o \u{202e}jbo.exe\u{202c}\nf 1 2 3\n", 3.into()),
        odd("name of a formatted print", "o %n%n%s%s\nusemtl {}{0}\nf 1 2 3\n", 3.into()),
        odd("name of a million characters", &format!("o {}\nf 1 2 3\n", "x".repeat(1_000_000)), 3.into()),
        odd("material of a million characters", &format!("usemtl {}\nf 1 2 3\n", "x".repeat(1_000_000)), 3.into()),
        odd("smoothing group that is none", "s 99999999999999999999\ns -1\ns x\nf 1 2 3\n", 3.into()),
    ]
}

/// Line ends, continuations and encodings.
fn lines() -> Vec<Case> {
    let text = format!("{VERTICES}{FACE}");
    let utf16 = |big: bool| -> Vec<u8> {
        let units = "\u{feff}".encode_utf16().chain(text.encode_utf16());
        units.flat_map(|unit| if big { unit.to_be_bytes() } else { unit.to_le_bytes() }).collect()
    };
    let latin: Vec<u8> = [b"o Stra\xdfe\nusemtl \xff\xfe\n".as_slice(), text.as_bytes()].concat();
    vec![
        case("with a byte order mark", format!("\u{feff}{text}"), 3),
        case("with two byte order marks", format!("\u{feff}\u{feff}{text}"), "face names vertex 3, the file has 2"),
        case("with CR LF", text.replace('\n', "\r\n"), 3),
        case("with CR", text.replace('\n', "\r"), 3),
        case("with LF CR", text.replace('\n', "\n\r"), 3),
        case("without a last line end", text.trim_end(), 3),
        case("ending in a backslash", format!("{text}\\"), 3),
        case("ending in a continuation", format!("{text}f 1 2 3\\\n"), 3),
        case("of continuations", text.replace(' ', " \\\n "), 3),
        case("with a continued keyword", text.replace("f ", "\\\nf\\\n "), 3),
        case("with a million continuations", format!("{text}#{}", "\\\n".repeat(100_000)), 3),
        case("with tabs", text.replace(' ', "\t \t"), 3),
        case("with vertical tabs", text.replace(' ', "\u{b}\u{c}"), 3),
        case("with zero bytes for blanks", text.replace(' ', "\0"), 3),
        case("with zero bytes after it", format!("{text}{}", "\0".repeat(5000)), 3),
        case("with bytes that are no text", latin, 3),
        case("with bytes that are no text in a comment", [b"# \xc0\xaf\xff\n".as_slice(), text.as_bytes()].concat(), 3),
        case("in two bytes a character", utf16(false), "is text in UTF-16"),
        case("in two bytes a character, big end first", utf16(true), "is text in UTF-16"),
        case("with the end mark of an old system", format!("{text}\u{1a}"), 3),
        case("with line separators of another kind", text.replace('\n', "\u{2028}"), "line 1, vertex 0: "),
        case("with blanks of another kind", text.replace(' ', "\u{3000}"), "holds no faces"),
    ]
}

/// Texture coordinates, normals, materials.
fn attributes() -> Vec<Case> {
    let odd = |name: &str, before: &str, corners: [&str; 3]| {
        let [a, b, c] = corners;
        case(name, format!("{VERTICES}{before}f {a} {b} {c}\n"), 3)
    };
    let vertices = ["1/1/1", "2/1/1", "3/1/1"];
    vec![
        odd("texture coordinates without numbers", "vt\nvn\n", vertices),
        odd("texture coordinates that are none", "vt nan inf\nvt x y\nvn nan inf -inf\n", vertices),
        odd("texture coordinates beyond singles", "vt 1e300 -1e300\nvn 1e300 1e300 1e300\n", vertices),
        odd("normal of no length", "vt 0 0\nvn 0 0 0\n", vertices),
        odd("normal of a tiny length", "vt 0 0\nvn 1e-40 0 0\n", vertices),
        odd("normal with one number", "vt 0\nvn 1\n", vertices),
        odd("corners that mix attributes", "vt 0 0\nvn 0 0 1\n", ["1", "2/1", "3//1"]),
        odd("attributes given after use", "", ["1/1/1", "2/2/2", "3/3/3"]),
        odd("a library without a name", "mtllib\nmtllib  \n", ["1", "2", "3"]),
        odd("a hundred libraries", &(0..100).map(|i| format!("mtllib {i}.mtl\n")).collect::<String>(), ["1", "2", "3"]),
        odd("a library of a thousand names", &format!("mtllib {}\n", "a.mtl ".repeat(1000)), ["1", "2", "3"]),
    ]
}
