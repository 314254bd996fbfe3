//! What the user should know about a surface that is being solved.

use pliant_solver::{LooseComponents, VertexId};

/// About components without a held vertex: (vertex count, first vertex).
pub(super) fn about_loose(parts: &[(usize, VertexId)], policy: LooseComponents) -> Vec<String> {
    let (they, it) = match policy {
        LooseComponents::KeepAtRest => ("stay", "stays"),
        LooseComponents::FollowNearest => ("follow the nearest", "follows the nearest"),
    };
    match parts {
        [] => Vec::new(),
        [(n, _)] => vec![format!("a part of {n} vertices has no handle and {it}")],
        parts => vec![format!("{} parts have no handle and {they}", parts.len())],
    }
}
