//! The text of a document with some of its values changed, and every other character as it was.
//!
//! **Idea.** Encoding a document anew loses what only its text says: how a number is spelled, what is indented how,
//! members named twice, whole numbers beyond 64 bits. So the new text is the old one, followed along both the old and
//! the new values: what is equal in both is copied, what differs is looked into, and only what is new is encoded.

use serde_json::{Map, Value};

/// The text of `new`, written over `text`, which is the one of `old`; none where the text is not what `old` came from.
pub(super) fn patched(text: &[u8], old: &Value, new: &Value) -> Option<Vec<u8>> {
    let mut patch = Patch { text, at: 0, out: Vec::with_capacity(text.len() + 1024) };
    if text.starts_with(b"\xef\xbb\xbf") {
        patch.at = 3;
    }
    patch.spaces();
    patch.out.extend_from_slice(&text[..patch.at]);
    patch.value(old, new)?;
    patch.out.extend_from_slice(&text[patch.at..]);
    Some(patch.out)
}

struct Patch<'a> {
    text: &'a [u8],
    at: usize,
    out: Vec<u8>,
}

impl Patch<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn spaces(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t' | b'\n' | b'\r')) {
            self.at += 1;
        }
    }

    /// Steps over a character that must be there.
    fn step(&mut self, character: u8) -> Option<()> {
        (self.peek()? == character).then(|| self.at += 1)
    }

    /// Steps over a value, and gives its text's range.
    fn skip(&mut self) -> Option<std::ops::Range<usize>> {
        let start = self.at;
        let mut depth = 0usize;
        loop {
            match self.peek()? {
                b'"' => {
                    self.string()?;
                }
                b'{' | b'[' => {
                    depth += 1;
                    self.at += 1;
                    continue;
                }
                b'}' | b']' => {
                    depth = depth.checked_sub(1)?;
                    self.at += 1;
                }
                b',' | b':' | b' ' | b'\t' | b'\n' | b'\r' if depth > 0 => {
                    self.at += 1;
                    continue;
                }
                _ => self.word()?,
            }
            if depth == 0 {
                return (self.at > start).then_some(start..self.at);
            }
        }
    }

    /// Steps over a number, true, false or null.
    fn word(&mut self) -> Option<()> {
        let start = self.at;
        while matches!(self.peek(), Some(b'+' | b'-' | b'.' | b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z')) {
            self.at += 1;
        }
        (self.at > start).then_some(())
    }

    /// Steps over a string, and gives it.
    fn string(&mut self) -> Option<String> {
        let start = self.at;
        self.step(b'"')?;
        loop {
            match self.peek()? {
                b'\\' => self.at += 2,
                b'"' => break,
                _ => self.at += 1,
            }
        }
        self.at += 1;
        serde_json::from_slice(&self.text[start..self.at]).ok()
    }

    /// Writes a value of the text as it is to be.
    fn value(&mut self, old: &Value, new: &Value) -> Option<()> {
        match (old, new) {
            _ if old == new => {
                let range = self.skip()?;
                self.out.extend_from_slice(&self.text[range]);
                Some(())
            }
            (Value::Object(old), Value::Object(new)) if !old.is_empty() => self.object(old, new),
            (Value::Array(old), Value::Array(new)) if !old.is_empty() && old.len() <= new.len() => self.array(old, new),
            _ => {
                self.skip()?;
                self.encode(new)
            }
        }
    }

    fn encode(&mut self, value: &Value) -> Option<()> {
        serde_json::to_writer(&mut self.out, value).ok()
    }

    /// The members of the text that stay, in their places, then those that are new.
    fn object(&mut self, old: &Map<String, Value>, new: &Map<String, Value>) -> Option<()> {
        self.step(b'{')?;
        self.out.push(b'{');
        let mut written = 0;
        loop {
            let start = self.at;
            self.spaces();
            let key = self.string()?;
            self.spaces();
            self.step(b':')?;
            self.spaces();
            match (old.get(&key)?, new.get(&key)) {
                (_, None) => {
                    self.skip()?;
                }
                (old, Some(new)) => {
                    if written > 0 {
                        self.out.push(b',');
                    }
                    self.out.extend_from_slice(&self.text[start..self.at]);
                    self.value(old, new)?;
                    written += 1;
                }
            }
            let end = self.at;
            self.spaces();
            if self.peek()? == b',' {
                self.out.extend_from_slice(if new.contains_key(&key) { &self.text[end..self.at] } else { b"" });
                self.at += 1;
                continue;
            }
            for (key, value) in new.iter().filter(|(key, _)| !old.contains_key(*key)) {
                self.out.extend_from_slice(if written > 0 { b"," } else { b"" });
                self.encode(&Value::from(key.as_str()))?;
                self.out.push(b':');
                self.encode(value)?;
                written += 1;
            }
            self.step(b'}')?;
            self.out.extend_from_slice(&self.text[end..self.at]);
            return Some(());
        }
    }

    /// The items of the text, in their places, then those that are new.
    fn array(&mut self, old: &[Value], new: &[Value]) -> Option<()> {
        self.step(b'[')?;
        self.out.push(b'[');
        for (i, (old_item, new_item)) in old.iter().zip(new).enumerate() {
            let start = self.at;
            if i > 0 {
                self.spaces();
                self.step(b',')?;
            }
            self.spaces();
            self.out.extend_from_slice(&self.text[start..self.at]);
            self.value(old_item, new_item)?;
        }
        for item in &new[old.len()..] {
            self.out.push(b',');
            self.encode(item)?;
        }
        let end = self.at;
        self.spaces();
        self.step(b']')?;
        self.out.extend_from_slice(&self.text[end..self.at]);
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{Numbers, mutated};

    fn check(text: &str, new: &str, expected: &str) {
        let value = |text: &str| serde_json::from_str::<Value>(text).expect("JSON");
        let got = patched(text.as_bytes(), &value(text), &value(new)).expect("a text");
        assert_eq!(String::from_utf8_lossy(&got), expected, "{text} to {new}");
    }

    #[test]
    fn only_what_changed_is_written_anew() {
        check(
            r#" { "a" : 1.50 , "b":[ 1e5,{"c" : 1}] } "#,
            r#"{"a":1.5,"b":[1e5,{"c":2}]}"#,
            r#" { "a" : 1.50 , "b":[ 1e5,{"c" : 2}] } "#,
        );
        check(r#"{"a": 1.0, "b": 2}"#, r#"{"a": 1.0, "b": 2, "c": {"d": [3]}}"#, r#"{"a": 1.0, "b": 2,"c":{"d":[3]}}"#);
        check(r#"{"a": 1.0, "b": 2, "c": 3e0}"#, r#"{"a": 1.0, "c": 3e0}"#, r#"{"a": 1.0, "c": 3e0}"#);
        check(r#"{"a": 1, "b": 2}"#, r#"{"b": 2}"#, r#"{ "b": 2}"#);
        check(r#"{"a": 1}"#, r#"{"b": 2}"#, r#"{"b":2}"#);
        check(r#"{"a": [] }"#, r#"{"a": [1, 2]}"#, r#"{"a": [1,2] }"#);
        check("[\n  1.0,\n  2\n]", "[1.0, 2, 3]", "[\n  1.0,\n  2,3\n]");
        check("[1.0, 2, 3]", "[1.0, 2]", "[1.0,2]");
        check(r#"{"\u0061\"": 1, "x": "]}\\"}"#, r#"{"a\"": 2, "x": "]}\\"}"#, r#"{"\u0061\"": 2, "x": "]}\\"}"#);
        check(
            r#"{"a": 99999999999999999999, "b": 1}"#,
            r#"{"a": 99999999999999999999, "b": 2}"#,
            r#"{"a": 99999999999999999999, "b": 2}"#,
        );
        check(r#"{"a": 1, "a": 2, "b": 1}"#, r#"{"a": 2, "b": 2}"#, r#"{"a": 1, "a": 2, "b": 2}"#);
    }

    #[test]
    fn whatever_changed_the_new_text_says_it() {
        let mut numbers = Numbers(0x5eed_0012);
        let text = br#"{"a": [1, 2.50, {"b": null, "c": "d\n"}], "e": {"f": {}, "g": [[], [true]]}, "h": -1e-7 }"#;
        let mut values: Vec<(Vec<u8>, Value)> = Vec::new();
        while values.len() < 400 {
            let text = mutated(text, &mut numbers);
            if let Ok(value) = serde_json::from_slice(&text) {
                values.push((text, value));
            }
        }
        for pair in values.windows(2) {
            let [(text, old), (_, new)] = pair else { continue };
            let got = patched(text, old, new).unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(text)));
            let read: Value = serde_json::from_slice(&got).unwrap_or_else(|error| {
                panic!("{error}: {} to {new}: {}", String::from_utf8_lossy(text), String::from_utf8_lossy(&got))
            });
            assert_eq!(&read, new, "{}", String::from_utf8_lossy(text));
        }
    }
}
