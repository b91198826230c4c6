//! Shapes by themselves and among each other.

use super::subject::{OfPair, Subject, worst};
use crate::certification::angles::Angle;
use crate::certification::pair::PairKind;
use crate::certification::rounding::of_rounding;
use crate::certification::strayed;
use crate::dense::{self, NOISE_FACTOR};
use crate::number::quantity;
use crate::sparse::{absolute_energy, product};
use crate::verification::check::{Check, Limits};

/// The most of two shapes in each other that their digits excuse: a hundredth of the mass or the energy of one.
const MOST_EXCUSED: f64 = 1e-1;

/// Two shapes that have something of each other.
struct Coupled {
    value: f64,
    pair: [usize; 2],
    are_rigid: bool,
}

impl Subject<'_> {
    /// M-01, with the quotient of each shape: whether the result states another frequency is a matter of C-01.
    pub(super) fn backward_error(&self) -> Check {
        /// The most that digits excuse without a warning, and at all.
        const MOST_EXCUSED: [f64; 2] = [1e-5, 1e-3];
        let inside = self.of_kinds(&[PairKind::Mode, PairKind::Inexact, PairKind::RigidBody, PairKind::Invented]);
        let found = OfPair::worst(inside.into_iter().map(|claim| {
            let data = self.of_digits(claim) + self.component.partition.precision.share();
            let limits = Limits { engineering: 1e-9, arithmetic: 0.0, data }.capped(0.0, MOST_EXCUSED[0]);
            // ‖(K − ρM) δx‖ is within the rounding of the numbers; as much again covers the quotient that follows from them.
            let of_rounding = if self.judged.is_rounded[claim] { 2.0 * self.claims.shape_rounding[claim] } else { 0.0 };
            let fail_above = limits.value().max(1e-6).max(data.min(MOST_EXCUSED[1])).max(of_rounding);
            OfPair { claim, value: self.measured.backward[claim], limits, fail_above }
        }));
        let nothing = Limits { engineering: 1e-9, ..Limits::default() };
        Check {
            id: "M-01",
            name: "modes satisfy the full model",
            equation: "max ‖Kx − ρMx‖ / ((‖K‖ + ρ‖M‖) ‖x‖), ρ = xᵀKx / xᵀMx, equilibrated",
            value: found.map_or(0.0, |found| found.value),
            limits: found.map_or(nothing, |found| found.limits),
            fail_above: found.map_or(1e-6, |found| found.fail_above),
            worst: found
                .map(|found| format!("{}, {}", self.name(found.claim), self.judged.pairs[found.claim].worst_at)),
        }
    }

    /// M-03, of shapes of unit modal mass that are modes.
    pub(super) fn mass_orthogonality(&self) -> Option<Check> {
        let kinds = [PairKind::RigidBody, PairKind::Mode, PairKind::Inexact];
        let modes = self.of_kinds(&kinds);
        let (shapes, mass) = (dense::columns(self.claims.shapes.as_ref(), &modes), &self.component.partition.mass);
        let products = dense::gram(shapes.as_ref(), product(mass, shapes.as_ref()).as_ref());
        let largest_terms = dense::worst(absolute_energy(mass, shapes.as_ref()));
        let limits = Limits {
            engineering: 1e-6,
            arithmetic: NOISE_FACTOR * f64::EPSILON * largest_terms,
            data: self.of_digits_of(&modes) * largest_terms,
        };
        let excused = limits.capped(0.0, self.most_excused(&modes));
        let limits = limits.capped(1e-6, 1e-3);
        let coupling = |i: usize, j: usize| products[(i, j)].abs();
        let found = self.coupled(&modes, coupling, limits.value())?;
        Some(self.coupling(
            &found,
            Check {
                id: "M-03",
                name: "modes are orthogonal in the mass",
                equation: "max |x_iᵀMx_j|, i ≠ j, each shape at unit modal mass",
                value: 0.0,
                limits,
                fail_above: limits.value().max(1e-2).max(excused.data),
                worst: None,
            },
        ))
    }

    /// The check of two pairs. Any combinations of rigid-body motions are rigid-body modes, orthogonal or not: that is no
    /// failure. Of elastic modes an eigensolver has to make a basis.
    fn coupling(&self, Coupled { value, pair, are_rigid }: &Coupled, check: Check) -> Check {
        let [a, b] = pair.map(|claim| self.name(claim));
        let (what, fail_above) = match are_rigid {
            true => (", rigid-body modes all the same, and no basis with a diagonal mass", Check::NEVER),
            false => ("", check.fail_above),
        };
        Check { value: *value, fail_above, worst: Some(format!("{a} and {b}{what}")), ..check }
    }

    /// The two pairs that have most of each other; rigid-body modes only where no others have more than a limit lets pass.
    fn coupled(&self, modes: &[usize], coupling: impl Fn(usize, usize) -> f64, limit: f64) -> Option<Coupled> {
        let is_rigid = |claim: usize| self.judged.pairs[claim].kind == PairKind::RigidBody;
        let worst = |are_rigid: bool| {
            let mut worst: Option<Coupled> = None;
            for (j, claim) in modes.iter().enumerate() {
                for (i, other) in modes[..j].iter().enumerate() {
                    let value = coupling(i, j);
                    let is_asked = [other, claim].iter().all(|claim| is_rigid(**claim)) == are_rigid;
                    if is_asked && worst.as_ref().is_none_or(|worst| dense::worse(value, worst.value)) {
                        worst = Some(Coupled { value, pair: [*other, *claim], are_rigid });
                    }
                }
            }
            worst
        };
        let across = worst(false);
        let is_enough = across.as_ref().is_some_and(|across| dense::worse(across.value, limit));
        match worst(true) {
            Some(within) if !is_enough && across.as_ref().is_none_or(|across| within.value > across.value) => {
                Some(within)
            }
            _ => across,
        }
    }

    /// The most of two shapes in each other that digits excuse: all where every shape is a mode but for its rounding.
    fn most_excused(&self, modes: &[usize]) -> f64 {
        if modes.iter().all(|claim| self.judged.is_rounded[*claim]) { 1.0 } else { MOST_EXCUSED }
    }

    /// M-04.
    pub(super) fn stiffness_orthogonality(&self) -> Option<Check> {
        let modes = self.elastic();
        let shapes = dense::columns(self.claims.shapes.as_ref(), &modes);
        let forces = product(&self.component.partition.stiffness, shapes.as_ref());
        let energies = dense::gram(shapes.as_ref(), forces.as_ref());
        let coupling = |i: usize, j: usize| {
            energies[(i, j)].abs() / (self.measured.lambda[modes[i]] * self.measured.lambda[modes[j]]).abs().sqrt()
        };
        let cancellation = modes.iter().map(|claim| self.measured.errors[*claim].cancellation).fold(0.0, f64::max);
        let limits = Limits {
            engineering: 1e-4,
            arithmetic: NOISE_FACTOR * f64::EPSILON * cancellation,
            data: self.of_digits_of(&modes) * cancellation,
        };
        let excused = limits.capped(0.0, self.most_excused(&modes));
        let limits = limits.capped(1e-3, 1e-2);
        let found = self.coupled(&modes, coupling, limits.value())?;
        Some(self.coupling(
            &found,
            Check {
                id: "M-04",
                name: "modes are orthogonal in the stiffness",
                equation: "max |x_iᵀKx_j| / √(λ_i λ_j), i ≠ j",
                value: 0.0,
                limits,
                fail_above: limits.value().max(3e-2).max(excused.data),
                worst: None,
            },
        ))
    }

    /// M-08.
    pub(super) fn angles(&self) -> Option<Check> {
        let angle = |claim: usize| Some((claim, self.judged.angles[claim]?));
        let known = self.elastic().into_iter().filter_map(angle).map(|(claim, angle)| self.angle(claim, angle));
        let found = OfPair::worst(known.chain(self.elastic().into_iter().filter_map(|claim| self.of_others(claim))))?;
        Some(Check {
            id: "M-08",
            name: "shapes lie close to eigenvectors",
            equation: "max sin ∠(x, eigenvectors of its cluster) ≤ min(δ/γ, √(Σ a_k² (λ_k − σ)/(ρ − σ)) + δ_⊥/γ_⊥ √(1 + (δ/γ)²)), in the norm of \
                       K − σM",
            value: found.value,
            limits: found.limits,
            fail_above: found.fail_above,
            worst: Some(self.name(found.claim)),
        })
    }

    /// The angle of a pair, with what the digits of the shape make of it by the length of what they round.
    fn angle(&self, claim: usize, angle: Angle) -> OfPair {
        /// The most that digits excuse without a warning, and at all: a quarter of the energy of a shape.
        const MOST_EXCUSED: [f64; 2] = [1e-2, 0.5];
        let rounded = of_rounding(self.claims, self.measured, claim);
        let data = angle.per_rounding * rounded + self.component.partition.precision.share();
        let limits = Limits { engineering: 1e-3, arithmetic: 0.0, data };
        let [limits, excused] = MOST_EXCUSED.map(|most| limits.capped(0.0, most));
        // A sine is one at most: nothing is proved of a shape that is its mode but for rounding, and nothing is held against it.
        let of_rounding = if self.judged.is_rounded[claim] { 1.0 } else { 0.0 };
        OfPair { claim, value: angle.value, limits, fail_above: excused.data.max(1e-1).max(of_rounding) }
    }

    /// What a shape of few digits has of known modes in the norm of the mass, in which rounding is no larger than the digits say.
    fn of_others(&self, claim: usize) -> Option<OfPair> {
        let value = self.judged.of_others[claim].filter(|_| self.claims.shape_rounding[claim] > f64::EPSILON)?;
        let data = self.claims.rounded[claim];
        let limits = Limits { engineering: 1e-3, arithmetic: 0.0, data }.capped(0.0, 1e-2);
        Some(OfPair { claim, value, limits, fail_above: data.max(1e-1) })
    }

    /// C-06.
    pub(super) fn modal_masses(&self) -> Check {
        let masses = &self.claims.modal_masses;
        let (low, high) = masses.iter().fold((f64::INFINITY, 0.0f64), |(low, high), m| (low.min(*m), high.max(*m)));
        let (value, _) = worst(masses.iter().map(|mass| (mass - 1.0).abs()).enumerate());
        let said = if value <= 1e-6 {
            "mass-normalised".to_owned()
        } else {
            format!("from {} to {}: not mass-normalised", quantity(low, 4), quantity(high, 4))
        };
        // A length may be beyond what its square can be.
        let value = value.min(f64::MAX);
        Check {
            id: "C-06",
            name: "modal masses are one",
            equation: "max |xᵀMx − 1|, shapes as they are in the file",
            value,
            limits: Limits::NONE,
            fail_above: f64::INFINITY,
            worst: Some(said),
        }
    }

    /// C-10: the pairs that are modes, or should be.
    pub(super) fn rows_in_place(&self) -> Option<Check> {
        strayed::check(self.component.partition, &self.claims.strayed, |claim| self.name(claim))
    }
}
