//! Rubin's residual attachment modes [I; Ψ_R] are what the interface's forces and the inertia they set free make of the component,
//! without rigid-body motion: M-22.

use faer::MatRef;

use super::check::{Check, Limits};
use super::evidence::Evidence;
use super::residual::{Residuals, Rows, Worst};
use super::solves::{Statics, column_is, statics};
use crate::dense::{self, NOISE_FACTOR};
use crate::error::Result;
use crate::reduction::panel_of;
use crate::rubin::Rubin;
use crate::sparse::{panels, product};

/// M-22, where the method is Rubin's.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn checks(evidence: &Evidence<'_>) -> Result<Vec<Check>> {
    match evidence.rubin {
        Some(rubin) if rubin.n_rigid() > 0 => Ok(vec![orthogonality(evidence, rubin), equilibrium(evidence, rubin)?]),
        _ => Ok(Vec::new()),
    }
}

/// UᵀM[Ψ_R; I] = 0, by the full matrices.
fn orthogonality(evidence: &Evidence<'_>, rubin: &Rubin) -> Check {
    const FAIL: f64 = 1e-8;
    let n_b = rubin.n_interface();
    let (mut worst, mut lost) = ((0.0, 0), 1.0f64);
    for columns in panels(n_b) {
        let reduced = rubin.columns.as_ref().subcols(columns.start, columns.len());
        let (whole, statics) = (evidence.basis.expanded(reduced), panel_of(evidence.basis, columns.clone()));
        let left = dense::gram(evidence.rigid.mass_orthonormal.as_ref(), whole.as_ref());
        let relief = &whole - &statics;
        let [whole, statics, relief] = [&whole, &statics, &relief].map(|motions| lengths(evidence, motions.as_ref()));
        for (j, column) in columns.enumerate() {
            let error = dense::norm(dense::column(left.as_ref(), j)) / whole[j];
            if dense::worse(error, worst.0) {
                worst = (error, column);
            }
            lost = lost.max((statics[j] + relief[j]) / whole[j]);
        }
    }
    // Both parts are known to rounding, and what they have in common cancels.
    let limits = Limits { engineering: 1e-12, arithmetic: NOISE_FACTOR * f64::EPSILON * lost, data: 0.0 };
    Check {
        id: "M-22",
        name: "attachment modes are free of rigid-body motion",
        equation: "max ‖UᵀMΨ_R‖ / ‖Ψ_R‖_M (49), U of unit mass",
        value: worst.0,
        limits: limits.capped(FAIL, 1e-2),
        fail_above: limits.value().max(FAIL),
        worst: Some(format!("attachment mode {}", worst.1 + 1)),
    }
}

/// (K[Ψ_R; I] − MUZ_B)_I = 0, row by row: forces act on the interface alone, but for inertia of rigid-body motion.
fn equilibrium(evidence: &Evidence<'_>, rubin: &Rubin) -> Result<Check> {
    const FAIL: f64 = 1e-9;
    let partition = evidence.partition;
    let rows = Rows::of(partition.pencil());
    let Statics { combinations, forces, lift } = statics(evidence, &rows)?;
    let inertia = product(&partition.mass, evidence.rigid.modes.as_ref());
    let (mut worst, mut explained) = (Worst::none(), Worst::none());
    for columns in panels(combinations.ncols()) {
        let mixture = combinations.as_ref().get(.., columns.clone());
        let reduced = dense::product(rubin.columns.as_ref().subcols(0, rubin.n_interface()), mixture);
        let panel = evidence.basis.expanded(reduced.as_ref());
        let Residuals { mut residual, mut terms, .. } = rows.residuals(panel.as_ref(), &vec![0.0; columns.len()]);
        let loads = dense::product(inertia.as_ref(), dense::product(rubin.relief.as_ref(), mixture).as_ref());
        residual -= &loads;
        terms += dense::absolute(loads.as_ref());
        residual.as_mut().subrows_mut(partition.n_internal, partition.n_interface()).fill(0.0);
        let force = dense::product(forces.as_ref(), dense::product(lift, mixture).as_ref());
        worst.take_columns(&rows, columns.clone(), [panel.as_ref(), residual.as_ref(), terms.as_ref()]);
        explained.take_columns(&rows, columns, [panel.as_ref(), force.as_ref(), terms.as_ref()]);
    }
    let limits = Limits { engineering: 1e-12, arithmetic: 0.0, data: explained.value }.capped(0.0, 1e-2);
    Ok(Check {
        id: "M-22",
        name: "attachment modes are in equilibrium with inertia",
        equation: "max |K_II Ψ_R + K_IB − (MUZ_B)_I|_i / (|K_II||Ψ_R| + |K_IB| + |MUZ_B|)_i (40)",
        value: worst.value,
        limits,
        fail_above: limits.value().max(FAIL),
        worst: worst.name(evidence, column_is(rubin.n_interface(), "attachment mode")),
    })
}

/// √(xᵀMx) of each column.
fn lengths(evidence: &Evidence<'_>, motions: MatRef<'_, f64>) -> Vec<f64> {
    let momenta = product(&evidence.partition.mass, motions);
    dense::dots(momenta.as_ref(), motions).into_iter().map(|square| square.max(0.0).sqrt()).collect()
}
