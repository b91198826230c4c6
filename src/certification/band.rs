//! All modes of a band: those that a result has, and those that counts find missing and the own eigensolver finds.

use super::claims::Claims;
use super::independence::{RECOGNISED, RIGID, Standing};
use super::measured::Measured;
use super::turned;
use crate::eigen::{ElasticCount, Interval, ModalProblem, Modes, ShiftInvert, bars_with_neighbours};
use crate::error::{Error, Result};
use crate::job::Certify;
use crate::modes::{BoundaryProblem, Certificate, ModeSource, Search, certified};
use crate::partition::Partition;

/// The band that a result is to be complete in, in Hz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Lower end; zero has the rigid-body modes in it.
    pub from_hz: f64,
    /// Upper end.
    pub to_hz: f64,
}

/// Relative distance of eigenvalues of one cluster: a result ends inside one, or has some of its modes, without anybody's fault.
pub(super) const CLUSTER: f64 = 1e-5;
/// How far above the end of a band its count is taken, relative to λ: off the highest mode by more than rounding, and mostly below the
/// next one.
const BEYOND: f64 = 1.0 / 256.0;
/// Share of the end of a band from which on shapes are near it.
const NEAR_THE_END: f64 = 0.9;
/// How many times as far as the forces of the shapes at its end that count is taken: their angle to what lies above is then below half a
/// hundredth, and the bar of their frequencies that times their δ.
const FORCES_BEYOND: f64 = 250.0;
/// How far it is taken at most, however poor they are: an eighth in frequency.
const FARTHEST: f64 = 0.25;
/// Steps by which a shift that lies on an eigenvalue is moved up, relative to it.
const STEPS: [f64; 4] = [0.0, 1e-4, 1e-3, 1e-2];
/// Steps in λ by which a shift leaves the cluster of zeros that rigid-body modes are: a quarter of a frequency each.
const JUMP: f64 = 16.0;
/// Such steps: from the smallest rounding of a zero to the first elastic mode.
const MOST_JUMPS: usize = 12;
/// Modes of an interval in which one is missing: a search among fewer finds what it looks for.
const NARROW: usize = 24;
/// Counts that cut one interval after another down to that.
const MOST_CUTS: usize = 400;
/// Modes that are looked for, in addition to as many as the result has.
const MOST_MISSING: usize = 60;

/// The modes of a band and how they were counted.
pub(super) struct Completed {
    /// Every mode from the beginning of the band on, ascending, some of them above its end.
    pub(super) modes: Modes,
    /// The count; none where the band has no end above zero.
    pub(super) certificate: Option<Certificate>,
    /// λ at the ends of the band, in scaled units.
    pub(super) ends: [f64; 2],
    /// λ between which no others than `modes` are, rigid-body modes apart, where they were counted; the lower one infinite from zero on.
    pub(super) counted: Option<[f64; 2]>,
    /// λ up to which all modes of the band are known: its upper end, unless too many are missing below that.
    pub(super) known_to: f64,
    /// Whether the band is the one that was asked for.
    pub(super) is_asked: bool,
    /// Modes that a count finds missing and that were not looked for, as they are too many.
    pub(super) n_not_sought: usize,
    /// λ of the first elastic mode, where the band begins at zero, or has a stated frequency of rigid-body motion in it.
    pub(super) first_elastic: Option<f64>,
}

impl Completed {
    /// Whether an eigenvalue lies in the band; clusters at its end are in it.
    pub(super) fn holds(&self, lambda: f64) -> bool {
        let [from, to] = self.ends;
        (from <= 0.0 || lambda >= from * (1.0 - CLUSTER)) && lambda <= to * (1.0 + CLUSTER)
    }

    /// Whether an eigenvalue lies in the band and not only next to it.
    pub(super) fn holds_strictly(&self, lambda: f64) -> bool {
        let [from, to] = self.ends;
        (from <= 0.0 || lambda >= from) && lambda <= to
    }

    /// With the first elastic mode, which tells what is no frequency of rigid-body motion. Neither a result of such motions alone has it,
    /// nor a band that begins above zero: `lowest` finds it.
    ///
    /// # Errors
    /// Those of `lowest`.
    pub(super) fn with_first_elastic(
        self,
        (claims, standing): (&Claims, &[Standing]),
        lowest: impl FnOnce() -> Result<Option<f64>>,
    ) -> Result<Self> {
        let begins_at_zero = self.ends[0] <= 0.0;
        let mut stated = claims.lambda.iter().flatten().zip(standing);
        let first_elastic = match self.modes.lambda.first() {
            Some(first) if begins_at_zero => Some(*first),
            None if begins_at_zero => lowest()?,
            _ if stated.any(|(stated, standing)| *standing == Standing::Rigid && self.holds(*stated)) => lowest()?,
            _ => None,
        };
        Ok(Self { first_elastic, ..self })
    }

    /// Turns the modes of the result, and the modes that a search has added, into modes of the space that they span together. Next to a
    /// combination of two modes a search finds the other combination of the two. Their error bars know then how far all other modes are.
    ///
    /// # Errors
    /// A dense eigenproblem that does not converge.
    pub(super) fn turned(self, problem: ModalProblem<'_>, operator: &dyn ShiftInvert) -> Result<Self> {
        let around = self.around();
        let Modes { shapes, searched_to, next, counts, work, .. } = self.modes;
        let modes = Modes { searched_to, next, counts, work, ..turned::modes_of(problem, operator, shapes, around)? };
        Ok(Self { modes, ..self })
    }

    /// The modes of the result as they are, their error bars with what the count tells of all others; σ is that of the bars.
    pub(super) fn with_neighbours(mut self, sigma: f64) -> Self {
        let around = self.around();
        bars_with_neighbours(&self.modes.lambda, &mut self.modes.errors, (sigma, around));
        self
    }

    /// What all other modes lie beyond. Without a count there may be some right beyond the first and the last.
    fn around(&self) -> [Option<f64>; 2] {
        let lambda = &self.modes.lambda;
        match self.counted {
            Some([from, to]) => [Some(from).filter(|from| from.is_finite()), Some(to)],
            None => [lambda.first().copied(), lambda.last().copied()],
        }
    }

    /// The same modes in a band that ends with the highest mode that a pair is, where no end was asked for: what a result states above it
    /// is no reason to look for modes there.
    pub(super) fn ending_with(self, highest: Option<f64>) -> Self {
        let [from, to] = self.ends;
        match highest.filter(|highest| !self.is_asked && *highest < to) {
            Some(highest) => Self {
                ends: [from, highest],
                known_to: self.known_to.min(highest),
                n_not_sought: if highest <= self.known_to { 0 } else { self.n_not_sought },
                ..self
            },
            None => self,
        }
    }
}

/// Completes the modes of a result in a band.
///
/// # Errors
/// [`Error::ModesMissing`] where a mode that counts find missing is not found; those of the counts.
pub(super) fn completed(
    (search, partition): (&Search<'_>, &Partition),
    known: Modes,
    (claims, measured): (&Claims, &Measured),
    band: Option<Band>,
) -> Result<Completed> {
    let problem = &search.problem;
    let scaling = partition.scaling;
    let asked = band.map(|band| [band.from_hz, band.to_hz].map(|hz| scaling.eigenvalue(hz)));
    let begin = match asked {
        Some([from, _]) if from > 0.0 => Some(count_near(problem, from * (1.0 - BEYOND))?),
        _ => None,
    };
    let (top, end) = match asked {
        Some([_, to]) => (to, end_of(problem, to, (claims, measured))?),
        None => default_end(problem, &known, (claims, measured))?,
    };
    let ends = [asked.map_or(0.0, |[from, _]| from), top];
    let is_asked = asked.is_some();
    let incomplete = |modes: Modes, n_not_sought: usize| {
        let (certificate, counted, known_to) = (None, None, 0.0);
        Completed { modes, certificate, ends, counted, known_to, is_asked, n_not_sought, first_elastic: None }
    };
    let Some(end) = end else { return Ok(incomplete(known, 0)) };
    let lowest = begin.map_or(f64::NEG_INFINITY, |begin| begin.inertia.sigma);
    let inside = known.selected(|lambda| lowest < lambda && lambda < end.inertia.sigma);
    let begin_at = begin.map_or((0.0, 0), place);
    let most = MOST_MISSING + claims.count();
    let Reach { end, n_beyond } = within_reach(problem, &inside, (begin_at, end), most)?;
    let Some(end) = end else { return Ok(incomplete(inside, n_beyond)) };
    let inside = inside.selected(|lambda| lambda < end.inertia.sigma);
    let counts = localised(problem, &inside, (begin_at, end))?;
    let known_to = ends[1].min(end.inertia.sigma);
    let given = Modes { counts, searched_to: Some(known_to), ..inside };
    let source = OfResult { search, modes: &given, begin };
    let (modes, certificate) = certified(&source, problem, given.clone(), Some(end), Certify::Count)?;
    let counted = Some([lowest, certificate.as_ref().map_or(end.inertia.sigma, |certificate| certificate.count.sigma)]);
    Ok(Completed { modes, certificate, ends, counted, known_to, is_asked, n_not_sought: n_beyond, first_elastic: None })
}

/// The modes of a result as a source that has no others: what is missing the own search finds.
struct OfResult<'a> {
    search: &'a Search<'a>,
    modes: &'a Modes,
    begin: Option<ElasticCount>,
}

impl ModeSource for OfResult<'_> {
    fn lowest(&self, _: u64) -> Result<Modes> {
        Ok(self.modes.clone())
    }

    fn between(&self, interval: Interval, known: &Modes, seed: u64) -> Result<Modes> {
        self.search.between(interval, known, seed)
    }

    fn again(&self, _: u64) -> Result<Option<Modes>> {
        Ok(None)
    }

    fn begin(&self) -> Option<ElasticCount> {
        self.begin
    }
}

fn place(count: ElasticCount) -> (f64, usize) {
    (count.inertia.sigma, count.n_elastic)
}

/// A count at a shift, moved up while it lies on an eigenvalue.
fn count_near(problem: &BoundaryProblem<'_>, sigma: f64) -> Result<ElasticCount> {
    let mut last = Error::SturmPivot;
    for step in STEPS {
        match problem.count_below(sigma * (1.0 + step)) {
            Err(error @ (Error::SturmPivot | Error::ModesMissing { .. })) => last = error,
            found => return found,
        }
    }
    above_the_zeros(problem, sigma)?.ok_or(last)
}

/// The count of no elastic mode at a shift above the cluster of zeros, where the given one lies among them: as none is below the higher
/// shift, none is below this one. A component that is held has no such cluster.
fn above_the_zeros(problem: &BoundaryProblem<'_>, sigma: f64) -> Result<Option<ElasticCount>> {
    if problem.n_rigid() == 0 {
        return Ok(None);
    }
    let mut higher = sigma;
    for _ in 0..MOST_JUMPS {
        higher *= JUMP;
        match problem.count_below(higher) {
            Ok(count) => return Ok(Some(count).filter(|count| count.n_elastic == 0)),
            Err(Error::SturmPivot | Error::ModesMissing { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(None)
}

/// The count above the end of a band: by so much that the distance from there to the shapes at its end is far more than their forces
/// leave open. What is nearer than that to a poor shape may be a part of it.
fn end_of(
    problem: &BoundaryProblem<'_>,
    top: f64,
    (claims, measured): (&Claims, &Measured),
) -> Result<Option<ElasticCount>> {
    if top <= 0.0 {
        return Ok(None);
    }
    let is_near = |claim: &usize| claims.has_mass[*claim] && measured.lambda[*claim] >= NEAR_THE_END * top;
    let of_shapes = (0..claims.count()).filter(is_near).map(|claim| measured.lacking[claim]);
    let poorest = of_shapes.filter(|lacking| *lacking <= RECOGNISED).fold(0.0, f64::max);
    count_near(problem, top * (1.0 + (FORCES_BEYOND * poorest).clamp(BEYOND, FARTHEST))).map(Some)
}

/// The end of the band that a result has by itself: its highest frequency, or the highest of a shape that is a mode where there are too
/// many modes below that to be looked for.
fn default_end(
    problem: &BoundaryProblem<'_>,
    known: &Modes,
    (claims, measured): (&Claims, &Measured),
) -> Result<(f64, Option<ElasticCount>)> {
    let of_known = known.lambda.last().copied().unwrap_or(0.0);
    // A shape that is no mode has a quotient somewhere; what is stated of it counts. Of rigid-body motion it is the rounding of a zero.
    let stated = claims.lambda.as_ref().unwrap_or(&measured.lambda).iter().copied().enumerate();
    let is_elastic = |claim: usize| claims.has_mass[claim] && measured.rigid_share(claim) <= RIGID;
    let stated = stated.filter(|(claim, lambda)| is_elastic(*claim) && lambda.is_finite());
    let of_all = stated.map(|(_, lambda)| lambda).fold(of_known, f64::max);
    if of_all > of_known * (1.0 + BEYOND) {
        let end = end_of(problem, of_all, (claims, measured))?;
        let n_lacking = end.map_or(0, |end| end.n_elastic.saturating_sub(known.count()));
        if n_lacking <= MOST_MISSING + claims.count() {
            return Ok((of_all, end));
        }
    }
    Ok((of_known, end_of(problem, of_known, (claims, measured))?))
}

/// Counts inside a band, so that what is missing is in intervals of few modes.
fn localised(
    problem: &BoundaryProblem<'_>,
    known: &Modes,
    (begin, end): ((f64, usize), ElasticCount),
) -> Result<Vec<ElasticCount>> {
    let mut counts: Vec<ElasticCount> = Vec::new();
    let mut waiting = vec![(begin, end)];
    for _ in 0..MOST_CUTS {
        let Some((lower, upper)) = waiting.pop() else { break };
        let inside: Vec<f64> =
            known.lambda.iter().copied().filter(|lambda| lower.0 < *lambda && *lambda < upper.inertia.sigma).collect();
        let n_counted = upper.n_elastic.saturating_sub(lower.1);
        if n_counted <= inside.len() || n_counted <= NARROW {
            continue;
        }
        let Some(count) = gap_near_the_middle(&inside, (lower.0, upper.inertia.sigma)) else { continue };
        match problem.count_below(count) {
            Ok(middle) if (lower.1..=upper.n_elastic).contains(&middle.n_elastic) => {
                counts.push(middle);
                waiting.extend([(lower, middle), (place(middle), upper)]);
            }
            Ok(_) | Err(Error::SturmPivot | Error::ModesMissing { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    counts.sort_by(|a, b| a.inertia.sigma.total_cmp(&b.inertia.sigma));
    Ok(counts)
}

/// The middle of the widest gap, relative to λ, among those in the middle third of some modes; of few modes, the middle of the interval.
fn gap_near_the_middle(lambda: &[f64], (from, to): (f64, f64)) -> Option<f64> {
    let n = lambda.len();
    if n < 3 {
        return Some(0.5 * (from + to)).filter(|sigma| from < *sigma && *sigma < to);
    }
    let width = |at: &usize| 1.0 - lambda[*at] / lambda[*at + 1];
    let widest = (n / 3..=(2 * n / 3).min(n - 2)).max_by(|a, b| width(a).total_cmp(&width(b)))?;
    Some(0.5 * (lambda[widest] + lambda[widest + 1]))
}

/// How far a band is looked through.
struct Reach {
    /// The count at its end; none where too many modes are missing wherever it ends.
    end: Option<ElasticCount>,
    /// Modes that are missing above that.
    n_beyond: usize,
}

/// The end of a band up to which no more modes are missing than are looked for.
fn within_reach(
    problem: &BoundaryProblem<'_>,
    known: &Modes,
    (begin, end): ((f64, usize), ElasticCount),
    most: usize,
) -> Result<Reach> {
    const MOST_COUNTS: usize = 12;
    let n_lacking = |count: &ElasticCount| {
        let n_known = known.lambda.iter().filter(|lambda| **lambda < count.inertia.sigma).count();
        count.n_elastic.saturating_sub(begin.1 + n_known)
    };
    let all = n_lacking(&end);
    if all <= most {
        return Ok(Reach { end: Some(end), n_beyond: 0 });
    }
    let (mut low, mut high, mut reach) = (begin.0, end.inertia.sigma, None);
    for _ in 0..MOST_COUNTS {
        // Half way in frequency.
        let sigma = (0.5 * (low.sqrt() + high.sqrt())).powi(2);
        match problem.count_below(sigma) {
            Ok(count) if n_lacking(&count) <= most => {
                low = sigma;
                reach = Some(count).filter(|count| n_lacking(count) > 0);
                if 2 * n_lacking(&count) >= most {
                    break;
                }
            }
            Ok(_) | Err(Error::SturmPivot | Error::ModesMissing { .. }) => high = sigma,
            Err(error) => return Err(error),
        }
    }
    Ok(Reach { n_beyond: reach.as_ref().map_or(all, |reach| all - n_lacking(reach)), end: reach })
}
