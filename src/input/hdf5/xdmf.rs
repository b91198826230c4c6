//! XDMF: XML that says where in an HDF5 file the geometry lies.

use std::collections::HashSet;
use std::io::Read;
use std::path::{Path, PathBuf};

use roxmltree::{Document, Node, ParsingOptions};

use super::file::{H5, with_memory};
use super::group::Group;
use super::mesh::{Mesh, points};
use super::xdmf_attributes::node_groups;
use super::xdmf_reference::inside_folder;
use crate::error::{Error, Result};
use crate::input::Allowance;
use crate::input::allowance::Claim;
use crate::input::banner::excerpt;
use crate::input::xml_size::refuse_many_names;
use crate::number::counted;
use crate::regular_file::{self, digest, unchanged};

/// Bytes of the document and of what is made of it for each of its bytes: the text itself, its tree, its numbers.
const OF_TEXT: u64 = 3;
/// Bytes of an XDMF that holds no data of its own. Where a longer one refers to data, only its reader finds that.
const MAX_WITHOUT_DATA: u64 = 1 << 24;
/// Geometries that are quoted in a message.
const QUOTED: usize = 13;

/// Reads the one geometry of an XDMF file, and the digest of the file it refers to. Grids of a time series that refer to the same data count
/// as one.
pub(super) fn read(path: &Path, allowance: &Allowance) -> Result<(Mesh, Option<String>)> {
    let text = text_of(path, &allowance.claim(path))?;
    let document = parse(&text, path)?;
    let mut seen: HashSet<Geometry<'_>> = HashSet::new();
    let mut geometries: Vec<Geometry<'_>> = Vec::new();
    for node in document.descendants().filter(|n| n.tag_name().name() == "Geometry") {
        let geometry = Geometry::of(node, path)?;
        if seen.insert(geometry.clone()) {
            geometries.push(geometry);
        }
    }
    match geometries.as_slice() {
        [only] => {
            let (mut mesh, digest) = only.read(path, allowance)?;
            mesh.groups = node_groups(&document, (path, only.content), mesh.coordinates.len(), allowance)?;
            Ok((mesh, digest))
        }
        _ => {
            let quoted = geometries.iter().take(QUOTED);
            let found = quoted.map(|g| excerpt(g.content.trim().as_bytes())).collect();
            let object = "Xdmf/Domain/Grid/Geometry".to_owned();
            Err(Error::MeshNotOne { path: path.to_owned(), object, found, kind: "geometry" })
        }
    }
}

/// The text of the document.
pub(super) fn text_of(path: &Path, claim: &Claim<'_>) -> Result<String> {
    let failed = |source| Error::Read { path: path.to_owned(), source };
    let file = regular_file::open(path)?;
    let size = file.metadata().map_err(failed)?.len();
    claim.set(size.saturating_mul(OF_TEXT))?;
    let mut bytes = Vec::new();
    file.take(size).read_to_end(&mut bytes).map_err(failed)?;
    String::from_utf8(bytes)
        .map_err(|fault| Error::NotText { path: path.to_owned(), offset: fault.utf8_error().valid_up_to() })
}

pub(super) fn parse<'a>(text: &'a str, path: &Path) -> Result<Document<'a>> {
    refuse_many_names(text, path)?;
    // A document type that declares nothing, which is the only one that gets here, defines no entity and fetches no file.
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|source| Error::XdmfSyntax { path: path.to_owned(), source })
}

/// The files that a document refers to, as far as it can be read.
pub(super) fn referenced_files(path: &Path) -> Vec<PathBuf> {
    if std::fs::metadata(path).is_ok_and(|file| file.len() > MAX_WITHOUT_DATA) {
        return Vec::new();
    }
    let Ok(text) = text_of(path, &Allowance::of(None).claim(path)) else { return Vec::new() };
    let Ok(document) = parse(&text, path) else { return Vec::new() };
    let items = document.descendants().filter(|node| node.tag_name().name() == "DataItem");
    let mut files: Vec<PathBuf> = items.filter_map(|item| Some(inside_folder(path, item.text()?.trim())?.0)).collect();
    files.sort();
    files.dedup();
    files
}

/// The digest of the file that the geometry lies in now; none where the document has it.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn data_digest(path: &Path) -> Result<Option<String>> {
    let text = text_of(path, &Allowance::of(None).claim(path))?;
    let document = parse(&text, path)?;
    let Some(node) = document.descendants().find(|node| node.tag_name().name() == "Geometry") else { return Ok(None) };
    let geometry = Geometry::of(node, path)?;
    let file = inside_folder(path, geometry.content).filter(|_| geometry.format == "HDF");
    file.map(|(file, _)| digest(&file)).transpose()
}

/// A `Geometry` element with its one data item.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Geometry<'a> {
    n_axes: usize,
    format: String,
    /// A reference to a dataset, or the numbers themselves.
    content: &'a str,
    dimensions: Option<&'a str>,
}

impl<'a> Geometry<'a> {
    fn of(node: Node<'a, '_>, path: &Path) -> Result<Self> {
        let unsupported = |object: &str, found: &str, expected| {
            let (path, found) = (path.to_owned(), excerpt(found.as_bytes()));
            Err(Error::MeshUnsupported { path, object: object.to_owned(), found, expected })
        };
        let kind = node.attribute("GeometryType").or_else(|| node.attribute("Type")).unwrap_or("XYZ");
        let n_axes = match kind.to_ascii_uppercase().as_str() {
            "X" => 1,
            "XY" => 2,
            "XYZ" => 3,
            _ => return unsupported("Geometry", kind, "GeometryType XYZ or XY"),
        };
        let items: Vec<Node<'_, '_>> = node.children().filter(|c| c.tag_name().name() == "DataItem").collect();
        let &[item] = items.as_slice() else {
            let found = counted(items.len(), "data item", "data items");
            return unsupported("Geometry", &found, "one DataItem");
        };
        let format = item.attribute("Format").unwrap_or("XML").to_ascii_uppercase();
        if item.has_attribute("Reference")
            || item.has_attribute("ItemType") && item.attribute("ItemType") != Some("Uniform")
        {
            return unsupported(
                "Geometry/DataItem",
                "a reference or a computed item",
                "a uniform item with its own data",
            );
        }
        if format != "HDF" && format != "XML" {
            return unsupported("Geometry/DataItem", &format, "Format HDF or XML");
        }
        Ok(Self { n_axes, format, content: item.text().unwrap_or("").trim(), dimensions: item.attribute("Dimensions") })
    }

    fn read(&self, path: &Path, allowance: &Allowance) -> Result<(Mesh, Option<String>)> {
        let (values, source, digest) =
            if self.format == "HDF" { self.read_hdf5(path, allowance)? } else { self.read_text(path)? };
        let stated = self.stated_len();
        if !values.len().is_multiple_of(self.n_axes) || stated.is_some_and(|n| n != values.len()) {
            let found = counted(values.len(), "value", "values");
            let expected = format!(
                "{} for each node and Dimensions {}",
                self.n_axes,
                excerpt(self.dimensions.unwrap_or("-").as_bytes())
            );
            return Err(Error::Hdf5Shape { path: path.to_owned(), object: source, found, expected });
        }
        Ok((Mesh::of_points(points(&values, self.n_axes), source), digest))
    }

    /// Number of values by the `Dimensions` attribute; a product that overflows matches no length.
    fn stated_len(&self) -> Option<usize> {
        let dimensions: Vec<usize> =
            self.dimensions?.split_ascii_whitespace().map(str::parse).collect::<Result<_, _>>().ok()?;
        Some(dimensions.iter().try_fold(1_usize, |n, &d| n.checked_mul(d)).unwrap_or(usize::MAX))
    }

    fn read_hdf5(&self, path: &Path, allowance: &Allowance) -> Result<Values> {
        let Some((file, object)) = inside_folder(path, self.content) else {
            return Err(Error::XdmfReference { path: path.to_owned(), reference: excerpt(self.content.as_bytes()) });
        };
        let read = || {
            let h5 = H5::open(&file, allowance)?;
            Group::root(&h5)?.dataset(object)?.reals()
        };
        let (reals, digest) = unchanged(&file, || Ok((with_memory(&file, read)?, digest(&file)?)))?;
        Ok((reals.values, self.content.to_owned(), Some(digest)))
    }

    fn read_text(&self, path: &Path) -> Result<Values> {
        let source = "Geometry/DataItem";
        let number = |word: &str| {
            word.parse::<f64>().map_err(|_| Error::Hdf5Type {
                path: path.to_owned(),
                object: source.to_owned(),
                found: format!("`{}`", excerpt(word.as_bytes())),
                expected: "real numbers",
            })
        };
        let values = self.content.split_ascii_whitespace().map(number).collect::<Result<_>>()?;
        Ok((values, source.to_owned(), None))
    }
}

/// Coordinates, where they come from, and the digest of the file they come from where it is another one.
type Values = (Vec<f64>, String, Option<String>);
