//! Internal loads of the reduced against the full model, under harmonic forces on the interface: M-34.
//!
//! ```text
//! u = Ψ_e c,  (K_e − zM_e) c = Ψ_eᵀ f                 the full model on its extended basis, f a unit force on an interface dof
//! û = Ψ ĉ,    (K̂ − zM̂) ĉ = Ψᵀ f                      the reduced model, the leading columns of that basis
//! e = ‖û − u‖_K / ‖u‖_K,  ‖x‖²_K = xᴴKx               r_e × r_e: Ψ_eᵀKΨ_e
//! ```
//! Twice the strain energy is what stresses do along strains, so that e is the error of all stresses of the component together, each
//! weighted by its own strain: what rigid-body motion makes no load of, it does not see. The factor 1 + iη is in both and cancels.
//!
//! A mode that is off by δ of its eigenvalue errs most where the reduced model resonates, by δ/η. Samples lie there, at the points of a scan,
//! and at the highest tops between these.

use faer::Mat;
use rayon::prelude::*;

use super::super::evidence::Evidence;
use super::extended::Extended;
use super::leading::leading;
use super::outcome::{InternalLoads, LoadSample};
use super::samples::merged;
use super::scan::{highest, top};
use super::shift::shift;
use crate::cost_forecast::{MAX_FLOPS, WIDEST_STEP};
use crate::dense;
use crate::eigen::{Spectral, complex_shift};
use crate::error::Result;

/// Tops that are sharpened.
const MAX_TOPS: usize = 8;

/// The answers of the full model to unit forces on its interface dofs, for reduced models to be compared with.
pub(super) struct FullLoads<'a> {
    /// Whose basis the answers of the reduced model are on.
    own: &'a Evidence<'a>,
    samples_hz: Vec<f64>,
    /// The errors of the whole reduced model at the samples.
    of_whole: Vec<Worst>,
    eta: f64,
    /// The full model on its extended basis, and Ψ_eᵀKΨ_e.
    spectral: Spectral,
    stiffness: Mat<f64>,
}

/// The largest error at a sample, and the interface dof that was driven.
#[derive(Clone, Copy)]
struct Worst {
    error: f64,
    dof: usize,
}

impl<'a> FullLoads<'a> {
    /// Takes over the full model on its basis, with samples where the whole reduced model errs most.
    ///
    /// # Errors
    /// A reduced pencil that is not definite.
    pub(super) fn new(own: &'a Evidence<'a>, extended: Extended<'_>, samples_hz: &[f64], eta: f64) -> Result<Self> {
        let (spectral, stiffness) = extended.into_pencil();
        let (samples_hz, of_whole) = (samples_hz.to_vec(), Vec::new());
        let mut loads = Self { own, samples_hz, of_whole, eta, spectral, stiffness };
        let reduced = loads.reduced(own.reduction.n_reduced())?;
        (loads.samples_hz, loads.of_whole) = loads.scanned(&reduced).into_iter().unzip();
        Ok(loads)
    }

    /// The samples, points between them, and the highest tops of the error there, ascending.
    fn scanned(&self, reduced: &Spectral) -> Vec<(f64, Worst)> {
        let (low, high) = (self.samples_hz[0], self.samples_hz[self.samples_hz.len() - 1]);
        let r = self.spectral.n() as f64;
        // Answers and forces of each driven dof, real and imaginary part, twice.
        let flops = 16.0 * r * r * self.own.partition.n_interface() as f64;
        let n_steps = ((high / low).ln() / WIDEST_STEP).ceil().min(MAX_FLOPS / flops).max(1.0) as usize;
        let at = |i: usize| low * (high / low).powf(i as f64 / n_steps as f64);
        let points = merged((1..n_steps).map(at).chain(self.samples_hz.iter().copied()).collect());
        let found = |hz: f64| (hz, self.error_at(hz, reduced));
        let mut all: Vec<(f64, Worst)> = points.par_iter().map(|hz| found(*hz)).collect();
        let error = |i: usize| all[i].1.error;
        let neighbours = |i: usize| [i.saturating_sub(1), (i + 1).min(points.len() - 1)];
        let is_top = |i: &usize| neighbours(*i).into_iter().all(|next| !dense::worse(error(next), error(*i)));
        let tops = highest((0..points.len()).filter(is_top), &error, MAX_TOPS);
        let sharpened = |i: &usize| found(top(neighbours(*i).map(|next| points[next]), &|hz| found(hz).1.error).0);
        let sharpened: Vec<(f64, Worst)> = tops.par_iter().map(sharpened).collect();
        all.extend(sharpened);
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all
    }

    /// The reduced model that has the leading `n` columns of the basis.
    fn reduced(&self, n: usize) -> Result<Spectral> {
        let (k, m) = leading(self.own, n)?;
        Spectral::of(k.as_ref(), m.as_ref(), shift(self.own)?)
    }

    /// The comparison with the whole basis, for the report.
    pub(super) fn compared(&self) -> InternalLoads {
        let errors = &self.of_whole;
        let at = (0..errors.len()).fold(0, |a, b| if dense::worse(errors[b].error, errors[a].error) { b } else { a });
        let partition = self.own.partition;
        let samples = self.samples_hz.iter().zip(errors);
        InternalLoads {
            worst: errors[at].error,
            worst_at_hz: self.samples_hz[at],
            driven: partition.name_of(partition.n_internal + errors[at].dof),
            samples: samples.map(|(hz, worst)| LoadSample { frequency_hz: *hz, error: worst.error }).collect(),
        }
    }

    /// The largest error of the reduced model that has the leading `n` columns of the basis.
    ///
    /// # Errors
    /// A reduced pencil that is not definite.
    pub(super) fn worst(&self, n: usize) -> Result<f64> {
        let reduced = self.reduced(n)?;
        let errors: Vec<f64> = self.samples_hz.par_iter().map(|hz| self.error_at(*hz, &reduced).error).collect();
        Ok(dense::worst(errors))
    }

    fn error_at(&self, frequency_hz: f64, reduced: &Spectral) -> Worst {
        let n_b = self.own.partition.n_interface();
        let z = complex_shift(self.own.partition.scaling.eigenvalue(frequency_hz), self.eta);
        let parts = self.spectral.columns(z, n_b).into_iter().zip(reduced.columns(z, n_b));
        let (mut energies, mut errors) = (vec![0.0; n_b], vec![0.0; n_b]);
        for (full, mut other) in parts {
            self.add_energies(&full, &mut energies);
            let n = other.nrows();
            other = Mat::from_fn(full.nrows(), n_b, |i, j| {
                let reduced = if i < n { other[(i, j)] } else { 0.0 };
                reduced - full[(i, j)]
            });
            self.add_energies(&other, &mut errors);
        }
        let relative = |j: usize| (errors[j].max(0.0) / energies[j]).sqrt();
        (0..n_b).map(|dof| Worst { error: relative(dof), dof }).fold(Worst { error: 0.0, dof: 0 }, |worst, next| {
            if dense::worse(next.error, worst.error) { next } else { worst }
        })
    }

    /// Adds xᵀKx of every column of coordinates.
    fn add_energies(&self, columns: &Mat<f64>, energies: &mut [f64]) {
        let forces = dense::product(self.stiffness.as_ref(), columns.as_ref());
        let own = dense::dots(columns.as_ref(), forces.as_ref());
        energies.iter_mut().zip(own).for_each(|(sum, energy)| *sum += energy);
    }
}
