//! Modes that the superelement leaves out are coupled with nothing that it has: M-35.

use super::check::{Check, Limits};
use super::evidence::Evidence;
use crate::dense;
use crate::unseen::{MAX_TIE, UnseenMode};

/// Times the limit at which the check fails.
const FAIL: f64 = 10.0;
/// The most that rounding of modes that were found again excuses.
const LARGEST_EXCUSE: f64 = 1e-5;

/// M-35 of a reduction; none where no mode is left out.
pub(super) fn uncoupled(evidence: &Evidence<'_>) -> Option<Check> {
    of_modes(evidence.unseen)
}

/// M-35 of modes that are left out.
pub(crate) fn of_modes(unseen: &[UnseenMode]) -> Option<Check> {
    let mut worst = (0.0, unseen.first()?);
    for mode in unseen {
        let size = if dense::worse(mode.tie, mode.coupling) { mode.tie } else { mode.coupling };
        if dense::worse(size, worst.0) {
            worst = (size, mode);
        }
    }
    let rounding = dense::worst(unseen.iter().map(|mode| mode.rounding));
    let arithmetic = if rounding <= LARGEST_EXCUSE { rounding } else { LARGEST_EXCUSE };
    let limits = Limits { engineering: MAX_TIE, arithmetic, data: 0.0 };
    Some(Check {
        id: "M-35",
        name: "modes left out are coupled with nothing",
        equation: "max of c over the largest c of a mode, and of |A_ij| over row j of K̂, M̂, Ĉ and further matrices, j kept",
        value: worst.0,
        limits,
        fail_above: FAIL * limits.value(),
        worst: Some(format!("mode {}, one of {} left out", worst.1.mode + 1, unseen.len())),
    })
}
