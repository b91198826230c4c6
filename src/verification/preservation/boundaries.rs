//! Frequencies of the reduced against the full model under the boundaries of the scene: M-24.

use faer::Mat;

use super::super::check::{Check, Limits};
use super::super::{Evidence, data_noise};
use super::full::Supported;
use super::interfaces::{Inertia, Interface};
use super::reduced::{Quotient, quotients};
use crate::dense;
use crate::error::Result;
use crate::job::Support;
use crate::modes::{Boundary as ModeBoundary, ModeError, SEED};
use crate::report::table::{quantity, scientific};
use crate::report::{BoundaryComparison, BoundaryCount, FrequencyPair};

/// How far roundings of one sign may exceed their typical sum.
const ROUNDINGS: f64 = 10.0;
/// Backward error of a pair beyond which it is not accepted, unless the digits of the data explain it: half the digits are gone.
const NOT_SOLVED: f64 = 1e-8;
/// What arithmetic and data may excuse without a warning, and what they may excuse at most: past two digits the comparison says little, past one nothing.
const MOST_EXCUSED: [f64; 2] = [1e-2, 1e-1];

/// A support: which interface dofs it holds and which it loads.
#[derive(Clone, Debug)]
pub(super) struct Boundary {
    pub(super) name: String,
    description: String,
    /// Held or not, for each interface dof.
    pub(super) held: Vec<bool>,
    /// Mass added to each interface dof, in scaled units.
    pub(super) load: Vec<f64>,
}

impl Boundary {
    pub(super) fn new(evidence: &Evidence<'_>, interfaces: &[Interface], support: &Support) -> Self {
        let partition = evidence.partition;
        let n_b = partition.n_interface();
        let mut boundary = Self {
            name: support.to_string(),
            description: "no interface held or loaded".to_owned(),
            held: vec![false; n_b],
            load: vec![0.0; n_b],
        };
        let Some(interface) = interfaces.iter().find(|interface| Some(interface.name.as_str()) == support.interface())
        else {
            return boundary;
        };
        match support {
            Support::Free => {}
            Support::Fixed { .. } => {
                interface.dofs.iter().for_each(|dof| boundary.held[*dof] = true);
                boundary.description = format!("all dofs of {} held, the other interfaces free", interface.name);
            }
            Support::Loaded { mass, .. } => boundary.load(evidence, interface, *mass),
        }
        boundary
    }

    /// Spreads a mass and its moment of inertia evenly over the nodes of an interface.
    fn load(&mut self, evidence: &Evidence<'_>, interface: &Interface, mass: Option<f64>) {
        let partition = evidence.partition;
        let unit = partition.scaling.mass_unit();
        let own = Inertia::of(evidence);
        let inertia = mass.map_or(own, |mass| own.with_mass(mass / unit));
        let n_nodes = interface.n_nodes.max(1) as f64;
        for dof in &interface.dofs {
            let direction = partition.dofs[partition.n_internal + dof].site.map(|site| site.direction);
            let is_rotation = direction.is_some_and(|direction| direction.is_rotation());
            self.load[*dof] = if is_rotation { inertia.moment } else { inertia.mass } / n_nodes;
        }
        let whose = if mass.is_none() { ", those of the component itself" } else { "" };
        self.description = format!(
            "{} carries a mass of {} with moments of inertia of {}{whose}; nothing is held",
            interface.name,
            quantity(inertia.mass * unit, 4),
            quantity(inertia.moment * unit, 4)
        );
    }

    /// Whether the retained modes are those of this boundary.
    fn is_own(&self, evidence: &Evidence<'_>) -> bool {
        match evidence.retained.boundary {
            ModeBoundary::FreeInterface => {
                self.load.iter().all(|load| *load == 0.0) && self.held.iter().all(|held| !held)
            }
            ModeBoundary::FixedInterface => self.held.iter().all(|held| *held),
        }
    }
}

/// The full model's answer under one boundary.
#[derive(Clone, Debug)]
pub(super) struct Reference {
    pub(super) boundary: Boundary,
    /// Elastic eigenvalues up to the end of the band, ascending.
    pub(super) lambda: Vec<f64>,
    /// What is known of the error of each.
    errors: Vec<ModeError>,
    /// The next eigenvalue above, where there is one.
    pub(super) next: Option<f64>,
    /// The rigid-body motions that the support lets pass, at the interface dofs that are not held; orthonormal in the mass of
    /// the component with its load.
    passing: Mat<f64>,
    /// The Sturm count, where one was made.
    pub(super) count: Option<BoundaryCount>,
}

impl Reference {
    /// The full model up to `limit`; the retained modes where they are the answer already and `seed` is the first.
    ///
    /// # Errors
    /// The eigensolver does not converge; no memory.
    pub(super) fn new(evidence: &Evidence<'_>, boundary: Boundary, limit: f64, seed: u64) -> Result<Self> {
        let modes = &evidence.retained.modes;
        let is_covered = match (modes.next, modes.searched_to) {
            (Some(next), _) => next > limit,
            (None, Some(searched_to)) => searched_to >= limit,
            (None, None) => true,
        };
        let supported = Supported::new(evidence, &boundary)?;
        let found = if boundary.is_own(evidence) && is_covered && seed == SEED {
            modes
        } else {
            &supported.modes_up_to(evidence, limit, seed)?
        };
        let n_found = found.lambda.iter().take_while(|lambda| **lambda <= limit).count();
        Ok(Self {
            boundary,
            lambda: found.lambda[..n_found].to_vec(),
            errors: found.errors[..n_found].to_vec(),
            next: found.lambda.get(n_found).copied().or(found.next),
            passing: supported.passing(),
            count: None,
        })
    }

    /// Rigid-body motions that the support lets pass.
    pub(super) fn n_zero(&self) -> usize {
        self.passing.ncols()
    }

    /// Rigid-body motions that the support lets pass, in the coordinates of a reduced model without the dofs that are held, n × n_zero.
    pub(super) fn passing_coordinates(&self, n: usize) -> Mat<f64> {
        let motions = &self.passing;
        Mat::from_fn(n, motions.ncols(), |i, j| if i < motions.nrows() { motions[(i, j)] } else { 0.0 })
    }

    /// Why the full model was not solved under this boundary well enough to be compared with; the retained modes have M-01
    /// to say so.
    pub(super) fn unsound(&self, evidence: &Evidence<'_>) -> Option<String> {
        let precision = evidence.partition.precision;
        let most = NOT_SOLVED.max(ROUNDINGS * precision.stiffness.max(precision.mass));
        let backward = dense::worst(self.errors.iter().map(|error| error.backward));
        (!self.boundary.is_own(evidence) && dense::worse(backward, most))
            .then(|| format!("the full model leaves a residual of {} there", scientific(backward, 2)))
    }

    /// What rounding moves an eigenvalue by, in scaled units: that of the mode it moves most.
    pub(super) fn rounding_floor(&self) -> f64 {
        dense::worst(self.errors.iter().map(|error| error.rounding_floor))
    }

    /// Largest relative difference of a frequency in the band, given the eigenvalues of a reduced model.
    pub(super) fn worst_difference(&self, evidence: &Evidence<'_>, reduced: &[Quotient], band_hz: [f64; 2]) -> f64 {
        self.pairs(evidence, reduced, band_hz)
            .iter()
            .filter(|pair| pair.in_band)
            .map(|pair| pair.relative_difference.abs())
            .fold(0.0, |worst, difference| if dense::worse(difference, worst) { difference } else { worst })
    }

    fn pairs(&self, evidence: &Evidence<'_>, reduced: &[Quotient], band_hz: [f64; 2]) -> Vec<FrequencyPair> {
        let pair = |(j, full): (usize, &f64)| {
            let full_hz = super::hertz(evidence, *full);
            let reduced_hz = reduced.get(j).map_or(f64::INFINITY, |quotient| super::hertz(evidence, quotient.lambda));
            FrequencyPair {
                full_hz,
                reduced_hz,
                relative_difference: reduced_hz / full_hz - 1.0,
                in_band: (band_hz[0]..=band_hz[1]).contains(&full_hz),
            }
        };
        self.lambda.iter().enumerate().map(pair).collect()
    }

    pub(super) fn comparison(&self, evidence: &Evidence<'_>, band_hz: [f64; 2]) -> Result<BoundaryComparison> {
        let (k, m) = (evidence.reduction.stiffness.as_ref(), evidence.reduction.mass.as_ref());
        let reduced = quotients(evidence, self, k, m)?;
        Ok(BoundaryComparison {
            boundary: self.boundary.name.clone(),
            description: self.boundary.description.clone(),
            frequencies: self.pairs(evidence, &reduced, band_hz),
            worst_in_band: self.worst_difference(evidence, &reduced, band_hz),
            count: self.count,
        })
    }
}

/// M-24: a reduced model is the full one with constraints; none of its eigenvalues lies below.
///
/// What may still be missing is bounded term by term. Each of the two Rayleigh quotients has the rounding of its own terms,
/// and of the entries of K̂, whose terms cancel from the size of K. The quotient of the full model lies above its eigenvalue
/// by what its residual leaves in doubt, and K̂ lost the block K̂_Bη, which (29) says is zero and the digits of K do not.
pub(super) fn monotonicity(evidence: &Evidence<'_>, references: &[Reference]) -> Result<Option<Check>> {
    let (k, m) = (evidence.reduction.stiffness.as_ref(), evidence.reduction.mass.as_ref());
    // How far below, the limits of that mode, the quiet and the last one, and which it is.
    let least = Limits { engineering: 1e-9, ..Limits::default() };
    let mut worst: (f64, [Limits; 2], Option<String>) = (0.0, [least; 2], None);
    for reference in references {
        let quotients = quotients(evidence, reference, k, m)?;
        for (j, (reduced, (full, error))) in
            quotients.iter().zip(reference.lambda.iter().zip(&reference.errors)).enumerate()
        {
            let below = (1.0 - reduced.lambda / full).max(0.0);
            let terms = f64::EPSILON * error.cancellation + error.rounding_floor / full.abs();
            let rounding = ROUNDINGS * (terms + reduced.rounding);
            let left = error.residual_bar + reduced.uncoupled;
            let (arithmetic, data) = match data_noise(evidence.partition) > 0.0 {
                true => (rounding, left),
                false => (rounding + left, 0.0),
            };
            let limits = MOST_EXCUSED.map(|most| Limits { arithmetic, data, ..least }.capped(most, most));
            if dense::worse(below / limits[0].value(), worst.0 / worst.1[0].value()) {
                worst = (below, limits, Some(format!("{}, mode {}", reference.boundary.name, j + 1)));
            }
        }
    }
    let (value, limits, at) = worst;
    Ok((!references.is_empty()).then(|| Check {
        id: "M-24",
        name: "no reduced frequency lies below the full one",
        equation: "max (λ_full − λ_reduced) / λ_full over boundaries and modes (Rayleigh)",
        value,
        limits: limits[0],
        fail_above: limits[1].value(),
        worst: at,
    }))
}
