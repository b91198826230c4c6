//! Sturm counts of the full model under every boundary of the scene, from one factorisation: M-06.
//!
//! ```text
//! S(σ) = (K − σM)_BB − (K − σM)_BI (K − σM)_II⁻¹ (K − σM)_IB      n_B × n_B
//! eigenvalues below σ with the dofs f of the interface free, a load D and springs C on them:
//!        negative eigenvalues of (K − σM)_II  +  negative eigenvalues of S(σ)_ff + C_ff − σ D_ff      (Haynsworth 1968)
//! ```
//! A support holds, loads or ties interface dofs alone, so that (K − σM)_II is the same under all of them.

use faer::Mat;

use super::super::check::{Check, Limits};
use super::super::evidence::Evidence;
use super::boundary::Boundary;
use super::outcome::BoundaryCount;
use super::reference::Reference;
use crate::cache::{Kind, Reader, Recorded, Writer, recalled};
use crate::dense;
use crate::error::Result;
use crate::factor::{Analysis, CONDENSED_GAP, InertiaCount, condensed};
use crate::sparse::diagonal;

/// Where between the end of the band and the next eigenvalue is counted.
const PLACES: [f64; 3] = [0.5, 0.25, 0.75];
/// A shift keeps this share of the gap it lies in from the eigenvalues of every boundary.
const SHARE_OF_GAP: f64 = 1e-3;
/// A shift keeps this many times what rounding of the factorisation moves an eigenvalue by; [`crate::modes`] derives it.
const ROUNDINGS: f64 = 100.0;

/// K − σM condensed to the interface.
pub(super) struct Condensed {
    sigma: f64,
    /// Negative eigenvalues of (K − σM)_II.
    clamped: usize,
    /// Growth of its pivots.
    growth: f64,
    /// S(σ).
    schur: Mat<f64>,
    /// |K_ii| + σ M_ii of the interface dofs.
    terms: Vec<f64>,
}

/// A count with S(σ), as an entry of a cache has them.
struct Counted {
    count: InertiaCount,
    schur: Mat<f64>,
}

impl Recorded for Counted {
    const KIND: Kind = Kind::Count;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        self.count.write(to)?;
        to.columns(self.schur.as_ref())
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        Some(Self { count: InertiaCount::read(from)?, schur: from.columns()? })
    }
}

impl Condensed {
    /// Factors K − σM above the band at a shift that is off the eigenvalues of all references; none where there is no such shift,
    /// or where rounding decides a sign.
    ///
    /// # Errors
    /// No memory; pivots that are NaN.
    pub(super) fn new(
        evidence: &Evidence<'_>,
        analysis: &Analysis,
        references: &[Reference],
        limit: f64,
    ) -> Result<Option<Self>> {
        let Some(sigma) = shift(references, limit) else { return Ok(None) };
        let partition = evidence.partition;
        let key = || partition.key_of_matrices("condensed").numbers(&[sigma]);
        let made = || condensed(analysis, partition.pencil(), sigma).map(|(count, schur)| Counted { count, schur });
        let Counted { count, schur } = recalled(partition.cache(), key, made)?;
        if !count.is_off_clamped() {
            return Ok(None);
        }
        let interface = diagonal(&partition.stiffness).into_iter().zip(diagonal(&partition.mass));
        let terms = interface.skip(partition.n_internal).map(|(k, m)| k.abs() + sigma * m.abs()).collect();
        Ok(Some(Self { sigma, clamped: count.clamped, growth: count.growth, schur, terms }))
    }

    /// The count of a reference against what was found; none where rounding may have decided a sign.
    ///
    /// # Errors
    /// A dense eigenproblem that does not converge.
    pub(super) fn count(&self, evidence: &Evidence<'_>, reference: &Reference) -> Result<Option<BoundaryCount>> {
        let Some(n_negative) = self.n_negative(&reference.boundary)? else { return Ok(None) };
        if ROUNDINGS * self.growth * reference.rounding_floor() > distance(reference, self.sigma) {
            return Ok(None);
        }
        Ok(Some(BoundaryCount {
            below_hz: evidence.partition.scaling.hertz(self.sigma),
            n_counted: self.clamped + n_negative,
            n_found: reference.n_zero() + reference.lambda.partition_point(|lambda| *lambda < self.sigma),
        }))
    }

    /// Negative eigenvalues of S(σ)_ff + C_ff − σ D_ff.
    fn n_negative(&self, boundary: &Boundary) -> Result<Option<usize>> {
        let free: Vec<usize> = (0..boundary.held.len()).filter(|dof| !boundary.held[*dof]).collect();
        let loads: Vec<f64> = free.iter().map(|dof| self.sigma * boundary.load[*dof]).collect();
        let springs: Vec<f64> = free.iter().map(|dof| boundary.springs[*dof]).collect();
        let terms = |i: usize| self.terms[free[i]] + loads[i] + springs[i];
        let scale: Vec<f64> = (0..free.len()).map(|i| dense::power_of_two_root(terms(i))).collect();
        let scaled = Mat::from_fn(free.len(), free.len(), |i, j| {
            let added = if i == j { springs[i] - loads[i] } else { 0.0 };
            (self.schur[(free[i], free[j])] + added) * scale[i] * scale[j]
        });
        let (eigenvalues, _) = dense::symmetric_eigen(scaled.as_ref())?;
        let is_off = eigenvalues.iter().all(|value| value.abs() > CONDENSED_GAP);
        Ok(is_off.then(|| eigenvalues.iter().filter(|value| **value < 0.0).count()))
    }
}

/// A shift above the band and below the next eigenvalue of every reference; where that leaves no room, one above all
/// eigenvalues that were found.
fn shift(references: &[Reference], limit: f64) -> Option<f64> {
    let found = references.iter().filter_map(|reference| reference.lambda.last().copied()).fold(0.0, f64::max);
    let next = references.iter().filter_map(|reference| reference.next).fold(f64::INFINITY, f64::min);
    let end = if next.is_finite() { next } else { 2.0 * limit };
    let between = |from: f64| PLACES.map(|place| from + place * (end - from));
    let candidates = between(limit.max(found)).into_iter().chain(between(found));
    candidates
        .into_iter()
        .find(|sigma| *sigma > found && *sigma < end && references.iter().all(|reference| is_clear(reference, *sigma)))
}

/// Whether a shift lies off the eigenvalues of a reference by a share of the gap it is in.
fn is_clear(reference: &Reference, sigma: f64) -> bool {
    let below = reference.lambda.last().copied().unwrap_or(0.0);
    let gap = reference.next.unwrap_or(2.0 * sigma) - below;
    distance(reference, sigma) > SHARE_OF_GAP * gap
}

/// How far the next eigenvalue of a reference is from a shift.
fn distance(reference: &Reference, sigma: f64) -> f64 {
    let below = reference.lambda.last().copied().unwrap_or(0.0);
    (sigma - below).min(reference.next.map_or(f64::INFINITY, |next| next - sigma))
}

/// M-06 under the boundaries of the scene, where any of them was counted.
pub(super) fn check(references: &[Reference]) -> Option<Check> {
    let counts: Vec<(&str, BoundaryCount)> = references
        .iter()
        .filter_map(|reference| reference.count.map(|count| (reference.boundary.name.as_str(), count)))
        .collect();
    judged(&counts)
}

fn judged(counts: &[(&str, BoundaryCount)]) -> Option<Check> {
    let difference = |count: &BoundaryCount| count.n_counted.abs_diff(count.n_found);
    let (name, worst) = counts.iter().rev().max_by_key(|(_, count)| difference(count))?;
    Some(Check {
        id: "M-06",
        name: "no mode of the full model is missing under the boundaries compared",
        equation: "max |eigenvalues counted below a shift − modes found| over boundaries, by the inertia of K − σM",
        value: difference(worst) as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst: Some(format!("{name}, counted {}, found {}", worst.n_counted, worst.n_found)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verification::check::Verdict;

    #[test]
    fn a_count_that_is_not_met_fails_and_names_the_boundary() {
        let count = |n_found| BoundaryCount { below_hz: 10.0, n_counted: 9, n_found };
        assert!(judged(&[]).is_none());
        let met = judged(&[("free", count(9)), ("fix:base", count(9))]).expect("counts");
        assert_eq!(met.verdict(), Verdict::Pass);
        let missing = judged(&[("free", count(9)), ("fix:base", count(8))]).expect("counts");
        assert_eq!((missing.verdict(), missing.value), (Verdict::Fail, 1.0));
        assert!(missing.worst.expect("a place").contains("fix:base"));
    }
}
