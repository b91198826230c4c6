//! The head of a matrix file: Matrix Market banner, comments and size line, or none at all.

use std::path::Path;

use super::MatrixRole;
use super::fortran::Values;
use crate::error::{Error, Result};
use crate::sparse::{Declared, MAX_ORDER};

/// What the head of a matrix file says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Head {
    /// Banner and size line of Matrix Market.
    Coordinate {
        /// Rows and columns.
        n: u32,
        /// Entries declared.
        n_entries: u64,
        /// What the entries stand for.
        declared: Declared,
        /// What their values are.
        values: Values,
    },
    /// The file starts with lines of numbers.
    Headerless {
        /// The first line where it is three whole numbers: an entry or a size line without a banner.
        first: Option<[u64; 3]>,
        /// Number of that line, from 1.
        line: u64,
    },
}

/// Reads the head line by line.
pub(super) struct HeadReader<'a> {
    path: &'a Path,
    role: MatrixRole,
    n_lines: u64,
    banner: Option<(Declared, Values)>,
}

impl<'a> HeadReader<'a> {
    /// At the first line of a file.
    pub(super) fn new(path: &'a Path, role: MatrixRole) -> Self {
        Self { path, role, n_lines: 0, banner: None }
    }

    /// Lines taken so far.
    pub(super) fn n_lines(&self) -> u64 {
        self.n_lines
    }

    /// Takes whole lines from the front of `text`; returns the bytes taken, and the head where it is complete.
    pub(super) fn take(&mut self, text: &[u8]) -> Result<(usize, Option<Head>)> {
        let mut taken = 0;
        for line in text.split_inclusive(|&byte| byte == b'\n') {
            let trimmed = line.trim_ascii();
            let head = match self.banner {
                _ if trimmed.is_empty() => None,
                Some(banner) => self.size_line(trimmed, banner)?,
                // Bare triplets say neither their order nor what they are of a further matrix.
                None if trimmed[0].is_ascii_digit() && self.role == MatrixRole::Further => {
                    let (path, line) = (self.path.to_owned(), self.n_lines + 1);
                    return Err(Error::MatrixBanner { path, line, found: excerpt(trimmed) });
                }
                None if trimmed[0].is_ascii_digit() => {
                    let first = whole_numbers(trimmed);
                    return Ok((taken, Some(Head::Headerless { first, line: self.n_lines + 1 })));
                }
                None => {
                    self.banner = self.banner_line(trimmed)?;
                    None
                }
            };
            taken += line.len();
            self.n_lines += 1;
            if head.is_some() {
                return Ok((taken, head));
            }
        }
        Ok((taken, None))
    }

    /// The error of a file that ends within its head.
    pub(super) fn ended_early(&self) -> Error {
        let path = self.path.to_owned();
        match self.banner {
            Some(_) => Error::MatrixSizeLine { path, line: self.n_lines + 1, found: "end of file".into() },
            None => Error::NoData { path, expected: "a matrix in Matrix Market form, or lines `row column value`" },
        }
    }

    /// A banner, or `None` for a comment.
    fn banner_line(&self, line: &[u8]) -> Result<Option<(Declared, Values)>> {
        let text = String::from_utf8_lossy(line).to_ascii_lowercase();
        let is_banner = text.starts_with("%%") || text.starts_with("%matrixmarket");
        if !is_banner && is_comment(line) {
            return Ok(None);
        }
        let as_written = line;
        let (path, line) = (self.path.to_owned(), self.n_lines + 1);
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        let ["%%matrixmarket", object, format, field, symmetry] = words[..] else {
            return Err(Error::MatrixBanner { path, line, found: excerpt(as_written) });
        };
        let symmetries: &[&str] = match self.role {
            MatrixRole::Stiffness | MatrixRole::Mass => &["symmetric", "general"],
            MatrixRole::Further | MatrixRole::Conversion | MatrixRole::Reduced => {
                &["symmetric", "general", "skew-symmetric"]
            }
        };
        let values = Values::of_banner(field);
        let fields: &[&str] = if values.is_some() { &[field] } else { &[] };
        let supported: [(&str, &[&str]); 4] =
            [(object, &["matrix"]), (format, &["coordinate"]), (field, fields), (symmetry, symmetries)];
        if let Some((found, _)) = supported.into_iter().find(|(found, known)| !known.contains(found)) {
            return Err(Error::MatrixFlavour { path, line, found: excerpt(found.as_bytes()) });
        }
        let declared = match (symmetry, self.role) {
            ("symmetric", _) => Declared::Symmetric,
            ("skew-symmetric", _) => Declared::Skew,
            (_, role) => role.undeclared(),
        };
        Ok(values.map(|values| (declared, values)))
    }

    /// The size line, or `None` for a comment.
    fn size_line(&self, text: &[u8], (declared, values): (Declared, Values)) -> Result<Option<Head>> {
        if is_comment(text) {
            return Ok(None);
        }
        let line = self.n_lines + 1;
        let Some([rows, cols, n_entries]) = whole_numbers(text) else {
            return Err(Error::MatrixSizeLine { path: self.path.to_owned(), line, found: excerpt(text) });
        };
        let n = square_order(self.path, line, rows, cols)?;
        Ok(Some(Head::Coordinate { n, n_entries, declared, values }))
    }
}

/// The order of a matrix of this many rows and columns.
pub(super) fn square_order(path: &Path, line: u64, rows: u64, cols: u64) -> Result<u32> {
    if rows != cols {
        return Err(Error::MatrixNotSquare { path: path.to_owned(), line, rows, cols });
    }
    let order = u32::try_from(rows).ok().filter(|&n| n > 0 && n as usize <= MAX_ORDER);
    order.ok_or_else(|| Error::MatrixOrder { path: path.to_owned(), line, n: rows, limit: MAX_ORDER as u64 })
}

/// Whether a line is a comment. Matrix Market marks comments with a percent sign, bare tables with other signs.
pub(super) fn is_comment(line: &[u8]) -> bool {
    matches!(line.first(), Some(b'%' | b'#')) || line.starts_with(b"**")
}

/// The start of a text from a file, for a message.
pub(super) fn excerpt(text: &[u8]) -> String {
    const LONGEST: usize = 60;
    let shown: String = String::from_utf8_lossy(&text[..text.len().min(4 * LONGEST)])
        .chars()
        .take(LONGEST)
        .map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c })
        .collect();
    if shown.chars().count() == LONGEST { shown + "…" } else { shown }
}

/// Exactly three whole numbers.
fn whole_numbers(line: &[u8]) -> Option<[u64; 3]> {
    let text = std::str::from_utf8(line).ok()?;
    let mut fields = text.split_ascii_whitespace().map(|field| field.parse::<u64>().ok());
    let numbers = [fields.next()??, fields.next()??, fields.next()??];
    fields.next().is_none().then_some(numbers)
}
