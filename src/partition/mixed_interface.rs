//! Modes with mixed boundaries: which interface dofs are held while modes are computed, and K and M of the others.
//!
//! ```text
//! K_II K_IF         internal dofs, then the interface dofs that are free, both in their order
//! K_FI K_FF         n_I + n_F
//! ```

use faer::{Mat, MatRef};

use super::interface_node::InterfaceNode;
use crate::dofs::Direction;
use crate::error::{Error, Result};
use crate::job::InterfacePart;
use crate::sparse::{SparseMatrix, principal};

/// What is held of an interface while modes are computed.
#[derive(Clone, Debug)]
pub struct MixedInterface {
    /// For each interface dof whether it is held.
    pub(super) held: Vec<bool>,
    /// K and M of the dofs that are not held; none where all or none of the interface is held, which are boundaries of their own.
    pub(crate) pencil: Option<MixedPencil>,
}

/// K and M without the rows and columns of the interface dofs that are held.
#[derive(Clone, Debug)]
pub(crate) struct MixedPencil {
    /// Dofs of the partition that are left, ascending.
    pub(crate) kept: Vec<usize>,
    /// Numbers of the interface dofs among them.
    pub(crate) free: Vec<usize>,
    /// K, n_I + n_F.
    pub(crate) stiffness: SparseMatrix,
    /// M, n_I + n_F.
    pub(crate) mass: SparseMatrix,
}

impl MixedInterface {
    /// Resolves what a job holds of its interfaces while modes are computed; K and M have the interface dofs of the nodes last.
    ///
    /// # Errors
    /// [`Error::HeldInterface`]: a direction that no node of the interface has.
    pub(super) fn new(nodes: &[InterfaceNode], held: &[InterfacePart], matrices: [&SparseMatrix; 2]) -> Result<Self> {
        let dofs = interface_dofs(nodes);
        let mut is_held = vec![false; dofs.len()];
        for job in held {
            let places = places(&dofs, job);
            if places.is_empty() {
                let mut known: Vec<String> = nodes.iter().map(|node| node.name.clone()).collect();
                known.dedup();
                return Err(Error::HeldInterface { held: job.0.clone(), known });
            }
            places.into_iter().for_each(|at| is_held[at] = true);
        }
        let is_mixed = is_held.contains(&true) && is_held.contains(&false);
        let pencil = is_mixed.then(|| MixedPencil::of(matrices, &is_held));
        Ok(Self { held: is_held, pencil })
    }
}

/// The places that a part of the job means among the names and directions of the interface dofs.
fn places(dofs: &[(&str, Option<Direction>)], held: &InterfacePart) -> Vec<usize> {
    let Some((name, direction)) = held.of(|name| dofs.iter().any(|(known, _)| *known == name)) else {
        return Vec::new();
    };
    let is_meant = |at: &usize| dofs[*at].0 == name && (direction.is_none() || dofs[*at].1 == direction);
    (0..dofs.len()).filter(is_meant).collect()
}

/// Name and direction of each interface dof; rows without a dof map have none.
fn interface_dofs(nodes: &[InterfaceNode]) -> Vec<(&str, Option<Direction>)> {
    let of_node = |node: &InterfaceNode| match node.directions.is_empty() {
        true => vec![None; node.n_nodes],
        false => node.directions.iter().map(|direction| Some(*direction)).collect(),
    };
    nodes.iter().flat_map(|node| of_node(node).into_iter().map(|direction| (node.name.as_str(), direction))).collect()
}

impl MixedPencil {
    fn of([stiffness, mass]: [&SparseMatrix; 2], held: &[bool]) -> Self {
        let n_i = stiffness.rows() - held.len();
        let free: Vec<usize> = (0..held.len()).filter(|dof| !held[*dof]).collect();
        let kept: Vec<usize> = (0..n_i).chain(free.iter().map(|dof| n_i + dof)).collect();
        let [stiffness, mass] = [stiffness, mass].map(|matrix| principal(matrix, &kept, &[]));
        Self { kept, free, stiffness, mass }
    }

    /// Motions with the dofs that are held at rest, n' × k.
    pub(super) fn whole(&self, x: MatRef<'_, f64>, n_dofs: usize) -> Mat<f64> {
        let mut whole = Mat::zeros(n_dofs, x.ncols());
        for (row, dof) in self.kept.iter().enumerate() {
            (0..x.ncols()).for_each(|j| whole[(*dof, j)] = x[(row, j)]);
        }
        whole
    }
}
