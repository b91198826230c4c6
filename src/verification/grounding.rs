//! How much energy and force rigid-body motion costs, direction by direction.

use faer::MatRef;

use super::directions::Directions;
use super::evidence::Evidence;
use super::limits::NEARLY_FREE;
use super::spectrum::Spectrum;
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::{Equilibrated, eigenvalues};
use crate::error::Result;
use crate::model::Finding;
use crate::sparse::{product, product_and_terms};

/// One direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Grounding {
    /// `translation x`, `rotation z`.
    pub direction: String,
    /// uᵀKu / (λ uᵀMu), λ the first eigenvalue beyond all directions, or the highest elastic one.
    pub energy_ratio: f64,
    /// What rounding and the digits of K can make of it.
    pub noise: f64,
    /// max |Ku| / max (|K||u|), equilibrated.
    pub force_ratio: f64,
    /// Node and direction of the largest force.
    pub worst: Option<String>,
    /// The verdict on the ratio.
    pub restraint: Restraint,
}

/// Whether a motion is free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Restraint {
    /// K lets it pass.
    Free,
    /// A weak spring holds what should be free.
    Grounded,
    /// A support holds it, it is not a motion of the component as a whole, or it turns a preloaded component, whose internal forces cost
    /// what has been confirmed of them.
    Held,
}

/// Energy ratio above which a support holds a motion: its frequency is a tenth of the first elastic one.
const HELD_ABOVE: f64 = 1e-2;
/// Largest ratio of the Rayleigh quotient of a motion to the eigenvalue of its number where the component moves as a whole. With
/// the stiffness k_e on a spring k the quotient is k/m and the eigenvalue k k_e / ((k + k_e) m), so that the ratio is 1 + k/k_e:
/// beyond two the component gives way more than what holds it, as a clamped one does whatever mass it carries.
const AS_A_WHOLE: f64 = 2.0;

/// All directions.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn groundings(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Result<Vec<Grounding>> {
    let directions = Directions::of(evidence);
    let partition = evidence.partition;
    let (forces, terms) = product_and_terms(&partition.stiffness, directions.motions.as_ref());
    let scale = Equilibrated::of(partition.pencil()).scale;
    // Where no elastic mode is known, one in scaled units: the largest K_ii over the largest M_ii.
    let first = spectrum.scale(directions.count().max(evidence.rigid.count())).unwrap_or(1.0);
    // Where K lets fewer motions pass than there are directions, some are held. Particles move by themselves.
    let n_particles: usize = partition.model.findings.iter().map(Finding::n_free_particles).sum();
    let all_free = directions.count() + n_particles <= evidence.rigid.count();
    let precision = partition.precision.stiffness.relative + f64::EPSILON;
    // Of entries that are known to a share of themselves the terms tell enough.
    let of_digits = match partition.precision.stiffness.is_beyond_entries() {
        true => partition.energy_noise(directions.motions.as_ref()),
        false => vec![0.0; directions.count()],
    };
    let quotients = ritz_values(evidence, &directions, forces.as_ref(), first)?;
    // The least quotient that is not below that of a direction belongs to the motion that makes it up.
    let moves_as_a_whole = |quotient: f64| {
        let at = quotients.partition_point(|value| *value < (1.0 - SAME) * quotient).min(quotients.len() - 1);
        spectrum.number(at).is_none_or(|lambda| quotients[at] <= AS_A_WHOLE * lambda)
    };
    // What the supports of the job hold, no spring has to.
    let found = (0..directions.count()).filter(|j| !directions.are_held[*j]).map(|j| {
        let (u, force) = (dense::column(directions.motions.as_ref(), j), dense::column(forces.as_ref(), j));
        let terms = dense::column(terms.as_ref(), j);
        let of = |energy: f64| energy.abs() / (first * directions.masses[j]);
        let energy_ratio = of(dense::dot(u, force));
        let size: f64 = u.iter().zip(terms).map(|(u, terms)| u.abs() * terms).sum();
        let noise = NOISE_FACTOR * (partition.cancellation * precision * of(size)).max(of(of_digits[j]));
        let (mut largest, mut at, mut of_terms) = (0.0, None, 0.0f64);
        for (row, d) in scale.iter().enumerate() {
            of_terms = of_terms.max(d * terms[row]);
            if dense::worse(d * force[row].abs(), largest) {
                (largest, at) = (d * force[row].abs(), Some(row));
            }
        }
        let least = if all_free { noise.max(NEARLY_FREE) } else { noise };
        let restraint = if energy_ratio <= least {
            Restraint::Free
        } else if partition.fit.is_preloaded() && directions.turns(j) {
            Restraint::Held
        } else if all_free || energy_ratio < HELD_ABOVE && moves_as_a_whole(dense::dot(u, force) / directions.masses[j])
        {
            Restraint::Grounded
        } else {
            Restraint::Held
        };
        Grounding {
            direction: directions.names[j].clone(),
            energy_ratio,
            noise,
            force_ratio: if of_terms > 0.0 { largest / of_terms } else { 0.0 },
            worst: at.map(|row| partition.name_of(row)),
            restraint,
        }
    });
    let mut found: Vec<Grounding> = found.collect();
    // Rotations of a preloaded component cost energy, which few digits of K hide and no spring makes.
    let restraint = if partition.fit.is_preloaded() { Restraint::Held } else { Restraint::Grounded };
    hold_surplus(&mut found, evidence.rigid.count(), restraint);
    Ok(found)
}

/// No more directions are free than there are free motions, whatever rounding in patches would hide: the costliest of them are held.
fn hold_surplus(found: &mut [Grounding], n_free_motions: usize, restraint: Restraint) {
    let mut free: Vec<&mut Grounding> = found.iter_mut().filter(|of| of.restraint == Restraint::Free).collect();
    free.sort_by(|a, b| b.energy_ratio.total_cmp(&a.energy_ratio));
    let n_surplus = free.len().saturating_sub(n_free_motions);
    free.into_iter().take(n_surplus).filter(|of| of.energy_ratio > 0.0).for_each(|of| of.restraint = restraint);
}

/// How far rounding may move a quotient apart from itself.
const SAME: f64 = 1e-9;

/// The Rayleigh quotients of the pencil on the space of the directions, ascending; one at least.
fn ritz_values(
    evidence: &Evidence<'_>,
    directions: &Directions,
    forces: MatRef<'_, f64>,
    first: f64,
) -> Result<Vec<f64>> {
    let motions = directions.motions.as_ref();
    let mut energies = dense::gram(motions, forces);
    let mut masses = dense::gram(motions, product(&evidence.partition.mass, motions).as_ref());
    dense::symmetrise(&mut energies);
    dense::symmetrise(&mut masses);
    let values = eigenvalues(energies.as_ref(), masses.as_ref(), first)?;
    // Without a definite pencil nothing is known of the motions. Zero stands for that: it is never above an eigenvalue.
    Ok(if values.is_empty() { vec![0.0] } else { values })
}
