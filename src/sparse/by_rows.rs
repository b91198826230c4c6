//! Compressed rows that several threads write where they stay.

use std::ops::Range;

use rayon::prelude::*;

/// Compressed rows that are no matrix yet.
pub(crate) struct RowStorage {
    /// Where each row starts, n + 1 values.
    pub(crate) pointers: Vec<usize>,
    /// Columns.
    pub(crate) indices: Vec<u32>,
    /// Values.
    pub(crate) values: Vec<f64>,
}

/// Rows of known lengths, each written by `fill` with what `scratch` gives its thread.
pub(crate) fn filled<S>(
    lengths: &[usize],
    scratch: impl Fn() -> S + Sync + Send,
    fill: impl Fn(&mut S, usize, &mut [u32], &mut [f64]) + Sync + Send,
) -> RowStorage {
    let mut pointers = Vec::with_capacity(lengths.len() + 1);
    pointers.push(0);
    pointers.extend(lengths.iter().scan(0, |end, length| {
        *end += length;
        Some(*end)
    }));
    let n_stored = pointers[lengths.len()];
    let (mut indices, mut values) = (vec![0; n_stored], vec![0.0; n_stored]);
    let ranges = balanced_ranges(&pointers, 8 * rayon::current_num_threads());
    let parts = split_by_rows(&pointers, &ranges, &mut indices, &mut values);
    parts.into_par_iter().for_each_init(scratch, |scratch, (rows, mut indices, mut values)| {
        for row in rows {
            let whole = "the rows make up the part";
            let indices = indices.split_off_mut(..lengths[row]).expect(whole);
            fill(scratch, row, indices, values.split_off_mut(..lengths[row]).expect(whole));
        }
    });
    RowStorage { pointers, indices, values }
}

/// At most `n_parts` consecutive ranges of rows with about as many entries each.
pub(crate) fn balanced_ranges(pointers: &[usize], n_parts: usize) -> Vec<Range<usize>> {
    let n_rows = pointers.len() - 1;
    let n_stored = pointers[n_rows];
    let mut ranges = Vec::new();
    let mut start = 0;
    for part in 1..=n_parts {
        let target = (n_stored as u128 * part as u128 / n_parts as u128) as usize;
        let end = if part == n_parts { n_rows } else { pointers.partition_point(|&p| p < target).min(n_rows) };
        if end > start {
            ranges.push(start..end);
            start = end;
        }
    }
    ranges
}

/// A range of rows with the parts of the column and value arrays that belong to it.
pub(super) type RowPart<'a> = (Range<usize>, &'a mut [u32], &'a mut [f64]);

pub(super) fn split_by_rows<'a>(
    pointers: &[usize],
    ranges: &[Range<usize>],
    mut indices: &'a mut [u32],
    mut data: &'a mut [f64],
) -> Vec<RowPart<'a>> {
    let mut parts = Vec::with_capacity(ranges.len());
    for rows in ranges {
        let length = pointers[rows.end] - pointers[rows.start];
        let (index_part, index_rest) = indices.split_at_mut(length);
        let (data_part, data_rest) = data.split_at_mut(length);
        (indices, data) = (index_rest, data_rest);
        parts.push((rows.clone(), index_part, data_part));
    }
    parts
}
