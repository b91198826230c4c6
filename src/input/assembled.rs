//! Entries that a format found become a matrix: digits, notes, both triangles.

use super::allowance::Claim;
use super::digits::{Digits, most_alike};
use super::format::MatrixSource;
use super::gathering::{Gathered, Gathering};
use super::written::{MAX_DECIMAL_DIGITS, Written};
use super::{MatrixInput, MatrixRole};
use crate::error::{Error, Result};
use crate::sparse::{Completed, Declared, ENTRY_BYTES, Given, ROW_BYTES, TRIPLET_BYTES, Triplets, completed};

/// Order up to which a matrix may be empty; its row pointers take 8 MiB.
const FREE_ORDER: u64 = 1 << 20;
/// Rows for each entry that a larger matrix may have, so that the row pointers stay within a multiple of the file.
const MAX_ROWS_PER_ENTRY: u64 = 100;
/// Entries of a block that a collector makes.
const BLOCK: usize = 1 << 16;

/// All entries of a matrix.
pub(super) struct Found {
    /// Rows and columns.
    pub(super) n: u32,
    /// What the entries stand for.
    pub(super) declared: Declared,
    pub(super) entries: Gathered,
    /// What a fixed format wrote of every number.
    pub(super) written: Option<Written>,
    /// BLAKE3 of the file.
    pub(super) digest: String,
}

/// The matrix of entries. With a triangle asked for, pairs that a matrix declared symmetric gives twice are let pass.
///
/// # Errors
/// [`Error::MatrixMostlyEmpty`]; [`Error::MemoryRead`]; [`Error::DoubleTriangle`].
pub(super) fn assembled(found: Found, source: &MatrixSource<'_>, claim: &Claim<'_>) -> Result<MatrixInput> {
    let (path, n, declared) = (source.file.as_path(), found.n, found.declared);
    let Gathered { triplets, n_merged, most_merged, digits } = found.entries;
    check_emptiness(source, n, triplets.len())?;
    let assembled = if source.triangle.is_some() { Declared::OneHolds } else { declared };
    let digits = source.stated_digits.map_or_else(|| digits.with(found.written), Digits::stated);
    // Needed for sums of numbers of few digits alone.
    let most_alike = (digits.significant <= MAX_DECIMAL_DIGITS && n_merged == 0).then(|| most_alike(&triplets));
    let (matrix, mut notes) = triplets.assemble(n as usize, assembled, path)?;
    if declared != Declared::General && !matches!(notes.given, Given::EitherOrder { .. }) {
        notes.given = Given::Whole;
    }
    notes.n_duplicates += n_merged;
    notes.most_repeated += most_merged;
    claim.set(ENTRY_BYTES * matrix.nnz() as u64 + ROW_BYTES * u64::from(n))?;
    notes.most_alike = most_alike.filter(|_| notes.most_repeated > 0);
    Ok(MatrixInput { matrix, notes, digits, path: path.to_owned(), layout: None, digest: found.digest })
}

/// Refuses to make row pointers of a size that only an index or a header promises.
fn check_emptiness(source: &MatrixSource<'_>, n: u32, n_entries: usize) -> Result<()> {
    let (n, entries) = (u64::from(n), n_entries as u64);
    if n > FREE_ORDER && n / MAX_ROWS_PER_ENTRY > entries {
        return Err(Error::MatrixMostlyEmpty { path: source.file.clone(), n, entries });
    }
    Ok(())
}

/// Bytes that an entry takes while it is read and assembled: in both triangles where one stands for both.
pub(super) fn bytes_of_entry(declared: Declared) -> u64 {
    let is_mirrored = matches!(declared, Declared::Symmetric | Declared::Skew);
    TRIPLET_BYTES + if is_mirrored { 2 * ENTRY_BYTES } else { ENTRY_BYTES }
}

/// Completes a matrix that its file declares symmetric and of which it may give each pair of a row and a column once or twice.
///
/// # Errors
/// [`Error::DoubleTriangle`] where a pair has two values.
pub(super) fn complete(input: &mut MatrixInput) -> Result<()> {
    let Completed { matrix, n_once, conflict } = completed(&input.matrix);
    if let Some((row, col)) = conflict {
        let (row, col) = (row.max(col) as u64 + 1, row.min(col) as u64 + 1);
        let remedy = "give one value of both, or declare the matrix general";
        let path = input.path.clone();
        return Err(Error::DoubleTriangle {
            path,
            declared: "symmetric",
            remedy,
            lower: (row, col),
            upper: (col, row),
        });
    }
    if n_once > 0 {
        input.matrix = matrix;
    }
    Ok(())
}

/// Entries that come one by one.
pub(super) struct Collector<'a> {
    gathering: Gathering,
    block: Triplets,
    claim: Claim<'a>,
    bytes_of_entry: u64,
}

impl<'a> Collector<'a> {
    /// None yet.
    pub(super) fn new(source: &MatrixSource<'a>, declared: Declared) -> Self {
        let claim = source.allowance.claim(&source.file);
        let bytes_of_entry = bytes_of_entry(declared);
        Self { gathering: Gathering::new(), block: Triplets::default(), claim, bytes_of_entry }
    }

    /// Takes the next entry: row, column, value, zero-based.
    ///
    /// # Errors
    /// [`Error::MemoryRead`].
    pub(super) fn push(&mut self, row: u32, col: u32, value: f64) -> Result<()> {
        self.block.push(row, col, value);
        if self.block.len() < BLOCK { Ok(()) } else { self.close_block() }
    }

    /// Entries so far.
    pub(super) fn n_entries(&self) -> u64 {
        self.gathering.n_entries() + self.block.len() as u64
    }

    /// The entries with their rows and columns numbered anew.
    pub(super) fn renumbered(mut self, number: &[u32]) -> Self {
        self.gathering.renumber(number);
        for index in self.block.rows.iter_mut().chain(&mut self.block.cols) {
            *index = number[*index as usize];
        }
        self
    }

    /// Takes many entries at once.
    ///
    /// # Errors
    /// [`Error::MemoryRead`].
    pub(super) fn append(&mut self, entries: Triplets) -> Result<()> {
        self.gathering.append(entries);
        self.claim.set(self.bytes_of_entry * self.gathering.n_held() as u64)
    }

    fn close_block(&mut self) -> Result<()> {
        let room = if self.gathering.n_entries() > 0 { BLOCK } else { 0 };
        self.gathering.append(std::mem::replace(&mut self.block, Triplets::with_capacity(room)));
        self.claim.set(self.bytes_of_entry * self.gathering.n_held() as u64)
    }

    /// The matrix of all entries.
    ///
    /// # Errors
    /// Those of [`assembled`].
    pub(super) fn into_matrix(
        mut self,
        source: &MatrixSource<'_>,
        (n, declared): (u32, Declared),
        digest: String,
    ) -> Result<MatrixInput> {
        self.close_block()?;
        let Self { gathering, claim, .. } = self;
        let found = Found { n, declared, entries: gathering.all(), written: None, digest };
        assembled(found, source, &claim)
    }
}

impl MatrixRole {
    /// Whether it may be any matrix, whatever its name says.
    pub(super) fn takes_any(self) -> bool {
        matches!(self, Self::Further | Self::Conversion | Self::Reduced)
    }

    /// What entries of it stand for where the format does not say that one triangle stands for both.
    pub(super) fn undeclared(self) -> Declared {
        match self {
            Self::Further | Self::Conversion => Declared::Whole,
            Self::Stiffness | Self::Mass | Self::Reduced => Declared::General,
        }
    }
}
