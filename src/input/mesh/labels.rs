//! The index of each label.

use std::collections::HashMap;

/// Indices by label.
#[derive(Debug)]
pub(in crate::input) struct Labels {
    places: Places,
    /// Labels with their indices, ascending.
    sorted: Vec<(i64, u32)>,
}

#[derive(Debug)]
enum Places {
    /// Index by label minus the first; `NONE` where there is none.
    Dense {
        first: i64,
        indices: Vec<u32>,
    },
    Sparse(HashMap<i64, u32>),
}

const NONE: u32 = u32::MAX;

/// Bytes that finding a label takes.
pub(in crate::input) const LABEL: u64 = 48;

impl Labels {
    /// Of all labels in the order of their indices; the indices of two equal ones where there are some.
    pub(in crate::input) fn new(labels: &[i64]) -> Result<Self, [usize; 2]> {
        let mut sorted: Vec<(i64, u32)> = labels.iter().copied().zip(0..NONE).collect();
        if !sorted.is_sorted() {
            sorted.sort_unstable();
        }
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err([pair[0].1 as usize, pair[1].1 as usize]);
        }
        let range = sorted.first().zip(sorted.last()).map(|((first, _), (last, _))| (*first, last.checked_sub(*first)));
        let places = match range {
            // Labels of most meshes have few gaps, and a table is faster than a map.
            Some((first, Some(span))) if (span as u64) < 4 * labels.len() as u64 => {
                let mut indices = vec![NONE; span as usize + 1];
                sorted.iter().for_each(|(label, index)| indices[(label - first) as usize] = *index);
                Places::Dense { first, indices }
            }
            _ => Places::Sparse(sorted.iter().copied().collect()),
        };
        Ok(Self { places, sorted })
    }

    /// Of no labels.
    pub(in crate::input) fn none() -> Self {
        Self { places: Places::Sparse(HashMap::new()), sorted: Vec::new() }
    }

    /// The index of a label.
    pub(in crate::input) fn find(&self, label: i64) -> Option<u32> {
        match &self.places {
            Places::Dense { first, indices } => {
                let at = usize::try_from(label.checked_sub(*first)?).ok()?;
                indices.get(at).copied().filter(|index| *index != NONE)
            }
            Places::Sparse(indices) => indices.get(&label).copied(),
        }
    }

    /// The indices of the labels `first`, `first + step`, … up to `last` that there are.
    pub(in crate::input) fn range(&self, first: i64, last: i64, step: i64) -> impl Iterator<Item = u32> {
        let from = self.sorted.partition_point(|(label, _)| *label < first);
        let labels = self.sorted[from..].iter().take_while(move |(label, _)| *label <= last);
        labels.filter(move |(label, _)| step > 0 && (label - first) % step == 0).map(|(_, index)| *index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_with_and_without_gaps() {
        for labels in [vec![5, 3, 4], vec![i64::MIN, 7, i64::MAX, 0]] {
            let found = Labels::new(&labels).expect("different labels");
            for (label, index) in labels.iter().zip(0..) {
                assert_eq!(found.find(*label), Some(index));
            }
            assert_eq!((found.find(6), found.find(i64::MAX - 1)), (None, None));
        }
        assert_eq!(Labels::new(&[8, 2, 9, 2]).expect_err("two of one kind"), [1, 3]);
        let found = Labels::new(&[1, 2, 3, 5, 8, 13]).expect("different labels");
        assert_eq!(found.range(1, 9, 2).collect::<Vec<_>>(), [0, 2, 3]);
        assert_eq!(found.range(1, i64::MAX, 0).count(), 0);
    }
}
