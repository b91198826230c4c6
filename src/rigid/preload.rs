//! Rigid-body motions of a preloaded body: those of the six that K lets pass.
//!
//! ```text
//! C    n' × (≤ 6)   motions of the body as a whole
//! F    n' × (≤ 6)   K C, the internal forces as they turn, compared with the job's by [`crate::coordinates`]
//! ```
//! F C⁺ has rank 3 at most. Motions are told by their forces: the energy of a rotation may be zero although it makes forces.

use faer::{Mat, MatRef};

use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::Equilibrated;
use crate::error::{Error, Result};
use crate::model::Frame;
use crate::partition::Partition;
use crate::sparse::{absolute_energy, energies_of_terms, product_and_terms};

use super::energy::zero_energy;

/// Motions of a preloaded body that make no force.
pub(super) struct WithoutForce {
    /// Translations, each of them by itself.
    pub(super) translations: Mat<f64>,
    /// Combinations of the rest.
    pub(super) others: Mat<f64>,
}

impl WithoutForce {
    /// All of them, translations first.
    pub(super) fn all(&self) -> Mat<f64> {
        dense::side_by_side(self.translations.as_ref(), self.others.as_ref())
    }
}

/// Combinations of some motions of a body that make no force; `frame` is that of the body, and the motions are these `directions` of its six.
///
/// # Errors
/// [`Error::NegativePreload`] where a motion of the body as a whole has negative energy.
pub(super) fn without_force(
    partition: &Partition,
    motions: MatRef<'_, f64>,
    directions: MatRef<'_, f64>,
    frame: &Frame,
) -> Result<WithoutForce> {
    if motions.ncols() == 0 {
        return Ok(WithoutForce { translations: motions.to_owned(), others: motions.to_owned() });
    }
    let (forces, terms) = product_and_terms(&partition.stiffness, motions);
    refuse_negative(partition, motions, forces.as_ref(), terms.as_ref())?;
    let scale = Equilibrated::of(partition.pencil()).scale;
    let n_rows = motions.nrows().max(motions.ncols());
    let scaled =
        |a: &Mat<f64>| Mat::from_fn(n_rows, a.ncols(), |i, j| if i < a.nrows() { scale[i] * a[(i, j)] } else { 0.0 });
    let (forces, terms) = (scaled(&forces), scaled(&terms));
    let size = (0..terms.ncols()).map(|j| dense::norm(dense::column(terms.as_ref(), j))).fold(0.0, f64::max);
    // Levers of a body far from the origin are rounded as the distance is.
    let far = 1.0 + dense::norm(&frame.centre) / frame.size;
    let rounding = partition.precision.stiffness.share + f64::EPSILON * far;
    let zero = NOISE_FACTOR * partition.cancellation * rounding * size;
    // Translations that are free by themselves stay as they are, to the bit.
    let is_translation = |j: usize| (3..6).all(|rotation| directions[(rotation, j)] == 0.0);
    let is_alone = |j: &usize| is_translation(*j) && dense::norm(dense::column(forces.as_ref(), *j)) <= zero;
    let (alone, others): (Vec<usize>, Vec<usize>) = (0..motions.ncols()).partition(is_alone);
    let (singular, v) = dense::right_singular(dense::columns(forces.as_ref(), &others).as_ref())?;
    let free: Vec<usize> = (0..singular.len()).filter(|j| singular[*j] <= zero).collect();
    let combined =
        dense::product(dense::columns(motions, &others).as_ref(), dense::columns(v.as_ref(), &free).as_ref());
    Ok(WithoutForce { translations: dense::columns(motions, &alone), others: combined })
}

/// Refuses a body that turns with negative energy. Its free modes would be unstable and their counts those of another structure.
fn refuse_negative(
    partition: &Partition,
    motions: MatRef<'_, f64>,
    forces: MatRef<'_, f64>,
    terms: MatRef<'_, f64>,
) -> Result<()> {
    let mut energy = dense::gram(motions, forces);
    dense::symmetrise(&mut energy);
    let (energies, _) = dense::symmetric_eigen(energy.as_ref())?;
    let largest = energies_of_terms(motions, terms).into_iter().fold(0.0, f64::max);
    let share = partition.precision.stiffness.share + f64::EPSILON;
    let noise = zero_energy(partition, motions, terms).max(NOISE_FACTOR * partition.cancellation * share * largest);
    let masses = absolute_energy(&partition.mass, motions);
    let mass = masses.into_iter().fold(0.0, f64::max);
    match energies.first() {
        Some(energy) if *energy < -noise => {
            let turns_patches = partition.interface.iter().any(|node| node.coupling.is_patch());
            let cause = match (partition.model.n_held, turns_patches) {
                (0, false) => "compression has it while nothing holds the component",
                (0, true) => {
                    "compression has it while nothing holds the component, or the origin of a rigid patch is off the line of its internal forces"
                }
                (_, false) => "the component buckles as it is held",
                (_, true) => {
                    "the component buckles as it is held, or the origin of a rigid patch is off the line of its internal forces"
                }
            };
            Err(Error::NegativePreload { cause, energy: energy / mass, noise: noise / mass })
        }
        _ => Ok(()),
    }
}
