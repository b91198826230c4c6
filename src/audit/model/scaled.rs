//! The content of the file in the scaled units of the partition.

use faer::{Mat, MatRef, Side};
use supel_runtime::Superelement;

use crate::audit::content::unpacked;
use crate::audit::spectrum::{Eigenpairs, eigenpairs};
use crate::dense;
use crate::error::Result;
use crate::partition::Partition;

/// K̂, M̂, Û and λ as the stages of the model see them.
pub(super) struct Scaled {
    pub(super) k: Mat<f64>,
    pub(super) m: Mat<f64>,
    pub(super) u: Mat<f64>,
    pub(super) m_f: Mat<f64>,
    pub(super) gravity: Option<Mat<f64>>,
    pub(super) n_b: usize,
    /// λ of the stated frequencies.
    pub(super) lambda: Vec<f64>,
    /// The eigenpairs of the free reduced pencil.
    pub(super) free: Eigenpairs,
    /// The first eigenvalue of the reduced pencil with its interface held, where it has one.
    pub(super) first_held: Option<f64>,
}

impl Scaled {
    pub(super) fn of(superelement: &Superelement, partition: &Partition) -> Result<Self> {
        let (tensors, units, n_b) = (superelement.tensors(), partition.scaling, superelement.n_interface());
        let shape = units.shape_unit();
        let of = |i: usize| if i < n_b { 1.0 } else { shape };
        let both =
            |a: Mat<f64>, unit: f64| Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] / (unit * of(i) * of(j)));
        let k = both(unpacked(&tensors.stiffness), units.stiffness_unit());
        let m = both(unpacked(&tensors.mass), units.mass_unit());
        let lambda: Vec<f64> =
            tensors.frequencies.iter().map(|omega| omega * omega / units.eigenvalue_unit()).collect();
        let first = lambda.iter().copied().find(|lambda| *lambda > 0.0).unwrap_or(1.0);
        let gravity = tensors.gravity.as_ref().map(|gravity| {
            Mat::from_fn(gravity.rows(), gravity.cols(), |i, j| gravity[(i, j)] / (units.mass_unit() * of(i)))
        });
        let mut m_f = unpacked(&tensors.rigid_body_mass);
        m_f *= faer::Scale(1.0 / units.mass_unit());
        let free = eigenpairs(k.as_ref(), m.as_ref(), first)?;
        let n = k.nrows() - n_b;
        let held = |a: &Mat<f64>| a.submatrix(n_b, n_b, n, n).to_owned();
        let first_held = eigenpairs(held(&k).as_ref(), held(&m).as_ref(), first)?.values.first().copied();
        Ok(Self { first_held, k, m, u: unpacked(&tensors.rigid_body_modes), m_f, gravity, n_b, lambda, free })
    }

    /// Loads K̂_BB x of interface motions x that span every motion with energy, n_B × k: x is orthonormal in
    /// K̂_BB + λM̂_BB, and each load does the work λ on the motion it makes.
    ///
    /// A stiff direction counts as much as a soft one: an error in any entry of K̂_BB shows. Where that sum is not definite
    /// there are no such motions, and a load that is no number fails every check that uses it.
    pub(super) fn interface_loads(&self, lambda: f64) -> Result<Mat<f64>> {
        /// Share of the energy in that of K̂_BB + λM̂_BB below which a motion is that of a rigid body.
        const RIGID: f64 = 1e-6;
        let n = self.n_b;
        let (k, m) = (self.k.as_ref().submatrix(0, 0, n, n), self.m.as_ref().submatrix(0, 0, n, n));
        let sum = Mat::from_fn(n, n, |i, j| k[(i, j)] + lambda * m[(i, j)]);
        let d: Vec<f64> = (0..n).map(|i| dense::power_of_two_root(sum[(i, i)])).collect();
        let scaled = Mat::from_fn(n, n, |i, j| sum[(i, j)] * d[i] * d[j]);
        let Ok(factor) = scaled.llt(Side::Lower) else { return Ok(Mat::from_fn(n, 1, |_, _| f64::NAN)) };
        let l = factor.L();
        let mut c = dense::standard_form(l, Mat::from_fn(n, n, |i, j| k[(i, j)] * d[i] * d[j]));
        self.take_out_rigid_motion(&mut c, l, &d);
        dense::symmetrise(&mut c);
        let (tau, w) = dense::symmetric_eigen(c.as_ref())?;
        let kept: Vec<usize> = (0..n).filter(|j| tau[*j] > RIGID).collect();
        // K̂ x of x = D L⁻ᵀ w is D⁻¹ L w τ.
        let shares = Mat::from_fn(n, kept.len(), |i, j| w[(i, kept[j])] * (tau[kept[j]] * lambda).sqrt());
        let triangle = Mat::from_fn(n, n, |i, j| if j <= i { l[(i, j)] } else { 0.0 });
        let loads = dense::product(triangle.as_ref(), shares.as_ref());
        Ok(Mat::from_fn(n, kept.len(), |i, j| loads[(i, j)] / d[i]))
    }

    /// C ← P C P − Z Zᵀ, P = I − Z Zᵀ, with Z spanning Lᵀ D⁻¹ Û_B: rigid-body motion is told from elastic motion by Û, not
    /// by its energy, which rounding may make larger than that of the softest elastic one.
    fn take_out_rigid_motion(&self, c: &mut Mat<f64>, l: MatRef<'_, f64>, d: &[f64]) {
        let (n, n_r) = (self.n_b, self.u.ncols());
        if n_r == 0 {
            return;
        }
        let upper = Mat::from_fn(n, n, |i, j| if i <= j { l[(j, i)] } else { 0.0 });
        let motion = Mat::from_fn(n, n_r, |i, j| self.u[(i, j)] / d[i]);
        let z = dense::product(upper.as_ref(), motion.as_ref()).qr().compute_thin_Q();
        let mut projector = Mat::<f64>::identity(n, n);
        dense::add_product(projector.as_mut(), -1.0, z.as_ref(), z.transpose());
        let half = dense::product(projector.as_ref(), c.as_ref());
        *c = dense::product(half.as_ref(), projector.as_ref());
        dense::add_product(c.as_mut(), -1.0, z.as_ref(), z.transpose());
    }
}
