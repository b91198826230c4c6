//! The space that the response of the full model was found in, as a cache keeps it.
//!
//! ```text
//! Ψ_e                               n' × r_e           its basis, the interface dofs as they are and first
//! Ψ_eᵀKΨ_e, Ψ_eᵀMΨ_e                r_e × r_e          the full model on it
//! T                                 (n_B + 2 r_e)²     D [F KΨ_e MΨ_e] = Q T: the lengths of all residuals on it
//! ```
//! It belongs to K and M alone: another method, another number of modes, another band or another damping asks the same full model. What it
//! does not answer with a small residual shows in T before a product is made, and the comparison begins anew then. The residual at the
//! hardest sample is made of the sparse matrices as well, so that no answer rests on what a file says.

use faer::{Mat, MatRef, c64};
use rayon::prelude::*;

use super::super::evidence::Evidence;
use super::shift::shift;
use crate::cache::{Key, Kind, Reader, Recorded, Writer};
use crate::dense;
use crate::eigen::{Equilibrated, Spectral, complex_shift};
use crate::error::Result;
use crate::factor::SolveOperator;
use crate::sparse::product;

/// Relative residual that ends the iteration, and up to which a space of an earlier run answers. The error of the response is of the order of
/// its square, times at most the ratio of the peak to the static response.
pub(super) const RESIDUAL: f64 = 1e-7;

/// What a comparison of responses asks of the full model.
pub(super) trait FullModel {
    /// The full model as far as it is known.
    fn spectral(&self) -> &Spectral;

    /// The basis that it is known on, n' × r_e.
    fn basis(&self) -> MatRef<'_, f64>;

    /// Makes the answers at samples known, and says how large the residual of each is; none where this model has no answer to one.
    ///
    /// # Errors
    /// A projected pencil that is not definite.
    fn settle(&mut self, samples_hz: &[f64]) -> Result<Option<Vec<f64>>>;

    /// Bound on the error of the response at a frequency, entry by entry as the product of two numbers of the rows; see [`bound_of`].
    fn bound(&self, frequency_hz: f64) -> Vec<f64>;
}

/// The space of a response.
pub(super) struct Space {
    pub(super) basis: Mat<f64>,
    pub(super) stiffness: Mat<f64>,
    pub(super) mass: Mat<f64>,
    pub(super) triangle: Mat<f64>,
}

impl Space {
    /// The key of the spaces of a full model.
    pub(super) fn key(evidence: &Evidence<'_>) -> Key {
        evidence.partition.key("space of the response")
    }
}

impl Recorded for Space {
    const KIND: Kind = Kind::Space;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        let Self { basis, stiffness, mass, triangle } = self;
        [basis, stiffness, mass, triangle].into_iter().try_for_each(|matrix| to.columns(matrix.as_ref()))
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let [basis, stiffness, mass, triangle] = [from.columns()?, from.columns()?, from.columns()?, from.columns()?];
        let r = basis.ncols();
        let is_square = [&stiffness, &mass].into_iter().all(|matrix| [matrix.nrows(), matrix.ncols()] == [r; 2]);
        (is_square && triangle.ncols() > 2 * r).then_some(Self { basis, stiffness, mass, triangle })
    }
}

/// The full model on a space of an earlier run.
pub(super) struct Known<'a> {
    evidence: &'a Evidence<'a>,
    eta: f64,
    space: Space,
    spectral: Spectral,
    scale: Vec<f64>,
}

impl<'a> Known<'a> {
    /// The full model on a space; none where the space is that of another model.
    pub(super) fn of(evidence: &'a Evidence<'a>, space: Space, eta: f64) -> Option<Self> {
        let (n, n_b) = (evidence.partition.n_dofs(), evidence.partition.n_interface());
        if space.basis.nrows() != n || space.triangle.ncols() != n_b + 2 * space.basis.ncols() {
            return None;
        }
        let spectral = Spectral::of(space.stiffness.as_ref(), space.mass.as_ref(), shift(evidence).ok()?).ok()?;
        let scale = Equilibrated::of(evidence.partition.pencil()).scale;
        Some(Self { evidence, eta, space, spectral, scale })
    }

    /// (1 + iη) R of unit forces at a frequency, by products with the sparse matrices, real and imaginary part.
    fn residual(&self, frequency_hz: f64) -> [Mat<f64>; 2] {
        let partition = self.evidence.partition;
        let (n_i, n_b, r) = (partition.n_internal, partition.n_interface(), self.space.basis.ncols());
        coefficients(self.evidence, &self.spectral, (frequency_hz, self.eta)).map(|coefficients| {
            let of_space =
                |first: usize| dense::product(self.space.basis.as_ref(), coefficients.as_ref().subrows(first, r));
            let mut part = product(&partition.stiffness, of_space(n_b).as_ref());
            part += product(&partition.mass, of_space(n_b + r).as_ref());
            for j in 0..n_b {
                for i in 0..n_b {
                    part[(n_i + i, j)] += coefficients[(i, j)];
                }
            }
            part
        })
    }

    /// The largest relative residual of a column at a frequency, by the sparse matrices.
    fn residual_size(&self, frequency_hz: f64) -> f64 {
        let parts = self.residual(frequency_hz);
        let scaled = parts.map(|part| Mat::from_fn(part.nrows(), part.ncols(), |i, j| part[(i, j)] * self.scale[i]));
        largest_column(&scaled, &self.scale[self.evidence.partition.n_internal..])
    }
}

impl FullModel for Known<'_> {
    fn spectral(&self) -> &Spectral {
        &self.spectral
    }

    fn basis(&self) -> MatRef<'_, f64> {
        self.space.basis.as_ref()
    }

    fn settle(&mut self, samples_hz: &[f64]) -> Result<Option<Vec<f64>>> {
        let interface_scale = &self.scale[self.evidence.partition.n_internal..];
        let size = |hz: &f64| {
            let coefficients = coefficients(self.evidence, &self.spectral, (*hz, self.eta));
            size_by(self.space.triangle.as_ref(), coefficients, interface_scale)
        };
        let sizes: Vec<f64> = samples_hz.par_iter().map(size).collect();
        let is_small = |size: f64| size <= RESIDUAL;
        let is_known = sizes.iter().all(|size| is_small(*size))
            && (0..sizes.len())
                .max_by(|a, b| sizes[*a].total_cmp(&sizes[*b]))
                .is_none_or(|hardest| is_small(self.residual_size(samples_hz[hardest])));
        Ok(is_known.then_some(sizes))
    }

    fn bound(&self, frequency_hz: f64) -> Vec<f64> {
        bound_of(self.evidence.factor, self.evidence, (self.residual(frequency_hz), self.eta))
    }
}

/// What (1 + iη) R is made of: coefficients of F, KΨ_e and MΨ_e, real and imaginary part, (n_B + 2 r_e) × n_B each.
pub(super) fn coefficients(evidence: &Evidence<'_>, spectral: &Spectral, (hz, eta): (f64, f64)) -> [Mat<f64>; 2] {
    let (n_b, r) = (evidence.partition.n_interface(), spectral.n());
    let z: c64 = complex_shift(evidence.partition.scaling.eigenvalue(hz), eta);
    let [re, im] = spectral.columns(z, n_b);
    // M Ψ (z C), part by part.
    let part = |own: &Mat<f64>, unit: f64, (a, b): (f64, f64)| {
        Mat::from_fn(n_b + 2 * r, n_b, |i, j| match i {
            i if i < n_b => unit * f64::from(u8::from(i == j)),
            i if i < n_b + r => -own[(i - n_b, j)],
            i => a * re[(i - n_b - r, j)] + b * im[(i - n_b - r, j)],
        })
    };
    [part(&re, 1.0, (z.re, -z.im)), part(&im, 0.0, (z.im, z.re))]
}

/// The largest relative residual of a column by T; `interface_scale` are the scales of the interface dofs.
pub(super) fn size_by(triangle: MatRef<'_, f64>, coefficients: [Mat<f64>; 2], interface_scale: &[f64]) -> f64 {
    largest_column(&coefficients.map(|part| dense::product(triangle, part.as_ref())), interface_scale)
}

/// The largest length of a column of two parts over its scale.
fn largest_column([real, imaginary]: &[Mat<f64>; 2], scale: &[f64]) -> f64 {
    (0..real.ncols()).fold(0.0, |worst, j| {
        let square = |part: &Mat<f64>| dense::norm(dense::column(part.as_ref(), j)).powi(2);
        let relative = (square(real) + square(imaginary)).sqrt() / scale[j];
        if dense::worse(relative, worst) { relative } else { worst }
    })
}

/// Bound on the error of the response, entry by entry as the product of two numbers of the rows: |ΔH_ij| ≤ ρ_i ρ_j / η with
/// ρ_j = ‖r_j‖ in the norm of K_II⁻¹, to first order in the error; `parts` are those of (1 + iη) R.
///
/// The error of a Galerkin answer is rᵀ(K_II − zM_II)⁻¹r, and 1/|1 − z/λ| is at most √(1 + η²)/η over λ > 0.
pub(super) fn bound_of(
    factor: &dyn SolveOperator,
    evidence: &Evidence<'_>,
    (parts, eta): ([Mat<f64>; 2], f64),
) -> Vec<f64> {
    let n_i = evidence.partition.n_internal;
    let squares = parts.map(|part| {
        let internal = part.as_ref().subrows(0, n_i).to_owned();
        let mut answer = internal.clone();
        factor.solve_in_place(answer.as_mut());
        let square = |j| dense::dot(dense::column(internal.as_ref(), j), dense::column(answer.as_ref(), j));
        (0..part.ncols()).map(square).collect::<Vec<f64>>()
    });
    squares[0].iter().zip(&squares[1]).map(|(re, im)| ((re + im) / eta).max(0.0).sqrt()).collect()
}
