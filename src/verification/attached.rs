//! Rubin's static modes where the interface leaves rigid-body motions free, by the full matrices: M-17, M-22 and M-27.
//!
//! ```text
//! A     n' × n_B   answers of the free component to unit loads at the interface and the inertia that these set free (40)
//! Ψ_R   n_I × n_B  A_I A_B⁻¹ (41)
//! Â_B   n_B × n_B  the same flexibility by the reduced matrices
//! ```

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Side};

use super::check::{Check, Limits, MAX_EXCUSE};
use super::evidence::{Evidence, data_noise};
use super::limits::share_of_data;
use super::loads::root_of_energy;
use super::residual::{Residuals, Rows, Worst};
use super::spectrum::Spectrum;
use crate::basis::ANSWERED;
use crate::constraint::Attachment;
use crate::dense::{self, NOISE_FACTOR};
use crate::reduction::panel_of;
use crate::sparse::{panels, product};

/// M-22 and M-27, where the static modes are Rubin's.
pub(super) fn checks(evidence: &Evidence<'_>) -> Vec<Check> {
    let Some(attachment) = &evidence.constraint.attachment else { return Vec::new() };
    let mut checks = vec![orthogonality(evidence, attachment), equilibrium(evidence, attachment)];
    checks.extend(answered(evidence, attachment));
    checks
}

/// M-22: UᵀM[I; Ψ_R] = 0.
fn orthogonality(evidence: &Evidence<'_>, attachment: &Attachment) -> Check {
    const FAIL: f64 = 1e-6;
    let mut worst = (0.0, 0);
    for columns in panels(evidence.partition.n_interface()) {
        let statics = panel_of(evidence.basis, columns.clone());
        let left = dense::gram(evidence.rigid.mass_orthonormal.as_ref(), statics.as_ref());
        let momenta = product(&evidence.partition.mass, statics.as_ref());
        let squares = dense::dots(momenta.as_ref(), statics.as_ref());
        for (j, column) in columns.enumerate() {
            let error = dense::norm(dense::column(left.as_ref(), j)) / squares[j].max(0.0).sqrt();
            if dense::worse(error, worst.0) {
                worst = (error, column);
            }
        }
    }
    // A is free of rigid-body motion to rounding; the inverse of A_B puts it together from terms as much larger.
    let arithmetic = NOISE_FACTOR * f64::EPSILON * attachment.condition;
    let limits = Limits { engineering: 1e-12, arithmetic, data: 0.0 }.capped(FAIL, MAX_EXCUSE);
    Check {
        id: "M-22",
        name: "attachment modes are free of rigid-body motion",
        equation: "max ‖UᵀMΨ_R‖ / ‖Ψ_R‖_M (49), U of unit mass",
        value: worst.0,
        limits,
        fail_above: limits.value().max(FAIL),
        worst: Some(format!("attachment mode {}", worst.1 + 1)),
    }
}

/// M-22: KA = F − MQQᵀF, row by row.
fn equilibrium(evidence: &Evidence<'_>, attachment: &Attachment) -> Check {
    const FAIL: f64 = 1e-8;
    let partition = evidence.partition;
    let rows = Rows::of(partition.pencil());
    let n_i = partition.n_internal;
    let (mut worst, mut explained) = (Worst::none(), Worst::none());
    // K lets rigid-body motion pass but for its digits, and what Pᵀ takes from a load is known as well.
    let digits = NOISE_FACTOR * (f64::EPSILON + data_noise(partition));
    for columns in panels(partition.n_interface()) {
        let answers = attachment.modes.as_ref().get(.., columns.clone());
        let Residuals { mut residual, mut terms, .. } = rows.residuals(answers, &vec![0.0; columns.len()]);
        let (loads, of_loads) = balanced_units(evidence, columns.clone());
        residual -= &loads;
        let unit = |i: usize, j: usize| f64::from(u8::from(i == n_i + columns.start + j));
        terms += &of_loads;
        worst.take_columns(&rows, columns.clone(), [answers, residual.as_ref(), terms.as_ref()]);
        // What rounding leaves of the inertia: QᵀF of every entry of MQ.
        let of_motion = Mat::from_fn(loads.nrows(), loads.ncols(), |i, j| digits * (loads[(i, j)] - unit(i, j)).abs());
        explained.take_columns(&rows, columns, [answers, of_motion.as_ref(), terms.as_ref()]);
    }
    let limits = Limits { engineering: 1e-12, arithmetic: explained.value, data: data_noise(partition) };
    let limits = limits.capped(FAIL, MAX_EXCUSE);
    Check {
        id: "M-22",
        name: "attachment modes are in equilibrium with inertia",
        equation: "max |KA − (F − MQQᵀF)|_i / (|K||A| + |F| + ‖MQ‖‖QᵀF‖)_i (40)",
        value: worst.value,
        limits,
        fail_above: limits.value().max(FAIL),
        worst: worst.name(evidence, "attachment mode"),
    }
}

/// F − MQQᵀF of unit loads on some interface dofs, and the size |F| + ‖(MQ)_i‖ ‖QᵀF‖ of each row, n' × k. A dof of a patch that ties all nodes
/// moves the component as a rigid body: there nothing is left of a load but rounding, for which what Schwarz makes of the inertia stands.
fn balanced_units(evidence: &Evidence<'_>, columns: std::ops::Range<usize>) -> (Mat<f64>, Mat<f64>) {
    let (n, n_i) = (evidence.partition.n_dofs(), evidence.partition.n_internal);
    let mut loads = Mat::from_fn(n, columns.len(), |i, j| f64::from(u8::from(i == n_i + columns.start + j)));
    let momenta = evidence.rigid.mass_orthonormal.as_ref();
    let along = dense::gram(evidence.rigid.orthonormal.as_ref(), loads.as_ref());
    let of_row = |i: usize| (0..momenta.ncols()).map(|j| momenta[(i, j)].powi(2)).sum::<f64>().sqrt();
    let rows: Vec<f64> = (0..n).map(of_row).collect();
    let shares: Vec<f64> = (0..columns.len()).map(|j| dense::norm(dense::column(along.as_ref(), j))).collect();
    let sizes = Mat::from_fn(n, columns.len(), |i, j| loads[(i, j)] + rows[i] * shares[j]);
    dense::add_product(loads.as_mut(), -1.0, momenta, along.as_ref());
    (loads, sizes)
}

/// M-17: the flexibility of the interface by the reduced matrices is that of the full ones. Digits that leave an energy of rigid-body motion,
/// relative to the first elastic one, leave as much of it open.
pub(super) fn flexibility(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Option<Check> {
    const FAIL: f64 = 1e-6;
    let attachment = evidence.constraint.attachment.as_ref()?;
    let (n_i, n_b) = (evidence.partition.n_internal, evidence.partition.n_interface());
    let unit = Mat::from_fn(evidence.reduction.n_reduced(), n_b, |i, j| f64::from(u8::from(i == j)));
    let reduced = answers(evidence, unit.as_ref());
    let full = attachment.modes.as_ref().subrows(n_i, n_b);
    let (mut worst, mut at) = (0.0, None);
    for (i, j) in (0..n_b).flat_map(|j| (0..n_b).map(move |i| (i, j))) {
        let found = reduced.as_ref().map_or(f64::NAN, |reduced| reduced[(i, j)]);
        let error = (found - full[(i, j)]).abs() / (full[(i, i)] * full[(j, j)]).abs().sqrt();
        if dense::worse(error, worst) {
            (worst, at) = (error, Some((i, j)));
        }
    }
    let name = |dof: usize| evidence.partition.name_of(n_i + dof);
    let own = rounding(evidence, attachment);
    let data = own.data.max(spectrum.noise * share_of_data(evidence.partition));
    let limits = Limits { engineering: 1e-10, data, ..own }.capped(FAIL, MAX_EXCUSE);
    Some(Check {
        id: "M-17",
        name: "flexibility of the interface is preserved",
        equation: "max |A_B − Â_B|_ij / √(A_ii A_jj), inertia in balance with unit loads (40)",
        value: worst,
        limits,
        fail_above: limits.value().max(FAIL),
        worst: at.map(|(i, j)| format!("{} and {}", name(i), name(j))),
    })
}

/// What rounding of K̂ makes of a reduced answer: its entries are those of A_B⁻¹, which is as much larger as that is ill-conditioned.
fn rounding(evidence: &Evidence<'_>, attachment: &Attachment) -> Limits {
    let arithmetic = NOISE_FACTOR * evidence.reduction.n_reduced() as f64 * f64::EPSILON * attachment.condition;
    Limits { engineering: 0.0, arithmetic, data: data_noise(evidence.partition) * attachment.condition }
}

/// M-27: what the reduced model lacks of the answers to the loads of the job, the worst with a residual vector and the worst without.
fn answered(evidence: &Evidence<'_>, attachment: &Attachment) -> Vec<Check> {
    let full = attachment.of_loads.as_ref();
    let facts = &evidence.partition.loads.facts;
    let Some(reduced) = answers(evidence, evidence.reduction.loads.as_ref()).filter(|_| !facts.is_empty()) else {
        return Vec::new();
    };
    let error = full - evidence.basis.expanded(reduced.as_ref());
    let [of_error, of_full] = [error.as_ref(), full].map(|motions| product(&evidence.partition.stiffness, motions));
    let share = |load: usize| {
        let missed = root_of_energy(error.as_ref(), of_error.as_ref(), load);
        if missed == 0.0 { 0.0 } else { missed / root_of_energy(full, of_full.as_ref(), load) }
    };
    let of_kind = |has_residual_vector: bool, name: &'static str, judged: (Limits, f64)| {
        let loads = (0..facts.len()).filter(|load| facts[*load].has_residual_vector == has_residual_vector);
        let shares = loads.map(|load| (share(load), load));
        let worst = shares.reduce(|worst, next| if dense::worse(next.0, worst.0) { next } else { worst })?;
        Some(Check {
            id: "M-27",
            name,
            equation: "max ‖a − Ψ q‖_K / ‖a‖_K, a and q the answers of the free component with inertia in balance",
            value: worst.0,
            limits: judged.0,
            fail_above: judged.1,
            worst: Some(facts[worst.1].name.clone()),
        })
    };
    let exact = Limits { engineering: ANSWERED, ..rounding(evidence, attachment) }.capped(1e-3, MAX_EXCUSE);
    let judged = of_kind(true, "static answer to loads with residual vectors", (exact, exact.value().max(1e-6)));
    let shown = of_kind(false, "static answer to loads without residual vectors", (Limits::NONE, f64::INFINITY));
    judged.into_iter().chain(shown).collect()
}

/// Answers of the reduced model to loads, r × k, with the inertia that they set free and without rigid-body motion; none where K̂ is not
/// definite on what is left, which M-25 says.
fn answers(evidence: &Evidence<'_>, loads: MatRef<'_, f64>) -> Option<Mat<f64>> {
    let (k, m, _) = evidence.reduction.pencil();
    let q = evidence.reduced_rigid();
    let momenta = dense::product(m, q.as_ref());
    // M̂QQᵀf is the inertia; K̂ + c M̂Q(M̂Q)ᵀ answers what is left of f without rigid-body motion, whatever c > 0.
    let mut balanced = loads.to_owned();
    dense::add_product(balanced.as_mut(), -1.0, momenta.as_ref(), dense::gram(q.as_ref(), loads).as_ref());
    let lift = evidence.retained.modes.lambda.first().copied().filter(|lambda| *lambda > 0.0).unwrap_or(1.0);
    let mut lifted = k.to_owned();
    dense::add_product(lifted.as_mut(), lift, momenta.as_ref(), momenta.transpose());
    dense::symmetrise(&mut lifted);
    let (scaled, scale) = dense::unit_diagonal(lifted.as_ref());
    let scaled_by = |a: &Mat<f64>| Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] * scale[i]);
    let factor = scaled.llt(Side::Lower).ok()?;
    Some(scaled_by(&factor.solve(&scaled_by(&balanced))))
}
