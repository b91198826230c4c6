//! The content of a superelement file, in the form the checks work on.

use std::collections::BTreeSet;

use faer::{Mat, MatRef};
use supel_runtime::{Coordinate, Direction, Flag, Superelement};

use super::version::kept_job;
use crate::dense::{self, NOISE_FACTOR, unpacked};
use crate::eigen::massless::lifted;
use crate::eigen::{ByInertia, bar_of_lambda, eigenvalue_beyond, elastic_scale, relief_scale};
use crate::error::Result;
use crate::job::{Boundary, Job, MassOf, Method};
use crate::plan::Plan;
use crate::rigid::n_passing;
use crate::verification::check::Limits;
use crate::verification::force;
use crate::verification::limits::{self, Judged, Known, LARGEST_EXCUSE};

/// A superelement with its matrices unpacked.
pub(super) struct Content<'a> {
    pub(super) superelement: &'a Superelement,
    /// K̂, r × r.
    pub(super) k: Mat<f64>,
    /// M̂, r × r; the diagonal of K̂ where the file has no mass, so that energies have something to be compared with.
    pub(super) m: Mat<f64>,
    /// Û, r × n_r.
    pub(super) u: Mat<f64>,
    /// The motions that Û spans, with inertia and without.
    pub(super) motions: ByInertia,
    /// K̂ that holds those without, in which the pencil would be singular.
    pub(super) k_of_pencil: Mat<f64>,
    /// M_F, n_r × n_r.
    pub(super) m_f: Mat<f64>,
    /// Interface coordinates.
    pub(super) n_b: usize,
    /// The boundary its modes were computed under.
    pub(super) boundary: Boundary,
    /// ω² of its modes.
    pub(super) lambda: Vec<f64>,
    /// Of those that its coordinates have: without what nothing starts and nothing sees.
    pub(super) kept: Vec<f64>,
    /// The first elastic eigenvalue, the unit that energies are compared with.
    pub(super) first: f64,
    /// Rounding of the arithmetic and of the data in an energy, relative to `first`, as error bars tell.
    noise: Noise,
    /// Powers of two near 1/√(K̂ + λ₁M̂)_ii. Of K̂ alone nothing may be left: an interface that just holds the component
    /// has none.
    pub(super) scale: Vec<f64>,
    /// The rank of M̂ of a method that makes it singular: the modes and rigid-body motion.
    pub(super) mass_rank: Option<usize>,
    /// What was done by the job kept in the file, where it is one of this version.
    pub(super) plan: Option<Plan>,
}

/// What rounding makes of a file, as the model tells.
#[derive(Clone, Copy, Debug)]
pub(super) struct ModelNoise {
    /// In an energy, relative to the first elastic eigenvalue.
    pub(super) energy: f64,
    /// In a static answer of the interior, as a ratio of lengths in energy.
    pub(super) answers: f64,
    /// In an inertia, relative to that of the columns.
    pub(super) inertia: f64,
    /// The limits of the relative difference of two frequencies of one mode.
    pub(super) frequency: Judged,
}

/// What rounding makes of a file, as its own error bars tell.
#[derive(Clone, Copy, Debug)]
struct FileNoise {
    /// In an energy, relative to the first elastic eigenvalue.
    energy: f64,
    /// The largest error bar of an eigenvalue, relative to that eigenvalue.
    relative_bar: f64,
}

/// Rounding in energies and frequencies, by whose error bars it is known.
#[derive(Clone, Copy, Debug)]
enum Noise {
    /// By the error bars of modes that were found anew, and by static answers that were.
    OfModel(ModelNoise),
    /// By the error bars that the file states.
    OfFile(FileNoise),
}

impl Noise {
    fn size(self) -> f64 {
        match self {
            Self::OfModel(noise) => noise.energy,
            Self::OfFile(noise) => noise.energy,
        }
    }
}

impl<'a> Content<'a> {
    /// The content of a file; without a model that tells the noise of its energies, the file's own error bars have to.
    pub(super) fn of(superelement: &'a Superelement, noise: Option<ModelNoise>) -> Result<Self> {
        let tensors = superelement.tensors();
        let (k, u) = (unpacked(&tensors.stiffness), unpacked(&tensors.rigid_body_modes));
        let m = if has_mass(superelement) { unpacked(&tensors.mass) } else { unit_mass(&k, u.as_ref()) };
        let lambda: Vec<f64> = tensors.frequencies.iter().map(|omega| omega * omega).collect();
        let kept: Vec<f64> = superelement.frequencies_kept().into_iter().map(|omega| omega * omega).collect();
        let stated = kept.iter().copied().find(|lambda| *lambda > 0.0);
        let parts = (k.as_ref(), m.as_ref(), u.as_ref());
        let mass_rank = mass_rank(superelement);
        let motions = ByInertia::of(m.as_ref(), u.as_ref())?;
        let k_of_pencil = lifted(k.as_ref(), motions.massless.as_ref());
        let first = match (mass_rank, stated) {
            (Some(_), None) => relief_scale(parts, superelement.n_interface()).unwrap_or(1.0),
            (_, stated) => match stated.map_or_else(|| elastic_scale(parts), |near| Ok(Some(near)))? {
                Some(near) => eigenvalue_beyond(motions.massive.ncols(), (k_of_pencil.as_ref(), m.as_ref()), near)?,
                None => 1.0,
            },
        };
        let scale: Vec<f64> = (0..k.nrows()).map(|i| dense::power_of_two_root(k[(i, i)] + first * m[(i, i)])).collect();
        let n_modes = tensors.frequencies.len();
        Ok(Self {
            superelement,
            u,
            motions,
            k_of_pencil,
            m_f: unpacked(&tensors.rigid_body_mass),
            n_b: superelement.n_interface(),
            boundary: boundary(superelement),
            noise: noise.map_or_else(|| Noise::OfFile(by_own_bars(superelement, first)), Noise::OfModel),
            mass_rank,
            plan: kept_job(superelement).as_ref().map(|job| Plan::of(job).with_modes_of_file(n_modes)),
            k,
            m,
            lambda,
            kept,
            first,
            scale,
        })
    }

    /// Whether the file has a mass of its own.
    pub(super) fn has_mass(&self) -> bool {
        has_mass(self.superelement)
    }

    /// The job kept in the file as a run does it: without what its scene never asks.
    pub(super) fn job(&self) -> Option<&Job> {
        self.plan.as_ref().map(Plan::job)
    }

    /// For each interface coordinate whether it was held while the modes were computed.
    pub(super) fn held(&self) -> Vec<bool> {
        let named = &self.superelement.metadata().modes_held;
        let is_held = |at: usize| match self.boundary {
            Boundary::FixedInterface => true,
            Boundary::FreeInterface => false,
            Boundary::MixedInterface => named.binary_search(&at).is_ok(),
        };
        (0..self.n_b).map(is_held).collect()
    }

    /// Numbers of the coordinates that take part in the eigenproblem of the modes.
    pub(super) fn moving(&self) -> Vec<usize> {
        let held = self.held();
        (0..self.n_reduced()).filter(|at| held.get(*at) != Some(&true)).collect()
    }

    /// Rigid-body motions that leave what was held at rest, which the eigenproblem of the modes has at zero.
    pub(super) fn n_passing(&self) -> Result<usize> {
        let held = self.held();
        let rows: Vec<usize> = (0..self.n_b).filter(|at| held[*at]).collect();
        n_passing(self.u.as_ref().subrows(0, self.n_b), &self.scale, &rows)
    }

    /// Whether rigid-body modes are coordinates next to those of an interface, which leaves some of them free: the static modes are Rubin's.
    pub(super) fn is_attached(&self) -> bool {
        self.superelement.has_rigid_amplitudes()
    }

    /// r.
    pub(super) fn n_reduced(&self) -> usize {
        self.k.nrows()
    }

    /// Whether the job kept in the file holds dofs, under which a component of any rigid-body modes has loads of gravity.
    pub(super) fn holds_dofs(&self) -> bool {
        self.plan.as_ref().is_some_and(Plan::holds_dofs)
    }

    /// Whether its stiffness is said to be the tangent of a preloaded state, whose rigid-body modes lack rotations.
    pub(super) fn is_preloaded(&self) -> bool {
        self.superelement.metadata().flags.contains(&Flag::Preloaded)
    }

    /// How many rigid-body motions the pencil has at zero: those with inertia.
    pub(super) fn n_massive(&self) -> usize {
        self.motions.massive.ncols()
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
            Noise::OfFile(_) => limits::of_unexplained_energy(noise.max(self.recorded_energy() / NOISE_FACTOR)),
        }
    }

    /// The limit on record of the energy of rigid-body motion, where it is more than practice asks: a file without modes has no bars that
    /// would tell what the reduction knew.
    fn recorded_energy(&self) -> f64 {
        let checks = &self.superelement.metadata().verification.checks;
        let limit = checks.iter().find(|check| check.id == "M-05").map_or(0.0, |check| check.limit);
        if limit > NOISE_FACTOR * limits::ENERGY_ASKED { limit } else { 0.0 }
    }

    /// Limits of a force of rigid-body motion, in the scales of K̂ + λ₁M̂.
    ///
    /// Bars of modes with the interface held do not show what few digits make of rigid-body motion. A reduction knows, and
    /// its limit is on record.
    pub(super) fn force_limits(&self) -> Judged {
        let judged = limits::of_force(self.noise.size(), 1.0);
        match self.noise {
            Noise::OfFile(noise) if self.recorded_limit("M-12") > judged.limits.value() => {
                limits::of_unexplained_force(noise.energy.max(self.recorded_limit("M-12") / NOISE_FACTOR))
            }
            _ => judged,
        }
    }

    /// The scales of such a force, 1/√(K̂ + λ₁M̂)_ii.
    pub(super) fn force_scales(&self) -> Vec<f64> {
        let parts = (self.k.as_ref(), self.m.as_ref(), self.u.as_ref());
        force::scales(parts, self.first, &directions(self.superelement))
    }

    /// Limits of what a static answer leaves of its load, in K̂ and relative to its terms.
    ///
    /// An answer y of which a solve lacks e has ‖DK̂e‖ ≤ √λ_max(DK̂D) ‖e‖_K, and its terms have ‖D|K̂||y|‖ ≥ ‖y‖_K / √λ_max(DK̂D) or so:
    /// the share that it lacks of its energy, as a length, is what is left of its load. The conditioning of the interior, which that comes
    /// from, is not in the file; the limits of the checks that a reduction made of these answers are.
    pub(super) fn answer_limits(&self, id: &str) -> Limits {
        let of_answers = match self.noise {
            Noise::OfModel(noise) => NOISE_FACTOR * noise.answers,
            Noise::OfFile(_) => self.recorded_limit(id),
        };
        let Limits { engineering, arithmetic, data } = self.rounding_limits();
        Limits { engineering, arithmetic: arithmetic.max(of_answers.min(LARGEST_EXCUSE)), data }
    }

    /// Limits of the inertia that unit columns have in common: rounding of its terms, which are large where columns let a heavy mass nearly
    /// rest. A reduction knows them, and its limit is on record.
    pub(super) fn inertia_limits(&self) -> Limits {
        let arithmetic = match self.noise {
            Noise::OfModel(noise) => NOISE_FACTOR * noise.inertia,
            Noise::OfFile(_) => self.recorded_limit("M-03"),
        };
        Limits { engineering: 1e-10, arithmetic: arithmetic.min(limits::HARMLESS_COUPLING), data: 0.0 }
    }

    /// Limits of a force of rigid-body motion in the damping: a reduction knows what the digits of its matrices leave, and its limit is on
    /// record, before that of the energy.
    pub(super) fn damping_force_limits(&self) -> Judged {
        let recorded = self.superelement.metadata().verification.checks.iter().find(|check| check.id == "M-28");
        let recorded = recorded.map_or(0.0, |check| check.limit);
        let judged = self.force_limits();
        // At their largest both limits are one, and that of the record knows the digits.
        if recorded < judged.limits.value() {
            return judged;
        }
        limits::of_unexplained_force(self.noise.size().max(recorded / NOISE_FACTOR))
    }

    /// The limit on record of the energy that damping puts into a motion, the last that a reduction judges of damping: it knows the digits of
    /// its matrices.
    pub(super) fn recorded_damping_energy(&self) -> f64 {
        let checks = self.superelement.metadata().verification.checks.iter();
        checks.rev().find(|check| check.id == "M-28").map_or(0.0, |check| check.limit)
    }

    /// The largest limit on record of the checks of one identifier.
    fn recorded_limit(&self, id: &str) -> f64 {
        let checks = self.superelement.metadata().verification.checks.iter().filter(|check| check.id == id);
        checks.fold(0.0, |most, check| most.max(check.limit))
    }

    /// Limits of the relative difference of two frequencies of one mode. The noise of energies is relative to the first elastic mode of the
    /// free component and is nothing of the kind: a mode with part of the interface held may lie far below that one.
    pub(super) fn frequency_limits(&self) -> Judged {
        match self.noise {
            Noise::OfModel(noise) => noise.frequency,
            // All that the bars of a file tell counts as its digits, as for energies.
            Noise::OfFile(noise) => limits::of_frequency(noise.relative_bar, 1.0),
        }
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
        Some(mode) => mode.mode_name(&metadata.load_names).unwrap_or_default(),
        None => "no coordinate".to_owned(),
    }
}

/// The direction of each coordinate; none of those that belong to no node of the interface.
pub(super) fn directions(superelement: &Superelement) -> Vec<Option<Direction>> {
    let of = |coordinate: &Coordinate| match coordinate {
        Coordinate::Interface { direction, .. } => Some(*direction),
        _ => None,
    };
    superelement.metadata().coordinates.iter().map(of).collect()
}

/// Whether a file has a mass.
pub(super) fn has_mass(superelement: &Superelement) -> bool {
    !superelement.metadata().flags.contains(&Flag::StiffnessOnly)
}

/// A diagonal mass with which the coordinates of a stiffness have frequencies near one. Where a body has no coordinates but those of its
/// motions as a whole, the rounding that K̂ has instead of nothing is no size: they get the largest one.
pub(super) fn unit_mass(stiffness: &Mat<f64>, motions: MatRef<'_, f64>) -> Mat<f64> {
    let r = stiffness.nrows();
    let is_carried = force::carried(motions);
    let largest = stiffness.norm_max().max(f64::MIN_POSITIVE);
    let of = |i: usize| if stiffness[(i, i)] > 0.0 && !is_carried[i] { stiffness[(i, i)] } else { largest };
    Mat::from_fn(r, r, |i, j| if i == j { of(i) } else { 0.0 })
}

/// The rank that the mass of a file has by its method, where that is less than r.
pub(super) fn mass_rank(superelement: &Superelement) -> Option<usize> {
    let method = Method::of_file(superelement.metadata().method)?;
    let rank = superelement.n_rigid() + superelement.frequencies_kept().len();
    (method.mass() == MassOf::RetainedModes && rank < superelement.n_coordinates()).then_some(rank)
}

/// What a reduction by this plan says to clients: of the mass by the method of the file, of the rest by the job and its scene.
pub(super) fn flags(superelement: &Superelement, plan: Option<&Plan>) -> BTreeSet<Flag> {
    let of_mass = mass_rank(superelement).map(|_| Flag::SingularMass);
    plan.map_or_else(BTreeSet::new, Plan::flags).into_iter().chain(of_mass).collect()
}

/// The kind of a mode tells where it was computed, whatever the method is called.
pub(super) fn boundary(superelement: &Superelement) -> Boundary {
    let has = |is_kind: fn(&Coordinate) -> bool| superelement.metadata().named_columns().any(is_kind);
    if has(|coordinate| matches!(coordinate, Coordinate::FixedInterfaceMode { .. })) {
        return Boundary::FixedInterface;
    }
    match has(|coordinate| matches!(coordinate, Coordinate::MixedInterfaceMode { .. })) {
        true => Boundary::MixedInterface,
        false => Boundary::FreeInterface,
    }
}

/// Noise by the bars that the file states. No file is written with a frequency that is unknown, and a bar that says so excuses nothing.
fn by_own_bars(superelement: &Superelement, first: f64) -> FileNoise {
    // Modes that the interface spans are no coordinates and have bars all the same.
    let known = superelement.metadata().named_columns().filter_map(|coordinate| {
        let ((_, frequency_hz), bar) = (coordinate.mode()?, coordinate.error_bar_hz()?);
        let omega = frequency_hz * std::f64::consts::TAU;
        let known = Known { lambda: omega * omega, relative_bar: bar_of_lambda(bar, frequency_hz) };
        (bar <= limits::UNKNOWN * frequency_hz).then_some(known)
    });
    let known: Vec<Known> = known.collect();
    let relative_bar = known.iter().map(|known| known.relative_bar).fold(0.0, f64::max);
    FileNoise { energy: limits::noise(known, first), relative_bar }
}
