//! What the full stiffness leaves open of the coordinates of the job: M-05.

use crate::partition::Partition;
use crate::verification::check::{Check, Limits};

/// M-05: coordinates that no force of rigid-body motion confirms. The reference is made of them as the file was, and agrees with it when
/// they are wrong. None where all are confirmed.
pub(super) fn untested(partition: &Partition) -> Option<Check> {
    let finding = partition.model.findings.iter().find(|finding| finding.n_untested() > 0)?;
    Some(Check {
        id: "M-05",
        name: "coordinates are confirmed by the full model",
        equation: "nodes of patches, rows or models at which K C of the unit motions C tells nothing",
        value: finding.n_untested() as f64,
        limits: Limits::default(),
        fail_above: Check::NEVER,
        worst: Some(finding.to_string()),
    })
}
