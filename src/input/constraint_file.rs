//! Multipoint constraints: the rows of a matrix G with G u = 0, in Matrix Market form.
//!
//! ```text
//! G    m × n    a row for each constraint, a column for each row of the matrices: `coordinate` or `array`
//! ```

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::allowance::Allowance;
use super::rectangular::{Content, RectangularFile};
use crate::dofs::RowNames;
use crate::error::Result;
use crate::regular_file::unchanged;

/// Bytes of an entry with what finds its row.
const ENTRY: u64 = 32;
/// Entries after which their memory is claimed.
const PER_CLAIM: usize = 1 << 8;

/// Constraints as they were read.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintRows {
    /// The constraints that have terms, in the order of the file.
    pub list: Vec<Constraint>,
    /// Rows of G, those without terms among them.
    pub n_rows: u64,
    /// Whether the job accepts that they hold the component to the ground.
    pub may_ground: bool,
    /// The file.
    pub path: PathBuf,
    /// BLAKE3 digest of the file's bytes, lower-case hexadecimal.
    pub digest: String,
}

/// One constraint: Σ g u = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint {
    /// Its row in the file, from zero.
    pub row: usize,
    /// Rows of the matrices, ascending, each once, with their coefficients other than zero.
    pub terms: Vec<(u32, f64)>,
}

impl Constraint {
    /// Its dofs by name.
    pub fn dofs(&self, names: RowNames<'_>) -> Vec<String> {
        self.terms.iter().map(|(row, _)| names.short(*row as usize)).collect()
    }
}

impl ConstraintRows {
    /// Rows of the matrices that take part in a constraint, each once, ascending.
    pub fn tied(&self) -> Vec<u32> {
        let mut tied: Vec<u32> = self.list.iter().flat_map(|row| row.terms.iter().map(|(row, _)| *row)).collect();
        tied.sort_unstable();
        tied.dedup();
        tied
    }

    /// These constraints on rows that have other numbers now.
    #[must_use]
    pub fn renumbered(mut self, number: impl Fn(u32) -> u32) -> Self {
        let terms = self.list.iter_mut().flat_map(|row| &mut row.terms);
        terms.for_each(|(row, _)| *row = number(*row));
        self
    }
}

/// Reads the constraints of a model whose matrices have `n_rows` rows in their files.
///
/// # Errors
/// A file that cannot be read or is no Matrix Market file; [`crate::error::Error::ConstraintSize`] where it has another number of
/// columns; [`crate::error::Error::MemoryRead`]; [`crate::error::Error::Changed`].
pub(super) fn constraint_rows(path: &Path, n_rows: usize, allowance: &Allowance) -> Result<ConstraintRows> {
    unchanged(path, || read(path, n_rows, allowance))
}

fn read(path: &Path, n: usize, allowance: &Allowance) -> Result<ConstraintRows> {
    let file = RectangularFile::open(path, Content::Constraints { n_rows: n })?;
    let (claim, n_rows) = (allowance.claim(path), file.n_rows);
    let mut rows: BTreeMap<usize, Vec<(u32, f64)>> = BTreeMap::new();
    let mut n_entries = 0usize;
    let digest = file.read(|entry| {
        if entry.value != 0.0 {
            if n_entries.is_multiple_of(PER_CLAIM) {
                claim.add(ENTRY * PER_CLAIM as u64)?;
            }
            n_entries += 1;
            rows.entry(entry.row).or_default().push((entry.column as u32, entry.value));
        }
        Ok(())
    })?;
    let list = rows.into_iter().map(|(row, terms)| Constraint { row, terms: added_up(terms) });
    let list = list.filter(|constraint| !constraint.terms.is_empty()).collect();
    Ok(ConstraintRows { list, n_rows, may_ground: false, path: path.to_owned(), digest })
}

/// Terms by their rows, those of one row added up in the order of the file.
fn added_up(mut terms: Vec<(u32, f64)>) -> Vec<(u32, f64)> {
    terms.sort_by_key(|(row, _)| *row);
    let of_row = terms.chunk_by(|a, b| a.0 == b.0);
    let sums = of_row.map(|terms| (terms[0].0, terms.iter().map(|(_, value)| value).sum::<f64>()));
    sums.filter(|(_, value)| *value != 0.0).collect()
}
