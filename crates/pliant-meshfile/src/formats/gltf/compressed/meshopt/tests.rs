//! Streams of the original encoder, and damaged ones. The script beside the data made it.

use super::{Filter, View};
use crate::formats::gltf::base64;
use crate::tests::Numbers;
use serde_json::{Value, json};

struct Case {
    name: String,
    view: View,
    bytes: Vec<u8>,
    decoded: Vec<u8>,
}

fn cases() -> Vec<Case> {
    let text = include_str!("../../../../tests/data/meshopt-streams.json");
    let streams: Vec<Value> = serde_json::from_str(text).expect("JSON");
    let case = |stream: &Value| {
        let text = |key: &str| stream[key].as_str().expect(key);
        let bytes = |key: &str| base64::decode(text(key)).expect(key);
        let encoded = bytes("bytes");
        let extension = json!({
            "buffer": 0, "byteLength": encoded.len(), "byteStride": stream["stride"], "count": stream["count"],
            "mode": stream["mode"], "filter": stream["filter"],
        });
        let view = View::of(&extension, "test", 1).unwrap_or_else(|fault| panic!("{}: {fault}", text("name")));
        Case { name: text("name").into(), view, bytes: encoded, decoded: bytes("decoded") }
    };
    streams.iter().map(case).collect()
}

/// The numbers of a filter's elements, of the width that may differ by one.
fn numbers(bytes: &[u8], stride: usize) -> Vec<i32> {
    match stride {
        4 => bytes.iter().map(|&b| i32::from(b as i8)).collect(),
        _ => bytes.chunks_exact(2).map(|b| i32::from(i16::from_le_bytes([b[0], b[1]]))).collect(),
    }
}

#[test]
fn streams_decode_as_the_original_decoder_does() {
    let cases = cases();
    assert_eq!(cases.len(), 26, "streams in the file");
    for Case { name, view, bytes, decoded } in &cases {
        let got = view.decode(bytes).unwrap_or_else(|problem| panic!("{name}: {problem}"));
        assert_eq!(got.len(), decoded.len(), "{name}: bytes");
        if matches!(view.filter, Filter::Octahedral | Filter::Quaternion | Filter::Color) {
            // The specification allows one unit in the last place; quantities wrap in 8 bits as they do in a byte.
            let pairs = numbers(&got, view.stride).into_iter().zip(numbers(decoded, view.stride));
            for (i, (got, expected)) in pairs.enumerate() {
                let apart = (got - expected).abs();
                assert!(apart <= 1, "{name}, number {i}: got {got}, expected {expected}");
            }
        } else {
            let first = got.iter().zip(decoded).position(|(got, expected)| got != expected);
            assert_eq!(first, None, "{name}: first wrong byte");
        }
    }
}

#[test]
fn damaged_streams_are_decoded_or_refused() {
    let mut numbers = Numbers(0x5eed_0010);
    for Case { name, view, bytes, decoded } in cases() {
        for round in 0..300 {
            let bytes = crate::tests::mutated(&bytes, &mut numbers);
            if let Ok(got) = view.decode(&bytes) {
                assert_eq!(got.len(), decoded.len(), "{name}, round {round}");
            }
        }
        for length in 0..bytes.len().min(100) {
            assert!(view.decode(&bytes[..length]).is_err() || view.count == 0, "{name}: {length} bytes were enough");
        }
    }
}

#[test]
fn a_claim_of_many_elements_reserves_nothing() {
    for (mode, first) in [("ATTRIBUTES", 0xa0u8), ("ATTRIBUTES", 0xa1), ("TRIANGLES", 0xe1), ("INDICES", 0xd1)] {
        let count = 3_000_000_000_000u64;
        let extension = json!({"buffer": 0, "byteLength": 60, "byteStride": 4, "count": count, "mode": mode});
        let view = View::of(&extension, "test", 1).expect("a view");
        let mut bytes = vec![0; 60];
        bytes[0] = first;
        assert!(view.decode(&bytes).is_err(), "{mode}");
    }
}
