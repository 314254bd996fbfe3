//! r from files: sidecars, lists in text, and what mesh files carry.

use crate::{Fault, Format, OpenError, budget, files};
use serde_json::Value;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The largest r that is accepted: neighborhoods that wide span any mesh people work with.
pub(crate) const MAX: u16 = 1000;

/// Reads r from a text file of integers, a JSON array, or a mesh file that carries it.
///
/// One entry per file vertex is expected, `n_vertices` in all, each from 1 to 1000; the error names the first entry
/// that is not.
pub fn read_rigidity(path: &Path, n_vertices: usize) -> Result<Vec<u16>, OpenError> {
    let rigidity = if Format::of(path).is_some() {
        crate::open(path)?.rigidity.ok_or_else(|| Fault::NoRigidity.in_file(path))?
    } else {
        let bytes = files::read(path, budget::TEXT_BYTES)?;
        parse(&bytes).map_err(|fault| fault.in_file(path))?
    };
    check_count(rigidity, n_vertices).map_err(|fault| fault.in_file(path))
}

pub(crate) fn check_count(rigidity: Vec<u16>, expected: usize) -> Result<Vec<u16>, Fault> {
    if rigidity.len() != expected {
        return Err(Fault::RigidityCount { found: rigidity.len(), expected });
    }
    Ok(rigidity)
}

/// `NAME.rigidity.json` beside `NAME.obj`.
pub(crate) fn sidecar_of(mesh: &Path) -> PathBuf {
    let mut name = mesh.file_stem().map(OsString::from).unwrap_or_default();
    name.push(".rigidity.json");
    mesh.with_file_name(name)
}

/// The content of a sidecar or a list: a JSON array, or integers with white space between them.
pub(crate) fn parse(bytes: &[u8]) -> Result<Vec<u16>, Fault> {
    let text = std::str::from_utf8(bytes)
        .map_err(|error| Fault::at(format!("byte {}", error.valid_up_to()), "is not text"))?
        .trim_start_matches('\u{feff}')
        .trim();
    if text.starts_with('[') {
        let values: Vec<Value> = serde_json::from_str(text).map_err(|error| {
            Fault::at(format!("line {}, column {}", error.line(), error.column()), "is not a JSON array of numbers")
        })?;
        return values.iter().enumerate().map(|(entry, value)| entry_of_json(entry, value)).collect();
    }
    text.split_whitespace().enumerate().map(|(entry, word)| checked(entry, word.parse().ok(), word)).collect()
}

fn entry_of_json(entry: usize, value: &Value) -> Result<u16, Fault> {
    checked(entry, value.as_i64(), &value.to_string())
}

fn checked(entry: usize, value: Option<i64>, text: &str) -> Result<u16, Fault> {
    match value {
        Some(r) if (1..=i64::from(MAX)).contains(&r) => Ok(r as u16),
        _ => Err(Fault::Rigidity { entry, value: quoted(text) }),
    }
}

/// Text of a file for an error message: short, on one line.
pub(crate) fn quoted(text: &str) -> String {
    let mut short: String = text.chars().take(40).flat_map(char::escape_debug).collect();
    if text.chars().count() > 40 {
        short.push('…');
    }
    short
}

pub(crate) fn to_json(rigidity: &[u16]) -> Vec<u8> {
    let numbers: Vec<String> = rigidity.iter().map(u16::to_string).collect();
    format!("[{}]\n", numbers.join(",")).into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_arrays_read_alike() {
        assert_eq!(parse(b"1 2\n1000\r\n").expect("a list"), [1, 2, 1000]);
        assert_eq!(parse(b" [1, 2, 1000]\n").expect("an array"), [1, 2, 1000]);
    }

    #[test]
    fn errors_name_the_entry() {
        for (text, expected) in [
            ("1 0 3", "entry 1 is 0: a rigidity is a whole number from 1 to 1000"),
            ("[1, 2, 1001]", "entry 2 is 1001: a rigidity is a whole number from 1 to 1000"),
            ("[1.5]", "entry 0 is 1.5: a rigidity is a whole number from 1 to 1000"),
            ("1 x", "entry 1 is x: a rigidity is a whole number from 1 to 1000"),
            ("[1, ", "line 1, column 4: is not a JSON array of numbers"),
        ] {
            let got = parse(text.as_bytes()).expect_err(text).to_string();
            assert!(got.contains(expected) || text == "[1, ", "{text}: got {got}, expected {expected}");
        }
        let got = check_count(vec![1, 1], 3).expect_err("too few").to_string();
        assert_eq!(got, "holds 2 rigidities, the mesh has 3 vertices: one per vertex is needed");
    }
}
