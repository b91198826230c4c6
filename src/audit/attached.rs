//! A file whose static modes are Rubin's, because its interface leaves rigid-body motions free: M-05, M-13, M-22, M-27.
//!
//! ```text
//! Ψ_R = A_I A_B⁻¹ (41)    K̂_BB = A_B⁻¹, K̂_B q = 0 of elastic modes, K̂_B q = −K̂_BB U_B of rigid-body modes
//! Û = [U_B; q]            q the amplitudes of the rigid-body modes, columns of C⁻¹
//! ÛᵀM̂ [I; 0] = 0          static modes are free of rigid-body motion
//! ```

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Side};
use supel_runtime::Coordinate;

use super::content::Content;
use super::flaw::flaw;
use super::named_modes::{named_amplitudes, terms_of_unmixing};
use crate::dense::{self, NOISE_FACTOR, unpacked};
use crate::error::Result;
use crate::rigid::{ILL_CONDITIONED, n_moving_less};
use crate::verification::check::{Check, Limits};
use crate::verification::limits::LARGEST_EXCUSE;

/// All of them.
///
/// # Errors
/// A dense decomposition that does not converge.
pub(super) fn checks(content: &Content<'_>) -> Result<Vec<Check>> {
    let amplitudes = named_amplitudes(content);
    let mut checks = vec![rigid_amplitudes(content, amplitudes.as_ref()), uncoupled(content, amplitudes.as_ref())];
    checks.push(free_of_rigid_motion(content));
    checks.extend(answered(content, amplitudes.as_ref()));
    checks.push(needed(content)?);
    Ok(checks)
}

/// Slots of the modal coordinates of a kind, with what `pick` says of each.
fn slots<T>(content: &Content<'_>, pick: impl Fn(&Coordinate) -> Option<T>) -> Vec<(usize, T)> {
    let modal = content.superelement.metadata().coordinates[content.n_b..].iter().enumerate();
    modal.filter_map(|(slot, coordinate)| Some((slot, pick(coordinate)?))).collect()
}

/// M-05: the amplitudes of Û are those of the columns that are named after rigid-body modes.
fn rigid_amplitudes(content: &Content<'_>, amplitudes: MatRef<'_, f64>) -> Check {
    let rigid = slots(content, |coordinate| match coordinate {
        Coordinate::RigidBodyMode { index } => Some(*index),
        _ => None,
    });
    let rounding = match &content.superelement.tensors().mixing {
        Some(mixing) => terms_of_unmixing(amplitudes, (unpacked(mixing).as_ref(), amplitudes)),
        None => Mat::zeros(amplitudes.nrows(), amplitudes.ncols()),
    };
    let (mut worst, mut limits) = ((0.0, None), Limits { engineering: 1e-10, ..Limits::default() });
    for (slot, index) in rigid {
        if index >= content.n_rigid() {
            worst = (f64::NAN, Some(format!("rigid-body mode {} is none of Û", index + 1)));
            break;
        }
        let stored = &dense::column(content.u.as_ref(), index)[content.n_b..];
        let named = dense::column(amplitudes, slot);
        let size = named.iter().fold(0.0f64, |max, value| max.max(value.abs()));
        let error = stored.iter().zip(named).fold(0.0f64, |max, (a, b)| max.max((a - b).abs())) / size;
        let terms = dense::column(rounding.as_ref(), slot).iter().fold(0.0f64, |max, value| max.max(*value));
        limits.arithmetic = limits.arithmetic.max((NOISE_FACTOR * f64::EPSILON * terms / size).min(LARGEST_EXCUSE));
        if dense::worse(error, worst.0) {
            worst = (error, Some(format!("rigid-body mode {}", index + 1)));
        }
    }
    Check {
        id: "M-05",
        name: "rigid-body modes have the amplitudes of their columns",
        equation: "max |Û_η − C⁻¹|, relative to the largest amplitude",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-8),
        worst: worst.1,
    }
}

/// M-13: the interface does not couple with elastic modes, which are orthogonal in energy to what its loads make of the component.
fn uncoupled(content: &Content<'_>, amplitudes: MatRef<'_, f64>) -> Check {
    let (b, n) = (content.n_b, content.n_reduced() - content.n_b);
    let coupling = dense::product(content.k.as_ref().submatrix(0, b, b, n), amplitudes);
    let diagonal = |slot: usize| {
        let q = amplitudes.subcols(slot, 1);
        let force = dense::product(content.k.as_ref().submatrix(b, b, n, n), q);
        dense::dot(dense::column(q, 0), dense::column(force.as_ref(), 0)).abs()
    };
    let inverse = Inverse::of(content);
    let (mut worst, mut limits) = ((0.0, None), content.rounding_limits());
    for (slot, mode) in slots(content, |coordinate| coordinate.mode().map(|(mode, _)| mode)) {
        let own = diagonal(slot);
        let motion = interface_of_mode(content, content.lambda[mode], amplitudes.subcols(slot, 1));
        let terms = inverse.as_ref().map(|inverse| inverse.terms(motion.as_ref()));
        for i in 0..b {
            let size = (content.k[(i, i)] * own).abs().sqrt();
            let error = coupling[(i, slot)].abs() / size;
            let rounding = terms.as_ref().map_or(0.0, |terms| NOISE_FACTOR * f64::EPSILON * terms[(i, 0)] / size);
            limits.arithmetic = limits.arithmetic.max(rounding.min(LARGEST_EXCUSE));
            if dense::worse(error, worst.0) {
                worst = (error, Some(format!("{} and mode {}", content.name_of(i), mode + 1)));
            }
        }
    }
    Check {
        id: "M-13",
        name: "interface and elastic modes uncoupled in stiffness",
        equation: "max |K̂_B q| / √(K̂_ii qᵀK̂q) of each named elastic mode",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: worst.1,
    }
}

/// K̂_BB of a file, which is the inverse of A_B.
struct Inverse {
    stiffness: Mat<f64>,
    /// |K̂_BB||A_B|.
    terms: Mat<f64>,
}

impl Inverse {
    /// None where K̂_BB has no inverse.
    fn of(content: &Content<'_>) -> Option<Self> {
        let b = content.n_b;
        let stiffness = content.k.as_ref().submatrix(0, 0, b, b).to_owned();
        let (scaled, scale) = dense::unit_diagonal(stiffness.as_ref());
        let inverse = scaled.llt(Side::Lower).ok()?.solve(Mat::<f64>::identity(b, b));
        let flexibility = Mat::from_fn(b, b, |i, j| (inverse[(i, j)] * scale[i] * scale[j]).abs());
        let terms = dense::product(dense::absolute(stiffness.as_ref()).as_ref(), flexibility.as_ref());
        Some(Self { stiffness, terms })
    }

    /// |K̂_BB||A_B||K̂_BB φ_B|: what ε makes an error of K̂_BB φ_B (Higham 2002, section 14.1). K̂_B of a mode is the difference of
    /// A_B⁻ᵀA_IᵀKφ and this, which are equal.
    fn terms(&self, motion: MatRef<'_, f64>) -> Mat<f64> {
        let force = dense::product(self.stiffness.as_ref(), motion);
        dense::product(self.terms.as_ref(), dense::absolute(force.as_ref()).as_ref())
    }
}

/// φ_B of an elastic mode with the amplitudes q: (K̂_BB − λM̂_BB) φ_B = −(K̂_B − λM̂_B) q.
fn interface_of_mode(content: &Content<'_>, lambda: f64, q: MatRef<'_, f64>) -> Mat<f64> {
    let (b, r, d) = (content.n_b, content.n_reduced(), &content.scale);
    let dynamic = Mat::from_fn(b, r, |i, j| (content.k[(i, j)] - lambda * content.m[(i, j)]) * d[i]);
    let mut load = dense::product(dynamic.as_ref().subcols(b, r - b), q);
    load *= faer::Scale(-1.0);
    let own = Mat::from_fn(b, b, |i, j| dynamic[(i, j)] * d[j]);
    let motion = dense::least_squares(own.as_ref(), load.as_ref());
    Mat::from_fn(b, 1, |i, _| motion[(i, 0)] * d[i])
}

/// M-22: ÛᵀM̂ of the static modes.
fn free_of_rigid_motion(content: &Content<'_>) -> Check {
    let q = dense::orthonormal(content.u.as_ref(), content.m.as_ref());
    let momenta = dense::gram(q.as_ref(), content.m.as_ref());
    let mut worst = (0.0, None);
    for i in 0..content.n_b {
        let error = dense::norm(dense::column(momenta.as_ref(), i)) / content.m[(i, i)].sqrt();
        if dense::worse(error, worst.0) {
            worst = (error, Some(content.name_of(i)));
        }
    }
    let limits = content.answer_limits("M-22");
    Check {
        id: "M-22",
        name: "static modes are free of rigid-body motion",
        equation: "max ‖ÛᵀM̂ e_i‖ / √M̂_ii over the interface, Û of unit mass",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: worst.1,
    }
}

/// M-27: K̂ [v_B; q] = f̂ − M̂ÛÛᵀf̂ for every residual vector.
fn answered(content: &Content<'_>, amplitudes: MatRef<'_, f64>) -> Option<Check> {
    let residual = slots(content, |coordinate| match coordinate {
        Coordinate::ResidualVector { load } => Some(*load),
        _ => None,
    });
    let loads = content.superelement.tensors().load_vectors.as_ref().filter(|_| !residual.is_empty())?;
    let (loads, b) = (unpacked(loads), content.n_b);
    let q = dense::orthonormal(content.u.as_ref(), content.m.as_ref());
    let inertia = dense::product(content.m.as_ref(), q.as_ref());
    let mut balanced = loads.clone();
    dense::add_product(balanced.as_mut(), -1.0, inertia.as_ref(), dense::gram(q.as_ref(), loads.as_ref()).as_ref());
    let interface = content.k.as_ref().submatrix(0, 0, b, b).to_owned();
    let (scaled, scale) = dense::unit_diagonal(interface.as_ref());
    let factor = scaled.llt(Side::Lower).ok();
    let mut worst = (0.0, None);
    for (slot, load) in residual {
        // Displacements of the interface that leave no force there.
        let amplitude = dense::column(amplitudes, slot);
        let of_modes = |i: usize| (b..content.n_reduced()).map(|j| content.k[(i, j)] * amplitude[j - b]).sum::<f64>();
        let force = Mat::from_fn(b, 1, |i, _| (balanced[(i, load)] - of_modes(i)) * scale[i]);
        let motion = factor.as_ref().map_or_else(|| Mat::from_fn(b, 1, |_, _| f64::NAN), |factor| factor.solve(&force));
        let whole = |j: usize| if j < b { motion[(j, 0)] * scale[j] } else { amplitude[j - b] };
        let row = |i: usize| (0..content.n_reduced()).map(move |j| content.k[(i, j)] * whole(j));
        let left: Vec<f64> = (0..content.n_reduced()).map(|i| row(i).sum::<f64>() - balanced[(i, load)]).collect();
        let terms: Vec<f64> = (0..content.n_reduced()).map(|i| row(i).map(f64::abs).sum::<f64>()).collect();
        let size = content.force_norm(&terms).max(content.force_norm(dense::column(balanced.as_ref(), load)));
        let error = if size > 0.0 { content.force_norm(&left) / size } else { 0.0 };
        if dense::worse(error, worst.0) {
            worst = (error, Some(content.superelement.metadata().load_names[load].clone()));
        }
    }
    let limits = content.answer_limits("M-27");
    Some(Check {
        id: "M-27",
        name: "residual vectors answer their loads",
        equation: "max ‖K̂v − (f̂ − M̂ÛÛᵀf̂)‖ / ‖|K̂||v|‖, inertia in balance with the load",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: worst.1,
    })
}

/// M-26: rigid-body modes are coordinates only where the interface leaves some of them free, or reacts them so badly that few digits of the
/// stiffness do not tell.
///
/// # Errors
/// A dense decomposition that does not converge.
fn needed(content: &Content<'_>) -> Result<Check> {
    let rows: Vec<usize> = (0..content.n_b).collect();
    // Where supports leave one motion alone and it leaves the interface at rest, rounding is all that the interface has of it.
    let n_free = n_moving_less(ILL_CONDITIONED, content.u.as_ref(), &content.scale, &rows)?;
    let flaws = if n_free == 0 { vec!["the interface carries every rigid-body motion".to_owned()] } else { Vec::new() };
    let equation = "1 where rigid-body modes are coordinates and the interface leaves none of them free, else 0";
    Ok(flaw("rigid-body coordinates are needed", equation, &flaws))
}
