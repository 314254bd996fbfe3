//! How an energy is minimized: what `deform` and `compare` have in common.

use clap::Args;
use pliant_solver::{Minimizer, Start};

use super::{Method, SolverChoice, StartChoice, WeightsChoice};
use crate::cli::failure::Failure;

#[derive(Debug, Args)]
pub(in crate::cli) struct SolvingOptions {
    /// How to minimize it (embedded has its own way)
    #[arg(long, value_enum, default_value_t)]
    pub(in crate::cli) solver: SolverChoice,

    /// Weights of the edges
    #[arg(long, value_enum, default_value_t)]
    pub(in crate::cli) weights: WeightsChoice,

    /// Where the iteration begins
    #[arg(long, value_enum, default_value_t)]
    pub(in crate::cli) start: StartChoice,

    /// Iterations at most
    #[arg(long, value_name = "COUNT", default_value_t = 1000)]
    pub(in crate::cli) max_iterations: u64,

    /// Stop when the energy falls by less than this fraction in one iteration (lbfgs: in three); 0 runs all iterations
    #[arg(long, value_name = "FRACTION", default_value_t = 1e-3, allow_negative_numbers = true)]
    pub(in crate::cli) tolerance: f64,

    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N")]
    pub(in crate::cli) threads: Option<usize>,
}

impl SolvingOptions {
    /// Refuses what is out of range.
    pub(in crate::cli) fn check(&self) -> Result<(), Failure> {
        let refuse = |option, value: String, allowed| Err(Failure::OutOfRange { option, value, allowed });
        if self.max_iterations == 0 {
            return refuse("--max-iterations", "0".to_owned(), "at least 1");
        }
        if !(self.tolerance >= 0.0 && self.tolerance.is_finite()) {
            return refuse("--tolerance", self.tolerance.to_string(), "a number of at least 0");
        }
        if self.threads == Some(0) {
            return refuse("--threads", "0".to_owned(), "at least 1");
        }
        Ok(())
    }

    pub(in crate::cli) fn minimizer(&self) -> Minimizer {
        match self.solver {
            SolverChoice::Lbfgs => Minimizer::Lbfgs,
            SolverChoice::LocalGlobal => Minimizer::LocalGlobal,
        }
    }

    pub(in crate::cli) fn start(&self) -> Start {
        match self.start {
            StartChoice::Auto => Start::Auto,
            StartChoice::Rest => Start::Rest,
        }
    }

    /// The name of what minimizes the energy of this method.
    pub(in crate::cli) fn solver_of(&self, method: Method) -> &'static str {
        match method {
            Method::Embedded => "gauss-newton",
            Method::Rring | Method::Arap | Method::SrArap => self.solver.name(),
        }
    }
}
