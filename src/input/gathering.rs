//! Entries of a text matrix while it is read. Repeated entries are added up before they cost memory.
//!
//! A file may repeat its entries as often as its size allows, and gzip makes such a file small. So memory is bounded by the number of
//! positions and not by the number of lines. When many entries have been read, a sample estimates how many positions there are. If they are
//! less than half of the entries, entries are merged. Sums have the bits of the file's order, whenever they are merged.

use std::hash::{BuildHasher, RandomState};

use rayon::prelude::*;

use super::digits::{Digits, digits_of_blocks};
use crate::sparse::{TripletBlocks, Triplets};

/// Up to this number, 64 MiB, entries are not merged.
const FIRST_LOOK: usize = 1 << 22;
/// One position in so many is in the sample.
const SAMPLED: u64 = 64;

/// The entries so far.
pub(super) struct Gathering {
    triplets: TripletBlocks,
    /// Entries that came.
    n_entries: u64,
    /// Entries that are held.
    n_held: usize,
    /// Entries that are in others.
    n_merged: usize,
    /// The most entries that were added up at one position, at most.
    most_merged: usize,
    /// What the numbers showed before any were added up.
    digits: Option<Digits>,
    look_at: usize,
    hashing: RandomState,
    first: Option<First>,
}

/// The first entry of a file without a banner, which may turn out to be a size line: sums are kept with and without it.
struct First {
    row: u32,
    col: u32,
    /// It and everything of its position that was merged; the entries hold the sum without it.
    sum: f64,
    /// Whether the first entry of its position in the list is such a sum.
    is_merged: bool,
}

/// Everything that came.
pub(super) struct Gathered {
    pub(super) triplets: TripletBlocks,
    /// Entries that repeated an earlier position and are in the sums.
    pub(super) n_merged: usize,
    /// The most of them at one position, at most.
    pub(super) most_merged: usize,
    /// What the numbers of the file show of their digits.
    pub(super) digits: Digits,
}

impl Gathering {
    pub(super) fn new() -> Self {
        Self {
            triplets: TripletBlocks::default(),
            n_entries: 0,
            n_held: 0,
            n_merged: 0,
            most_merged: 0,
            digits: None,
            look_at: FIRST_LOOK,
            hashing: RandomState::new(),
            first: None,
        }
    }

    /// Entries that came.
    pub(super) fn n_entries(&self) -> u64 {
        self.n_entries
    }

    /// Entries that are held.
    pub(super) fn n_held(&self) -> usize {
        self.n_held
    }

    /// Keeps the first entry that comes apart until it is known what it is.
    pub(super) fn doubt_first(&mut self, mut entries: Triplets) -> Triplets {
        if self.first.is_none() && self.n_entries == 0 && !entries.is_empty() {
            let (row, col, sum) = (entries.rows.remove(0), entries.cols.remove(0), entries.values.remove(0));
            self.first = Some(First { row, col, sum, is_merged: false });
            self.n_entries = 1;
        }
        entries
    }

    /// Takes the next entries of the file.
    pub(super) fn append(&mut self, entries: Triplets) {
        self.n_entries += entries.len() as u64;
        self.n_held += entries.len();
        self.triplets.blocks.push(entries);
        if self.n_held < self.look_at {
            return;
        }
        if self.estimated_positions() < self.n_held / 2 {
            self.merge();
        }
        self.look_at = FIRST_LOOK.max(2 * self.n_held);
    }

    /// Gives every row and column a new number.
    pub(super) fn renumber(&mut self, number: &[u32]) {
        self.triplets.blocks.par_iter_mut().for_each(|block| {
            for index in block.rows.iter_mut().chain(&mut block.cols) {
                *index = number[*index as usize];
            }
        });
    }

    /// The largest index beyond the first entry, from 1; none without another entry.
    pub(super) fn largest_index_of_rest(&self) -> u64 {
        let largest = |block: &Triplets| block.rows.iter().chain(&block.cols).max().copied();
        self.triplets.blocks.par_iter().filter_map(largest).max().map_or(0, |index| u64::from(index) + 1)
    }

    /// The largest index, from 1.
    pub(super) fn largest_index(&self) -> u64 {
        let of_first = self.first.as_ref().map_or(0, |first| u64::from(first.row.max(first.col)) + 1);
        of_first.max(self.largest_index_of_rest())
    }

    /// All entries, the first one among them.
    pub(super) fn all(mut self) -> Gathered {
        if self.n_merged > 0 || self.first.as_ref().is_some_and(|first| first.is_merged) {
            self.merge();
        }
        let digits = self.digits();
        let Self { mut triplets, n_merged, most_merged, first, .. } = self;
        if let Some(First { row, col, sum, is_merged }) = first {
            let merged = triplets.blocks.first_mut().filter(|_| is_merged);
            let held = merged.and_then(|block| {
                let at = block.rows.iter().zip(&block.cols).position(|at| at == (&row, &col))?;
                block.values.get_mut(at)
            });
            match held {
                // Merged once more above, so that the position is there once and this is its whole sum.
                Some(value) => *value = sum,
                None => triplets.blocks.insert(0, Triplets { rows: vec![row], cols: vec![col], values: vec![sum] }),
            }
            return Gathered {
                triplets,
                n_merged: n_merged + usize::from(is_merged),
                most_merged: most_merged + 1,
                digits,
            };
        }
        Gathered { triplets, n_merged, most_merged, digits }
    }

    /// The entries without the first one, which was a size line.
    pub(super) fn rest(self) -> Gathered {
        let digits = self.digits();
        Gathered { triplets: self.triplets, n_merged: self.n_merged, most_merged: self.most_merged, digits }
    }

    /// Sums of numbers of few digits have more of them, or all that a double has: the numbers are looked at as they stand in the file.
    fn digits(&self) -> Digits {
        self.digits.unwrap_or_else(|| digits_of_blocks(&self.triplets))
    }

    /// How many positions differ, by those of a sample that no file can know.
    fn estimated_positions(&self) -> usize {
        let key = |(row, col, _): (u32, u32, f64)| (u64::from(row) << 32) | u64::from(col);
        let is_sampled = |key: &u64| self.hashing.hash_one(key).is_multiple_of(SAMPLED);
        let blocks = self.triplets.blocks.par_iter();
        let mut sample: Vec<u64> = blocks.flat_map_iter(|block| block.iter().map(key).filter(is_sampled)).collect();
        sample.par_sort_unstable();
        sample.dedup();
        sample.len().saturating_mul(SAMPLED as usize)
    }

    /// Adds up the entries of each position, in the order of the file.
    fn merge(&mut self) {
        self.digits = Some(self.digits());
        let before = self.n_held;
        let mut entries: Vec<(u32, u32, f64)> = Vec::with_capacity(before);
        std::mem::take(&mut self.triplets).blocks.into_iter().for_each(|block| entries.extend(block.iter()));
        // Stable: entries of one position stay in the order of the file.
        entries.par_sort_by_key(|&(row, col, _)| (row, col));
        self.add_to_first(&entries);
        let runs = entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).map(<[_]>::len);
        // What was merged before may be one of them, as one more may be the first entry.
        self.most_merged += runs.max().unwrap_or(0);
        entries.dedup_by(|next, kept| {
            let is_same = (next.0, next.1) == (kept.0, kept.1);
            if is_same {
                kept.2 += next.2;
            }
            is_same
        });
        self.n_merged += before - entries.len();
        let mut merged = Triplets::with_capacity(entries.len());
        entries.iter().for_each(|&(row, col, value)| merged.push(row, col, value));
        self.n_held = merged.len();
        self.triplets = merged.into();
    }

    /// Adds what is about to be merged into the position of the first entry to the sum that holds it.
    fn add_to_first(&mut self, sorted: &[(u32, u32, f64)]) {
        let Some(first) = &mut self.first else { return };
        let from = sorted.partition_point(|&(row, col, _)| (row, col) < (first.row, first.col));
        let same = sorted[from..].iter().take_while(|&&(row, col, _)| (row, col) == (first.row, first.col));
        // What was merged before is in the sum.
        for &(.., value) in same.skip(usize::from(first.is_merged)) {
            first.sum += value;
            first.is_merged = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries that repeat a few positions, with values whose sums show the order they were added in.
    fn entries(n: u32) -> Vec<(u32, u32, f64)> {
        (0..n).map(|k| (k * 7 % 5, k * 3 % 4, 1.0 / f64::from(k + 1) * 10f64.powi((k % 7) as i32))).collect()
    }

    fn triplets(entries: &[(u32, u32, f64)]) -> Triplets {
        let mut triplets = Triplets::default();
        entries.iter().for_each(|&(row, col, value)| triplets.push(row, col, value));
        triplets
    }

    /// The sum of every position in the order of the entries.
    fn sums(entries: impl IntoIterator<Item = (u32, u32, f64)>) -> std::collections::BTreeMap<(u32, u32), f64> {
        let mut sums = std::collections::BTreeMap::new();
        for (row, col, value) in entries {
            sums.entry((row, col)).and_modify(|sum| *sum += value).or_insert(value);
        }
        sums
    }

    fn listed(gathered: &TripletBlocks) -> Vec<(u32, u32, f64)> {
        gathered.iter().collect()
    }

    /// Wherever the entries are cut and merged, and whether or not the first one is doubted.
    #[test]
    fn sums_are_those_of_the_files_order() {
        let entries = entries(200);
        let distinct = sums(entries.clone()).len();
        for cut in [1, 2, 3, 10, 77, 199] {
            for doubted in [false, true] {
                let gather = || {
                    let mut gathering = Gathering::new();
                    for part in entries.chunks(cut) {
                        let mut part = triplets(part);
                        if doubted {
                            part = gathering.doubt_first(part);
                        }
                        gathering.append(part);
                        gathering.merge();
                    }
                    gathering
                };
                assert_eq!(gather().n_entries(), 200);
                let all = gather().all();
                assert_eq!(sums(listed(&all.triplets)), sums(entries.clone()), "parts of {cut}, doubted: {doubted}");
                assert_eq!((all.triplets.len(), all.n_merged), (distinct, 200 - distinct), "parts of {cut}: {doubted}");
                if doubted {
                    let rest = gather().rest();
                    assert_eq!(sums(listed(&rest.triplets)), sums(entries[1..].to_vec()), "parts of {cut}");
                    assert_eq!(rest.n_merged, 199 - rest.triplets.len());
                }
            }
        }
    }

    #[test]
    fn what_is_held_follows_the_positions_not_the_lines() {
        let part = triplets(&entries(1 << 16));
        let mut repeated = Gathering::new();
        let mut most = 0;
        for _ in 0..3 * (FIRST_LOOK >> 16) {
            repeated.append(part.clone());
            most = most.max(repeated.n_held());
        }
        assert_eq!((repeated.n_entries(), most), (3 * FIRST_LOOK as u64, FIRST_LOOK - (1 << 16) + 20));
        assert!(repeated.all().triplets.len() == 20);

        let mut distinct = Gathering::new();
        for row in 0..(FIRST_LOOK as u32) >> 10 {
            distinct.append(triplets(&(0..1 << 11).map(|col| (row, col, 1.0)).collect::<Vec<_>>()));
        }
        assert_eq!((distinct.n_held(), distinct.all().n_merged), (2 * FIRST_LOOK, 0));
    }
}
