//! What each pair of a result is, once all modes of the band are known.
//!
//! ```text
//! Y    n' × m   the modes of the band, M-orthonormal
//! C    m × k    YᵀMX: how much of each mode a shape has; the squares of a column are shares of its modal mass
//! ```
//! Modes of a cluster are one space: any combination of them is as good.

use super::angles::{AmongKnown, Angle, angle};
use super::band::Completed;
use super::claims::Claims;
use super::independence::Standing;
use super::lacking::Lacking;
use super::measured::Measured;
use super::pair::{JudgedPair, PairKind};
use super::rounding::{
    MOST_OF_DIGITS, OfShape, is_rounded_mode, of_digits_in_energy, of_digits_in_frequency, of_digits_of_shape,
};
use super::truth::{Found, Truth, clusters, nearest};
use crate::dense;
use crate::eigen::frequency_bar;
use crate::modes::BoundaryProblem;
use crate::sparse::product;
use crate::verification::limits::LARGEST_EXPLAINED_ENERGY;

/// Relative difference of a frequency beyond which it is not that of its mode: reduced models are accepted with less.
pub(super) const INEXACT: f64 = 1e-3;
/// λ of rigid-body motion relative to the first elastic one: a hundredth of its frequency.
pub(super) const NOT_RIGID: f64 = 1e-4;

/// The pairs of a result and what it lacks.
pub(super) struct Judged {
    pub(super) pairs: Vec<JudgedPair>,
    pub(super) lacking: Lacking,
    /// Rigid-body modes that the result lacks; none are missing of a band that begins above them.
    pub(super) n_rigid_missing: usize,
    /// λ of the highest mode that a pair is.
    pub(super) highest: Option<f64>,
    /// The angle between the shape of each pair that is a mode and the modes of its cluster.
    pub(super) angles: Vec<Option<Angle>>,
    /// How far each quotient may be from an eigenvalue of K and M by the force that is left over, relative to it.
    pub(super) residual_bars: Vec<f64>,
    /// What the digits of each shape leave open of its frequency, relative to it.
    pub(super) of_shapes: Vec<f64>,
    /// Whether each shape is no farther from its mode than the rounding of its digits, where these are few.
    pub(super) is_rounded: Vec<bool>,
    /// What each shape has of known modes other than its own, in the norm of M.
    pub(super) of_others: Vec<Option<f64>>,
}

/// Judges every pair.
pub(super) fn judged_pairs(
    problem: &BoundaryProblem<'_>,
    (claims, measured): (&Claims, &Measured),
    standing: &[Standing],
    (completed, known): (&Completed, Option<&AmongKnown>),
) -> Judged {
    let modes = &completed.modes;
    let truth = Truth { lambda: &modes.lambda, clusters: clusters(&modes.lambda), completed, sigma: measured.sigma };
    let momenta = product(problem.modal().mass, claims.shapes.as_ref());
    let shares = dense::gram(modes.shapes.as_ref(), momenta.as_ref());
    let (kinds, taken) = truth.found_of_all((claims, measured), standing, &shares);
    let n_rigid = kinds.iter().filter(|found| found.kind == PairKind::RigidBody).count();
    let has_rigid = completed.ends[0] <= 0.0;
    let n_rigid_missing = if has_rigid { problem.n_rigid().saturating_sub(n_rigid) } else { 0 };
    let residual_bars: Vec<f64> =
        (0..claims.count()).map(|claim| truth.residual_bar(claim, kinds[claim].cluster, measured)).collect();
    let of_shape = |claim: usize| {
        let gap = kinds[claim].cluster.map_or(1.0, |cluster| truth.gap(cluster, measured.lambda[claim]));
        of_digits_of_shape(claims, measured, (claim, gap))
    };
    let of_shapes: Vec<f64> = (0..claims.count()).map(of_shape).collect();
    let is_rounded: Vec<bool> = (0..claims.count())
        .map(|claim| {
            let cluster = kinds[claim].cluster.map(|cluster| &truth.clusters[cluster]);
            is_rounded_mode((claims, measured), known, (claim, standing[claim], cluster))
        })
        .collect();
    let context = Context { problem, claims, measured, truth: &truth };
    let pair = |claim: usize| {
        let (residual_bar, of_digits, is_rounded) = (residual_bars[claim], of_shapes[claim], is_rounded[claim]);
        context.pair(claim, &kinds[claim], OfShape { residual_bar, of_digits, is_rounded })
    };
    let pairs = (0..claims.count()).map(pair).collect();
    let angle_of = |claim: usize| {
        let cluster = kinds[claim].cluster?;
        let gap = truth.gap(cluster, measured.lambda[claim]);
        Some(angle(known, claim, (&truth.clusters[cluster], gap), measured))
    };
    let angles = (0..claims.count()).map(angle_of).collect();
    let of_others = |claim: usize| Some(known?.of_others(claim, &truth.clusters[kinds[claim].cluster?]));
    let of_others = (0..claims.count()).map(of_others).collect();
    let lacking = Lacking::of(&truth, &taken, (claims, measured), |lambda| context.hertz(lambda));
    let mut is_taken = truth.clusters.iter().zip(&taken).filter(|(_, taken)| !taken.is_empty());
    let highest = is_taken.next_back().map(|(cluster, _)| truth.lambda[cluster.end - 1]);
    Judged { pairs, lacking, n_rigid_missing, highest, angles, residual_bars, of_shapes, is_rounded, of_others }
}

/// What the pairs are put into words with.
struct Context<'a> {
    problem: &'a BoundaryProblem<'a>,
    claims: &'a Claims,
    measured: &'a Measured,
    truth: &'a Truth<'a>,
}

impl Context<'_> {
    fn hertz(&self, lambda: f64) -> f64 {
        self.problem.component.partition.scaling.hertz(lambda)
    }

    fn pair(&self, claim: usize, found: &Found, of_shape: OfShape) -> JudgedPair {
        let Self { problem, claims, measured, truth } = self;
        let lambda = measured.lambda[claim];
        let stated = claims.lambda.as_ref().map(|stated| stated[claim]);
        let shape_hz = self.hertz(lambda);
        // Of a shape that is its mode but for rounding the mode is known better than its quotient.
        let is_by_mode = of_shape.is_rounded && found.kind == PairKind::Inexact && found.cluster.is_some();
        let to = stated.filter(|_| is_by_mode).unwrap_or(lambda);
        let of_cluster = found.cluster.map(|cluster| nearest(truth.lambda, truth.clusters[cluster].clone(), to));
        let found_kind = if is_by_mode { PairKind::Mode } else { found.kind };
        let own_bar = frequency_bar(of_shape.residual_bar + measured.errors[claim].data_bar, shape_hz);
        let bar_of = |mode: usize| truth.completed.modes.errors[mode].bar_of(self.hertz(truth.lambda[mode]));
        // Of a shape that is an eigenvector its own quotient is known best.
        let (mode, mode_bar) = match found.kind {
            PairKind::Mode => (Some(lambda), Some(own_bar)),
            PairKind::Inexact => (of_cluster.map(|mode| truth.lambda[mode]), of_cluster.map(bar_of)),
            PairKind::RigidBody => (Some(0.0), None),
            PairKind::Repeated | PairKind::Invented | PairKind::OutsideBand => (None, None),
        };
        let stated_or_own = stated.unwrap_or(lambda);
        let is_off = match (found_kind, mode) {
            (PairKind::Mode, Some(mode)) => self.is_off(claim, (stated_or_own, mode), of_shape),
            (PairKind::RigidBody, _) => self.is_no_rigid_motion(claim, of_shape),
            _ => false,
        };
        let is_told = matches!(found_kind, PairKind::Mode | PairKind::RigidBody | PairKind::Inexact);
        let out_of_place = Some(claims.strayed[claim]).filter(|strayed| is_told && strayed.fails());
        let kind = if is_off || out_of_place.is_some() { PairKind::Inexact } else { found_kind };
        // What is stated in the band is judged although the shape belongs elsewhere, and the other way round.
        let is_inside = truth.completed.holds(mode.unwrap_or(lambda)) || truth.completed.holds(stated_or_own);
        let is_outside = truth.completed.is_asked && kind != PairKind::Repeated && !is_inside;
        let kind = if is_outside { PairKind::OutsideBand } else { kind };
        let at = problem.component.partition.dof_under(problem.boundary, measured.worst[claim]);
        JudgedPair {
            number: claim + 1,
            kind,
            stated_hz: stated.map(|stated| self.hertz(stated)),
            shape_hz,
            error_bar_hz: own_bar,
            mode_hz: mode.map(|mode| self.hertz(mode)),
            mode_error_bar_hz: mode_bar,
            backward_error: measured.backward[claim],
            worst_at: problem.component.partition.name_of(at),
            out_of_place: out_of_place.map(|strayed| strayed.value),
            repeats: found.repeats.map(|other| other + 1),
            neighbours_hz: if kind == PairKind::Invented { self.neighbours(stated_or_own) } else { [None, None] },
        }
    }

    /// Whether the frequency of a pair, or what its shape leaves open of it, is off that of its mode.
    fn is_off(&self, claim: usize, (own, mode): (f64, f64), of_shape: OfShape) -> bool {
        let Self { claims, measured, .. } = self;
        let of_digits = claims.value_rounding[claim] + of_digits_in_frequency(measured, claim);
        let off = (own.max(0.0) / mode).sqrt() - 1.0;
        if of_shape.is_rounded {
            // Without a frequency of its own the pair has that of its mode.
            let is_near = off.abs() <= INEXACT + of_digits;
            return claims.lambda.is_some() && !is_near;
        }
        let of_shape_digits = of_shape.of_digits.min(MOST_OF_DIGITS);
        !(off.abs() <= INEXACT + of_digits + of_shape_digits
            && 0.5 * of_shape.residual_bar <= INEXACT + of_shape_digits)
    }

    /// Whether a pair that moves as a rigid body has a frequency. The energy of a rounded shape is that of its rounding.
    fn is_no_rigid_motion(&self, claim: usize, of_shape: OfShape) -> bool {
        let Self { claims, measured, truth, .. } = self;
        let stated = claims.lambda.as_ref().map(|stated| stated[claim]);
        let Some(own) = stated.or_else(|| Some(measured.lambda[claim]).filter(|_| !of_shape.is_rounded)) else {
            return false;
        };
        let of_digits = |first: f64| of_digits_in_energy(measured, claim, first).min(LARGEST_EXPLAINED_ENERGY);
        truth.completed.first_elastic.is_some_and(|first| own.abs() > NOT_RIGID.max(of_digits(first)) * first)
    }

    fn neighbours(&self, lambda: f64) -> [Option<f64>; 2] {
        let known = self.truth.lambda;
        let above = known.partition_point(|other| *other <= lambda);
        let below = above.checked_sub(1).map(|below| self.hertz(known[below]));
        [below, known.get(above).map(|above| self.hertz(*above))]
    }
}
