//! What motions cost, and up to which cost a motion is rigid.

use faer::MatRef;

use super::rigid_body_modes::RigidBodyModes;
use crate::dense;
use crate::eigen::{Equilibrated, zero};
use crate::partition::Partition;
use crate::sparse::{energies_of_terms, product_and_terms};

/// Energies xᵀKx up to which motions are zero, by the criterion of [`crate::eigen::zero`]; `terms` are |K||x|.
pub(crate) fn zero_energies(partition: &Partition, x: MatRef<'_, f64>, terms: MatRef<'_, f64>) -> Vec<f64> {
    let norms = Equilibrated::of(partition.pencil());
    let (digits, sizes) = (partition.energy_noise(x), energies_of_terms(x, terms));
    let patches = partition.patch_terms(x);
    let level = |j: usize| {
        let floor = norms.stiffness_norm * norms.scaled_norm(dense::column(x, j)).powi(2);
        zero::level(digits[j], f64::EPSILON * (sizes[j] + patches[j]), f64::EPSILON * floor)
    };
    (0..x.ncols()).map(level).collect()
}

/// The largest of [`zero_energies`].
pub(crate) fn zero_energy(partition: &Partition, x: MatRef<'_, f64>, terms: MatRef<'_, f64>) -> f64 {
    zero_energies(partition, x, terms).into_iter().fold(0.0, f64::max)
}

/// What few digits of K, roundings of it that rigid patches hide, or those that motions below zero show, can make of the energy of a rigid-body
/// motion of unit modal mass.
pub(crate) fn noise_of_digits(partition: &Partition, rigid: &RigidBodyModes) -> f64 {
    let of_patches = partition.patch_terms(rigid.massive()).into_iter().fold(0.0, f64::max);
    let of_digits = match partition.has_few_digits() {
        true => partition.energy_noise(rigid.massive()).into_iter().fold(0.0, f64::max),
        false => 0.0,
    };
    let (share, sizes) = shown_and_sizes(partition, rigid);
    let shown = share * sizes.into_iter().fold(0.0, f64::max);
    of_digits.max(f64::EPSILON * of_patches).max(shown)
}

/// What rigid-body motions below zero show of the roundings in K, relative to its terms; see [`zero::shown_below_zero`].
pub(crate) fn shown_below_zero(partition: &Partition, rigid: &RigidBodyModes) -> f64 {
    shown_and_sizes(partition, rigid).0
}

/// That share, and |q|ᵀ|K||q| of the motions.
fn shown_and_sizes(partition: &Partition, rigid: &RigidBodyModes) -> (f64, Vec<f64>) {
    let motions = rigid.massive();
    let (forces, terms) = product_and_terms(&partition.stiffness, motions);
    let (energies, sizes) = (dense::dots(motions, forces.as_ref()), energies_of_terms(motions, terms.as_ref()));
    // The levels of the motions take every entry of K; none is below what rounding of its own terms makes of it.
    let least: Vec<f64> = sizes.iter().map(|size| zero::level(0.0, f64::EPSILON * size, 0.0)).collect();
    let share = match zero::shown_below_zero(&energies, &least, &sizes) > 0.0 {
        true => zero::shown_below_zero(&energies, &zero_energies(partition, motions, terms.as_ref()), &sizes),
        false => 0.0,
    };
    (share, sizes)
}

/// ‖Kq‖ / ‖ |K||q| ‖ of each column, from the two products.
pub(super) fn residuals(forces: MatRef<'_, f64>, terms: MatRef<'_, f64>) -> Vec<f64> {
    let ratio = |j: usize| {
        let size = dense::norm(dense::column(terms, j));
        if size > 0.0 { dense::norm(dense::column(forces, j)) / size } else { 0.0 }
    };
    (0..forces.ncols()).map(ratio).collect()
}
