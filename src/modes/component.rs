//! A component as the modes see it: what they are computed from.

use crate::cache::Key;
use crate::constraint::ConstraintModes;
use crate::factor::{Analysis, Cholesky};
use crate::job::{Boundary, ReductionJob};
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
    /// The constraint modes; none where the interface leaves rigid-body motions free.
    pub constraint: Option<&'a ConstraintModes<'a>>,
}

impl<'a> Component<'a> {
    /// All of it by reference.
    pub fn new(
        partition: &'a Partition,
        analysis: &'a Analysis,
        factor: &'a Cholesky<'a>,
        rigid: &'a RigidBodyModes,
        constraint: Option<&'a ConstraintModes<'a>>,
    ) -> Self {
        Self { partition, analysis, factor, rigid, constraint }
    }
}

impl Component<'_> {
    /// The boundary that the modes of a job are computed under.
    pub fn boundary(&self, job: &ReductionJob) -> Boundary {
        if self.is_modal() { Boundary::FreeInterface } else { self.partition.boundary(job.method.boundary()) }
    }

    /// The key of what a function makes of the component.
    pub(crate) fn key(&self, function: &str) -> Key {
        let Self { partition, analysis: _, factor, rigid, constraint } = self;
        let key = rigid.key(partition.key(function)).shown(&factor.storage());
        constraint.iter().fold(key, |key, constraint| constraint.key(key))
    }

    /// True where nothing holds the component and nothing is to be condensed: its own modes are the model.
    pub fn is_modal(&self) -> bool {
        self.partition.n_interface() == 0 && self.rigid.count() > 0
    }
}
