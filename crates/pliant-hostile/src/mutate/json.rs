//! Damage to what a glTF document says, in a container that stays right.

use crate::crafted::glb_of;
use crate::random::Random;
use serde_json::{Map, Value, json};

/// The file with one member of its document changed; nothing for files that are none any more.
pub(super) fn edited(file: &[u8], random: &mut Random) -> Option<Vec<u8>> {
    let (text, binary) = match file.starts_with(b"glTF") {
        true => apart(file)?,
        false => (file, None),
    };
    let mut document: Value = serde_json::from_slice(text).ok()?;
    let mut places = Vec::new();
    collect(&document, &mut String::new(), &mut places);
    let place = random.pick(&places).clone();
    let copy = document.pointer(random.pick(&places).as_str())?.clone();
    let value = document.pointer_mut(&place)?;
    change(value, copy, random);
    let text = document.to_string().into_bytes();
    Some(match binary {
        Some(binary) => glb_of(&text, binary),
        None => text,
    })
}

fn apart(file: &[u8]) -> Option<(&[u8], Option<&[u8]>)> {
    let length = u32::from_le_bytes(file.get(12..16)?.try_into().ok()?) as usize;
    let end = 20usize.checked_add(length)?;
    Some((file.get(20..end)?, Some(file.get(end + 8..).unwrap_or_default())))
}

/// Every place in a document but the text of data URIs, which have their own damage.
fn collect(value: &Value, path: &mut String, places: &mut Vec<String>) {
    let mut below = |key: &str, value: &Value| {
        let length = path.len();
        path.push('/');
        path.push_str(key);
        places.push(path.clone());
        collect(value, path, places);
        path.truncate(length);
    };
    match value {
        Value::Object(members) => members.iter().for_each(|(key, value)| below(&key.replace('/', "~1"), value)),
        // The first few of many are like the rest.
        Value::Array(items) => items.iter().take(40).enumerate().for_each(|(i, v)| below(&i.to_string(), v)),
        _ => {}
    }
    if places.is_empty() {
        places.push(String::new());
    }
}

fn change(value: &mut Value, copy: Value, random: &mut Random) {
    let number = value.as_f64();
    match (random.below(6), number) {
        (0, _) => *value = copy,
        (1, _) => *value = other_type(random),
        (2, _) => shrink_or_grow(value, copy, random),
        (_, Some(number)) => *value = other_number(number, random),
        (_, None) => match value {
            Value::String(text) => *value = other_text(text, random),
            _ => shrink_or_grow(value, copy, random),
        },
    }
}

fn other_number(number: f64, random: &mut Random) -> Value {
    match random.below(16) {
        0 => json!(number + 1.0),
        1 => json!(number - 1.0),
        2 => json!(number as i64 + 1),
        3 => json!(number as i64 - 1),
        4 => json!(-number),
        5 => json!(number * 1e300),
        6 => json!(0),
        7 => json!(-1),
        8 => json!(u64::MAX),
        9 => json!(u32::MAX),
        10 => json!(i64::MIN),
        11 => json!(1u64 << random.below(64)),
        12 => json!(random.below(20)),
        13 => json!([5120, 5121, 5122, 5123, 5125, 5126][random.below(6)]),
        14 => json!(1e-320),
        _ => json!(random.below(300)),
    }
}

fn other_text(text: &str, random: &mut Random) -> Value {
    const TEXTS: &[&str] = &[
        "SCALAR",
        "VEC2",
        "VEC3",
        "VEC4",
        "MAT2",
        "MAT3",
        "MAT4",
        "LINEAR",
        "STEP",
        "CUBICSPLINE",
        "translation",
        "rotation",
        "scale",
        "weights",
        "",
        "..",
        "/dev/zero",
        "data:;base64,AAAA",
        "%00",
        "2.0",
        "2.1",
        "1.0",
        "KHR_mesh_quantization",
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "EXT_mesh_gpu_instancing",
        "KHR_texture_transform",
        "\u{1f4a5}\n\u{0}",
    ];
    match random.below(4) {
        0 => text.repeat(1 + random.below(50)).into(),
        1 => text.chars().take(random.below(text.len() + 1)).collect::<String>().into(),
        _ => (*random.pick(TEXTS)).into(),
    }
}

fn other_type(random: &mut Random) -> Value {
    match random.below(9) {
        0 => Value::Null,
        1 => json!(true),
        2 => json!([]),
        3 => json!({}),
        4 => json!("0"),
        5 => json!(0.5),
        6 => json!([0, 0, 0, 0]),
        7 => (0..100).fold(json!(0), |inner, _| json!([inner])),
        _ => json!({"bufferView": 0, "componentType": 5126, "count": 1, "type": "SCALAR", "extras": {}}),
    }
}

fn shrink_or_grow(value: &mut Value, copy: Value, random: &mut Random) {
    const KEYS: &[&str] = &[
        "sparse",
        "byteStride",
        "byteOffset",
        "matrix",
        "children",
        "mesh",
        "skin",
        "targets",
        "indices",
        "mode",
        "extensions",
        "normalized",
        "uri",
        "weights",
        "EXT_meshopt_compression",
        "KHR_draco_mesh_compression",
        "EXT_mesh_gpu_instancing",
        "attributes",
        "inverseBindMatrices",
        "bufferView",
        "count",
    ];
    match value {
        Value::Array(items) => match random.below(4) {
            0 => drop(items.pop()),
            1 => items.push(copy),
            2 => items.extend(items.first().cloned().map(|item| vec![item; 1 + random.below(300)]).unwrap_or_default()),
            _ if !items.is_empty() => drop(items.remove(random.below(items.len()))),
            _ => {}
        },
        Value::Object(members) => remove_or_add(members, copy, KEYS[random.below(KEYS.len())], random),
        _ => *value = copy,
    }
}

fn remove_or_add(members: &mut Map<String, Value>, copy: Value, key: &str, random: &mut Random) {
    let known = members.keys().nth(random.below(members.len())).cloned();
    match (random.below(3), known) {
        (0, Some(known)) => drop(members.shift_remove(&known)),
        (1, _) => drop(members.insert(key.into(), copy)),
        (_, Some(known)) => drop(members.insert(known, copy)),
        _ => {}
    }
}
