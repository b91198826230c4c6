//! The count at the lower end of the spectrum: nothing lies below zero.
//!
//! Cholesky factorisation of K_II at shift zero is a count of its own: it ends with positive pivots only where K_II has no
//! eigenvalue below zero. With the interface free, those of S = K_BB + K_BI Ψ_S complete it ([`n_negative`]). So the factor that the
//! reduction needs anyway counts both boundaries at the lower end, and the zero modes are counted by the rank of U_B, which
//! S U_B = 0 holds.

use super::Component;
use crate::constraint::n_negative;
use crate::error::{Error, Result};

/// Refuses a stiffness that has negative eigenvalues with the interface free.
///
/// # Errors
/// [`Error::IndefiniteStiffness`].
pub(super) fn refuse(component: Component<'_>) -> Result<()> {
    // Where the interface holds nothing, a factor below zero says it while the modes are looked for.
    let Component { partition, constraint: Some(constraint), rigid, .. } = component else { return Ok(()) };
    match n_negative(partition, constraint, rigid)? {
        0 => Ok(()),
        count => Err(Error::IndefiniteStiffness { count, boundary: "free" }),
    }
}
