//! What tools need to know of the whole mesh: found in the background, absent until then.

use std::sync::Arc;

use pliant_geometry::FacePatches;

use super::Mirror;

/// What has been found so far for the open mesh and the options as they are.
#[derive(Clone, Debug, Default)]
pub struct Prepared {
    /// The other side, while painting is mirrored.
    pub mirror: Option<Arc<Mirror>>,
    /// Patches between sharp edges, while they bound fills.
    pub patches: Option<Arc<FacePatches>>,
}
