//! K − σM, proved positive definite.

use crate::dense;
use crate::error::{Error, Result};
use crate::factor::{Analysis, Cholesky, SolveOperator, forming_error};
use crate::random::SplitMix64;
use crate::sparse::Pencil;
use crate::sparse::{Leading, SparseMatrix};

/// A definite K_s = K − σM with the proof that it is.
pub(super) struct Metric<'a> {
    pub(super) pencil: Pencil<'a>,
    /// σ < 0, a power of two.
    pub(super) sigma: f64,
    /// L Lᵀ ≈ K_s.
    pub(super) factor: Cholesky<'a>,
    /// S, powers of two near 1/√K_ii.
    pub(super) scale: Vec<f64>,
    /// K_s ≽ floor · S⁻².
    pub(super) floor: f64,
}

/// −σ is tried at these multiples of the first eigenvalue: nearer gives narrower intervals, farther is easier to prove.
const DISTANCES: [f64; 3] = [1.0, 16.0, 256.0];
/// Shares of the smallest eigenvalue of S K_s S, as iteration estimates it from above, that are tried as its proved floor.
const SHARES: [f64; 2] = [0.25, 0.01];
/// Steps of inverse iteration for that estimate.
const STEPS: usize = 12;
/// Seed of its start vector.
const SEED: u64 = 0xf100;

impl<'a> Metric<'a> {
    /// The metric of a pencil whose first eigenvalue above zero is known, and the factorisations it took; none where no
    /// shift gives a matrix that can be proved definite.
    ///
    /// # Errors
    /// No memory.
    pub(super) fn new(analysis: &'a Analysis, pencil: Pencil<'a>, first: Option<f64>) -> Result<(Option<Self>, usize)> {
        let k_diagonal = pencil.stiffness.diagonal();
        let scale: Vec<f64> = k_diagonal.iter().map(|d| dense::power_of_two_root(d.abs())).collect();
        let mut n_factorisations = 0;
        for distance in DISTANCES {
            // A power of two makes its product with M exact.
            let sigma = -(distance * first.unwrap_or(1.0)).log2().round().exp2();
            n_factorisations += 1;
            let Some(factor) = factored(analysis, pencil, sigma)? else { continue };
            let least = smallest_eigenvalue(&factor, &scale);
            for share in SHARES {
                let Some(lowered) = lowered(pencil.stiffness, share * least, &scale) else {
                    return Ok((None, n_factorisations));
                };
                let pencil_of_proof = Pencil::new(&lowered, pencil.mass);
                n_factorisations += 1;
                let Some(proof) = factored(analysis, pencil_of_proof, sigma)? else { continue };
                // K_s − δS⁻² + E = LLᵀ ≽ 0, so that K_s ≽ (δ − ‖SES‖) S⁻². The diagonal was lowered by one operation more.
                let error = proof.backward_error(&scale) + 2.0 * forming_error(pencil, sigma, &scale);
                let floor = share * least - error;
                if floor > 0.0 {
                    return Ok((Some(Self { pencil, sigma, factor, scale, floor }), n_factorisations));
                }
            }
        }
        Ok((None, n_factorisations))
    }

    /// The floor for other scales D: K_s ≽ floor · D⁻².
    pub(super) fn floor_in(&self, scale: &[f64]) -> f64 {
        let ratios = self.scale.iter().zip(scale).map(|(s, d)| (d / s).powi(2));
        self.floor * ratios.fold(f64::INFINITY, f64::min)
    }

    /// ‖S v‖ / √floor: an upper bound of ‖v‖ in the norm of K_s⁻¹.
    pub(super) fn dual_bound(&self, v: impl Iterator<Item = f64>) -> f64 {
        let scaled: Vec<f64> = v.zip(&self.scale).map(|(v, s)| v * s).collect();
        dense::norm(&scaled) / self.floor.sqrt()
    }
}

/// The factor, or nothing where the matrix is not definite beyond rounding.
fn factored<'a>(analysis: &'a Analysis, pencil: Pencil<'_>, sigma: f64) -> Result<Option<Cholesky<'a>>> {
    match Cholesky::new(analysis, pencil, sigma, &|dof| dof.to_string()) {
        Ok(factor) => Ok(Some(factor)),
        Err(Error::NotDefinite { .. } | Error::IndefiniteStiffness { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}

/// The smallest eigenvalue of S K_s S, from above: one over the growth of a vector under its inverse.
fn smallest_eigenvalue(factor: &Cholesky<'_>, scale: &[f64]) -> f64 {
    let mut v = faer::Mat::zeros(scale.len(), 1);
    SplitMix64::new(SEED).fill(v.as_mut());
    let mut growth = 0.0;
    for _ in 0..STEPS {
        let length = dense::norm(dense::column(v.as_ref(), 0));
        dense::column_mut(v.as_mut(), 0).iter_mut().zip(scale).for_each(|(v, s)| *v /= length * s);
        factor.solve_in_place(v.as_mut());
        dense::column_mut(v.as_mut(), 0).iter_mut().zip(scale).for_each(|(v, s)| *v /= s);
        growth = dense::norm(dense::column(v.as_ref(), 0));
    }
    1.0 / growth
}

/// K − δS⁻²; none where a diagonal entry is not stored, which is a free particle.
fn lowered(stiffness: Leading<'_>, delta: f64, scale: &[f64]) -> Option<SparseMatrix> {
    let mut lowered = stiffness.to_owned();
    for (i, s) in scale.iter().enumerate() {
        *lowered.get_mut(i, i)? -= delta / (s * s);
    }
    Some(lowered)
}
