//! K − σM factored with a shift that is near for all motions, also those of heavy masses.
//!
//! A heavy mass that the component holds is slower than everything else by orders. With −σ next to the first elastic eigenvalue its inertia
//! hides what K is to it: a factor has digits for K − σM, and not for K. Then σ is taken next to the eigenvalue of that motion, which a few
//! steps of inverse iteration find:
//! ```text
//! X ← (K − σM)⁻¹ M X       n × 8, from random columns
//! ```

use faer::{Mat, MatRef};

use crate::dense::{self, NOISE_FACTOR};
use crate::error::{Error, Result};
use crate::factor::{Analysis, Cholesky, SolveOperator};
use crate::partition::Partition;
use crate::random::SplitMix64;
use crate::sparse::{Pencil, product, product_and_terms};

/// −σ over the eigenvalue of the softest motion, where that is what it is taken from.
const SHIFT: f64 = 1e-2;
/// The first eigenvalue over −σ below which more than two digits of K would be hidden.
const TOO_FAR: f64 = 1e-2;
/// Seed of the columns that look for the softest motion.
const SEED: u64 = 0x50f7_0e57;
/// Columns that look for it: six motions of one heavy body, and two more.
const LOOKING: usize = 8;
/// Steps of theirs: what is a hundred times stiffer than −σM is 10⁻⁶ of them then.
const LOOKS: usize = 3;
/// Share of the longest below which a direction of the columns is rounding of the others.
const ALIKE: f64 = 1e-12;

/// A factor and its shift.
pub(super) struct Nearby<'a> {
    pub(super) factor: Cholesky<'a>,
    /// σ < 0.
    pub(super) sigma: f64,
}

impl<'a> Nearby<'a> {
    /// Factors K − σM at `sigma` or nearer to zero; `name` names a row of the pencil.
    ///
    /// # Errors
    /// K − σM is not definite; no memory.
    pub(super) fn new(
        partition: &Partition,
        (analysis, pencil): (&'a Analysis, Pencil<'a>),
        sigma: f64,
        name: &dyn Fn(usize) -> String,
    ) -> Result<Self> {
        let factor = Cholesky::new(analysis, pencil, sigma, name)?;
        let share = partition.precision.stiffness.share;
        let Some(softest) = softest(pencil, &factor, share)?.filter(|softest| *softest < -TOO_FAR * sigma) else {
            return Ok(Self { factor, sigma });
        };
        drop(factor);
        match Cholesky::new(analysis, pencil, -SHIFT * softest, name) {
            Ok(factor) => Ok(Self { factor, sigma: -SHIFT * softest }),
            // It was rounding after all.
            Err(Error::NotDefinite { .. }) => Ok(Self { factor: Cholesky::new(analysis, pencil, sigma, name)?, sigma }),
            Err(error) => Err(error),
        }
    }
}

/// About the lowest eigenvalue, where its motion has an energy that is no rounding of entries to this share.
fn softest(pencil: Pencil<'_>, factor: &Cholesky<'_>, share: f64) -> Result<Option<f64>> {
    let Pencil { stiffness, mass, .. } = pencil;
    let Some(basis) = soft_motions(pencil, factor)? else { return Ok(None) };
    let energies = dense::gram(basis.as_ref(), product(stiffness, basis.as_ref()).as_ref());
    let (_, shapes) = dense::symmetric_eigen(energies.as_ref())?;
    let motion = dense::product(basis.as_ref(), shapes.as_ref().subcols(0, 1));
    let (forces, terms) = product_and_terms(stiffness, motion.as_ref());
    let with = |x: &Mat<f64>, y: MatRef<'_, f64>| dense::dots(x.as_ref(), y)[0];
    let energy = with(&motion, forces.as_ref());
    let noise = NOISE_FACTOR * share.max(f64::EPSILON) * with(&dense::absolute(motion.as_ref()), terms.as_ref());
    let inertia = with(&motion, product(mass, motion.as_ref()).as_ref());
    Ok((energy > noise && inertia > 0.0).then(|| energy / inertia))
}

/// The space of the softest motions, orthonormal in M; none without mass.
fn soft_motions(pencil: Pencil<'_>, factor: &Cholesky<'_>) -> Result<Option<Mat<f64>>> {
    let (n, mass) = (factor.n(), pencil.mass);
    let mut x = Mat::zeros(n, LOOKING.min(n));
    SplitMix64::new(SEED).fill(x.as_mut());
    for _ in 0..LOOKS {
        x = product(mass, x.as_ref());
        factor.solve_in_place(x.as_mut());
        let squares = dense::dots(x.as_ref(), product(mass, x.as_ref()).as_ref());
        for (j, square) in squares.into_iter().enumerate().filter(|(_, square)| *square > 0.0) {
            dense::column_mut(x.as_mut(), j).iter_mut().for_each(|value| *value /= square.sqrt());
        }
    }
    let inertia = dense::gram(x.as_ref(), product(mass, x.as_ref()).as_ref());
    let (squares, axes) = dense::symmetric_eigen(inertia.as_ref())?;
    // Columns that say the same of M are one.
    let least = ALIKE * squares.last().copied().unwrap_or(0.0);
    let apart: Vec<usize> = (0..squares.len()).filter(|j| squares[*j] > least).collect();
    let axes = Mat::from_fn(axes.nrows(), apart.len(), |i, j| axes[(i, apart[j])] / squares[apart[j]].sqrt());
    Ok((!apart.is_empty()).then(|| dense::product(x.as_ref(), axes.as_ref())))
}
