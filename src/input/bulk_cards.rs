//! Entries of bulk data of one name, each with its continuations: small, large and free fields.

use std::collections::HashSet;
use std::path::Path;

use super::blocks::LastLine;
use super::bulk_lines::{BulkLines, Place};
use super::bulk_start::without_comment;
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
/// Columns of a small field, and of what stands before and behind the fields of a line.
const SMALL: usize = 8;
/// Columns in which a comma makes a line one of free fields, as Nastran tells them.
const FREE: usize = 10;

/// The entries of bulk data of one name.
pub(super) struct Cards<'a> {
    path: &'a Path,
    lines: BulkLines<'a>,
    name: &'static str,
    /// The line that was read is the first one of the next entry, or of something else.
    is_ahead: bool,
    /// The names that continuations of the deck have, once a line names one that does not follow.
    named: Option<HashSet<Vec<u8>>>,
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
        Ok(Self { path, lines: BulkLines::open(path)?, name, is_ahead: false, named: None })
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
            self.check_nothing_is_elsewhere(&due)?;
            return Ok(Some(card));
        }
    }

    /// Refuses an entry that ends although its last line names a continuation that stands elsewhere in the deck. A name that no
    /// continuation has says nothing, nor does one without a mark, which may be a number of the line or a word.
    fn check_nothing_is_elsewhere(&mut self, due: &Due) -> Result<()> {
        if !matches!(due.name.first(), Some(b'+' | b'*')) || own_name(&due.name).is_empty() {
            return Ok(());
        }
        let named = match &mut self.named {
            Some(named) => named,
            none => none.insert(names_of_continuations(self.path)?),
        };
        if named.contains(&own_name(&due.name).to_ascii_uppercase()) { Err(due.missed()) } else { Ok(()) }
    }

    /// The line that was read, without the comment behind its fields.
    fn line(&self) -> &[u8] {
        without_comment(self.lines.line())
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

    /// The error of an entry that ends without it.
    fn missed(&self) -> Error {
        let found = format!("no continuation {:?} behind it", String::from_utf8_lossy(&self.name));
        out_of_order(&self.place, found, "the continuation that it names, which stands elsewhere".to_owned())
    }
}

/// The names of all continuations of a deck, without their marks and in capital letters.
fn names_of_continuations(path: &Path) -> Result<HashSet<Vec<u8>>> {
    let mut lines = BulkLines::open(path)?;
    let mut names = HashSet::new();
    while lines.advance()? {
        let name =
            continued_fields(without_comment(lines.line())).map(|line| own_name(&line.name).to_ascii_uppercase());
        names.extend(name.filter(|name| !name.is_empty()));
    }
    Ok(names)
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
    matches!(mark.first(), Some(b',' | b' ' | b'\t')).then(|| line_of(line, width))
}

/// The fields of a line that continues an entry; none where it does not.
fn continued_fields(line: &[u8]) -> Option<Line> {
    let first = line.first().filter(|_| !line.trim_ascii().is_empty())?;
    matches!(first, b',' | b' ' | b'+' | b'*' | b'\t').then(|| line_of(line, Width::of(Some(first))))
}

fn line_of(line: &[u8], width: Width) -> Line {
    let is_free = line.iter().take(FREE).any(|byte| *byte == b',');
    if is_free { free_line(line, width) } else { fixed_line(line, width) }
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
    let fixed = fixed_fields(line, width, SMALL);
    // No field has a blank inside: such tabs go from one large field to the next.
    let is_split = |field: &Vec<u8>| field.iter().any(u8::is_ascii_whitespace);
    let is_by_fields = width == Width::Large && line.contains(&b'\t') && fixed.fields.iter().any(is_split);
    if is_by_fields { fixed_fields(line, width, 2 * SMALL) } else { fixed }
}

/// The fields of a line in which a tab fills up to the next multiple of so many columns behind the first eight.
fn fixed_fields(line: &[u8], width: Width, stop: usize) -> Line {
    let (n, width) = (width.n_fields(), 8 * SMALL / width.n_fields());
    let mut text = Vec::with_capacity(END + SMALL);
    for &byte in line.iter().take(END + SMALL) {
        match byte {
            b'\t' if text.len() < SMALL => text.resize(SMALL, b' '),
            b'\t' => text.resize(SMALL + ((text.len() - SMALL) / stop + 1) * stop, b' '),
            byte => text.push(byte),
        }
    }
    text.resize(END + SMALL, b' ');
    let field = |from: usize, width: usize| text[from..from + width].trim_ascii().to_vec();
    let fields = (0..n).map(|at| field(SMALL + at * width, width)).collect();
    Line { name: field(0, SMALL), fields, next: field(END, SMALL) }
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
        assert_eq!(texts(first_fields(b"DMIG  , k, 1", "DMIG"))[..3], ["k", "1", ""]);
        assert_eq!(texts(continued_fields(b"        ,2,1,4.5"))[..3], ["2", "1", "4.5"]);
        assert!(continued_fields(b"GRID    1").is_none() && continued_fields(b"  ").is_none());
        assert!(first_fields(b"DMIGX   A", "DMIG").is_none() && first_fields(b"DMI", "DMIG").is_none());
    }

    /// A tab ends a field. In lines of large fields it goes to the next eight columns, or to the next field where fields had blanks inside
    /// otherwise.
    #[test]
    fn tabs_end_fields() {
        let small = ["KAAX", "1", "3", "", "1", "3", "2.5+3", ""];
        for line in ["DMIG\tKAAX\t1\t3\t\t1\t3\t2.5+3\t\t+C1", "DMIG    KAAX\t       1       3\t1\t3\t2.5+3"] {
            assert_eq!(texts(first_fields(line.as_bytes(), "DMIG")), small, "{line:?}");
        }
        assert_eq!(
            first_fields(b"DMIG\tK\t1\t3\t\t1\t3\t2.\t\t+C1", "DMIG").map(|line| line.next),
            Some(b"+C1".to_vec())
        );
        assert_eq!(texts(continued_fields(b"\t2\t1\t4.5\t\t3\t1\t5.5"))[..7], ["2", "1", "4.5", "", "3", "1", "5.5"]);
        for line in ["DMIG*\tKAAX\t\t1\t\t3", "DMIG*\tKAAX\t1\t3"] {
            assert_eq!(texts(first_fields(line.as_bytes(), "DMIG")), ["KAAX", "1", "3", ""], "{line:?}");
        }
        for line in ["*\t1\t\t3\t\t6.788227013D+06", "*C1\t1\t3\t6.788227013D+06"] {
            assert_eq!(texts(continued_fields(line.as_bytes())), ["1", "3", "6.788227013D+06", ""], "{line:?}");
        }
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
    }
}
