//! What all fuzz targets do with an input.

#[cfg(feature = "project")]
mod project;

use pliant_hostile::exercise;
use pliant_meshfile::Format;
use std::cell::OnceCell;
use tempfile::TempDir;

thread_local! {
    static FOLDER: OnceCell<TempDir> = const { OnceCell::new() };
}

/// Opens an input as a project.
#[cfg(feature = "project")]
pub fn opens_or_refuses_project(bytes: &[u8]) {
    FOLDER.with(|folder| {
        let folder = folder.get_or_init(|| exercise::scratch().expect("a temporary folder"));
        project::opens_or_refuses(bytes, folder.path());
    });
}

/// Opens an input and does everything with it that the program does.
pub fn opens_or_refuses(bytes: &[u8], format: Format) {
    FOLDER.with(|folder| {
        let folder = folder.get_or_init(|| exercise::scratch().expect("a temporary folder"));
        exercise::in_memory(bytes, format, folder.path());
    });
}
