//! Is there a Vulkan driver? The image tests draw with one; a software one will do.
//!
//! Looked for cheaply, without loading anything: the loader's library and a driver's description (ICD).

use crate::failure::Failure;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What Debian and Ubuntu call the loader and Mesa's drivers, among them the software one.
const PACKAGES: [&str; 2] = ["libvulkan1", "mesa-vulkan-drivers"];

/// Makes sure that a driver is there: installs Mesa's on Debian and its kin, elsewhere says what to install.
pub(crate) fn ensure() -> Result<(), Failure> {
    if let Some(named) = driver_named_by_environment() {
        return named;
    }
    if !cfg!(target_os = "linux") || is_present() {
        // Elsewhere wgpu draws with what the system brings: Direct3D or Metal.
        return Ok(());
    }
    if !Path::new("/etc/debian_version").exists() {
        return Err(Failure::NoVulkan);
    }
    eprintln!("No Vulkan driver found: installing Mesa's ({}).", PACKAGES.join(" "));
    // Old package lists name versions that are gone; without a network the installation may still work from a cache.
    let _ = apt_get(&["update"]);
    let installed = apt_get(&[&["install", "--yes", "--no-install-recommends"][..], &PACKAGES].concat());
    if installed && is_present() { Ok(()) } else { Err(Failure::NotInstalled(PACKAGES.join(" "))) }
}

/// If the environment names drivers, the loader looks nowhere else: then one of the files must be there.
fn driver_named_by_environment() -> Option<Result<(), Failure>> {
    let named = |name: &'static str| Some((name, std::env::var(name).ok().filter(|files| !files.is_empty())?));
    let (variable, files) = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].into_iter().find_map(named)?;
    let found = std::env::split_paths(&files).any(|file| file.exists());
    Some(if found { Ok(()) } else { Err(Failure::NoNamedDriver { variable, files }) })
}

/// Runs apt-get, through sudo unless this is root; whether it succeeded. It may not even start: not everybody has sudo.
fn apt_get(arguments: &[&str]) -> bool {
    let mut command = if is_root() { Command::new("apt-get") } else { Command::new("sudo") };
    if !is_root() {
        // Asks for no password: in a script nobody could answer.
        command.args(["--non-interactive", "apt-get"]);
    }
    succeeds(command.args(arguments).env("DEBIAN_FRONTEND", "noninteractive"))
}

fn succeeds(command: &mut Command) -> bool {
    command.status().is_ok_and(|status| status.success())
}

/// Effective user id 0, as the kernel tells.
fn is_root() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status.lines().any(|line| line.strip_prefix("Uid:").is_some_and(|ids| ids.split_whitespace().nth(1) == Some("0")))
}

fn is_present() -> bool {
    has_loader() && has_driver()
}

fn has_loader() -> bool {
    let cache = Command::new("/sbin/ldconfig").arg("-p").output();
    let cached = cache.is_ok_and(|out| String::from_utf8_lossy(&out.stdout).contains("libvulkan.so.1"));
    let folders = std::env::var("LD_LIBRARY_PATH").unwrap_or_default();
    cached || folders.split(':').any(|folder| Path::new(folder).join("libvulkan.so.1").exists())
}

/// Whether a driver is described in the loader's usual folders.
fn has_driver() -> bool {
    let mut folders: Vec<PathBuf> =
        ["/usr/share", "/usr/local/share", "/etc"].iter().map(|f| Path::new(f).join("vulkan/icd.d")).collect();
    let data = std::env::var("XDG_DATA_DIRS").unwrap_or_default();
    folders.extend(data.split(':').filter(|f| !f.is_empty()).map(|f| Path::new(f).join("vulkan/icd.d")));
    let has_json = |folder: &PathBuf| {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries.map(|e| e.path()).any(|path| path.extension().is_some_and(|e| e == "json"))
    };
    folders.iter().any(has_json)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_cannot_be_started_has_not_succeeded() {
        assert!(!succeeds(&mut Command::new("/nowhere/sudo")));
    }

    #[test]
    fn an_installation_that_failed_names_the_command_to_run_by_hand() {
        let said = Failure::NotInstalled(PACKAGES.join(" ")).to_string();
        assert!(said.contains("apt-get install libvulkan1 mesa-vulkan-drivers"), "{said}");
    }
}
