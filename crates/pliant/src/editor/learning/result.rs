//! A result on trial: its sliders, and what the surface shows of it.

use std::ops::RangeInclusive;
use std::sync::Arc;

use pliant_solver::{Learned, Mesh, Rigidity};

use crate::learning::gather::{Gathered, Reading};

/// The worth of one ring (paper 3.4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Omega {
    /// Chosen from the poses.
    Auto,
    /// Given.
    Absolute(f64),
}

/// What of the result colors the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// The learned r.
    Learned,
    /// How sure it is.
    Confidence,
    /// The document's r as it is now.
    Now,
}

/// How r follows from the energies.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// ω.
    pub omega: Omega,
    /// The sizes among which r is chosen.
    pub range: RangeInclusive<u16>,
    /// Rounds of smoothing.
    pub smoothing: usize,
}

/// Energies, the settings under which they are read, and the r that follows.
pub struct Trial {
    gathered: Gathered,
    auto_omega: f64,
    settings: Settings,
    learned: Learned,
    mesh: Arc<Mesh>,
    /// `learned` after smoothing.
    rigidity: Rigidity,
    confidence: Arc<[f32]>,
    histogram: Vec<usize>,
    /// What colors the surface.
    pub shown: Shown,
}

impl Trial {
    pub(super) fn new(mesh: Arc<Mesh>, gathered: Gathered, auto_omega: f64) -> Trial {
        let range = gathered.table.r_range();
        let learned = gathered.table.learn(auto_omega, range.clone());
        let mut trial = Trial {
            gathered,
            auto_omega,
            settings: Settings { omega: Omega::Auto, range, smoothing: 0 },
            confidence: Arc::new([]),
            histogram: Vec::new(),
            mesh,
            rigidity: learned.rigidity.clone(),
            learned,
            shown: Shown::Learned,
        };
        trial.sum_up();
        trial
    }

    /// Poses used and left out.
    pub fn reading(&self) -> &Reading {
        &self.gathered.reading
    }

    /// As they are.
    pub fn settings(&self) -> Settings {
        self.settings.clone()
    }

    /// ω as the poses suggest it.
    pub fn auto_omega(&self) -> f64 {
        self.auto_omega
    }

    /// ω in use.
    pub fn omega_value(&self) -> f64 {
        match self.settings.omega {
            Omega::Auto => self.auto_omega,
            Omega::Absolute(omega) => omega,
        }
    }

    /// ω if it is not chosen from the poses.
    pub fn omega_given(&self) -> Option<f64> {
        match self.settings.omega {
            Omega::Auto => None,
            Omega::Absolute(omega) => Some(omega),
        }
    }

    /// The sizes whose energies are known.
    pub fn known_range(&self) -> RangeInclusive<u16> {
        self.gathered.table.r_range()
    }

    /// Other settings. Only the smallest sums are looked for anew: quick enough to follow a slider.
    pub fn set(&mut self, settings: Settings) {
        let known = self.known_range();
        let low = (*settings.range.start()).clamp(*known.start(), *known.end());
        let settings = Settings { range: low..=(*settings.range.end()).clamp(low, *known.end()), ..settings };
        if settings != self.settings {
            self.settings = settings;
            self.learned = self.gathered.table.learn(self.omega_value(), self.settings.range.clone());
            self.sum_up();
        }
    }

    fn sum_up(&mut self) {
        self.rigidity = match self.settings.smoothing {
            0 => self.learned.rigidity.clone(),
            rounds => self.learned.rigidity.smoothed(&self.mesh, rounds),
        };
        self.confidence = self.learned.confidence.as_slice().into();
        self.histogram = vec![0; self.known_range().count()];
        let first = *self.known_range().start();
        for &r in self.rigidity.as_slice() {
            self.histogram[usize::from(r - first)] += 1;
        }
    }

    /// The r that follows from the settings.
    pub fn rigidity(&self) -> &Rigidity {
        &self.rigidity
    }

    /// For every vertex how much worse the second best r is, from 0 to 1.
    pub fn confidence(&self) -> &Arc<[f32]> {
        &self.confidence
    }

    /// How many vertices have each r of the known ones, ascending.
    pub fn histogram(&self) -> &[usize] {
        &self.histogram
    }
}
