//! Looking things up in the JSON of a glTF document, with errors that name the place.

use crate::Fault;
use serde_json::Value;

/// The list under a key of the document; absent is empty.
pub(super) fn list<'a>(document: &'a Value, key: &str) -> Result<&'a [Value], Fault> {
    match document.get(key) {
        None => Ok(&[]),
        Some(Value::Array(items)) => Ok(items),
        Some(_) => Err(Fault::at(key, "is not a list")),
    }
}

/// A whole number that is not negative.
pub(super) fn number(object: &Value, key: &str, place: &str) -> Result<Option<u64>, Fault> {
    match object.get(key) {
        None => Ok(None),
        Some(value) => {
            let whole = value.as_u64().or_else(|| {
                // Some writers put a point behind every number.
                value.as_f64().filter(|x| x.fract() == 0.0 && (0.0..9e15).contains(x)).map(|x| x as u64)
            });
            whole.map(Some).ok_or_else(|| Fault::at(place, format!("{key} is not a whole number from 0")))
        }
    }
}

/// The item of a list that an index under `key` names.
pub(super) fn reference(object: &Value, key: &str, place: &str, what: &str, n: usize) -> Result<Option<usize>, Fault> {
    let Some(index) = number(object, key, place)? else { return Ok(None) };
    if index >= n as u64 {
        return Err(Fault::at(place, format!("{key} names {what} {index}, the file has {n}")));
    }
    Ok(Some(index as usize))
}

/// `N` numbers under a key.
pub(super) fn numbers<const N: usize>(object: &Value, key: &str, place: &str) -> Result<Option<[f64; N]>, Fault> {
    let Some(value) = object.get(key) else { return Ok(None) };
    let bad = || Fault::at(place, format!("{key} is not {N} finite numbers"));
    let items = value.as_array().filter(|items| items.len() == N).ok_or_else(bad)?;
    let mut numbers = [0.0; N];
    for (number, item) in numbers.iter_mut().zip(items) {
        *number = item.as_f64().filter(|x| x.is_finite()).ok_or_else(bad)?;
    }
    Ok(Some(numbers))
}

/// The text under `name`, if it says anything.
pub(super) fn name(object: &Value) -> Option<&str> {
    object.get("name").and_then(Value::as_str).filter(|name| !name.trim().is_empty())
}
