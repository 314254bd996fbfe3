//! r from files: sidecars, lists in text, and what mesh files carry.

use crate::{Fault, Format, OpenError, budget, files};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The largest r that is accepted: neighborhoods that wide span any mesh people work with.
pub(crate) const MAX: u16 = 1000;

/// Reads r from a text file of integers, a JSON array, or a mesh file that carries it.
///
/// One entry per file vertex is expected, `n_vertices` in all, each from 1 to 1000; the error names the first entry
/// that is not.
pub fn read_rigidity(path: &Path, n_vertices: usize) -> Result<Vec<u16>, OpenError> {
    if Format::of(path).is_some() {
        let rigidity = crate::open(path)?.rigidity.ok_or_else(|| Fault::NoRigidity.in_file(path))?;
        check_count(rigidity.len(), n_vertices).map_err(|fault| fault.in_file(path))?;
        return Ok(rigidity);
    }
    let bytes = files::read(path, budget::TEXT_BYTES)?;
    parse(&bytes, n_vertices).map_err(|fault| fault.in_file(path))
}

fn check_count(found: usize, expected: usize) -> Result<(), Fault> {
    if found != expected {
        return Err(Fault::RigidityCount { found, expected });
    }
    Ok(())
}

/// `NAME.rigidity.json` beside `NAME.obj`.
pub(crate) fn sidecar_of(mesh: &Path) -> PathBuf {
    let mut name = mesh.file_stem().map(OsString::from).unwrap_or_default();
    name.push(".rigidity.json");
    mesh.with_file_name(name)
}

/// The content of a sidecar or a list of `expected` entries: a JSON array, or integers with white space between them.
///
/// Entries beyond those expected are counted and not kept.
pub(crate) fn parse(bytes: &[u8], expected: usize) -> Result<Vec<u16>, Fault> {
    let text = std::str::from_utf8(bytes)
        .map_err(|error| Fault::at(format!("byte {}", error.valid_up_to()), "is not text"))?
        .trim_start_matches('\u{feff}')
        .trim();
    let Some(array) = text.strip_prefix('[') else {
        return collect(text.split_whitespace(), expected);
    };
    // A list of whole numbers is split here: a JSON value for each of millions of entries would take gigabytes.
    let entries = array.strip_suffix(']').ok_or_else(|| Fault::Container("is a JSON array without its end".into()))?;
    collect(entries.split(',').map(str::trim).filter(|_| !entries.trim().is_empty()), expected)
}

fn collect<'a>(entries: impl Iterator<Item = &'a str>, expected: usize) -> Result<Vec<u16>, Fault> {
    let (mut rigidity, mut found) = (Vec::new(), 0);
    for (entry, text) in entries.enumerate() {
        if entry < expected {
            rigidity.push(checked(entry, text)?);
        }
        found += 1;
    }
    check_count(found, expected)?;
    Ok(rigidity)
}

fn checked(entry: usize, text: &str) -> Result<u16, Fault> {
    match text.parse() {
        Ok(r) if (1..=MAX).contains(&r) => Ok(r),
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
        assert_eq!(parse(b"1 2\n1000\r\n", 3).expect("a list"), [1, 2, 1000]);
        assert_eq!(parse(b" [1, 2, 1000]\n", 3).expect("an array"), [1, 2, 1000]);
    }

    #[test]
    fn errors_name_the_entry() {
        for (text, expected) in [
            ("1 0 3", "entry 1 is 0: a rigidity is a whole number from 1 to 1000"),
            ("[1, 2, 1001]", "entry 2 is 1001: a rigidity is a whole number from 1 to 1000"),
            ("[1.5]", "entry 0 is 1.5: a rigidity is a whole number from 1 to 1000"),
            ("1 x", "entry 1 is x: a rigidity is a whole number from 1 to 1000"),
            ("[1, ", "is a JSON array without its end"),
            ("[1, ]", "entry 1 is : a rigidity is"),
            ("[[1], 2]", "entry 0 is [1]: a rigidity is"),
        ] {
            let got = parse(text.as_bytes(), text.split(' ').count()).expect_err(text).to_string();
            assert!(got.contains(expected), "{text}: got {got}, expected {expected}");
        }
    }

    #[test]
    fn lists_of_another_length_are_refused_with_both_counts() {
        for text in ["1 1", "[1, 1]", "1 1 1 0", "[1, 1, 1, 0]"] {
            let got = parse(text.as_bytes(), 3).expect_err(text).to_string();
            let found = text.split(' ').count();
            let expected = format!("holds {found} rigidities, the mesh has 3 vertices: one per vertex is needed");
            assert_eq!(got, expected, "{text}");
        }
    }
}
