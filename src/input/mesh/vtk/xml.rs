//! Unstructured grids in XML (`.vtu`).

use std::io::Read;
use std::path::Path;

use roxmltree::{Document, Node, ParsingOptions};

use super::encoded::{Encoding, Numbers, numbers};
use super::pieces::{Piece, Pieces, Tags};
use crate::error::{Error, Result};
use crate::input::Allowance;
use crate::input::allowance::Claim;
use crate::input::banner::excerpt;
use crate::input::file_start::FileStart;
use crate::input::format::Sureness;
use crate::input::fortran;
use crate::input::mesh::cell_mesh::CellMesh;
use crate::input::raw_numbers::Endian;
use crate::input::source::{Source, read_error};
use crate::input::xml_size::refuse_many_names;

/// Bytes of what is made of each byte of the file.
const OF_BYTE: u64 = 8;
/// Bytes read at once.
const CHUNK: usize = 1 << 20;

/// Whether a file is a grid in XML.
pub(in crate::input::mesh) fn sureness(start: &FileStart<'_>) -> Sureness {
    match () {
        () if start.holds(b"<VTKFile") => Sureness::Certain,
        () if start.has_extension(&["vtu"]) => Sureness::Named,
        () => Sureness::Unlikely,
    }
}

/// A document with the bytes behind it.
struct Reader<'a> {
    path: &'a Path,
    document: &'a Document<'a>,
    encoding: Encoding<'a>,
    /// Data that arrays refer to by their offset, and whether they are base64.
    appended: (&'a [u8], bool),
}

/// Reads all pieces of a grid.
pub(in crate::input::mesh) fn read(path: &Path, allowance: &Allowance) -> Result<CellMesh> {
    let bytes = bytes_of(path, &allowance.claim(path))?;
    let (text, appended) = split(&bytes);
    let text = String::from_utf8(text)
        .map_err(|fault| Error::NotText { path: path.to_owned(), offset: fault.utf8_error().valid_up_to() })?;
    refuse_many_names(&text, path)?;
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&text, options)
        .map_err(|source| Error::XdmfSyntax { path: path.to_owned(), source })?;
    let root = document.root_element();
    let wrong = |found: &str, expected: &str| {
        let (found, expected) = (format!("`{}`", excerpt(found.as_bytes())), expected.to_owned());
        Error::MeshText { path: path.to_owned(), line: 1, found, expected }
    };
    if root.attribute("type") != Some("UnstructuredGrid") {
        return Err(wrong(root.attribute("type").unwrap_or_default(), "a VTKFile of type UnstructuredGrid"));
    }
    let header = match root.attribute("header_type") {
        None | Some("UInt32") => 4,
        Some("UInt64") => 8,
        Some(other) => return Err(wrong(other, "header_type UInt32 or UInt64")),
    };
    let endian = if root.attribute("byte_order") == Some("BigEndian") { Endian::Big } else { Endian::Little };
    let encoding = Encoding { header, endian, compressor: root.attribute("compressor") };
    let reader = Reader { path, document: &document, encoding, appended };
    let mut pieces = Pieces::default();
    for node in document.descendants().filter(|node| node.has_tag_name("Piece")) {
        let piece = reader.piece(node)?;
        pieces.add(piece).map_err(|(found, expected)| reader.error(node, found, expected))?;
    }
    if pieces.points.is_empty() {
        return Err(Error::NoData { path: path.to_owned(), expected: "a Piece with Points" });
    }
    Ok(pieces.into_mesh())
}

fn bytes_of(path: &Path, claim: &Claim<'_>) -> Result<Vec<u8>> {
    let mut source = Source::open(path)?;
    let mut bytes = Vec::new();
    loop {
        claim.set(OF_BYTE * (bytes.len() + CHUNK) as u64)?;
        let read = source.by_ref().take(CHUNK as u64).read_to_end(&mut bytes);
        if read.map_err(|error| read_error(path, error))? == 0 {
            return Ok(bytes);
        }
    }
}

/// The document without appended data, and these from behind their underscore, with whether they are base64.
fn split(bytes: &[u8]) -> (Vec<u8>, (&[u8], bool)) {
    const OPEN: &[u8] = b"<AppendedData";
    let find = |from: usize, mark: &[u8]| {
        let at = bytes[from..].windows(mark.len()).position(|window| window == mark);
        at.map(|at| from + at)
    };
    let Some(open) = find(0, OPEN) else { return (bytes.to_vec(), (&[], false)) };
    let tag_end = find(open, b">").unwrap_or(bytes.len());
    let is_base64 = bytes[open..tag_end].windows(6).any(|window| window == b"base64");
    let start = find(tag_end, b"_").map_or(bytes.len(), |at| at + 1);
    let mut text = bytes[..open].to_vec();
    text.extend_from_slice(b"</VTKFile>");
    (text, (&bytes[start..], is_base64))
}

impl Reader<'_> {
    fn error(&self, node: Node<'_, '_>, found: impl Into<String>, expected: impl Into<String>) -> Error {
        let line = self.document.text_pos_at(node.range().start).row.into();
        Error::MeshText { path: self.path.to_owned(), line, found: found.into(), expected: expected.into() }
    }

    fn piece(&self, node: Node<'_, '_>) -> Result<Piece> {
        let child = |name: &str| node.children().find(|child| child.has_tag_name(name));
        let points = child("Points").and_then(|points| points.children().find(|child| child.has_tag_name("DataArray")));
        let Some(points) = points else {
            return Err(self.error(node, "a Piece without Points", "Points with a DataArray"));
        };
        let mut piece = Piece { points: self.reals(points)?, ..Piece::default() };
        for array in child("Cells").iter().flat_map(Node::children).filter(|child| child.has_tag_name("DataArray")) {
            let Numbers::Whole(values) = self.numbers(array)? else {
                return Err(self.error(array, "real numbers", "whole numbers"));
            };
            match array.attribute("Name") {
                Some("connectivity") => piece.connectivity = values,
                Some("offsets") => piece.offsets = values,
                Some("types") => piece.types = values,
                // What polyhedra need in addition.
                _ => {}
            }
        }
        self.check_count(node, "NumberOfPoints", piece.points.len() / 3)?;
        self.check_count(node, "NumberOfCells", piece.types.len())?;
        piece.point_tags = self.tags(child("PointData"))?;
        piece.cell_tags = self.tags(child("CellData"))?;
        Ok(piece)
    }

    /// Makes sure that a piece has as many points or cells as it says, where it says so.
    fn check_count(&self, node: Node<'_, '_>, attribute: &str, n: usize) -> Result<()> {
        match node.attribute(attribute) {
            Some(stated) if stated.trim().parse() != Ok(n) => {
                let found = format!("{attribute}=\"{}\" and {n} of them", excerpt(stated.as_bytes()));
                Err(self.error(node, found, "as many as the piece says"))
            }
            _ => Ok(()),
        }
    }

    /// The arrays of whole numbers, one for each item.
    fn tags(&self, data: Option<Node<'_, '_>>) -> Result<Tags> {
        let mut tags = Tags::new();
        for array in data.iter().flat_map(Node::children).filter(|child| child.has_tag_name("DataArray")) {
            let is_whole = array.attribute("type").is_some_and(|kind| kind.contains("Int"));
            let is_single = array.attribute("NumberOfComponents").is_none_or(|n| matches!(n, "0" | "1"));
            if let (true, true, Some(name), Numbers::Whole(values)) =
                (is_whole, is_single, array.attribute("Name"), self.numbers(array)?)
            {
                tags.insert(name.to_owned(), values);
            }
        }
        Ok(tags)
    }

    fn reals(&self, array: Node<'_, '_>) -> Result<Vec<f64>> {
        Ok(match self.numbers(array)? {
            Numbers::Real(values) => values,
            Numbers::Whole(values) => values.into_iter().map(|value| value as f64).collect(),
        })
    }

    fn numbers(&self, array: Node<'_, '_>) -> Result<Numbers> {
        let kind = array.attribute("type").unwrap_or_default();
        let text = array.text().unwrap_or_default();
        let (bytes, expected) = match array.attribute("format").unwrap_or("ascii") {
            "ascii" => return self.of_text(array, kind, text),
            "binary" if text.trim().is_empty() => (Ok(Vec::new()), "base64"),
            "binary" => (self.encoding.of_base64(text.as_bytes()), "base64"),
            "appended" => {
                let offset = array.attribute("offset").and_then(|offset| offset.trim().parse::<usize>().ok());
                let data = offset.and_then(|offset| self.appended.0.get(offset..));
                let data =
                    data.ok_or_else(|| self.error(array, "an offset beyond the data", "an offset into AppendedData"))?;
                let end = data.iter().position(|byte| *byte == b'<').unwrap_or(data.len());
                let bytes =
                    if self.appended.1 { self.encoding.of_base64(&data[..end]) } else { self.encoding.of_bytes(data) };
                (bytes, "data of the array")
            }
            other => {
                return Err(self.error(
                    array,
                    format!("the format {}", excerpt(other.as_bytes())),
                    "ascii, binary or appended",
                ));
            }
        };
        if let Some(name) = self.encoding.unread_compressor().filter(|_| !bytes.as_ref().is_ok_and(Vec::is_empty)) {
            return Err(self.packed(array, name));
        }
        let bytes = bytes.map_err(|found| self.error(array, found, expected))?;
        let found = numbers(&bytes, kind, self.encoding.endian);
        found.ok_or_else(|| {
            let found = format!("{} bytes of type {}", bytes.len(), excerpt(kind.as_bytes()));
            self.error(array, found, "a whole number of values of a type of VTK")
        })
    }

    /// The error of arrays that a compressor packed which is not read.
    fn packed(&self, array: Node<'_, '_>, compressor: &str) -> Error {
        let line = self.document.text_pos_at(array.range().start).row.into();
        let found = format!("an array that {} packed", excerpt(compressor.as_bytes()));
        let advice = "write the mesh again with vtkZLibDataCompressor (zlib) or without a compressor";
        Error::DeckUnsupported { path: self.path.to_owned(), line, found, advice }
    }

    fn of_text(&self, array: Node<'_, '_>, kind: &str, text: &str) -> Result<Numbers> {
        let wrong =
            |word: &str| self.error(array, format!("`{}`", excerpt(word.as_bytes())), format!("values of type {kind}"));
        if kind.starts_with("Float") {
            let value = |word: &str| fortran::real(word.as_bytes()).ok_or_else(|| wrong(word));
            return Ok(Numbers::Real(text.split_ascii_whitespace().map(value).collect::<Result<_>>()?));
        }
        let value = |word: &str| word.parse().map_err(|_| wrong(word));
        Ok(Numbers::Whole(text.split_ascii_whitespace().map(value).collect::<Result<_>>()?))
    }
}
