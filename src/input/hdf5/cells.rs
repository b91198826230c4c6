//! Cells of a mesh in one of the formats that live in HDF5, as far as the faces of patches need them.
//!
//! A mesh with cells of a kind that is not known here, polygons and polyhedra among them, tells nothing of outer faces: then no face
//! is known, and the report says which kind it is. Neither is one of Exodus and of an `.hmf`, whose kinds of cells are texts of
//! attributes, which are not read: of their tables of cells it is known which nodes each cell has.

use super::dataset::Dataset;
use super::group::Group;
use crate::error::{Error, Result};
use crate::input::cell_kind::{Kind, Known};
use crate::input::faces::{Cell, Gathered};
use crate::number::counted;

/// The groups of `kinds` with what each of them holds by `kind_of` its name, or the one that is unknown.
pub(super) fn known_groups<'a>(
    kinds: Option<Group<'a>>,
    kind_of: fn(&str) -> Kind,
) -> Result<std::result::Result<Vec<(Group<'a>, Cell)>, Known>> {
    let mut known = Vec::new();
    for group in kinds.map(|kinds| kinds.groups()).transpose()?.unwrap_or_default() {
        let name = group.name();
        let name = name.rsplit('/').next().unwrap_or_default();
        match kind_of(name) {
            Kind::Faced(cell) => known.push((group, cell)),
            Kind::Faceless => {}
            Kind::Unknown => return Ok(Err(Known::Not(format!("cells of type {name}")))),
        }
    }
    Ok(Ok(known))
}

/// Takes up cells from the numbers of their nodes; `position` tells where node k of cell c stands, `first` is the number of the first
/// node.
pub(super) fn add(
    faces: &mut Gathered<'_>,
    (dataset, numbers): (&Dataset<'_>, &[i64]),
    cell: Cell,
    (first, position): (i64, impl Fn(usize, usize) -> usize),
) -> Result<()> {
    let mut nodes = vec![0; cell.n_nodes()];
    for at in 0..numbers.len() / cell.n_nodes() {
        for (corner, node) in nodes.iter_mut().enumerate() {
            let position = position(at, corner);
            *node = dataset.checked_index(position, numbers[position], first, faces.n_nodes())?;
        }
        faces.add(cell, &nodes)?;
    }
    Ok(())
}

/// Fewer nodes are a point or a line, which are no cells.
const LEAST_NODES: usize = 3;

/// Takes up a table with one row of nodes for each cell, of a kind that is not read; `first` is the number of the first node. Without
/// rows of one length, as polyhedra have none, it is no such table.
pub(super) fn add_table(cells: &mut Gathered<'_>, table: &Dataset<'_>, first: i64) -> Result<()> {
    let [_, n_each] = table.shape()?[..] else { return Ok(()) };
    if n_each < LEAST_NODES {
        return Ok(());
    }
    let nodes = table.checked_indices(first, cells.n_nodes())?;
    cells.add_table(n_each, &nodes)
}

/// The error for numbers that do not fill cells, or not as many as the file states.
pub(super) fn unfilled(dataset: &Dataset<'_>, n_values: usize, (cell, stated): (Cell, Option<i64>)) -> Error {
    let each = match stated {
        Some(stated) => format!("{} for each of the {stated} cells that the attribute NBR states", cell.n_nodes()),
        None => format!("{} for each cell", cell.n_nodes()),
    };
    dataset.wrong_shape(counted(n_values, "value", "values"), each)
}
