//! The head of a matrix.

use std::path::Path;

use crate::error::{Error, Result};
use crate::input::compressed::order;

/// What messages call the format.
pub(super) const FORMAT: &str = "OUTPUT4";
/// Rows above which a string has a word for its length and one for its row.
const MAX_PACKED_ROWS: i64 = 65_535;
/// Decimal digits of single precision.
const SINGLE_DIGITS: u32 = 7;

/// The head of a matrix.
pub(super) struct Head {
    pub(super) name: String,
    pub(super) columns: i64,
    /// Negative in the form of big matrices.
    pub(super) rows: i64,
    pub(super) form: i64,
    pub(super) kind: i64,
}

/// What the entries of a matrix stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Square,
    Symmetric,
    /// A column that is the diagonal.
    Diagonal,
}

impl Head {
    /// Whether head and size can be those of a matrix.
    pub(super) fn is_sound(&self) -> bool {
        let name = self.name.bytes().all(|byte| byte.is_ascii_graphic());
        (0..=i64::from(i32::MAX)).contains(&self.columns)
            && self.rows.unsigned_abs() <= i32::MAX as u64
            && (1..=16).contains(&self.form)
            && (1..=4).contains(&self.kind)
            && name
    }

    pub(super) fn n_rows(&self) -> u64 {
        self.rows.unsigned_abs()
    }

    /// Whether a string has a word for its length and one for its row.
    pub(super) fn is_big(&self) -> bool {
        self.rows < 0 || self.rows > MAX_PACKED_ROWS
    }

    /// Whether numbers are in double precision.
    pub(super) fn is_double(&self) -> bool {
        self.kind % 2 == 0
    }

    /// Numbers of an entry: two of a complex one.
    pub(super) fn per_entry(&self) -> u64 {
        if self.kind > 2 { 2 } else { 1 }
    }

    pub(super) fn digits(&self) -> u32 {
        if self.is_double() { u32::MAX } else { SINGLE_DIGITS }
    }

    /// What its entries stand for.
    ///
    /// # Errors
    /// [`Error::MatrixUnread`] for complex matrices and factors.
    pub(super) fn form(&self, path: &Path) -> Result<Form> {
        let unread = |found: &str| {
            let (path, place, found) = (path.to_owned(), self.name.clone(), found.to_owned());
            let expected = "a real matrix of form 1 (square), 6 (symmetric) or 3 (diagonal)";
            Err(Error::MatrixUnread { path, format: FORMAT, place, found, expected })
        };
        match self.form {
            _ if self.kind > 2 => unread("a complex matrix"),
            1 | 2 => Ok(Form::Square),
            6 => Ok(Form::Symmetric),
            3 if self.columns == 1 => Ok(Form::Diagonal),
            3 => Ok(Form::Square),
            form => unread(&format!("a matrix of form {form}")),
        }
    }

    /// The order of the matrix, which must be square.
    pub(super) fn order(&self, path: &Path) -> Result<u32> {
        let columns = if self.form == 3 && self.columns == 1 { self.n_rows() } else { self.columns.unsigned_abs() };
        order(path, &self.name, [self.n_rows(), columns])
    }

    /// The rows of a string, from zero, where it lies within the matrix.
    pub(super) fn rows_of(&self, first: i64, n_entries: u64) -> Option<u32> {
        let first = u64::try_from(first.checked_sub(1)?).ok()?;
        (first.checked_add(n_entries)? <= self.n_rows()).then_some(first as u32)
    }
}
