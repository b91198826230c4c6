//! XDMF: XML that says where in an HDF5 file the geometry lies.

use std::fs;
use std::path::{Component, Path, PathBuf};

use roxmltree::{Document, Node};

use super::file::H5;
use super::mesh::{Mesh, points};
use crate::error::{Error, Result};

/// Reads the one geometry of an XDMF file. Grids of a time series that refer to the same data count as one.
pub(super) fn read(path: &Path) -> Result<Mesh> {
    let text = fs::read_to_string(path).map_err(|source| Error::Read { path: path.to_owned(), source })?;
    let document = Document::parse(&text).map_err(|source| Error::XdmfSyntax { path: path.to_owned(), source })?;
    let mut geometries: Vec<Geometry<'_>> = Vec::new();
    for node in document.descendants().filter(|n| n.tag_name().name() == "Geometry") {
        let geometry = Geometry::of(node, path)?;
        if !geometries.contains(&geometry) {
            geometries.push(geometry);
        }
    }
    match geometries.as_slice() {
        [only] => only.read(path),
        _ => {
            let found = geometries.iter().map(|g| g.content.trim().chars().take(60).collect()).collect();
            let object = "Xdmf/Domain/Grid/Geometry".to_owned();
            Err(Error::MeshNotOne { path: path.to_owned(), object, found, kind: "geometry" })
        }
    }
}

/// A `Geometry` element with its one data item.
#[derive(PartialEq, Eq)]
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
            let (path, found) = (path.to_owned(), found.to_owned());
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
            let found = format!("{} data items", items.len());
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

    fn read(&self, path: &Path) -> Result<Mesh> {
        let (values, source) = if self.format == "HDF" { self.read_hdf5(path)? } else { self.read_text(path)? };
        let stated = self.stated_len();
        if !values.len().is_multiple_of(self.n_axes) || stated.is_some_and(|n| n != values.len()) {
            let found = format!("{} values", values.len());
            let expected = format!("{} for each node and Dimensions {}", self.n_axes, self.dimensions.unwrap_or("-"));
            return Err(Error::Hdf5Shape { path: path.to_owned(), object: source, found, expected });
        }
        Ok(Mesh::of_points(points(&values, self.n_axes), source))
    }

    /// Number of values by the `Dimensions` attribute; a product that overflows matches no length.
    fn stated_len(&self) -> Option<usize> {
        let dimensions: Vec<usize> =
            self.dimensions?.split_ascii_whitespace().map(str::parse).collect::<Result<_, _>>().ok()?;
        Some(dimensions.iter().try_fold(1_usize, |n, &d| n.checked_mul(d)).unwrap_or(usize::MAX))
    }

    fn read_hdf5(&self, path: &Path) -> Result<(Vec<f64>, String)> {
        let Some((file, object)) = inside_folder(path, self.content) else {
            return Err(Error::XdmfReference { path: path.to_owned(), reference: self.content.to_owned() });
        };
        let h5 = H5::open(&file)?;
        let values = h5.root()?.dataset(object)?.reals()?.values;
        Ok((values, self.content.to_owned()))
    }

    fn read_text(&self, path: &Path) -> Result<(Vec<f64>, String)> {
        let source = "Geometry/DataItem";
        let number = |word: &str| {
            word.parse::<f64>().map_err(|_| Error::Hdf5Type {
                path: path.to_owned(),
                object: source.to_owned(),
                found: format!("`{word}`"),
                expected: "real numbers",
            })
        };
        let values = self.content.split_ascii_whitespace().map(number).collect::<Result<_>>()?;
        Ok((values, source.to_owned()))
    }
}

/// The file and the path in it, if the reference is `file:/path` and the file lies in the folder of the XDMF or below.
fn inside_folder<'a>(path: &Path, reference: &'a str) -> Option<(PathBuf, &'a str)> {
    let (file, object) = reference.rsplit_once(":/")?;
    let file = Path::new(file);
    let inside = file.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
    // A backslash or a second colon would leave the folder on some systems.
    let portable = !reference.contains(['\\']) && !file.to_string_lossy().contains(':');
    let named = file.file_name().is_some() && !object.is_empty();
    (inside && portable && named).then(|| (path.parent().unwrap_or(Path::new("")).join(file), object))
}
