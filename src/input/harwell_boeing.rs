//! Harwell-Boeing and Rutherford-Boeing: compressed columns in fields of fixed width, what HBMAT of Ansys writes.
//!
//! ```text
//! title, key                                        72 and 8 characters
//! lines of everything, pointers, indices, values    four numbers, five where there may be right-hand sides
//! type, rows, columns, entries, elements            RSA: real, symmetric (lower triangle), assembled
//! formats of pointers, indices, values              (16I5)          (16I5)          (4E20.12)
//! a line more where there are right-hand sides
//! pointers, indices, values
//! ```

use std::path::Path;

use super::banner::excerpt;
use super::compressed::{Compressed, Major};
use super::file_start::FileStart;
use super::format::{Format, MatrixFormat, MatrixSource, ReadMatrix, Sureness};
use super::fortran::{Fields, Values, whole};
use super::indices::Indices;
use super::lines::Lines;
use super::raw_numbers::room;
use crate::error::{Error, Result};
use crate::job::Layout;
use crate::sparse::Declared;

const FORMAT: &str = "Harwell-Boeing";
const EXPECTED: &str = "a real assembled square matrix with values: RSA, RUA, or RZA for a further matrix";

/// Harwell-Boeing and Rutherford-Boeing.
pub(super) struct HarwellBoeing;

impl Format for HarwellBoeing {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        let mut lines = start.head.split(|byte| *byte == b'\n').skip(2);
        let kind = lines.next().and_then(Kind::of);
        let line = lines.next().unwrap_or_default();
        // A pattern has no format of values, and is refused for what it is.
        let has_formats = match kind {
            Some(Kind { letters: [b'P', ..], .. }) => {
                bracketed(line).first().is_some_and(|word| Fields::of(word).is_some())
            }
            _ => formats(line).is_some(),
        };
        if kind.is_some() && has_formats { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl MatrixFormat for HarwellBoeing {
    fn layout(&self) -> Layout {
        Layout::HarwellBoeing
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        let path = source.file.as_path();
        let mut lines = Lines::open(path)?;
        lines.advance()?;
        lines.advance()?;
        let has_right_hand_sides = numbers(lines.line()).get(4).is_some_and(|n_lines| *n_lines > 0);
        lines.advance()?;
        let kind = Kind::of(lines.line());
        let kind = kind.ok_or_else(|| wrong(&lines, "the type of the matrix, its rows, columns and entries"))?;
        let declared = kind.declared(path, source)?;
        lines.advance()?;
        let [of_pointers, of_indices, of_values] = formats(lines.line())
            .ok_or_else(|| wrong(&lines, "formats as in (16I5)          (16I5)          (4E20.12)"))?;
        if has_right_hand_sides {
            lines.advance()?;
        }
        let n_pointers = kind.n_columns.saturating_add(1);
        let from_zero = |field: &[u8]| Some(whole(field)?.saturating_sub(1));
        let mut pointers = Vec::with_capacity(room(n_pointers));
        let take = |field: &[u8]| {
            pointers.push(from_zero(field)?);
            Some(())
        };
        read(&mut lines, (of_pointers, n_pointers), take, "a pointer")?;
        let mut indices = Indices::with_capacity(room(kind.n_entries));
        let take = |field: &[u8]| {
            indices.push(from_zero(field)?);
            Some(())
        };
        read(&mut lines, (of_indices, kind.n_entries), take, "a row")?;
        let kept = kind.values();
        let mut values = Vec::with_capacity(room(kind.n_entries));
        let take = |field: &[u8]| {
            values.push(kept.of_format(field, of_values)?);
            Some(())
        };
        read(&mut lines, (of_values, kind.n_entries), take, kept.expected())?;
        // What follows may be right-hand sides; a packed file shows at its end whether it is whole.
        lines.digest()?;
        let names = ["pointers (less 1)", "rows (less 1)", "values"].map(str::to_owned);
        let shape = [kind.n_rows, kind.n_columns];
        let compressed = Compressed::new(Major::Columns, shape, pointers, indices, values, names);
        compressed.into_matrix(source, "the matrix", (declared, u32::MAX)).map(ReadMatrix::with_size)
    }
}

fn wrong(lines: &Lines<'_>, expected: &str) -> Error {
    let line = lines.line().trim_ascii();
    Error::MatrixFormat {
        path: lines.path(),
        format: FORMAT,
        place: format!("line {}", lines.number()),
        found: if line.is_empty() { "nothing".to_owned() } else { format!("`{}`", excerpt(line)) },
        expected: expected.into(),
    }
}

/// Type and size of a matrix.
struct Kind {
    /// Three capital letters.
    letters: [u8; 3],
    n_rows: u64,
    n_columns: u64,
    n_entries: u64,
}

impl Kind {
    fn of(line: &[u8]) -> Option<Self> {
        let letters = line.first_chunk::<3>()?.map(|letter| letter.to_ascii_uppercase());
        let [values, symmetry, assembly] = letters;
        let is_known = b"RCPIQ".contains(&values) && b"SUHZR".contains(&symmetry) && b"AE".contains(&assembly);
        let sizes = numbers(&line[3..]);
        let size = |at: usize| sizes.get(at).and_then(|size| u64::try_from(*size).ok());
        let (n_rows, n_columns, n_entries) = (size(0)?, size(1)?, size(2)?);
        is_known.then_some(Self { letters, n_rows, n_columns, n_entries })
    }

    /// What its values are.
    fn values(&self) -> Values {
        if self.letters[0] == b'I' { Values::Whole } else { Values::Real }
    }

    /// What its entries stand for.
    fn declared(&self, path: &Path, source: &MatrixSource<'_>) -> Result<Declared> {
        let unread = |found: &str| {
            let (path, place) = (path.to_owned(), "line 3".to_owned());
            let found = format!("{}, {found}", String::from_utf8_lossy(&self.letters));
            Err(Error::MatrixUnread { path, format: FORMAT, place, found, expected: EXPECTED })
        };
        match self.letters {
            [b'C' | b'Q', ..] => unread("a complex matrix"),
            [b'P', ..] => unread("a pattern without values"),
            [.., b'E'] => unread("a matrix of elements that are not assembled"),
            [_, b'S', _] => Ok(Declared::Symmetric),
            [_, b'Z', _] if source.role.takes_any() => Ok(Declared::Skew),
            [_, b'U' | b'R', _] => Ok(source.role.undeclared()),
            _ => unread("a skew-symmetric or Hermitian matrix"),
        }
    }
}

/// The whole numbers at the start of a line.
fn numbers(line: &[u8]) -> Vec<i64> {
    line.split(u8::is_ascii_whitespace).filter(|field| !field.is_empty()).map_while(whole).collect()
}

/// The fields of pointers, indices and values. Their formats stand in columns, or one behind the other.
fn formats(line: &[u8]) -> Option<[Fields; 3]> {
    let column = |range: std::ops::Range<usize>| line.get(range.start..range.end.min(line.len())).and_then(Fields::of);
    let in_columns = || Some([column(0..16)?, column(16..32)?, column(32..52)?]);
    let mut words = bracketed(line).into_iter().map(Fields::of);
    let mut word = || words.next().flatten();
    let begins = line.trim_ascii_start().starts_with(b"(");
    in_columns().or_else(|| Some([word()?, word()?, word()?])).filter(|_| begins)
}

/// The parts of a line up to each bracket that closes all before it.
fn bracketed(line: &[u8]) -> Vec<&[u8]> {
    let mut depth = 0i32;
    let is_end = |byte: &u8| {
        depth += i32::from(*byte == b'(') - i32::from(*byte == b')');
        *byte == b')' && depth <= 0
    };
    line.split_inclusive(is_end).collect()
}

/// Hands the fields of the next n numbers to `take`, which says whether a field holds one.
fn read(
    lines: &mut Lines<'_>,
    (fields, n): (Fields, u64),
    mut take: impl FnMut(&[u8]) -> Option<()>,
    expected: &str,
) -> Result<()> {
    let mut left = n;
    while left > 0 {
        lines.advance()?;
        let line = lines.line();
        let n_fields = left.min(fields.per_line as u64) as usize;
        // Without an end of the line nothing tells whether its last number is whole.
        if lines.is_open() && line.len() < fields.end(n_fields) {
            return Err(wrong(
                lines,
                &format!("{expected} up to the end of its field, or the end of the line behind it"),
            ));
        }
        let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
        let rest = line.get(fields.end(n_fields)..).unwrap_or_default();
        if words.len() != n_fields && !rest.trim_ascii().is_empty() {
            return Err(wrong(lines, &format!("{expected} in each of {n_fields} fields, and nothing behind them")));
        }
        for at in 0..n_fields {
            // SciPy writes fields narrower than its own format says, with blanks between them.
            let field = if words.len() == n_fields { words[at] } else { fields.field(line, at) };
            take(field).ok_or_else(|| wrong(lines, &format!("{expected} in field {}", at + 1)))?;
        }
        left -= n_fields as u64;
    }
    Ok(())
}
