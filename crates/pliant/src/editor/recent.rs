//! Files that were opened or saved lately, newest first.

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::preferences::forgiving;

/// Name of the list among the settings.
pub(super) const NAME: &str = "recent";
/// What a menu shows at a glance (by eye).
const AT_MOST: usize = 12;

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Entry {
    path: PathBuf,
    /// Milliseconds since 1970.
    at: u64,
}

/// Files that were opened or saved lately.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Recent {
    files: Vec<Entry>,
}

impl Recent {
    /// Puts a file first.
    pub fn add(&mut self, path: &Path) {
        let full = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        // A path that is no text could not be stored.
        if full.to_str().is_none() {
            return;
        }
        let at = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_millis() as u64);
        // A clock that was set back must not put it behind older ones.
        let at = at.max(self.files.first().map_or(0, |newest| newest.at.saturating_add(1)));
        self.files.push(Entry { path: full, at });
        self.order();
    }

    /// Takes a file off the list: it is gone.
    pub fn remove(&mut self, path: &Path) {
        self.files.retain(|entry| entry.path != path);
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.files.clear();
    }

    /// The files, newest first.
    pub fn paths(&self) -> impl ExactSizeIterator<Item = &Path> {
        self.files.iter().map(|entry| entry.path.as_path())
    }

    /// The folder of the newest.
    pub fn folder(&self) -> Option<&Path> {
        self.files.first()?.path.parent()
    }

    fn order(&mut self) {
        self.files.sort_by_key(|entry| std::cmp::Reverse(entry.at));
        let mut seen = std::collections::HashSet::new();
        self.files.retain(|entry| seen.insert(entry.path.clone()));
        self.files.truncate(AT_MOST);
    }
}

/// The list of this window with what other windows have added to the stored one. An empty list was emptied by hand.
pub(super) fn merged(stored: Option<&Value>, own: Value) -> Value {
    let mut list: Recent = forgiving(&own);
    if let Some(stored) = stored.filter(|_| !list.files.is_empty()) {
        list.files.extend(forgiving::<Recent>(stored).files);
    }
    list.order();
    serde_json::to_value(list).unwrap_or(own)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(recent: &Recent) -> Vec<String> {
        recent.paths().map(|path| path.file_name().unwrap_or_default().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn the_newest_comes_first_once_and_old_ones_give_way() {
        let mut recent = Recent::default();
        for name in ["a.obj", "b.obj", "a.obj"] {
            recent.add(Path::new(name));
        }
        assert_eq!(names(&recent), ["a.obj", "b.obj"]);
        for k in 0..20 {
            recent.add(Path::new(&format!("{k}.obj")));
        }
        assert_eq!((recent.paths().len(), names(&recent)[0].as_str()), (AT_MOST, "19.obj"));
        recent.remove(&std::path::absolute("19.obj").expect("a path"));
        assert_eq!(names(&recent)[0], "18.obj");
    }

    #[test]
    fn two_windows_share_one_list() {
        let (mut one, mut other) = (Recent::default(), Recent::default());
        one.add(Path::new("one.obj"));
        other.add(Path::new("other.obj"));
        let value = |recent: &Recent| serde_json::to_value(recent).expect("plain values");
        let both: Recent = forgiving(&merged(Some(&value(&one)), value(&other)));
        assert_eq!(both.paths().len(), 2);
        let emptied: Recent = forgiving(&merged(Some(&value(&one)), value(&Recent::default())));
        assert_eq!(emptied.paths().len(), 0);
    }
}
