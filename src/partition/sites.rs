//! Where the rows of a model are, and how they move with a rigid body.

use crate::dofs::Dof;
use crate::model::{Model, RoundedCoordinates, Site, node_of_row};

/// Positions of the rows of the model.
pub(super) struct Sites<'a> {
    pub(super) of_row: Option<Vec<Option<Site>>>,
    /// How they move as K knows it, where their coordinates are rounded.
    rounded: Option<&'a RoundedCoordinates>,
    pub(super) node_of_row: Vec<u32>,
    pub(super) dofs: Option<&'a [Option<Dof>]>,
    pub(super) n_nodes: u32,
}

impl<'a> Sites<'a> {
    pub(super) fn new(model: &'a Model) -> Self {
        let of_row = model.sites();
        let node_of_row = node_of_row(model.n_dofs(), model.dofs.as_deref());
        let n_nodes = node_of_row.iter().max().map_or(0, |max| max + 1);
        Self { of_row, rounded: model.fit.rounded(), node_of_row, dofs: model.dofs.as_deref(), n_nodes }
    }

    /// The factors of the six dofs of a node at `position` in the motion of a row.
    pub(super) fn lever(&self, row: usize, position: [f64; 3]) -> [f64; 6] {
        match (&self.of_row, self.rounded) {
            (None, _) => [0.0; 6],
            (Some(_), Some(rounded)) => rounded.motion(row, position),
            (Some(sites), None) => sites[row].map_or([0.0; 6], |site| site.rigid_motion_about(position)),
        }
    }
}
