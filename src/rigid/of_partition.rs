//! The rigid-body modes of a partition: from its coordinates where they are known, else from its matrices.

use super::algebraic::from_matrices;
use super::geometric;
use super::rigid_body_modes::RigidBodyModes;
use crate::error::{Error, Result};
use crate::number::counted;
use crate::partition::Partition;

/// The rigid-body modes, and the factorisations they took: from coordinates none.
///
/// Without an interface there is no S in which mechanisms would show, so that a free component is counted by its matrices too.
///
/// # Errors
/// The errors of [`from_coordinates`] and [`from_matrices`]; rigid patches that leave nothing elastic.
pub fn rigid_body_modes(partition: &Partition) -> Result<(RigidBodyModes, usize)> {
    let Some(sites) = partition.sites() else {
        let (rigid, n_factorisations) = from_matrices(partition)?;
        refuse_wholly_rigid(partition, &rigid)?;
        return Ok((rigid, n_factorisations));
    };
    let rigid = geometric::rigid_body_modes(partition, &sites)?;
    refuse_wholly_rigid(partition, &rigid)?;
    if partition.n_interface() > 0 || rigid.count() == 0 {
        Ok((rigid, 0))
    } else {
        counted_by_matrices(partition, rigid)
    }
}

/// The motions without energy by the matrices, where there are more than coordinates tell: mechanisms are among them. Modes that come from
/// the matrices have all of them, and so have those that were counted. With it the factorisations that it took.
///
/// # Errors
/// The errors of [`from_matrices`].
pub fn counted_by_matrices(partition: &Partition, rigid: RigidBodyModes) -> Result<(RigidBodyModes, usize)> {
    if partition.sites().is_none() || rigid.n_mechanisms > 0 {
        return Ok((rigid, 0));
    }
    let (every, n_factorisations) = from_matrices(partition)?;
    let n_mechanisms = every.count().saturating_sub(rigid.count());
    let rigid = if n_mechanisms > 0 { RigidBodyModes { n_mechanisms, ..every } } else { rigid };
    Ok((rigid, n_factorisations))
}

/// Patches of all nodes, and constraints between all, leave no stiffness but rounding, of which nothing follows.
fn refuse_wholly_rigid(partition: &Partition, rigid: &RigidBodyModes) -> Result<()> {
    match partition.interface.iter().find(|node| node.coupling.is_patch()) {
        Some(patch) if partition.n_dofs() == rigid.count() => {
            Err(Error::WhollyRigid { interface: patch.name.clone(), n_nodes: patch.n_nodes, n_rigid: rigid.count() })
        }
        None if partition.n_dofs() == rigid.count() && partition.model.n_dependent > 0 => {
            let motions = counted(rigid.count(), "rigid-body motion", "rigid-body motions");
            Err(Error::ConstraintAll { left: format!("leave nothing but {motions}") })
        }
        _ => Ok(()),
    }
}

/// The rigid-body modes from the coordinates, or `None` where the model has none.
///
/// # Errors
/// A rigid motion without mass or of negative energy.
pub fn from_coordinates(partition: &Partition) -> Result<Option<RigidBodyModes>> {
    partition.sites().map(|sites| geometric::rigid_body_modes(partition, &sites)).transpose()
}
