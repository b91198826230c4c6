//! Shapes by themselves and among each other.

use super::subject::{OfPair, Subject, worst};
use crate::certification::angles::Angle;
use crate::certification::pair::PairKind;
use crate::certification::rounding::of_rounding;
use crate::certification::strayed;
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::mass_orthogonality;
use crate::number::quantity;
use crate::sparse::product;
use crate::verification::check::{Check, Limits};

/// The most of two shapes in each other that their digits excuse: a hundredth of the mass or the energy of one.
const MOST_EXCUSED: f64 = 1e-1;

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
        let shapes = dense::columns(self.claims.shapes.as_ref(), &modes);
        let found = mass_orthogonality(&self.component.partition.mass, shapes.as_ref());
        let (a, b) = found.pair;
        let limits = Limits {
            engineering: 1e-6,
            arithmetic: NOISE_FACTOR * f64::EPSILON * found.largest_terms,
            data: self.of_digits_of(&modes) * found.largest_terms,
        };
        let excused = limits.capped(0.0, self.most_excused(&modes));
        let limits = limits.capped(1e-6, 1e-3);
        (modes.len() > 1).then(|| Check {
            id: "M-03",
            name: "modes are orthogonal in the mass",
            equation: "max |XᵀMX − I|, each shape at unit modal mass",
            value: found.error,
            limits,
            fail_above: limits.value().max(1e-2).max(excused.data),
            worst: Some(format!("{} and {}", self.name(modes[a]), self.name(modes[b]))),
        })
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
        let mut found = (0.0, (0, 0));
        for j in 0..modes.len() {
            for i in 0..j {
                if dense::worse(coupling(i, j), found.0) {
                    found = (coupling(i, j), (i, j));
                }
            }
        }
        let cancellation = modes.iter().map(|claim| self.measured.errors[*claim].cancellation).fold(0.0, f64::max);
        let limits = Limits {
            engineering: 1e-4,
            arithmetic: NOISE_FACTOR * f64::EPSILON * cancellation,
            data: self.of_digits_of(&modes) * cancellation,
        };
        let excused = limits.capped(0.0, self.most_excused(&modes));
        let limits = limits.capped(1e-3, 1e-2);
        let (value, (a, b)) = found;
        (modes.len() > 1).then(|| Check {
            id: "M-04",
            name: "modes are orthogonal in the stiffness",
            equation: "max |x_iᵀKx_j| / √(λ_i λ_j), i ≠ j",
            value,
            limits,
            fail_above: limits.value().max(3e-2).max(excused.data),
            worst: Some(format!("{} and {}", self.name(modes[a]), self.name(modes[b]))),
        })
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
