//! The columns that retained modes make.

use super::attached::{attached_columns, rigid_columns};
use super::dynamic::{DynamicColumns, accelerated_columns, expansion_columns, inertia_relief_columns, modal_columns};
use crate::constraint::ConstraintModes;
use crate::modes::{Component, Retained};
use crate::plan::Relief;

/// The columns of Ψ_D: inertia relief (37) of the accelerations that have it, and then the modes, accelerated (23), which leaves modes of the held
/// interface as they are (38). A free component without interface has its rigid-body and elastic modes themselves.
///
/// Next to Rubin's static modes V = [U X] are what they leave of the rigid-body and elastic modes, V_I − Ψ_R V_B.
pub fn retained_columns(
    component: Component<'_>,
    constraint: &ConstraintModes<'_>,
    relief: Relief,
    retained: &Retained,
) -> DynamicColumns {
    let Component { partition, factor, rigid, .. } = component;
    if component.is_modal() {
        return modal_columns(rigid, &retained.modes);
    }
    if let Some(attachment) = &constraint.attachment {
        let modes = accelerated_columns(partition, constraint, retained);
        let columns = rigid_columns(partition, constraint, rigid).followed_by(modes);
        return columns.followed_by(attached_columns(partition, constraint, attachment));
    }
    let mut modes = accelerated_columns(partition, constraint, retained);
    if partition.expansion.count() > 0 {
        modes = modes.followed_by(expansion_columns(partition, factor));
    }
    match rigid.relieved(partition, relief) {
        motions if motions.is_empty() => modes,
        motions => inertia_relief_columns(partition, factor, (rigid, &motions)).followed_by(modes),
    }
}
