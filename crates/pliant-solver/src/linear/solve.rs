//! The two triangular solves, L y = b upward through the tasks and Lᵀ x = y downward, for three right-hand sides side by
//! side. Every value of L is read twice, in the order in which it lies in memory or backward.

use super::factor::TaskFactor;
use super::panels::{WIDTH, n_values, panels, triangle};
use super::plan::{Plan, Task};
use crate::kernels::quad::Quad;
use crate::kernels::wide::{Kernel, Wide, dispatch};

/// Solves for `rhs`, in the caller's rows. The solution is left in `rows`, the rows of all tasks, at their columns.
pub(super) fn solve(plan: &Plan, factors: &[TaskFactor], rhs: &[Quad], rows: &mut [Quad]) {
    let Some(root) = plan.tasks.len().checked_sub(1) else { return };
    let work = Work { plan, factors, rhs };
    work.upward(root, rows);
    work.downward(root, rows);
}

struct Work<'a> {
    plan: &'a Plan,
    factors: &'a [TaskFactor],
    rhs: &'a [Quad],
}

impl Work<'_> {
    /// `rows`: of the subtree of a task, whose own come last.
    fn upward(&self, index: usize, rows: &mut [Quad]) {
        let task = &self.plan.tasks[index];
        let (below, own) = rows.split_at_mut(rows.len() - task.n_rows());
        self.siblings(&task.children, below, &|child, rows| self.upward(child, rows));
        let (columns, boundary) = own.split_at_mut(task.n_columns());
        let order = &self.plan.order[task.columns.start as usize..task.columns.end as usize];
        columns.iter_mut().zip(order).for_each(|(b, &row)| *b = self.rhs[row as usize]);
        boundary.fill(Quad::ZERO);
        let begin = task.rows_begin - below.len();
        for &child in &task.children {
            let child = &self.plan.tasks[child];
            let boundary = &below[child.rows_begin - begin + child.n_columns()..];
            for (&row, gathered) in child.boundary_above.iter().zip(boundary) {
                let to = &mut own[row as usize].0;
                to.iter_mut().zip(gathered.0).for_each(|(to, gathered)| *to += gathered);
            }
        }
        dispatch(Forward { task, values: &self.factors[index].values, x: own });
    }

    fn downward(&self, index: usize, rows: &mut [Quad]) {
        let task = &self.plan.tasks[index];
        let (below, own) = rows.split_at_mut(rows.len() - task.n_rows());
        dispatch(Backward { task, values: &self.factors[index].values, x: own });
        let begin = task.rows_begin - below.len();
        for &child in &task.children {
            let child = &self.plan.tasks[child];
            let boundary = &mut below[child.rows_begin - begin + child.n_columns()..];
            for (&row, known) in child.boundary_above.iter().zip(boundary) {
                *known = own[row as usize];
            }
        }
        self.siblings(&task.children, below, &|child, rows| self.downward(child, rows));
    }

    /// Calls `f` for every sibling with the rows of its subtree, in parallel.
    fn siblings(&self, siblings: &[usize], rows: &mut [Quad], f: &(impl Fn(usize, &mut [Quad]) + Sync)) {
        match siblings {
            [] => {}
            [only] => f(*only, rows),
            _ => {
                let (left, right) = siblings.split_at(siblings.len() / 2);
                let end = |sibling: usize| {
                    let task = &self.plan.tasks[sibling];
                    task.rows_begin + task.n_rows()
                };
                let first = self.plan.tasks[self.plan.tasks[left[0]].first_task].rows_begin;
                let (rows_left, rows_right) = rows.split_at_mut(end(left[left.len() - 1]) - first);
                rayon::join(|| self.siblings(left, rows_left, f), || self.siblings(right, rows_right, f));
            }
        }
    }
}

/// A task's part of L y = b.
struct Forward<'a> {
    task: &'a Task,
    values: &'a [f64],
    x: &'a mut [Quad],
}

impl Kernel for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Wide>(self, wide: W) {
        let Forward { task, values, x } = self;
        let mut rest = values;
        for node in &task.nodes {
            let rows = task.rows_of(node);
            for panel in panels(node.width as usize) {
                let (mine, later) = rest.split_at(n_values(panel.width, panel.inside + node.height()));
                rest = later;
                let first = node.first as usize + panel.first;
                let work = PanelWork { values: mine, inside: panel.inside, rows };
                match panel.width {
                    1 => work.forward::<W, 1>(wide, first, x),
                    2 => work.forward::<W, 2>(wide, first, x),
                    3 => work.forward::<W, 3>(wide, first, x),
                    4 => work.forward::<W, 4>(wide, first, x),
                    5 => work.forward::<W, 5>(wide, first, x),
                    6 => work.forward::<W, 6>(wide, first, x),
                    7 => work.forward::<W, 7>(wide, first, x),
                    _ => work.forward::<W, WIDTH>(wide, first, x),
                }
            }
        }
    }
}

/// A task's part of Lᵀ x = y.
struct Backward<'a> {
    task: &'a Task,
    values: &'a [f64],
    x: &'a mut [Quad],
}

impl Kernel for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Wide>(self, wide: W) {
        let Backward { task, values, x } = self;
        let mut end = values.len();
        for node in task.nodes.iter().rev() {
            let rows = task.rows_of(node);
            for panel in panels(node.width as usize).rev() {
                let begin = end - n_values(panel.width, panel.inside + node.height());
                let first = node.first as usize + panel.first;
                let work = PanelWork { values: &values[begin..end], inside: panel.inside, rows };
                end = begin;
                match panel.width {
                    1 => work.backward::<W, 1>(wide, first, x),
                    2 => work.backward::<W, 2>(wide, first, x),
                    3 => work.backward::<W, 3>(wide, first, x),
                    4 => work.backward::<W, 4>(wide, first, x),
                    5 => work.backward::<W, 5>(wide, first, x),
                    6 => work.backward::<W, 6>(wide, first, x),
                    7 => work.backward::<W, 7>(wide, first, x),
                    _ => work.backward::<W, WIDTH>(wide, first, x),
                }
            }
        }
    }
}

/// A panel of N columns.
struct PanelWork<'a> {
    values: &'a [f64],
    /// Rows below the triangle that are later columns of the same node; the others are `rows`.
    inside: usize,
    rows: &'a [u32],
}

impl PanelWork<'_> {
    #[inline(always)]
    fn forward<W: Wide, const N: usize>(&self, wide: W, first: usize, x: &mut [Quad]) {
        let (inverse, below) = self.values.split_at(triangle(N));
        let (mine, after) = x[first..].split_at_mut(N);
        let b: [W::Four; N] = std::array::from_fn(
            #[inline(always)]
            |j| wide.four(mine[j].0),
        );
        let mut y = [wide.splat4(0.0); N];
        for i in 0..N {
            for j in 0..=i {
                y[i] = wide.fma4(b[j], wide.splat4(inverse[triangle(i) + j]), y[i]);
            }
        }
        for j in 0..N {
            mine[j] = Quad(wide.array4(y[j]));
            y[j] = wide.sub4(wide.splat4(0.0), y[j]);
        }
        let (below_inside, below_rows) = below.split_at(self.inside * N);
        for (x, l) in after.iter_mut().zip(below_inside.chunks_exact(N)) {
            let mut sum = wide.four(x.0);
            for j in 0..N {
                sum = wide.fma4(y[j], wide.splat4(l[j]), sum);
            }
            *x = Quad(wide.array4(sum));
        }
        for (&row, l) in self.rows.iter().zip(below_rows.chunks_exact(N)) {
            let x = &mut x[row as usize];
            let mut sum = wide.four(x.0);
            for j in 0..N {
                sum = wide.fma4(y[j], wide.splat4(l[j]), sum);
            }
            *x = Quad(wide.array4(sum));
        }
    }

    #[inline(always)]
    fn backward<W: Wide, const N: usize>(&self, wide: W, first: usize, x: &mut [Quad]) {
        let (inverse, below) = self.values.split_at(triangle(N));
        let (below_inside, below_rows) = below.split_at(self.inside * N);
        let mut sums = [wide.splat4(0.0); N];
        for (&row, l) in self.rows.iter().zip(below_rows.chunks_exact(N)) {
            let x = wide.four(x[row as usize].0);
            for j in 0..N {
                sums[j] = wide.fma4(x, wide.splat4(l[j]), sums[j]);
            }
        }
        let (mine, after) = x[first..].split_at_mut(N);
        for (x, l) in after.iter().zip(below_inside.chunks_exact(N)) {
            let x = wide.four(x.0);
            for j in 0..N {
                sums[j] = wide.fma4(x, wide.splat4(l[j]), sums[j]);
            }
        }
        for j in 0..N {
            sums[j] = wide.sub4(wide.four(mine[j].0), sums[j]);
        }
        for j in 0..N {
            let mut sum = wide.splat4(0.0);
            for i in j..N {
                sum = wide.fma4(sums[i], wide.splat4(inverse[triangle(i) + j]), sum);
            }
            mine[j] = Quad(wide.array4(sum));
        }
    }
}
