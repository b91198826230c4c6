//! OUTPUT4 of Nastran with sparse columns: strings of consecutive rows, each with one word for its length and its row, or with one for
//! each in a matrix of more rows than fit half a word. Seventeen digits in text bring a double back.

use std::fmt::Write as _;
use std::io::{Result, Write};

use super::by_columns::ByColumns;
use super::content::Shape;

/// Rows that the fields of the text have digits for.
pub(super) const MAX_ROWS_IN_TEXT: usize = 9_999_998;
/// Rows up to which a string has one word for its length and its row.
const MAX_PACKED_ROWS: usize = 65_535;
/// Values of a string whose length fits half a word with those rows.
const LONGEST: usize = 16_000;
/// Words of a double.
const WORDS: usize = 2;
/// Forms of a matrix: square, symmetric.
const SQUARE: usize = 1;
const SYMMETRIC: usize = 6;
/// Type of real numbers in double precision.
const REAL_DOUBLE: usize = 2;
/// Values in a line of text.
const PER_LINE: usize = 3;
/// Letters of a name.
pub(crate) const LETTERS_OF_AN_OP4_NAME: usize = 8;

/// What stands in the head of a matrix and in those of its strings.
struct Layout {
    n: usize,
    form: usize,
    is_big: bool,
    name: String,
}

impl Layout {
    fn of(name: &str, matrix: &ByColumns<'_>) -> Self {
        let n = matrix.order();
        let form = if matrix.shape == Shape::Symmetric { SYMMETRIC } else { SQUARE };
        let name = name.to_ascii_uppercase().chars().take(LETTERS_OF_AN_OP4_NAME).collect();
        Self { n, form, is_big: n > MAX_PACKED_ROWS, name }
    }

    /// Words of the head of a string.
    fn words_of_head(&self) -> usize {
        if self.is_big { 2 } else { 1 }
    }

    /// The words before the values of a string.
    fn head(&self, row: usize, n_values: usize) -> Vec<usize> {
        let length = WORDS * n_values + 1;
        if self.is_big { vec![length, row + 1] } else { vec![(length << 16) + row + 1] }
    }

    /// Words of a column.
    fn words(&self, strings: &[(usize, &[f64])]) -> usize {
        strings.iter().map(|(_, values)| self.words_of_head() + WORDS * values.len()).sum()
    }

    /// Rows as the head has them: negative for a big matrix.
    fn rows(&self) -> i64 {
        if self.is_big { -(self.n as i64) } else { self.n as i64 }
    }
}

pub(super) fn write_text(name: &str, matrix: &ByColumns<'_>, out: &mut impl Write) -> Result<()> {
    let layout = Layout::of(name, matrix);
    let Layout { n, form, name, .. } = &layout;
    writeln!(out, "{n:8}{:8}{form:8}{REAL_DOUBLE:8}{name:8}1P,{PER_LINE}E24.16", layout.rows())?;
    for column in 0..*n {
        let strings = matrix.strings(column, LONGEST);
        if strings.is_empty() {
            continue;
        }
        writeln!(out, "{:8}{:8}{:8}", column + 1, 0, layout.words(&strings))?;
        for (row, values) in strings {
            match layout.head(row, values.len())[..] {
                [packed] => writeln!(out, "{packed:11}")?,
                _ => writeln!(out, "{:8}{:8}", WORDS * values.len() + 1, row + 1)?,
            }
            numbers(values, out)?;
        }
    }
    writeln!(out, "{:8}{:8}{:8}", n + 1, 1, 1)?;
    numbers(&[1.0], out)
}

fn numbers(values: &[f64], out: &mut impl Write) -> Result<()> {
    let mut line = String::new();
    for part in values.chunks(PER_LINE) {
        line.clear();
        part.iter().for_each(|value| put(&mut line, *value));
        writeln!(out, "{line}")?;
    }
    Ok(())
}

/// A number as Fortran writes it, in a field of 24: a sign and two digits at least in the exponent.
fn put(line: &mut String, value: f64) {
    let text = format!("{value:.16e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, exponent) = exponent.strip_prefix('-').map_or(('+', exponent), |exponent| ('-', exponent));
    let _ = write!(line, "{:>24}", format!("{digits}E{sign}{exponent:0>2}"));
}

pub(super) fn write_binary(name: &str, matrix: &ByColumns<'_>, out: &mut impl Write) -> Result<()> {
    let layout = Layout::of(name, matrix);
    let Layout { n, form, name, .. } = &layout;
    let mut head = words(&[*n, 0, *form, REAL_DOUBLE]);
    head[4..8].copy_from_slice(&(layout.rows() as i32).to_le_bytes());
    head.extend(format!("{name:LETTERS_OF_AN_OP4_NAME$}").into_bytes());
    record(out, &head)?;
    for column in 0..*n {
        let strings = matrix.strings(column, LONGEST);
        if strings.is_empty() {
            continue;
        }
        let mut content = words(&[column + 1, 0, layout.words(&strings)]);
        for (row, values) in strings {
            content.extend(words(&layout.head(row, values.len())));
            content.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        }
        record(out, &content)?;
    }
    let mut last = words(&[n + 1, 1, WORDS]);
    last.extend(1f64.to_le_bytes());
    record(out, &last)
}

/// Content between its lengths.
fn record(out: &mut impl Write, content: &[u8]) -> Result<()> {
    let length = words(&[content.len()]);
    out.write_all(&length)?;
    out.write_all(content)?;
    out.write_all(&length)
}

/// Whole numbers as words; those of a matrix of fewer than 2³¹ rows fit.
fn words(numbers: &[usize]) -> Vec<u8> {
    numbers.iter().flat_map(|number| (*number as u32).to_le_bytes()).collect()
}
