//! The old files of VTK (`.vtk`): an unstructured grid in text or binary.

use std::path::Path;

use super::pieces::{Piece, Pieces, Tags};
use crate::error::{Error, Result};
use crate::input::Allowance;
use crate::input::allowance::Claim;
use crate::input::banner::excerpt;
use crate::input::file_start::FileStart;
use crate::input::format::Sureness;
use crate::input::mesh::cell_mesh::CellMesh;
use crate::input::mesh::stream::{Form, Stream};

/// Bytes that a number takes in the mesh that is made of it.
const NUMBER: u64 = 24;
/// Numbers after which their memory is claimed.
const NUMBERS_PER_CLAIM: usize = 1 << 12;

/// Whether a file is one of VTK.
pub(in crate::input::mesh) fn sureness(start: &FileStart<'_>) -> Sureness {
    let begins = start.head.to_ascii_lowercase().starts_with(b"# vtk datafile");
    if begins { Sureness::Certain } else { Sureness::Unlikely }
}

struct Reader<'a> {
    stream: Stream,
    /// How arrays are written; everything else is text.
    form: Form,
    /// Cells are two arrays, as since version 5.
    has_offsets: bool,
    claim: Claim<'a>,
    piece: Piece,
    /// Values of an array that do not matter end here.
    values: Vec<f64>,
}

/// Whose arrays come.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Owner {
    Points,
    Cells,
    Field,
}

/// Reads an unstructured grid.
pub(in crate::input::mesh) fn read(path: &Path, allowance: &Allowance) -> Result<CellMesh> {
    let mut stream = Stream::open(path)?;
    let banner = stream.next_line("# vtk DataFile Version")?;
    let has_offsets = version(&banner).is_some_and(|version| version >= 5.0);
    stream.rest_of_line()?;
    let form = match stream.next_line("ASCII or BINARY")?.to_ascii_uppercase().as_slice() {
        b"ASCII" => Form::Text,
        b"BINARY" => Form::BigEndian,
        other => return Err(stream.error(format!("`{}`", excerpt(other)), "ASCII or BINARY")),
    };
    let kind = stream.next_line("DATASET UNSTRUCTURED_GRID")?;
    if !kind.eq_ignore_ascii_case(b"DATASET UNSTRUCTURED_GRID") {
        let (path, line) = (path.to_owned(), stream.line() - 1);
        let found = format!("`{}`", excerpt(&kind));
        return Err(Error::DeckUnsupported { path, line, found, advice: "write an unstructured grid" });
    }
    let claim = allowance.claim(path);
    let mut reader = Reader { stream, form, has_offsets, claim, piece: Piece::default(), values: Vec::new() };
    reader.sections()?;
    if reader.piece.points.is_empty() {
        return Err(Error::NoData { path: path.to_owned(), expected: "points below POINTS" });
    }
    let mut pieces = Pieces::default();
    pieces.add(reader.piece).map_err(|(found, expected)| reader.stream.error(found, expected))?;
    Ok(pieces.into_mesh())
}

/// The version that the first line states.
fn version(banner: &[u8]) -> Option<f64> {
    String::from_utf8_lossy(banner).split_ascii_whitespace().last()?.parse().ok()
}

impl Reader<'_> {
    fn sections(&mut self) -> Result<()> {
        let mut owner = Owner::Field;
        let mut n_items = 0;
        while let Some(line) = self.stream.rest_of_line()? {
            let text = String::from_utf8_lossy(&line).into_owned();
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            let Some((first, rest)) = words.split_first() else { continue };
            match first.to_ascii_uppercase().as_str() {
                "POINTS" => {
                    let n = self.number(rest.first(), "POINTS n type")?;
                    self.reals(n.saturating_mul(3), rest.get(1).copied().unwrap_or_default())?;
                    self.piece.points = std::mem::take(&mut self.values);
                }
                "CELLS" => self.cells(rest)?,
                "CELL_TYPES" => {
                    let n = self.number(rest.first(), "CELL_TYPES n")?;
                    self.piece.types = self.ints(n, "int")?;
                }
                "POINT_DATA" | "CELL_DATA" => {
                    n_items = self.number(rest.first(), "the number of points or cells")?;
                    owner = if first.eq_ignore_ascii_case("POINT_DATA") { Owner::Points } else { Owner::Cells };
                }
                "SCALARS" => {
                    let n_each = rest.get(2).map_or(Ok(1), |_| self.number(rest.get(2), "SCALARS name type n"))?;
                    let line = self.stream.next_line("LOOKUP_TABLE name")?;
                    if !line.to_ascii_uppercase().starts_with(b"LOOKUP_TABLE") {
                        return Err(self.stream.error(format!("`{}`", excerpt(&line)), "LOOKUP_TABLE name"));
                    }
                    self.array(owner, rest, n_items.saturating_mul(n_each))?;
                }
                "VECTORS" | "NORMALS" => self.array(owner, rest, n_items.saturating_mul(3))?,
                "TENSORS" => self.array(owner, rest, n_items.saturating_mul(9))?,
                "FIELD" => self.field(owner, rest)?,
                "METADATA" => while self.stream.rest_of_line()?.is_some_and(|line| !line.is_empty()) {},
                "LOOKUP_TABLE" | "TEXTURE_COORDINATES" | "COLOR_SCALARS" => break,
                _ => {
                    return Err(self
                        .stream
                        .error(format!("`{}`", excerpt(&line)), "a section of an unstructured grid"));
                }
            }
        }
        Ok(())
    }

    /// `CELLS n size`: a count before the points of each cell; since version 5 offsets and points in two arrays.
    fn cells(&mut self, words: &[&str]) -> Result<()> {
        const EXPECTED: &str = "CELLS n size";
        let (n, size) = (self.number(words.first(), EXPECTED)?, self.number(words.get(1), EXPECTED)?);
        if !self.has_offsets {
            let numbers = self.ints(size, "int")?;
            return self.counted_cells(&numbers);
        }
        for (name, n) in [("OFFSETS", n), ("CONNECTIVITY", size)] {
            let line = self.stream.next_line(name)?;
            let text = String::from_utf8_lossy(&line).to_ascii_lowercase();
            let kind = text.split_ascii_whitespace().nth(1).unwrap_or_default().to_owned();
            let values = self.ints(n, &kind)?;
            if name == "OFFSETS" { self.piece.offsets = values } else { self.piece.connectivity = values }
        }
        Ok(())
    }

    fn counted_cells(&mut self, numbers: &[i64]) -> Result<()> {
        let mut at = 0;
        while let Some(n) = numbers.get(at) {
            let points = usize::try_from(*n).ok().and_then(|n| numbers.get(at + 1..(at + 1).checked_add(n)?));
            let Some(points) = points else {
                return Err(self.stream.error(format!("a cell of {n} points"), "cells that fill the section CELLS"));
            };
            self.piece.connectivity.extend(points);
            self.piece.offsets.push(self.piece.connectivity.len() as i64);
            at += 1 + points.len();
        }
        Ok(())
    }

    /// `FIELD name n`: n arrays, each below a line with its name, numbers each, items and type.
    fn field(&mut self, owner: Owner, words: &[&str]) -> Result<()> {
        const EXPECTED: &str = "name, numbers each, items and type of an array";
        let n = self.number(words.get(1), "FIELD name n")?;
        for _ in 0..n {
            let line = loop {
                let line = self.stream.next_line(EXPECTED)?;
                if !line.to_ascii_uppercase().starts_with(b"METADATA") {
                    break line;
                }
                while self.stream.rest_of_line()?.is_some_and(|line| !line.is_empty()) {}
            };
            let text = String::from_utf8_lossy(&line).into_owned();
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            let [name, each, items, kind] = words[..] else {
                return Err(self.stream.error(format!("`{}`", excerpt(&line)), EXPECTED));
            };
            let n = self.number(Some(&each), EXPECTED)?.saturating_mul(self.number(Some(&items), EXPECTED)?);
            self.array(owner, &[name, kind], n)?;
        }
        Ok(())
    }

    /// The values of an array whose name and type are given; whole numbers are kept.
    fn array(&mut self, owner: Owner, words: &[&str], n: usize) -> Result<()> {
        let [name, kind, ..] = words else { return Err(self.stream.error("an array", "its name and its type")) };
        let (name, kind) = (name.replace("%20", " "), kind.to_ascii_lowercase());
        if kind == "string" {
            for _ in 0..n {
                self.stream.next_line("a text")?;
            }
            return Ok(());
        }
        if matches!(kind.as_str(), "float" | "double") {
            self.reals(n, &kind)?;
            self.values.clear();
            return Ok(());
        }
        let values = self.ints(n, &kind)?;
        let tags: Option<&mut Tags> = match owner {
            Owner::Points => Some(&mut self.piece.point_tags),
            Owner::Cells => Some(&mut self.piece.cell_tags),
            Owner::Field => None,
        };
        if let Some(tags) = tags {
            tags.insert(name, values);
        }
        Ok(())
    }

    fn number(&self, word: Option<&&str>, expected: &str) -> Result<usize> {
        let number = word.and_then(|word| word.parse().ok());
        number.ok_or_else(|| self.stream.error(format!("`{}`", word.map_or("", |word| word)), expected))
    }

    fn reals(&mut self, n: usize, kind: &str) -> Result<()> {
        const EXPECTED: &str = "as many numbers as the section states";
        self.stream.form = self.form;
        let is_single = self.form != Form::Text && kind.eq_ignore_ascii_case("float");
        self.values.clear();
        for at in 0..n {
            if at % NUMBERS_PER_CLAIM == 0 {
                self.claim.add(NUMBER * NUMBERS_PER_CLAIM as u64)?;
            }
            let value = match is_single {
                true => f32::from_be_bytes(self.stream.bytes(EXPECTED)?).into(),
                false => self.stream.any_real(EXPECTED)?,
            };
            self.values.push(value);
        }
        self.stream.form = Form::Text;
        Ok(())
    }

    fn ints(&mut self, n: usize, kind: &str) -> Result<Vec<i64>> {
        const EXPECTED: &str = "as many whole numbers as the section states";
        self.stream.form = self.form;
        let mut values = Vec::new();
        for at in 0..n {
            if at % NUMBERS_PER_CLAIM == 0 {
                self.claim.add(NUMBER * NUMBERS_PER_CLAIM as u64)?;
            }
            let value = match (self.form, kind) {
                (Form::Text, _) => self.stream.long(EXPECTED)?,
                (_, "char" | "signed_char" | "vtktypeint8") => i8::from_be_bytes(self.stream.bytes(EXPECTED)?).into(),
                (_, "unsigned_char" | "bit" | "vtktypeuint8") => u8::from_be_bytes(self.stream.bytes(EXPECTED)?).into(),
                (_, "short" | "vtktypeint16") => i16::from_be_bytes(self.stream.bytes(EXPECTED)?).into(),
                (_, "unsigned_short" | "vtktypeuint16") => u16::from_be_bytes(self.stream.bytes(EXPECTED)?).into(),
                (_, "int" | "vtktypeint32") => self.stream.int(EXPECTED)?,
                (_, "unsigned_int" | "vtktypeuint32") => u32::from_be_bytes(self.stream.bytes(EXPECTED)?).into(),
                (_, "long" | "unsigned_long" | "vtktypeint64" | "vtktypeuint64" | "vtkidtype") => {
                    if kind == "vtkidtype" { self.stream.int(EXPECTED)? } else { self.stream.long(EXPECTED)? }
                }
                _ => {
                    return Err(self
                        .stream
                        .error(format!("values of type {}", excerpt(kind.as_bytes())), "a type of VTK"));
                }
            };
            values.push(value);
        }
        self.stream.form = Form::Text;
        Ok(values)
    }
}
