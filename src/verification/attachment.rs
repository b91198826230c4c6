//! Rubin's residual attachment modes [I; Ψ_R] are what the interface's forces and the inertia they set free make of the component,
//! without rigid-body motion: M-22.

use faer::{Mat, MatRef};

use super::check::{Check, Limits, MAX_EXCUSE};
use super::evidence::Evidence;
use super::residual::{Residuals, Rows, Worst};
use super::solves::{Statics, column_is, constraint_panel, statics};
use crate::dense::{self, NOISE_FACTOR};
use crate::error::Result;
use crate::reduction::panel_of;
use crate::rubin::Rubin;
use crate::sparse::{panels, product, product_and_terms};

/// M-22, where the method is Rubin's.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn checks(evidence: &Evidence<'_>) -> Result<Vec<Check>> {
    match evidence.rubin {
        Some(rubin) if rubin.n_rigid() > 0 => Ok(vec![orthogonality(evidence, rubin)?, equilibrium(evidence, rubin)?]),
        _ => Ok(Vec::new()),
    }
}

/// UᵀM[Ψ_R; I] = 0, by the full matrices.
///
/// # Errors
/// A dense eigenproblem that does not converge.
fn orthogonality(evidence: &Evidence<'_>, rubin: &Rubin) -> Result<Check> {
    const FAIL: f64 = 1e-8;
    let n_b = rubin.n_interface();
    let (mut worst, mut lost) = ((0.0, 0), 1.0f64);
    for columns in panels(n_b) {
        let reduced = rubin.columns.as_ref().subcols(columns.start, columns.len());
        let (whole, statics) = (evidence.basis.expanded(reduced), panel_of(evidence.basis, columns.clone()));
        let left = dense::gram(evidence.rigid.mass_orthonormal.as_ref(), whole.as_ref());
        let terms = momenta_before(evidence, statics.as_ref());
        let [whole, statics] = [&whole, &statics].map(|motions| lengths(evidence, motions.as_ref()));
        for (j, column) in columns.enumerate() {
            let error = dense::norm(dense::column(left.as_ref(), j)) / whole[j];
            if dense::worse(error, worst.0) {
                worst = (error, column);
            }
            // Columns of Ψ_D have unit length.
            let summed: f64 = dense::column(reduced, j)[n_b..].iter().map(|amplitude| amplitude.abs()).sum();
            lost = lost.max((statics[j] + summed + terms[j]) / whole[j]);
        }
    }
    // Both parts are known to rounding, and what they have in common cancels. Momenta along U are, and those along its orthonormal
    // combinations as far as the motions of U are independent: turns about an origin far away are nearly translations.
    let amplified = lost / independence(evidence)?;
    let limits = Limits { engineering: 1e-12, arithmetic: NOISE_FACTOR * f64::EPSILON * amplified, data: 0.0 };
    Ok(Check {
        id: "M-22",
        name: "attachment modes are free of rigid-body motion",
        equation: "max ‖UᵀMΨ_R‖ / ‖Ψ_R‖_M (49), U of unit mass",
        value: worst.0,
        limits: limits.capped(FAIL, MAX_EXCUSE),
        fail_above: limits.value().max(FAIL),
        worst: Some(format!("attachment mode {}", worst.1 + 1)),
    })
}

/// ‖|Q|ᵀ|M|(|x| + |Q||QᵀMx|)‖ of each column x: what its momenta along rigid-body motions are summed from, before these motions are taken
/// out of it. Rotations about a heavy mass are no part of its momentum, but sums of terms of that size.
fn momenta_before(evidence: &Evidence<'_>, x: MatRef<'_, f64>) -> Vec<f64> {
    let along = dense::gram(evidence.rigid.mass_orthonormal.as_ref(), x);
    let q = dense::absolute(evidence.rigid.orthonormal.as_ref());
    let mut sizes = dense::absolute(x);
    dense::add_product(sizes.as_mut(), 1.0, q.as_ref(), dense::absolute(along.as_ref()).as_ref());
    let (_, terms) = product_and_terms(&evidence.partition.mass, sizes.as_ref());
    let sums = dense::gram(q.as_ref(), terms.as_ref());
    (0..sums.ncols()).map(|j| dense::norm(dense::column(sums.as_ref(), j))).collect()
}

/// The least singular value of the rigid-body motions that have mass, each of unit length in it.
fn independence(evidence: &Evidence<'_>) -> Result<f64> {
    let momenta = dense::gram(evidence.rigid.mass_orthonormal.as_ref(), evidence.rigid.modes.as_ref());
    let length = |j: usize| dense::norm(dense::column(momenta.as_ref(), j));
    let massive: Vec<usize> = (0..momenta.ncols()).filter(|j| length(*j) > 0.0).collect();
    let unit = Mat::from_fn(momenta.nrows(), massive.len(), |i, j| momenta[(i, massive[j])] / length(massive[j]));
    let (values, _) = dense::right_singular(unit.as_ref())?;
    Ok(values.last().copied().unwrap_or(1.0).max(f64::EPSILON))
}

/// (K[Ψ_R; I] − MUZ_B)_I = 0, row by row: forces act on the interface alone, but for inertia of rigid-body motion.
///
/// Ψ_R is put together from Ψ_S and N Z_B, of which the larger part cancels in a slender body: rounding of a row is relative to its terms
/// before that, |K|(|Ψ_S| + |N||Z_B|) + |MU||Z_B|. The row is told that is farthest beyond its own limit, or closest to it.
fn equilibrium(evidence: &Evidence<'_>, rubin: &Rubin) -> Result<Check> {
    const FAIL: f64 = 1e-9;
    const ENGINEERING: f64 = 1e-12;
    /// What rounding may excuse of a force: half of the digits.
    const LARGEST_ROUNDING: f64 = 1e-6;
    let partition = evidence.partition;
    let rows = Rows::of(partition.pencil());
    let Statics { combinations, forces, lift } = statics(evidence, &rows)?;
    let parts = Parts::of(evidence, rubin);
    let (mut worst, mut rounding, mut explained) = (Worst::none(), 0.0, Worst::none());
    for columns in panels(combinations.ncols()) {
        let mixture = combinations.as_ref().get(.., columns.clone());
        let reduced = dense::product(rubin.columns.as_ref().subcols(0, rubin.n_interface()), mixture);
        let panel = evidence.basis.expanded(reduced.as_ref());
        let Residuals { mut residual, mut terms, .. } = rows.residuals(panel.as_ref(), &vec![0.0; columns.len()]);
        let loads = dense::product(parts.inertia.as_ref(), dense::product(rubin.relief.as_ref(), mixture).as_ref());
        residual -= &loads;
        terms += dense::absolute(loads.as_ref());
        let force = dense::product(forces.as_ref(), dense::product(lift, mixture).as_ref());
        explained.take_columns(&rows, columns.clone(), [panel.as_ref(), force.as_ref(), terms.as_ref()]);
        let before = parts.terms(evidence, rubin, mixture);
        for (j, column) in columns.enumerate() {
            let sizes = rows.sizes(0.0, dense::column(panel.as_ref(), j), dense::column(terms.as_ref(), j));
            for (row, size) in sizes.into_iter().enumerate().take(partition.n_internal) {
                let value = if residual[(row, j)] == 0.0 { 0.0 } else { residual[(row, j)].abs() / size };
                let own = (NOISE_FACTOR * f64::EPSILON * before[(row, j)] / size).min(LARGEST_ROUNDING);
                let room = |rounding: f64| rounding.max(ENGINEERING);
                if worst.at.is_none() || dense::worse(value / room(own), worst.value / room(rounding)) {
                    (worst, rounding) = (Worst { value, at: Some((column, row)) }, own);
                }
            }
        }
    }
    let limits = Limits { engineering: ENGINEERING, arithmetic: rounding, data: explained.value };
    let limits = limits.capped(LARGEST_ROUNDING, MAX_EXCUSE);
    Ok(Check {
        id: "M-22",
        name: "attachment modes are in equilibrium with inertia",
        equation: "max |K_II Ψ_R + K_IB − (MUZ_B)_I|_i / (|K_II||Ψ_R| + |K_IB| + |MUZ_B|)_i (40)",
        value: worst.value,
        limits,
        fail_above: limits.value().max(FAIL),
        worst: worst.name(evidence, column_is(evidence, "attachment mode")),
    })
}

/// What attachment modes are put together from.
struct Parts {
    /// MU, n' × n_r.
    inertia: Mat<f64>,
    /// |N|, n_I × n_r.
    relief: Mat<f64>,
}

impl Parts {
    fn of(evidence: &Evidence<'_>, rubin: &Rubin) -> Self {
        let coordinates = evidence.basis.mixing.as_ref().subcols(0, rubin.n_rigid());
        let relief = dense::product(evidence.basis.dynamic_modes.as_ref(), coordinates);
        Self {
            inertia: product(&evidence.partition.mass, evidence.rigid.modes.as_ref()),
            relief: dense::absolute(relief.as_ref()),
        }
    }

    /// |K|(|Ψ_S C| + |N||Z_B C|) + |MU||Z_B C|, n' × k, of mixtures C of attachment modes.
    fn terms(&self, evidence: &Evidence<'_>, rubin: &Rubin, mixture: MatRef<'_, f64>) -> Mat<f64> {
        let partition = evidence.partition;
        let amplitudes = dense::absolute(dense::product(rubin.relief.as_ref(), mixture).as_ref());
        let mut motions = dense::absolute(constraint_panel(evidence, mixture).as_ref());
        let interior = motions.as_mut().subrows_mut(0, partition.n_internal);
        dense::add_product(interior, 1.0, self.relief.as_ref(), amplitudes.as_ref());
        let (_, mut terms) = product_and_terms(&partition.stiffness, motions.as_ref());
        dense::add_product(terms.as_mut(), 1.0, dense::absolute(self.inertia.as_ref()).as_ref(), amplitudes.as_ref());
        terms
    }
}

/// √(xᵀMx) of each column.
fn lengths(evidence: &Evidence<'_>, motions: MatRef<'_, f64>) -> Vec<f64> {
    let momenta = product(&evidence.partition.mass, motions);
    dense::dots(momenta.as_ref(), motions).into_iter().map(|square| square.max(0.0).sqrt()).collect()
}
