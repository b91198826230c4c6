//! The full model computed densely: responses by complex elimination or by all its modes, without a line of the library.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side, c64};
use supel_models::Model;

/// K and M of a model, dense, in the model's units.
pub(crate) struct Dense {
    pub(crate) k: Mat<f64>,
    pub(crate) m: Mat<f64>,
}

impl Dense {
    pub(crate) fn of(model: &Model) -> Self {
        let full = |entries: &[supel_models::model::Entry]| {
            let mut a = Mat::zeros(model.n, model.n);
            entries.iter().for_each(|&(i, j, value)| a[(i as usize, j as usize)] = value);
            a
        };
        Self { k: full(&model.stiffness), m: full(&model.mass) }
    }

    /// These matrices under a congruence.
    pub(crate) fn transformed(&self, t: &Mat<f64>) -> Self {
        Self { k: t.transpose() * &self.k * t, m: t.transpose() * &self.m * t }
    }

    /// H = [(K (1 + iη) − ω²M)⁻¹]_BB by elimination.
    pub(crate) fn response(&self, dofs: &[usize], frequency_hz: f64, eta: f64) -> Mat<c64> {
        response(self, dofs, frequency_hz, eta)
    }

    /// Rows and columns of these dofs.
    pub(crate) fn restricted(&self, kept: &[usize]) -> Self {
        let part = |a: &Mat<f64>| Mat::from_fn(kept.len(), kept.len(), |i, j| a[(kept[i], kept[j])]);
        Self { k: part(&self.k), m: part(&self.m) }
    }

    /// The finite frequencies of a pencil whose mass may be singular, ascending, in Hz: by θ = 1/(λ + α), which is zero for the others.
    pub(crate) fn finite_hz(&self, alpha: f64) -> Vec<f64> {
        let n = self.k.nrows();
        let sum = Mat::from_fn(n, n, |i, j| self.k[(i, j)] + alpha * self.m[(i, j)]);
        let l = sum.llt(Side::Lower).expect("K + αM is definite").L().to_owned();
        let mut c = self.m.clone();
        l.as_ref().solve_lower_triangular_in_place(&mut c);
        let mut c = c.transpose().to_owned();
        l.as_ref().solve_lower_triangular_in_place(&mut c);
        let theta = c.self_adjoint_eigenvalues(Side::Lower).expect("converges");
        let finite = theta.iter().rev().take_while(|value| **value > 1e-12 * theta[n - 1]);
        finite.map(|value| (1.0 / value - alpha).sqrt() / std::f64::consts::TAU).collect()
    }

    pub(crate) fn modes(&self) -> AllModes {
        AllModes::of(self)
    }
}

/// The dofs' columns of (K (1 + iη) − ω²M)⁻¹.
pub(crate) fn answers(dense: &Dense, dofs: &[usize], frequency_hz: f64, eta: f64) -> Mat<c64> {
    let (k, m) = (&dense.k, &dense.m);
    let omega = std::f64::consts::TAU * frequency_hz;
    let n = k.nrows();
    let a = Mat::from_fn(n, n, |i, j| c64::new(k[(i, j)] - omega * omega * m[(i, j)], eta * k[(i, j)]));
    let f = Mat::from_fn(n, dofs.len(), |i, j| c64::new(f64::from(u8::from(i == dofs[j])), 0.0));
    a.partial_piv_lu().solve(&f)
}

/// The dofs' block of (K (1 + iη) − ω²M)⁻¹.
pub(crate) fn response(dense: &Dense, dofs: &[usize], frequency_hz: f64, eta: f64) -> Mat<c64> {
    let x = answers(dense, dofs, frequency_hz, eta);
    Mat::from_fn(dofs.len(), dofs.len(), |i, j| x[(dofs[i], j)])
}

/// All modes of a pencil with definite mass.
pub(crate) struct AllModes {
    pub(crate) lambda: Vec<f64>,
    pub(crate) shapes: Mat<f64>,
}

impl AllModes {
    fn of(dense: &Dense) -> Self {
        let l = dense.m.llt(Side::Lower).expect("M is definite").L().to_owned();
        let mut c = dense.k.clone();
        l.as_ref().solve_lower_triangular_in_place(&mut c);
        let mut c = c.transpose().to_owned();
        l.as_ref().solve_lower_triangular_in_place(&mut c);
        let eigen = c.self_adjoint_eigen(Side::Lower).expect("converges");
        let mut shapes = eigen.U().to_owned();
        l.transpose().solve_upper_triangular_in_place(&mut shapes);
        Self { lambda: eigen.S().column_vector().iter().copied().collect(), shapes }
    }

    /// Frequencies after the first `n_zero`, in Hz.
    pub(crate) fn elastic_hz(&self, n_zero: usize) -> Vec<f64> {
        self.lambda[n_zero..].iter().map(|lambda| lambda.sqrt() / std::f64::consts::TAU).collect()
    }

    /// H = Σ x xᵀ / (λ (1 + iη) − ω²); zero modes have λ = 0.
    pub(crate) fn response(&self, dofs: &[usize], n_zero: usize, frequency_hz: f64, eta: f64) -> Mat<c64> {
        let omega = std::f64::consts::TAU * frequency_hz;
        let weight = |j: usize| {
            let lambda = if j < n_zero { 0.0 } else { self.lambda[j] };
            c64::new(1.0, 0.0) / c64::new(lambda - omega * omega, eta * lambda)
        };
        let n_b = dofs.len();
        let weights: Vec<c64> = (0..self.lambda.len()).map(weight).collect();
        let part = |of: fn(&c64) -> f64| {
            let left = Mat::from_fn(n_b, weights.len(), |i, j| self.shapes[(dofs[i], j)] * of(&weights[j]));
            left * Mat::from_fn(weights.len(), n_b, |j, i| self.shapes[(dofs[i], j)])
        };
        let (re, im) = (part(|w| w.re), part(|w| w.im));
        Mat::from_fn(n_b, n_b, |i, j| c64::new(re[(i, j)], im[(i, j)]))
    }
}

/// The matrices of a superelement.
pub(crate) fn reduced(superelement: &supel_runtime::Superelement) -> Dense {
    let tensors = superelement.tensors();
    let dense = |a: &supel_runtime::Matrix| Mat::from_fn(a.rows(), a.cols(), |i, j| a.get(i, j).expect("inside"));
    Dense { k: dense(&tensors.stiffness), m: dense(&tensors.mass) }
}

/// The error measure of the report, written out once more: dB over all pairs, pairs more than 60 dB below their driving
/// points judged by those.
pub(crate) fn decibel(full: &Mat<c64>, reduced: &Mat<c64>) -> f64 {
    let mut worst = 0.0f64;
    for i in 0..full.nrows() {
        for j in 0..full.nrows() {
            let floor = 1e-3 * (full[(i, i)].norm() * full[(j, j)].norm()).sqrt();
            let size = full[(i, j)].norm().max(floor);
            let levels = 20.0 * (reduced[(i, j)].norm().max(floor) / size).log10();
            let added = 20.0 * (1.0 + (reduced[(i, j)] - full[(i, j)]).norm() / size).log10();
            worst = worst.max(levels.abs()).max(added);
        }
    }
    worst
}
