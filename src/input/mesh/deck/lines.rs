//! The lines of a deck and of the files that it includes, one after the other.

use std::collections::HashSet;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use super::keyword::Keyword;
use crate::error::{Error, Result};
use crate::input::banner::excerpt;
use crate::input::inclusion::included_file;
use crate::input::source::{Source, read_error};
use crate::regular_file::digest_of_list;

/// The longest line, with the lines that continue a keyword.
const MAX_LINE_BYTES: usize = 1 << 16;

/// Where a line is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Place {
    /// Index of the file, in the order of inclusion.
    file: u32,
    /// Line number, from 1.
    line: u32,
}

/// The lines of a deck that are no comments.
pub(super) struct DeckLines {
    /// The deck and what it includes, as often as it does.
    files: Vec<PathBuf>,
    open: Vec<Open>,
    line: Vec<u8>,
    /// A line that was read too far.
    is_held: bool,
    place: Place,
    /// Digests of the included files that were read to their ends.
    digests: Vec<String>,
}

struct Open {
    file: u32,
    text: BufReader<Source>,
    line: u32,
}

impl DeckLines {
    pub(super) fn open(path: &Path) -> Result<Self> {
        let open = vec![Open { file: 0, text: BufReader::new(Source::open(path)?), line: 0 }];
        let (files, line, digests) = (vec![path.to_owned()], Vec::new(), Vec::new());
        Ok(Self { files, open, line, is_held: false, place: Place::default(), digests })
    }

    /// The next line that is neither blank nor a comment, without blanks around it; none at the end of the deck. A keyword comes with the
    /// lines that continue it.
    pub(super) fn next(&mut self) -> Result<Option<&[u8]>> {
        if self.is_held {
            self.is_held = false;
            return Ok(Some(self.line.trim_ascii()));
        }
        if !self.next_line(0)? {
            return Ok(None);
        }
        let place = self.place;
        while is_keyword(&self.line) && self.line.trim_ascii_end().ends_with(b",") {
            let length = self.line.trim_ascii_end().len();
            self.line.truncate(length);
            if !self.next_line(length)? {
                break;
            }
        }
        self.place = place;
        Ok(Some(self.line.trim_ascii()))
    }

    /// Lets the next call give the last line once more.
    pub(super) fn hold(&mut self) {
        self.is_held = true;
    }

    /// The last line.
    pub(super) fn text(&self) -> &[u8] {
        self.line.trim_ascii()
    }

    /// Where the last line is.
    pub(super) fn place(&self) -> Place {
        self.place
    }

    /// BLAKE3 of the included file; of their digests one below the other where there are several; none where there are none.
    pub(super) fn digest_of_included(&self) -> Option<String> {
        (!self.digests.is_empty()).then(|| digest_of_list(&self.digests))
    }

    /// The files that were included.
    pub(super) fn included(&self) -> &[PathBuf] {
        &self.files[1..]
    }

    /// File and line of a place.
    pub(super) fn at(&self, place: Place) -> (PathBuf, u64) {
        (self.files[place.file as usize].clone(), place.line.into())
    }

    /// The error of the last line.
    pub(super) fn error(&self, found: impl Into<String>, expected: impl Into<String>) -> Error {
        self.error_at(self.place, found, expected)
    }

    /// The error of a line.
    pub(super) fn error_at(&self, place: Place, found: impl Into<String>, expected: impl Into<String>) -> Error {
        let (path, line) = self.at(place);
        Error::MeshText { path, line, found: found.into(), expected: expected.into() }
    }

    /// The error of a keyword that is not read.
    pub(super) fn unsupported(&self, found: impl Into<String>, advice: &'static str) -> Error {
        let (path, line) = self.at(self.place);
        Error::DeckUnsupported { path, line, found: found.into(), advice }
    }

    /// Goes on with another file of the folder, and then with the lines behind this one.
    pub(super) fn include(&mut self, reference: &str) -> Result<()> {
        let (path, line) = self.at(self.place);
        let refuse = |[reason, expected]: [&'static str; 2]| {
            let reference = excerpt(reference.as_bytes());
            Error::DeckInclude { path: path.clone(), line, reference, reason, expected }
        };
        let file = included_file(&self.files[0], reference, (self.open.len(), self.files.len())).map_err(refuse)?;
        let text = BufReader::new(Source::open(&file)?);
        self.open.push(Open { file: self.files.len() as u32, text, line: 0 });
        self.files.push(file);
        Ok(())
    }

    /// Goes through the deck and what it includes, and leaves every line aside.
    fn follow(&mut self) -> Result<()> {
        while let Some(line) = self.next()? {
            if is_keyword(line)
                && let Some(file) = included_by(&Keyword::of(line))
            {
                self.include(file)?;
            }
        }
        Ok(())
    }

    /// Puts the next line that is neither blank nor a comment behind the first bytes of the buffer; false at the end of the deck.
    fn next_line(&mut self, kept: usize) -> Result<bool> {
        while let Some(open) = self.open.last_mut() {
            self.line.truncate(kept);
            let room = MAX_LINE_BYTES.saturating_sub(kept);
            let path = &self.files[open.file as usize];
            let read = open.text.by_ref().take(room as u64).read_until(b'\n', &mut self.line);
            let n_read = read.map_err(|error| read_error(path, error))?;
            open.line = open.line.saturating_add(1);
            if n_read == room {
                return Err(Error::LineTooLong { path: path.clone(), line: open.line.into(), limit: MAX_LINE_BYTES });
            }
            if n_read == 0 {
                let file = open.file;
                let digest = open.text.get_ref().digest();
                self.open.pop();
                if file > 0 {
                    self.digests.push(digest);
                }
                continue;
            }
            let text = self.line[kept.min(self.line.len())..].trim_ascii();
            if text.is_empty() || text.starts_with(b"**") {
                continue;
            }
            self.place = Place { file: open.file, line: open.line };
            return Ok(true);
        }
        Ok(false)
    }
}

/// Whether a line begins a keyword.
pub(super) fn is_keyword(line: &[u8]) -> bool {
    matches!(line.trim_ascii_start(), [b'*', next, ..] if *next != b'*')
}

/// The files that a deck includes, those that can be told.
pub(in crate::input::mesh) fn included_files(path: &Path) -> Vec<PathBuf> {
    let Ok(mut lines) = DeckLines::open(path) else { return Vec::new() };
    // What comes before a line that cannot be read is included all the same.
    let _ = lines.follow();
    let mut seen = HashSet::new();
    lines.included().iter().filter(|file| seen.insert(file.as_path())).cloned().collect()
}

/// BLAKE3 of the files that a deck includes now, as a reading of its mesh records it; none where it includes none.
///
/// # Errors
/// A file that cannot be read, an inclusion that is refused.
pub(in crate::input::mesh) fn digest_of_included(path: &Path) -> Result<Option<String>> {
    let mut lines = DeckLines::open(path)?;
    lines.follow()?;
    Ok(lines.digest_of_included())
}

/// The file that a keyword takes its lines from.
pub(super) fn included_by(keyword: &Keyword) -> Option<&str> {
    let may = matches!(keyword.name.as_str(), "INCLUDE" | "NODE" | "ELEMENT" | "NSET" | "ELSET" | "SURFACE");
    if may { keyword.value("INPUT") } else { None }
}
