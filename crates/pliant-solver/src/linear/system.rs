//! A factored system and the memory to solve with it.

use std::sync::Arc;

use rayon::prelude::*;

use super::factor::{Failure, TaskFactor, factor};
use super::pattern::Pattern;
use super::plan::{Plan, Task};
use super::solve::solve;
use crate::kernels::parallel::chunks;
use crate::kernels::quad::Quad;

/// A raw pivot this much smaller than its diagonal entry is rounding, not definiteness: 1e4 times the unit roundoff.
const SMALLEST_PIVOT: f64 = 1e-12;

/// Why a factorization failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FactorError {
    /// The pivot of this row was not positive.
    NonPositivePivot { row: usize },
    /// Memory or index range.
    TooLarge,
}

/// A matrix, its factor, and the memory to solve.
pub(crate) struct System {
    pattern: Arc<Pattern>,
    /// The matrix that was factored last, or tried.
    values: Vec<f64>,
    factors: Vec<TaskFactor>,
    /// Tasks whose factor is not that of `values`.
    due: Vec<bool>,
    /// Rows of all tasks, to solve in.
    rows: Vec<Quad>,
}

impl System {
    /// Reserves memory; nothing is factored yet.
    pub(crate) fn new(pattern: Arc<Pattern>) -> Result<System, FactorError> {
        let plan = plan_of(&pattern)?;
        // In parallel, because the first touch of so much memory takes as long as factoring.
        let factors = plan.tasks.par_iter().map(TaskFactor::reserve).collect::<Option<Vec<_>>>();
        let factors = factors.ok_or(FactorError::TooLarge)?;
        let due = vec![true; plan.tasks.len()];
        let rows = vec![Quad::ZERO; plan.n_rows()];
        Ok(System { values: vec![0.0; pattern.n_values()], factors, due, rows, pattern })
    }

    /// Number of values of L that are stored.
    #[cfg(feature = "measure")]
    pub(crate) fn n_values(&self) -> usize {
        self.factors.iter().map(|factor| factor.values.len()).sum()
    }

    /// The pattern and the values that were factored last.
    #[cfg(feature = "measure")]
    pub(super) fn matrix(&self) -> (&Pattern, &[f64]) {
        (&self.pattern, &self.values)
    }

    /// Factors new values: those tasks whose entries changed since the last time, and the ones above them. After an error
    /// the factor is unusable until the next success.
    pub(crate) fn factor(&mut self, values: &[f64]) -> Result<(), FactorError> {
        let plan = plan_of(&self.pattern)?;
        let is_changed = |task: &Task| {
            task.entries.iter().map(|entry| entry.slot as usize).any(|slot| values[slot] != self.values[slot])
        };
        let changed: Vec<bool> = plan.tasks.par_iter().map(is_changed).collect();
        for (t, task) in plan.tasks.iter().enumerate() {
            let is_above = task.children.iter().any(|&child| self.due[child]);
            self.due[t] = self.due[t] || changed[t] || is_above;
        }
        self.values.copy_from_slice(values);
        factor(plan, &self.values, &self.due, &mut self.factors).map_err(|failure| match failure {
            Failure::Pivot(column) => FactorError::NonPositivePivot { row: plan.order[column as usize] as usize },
            Failure::TooLarge => FactorError::TooLarge,
        })?;
        self.due.fill(false);
        Ok(())
    }

    /// A row whose pivot is so small against its diagonal entry that it is only rounding away from zero.
    pub(crate) fn doubtful_pivot(&self) -> Option<usize> {
        let plan = plan_of(&self.pattern).ok()?;
        let diagonal = plan.tasks.iter().zip(&self.factors).flat_map(|(task, factor)| factor.diagonal(task));
        let mut pivots = diagonal.map(|(column, l)| (plan.order[column as usize] as usize, l * l));
        let is_sound = |&(row, pivot): &(usize, f64)| pivot >= SMALLEST_PIVOT * self.values[self.pattern.diagonal(row)];
        pivots.find(|pivot| !is_sound(pivot)).map(|(row, _)| row)
    }

    /// Replaces `rhs` (three right-hand sides, a row of each side by side) by the solution.
    pub(crate) fn solve_in_place(&mut self, rhs: &mut [Quad]) {
        let Ok(plan) = plan_of(&self.pattern) else { return };
        solve(plan, &self.factors, rhs, &mut self.rows);
        let rows = &self.rows;
        chunks(rhs, |first, rhs| {
            for (x, &place) in rhs.iter_mut().zip(&plan.place[first..]) {
                *x = rows[place as usize];
            }
        });
    }
}

fn plan_of(pattern: &Pattern) -> Result<&Plan, FactorError> {
    pattern.plan.as_ref().map_err(|_| FactorError::TooLarge)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::linear::Ordered;
    use crate::test_support::{Random, bumpy_sheet};

    /// A path 0 - 1 - … with unit weights, both ends fixed.
    fn path(n: usize, weight: f64) -> (System, Vec<f64>) {
        let edges: Vec<[u32; 2]> = (1..n as u32).map(|i| [i - 1, i]).collect();
        let points: Vec<DVec3> = (0..n).map(|i| DVec3::X * i as f64).collect();
        let (ordered, slots) = Ordered::new(&points, &edges);
        let pattern = ordered.analyzed();
        let mut values = vec![0.0; pattern.n_values()];
        for i in 0..n {
            values[pattern.diagonal(i)] = if i == 0 || i + 1 == n { 1.0 } else { 2.0 * weight };
        }
        for e in 1..edges.len() - 1 {
            values[slots[e] as usize] = -weight;
        }
        (System::new(Arc::new(pattern)).expect("small"), values)
    }

    #[test]
    fn a_path_is_solved_at_any_length() {
        for n in [2, 5, 507, 30_001] {
            let (mut system, values) = path(n, 1.0);
            system.factor(&values).expect("definite");
            assert_eq!(system.doubtful_pivot(), None);
            // Right-hand side of the straight line x_i = i with ends moved over.
            let mut rhs = vec![Quad::ZERO; n];
            for end in [n - 1, n.saturating_sub(2).max(1)] {
                rhs[end].0[1] = (n - 1) as f64;
            }
            system.solve_in_place(&mut rhs);
            for (i, x) in rhs.iter().enumerate() {
                // The condition number of a path grows with the square of its length.
                assert!((x.0[1] - i as f64).abs() < 1e-15 * (n * n) as f64 * n as f64, "row {i} of {n}: {x:?}");
                assert_eq!(x.0[0], 0.0, "row {i} of {n}");
            }
        }
    }

    /// The clamped Laplacian of a sheet large enough for many tasks, with some rows made heavier: by row, what is added.
    fn sheet(heavier: &[(usize, f64)]) -> (Arc<Pattern>, Vec<f64>) {
        let mesh = bumpy_sheet(150);
        let analysis = crate::Analysis::new(Arc::new(mesh), crate::Weights::Clamped);
        let mut values = vec![0.0; analysis.pattern.n_values()];
        for (e, &[i, j]) in analysis.layout.edges.iter().enumerate() {
            let weight = analysis.layout.weight[e];
            values[analysis.slots[e] as usize] = -weight;
            values[analysis.pattern.diagonal(i as usize)] += weight;
            values[analysis.pattern.diagonal(j as usize)] += weight;
        }
        values[analysis.pattern.diagonal(0)] += 1.0;
        for &(row, more) in heavier {
            values[analysis.pattern.diagonal(row)] += more;
        }
        (analysis.pattern.clone(), values)
    }

    fn right_hand_side(n: usize) -> Vec<Quad> {
        let mut random = Random::new(5);
        (0..n).map(|_| Quad::from(random.vector())).collect()
    }

    #[test]
    fn a_local_change_gives_the_bits_of_a_whole_factorization() {
        let heavier = [(17, 3.0), (9_000, 0.5), (9_001, 0.25)];
        let (pattern, before) = sheet(&[]);
        let (_, after) = sheet(&heavier);
        let n_tasks = pattern.plan.as_ref().expect("small").tasks.len();
        assert!(n_tasks > 10, "many tasks, not {n_tasks}");
        let mut changed = System::new(pattern.clone()).expect("small");
        changed.factor(&before).expect("definite");
        changed.factor(&after).expect("definite");
        let mut whole = System::new(pattern).expect("small");
        whole.factor(&after).expect("definite");
        let (mut x, mut y) = (right_hand_side(150 * 150), right_hand_side(150 * 150));
        changed.solve_in_place(&mut x);
        whole.solve_in_place(&mut y);
        assert_eq!(x, y);
    }

    #[test]
    fn after_a_refused_matrix_the_one_before_is_factored_as_at_first() {
        let (pattern, good) = sheet(&[]);
        let (_, bad) = sheet(&[(4_000, -1e6)]);
        let mut system = System::new(pattern).expect("small");
        system.factor(&good).expect("definite");
        let mut x = right_hand_side(150 * 150);
        system.solve_in_place(&mut x);
        assert_eq!(system.factor(&bad), Err(FactorError::NonPositivePivot { row: 4_000 }));
        system.factor(&good).expect("definite");
        let mut y = right_hand_side(150 * 150);
        system.solve_in_place(&mut y);
        assert_eq!(x, y);
    }

    #[test]
    fn the_number_of_threads_changes_no_bit_of_factor_or_solution() {
        let solved = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| {
                let (pattern, values) = sheet(&[]);
                let mut system = System::new(pattern).expect("small");
                system.factor(&values).expect("definite");
                let mut x = right_hand_side(150 * 150);
                system.solve_in_place(&mut x);
                x
            })
        };
        assert_eq!(solved(1), solved(3));
    }

    #[test]
    fn the_solution_satisfies_every_row() {
        let (pattern, values) = sheet(&[]);
        let mut system = System::new(pattern.clone()).expect("small");
        system.factor(&values).expect("definite");
        let b = right_hand_side(150 * 150);
        let mut x = b.clone();
        system.solve_in_place(&mut x);
        let largest = x.iter().map(|x| x.xyz().length()).fold(0.0, f64::max);
        for (i, (found, b)) in pattern.times(&values, &x).into_iter().zip(&b).enumerate() {
            // Backward stability: a few dozen roundings of the row times the largest unknown.
            let tolerance = 64.0 * f64::EPSILON * largest * values[pattern.diagonal(i)].abs() * 4.0;
            assert!(found.distance(b.xyz()) < tolerance, "row {i}: got {found}, expected {b:?} within {tolerance:e}");
        }
    }

    #[test]
    fn blocks_are_factored_as_the_rows_they_are() {
        const SIZE: u32 = 4;
        let (n, mut random) = (200u32, Random::new(9));
        let points: Vec<DVec3> = (0..n).map(|_| random.vector()).collect();
        let links: Vec<[u32; 2]> = (1..n).flat_map(|i| [[i / 2, i], [i / 3, i]]).filter(|[a, b]| a < b).collect();
        let links: Vec<[u32; 2]> = std::collections::BTreeSet::from_iter(links).into_iter().collect();
        let (ordered, slots) = Ordered::of_blocks(&points, &links, SIZE);
        let pattern = ordered.analyzed();
        let pairs = (n * SIZE * (SIZE - 1) / 2) as usize;
        assert_eq!(slots.len(), pairs + links.len() * (SIZE * SIZE) as usize);
        let mut values = vec![0.0; pattern.n_values()];
        slots.iter().for_each(|&slot| values[slot as usize] = random.signed());
        // A row has some 30 other entries at most, below 1 each.
        (0..(n * SIZE) as usize).for_each(|row| values[pattern.diagonal(row)] = 100.0);
        let b: Vec<Quad> = (0..n * SIZE).map(|_| Quad::from(random.vector())).collect();
        let pattern = Arc::new(pattern);
        let mut system = System::new(pattern.clone()).expect("small");
        system.factor(&values).expect("dominant");
        let mut x = b.clone();
        system.solve_in_place(&mut x);
        for (i, (found, b)) in pattern.times(&values, &x).into_iter().zip(&b).enumerate() {
            // A condition number of 2, some 30 sums a row.
            assert!(found.distance(b.xyz()) < 1e-13, "row {i}: got {found}, expected {b:?}");
        }
        // The place of an entry is that of its rows: the block of a link stands where its rows and columns are.
        let at = slots[pairs..].chunks_exact((SIZE * SIZE) as usize);
        for (&[i, j], slots) in links.iter().zip(at) {
            for (ab, &slot) in slots.iter().enumerate() {
                let (a, b) = (ab as u32 / SIZE, ab as u32 % SIZE);
                let column = (i * SIZE + a) as usize;
                let range = pattern.columns[column]..pattern.columns[column + 1];
                assert!(range.contains(&slot) && pattern.rows[slot as usize] == j * SIZE + b, "link {i} {j}, {a} {b}");
            }
        }
    }

    #[test]
    fn a_pivot_that_is_not_positive_is_reported() {
        for n in [5, 507] {
            let (mut system, values) = path(n, -1.0);
            assert!(matches!(system.factor(&values), Err(FactorError::NonPositivePivot { .. })));
            let (mut system, values) = path(n, 0.0);
            assert!(matches!(system.factor(&values), Err(FactorError::NonPositivePivot { .. })));
        }
    }
}
