//! The content of a superelement file, in the form the checks work on.

use faer::{Mat, MatRef};
use supel_runtime::{Coordinate, Superelement};

use super::version::kept_job;
use crate::dense::{self, NOISE_FACTOR, unpacked};
use crate::eigen::{eigenvalues, lowest_ratio};
use crate::error::Result;
use crate::job::{Boundary, Job};
use crate::verification::check::Limits;
use crate::verification::limits::{self, Judged, Known, LARGEST_EXCUSE};

/// A superelement with its matrices unpacked.
pub(super) struct Content<'a> {
    pub(super) superelement: &'a Superelement,
    /// K̂, r × r.
    pub(super) k: Mat<f64>,
    /// M̂, r × r.
    pub(super) m: Mat<f64>,
    /// Û, r × n_r.
    pub(super) u: Mat<f64>,
    /// M_F, n_r × n_r.
    pub(super) m_f: Mat<f64>,
    /// Interface coordinates.
    pub(super) n_b: usize,
    /// The boundary its modes were computed under.
    pub(super) boundary: Boundary,
    /// ω² of its modes.
    pub(super) lambda: Vec<f64>,
    /// The first elastic eigenvalue, the unit that energies are compared with.
    pub(super) first: f64,
    /// Rounding of the arithmetic and of the data in an energy, relative to `first`, as error bars tell.
    noise: Noise,
    /// Powers of two near 1/√(K̂ + λ₁M̂)_ii. Of K̂ alone nothing may be left: an interface that just holds the component
    /// has none.
    pub(super) scale: Vec<f64>,
    /// The job kept in the file, where it is one of this version.
    pub(super) job: Option<Job>,
}

/// Rounding in an energy, by whose error bars it is known.
#[derive(Clone, Copy, Debug)]
enum Noise {
    /// By the error bars of modes that were found anew.
    OfModel(f64),
    /// By the error bars that the file states.
    OfFile(f64),
}

impl Noise {
    fn size(self) -> f64 {
        match self {
            Self::OfModel(noise) | Self::OfFile(noise) => noise,
        }
    }
}

impl<'a> Content<'a> {
    /// The content of a file; without a model that tells the noise of its energies, the file's own error bars have to.
    pub(super) fn of(superelement: &'a Superelement, noise: Option<f64>) -> Result<Self> {
        let tensors = superelement.tensors();
        let (k, m) = (unpacked(&tensors.stiffness), unpacked(&tensors.mass));
        let n_r = tensors.rigid_body_modes.cols();
        let lambda: Vec<f64> = tensors.frequencies.iter().map(|omega| omega * omega).collect();
        let first = first_elastic((k.as_ref(), m.as_ref()), n_r, lambda.iter().copied().find(|lambda| *lambda > 0.0))?;
        let scale: Vec<f64> = (0..k.nrows()).map(|i| dense::power_of_two_root(k[(i, i)] + first * m[(i, i)])).collect();
        Ok(Self {
            superelement,
            u: unpacked(&tensors.rigid_body_modes),
            m_f: unpacked(&tensors.rigid_body_mass),
            n_b: superelement.n_interface(),
            boundary: boundary(superelement),
            noise: noise.map_or_else(|| Noise::OfFile(by_own_bars(superelement, first)), Noise::OfModel),
            job: kept_job(superelement),
            k,
            m,
            lambda,
            first,
            scale,
        })
    }

    /// r.
    pub(super) fn n_reduced(&self) -> usize {
        self.k.nrows()
    }

    /// Whether the job kept in the file holds dofs, under which a component of any rigid-body modes has loads of gravity.
    pub(super) fn holds_dofs(&self) -> bool {
        self.job.as_ref().is_some_and(|job| !job.fixed.is_empty())
    }

    /// n_r.
    pub(super) fn n_rigid(&self) -> usize {
        self.u.ncols()
    }

    /// Limits of an energy that should be nothing, relative to an eigenvalue. A file does not say how many digits its matrices had, and
    /// all that its bars explain counts alike.
    pub(super) fn energy_limits(&self, eigenvalue: f64) -> Judged {
        let noise = self.noise.size() * self.first / eigenvalue;
        match self.noise {
            Noise::OfModel(_) => limits::of_energy(noise, 1.0),
            Noise::OfFile(_) => limits::of_unexplained_energy(noise),
        }
    }

    /// Limits of a force of rigid-body motion, in the scales of K̂ + λ₁M̂.
    ///
    /// Bars of modes with the interface held do not show what few digits make of rigid-body motion. A reduction knows, and
    /// its limit is on record.
    pub(super) fn force_limits(&self) -> Judged {
        let judged = limits::of_force(self.noise.size(), 1.0);
        match self.noise {
            Noise::OfFile(noise) if self.recorded_limit("M-12") > judged.limits.value() => {
                limits::of_unexplained_force(noise.max(self.recorded_limit("M-12") / NOISE_FACTOR))
            }
            _ => judged,
        }
    }

    /// Limits of a force of rigid-body motion in the damping: a reduction knows what the digits of its matrices leave, and its limit is on
    /// record, before that of the energy.
    pub(super) fn damping_force_limits(&self) -> Judged {
        let recorded = self.superelement.metadata().verification.checks.iter().find(|check| check.id == "M-28");
        let recorded = recorded.map_or(0.0, |check| check.limit);
        let judged = self.force_limits();
        if recorded <= judged.limits.value() {
            return judged;
        }
        limits::of_unexplained_force(self.noise.size().max(recorded / NOISE_FACTOR))
    }

    /// The largest limit on record of the checks of one identifier.
    fn recorded_limit(&self, id: &str) -> f64 {
        let checks = self.superelement.metadata().verification.checks.iter().filter(|check| check.id == id);
        checks.fold(0.0, |most, check| most.max(check.limit))
    }

    /// Limits of the relative difference of two frequencies of one mode.
    pub(super) fn frequency_limits(&self) -> Judged {
        limits::of_frequency(self.noise.size(), 1.0)
    }

    /// A difference of numbers that rounding alone may tell apart.
    pub(super) fn rounding_limits(&self) -> Limits {
        let arithmetic = (NOISE_FACTOR * self.noise.size()).min(LARGEST_EXCUSE);
        Limits { engineering: 1e-10, arithmetic, data: 0.0 }
    }

    /// ‖D v‖.
    pub(super) fn force_norm(&self, v: &[f64]) -> f64 {
        dense::norm(&v.iter().zip(&self.scale).map(|(v, d)| v * d).collect::<Vec<f64>>())
    }

    /// The name of a coordinate.
    pub(super) fn name_of(&self, coordinate: usize) -> String {
        coordinate_name(self.superelement, coordinate)
    }
}

/// The name of a coordinate of a superelement.
pub(super) fn coordinate_name(superelement: &Superelement, coordinate: usize) -> String {
    let metadata = superelement.metadata();
    match metadata.coordinates.get(coordinate) {
        Some(Coordinate::Interface { node, direction }) => {
            let name = &metadata.interface_nodes[*node].name;
            format!("{name} {}", format!("{direction:?}").to_lowercase())
        }
        Some(Coordinate::InterfaceRow { row }) => format!("row {}", row + 1),
        Some(Coordinate::RigidBodyMode { index }) => format!("rigid-body mode {}", index + 1),
        Some(Coordinate::InertiaRelief { index }) => format!("inertia relief {}", index + 1),
        Some(Coordinate::ExpansionMode { column }) => format!("expansion mode {}", column + 1),
        Some(Coordinate::ResidualVector { load }) => format!("residual vector of {}", metadata.load_names[*load]),
        Some(Coordinate::ElasticMode { mode, .. } | Coordinate::FixedInterfaceMode { mode, .. }) => {
            format!("mode {}", mode + 1)
        }
        None => "no coordinate".to_owned(),
    }
}

/// The kind of a mode tells where it was computed, whatever the method is called.
pub(super) fn boundary(superelement: &Superelement) -> Boundary {
    let mut columns = superelement.metadata().named_columns();
    let is_fixed = columns.any(|coordinate| matches!(coordinate, Coordinate::FixedInterfaceMode { .. }));
    if is_fixed { Boundary::FixedInterface } else { Boundary::FreeInterface }
}

/// The noise of energies relative to the first elastic one, by the bars that the file states. No file is written with a frequency that
/// is unknown, and a bar that says so excuses nothing.
fn by_own_bars(superelement: &Superelement, first: f64) -> f64 {
    let known = superelement.metadata().coordinates.iter().filter_map(|coordinate| match *coordinate {
        Coordinate::ElasticMode { frequency_hz, error_bar_hz: Some(bar), .. }
        | Coordinate::FixedInterfaceMode { frequency_hz, error_bar_hz: Some(bar), .. } => {
            // The bar of the square of a frequency is twice that of the frequency.
            let omega = frequency_hz * std::f64::consts::TAU;
            let known = Known { lambda: omega * omega, relative_bar: 2.0 * bar / frequency_hz };
            (bar <= limits::UNKNOWN * frequency_hz).then_some(known)
        }
        _ => None,
    });
    limits::noise(known, first)
}

/// The first eigenvalue of the reduced pencil beyond its rigid-body modes, with its interface free; `near` is one of its modes.
fn first_elastic((k, m): (MatRef<'_, f64>, MatRef<'_, f64>), n_r: usize, near: Option<f64>) -> Result<f64> {
    let Some(near) = near.or_else(|| lowest_ratio(k, m)) else { return Ok(1.0) };
    let values = eigenvalues(k, m, near)?;
    Ok(values.get(n_r).copied().filter(|value| *value > 0.0).unwrap_or(near))
}
