//! D (K − σM) D as the fronts take it in: entry by entry, straight from K and M.

use faer::{Mat, MatMut};

use super::Analysis;
use super::analysis::Supernode;
use crate::sparse::Leading;
use crate::sparse::Pencil;

/// D (K − σM) D with a diagonal D, never formed as a whole.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shifted<'a> {
    pub(super) pencil: Pencil<'a>,
    pub(super) sigma: f64,
    /// Powers of two for all dofs, the border's included; none for ones.
    pub(super) scale: Option<&'a [f64]>,
    /// Dofs that stay, the last ones.
    pub(super) n_border: usize,
}

impl Shifted<'_> {
    /// Adds the matrix's columns of a supernode to its trapezoid, which holds zeros; `place` is the row of the front at each
    /// later step.
    pub(super) fn add_columns(
        &self,
        analysis: &Analysis,
        node: &Supernode<'_>,
        place: &[u32],
        mut trapezoid: MatMut<'_, f64>,
    ) {
        let (given, step_of) = (analysis.given(), analysis.step());
        for (j, step) in node.steps.clone().enumerate() {
            let column = crate::dense::column_mut(trapezoid.as_mut(), j);
            self.for_each_in_row(given[step] as usize, |dof, value| {
                let row = step_of[dof] as usize;
                if row >= node.steps.end {
                    column[place[row] as usize] += value;
                } else if row >= step {
                    column[row - node.steps.start] += value;
                }
            });
        }
    }

    /// The block of the border, both triangles.
    pub(super) fn border(&self) -> Mat<f64> {
        let first = self.pencil.stiffness.rows() - self.n_border;
        let mut block = Mat::zeros(self.n_border, self.n_border);
        for i in 0..self.n_border {
            self.for_each_in_row(first + i, |dof, value| {
                if dof >= first {
                    block[(i, dof - first)] += value;
                }
            });
        }
        block
    }

    /// No entry exceeds this: the largest entry of D K D and that of σ D M D together.
    pub(super) fn largest_entry(&self) -> f64 {
        let largest = |matrix: Leading<'_>, factor: f64| {
            (0..matrix.rows()).fold(0.0f64, |max, row| {
                let mut of_row = max;
                for (col, value) in matrix.entries(row) {
                    let scale = self.scale.map_or(1.0, |scale| scale[row] * scale[col]);
                    of_row = of_row.max((factor * value * scale).abs());
                }
                of_row
            })
        };
        largest(self.pencil.stiffness, 1.0) + largest(self.pencil.mass, self.sigma)
    }

    /// Gives the terms k and −σm of a row; at one place the term of K comes first.
    fn for_each_in_row(&self, row: usize, mut take: impl FnMut(usize, f64)) {
        let scale = |col: usize| self.scale.map_or(1.0, |scale| scale[row] * scale[col]);
        self.pencil.stiffness.entries(row).for_each(|(col, k)| take(col, k * scale(col)));
        if self.sigma != 0.0 {
            self.pencil.mass.entries(row).for_each(|(col, m)| take(col, -self.sigma * m * scale(col)));
        }
    }
}
