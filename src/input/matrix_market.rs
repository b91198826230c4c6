//! Matrices in text: Matrix Market coordinate files, and the bare triplets of CalculiX (`.sti`, `.mas`) and Abaqus.
//!
//! Bare triplets have no size: the largest index is the order of the matrix. A size line without a
//! banner is recognised only at the end of the file: the first line is `n n m`, and m entries within n follow.

use std::path::Path;

use rayon::prelude::*;

use super::allowance::Claim;
use super::assembled::{Found, assembled, bytes_of_entry};
use super::banner::{Head, HeadReader, square_order};
use super::blocks::{BLOCK_BYTES, LastLine, for_each_batch};
use super::entries::{Entries, Fault, parse_entries};
use super::file_start::FileStart;
use super::format::{Format, MatrixFormat, MatrixSource, OrderSource, ReadMatrix, Sureness};
use super::fortran::Values;
use super::gathering::Gathering;
use super::market_array;
use super::written::{Written, written};
use crate::error::{Error, Result};
use crate::job::Layout;
use crate::sparse::{Declared, MAX_ORDER};

/// How a file with a banner begins, in whatever case.
const BANNER: &[u8] = b"%%MatrixMarket";

/// Matrix Market.
pub(super) struct MatrixMarket;

/// Bare triplets: every file that is nothing else.
pub(super) struct Coordinate;

impl Format for MatrixMarket {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        let begins = start.head.get(..BANNER.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(BANNER));
        if begins { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl Format for Coordinate {
    fn sureness(&self, _: &FileStart<'_>) -> Sureness {
        Sureness::Possible
    }
}

impl MatrixFormat for MatrixMarket {
    fn layout(&self) -> Layout {
        Layout::MatrixMarket
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        if market_array::begins(&FileStart::of(&source.file)?) {
            return market_array::read(source);
        }
        read_in_blocks(source, BLOCK_BYTES)
    }
}

impl MatrixFormat for Coordinate {
    fn layout(&self) -> Layout {
        Layout::Coordinate
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        read_in_blocks(source, BLOCK_BYTES)
    }
}

/// Reads a matrix from text in blocks of about this many bytes. The block size changes no result.
fn read_in_blocks(source: &MatrixSource<'_>, block_bytes: usize) -> Result<ReadMatrix> {
    let path = source.file.as_path();
    let mut reading = Reading {
        path,
        head_reader: HeadReader::new(path, source.role),
        head: None,
        entries: Gathering::new(),
        claim: source.allowance.claim(path),
        written: None,
        n_lines: 0,
    };
    let ending = for_each_batch(path, block_bytes, |batch| reading.take(batch))?;
    let Some(head) = reading.head else {
        return Err(reading.head_reader.ended_early());
    };
    let Reading { entries, claim, written, n_lines, .. } = reading;
    let last_line = n_lines + u64::from(ending.last_line == LastLine::Open);
    let n_read = entries.n_entries();
    let (n, declared, order, gathered) = match head {
        Head::Coordinate { n, n_entries, declared, .. } => {
            check_count((path, last_line), n_entries, n_read)?;
            (n, declared, OrderSource::SizeLine, entries.all())
        }
        Head::Headerless { first, line } => {
            let (n, order) = headerless_order((path, last_line), &entries, first, line)?;
            let gathered = if order == OrderSource::SizeLine { entries.rest() } else { entries.all() };
            (n, Declared::General, order, gathered)
        }
    };
    let found = Found { n, declared, entries: gathered, written, digest: ending.digest };
    let input = assembled(found, source, &claim)?;
    Ok(ReadMatrix { input, order, last_line: ending.last_line, labels: None, frames: Ok(None) })
}

/// What was read so far.
struct Reading<'a> {
    path: &'a Path,
    head_reader: HeadReader<'a>,
    head: Option<Head>,
    entries: Gathering,
    claim: Claim<'a>,
    /// What a fixed format wrote of every number, by the first lines of entries.
    written: Option<Written>,
    /// Lines taken, of the head and of entries.
    n_lines: u64,
}

impl Reading<'_> {
    /// Claims the entries so far and the matrix that will be made of them: both triangles where one is declared for both.
    fn claim_entries(&mut self) -> Result<()> {
        let declared = match self.head {
            Some(Head::Coordinate { declared, .. }) => declared,
            _ => Declared::General,
        };
        self.claim.set(bytes_of_entry(declared) * self.entries.n_held() as u64)
    }

    fn take(&mut self, batch: &[Vec<u8>]) -> Result<()> {
        let mut texts: Vec<&[u8]> = Vec::with_capacity(batch.len());
        for block in batch {
            let mut text = block.as_slice();
            if self.head.is_none() {
                let (taken, head) = self.head_reader.take(text)?;
                (text, self.head) = (&text[taken..], head);
                self.n_lines = self.head_reader.n_lines();
            }
            texts.push(text);
        }
        if self.entries.n_entries() == 0 {
            self.written = texts.first().and_then(|text| written(text));
        }
        let (n, values, declared) = match self.head {
            None => return Ok(()),
            Some(Head::Coordinate { n, n_entries, values, .. }) => (n, values, n_entries),
            Some(Head::Headerless { .. }) => (MAX_ORDER as u32, Values::Real, u64::MAX),
        };
        let parsed: Vec<Result<Entries, Fault>> =
            texts.par_iter().map(|text| parse_entries(text, (n, values), u64::MAX)).collect();
        for (text, entries) in texts.into_iter().zip(parsed) {
            let left = declared - self.entries.n_entries();
            let entries = entries.and_then(|entries| {
                // Parsed again to find the line of the first one too many.
                if entries.triplets.len() as u64 > left { parse_entries(text, (n, values), left) } else { Ok(entries) }
            });
            let entries = entries.map_err(|fault| fault.into_error(self.path, self.n_lines, n, declared))?;
            let mut triplets = entries.triplets;
            // Three whole numbers may be a size line.
            if matches!(self.head, Some(Head::Headerless { first: Some(_), .. })) {
                triplets = self.entries.doubt_first(triplets);
            }
            self.entries.append(triplets);
            self.claim_entries()?;
            self.n_lines += entries.n_lines;
        }
        Ok(())
    }
}

/// The order of a matrix without a banner, whose first line may be a bare size line.
fn headerless_order(
    (path, last_line): (&Path, u64),
    entries: &Gathering,
    first: Option<[u64; 3]>,
    line: u64,
) -> Result<(u32, OrderSource)> {
    if let Some([rows, cols, declared]) = first {
        let n_rest = entries.n_entries() - 1;
        let holds_rest = n_rest > 0 && rows.min(cols) >= entries.largest_index_of_rest();
        // A count of entries below the order would be an odd matrix, but an ordinary value.
        if holds_rest && (declared == n_rest || (rows == cols && declared >= rows)) {
            check_count((path, last_line), declared, n_rest)?;
            let n = square_order(path, line, rows, cols)?;
            return Ok((n, OrderSource::SizeLine));
        }
    }
    let n = entries.largest_index();
    Ok((square_order(path, line, n, n)?, OrderSource::LargestIndex))
}

fn check_count((path, line): (&Path, u64), declared: u64, found: u64) -> Result<()> {
    if found == declared {
        return Ok(());
    }
    Err(Error::EntryCount { path: path.to_owned(), line, declared, found })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::MatrixRole;
    use crate::input::allowance::Allowance;

    fn read_in_blocks(path: &Path, block_bytes: usize) -> Result<ReadMatrix> {
        let (file, role, allowance) = (path.to_owned(), MatrixRole::Stiffness, &Allowance::of(None));
        let source =
            MatrixSource { file, member: None, layout: None, role, triangle: None, stated_digits: None, allowance };
        super::read_in_blocks(&source, block_bytes)
    }

    fn read(path: &Path) -> Result<ReadMatrix> {
        read_in_blocks(path, BLOCK_BYTES)
    }

    /// A file of lines of many lengths, and what reading it in one block gives.
    fn sample(folder: &Path) -> (std::path::PathBuf, ReadMatrix) {
        let mut text = String::from("\u{feff}%%MatrixMarket matrix coordinate real symmetric\n% rows\n\n40 40 120\n");
        for k in 0..120_u32 {
            let row = k * 7 % 40 + 1;
            let col = k * 3 % row + 1;
            text += &format!("{row}\t{col}  {}\r\n", f64::from(k * k) / 7.0 - 100.0);
            if k % 10 == 0 {
                text += "% a comment between\n\n";
            }
        }
        let path = folder.join("a.mtx");
        std::fs::write(&path, text).expect("a file");
        let whole = read(&path).expect("a matrix");
        (path, whole)
    }

    #[test]
    fn the_block_size_changes_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let (path, whole) = sample(folder.path());
        for block_bytes in 1..=64 {
            let blocks = read_in_blocks(&path, block_bytes).expect("a matrix");
            assert_eq!(blocks.input.matrix, whole.input.matrix, "{block_bytes}");
            assert_eq!(blocks.input.digest, whole.input.digest);
            assert_eq!(blocks.last_line, LastLine::Terminated);
        }
    }

    /// A header that promises more than any memory, and a length that the disk does not hold either.
    #[test]
    fn neither_header_nor_length_is_believed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("c.mtx");
        let head = "%%MatrixMarket matrix coordinate real symmetric\n3 3 100000000000\n1 1 1\n";
        std::fs::write(&path, head).expect("a file");
        let file = std::fs::OpenOptions::new().write(true).open(&path).expect("the file");
        file.set_len(1 << 40).expect("a file with a hole");
        let error = read_in_blocks(&path, 1 << 10).err().expect("an error");
        assert!(matches!(&error, Error::EntryField { line: 4, .. } | Error::LineTooLong { line: 4, .. }), "{error}");
    }

    #[test]
    fn the_block_size_changes_no_error() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("b.mtx");
        let head = "%%MatrixMarket matrix coordinate real general\n3 3 3\n1 1 1\n\n% x\n";
        for tail in ["2 2 x\n3 3 3\n", "2 2 2\n4 1 1\n", "1 1 1\n2 2 2\n3 3 3\n", "1 1 1\n"] {
            std::fs::write(&path, format!("{head}{tail}")).expect("a file");
            let whole = read(&path).err().expect("an error").to_string();
            for block_bytes in 1..=64 {
                let blocks = read_in_blocks(&path, block_bytes).err().expect("an error").to_string();
                assert_eq!(blocks, whole, "{block_bytes}");
            }
        }
    }
}
