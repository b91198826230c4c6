//! Shapes by themselves and among each other.

use super::subject::{OfPair, Subject, worst};
use crate::certification::angles::Angle;
use crate::certification::judgement::of_rounding;
use crate::certification::pair::PairKind;
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
        let (value, at) = worst(inside.iter().map(|claim| (*claim, self.measured.backward[*claim])));
        let data = self.of_digits_of(&inside) + self.component.partition.precision.share();
        let limits = Limits { engineering: 1e-9, arithmetic: 0.0, data }.capped(0.0, MOST_EXCUSED[0]);
        Check {
            id: "M-01",
            name: "modes satisfy the full model",
            equation: "max ‖Kx − ρMx‖ / ((‖K‖ + ρ‖M‖) ‖x‖), ρ = xᵀKx / xᵀMx, equilibrated",
            value,
            limits,
            fail_above: limits.value().max(1e-6).max(data.min(MOST_EXCUSED[1])),
            worst: at.map(|claim| format!("{}, {}", self.name(claim), self.judged.pairs[claim].worst_at)),
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
        let excused = limits.capped(0.0, MOST_EXCUSED);
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
        let excused = limits.capped(0.0, MOST_EXCUSED);
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
        let known = self.elastic().into_iter().filter_map(angle).flat_map(|(claim, angle)| self.angle(claim, angle));
        let found = OfPair::worst(known)?;
        Some(Check {
            id: "M-08",
            name: "shapes lie close to eigenvectors",
            equation: "max sin ∠(x, eigenvectors of its cluster) ≤ δ/γ, in the norm of K − σM",
            value: found.value,
            limits: found.limits,
            fail_above: found.fail_above,
            worst: Some(self.name(found.claim)),
        })
    }

    /// The angle of a pair, and what it has of known modes by itself, each with what the digits of the shape make of it by the length of what
    /// they round.
    fn angle(&self, claim: usize, angle: Angle) -> [OfPair; 2] {
        /// The most that digits excuse without a warning, and at all: a quarter of the energy of a shape.
        const MOST_EXCUSED: [f64; 2] = [1e-2, 0.5];
        let rounded = of_rounding(self.claims, self.measured, claim);
        [(angle.value, angle.per_rounding), (angle.of_known, 1.0)].map(|(value, per_rounding)| {
            let data = per_rounding * rounded + self.component.partition.precision.share();
            let limits = Limits { engineering: 1e-3, arithmetic: 0.0, data };
            let [limits, excused] = MOST_EXCUSED.map(|most| limits.capped(0.0, most));
            OfPair { claim, value, limits, fail_above: excused.data.max(1e-1) }
        })
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
