//! L B Lᵀ of a symmetric indefinite matrix K − σM.

mod backward_error;
mod whole;

use faer::{Mat, MatMut};

use super::elimination::{Kind, PANEL};
use super::matrix::Shifted;
use super::multifrontal::{Keep, Numbers, eliminate};
use super::substitution::Factor;
use super::{Analysis, Storage};
use crate::dense;
use crate::error::{Error, Result};
use crate::sparse::Pencil;
use crate::sparse::diagonal;

pub use whole::{WholeCount, whole_count};

/// L B Lᵀ of D (K − σM) D with pivots of order one and two inside each supernode.
///
/// D holds powers of two that bring the diagonal of |K| + |σ| M near one, which no entry then exceeds by much: pivots are
/// compared on equal terms whatever the units of translations and rotations, and however far up σ lies.
pub(super) struct Indefinite<'a> {
    analysis: &'a Analysis,
    scale: Vec<f64>,
    largest: f64,
    numbers: Numbers<f64>,
}

/// Signs of the pivots of B and what they can be trusted with.
pub(super) struct Signs {
    /// Negative eigenvalues of B.
    pub(super) negative: usize,
    /// Bound of the largest entry of |L||B||Lᵀ| over the largest entry of the scaled matrix.
    pub(super) growth: f64,
    /// Smallest pivot over largest entry of the scaled matrix.
    pub(super) smallest: f64,
}

impl<'a> Indefinite<'a> {
    pub(super) fn new(analysis: &'a Analysis, pencil: Pencil<'_>, sigma: f64, keep: Keep) -> Result<Self> {
        let diagonals = diagonal(pencil.stiffness).into_iter().zip(diagonal(pencil.mass));
        let terms: Vec<f64> = diagonals.map(|(k, m)| k.abs() + sigma.abs() * m.abs()).collect();
        let scale: Vec<f64> = terms.iter().map(|terms| dense::power_of_two_root(*terms)).collect();
        let matrix = Shifted { pencil, sigma, scale: Some(&scale), n_border: analysis.n_border() };
        // On an eigenvalue all of K − σM may cancel: what is left is measured by the terms it is left of.
        let largest_term = terms.iter().zip(&scale).fold(0.0, |max: f64, (terms, d)| max.max(terms * d * d));
        let largest = largest_term.max(matrix.largest_entry());
        let numbers = eliminate(analysis, &matrix, Kind::Indefinite, keep)
            .map_err(|_| Error::OutOfMemory { what: "the Sturm count" })?;
        Ok(Self { analysis, scale, largest, numbers })
    }

    /// The diagonal of B.
    fn diagonal(&self) -> Vec<f64> {
        self.numbers.pivots().map(|(d, _)| d).collect()
    }

    /// What stands below the diagonal of B: not zero where a pivot of two rows begins.
    fn subdiagonal(&self) -> Vec<f64> {
        self.numbers.pivots().map(|(_, coupling)| coupling).collect()
    }

    /// Row, column and value of the entries of L, its unit diagonal too; rows are numbered as the pivots came.
    fn visit(&self, mut with: impl FnMut(usize, usize, f64)) {
        let places = self.numbers.places_of_pivots(self.analysis);
        for (node, numbers) in self.numbers.supernodes(self.analysis) {
            let (start, size) = (node.steps.start, node.steps.len());
            numbers.panels.visit(|i, j, value| {
                let end_of_panel = size.min(j - j % PANEL + PANEL);
                let (row, value) = match i {
                    _ if i == j => (start + j, 1.0),
                    _ if i < end_of_panel => (start + i, value),
                    _ if i < size => (places[start + i], value),
                    _ => (places[node.below[i - size] as usize], value),
                };
                with(row, start + j, value);
            });
        }
    }

    /// Signs of the pivots of B.
    pub(super) fn signs(&self) -> Result<Signs> {
        if self.analysis.n() == 0 {
            return Ok(Signs { negative: 0, growth: 1.0, smallest: 1.0 });
        }
        let (mut negative, mut smallest) = (0, f64::INFINITY);
        let mut pivots = self.numbers.pivots();
        while let Some((d, coupling)) = pivots.next() {
            if !d.is_finite() || !coupling.is_finite() || (d == 0.0 && coupling == 0.0) {
                return Err(Error::SturmPivot);
            }
            if coupling == 0.0 {
                negative += usize::from(d < 0.0);
                smallest = smallest.min(d.abs());
                continue;
            }
            let Some((next, _)) = pivots.next() else { return Err(Error::SturmPivot) };
            let determinant = d * next - coupling * coupling;
            if !determinant.is_finite() || determinant == 0.0 {
                return Err(Error::SturmPivot);
            }
            smallest = smallest.min(determinant.abs() / d.abs().max(next.abs()).max(coupling.abs()));
            // One of each sign unless the determinant is positive; then both have the sign of the trace.
            negative += if determinant < 0.0 { 1 } else { 2 * usize::from(d < 0.0) };
        }
        let growth = self.numbers.largest_product / self.largest;
        Ok(Signs { negative, growth, smallest: smallest / self.largest })
    }

    /// S(σ), n_B × n_B: what elimination left of the border, without the scales.
    pub(super) fn schur(&self) -> Mat<f64> {
        let border = &self.scale[self.analysis.n()..];
        Mat::from_fn(border.len(), border.len(), |i, j| self.numbers.schur[(i, j)] / (border[i] * border[j]))
    }

    /// n_B.
    pub(super) fn n_border(&self) -> usize {
        self.analysis.n_border()
    }

    /// Bytes of the factor, all of which a solve reads.
    pub(super) fn bytes(&self) -> u64 {
        self.analysis.factor_bytes(Storage::Double)
    }

    /// X ← (K − σM)_II⁻¹ X, n rows.
    pub(super) fn solve_held(&self, mut block: MatMut<'_, f64>) {
        self.scale_rows(block.as_mut(), |d| d);
        self.factor().solve_in_place(block.as_mut());
        self.scale_rows(block, |d| d);
    }

    /// X ← (K − σM)⁻¹ X, n + n_B rows; `at_border` solves with S(σ).
    pub(super) fn solve_free(&self, mut block: MatMut<'_, f64>, at_border: impl Fn(MatMut<'_, f64>)) {
        let border = &self.scale[self.analysis.n()..];
        self.scale_rows(block.as_mut(), |d| d);
        self.factor().solve_with_border(block.as_mut(), |mut loads| {
            scale_rows(loads.as_mut(), border, |d| 1.0 / d);
            at_border(loads.as_mut());
            scale_rows(loads, border, |d| 1.0 / d);
        });
        self.scale_rows(block, |d| d);
    }

    fn factor(&self) -> Factor<'_, f64> {
        Factor::indefinite(self.analysis, &self.numbers)
    }

    fn scale_rows(&self, block: MatMut<'_, f64>, factor: impl Fn(f64) -> f64) {
        scale_rows(block, &self.scale, factor);
    }
}

fn scale_rows(mut block: MatMut<'_, f64>, scale: &[f64], factor: impl Fn(f64) -> f64) {
    for column in block.as_mut().col_iter_mut() {
        column.iter_mut().zip(scale).for_each(|(value, d)| *value *= factor(*d));
    }
}
