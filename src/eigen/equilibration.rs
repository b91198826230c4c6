//! Norms that do not depend on the units of translations and rotations.
//!
//! With D holding powers of two near 1/√K_ii, DKD has a diagonal near one. Cholesky factorisation commutes with D bit
//! for bit, so only the norms that errors are divided by need it, not the matrices.
//!
//! A row without stiffness has no such unit. Its mass gives one, 1/√(μ M_ii) with μ the least K_jj / M_jj of the other rows: at one whatever
//! the units, a small inertia would move by so much that nothing next to it is an error.

use faer::MatRef;
use rayon::prelude::*;

use crate::dense;
use crate::sparse::Leading;
use crate::sparse::Pencil;

/// Rows worth a thread of their own: tens of microseconds of work.
const ROWS_PER_TASK: usize = 1024;

/// A pencil's dof scaling and its norms in it.
#[derive(Clone, Debug)]
pub struct Equilibrated {
    /// D.
    pub scale: Vec<f64>,
    /// ‖DKD‖₁.
    pub stiffness_norm: f64,
    /// ‖DMD‖₁.
    pub mass_norm: f64,
}

impl Equilibrated {
    /// The scaling of a pencil.
    pub fn of(pencil: Pencil<'_>) -> Self {
        Self::with_rows(pencil).0
    }

    /// The scaling of a pencil, and ‖(DKD)_i‖₁ and ‖(DMD)_i‖₁ of each row.
    pub fn with_rows(pencil: Pencil<'_>) -> (Self, Vec<[f64; 2]>) {
        let Pencil { stiffness, mass } = pencil;
        let scale = scales(&stiffness.diagonal(), &mass.diagonal());
        let norm = |matrix: Leading<'_>, row: usize| {
            scale[row] * matrix.entries(row).map(|(col, a)| scale[col] * a.abs()).sum::<f64>()
        };
        let rows = (0..stiffness.rows()).into_par_iter().with_min_len(ROWS_PER_TASK);
        let rows: Vec<[f64; 2]> = rows.map(|row| [norm(stiffness, row), norm(mass, row)]).collect();
        let [stiffness_norm, mass_norm] =
            [0, 1].map(|which| rows.iter().fold(0.0, |max: f64, row| max.max(row[which])));
        (Self { scale, stiffness_norm, mass_norm }, rows)
    }

    /// Normwise backward error of (λ, x) with residual r: ‖Dr‖ / ((‖DKD‖ + |λ|‖DMD‖) ‖D⁻¹x‖), measure M-01. Without stiffness and at λ = 0
    /// no force is left of any motion, and none is needed.
    pub fn backward_error(&self, lambda: f64, x: &[f64], residual: &[f64]) -> f64 {
        let r: Vec<f64> = residual.iter().zip(&self.scale).map(|(r, d)| r * d).collect();
        let (force, size) = (dense::norm(&r), self.stiffness_norm + lambda.abs() * self.mass_norm);
        if force == 0.0 && size == 0.0 { 0.0 } else { force / (size * self.scaled_norm(x)) }
    }

    /// ‖Dr‖ / ‖D(|K||x| + |λ||M||x|)‖: the residual of (λ, x) over the terms that it is summed from, |K||x| and |M||x|.
    pub fn error_of_terms(&self, lambda: f64, residual: &[f64], [stiffness, mass]: [&[f64]; 2]) -> f64 {
        let mut squares = [0.0; 2];
        for (row, d) in self.scale.iter().enumerate() {
            let terms = stiffness[row] + lambda.abs() * mass[row];
            squares[0] += (d * residual[row]).powi(2);
            squares[1] += (d * terms).powi(2);
        }
        let [residual, terms] = squares.map(f64::sqrt);
        if residual > 0.0 { residual / terms } else { 0.0 }
    }

    /// The row where a residual is largest, equilibrated; a row that is not a number comes first.
    pub fn largest(&self, residual: &[f64]) -> usize {
        let mut worst = (0.0, 0);
        for (row, (r, d)) in residual.iter().zip(&self.scale).enumerate() {
            if dense::worse(r.abs() * d, worst.0) {
                worst = (r.abs() * d, row);
            }
        }
        worst.1
    }

    /// ‖D⁻¹x‖.
    pub fn scaled_norm(&self, x: &[f64]) -> f64 {
        let x: Vec<f64> = x.iter().zip(&self.scale).map(|(x, d)| x / d).collect();
        dense::norm(&x)
    }

    /// The norms of a small dense pencil in given scales.
    pub fn of_dense(stiffness: MatRef<'_, f64>, mass: MatRef<'_, f64>, scale: Vec<f64>) -> Self {
        let n = stiffness.nrows();
        let norm = |matrix: MatRef<'_, f64>| {
            (0..n).fold(0.0, |max: f64, j| {
                max.max(scale[j] * (0..n).map(|i| scale[i] * matrix[(i, j)].abs()).sum::<f64>())
            })
        };
        Self { stiffness_norm: norm(stiffness), mass_norm: norm(mass), scale }
    }
}

/// D of the diagonals of K and M.
fn scales(stiffness: &[f64], mass: &[f64]) -> Vec<f64> {
    let rows = || stiffness.iter().zip(mass);
    let ratios = rows().filter(|(k, m)| **k > 0.0 && **m > 0.0).map(|(k, m)| k / m);
    let least = ratios.fold(f64::INFINITY, f64::min);
    let unit = |(k, m): (&f64, &f64)| if *k == 0.0 { least * m } else { *k };
    rows().map(|row| dense::power_of_two_root(unit(row))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_without_stiffness_has_the_unit_of_its_mass() {
        assert_eq!(scales(&[4.0, 16.0, 0.0, 0.0], &[1.0, 1.0, 0.25, 0.0]), [0.5, 0.25, 1.0, 1.0]);
        assert_eq!(scales(&[4.0, 16.0, 0.0, -4.0], &[1.0, 1.0, 1.0 / 64.0, 1.0]), [0.5, 0.25, 4.0, 1.0]);
        // Without any stiffness there is no unit but one.
        assert_eq!(scales(&[0.0, 0.0], &[1e-20, 1.0]), [1.0, 1.0]);
    }
}
