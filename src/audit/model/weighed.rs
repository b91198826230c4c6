//! What the mass before supports says of a component: M-16.

use supel_runtime::Superelement;

use super::motions::KnownMotions;
use crate::audit::mass;
use crate::partition::Partition;
use crate::plan::Plan;
use crate::verification;
use crate::verification::check::Check;

/// M-16 of a component whose file has no mass properties: that its mass is a body's, and what the job expects.
pub(super) fn expectations(
    (plan, partition): (&Plan, &Partition),
    motions: &KnownMotions,
    superelement: &Superelement,
) -> Vec<Check> {
    let is_weighed = !motions.is_classical() || partition.held.count() > 0;
    let weighed = is_weighed.then(|| verification::of_weighed_body(partition)).flatten();
    let mut checks: Vec<Check> = weighed.into_iter().chain(verification::of_parts(partition)).collect();
    let has_properties = superelement.metadata().model.mass_properties.is_some();
    checks.extend(mass::stated_of_model(superelement, partition));
    let is_expected_here = !has_properties || partition.fit.is_preloaded();
    if let Some(expect) = plan.job().model.expect.as_ref().filter(|_| is_expected_here) {
        let lacks = verification::not_comparable(expect, partition);
        checks.extend(verification::expected_by_weight(expect, partition));
        checks.extend(verification::comparable(&lacks));
    }
    checks
}
