//! How many motions the stiffness of a foreign superelement leaves free, whatever its mass is.
//!
//! ```text
//! K̂        r × r     the stiffness that is judged
//! ΨᵀMΨ     r × r     the mass of the basis, known from K and M alone
//! K̂ q = λ ΨᵀMΨ q     a motion is free where λ is below half of λ₁ of the component, times what K̂ is to ΨᵀKΨ
//! ```
//! M̂ has no part in it: one that is wrong moves frequencies, and takes no stiffness away. Nor has a factor that all of K̂ is off by.

use faer::Mat;

use super::foreign::Foreign;
use crate::dense;
use crate::eigen::Spectral;
use crate::error::Result;

/// How many motions K̂ leaves free; `first` is λ₁ of the component.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn count(foreign: &Foreign, first: f64) -> Result<usize> {
    let limit = 0.5 * first * foreign.stiffness.usual_factor();
    let (k, m) = (&foreign.stiffness.given, &foreign.mass.projected);
    let eigenvalues = match Spectral::if_definite(k.as_ref(), m.as_ref(), 2.0 * limit)? {
        Some(spectral) => spectral.eigenvalues(),
        // Columns of the basis that depend on each other have no mass of their own, and K̂ may be negative.
        None => within_range(k, m)?,
    };
    Ok(eigenvalues.into_iter().filter(|lambda| *lambda < limit).count())
}

/// Eigenvalues of a pencil within the range of its mass.
fn within_range(stiffness: &Mat<f64>, mass: &Mat<f64>) -> Result<Vec<f64>> {
    let shapes = dense::orthonormal(Mat::identity(mass.nrows(), mass.ncols()).as_ref(), mass.as_ref());
    let mut within = dense::gram(shapes.as_ref(), dense::product(stiffness.as_ref(), shapes.as_ref()).as_ref());
    dense::symmetrise(&mut within);
    Ok(dense::symmetric_eigen(within.as_ref())?.0)
}
