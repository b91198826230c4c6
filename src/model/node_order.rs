//! Whether the rows of K and M belong to the nodes that the map gives them, as far as what they couple tells.
//!
//! Rigid-body motion, which [`crate::coordinates`] compares with K, does not see rows of one rotation at other nodes, the order of a mass,
//! or nodes at one place that were exchanged. An element couples the nodes of its cell, in all directions, by K and by M.

mod apart;
mod cells;
mod couplings;
mod directions;
mod mass;

use cells::{CellGraph, Numbers};
use couplings::Couplings;

use super::finding::Finding;
use super::node_of_row;
use crate::dofs::{Nodes, RowNames};
use crate::error::Result;
use crate::input::MeshCells;
use crate::sparse::SparseMatrix;

/// What K, M and the cells of the mesh say of it.
///
/// # Errors
/// [`crate::error::Error::MassInAnotherOrder`], [`crate::error::Error::DirectionInAnotherOrder`] and
/// [`crate::error::Error::CellsOfOthers`] where they contradict each other.
pub(super) fn compared(
    matrices: [&SparseMatrix; 2],
    (nodes, cells): (Option<&Nodes>, &[MeshCells]),
    names: RowNames<'_>,
) -> Result<Vec<Finding>> {
    let node_of = node_of_row(matrices[0].rows(), names.dofs);
    let [stiffness, mass] = matrices.map(|matrix| Couplings::of(matrix, &node_of, names.dofs));
    let mut findings: Vec<Finding> = mass::compared([&stiffness, &mass], names)?.into_iter().collect();
    for matrix in [("stiffness", &stiffness), ("mass", &mass)] {
        findings.extend(directions::compared(matrix, names)?);
    }
    if let Some((nodes, dofs)) = nodes.zip(names.dofs).filter(|_| !cells.is_empty()) {
        let by_cells = CellGraph::of(cells, &Numbers::of(nodes, dofs, &node_of));
        findings.extend(cells::compared(&stiffness, &by_cells, names)?);
    }
    Ok(findings)
}
