//! The elastic modes of a pencil by a shift-invert operator: found, made accurate and judged.

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[cfg(feature = "arpack")]
use super::arpack;
use super::cluster;
use super::lanczos::{lanczos, lanczos_between};
use super::modal_problem::ModalProblem;
use super::modes::Modes;
use super::operator::ShiftInvert;
use super::problem::{EigenWork, Eigenpairs, Interval, Problem, Wanted, are_clustered};
use super::quality::{self, ModeError};
use super::ritz::{RESIDUAL_FLOOR, TOLERANCE};
use crate::dense;
use crate::error::Result;
use crate::sparse::{Precision, product};

/// Which eigensolver finds the modes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Eigensolver {
    /// Block Lanczos with thick restart.
    #[default]
    Lanczos,
    /// ARPACK-NG, an independent witness.
    Arpack,
}

impl Eigensolver {
    /// The solvers of this build.
    pub const BUILT_IN: &'static [Self] =
        if cfg!(feature = "arpack") { &[Self::Lanczos, Self::Arpack] } else { &[Self::Lanczos] };
}

/// Which modes, by which solver.
#[derive(Clone, Copy, Debug)]
pub struct ModeRequest {
    /// Count or band, in scaled units.
    pub wanted: Wanted,
    /// Lanczos or the independent witness.
    pub eigensolver: Eigensolver,
    /// Seed of the start vectors.
    pub seed: u64,
}

/// Modes found at once are sound within this factor: an operator is applied with ε of its largest θ, and what that leaves of a
/// mode, ε · 10⁶ of itself, moves its Rayleigh quotient by the square.
const SPREAD: f64 = 1e6;
/// Backward error of a mode that lacks no digits, a hundredth of what M-01 lets pass.
const SETTLED: f64 = 1e-12;
/// Residual of a mode over its own terms that lacks no digits: what rounding leaves of those up to [`SPREAD`], ε · 10⁶ of each.
const SETTLED_OF_TERMS: f64 = f64::EPSILON * SPREAD;
/// Backward error above which a step of inverse iteration is tried on a mode: a tenth of what M-01 asks for, and ten times what
/// modes are left with that carry nothing unseen.
pub(crate) const CARRIES_NOTHING: f64 = 1e-14;
/// Share of λ that the residual of such a mode may leave in doubt, a tenth of what M-24 looks at.
const SETTLED_BAR: f64 = 1e-10;

/// Finds elastic modes with a shift-invert operator.
///
/// Where few soft motions spread the spectrum over many powers of ten, a search leaves the modes far above them with few
/// digits. Those are then found with the others deflated, as all elastic modes are found with rigid-body motion deflated.
///
/// # Errors
/// The eigensolver does not converge.
pub fn elastic_modes(problem: ModalProblem<'_>, operator: &dyn ShiftInvert, request: ModeRequest) -> Result<Modes> {
    let n = problem.mass.rows();
    let [q, mass_q] = problem.deflated;
    let mut known = Modes::none(n);
    let mut asked = request.wanted;
    loop {
        let momenta = product(problem.mass, known.shapes.as_ref());
        let with_known = [dense::side_by_side(q, known.shapes.as_ref()), dense::side_by_side(mass_q, momenta.as_ref())];
        let deflated = [with_known[0].as_ref(), with_known[1].as_ref()];
        let wanted = match asked {
            Wanted::Count(count) => Wanted::Count(count.saturating_sub(known.count()).max(usize::from(count > 0))),
            Wanted::UpTo(limit) => Wanted::UpTo(limit),
        };
        let eigenproblem = Problem { operator, mass: problem.mass, deflated };
        let found = search(problem, eigenproblem, ModeRequest { wanted, ..request })?;
        let n_settled = n_settled(problem, &found, operator.shift());
        let is_all = n_settled == found.count();
        known = found.truncated(n_settled).joined([known]);
        // More than there are rows would be the same ones again, of a pencil whose rounding no deflation keeps away.
        if known.count() + q.ncols() >= n {
            return Ok(Modes { searched_to: request.wanted.band_end(), ..known });
        }
        if is_all {
            // The iteration ended the last cluster by its own estimates; where the quotients say that it goes on, so does the search.
            let goes_on = |last: &f64| known.next.is_some_and(|next| are_clustered(*last, next));
            if n_settled == 0 || !known.lambda.last().is_some_and(goes_on) {
                return Ok(Modes { searched_to: request.wanted.band_end(), ..known });
            }
            asked = Wanted::Count(known.count() + 1);
        }
    }
}

/// Modes of one search that stand: all of them, or those up to [`SPREAD`] where one further up lacks digits.
fn n_settled(problem: ModalProblem<'_>, found: &Modes, sigma: f64) -> usize {
    let (n_near, settled) = (n_near(found, sigma), settled_at(problem.precision));
    let lacks_digits = |error: &ModeError| {
        error.backward > settled || error.of_terms > settled.max(SETTLED_OF_TERMS) || error.residual_bar > SETTLED_BAR
    };
    if n_near > 0 && found.errors[n_near..].iter().any(lacks_digits) { n_near } else { found.count() }
}

/// Modes up to [`SPREAD`]: θ against the largest, which rounding of the operator is relative to.
fn n_near(found: &Modes, sigma: f64) -> usize {
    let reach = found.lambda.first().map_or(0.0, |first| SPREAD * (first - sigma));
    found.lambda.partition_point(|lambda| lambda - sigma <= reach)
}

/// Backward error of a mode that lacks no digits: those that the data do not have are not missed.
pub(crate) fn settled_at(precision: Precision) -> f64 {
    SETTLED.max(precision.share())
}

/// Whether a mode has a backward error above what an eigensolver leaves – it takes a pair at a residual of so many ε of the largest θ, and digits
/// that the data lack may be forces of the motions that are deflated – or a residual that leaves more of λ in doubt than the data do: the
/// operator was another one than that of K and M.
pub(crate) fn are_left_inexact(problem: ModalProblem<'_>, modes: &Modes) -> bool {
    let of_largest = RESIDUAL_FLOOR * f64::EPSILON * modes.spread();
    let taken_at = TOLERANCE.max(of_largest).max(problem.precision.share());
    let is_open = |error: &ModeError| error.residual_bar > TOLERANCE.max(error.data_bar);
    modes.largest_backward() > taken_at || modes.errors.iter().any(is_open)
}

fn search(problem: ModalProblem<'_>, eigenproblem: Problem<'_>, request: ModeRequest) -> Result<Modes> {
    let pairs = match request.eigensolver {
        Eigensolver::Lanczos => lanczos(eigenproblem, request.wanted, request.seed)?,
        Eigensolver::Arpack => by_arpack(eigenproblem, request)?,
    };
    let around = [None, pairs.next];
    let modes = judged(problem, eigenproblem, pairs, around);
    let modes = purified_where_doubtful(problem, eigenproblem, modes, around);
    Ok(modes)
}

/// The modes after a step of inverse iteration, where one of them lacks digits and gains some: what M hardly sees an iteration
/// carries along, unseen by its products with M.
fn purified_where_doubtful(
    problem: ModalProblem<'_>,
    eigenproblem: Problem<'_>,
    modes: Modes,
    around: [Option<f64>; 2],
) -> Modes {
    let n_near = n_near(&modes, eigenproblem.operator.shift());
    let worst = |modes: &Modes| dense::worst(modes.errors[..n_near].iter().map(|error| error.backward));
    if n_near == 0 || worst(&modes) <= CARRIES_NOTHING {
        return modes;
    }
    let purified = purified(eigenproblem, &modes, CARRIES_NOTHING);
    let purified = judged(problem, eigenproblem, purified, around);
    if worst(&purified) < worst(&modes) { purified } else { Modes { work: purified.work, ..modes } }
}

/// Modes of unit modal mass with their Rayleigh quotients and what is known of their errors; `around` as for the error bars.
pub(crate) fn judged(
    problem: ModalProblem<'_>,
    eigenproblem: Problem<'_>,
    pairs: Eigenpairs,
    around: [Option<f64>; 2],
) -> Modes {
    let mut shapes = pairs.vectors;
    quality::normalise(problem.mass, &mut shapes);
    let (mut lambda, mut errors, mut residuals) = quality::rayleigh_quotients(problem, shapes.as_ref());
    let repeated = cluster::repeated(&lambda, &errors);
    if !repeated.is_empty() {
        cluster::canonicalise(problem.mass, &repeated, &mut shapes);
        (lambda, errors, residuals) = quality::rayleigh_quotients(problem, shapes.as_ref());
        cluster::average(&repeated, &mut lambda, &mut errors);
    }
    quality::add_residual_bars(eigenproblem, &lambda, &mut errors, residuals, around);
    let work = EigenWork { solves: pairs.work.solves + lambda.len(), ..pairs.work };
    Modes { lambda, shapes, errors, searched_to: None, next: pairs.next, counts: Vec::new(), work }
}

#[cfg(feature = "arpack")]
fn by_arpack(problem: Problem<'_>, request: ModeRequest) -> Result<Eigenpairs> {
    arpack::arpack(problem, request.wanted, request.seed)
}

#[cfg(not(feature = "arpack"))]
fn by_arpack(_: Problem<'_>, _: ModeRequest) -> Result<Eigenpairs> {
    Err(crate::error::Error::EigensolverMissing)
}

/// Eigenpairs between two shifts, around the shift of the operator, ascending.
pub(crate) fn pairs_between(
    problem: Problem<'_>,
    interval: Interval,
    solver: (Eigensolver, u64),
) -> Result<Eigenpairs> {
    let (eigensolver, seed) = solver;
    let pairs = match eigensolver {
        Eigensolver::Lanczos => lanczos_between(problem, interval, seed),
        #[cfg(feature = "arpack")]
        Eigensolver::Arpack => arpack::arpack_between(problem, interval, seed),
        #[cfg(not(feature = "arpack"))]
        Eigensolver::Arpack => Err(crate::error::Error::EigensolverMissing),
    };
    pairs.map(Eigenpairs::ascending)
}

/// X = (K − σM)⁻¹ M X (Λ − σI) for the modes whose backward error is not settled: a step of inverse iteration, which leaves nothing
/// in them that M does not see. An iteration carries it along, unseen by its products with M, and where all eigenvalues lie on
/// one side of the shift and far from it, it grows.
pub(crate) fn purified(problem: Problem<'_>, modes: &Modes, settled: f64) -> Eigenpairs {
    let sigma = problem.operator.shift();
    let mut order: Vec<usize> = (0..modes.count()).collect();
    order.sort_by(|a, b| (modes.lambda[*a] - sigma).abs().total_cmp(&(modes.lambda[*b] - sigma).abs()));
    let Modes { lambda: values, shapes: mut vectors, errors, next, mut work, .. } = modes.in_order(&order);
    let doubtful: Vec<usize> = (0..values.len()).filter(|j| errors[*j].backward > settled).collect();
    work.solves += doubtful.len();
    let image = problem.step(dense::columns(vectors.as_ref(), &doubtful).as_ref());
    for (x, j) in image.col_iter().zip(doubtful) {
        let column = dense::column_mut(vectors.as_mut(), j);
        column.iter_mut().zip(x.iter()).for_each(|(to, x)| *to = x * (values[j] - sigma));
    }
    problem.orthonormalise(&mut vectors);
    Eigenpairs { values, vectors, next, work }.ascending()
}
