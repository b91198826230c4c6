//! What a set of triplets gives of a symmetric matrix where its source does not say so.

use rayon::prelude::*;

use super::TripletBlocks;

/// Which of the two places of each pair of a row and a column have entries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Given {
    /// Some pairs have entries at both places, or there is nothing off the diagonal: every entry stands for itself.
    #[default]
    Whole,
    /// All entries lie on one side of the diagonal.
    OneTriangle,
    /// Every pair has entries at one of its places, some below the diagonal and some above.
    EitherOrder {
        /// Entries below the diagonal.
        n_below: usize,
        /// Entries above it.
        n_above: usize,
    },
}

impl TripletBlocks {
    /// What the entries give.
    pub(super) fn given(&self) -> Given {
        let n_of = |side: fn(u32, u32) -> bool| self.iter().filter(|&(row, col, _)| side(row, col)).count();
        let has = |side: fn(u32, u32) -> bool| self.iter().any(|(row, col, _)| side(row, col));
        match (has(|row, col| row > col), has(|row, col| row < col)) {
            (false, false) => Given::Whole,
            (true, false) | (false, true) => Given::OneTriangle,
            (true, true) if self.twice().is_some() => Given::Whole,
            (true, true) => {
                Given::EitherOrder { n_below: n_of(|row, col| row > col), n_above: n_of(|row, col| row < col) }
            }
        }
    }

    /// Row and column, the larger one first, of a pair that has entries at both places. The costly question is asked only where the first entry
    /// below the diagonal has none at its mirror image: a whole matrix has those of all.
    pub(super) fn twice(&self) -> Option<(u32, u32)> {
        let (row, col, _) = self.iter().find(|(row, col, _)| row > col)?;
        if self.iter().any(|(other_row, other_col, _)| (other_row, other_col) == (col, row)) {
            return Some((row, col));
        }
        let key = |row: u32, col: u32| (u64::from(row) << 32) | u64::from(col);
        let mut above: Vec<u64> = Vec::new();
        above.extend(self.iter().filter(|(row, col, _)| row < col).map(|(row, col, _)| key(col, row)));
        above.par_sort_unstable();
        let is_twice = |(row, col, _): &(u32, u32, f64)| row > col && above.binary_search(&key(*row, *col)).is_ok();
        let found = self.blocks.par_iter().find_map_first(|block| block.iter().find(is_twice));
        found.map(|(row, col, _)| (row, col))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::Triplets;

    fn given(places: &[(u32, u32)]) -> Given {
        let mut triplets = Triplets::default();
        places.iter().for_each(|(row, col)| triplets.push(*row, *col, 1.0));
        TripletBlocks::from(triplets).given()
    }

    #[test]
    fn pairs_are_counted_and_not_entries() {
        assert_eq!(given(&[]), Given::Whole);
        assert_eq!(given(&[(0, 0), (2, 2)]), Given::Whole);
        assert_eq!(given(&[(1, 0), (2, 2), (2, 1), (1, 0)]), Given::OneTriangle);
        assert_eq!(given(&[(0, 1), (1, 2)]), Given::OneTriangle);
        assert_eq!(given(&[(1, 0), (1, 2), (1, 0)]), Given::EitherOrder { n_below: 2, n_above: 1 });
        // One pair of many at both places, be it the first one or not.
        assert_eq!(given(&[(1, 0), (0, 1), (2, 1), (0, 2)]), Given::Whole);
        assert_eq!(given(&[(2, 1), (0, 2), (1, 0), (0, 1)]), Given::Whole);
    }
}
