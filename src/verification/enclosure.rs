//! Intervals that are proved to hold the eigenvalues: M-07, M-08.
//!
//! ```text
//! K_s = K − σM      n × n   σ < 0, proved positive definite
//! x, λ̃              n, 1    a computed mode and its Rayleigh quotient; μ̃ = λ̃ − σ
//! r = Kx − λ̃Mx      n       to twice the working precision
//! ρ = ‖r‖_{K_s⁻¹} / ‖x‖_{K_s}
//! ```
//! T = K_s⁻¹M is self-adjoint in the inner product of K_s with eigenvalues 1/μ, also where M is singular, and
//! ‖Tx − x/μ̃‖_{K_s} = ρ‖x‖_{K_s}/μ̃: some eigenvalue has |μ̃/μ − 1| ≤ ρ. Groups of modes whose intervals overlap hold as
//! many eigenvalues as they have modes (Kahan 1967; Cao, Xie and Li 1996). Where a count proves that there are no others, each
//! group holds exactly the eigenvalues of its modes, the distances to the neighbours are known, and the interval of a single mode shrinks
//! to μ̃ρ²/gap (Kato 1949, Temple 1928). Everything is an upper bound that includes the rounding of its own computation; the rounding
//! that the matrices have taken up since they were read is added to first order.

mod bracket;
mod exact;
mod metric;
mod pair;

use crate::eigen::Modes;
use crate::error::Result;
use crate::factor::{Analysis, whole_count};
use crate::job::{Boundary, Certify};
use crate::modes::{Component, Retained};
use crate::partition::Partition;
use crate::rigid::RigidBodyModes;

use bracket::Group;
use metric::Metric;

/// What was proved of the retained modes, in scaled units.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosures {
    /// For each mode an interval that holds an eigenvalue; none where K − σM could not be proved definite.
    pub intervals: Vec<Option<[f64; 2]>>,
    /// For each mode a bound of the sine of its angle to the eigenvectors of its cluster; none without a proved count.
    pub angles: Vec<Option<f64>>,
    /// How far the count is proved.
    pub count: CountProof,
    /// Factorisations it took.
    pub n_factorisations: usize,
}

/// How far a count of eigenvalues is proved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountProof {
    /// How far the factors may be from the matrix, relative to the distance of the shift to the highest mode: below one
    /// the count is proved.
    pub uncertainty: f64,
    /// Eigenvalues counted below the shift.
    pub counted: usize,
    /// Eigenvalues that the intervals below it hold.
    pub enclosed: usize,
}

impl CountProof {
    /// True where the intervals hold every eigenvalue below the shift, beyond rounding.
    pub fn is_proved(&self) -> bool {
        self.uncertainty < 1.0 && self.counted == self.enclosed
    }
}

/// Encloses the retained modes where the job asks for it.
///
/// # Errors
/// The errors of [`enclosures`].
pub fn enclosures_where_asked(
    component: Component<'_>,
    retained: &Retained,
    certify: Certify,
) -> Result<Option<Enclosures>> {
    let Component { partition, rigid, .. } = component;
    match certify {
        Certify::None | Certify::Count => Ok(None),
        Certify::Full => enclosures(partition, rigid, &retained.modes, retained.boundary).map(Some),
    }
}

/// Encloses modes that were computed under a boundary.
///
/// # Errors
/// No memory for a factor; σ of the count lies on an eigenvalue.
pub fn enclosures(
    partition: &Partition,
    rigid: &RigidBodyModes,
    modes: &Modes,
    boundary: Boundary,
) -> Result<Enclosures> {
    let (pencil, zero_modes) = (partition.pencil_under(boundary), rigid.under(boundary));
    let by_rounding = moved_by_rounding(partition, modes);
    let rows = partition.rows_under(boundary, modes.shapes.as_ref());
    let rows = rows.map(|shapes| Modes { shapes, ..modes.clone() });
    let modes = rows.as_ref().unwrap_or(modes);
    let analysis = Analysis::new(pencil)?;
    let (metric, n_metric) = Metric::new(&analysis, pencil, modes.lambda.first().copied())?;
    let Some(metric) = metric else {
        let count = CountProof { uncertainty: f64::INFINITY, counted: 0, enclosed: 0 };
        let nothing = vec![None; modes.count()];
        let angles = vec![None; modes.count()];
        return Ok(Enclosures { intervals: nothing, angles, count, n_factorisations: n_metric });
    };
    let pairs = pair::pairs(&metric, zero_modes, modes);
    let groups = bracket::groups(&pairs);
    let n_zero = zero_modes.map_or(0, RigidBodyModes::count);
    let (count, ceiling) = proof(&analysis, &metric, &groups, modes.shift_above(0.5))?;
    let mut intervals = vec![None; modes.count()];
    let mut angles = vec![None; modes.count()];
    for (index, group) in groups.iter().enumerate() {
        let neighbours = count.is_proved().then(|| bracket::neighbours(&groups, index, ceiling, metric.sigma));
        for member in group.members.clone().filter(|member| *member >= n_zero) {
            let [low, high] = group.interval_of(&pairs, member, neighbours);
            let moved = by_rounding[member - n_zero];
            intervals[member - n_zero] = Some([low - moved, high + moved]);
        }
    }
    let clusters = bracket::clusters(&pairs, &groups);
    for (index, cluster) in clusters.iter().enumerate().filter(|_| count.is_proved()) {
        let angle = cluster.angle(bracket::neighbours(&clusters, index, ceiling, metric.sigma));
        for member in cluster.members.clone().filter(|member| *member >= n_zero) {
            angles[member - n_zero] = Some(angle);
        }
    }
    Ok(Enclosures { intervals, angles, count, n_factorisations: n_metric + 1 })
}

/// How far each eigenvalue of the matrices as they are worked on may be from that of the numbers in the files: repeated entries and masses were
/// added up, rows were turned, patches and constraints were taken up. Quotients of modes of unit modal mass move by so much in first order, and
/// twice that covers the second.
fn moved_by_rounding(partition: &Partition, modes: &Modes) -> Vec<f64> {
    let (shapes, lambda) = (modes.shapes.as_ref(), modes.lambda.as_slice());
    let of_patches = partition.rounding_of_patches(shapes, lambda);
    let of_entries = partition.rounding_of_made_entries(shapes, lambda);
    of_patches.iter().zip(of_entries).map(|(of_patches, of_entries)| 2.0 * (of_patches + of_entries)).collect()
}

/// The count above the highest mode, how far it is proved, and the eigenvalue up to which there are no others.
///
/// In the metric of K_s the eigenvalues of K − σ'M are ν = (λ − σ')/(λ − σ), and a factorisation that is off by E moves
/// them by at most ω = ‖E‖/floor. Every λ with ν < −ω is counted, and no λ with ν > ω.
fn proof(analysis: &Analysis, metric: &Metric<'_>, groups: &[Group], shift: f64) -> Result<(CountProof, f64)> {
    let count = whole_count(analysis, metric.pencil, shift)?;
    let omega = count.backward_error / metric.floor_in(&count.scale);
    let top = groups.last().map_or(metric.sigma, |group| group.interval[1]);
    let distance = (shift - top) / (top - metric.sigma);
    let enclosed = groups.iter().map(|group| group.members.len()).sum();
    // NaN proves nothing.
    let uncertainty = if omega.is_nan() || omega >= 1.0 || distance <= 0.0 { f64::INFINITY } else { omega / distance };
    let ceiling = (shift + omega * metric.sigma) / (1.0 + omega);
    Ok((CountProof { uncertainty, counted: count.below, enclosed }, ceiling))
}
