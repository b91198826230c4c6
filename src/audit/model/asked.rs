//! The modes that the job asks for, found by another eigensolver from another factor: M-01, M-06.
//!
//! The file takes no part in this. The job, the spectrum and a count say how many modes there are.

use std::ops::Range;

use faer::Mat;

use super::full::Full;
use super::interior::Interior;
use crate::dense;
use crate::eigen::{
    CLUSTER_GAP, Factored, ModalProblem, ModeRequest, Modes, RESIDUAL_FLOOR, ShiftInvert, Wanted, elastic_modes,
};
use crate::error::{Error, Result};
use crate::factor::{Analysis, WholeCount, whole_count};
use crate::job::{Boundary, Eigensolver, ReductionJob};
use crate::modes::mode_wish;
use crate::partition::Partition;
use crate::rigid::RigidBodyModes;
use crate::sparse::{panels, product};
use crate::verification::check::{Check, Limits, MAX_EXCUSE};
use crate::verification::limits::Known;

/// Seed of the start vectors; another one than any the reduction uses.
const SEED: u64 = 0x0dd5_eed5;
/// Where in the gap above the highest mode the count is taken: elsewhere than the reduction takes it.
const PLACE: f64 = 0.29;
/// Residual over θ at which the eigensolvers of the reduction take a pair.
const RESIDUAL_OF_REDUCTION: f64 = 1e-13;
/// How much rounding may move an eigenvalue at the edge of a cluster or a band, in units of the gap that decides.
const EDGE: f64 = 1e-2;

/// Independent modes under the boundary of the job's method.
pub(super) struct AskedModes {
    pub(super) boundary: Boundary,
    pub(super) modes: Modes,
    /// How far each shape, mine or the file's, may lie outside the space of its group: the sine of an angle in the mass.
    pub(super) angles: Vec<f64>,
    /// How far each may be turned inside of its group, unless it shares its eigenvalue: the same sine.
    pub(super) turns_inside: Vec<f64>,
    /// What the residual of a shape of the file may add to its relative error bar, at most.
    pub(super) residual_bars: Vec<f64>,
    /// Ranges of modes that are compared as one space.
    pub(super) groups: Vec<Range<usize>>,
    /// What the job asks for, in scaled units.
    wanted: Wanted,
    n_zero: usize,
    count: Option<WholeCount>,
    /// Why the modes were found again by the eigensolver of the job, where the other one failed.
    other_failed: Option<String>,
    /// What few digits leave of the backward error of a mode that is kept apart from motions which K does not quite let pass: half a
    /// unit of the last digit in every entry, ten times where rigid-body motions are taken out, which stands for the sum over them.
    of_digits: f64,
}

impl AskedModes {
    /// No modes at all: a component without internal dofs has none with its interface held.
    fn none(partition: &Partition, wanted: Wanted) -> Self {
        Self {
            boundary: Boundary::FixedInterface,
            modes: Modes::none(partition.n_internal),
            angles: Vec::new(),
            turns_inside: Vec::new(),
            residual_bars: Vec::new(),
            groups: Vec::new(),
            wanted,
            n_zero: 0,
            count: None,
            other_failed: None,
            of_digits: 0.0,
        }
    }

    /// How far eigenvalues of the cluster of a mode lie apart, relatively: as much as its turning hides of K̂.
    pub(super) fn width(&self, mode: usize) -> f64 {
        let of = |group: &Range<usize>| 1.0 - self.modes.lambda[group.start] / self.modes.lambda[group.end - 1];
        self.groups.iter().find(|group| group.contains(&mode)).map_or(0.0, of)
    }

    /// Modes with the interface free, or some of it, by K − σM of the dofs that are free; `rigid` are the motions that the
    /// reduction deflates.
    ///
    /// # Errors
    /// The eigensolver fails; the count falls on an eigenvalue.
    pub(super) fn moving(
        full: &Full<'_>,
        (boundary, operator): (Boundary, &dyn ShiftInvert),
        rigid: &RigidBodyModes,
        job: &ReductionJob,
    ) -> Result<Self> {
        let problem = full.partition.problem_under(boundary);
        let passing = rigid.under(boundary);
        let problem = passing.map_or(problem, |passing| problem.deflating(passing.deflated()));
        let mut found = Self::of(problem, operator, job, full.partition)?;
        // Motions that K does not quite let pass are not those of the next operator: what they cost it is what tells both apart.
        let energy = rigid.energy.largest_quotient / full.first;
        // Deflated, the operators differ by no more than what those motions pull the elastic ones by, which is of second order.
        let energy = match passing.filter(|_| full.partition.has_few_digits()) {
            Some(passing) => energy.min(pull(problem, operator, passing)).max(RESIDUAL_OF_REDUCTION),
            None => energy,
        };
        // Zero modes of mechanisms are others by the interface than by inverse iteration, by what roundings turn both towards elastic ones.
        let turned = if full.has_mechanisms && full.partition.has_few_digits() { full.noise } else { 0.0 };
        let energy = energy.max(turned);
        for group in &found.groups {
            let gap = gap_of(&found.modes, operator.shift(), group);
            let turn = energy / gap;
            found.angles[group.clone()].iter_mut().for_each(|angle| *angle = (*angle + turn).min(1.0));
            // A shape that lacks δ of θ, and is turned by δ/γ for it, has a quotient that is off by δ²/γ.
            found.residual_bars[group.clone()].iter_mut().for_each(|bar| *bar += turn * turn * gap);
        }
        let shapes = full.partition.whole_under(boundary, found.modes.shapes);
        let modes = Modes { shapes, ..found.modes };
        let n_zero = passing.map_or(0, RigidBodyModes::count);
        let of_digits = if n_zero > 0 { 10.0 * found.of_digits } else { found.of_digits };
        Ok(Self { boundary, n_zero, modes, of_digits, ..found })
    }

    /// Modes with the interface held; none where there is no interior.
    ///
    /// # Errors
    /// The eigensolver fails; the count falls on an eigenvalue.
    pub(super) fn held(interior: Option<&Interior<'_>>, partition: &Partition, job: &ReductionJob) -> Result<Self> {
        let Some(interior) = interior else {
            return Ok(Self::none(partition, mode_wish(job.wanted(), partition)));
        };
        let problem = partition.held_problem();
        Self::of(problem, &Factored::new(&interior.factor, interior.sigma), job, partition)
    }

    fn of(
        problem: ModalProblem<'_>,
        operator: &dyn ShiftInvert,
        job: &ReductionJob,
        partition: &Partition,
    ) -> Result<Self> {
        let wanted = mode_wish(job.wanted(), partition);
        let by = |eigensolver: Eigensolver| {
            elastic_modes(problem, operator, ModeRequest { wanted, eigensolver, seed: SEED })
        };
        let (modes, other_failed) = match by(other_than(job.eigensolver)) {
            // From other start vectors and another factor the eigensolver of the job is a witness too.
            Err(error @ (Error::Arpack { .. } | Error::LanczosStalled { .. })) => {
                (by(job.eigensolver)?, Some(error.to_string()))
            }
            found => (found?, None),
        };
        let sigma = operator.shift();
        let lacking = lacking(problem, operator, &modes);
        let groups = clusters(&modes, sigma);
        let angles = angles(&modes, sigma, (&lacking, &groups));
        let turns_inside = turns_inside(&modes, (&lacking, &groups));
        let residual_bars = residual_bars(&modes, sigma, (&with_products(&lacking, &modes, sigma), &groups));
        let boundary = Boundary::FixedInterface;
        let of_digits = if partition.has_few_digits() { partition.precision.stiffness.share } else { 0.0 };
        Ok(Self {
            boundary,
            modes,
            angles,
            turns_inside,
            residual_bars,
            groups,
            wanted,
            n_zero: 0,
            count: None,
            other_failed,
            of_digits,
        })
    }

    /// Counts the eigenvalues below a shift above the modes, by the inertia of the whole matrix.
    ///
    /// # Errors
    /// The shift falls on an eigenvalue; no memory.
    pub(super) fn counted(self, partition: &Partition, analysis: &Analysis, first: f64) -> Result<Self> {
        let pencil = partition.pencil_under(self.boundary);
        let is_bare = self.modes.lambda.is_empty() && self.modes.next.is_none();
        let sigma = if is_bare { PLACE * first } else { self.modes.shift_above(PLACE) };
        Ok(Self { count: Some(whole_count(analysis, pencil, sigma)?), ..self })
    }

    /// What to say where the other eigensolver failed.
    pub(super) fn note(&self) -> Option<String> {
        let error = self.other_failed.as_ref()?;
        // The advice is for those who chose the eigensolver.
        let what = error.split(" – ").next().unwrap_or(error);
        Some(format!("{what}; the modes were found again by the eigensolver of the job, from other start vectors"))
    }

    /// All of it but the shapes, which are the largest part.
    pub(super) fn without_shapes(self) -> Self {
        let modes = Modes { shapes: Mat::zeros(0, 0), ..self.modes };
        Self { modes, ..self }
    }

    /// Its eigenvalues with their error bars.
    pub(super) fn known(&self) -> impl Iterator<Item = Known> + '_ {
        let bars = self.modes.errors.iter().zip(&self.modes.lambda);
        bars.map(|(error, lambda)| Known { lambda: *lambda, relative_bar: error.relative_bar })
    }

    pub(super) fn lambda(&self) -> &[f64] {
        &self.modes.lambda
    }

    /// The numbers of modes that answer the request; more than one where rounding decides on a mode at its edge.
    pub(super) fn n_asked(&self) -> Range<usize> {
        let by_gap = |gap: f64, side: f64| {
            let all: Vec<f64> = self.modes.lambda.iter().copied().chain(self.modes.next).collect();
            let mut n = match self.wanted {
                Wanted::Count(count) => count.min(all.len()),
                Wanted::UpTo(limit) => all.iter().take_while(|lambda| **lambda <= limit * (1.0 + gap)).count(),
            };
            // Two searches tell a gap apart as well as they know the eigenvalues on both sides of it.
            let is_one = |n: usize| all[n] - all[n - 1] <= (gap + side * self.doubt_of_gap(n)) * all[n];
            while n > 0 && n < all.len() && is_one(n) {
                n += 1;
            }
            n.min(self.modes.count())
        };
        by_gap(CLUSTER_GAP * (1.0 - EDGE), -1.0)..by_gap(CLUSTER_GAP * (1.0 + EDGE), 1.0) + 1
    }

    /// What rounding and residuals, mine and those of the file, leave open of the relative gap below a mode. Digits that the data lack move
    /// the eigenvalues of both alike.
    fn doubt_of_gap(&self, mode: usize) -> f64 {
        let of_mode = |mode: usize| {
            let error = self.modes.errors[mode];
            2.0 * f64::EPSILON * error.cancellation + error.residual_bar + self.residual_bars[mode]
        };
        // The one beyond the last is known by its neighbour.
        of_mode(mode - 1) + of_mode(mode.min(self.modes.count() - 1))
    }

    /// M-01: the modes found are modes.
    pub(super) fn backward_error(&self) -> Check {
        let mut worst = (0.0, None);
        for (mode, error) in self.modes.errors.iter().enumerate() {
            if dense::worse(error.backward, worst.0) {
                worst = (error.backward, Some(format!("mode {}", mode + 1)));
            }
        }
        let limits = Limits { engineering: 1e-10, arithmetic: 0.0, data: self.of_digits }.capped(0.0, MAX_EXCUSE);
        Check {
            id: "M-01",
            name: "modes found again satisfy the full model",
            equation: "max ‖Kx − λMx‖ / ((‖K‖ + λ‖M‖) ‖x‖), equilibrated",
            value: worst.0,
            limits,
            fail_above: limits.data.max(1e-7),
            worst: worst.1,
        }
    }

    /// M-06: the inertia of the whole matrix counts as many modes as were found again.
    pub(super) fn count(&self) -> Option<Check> {
        let count = self.count.as_ref()?;
        let expected = self.modes.count() + self.n_zero;
        Some(Check {
            id: "M-06",
            name: "modes found again are all there are",
            equation: "|eigenvalues below σ − modes|, by the inertia of the whole K − σM at another shift",
            value: count.below.abs_diff(expected) as f64,
            limits: Limits::default(),
            fail_above: 0.0,
            worst: Some(format!("counted {}, found {expected}, pivot growth {:.1}", count.below, count.growth)),
        })
    }
}

fn other_than(eigensolver: Eigensolver) -> Eigensolver {
    match eigensolver {
        Eigensolver::Lanczos if cfg!(feature = "arpack") => Eigensolver::Arpack,
        Eigensolver::Lanczos | Eigensolver::Arpack => Eigensolver::Lanczos,
    }
}

/// Σ fᵀ(K − σM)⁻¹f / |σ| of the forces f = Kq − (qᵀKq) Mq that K makes of motions q that it should let pass.
///
/// (K − σM)⁻¹ without them is the inverse of K − σM without them but for c cᵀ/|σ|, c their coupling with all others: so much of θ,
/// relatively, is another operator's.
fn pull(problem: ModalProblem<'_>, operator: &dyn ShiftInvert, rigid: &RigidBodyModes) -> f64 {
    let motions = rigid.orthonormal.as_ref();
    let mut forces = product(problem.stiffness, motions);
    let energies = dense::gram(motions, forces.as_ref());
    dense::add_product(forces.as_mut(), -1.0, rigid.mass_orthonormal.as_ref(), energies.as_ref());
    operator.compliances(forces.as_ref()).into_iter().sum::<f64>().max(0.0) / operator.shift().abs()
}

/// Runs of modes that are one cluster. Their shapes turn under rounding, and are compared as one space; what that may hide in K̂_ηη
/// is less than the difference of their eigenvalues.
fn clusters(modes: &Modes, sigma: f64) -> Vec<Range<usize>> {
    let lambda = &modes.lambda;
    let mut groups = Vec::new();
    let mut start = 0;
    for end in 1..=lambda.len() {
        if end == lambda.len() || lambda[end] - lambda[end - 1] > CLUSTER_GAP * (lambda[end] - sigma) {
            groups.push(start..end);
            start = end;
        }
    }
    groups
}

/// The relative distance γ of the θ = 1/(λ − σ) of a group to all others.
fn gap_of(modes: &Modes, sigma: f64, group: &Range<usize>) -> f64 {
    let lambda = &modes.lambda;
    let (low, high) = (lambda[group.start] - sigma, lambda[group.end - 1] - sigma);
    let below = group.start.checked_sub(1).map(|j| (low / (lambda[j] - sigma) - 1.0).abs());
    let above = lambda.get(group.end).copied().or(modes.next).map(|next| (high / (next - sigma) - 1.0).abs());
    below.into_iter().chain(above).fold(1.0, f64::min)
}

/// δ/γ: what a shape lacks in θ, relatively, over the distance of its group (Davis and Kahan 1970).
fn angles(modes: &Modes, sigma: f64, (lacking, groups): (&[f64], &[Range<usize>])) -> Vec<f64> {
    let of_group = |group: &Range<usize>| {
        let gap = gap_of(modes, sigma, group);
        group.clone().map(move |j| (lacking[j] / gap).min(1.0))
    };
    groups.iter().flat_map(of_group).collect()
}

/// δ over the distance to the nearest other eigenvalue of the group. Modes of one eigenvalue are in the basis that their space defines.
fn turns_inside(modes: &Modes, (lacking, groups): (&[f64], &[Range<usize>])) -> Vec<f64> {
    let lambda = &modes.lambda;
    let of_mode = |group: &Range<usize>, j: usize| {
        let distances = group.clone().map(|other| (lambda[other] / lambda[j] - 1.0).abs());
        let nearest = distances.filter(|distance| *distance > 0.0).fold(f64::INFINITY, f64::min);
        (lacking[j] / nearest).min(1.0)
    };
    groups.iter().flat_map(|group| group.clone().map(|j| of_mode(group, j))).collect()
}

/// δ of each mode with what rounding of products leaves of it in a reduction: an eigensolver takes a pair at 16 ε of the largest terms and of
/// the largest θ.
fn with_products(lacking: &[f64], modes: &Modes, sigma: f64) -> Vec<f64> {
    let floor = RESIDUAL_FLOOR * f64::EPSILON * modes.largest_cancellation();
    let of_products = |lambda: &f64| floor * (lambda - sigma) / (modes.lambda[0] - sigma);
    lacking.iter().zip(&modes.lambda).map(|(lacking, lambda)| lacking.max(of_products(lambda))).collect()
}

/// What a residual leaves of λ in doubt: by Kato and Temple Σδ²/γ of a cluster, δ at most (see the error bars of the modes).
fn residual_bars(modes: &Modes, sigma: f64, (lacking, groups): (&[f64], &[Range<usize>])) -> Vec<f64> {
    let of_cluster = |cluster: &Range<usize>| {
        let sum: f64 = lacking[cluster.clone()].iter().map(|lacking| lacking * lacking).sum();
        let gap = gap_of(modes, sigma, cluster);
        cluster.clone().map(move |_| sum.sqrt().min(sum / gap))
    };
    groups.iter().flat_map(of_cluster).collect()
}

/// δ of each mode: with r the residual, δ² = rᵀ(K − σM)⁻¹r/(λ − σ) is what a shape lacks in θ = 1/(λ − σ), relatively; and what
/// the reduction leaves of its own at most.
fn lacking(problem: ModalProblem<'_>, operator: &dyn ShiftInvert, modes: &Modes) -> Vec<f64> {
    let sigma = operator.shift();
    let mut lacking = Vec::with_capacity(modes.count());
    for columns in panels(modes.count()) {
        let x = modes.shapes.as_ref().get(.., columns.clone());
        let mut r = product(problem.stiffness, x);
        let momenta = product(problem.mass, x);
        for (at, j) in columns.clone().enumerate() {
            let momentum = dense::column(momenta.as_ref(), at);
            dense::add_scaled(dense::column_mut(r.as_mut(), at), -modes.lambda[j], momentum);
        }
        let [q, mass_q] = problem.deflated;
        let resultant = dense::gram(q, r.as_ref());
        dense::add_product(r.as_mut(), -1.0, mass_q, resultant.as_ref());
        let mut y: Mat<f64> = r.clone();
        operator.solve_in_place(y.as_mut());
        for (j, energy) in columns.zip(dense::dots(r.as_ref(), y.as_ref())) {
            let distance = modes.lambda[j] - sigma;
            let floor = RESIDUAL_FLOOR * f64::EPSILON * distance / (modes.lambda[0] - sigma);
            lacking.push((energy.max(0.0) / distance).sqrt() + RESIDUAL_OF_REDUCTION.max(floor));
        }
    }
    lacking
}
