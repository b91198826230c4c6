//! The frequency response of the full model between its interface dofs, by an iteration with a stated residual.
//!
//! ```text
//! Ψ_e = [Ψ Y]                                 n' × r_e   the basis of the reduction and what the residuals add to it
//! X(z) = Ψ_e (Ψ_eᵀ(K − zM)Ψ_e)⁻¹ Ψ_eᵀ F        n' × n_B   unit forces F on the interface dofs
//! R(z) = F − (K − zM) X(z)                     n' × n_B   with the full sparse matrices
//! Y ← Y, K_II⁻¹ Re R_I, K_II⁻¹ Im R_I
//! ```
//! This is a Galerkin-Krylov iteration for the complex symmetric system (K (1 + iη) − ω²M) x = f, started from the
//! reduced answer and preconditioned with the real factor of K_II. All samples share one space and one factor: what one
//! of them needed serves the others too. It ends when the residual of every sample is small, so a wrong basis costs
//! iterations and never an error. Damping keeps the Galerkin system regular at any frequency.
//!
//! Cost: n_B to 2 n_B solves and 24 n' r_e n_B operations for each step, 2 n' (2 r_e + n_B)² for the residuals of all samples
//! together, and up to a third more where their rows are divided into panels; memory 4 n' r_e, and a panel for each thread.

use std::ops::Range;

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Scale, Side};
use rayon::prelude::*;

use super::super::evidence::Evidence;
use super::shift::shift;
use super::space::{FullModel, RESIDUAL, Space, bound_of, coefficients, size_by};
use super::triangle::triangle_of_panels;
use crate::dense;
use crate::eigen::{Equilibrated, Spectral, mass_qr};
use crate::error::{Error, Result};
use crate::factor::SolveOperator;
use crate::reduction::panel_of;
use crate::sparse::product;

/// Steps after which the residual is taken as it is, and stated.
const MAX_STEPS: usize = 24;
/// Steps without progress after which the limit of arithmetic is met. A band with modes that the basis lacks makes none
/// for a few steps, until they are found.
const MAX_IDLE: usize = 4;
/// A residual above this share of the smallest so far is not progress.
const PROGRESS: f64 = 0.7;
/// Residual columns, relative to the largest, that are worth a solve of their own.
const WORTH_A_SOLVE: f64 = 1e-6;
/// Length a new direction must keep after those before it are taken out.
const INDEPENDENT: f64 = 1e-8;
/// Samples looked at in every step; the others wait until these are answered.
const PROBES: usize = 3;

/// The full model on the growing basis.
pub(super) struct Extended<'a> {
    evidence: &'a Evidence<'a>,
    factor: &'a dyn SolveOperator,
    eta: f64,
    /// The shift of spectral forms.
    alpha: f64,
    /// Ψ_e, KΨ_e and MΨ_e.
    basis: Mat<f64>,
    forces: Mat<f64>,
    momenta: Mat<f64>,
    /// Ψ_eᵀKΨ_e and Ψ_eᵀMΨ_e.
    stiffness: Mat<f64>,
    mass: Mat<f64>,
    /// Their spectral form.
    pub(super) spectral: Spectral,
    /// Powers of two that make residuals of translations and rotations comparable.
    scale: Vec<f64>,
    /// Steps taken.
    steps: usize,
    /// The triangle T of all residuals on the basis as it is, once it has been needed.
    triangle: Option<Mat<f64>>,
}

/// A residual R(z), n' × n_B.
struct Residual {
    parts: [Mat<f64>; 2],
    /// The largest relative residual of a column.
    size: f64,
}

impl<'a> Extended<'a> {
    /// Starts from the basis of the reduction.
    ///
    /// # Errors
    /// A projected pencil that is not definite.
    pub(super) fn new(evidence: &'a Evidence<'a>, factor: &'a dyn SolveOperator, eta: f64) -> Result<Self> {
        let partition = evidence.partition;
        let basis = panel_of(evidence.basis, 0..evidence.basis.n_reduced());
        let (forces, momenta) =
            rayon::join(|| product(&partition.stiffness, basis.as_ref()), || product(&partition.mass, basis.as_ref()));
        let project = |image: &Mat<f64>| {
            let mut projected = dense::gram(basis.as_ref(), image.as_ref());
            dense::symmetrise(&mut projected);
            projected
        };
        let (stiffness, mass) = (project(&forces), project(&momenta));
        let alpha = shift(evidence)?;
        let spectral = Spectral::of(stiffness.as_ref(), mass.as_ref(), alpha)?;
        let scale = Equilibrated::of(partition.pencil()).scale;
        Ok(Self {
            evidence,
            factor,
            eta,
            alpha,
            basis,
            forces,
            momenta,
            stiffness,
            mass,
            spectral,
            scale,
            steps: 0,
            triangle: None,
        })
    }

    /// Extends the basis until the residual of every sample is small or falls no more; returns the residual of each.
    ///
    /// # Errors
    /// A projected pencil that is not definite.
    fn settled(&mut self, samples_hz: &[f64]) -> Result<Vec<f64>> {
        let n = samples_hz.len();
        let n_probes = PROBES.min(n);
        // The last sample is the hardest as a rule and always among them.
        let mut probes: Vec<f64> = (1..=n_probes).map(|i| samples_hz[i * n / n_probes - 1]).collect();
        let (mut smallest, mut n_idle) = (f64::INFINITY, 0);
        loop {
            let residuals = probes.iter().map(|hz| self.residual(*hz));
            let worst = residuals.reduce(|a, b| if dense::worse(b.size, a.size) { b } else { a });
            let Some(worst) = worst else { return Ok(Vec::new()) };
            if worst.size <= RESIDUAL {
                let all = self.residual_sizes(samples_hz);
                match (0..n).max_by(|a, b| all[*a].total_cmp(&all[*b])).filter(|at| all[*at] > RESIDUAL) {
                    Some(at) if self.steps < MAX_STEPS && !probes.contains(&samples_hz[at]) => {
                        probes.push(samples_hz[at]);
                        (smallest, n_idle) = (f64::INFINITY, 0);
                        continue;
                    }
                    _ => return Ok(all),
                }
            }
            n_idle = if worst.size <= PROGRESS * smallest { 0 } else { n_idle + 1 };
            smallest = worst.size.min(smallest);
            let is_stuck = worst.size.is_nan() || n_idle == MAX_IDLE;
            if is_stuck || self.steps == MAX_STEPS || !self.grow(&worst)? {
                return Ok(self.residual_sizes(samples_hz));
            }
        }
    }

    /// The relative residual of every sample.
    ///
    /// All residuals are combinations of the columns of D [F KΨ_e MΨ_e] = Q T, so their lengths are those of the same
    /// combinations of the small T. That loses no digit: the combination is summed before it is squared.
    fn residual_sizes(&mut self, samples_hz: &[f64]) -> Vec<f64> {
        let triangle = self.triangle.take().unwrap_or_else(|| self.triangle());
        let interface_scale = &self.scale[self.evidence.partition.n_internal..];
        let size = |hz: &f64| size_by(triangle.as_ref(), self.coefficients(*hz), interface_scale);
        let sizes = samples_hz.par_iter().map(size).collect();
        self.triangle = Some(triangle);
        sizes
    }

    /// T.
    fn triangle(&self) -> Mat<f64> {
        let (n_i, n_b) = (self.evidence.partition.n_internal, self.evidence.partition.n_interface());
        let r = self.basis.ncols();
        let panel = |rows: Range<usize>| {
            Mat::from_fn(rows.len(), n_b + 2 * r, |i, j| {
                let i = rows.start + i;
                self.scale[i]
                    * match j {
                        j if j < n_b => f64::from(u8::from(i == n_i + j)),
                        j if j < n_b + r => self.forces[(i, j - n_b)],
                        j => self.momenta[(i, j - n_b - r)],
                    }
            })
        };
        triangle_of_panels((self.basis.nrows(), n_b + 2 * r), panel)
    }

    fn coefficients(&self, frequency_hz: f64) -> [Mat<f64>; 2] {
        coefficients(self.evidence, &self.spectral, (frequency_hz, self.eta))
    }

    /// (1 + iη) R of unit forces at a frequency.
    fn residual(&self, frequency_hz: f64) -> Residual {
        let (n_i, n_b) = (self.evidence.partition.n_internal, self.evidence.partition.n_interface());
        let r = self.basis.ncols();
        let parts = self.coefficients(frequency_hz).map(|coefficients| {
            let mut part = Mat::zeros(self.basis.nrows(), n_b);
            part.as_mut().subrows_mut(n_i, n_b).copy_from(coefficients.as_ref().subrows(0, n_b));
            dense::add_product(part.as_mut(), 1.0, self.forces.as_ref(), coefficients.as_ref().subrows(n_b, r));
            dense::add_product(part.as_mut(), 1.0, self.momenta.as_ref(), coefficients.as_ref().subrows(n_b + r, r));
            part
        });
        let mut size = 0.0;
        for j in 0..n_b {
            let square = |part: &Mat<f64>| {
                let column = dense::column(part.as_ref(), j).iter().zip(&self.scale);
                let scaled: Vec<f64> = column.map(|(r, d)| r * d).collect();
                dense::dot(&scaled, &scaled)
            };
            let relative = (square(&parts[0]) + square(&parts[1])).sqrt() / self.scale[n_i + j];
            if dense::worse(relative, size) {
                size = relative;
            }
        }
        Residual { parts, size }
    }

    /// Adds what the factor of K_II answers to a residual; false where nothing new is left, or nothing but rounding.
    fn grow(&mut self, residual: &Residual) -> Result<bool> {
        self.steps += 1;
        self.triangle = None;
        let partition = self.evidence.partition;
        let (n_i, n, n_before) = (partition.n_internal, partition.n_dofs(), self.basis.ncols());
        let loads = self.compressed(residual)?;
        let mut directions = loads.clone();
        self.factor.solve_in_place(directions.as_mut());
        let fresh = self.independent(directions, loads)?;
        if fresh.ncols() == 0 {
            return Ok(false);
        }
        let mut padded = Mat::zeros(n, fresh.ncols());
        padded.as_mut().subrows_mut(0, n_i).copy_from(&fresh);
        let force = product(&partition.stiffness, padded.as_ref());
        let momentum = product(&partition.mass, padded.as_ref());
        self.basis = dense::side_by_side(self.basis.as_ref(), padded.as_ref());
        for (projected, images, image) in
            [(&mut self.stiffness, &mut self.forces, &force), (&mut self.mass, &mut self.momenta, &momentum)]
        {
            let columns = dense::gram(self.basis.as_ref(), image.as_ref());
            let old = projected.nrows();
            *projected = Mat::from_fn(columns.nrows(), columns.nrows(), |i, j| match (i < old, j < old) {
                (true, true) => projected[(i, j)],
                (_, false) => columns[(i, j - old)],
                (false, true) => columns[(j, i - old)],
            });
            dense::symmetrise(projected);
            *images = dense::side_by_side(images.as_ref(), image.as_ref());
        }
        match Spectral::of(self.stiffness.as_ref(), self.mass.as_ref(), self.alpha) {
            Ok(spectral) => self.spectral = spectral,
            // The new columns are rounding: the residual stays what it is, and is stated.
            Err(Error::DenseEigen { .. }) => {
                self.truncate(n_before);
                return Ok(false);
            }
            Err(error) => return Err(error),
        }
        Ok(true)
    }

    /// Leaves the first columns of the basis alone.
    fn truncate(&mut self, r: usize) {
        for columns in [&mut self.basis, &mut self.forces, &mut self.momenta] {
            *columns = columns.subcols(0, r).to_owned();
        }
        for projected in [&mut self.stiffness, &mut self.mass] {
            *projected = projected.submatrix(0, 0, r, r).to_owned();
        }
    }

    /// The internal rows of a residual in as few columns as hold all of it.
    fn compressed(&self, residual: &Residual) -> Result<Mat<f64>> {
        let (n_i, n_b) = (self.evidence.partition.n_internal, residual.parts[0].ncols());
        // Unit forces on unlike dofs are compared by their own scale.
        let weight: Vec<f64> = self.scale[n_i..].iter().map(|d| 1.0 / d).collect();
        let all = Mat::from_fn(n_i, 2 * n_b, |i, j| residual.parts[j / n_b][(i, j % n_b)] * weight[j % n_b]);
        let scaled = Mat::from_fn(n_i, 2 * n_b, |i, j| all[(i, j)] * self.scale[i]);
        let mut products = dense::gram(scaled.as_ref(), scaled.as_ref());
        dense::symmetrise(&mut products);
        let (squares, directions) = dense::symmetric_eigen(products.as_ref())?;
        let least = squares.last().copied().unwrap_or(0.0) * WORTH_A_SOLVE.powi(2);
        let first = squares.iter().position(|square| *square > least.max(0.0)).unwrap_or(squares.len());
        Ok(dense::product(all.as_ref(), directions.as_ref().subcols(first, squares.len() - first)))
    }

    /// Columns that are orthonormal to one another and to the dynamic columns of the basis, in the norm W = M_II + K_II/α that spectral forms
    /// factor; dependent ones are left out.
    ///
    /// In M_II alone columns would be told apart that differ in the little mass of a motion which has all their energy, as of rotations that
    /// nothing but a drilling spring holds: with stiffness there is nothing to tell them by. `loads` are what the columns answer to, K_II times
    /// them.
    fn independent(&self, mut block: Mat<f64>, loads: Mat<f64>) -> Result<Mat<f64>> {
        let (n_i, n_b) = (self.evidence.partition.n_internal, self.evidence.partition.n_interface());
        let (pencil, alpha) = (self.evidence.partition.internal(), self.alpha);
        let in_norm = |block: &Mat<f64>, forces: Mat<f64>| {
            let mut image = forces;
            image *= Scale(1.0 / alpha);
            image += product(pencil.mass, block.as_ref());
            image
        };
        let n_dynamic = self.basis.ncols() - n_b;
        let earlier = self.basis.as_ref().submatrix(0, n_b, n_i, n_dynamic);
        let own = Mat::from_fn(n_dynamic, n_dynamic, |i, j| {
            self.stiffness[(n_b + i, n_b + j)] / alpha + self.mass[(n_b + i, n_b + j)]
        });
        let own = own.llt(Side::Lower).map_err(|_| Error::DenseEigen { n: n_dynamic })?;
        let mut dependent = vec![false; block.ncols()];
        let fresh = |block: &Mat<f64>| in_norm(block, product(pencil.stiffness, block.as_ref()));
        let mut image = in_norm(&block, loads);
        for pass in 0..2 {
            for j in 0..block.ncols() {
                let length =
                    dense::dot(dense::column(block.as_ref(), j), dense::column(image.as_ref(), j)).max(0.0).sqrt();
                let factor = if length > 0.0 { 1.0 / length } else { 0.0 };
                for side in [&mut block, &mut image] {
                    dense::column_mut(side.as_mut(), j).iter_mut().for_each(|value| *value *= factor);
                }
            }
            let coefficients = own.solve(dense::gram(earlier, image.as_ref()));
            dense::add_product(block.as_mut(), -1.0, earlier, coefficients.as_ref());
            image = fresh(&block);
            let least = if pass == 0 { INDEPENDENT } else { 0.0 };
            mass_qr(&mut block, &mut image, least, &mut dependent);
            if pass == 0 {
                // Of a column of which little was left its image is rounding of the terms of what was taken out.
                image = fresh(&block);
            }
        }
        let kept: Vec<usize> = (0..block.ncols()).filter(|j| !dependent[*j]).collect();
        Ok(dense::columns(block.as_ref(), &kept))
    }

    /// The spectral form of the full model on the basis, and Ψ_eᵀKΨ_e.
    pub(super) fn into_pencil(self) -> (Spectral, Mat<f64>) {
        (self.spectral, self.stiffness)
    }

    /// What answers in this space again, where every residual is small; none where one is not.
    pub(super) fn space(&self, residuals: &[f64]) -> Option<Space> {
        let is_settled = residuals.iter().all(|size| *size <= RESIDUAL);
        let Self { basis, stiffness, mass, .. } = self;
        let triangle = self.triangle.as_ref().filter(|_| is_settled)?.clone();
        Some(Space { basis: basis.clone(), stiffness: stiffness.clone(), mass: mass.clone(), triangle })
    }
}

impl FullModel for Extended<'_> {
    fn spectral(&self) -> &Spectral {
        &self.spectral
    }

    fn basis(&self) -> MatRef<'_, f64> {
        self.basis.as_ref()
    }

    fn settle(&mut self, samples_hz: &[f64]) -> Result<Option<Vec<f64>>> {
        self.settled(samples_hz).map(Some)
    }

    fn bound(&self, frequency_hz: f64) -> Vec<f64> {
        bound_of(self.factor, self.evidence, (self.residual(frequency_hz).parts, self.eta))
    }
}
