//! Motions without energy that the digits of K_II tell from all others, where K_II has no factor.
//!
//! ```text
//! r    n_I    what roundings along each row of K_II may add up to
//! μ           eigenvalues of K_II x = μ diag(r) x: motions with |μ| ≤ 1 cost nothing as far as the digits tell
//! ```
//! Digits are too few where other motions cost hardly more than that. Where none does, the interface leaves a motion free, and more digits
//! would say the same.

use faer::Mat;

use super::cholesky::Cholesky;
use super::indefinite::Indefinite;
use super::multifrontal::Keep;
use super::sturm_count::margin_of_roundings;
use super::{Analysis, SolveOperator};
use crate::error::{Error, Result};
use crate::sparse::{Leading, Pencil, Rounding, diagonal};

/// Energy of all other motions in units of what roundings make: what is lost in rounding is slower than a hundredth of them.
const TOLD: f64 = 1e4;
/// Steps of inverse iteration with K_II + diag(r), each of which leaves 1/[`TOLD`] of what the others have in a motion.
const STEPS: usize = 4;

/// The dof that a motion without energy moves most relative to its roundings, where the digits tell that there is one.
///
/// # Errors
/// A shift that meets an eigenvalue; no memory.
pub fn without_energy(analysis: &Analysis, stiffness: Leading<'_>, rounding: Rounding) -> Result<Option<usize>> {
    let margin = margin_of_roundings(stiffness, rounding);
    let pencil = Pencil::new(stiffness, &margin);
    let n_below = |mu: f64| {
        let signs = Indefinite::new(analysis, pencil, mu, Keep::Pivots)?.signs()?;
        Ok::<_, Error>(signs.negative)
    };
    let n_free = n_below(1.0)?;
    if n_free == 0 || n_below(-1.0)? > 0 || n_below(TOLD)? > n_free {
        return Ok(None);
    }
    let factor = Cholesky::new(analysis, pencil, -1.0, &|dof| dof.to_string())?;
    let margin = diagonal(&margin);
    let n = factor.n();
    let mut motion = Mat::from_fn(n, 1, |dof, _| margin[dof].sqrt().recip());
    for _ in 0..STEPS {
        motion = Mat::from_fn(n, 1, |dof, _| margin[dof] * motion[(dof, 0)]);
        factor.solve_in_place(motion.as_mut());
    }
    let size = |dof: usize| margin[dof].sqrt() * motion[(dof, 0)].abs();
    Ok((0..n).max_by(|a, b| size(*a).total_cmp(&size(*b))))
}
