//! Nastran DMIG: matrices of bulk data and of punch files, by nodes and components.
//!
//! ```text
//! DMIG  NAME  0   IFO  TIN  TOUT  POLAR  -  NCOL     the head
//! DMIG  NAME  GJ  CJ   -    G1    C1     A1  B1      a column, and its first entry
//!       G2    C2  A2   B2   G3    C3     A3  B3      further entries, two in a line, or one where fields are large
//! ```
//!
//! Nastran takes a symmetric matrix (IFO = 6) from either triangle, entry by entry; NASTRAN-95 wants both. Both are read.

use std::collections::BTreeSet;
use std::path::Path;

use super::assembled::complete;
use super::bulk_cards::Cards;
use super::bulk_lines::Place;
use super::bulk_start::is_bulk;
use super::file_start::FileStart;
use super::format::{Format, MatrixFormat, MatrixSource, ReadMatrix, Sureness};
use super::fortran::{real, whole};
use super::labels::LabelledEntries;
use super::named::chosen;
use super::row_label::RowLabel;
use crate::error::{Error, Result};
use crate::job::Layout;
use crate::sparse::{Declared, Given};

const FORMAT: &str = "DMIG";
/// Fields of a column before its entries.
const BEFORE_ENTRIES: usize = 4;
/// Fields of an entry.
const PER_ENTRY: usize = 4;

/// DMIG of Nastran.
pub(super) struct Dmig;

impl Format for Dmig {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        if is_bulk(start) { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl MatrixFormat for Dmig {
    fn layout(&self) -> Layout {
        Layout::Dmig
    }

    fn has_members(&self) -> bool {
        true
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        let path = source.file.as_path();
        let heads = heads(path)?;
        let names: Vec<&str> = heads.iter().map(|head| head.name.as_str()).collect();
        if names.is_empty() {
            let expected = "DMIG entries: have Nastran write them, as EXTSEOUT(DMIGPCH) and PARAM,EXTOUT,DMIGPCH do";
            return Err(Error::MatrixNone { path: path.to_owned(), format: FORMAT, holds: Vec::new(), expected });
        }
        let head = &heads[chosen(path, &names, source.member.as_deref(), source.role)?];
        read(source, head)
    }
}

/// The head of a matrix.
struct Head {
    name: String,
    form: i64,
    kind: i64,
    place: Place,
}

/// The heads of a file, in order.
fn heads(path: &Path) -> Result<Vec<Head>> {
    let mut cards = Cards::open(path, "DMIG")?;
    let mut heads: Vec<Head> = Vec::new();
    while let Some(card) = cards.advance()? {
        if !card.is_head() {
            continue;
        }
        let number = |at: usize| card.fields.get(at).and_then(|field| whole(field)).unwrap_or(0);
        let name = card.name();
        if heads.iter().any(|head| head.name == name) {
            return Err(wrong(&card.place, format!("a second head of {name}"), "one for each matrix"));
        }
        heads.push(Head { name, form: number(2), kind: number(3), place: card.place.clone() });
    }
    Ok(heads)
}

fn wrong(place: &Place, found: String, expected: &str) -> Error {
    let (path, place, expected) = (place.path.to_path_buf(), format!("line {}", place.line), expected.to_owned());
    Error::MatrixFormat { path, format: FORMAT, place, found, expected: expected.into() }
}

fn read(source: &MatrixSource<'_>, head: &Head) -> Result<ReadMatrix> {
    let path = source.file.as_path();
    let unread = |found: String| {
        let (path, place) = (head.place.path.to_path_buf(), format!("line {}", head.place.line));
        let expected = "a real matrix (TIN 1 or 2) whose rows and columns are dofs (IFO 1, 2 or 6)";
        Err(Error::MatrixUnread { path, format: FORMAT, place, found, expected })
    };
    if !matches!(head.kind, 1 | 2) {
        let what = if matches!(head.kind, 3 | 4) { ", a complex matrix" } else { "" };
        return unread(format!("{} of type {}{what}", head.name, head.kind));
    }
    if !matches!(head.form, 1 | 2 | 6) {
        return unread(format!("{} of form {}", head.name, head.form));
    }
    // An entry of a symmetric matrix may come once or twice.
    let declared = if head.form == 6 { Declared::General } else { source.role.undeclared() };
    let mut entries = LabelledEntries::new(source, declared);
    let (mut rows, mut columns) = (BTreeSet::new(), BTreeSet::new());
    let mut cards = Cards::open(path, "DMIG")?;
    while let Some(card) = cards.advance()? {
        if card.is_head() || card.name() != head.name {
            continue;
        }
        let col = label(&card.place, card.fields.get(1..3).unwrap_or_default())?;
        if head.form == 2 {
            columns.insert(col);
        }
        for entry in card.fields.get(BEFORE_ENTRIES..).unwrap_or_default().chunks(PER_ENTRY) {
            if entry.iter().all(|field| field.is_empty()) {
                continue;
            }
            let row = label(&card.place, entry)?;
            let value = entry.get(2).and_then(|field| real(field));
            let Some(value) = value.filter(|value| value.is_finite()) else {
                let found = entry.get(2).map_or_else(String::new, |field| String::from_utf8_lossy(field).into_owned());
                return Err(wrong(&card.place, format!("{found:?} at {row}, column {col}"), "a finite number"));
            };
            if head.form == 2 {
                rows.insert(row);
            }
            entries.push(source, [row, col], value)?;
        }
    }
    // Columns of a rectangular matrix may be numbers of their own.
    if let Some(column) = columns.difference(&rows).next() {
        return unread(format!("{} of form 2 with a column {column} that is no row, a rectangular matrix", head.name));
    }
    if entries.is_empty() {
        return Err(wrong(&head.place, format!("{} without entries", head.name), "its columns"));
    }
    let mut read = entries.into_matrix(source, declared, cards.ending()?)?;
    if head.form == 6 {
        if source.triangle.is_none() {
            complete(&mut read.input)?;
        }
        read.input.notes.given = Given::Whole;
    }
    Ok(read)
}

/// A node and a component, from the first two fields.
fn label(place: &Place, fields: &[Vec<u8>]) -> Result<RowLabel> {
    let number = |at: usize| fields.get(at).filter(|field| !field.is_empty()).map(|field| whole(field));
    let node = number(0).flatten().filter(|node| *node > 0);
    let component = number(1).unwrap_or(Some(0)).and_then(|component| u8::try_from(component).ok());
    match node.zip(component.filter(|component| *component <= 6)) {
        Some((node, component)) => Ok(RowLabel { node, component }),
        None => {
            let found: Vec<String> =
                fields.iter().take(2).map(|field| String::from_utf8_lossy(field).into_owned()).collect();
            Err(wrong(place, format!("{found:?}"), "a node or scalar point, and a component from 0 to 6"))
        }
    }
}
