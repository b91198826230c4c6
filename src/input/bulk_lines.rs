//! The lines of a Nastran deck and of the files that it includes, up to ENDDATA, behind which Nastran reads nothing.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::banner::excerpt;
use super::blocks::LastLine;
use super::bulk_start::is_bulk;
use super::file_start::FileStart;
use super::inclusion::included_file;
use super::lines::Lines;
use crate::error::{Error, Result};
use crate::regular_file::{digest, digest_of_list};

/// The longest name of a file, with the lines that continue it.
const MAX_NAME: usize = 1 << 10;

/// The lines of a deck.
pub(super) struct BulkLines<'a> {
    /// The deck and what it includes, as often as it does.
    files: Vec<Rc<Path>>,
    /// Files that are open, each with its index, and included by the one before.
    open: Vec<(usize, Lines<'a>)>,
    /// Digests of the files that were read to their ends, and their indices.
    digests: Vec<(usize, String)>,
    last_line: LastLine,
}

impl<'a> BulkLines<'a> {
    /// Before the first line.
    pub(super) fn open(path: &'a Path) -> Result<Self> {
        Ok(Self {
            files: vec![path.into()],
            open: vec![(0, Lines::open(path)?)],
            digests: Vec::new(),
            last_line: LastLine::Terminated,
        })
    }

    /// The line that was read last, without its end; nothing behind the last one.
    pub(super) fn line(&self) -> &[u8] {
        self.open.last().map_or(&[], |(_, lines)| lines.line())
    }

    /// File and line of the line that was read last.
    pub(super) fn place(&self) -> Place {
        match self.open.last() {
            Some((file, lines)) => Place { path: Rc::clone(&self.files[*file]), line: lines.number() },
            None => Place { path: Rc::clone(&self.files[0]), line: 0 },
        }
    }

    /// Reads the next line; false at the end.
    ///
    /// # Errors
    /// [`Error::DeckInclude`]; those of reading the files.
    pub(super) fn advance(&mut self) -> Result<bool> {
        while let Some((_, lines)) = self.open.last_mut() {
            if !lines.advance()? {
                self.close()?;
            } else if ends_data(lines.line()) {
                while !self.open.is_empty() {
                    self.close()?;
                }
            } else if includes(lines.line()) {
                self.include()?;
            } else {
                self.last_line = if lines.is_open() { LastLine::Open } else { LastLine::Terminated };
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether the line that was read last is complete.
    pub(super) fn last_line(&self) -> LastLine {
        self.last_line
    }

    /// BLAKE3 of the deck; where it includes others, of their digests one below the other.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(super) fn digest(mut self) -> Result<String> {
        while !self.open.is_empty() {
            self.close()?;
        }
        self.digests.sort_by_key(|(file, _)| *file);
        let digests: Vec<String> = self.digests.into_iter().map(|(_, digest)| digest).collect();
        Ok(digest_of_list(&digests))
    }

    /// Closes the file that was included last.
    fn close(&mut self) -> Result<()> {
        if let Some((file, lines)) = self.open.pop() {
            self.digests.push((file, lines.digest()?));
        }
        Ok(())
    }

    /// Goes on with the file that the line names, and then with the lines behind this one.
    fn include(&mut self) -> Result<()> {
        let Place { path, line } = self.place();
        let reference = self.reference()?;
        let counts = (self.open.len(), self.files.len());
        let file = included_file(&self.files[0], &reference, counts).map_err(|[reason, expected]| {
            let reference = excerpt(reference.as_bytes());
            Error::DeckInclude { path: path.to_path_buf(), line, reference, reason, expected }
        })?;
        self.open.push((self.files.len(), Lines::open(file.clone())?));
        self.files.push(file.into());
        Ok(())
    }

    /// The name that a line includes. In quotation marks it may go on in the lines that follow.
    fn reference(&mut self) -> Result<String> {
        let mut text = self.line().trim_ascii()[INCLUDE.len()..].trim_ascii().to_vec();
        let Some(&mark) = text.first().filter(|mark| matches!(mark, b'\'' | b'"')) else {
            let name = text.split(|byte| byte.is_ascii_whitespace() || *byte == b'$').next().unwrap_or_default();
            return Ok(String::from_utf8_lossy(name).into_owned());
        };
        while !text[1..].contains(&mark) && text.len() < MAX_NAME {
            let Some((_, lines)) = self.open.last_mut() else { break };
            if !lines.advance()? {
                break;
            }
            text.extend_from_slice(lines.line().trim_ascii());
        }
        let name = text[1..].split(|byte| *byte == mark).next().unwrap_or_default();
        Ok(String::from_utf8_lossy(name).into_owned())
    }
}

/// Where a line is.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub(super) path: Rc<Path>,
    /// Line number, from 1.
    pub(super) line: u64,
}

/// The statement that another file stands for.
const INCLUDE: &[u8] = b"INCLUDE";

/// Whether a line names a file to go on with.
fn includes(line: &[u8]) -> bool {
    let rest = behind(line, INCLUDE);
    rest.is_some_and(|rest| rest.first().is_some_and(|byte| matches!(byte, b' ' | b'\t' | b'\'' | b'"')))
}

/// Whether a line is the last one of a deck.
fn ends_data(line: &[u8]) -> bool {
    behind(line, b"ENDDATA").is_some_and(|rest| !rest.first().is_some_and(u8::is_ascii_alphanumeric))
}

/// What follows a word at the start of a line, in whatever case.
fn behind<'l>(line: &'l [u8], word: &[u8]) -> Option<&'l [u8]> {
    let line = line.trim_ascii();
    let (begin, rest) = line.split_at_checked(word.len())?;
    begin.eq_ignore_ascii_case(word).then_some(rest)
}

/// The files that a deck of Nastran includes, those that can be told; none of other files.
pub(super) fn included_files(path: &Path) -> Vec<PathBuf> {
    if !FileStart::of(path).is_ok_and(|start| is_bulk(&start)) {
        return Vec::new();
    }
    let Ok(mut lines) = BulkLines::open(path) else { return Vec::new() };
    // What comes before a line that cannot be read is included all the same.
    while let Ok(true) = lines.advance() {}
    let mut seen = HashSet::new();
    lines.files[1..].iter().filter(|file| seen.insert(Rc::clone(file))).map(|file| file.to_path_buf()).collect()
}

/// BLAKE3 of a file as inputs are recorded by it, in lower-case hexadecimal: that of its bytes, or where a deck of Nastran includes others, of
/// all their digests one below the other.
///
/// # Errors
/// A file that cannot be read, an inclusion that is refused.
pub fn digest_with_included(path: &Path) -> Result<String> {
    if !is_bulk(&FileStart::of(path)?) {
        return digest(path);
    }
    let mut lines = BulkLines::open(path)?;
    while lines.advance()? {}
    lines.digest()
}
