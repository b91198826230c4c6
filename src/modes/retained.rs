//! The modes that a reduction retains, and the columns that they add to the basis under either boundary.

use super::{Boundary, Modes};
use crate::basis::{
    ConstraintModes, DynamicColumns, fixed_interface_columns, modal_columns, mode_acceleration_columns,
};
use crate::factor::{Analysis, Cholesky};
use crate::partition::Partition;
use crate::rigid::RigidBodyModes;

/// What the modes are computed from.
#[derive(Clone, Copy, Debug)]
pub struct Component<'a> {
    /// The matrices in their order.
    pub partition: &'a Partition,
    /// The symbolic factorisation of the partition.
    pub analysis: &'a Analysis,
    /// The factor of K_II.
    pub factor: &'a Cholesky<'a>,
    /// The rigid-body modes.
    pub rigid: &'a RigidBodyModes,
    /// The constraint modes.
    pub constraint: &'a ConstraintModes,
}

impl<'a> Component<'a> {
    /// All of it by reference.
    pub fn new(
        partition: &'a Partition,
        analysis: &'a Analysis,
        factor: &'a Cholesky<'a>,
        rigid: &'a RigidBodyModes,
        constraint: &'a ConstraintModes,
    ) -> Self {
        Self { partition, analysis, factor, rigid, constraint }
    }
}

/// The modes a method retains.
#[derive(Clone, Debug)]
pub struct Retained {
    /// The elastic modes.
    pub modes: Modes,
    /// The boundary they were computed under.
    pub boundary: Boundary,
}

impl Component<'_> {
    /// True where nothing holds the component and nothing is to be condensed: its own modes are the model.
    pub fn is_modal(&self) -> bool {
        self.partition.n_interface() == 0 && self.rigid.count() > 0
    }
}

impl Retained {
    /// The columns of Ψ_D that they make: Craig and Bampton keep the fixed-interface modes as they are, Herting's method
    /// accelerates the free-free ones.
    pub fn columns(&self, component: Component<'_>) -> DynamicColumns {
        let Component { partition, factor, rigid, constraint, .. } = component;
        match self.boundary {
            Boundary::FixedInterface => fixed_interface_columns(&self.modes),
            Boundary::FreeInterface if component.is_modal() => modal_columns(rigid, &self.modes),
            Boundary::FreeInterface => mode_acceleration_columns(partition, factor, constraint, rigid, &self.modes),
        }
    }
}
