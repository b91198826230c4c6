//! Frequencies of the reduced against the full model under the boundaries of the scene: M-24.

use faer::{Mat, MatRef};

use super::super::Evidence;
use super::super::check::{Check, Limits};
use super::full::Supported;
use super::interfaces::{Inertia, Interface};
use super::pencil::Spectral;
use crate::dense;
use crate::error::Result;
use crate::factor::SolveOperator;
use crate::job::Support;
use crate::modes::{Boundary as ModeBoundary, ModeError};
use crate::report::table::quantity;
use crate::report::{BoundaryComparison, FrequencyPair};

/// How far roundings of one sign may exceed their typical sum.
const ROUNDINGS: f64 = 10.0;

/// What a support does to the interface dofs.
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

    /// Eigenvalues of a reduced pencil under this boundary, ascending, zero modes included.
    pub(super) fn of_reduced(&self, k: MatRef<'_, f64>, m: MatRef<'_, f64>, alpha: f64) -> Result<Vec<f64>> {
        let n_b = self.held.len();
        let kept: Vec<usize> = (0..k.nrows()).filter(|i| *i >= n_b || !self.held[*i]).collect();
        let part = |a: MatRef<'_, f64>| Mat::from_fn(kept.len(), kept.len(), |i, j| a[(kept[i], kept[j])]);
        let mut mass = part(m);
        for (new, old) in kept.iter().enumerate().take_while(|(_, old)| **old < n_b) {
            mass[(new, new)] += self.load[*old];
        }
        Ok(Spectral::of(part(k).as_ref(), mass.as_ref(), alpha)?.eigenvalues())
    }
}

/// The full model's answer under one boundary.
#[derive(Clone, Debug)]
pub(super) struct Reference {
    pub(super) boundary: Boundary,
    /// Elastic eigenvalues up to the end of the band, ascending.
    pub(super) lambda: Vec<f64>,
    /// Relative rounding of each: that of the terms of xᵀKx, and that of K̂, whose terms cancel from the size of K.
    bars: Vec<f64>,
    /// Zero modes that the support leaves.
    pub(super) n_zero: usize,
}

impl Reference {
    /// The full model up to `limit`; the retained modes where they are the answer already.
    ///
    /// # Errors
    /// The eigensolver does not converge; no memory.
    pub(super) fn new(
        evidence: &Evidence<'_>,
        factor: &dyn SolveOperator,
        boundary: Boundary,
        limit: f64,
    ) -> Result<Self> {
        let modes = &evidence.retained.modes;
        let is_covered = match (modes.next, modes.searched_to) {
            (Some(next), _) => next > limit,
            (None, Some(searched_to)) => searched_to >= limit,
            (None, None) => true,
        };
        let supported = Supported::new(evidence, &boundary)?;
        let found = if boundary.is_own(evidence) && is_covered {
            modes
        } else {
            &supported.modes_up_to(evidence, factor, limit)?
        };
        let n_found = found.lambda.iter().take_while(|lambda| **lambda <= limit).count();
        let bar = |(lambda, error): (&f64, &ModeError)| {
            f64::EPSILON * error.cancellation + error.rounding_floor / lambda.abs()
        };
        let bars = found.lambda[..n_found].iter().zip(&found.errors).map(bar).collect();
        Ok(Self { boundary, lambda: found.lambda[..n_found].to_vec(), bars, n_zero: supported.n_rigid() })
    }

    /// Largest relative difference of a frequency in the band, given the eigenvalues of a reduced model.
    pub(super) fn worst_difference(&self, evidence: &Evidence<'_>, reduced: &[f64], band_hz: [f64; 2]) -> f64 {
        self.pairs(evidence, reduced, band_hz)
            .iter()
            .filter(|pair| pair.in_band)
            .map(|pair| pair.relative_difference.abs())
            .fold(0.0, |worst, difference| if dense::worse(difference, worst) { difference } else { worst })
    }

    fn pairs(&self, evidence: &Evidence<'_>, reduced: &[f64], band_hz: [f64; 2]) -> Vec<FrequencyPair> {
        let pair = |(j, full): (usize, &f64)| {
            let full_hz = super::hertz(evidence, *full);
            let reduced_hz =
                reduced.get(self.n_zero + j).map_or(f64::INFINITY, |lambda| super::hertz(evidence, *lambda));
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
        let reduced = self.boundary.of_reduced(k, m, super::shift(evidence))?;
        Ok(BoundaryComparison {
            boundary: self.boundary.name.clone(),
            description: self.boundary.description.clone(),
            frequencies: self.pairs(evidence, &reduced, band_hz),
            worst_in_band: self.worst_difference(evidence, &reduced, band_hz),
        })
    }
}

/// M-24: a reduced model is the full one with constraints; none of its eigenvalues lies below.
pub(super) fn monotonicity(evidence: &Evidence<'_>, references: &[Reference]) -> Result<Option<Check>> {
    let (k, m) = (evidence.reduction.stiffness.as_ref(), evidence.reduction.mass.as_ref());
    // How far below, the limit of that mode, and which it is.
    let mut worst: (f64, Limits, Option<String>) = (0.0, Limits { engineering: 1e-9, ..Limits::default() }, None);
    for reference in references {
        let reduced = reference.boundary.of_reduced(k, m, super::shift(evidence))?;
        for (j, (full, bar)) in reference.lambda.iter().zip(&reference.bars).enumerate() {
            let Some(reduced) = reduced.get(reference.n_zero + j) else { break };
            let below = (1.0 - reduced / full).max(0.0);
            // The full model is solved beside its rigid-body motions q. Where the digits leave them an energy ε = qᵀKq, they
            // couple with a mode by |qᵀKx| ≤ √(ελ), and leaving them out raises λ by up to |qᵀKx|²/λ = ε each.
            let data = reference.n_zero as f64 * evidence.rigid.energy.largest_quotient / full;
            let limits = Limits { engineering: 1e-9, arithmetic: ROUNDINGS * bar, data };
            if dense::worse(below / limits.value(), worst.0 / worst.1.value()) {
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
        limits,
        fail_above: limits.value(),
        worst: at,
    }))
}
