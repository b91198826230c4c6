//! The interfaces of the job with their dofs, and the masses that load them.

use super::super::evidence::Evidence;
use super::super::place::{centre as centre_of, square_levers};
use crate::dense;
use crate::model::Site;
use crate::partition::Partition;
use crate::sparse::product;
use faer::Mat;

/// An interface of the job.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Interface {
    /// Its name.
    pub(super) name: String,
    /// Numbers of its dofs among the interface dofs.
    pub(super) dofs: Vec<usize>,
    /// Number of its nodes; rows without a dof map count as nodes.
    pub(super) n_nodes: usize,
}

/// The interfaces in the order of the job.
pub(super) fn interfaces(partition: &Partition) -> Vec<Interface> {
    let mut all: Vec<Interface> = Vec::new();
    let mut next = 0;
    for node in &partition.interface {
        // A node without directions is a list of rows.
        let is_rows = node.directions.is_empty();
        let n_dofs = if is_rows { node.n_nodes } else { node.directions.len() };
        if all.last().is_none_or(|last| last.name != node.name) {
            all.push(Interface { name: node.name.clone(), dofs: Vec::new(), n_nodes: 0 });
        }
        if let Some(last) = all.last_mut() {
            last.dofs.extend(next..next + n_dofs);
            last.n_nodes += if is_rows { n_dofs } else { 1 };
        }
        next += n_dofs;
    }
    all
}

/// Mass of the component and its mean moment of inertia about its centre, of the axes that the model turns about, in scaled units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Inertia {
    pub(super) mass: f64,
    pub(super) moment: f64,
}

impl Inertia {
    /// The inertia of the component: from coordinates where there are any, otherwise that of all rows moving together.
    pub(super) fn of(evidence: &Evidence<'_>) -> Self {
        let partition = evidence.partition;
        let n = partition.n_dofs();
        let Some(sites) = partition.sites() else {
            let together = Mat::from_fn(n, 1, |_, _| 1.0);
            let momentum = product(&partition.mass, together.as_ref());
            return Self { mass: momentum.col(0).iter().sum(), moment: 0.0 };
        };
        let places = || sites.iter().flatten();
        let n_places = places().count() as f64;
        let centre = [0, 1, 2].map(|axis| places().map(|site| site.position[axis]).sum::<f64>() / n_places);
        let motion = |site: &Option<Site>| site.map_or([0.0; 6], |site| site.rigid_motion_about(centre));
        let motions: Vec<[f64; 6]> = sites.iter().map(motion).collect();
        let u = Mat::from_fn(n, 6, |i, j| motions[i][j]);
        let m_f = dense::gram(u.as_ref(), product(&partition.mass, u.as_ref()).as_ref());
        let mass = (0..3).map(|axis| m_f[(axis, axis)]).fold(0.0, f64::max);
        let has = |direction: usize| places().any(|site| site.direction as usize == direction);
        let axes: Vec<usize> = (0..3).filter(|axis| has(*axis)).collect();
        let offset = centre_of(m_f.as_ref(), None);
        // A model in a plane turns about the axis across it alone, or about those along it.
        let turns_about =
            |axis: &usize| has(3 + axis) || (0..3).all(|across| across == *axis || axes.contains(&across));
        let moments: Vec<f64> = (0..3)
            .filter(turns_about)
            .map(|axis| m_f[(3 + axis, 3 + axis)] - mass * square_levers(&axes, offset, axis))
            .collect();
        let moment = if moments.is_empty() { 0.0 } else { moments.iter().sum::<f64>() / moments.len() as f64 };
        Self { mass, moment: moment.max(0.0) }
    }

    /// The inertia of another mass of the same radius of gyration.
    pub(super) fn with_mass(self, mass: f64) -> Self {
        Self { mass, moment: self.moment * mass / self.mass }
    }
}

/// What turns the displacement of each interface dof into a length: one, or [`rotation_length`] of a rotation.
pub(super) fn interface_lengths(partition: &Partition) -> Vec<f64> {
    let length = rotation_length(partition);
    let of_dof = |dof: usize| match partition.dofs[partition.n_internal + dof].site {
        Some(site) if site.direction.is_rotation() => length,
        _ => 1.0,
    };
    (0..partition.n_interface()).map(of_dof).collect()
}

/// Length that turns rotations into displacements: the root mean square distance of the interface nodes from their
/// centre or, with one node, of the component's dofs from theirs; one without coordinates.
pub(super) fn rotation_length(partition: &Partition) -> f64 {
    let spread = |positions: &[[f64; 3]]| {
        let n = positions.len() as f64;
        let centre = [0, 1, 2].map(|axis| positions.iter().map(|p| p[axis]).sum::<f64>() / n);
        let squares = positions.iter().map(|p| (0..3).map(|axis| (p[axis] - centre[axis]).powi(2)).sum::<f64>());
        (squares.sum::<f64>() / n).sqrt()
    };
    let nodes: Vec<[f64; 3]> = partition.interface.iter().filter_map(|node| node.position).collect();
    let all = || partition.sites().map(|sites| sites.iter().flatten().map(|site| site.position).collect::<Vec<_>>());
    let of_nodes = if nodes.len() > 1 { spread(&nodes) } else { 0.0 };
    let length = if of_nodes > 0.0 { of_nodes } else { all().map_or(0.0, |all| spread(&all)) };
    if length > 0.0 { length } else { 1.0 }
}
