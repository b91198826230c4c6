//! A small symmetric pencil in spectral form: its eigenvalues, and its response at any frequency as a sum over them.
//!
//! ```text
//! K + αM = L Lᵀ,  L⁻¹ M L⁻ᵀ = Q Θ Qᵀ,  P = L⁻ᵀ Q         r × r, α > 0
//! (K − zM)⁻¹ = P [1 − (z + α) θ]⁻¹ Pᵀ                       for any complex z
//! λ = 1/θ − α                                               accurate at the low end
//! ```
//! Nothing is divided by θ, so that coordinates without mass (θ = 0) answer statically, as they should. With structural
//! damping K (1 + iη) − ω²M = (1 + iη) (K − zM) at z = ω² / (1 + iη): a complex symmetric matrix is never factored.

use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::{Mat, MatRef, Par, Side, c64};

use crate::dense::{self, NOISE_FACTOR};
use crate::error::{Error, Result};

/// The spectral form of K − zM.
#[derive(Clone, Debug)]
pub(crate) struct Spectral {
    /// α.
    alpha: f64,
    /// θ, descending.
    theta: Vec<f64>,
    /// P, r × r, in the order of θ.
    shapes: Mat<f64>,
    /// How many eigenvalues are finite at most.
    rank: usize,
    /// Share of the largest θ at which one belongs to an infinite eigenvalue.
    rounding: f64,
}

impl Spectral {
    /// The spectral form of a pencil; α should be near the lowest elastic eigenvalue.
    ///
    /// # Errors
    /// [`Error::DenseEigen`] where K + αM is not definite, M is negative, or either holds NaN.
    pub(crate) fn of(k: MatRef<'_, f64>, m: MatRef<'_, f64>, alpha: f64) -> Result<Self> {
        let n = k.nrows();
        let spectral = Self::if_definite(k, m, alpha)?.ok_or(Error::DenseEigen { n })?;
        // Rounding leaves a θ of zero a little below; one further below than the largest is above belongs to no mass.
        match (spectral.theta.first(), spectral.theta.last()) {
            (Some(most), Some(least)) if *least < -most.abs() => Err(Error::DenseEigen { n }),
            _ => Ok(spectral),
        }
    }

    /// The decomposition of a pencil whatever M is; none where K + αM is not definite.
    pub(crate) fn if_definite(k: MatRef<'_, f64>, m: MatRef<'_, f64>, alpha: f64) -> Result<Option<Self>> {
        let n = k.nrows();
        let shifted = Mat::from_fn(n, n, |i, j| k[(i, j)] + alpha * m[(i, j)]);
        let scale: Vec<f64> = (0..n).map(|i| dense::power_of_two_root(shifted[(i, i)])).collect();
        let Ok(factor) = scaled_by(shifted.as_ref(), &scale).llt(Side::Lower) else { return Ok(None) };
        let mut c = dense::standard_form(factor.L(), scaled_by(m, &scale));
        dense::symmetrise(&mut c);
        let (mut theta, q) = dense::symmetric_eigen(c.as_ref())?;
        theta.reverse();
        let mut shapes = Mat::from_fn(n, n, |i, j| q[(i, n - 1 - j)]);
        solve_upper_triangular_in_place(factor.L().transpose(), shapes.as_mut(), Par::Seq);
        for j in 0..n {
            dense::column_mut(shapes.as_mut(), j).iter_mut().zip(&scale).for_each(|(value, d)| *value *= d);
        }
        Ok(Some(Self { alpha, theta, shapes, rank: n, rounding: f64::EPSILON }))
    }

    /// The form of a pencil whose mass has no more than this rank by its making, and zero eigenvalues that are the rounding of r sums;
    /// without a rank any other form.
    pub(crate) fn of_rank(mut self, rank: Option<usize>) -> Self {
        if let Some(rank) = rank {
            self.rank = rank.min(self.n());
            self.rounding = NOISE_FACTOR * self.n() as f64 * f64::EPSILON;
        }
        self
    }

    /// r.
    pub(crate) fn n(&self) -> usize {
        self.shapes.nrows()
    }

    /// The finite eigenvalues, ascending.
    pub(crate) fn eigenvalues(&self) -> Vec<f64> {
        let largest = self.theta.first().copied().unwrap_or(0.0);
        // A θ at the rounding of the largest belongs to an infinite eigenvalue.
        let finite = self.theta.iter().take(self.rank).take_while(|theta| **theta > self.rounding * largest);
        finite.map(|theta| 1.0 / theta - self.alpha).collect()
    }

    /// Eigenvector j at unit modal mass.
    pub(crate) fn eigenvector(&self, j: usize) -> Vec<f64> {
        let length = self.theta[j].sqrt();
        dense::column(self.shapes.as_ref(), j).iter().map(|value| value / length).collect()
    }

    /// The finite eigenvalues, ascending, and the first `n_shapes` eigenvectors at unit modal mass, r × n_shapes or fewer.
    pub(crate) fn lowest(&self, n_shapes: usize) -> (Vec<f64>, Mat<f64>) {
        let lambda = self.eigenvalues();
        let shapes: Vec<Vec<f64>> = (0..n_shapes.min(lambda.len())).map(|j| self.eigenvector(j)).collect();
        (lambda, Mat::from_fn(self.n(), shapes.len(), |i, j| shapes[j][i]))
    }

    /// The columns of (K − zM)⁻¹ that belong to the leading `n_b` coordinates, real and imaginary part, r × n_b each.
    pub(crate) fn columns(&self, z: c64, n_b: usize) -> [Mat<f64>; 2] {
        self.weighted(self.shapes.as_ref(), z, n_b)
    }

    /// What rows of a basis see of the shapes, n_o × r: [`Spectral::seen`] takes it at every frequency.
    pub(crate) fn shapes_at(&self, rows: MatRef<'_, f64>) -> Mat<f64> {
        dense::product(rows, self.shapes.as_ref())
    }

    /// Those columns as rows of a basis see them, real and imaginary part, n_o × n_b each.
    pub(crate) fn seen(&self, shapes_at: MatRef<'_, f64>, z: c64, n_b: usize) -> [Mat<f64>; 2] {
        self.weighted(shapes_at, z, n_b)
    }

    /// The leading n_b × n_b block of (K − zM)⁻¹, real and imaginary part.
    pub(crate) fn block(&self, z: c64, n_b: usize) -> [Mat<f64>; 2] {
        self.weighted(self.shapes.as_ref().subrows(0, n_b), z, n_b)
    }

    fn weighted(&self, rows: MatRef<'_, f64>, z: c64, n_b: usize) -> [Mat<f64>; 2] {
        let one = c64::new(1.0, 0.0);
        let weight: Vec<c64> = self.theta.iter().map(|theta| one / (one - (z + self.alpha) * theta)).collect();
        let right = self.shapes.as_ref().subrows(0, n_b).transpose();
        [|w: c64| w.re, |w: c64| w.im].map(|part| {
            let left = Mat::from_fn(rows.nrows(), self.n(), |i, j| rows[(i, j)] * part(weight[j]));
            dense::product(left.as_ref(), right)
        })
    }
}

/// Computes anew those of the lowest `n` eigenvalues of K − λM, ascending, that are far above α: θ is known to rounding of the largest
/// one, which is relative to the eigenvalues next to α.
///
/// # Errors
/// As [`dense::symmetric_eigen`].
pub(crate) fn sharpen(
    values: &mut [f64],
    (k, m): (MatRef<'_, f64>, MatRef<'_, f64>),
    mut alpha: f64,
    n: usize,
) -> Result<()> {
    /// Ratio of an eigenvalue to α at which it has ten digits.
    const FAR: f64 = 1e6;
    let n = n.min(values.len());
    while let Some(first) = values[..n].iter().position(|value| *value > FAR * alpha) {
        alpha = values[first];
        let Some(spectral) = Spectral::if_definite(k, m, alpha)? else { return Ok(()) };
        let again = spectral.eigenvalues();
        if again.len() < n {
            return Ok(());
        }
        values[first..n].copy_from_slice(&again[first..n]);
    }
    Ok(())
}

/// z = ω² / (1 + iη) of a scaled eigenvalue ω².
pub(crate) fn complex_shift(lambda: f64, eta: f64) -> c64 {
    c64::new(lambda, 0.0) / c64::new(1.0, eta)
}

/// D A D.
pub(crate) fn scaled_by(a: MatRef<'_, f64>, scales: &[f64]) -> Mat<f64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] * scales[i] * scales[j])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two springs in a row, the second mass missing.
    fn pencil() -> (Mat<f64>, Mat<f64>) {
        let k = Mat::from_fn(2, 2, |i, j| [[3.0, -1.0], [-1.0, 1.0]][i][j]);
        let m = Mat::from_fn(2, 2, |i, j| if i == 0 && j == 0 { 2.0 } else { 0.0 });
        (k, m)
    }

    #[test]
    fn eigenvalues_leave_out_coordinates_without_mass() {
        let (k, m) = pencil();
        let spectral = Spectral::of(k.as_ref(), m.as_ref(), 1.0).expect("definite");
        // The massless end follows: 2 x = λ 2 x. Rounding of four operations on numbers of order one.
        let found = spectral.eigenvalues();
        assert!(found.len() == 1 && (found[0] - 1.0).abs() < 1e-14, "{found:?}");
    }

    #[test]
    fn response_is_the_inverse() {
        let (k, m) = pencil();
        let spectral = Spectral::of(k.as_ref(), m.as_ref(), 1.0).expect("definite");
        let z = c64::new(0.7, -0.2);
        let [re, im] = spectral.columns(z, 2);
        for i in 0..2 {
            for j in 0..2 {
                let entry = |a: usize, b: usize| c64::new(k[(a, b)], 0.0) - z * m[(a, b)];
                let sum: c64 = (0..2).map(|l| entry(i, l) * c64::new(re[(l, j)], im[(l, j)])).sum();
                let expected = f64::from(u8::from(i == j));
                assert!((sum - expected).norm() < 1e-14, "{i} {j}: {sum}");
            }
        }
    }
}
