//! Cells of an XDMF document: tables of one kind, or streams in which each cell says its kind first.

use std::collections::HashSet;
use std::path::Path;

use roxmltree::Node;

use super::file::{H5, with_memory};
use super::xdmf::{parse, text_of};
use super::xdmf_reference::inside_folder;
use crate::error::{Error, Result};
use crate::input::Allowance;
use crate::input::allowance::Claim;
use crate::input::banner::excerpt;
use crate::input::cell_kind::{Kind, Known, kind};
use crate::input::faces::{Cell, Gathered, Shape};
use crate::input::hdf5::group::Group;
use crate::number::counted;
use crate::regular_file::unchanged;

/// Bytes of a number.
const NUMBER: u64 = 8;

/// Takes up the cells of all topologies of a document. Grids of a time series that refer to the same cells count as one.
pub(super) fn read(path: &Path, allowance: &Allowance, faces: &mut Gathered<'_>) -> Result<Known> {
    let text = text_of(path, &allowance.claim(path))?;
    let of_numbers = allowance.claim(path);
    let document = parse(&text, path)?;
    let mut seen = HashSet::new();
    for node in document.descendants().filter(|node| node.tag_name().name() == "Topology") {
        if node.has_attribute("Reference") {
            // It stands in the document a second time.
            continue;
        }
        let topology = match Topology::of(node) {
            Ok(topology) => topology,
            Err(what) => return Ok(Known::Not(what)),
        };
        if topology.cells == Cells::Of(Kind::Faceless) || !seen.insert((topology.kind, topology.content)) {
            continue;
        }
        let Some(numbers) = topology.numbers(path, allowance, &of_numbers)? else {
            return Ok(Known::Not("a Topology whose numbers lie outside the folder".to_owned()));
        };
        let known = match topology.cells {
            Cells::Of(Kind::Faced(cell)) => topology.add_table(faces, cell, (path, &numbers))?,
            Cells::Of(_) => Known::Not(format!("a Topology of type {}", topology.kind)),
            Cells::Mixed => topology.add_stream(faces, (path, &numbers))?,
        };
        if known != Known::All {
            return Ok(known);
        }
    }
    Ok(Known::All)
}

/// What a topology holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cells {
    Of(Kind),
    Mixed,
}

/// A `Topology` element with its one data item.
struct Topology<'a> {
    kind: &'a str,
    cells: Cells,
    is_hdf5: bool,
    content: &'a str,
    dimensions: Option<&'a str>,
    /// The number of the first node.
    first: i64,
}

impl<'a> Topology<'a> {
    /// What it is in words where it is one that is not known here.
    fn of(node: Node<'a, '_>) -> std::result::Result<Self, String> {
        let kind = node.attribute("TopologyType").or_else(|| node.attribute("Type"));
        let kind = kind.ok_or("a Topology without a type")?;
        let cells = cells_of(kind);
        if cells == Cells::Of(Kind::Unknown) {
            return Err(format!("a Topology of type {}", excerpt(kind.as_bytes())));
        }
        let offset = node.attribute("BaseOffset");
        let first = offset.map_or(Ok(0), |offset| {
            offset.trim().parse().map_err(|_| "a Topology with a BaseOffset that is no number")
        })?;
        let mut items = node.children().filter(|child| child.tag_name().name() == "DataItem");
        let (item, None) = (items.next(), items.next()) else {
            return Err("a Topology with several data items".to_owned());
        };
        let Some(item) = item else {
            // A cloud of points needs no numbers.
            let is_none = cells == Cells::Of(Kind::Faceless);
            let points = Self { kind, cells, is_hdf5: false, content: "", dimensions: None, first };
            return if is_none { Ok(points) } else { Err("a Topology without a data item".to_owned()) };
        };
        let is_uniform = item.attribute("ItemType").is_none_or(|kind| kind == "Uniform");
        if node.has_attribute("Order") || item.has_attribute("Reference") || !is_uniform {
            return Err("a Topology with an order of its own, a reference or a computed item".to_owned());
        }
        let is_hdf5 = match item.attribute("Format").unwrap_or("XML").to_ascii_uppercase().as_str() {
            "HDF" => true,
            "XML" => false,
            other => return Err(format!("a Topology in the format {}", excerpt(other.as_bytes()))),
        };
        let (content, dimensions) = (item.text().unwrap_or("").trim(), item.attribute("Dimensions"));
        Ok(Self { kind, cells, is_hdf5, content, dimensions, first })
    }

    /// All numbers of the data item; none where they lie outside the folder, where nothing is read.
    fn numbers(&self, path: &Path, allowance: &Allowance, claim: &Claim<'_>) -> Result<Option<Vec<i64>>> {
        let numbers = if self.is_hdf5 {
            let Some((file, object)) = inside_folder(path, self.content) else { return Ok(None) };
            let read = || {
                let h5 = H5::open(&file, allowance)?;
                let numbers = Group::root(&h5)?.dataset(object)?.integers()?;
                h5.keep(0)?;
                claim.set(NUMBER * numbers.len() as u64)?;
                Ok(numbers)
            };
            unchanged(&file, || with_memory(&file, read))?
        } else {
            self.numbers_of_text(path, claim)?
        };
        let stated = self.dimensions.and_then(|dimensions| {
            let factors: Option<Vec<usize>> =
                dimensions.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
            Some(factors?.iter().try_fold(1_usize, |n, d| n.checked_mul(*d)).unwrap_or(usize::MAX))
        });
        if stated.is_some_and(|stated| stated != numbers.len()) {
            let expected = format!("Dimensions {}", excerpt(self.dimensions.unwrap_or("-").as_bytes()));
            return Err(self.wrong_shape(path, numbers.len(), expected));
        }
        Ok(Some(numbers))
    }

    fn numbers_of_text(&self, path: &Path, claim: &Claim<'_>) -> Result<Vec<i64>> {
        claim.set(NUMBER * self.content.split_ascii_whitespace().count() as u64)?;
        let number = |word: &str| {
            word.parse::<i64>().map_err(|_| Error::Hdf5Type {
                path: path.to_owned(),
                object: self.source(),
                found: format!("`{}`", excerpt(word.as_bytes())),
                expected: "whole numbers",
            })
        };
        self.content.split_ascii_whitespace().map(number).collect()
    }

    fn add_table(&self, faces: &mut Gathered<'_>, cell: Cell, (path, numbers): (&Path, &[i64])) -> Result<Known> {
        if !numbers.len().is_multiple_of(cell.n_nodes()) {
            return Err(self.wrong_shape(path, numbers.len(), format!("{} for each cell", cell.n_nodes())));
        }
        for (at, nodes) in numbers.chunks_exact(cell.n_nodes()).enumerate() {
            self.add(faces, cell, (path, at * cell.n_nodes(), nodes))?;
        }
        Ok(Known::All)
    }

    fn add_stream(&self, faces: &mut Gathered<'_>, (path, numbers): (&Path, &[i64])) -> Result<Known> {
        let mut at = 0;
        while let Some(code) = numbers.get(at) {
            let (found, length) = match self.coded(*code, numbers.get(at + 1), (path, at))? {
                Coded::Cell(cell) => (Some(cell), 1 + cell.n_nodes()),
                Coded::Faceless(length) => (None, length),
                Coded::Unknown => return Ok(Known::Not(format!("cells of type {code}"))),
            };
            let Some(end) = at.checked_add(length).filter(|end| *end <= numbers.len()) else {
                let expected = format!("{length} for the cell that begins at value {at}");
                return Err(self.wrong_shape(path, numbers.len(), expected));
            };
            if let Some(cell) = found {
                self.add(faces, cell, (path, at + 1, &numbers[at + 1..end]))?;
            }
            at = end;
        }
        Ok(Known::All)
    }

    /// What a code of a stream announces; points and lines say how many nodes they have.
    fn coded(&self, code: i64, next: Option<&i64>, (path, at): (&Path, usize)) -> Result<Coded> {
        let cell = |shape, n_nodes| Cell::new(shape, n_nodes).map_or(Coded::Unknown, Coded::Cell);
        Ok(match code {
            1 | 2 => match next.and_then(|n| usize::try_from(*n).ok()) {
                Some(n) => Coded::Faceless(n.saturating_add(2)),
                None => {
                    return Err(self.wrong_shape(path, at + 1, "a number of nodes behind a point or line".to_owned()));
                }
            },
            4 => cell(Shape::Triangle, 3),
            5 => cell(Shape::Quadrilateral, 4),
            6 => cell(Shape::Tetrahedron, 4),
            7 => cell(Shape::Pyramid, 5),
            8 => cell(Shape::Wedge, 6),
            9 => cell(Shape::Brick, 8),
            34 => Coded::Faceless(4),
            35 => cell(Shape::Quadrilateral, 9),
            36 => cell(Shape::Triangle, 6),
            37 => cell(Shape::Quadrilateral, 8),
            38 => cell(Shape::Tetrahedron, 10),
            39 => cell(Shape::Pyramid, 13),
            40 => cell(Shape::Wedge, 15),
            41 => cell(Shape::Wedge, 18),
            48 => cell(Shape::Brick, 20),
            50 => cell(Shape::Brick, 27),
            // Polygons, polyhedra, bricks of 24 nodes, of higher order and spectral ones: the last numbers that a version has.
            3 | 16 | 49 | 51..=58 | 64..=71 => Coded::Unknown,
            _ => {
                let (path, object, found) = (path.to_owned(), self.source(), format!("the code {code} at value {at}"));
                return Err(Error::Hdf5Type { path, object, found, expected: "a kind of cell" });
            }
        })
    }

    fn add(&self, faces: &mut Gathered<'_>, cell: Cell, (path, at, numbers): (&Path, usize, &[i64])) -> Result<()> {
        let n = faces.n_nodes();
        let index = |(corner, number): (usize, &i64)| {
            let index = number.checked_sub(self.first).and_then(|index| usize::try_from(index).ok());
            index.filter(|index| *index < n).ok_or_else(|| Error::Hdf5Index {
                path: path.to_owned(),
                dataset: self.source(),
                position: at + corner,
                found: *number,
                first: self.first,
                last: self.first.saturating_add_unsigned(n as u64).saturating_sub(1),
            })
        };
        let nodes: Vec<usize> = numbers.iter().enumerate().map(index).collect::<Result<_>>()?;
        faces.add(cell, &nodes)
    }

    /// Where its numbers come from.
    fn source(&self) -> String {
        if self.is_hdf5 { self.content.to_owned() } else { "Topology/DataItem".to_owned() }
    }

    fn wrong_shape(&self, path: &Path, n_values: usize, expected: String) -> Error {
        let found = counted(n_values, "value", "values");
        Error::Hdf5Shape { path: path.to_owned(), object: self.source(), found, expected }
    }
}

/// What a code of a stream announces.
enum Coded {
    Cell(Cell),
    /// So many numbers with the code.
    Faceless(usize),
    Unknown,
}

/// What a topology holds, by its type: `Tetrahedron`, `Tet_10`, `Tetrahedron_10`.
fn cells_of(name: &str) -> Cells {
    let name = name.to_ascii_lowercase();
    let (shape, n_nodes) = name.split_once('_').map_or((name.as_str(), None), |(shape, n)| (shape, Some(n)));
    let of = |shape| match n_nodes {
        None => Kind::Faced(Cell::linear(shape)),
        Some(n_nodes) => n_nodes.parse().map_or(Kind::Unknown, |n_nodes| kind(shape, n_nodes)),
    };
    Cells::Of(match shape {
        "mixed" => return Cells::Mixed,
        "polyvertex" | "polyline" | "edge" => Kind::Faceless,
        "tri" | "triangle" => of(Shape::Triangle),
        "quad" | "quadrilateral" => of(Shape::Quadrilateral),
        "tet" | "tetrahedron" => of(Shape::Tetrahedron),
        "pyramid" => of(Shape::Pyramid),
        "wedge" => of(Shape::Wedge),
        "hex" | "hexahedron" => of(Shape::Brick),
        _ => Kind::Unknown,
    })
}
