//! One array of NumPy, in a file of its own or in an archive: numbers, text, or a dense matrix.

use std::io::Read;
use std::path::Path;

use super::assembled::Collector;
use super::compressed::order;
use super::format::MatrixSource;
use super::indices::Indices;
use super::mode_format::{ModeSource, ReadModes};
use super::mode_matrix::{NUMBER, Order, columns_of, refuse_not_finite};
use super::npy_header::{Failure as NoHeader, Header};
use super::raw_numbers::{self, Endian, Failure, Kind, fill};
use super::source::read_error;
use crate::error::{Error, Result};
use crate::number::counted;
use crate::sparse::Declared;

/// The longest text that is read: the name of a format of SciPy.
const MAX_TEXT: u64 = 64;

/// How NumPy calls the types of numbers that are read, without the mark of the order of bytes.
const KINDS: [(&str, Kind); 11] = [
    ("f8", Kind::F64),
    ("f4", Kind::F32),
    ("f2", Kind::F16),
    ("i1", Kind::I8),
    ("i2", Kind::I16),
    ("i4", Kind::I32),
    ("i8", Kind::I64),
    ("u1", Kind::U8),
    ("u2", Kind::U16),
    ("u4", Kind::U32),
    ("u8", Kind::U64),
];

/// How the numbers of an array of this type are stored; none of other types.
pub(super) fn stored_as(descr: &str) -> Option<(Kind, Endian)> {
    let (mark, kind) = descr.split_at_checked(1)?;
    let (_, kind) = KINDS.into_iter().find(|(name, _)| *name == kind)?;
    let endian = if mark == ">" { Endian::Big } else { Endian::Little };
    matches!(mark, "<" | ">" | "|" | "=").then_some((kind, endian))
}

/// Values of an array of this shape that lie with the first index running fastest, the last one running fastest.
fn by_rows(values: &[f64], shape: &[u64]) -> Vec<f64> {
    let of_first = shape.iter().scan(1, |stride, size| Some(std::mem::replace(stride, *stride * size)));
    let strides: Vec<u64> = of_first.collect();
    let place = |at: u64| {
        let (mut rest, mut place) = (at, 0);
        for (size, stride) in shape.iter().zip(&strides).rev() {
            place += rest % size * stride;
            rest /= size;
        }
        place as usize
    };
    (0..values.len() as u64).map(|at| values[place(at)]).collect()
}

/// Whether an archive says of its content that it is not the one that was put in.
fn is_of_archive(error: &std::io::Error) -> bool {
    error.get_ref().is_some_and(|inner| inner.is::<rawzip::Error>())
}

/// What the numbers of an array are read as.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Numbers {
    Whole,
    Real,
}

impl Numbers {
    fn in_words(self) -> &'static str {
        match self {
            Self::Whole => "whole numbers",
            Self::Real => "real numbers of float64, float32 or float16, or whole ones",
        }
    }
}

/// An array whose header has been read.
pub(super) struct Array<'a, R> {
    path: &'a Path,
    format: &'static str,
    /// What messages call it.
    name: &'a str,
    pub(super) header: Header,
    numbers: R,
}

/// Real numbers and the decimal digits that their type has room for.
pub(super) struct Reals {
    pub(super) values: Vec<f64>,
    pub(super) digits: u32,
}

impl<'a, R: Read> Array<'a, R> {
    /// Reads the header.
    pub(super) fn open(path: &'a Path, format: &'static str, name: &'a str, mut numbers: R) -> Result<Self> {
        let wrong = |found| {
            let (path, place) = (path.to_owned(), format!("the header of {name}, byte 0"));
            Error::MatrixFormat { path, format, place, found, expected: "a header of numpy.save".into() }
        };
        let header = Header::read(&mut numbers).map_err(|failure| match failure {
            NoHeader::Found(found) => wrong(found),
            NoHeader::Read(error) if is_of_archive(&error) => wrong(error.to_string()),
            NoHeader::Read(error) => read_error(path, error),
        })?;
        Ok(Self { path, format, name, header, numbers })
    }

    /// All values as real numbers, the last index of the array running fastest whatever the order in the file.
    pub(super) fn reals(self) -> Result<Reals> {
        let (shape, order) = (self.header.shape.clone(), self.header.order);
        let Reals { values, digits } = self.reals_as_stored()?;
        let values = if order == Order::ByColumns && shape.len() > 1 { by_rows(&values, &shape) } else { values };
        Ok(Reals { values, digits })
    }

    fn reals_as_stored(mut self) -> Result<Reals> {
        let (stored, n) = (self.stored(Numbers::Real)?, self.n_numbers()?);
        let values = raw_numbers::reals(&mut self.numbers, stored, n);
        let values = values.map_err(|failure| self.error(failure))?;
        self.end()?;
        Ok(Reals { values, digits: stored.0.digits() })
    }

    /// All values as whole numbers.
    pub(super) fn wholes(mut self) -> Result<Vec<i64>> {
        let (stored, n) = (self.stored(Numbers::Whole)?, self.n_numbers()?);
        let values = raw_numbers::wholes(&mut self.numbers, stored, n);
        let values = values.map_err(|failure| self.error(failure))?;
        self.end()?;
        Ok(values)
    }

    /// All values as indices, in the order of the file.
    pub(super) fn indices(mut self) -> Result<Indices> {
        let (stored, n) = (self.stored(Numbers::Whole)?, self.n_numbers()?);
        let indices = raw_numbers::indices(&mut self.numbers, stored, n);
        let indices = indices.map_err(|failure| self.error(failure))?;
        self.end()?;
        Ok(indices)
    }

    /// A short text.
    pub(super) fn text(mut self) -> Result<String> {
        let descr = self.header.descr.clone();
        let (width, n) = match (descr.strip_prefix("|S"), descr.strip_prefix("<U")) {
            (Some(n), _) => (1, n.parse().ok()),
            (_, Some(n)) => (4, n.parse::<u64>().ok()),
            _ => (1, None),
        };
        let is_one = self.header.n_numbers() == Some(1);
        let Some(n) = n.filter(|n| *n <= MAX_TEXT && is_one) else { return Err(self.unread("a short text")) };
        let mut bytes = vec![0; (width * n) as usize];
        let n_read = fill(&mut self.numbers, &mut bytes).map_err(|error| self.error(Failure::Read(error)))?;
        if n_read < bytes.len() {
            return Err(self.error(Failure::Cut(n_read as u64 / width)));
        }
        self.end()?;
        Ok(bytes.iter().filter(|byte| **byte != 0).map(|byte| char::from(*byte)).collect())
    }

    /// The entries of a square matrix that are not zero, and its order.
    pub(super) fn dense(mut self, source: &MatrixSource<'a>, declared: Declared) -> Result<(Collector<'a>, u32, u32)> {
        let stored = self.stored(Numbers::Real)?;
        let (rows, columns) = match self.header.shape[..] {
            [rows, columns] => (rows, columns),
            _ => return Err(self.unread("a square array of two dimensions")),
        };
        let n = order(self.path, self.name, [rows, columns])?;
        let by_rows = self.header.order == Order::ByRows;
        let mut entries = Collector::new(source, declared);
        let (path, name) = (self.path, self.name);
        let read = raw_numbers::each_real(&mut self.numbers, stored, rows * columns, |position, value| {
            let (slow, fast) = ((position / u64::from(n)) as u32, (position % u64::from(n)) as u32);
            let (row, col) = if by_rows { (slow, fast) } else { (fast, slow) };
            if !value.is_finite() {
                let (row, col) = (u64::from(row) + 1, u64::from(col) + 1);
                let (path, matrix) = (path.to_owned(), name.to_owned());
                return Err(Failure::Refused(Box::new(Error::MatrixNotFinite { path, matrix, row, col, value })));
            }
            if value == 0.0 {
                Ok(())
            } else {
                entries.push(row, col, value).map_err(|error| Failure::Refused(Box::new(error)))
            }
        });
        read.map_err(|failure| self.error(failure))?;
        self.end()?;
        Ok((entries, n, stored.0.digits()))
    }

    /// Modes in its columns; in an array of one dimension, the only one.
    pub(super) fn modes(self, source: &ModeSource<'_>) -> Result<ReadModes> {
        let (path, n_rows) = (self.path, source.rows.n);
        let (rows, n_columns) = match self.header.shape[..] {
            [rows] => (rows, 1),
            [rows, columns] => (rows, columns),
            _ => return Err(self.unread("an array of rows and modes")),
        };
        if rows != n_rows as u64 {
            return Err(Error::ModesRows { path: path.to_owned(), found: rows, n: n_rows });
        }
        let n_columns = source.meaning.checked_count(path, n_columns, n_rows)?;
        // The numbers as they are read and in columns.
        source.allowance.claim(path).add(2 * NUMBER * rows * n_columns as u64)?;
        let order = self.header.order;
        let columns = columns_of(&self.reals_as_stored()?.values, [n_rows, n_columns], order);
        refuse_not_finite(path, &columns)?;
        Ok(ReadModes::of_columns(columns))
    }

    fn n_numbers(&self) -> Result<u64> {
        self.header.n_numbers().ok_or_else(|| self.unread("a shape of fewer numbers than 2^64"))
    }

    /// How the numbers are stored.
    fn stored(&self, wanted: Numbers) -> Result<(Kind, Endian)> {
        let stored = stored_as(&self.header.descr).filter(|(kind, _)| kind.is_whole() || wanted == Numbers::Real);
        stored.ok_or_else(|| self.unread(wanted.in_words()))
    }

    /// Makes sure that nothing follows the numbers; an archive compares its checksum here.
    fn end(&mut self) -> Result<()> {
        match fill(&mut self.numbers, &mut [0]) {
            Ok(0) => Ok(()),
            Ok(_) => {
                let n = self.header.n_numbers().unwrap_or(u64::MAX);
                Err(self.wrong(n, "bytes behind the last number".to_owned()))
            }
            Err(error) => Err(self.error(Failure::Read(error))),
        }
    }

    fn error(&self, failure: Failure) -> Error {
        match failure {
            Failure::Refused(error) => *error,
            Failure::Cut(n) => self.wrong(n, format!("the end after {}", counted(n, "number", "numbers"))),
            Failure::Value(position) => {
                let found = format!("number {} that cannot be kept as it is", position + 1);
                let expected = "whole numbers that a double equals, and indices that are whole".to_owned();
                self.not_as(position, found, expected)
            }
            Failure::Read(error) if is_of_archive(&error) => self.wrong(0, error.to_string()),
            Failure::Read(error) => read_error(self.path, error),
        }
    }

    fn wrong(&self, number: u64, found: String) -> Error {
        self.not_as(number, found, format!("as many numbers as its shape {:?} says", self.header.shape))
    }

    /// The error at a number of the array, counted from zero.
    fn not_as(&self, number: u64, found: String, expected: String) -> Error {
        let size = stored_as(&self.header.descr).map_or(1, |(kind, _)| kind.size() as u64);
        let byte = self.header.length.saturating_add(number.saturating_mul(size));
        Error::MatrixFormat {
            path: self.path.to_owned(),
            format: self.format,
            place: format!("{}, byte {byte}", self.name),
            found,
            expected: expected.into(),
        }
    }

    fn unread(&self, expected: &'static str) -> Error {
        let Header { descr, shape, .. } = &self.header;
        let found = match descr.as_str() {
            "|O" => "Python objects (a sparse matrix is saved by scipy.sparse.save_npz)".to_owned(),
            _ => format!("an array of type {descr} and shape {shape:?}"),
        };
        Error::MatrixUnread {
            path: self.path.to_owned(),
            format: self.format,
            place: self.name.to_owned(),
            found,
            expected,
        }
    }
}
