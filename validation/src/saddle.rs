//! Linear equations with joints, by the Schur complement.
//!
//! ```text
//! S   n × n   iteration matrix, positive definite on the free coordinates
//! B   m × n   gradients of the joints
//! ```
//! [S Bᵀ; B 0] (dq, dλ) = −(r, g): S is factored once, B S⁻¹ Bᵀ whenever the joints have turned.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};
use supel_runtime::motion::Vector6;

use crate::Result;
use crate::system::{Configuration, System};

/// Squared sine of the angle between a row and those before it, in the norm of S⁻¹, from which on they depend on each other:
/// multipliers keep four digits of sixteen.
const DEPENDENT: f64 = 1e-12;

/// Gradients of the joints, m rows of n, and what they are gradients of.
pub(crate) struct Gradients {
    rows: Vec<Vec<f64>>,
    pub(crate) violations: Vec<f64>,
}

impl Gradients {
    pub(crate) fn new(system: &System, time: f64, at: &Configuration) -> Self {
        let n = system.n();
        let dense = |gradient: &[(usize, Vector6)]| {
            let mut row = vec![0.0; n];
            for (node, g) in gradient {
                row[6 * node..6 * node + 6].iter_mut().zip(g).for_each(|(sum, value)| *sum += value);
            }
            row
        };
        let rows = system.constraints(time, at).into_iter();
        let (violations, rows) = rows.map(|row| (row.violation, dense(&row.gradient))).unzip();
        Self { rows, violations }
    }

    /// B x.
    pub(crate) fn times(&self, x: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| row.iter().zip(x).map(|(b, x)| b * x).sum()).collect()
    }

    /// |B| |x|.
    pub(crate) fn magnitudes(&self, x: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| row.iter().zip(x).map(|(b, x)| (b * x).abs()).sum()).collect()
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
    /// The rows that move a free coordinate by more than rounding; supports keep the others.
    active: Vec<usize>,
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

    /// # Errors
    /// Joints that depend on each other.
    pub(crate) fn bordered(&self, joints: &Gradients) -> Result<Bordered> {
        let largest = |most: f64, b: &f64| most.max(b.abs());
        let moves = |row: &Vec<f64>| {
            let free = self.free.iter().map(|i| &row[*i]).fold(0.0, largest);
            free > 16.0 * f64::EPSILON * row.iter().fold(0.0, largest)
        };
        let active: Vec<usize> = (0..joints.rows.len()).filter(|i| moves(&joints.rows[*i])).collect();
        let gradients = Mat::from_fn(active.len(), self.free.len(), |i, j| joints.rows[active[i]][self.free[j]]);
        let solved = self.factor.solve(gradients.transpose());
        let complement = if active.is_empty() { None } else { Some(independent(&gradients * &solved)?) };
        Ok(Bordered { active, gradients, solved, complement })
    }

    /// Changes of all coordinates and of the multipliers.
    pub(crate) fn solve(&self, bordered: &Bordered, residual: &[f64], violation: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let load = Mat::from_fn(self.free.len(), 1, |i, _| -residual[self.free[i]]);
        let mut change = self.factor.solve(&load);
        let mut multipliers = vec![0.0; violation.len()];
        if let Some(complement) = &bordered.complement {
            let held = &bordered.gradients * &change;
            let right = Mat::from_fn(held.nrows(), 1, |i, _| held[(i, 0)] + violation[bordered.active[i]]);
            let found = complement.solve(&right);
            change -= &bordered.solved * &found;
            bordered.active.iter().enumerate().for_each(|(i, row)| multipliers[*row] = found[(i, 0)]);
        }
        let mut full = vec![0.0; self.n];
        self.free.iter().enumerate().for_each(|(i, row)| full[*row] = change[(i, 0)]);
        (full, multipliers)
    }
}

/// The factor of B S⁻¹ Bᵀ.
fn independent(complement: Mat<f64>) -> Result<Llt<f64>> {
    let depend = "the joints depend on each other: they hold a direction twice in which nothing deforms";
    let factor = complement.llt(Side::Lower).map_err(|_| depend)?;
    let lower = factor.L();
    let depends = (0..lower.nrows()).any(|i| lower[(i, i)].powi(2) <= DEPENDENT * complement[(i, i)]);
    if depends { Err(depend.into()) } else { Ok(factor) }
}
