//! Forces of a pressure on faces of the mesh, consistent with the displacements between their nodes.

use super::node_catalogue::NodeCatalogue;
use crate::dense;
use crate::dofs::{Direction, Dof};
use crate::error::{Error, Result};
use crate::input::{Faces, PatchFaces, area_vectors};
use crate::job::{LoadJob, NodeSelection};
use crate::model::Model;

/// What rounding leaves of a force across a face, relative to the force on the face: sums of sixteen products of a few roundings each.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The forces of a pressure on all rows of a model, and the number of faces that it acts on.
///
/// # Errors
/// [`Error::LoadWithoutFaces`]; [`Error::DofMissing`] where a node of a face lacks a direction of its force; nodes that do not exist or
/// have no rows, a selection without nodes.
pub(super) fn pressed(
    model: &Model,
    catalogue: &NodeCatalogue,
    (job, nodes, pressure): (&LoadJob, &NodeSelection, f64),
    known: &[PatchFaces],
) -> Result<(Vec<f64>, usize)> {
    let selection = job.selection(nodes);
    let labels = catalogue.select(model, &selection)?;
    let found = known.iter().find(|patch| patch.of == selection.selector).map(|patch| &patch.faces);
    let without = |found: &str| Error::LoadWithoutFaces { load: job.name.clone(), found: found.to_owned() };
    let faces = match found {
        Some(Faces::Known { faces, .. }) => faces,
        Some(Faces::Unknown { reason }) => return Err(without(reason)),
        None => return Err(without("no face of the mesh has all its nodes among them, or the mesh has no cells")),
    };
    let position = |place: usize| catalogue.position(labels[place]).unwrap_or_default();
    let mut values = vec![0.0; model.n_dofs()];
    for face in faces {
        let shares = area_vectors(face, position);
        let whole: [f64; 3] = std::array::from_fn(|axis| shares.iter().map(|share| share[axis]).sum());
        for (place, share) in face.nodes().zip(&shares) {
            let (node, rows) = (labels[place], catalogue.rows_of(&selection.selector, labels[place])?);
            for (direction, area) in Direction::ALL.into_iter().zip(share) {
                match rows.get(&direction) {
                    Some(row) => values[*row] -= pressure * area,
                    // A plane model has no direction across its plane, and no force either.
                    None if area.abs() <= ROUNDING * dense::norm(&whole) => {}
                    None => {
                        let dof = Dof { node, direction };
                        return Err(Error::DofMissing { selector: selection.selector.clone(), dof });
                    }
                }
            }
        }
    }
    Ok((values, faces.len()))
}
