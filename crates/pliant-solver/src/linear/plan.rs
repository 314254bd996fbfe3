//! The work of factoring and solving, cut into a tree of tasks.
//!
//! A *leaf* task is a whole subtree of supernodes, or a few small ones side by side; an *upper* task is a supernode
//! whose subtree is too large to be done at a stretch (or a chain of such without branches), worked on after the tasks
//! below it. A task touches its own columns and some rows of the tasks above it, its *boundary*. It works on numbers of
//! its own only: local rows 0..n_columns are its columns, the ones after it the boundary; what it has gathered for the
//! boundary is added by the task above. So tasks in different subtrees can run at the same time.
//!
//! Tasks are in postorder: those below task t are `tasks[t.first_task..t]`. The last task is the root; it has no columns
//! and joins the trees of the forest.

use std::ops::Range;

use super::symbolic::Supernodes;

/// Leaf tasks have up to this share of all values of L: enough tasks for sixteen threads, and few enough that the rows
/// shared between them cost little.
const LEAF_SHARE: usize = 24;
/// A leaf task of fewer values would not be worth handing to another thread: some ten microseconds of a solve.
const LEAF_VALUES: usize = 20_000;
/// Upper tasks nested deeper than this are cut short: no mesh comes near, and the depth of recursion is bounded.
const DEEPEST: usize = 64;
/// No parent.
const NONE: u32 = u32::MAX;

/// Columns of L with the same rows below them, in local rows of their task.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// First column.
    pub(super) first: u32,
    /// Number of columns.
    pub(super) width: u32,
    /// Rows below the columns: `task.rows[rows]`.
    pub(super) rows: Range<usize>,
    /// How many nodes of the same task hand their remainder to this one.
    pub(super) n_updates: usize,
}

impl Node {
    pub(super) fn height(&self) -> usize {
        self.rows.len()
    }
}

/// An entry of the matrix: local row, and place in the caller's values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) row: u32,
    pub(super) slot: u32,
}

/// A piece of work on a range of columns.
#[derive(Debug)]
pub(super) struct Task {
    /// The tasks below are those from here on up to this one.
    pub(super) first_task: usize,
    /// Those directly below, ascending.
    pub(super) children: Vec<usize>,
    /// Columns in elimination order.
    pub(super) columns: Range<u32>,
    /// Rows of tasks above that are touched, ascending, in elimination order.
    pub(super) boundary: Vec<u32>,
    /// Local row in the task above of each row of the boundary.
    pub(super) boundary_above: Vec<u32>,
    /// In elimination order; those of an upper task are a chain, and the first takes what comes from the tasks below.
    pub(super) nodes: Vec<Node>,
    pub(super) rows: Vec<u32>,
    /// Entries of the matrix on and below the diagonal of local column c: `entries[entries_at[c]..entries_at[c + 1]]`.
    pub(super) entries_at: Vec<u32>,
    pub(super) entries: Vec<Entry>,
    /// Where the local rows begin in a vector of the rows of all tasks.
    pub(super) rows_begin: usize,
}

impl Task {
    pub(super) fn n_columns(&self) -> usize {
        self.columns.len()
    }

    /// Columns and boundary.
    pub(super) fn n_rows(&self) -> usize {
        self.columns.len() + self.boundary.len()
    }

    /// Rows below the columns of a node.
    pub(super) fn rows_of(&self, node: &Node) -> &[u32] {
        &self.rows[node.rows.clone()]
    }

    fn local_row(&self, row: u32) -> u32 {
        if row < self.columns.end {
            row - self.columns.start
        } else {
            let place = self.boundary.partition_point(|&other| other < row);
            (self.n_columns() + place) as u32
        }
    }
}

/// All tasks, and where each of the caller's rows is worked on.
#[derive(Debug)]
pub(super) struct Plan {
    pub(super) tasks: Vec<Task>,
    /// The caller's row of each column.
    pub(super) order: Vec<u32>,
    /// Place of each of the caller's rows in a vector of the rows of all tasks.
    pub(super) place: Vec<u32>,
}

impl Plan {
    /// `columns`, `rows`: lower triangle of the matrix in the caller's rows, by columns.
    pub(super) fn new(order: Vec<u32>, supernodes: &Supernodes, (columns, rows): (&[u32], &[u32])) -> Plan {
        let tree = Tree::new(supernodes);
        let mut tasks = Vec::new();
        let roots: Vec<usize> = (0..supernodes.len()).filter(|&s| tree.parent[s] == NONE).collect();
        let below = Builder { supernodes, tree: &tree, tasks: &mut tasks }.children(&roots, 0);
        let end = order.len() as u32;
        Builder { supernodes, tree: &tree, tasks: &mut tasks }.push(0..0, end..end, below);
        let mut plan = Plan { tasks, place: vec![0; order.len()], order };
        plan.place_rows();
        plan.find_entries(columns, rows);
        plan
    }

    /// Number of local rows of all tasks.
    pub(super) fn n_rows(&self) -> usize {
        self.tasks.last().map_or(0, |root| root.rows_begin + root.n_rows())
    }

    fn place_rows(&mut self) {
        let mut begin = 0;
        for task in &mut self.tasks {
            task.rows_begin = begin;
            for (local, column) in task.columns.clone().enumerate() {
                self.place[self.order[column as usize] as usize] = (begin + local) as u32;
            }
            begin += task.n_rows();
        }
        for above in 0..self.tasks.len() {
            for child in self.tasks[above].children.clone() {
                let boundary = std::mem::take(&mut self.tasks[child].boundary);
                self.tasks[child].boundary_above =
                    boundary.iter().map(|&row| self.tasks[above].local_row(row)).collect();
                self.tasks[child].boundary = boundary;
            }
        }
    }

    fn find_entries(&mut self, columns: &[u32], rows: &[u32]) {
        let n = self.order.len();
        let mut column_of = vec![0u32; n];
        for (column, &row) in self.order.iter().enumerate() {
            column_of[row as usize] = column as u32;
        }
        // Each entry belongs to the column that is eliminated first.
        let mut begin = vec![0u32; n + 1];
        let entries = || {
            (0..n).flat_map(|j| (columns[j]..columns[j + 1]).map(move |slot| (j, slot))).map(|(j, slot)| {
                let (a, b) = (column_of[j], column_of[rows[slot as usize] as usize]);
                (a.min(b) as usize, Entry { row: a.max(b), slot })
            })
        };
        entries().for_each(|(column, _)| begin[column + 1] += 1);
        (0..n).for_each(|column| begin[column + 1] += begin[column]);
        let mut sorted = vec![Entry { row: 0, slot: 0 }; rows.len()];
        let mut next = begin.clone();
        for (column, entry) in entries() {
            sorted[next[column] as usize] = entry;
            next[column] += 1;
        }
        for task in &mut self.tasks {
            let (first, end) = (task.columns.start as usize, task.columns.end as usize);
            let base = begin[first];
            task.entries_at = begin[first..=end].iter().map(|at| at - base).collect();
            let global = &sorted[base as usize..begin[end] as usize];
            task.entries = global.iter().map(|entry| Entry { row: task.local_row(entry.row), ..*entry }).collect();
        }
    }
}

/// The supernodes as a forest.
struct Tree {
    parent: Vec<u32>,
    /// Children of supernode s: `children[children_at[s]..children_at[s + 1]]`, ascending.
    children_at: Vec<usize>,
    children: Vec<usize>,
    /// First supernode of each subtree.
    first: Vec<usize>,
    /// Values of L in each subtree.
    n_values: Vec<usize>,
    leaf_values: usize,
}

impl Tree {
    fn new(supernodes: &Supernodes) -> Tree {
        let n = supernodes.len();
        let mut supernode_of = vec![0u32; supernodes.begin[n] as usize];
        for s in 0..n {
            supernodes.columns(s).for_each(|column| supernode_of[column as usize] = s as u32);
        }
        let parent: Vec<u32> =
            (0..n).map(|s| supernodes.rows(s).first().map_or(NONE, |&row| supernode_of[row as usize])).collect();
        let mut children_at = vec![0; n + 1];
        parent.iter().filter(|&&p| p != NONE).for_each(|&p| children_at[p as usize + 1] += 1);
        (0..n).for_each(|s| children_at[s + 1] += children_at[s]);
        let mut children = vec![0; children_at[n]];
        let mut next = children_at.clone();
        let mut first: Vec<usize> = (0..n).collect();
        let mut n_values: Vec<usize> = (0..n)
            .map(|s| {
                let width = supernodes.columns(s).len();
                width * (width + 1) / 2 + width * supernodes.rows(s).len()
            })
            .collect();
        for s in 0..n {
            if parent[s] != NONE {
                let p = parent[s] as usize;
                children[next[p]] = s;
                next[p] += 1;
                first[p] = first[p].min(first[s]);
                n_values[p] += n_values[s];
            }
        }
        let total: usize = (0..n).filter(|&s| parent[s] == NONE).map(|s| n_values[s]).sum();
        Tree { parent, children_at, children, first, n_values, leaf_values: (total / LEAF_SHARE).max(LEAF_VALUES) }
    }

    fn children(&self, s: usize) -> &[usize] {
        &self.children[self.children_at[s]..self.children_at[s + 1]]
    }
}

struct Builder<'a> {
    supernodes: &'a Supernodes,
    tree: &'a Tree,
    tasks: &'a mut Vec<Task>,
}

impl Builder<'_> {
    /// Tasks for sibling subtrees: small ones are put together. Returns the tasks directly below the caller.
    fn children(&mut self, siblings: &[usize], depth: usize) -> Vec<usize> {
        let mut made = Vec::new();
        let mut small: Option<Range<usize>> = None;
        let mut small_values = 0;
        for &s in siblings {
            let is_large = self.tree.n_values[s] > self.tree.leaf_values && depth < DEEPEST;
            if is_large || small_values + self.tree.n_values[s] > self.tree.leaf_values {
                made.extend(small.take().map(|supernodes| self.leaf(supernodes)));
                small_values = 0;
            }
            if is_large {
                made.push(self.upper(s, depth));
            } else {
                let first = small.map_or(self.tree.first[s], |supernodes| supernodes.start);
                small = Some(first..s + 1);
                small_values += self.tree.n_values[s];
            }
        }
        made.extend(small.take().map(|supernodes| self.leaf(supernodes)));
        made
    }

    fn upper(&mut self, last: usize, depth: usize) -> usize {
        let mut first = last;
        while let [only] = self.tree.children(first)
            && self.tree.n_values[*only] > self.tree.leaf_values
        {
            first = *only;
        }
        let below = self.children(self.tree.children(first), depth + 1);
        let columns = self.supernodes.begin[first]..self.supernodes.begin[last + 1];
        self.push(first..last + 1, columns, below)
    }

    fn leaf(&mut self, supernodes: Range<usize>) -> usize {
        let columns = self.supernodes.begin[supernodes.start]..self.supernodes.begin[supernodes.end];
        self.push(supernodes, columns, Vec::new())
    }

    fn push(&mut self, supernodes: Range<usize>, columns: Range<u32>, children: Vec<usize>) -> usize {
        let index = self.tasks.len();
        let first_task = children.first().map_or(index, |&child| self.tasks[child].first_task);
        let mut boundary: Vec<u32> = supernodes
            .clone()
            .filter(|&s| self.tree.parent[s] == NONE || self.tree.parent[s] as usize >= supernodes.end)
            .flat_map(|s| self.supernodes.rows(s).iter().copied())
            .collect();
        boundary.sort_unstable();
        boundary.dedup();
        let mut task = Task {
            first_task,
            children,
            columns,
            boundary,
            boundary_above: Vec::new(),
            nodes: Vec::with_capacity(supernodes.len()),
            rows: Vec::new(),
            entries_at: Vec::new(),
            entries: Vec::new(),
            rows_begin: 0,
        };
        for s in supernodes.clone() {
            let columns = self.supernodes.columns(s);
            let begin = task.rows.len();
            let local: Vec<u32> = self.supernodes.rows(s).iter().map(|&row| task.local_row(row)).collect();
            task.rows.extend(local);
            let inside = self.tree.children(s).iter().filter(|child| supernodes.contains(child)).count();
            task.nodes.push(Node {
                first: columns.start - task.columns.start,
                width: columns.len() as u32,
                rows: begin..task.rows.len(),
                n_updates: inside,
            });
        }
        self.tasks.push(task);
        index
    }
}
