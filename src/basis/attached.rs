//! What Rubin's static modes leave of motions: dynamic columns where the interface leaves rigid-body motions free.
//!
//! ```text
//! V_I − Ψ_R V_B   n_I × 1   of a rigid-body motion, or of the answer to a load
//! ```

use faer::{Mat, MatRef};

use super::dynamic::{DynamicColumns, DynamicCoordinate};
use crate::constraint::{Attachment, ConstraintModes};
use crate::dense;
use crate::partition::Partition;
use crate::rigid::RigidBodyModes;

/// Of every rigid-body mode: with the interface at rest, its amplitude moves the component as it is free to.
pub(super) fn rigid_columns(
    partition: &Partition,
    constraint: &ConstraintModes<'_>,
    rigid: &RigidBodyModes,
) -> DynamicColumns {
    let columns = left_of(partition, constraint, rigid.modes.as_ref());
    DynamicColumns { columns, coordinates: (0..rigid.count()).map(DynamicCoordinate::RigidBody).collect() }
}

/// Of the answers to the loads that ask for a residual vector.
pub(super) fn attached_columns(
    partition: &Partition,
    constraint: &ConstraintModes<'_>,
    attachment: &Attachment,
) -> DynamicColumns {
    let loads = &partition.loads;
    let asked: Vec<usize> = (0..loads.count()).filter(|load| loads.facts[*load].has_residual_vector).collect();
    let answers = dense::columns(attachment.of_loads.as_ref(), &asked);
    let columns = left_of(partition, constraint, answers.as_ref());
    DynamicColumns { columns, coordinates: asked.into_iter().map(DynamicCoordinate::ResidualVector).collect() }
}

/// V_I − Ψ_R V_B.
fn left_of(partition: &Partition, constraint: &ConstraintModes<'_>, motions: MatRef<'_, f64>) -> Mat<f64> {
    let (internal, interface) = motions.split_at_row(partition.n_internal);
    let mut left = internal.to_owned();
    constraint.modes.add_followed(left.as_mut(), -1.0, interface);
    left
}
