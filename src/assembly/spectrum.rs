//! The elastic eigenpairs of a small pencil whose rigid-body motions are known and whose mass may be singular.
//!
//! ```text
//! K, M    n × n       symmetric
//! R       n × n_r     RᵀMR = 1, rigid-body motions
//! T    n × (n − n_r)  RᵀMT = 0, a basis of all other motions
//! TᵀKT y = λ TᵀMT y
//! x = T y,  λ = xᵀKx / xᵀMx             Rayleigh quotient
//! ```
//! Eigenvalues are found as θ = 1/(λ + α), which is zero for motions without mass; nothing is divided by the mass.

use faer::{Mat, MatRef};

use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::{lowest_eigenpairs, lowest_ratio_of};
use crate::error::Result;

/// α is taken anew until it is this near to the first elastic eigenvalue, to which rounding is then relative.
const NEAR: f64 = 16.0;
/// How often α is taken anew; each time it comes nearer by as many powers of ten as a double has digits.
const MAX_SHIFTS: usize = 4;
/// By how much α is raised where K + αM is not definite: few digits of a component leave energies below zero, which soft components
/// next to it do not raise.
const RAISED: f64 = 1e4;

/// A pencil, its rigid-body motions and the rounding of its entries.
#[derive(Clone, Debug)]
pub(super) struct Pencil {
    pub(super) stiffness: Mat<f64>,
    pub(super) mass: Mat<f64>,
    /// R, n × n_r.
    pub(super) rigid: Mat<f64>,
    /// How far each entry of K may be off.
    pub(super) rounding: Mat<f64>,
    /// D: what else is not known of an energy xᵀKx is xᵀDx.
    pub(super) doubt: Mat<f64>,
}

/// Elastic eigenpairs, ascending.
#[derive(Clone, Debug)]
pub(super) struct Spectrum {
    pub(super) lambda: Vec<f64>,
    /// How far rounding can move each eigenvalue.
    pub(super) rounding: Vec<f64>,
    /// At unit modal mass, n × number of eigenvalues.
    pub(super) shapes: Mat<f64>,
}

impl Pencil {
    /// A pencil of which nothing but double precision is to be doubted.
    pub(super) fn of(stiffness: MatRef<'_, f64>, mass: MatRef<'_, f64>, rigid: Mat<f64>) -> Self {
        Self {
            stiffness: stiffness.to_owned(),
            mass: mass.to_owned(),
            rigid,
            rounding: dense::absolute(stiffness) * faer::Scale(NOISE_FACTOR * f64::EPSILON),
            doubt: Mat::zeros(mass.nrows(), mass.ncols()),
        }
    }

    /// Its elastic eigenpairs with finite eigenvalues; none where a motion has neither stiffness nor mass.
    ///
    /// The first α is `near`, an eigenvalue that is known to be near the first of them, or the lowest ratio of the diagonals.
    ///
    /// # Errors
    /// [`crate::error::Error::DenseEigen`].
    pub(super) fn spectrum(&self, near: Option<f64>) -> Result<Option<Spectrum>> {
        let (n, n_r) = (self.stiffness.nrows(), self.rigid.ncols());
        let momenta = dense::product(self.mass.as_ref(), self.rigid.as_ref());
        let mut alpha = near.or_else(|| self.lowest_ratio(&momenta)).unwrap_or(1.0);
        let others = self.others(&momenta, alpha);
        let of_others = |a: &Mat<f64>| {
            let mut form = dense::gram(others.as_ref(), dense::product(a.as_ref(), others.as_ref()).as_ref());
            dense::symmetrise(&mut form);
            form
        };
        let (stiffness, mass) = (of_others(&self.stiffness), of_others(&self.mass));
        let mut best = None;
        for _ in 0..MAX_SHIFTS {
            let (values, shapes) = lowest_eigenpairs(stiffness.as_ref(), mass.as_ref(), alpha, n - n_r)?;
            if values.is_empty() && n > n_r && mass.norm_max() > 0.0 {
                if best.is_some() {
                    break;
                }
                alpha *= RAISED;
                continue;
            }
            let spectrum = self.quotients(dense::product(others.as_ref(), shapes.as_ref()), &momenta);
            let first = spectrum.first_elastic();
            best = Some(spectrum);
            match first {
                Some(first) if !(alpha / NEAR..=alpha * NEAR).contains(&first) => alpha = first,
                _ => break,
            }
        }
        Ok(best)
    }

    /// T, of columns that are orthonormal in the scales of K + αM. Nothing is added to K that would drown it next to a heavy mass.
    fn others(&self, momenta: &Mat<f64>, alpha: f64) -> Mat<f64> {
        let (n, n_r) = (momenta.nrows(), momenta.ncols());
        let scale: Vec<f64> =
            (0..n).map(|i| dense::power_of_two_root(self.stiffness[(i, i)] + alpha * self.mass[(i, i)])).collect();
        let q = Mat::from_fn(n, n_r, |i, j| scale[i] * momenta[(i, j)]).qr().compute_Q();
        Mat::from_fn(n, n - n_r, |i, j| scale[i] * q[(i, n_r + j)])
    }

    /// The lowest ratio of the diagonals of K and of the mass that rigid-body motion leaves.
    fn lowest_ratio(&self, momenta: &Mat<f64>) -> Option<f64> {
        // What is left of the mass of a coordinate that rigid-body motion moves alone is rounding, and no measure of anything.
        let left = |i: usize| {
            let taken: f64 = (0..momenta.ncols()).map(|j| momenta[(i, j)].powi(2)).sum();
            let left = self.mass[(i, i)] - taken;
            if left > NOISE_FACTOR * f64::EPSILON * taken { left } else { 0.0 }
        };
        lowest_ratio_of((0..self.mass.nrows()).map(|i| (self.stiffness[(i, i)], left(i))))
    }

    /// Columns freed of rigid-body motion, at unit modal mass, with their Rayleigh quotients.
    fn quotients(&self, mut x: Mat<f64>, momenta: &Mat<f64>) -> Spectrum {
        let quadratic =
            |a: &Mat<f64>, x: &Mat<f64>| dense::dots(x.as_ref(), dense::product(a.as_ref(), x.as_ref()).as_ref());
        let along = dense::gram(momenta.as_ref(), x.as_ref());
        dense::add_product(x.as_mut(), -1.0, self.rigid.as_ref(), along.as_ref());
        let (energies, masses) = (quadratic(&self.stiffness, &x), quadratic(&self.mass, &x));
        let (of_entries, doubts) =
            (quadratic(&self.rounding, &dense::absolute(x.as_ref())), quadratic(&self.doubt, &x));
        let noise: Vec<f64> = of_entries.iter().zip(doubts).map(|(noise, doubt)| noise + doubt.max(0.0)).collect();
        let mut order: Vec<usize> = (0..x.ncols()).filter(|j| masses[*j] > 0.0).collect();
        order.sort_by(|a, b| (energies[*a] / masses[*a]).total_cmp(&(energies[*b] / masses[*b])));
        Spectrum {
            lambda: order.iter().map(|j| energies[*j] / masses[*j]).collect(),
            rounding: order.iter().map(|j| noise[*j] / masses[*j]).collect(),
            shapes: Mat::from_fn(x.nrows(), order.len(), |i, j| x[(i, order[j])] / masses[order[j]].sqrt()),
        }
    }
}

impl Spectrum {
    /// The first eigenvalue that is more than rounding.
    pub(super) fn first_elastic(&self) -> Option<f64> {
        self.lambda.iter().zip(&self.rounding).find(|(lambda, rounding)| lambda > rounding).map(|(lambda, _)| *lambda)
    }
}

/// The column of least (K + M) energy, each brought to unit diagonal: where a motion without stiffness and mass is largest.
pub(super) fn emptiest(k: MatRef<'_, f64>, m: MatRef<'_, f64>) -> Result<usize> {
    let unit = |a: MatRef<'_, f64>| a.norm_max().max(f64::MIN_POSITIVE);
    let sum = Mat::from_fn(k.nrows(), k.nrows(), |i, j| k[(i, j)] / unit(k) + m[(i, j)] / unit(m));
    let (scaled, _) = dense::unit_diagonal(sum.as_ref());
    let (_, vectors) = dense::symmetric_eigen(scaled.as_ref())?;
    Ok((0..k.nrows()).max_by(|a, b| vectors[(*a, 0)].abs().total_cmp(&vectors[(*b, 0)].abs())).unwrap_or(0))
}
