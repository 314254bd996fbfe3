//! The elimination tree: column j's parent is the first row below the diagonal in column j of L, and columns in
//! different subtrees have nothing to do with each other.

/// No parent, no ancestor.
const NONE: u32 = u32::MAX;

/// Renumbers an order so that every subtree of its elimination tree is a range of columns and parents come last. This
/// changes neither fill nor work, but columns of equal structure become neighbors. `offsets`, `neighbors`: the graph of
/// the matrix without its diagonal.
pub(super) fn postordered(order: &[u32], offsets: &[u32], neighbors: &[u32]) -> Vec<u32> {
    let parents = elimination_tree(order, offsets, neighbors);
    postorder(&parents).into_iter().map(|column| order[column as usize]).collect()
}

/// Parent of each column, by walking up from the earlier neighbors of each column shortening the paths on the way
/// (Liu 1986).
fn elimination_tree(order: &[u32], offsets: &[u32], neighbors: &[u32]) -> Vec<u32> {
    let n = order.len();
    let mut column_of = vec![0u32; n];
    for (column, &row) in order.iter().enumerate() {
        column_of[row as usize] = column as u32;
    }
    let mut parents = vec![NONE; n];
    let mut ancestors = vec![NONE; n];
    for (column, &row) in order.iter().enumerate() {
        let column = column as u32;
        for &neighbor in &neighbors[offsets[row as usize] as usize..offsets[row as usize + 1] as usize] {
            let mut below = column_of[neighbor as usize];
            while below < column {
                let above = std::mem::replace(&mut ancestors[below as usize], column);
                if above == NONE {
                    parents[below as usize] = column;
                    break;
                }
                below = above;
            }
        }
    }
    parents
}

/// Columns with children before parents, each subtree in a row.
fn postorder(parents: &[u32]) -> Vec<u32> {
    let n = parents.len();
    // Children as linked lists in ascending order.
    let (mut first_child, mut next_sibling) = (vec![NONE; n], vec![NONE; n]);
    let mut roots = Vec::new();
    for column in (0..n as u32).rev() {
        match parents[column as usize] {
            NONE => roots.push(column),
            parent => {
                next_sibling[column as usize] = std::mem::replace(&mut first_child[parent as usize], column);
            }
        }
    }
    let mut ordered = Vec::with_capacity(n);
    // `roots` is a stack with the first root on top.
    let mut stack = roots;
    while let Some(&column) = stack.last() {
        match std::mem::replace(&mut first_child[column as usize], NONE) {
            NONE => {
                stack.pop();
                ordered.push(column);
                let sibling = next_sibling[column as usize];
                if sibling != NONE {
                    stack.push(sibling);
                }
            }
            child => stack.push(child),
        }
    }
    ordered
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subtrees_become_ranges_and_parents_come_last() {
        // A path 0 - 1 - … - 8 eliminated from both ends and the middle outward.
        let order = [0, 8, 4, 2, 6, 1, 3, 5, 7];
        let mut offsets = vec![0u32];
        let mut neighbors = Vec::new();
        for v in 0..9u32 {
            neighbors.extend(v.checked_sub(1));
            neighbors.extend((v < 8).then_some(v + 1));
            offsets.push(neighbors.len() as u32);
        }
        let after = postordered(&order, &offsets, &neighbors);
        let mut sorted = after.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..9).collect::<Vec<_>>(), "a permutation");
        let parents = elimination_tree(&after, &offsets, &neighbors);
        let mut first = (0..9).collect::<Vec<usize>>();
        for column in 0..9 {
            if parents[column] != NONE {
                let parent = parents[column] as usize;
                assert!(parent > column, "column {column} comes before its parent {parent}");
                first[parent] = first[parent].min(first[column]);
                assert!(first[parent] <= first[column], "the subtree of {parent} is a range");
            }
        }
        assert_eq!(postorder(&parents), (0..9).collect::<Vec<_>>(), "already in postorder");
    }
}
