//! OUTPUT4 as text.
//!
//! ```text
//! columns rows form type NAME    1P,3E24.16     widths 8, or 16 for the first two where the line ends with |I16
//! column  first-row  words                      dense; then the numbers; first-row 0 for a sparse column
//! words + 1  row                                of a string in a big matrix, then its numbers
//! (words + 1) · 65536 + row                     of a string in any other
//! columns + 1  1  words                         after the last column, and a number
//! ```

use std::path::Path;

use super::head::{FORMAT, Head};
use super::matrices::Matrices;
use crate::error::{Error, Result};
use crate::input::banner::excerpt;
use crate::input::fortran::{Fields, real, whole};
use crate::input::lines::Lines;
use crate::number::counted;

/// Fields of a matrix whose head does not say.
const USUAL: Fields = Fields { per_line: 5, width: 16, before: 0, between: 0, decimals: 0, scale: 0 };

/// Whether a file begins as OUTPUT4 in text does.
pub(super) fn begins(head: &[u8]) -> bool {
    let line = head.split(|byte| *byte == b'\n').next().unwrap_or_default();
    let line = line.strip_suffix(b"\r").unwrap_or(line);
    parsed(line).is_some_and(|(head, fields)| head.is_sound() && !head.name.is_empty() && fields.is_some())
}

/// The head in a line, and how numbers fill the lines that follow where it says so.
fn parsed(line: &[u8]) -> Option<(Head, Option<Fields>)> {
    let (line, wide) = match line.trim_ascii_end().strip_suffix(b"|I16") {
        Some(line) => (line, 16),
        None => (line, 8),
    };
    let field = |start: usize, width: usize| line.get(start..(start + width).min(line.len()));
    let number = |start: usize, width: usize| whole(field(start, width)?);
    let after = 2 * wide;
    let name = field(after + 16, 8)?.trim_ascii();
    let head = Head {
        name: String::from_utf8_lossy(name).into_owned(),
        columns: number(0, wide)?,
        rows: number(wide, wide)?,
        form: number(after, 8)?,
        kind: number(after + 8, 8)?,
    };
    Some((head, line.get(after + 24..).and_then(Fields::of)))
}

/// A file that is read line by line.
pub(super) struct File<'a> {
    lines: Lines<'a>,
    fields: Fields,
}

/// The record of a column.
struct Record {
    column: i64,
    first: i64,
    words: i64,
}

impl<'a> File<'a> {
    pub(super) fn open(path: &'a Path) -> Result<Self> {
        Ok(Self { lines: Lines::open(path)?, fields: USUAL })
    }

    fn error(&self, expected: &str) -> Error {
        let line = self.lines.line().trim_ascii();
        Error::MatrixFormat {
            path: self.lines.path(),
            format: FORMAT,
            place: format!("line {}", self.lines.number()),
            found: if line.is_empty() { "nothing".to_owned() } else { format!("`{}`", excerpt(line)) },
            expected: expected.into(),
        }
    }

    /// The head of the next record, of a column of the matrix or the one that ends it.
    fn record(&mut self, head: &Head) -> Result<Option<Record>> {
        const EXPECTED: &str = "a column, its first row and the number of its words";
        self.lines.advance()?;
        let line = self.lines.line();
        let number = |at: usize| whole(line.get(8 * at..(8 * at + 8).min(line.len()))?);
        let Some((column, first, words)) = number(0).zip(number(1)).zip(number(2)).map(|((c, r), w)| (c, r, w)) else {
            return Err(self.error(EXPECTED));
        };
        if column == head.columns + 1 {
            // The number that follows means nothing.
            self.lines.advance()?;
            return Ok(None);
        }
        if !(1..=head.columns).contains(&column) || first < 0 || words < 0 {
            return Err(self.error(&format!("a column up to {}", head.columns)));
        }
        Ok(Some(Record { column, first, words }))
    }

    /// The first row and the words of the next string of a sparse column, and the words that its head takes.
    fn string(&mut self, head: &Head) -> Result<(i64, i64, i64)> {
        self.lines.advance()?;
        let line = self.lines.line();
        let found = if head.is_big() {
            let number = |at: usize| whole(line.get(8 * at..(8 * at + 8).min(line.len()))?);
            number(0).zip(number(1)).map(|(length, row)| (row, length - 1, 2))
        } else {
            whole(line).map(|packed| (packed & 0xffff, (packed >> 16) - 1, 1))
        };
        match found {
            Some((row, words, own)) if row > 0 && words >= 0 => Ok((row, words, own)),
            _ => Err(self.error("the length and the first row of a string")),
        }
    }

    fn words_per_number(head: &Head) -> i64 {
        if head.is_double() { 2 } else { 1 }
    }

    /// The rows of a string and how many numbers it has.
    fn checked(&self, head: &Head, first: i64, n_numbers: i64) -> Result<(u32, u64)> {
        let n = n_numbers.unsigned_abs();
        let rows = head.rows_of(first, n / head.per_entry());
        rows.map(|first| (first, n)).ok_or_else(|| self.error(&format!("rows up to {}", head.n_rows())))
    }

    fn skip_lines(&mut self, n_numbers: i64) -> Result<()> {
        for _ in 0..n_numbers.unsigned_abs().div_ceil(self.fields.per_line as u64) {
            if !self.lines.advance()? {
                return Err(self.error("numbers"));
            }
        }
        Ok(())
    }

    /// Refuses a line that goes on behind its fields, of which there are so many at most: one of its numbers is wider than a field.
    fn refuse_wider(&self, n_left: u64) -> Result<()> {
        let n_fields = n_left.min(self.fields.per_line as u64) as usize;
        let rest = self.lines.line().get(self.fields.end(n_fields)..).unwrap_or_default();
        if rest.trim_ascii().is_empty() {
            return Ok(());
        }
        let width = self.fields.width;
        let fields = counted(n_fields, "field", "fields");
        Err(self.error(&format!(
            "{fields} of {width} characters and nothing behind – a number is wider than its field, as negative ones with exponents of three \
             digits are: write the matrix in binary"
        )))
    }

    /// The number in a field of a line. Without a point or an exponent Fortran reads it by the decimals and the scale of its format, and
    /// other programs as it stands: only what both read alike is known.
    fn number(&self, at: usize) -> Result<f64> {
        let field = self.fields.field(self.lines.line(), at);
        match (real(field), self.fields.real(field)) {
            (Some(number), Some(of_format)) if number == of_format || number.is_nan() => Ok(number),
            (Some(number), Some(of_format)) => Err(self.error(&format!(
                "numbers with a point and an exponent – field {} is {number:e} as it stands, and {of_format:e} as Fortran reads it by the \
                 format in the head: write both, as in 1.5E+00",
                at + 1
            ))),
            _ => Err(self.error(&format!("a number in field {}", at + 1))),
        }
    }

    /// Hands the next numbers to `take`, each with its position.
    fn numbers(&mut self, n: u64, mut take: impl FnMut(u64, f64) -> Result<()>) -> Result<()> {
        for position in 0..n {
            let at = (position % self.fields.per_line as u64) as usize;
            if at == 0 {
                if !self.lines.advance()? {
                    return Err(self.error("numbers"));
                }
                self.refuse_wider(n - position)?;
            }
            take(position, self.number(at)?)?;
        }
        Ok(())
    }

    /// Goes through the records: `each` is given column, first row and number of numbers before the lines of these.
    fn walk(&mut self, head: &Head, mut each: impl FnMut(&mut Self, i64, i64, i64) -> Result<()>) -> Result<()> {
        // A matrix without entries in the form of big ones has no dense column either.
        while let Some(Record { column, first, words }) = self.record(head)? {
            if first > 0 {
                each(self, column, first, words)?;
                continue;
            }
            let mut left = words;
            while left > 0 {
                let (row, words, own) = self.string(head)?;
                left -= words + own;
                each(self, column, row, words / Self::words_per_number(head))?;
            }
        }
        Ok(())
    }
}

impl<'a> Matrices<'a> for File<'a> {
    fn head(&mut self) -> Result<Option<Head>> {
        if !self.lines.advance()? || self.lines.line().trim_ascii().is_empty() {
            return Ok(None);
        }
        match parsed(self.lines.line()) {
            Some((head, fields)) if head.is_sound() => {
                self.fields = fields.unwrap_or(USUAL);
                Ok(Some(head))
            }
            _ => Err(self.error("the head of a matrix: columns, rows, form, type, name and format")),
        }
    }

    fn skip(&mut self, head: &Head) -> Result<()> {
        self.walk(head, |file, _, _, n| file.skip_lines(n))
    }

    fn entries(&mut self, head: &Head, take: &mut dyn FnMut(u32, u32, f64) -> Result<()>) -> Result<()> {
        self.walk(head, |file, column, first, n| {
            let (first, n) = file.checked(head, first, n)?;
            file.numbers(n, |position, value| take(first + position as u32, (column - 1) as u32, value))
        })
    }

    fn digest(self) -> Result<String> {
        self.lines.digest()
    }
}
