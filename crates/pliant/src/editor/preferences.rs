//! What the editor remembers from one start to the next: named values in one file of the platform's data folder.
//!
//! Each part of the editor stores what it likes under a name of its own ([`Preferences::get`], [`Preferences::set`]). Reading is
//! forgiving: what is broken, unknown or of another kind is as if it had never been stored, each field for itself, so that
//! no file keeps the editor from starting. Writing touches only what changed here, so that two windows do not undo each
//! other's settings.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::recent;

const FILE: &str = "settings.json";
/// Bytes of a settings file that is read: hundreds of times what they take.
const MOST_BYTES: u64 = 4 << 20;

/// Named values that last. Without a folder they last as long as the window.
#[derive(Debug, Default)]
pub struct Preferences {
    file: Option<PathBuf>,
    values: Map<String, Value>,
    /// Names of values that differ from those in the file.
    changed: BTreeSet<String>,
    /// One writer at a time.
    writing: Arc<Mutex<()>>,
}

impl Preferences {
    /// The settings in `folder`.
    pub fn load(folder: &Path) -> Preferences {
        let file = folder.join(FILE);
        Preferences { values: read(&file), file: Some(file), ..Preferences::default() }
    }

    /// What is stored under `name`; of a record, whatever of it can be used.
    pub fn get<T: Default + Serialize + DeserializeOwned>(&self, name: &str) -> T {
        self.values.get(name).map_or_else(T::default, forgiving)
    }

    /// Stores a value under a name.
    pub fn set<T: Serialize>(&mut self, name: &str, value: &T) {
        let Ok(value) = serde_json::to_value(value) else { return };
        if self.values.get(name) != Some(&value) {
            self.values.insert(name.to_owned(), value);
            self.changed.insert(name.to_owned());
        }
    }

    /// Whether something was not written yet.
    pub fn is_changed(&self) -> bool {
        !self.changed.is_empty() && self.file.is_some()
    }

    /// What is to be written, for a thread that does it.
    pub fn take_changes(&mut self) -> Option<Changes> {
        let file = self.file.clone().filter(|_| !self.changed.is_empty())?;
        let changed = std::mem::take(&mut self.changed);
        let values = changed.into_iter().filter_map(|name| self.values.get(&name).map(|value| (name, value.clone())));
        Some(Changes { file, values: values.collect(), writing: self.writing.clone() })
    }
}

/// Values on their way to the file.
pub struct Changes {
    file: PathBuf,
    values: Map<String, Value>,
    writing: Arc<Mutex<()>>,
}

impl Changes {
    /// Writes them; what other windows have written meanwhile stays. A failure is not worth a message: nothing that was
    /// made is lost.
    pub fn write(self) {
        let _one_at_a_time = self.writing.lock().unwrap_or_else(PoisonError::into_inner);
        let mut all = read(&self.file);
        for (name, value) in self.values {
            let value = if name == recent::NAME { recent::merged(all.get(&name), value) } else { value };
            all.insert(name, value);
        }
        let written =
            self.file.parent().map_or(Ok(()), std::fs::create_dir_all).map_err(|error| error.to_string()).and_then(
                |()| {
                    let text = serde_json::to_string_pretty(&all).unwrap_or_default();
                    pliant_meshfile::replace_file(&self.file, |file| file.write_all(text.as_bytes()))
                        .map_err(|error| error.to_string())
                },
            );
        if let Err(error) = written {
            log::warn!("settings are not kept: {error}");
        }
    }
}

/// The values of a file; none of one that is missing, broken, or not of this program.
fn read(file: &Path) -> Map<String, Value> {
    let is_sound = std::fs::metadata(file).is_ok_and(|found| found.is_file() && found.len() <= MOST_BYTES);
    let bytes = if is_sound { std::fs::read(file).unwrap_or_default() } else { Vec::new() };
    match serde_json::from_slice(&bytes) {
        Ok(Value::Object(values)) => values,
        _ => Map::new(),
    }
}

/// A value of stored data. Of a record, each field that can be used is; the others are as by default.
pub(super) fn forgiving<T: Default + Serialize + DeserializeOwned>(stored: &Value) -> T {
    let Ok(default) = serde_json::to_value(T::default()) else { return T::default() };
    // A list would be taken for the fields of a record in their order.
    if default.is_object() != stored.is_object() {
        return if default.is_object() { T::default() } else { T::deserialize(stored).unwrap_or_default() };
    }
    if let Ok(whole) = T::deserialize(stored) {
        return whole;
    }
    let (Value::Object(stored), Value::Object(mut sound)) = (stored, default) else { return T::default() };
    for (name, value) in stored {
        let Some(default) = sound.get(name).cloned() else { continue };
        sound.insert(name.clone(), value.clone());
        if T::deserialize(Value::Object(sound.clone())).is_err() {
            sound.insert(name.clone(), default);
        }
    }
    T::deserialize(Value::Object(sound)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::Look;
    use crate::tools::Options;

    fn written(settings: &mut Preferences) {
        settings.take_changes().expect("something changed").write();
    }

    #[test]
    fn what_was_set_is_there_at_the_next_start_and_another_windows_settings_stay() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let data = folder.path().join("made when needed");
        let (mut one, mut other) = (Preferences::load(&data), Preferences::load(&data));
        let look = Look { wireframe: true, opacity: 0.25, ..Look::default() };
        one.set("look", &look);
        other.set("other", &7);
        written(&mut one);
        written(&mut other);
        assert!(!one.is_changed());
        let next = Preferences::load(&data);
        assert_eq!(next.get::<Look>("look"), look);
        assert_eq!(next.get::<u32>("other"), 7);
        assert_eq!(next.get::<Vec<u32>>("never set"), Vec::<u32>::new());
    }

    #[test]
    fn of_broken_settings_whatever_is_sound_is_used() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join(FILE);
        for text in ["", "{", "[1, 2]", "\u{0}\u{1}", "{\"look\": 3, \"options\": [1]}"] {
            std::fs::write(&file, text).expect("written");
            let settings = Preferences::load(folder.path());
            assert_eq!(settings.get::<Look>("look"), Look::default(), "{text:?}");
            assert_eq!(settings.get::<Options>("options"), Options::default(), "{text:?}");
        }
        let text = r#"{"look": {"wireframe": true, "color_by": "smell", "opacity": "much", "new": 1, "grid": false}}"#;
        std::fs::write(&file, text).expect("written");
        let look = Preferences::load(folder.path()).get::<Look>("look");
        assert_eq!(look, Look { wireframe: true, grid: false, ..Look::default() });
    }
}
