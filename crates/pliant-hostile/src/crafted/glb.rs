//! The containers: GLB chunks and their lengths, JSON text.

use super::model::{N_VERTICES, glb_of, sound_document};
use super::{Case, Expected};
use serde_json::json;

pub(super) fn cases() -> Vec<Case> {
    [cut(), words(), chunks(), text()].concat()
}

fn sound() -> (Vec<u8>, Vec<u8>, Vec<u8>) {
    let (document, binary) = sound_document();
    let json = document.to_string().into_bytes();
    (glb_of(&json, &binary), json, binary)
}

fn case(name: impl AsRef<str>, bytes: Vec<u8>, expected: impl Into<Expected>) -> Case {
    Case::new(format!("glb container {}", name.as_ref()), "glb", bytes, expected)
}

/// Broken off at many places.
fn cut() -> Vec<Case> {
    let (whole, ..) = sound();
    let early = [0, 1, 2, 3].map(|length| (length, "of the JSON"));
    let late = (4..12).chain([12, 13, 16, 19, 20, 21, 28]).chain((1..25).map(|i| i * whole.len() / 25));
    let all = early.into_iter().chain(late.map(|length| (length, "is cut off")));
    all.map(|(length, expected)| case(format!("cut at {length}"), whole[..length].to_vec(), expected)).collect()
}

/// Other numbers in the header and in the headers of the chunks.
fn words() -> Vec<Case> {
    let (whole, json, _) = sound();
    let (total, json_length) = (whole.len() as u32, json.len().next_multiple_of(4) as u32);
    let second = 20 + json_length as usize;
    let changes: Vec<(&str, usize, u32, Expected)> = vec![
        ("version 0", 4, 0, "is GLB version 0".into()),
        ("version 1", 4, 1, "is GLB version 1".into()),
        ("version 3", 4, 3, "is GLB version 3".into()),
        ("version beyond counting", 4, u32::MAX, "is GLB version 4294967295".into()),
        ("length 0", 8, 0, "without a JSON chunk".into()),
        ("length 12", 8, 12, "without a JSON chunk".into()),
        ("length 4", 8, 4, "without a JSON chunk".into()),
        ("length one less", 8, total - 1, "GLB chunk 1: says".into()),
        ("length one more", 8, total + 1, "is cut off: its header says".into()),
        ("length beyond memory", 8, u32::MAX, "is cut off: its header says 4294967295".into()),
        ("JSON of 0", 12, 0, "GLB chunk 1: says 1935745659 bytes".into()),
        ("JSON of one less", 12, json_length - 1, "GLB chunk 1: says 187424 bytes".into()),
        ("JSON of all", 12, total - 20, "of the JSON".into()),
        ("JSON beyond the file", 12, total, "GLB chunk 0: says".into()),
        ("JSON beyond memory", 12, u32::MAX, "GLB chunk 0: says 4294967295 bytes".into()),
        ("JSON of another kind", 16, 0x1234_5678, "GLB chunk 0: is not the JSON chunk".into()),
        ("binary chunk first", 16, 0x004E_4942, "GLB chunk 0: is not the JSON chunk".into()),
        ("binary chunk of 0", second, 0, "GLB chunk 5: says 1073741824 bytes".into()),
        ("binary chunk of one more", second, total, "GLB chunk 1: says".into()),
        ("binary chunk beyond memory", second, u32::MAX, "GLB chunk 1: says 4294967295 bytes".into()),
        ("binary chunk of another kind", second + 4, 7, "buffer 0: names no data".into()),
        ("second JSON chunk", second + 4, 0x4E4F_534A, "buffer 0: names no data".into()),
    ];
    let change = |(name, at, word, expected): (&str, usize, u32, Expected)| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        case(name, bytes, expected)
    };
    changes.into_iter().map(change).collect()
}

fn chunks() -> Vec<Case> {
    let (whole, json, binary) = sound();
    let with_length = |mut bytes: Vec<u8>| {
        let length = bytes.len() as u32;
        bytes[8..12].copy_from_slice(&length.to_le_bytes());
        bytes
    };
    let more = |n: usize, bytes: &[u8]| {
        let mut chunk = (bytes.len() as u32).to_le_bytes().to_vec();
        chunk.extend(b"MORE");
        chunk.extend(bytes);
        with_length([whole.as_slice(), &chunk.repeat(n)].concat())
    };
    vec![
        case("sound", whole.clone(), N_VERTICES),
        case("with bytes after its end", [whole.as_slice(), b"trailing"].concat(), N_VERTICES),
        case("with seven bytes inside its length", with_length([whole.as_slice(), &[0; 7]].concat()), N_VERTICES),
        case("with a chunk of another kind", more(1, b"1234"), N_VERTICES),
        case("with chunks of nothing", more(50_000, b""), N_VERTICES),
        case(
            "with a chunk twice",
            with_length([&whole[..], &whole[20 + json.len().next_multiple_of(4)..]].concat()),
            N_VERTICES,
        ),
        case(
            "without a binary chunk",
            with_length(whole[..20 + json.len().next_multiple_of(4)].to_vec()),
            "buffer 0: names no data",
        ),
        case("of a text file", b"o a\nv 0 0 0\n".to_vec(), "of the JSON"),
        case("in a container", glb_of(&whole, &binary), "of the JSON"),
        case("with its magic in lower case", [b"gltf", &whole[4..]].concat(), "of the JSON"),
        Case::new("gltf that is GLB", "gltf", whole, N_VERTICES),
    ]
}

/// JSON that is none, or hardly.
fn text() -> Vec<Case> {
    let (document, binary) = sound_document();
    let (_, json, _) = sound();
    let case = |name: &str, text: &[u8], expected: Expected| {
        Case::new(format!("glb text {name}"), "glb", glb_of(text, &binary), expected)
    };
    let plain = document.to_string();
    let twice = plain.replacen("\"asset\":", "\"asset\":{\"version\":\"1.0\"},\"asset\":", 1);
    let depth = |n: usize| plain.replacen('{', &format!("{{\"extras\":{}{},", "[".repeat(n), "]".repeat(n)), 1);
    let long = |n: usize| plain.replacen('{', &format!("{{\"extras\":\"{}\",", "x".repeat(n)), 1);
    let mut many = document.clone();
    many["extras"] = vec![json!({"a": []}); 100_000].into();
    vec![
        case("of nothing", b"", "of the JSON".into()),
        case("of blanks", b"    ", "of the JSON".into()),
        case("null", b"null", "its JSON is not an object".into()),
        case("a list", b"[]", "its JSON is not an object".into()),
        case("a number", b"1e999", "of the JSON".into()),
        case("an empty object", b"{}", "names no asset version".into()),
        case("with a mark", &[b"\xef\xbb\xbf", json.as_slice()].concat(), N_VERTICES.into()),
        case(
            "with bytes that are no text",
            plain.replace("Kick", "Ki\u{0}k").replace('\0', "\\ud800").as_bytes(),
            "of the JSON".into(),
        ),
        case("with a raw zero", plain.replace("Kick", "Ki\0k").as_bytes(), "of the JSON".into()),
        case("with broken text", &[&json[..50], b"\xff\xfe", &json[50..]].concat(), "of the JSON".into()),
        case("with a comment", format!("// no\n{plain}").as_bytes(), "of the JSON".into()),
        case("with a comma too many", plain.replacen("]", ",]", 1).as_bytes(), "of the JSON".into()),
        case("with NaN", plain.replacen("5126", "NaN", 1).as_bytes(), "of the JSON".into()),
        case("with an endless number", plain.replacen("5126", "1e999", 1).as_bytes(), "of the JSON".into()),
        case("with a key twice", twice.as_bytes(), N_VERTICES.into()),
        case("a hundred deep", depth(100).as_bytes(), N_VERTICES.into()),
        case("a hundred thousand deep", depth(100_000).as_bytes(), "recursion limit".into()),
        case("with text of a million characters", long(1_000_000).as_bytes(), N_VERTICES.into()),
        case("with a hundred thousand extras", many.to_string().as_bytes(), N_VERTICES.into()),
        case("with something after it", format!("{plain}{plain}").as_bytes(), "of the JSON".into()),
    ]
}
