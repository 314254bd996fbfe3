//! The most a file may ask for. Beyond these limits it is refused by name, before memory is reserved.
//!
//! The figures are generous for a person's machine (a 20 M vertex mesh needs some gigabytes to solve) and small enough
//! that a hostile file cannot exhaust it.

use crate::Fault;

/// Size of any one file, in bytes.
pub(crate) const FILE_BYTES: u64 = 2 << 30;
/// Size of the JSON part of a glTF file, in bytes.
pub(crate) const JSON_BYTES: u64 = 256 << 20;
/// Size of a material library or a rigidity file, in bytes.
pub(crate) const TEXT_BYTES: u64 = 256 << 20;
/// File vertices of one model.
pub(crate) const VERTICES: u64 = 20_000_000;
/// Triangles of one model.
pub(crate) const TRIANGLES: u64 = 40_000_000;
/// Nodes of one glTF scene graph.
pub(crate) const NODES: u64 = 1_000_000;
/// Corners of one polygon.
pub(crate) const POLYGON_CORNERS: u64 = 65_536;

/// Refuses `found` beyond `limit`, naming `what` is counted.
pub(crate) fn check(what: &'static str, found: u64, limit: u64) -> Result<(), Fault> {
    if found > limit {
        return Err(Fault::Budget { what, found, limit });
    }
    Ok(())
}
