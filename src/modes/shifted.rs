//! A factor of K − σM with a shift found from the model itself.
//!
//! It serves where K_II cannot: without an interface, without coordinates, or where the interface holds the component
//! badly. σ lies below the spectrum at the distance of the first elastic eigenvalue, far enough from zero for K − σM to
//! be well conditioned and near enough to separate eigenvalues.

use super::lanczos::Wanted;
use super::operator::Factored;
use super::{ModalProblem, ModeRequest, Modes, SEED, elastic_modes};
use crate::error::Result;
use crate::factor::{Analysis, Cholesky, Pencil};
use crate::job::Eigensolver;
use crate::model::diagonal;

/// A factor of K − σM and the lowest modes found on the way.
#[derive(Debug)]
pub struct Shifted<'a> {
    /// L Lᵀ = K − σM.
    pub factor: Cholesky<'a>,
    /// σ < 0.
    pub sigma: f64,
    /// The lowest modes, zero modes first.
    pub lowest: Modes,
    /// How many of them are zero within the noise of the data.
    pub n_zero: usize,
    /// Numeric factorisations it took.
    pub n_factorisations: usize,
}

/// The first shift relative to max K_ii / M_ii, which lies within a small factor of the largest eigenvalue.
const FIRST_SHIFT: f64 = 1e-6;
/// Refactorisations before the shift is taken as it is.
const MAX_ROUNDS: usize = 4;
/// −σ may lie between these multiples of the first elastic eigenvalue.
const WINDOW: std::ops::RangeInclusive<f64> = 1e-2..=10.0;
/// Modes looked at first; doubled while all of them are zero modes.
const LOOK_AT: usize = 12;
/// A mode is zero when its Rayleigh quotient stays below this many error bars of itself.
const ZERO_WITHIN_BARS: f64 = 10.0;

/// Factors K − σM of a modal problem with a shift suited to it.
///
/// # Errors
/// K − σM is not definite, or the eigensolver fails.
pub fn shifted<'a>(
    analysis: &'a Analysis,
    problem: ModalProblem<'_>,
    name: &dyn Fn(usize) -> String,
) -> Result<Shifted<'a>> {
    let pencil = Pencil {
        stiffness: problem.stiffness,
        mass: problem.mass,
    };
    let (k, m) = (diagonal(problem.stiffness), diagonal(problem.mass));
    let largest = k
        .iter()
        .zip(&m)
        .filter(|(_, m)| **m > 0.0)
        .fold(0.0f64, |max, (k, m)| max.max(k / m));
    let mut sigma = -FIRST_SHIFT * if largest > 0.0 { largest } else { 1.0 };
    let mut count = LOOK_AT;
    let mut round = 1;
    loop {
        let factor = Cholesky::new(analysis, pencil, sigma, name)?;
        let request = ModeRequest {
            wanted: Wanted::Count(count),
            eigensolver: Eigensolver::Lanczos,
            seed: SEED,
        };
        let lowest = elastic_modes(problem, &Factored::new(&factor, sigma), request)?;
        let n_zero = lowest.lambda.iter().zip(&lowest.errors).take_while(|(lambda, error)| {
            // The bar is relative to λ and grows without limit as λ goes to zero.
            error.relative_bar * ZERO_WITHIN_BARS >= 1.0 || **lambda <= 0.0
        });
        let n_zero = n_zero.count();
        let all_zero = n_zero == lowest.count() && lowest.next.is_some();
        if all_zero && count < problem.mass.rows() {
            count *= 2;
        }
        let first_elastic = lowest.lambda.get(n_zero).copied().or(lowest.next);
        let settled = first_elastic.is_none_or(|lambda| WINDOW.contains(&(-sigma / lambda)));
        if (settled && !all_zero) || round == MAX_ROUNDS {
            return Ok(Shifted {
                factor,
                sigma,
                lowest,
                n_zero,
                n_factorisations: round,
            });
        }
        if let Some(lambda) = first_elastic.filter(|lambda| *lambda > 0.0) {
            sigma = -lambda;
        }
        round += 1;
    }
}
