//! A set of small integers that is filled in any order and emptied in ascending order, as runs.

/// Bits with a second level that tells which words have any.
pub(crate) struct EdgeSet {
    words: Vec<u64>,
    /// Bit k: word k is not zero.
    summary: Vec<u64>,
    /// Words of the summary in use: `lowest..=highest`, empty if reversed.
    lowest: usize,
    highest: usize,
}

impl EdgeSet {
    /// An empty set for numbers below `n`.
    pub(crate) fn new(n: usize) -> EdgeSet {
        let n_words = n.div_ceil(64);
        EdgeSet { words: vec![0; n_words], summary: vec![0; n_words.div_ceil(64)], lowest: usize::MAX, highest: 0 }
    }

    pub(crate) fn insert(&mut self, x: u32) {
        let word = x as usize / 64;
        let group = word / 64;
        self.words[word] |= 1 << (x % 64);
        self.summary[group] |= 1 << (word % 64);
        self.lowest = self.lowest.min(group);
        self.highest = self.highest.max(group);
    }

    /// Calls `run(first, end)` for every maximal run of consecutive members, ascending, and empties the set.
    pub(crate) fn drain_runs(&mut self, mut run: impl FnMut(u32, u32)) {
        let (mut first, mut end) = (0, 0);
        for group in self.lowest..=self.highest.min(self.summary.len().wrapping_sub(1)) {
            let mut used = std::mem::take(&mut self.summary[group]);
            while used != 0 {
                let word = group * 64 + used.trailing_zeros() as usize;
                used &= used - 1;
                let mut bits = std::mem::take(&mut self.words[word]);
                while bits != 0 {
                    let skip = bits.trailing_zeros();
                    let length = (bits >> skip).trailing_ones();
                    let start = (word * 64) as u32 + skip;
                    if start != end || first == end {
                        if first != end {
                            run(first, end);
                        }
                        first = start;
                    }
                    end = start + length;
                    let taken = skip + length;
                    bits = if taken == 64 { 0 } else { bits >> taken << taken };
                }
            }
        }
        if first != end {
            run(first, end);
        }
        (self.lowest, self.highest) = (usize::MAX, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_come_out_ascending_maximal_and_once() {
        let mut set = EdgeSet::new(10_000);
        for x in [9_999, 5, 3, 4, 63, 64, 0, 127, 128, 4096, 4095] {
            set.insert(x);
        }
        let mut runs = Vec::new();
        set.drain_runs(|a, b| runs.push((a, b)));
        assert_eq!(runs, [(0, 1), (3, 6), (63, 65), (127, 129), (4095, 4097), (9_999, 10_000)]);
        set.drain_runs(|a, b| panic!("left over: {a}..{b}"));
        (0..200).for_each(|x| set.insert(x));
        let mut runs = Vec::new();
        set.drain_runs(|a, b| runs.push((a, b)));
        assert_eq!(runs, [(0, 200)]);
    }
}
