//! The digits of a condensed stiffness, which a job that reduces it again states.
//!
//! ```text
//! Q    r × n_r    rigid-body modes of the matrices, M̂-orthonormal combinations of Û without its rounding
//! ```
//! K̂ was condensed from a stiffness that is larger by orders, and its entries carry the rounding of that one. So K̂ Q is not zero
//! to the last digit of K̂, and the job states as many digits as K̂ Q shows: taken for exact, the zero eigenvalues of K̂
//! would be negative or elastic. A part that others hardly hold has rows that are soft next to theirs, and which have the rounding of
//! its own stiffness: each row of a node is judged by its own terms, and all rows as a whole. Of modal amplitudes K̂ Q has nothing but
//! rounding, all terms of it.

use faer::{Mat, MatRef};

use supel_runtime::{Matrix, Superelement};

use super::strainless::{Place, mass_or_unit, places, without_rounding};
use crate::dense;
use crate::error::Result;

/// Digits of K̂ below which a second reduction cannot tell stiffness from rounding.
pub(crate) const FEWEST_DIGITS: i64 = 4;

/// [`digits`] of a superelement, whose K̂ without rounding in rows that can do without is `stiffness`.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(crate) fn digits_of(superelement: &Superelement, stiffness: &Matrix) -> Result<Option<i64>> {
    let [k, u] = [stiffness, &superelement.tensors().rigid_body_modes].map(dense::unpacked);
    digits([&k, &mass_or_unit(superelement), &u].map(Mat::as_ref), &places(superelement))
}

/// The digits that K̂ has by its rigid-body motion; nothing where it has none or all.
///
/// Half a unit of the last of d digits, 0.5·10^(1−d), is at least [`MARGIN`] times the largest ‖K̂q‖ / ‖|K̂||q|‖, and the largest
/// ‖(K̂Q)ᵢ‖ / ‖(|K̂||Q|)ᵢ‖ of a row of a node.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(crate) fn digits([k, m, u]: [MatRef<'_, f64>; 3], places: &[Option<Place>]) -> Result<Option<i64>> {
    /// Combinations of the columns of Q, in which more cancels, do worse than each.
    const MARGIN: f64 = 10.0;
    /// As many identify almost every double, and reading takes them for all.
    const ALL: f64 = 16.0;
    if u.ncols() == 0 {
        return Ok(None);
    }
    let u = without_rounding(u, places, &dense::diagonal(m));
    let u = u.as_ref();
    let mut modal_mass = dense::gram(u, dense::product(m, u).as_ref());
    dense::symmetrise(&mut modal_mass);
    let (masses, directions) = dense::symmetric_eigen(modal_mass.as_ref())?;
    let massive: Vec<usize> = (0..masses.len()).filter(|j| masses[*j] > 0.0).collect();
    let unit =
        Mat::from_fn(masses.len(), massive.len(), |i, j| directions[(i, massive[j])] / masses[massive[j]].sqrt());
    let q = dense::product(u, unit.as_ref());
    let forces = dense::product(k, q.as_ref());
    let terms = dense::product(dense::absolute(k).as_ref(), dense::absolute(q.as_ref()).as_ref());
    let norm = |a: &Mat<f64>, j: usize| dense::norm(dense::column(a.as_ref(), j));
    let of_row = |a: &Mat<f64>, i: usize| dense::norm(&(0..a.ncols()).map(|j| a[(i, j)]).collect::<Vec<f64>>());
    let of_motions = (0..q.ncols()).map(|j| (norm(&forces, j), norm(&terms, j)));
    let rows = (0..places.len()).filter(|i| places[*i].is_some());
    let of_rows = rows.map(|i| (of_row(&forces, i), of_row(&terms, i)));
    let ratio = |(force, terms): (f64, f64)| if terms > 0.0 { force / terms } else { 0.0 };
    let digits = |residual: f64| (1.0 - (2.0 * MARGIN * residual).log10()).floor();
    // A row with fewer digits than a model needs is that of a motion that costs nothing: all of it is rounding of the stiffness around.
    let has_digits = |residual: &f64| digits(*residual) >= FEWEST_DIGITS as f64;
    let residuals = of_motions.map(ratio).chain(of_rows.map(ratio).filter(has_digits));
    let digits = digits(residuals.fold(0.0, f64::max));
    Ok((digits < ALL).then_some(digits.max(1.0) as i64))
}
