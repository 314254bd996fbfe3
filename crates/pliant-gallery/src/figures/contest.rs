//! One pull, several methods: what figures 7, 9 to 12 and 14 have in common.

use glam::DVec3;
use pliant_solver::{Method, Rigidity};

use crate::bending::{Bent, settled};
use crate::failure::Failure;
use crate::measures::{Hinges, crossings, volume_ratio};
use crate::models::Posing;
use crate::page::{Folder, Panel};
use crate::shots::Stage;

/// A method under a name.
pub(crate) struct Entry {
    /// As in captions.
    pub(crate) name: String,
    /// As in the names of files.
    pub(crate) slug: &'static str,
    pub(crate) method: Method,
}

/// The methods that the paper compares with, with the parameters that their papers or other implementations have.
pub(crate) fn rivals(n_vertices: usize) -> Vec<Entry> {
    let entry = |name: &str, slug, method| Entry { name: name.to_owned(), slug, method };
    vec![
        entry("ARAP", "arap", Method::RRing(Rigidity::uniform(n_vertices, 1))),
        entry("SR-ARAP", "sr-arap", Method::SrArap { alpha: Method::ALPHA }),
        entry(
            "embedded deformation",
            "embedded",
            Method::Embedded { nodes: Method::NODES, neighbors: Method::NODE_NEIGHBORS },
        ),
    ]
}

/// r-ring neighborhoods.
pub(crate) fn ring(name: impl Into<String>, slug: &'static str, rigidity: Rigidity) -> Entry {
    Entry { name: name.into(), slug, method: Method::RRing(rigidity) }
}

/// How an entry did.
pub(crate) struct Outcome {
    pub(crate) name: String,
    pub(crate) slug: &'static str,
    pub(crate) bent: Bent,
    pub(crate) crossings: usize,
    /// Now over at rest.
    pub(crate) volume: f64,
    /// Means over all edges.
    pub(crate) stretch: f64,
    pub(crate) bending: f64,
    /// Largest angle between the normals of neighboring faces, degrees.
    pub(crate) sharpest: f64,
}

impl Outcome {
    pub(crate) fn positions(&self) -> &[DVec3] {
        &self.bent.positions
    }
}

/// Bends and measures.
pub(crate) fn run(posing: &Posing, entries: Vec<Entry>) -> Result<Vec<Outcome>, Failure> {
    let mesh = &posing.mesh;
    let hinges = Hinges::new(mesh);
    let one = |Entry { name, slug, method }: Entry| {
        let bent = settled(posing, &method)?;
        let posed = &bent.positions;
        Ok(Outcome {
            crossings: crossings(mesh, posed),
            volume: volume_ratio(mesh, posed),
            stretch: hinges.stretch(posed),
            bending: hinges.bending(posed),
            sharpest: hinges.sharpest(posed),
            name,
            slug,
            bent,
        })
    };
    entries.into_iter().map(one).collect()
}

/// All results from one camera, with handles. `more` is put under each caption.
pub(crate) fn panels(
    into: &mut Folder,
    prefix: &str,
    stage: &Stage,
    posing: &Posing,
    outcomes: &[(&Outcome, String)],
) -> Result<Vec<Panel>, Failure> {
    let one = |(outcome, more): &(&Outcome, String)| {
        let shot = stage.shot(&posing.mesh, outcome.positions()).with_handles(posing);
        let file = into.picture(&format!("{prefix}-{}", outcome.slug), &shot)?;
        Ok(Panel::new(file, format!("{}<br>{more}", outcome.name)))
    };
    outcomes.iter().map(one).collect()
}

/// Measures as rows of a table.
pub(crate) fn csv(into: &mut Folder, name: &str, outcomes: &[Outcome]) -> Result<String, Failure> {
    let header = ["method", "iterations", "crossings", "volume ratio", "stretch", "bending", "sharpest angle"];
    let row = |outcome: &Outcome| {
        let counts = [outcome.bent.n_iterations().to_string(), outcome.crossings.to_string()];
        let Outcome { volume, stretch, bending, sharpest, .. } = outcome;
        let numbers = [volume, stretch, bending, sharpest].map(|number| format!("{number:.4}"));
        [outcome.name.clone()].into_iter().chain(counts).chain(numbers).collect()
    };
    into.csv(name, &header, &outcomes.iter().map(row).collect::<Vec<Vec<String>>>())
}
