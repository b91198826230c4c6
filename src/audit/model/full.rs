//! The full model by a factor of K − σM on all its dofs: which motions are free, and the first elastic eigenvalue.

use faer::{Mat, MatRef};

use crate::dense;
use crate::eigen::{ModalProblem, Shifted, shifted, zero};
use crate::error::Result;
use crate::factor::{Analysis, Cholesky};
use crate::partition::Partition;
use crate::rigid::{self, RigidBodyModes, RigidEnergy, RigidSource};
use crate::sparse::{SparseMatrix, diagonal, product};

/// The full model with a factor of K − σM on all dofs.
pub(super) struct Full<'a> {
    pub(super) partition: &'a Partition,
    /// L Lᵀ = K − σM.
    pub(super) factor: Cholesky<'a>,
    /// σ < 0.
    pub(super) sigma: f64,
    /// Zero modes found by inverse iteration.
    pub(super) zero: RigidBodyModes,
    /// Shapes of the first elastic modes, n × k of unit modal mass; those that were found with the zero modes.
    pub(super) elastic: Mat<f64>,
    /// The first elastic eigenvalue.
    pub(super) first: f64,
    /// What roundings of K leave of an energy, relative to that: how far they turn motions towards each other.
    pub(super) noise: f64,
    /// Whether K has more zero modes than the coordinates tell: those of mechanisms, which the reduction knows by its interface.
    pub(super) has_mechanisms: bool,
}

impl<'a> Full<'a> {
    /// Factors K − σM and finds the zero modes.
    ///
    /// # Errors
    /// K − σM is not definite; the eigensolver fails.
    pub(super) fn new(partition: &'a Partition, analysis: &'a Analysis, given: &RigidBodyModes) -> Result<Self> {
        let pinned = pinned(&partition.stiffness, given.massless());
        let problem = ModalProblem { stiffness: (&pinned).into(), ..partition.free_problem() };
        let problem = problem.knowing_free(by_coordinates(given));
        let found = shifted(analysis, problem, &|dof| partition.name_of(dof))?;
        let n_zero = confirmed(partition, &found, given);
        let (shapes, elastic) = found.lowest.shapes.as_ref().split_at_col(n_zero);
        let (shapes, elastic) = (shapes.to_owned(), elastic.to_owned());
        let first = found.lowest.lambda[n_zero..].iter().copied().reduce(f64::min).or(found.lowest.next).unwrap_or(1.0);
        let looked_at = &found.lowest.errors[..found.lowest.count().min(n_zero + 1)];
        // What zero modes cost all the same shows roundings that the digits of K do not.
        let costs = found.lowest.lambda[..n_zero].iter().map(|lambda| lambda.abs());
        let noise =
            looked_at.iter().map(|error| error.zero_level).chain(costs).map(|level| level / first).fold(0.0, f64::max);
        let shapes = dense::side_by_side(shapes.as_ref(), given.massless());
        let zero = RigidBodyModes {
            modes: shapes.clone(),
            mass_orthonormal: product(&partition.mass, shapes.as_ref()),
            orthonormal: shapes,
            n_massless: given.n_massless,
            source: RigidSource::Algebraic,
            energy: RigidEnergy { angle: noise, ..RigidEnergy::default() },
            ..RigidBodyModes::none(partition.n_dofs())
        };
        let has_mechanisms = (1..n_zero).contains(&by_coordinates(given));
        Ok(Self { partition, factor: found.factor, sigma: found.sigma, zero, elastic, first, noise, has_mechanisms })
    }
}

/// K with some dofs held by a spring each, as many as there are motions without energy and mass. K − σM has no factor with such motions, and a
/// spring in the way of each changes nothing but them: whatever has no momentum along them leaves the spring at rest.
fn pinned(stiffness: &SparseMatrix, massless: MatRef<'_, f64>) -> SparseMatrix {
    let (mut pinned, mut left) = (stiffness.clone(), massless.to_owned());
    let sizes: Vec<f64> = diagonal(stiffness).iter().map(|size| size.max(0.0).sqrt()).collect();
    for j in 0..left.ncols() {
        let reach = |i: &usize| left[(*i, j)].abs() * sizes[*i];
        let Some(at) = (0..left.nrows()).max_by(|a, b| reach(a).total_cmp(&reach(b))) else { break };
        if let Some(entry) = pinned.get_mut(at, at) {
            *entry *= 2.0;
        }
        // The others are taken without what they move there.
        for other in j + 1..left.ncols() {
            let share = left[(at, other)] / left[(at, j)];
            (0..left.nrows()).for_each(|i| left[(i, other)] -= share * left[(i, j)]);
        }
    }
    pinned
}

/// How many motions with mass are free by coordinates.
fn by_coordinates(given: &RigidBodyModes) -> usize {
    if given.source == RigidSource::Geometric { given.count() - given.n_massless } else { 0 }
}

/// How many modes are zero: by their own levels, or as many as the coordinates say where none of those is above the largest level, which
/// is what the motions of the coordinates are held to. Modes beyond those of the coordinates that only rounding of their neighbours
/// makes zero are elastic: where ties of 10⁹ times the stiffness hide half the digits, the soft ones cannot be told by their neighbours. So are
/// those above an elastic one that is none by its own level: of soft rotations few digits may leave no frequency.
fn confirmed(partition: &Partition, found: &Shifted<'_>, given: &RigidBodyModes) -> usize {
    let n_given = by_coordinates(given);
    if (1..found.n_zero).contains(&n_given) {
        let beyond = n_given..found.n_zero;
        let known = found.lowest.lambda[found.n_zero..].iter().copied().fold(f64::INFINITY, f64::min);
        let is_elastic = |j: usize| {
            let lambda = found.lowest.lambda[j];
            lambda > known || !zero::is_zero(lambda, found.lowest.errors[j].zero_level)
        };
        // Few digits that leave the next mode open count no mechanism: a reduction does not either, and takes K as it is.
        let are_elastic =
            rigid::is_uncounted(rigid::bar_of_digits(partition, found)) || beyond.into_iter().all(is_elastic);
        return if are_elastic { n_given } else { found.n_zero };
    }
    if n_given <= found.n_zero || n_given > found.lowest.count() {
        return found.n_zero;
    }
    let largest = found.lowest.errors[..n_given].iter().map(|error| error.zero_level).fold(0.0, f64::max);
    let are_zero = found.lowest.lambda[..n_given].iter().all(|lambda| zero::is_zero(*lambda, largest));
    if are_zero { n_given } else { found.n_zero }
}
