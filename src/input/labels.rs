//! Matrices whose entries stand at nodes and directions in place of rows and columns.

use std::collections::HashMap;

use super::MatrixRole;
use super::assembled::Collector;
use super::blocks::LastLine;
use super::format::{MatrixSource, OrderSource, ReadMatrix};
use super::row_label::RowLabel;
use crate::error::{Error, Result};
use crate::sparse::{Declared, MAX_ORDER};

/// Entries at nodes and directions, as they come.
pub(super) struct LabelledEntries<'a> {
    numbers: HashMap<RowLabel, u32>,
    /// Labels in the order in which they came.
    labels: Vec<RowLabel>,
    /// The label before, which most entries of a file repeat.
    last: Option<(RowLabel, u32)>,
    entries: Collector<'a>,
}

impl<'a> LabelledEntries<'a> {
    /// None yet.
    pub(super) fn new(source: &MatrixSource<'a>, declared: Declared) -> Self {
        let entries = Collector::new(source, declared);
        Self { numbers: HashMap::new(), labels: Vec::new(), last: None, entries }
    }

    /// Takes the next entry.
    ///
    /// # Errors
    /// [`Error::MemoryRead`]; [`Error::MatrixSize`] for more rows than there can be.
    pub(super) fn push(&mut self, source: &MatrixSource<'_>, at: [RowLabel; 2], value: f64) -> Result<()> {
        let [row, col] = at;
        let col = self.number(source, col)?;
        let row = self.number(source, row)?;
        self.entries.push(row, col, value)
    }

    /// True without an entry.
    pub(super) fn is_empty(&self) -> bool {
        self.entries.n_entries() == 0
    }

    fn number(&mut self, source: &MatrixSource<'_>, label: RowLabel) -> Result<u32> {
        if let Some((_, number)) = self.last.filter(|(last, _)| *last == label) {
            return Ok(number);
        }
        let next = self.labels.len();
        let number = *self.numbers.entry(label).or_insert(next as u32);
        if number as usize == next {
            if next >= MAX_ORDER {
                let (path, n, limit) = (source.file.clone(), next as u64 + 1, MAX_ORDER as u64);
                return Err(Error::MatrixSize { path, matrix: "the matrix".to_owned(), n_rows: n, n_cols: n, limit });
            }
            self.labels.push(label);
        }
        self.last = Some((label, number));
        Ok(number)
    }

    /// The matrix, its rows in the order of nodes and directions.
    ///
    /// # Errors
    /// Those of assembling it.
    pub(super) fn into_matrix(
        self,
        source: &MatrixSource<'_>,
        declared: Declared,
        (digest, last_line): (String, LastLine),
    ) -> Result<ReadMatrix> {
        let Self { labels, entries, .. } = self;
        let mut order: Vec<u32> = (0..labels.len() as u32).collect();
        let label = |number: &u32| labels[*number as usize];
        match source.role {
            MatrixRole::Reduced => order.sort_by_key(|number| {
                let label = label(number);
                label.place_in_superelement(label.node.unsigned_abs() as usize)
            }),
            _ => order.sort_unstable_by_key(label),
        }
        let mut rank = vec![0; labels.len()];
        order.iter().zip(0..).for_each(|(number, row)| rank[*number as usize] = row);
        let entries = entries.renumbered(&rank);
        let input = entries.into_matrix(source, (labels.len() as u32, declared), digest)?;
        let labels = order.iter().map(|number| labels[*number as usize]).collect();
        Ok(ReadMatrix { input, order: OrderSource::Labels, last_line, labels: Some(labels), frames: Ok(None) })
    }
}
