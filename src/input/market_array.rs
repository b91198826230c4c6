//! Square matrices in Matrix Market `array` form: every value, column by column; of a symmetric matrix those from the diagonal down, of a
//! skew one those below it.

use super::assembled::Collector;
use super::banner::{excerpt, is_comment, square_order};
use super::file_start::FileStart;
use super::format::{MatrixSource, ReadMatrix};
use super::fortran::{Values, whole};
use super::lines::Lines;
use crate::error::{Error, Result};
use crate::sparse::Declared;

/// Whether a file begins with the banner of an array.
pub(super) fn begins(start: &FileStart<'_>) -> bool {
    let line = start.head.split(|byte| *byte == b'\n').next().unwrap_or_default();
    String::from_utf8_lossy(line).split_ascii_whitespace().nth(2).is_some_and(|word| word.eq_ignore_ascii_case("array"))
}

/// Reads the matrix.
///
/// # Errors
/// [`Error::MatrixFlavour`] for another banner; [`Error::MatrixSizeLine`], [`Error::EntryField`] and the like for lines that are none;
/// [`Error::EntryCount`] and [`Error::EntriesSurplus`] for another number of values.
pub(super) fn read(source: &MatrixSource<'_>) -> Result<ReadMatrix> {
    let mut lines = Lines::open(&source.file)?;
    lines.advance()?;
    let (declared, values) = declared(&lines, source)?;
    advance(&mut lines)?;
    let sizes: Vec<Option<i64>> = fields(lines.line()).map(whole).collect();
    let &[Some(rows), Some(columns)] = sizes.as_slice() else {
        let (path, line, found) = (lines.path(), lines.number(), excerpt(lines.line().trim_ascii()));
        return Err(Error::MatrixSizeLine { path, line, found });
    };
    let count = |size: i64| u64::try_from(size).unwrap_or(u64::MAX);
    let n = square_order(&source.file, lines.number(), count(rows), count(columns))?;
    let mut entries = Collector::new(source, declared);
    let mut places = places(n, declared);
    let mut n_read = 0u64;
    while advance(&mut lines)? {
        for field in fields(lines.line()) {
            let (path, line) = (lines.path(), lines.number());
            let Some((row, col)) = places.next() else {
                return Err(Error::EntriesSurplus { path, line, declared: n_read });
            };
            let found = || excerpt(field);
            match values.of_field(field) {
                Some(value) if value.is_finite() => {
                    n_read += 1;
                    if value != 0.0 {
                        entries.push(row, col, value)?;
                    }
                }
                Some(_) => {
                    let (row, col) = (u64::from(row) + 1, u64::from(col) + 1);
                    return Err(Error::NonFinite { path, line, row, col, found: found() });
                }
                None => {
                    let expected = values.expected();
                    return Err(Error::EntryField { path, line, field: "value", found: found(), expected });
                }
            }
        }
    }
    if places.next().is_some() {
        let own = u64::from(n);
        let declared = match declared {
            Declared::Symmetric => own * (own + 1) / 2,
            Declared::Skew => own * (own - 1) / 2,
            Declared::General | Declared::OneHolds | Declared::Whole => own * own,
        };
        let (path, line) = (source.file.clone(), lines.number().saturating_sub(1));
        return Err(Error::EntryCount { path, line, declared, found: n_read });
    }
    entries.into_matrix(source, (n, declared), lines.digest()?).map(ReadMatrix::with_size)
}

/// What the banner says.
fn declared(lines: &Lines<'_>, source: &MatrixSource<'_>) -> Result<(Declared, Values)> {
    let text = String::from_utf8_lossy(lines.line()).to_ascii_lowercase();
    let words: Vec<&str> = text.split_ascii_whitespace().skip(3).collect();
    let flavour = |found: &str| {
        let found = excerpt(found.as_bytes());
        Err(Error::MatrixFlavour { path: lines.path(), line: lines.number(), found })
    };
    let [field, symmetry] = words[..] else { return flavour(&text) };
    let Some(values) = Values::of_banner(field) else { return flavour(field) };
    match symmetry {
        "symmetric" => Ok((Declared::Symmetric, values)),
        "skew-symmetric" if source.role.takes_any() => Ok((Declared::Skew, values)),
        "general" => Ok((source.role.undeclared(), values)),
        _ => flavour(symmetry),
    }
}

/// Row and column of each value.
fn places(n: u32, declared: Declared) -> impl Iterator<Item = (u32, u32)> {
    let first = move |col: u32| match declared {
        Declared::Symmetric => col,
        Declared::Skew => col + 1,
        Declared::General | Declared::OneHolds | Declared::Whole => 0,
    };
    (0..n).flat_map(move |col| (first(col)..n).map(move |row| (row, col)))
}

/// Goes to the next line with data; false at the end of the file.
fn advance(lines: &mut Lines<'_>) -> Result<bool> {
    while lines.advance()? {
        let text = lines.line().trim_ascii();
        if !text.is_empty() && !is_comment(text) {
            return Ok(true);
        }
    }
    Ok(false)
}

fn fields(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|field| !field.is_empty())
}
