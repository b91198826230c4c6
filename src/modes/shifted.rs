//! A factor of K − σM with a shift found from the model itself.
//!
//! It serves where K_II cannot: without an interface, without coordinates, or where the interface holds the component
//! badly. σ lies below the spectrum at the distance of the first elastic eigenvalue, far enough from zero for K − σM to
//! be well conditioned and near enough to separate eigenvalues.

use super::lanczos::Wanted;
use super::operator::Factored;
use super::{ModalProblem, ModeError, ModeRequest, Modes, SEED, elastic_modes};
use crate::error::{Error, Result};
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

/// The first shift relative to the median of K_ii / M_ii. The largest ratio would do where all dofs are alike, but a few
/// rotations of tiny inertia raise it by many orders of magnitude, and then eigenvalues can no longer be told apart.
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
/// K − σM is not definite; an eigenvalue is negative beyond the noise of the data; the eigensolver fails.
pub fn shifted<'a>(
    analysis: &'a Analysis,
    problem: ModalProblem<'_>,
    name: &dyn Fn(usize) -> String,
) -> Result<Shifted<'a>> {
    let pencil = Pencil { stiffness: problem.stiffness, mass: problem.mass };
    let mut sigma = -FIRST_SHIFT * median_ratio(problem);
    let mut count = LOOK_AT;
    let mut round = 1;
    loop {
        let factor = Cholesky::new(analysis, pencil, sigma, name)?;
        let request = ModeRequest { wanted: Wanted::Count(count), eigensolver: Eigensolver::Lanczos, seed: SEED };
        let lowest = elastic_modes(problem, &Factored::new(&factor, sigma), request)?;
        let zero_modes = lowest.lambda.iter().zip(&lowest.errors);
        let n_zero = zero_modes.take_while(|(lambda, error)| is_zero(error) || **lambda <= 0.0).count();
        let all_zero = n_zero == lowest.count() && lowest.next.is_some();
        if all_zero && count < problem.mass.rows() {
            count *= 2;
        }
        let first_elastic = lowest.lambda.get(n_zero).copied().or(lowest.next);
        let settled = first_elastic.is_none_or(|lambda| WINDOW.contains(&(-sigma / lambda)));
        if (settled && !all_zero) || round == MAX_ROUNDS {
            refuse_negative(&lowest)?;
            return Ok(Shifted { factor, sigma, lowest, n_zero, n_factorisations: round });
        }
        if let Some(lambda) = first_elastic.filter(|lambda| *lambda > 0.0) {
            sigma = -lambda;
        }
        round += 1;
    }
}

/// The median of K_ii / M_ii over the dofs that have both; one where none has.
fn median_ratio(problem: ModalProblem<'_>) -> f64 {
    let (k, m) = (diagonal(problem.stiffness), diagonal(problem.mass));
    let mut ratios: Vec<f64> = k.iter().zip(&m).filter(|(k, m)| **k > 0.0 && **m > 0.0).map(|(k, m)| k / m).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied().unwrap_or(1.0)
}

/// Whether an eigenvalue is zero within its bar, which is relative and grows without limit as λ goes to zero.
fn is_zero(error: &ModeError) -> bool {
    let within = error.relative_bar * ZERO_WITHIN_BARS;
    // A free particle has no terms to cancel: 0/0.
    within.is_nan() || within >= 1.0
}

/// An eigenvalue below zero by more than noise belongs to an indefinite K, not to a rigid-body motion.
fn refuse_negative(modes: &Modes) -> Result<()> {
    let mut pairs = modes.lambda.iter().zip(&modes.errors);
    match pairs.find(|(lambda, error)| **lambda < 0.0 && !is_zero(error)) {
        Some((lambda, error)) => {
            Err(Error::NegativeRigidEnergy { energy: *lambda, noise: error.relative_bar * lambda.abs() })
        }
        None => Ok(()),
    }
}
