//! The validator: getting it, and asking it.

use crate::assets;
use crate::failure::Failure;
use serde_json::Value;
use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The release that was tried.
const PACKAGE: &str = "gltf-validator@2.0.0-dev.3.10";

/// Errors by kind, a sentence for each.
pub(super) type Report = BTreeMap<String, Vec<String>>;

/// The folder that builds go to.
pub(super) fn target() -> PathBuf {
    match std::env::var_os("CARGO_TARGET_DIR") {
        Some(target) => target.into(),
        None => assets::folder().join("../target"),
    }
}

/// The folder of the package, installed by npm where it is not there yet.
pub(super) fn install(target: &Path) -> Result<PathBuf, Failure> {
    let prefix = target.join("gltf-validator");
    let package = prefix.join("node_modules/gltf-validator");
    if package.join("package.json").is_file() {
        return Ok(package);
    }
    fs::create_dir_all(&prefix).map_err(|source| Failure::File { path: prefix.clone(), source })?;
    let mut npm = Command::new("npm");
    npm.args(["install", "--no-audit", "--no-fund", "--no-save", "--loglevel", "error", "--prefix"]).arg(&prefix);
    let status = npm.arg(PACKAGE).stdout(Stdio::null()).status();
    match status {
        Ok(status) if status.success() && package.join("package.json").is_file() => Ok(package),
        Ok(_) => Err(Failure::NoValidator(PACKAGE)),
        Err(source) => Err(Failure::NoNode { program: "npm", source }),
    }
}

/// The errors of each file.
pub(super) fn validate(package: &Path, files: &[&PathBuf]) -> Result<HashMap<PathBuf, Report>, Failure> {
    let no_node = |source| Failure::NoNode { program: "node", source };
    let script = assets::folder().join("../tools/validate.mjs");
    let mut node = Command::new("node");
    node.arg(script).arg(package).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = node.spawn().map_err(no_node)?;
    let list: String = files.iter().map(|file| format!("{}\n", file.display())).collect();
    if let Some(mut input) = child.stdin.take() {
        // It reads the whole list before it answers.
        input.write_all(list.as_bytes()).map_err(no_node)?;
    }
    let output = child.wait_with_output().map_err(no_node)?;
    let mut reports = HashMap::new();
    for line in String::from_utf8_lossy(&output.stdout).lines() {
        let answer: Value = serde_json::from_str(line).unwrap_or_default();
        let Some(file) = answer["file"].as_str() else { continue };
        let mut report = Report::new();
        for issue in answer["issues"].as_array().into_iter().flatten() {
            let text = |key: &str| issue[key].as_str().unwrap_or_default();
            if issue["severity"] == 0 {
                let sentence = format!("{} ({})", text("message"), text("pointer"));
                report.entry(text("code").to_owned()).or_default().push(sentence);
            }
        }
        if let Some(reason) = answer["refused"].as_str() {
            report.entry("REFUSED".into()).or_default().push(reason.to_owned());
        }
        reports.insert(PathBuf::from(file), report);
    }
    if !output.status.success() || reports.len() != files.len() {
        return Err(Failure::Stopped {
            program: format!("the validator, after {} of {} files,", reports.len(), files.len()),
        });
    }
    Ok(reports)
}
