//! What files are called in the report: by their last names, so that a report that is passed on does not tell where somebody
//! keeps his files. Only if two different files would get one name, paths are told as they were typed.

use std::collections::BTreeMap;
use std::path::Path;

use crate::cli::args::{CompareOptions, Entry, Way};

/// Names of all files of a comparison, and the commands that use them.
pub(super) struct Names {
    pub(super) mesh: String,
    handles: String,
    output: String,
    /// By entry: what follows `rring:`, shortened.
    rigidity: Vec<Option<String>>,
    entries: Vec<Entry>,
    /// Options that are not the default, for every command.
    options: Vec<String>,
    /// Paths as they were typed, with what they are called here, the longest first.
    paths: Vec<(String, String)>,
}

impl Names {
    pub(super) fn new(options: &CompareOptions) -> Names {
        let rigidity = || options.entries.iter().filter_map(Entry::file).map(Path::new);
        let paths = || [&*options.mesh, &*options.handles, &*options.output].into_iter().chain(rigidity());
        let mut by_name = BTreeMap::new();
        let is_ambiguous = paths().any(|path| *by_name.entry(last(path)).or_insert(path) != path);
        let shown = |path: &Path| if is_ambiguous { path.display().to_string() } else { last(path) };
        let mut typed: Vec<_> = paths().map(|path| (path.display().to_string(), shown(path))).collect();
        typed.sort_by_key(|(path, _)| std::cmp::Reverse(path.len()));
        Names {
            paths: typed,
            mesh: shown(&options.mesh),
            handles: shown(&options.handles),
            output: shown(&options.output),
            rigidity: options.entries.iter().map(|entry| entry.file().map(|file| shown(file.as_ref()))).collect(),
            entries: options.entries.clone(),
            options: changed(options),
        }
    }

    /// The same text with paths of files as they are called here.
    pub(super) fn shorten(&self, text: &str) -> String {
        self.paths.iter().fold(text.to_owned(), |text, (path, name)| text.replace(path, name))
    }

    /// The name of the file with an entry's rigidity.
    pub(super) fn rigidity(&self, entry: usize) -> Option<&str> {
        self.rigidity[entry].as_deref()
    }

    /// The command that makes the report.
    pub(super) fn command(&self) -> String {
        let mut words = vec!["pliant compare".to_owned(), quoted(&self.mesh)];
        words.extend(["--handles".to_owned(), quoted(&self.handles)]);
        for (k, entry) in self.entries.iter().enumerate() {
            let text = self.rigidity[k].as_ref().map_or_else(|| entry.to_string(), |file| format!("rring:{file}"));
            words.extend(["--entry".to_owned(), quoted(&text)]);
        }
        words.extend(self.options.iter().cloned());
        words.extend(["-o".to_owned(), quoted(&self.output)]);
        words.join(" ")
    }

    /// The command that makes the mesh of one entry.
    pub(super) fn deform(&self, entry: usize) -> String {
        let mut words = vec!["pliant deform".to_owned(), quoted(&self.mesh)];
        words.extend(["--handles".to_owned(), quoted(&self.handles)]);
        words.extend(["--method".to_owned(), self.entries[entry].method().name().to_owned()]);
        let mut option = |name: &str, value: String| words.extend([name.to_owned(), value]);
        match &self.entries[entry].way {
            Way::Rring(None) | Way::Arap => {}
            Way::Rring(Some(r)) => option("--rigidity", quoted(self.rigidity(entry).unwrap_or(r))),
            Way::SrArap { alpha } => option("--alpha", alpha.to_string()),
            Way::Embedded { nodes, node_neighbors } => {
                option("--nodes", nodes.to_string());
                option("--node-neighbors", node_neighbors.to_string());
            }
        }
        words.extend(self.options.iter().cloned());
        words.extend(["-o".to_owned(), "bent.glb".to_owned()]);
        words.join(" ")
    }
}

/// Options that are not as they are by default, as words.
fn changed(options: &CompareOptions) -> Vec<String> {
    use clap::CommandFactory;
    use pliant_meshfile::Welding;
    let solving = &options.solving;
    let weld = match options.weld {
        Welding::Exact => "exact".to_owned(),
        Welding::Never => "never".to_owned(),
        Welding::Within(distance) => distance.to_string(),
    };
    let values = [
        ("weld", weld),
        ("solver", solving.solver.name().to_owned()),
        ("weights", solving.weights.name().to_owned()),
        ("start", solving.start.name().to_owned()),
        ("max-iterations", solving.max_iterations.to_string()),
        ("tolerance", solving.tolerance.to_string()),
        ("threads", solving.threads.map(|n| n.to_string()).unwrap_or_default()),
    ];
    let command = crate::cli::args::Arguments::command();
    let compare = command.find_subcommand("compare").expect("this command");
    let is_default = |name: &str, value: &str| {
        let argument = compare.get_arguments().find(|argument| argument.get_long() == Some(name));
        let defaults = argument.map(|argument| argument.get_default_values()).unwrap_or_default();
        defaults.first().map_or(value.is_empty(), |default| *default == value)
    };
    let changed = values.into_iter().filter(|(name, value)| !is_default(name, value));
    changed.flat_map(|(name, value)| [format!("--{name}"), value]).collect()
}

fn last(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// A word as a shell takes it for one.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_.,:=/+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::cli::args::{Arguments, Command};

    fn names(words: &[&str]) -> Names {
        let line = ["pliant", "compare"].iter().chain(words);
        let parsed = Arguments::try_parse_from(line).expect("a legal command");
        let Some(Command::Compare(options)) = parsed.command else { panic!("not compare") };
        Names::new(&options)
    }

    #[test]
    fn commands_name_files_without_their_folders_and_options_that_were_changed() {
        let short = ["/home/me/a bar.obj", "--handles", "/tmp/h.json", "-o", "out/r.html"];
        let more =
            ["--entry", "rring:in/r.txt", "--entry", "embedded:nodes=9", "--tolerance", "1e-6", "--threads", "2"];
        let names = names(&[&short[..], &more].concat());
        assert_eq!(
            names.command(),
            "pliant compare 'a bar.obj' --handles h.json --entry rring:r.txt --entry embedded:nodes=9 \
             --tolerance 0.000001 --threads 2 -o r.html"
        );
        assert_eq!(
            names.deform(0),
            "pliant deform 'a bar.obj' --handles h.json --method rring --rigidity r.txt --tolerance 0.000001 \
             --threads 2 -o bent.glb"
        );
        assert!(names.deform(1).contains("--method embedded --nodes 9 --node-neighbors 4 --tolerance"));
    }

    #[test]
    fn by_default_commands_are_short() {
        let names = names(&["bar.obj", "--handles", "h.json", "--entry", "arap", "-o", "r.html"]);
        assert_eq!(names.command(), "pliant compare bar.obj --handles h.json --entry arap -o r.html");
    }

    #[test]
    fn files_of_one_name_are_told_apart() {
        let files = ["--entry", "rring:a/r.txt", "--entry", "rring:b/r.txt"];
        let names = names(&[&["in/bar.obj", "--handles", "h.json", "-o", "r.html"][..], &files].concat());
        assert!(names.command().contains("in/bar.obj") && names.command().contains("rring:b/r.txt"));
    }
}
