//! Entries of bulk data of one name, each with its continuations: small, large and free fields.

use std::path::Path;

use super::blocks::LastLine;
use super::bulk_lines::{BulkLines, Place};
use crate::error::{Error, Result};

/// How wide the fields of a line are.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Width {
    Small,
    Large,
}

impl Width {
    fn of(mark: Option<&u8>) -> Self {
        if mark == Some(&b'*') { Self::Large } else { Self::Small }
    }

    /// Fields of a line, the name not counted.
    fn n_fields(self) -> usize {
        match self {
            Self::Small => 8,
            Self::Large => 4,
        }
    }
}

const FORMAT: &str = "Nastran bulk data";

/// The last column of the fields; the eight behind it name the continuation.
const END: usize = 72;

/// The entries of bulk data of one name.
pub(super) struct Cards<'a> {
    lines: BulkLines<'a>,
    name: &'static str,
    /// The line that was read is the first one of the next entry, or of something else.
    is_ahead: bool,
}

/// An entry with its fields, blanks cut off.
pub(super) struct Card {
    pub(super) fields: Vec<Vec<u8>>,
    /// Where its first line is.
    pub(super) place: Place,
}

impl Card {
    /// The name of the matrix.
    pub(super) fn name(&self) -> String {
        self.fields.first().map_or_else(String::new, |name| String::from_utf8_lossy(name).to_ascii_uppercase())
    }

    /// Whether it is the head of a matrix: the node of its column is 0.
    pub(super) fn is_head(&self) -> bool {
        self.fields.get(1).is_some_and(|field| field.as_slice() == b"0")
    }
}

impl<'a> Cards<'a> {
    pub(super) fn open(path: &'a Path, name: &'static str) -> Result<Self> {
        Ok(Self { lines: BulkLines::open(path)?, name, is_ahead: false })
    }

    /// The next entry of that name; none at the end of the deck.
    pub(super) fn advance(&mut self) -> Result<Option<Card>> {
        loop {
            if !self.is_ahead && !self.lines.advance()? {
                return Ok(None);
            }
            self.is_ahead = false;
            let Some(first) = first_fields(self.line(), self.name) else { continue };
            let mut card = Card { fields: first.fields, place: self.lines.place() };
            let mut due = Due { name: first.next, place: card.place.clone() };
            while self.lines.advance()? {
                let line = self.line();
                // Nastran passes over comments and blank lines.
                if line.trim_ascii().is_empty() {
                    continue;
                }
                if line.starts_with(b"=") {
                    let expected = "entries written out: those that repeat the one before them are not read";
                    return Err(wrong(&self.lines.place(), line.trim_ascii(), expected));
                }
                let Some(more) = continued_fields(line) else {
                    self.is_ahead = true;
                    break;
                };
                due = due.met_by(more.name, more.next, self.lines.place())?;
                card.fields.extend(more.fields);
            }
            due.check_nothing_is_promised()?;
            return Ok(Some(card));
        }
    }

    /// The line that was read, without the comment behind its fields.
    fn line(&self) -> &[u8] {
        let line = self.lines.line();
        line.split(|byte| *byte == b'$').next().unwrap_or(line)
    }

    /// BLAKE3 of the deck, with what it includes, and whether the last line that was read is complete.
    pub(super) fn ending(self) -> Result<(String, LastLine)> {
        let last_line = self.lines.last_line();
        Ok((self.lines.digest()?, last_line))
    }
}

/// A line in its parts.
struct Line {
    /// What stands in the first field.
    name: Vec<u8>,
    fields: Vec<Vec<u8>>,
    /// What stands in the tenth field, the name of the line that continues it.
    next: Vec<u8>,
}

/// The continuation that the tenth field of a line names.
struct Due {
    name: Vec<u8>,
    /// Where that line is.
    place: Place,
}

impl Due {
    /// What is due behind a continuation of that name. Where either has no name of its own, it continues the line before it.
    fn met_by(self, name: Vec<u8>, next: Vec<u8>, place: Place) -> Result<Self> {
        let (due, found) = (own_name(&self.name), own_name(&name));
        if due.is_empty() || found.is_empty() || due.eq_ignore_ascii_case(found) {
            return Ok(Self { name: next, place });
        }
        let found = format!("a continuation {:?}", String::from_utf8_lossy(&name));
        Err(out_of_order(
            &place,
            found,
            format!("{:?}, which the line before it names", String::from_utf8_lossy(&self.name)),
        ))
    }

    /// Refuses an entry that ends although its last line names a continuation. Without a mark the tenth field is a number of the line or a word.
    fn check_nothing_is_promised(&self) -> Result<()> {
        if !matches!(self.name.first(), Some(b'+' | b'*')) || own_name(&self.name).is_empty() {
            return Ok(());
        }
        let name = String::from_utf8_lossy(&self.name);
        Err(out_of_order(
            &self.place,
            format!("no continuation {name:?} behind it"),
            "the continuation that it names".to_owned(),
        ))
    }
}

/// The name of a continuation without its mark; empty where it has none.
fn own_name(name: &[u8]) -> &[u8] {
    name.strip_prefix(b"+").or_else(|| name.strip_prefix(b"*")).unwrap_or(name).trim_ascii()
}

/// The error of a continuation that does not stand behind its entry.
fn out_of_order(place: &Place, found: String, expected: String) -> Error {
    let expected = format!("{expected}: continuations out of order are not read, write them behind their entries");
    wrong_line(place, found, expected)
}

/// The fields behind the name of an entry; none for another one.
fn first_fields(line: &[u8], name: &str) -> Option<Line> {
    let rest = line.get(name.len()..).filter(|_| line[..name.len()].eq_ignore_ascii_case(name.as_bytes()))?;
    let width = Width::of(rest.first());
    let mark = rest.strip_prefix(b"*").unwrap_or(rest);
    match mark.first() {
        Some(b',') => Some(free_line(line, width)),
        Some(b' ' | b'\t') => Some(fixed_line(line, width)),
        _ => None,
    }
}

/// The fields of a line that continues an entry; none where it does not.
fn continued_fields(line: &[u8]) -> Option<Line> {
    let first = *line.first()?;
    let width = Width::of(Some(&first));
    let mark_end = line.iter().position(|byte| *byte == b',');
    match first {
        _ if line.trim_ascii().is_empty() => None,
        b',' => Some(free_line(line, Width::Small)),
        b'+' | b'*' if mark_end.is_some_and(|at| at <= 8) => Some(free_line(line, width)),
        b' ' | b'+' | b'*' | b'\t' => Some(fixed_line(line, width)),
        _ => None,
    }
}

/// A line of fields between commas, filled up to a whole one.
fn free_line(text: &[u8], width: Width) -> Line {
    let mut fields = text.split(|byte| *byte == b',').map(|field| field.trim_ascii().to_vec());
    let name = fields.next().unwrap_or_default();
    let n = width.n_fields();
    let mut between: Vec<Vec<u8>> = fields.by_ref().take(n).collect();
    between.resize(n, Vec::new());
    Line { name, fields: between, next: fields.next().unwrap_or_default() }
}

/// A line of fields of a fixed width between the first eight columns and the last.
fn fixed_line(line: &[u8], width: Width) -> Line {
    let (n, width) = (width.n_fields(), 64 / width.n_fields());
    // A tab fills a field of eight columns.
    let mut text = Vec::with_capacity(END + 8);
    for &byte in line.iter().take(END + 8) {
        match byte {
            b'\t' => text.resize((text.len() / 8 + 1) * 8, b' '),
            byte => text.push(byte),
        }
    }
    text.resize(END + 8, b' ');
    let field = |from: usize, width: usize| text[from..from + width].trim_ascii().to_vec();
    let fields = (0..n).map(|at| field(8 + at * width, width)).collect();
    Line { name: field(0, 8), fields, next: field(END, 8) }
}

/// The error of a field.
pub(super) fn wrong(place: &Place, found: &[u8], expected: &str) -> Error {
    wrong_line(place, format!("{:?}", String::from_utf8_lossy(found)), expected.to_owned())
}

fn wrong_line(place: &Place, found: String, expected: String) -> Error {
    let (path, place) = (place.path.to_path_buf(), format!("line {}", place.line));
    Error::MatrixFormat { path, format: FORMAT, place, found, expected: expected.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(line: Option<Line>) -> Vec<String> {
        let fields = line.map_or_else(Vec::new, |line| line.fields);
        fields.into_iter().map(|field| String::from_utf8(field).expect("text")).collect()
    }

    #[test]
    fn fields_small_large_and_free() {
        let small = b"DMIG    KAAX           1       3               1       3   2.5+3            +C1";
        assert_eq!(texts(first_fields(small, "DMIG")), ["KAAX", "1", "3", "", "1", "3", "2.5+3", ""]);
        let large = b"DMIG*   KAAX                           1               3";
        assert_eq!(texts(first_fields(large, "DMIG")), ["KAAX", "1", "3", ""]);
        assert_eq!(texts(first_fields(b"dmig,k,1,2,,1,2,3.5", "DMIG")), ["k", "1", "2", "", "1", "2", "3.5", ""]);
        assert_eq!(
            texts(continued_fields(b"*                      1               3 6.788227013D+06")),
            ["1", "3", "6.788227013D+06", ""]
        );
        assert_eq!(texts(continued_fields(b"+,2,1,4.5,,3,1,5.5")), ["2", "1", "4.5", "", "3", "1", "5.5", ""]);
        assert_eq!(texts(continued_fields(b",2,1,4.5")), ["2", "1", "4.5", "", "", "", "", ""]);
        assert!(continued_fields(b"GRID    1").is_none() && continued_fields(b"  ").is_none());
        assert!(first_fields(b"DMIGX   A", "DMIG").is_none() && first_fields(b"DMI", "DMIG").is_none());
    }

    #[test]
    fn entries_that_repeat_the_one_before_them_are_refused_by_line() {
        let path = std::env::temp_dir().join(format!("supel-replicators-{}.bdf", std::process::id()));
        std::fs::write(&path, "CORD2R,1\n=,2\nGRID,1,,0.,0.,0.,10\n=,*1,=,*.1,==\n=3\n").expect("a file");
        let read = |name| Cards::open(&path, name).and_then(|mut cards| cards.advance()).map(|card| card.is_some());
        let error = read("GRID").expect_err("a replicator").to_string();
        assert!(error.contains("line 4") && error.contains("entries written out"), "{error}");
        assert!(read("GRDSET").is_ok());
        let _ = std::fs::remove_file(&path);
    }

    #[test]
    fn continuations_have_the_names_that_the_lines_before_them_say() {
        let place = Place { path: Path::new("k.bdf").into(), line: 3 };
        let met = |due: &str, name: &str| {
            let due = Due { name: due.into(), place: place.clone() };
            due.met_by(name.into(), Vec::new(), place.clone()).is_ok()
        };
        for (due, name) in
            [("+A1", "+A1"), ("+a1", "+A1"), ("A1", "+A1"), ("*A1", "+A1"), ("+A1", "+"), ("", "+A1"), ("+", "")]
        {
            assert!(met(due, name), "{due:?} {name:?}");
        }
        for (due, name) in [("+A1", "+A2"), ("+A1", "*B"), ("A1", "+A2")] {
            assert!(!met(due, name), "{due:?} {name:?}");
        }
        for (name, is_promised) in [("+A1", true), ("*A1", true), ("+", false), ("", false), ("00000012", false)] {
            let due = Due { name: name.into(), place: place.clone() };
            assert_eq!(due.check_nothing_is_promised().is_err(), is_promised, "{name:?}");
        }
    }
}
