//! Indices of a sparse matrix in 32 bits, whatever width its file gives them.
//!
//! Files keep indices in up to eight bytes. Held so, they and the values would take as much as the entries of the matrix that is made of
//! them, and half as much again while they are narrowed.

/// Indices from zero as they came, not yet trusted.
#[derive(Debug, Default)]
pub(super) struct Indices {
    /// Each index, or the largest number in place of one that does not fit: no matrix has so many rows.
    numbers: Vec<u32>,
    /// Position and value of the first index that does not fit.
    misfit: Option<(usize, i64)>,
}

impl Indices {
    /// None yet, with room for so many.
    pub(super) fn with_capacity(n: usize) -> Self {
        Self { numbers: Vec::with_capacity(n), misfit: None }
    }

    /// Takes the next index.
    pub(super) fn push(&mut self, index: i64) {
        let number = u32::try_from(index);
        if number.is_err() && self.misfit.is_none() {
            self.misfit = Some((self.numbers.len(), index));
        }
        self.numbers.push(number.unwrap_or(u32::MAX));
    }

    pub(super) fn len(&self) -> usize {
        self.numbers.len()
    }

    /// Forgets all behind the first so many.
    pub(super) fn truncate(&mut self, n: usize) {
        self.numbers.truncate(n);
        self.misfit = self.misfit.filter(|(position, _)| *position < n);
    }

    /// The indices from a position on, which are taken out.
    pub(super) fn split_off(&mut self, at: usize) -> Self {
        let mut rest = Self { numbers: self.numbers.split_off(at), misfit: None };
        // The first misfit of the second part is known where the first part has none.
        let is_in_rest = |(position, _): &(usize, i64)| *position >= at;
        rest.misfit = match self.misfit.take_if(|misfit| is_in_rest(misfit)) {
            Some((position, index)) => Some((position - at, index)),
            None => first_without_value(&rest.numbers),
        };
        rest
    }

    /// The indices at even positions and those at odd ones.
    pub(super) fn into_alternating(self) -> [Self; 2] {
        [0, 1].map(|first| {
            let numbers: Vec<u32> = self.numbers.iter().skip(first).step_by(2).copied().collect();
            let own = self.misfit.filter(|(position, _)| position % 2 == first).map(|(at, index)| (at / 2, index));
            let misfit = own.or_else(|| first_without_value(&numbers));
            Self { numbers, misfit }
        })
    }

    /// Those that fit, where all do up to the one that is asked for.
    #[cfg(feature = "hdf5")]
    pub(super) fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// The indices, once each is known to be below n.
    ///
    /// # Errors
    /// Position and value of the first that is not.
    pub(super) fn below(self, n: u64) -> Result<Vec<u32>, (usize, i64)> {
        match self.numbers.iter().position(|number| u64::from(*number) >= n || *number == u32::MAX) {
            None => Ok(self.numbers),
            Some(position) => {
                let misfit = self.misfit.filter(|(other, _)| *other == position);
                Err(misfit.unwrap_or((position, i64::from(self.numbers[position]))))
            }
        }
    }
}

/// The first misfit of indices that were parted from others, which may have had the one whose value is known.
fn first_without_value(numbers: &[u32]) -> Option<(usize, i64)> {
    numbers.iter().position(|number| *number == u32::MAX).map(|at| (at, i64::from(u32::MAX)))
}

impl FromIterator<i64> for Indices {
    fn from_iter<I: IntoIterator<Item = i64>>(indices: I) -> Self {
        let indices = indices.into_iter();
        let mut all = Self::with_capacity(indices.size_hint().0);
        indices.for_each(|index| all.push(index));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(indices: &[i64]) -> Indices {
        indices.iter().copied().collect()
    }

    #[test]
    fn the_first_index_outside_is_told_as_it_came() {
        assert_eq!(of(&[0, 2, 1]).below(3), Ok(vec![0, 2, 1]));
        assert_eq!(of(&[0, 3, -1]).below(3), Err((1, 3)));
        assert_eq!(of(&[0, -1, 3]).below(3), Err((1, -1)));
        assert_eq!(of(&[1 << 40, -1]).below(3), Err((0, 1 << 40)));
        // Not even where a matrix could have so many rows.
        assert_eq!(of(&[0, -5]).below(u64::MAX), Err((1, -5)));
    }

    #[test]
    fn parts_keep_what_does_not_fit() {
        let mut cut = of(&[0, 1, -7, 2]);
        cut.truncate(2);
        assert_eq!(cut.below(2), Ok(vec![0, 1]));
        let mut first = of(&[0, 1, 1 << 35, -7]);
        let second = first.split_off(2);
        assert_eq!((first.below(2), second.below(2)), (Ok(vec![0, 1]), Err((0, 1 << 35))));
    }
}
