//! Modes found again by another eigensolver, from another factor: M-01, M-06, M-14, M-15.

use faer::Mat;
use supel_runtime::{Coordinate, Superelement};

use super::full::{Full, LARGEST_TURN};
use super::scaled::Scaled;
use super::statics::Answers;
use crate::audit::content::boundary;
use crate::dense;
use crate::error::Result;
use crate::factor::{Analysis, whole_count};
use crate::job::Eigensolver;
use crate::modes::{Boundary, Factored, ModalProblem, ModeRequest, Modes, Wanted, elastic_modes, shifted};
use crate::sparse::product;
use crate::verification::check::{Check, Limits};
use crate::verification::limits::{self, Judged};

/// Seed of the start vectors; another one than any the reduction uses.
const SEED: u64 = 0x0dd5_eed5;
/// Where in the gap above the highest mode the count is taken: elsewhere than the reduction takes it.
const PLACE: f64 = 0.29;
/// Eigenvalues nearer than this, relatively, are compared as one space: their vectors rotate under rounding.
const ONE_SPACE: f64 = 1e-4;

/// Independent modes under the boundary of the file's modes.
pub(super) struct Witness<'a> {
    full: &'a Full<'a>,
    boundary: Boundary,
    /// Which modal coordinate each stored mode is.
    coordinate_of: Vec<Option<usize>>,
    n_stored: usize,
    n_rigid: usize,
    modes: Modes,
}

impl<'a> Witness<'a> {
    pub(super) fn of(superelement: &Superelement, scaled: &Scaled, full: &'a Full<'a>) -> Result<Self> {
        let partition = full.partition;
        let boundary = boundary(superelement);
        let n_stored = scaled.lambda.len();
        let eigensolver = if cfg!(feature = "arpack") { Eigensolver::Arpack } else { Eigensolver::Lanczos };
        let request = ModeRequest { wanted: Wanted::Count(n_stored), eigensolver, seed: SEED };
        let modes = match boundary {
            Boundary::FreeInterface => {
                let problem = ModalProblem::free(partition, Some(&full.rigid));
                elastic_modes(problem, &Factored::new(&full.factor, full.sigma), request)?
            }
            Boundary::FixedInterface => {
                let problem = ModalProblem::held(partition);
                let analysis = Analysis::new(problem.pencil())?;
                let found = shifted(&analysis, problem, &|dof| partition.name_of(dof))?;
                elastic_modes(problem, &Factored::new(&found.factor, found.sigma), request)?
            }
        };
        let n_rigid = full.rigid.count();
        let coordinate_of = coordinates_of_modes(superelement, n_stored);
        Ok(Self { full, boundary, coordinate_of, n_stored, n_rigid, modes })
    }

    /// M-01: the witness is one.
    pub(super) fn backward_error(&self) -> Check {
        let errors = self.modes.errors.iter().map(|error| error.backward).enumerate();
        let (value, worst) = worst_of(errors, |mode| format!("mode {}", mode + 1));
        Check {
            id: "M-01",
            name: "modes found again satisfy the full model",
            equation: "max ‖Kx − λMx‖ / ((‖K‖ + λ‖M‖) ‖x‖), equilibrated",
            value,
            limits: Limits { engineering: 1e-10, ..Limits::default() },
            fail_above: 1e-7,
            worst,
        }
    }

    /// M-14: stated frequencies against those found again.
    pub(super) fn frequencies(&self, scaled: &Scaled) -> Check {
        let difference = |(mode, stored): (usize, &f64)| {
            let found = self.modes.lambda.get(mode).copied().unwrap_or(f64::INFINITY);
            (mode, 0.5 * (stored / found - 1.0).abs())
        };
        let (value, worst) =
            worst_of(scaled.lambda.iter().enumerate().map(difference), |mode| format!("mode {}", mode + 1));
        let bars = self.modes.errors.iter().map(|error| error.relative_bar).fold(0.0, f64::max);
        // Both were computed from the same data: of the bar only the share of the arithmetic counts, and what the residuals leave
        // open, that of rigid-body motion which K holds by its digits among it.
        let arithmetic = bars * f64::EPSILON / (f64::EPSILON + self.full.partition.precision.stiffness);
        let open = self.modes.errors.iter().map(|error| error.residual_bar).fold(0.0, f64::max);
        // What digits turn a mode by moves its Rayleigh quotient by the square.
        let turned = self.full.turn(scaled).powi(2);
        let Judged { limits, fail_above } = limits::of_frequency(arithmetic.max(open).max(turned), 0.0);
        Check {
            id: "M-14",
            name: "frequencies are those of the full model",
            equation: "max |f_stated / f − 1|, f by another eigensolver on K − σM",
            value,
            limits,
            fail_above,
            worst,
        }
    }

    /// M-06: the inertia of the whole matrix counts as many modes as are stated.
    pub(super) fn count(&self, scaled: &Scaled) -> Result<Check> {
        // The shift follows the frequencies that the file states: those of the witness count themselves.
        let top = scaled.lambda.last().copied().unwrap_or(0.0);
        let above = |lambda: &f64| *lambda > top * (1.0 + ONE_SPACE);
        let next = self.modes.lambda.iter().copied().find(above).or(self.modes.next);
        let sigma = match next {
            Some(next) => top + PLACE * (next - top),
            None if top > 0.0 => (1.0 + PLACE) * top,
            None => PLACE * self.full.first,
        };
        let partition = self.full.partition;
        let (count, expected) = match self.boundary {
            Boundary::FixedInterface => {
                let pencil = partition.internal();
                (whole_count(&Analysis::new(pencil)?, pencil, sigma)?, self.n_stored)
            }
            Boundary::FreeInterface => {
                let count = whole_count(self.full.analysis, partition.pencil(), sigma)?;
                (count, self.n_stored + self.n_rigid)
            }
        };
        Ok(Check {
            id: "M-06",
            name: "no mode is missing in the file",
            equation: "|eigenvalues below σ − modes stated|, by the inertia of the whole K − σM at another shift",
            value: count.below.abs_diff(expected) as f64,
            limits: Limits::default(),
            fail_above: 0.0,
            worst: Some(format!("counted {}, stated {expected}, pivot growth {:.1}", count.below, count.growth)),
        })
    }

    /// M-15: modes move or load the interface as in the full model, cluster by cluster.
    ///
    /// None where the roundings of K leave nothing of the directions of the modes.
    pub(super) fn shapes(&self, scaled: &Scaled, full: &Full<'_>, answers: &Answers) -> Option<Check> {
        let (found, stored) = match self.boundary {
            Boundary::FreeInterface => self.interface_motions(scaled),
            Boundary::FixedInterface => self.participations(scaled, full, answers),
        };
        let mut worst = (0.0, None);
        for cluster in self.clusters() {
            let part = |a: &Mat<f64>| {
                let columns = a.as_ref().subcols(cluster.start, cluster.len());
                dense::product(columns, columns.transpose())
            };
            let (found, stored) = (part(&found), part(&stored));
            let largest = (0..found.nrows()).flat_map(|i| (0..found.nrows()).map(move |j| (i, j)));
            let error = largest.fold(0.0, |worst: f64, at| {
                let error = (found[at] - stored[at]).abs();
                if dense::worse(error, worst) { error } else { worst }
            });
            if dense::worse(error, worst.0) {
                worst = (error, Some(format!("mode {}", cluster.start + 1)));
            }
        }
        let arithmetic = (10.0 * f64::EPSILON * full.condition() / ONE_SPACE).min(1e-3);
        let limits = Limits { engineering: 1e-6, arithmetic, data: 0.0 };
        let limits = self.full.by_roundings_beside(self.least_gap(), scaled, limits);
        if limits.value() >= LARGEST_TURN {
            return None;
        }
        Some(Check {
            id: "M-15",
            name: "interface sees the modes of the full model",
            equation: "max |Σ p pᵀ − Σ p̂ p̂ᵀ| of each cluster, p motion of the interface or inertia seen by it, normalised",
            value: worst.0,
            limits,
            fail_above: limits.value().max(1e-3),
            worst: worst.1,
        })
    }

    /// Interface rows of the modes, weighted by inertia: of the full model, and of the reduced pencil.
    fn interface_motions(&self, scaled: &Scaled) -> (Mat<f64>, Mat<f64>) {
        let (n_i, n_b) = (self.full.partition.n_internal, scaled.n_b);
        let weight: Vec<f64> = (0..n_b).map(|i| scaled.m[(i, i)].max(0.0).sqrt()).collect();
        let shapes = &self.modes.shapes;
        let found = Mat::from_fn(n_b, self.n_compared(), |i, j| weight[i] * shapes[(n_i + i, j)]);
        let vectors = &scaled.free.vectors;
        let stored = Mat::from_fn(n_b, self.n_compared(), |i, j| {
            let column = self.n_rigid + j;
            if column < vectors.ncols() { weight[i] * vectors[(i, column)] } else { f64::NAN }
        });
        (found, stored)
    }

    /// Inertia of the modes against rigid and static motions of the interface: ZᵀMX, and Z_BᵀM̂_Bη.
    fn participations(&self, scaled: &Scaled, full: &Full<'_>, answers: &Answers) -> (Mat<f64>, Mat<f64>) {
        let n_i = full.partition.n_internal;
        let momenta = product(&full.partition.mass, answers.motions.as_ref());
        let shapes = self.modes.shapes.as_ref().subcols(0, self.n_compared());
        let found = dense::gram(momenta.as_ref().subrows(0, n_i), shapes);
        let (n_b, n) = (scaled.n_b, scaled.m.nrows() - scaled.n_b);
        let all = dense::gram(answers.interface.as_ref(), scaled.m.as_ref().submatrix(0, n_b, n_b, n));
        let stored = Mat::from_fn(found.nrows(), self.n_compared(), |i, j| {
            // A mode that was left out is not in M̂; its place takes what was found, so that it is not compared.
            self.coordinate_of[j].map_or(found[(i, j)], |slot| all[(i, slot)])
        });
        (found, stored)
    }

    /// The least distance of neighbouring clusters, relative to the eigenvalue above.
    fn least_gap(&self) -> f64 {
        let lambda = &self.modes.lambda;
        let next = |end: usize| lambda.get(end).copied().or(self.modes.next);
        let gap = |cluster: std::ops::Range<usize>| {
            next(cluster.end).map_or(1.0, |next| 1.0 - lambda[cluster.end - 1] / next)
        };
        self.clusters().into_iter().map(gap).fold(1.0, f64::min)
    }

    fn n_compared(&self) -> usize {
        self.n_stored.min(self.modes.count())
    }

    /// Ranges of modes whose eigenvalues lie together; the last one only where the next mode lies apart.
    fn clusters(&self) -> Vec<std::ops::Range<usize>> {
        let lambda = &self.modes.lambda;
        let is_end = |j: usize| {
            let next = lambda.get(j + 1).copied().or(self.modes.next);
            next.is_none_or(|next| next - lambda[j] > ONE_SPACE * next)
        };
        let mut start = 0;
        let mut clusters = Vec::new();
        for j in (0..self.n_compared()).filter(|j| is_end(*j)) {
            clusters.push(start..j + 1);
            start = j + 1;
        }
        clusters
    }
}

/// Slot among the modal coordinates of each stored mode that is one.
fn coordinates_of_modes(superelement: &Superelement, n_stored: usize) -> Vec<Option<usize>> {
    let mut slots = vec![None; n_stored];
    let coordinates = &superelement.metadata().coordinates[superelement.n_interface()..];
    for (slot, coordinate) in coordinates.iter().enumerate() {
        if let Coordinate::FixedInterfaceMode { mode, .. } = *coordinate {
            slots[mode] = Some(slot);
        }
    }
    slots
}

fn worst_of(values: impl Iterator<Item = (usize, f64)>, name: impl Fn(usize) -> String) -> (f64, Option<String>) {
    let mut worst = (0.0, None);
    for (index, value) in values {
        if dense::worse(value, worst.0) {
            worst = (value, Some(name(index)));
        }
    }
    worst
}
