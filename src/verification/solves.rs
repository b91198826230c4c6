//! The static solves behind the constraint modes: M-10.

use faer::{Mat, MatRef};

use super::check::{Check, Limits, MAX_EXCUSE};
use super::evidence::Evidence;
use super::evidence::data_noise;
use super::residual::{Residuals, Rows, Worst};
use crate::dense;
use crate::dense::NOISE_FACTOR;
use crate::error::Result;
use crate::rigid::unit_motions;
use crate::sparse::{panels, product};

/// Up to this number every constraint mode is checked; of more, random combinations are.
const MAX_SINGLE_COLUMNS: usize = 64;
/// Random combinations: a column that is wrong shows in each of them but for a set of measure zero, and eight leave it a
/// chance of 10⁻⁸ to be ten times smaller in all of them than it is.
const PROBES: usize = 8;
/// Relative force of rigid-body motion at which M-05 fails, or at more where the digits of the data make more of it.
const GROUNDED: f64 = 1e-6;

/// M-10: K_II Ψ_S = −K_IB, row by row.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn static_solves(evidence: &Evidence<'_>) -> Result<Check> {
    const FAIL: f64 = 1e-9;
    let partition = evidence.partition;
    let rows = Rows::of(partition.pencil());
    let n_b = partition.n_interface();
    let Statics { combinations, forces, lift } = statics(evidence, &rows)?;
    let (mut worst, mut explained) = (Worst::none(), Worst::none());
    for columns in panels(combinations.ncols()) {
        let panel = constraint_panel(evidence, combinations.as_ref().get(.., columns.clone()));
        let Residuals { mut residual, terms, .. } = rows.residuals(panel.as_ref(), &vec![0.0; columns.len()]);
        // The rows of the interface carry its reactions.
        residual.as_mut().subrows_mut(partition.n_internal, n_b).fill(0.0);
        worst.take_columns(&rows, columns.clone(), [panel.as_ref(), residual.as_ref(), terms.as_ref()]);
        let moved = dense::product(lift, combinations.as_ref().get(.., columns.clone()));
        let force = dense::product(forces.as_ref(), moved.as_ref());
        explained.take_columns(&rows, columns, [panel.as_ref(), force.as_ref(), terms.as_ref()]);
    }
    let limits = Limits { engineering: 1e-12, arithmetic: 0.0, data: explained.value }.capped(0.0, MAX_EXCUSE);
    Ok(Check {
        id: "M-10",
        name: "interface displacements are in equilibrium",
        equation: "max |K_II Ψ_S + K_IB|_i / (|K_II||Ψ_S| + |K_IB|)_i (23); rows at rest against their own norm",
        value: worst.value,
        limits,
        fail_above: limits.value().max(FAIL),
        worst: worst.name(evidence, column_is(evidence, "constraint mode")),
    })
}

/// Which static solutions are looked at, and what force the correction (24) leaves in them.
pub(super) struct Statics<'a> {
    /// Motions of the interface, n_B × k: each dof, or random combinations of many.
    pub(super) combinations: Mat<f64>,
    /// (KU)_I, n' × n_r, as far as the digits of K excuse it.
    pub(super) forces: Mat<f64>,
    /// U_B⁺, n_r × n_B.
    pub(super) lift: MatRef<'a, f64>,
}

/// What a column of the combinations is called: `single` where each dof is looked at.
pub(super) fn column_is(evidence: &Evidence<'_>, single: &'static str) -> &'static str {
    if is_by_columns(evidence) { single } else { "random combination" }
}

/// Whether each column is looked at: where there are few, and each does not take a solve.
fn is_by_columns(evidence: &Evidence<'_>) -> bool {
    evidence.partition.n_interface() <= MAX_SINGLE_COLUMNS && evidence.constraint.modes.is_stored()
}

/// The motions of the interface whose static solutions are looked at.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn statics<'a>(evidence: &Evidence<'a>, rows: &Rows<'_>) -> Result<Statics<'a>> {
    let n_b = evidence.partition.n_interface();
    let combinations = match is_by_columns(evidence) {
        true => Mat::identity(n_b, n_b),
        false => gaussian(n_b, &rows.norms.scale[evidence.partition.n_internal..]),
    };
    let (forces, lift) = forces_of_correction(evidence)?;
    Ok(Statics { combinations, forces, lift })
}

/// Forces of rigid-body motion at the internal dofs, n' × n_r, twice over, with the U_B⁺ that the correction of Ψ_S used.
///
/// The correction makes the interface carry U and adds (K_II U_I + K_IB U_B) U_B⁺ = (K U)_I U_B⁺ to K_II Ψ_S + K_IB. K lets
/// rigid-body motion pass but for its digits, or what its producer rounded; M-05 judges that, and no more than it warns of is
/// excused here.
fn forces_of_correction<'a>(evidence: &Evidence<'a>) -> Result<(Mat<f64>, MatRef<'a, f64>)> {
    const TWICE: f64 = 2.0;
    let (partition, lift) = (evidence.partition, evidence.constraint.carried.lift());
    if lift.nrows() == 0 {
        return Ok((Mat::zeros(partition.n_dofs(), 0), lift));
    }
    let motions = unit_motions(partition, &evidence.rigid.without_mechanisms())?;
    let mut forces = product(&partition.stiffness, motions.as_ref());
    forces.as_mut().subrows_mut(partition.n_internal, partition.n_interface()).fill(0.0);
    let excused = GROUNDED.max(NOISE_FACTOR * data_noise(partition));
    forces *= faer::Scale(TWICE * (excused / evidence.rigid.energy.largest_residual).min(1.0));
    Ok((forces, lift))
}

/// [Ψ_S; I] G, n' × k.
pub(super) fn constraint_panel(evidence: &Evidence<'_>, g: MatRef<'_, f64>) -> Mat<f64> {
    let (n_i, n_b) = (evidence.partition.n_internal, evidence.partition.n_interface());
    let mut panel = Mat::zeros(n_i + n_b, g.ncols());
    evidence.basis.constraint_modes.add_followed(panel.as_mut().subrows_mut(0, n_i), 1.0, g);
    panel.as_mut().subrows_mut(n_i, n_b).copy_from(g);
    panel
}

/// Normal numbers in the scales of the interface, from a fixed seed.
fn gaussian(n_b: usize, scale: &[f64]) -> Mat<f64> {
    let mut uniform = Mat::zeros(2 * n_b, PROBES);
    crate::random::SplitMix64::new(crate::random::SEED).fill(uniform.as_mut());
    // Box and Muller, from numbers in (−1, 1).
    Mat::from_fn(n_b, PROBES, |i, j| {
        let radius = (-2.0 * uniform[(2 * i, j)].abs().max(f64::MIN_POSITIVE).ln()).sqrt();
        scale[i] * radius * (std::f64::consts::PI * uniform[(2 * i + 1, j)]).cos()
    })
}
