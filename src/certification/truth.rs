//! The modes that there are, and which of them the pairs of a result are.

use std::ops::Range;

use faer::Mat;

use super::band::{CLUSTER, Completed};
use super::claims::Claims;
use super::independence::Standing;
use super::measured::Measured;
use super::pair::PairKind;

/// Share of its modal mass that a shape has of a mode at least, to be that mode.
const MOSTLY: f64 = 0.5;
/// Least share for a shape that is independent of the others and whose residual is small: such a shape may combine two near modes.
const PARTLY: f64 = 0.25;

/// What a pair was found to be.
pub(super) struct Found {
    pub(super) kind: PairKind,
    /// The cluster of modes that it belongs to.
    pub(super) cluster: Option<usize>,
    pub(super) repeats: Option<usize>,
}

impl Found {
    fn invented() -> Self {
        Self { kind: PairKind::Invented, cluster: None, repeats: None }
    }
}

/// The modes that there are.
pub(super) struct Truth<'a> {
    pub(super) lambda: &'a [f64],
    pub(super) clusters: Vec<Range<usize>>,
    pub(super) completed: &'a Completed,
    pub(super) sigma: f64,
}

/// Runs of eigenvalues of one cluster.
pub(super) fn clusters(lambda: &[f64]) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    for end in 1..=lambda.len() {
        if end == lambda.len() || lambda[end] - lambda[end - 1] > CLUSTER * lambda[end] {
            runs.push(start..end);
            start = end;
        }
    }
    runs
}

impl Truth<'_> {
    /// What all pairs are, and the pairs that each cluster has. Good shapes take their places first.
    pub(super) fn found_of_all(
        &self,
        (claims, measured): (&Claims, &Measured),
        standing: &[Standing],
        shares: &Mat<f64>,
    ) -> (Vec<Found>, Vec<Vec<usize>>) {
        let mut taken: Vec<Vec<usize>> = vec![Vec::new(); self.clusters.len()];
        let mut kinds: Vec<Found> = (0..claims.count()).map(|_| Found::invented()).collect();
        let kept_first = [true, false].into_iter().flat_map(|is_kept| {
            (0..claims.count()).filter(move |claim| (standing[*claim] == Standing::Kept) == is_kept)
        });
        for claim in kept_first {
            let own = measured.lambda[claim];
            // A pair is above what is known where neither its shape nor what is stated of it lies below.
            let told = claims.lambda.as_ref().map_or(own, |stated| stated[claim].min(own));
            // A band that nobody asked for ends where the result does: all that it has is judged, but for motions without mass, which are
            // modes of infinite frequency.
            let may_be_above = self.completed.is_asked || !claims.has_mass[claim];
            let above = Some(told).filter(|_| may_be_above);
            kinds[claim] = self.found(claim, standing[claim], (shares, above), (measured, &mut taken));
        }
        (kinds, taken)
    }

    fn found(
        &self,
        claim: usize,
        standing: Standing,
        (shares, above): (&Mat<f64>, Option<f64>),
        (measured, taken): (&Measured, &mut [Vec<usize>]),
    ) -> Found {
        let share_of =
            |cluster: usize| -> f64 { self.clusters[cluster].clone().map(|mode| shares[(mode, claim)].powi(2)).sum() };
        let most_of = |clusters: &mut dyn Iterator<Item = usize>, least: f64| {
            clusters.max_by(|a, b| share_of(*a).total_cmp(&share_of(*b))).filter(|best| share_of(*best) >= least)
        };
        let has_room = |cluster: &usize| taken[*cluster].len() < self.clusters[*cluster].len();
        let best = most_of(&mut (0..self.clusters.len()), MOSTLY);
        // Two combinations of two modes are both, whichever is mostly which.
        let best = match standing {
            Standing::Kept => most_of(&mut (0..self.clusters.len()).filter(has_room), PARTLY).or(best),
            _ => best,
        };
        match (standing, best) {
            (Standing::Rigid, _) => Found { kind: PairKind::RigidBody, cluster: None, repeats: None },
            (Standing::DependsOn(other), _) => Found { kind: PairKind::Repeated, cluster: None, repeats: Some(other) },
            (Standing::Kept | Standing::None, Some(cluster)) if has_room(&cluster) => {
                taken[cluster].push(claim);
                let kind = if standing == Standing::Kept { PairKind::Mode } else { PairKind::Inexact };
                Found { kind, cluster: Some(cluster), repeats: None }
            }
            // A poor copy of a mode that the result has.
            (Standing::Kept | Standing::None, Some(cluster)) => {
                Found { kind: PairKind::Repeated, cluster: None, repeats: taken[cluster].first().copied() }
            }
            // Its neighbours are not known, and it is a mode all the same.
            (Standing::Kept, None) if !self.are_counted_around(measured.lambda[claim]) => {
                Found { kind: PairKind::Mode, cluster: None, repeats: None }
            }
            // Of several modes, whose combination it is.
            (Standing::Kept | Standing::None, None) => {
                // What is told to lie above the modes that are known may be any.
                let is_above = above.is_some_and(|told| told > self.completed.known_to * (1.0 + CLUSTER));
                let kind = if is_above { PairKind::OutsideBand } else { PairKind::Invented };
                Found { kind, cluster: None, repeats: None }
            }
        }
    }

    /// Whether all modes near an eigenvalue are known.
    fn are_counted_around(&self, lambda: f64) -> bool {
        self.completed.counted.is_some_and(|[from, to]| from < lambda && lambda < to)
    }

    /// γ: how far ρ is from all eigenvalues but those of a cluster, or from where others may be, relative to their distance from σ; nothing
    /// where the modes of the band were not counted.
    pub(super) fn gap(&self, cluster: usize, rho: f64) -> f64 {
        let Range { start, end } = self.clusters[cluster];
        let Some([from, to]) = self.completed.counted else { return 0.0 };
        let below = start.checked_sub(1).map_or(from, |below| self.lambda[below]);
        let above = self.lambda.get(end).copied().unwrap_or(to);
        // Beyond its neighbours a quotient is not that of the cluster.
        if !(below < rho && rho < above) {
            return 0.0;
        }
        let distance = |other: f64| ((rho - self.sigma) / (other - self.sigma) - 1.0).abs();
        let of_below = if below.is_finite() { distance(below) } else { 1.0 };
        of_below.min(distance(above)).min(1.0)
    }

    /// How far ρ may be from an eigenvalue by its residual, relative to it: δ/(1 − δ), or δ²/(γ − δ²) where its mode is known. A combination of
    /// the modes of a cluster has a quotient between theirs: it is as far from one as that lies from it, and what the mode itself is known to.
    pub(super) fn residual_bar(&self, claim: usize, cluster: Option<usize>, measured: &Measured) -> f64 {
        let (lambda, lacking) = (measured.lambda[claim], measured.lacking[claim]);
        // Of λ − σ and not of λ.
        let of_distance = |share: f64| share * ((lambda - self.sigma) / lambda).abs();
        let of_any = if lacking < 1.0 { lacking / (1.0 - lacking) } else { f64::INFINITY };
        let several = cluster.map(|cluster| self.clusters[cluster].clone()).filter(|cluster| cluster.len() > 1);
        if let Some(modes) = several {
            let mode = nearest(self.lambda, modes, lambda);
            let of_mode = self.completed.modes.errors[mode].residual_bar;
            return of_distance(of_any).min(((lambda - self.lambda[mode]) / lambda).abs() + of_mode);
        }
        let of_residual = match cluster {
            // With s the quotient, s_n its mode and β the neighbour on the other side, both less σ, Σ a_k² (s_k − s_n)(s_k − β)/s_k ≥ 0 over
            // all modes, none of which lies between (Temple): |s − s_n| ≤ s δ²/γ with β above, and s δ²/(γ − δ²) with β below.
            Some(cluster) if lacking < self.gap(cluster, lambda) => {
                let square = lacking * lacking;
                of_any.min(square / (self.gap(cluster, lambda) - square))
            }
            _ => of_any,
        };
        of_distance(of_residual)
    }
}

/// The mode of a cluster whose eigenvalue is nearest.
pub(super) fn nearest(lambda: &[f64], cluster: Range<usize>, to: f64) -> usize {
    let distance = |mode: &usize| (lambda[*mode] - to).abs();
    let first = cluster.start;
    cluster.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(first)
}
