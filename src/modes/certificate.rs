//! The certificate that no mode is missing: Sturm counts at both ends of the band, and what happens when they disagree.
//!
//! # Both ends
//! The lower end takes no factorisation of its own. K_II = L Lᵀ with positive pivots is a count at zero with the interface
//! held, and with it free the eigenvalues of S complete it (see [`super::indefinite`]): nothing lies below zero. The zero
//! modes themselves are n_r independent vectors whose Rayleigh quotients are zero to rounding (M-05), so n_r eigenvalues
//! at least lie below any shift above those; and the count at the upper end, which equals n_r and the elastic modes found,
//! leaves no further one. Between the two ends every eigenvalue is thus matched by a vector, one to one, because the
//! vectors are M-orthonormal (M-03) and each is an eigenvector to its residual (M-01).
//!
//! # How far a count can be trusted
//! L B Lᵀ is the factorisation of K − σM + E with ‖E‖ ≤ c ε ρ (‖K‖ + |σ|‖M‖), ρ the growth of |L||B||Lᵀ| over the matrix, which
//! is measured (Higham 2002, theorem 11.3), so the signs are those of that matrix. E moves λ_j by xᵀEx ≤ c ρ φ_j with
//! φ_j = ε (‖K‖‖x‖²_K + |σ|‖M‖‖x‖²_M) / xᵀMx, norms equilibrated by the diagonals of K and of M: the count is right as long as no eigenvalue lies nearer to σ than
//! c ρ φ. Roundings add up like the root of the depth of the elimination, which is 10⁴ for the largest meshes:
//! c = [`ROUNDINGS`]. Growth beyond the limit makes a count likely, not certain, and the report says so.
//!
//! # Where there are no more modes
//! A search that ends with fewer modes than were asked for is compared with the rank of M, which is the number of finite
//! eigenvalues. Where they differ the count is taken above any spectrum of a mesh with these diagonals instead of just above
//! the highest mode, and what it finds missing is looked for as any other mode.

use super::boundary_problem::BoundaryProblem;
use super::finite::{above_all, most_finite};
use super::slices::{Band, ModeSource, missing};
use crate::dense;
use crate::eigen::{ElasticCount, median_ratio};
use crate::eigen::{Equilibrated, ModeError, Modes};
use crate::error::{Error, Result};
use crate::factor::InertiaCount;
use crate::job::{Boundary, Certify};
use crate::random::SEED;
use crate::sparse::Pencil;

/// Sturm counts against the modes found.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// The count at the upper end.
    pub count: InertiaCount,
    /// Boundary of the modes.
    pub boundary: Boundary,
    /// Eigenvalues below the upper end under that boundary, rigid-body modes included.
    pub n_counted: usize,
    /// Modes found below it, rigid-body modes included.
    pub n_found: usize,
    /// The intervals between neighbouring counts, from below zero to the upper end.
    pub intervals: Vec<CountedInterval>,
    /// Where fewer modes were found than asked for, the finite eigenvalues there are at most, rigid-body modes included.
    pub n_finite: Option<usize>,
    /// How the modes had to be completed.
    pub mending: Mending,
    /// Factorisations it took.
    pub n_factorisations: usize,
}

/// An interval between two counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountedInterval {
    /// Lower shift, in scaled units.
    pub from: f64,
    /// Upper shift.
    pub to: f64,
    /// Eigenvalues between them.
    pub n_counted: usize,
    /// Modes found between them.
    pub n_found: usize,
    /// Pivot growth of the two counts, the larger; one for the lower end, which is a Cholesky factor.
    pub growth: f64,
    /// The growth up to which the counts are certain, the smaller.
    pub growth_limit: f64,
}

/// How modes that a count had found missing were completed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mending {
    /// None was missing.
    None,
    /// By a search from another start.
    Restart,
    /// By slices of the band.
    Slices,
}

impl Certificate {
    /// True where every mode below the upper end was found, interval by interval and in all.
    pub fn holds(&self) -> bool {
        self.n_counted == self.n_found && self.intervals.iter().all(|interval| interval.n_counted == interval.n_found)
    }

    /// The largest growth over its limit: up to one the counts are certain, above they are likely.
    pub fn doubt(&self) -> f64 {
        dense::worst(self.intervals.iter().map(|interval| interval.growth / interval.growth_limit))
    }
}

/// c: eigenvalues that rounding φ of the factorisation moves by less than this many times decide no sign.
const ROUNDINGS: f64 = 100.0;
/// Where in the gap above the highest mode a count is taken: the middle, unless that is an eigenvalue itself.
const PLACES: [f64; 3] = [0.5, 0.375, 0.625];

/// Certifies the modes; those that are missing are looked for from another start, then in slices of the band.
///
/// `edge` is a count at the end of the band that was taken before the search; it serves where it is off the modes.
///
/// # Errors
/// [`Error::ModesMissing`] where that finds no more; those of the source and of the counts.
pub fn certified(
    source: &dyn ModeSource,
    problem: &BoundaryProblem<'_>,
    found: Modes,
    edge: Option<ElasticCount>,
    certify: Certify,
) -> Result<(Modes, Option<Certificate>)> {
    if certify == Certify::None {
        return Ok((found, None));
    }
    let certify_modes = |modes: &Modes| {
        let n_finite = match source.is_exhausted_by(modes) {
            true => Some(most_finite(problem, modes.count() + problem.n_rigid())?),
            false => None,
        };
        Ok(Certificate { n_finite, ..certify_modes((problem, source), modes, edge, n_finite)? })
    };
    let first = certify_modes(&found)?;
    if first.holds() {
        return Ok((found, Some(first)));
    }
    let mut n_factorisations = first.n_factorisations;
    let (known, last) = match source.again(SEED + 1)? {
        None => (found, first),
        Some(again) => {
            let second = certify_modes(&again)?;
            n_factorisations += second.n_factorisations;
            if second.holds() {
                return Ok((again, Some(Certificate { mending: Mending::Restart, n_factorisations, ..second })));
            }
            // The larger set is the better start for the slices.
            if again.count() >= found.count() { (again, second) } else { (found, first) }
        }
    };
    let upper = ElasticCount { inertia: last.count, n_elastic: Begin::of(problem, source).n_elastic(last.n_counted) };
    let mut ends = known.counts.clone();
    ends.retain(|end| end.inertia.sigma < upper.inertia.sigma);
    ends.push(upper);
    let known = Modes { counts: Vec::new(), ..known };
    let modes = Band { source, problem, at_once: 1 }.fill(known, &ends)?;
    let upper = modes.counts.last().copied().unwrap_or(upper);
    let third = judge((problem, source), &modes, upper);
    let n_finite = last.n_finite.filter(|_| source.is_exhausted_by(&modes));
    if !third.holds() {
        return Err(missing(problem, &modes, upper));
    }
    let third = Certificate { mending: Mending::Slices, n_factorisations, n_finite, ..third };
    let n_found = modes.count();
    let asked = source.asked(modes);
    // What the slices found above the modes asked for is counted too, unless a count between the two stands by itself.
    let certificate = match asked.count() < n_found {
        true => certify_modes(&asked).ok().filter(|fourth| fourth.holds() && fourth.doubt() <= third.doubt()),
        false => None,
    };
    let n_taken = certificate.as_ref().map_or(0, |fourth| fourth.n_factorisations);
    let certificate = certificate.unwrap_or(third);
    let n_factorisations = n_factorisations + n_taken;
    Ok((asked, Some(Certificate { mending: Mending::Slices, n_factorisations, ..certificate })))
}

/// Takes the count at the upper end and compares: at a count taken before where one serves, above all that can be where modes
/// are fewer than `n_finite`, otherwise in the gap above the highest mode.
fn certify_modes(
    (problem, source): (&BoundaryProblem<'_>, &dyn ModeSource),
    modes: &Modes,
    edge: Option<ElasticCount>,
    n_finite: Option<usize>,
) -> Result<Certificate> {
    let may_be_more = n_finite.is_some_and(|n_finite| modes.count() + problem.n_rigid() < n_finite);
    let far = may_be_more.then(|| above_all(problem));
    // Where nothing is known above the modes there is no gap for a better place, and only the doubt below decides.
    let serves = |end: &ElasticCount| {
        let sigma = end.inertia.sigma;
        let is_above = modes.lambda.last().is_none_or(|last| *last < sigma) && far.is_none_or(|far| far <= sigma);
        is_above && modes.next.is_none_or(|next| sigma < next && modes.is_clear(sigma))
    };
    for end in edge.into_iter().chain(modes.counts.last().copied()).filter(serves) {
        let certificate = judge((problem, source), modes, end);
        if certificate.doubt() <= 1.0 {
            return Ok(certificate);
        }
    }
    let (mut best, mut near): (Option<Certificate>, Vec<Certificate>) = (None, Vec::new());
    let mut failure = Error::SturmPivot;
    let places = far.into_iter().chain(PLACES.into_iter().map(|place| modes.shift_above(place)));
    for (attempt, sigma) in places.enumerate() {
        let counted = problem.count_at(sigma).and_then(|(count, is_off)| Ok((count?, is_off)));
        match counted {
            Ok((count, is_off)) => {
                let certificate =
                    Certificate { n_factorisations: attempt + 1, ..judge((problem, source), modes, count) };
                if !is_off {
                    near.push(certificate);
                    continue;
                }
                let is_certain = certificate.doubt() <= 1.0;
                if best.as_ref().is_none_or(|best| certificate.doubt() < best.doubt()) {
                    best = Some(certificate);
                }
                if is_certain {
                    break;
                }
            }
            Err(error) => failure = error,
        }
    }
    best.or_else(|| agreed(near)).ok_or(failure)
}

/// The first of some counts at shifts so near to eigenvalues that their factors do not tell by themselves on which side: they are counts
/// where no known eigenvalue is within the rounding of any of them, and all say the same. One eigenvalue more would have to lie
/// at every place.
fn agreed(near: Vec<Certificate>) -> Option<Certificate> {
    let n_counted = near.first()?.n_counted;
    let agree = near.iter().all(|other| other.n_counted == n_counted && other.doubt() <= 1.0);
    (near.len() >= PLACES.len() && agree).then(|| near.into_iter().next()).flatten()
}

/// Where a band begins: a shift with the count below it, or below the zero modes, which are in the band then.
struct Begin {
    sigma: f64,
    n_below: usize,
    n_rigid: usize,
    count: Option<ElasticCount>,
}

impl Begin {
    fn of(problem: &BoundaryProblem<'_>, source: &dyn ModeSource) -> Self {
        match source.begin() {
            Some(count) => {
                let (sigma, n_below) = count.place();
                Self { sigma, n_below, n_rigid: 0, count: Some(count) }
            }
            None => Self { sigma: lower_end(problem), n_below: 0, n_rigid: problem.n_rigid(), count: None },
        }
    }

    /// Elastic eigenvalues below a shift under which the band has `n_counted`.
    fn n_elastic(&self, n_counted: usize) -> usize {
        (n_counted + self.n_below).saturating_sub(self.n_rigid)
    }

    /// Eigenvalues of the band below a shift with so many elastic ones below it.
    fn n_in_band(&self, n_elastic: usize) -> usize {
        (n_elastic + self.n_rigid).saturating_sub(self.n_below)
    }
}

/// Compares the counts up to an upper end with the modes.
pub(super) fn judge(
    (problem, source): (&BoundaryProblem<'_>, &dyn ModeSource),
    modes: &Modes,
    upper: ElasticCount,
) -> Certificate {
    let begin = Begin::of(problem, source);
    let mut ends: Vec<ElasticCount> = modes.counts.clone();
    ends.retain(|end| begin.sigma < end.inertia.sigma && end.inertia.sigma < upper.inertia.sigma);
    ends.push(upper);
    let mass_floors = mass_floors(problem, modes);
    let limit_at = |sigma: f64| growth_limit(problem, modes, &mass_floors, sigma);
    let (mut from, mut below) = (begin.sigma, begin.n_below);
    let mut lower = begin.count.map_or((1.0, f64::INFINITY), |count| (count.inertia.growth, limit_at(begin.sigma)));
    let mut intervals = Vec::with_capacity(ends.len());
    for end in ends {
        let to = end.inertia.sigma;
        let limit = limit_at(to);
        let rigid = if intervals.is_empty() { begin.n_rigid } else { 0 };
        intervals.push(CountedInterval {
            from,
            to,
            // A count that falls with the shift is not a count; the sum over the intervals is then more than the whole.
            n_counted: (end.n_elastic + rigid).saturating_sub(below),
            n_found: modes.n_between(from, to) + rigid,
            growth: end.inertia.growth.max(lower.0),
            growth_limit: limit.min(lower.1),
        });
        (from, below, lower) = (to, end.n_elastic, (end.inertia.growth, limit));
    }
    let lowest = if begin.count.is_some() { begin.sigma } else { f64::NEG_INFINITY };
    Certificate {
        count: upper.inertia,
        boundary: problem.boundary,
        n_counted: begin.n_in_band(upper.n_elastic),
        n_found: modes.n_between(lowest, upper.inertia.sigma) + begin.n_rigid,
        intervals,
        n_finite: None,
        mending: Mending::None,
        n_factorisations: 0,
    }
}

/// Just below the zero modes, whose eigenvalues rounding of the data moves about zero; zero where there are none.
fn lower_end(problem: &BoundaryProblem<'_>) -> f64 {
    let energy = problem.component.rigid.energy;
    if problem.n_rigid() == 0 { 0.0 } else { -(energy.largest_quotient.abs() + energy.noise) }
}

/// The share of M in the floors φ of the modes at a shift of one: ε ‖M‖ Σ M_ii x_i² / xᵀMx, in units of the diagonal of M.
fn mass_floors(problem: &BoundaryProblem<'_>, modes: &Modes) -> Vec<f64> {
    let mass = problem.modal().mass;
    let weights = mass.diagonal();
    let norm = Equilibrated::of(Pencil::new(mass, mass)).mass_norm;
    let of_mode = |j: usize| {
        let x = dense::column(modes.shapes.as_ref(), j);
        f64::EPSILON * norm * x.iter().zip(&weights).map(|(x, m)| m * x * x).sum::<f64>()
    };
    (0..modes.count()).map(of_mode).collect()
}

/// The pivot growth up to which no eigenvalue can have crossed σ by rounding of the factorisation.
fn growth_limit(problem: &BoundaryProblem<'_>, modes: &Modes, mass_floors: &[f64], sigma: f64) -> f64 {
    let of_mode = |(error, mass): (&ModeError, &f64)| error.rounding_floor + sigma.abs() * mass;
    let floors: Vec<f64> = modes.errors.iter().zip(mass_floors).map(of_mode).collect();
    let largest = floors.iter().copied().fold(0.0, f64::max);
    // Without a mode to tell, rounding moves an eigenvalue by ε of the largest of a mesh of like dofs.
    let floor = if largest > 0.0 { largest } else { f64::EPSILON * median_ratio(problem.modal()) };
    let of_found = modes.lambda.iter().zip(floors).map(|(lambda, floor)| (sigma - lambda).abs() / floor);
    let of_next = modes.next.map(|next| (next - sigma).abs() / floor);
    let ratios: Vec<f64> = of_found.chain(of_next).collect();
    // NaN never counts as a bound.
    if ratios.iter().any(|ratio| ratio.is_nan()) {
        return 0.0;
    }
    ratios.into_iter().fold(f64::INFINITY, f64::min) / ROUNDINGS
}
