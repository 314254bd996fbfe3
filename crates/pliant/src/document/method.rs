//! Which method bends the surface, with the parameters of all of them: those of the others stay while one is in use.

use std::ops::RangeInclusive;

use pliant_solver::{DeformationGraph, EnergyWeights, Method as SolverMethod};

/// The methods there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MethodKind {
    /// The r-ring energy: painted rigidity counts.
    #[default]
    RRing,
    /// As rigid as possible (Sorkine and Alexa 2007): r-ring with r = 1 everywhere.
    Arap,
    /// Smooth rotation enhanced (Levi and Gotsman 2015).
    SrArap,
    /// Embedded deformation (Sumner, Schmid and Pauly 2007).
    Embedded,
}

impl MethodKind {
    /// All, in the order of lists.
    pub const ALL: [MethodKind; 4] = [MethodKind::RRing, MethodKind::Arap, MethodKind::SrArap, MethodKind::Embedded];

    /// Its name for people.
    pub fn label(self) -> &'static str {
        match self {
            MethodKind::RRing => "Rigidity (r-ring)",
            MethodKind::Arap => "ARAP",
            MethodKind::SrArap => "SR-ARAP",
            MethodKind::Embedded => "Embedded deformation",
        }
    }

    /// What it does, in a sentence or two.
    pub fn description(self) -> &'static str {
        match self {
            MethodKind::RRing => {
                "Neighborhoods as large as the painted rigidity keep their shape (r-ring energy, eq. 1). The stiffer a \
                 part is painted, the more it moves as one piece"
            }
            MethodKind::Arap => {
                "As rigid as possible: every vertex keeps its edges, as with rigidity 1 everywhere (Sorkine and Alexa \
                 2007). Painted rigidity does not count"
            }
            MethodKind::SrArap => {
                "Smooth rotation enhanced ARAP: neighbors should also turn alike (Levi and Gotsman 2015). Painted \
                 rigidity does not count"
            }
            MethodKind::Embedded => {
                "Some hundred nodes on the surface carry it (Sumner, Schmid and Pauly 2007). Handles are held softly, and \
                 painted rigidity does not count"
            }
        }
    }

    /// What its energy is called beside a number.
    pub fn energy_name(self) -> &'static str {
        match self {
            MethodKind::RRing => "r-ring energy",
            MethodKind::Arap => "ARAP energy",
            MethodKind::SrArap => "SR-ARAP energy",
            MethodKind::Embedded => "embedded energy",
        }
    }

    /// Whether painted rigidity counts.
    pub fn uses_rigidity(self) -> bool {
        self == MethodKind::RRing
    }

    /// Whether its energy is that of rings around the vertices, of painted sizes or 1.
    pub fn is_of_rings(self) -> bool {
        matches!(self, MethodKind::RRing | MethodKind::Arap)
    }
}

/// The method in use, and the parameters of every method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// Which.
    pub kind: MethodKind,
    /// α of SR-ARAP: how much turning alike counts.
    pub alpha: f64,
    /// Nodes of embedded deformation.
    pub nodes: usize,
    /// Nodes that carry a vertex (k).
    pub neighbors: usize,
    /// How much nodes side by side should agree (the weight of E_reg, beside 1 for being rotations).
    pub agreement: f64,
    /// How strongly handles pull nodes (the weight of E_con).
    pub pull: f64,
}

impl Default for Method {
    /// r-ring; the others as in their papers.
    fn default() -> Method {
        Method {
            kind: MethodKind::RRing,
            alpha: SolverMethod::ALPHA,
            nodes: SolverMethod::NODES,
            neighbors: SolverMethod::NODE_NEIGHBORS,
            agreement: EnergyWeights::default().regularity,
            pull: EnergyWeights::default().constraint,
        }
    }
}

impl Method {
    /// α that can be had. The term is scaled by the area: with 10, nothing but whole limbs turns any more (by eye).
    pub const ALPHAS: RangeInclusive<f64> = 0.0..=10.0;
    /// Numbers of nodes that can be had.
    pub const NODES: RangeInclusive<usize> = DeformationGraph::NODES;
    /// How many nodes may carry a vertex.
    pub const NEIGHBORS: RangeInclusive<usize> = DeformationGraph::NEIGHBORS;
    /// Weights of energies that can be had: beyond, single digits are left of what weighs least.
    pub const WEIGHTS: RangeInclusive<f64> = 1e-3..=1e6;

    /// Another kind with the same parameters.
    pub fn with(self, kind: MethodKind) -> Method {
        Method { kind, ..self }
    }

    /// What is out of range, if anything: its name, its value, and what is allowed.
    pub fn fault(&self) -> Option<(&'static str, String, String)> {
        let range =
            |low: &dyn ToString, high: &dyn ToString| format!("from {} to {}", low.to_string(), high.to_string());
        let whole = |name, value: usize, allowed: &RangeInclusive<usize>| {
            let is_good = allowed.contains(&value);
            (!is_good).then(|| (name, value.to_string(), range(allowed.start(), allowed.end())))
        };
        if !Self::ALPHAS.contains(&self.alpha) {
            let allowed = range(Self::ALPHAS.start(), Self::ALPHAS.end());
            return Some(("smoothness (α)", self.alpha.to_string(), allowed));
        }
        for (name, value) in [("agreement of nodes", self.agreement), ("pull of handles", self.pull)] {
            if !Self::WEIGHTS.contains(&value) {
                return Some((name, value.to_string(), range(Self::WEIGHTS.start(), Self::WEIGHTS.end())));
            }
        }
        whole("nodes", self.nodes, &Self::NODES).or_else(|| whole("nodes a vertex", self.neighbors, &Self::NEIGHBORS))
    }

    /// The weights of embedded deformation as the solver takes them.
    pub fn weights(&self) -> EnergyWeights {
        EnergyWeights { regularity: self.agreement, constraint: self.pull }
    }

    /// Whether both bend a surface alike: parameters of methods not in use do not matter.
    pub fn solves_like(&self, other: &Method) -> bool {
        self.kind == other.kind && self.is_prepared_like(other)
    }

    /// Whether what was prepared for one serves the other, apart from rigidity.
    pub fn is_prepared_like(&self, other: &Method) -> bool {
        match self.kind {
            MethodKind::RRing | MethodKind::Arap => other.kind.is_of_rings(),
            MethodKind::SrArap => other.kind == self.kind && self.alpha == other.alpha,
            MethodKind::Embedded => {
                other.kind == self.kind
                    && (self.nodes, self.neighbors) == (other.nodes, other.neighbors)
                    && self.weights() == other.weights()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_of_other_methods_do_not_matter_and_wrong_ones_are_named() {
        let method = Method::default();
        let other = Method { alpha: 0.5, nodes: 7, ..method };
        assert!(method.solves_like(&other) && !method.with(MethodKind::SrArap).solves_like(&other));
        assert!(!method.with(MethodKind::SrArap).solves_like(&other.with(MethodKind::SrArap)));
        assert!(method.is_prepared_like(&method.with(MethodKind::Arap)));
        assert!(!method.solves_like(&method.with(MethodKind::Arap)));
        assert_eq!(method.fault(), None);
        for (bad, name) in [
            (Method { alpha: f64::NAN, ..method }, "smoothness (α)"),
            (Method { alpha: -1.0, ..method }, "smoothness (α)"),
            (Method { nodes: 0, ..method }, "nodes"),
            (Method { neighbors: 1, ..method }, "nodes a vertex"),
            (Method { agreement: 0.0, ..method }, "agreement of nodes"),
            (Method { pull: f64::INFINITY, ..method }, "pull of handles"),
        ] {
            assert_eq!(bad.fault().map(|fault| fault.0), Some(name), "{bad:?}");
        }
    }
}
