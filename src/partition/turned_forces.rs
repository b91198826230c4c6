//! What the internal forces of a preloaded state add to the stiffness where rigid patches turn their arms.
//!
//! ```text
//! u_i = t + (exp θ̃ − I) r_i                          a node of a patch, r_i from the node of the patch to it
//! K_θθ += Σ ½ (r_i f_iᵀ + f_i r_iᵀ) − (r_i·f_i) I     of the forces f_i at the nodes, 3 × 3
//! ```
//! This is the second derivative of Σ f_i · u_i = Σ f_i · (t + θ × r_i + ½ θ × (θ × r_i) + …). TᵀKT has nodes that move along straight lines.
//! Moments add nothing, for the rotation vectors of the nodes are that of the patch. A carrier is the node of a rigid patch, too.

use super::interface_node::{Interfaces, NodeNames, Resolved, Rows};
use super::transformation::{DofOrigin, Transformation};
use crate::dofs::Direction;
use crate::error::{Error, Result};
use crate::model::{Model, Site};
use crate::sparse::{Declared, SparseMatrix, Triplets};

/// The rotations of a node.
const ROTATIONS: [Direction; 3] = [Direction::Rx, Direction::Ry, Direction::Rz];

/// Terms of the stiffness between two rotations of the node of a patch.
pub(super) struct TurnedForces(Vec<([Rotation; 2], f64)>);

/// A rotation of an interface node, by its number.
type Rotation = (usize, Direction);

impl TurnedForces {
    /// Those of the internal forces of a model, none where it has none; rotations that are no dof are at rest.
    ///
    /// # Errors
    /// [`Error::PreloadCarried`].
    pub(super) fn of(model: &Model, interfaces: &Interfaces, transformation: &Transformation) -> Result<Self> {
        let (Some(forces), Some(sites)) = (&model.internal_forces, model.sites()) else { return Ok(Self(Vec::new())) };
        let moves = |node: usize, direction: Direction| {
            transformation.dofs.iter().any(|dof| dof.origin == DofOrigin::PatchNode(node, direction))
        };
        let mut terms = Vec::new();
        for (index, resolved) in interfaces.list.iter().enumerate() {
            let Some((rows, node)) = turned(index, resolved) else { continue };
            let position = interfaces.list[node].node.position.unwrap_or_default();
            let of_row = |row: &usize| Some((sites[*row]?, forces[*row])).filter(|(_, force)| *force != 0.0);
            let of_rows: Vec<(Site, f64)> = rows.iter().filter_map(of_row).collect();
            if node != index && !of_rows.is_empty() && ROTATIONS.into_iter().any(|rotation| moves(index, rotation)) {
                let name = |index: usize| interfaces.list[index].node.name.clone();
                return Err(Error::PreloadCarried { interface: name(index), carrier: name(node) });
            }
            let stiffness = stiffness(&of_rows, position);
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                if moves(node, ROTATIONS[i]) && moves(node, ROTATIONS[j]) {
                    terms.push(([i, j].map(|axis| (node, ROTATIONS[axis])), stiffness[i][j]));
                }
            }
        }
        Ok(Self(terms))
    }

    /// A stiffness on the dofs of a partition with these terms.
    ///
    /// # Errors
    /// [`Error::PreloadDependent`] where constraints let one of the rotations follow other dofs.
    pub(super) fn added_to(
        &self,
        stiffness: SparseMatrix,
        transformation: &Transformation,
        names: NodeNames<'_>,
    ) -> Result<SparseMatrix> {
        if self.0.is_empty() {
            return Ok(stiffness);
        }
        let mut triplets = Triplets::default();
        for ([row, column], value) in &self.0 {
            let place = |(node, direction): Rotation| {
                let origin = DofOrigin::PatchNode(node, direction);
                let found = transformation.dofs.iter().position(|dof| dof.origin == origin);
                found
                    .ok_or_else(|| Error::PreloadDependent { dof: format!("interface {} {direction}", names.of(node)) })
            };
            triplets.push(place(*row)? as u32, place(*column)? as u32, *value);
        }
        let (added, _) = triplets.assemble(stiffness.rows(), Declared::Whole, "internal forces".as_ref())?;
        Ok(sprs::binop::csmat_binop(stiffness.view(), added.view(), |a, b| a + b))
    }
}

/// The rows that a rigid body moves, and the place of its node among the interfaces.
fn turned(index: usize, resolved: &Resolved) -> Option<(&[usize], usize)> {
    match (&resolved.rows, resolved.carrier) {
        (Rows::Patch(rows), carrier) => Some((rows, carrier.unwrap_or(index))),
        (Rows::Own(rows), Some(carrier)) => Some((rows, carrier)),
        (Rows::Own(_), None) | (Rows::Average { .. }, _) => None,
    }
}

/// The sum over rows, each with a component of a force.
fn stiffness(rows: &[(Site, f64)], centre: [f64; 3]) -> [[f64; 3]; 3] {
    let mut sum = [[0.0; 3]; 3];
    for (site, force) in rows.iter().filter(|(site, _)| !site.direction.is_rotation()) {
        let (axis, arm): (usize, [f64; 3]) =
            (site.direction.axis(), std::array::from_fn(|i| site.position[i] - centre[i]));
        for i in 0..3 {
            // Along the force both halves fall on the diagonal.
            sum[i][axis] += 0.5 * force * arm[i];
            sum[axis][i] += 0.5 * force * arm[i];
            sum[i][i] -= force * arm[axis];
        }
    }
    sum
}
