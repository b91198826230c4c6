//! What guards work that a run has left out: random motions of the reduced model against those of the full one, where no constraint mode is
//! stored, and parts of the interior that were factored apart: M-32.
//!
//! ```text
//! q    r × 2     random, in the scales of the coordinates
//! x    n' × 2    Ψ q
//! g    r × 2     Ψᵀ K x, to be K̂ q;  xᵀMx, to be qᵀM̂q
//! ```
//! A column of K̂ or M̂ that is wrong shows in every probe but for a set of measure zero.

use faer::Mat;

use super::check::{Check, Limits};
use super::evidence::{Evidence, coordinate_name, coordinate_scales, reduced_norms};
use super::spectrum::zero_level;
use crate::dense::{self, NOISE_FACTOR};
use crate::random::{SEED, SplitMix64};
use crate::reduction::transpose_apply;
use crate::sparse::{Leading, energies_of_terms, product_and_terms};

/// Random motions.
const PROBES: usize = 2;
/// Relative error of a probe at which the check fails: half of the digits of what stores every column.
const FAIL: f64 = 1e-8;

/// Probes of K̂; none where every constraint mode is stored and looked at by itself.
pub(super) fn stiffness(evidence: &Evidence<'_>) -> Option<Check> {
    let q = probes(evidence)?;
    let x = evidence.basis.expanded(q.as_ref());
    let (forces, _) = product_and_terms(&evidence.partition.stiffness, x.as_ref());
    let of_full = transpose_apply(evidence.basis, forces.as_ref());
    let of_reduced = dense::product(evidence.reduction.stiffness.as_ref(), q.as_ref());
    let difference = of_reduced - of_full;
    let norms = reduced_norms(evidence);
    let mut worst = (0.0, None);
    for j in 0..PROBES {
        let column = dense::column(difference.as_ref(), j);
        let error = norms.backward_error(0.0, dense::column(q.as_ref(), j), column);
        if dense::worse(error, worst.0) {
            worst = (error, Some(coordinate_name(evidence, norms.largest(column))));
        }
    }
    let limits = Limits { engineering: 1e-12, ..zero_level(evidence) };
    Some(Check {
        id: "M-32",
        name: "reduced stiffness answers random motions as the full one",
        equation: "max ‖K̂q − ΨᵀKΨq‖ / (‖K‖ ‖q‖) of random q, in the scales of the uncondensed stiffness",
        value: worst.0,
        limits,
        fail_above: limits.value().max(FAIL),
        worst: worst.1,
    })
}

/// Probes of M̂; none where every constraint mode is stored, nor of a mass that is not ΨᵀMΨ.
pub(super) fn mass(evidence: &Evidence<'_>) -> Option<Check> {
    let q = probes(evidence).filter(|_| evidence.reduction.modal_mass.is_none())?;
    let x = evidence.basis.expanded(q.as_ref());
    let (momenta, terms) = product_and_terms(&evidence.partition.mass, x.as_ref());
    let of_full = dense::dots(x.as_ref(), momenta.as_ref());
    let of_reduced = dense::dots(q.as_ref(), dense::product(evidence.reduction.mass.as_ref(), q.as_ref()).as_ref());
    let sizes = energies_of_terms(x.as_ref(), terms.as_ref());
    let errors = (0..PROBES).map(|j| (of_reduced[j] - of_full[j]).abs() / sizes[j]);
    // Sums over r coordinates, made once in M̂ and once here.
    let arithmetic = NOISE_FACTOR * evidence.reduction.n_reduced() as f64 * f64::EPSILON;
    let limits = Limits { engineering: 1e-12, arithmetic, data: 0.0 }.capped(1e-10, 0.0);
    Some(Check {
        id: "M-32",
        name: "reduced mass has the energy of the full one in random motions",
        equation: "max |qᵀM̂q − xᵀMx| / |x|ᵀ|M||x| of random q, x = Ψq",
        value: dense::worst(errors),
        limits,
        fail_above: limits.value().max(FAIL),
        worst: None,
    })
}

/// Entries of K and M between parts that were ordered and factored apart; none where the interior is one part.
pub(super) fn parts(evidence: &Evidence<'_>) -> Option<Check> {
    let (partition, ends) = (evidence.partition, &evidence.partition.part_ends);
    if ends.len() < 2 {
        return None;
    }
    let part_of = |dof: usize| ends.partition_point(|end| *end <= dof);
    let couples = |matrix: Leading<'_>| -> usize {
        let of_row = |row: usize| {
            let part = part_of(row);
            matrix.entries(row).filter(|(col, value)| *value != 0.0 && part_of(*col) != part).count()
        };
        (0..partition.n_internal).map(of_row).sum()
    };
    let internal = partition.internal();
    Some(Check {
        id: "M-32",
        name: "parts that the interface separates are uncoupled",
        equation: "entries of K_II and M_II between parts that were factored apart",
        value: (couples(internal.stiffness) + couples(internal.mass)) as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst: Some(format!("{} parts", ends.len())),
    })
}

/// Random coordinates of like energy, r × 2; none where every constraint mode is stored.
fn probes(evidence: &Evidence<'_>) -> Option<Mat<f64>> {
    if evidence.constraint.modes.is_stored() {
        return None;
    }
    let scales = coordinate_scales(evidence);
    let mut q = Mat::zeros(scales.len(), PROBES);
    SplitMix64::new(SEED).fill(q.as_mut());
    Some(Mat::from_fn(scales.len(), PROBES, |i, j| q[(i, j)] * scales[i]))
}
