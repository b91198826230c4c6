//! Linear equations with joints, by the Schur complement.
//!
//! ```text
//! S   n × n   iteration matrix, positive definite on the free coordinates
//! B   m × n   gradients of the joints
//! ```
//! [S Bᵀ; B 0] (dq, dλ) = −(r, g): S is factored once, B S⁻¹ Bᵀ whenever the joints have turned.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};

use crate::Result;
use crate::system::{Configuration, System};

/// Gradients of the joints, m rows of n.
pub(crate) struct Gradients {
    rows: Vec<Vec<f64>>,
}

impl Gradients {
    pub(crate) fn new(system: &System, at: &Configuration) -> Self {
        let n = system.n();
        let dense = |gradient: &[(usize, [f64; 3])]| {
            let mut row = vec![0.0; n];
            gradient.iter().for_each(|(node, g)| row[6 * node..6 * node + 3].copy_from_slice(g));
            row
        };
        Self { rows: system.constraints(at).iter().map(|row| dense(&row.gradient)).collect() }
    }

    pub(crate) fn times(&self, x: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| row.iter().zip(x).map(|(b, x)| b * x).sum()).collect()
    }

    /// r + Bᵀλ.
    pub(crate) fn add_reactions(&self, multipliers: &[f64], residual: &mut [f64]) {
        for (row, factor) in self.rows.iter().zip(multipliers) {
            residual.iter_mut().zip(row).for_each(|(r, b)| *r += factor * b);
        }
    }
}

/// [S Bᵀ; B 0] on the free coordinates, by the factor of S.
pub(crate) struct Saddle {
    factor: Llt<f64>,
    pub(crate) free: Vec<usize>,
    n: usize,
}

/// B and S⁻¹Bᵀ on the free coordinates, and the factor of B S⁻¹ Bᵀ; none without joints.
pub(crate) struct Bordered {
    gradients: Mat<f64>,
    solved: Mat<f64>,
    complement: Option<Llt<f64>>,
}

impl Saddle {
    pub(crate) fn new(s: &Mat<f64>, free: Vec<usize>) -> Result<Self> {
        let reduced = Mat::from_fn(free.len(), free.len(), |i, j| s[(free[i], free[j])]);
        let factor = reduced.llt(Side::Lower).map_err(|_| "the iteration matrix is not positive definite")?;
        Ok(Self { factor, free, n: s.nrows() })
    }

    pub(crate) fn bordered(&self, joints: &Gradients) -> Result<Bordered> {
        let gradients = Mat::from_fn(joints.rows.len(), self.free.len(), |i, j| joints.rows[i][self.free[j]]);
        let solved = self.factor.solve(gradients.transpose());
        let complement = (gradients.nrows() > 0).then(|| (&gradients * &solved).llt(Side::Lower));
        let complement = complement.transpose().map_err(|_| "the joints depend on each other")?;
        Ok(Bordered { gradients, solved, complement })
    }

    /// Changes of all coordinates and of the multipliers.
    pub(crate) fn solve(&self, bordered: &Bordered, residual: &[f64], violation: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let load = Mat::from_fn(self.free.len(), 1, |i, _| -residual[self.free[i]]);
        let mut change = self.factor.solve(&load);
        let mut multipliers = vec![0.0; violation.len()];
        if let Some(complement) = &bordered.complement {
            let held = &bordered.gradients * &change;
            let right = Mat::from_fn(violation.len(), 1, |i, _| held[(i, 0)] + violation[i]);
            let found = complement.solve(&right);
            change -= &bordered.solved * &found;
            (0..multipliers.len()).for_each(|i| multipliers[i] = found[(i, 0)]);
        }
        let mut full = vec![0.0; self.n];
        self.free.iter().enumerate().for_each(|(i, row)| full[*row] = change[(i, 0)]);
        (full, multipliers)
    }
}
