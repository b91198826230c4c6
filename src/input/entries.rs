//! Lines `row column value` to triplets.

use std::path::Path;

use super::banner::{excerpt, is_comment};
use super::blocks::count_lines;
use super::fortran::{Values, real};
use crate::error::Error;
use crate::sparse::Triplets;

/// Entries of a piece of text.
#[derive(Debug)]
pub(super) struct Entries {
    /// Entries in order, zero-based.
    pub(super) triplets: Triplets,
    /// Line ends passed.
    pub(super) n_lines: u64,
}

/// What is wrong with a line, and its number within the text, from 0.
#[derive(Debug)]
pub(super) struct Fault {
    line: u64,
    what: What,
}

#[derive(Debug)]
enum What {
    Field { field: &'static str, found: String, expected: &'static str },
    Excess { found: String },
    Index { field: &'static str, found: u64 },
    NonFinite { row: u64, col: u64, found: String },
    Surplus,
}

/// Parses whole lines of a matrix of order n, at most `max_entries` of them.
pub(super) fn parse_entries(text: &[u8], (n, values): (u32, Values), max_entries: u64) -> Result<Entries, Fault> {
    // Blocks of entries stay as they are: none takes more room than it has lines.
    let mut triplets = Triplets::with_capacity(count_lines(text) as usize + 1);
    let mut cursor = Cursor { text, at: 0, values };
    let mut line = 0;
    loop {
        cursor.skip_blanks();
        match cursor.peek() {
            None => {
                return Ok(Entries { triplets, n_lines: line });
            }
            Some(b'\n') => {
                cursor.at += 1;
                line += 1;
            }
            Some(_) if is_comment(cursor.rest()) => cursor.skip_line(),
            Some(_) if triplets.len() as u64 >= max_entries => {
                return Err(Fault { line, what: What::Surplus });
            }
            Some(_) => {
                let (row, col, value) = cursor.entry(n).map_err(|what| Fault { line, what })?;
                triplets.push(row, col, value);
            }
        }
    }
}

impl Fault {
    /// The error in the file `path`, where `n_before` lines come before the text and `declared` entries are due.
    pub(super) fn into_error(self, path: &Path, n_before: u64, n: u32, declared: u64) -> Error {
        let (path, line) = (path.to_owned(), n_before + self.line + 1);
        match self.what {
            What::Field { field, found, expected } => Error::EntryField { path, line, field, found, expected },
            What::Excess { found } => Error::EntryExcess { path, line, found },
            What::Index { field, found } => Error::EntryIndex { path, line, field, found, n: n.into() },
            What::NonFinite { row, col, found } => Error::NonFinite { path, line, row, col, found },
            What::Surplus => Error::EntriesSurplus { path, line, declared },
        }
    }
}

/// Eight characters 0.
const ZEROS: u64 = u64::from_ne_bytes([b'0'; 8]);

/// How many of eight characters, the lowest byte first, are digits before the first one that is none.
fn leading_digits(eight: u64) -> u32 {
    // Of a digit the upper half is that of a 0, and stays so where six is added: 9 + 6 is fifteen.
    const HALVES: u64 = u64::from_ne_bytes([0xf0; 8]);
    const SIXES: u64 = u64::from_ne_bytes([6; 8]);
    let differs = (eight & HALVES) ^ ZEROS | (eight.wrapping_add(SIXES) & HALVES) ^ ZEROS;
    differs.trailing_zeros() / 8
}

/// The number of eight decimal digits, one a byte, the first one lowest: pairs become two digits, pairs of pairs four.
fn value_of_eight_digits(digits: u64) -> u64 {
    let pairs = digits.wrapping_mul(10).wrapping_add(digits >> 8) & 0x00ff_00ff_00ff_00ff;
    let fours = pairs.wrapping_mul(100).wrapping_add(pairs >> 16) & 0x0000_ffff_0000_ffff;
    fours.wrapping_mul(10_000).wrapping_add(fours >> 32) & 0xffff_ffff
}

/// A place in a text.
struct Cursor<'a> {
    text: &'a [u8],
    at: usize,
    values: Values,
}

impl<'a> Cursor<'a> {
    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn rest(&self) -> &'a [u8] {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn skip_blanks(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t' | b'\r')) {
            self.at += 1;
        }
    }

    /// Stops before the line end.
    fn skip_line(&mut self) {
        let rest = self.rest();
        self.at += rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
    }

    /// One entry, zero-based, up to its line end.
    fn entry(&mut self, n: u32) -> Result<(u32, u32, f64), What> {
        let row = self.index("row", n)?;
        self.skip_blanks();
        let col = self.index("column", n)?;
        self.skip_blanks();
        let start = self.at;
        let value = self.value()?;
        if self.values == Values::Whole && Values::Whole.of_field(&self.text[start..self.at]).is_none() {
            self.at = start;
            let expected = self.values.expected();
            return Err(What::Field { field: "value", found: self.found(), expected });
        }
        if !value.is_finite() {
            let found = excerpt(&self.text[start..self.at]);
            return Err(What::NonFinite { row: u64::from(row) + 1, col: u64::from(col) + 1, found });
        }
        self.skip_blanks();
        if !matches!(self.peek(), None | Some(b'\n')) {
            return Err(What::Excess { found: self.found() });
        }
        Ok((row, col, value))
    }

    /// An index from 1 to n, returned from 0.
    fn index(&mut self, field: &'static str, n: u32) -> Result<u32, What> {
        let start = self.at;
        let short = self.short_whole();
        let found = short.unwrap_or_else(|| self.whole());
        if self.at == start || !self.at_field_end() {
            self.at = start;
            return Err(What::Field { field, found: self.found(), expected: "a whole number from 1" });
        }
        match u32::try_from(found) {
            Ok(index @ 1..) if index <= n => Ok(index - 1),
            _ => Err(What::Index { field, found }),
        }
    }

    /// The digits that start here, as far as they go.
    fn whole(&mut self) -> u64 {
        let mut found = 0_u64;
        while let Some(digit @ b'0'..=b'9') = self.peek() {
            found = found.saturating_mul(10).saturating_add(u64::from(digit - b'0'));
            self.at += 1;
        }
        found
    }

    /// The digits that start here, read at once where they are seven at most. None where there may be more of them, and the place stays.
    #[inline]
    fn short_whole(&mut self) -> Option<u64> {
        let eight = self.text.get(self.at..self.at + 8)?;
        // The first byte comes lowest.
        let eight = u64::from_le_bytes(eight.try_into().ok()?);
        let n_digits = leading_digits(eight);
        if n_digits == 8 {
            return None;
        }
        self.at += n_digits as usize;
        // Zeros in front of the digits, which move to the end. None of them leaves nothing.
        let digits = (eight ^ ZEROS).checked_shl(64 - 8 * n_digits).unwrap_or(0);
        Some(value_of_eight_digits(digits))
    }

    fn value(&mut self) -> Result<f64, What> {
        if let Ok((value, length)) = fast_float2::parse_partial::<f64, _>(self.rest()) {
            let start = self.at;
            self.at += length;
            if self.at_field_end() {
                return Ok(value);
            }
            self.at = start;
        }
        let field = self.field();
        let value = real(field);
        match value {
            Some(value) => {
                self.at += field.len();
                Ok(value)
            }
            None => Err(What::Field { field: "value", found: self.found(), expected: "a number" }),
        }
    }

    fn at_field_end(&self) -> bool {
        matches!(self.peek(), None | Some(b' ' | b'\t' | b'\r' | b'\n'))
    }

    /// The field that starts here, without moving.
    fn field(&self) -> &'a [u8] {
        let rest = self.rest();
        let length = rest.iter().position(|byte| byte.is_ascii_whitespace()).unwrap_or(rest.len());
        &rest[..length]
    }

    /// What stands here, for a message.
    fn found(&self) -> String {
        let field = self.field();
        if field.is_empty() { "end of line".into() } else { excerpt(field) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every number of digits, before every character, at the end of a text and far from it.
    #[test]
    fn digits_are_read_at_once_as_one_by_one() {
        let n = u32::MAX;
        for digits in [
            "0",
            "1",
            "9",
            "10",
            "407",
            "9999",
            "12345",
            "000001",
            "9999999",
            "10000000",
            "4294967295",
            "99999999999999999999999",
        ] {
            for after in (0..=u8::MAX).filter(|byte| !byte.is_ascii_digit()) {
                for more in ["", " 1 2.5\n3 4 5\n"] {
                    let mut text = digits.as_bytes().to_vec();
                    text.push(after);
                    text.extend(more.as_bytes());
                    let mut cursor = Cursor { text: &text, at: 0, values: Values::Real };
                    let found = cursor.index("row", n);
                    let value: f64 = digits.parse().expect("a number");
                    match found {
                        Ok(index) => {
                            assert!(matches!(after, b' ' | b'\t' | b'\r' | b'\n'), "{digits} {after}");
                            assert_eq!((f64::from(index) + 1.0, cursor.at), (value, digits.len()));
                        }
                        Err(What::Index { found, .. }) => {
                            assert!(value == 0.0 || value > f64::from(n), "{digits}");
                            assert_eq!(found, digits.parse().unwrap_or(u64::MAX));
                        }
                        Err(what) => {
                            assert!(matches!(what, What::Field { .. }), "{what:?}");
                            assert!(!matches!(after, b' ' | b'\t' | b'\r' | b'\n'), "{digits} {after}");
                            assert_eq!(cursor.at, 0);
                        }
                    }
                }
            }
        }
    }
}
