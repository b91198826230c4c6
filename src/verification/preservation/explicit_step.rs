//! The largest step of the central difference scheme, with the damping of the file.
//!
//! ```text
//! M (x₊ − 2x + x₋)/h² + C (x − x₋)/h + K x = 0      velocity of the half step before, so that M alone is factored
//! (4M/h² − 2C/h − K) x = 0                            the step at which a motion alternates, x₊ = −x: the largest that is stable
//! μ = 2/h,  μ² = max yᵀ(A + μD)y over yᵀy = 1         A = L⁻¹KL⁻ᵀ, D = L⁻¹CL⁻ᵀ, M = LLᵀ      r × r
//! h = 2/ω (√(1 + ζ²) − ζ)                              of one mode with damping ratio ζ
//! ```
//! The largest root over all motions counts, whether modes diagonalise C or not. With y of the largest eigenvalue the root of
//! μ² − μ yᵀDy − yᵀAy is no larger than the largest of all and no smaller than the one before, so that the iteration rises to it.
//!
//! T. Belytschko, W. K. Liu, B. Moran, *Nonlinear Finite Elements for Continua and Structures*, section 6.2.

use faer::{Mat, MatRef, Side};

use crate::dense;
use crate::eigen::scaled_by;
use crate::error::{Error, Result};

/// Steps of an iteration that doubles its digits with each.
const MAX_STEPS: usize = 60;
/// Change of μ, relative to it, that is the rounding of a decomposition.
const SETTLED: f64 = 1e-12;

/// h of a pencil with a definite mass and a damping matrix; none where no motion has energy.
///
/// # Errors
/// [`Error::DenseEigen`] where the mass is not definite or a matrix holds NaN.
pub(super) fn explicit_step([k, m, c]: [MatRef<'_, f64>; 3]) -> Result<Option<f64>> {
    let n = m.nrows();
    let scale: Vec<f64> = (0..n).map(|i| dense::power_of_two_root(m[(i, i)])).collect();
    let factor = scaled_by(m, &scale).llt(Side::Lower).map_err(|_| Error::DenseEigen { n })?;
    let [a, d] = [k, c].map(|matrix| {
        let mut form = dense::standard_form(factor.L(), scaled_by(matrix, &scale));
        dense::symmetrise(&mut form);
        form
    });
    let mut mu = 0.0;
    for _ in 0..MAX_STEPS {
        let both = Mat::from_fn(n, n, |i, j| a[(i, j)] + mu * d[(i, j)]);
        let (_, vectors) = dense::symmetric_eigen(both.as_ref())?;
        let y = vectors.subcols(n - 1, 1);
        let [energy, damping] = [&a, &d].map(|form| dense::gram(y, dense::product(form.as_ref(), y).as_ref())[(0, 0)]);
        let next = 0.5 * (damping + (damping * damping + 4.0 * energy.max(0.0)).sqrt());
        let is_settled = next <= (1.0 + SETTLED) * mu;
        mu = next.max(mu);
        if is_settled {
            break;
        }
    }
    Ok((mu > 0.0).then(|| 2.0 / mu))
}
