//! Static answers to the loads of the job: M-27.

use super::check::{Check, Limits, MAX_EXCUSE};
use super::evidence::Evidence;
use super::loads::{reduced_deflections, root_of_energy};
use crate::basis::{ANSWERED, DynamicCoordinate};
use crate::dense;
use crate::eigen::rows_with_mass;
use crate::sparse::product;

/// What the basis lacks of the static answer to each load of the job, its interface held: ‖u − Ψ_D η‖_K / ‖u‖_K, zero for a load that acts
/// on the interface alone. None where there are no loads, where nothing answers them, or where K̂_ηη is not definite, which M-25 says.
pub(super) fn lacking(evidence: &Evidence<'_>) -> Option<Vec<f64>> {
    let partition = evidence.partition;
    let full = evidence.answers.filter(|answers| answers.ncols() > 0)?;
    let loads = partition.loads.vectors.as_ref().subrows(0, partition.n_internal);
    let error = full - reduced_deflections(evidence, loads)?;
    let forces = product(partition.internal().stiffness, error.as_ref());
    let share = |load: usize| {
        let missed = root_of_energy(error.as_ref(), forces.as_ref(), load);
        if missed == 0.0 { 0.0 } else { missed / root_of_energy(full.as_ref(), loads, load) }
    };
    Some((0..full.ncols()).map(share).collect())
}

/// What to say of a load whose residual vector adds nothing with mass to the other columns: no mass of a superelement has coordinates without.
fn remaining_mass(evidence: &Evidence<'_>, load: usize) -> &'static str {
    let (basis, residual_vector) = (evidence.basis, DynamicCoordinate::ResidualVector(load));
    let is_left_out = basis.dropped.iter().any(|column| column.coordinate == residual_vector);
    match is_left_out && basis.n_dynamic() == rows_with_mass(evidence.partition.internal().mass) {
        true => {
            ": the modes span all that has mass, and no coordinate is left for an answer without; add its node to the interface, or set \
             residual = false"
        }
        false => "",
    }
}

/// M-27: the load with a residual vector that is answered worst, which is judged, and the one without, which is shown.
pub(super) fn checks(evidence: &Evidence<'_>, lacking: Option<&[f64]>, condition: f64) -> Vec<Check> {
    const FAIL: f64 = 1e-6;
    let Some(lacking) = lacking else { return Vec::new() };
    let loads = &evidence.partition.loads.facts;
    // The condition is that of the matrix, not of this solve; a thousandth of a deflection makes no difference.
    let exact =
        Limits { engineering: ANSWERED, arithmetic: f64::EPSILON * condition, data: 0.0 }.capped(1e-3, MAX_EXCUSE);
    let of_kind = |has_residual_vector: bool, name: &'static str, (limits, fail_above): (Limits, f64)| {
        let of_kind = (0..loads.len()).filter(|load| loads[*load].has_residual_vector == has_residual_vector);
        let worst =
            of_kind.reduce(|worst, next| if dense::worse(lacking[next], lacking[worst]) { next } else { worst })?;
        Some(Check {
            id: "M-27",
            name,
            equation: "max ‖u − Ψ_D η‖_K / ‖u‖_K, interface held, u = K_II⁻¹ f_I, η = K̂_ηη⁻¹ Ψ_Dᵀ f_I",
            value: lacking[worst],
            limits,
            fail_above,
            worst: Some(loads[worst].name.clone() + remaining_mass(evidence, worst)),
        })
    };
    let judged = of_kind(true, "static answer to loads with residual vectors", (exact, exact.value().max(FAIL)));
    let shown = of_kind(false, "static answer to loads without residual vectors", (Limits::NONE, f64::INFINITY));
    judged.into_iter().chain(shown).collect()
}
