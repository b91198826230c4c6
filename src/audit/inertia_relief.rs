//! Inertia-relief modes answer the inertia of unit accelerations: M-18.
//!
//! With Ψ_IRM = K_II⁻¹ (MU)_I (37) and q its amplitudes, K̂_ηη q = Ψ_Dᵀ (MU)_I = M̂_ηB Û_B, because Ψ_S U_B = U_I (24).

use super::content::Content;
use super::named_modes::{named_amplitudes, relief};
use crate::dense;
use crate::verification::check::Check;

/// M-18: K̂_ηη q = M̂_ηB Û_B for every inertia-relief mode.
pub(super) fn identity(content: &Content<'_>) -> Option<Check> {
    let relief = relief(content);
    if relief.is_empty() {
        return None;
    }
    let (b, n) = (content.n_b, content.n_reduced() - content.n_b);
    let amplitudes = named_amplitudes(content);
    let loads = dense::product(content.m.as_ref().submatrix(b, 0, n, b), content.u.as_ref().subrows(0, b));
    let stiffness = content.k.as_ref().submatrix(b, b, n, n);
    let forces = dense::product(stiffness, amplitudes.as_ref());
    let mut worst = (0.0, None);
    for (slot, index) in relief {
        let (force, q) = (dense::column(forces.as_ref(), slot), dense::column(amplitudes.as_ref(), slot));
        if index >= loads.ncols() {
            worst = (f64::NAN, Some(format!("inertia relief {} without its rigid-body mode", index + 1)));
            break;
        }
        let load = dense::column(loads.as_ref(), index);
        let difference: Vec<f64> = force.iter().zip(load).map(|(a, b)| a - b).collect();
        // The sizes of the terms before they cancel are what rounding is relative to.
        let terms: Vec<f64> = (0..n).map(|i| (0..n).map(|j| (stiffness[(i, j)] * q[j]).abs()).sum()).collect();
        let size = dense::norm(&terms).max(dense::norm(load));
        let error = if size > 0.0 { dense::norm(&difference) / size } else { 0.0 };
        if dense::worse(error, worst.0) {
            worst = (error, Some(format!("inertia relief {}", index + 1)));
        }
    }
    let limits = content.answer_limits("M-18");
    Some(Check {
        id: "M-18",
        name: "inertia relief answers unit accelerations",
        equation: "max ‖K̂_ηη q − M̂_ηB Û_B‖ / ‖|K̂_ηη||q|‖ (37)",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: worst.1,
    })
}
