//! A factor of K − σM with a shift found from the model itself.
//!
//! It serves where K_II cannot: without an interface, without coordinates, or where the interface holds the component
//! badly. σ lies below the spectrum at the distance of the first elastic eigenvalue, far enough from zero for K − σM to
//! be well conditioned and near enough to separate eigenvalues.

use super::median_ratio;
use super::operator::Factored;
use super::problem::Wanted;
use super::{ModalProblem, ModeError, ModeRequest, Modes, elastic_modes, zero};
use crate::dense;
use crate::error::{Error, Result};
use crate::factor::{Analysis, Cholesky, boundary_of, few_digits, whole_count};
use crate::job::Eigensolver;
use crate::random::SEED;

/// A factor of K − σM and the lowest modes found on the way.
#[derive(Debug)]
pub struct Shifted<'a> {
    /// L Lᵀ = K − σM.
    pub factor: Cholesky<'a>,
    /// σ < 0.
    pub sigma: f64,
    /// The lowest modes, zero modes first: λ ascends among these and among the others.
    pub lowest: Modes,
    /// How many of them are zero within the noise of the data.
    pub n_zero: usize,
    /// Numeric factorisations it took.
    pub n_factorisations: usize,
}

/// The first shift relative to the median of K_ii / M_ii. The largest ratio would do where all dofs are alike, but a few
/// rotations of tiny inertia raise it by many orders of magnitude, and then eigenvalues can no longer be told apart.
const FIRST_SHIFT: f64 = 1e-6;
/// The first shift in units of the precision of the data, whose rounding may leave eigenvalues below zero.
const ROUNDINGS_OF_DATA: f64 = 10.0;
/// Shifts tried before one is taken as it is.
const MAX_ROUNDS: usize = 4;
/// How much farther from zero a shift is tried where K − σM is not definite, and how often; not beyond the median of K_ii / M_ii.
const RETREAT: f64 = 10.0;
const MAX_RETREATS: usize = 6;
/// −σ may lie between these multiples of the first elastic eigenvalue.
const WINDOW: std::ops::RangeInclusive<f64> = 1e-2..=10.0;
/// Modes looked at first; doubled while all of them are zero modes.
const LOOK_AT: usize = 12;

/// Factors K − σM of a modal problem with a shift suited to it. As many eigenvalues as there are motions known to be free may be below zero by
/// the roundings of few digits.
///
/// # Errors
/// K − σM is not definite, or its digits do not tell; an eigenvalue is negative beyond the noise of the data; the eigensolver
/// fails.
pub fn shifted<'a>(
    analysis: &'a Analysis,
    problem: ModalProblem<'_>,
    name: &dyn Fn(usize) -> String,
) -> Result<Shifted<'a>> {
    let mut sigma = first_shift(problem);
    let farthest = median_ratio(problem);
    let mut count = LOOK_AT;
    let rounding = problem.precision.stiffness;
    // Of motions that are known to be free the digits need not tell that they are, and rounding of a heavy mass may exceed a shift by the
    // diagonals of what carries it.
    let are_known = problem.n_free > 0 || problem.n_deflated() > 0;
    let is_retreat = |error: &Error| match error {
        Error::NotDefinite { .. } => !rounding.is_coarse() || rounding.is_beyond_entries() || are_known,
        // What is below zero is looked at once there is a factor.
        Error::IndefiniteStiffness { .. } => rounding.is_coarse() && are_known,
        _ => false,
    };
    let (mut round, mut n_retreats, mut n_wider) = (1, 0, 0);
    let mut too_near = 0.0f64;
    loop {
        let factor = match Cholesky::new(analysis, problem.pencil(), sigma, name) {
            // Rounding of ties or masses far above all else may be larger than a shift that suits the softest modes.
            Err(error) if is_retreat(&error) && n_retreats < MAX_RETREATS && -sigma < farthest => {
                too_near = too_near.max(-sigma);
                (sigma, n_retreats) = (RETREAT * sigma, n_retreats + 1);
                continue;
            }
            found => {
                found.map_err(|error| few_digits(error, analysis, problem.stiffness, problem.precision.stiffness))?
            }
        };
        let request = ModeRequest { wanted: Wanted::Count(count), eigensolver: Eigensolver::Lanczos, seed: SEED };
        let (lowest, n_zero) = zero_first(elastic_modes(problem, &Factored::new(&factor, sigma), request)?);
        let all_zero = n_zero == lowest.count() && lowest.next.is_some();
        let first_elastic = lowest.lambda.get(n_zero).copied().or_else(|| elastic_beyond(&lowest));
        if all_zero && count < problem.mass.rows() {
            (count, n_wider) = (2 * count, n_wider + 1);
            // Where it is another zero mode that follows, it is no measure of a shift.
            sigma = first_elastic.map_or(sigma, |lambda| -lambda.max(least_shift(&lowest, n_zero)));
            continue;
        }
        let suited = first_elastic.map(|lambda| lambda.max(least_shift(&lowest, n_zero)));
        // Nearer than where K − σM was not definite there is nothing.
        let settled = suited.is_none_or(|suited| WINDOW.contains(&(-sigma / suited)) || suited <= too_near);
        if settled || round == MAX_ROUNDS {
            // Those that are known to be free have been judged, by their own energies.
            if n_zero > problem.n_free {
                refuse_negative(analysis, problem, (&lowest, first_elastic))?;
            }
            return Ok(Shifted { factor, sigma, lowest, n_zero, n_factorisations: round + n_retreats + n_wider });
        }
        sigma = suited.map_or(sigma, |suited| -suited);
        round += 1;
    }
}

/// A shift below the spectrum before anything is known of it but the diagonals.
pub(crate) fn first_shift(problem: ModalProblem<'_>) -> f64 {
    let rounding = problem.precision.stiffness;
    -FIRST_SHIFT.max(ROUNDINGS_OF_DATA * rounding.relative) * median_ratio(problem)
}

/// The modes with those first that are zero, by themselves or as rounding of modes they mix with, and how many these are. Negative ones are
/// no elastic ones; [`refuse_negative`] judges them. Next to a heavy mass, springs that hold it are slower than what rounding leaves of a
/// rotation about it, so that an elastic mode may lie below a zero one.
fn zero_first(lowest: Modes) -> (Modes, usize) {
    let floors: Vec<f64> = lowest.errors.iter().map(|error| error.rounding_floor).collect();
    let floors = zero::of_alike(&lowest.lambda, &floors);
    let levels: Vec<f64> = lowest.errors.iter().map(|error| error.zero_level).collect();
    let terms: Vec<f64> = lowest.lambda.iter().zip(&lowest.errors).map(terms_of).collect();
    let levels = zero::raised(&lowest.lambda, &levels, &terms);
    let is_zero = |j: usize| {
        let lambda = lowest.lambda[j];
        lambda <= 0.0 || zero::is_zero(lambda, levels[j]) || zero::is_zero(lambda, zero::level(0.0, 0.0, floors[j]))
    };
    let (zero, others): (Vec<usize>, Vec<usize>) = (0..lowest.count()).partition(|j| is_zero(*j));
    let n_zero = zero.len();
    let order: Vec<usize> = zero.into_iter().chain(others).collect();
    let sorted = Modes {
        lambda: order.iter().map(|j| lowest.lambda[*j]).collect(),
        errors: order.iter().map(|j| lowest.errors[*j]).collect(),
        shapes: dense::columns(lowest.shapes.as_ref(), &order),
        ..lowest
    };
    (sorted, n_zero)
}

/// |x|ᵀ|K||x| of a mode of unit modal mass, from its cancellation: next to those of a rigid-body motion the terms of its inertia are nothing.
fn terms_of((lambda, error): (&f64, &ModeError)) -> f64 {
    error.cancellation * lambda.abs()
}

/// The least −σ with which rounding of the zero modes leaves K − σM definite.
fn least_shift(lowest: &Modes, n_zero: usize) -> f64 {
    ROUNDINGS_OF_DATA * lowest.errors[..n_zero].iter().map(|error| error.zero_level).fold(0.0, f64::max)
}

/// The eigenvalue after modes that are all zero, where it is elastic and not one more zero.
fn elastic_beyond(lowest: &Modes) -> Option<f64> {
    let level = lowest.errors.iter().map(|error| error.zero_level).fold(0.0, f64::max);
    lowest.next.filter(|next| *next > 0.0 && !zero::is_zero(*next, level))
}

/// An eigenvalue below zero by more than noise belongs to an indefinite K, not to a rigid-body motion: where a count half way to it
/// says so.
fn refuse_negative(
    analysis: &Analysis,
    problem: ModalProblem<'_>,
    (modes, first_elastic): (&Modes, Option<f64>),
) -> Result<()> {
    let is_noise = |lambda: f64, error: &ModeError| {
        lambda >= 0.0
            || zero::is_zero(lambda, error.zero_level)
            || zero::is_negligible(lambda, first_elastic)
            || zero::is_left_by_the_producer(lambda, terms_of((&lambda, error)))
    };
    let mut pairs = modes.lambda.iter().zip(&modes.errors);
    let Some((energy, _)) = pairs.find(|(lambda, error)| !is_noise(**lambda, error)) else { return Ok(()) };
    match whole_count(analysis, problem.pencil(), 0.5 * energy)?.below {
        0 => Ok(()),
        count => {
            // Which motion it belongs to nobody has asked: that of a strut which buckles is no rigid-body motion.
            let error = Error::IndefiniteStiffness { count, boundary: boundary_of(analysis, problem.stiffness) };
            Err(few_digits(error, analysis, problem.stiffness, problem.precision.stiffness))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::Pencil;
    use crate::sparse::SparseMatrix;
    use crate::sparse::{Precision, Rounding};

    const BINARY: Precision = Precision { stiffness: Rounding::BINARY, mass: Rounding::BINARY };

    fn diagonal_matrix(values: &[f64]) -> SparseMatrix {
        let n = values.len();
        SparseMatrix::new((n, n), (0..=n).collect(), (0..n as u32).collect(), values.to_vec())
    }

    /// Springs of stiffness one between neighbours, both ends free.
    fn free_chain(n: usize) -> SparseMatrix {
        let (mut pointers, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for row in 0..n {
            for col in row.saturating_sub(1)..(row + 2).min(n) {
                let n_springs = if row == 0 || row == n - 1 { 1.0 } else { 2.0 };
                columns.push(col as u32);
                values.push(if row == col { n_springs } else { -1.0 });
            }
            pointers.push(columns.len());
        }
        SparseMatrix::new((n, n), pointers, columns, values)
    }

    fn with_lowest<T>(stiffness: &SparseMatrix, mass: &SparseMatrix, look: impl Fn(Result<Shifted<'_>>) -> T) -> T {
        let pencil = Pencil::new(stiffness, mass);
        let analysis = Analysis::new(pencil).expect("an analysis");
        look(shifted(&analysis, ModalProblem::of(pencil, BINARY), &|dof| dof.to_string()))
    }

    #[test]
    fn tiny_inertia_of_few_dofs_does_not_move_the_shift_away() {
        let n = 40;
        let mut masses = vec![1.0; n];
        masses[n - 1] = 1e-18;
        with_lowest(&free_chain(n), &diagonal_matrix(&masses), |found| {
            let found = found.expect("a shift");
            assert_eq!(found.n_zero, 1);
            // The last mass is as good as none and follows its neighbour: a free chain of n − 1 equal masses,
            // λ = 4 sin²(π / 2(n − 1)). The cancelling terms are some λ_max/λ = 600 times larger than the energy, which makes
            // rounding of 10⁻¹³.
            let expected = 4.0 * (std::f64::consts::PI / (2.0 * (n - 1) as f64)).sin().powi(2);
            assert!((found.lowest.lambda[1] / expected - 1.0).abs() < 1e-12, "{:?}", found.lowest.lambda);
        });
    }

    #[test]
    fn a_negative_eigenvalue_beyond_noise_is_no_zero_mode() {
        let mut stiffnesses: Vec<f64> = (0..30).map(f64::from).collect();
        // Above the first shift, so that K − σM is definite, and a billion times the rounding of its own terms.
        stiffnesses[0] = -1e-6;
        let mass = diagonal_matrix(&[1.0; 30]);
        with_lowest(&diagonal_matrix(&stiffnesses), &mass, |found| {
            assert!(matches!(found, Err(Error::IndefiniteStiffness { count: 1, .. })), "{found:?}");
        });
    }

    /// What practice takes for a rigid-body mode is one on either side of zero.
    #[test]
    fn a_negative_eigenvalue_far_below_the_first_elastic_one_is_a_zero_mode() {
        let mut stiffnesses: Vec<f64> = (0..30).map(f64::from).collect();
        stiffnesses[0] = -1e-9;
        let mass = diagonal_matrix(&[1.0; 30]);
        with_lowest(&diagonal_matrix(&stiffnesses), &mass, |found| assert_eq!(found.expect("a shift").n_zero, 1));
    }

    /// Two masses on a spring of 10⁸ that is off by some roundings, 2⁻²⁶ each, and a heavy one on a soft spring of its own.
    #[test]
    fn an_elastic_mode_may_lie_below_a_zero_one() {
        let stiff = 1e8;
        let rounding = 2f64.powi(-26);
        let values = vec![stiff + 30.0 * rounding, -stiff, -stiff, stiff, 1.0];
        let stiffness = SparseMatrix::new((3, 3), vec![0, 2, 4, 5], vec![0, 1, 0, 1, 2], values);
        with_lowest(&stiffness, &diagonal_matrix(&[1.0, 1.0, 1e9]), |found| {
            let found = found.expect("a shift");
            assert_eq!(found.n_zero, 1);
            // Half of what the one entry is off by, but for rounding of the terms of the energy.
            assert!((found.lowest.lambda[0] / (15.0 * rounding) - 1.0).abs() < 0.2, "{:?}", found.lowest.lambda);
            assert!((found.lowest.lambda[1] / 1e-9 - 1.0).abs() < 1e-12, "{:?}", found.lowest.lambda);
        });
    }
}
