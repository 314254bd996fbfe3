//! Pliant: bend any mesh, and say where it is stiff. The editor and the command line over one document.

pub mod cli;
pub mod comparing;
pub mod document;
pub mod editor;
pub mod learning;
pub mod posing;
pub mod project;
pub mod solving;
#[cfg(test)]
mod test_scenes;
pub mod tools;
pub mod viewport;
