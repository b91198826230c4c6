//! Groups of modes whose intervals overlap, and what their neighbours leave of the intervals.

use std::ops::Range;

use super::pair::Pair;
use crate::eigen::CLUSTER_GAP;

/// Modes that cannot be told apart, and the interval that holds as many eigenvalues.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Group {
    /// Numbers of its pairs.
    pub(super) members: Range<usize>,
    /// Of λ.
    pub(super) interval: [f64; 2],
    /// ‖TX − XΘ‖ / σ_min(X) of the group relative to its largest θ: ρ of a single mode.
    radius: f64,
    /// The smallest and the largest μ̃ of its pairs.
    mu: [f64; 2],
}

/// Eigenvalues on either side, as μ: none below, or none above known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Neighbours {
    below: Option<f64>,
    above: f64,
}

/// What covers the rounding of these few operations.
const OUTWARD: f64 = 1.0 + 1e-14;

/// Groups the pairs, which ascend but for rounding, until no two intervals overlap.
pub(super) fn groups(pairs: &[Pair]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for index in 0..pairs.len() {
        let mut group = Group::of(pairs, index..index + 1);
        // Taking in a neighbour may widen the interval onto the next one.
        while let Some(last) = groups.last().filter(|last| last.interval[1] >= group.interval[0]) {
            group = Group::of(pairs, last.members.start..group.members.end);
            groups.pop();
        }
        groups.push(group);
    }
    groups
}

/// Groups with those nearer than modes of one cluster put together: within a cluster no mode has a direction of its own, and the
/// angle is that to the space of all.
pub(super) fn clusters(pairs: &[Pair], groups: &[Group]) -> Vec<Group> {
    let mut clusters: Vec<Group> = Vec::new();
    for group in groups {
        let near = |last: &Group| {
            let gap = group.interval[0] - last.interval[1];
            gap <= CLUSTER_GAP * group.interval[1].abs()
        };
        match clusters.last_mut().filter(|last| near(last)) {
            Some(last) => *last = Group::of(pairs, last.members.start..group.members.end),
            None => clusters.push(group.clone()),
        }
    }
    clusters
}

impl Group {
    fn of(pairs: &[Pair], members: Range<usize>) -> Self {
        let group = &pairs[members.clone()];
        let mu = group.iter().fold([f64::INFINITY, 0.0f64], |[low, high], pair| [low.min(pair.mu), high.max(pair.mu)]);
        // The Frobenius norm bounds the norm; θ = 1/μ̃ ≤ 1/μ_low.
        let square: f64 = group.iter().map(|pair| (pair.residual * mu[0] / pair.mu).powi(2)).sum();
        let radius = OUTWARD * square.sqrt() / least_singular(group);
        let bounds = group.iter().map(|pair| {
            // |θ_j − θ| ≤ radius/μ_low, relative to θ_j.
            let relative = radius * pair.mu / mu[0];
            reach(pair, relative, relative)
        });
        let interval = bounds.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [a, b]| [low.min(a), high.max(b)]);
        Self { members, interval, radius, mu }
    }

    /// The interval of a member: that of the group, or where it is alone what its neighbours leave.
    pub(super) fn interval_of(&self, pairs: &[Pair], member: usize, neighbours: Option<Neighbours>) -> [f64; 2] {
        let (Some(neighbours), 1) = (neighbours, self.members.len()) else {
            return self.interval;
        };
        let pair = &pairs[member];
        let [below, above] = self.inverse_gaps(neighbours);
        let square = OUTWARD * pair.residual * pair.residual;
        let [low, high] = reach(pair, square * above, square * below);
        // What the square gives up to rounding of λ̃ may be wider than the interval itself.
        [low.max(self.interval[0]), high.min(self.interval[1])]
    }

    /// θ over the distance in θ to the neighbour below and above.
    fn inverse_gaps(&self, neighbours: Neighbours) -> [f64; 2] {
        let [low, high] = self.mu;
        let below = neighbours.below.map_or(0.0, |mu| mu / (low - mu));
        let above = neighbours.above / (neighbours.above - high);
        [below, above].map(|ratio| if ratio >= 0.0 { OUTWARD * ratio } else { f64::INFINITY })
    }

    /// sin of the angle between a member and the eigenvectors of the group: the residual over the distance to all others.
    pub(super) fn angle(&self, neighbours: Neighbours) -> f64 {
        let [below, above] = self.inverse_gaps(neighbours);
        // The residual is measured at the low end of the group, the gap above it at the high one.
        self.radius * below.max(above * self.mu[1] / self.mu[0])
    }
}

/// [λ̃ − μ̃ t_low/(1 + t_low), λ̃ + μ̃ t_high/(1 − t_high)] for 1/μ within (1 + t_low)/μ̃ and (1 − t_high)/μ̃.
fn reach(pair: &Pair, t_low: f64, t_high: f64) -> [f64; 2] {
    let high = if t_high < 1.0 { pair.mu * t_high / (1.0 - t_high) } else { f64::INFINITY };
    let low = pair.mu * t_low / (1.0 + t_low);
    // NaN never counts as a bound.
    let low = if low.is_nan() { f64::INFINITY } else { low };
    let high = if high.is_nan() { f64::INFINITY } else { high };
    [pair.lambda - OUTWARD * low - pair.rounding, pair.lambda + OUTWARD * high + pair.rounding]
}

/// A lower bound of σ_min of the normalised modes of a group, by Gershgorin's circles of their Gram matrix.
fn least_singular(group: &[Pair]) -> f64 {
    let off_diagonal = |i: usize| {
        let others = group.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, other)| group[i].cosine(other)).sum::<f64>()
    };
    let largest = (0..group.len()).map(off_diagonal).fold(0.0, f64::max);
    (1.0 - 1e-12 - largest).max(0.0).sqrt()
}

/// What is known of the eigenvalues on both sides of a group, where all below `ceiling` are in groups.
pub(super) fn neighbours(groups: &[Group], index: usize, ceiling: f64, sigma: f64) -> Neighbours {
    let below = index.checked_sub(1).map(|before| OUTWARD * (groups[before].interval[1] - sigma));
    let above = groups.get(index + 1).map_or(ceiling, |after| after.interval[0].min(ceiling)) - sigma;
    Neighbours { below, above: above / OUTWARD }
}
