//! That opening a file opens no other outside its folder, seen from the system's side.

use crate::references::Traps;
use crate::strace;
use std::io::{Error, Result};
use std::path::Path;

/// Calls that open, run, make, rename or remove something. Looking (`stat`, `readlink`) is how links are followed to see
/// where they lead.
const CALLS: &str = "open,openat,openat2,creat,execve,execveat,rename,renameat,renameat2,link,linkat,symlink,symlinkat,\
unlink,unlinkat,truncate,chmod,fchmodat,mkdir,mkdirat,mknod,mknodat,connect,socket,write";

/// What a worker reads of its own process to measure itself.
const OWN: &[&str] = &["/proc/self/status", "/proc/self/clear_refs", "/sys/fs/cgroup", "/proc/self/cgroup"];

/// What was seen.
#[derive(Debug)]
pub struct Seen {
    /// Files that were tried.
    pub tried: usize,
    /// Calls that opened or changed something meanwhile.
    pub calls: usize,
    /// Calls that went elsewhere.
    pub foreign: Vec<String>,
}

/// Tries all files with references in a traced worker of `program`.
pub fn run(program: &Path) -> Result<Seen> {
    strace::check()?;
    let n = Traps::new()?.n();
    let calls = format!("trace={CALLS}");
    let (output, lines) = strace::traced(&["-e", &calls], program, &["worker", "references", "0", &n.to_string()])?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        return Err(Error::other(format!("the traced worker ended with {}: {said}", output.status)));
    }
    let mut seen = Seen { tried: 0, calls: 0, foreign: Vec::new() };
    // The worker lays out its files before it begins with the first, and clears them away after the last.
    let mut begun = false;
    for line in &lines {
        if line.starts_with("write(1<") {
            begun = line.contains("\"begin ");
            seen.tried += usize::from(begun);
        } else if begun && !line.starts_with("write(") && !line.starts_with("+++") && !line.starts_with("---") {
            seen.calls += 1;
            if !is_allowed(line) {
                seen.foreign.push(line.clone());
            }
        }
    }
    if seen.tried != n {
        return Err(Error::other(format!("{} of {n} files were seen in the trace", seen.tried)));
    }
    Ok(seen)
}

/// Whether every file in a call lies in the folder of the models or in the one that is saved into.
fn is_allowed(call: &str) -> bool {
    if OWN.iter().any(|own| call.contains(own)) {
        return true;
    }
    let names = strace::names(call);
    let roots = ["/dev/shm".to_owned(), std::env::temp_dir().to_string_lossy().trim_end_matches('/').to_owned()];
    // What a path without `..` and with all links followed begins with. A number of the process stands for what it opened.
    let inside = |name: &String| {
        let scratch = roots.iter().any(|root| name.strip_prefix(root).is_some_and(|rest| rest.starts_with("/.tmp")));
        let folder = name.contains("/inside/") || name.ends_with("/inside") || !name.contains("/outside");
        scratch && folder && !name.contains("/../")
    };
    let files = names.iter().filter(|name| name.starts_with('/'));
    !names.is_empty() && files.clone().all(inside) && names.iter().all(|name| name.starts_with('/'))
}
