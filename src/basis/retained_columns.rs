//! The columns that retained modes make.

use super::dynamic::{DynamicColumns, accelerated_columns, expansion_columns, inertia_relief_columns, modal_columns};
use crate::job::ReductionJob;
use crate::modes::{Component, Retained};

/// The columns of Ψ_D: inertia relief (37), where the job has it, and then the modes, accelerated (23), which leaves modes of the held
/// interface as they are (38). A free component without interface has its rigid-body and elastic modes themselves.
pub fn retained_columns(component: Component<'_>, job: &ReductionJob, retained: &Retained) -> DynamicColumns {
    let Component { partition, factor, rigid, constraint, .. } = component;
    if component.is_modal() {
        return modal_columns(rigid, &retained.modes);
    }
    let mut modes = accelerated_columns(partition, constraint, retained);
    if partition.expansion.count() > 0 {
        modes = modes.followed_by(expansion_columns(partition, factor));
    }
    match job.has_inertia_relief() {
        true => inertia_relief_columns(partition, factor, rigid).followed_by(modes),
        false => modes,
    }
}
