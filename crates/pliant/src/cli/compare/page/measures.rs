//! The rows of the table: what is measured, how it is told, and which direction is better.

use super::super::facts::Measured;
use super::words::{number, percent, time, whole};
use crate::comparing::FOLDED_DEGREES;

/// Which direction is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Better {
    Less,
    NearOne,
    /// The numbers of different methods cannot be compared.
    Neither,
}

impl Better {
    pub(super) fn in_words(self) -> &'static str {
        match self {
            Better::Less => "Less is better.",
            Better::NearOne => "Near one is better.",
            Better::Neither => "Not to be compared from method to method.",
        }
    }
}

/// One row.
pub(super) struct Measure {
    /// Stable name, for whoever reads the page by a program.
    pub(super) id: &'static str,
    pub(super) name: &'static str,
    pub(super) better: Better,
    /// A sentence or two for somebody who sees it for the first time.
    pub(super) meaning: &'static str,
    pub(super) value: fn(&Measured) -> Option<f64>,
    pub(super) show: fn(f64) -> String,
}

pub(super) const MEASURES: &[Measure] = &[
    Measure {
        id: "common_energy",
        name: "Common energy",
        better: Better::Less,
        meaning: "One question asked of every result: how far are the edges around each vertex from being only moved and turned \
                  (the ARAP energy, r = 1 with the best rotations)? ARAP lowers just this and is ahead here by its nature; \
                  whether that is worth it, the rows below tell.",
        value: |result| Some(result.common_energy),
        show: number,
    },
    Measure {
        id: "stretch_mean",
        name: "Edge stretch, mean",
        better: Better::Less,
        meaning: "How much longer or shorter than at rest an edge is on average.",
        value: |result| Some(result.stretch.mean.exp_m1()),
        show: percent,
    },
    Measure {
        id: "stretch_99",
        name: "Edge stretch, worst 1 %",
        better: Better::Less,
        meaning: "One edge in a hundred is longer or shorter by more than this.",
        value: |result| Some(result.stretch.percentile_99.exp_m1()),
        show: percent,
    },
    Measure {
        id: "bending_99",
        name: "Bending, worst 1 %",
        better: Better::Less,
        meaning: "At one edge in a hundred the angle between its two faces changed by more than this. A bend that is spread out \
                  evenly has small angles everywhere; large ones are creases.",
        value: |result| Some(result.bending.percentile_99),
        show: |degrees| format!("{degrees:.1}°"),
    },
    Measure {
        id: "folds",
        name: "Folded edges",
        better: Better::Less,
        meaning: "Edges whose two faces lie nearly on each other (their normals are more than 150° apart) and did not at rest.",
        value: |result| Some(result.folds as f64),
        show: |n| whole(n as usize),
    },
    Measure {
        id: "self_intersections",
        name: "Self-intersections",
        better: Better::Less,
        meaning: "Pairs of triangles without a common vertex that pass through each other; those of the rest shape count too.",
        value: |result| Some(result.self_intersections as f64),
        show: |n| whole(n as usize),
    },
    Measure {
        id: "volume_ratio",
        name: "Volume, of that at rest",
        better: Better::NearOne,
        meaning: "The space the surface encloses, compared with that at rest: less than one has collapsed, more is bloated. Only \
                  closed surfaces have one.",
        value: |result| result.volume_ratio,
        show: |ratio| format!("{ratio:.4}"),
    },
    Measure {
        id: "max_handle_error",
        name: "Handles missed by",
        better: Better::Less,
        meaning: "How far a held vertex is from where it should be, at most, in the units of the file. Most methods hold them exactly; \
                  for embedded deformation handles are wishes.",
        value: |result| Some(result.max_handle_error),
        show: number,
    },
    Measure {
        id: "iterations",
        name: "Iterations",
        better: Better::Less,
        meaning: "Steps until the energy hardly fell any more. A step takes a different time with each method.",
        value: |result| Some(result.iterations as f64),
        show: |n| whole(n as usize),
    },
    Measure {
        id: "set_up",
        name: "Time to set up",
        better: Better::Less,
        meaning: "What is done before the first step whenever rigidity or the choice of handles changes: finding neighborhoods, \
                  factorizing the system.",
        value: |result| Some(result.times_ms.set_up),
        show: time,
    },
    Measure {
        id: "iterate",
        name: "Time to solve",
        better: Better::Less,
        meaning: "The search for a good start and all iterations.",
        value: |result| Some(result.times_ms.iterate),
        show: time,
    },
    Measure {
        id: "own_energy",
        name: "Own energy at the end",
        better: Better::Neither,
        meaning: "What the method itself makes as small as it can, in units of its own.",
        value: |result| result.energies.last().copied(),
        show: number,
    },
];

// The sentence about folded edges has the number in words.
const _: () = assert!(FOLDED_DEGREES == 150.0);

impl Measure {
    /// Which of the values are best: those that are told alike, and none if all are or if there is nothing to choose from.
    pub(super) fn best(&self, values: &[Option<f64>]) -> Vec<bool> {
        let badness = |value: f64| match self.better {
            Better::NearOne => (value - 1.0).abs(),
            Better::Less | Better::Neither => value,
        };
        let known = || values.iter().flatten().copied();
        let best = known().min_by(|a, b| badness(*a).total_cmp(&badness(*b)));
        let is_best = |value: &Option<f64>| match (value, best) {
            (Some(value), Some(best)) => (self.show)(*value) == (self.show)(best),
            _ => false,
        };
        let marks: Vec<bool> = values.iter().map(is_best).collect();
        let n_best = marks.iter().filter(|&&mark| mark).count();
        if self.better == Better::Neither || n_best == known().count() { vec![false; values.len()] } else { marks }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measure(id: &str) -> &'static Measure {
        MEASURES.iter().find(|measure| measure.id == id).expect(id)
    }

    #[test]
    fn the_best_are_marked_and_those_that_look_the_same_too() {
        let folds = measure("folds");
        assert_eq!(folds.best(&[Some(3.0), None, Some(1.0), Some(1.0)]), [false, false, true, true]);
        assert_eq!(folds.best(&[Some(2.0), Some(2.0), None]), [false; 3], "nothing stands out");
        assert_eq!(measure("common_energy").best(&[Some(0.123_412), Some(0.123_409), Some(0.2)]), [true, true, false]);
        assert_eq!(measure("volume_ratio").best(&[Some(0.9), Some(1.05), None]), [false, true, false]);
        assert_eq!(measure("own_energy").best(&[Some(1.0), Some(2.0)]), [false; 2], "units of their own");
        assert_eq!(folds.best(&[None, None]), [false; 2]);
    }
}
