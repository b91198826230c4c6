//! Residuals row by row, each against the terms of its own row.
//!
//! ```text
//! ω_i = |r_i| / ((|K| + |λ||M|)|x|)_i                         a row that moves
//! ω_i = |r_i| / ((‖K_i‖ + |λ|‖M_i‖) ‖x‖_∞), equilibrated      a row at rest: its own terms are rounding themselves
//! ```
//! Arioli, Demmel and Duff (1989) tell the two kinds of rows apart by the size of their terms.

use std::ops::Range;

use faer::{Mat, MatRef};

use super::evidence::Evidence;
use crate::dense;
use crate::eigen::Equilibrated;
use crate::sparse::{Pencil, energies_of_terms, product_and_terms};

/// Share of its own norm below which the terms of a row are at rest: a pair may leave 10⁻¹³ of a row's norm (M-01), which a
/// row of smaller terms than this could not keep within 10⁻¹¹ of them (M-02).
pub(super) const AT_REST: f64 = 1e-2;

/// Row norms of a pencil.
pub(super) struct Rows<'a> {
    pencil: Pencil<'a>,
    /// D and the norms of the whole.
    pub(super) norms: Equilibrated,
    /// ‖(DKD)_i‖₁ and ‖(DMD)_i‖₁.
    of_row: Vec<[f64; 2]>,
}

impl<'a> Rows<'a> {
    pub(super) fn of(pencil: Pencil<'a>) -> Self {
        let (norms, of_row) = Equilibrated::with_rows(pencil);
        Self { pencil, norms, of_row }
    }

    /// What the columns of x, with their λ_j, leave of the pencil.
    pub(super) fn residuals(&self, x: MatRef<'_, f64>, lambda: &[f64]) -> Residuals {
        let (forces, mut terms) = product_and_terms(self.pencil.stiffness, x);
        let (mut residual, mut inertia_terms, mut moving) = (forces.clone(), vec![0.0; lambda.len()], None);
        if lambda.iter().any(|lambda| *lambda != 0.0) {
            let (momenta, of_mass) = product_and_terms(self.pencil.mass, x);
            inertia_terms = energies_of_terms(x, of_mass.as_ref());
            for (j, lambda) in lambda.iter().enumerate() {
                let column = dense::column_mut(residual.as_mut(), j);
                column
                    .iter_mut()
                    .zip(dense::column(momenta.as_ref(), j))
                    .for_each(|(r, momentum)| *r -= lambda * momentum);
                let terms = dense::column_mut(terms.as_mut(), j);
                dense::add_scaled(terms, lambda.abs(), dense::column(of_mass.as_ref(), j));
            }
            moving = Some(momenta);
        }
        Residuals { forces, momenta: moving, residual, terms, inertia_terms }
    }

    /// max ω_i over the rows that have a residual, and the row it is reached at.
    pub(super) fn componentwise(&self, lambda: f64, x: &[f64], residual: &[f64], terms: &[f64]) -> (f64, usize) {
        let mut worst = (0.0, 0);
        for (row, (r, size)) in residual.iter().zip(self.sizes(lambda, x, terms)).enumerate() {
            // A row without terms has no residual.
            let error = if *r == 0.0 { 0.0 } else { r.abs() / size };
            if dense::worse(error, worst.0) {
                worst = (error, row);
            }
        }
        worst
    }

    /// What the residual of each row is relative to: its terms, or its norm where it is at rest.
    pub(super) fn sizes(&self, lambda: f64, x: &[f64], terms: &[f64]) -> Vec<f64> {
        let d = &self.norms.scale;
        let largest = x.iter().zip(d).fold(0.0f64, |max, (x, d)| max.max((x / d).abs()));
        let size = |(row, terms): (usize, &f64)| {
            let [k, m] = self.of_row[row];
            let norm = (k + lambda.abs() * m) * largest / d[row];
            if *terms > AT_REST * norm { *terms } else { norm }
        };
        terms.iter().enumerate().map(size).collect()
    }
}

/// Residuals of some vectors in a pencil, n × k each.
pub(super) struct Residuals {
    /// K x.
    pub(super) forces: Mat<f64>,
    /// M x, where one of them has a λ.
    pub(super) momenta: Option<Mat<f64>>,
    /// K x − λ M x.
    pub(super) residual: Mat<f64>,
    /// (|K| + |λ||M|)|x|.
    pub(super) terms: Mat<f64>,
    /// |x|ᵀ|M||x| of each, where it has a λ.
    pub(super) inertia_terms: Vec<f64>,
}

/// The largest of several errors, with the column and the row it belongs to.
#[derive(Clone, Copy)]
pub(super) struct Worst {
    pub(super) value: f64,
    pub(super) at: Option<(usize, usize)>,
}

impl Worst {
    pub(super) fn none() -> Self {
        Self { value: 0.0, at: None }
    }

    pub(super) fn take(&mut self, value: f64, column: usize, row: usize) {
        if dense::worse(value, self.value) {
            *self = Self { value, at: Some((column, row)) };
        }
    }

    /// The errors of some columns: motions, their residuals and the terms of these, n × k each.
    pub(super) fn take_columns(
        &mut self,
        rows: &Rows<'_>,
        columns: Range<usize>,
        [motions, residuals, terms]: [MatRef<'_, f64>; 3],
    ) {
        for (j, column) in columns.enumerate() {
            let [x, residual, terms] = [motions, residuals, terms].map(|a| dense::column(a, j));
            let (error, at) = rows.componentwise(0.0, x, residual, terms);
            self.take(error, column, at);
        }
    }

    /// As [`Self::name`], of rows of the eigenproblem of the retained modes.
    pub(super) fn name_under(&self, evidence: &Evidence<'_>, column_is: &str) -> Option<String> {
        let dof = |row| evidence.partition.dof_under(evidence.retained.boundary, row);
        Self { at: self.at.map(|(column, row)| (column, dof(row))), ..*self }.name(evidence, column_is)
    }

    /// `mode 3, node 12 uz`.
    pub(super) fn name(&self, evidence: &Evidence<'_>, column_is: &str) -> Option<String> {
        self.at.map(|(column, row)| format!("{column_is} {}, {}", column + 1, evidence.partition.name_of(row)))
    }
}
