//! Every check of a result, in the order of the identifiers.

use super::subject::Subject;
use crate::certification::band::Completed;
use crate::certification::claims::Claims;
use crate::certification::judgement::Judged;
use crate::certification::measured::Measured;
use crate::modes::Component;
use crate::verification::check::Check;

pub(in crate::certification) fn checks(
    component: Component<'_>,
    (claims, measured): (&Claims, &Measured),
    (judged, completed): (&Judged, &Completed),
) -> Vec<Check> {
    let looked_at = Subject { component, claims, measured, judged, completed };
    let mut checks = vec![looked_at.backward_error()];
    checks.extend(looked_at.mass_orthogonality());
    checks.extend(looked_at.stiffness_orthogonality());
    checks.extend(looked_at.rigid_energy());
    checks.extend(looked_at.missing());
    checks.extend(looked_at.angles());
    checks.extend(looked_at.data_precision());
    checks.extend(looked_at.frequencies());
    checks.push(looked_at.invented());
    checks.push(looked_at.repeated());
    checks.extend(looked_at.rigid_modes());
    checks.extend(looked_at.rigid_frequencies());
    checks.push(looked_at.modal_masses());
    checks.extend(looked_at.rows_in_place());
    checks
}
