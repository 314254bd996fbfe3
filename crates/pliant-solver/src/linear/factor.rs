//! Numeric factorization, task by task (multifrontal).
//!
//! A node's front is a small dense matrix of its columns and the rows below them. It collects the entries of the matrix
//! and what its children left, its columns are eliminated, and the remainder goes to its parent.

use super::dense::eliminate;
use super::panels::{diagonal, store, values_of_node};
use super::plan::{Node, Plan, Task};

/// What a task has worked out.
#[derive(Debug, Default)]
pub(super) struct TaskFactor {
    /// Columns of L as panels.
    pub(super) values: Vec<f64>,
    /// What is left for the boundary: a packed lower triangle by columns.
    remainder: Vec<f64>,
}

impl TaskFactor {
    /// Memory for the values of a task.
    pub(super) fn reserve(task: &Task) -> Option<TaskFactor> {
        let n_values = task.nodes.iter().map(values_of_node).sum();
        let mut values = Vec::new();
        values.try_reserve_exact(n_values).ok()?;
        values.resize(n_values, 0.0);
        let mut remainder = Vec::new();
        remainder.try_reserve_exact(packed(task.boundary.len())).ok()?;
        remainder.resize(packed(task.boundary.len()), 0.0);
        Some(TaskFactor { values, remainder })
    }

    /// The diagonal of L: (column, entry).
    pub(super) fn diagonal<'a>(&'a self, task: &'a Task) -> impl Iterator<Item = (u32, f64)> + 'a {
        let mut at = 0;
        task.nodes.iter().flat_map(move |node| {
            let values = &self.values[at..at + values_of_node(node)];
            at += values.len();
            diagonal(node, values).map(|(column, l)| (task.columns.start + node.first + column as u32, l))
        })
    }
}

/// Why a task could not be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Failure {
    /// The pivot of this column, in elimination order, is not positive.
    Pivot(u32),
    /// Memory.
    TooLarge,
}

/// Factors the tasks that are `due`, below before above; there is one factor per task. `values`: entries of the matrix.
/// The error is that of the first task, in elimination order.
pub(super) fn factor(plan: &Plan, values: &[f64], due: &[bool], factors: &mut [TaskFactor]) -> Result<(), Failure> {
    let Some(root) = plan.tasks.len().checked_sub(1) else { return Ok(()) };
    factor_subtree(&Work { plan, values, due }, root, factors)
}

struct Work<'a> {
    plan: &'a Plan,
    values: &'a [f64],
    due: &'a [bool],
}

/// `factors`: of the subtree of a task, which comes last.
fn factor_subtree(work: &Work<'_>, index: usize, factors: &mut [TaskFactor]) -> Result<(), Failure> {
    let task = &work.plan.tasks[index];
    let Some((own, below)) = factors.split_last_mut().filter(|_| work.due[index]) else { return Ok(()) };
    factor_siblings(work, &task.children, below)?;
    let children: Vec<(&Task, &TaskFactor)> =
        task.children.iter().map(|&c| (&work.plan.tasks[c], &below[c - task.first_task])).collect();
    factor_task(task, work.values, &children, own)
}

fn factor_siblings(work: &Work<'_>, siblings: &[usize], factors: &mut [TaskFactor]) -> Result<(), Failure> {
    match siblings {
        [] => Ok(()),
        [only] => factor_subtree(work, *only, factors),
        _ => {
            let (left, right) = siblings.split_at(siblings.len() / 2);
            let first = work.plan.tasks[left[0]].first_task;
            let (below_left, below_right) = factors.split_at_mut(work.plan.tasks[right[0]].first_task - first);
            let (a, b) =
                rayon::join(|| factor_siblings(work, left, below_left), || factor_siblings(work, right, below_right));
            a.and(b)
        }
    }
}

/// Entries of a packed lower triangle.
fn packed(n: usize) -> usize {
    n * (n + 1) / 2
}

fn factor_task(
    task: &Task,
    values: &[f64],
    below: &[(&Task, &TaskFactor)],
    own: &mut TaskFactor,
) -> Result<(), Failure> {
    let mut fronts =
        Fronts { task, place: vec![0; task.n_rows()], front: Vec::new(), left: Vec::new(), pending: Vec::new() };
    let mut at = 0;
    for (i, node) in task.nodes.iter().enumerate() {
        let n = fronts.begin(node)?;
        fronts.add_matrix(node, n, values);
        for _ in 0..node.n_updates {
            fronts.take_child(n);
        }
        if i == 0 {
            for (child, factor) in below {
                fronts.add(&child.boundary_above, &factor.remainder, n);
            }
        }
        let width = node.width as usize;
        eliminate(&mut fronts.front, n, width)
            .map_err(|column| Failure::Pivot(task.columns.start + node.first + column as u32))?;
        let n_values = values_of_node(node);
        store(&fronts.front, n, node, &mut own.values[at..at + n_values]);
        at += n_values;
        fronts.leave(i, width, n)?;
    }
    fronts.collect(&mut own.remainder);
    Ok(())
}

/// The front being worked on, and what nodes have left for their parents.
struct Fronts<'a> {
    task: &'a Task,
    /// Row of the front of each local row.
    place: Vec<u32>,
    front: Vec<f64>,
    /// Remainders on top of each other, packed.
    left: Vec<f64>,
    /// The nodes that left them.
    pending: Vec<usize>,
}

impl Fronts<'_> {
    /// An empty front; returns its number of rows.
    fn begin(&mut self, node: &Node) -> Result<usize, Failure> {
        let (width, rows) = (node.width as usize, self.task.rows_of(node));
        let n = width + rows.len();
        self.front.clear();
        self.front.try_reserve(n * n).map_err(|_| Failure::TooLarge)?;
        self.front.resize(n * n, 0.0);
        (0..width).for_each(|c| self.place[node.first as usize + c] = c as u32);
        rows.iter().enumerate().for_each(|(i, &row)| self.place[row as usize] = (width + i) as u32);
        Ok(n)
    }

    fn add_matrix(&mut self, node: &Node, n: usize, values: &[f64]) {
        let first = node.first as usize;
        for c in 0..node.width as usize {
            let entries = self.task.entries_at[first + c] as usize..self.task.entries_at[first + c + 1] as usize;
            for entry in &self.task.entries[entries] {
                self.front[c * n + self.place[entry.row as usize] as usize] += values[entry.slot as usize];
            }
        }
    }

    fn take_child(&mut self, n: usize) {
        let Some(child) = self.pending.pop() else { return };
        let rows = self.task.rows_of(&self.task.nodes[child]);
        let remainder = self.left.len() - packed(rows.len());
        let (front, place) = (&mut self.front, &self.place);
        extend_add(rows, &self.left[remainder..], |row| place[row as usize] as usize, |i, j| j * n + i, front);
        self.left.truncate(remainder);
    }

    fn add(&mut self, rows: &[u32], remainder: &[f64], n: usize) {
        let (front, place) = (&mut self.front, &self.place);
        extend_add(rows, remainder, |row| place[row as usize] as usize, |i, j| j * n + i, front);
    }

    fn leave(&mut self, node: usize, width: usize, n: usize) -> Result<(), Failure> {
        if width < n {
            self.pending.push(node);
        }
        self.left.try_reserve(packed(n - width)).map_err(|_| Failure::TooLarge)?;
        for j in width..n {
            self.left.extend_from_slice(&self.front[j * n + j..(j + 1) * n]);
        }
        Ok(())
    }

    /// Adds up what the roots of the task leave for the boundary.
    fn collect(&mut self, remainder: &mut [f64]) {
        remainder.fill(0.0);
        let n_columns = self.task.n_columns();
        let n = self.task.boundary.len();
        let mut at = 0;
        for &node in &self.pending {
            let rows = self.task.rows_of(&self.task.nodes[node]);
            let left = &self.left[at..at + packed(rows.len())];
            at += left.len();
            let place = |row: u32| row as usize - n_columns;
            extend_add(rows, left, place, |i, j| j * n - j * (j + 1) / 2 + i, remainder);
        }
    }
}

/// Adds a packed lower triangle over some rows to a larger one. `rows` ascend, and so do their places.
#[inline]
fn extend_add(
    rows: &[u32],
    packed: &[f64],
    place: impl Fn(u32) -> usize,
    at: impl Fn(usize, usize) -> usize,
    to: &mut [f64],
) {
    let mut rest = packed;
    for (j, &column) in rows.iter().enumerate() {
        let (values, later) = rest.split_at(rows.len() - j);
        rest = later;
        let column = place(column);
        for (&row, &value) in rows[j..].iter().zip(values) {
            to[at(place(row), column)] += value;
        }
    }
}
