//! What is chosen by a name, with the first as the default.

use clap::ValueEnum;
use pliant_solver::Weights;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Method {
    /// Rigid neighborhoods of r rings a vertex
    #[default]
    Rring,
    /// As rigid as possible: r = 1 everywhere
    Arap,
    /// ARAP whose neighbors turn alike, too (Levi and Gotsman 2015)
    SrArap,
    /// Some hundred nodes carry the surface (Sumner, Schmid and Pauly 2007); handles are soft
    Embedded,
}

impl Method {
    /// The name in options and reports.
    pub(in crate::cli) fn name(self) -> &'static str {
        match self {
            Method::Rring => "rring",
            Method::Arap => "arap",
            Method::SrArap => "sr-arap",
            Method::Embedded => "embedded",
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum SolverChoice {
    /// Learns from its last steps where the surface gives way: the same minimum in fewer iterations
    #[default]
    Lbfgs,
    /// Best positions for the rotations, best rotations for the positions, in turn (the paper's way)
    LocalGlobal,
}

impl SolverChoice {
    pub(in crate::cli) fn name(self) -> &'static str {
        match self {
            SolverChoice::Lbfgs => "lbfgs",
            SolverChoice::LocalGlobal => "local-global",
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum WeightsChoice {
    /// Cotangents, with slivers and negative weights tamed
    #[default]
    Clamped,
    /// Raw cotangents (eq. 2); refused where they admit no minimum
    Cotangent,
    /// 1 for every edge
    Uniform,
}

impl From<WeightsChoice> for Weights {
    fn from(choice: WeightsChoice) -> Weights {
        match choice {
            WeightsChoice::Clamped => Weights::Clamped,
            WeightsChoice::Cotangent => Weights::Cotangent,
            WeightsChoice::Uniform => Weights::Uniform,
        }
    }
}

impl WeightsChoice {
    pub(in crate::cli) fn name(self) -> &'static str {
        match self {
            WeightsChoice::Clamped => "clamped",
            WeightsChoice::Cotangent => "cotangent",
            WeightsChoice::Uniform => "uniform",
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum StartChoice {
    /// The best of several starts
    #[default]
    Auto,
    /// Every rotation the identity, as in the paper
    Rest,
}

impl StartChoice {
    pub(in crate::cli) fn name(self) -> &'static str {
        match self {
            StartChoice::Auto => "auto",
            StartChoice::Rest => "rest",
        }
    }
}
