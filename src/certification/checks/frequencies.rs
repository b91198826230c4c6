//! Frequencies, and what digits and springs make of them.

use super::subject::{OfPair, Subject, worst};
use crate::certification::judgement::NOT_RIGID;
use crate::certification::pair::{Off, PairKind};
use crate::certification::rounding::{MOST_OF_DIGITS, of_digits_in_energy, of_digits_in_frequency};
use crate::eigen::NOTICED_BAR;
use crate::modes::Component;
use crate::number::{quantity, scientific};
use crate::verification::check::{Check, Limits};
use crate::verification::limits::{self, Known, LARGEST_EXPLAINED_ENERGY, UNKNOWN};

/// Relative difference of a frequency that digits excuse without a warning, and at all.
const WITHIN_DIGITS: [f64; 2] = [1e-3, 1e-2];

/// A frequency in six digits, or the few more in which it differs from another.
fn apart(hertz: f64, other: f64) -> String {
    let differs = |digits: &usize| quantity(hertz, *digits) != quantity(other, *digits);
    quantity(hertz, (6..=9).find(differs).unwrap_or(6))
}

/// λ of rigid-body motion relative to the first elastic mode that practice does not see: a thousandth of its frequency.
const RIGID_ENERGY: f64 = 1e-6;

impl Subject<'_> {
    /// M-05: the rigid-body modes of the model, not those of the result.
    pub(super) fn rigid_energy(&self) -> Option<Check> {
        let Component { partition, rigid, .. } = self.component;
        let first = self.completed.first_elastic?;
        let errors = self.completed.modes.errors.iter();
        let known = self.completed.modes.lambda.iter().zip(errors);
        let known = known.map(|(lambda, error)| Known { lambda: *lambda, relative_bar: error.data_bar });
        let precision = partition.precision.stiffness.share;
        let judged = limits::of_energy(
            limits::energy_noise((partition, rigid), known, first),
            precision / (f64::EPSILON + precision),
        );
        (rigid.count() > 0).then(|| Check {
            id: "M-05",
            name: "rigid-body motion costs no energy",
            equation: "max qᵀKq / λ of the first elastic mode",
            value: rigid.energy.largest_quotient / first,
            limits: judged.limits,
            fail_above: judged.fail_above,
            worst: None,
        })
    }

    /// M-09.
    pub(super) fn data_precision(&self) -> Option<Check> {
        let modes = self.elastic();
        let is_empty = modes.is_empty();
        let bars = modes.into_iter().map(|claim| (claim, 0.5 * self.measured.errors[claim].data_bar));
        let (value, at) = worst(bars);
        (!is_empty).then(|| Check {
            id: "M-09",
            name: "digits of the data suffice",
            equation: "max ½ (|xᵀEx| + ε_M λ|x|ᵀ|M||x|) / λ, E roundings of K: relative error bar of a frequency",
            value,
            limits: Limits { engineering: NOTICED_BAR, ..Limits::default() },
            fail_above: UNKNOWN,
            worst: at.map(|claim| self.name(claim)),
        })
    }

    /// C-01.
    pub(super) fn frequencies(&self) -> Option<Check> {
        let found = OfPair::worst(self.elastic().into_iter().map(|claim| self.frequency(claim)))?;
        Some(Check {
            id: "C-01",
            name: "frequencies are those of the full model",
            equation: "max |f − f_model| / f_model, with the error bar that the residual leaves",
            value: found.value,
            limits: found.limits,
            fail_above: found.fail_above,
            worst: Some(self.told_frequency(found.claim)),
        })
    }

    /// How far a frequency is off, and what is allowed of that by digits.
    fn frequency(&self, claim: usize) -> OfPair {
        let pair = &self.judged.pairs[claim];
        let mode = pair.mode_hz.unwrap_or(pair.shape_hz);
        let difference = pair.stated_hz.map_or(0.0, |stated| (stated / mode - 1.0).abs());
        // The frequency of a pair that is another mode than its quotient says is known without its own bar.
        let bar = match mode == pair.shape_hz {
            // Rounding is spread over modes far away: what it has of near ones is bounded, and moves the quotient by no more than δ².
            true if self.judged.is_rounded[claim] => {
                0.5 * self.judged.residual_bars[claim].min(self.measured.lacking[claim].powi(2))
            }
            true => 0.5 * self.judged.residual_bars[claim],
            false => 0.0,
        };
        // A shape that is a mode but for its rounding has the frequency of that, whatever its own quotient is.
        let own = if self.judged.is_rounded[claim] { 0.0 } else { (pair.shape_hz / mode - 1.0).abs() };
        // Rounding of λ is twice that of its root; of a frequency it is what it is, and that of a shape acts by its square. What the
        // matrices leave open is no fault of the result: M-09 judges it.
        let data = self.claims.value_rounding[claim]
            + self.judged.of_shapes[claim]
            + of_digits_in_frequency(self.measured, claim);
        let limits = Limits { engineering: NOTICED_BAR, arithmetic: 0.0, data };
        let [limits, excused] = WITHIN_DIGITS.map(|most| limits.capped(0.0, most));
        // What digits explain is no failure up to a hundredth: it warns.
        let fail_above = WITHIN_DIGITS[0].max(excused.data);
        OfPair { claim, value: difference.max(own) + bar, limits, fail_above }
    }

    fn told_frequency(&self, claim: usize) -> String {
        let (name, pair) = (self.name(claim), &self.judged.pairs[claim]);
        let (shape, stated) = (pair.shape_hz, pair.stated_hz.unwrap_or(pair.shape_hz));
        match (pair.off(), pair.mode_hz.filter(|mode| *mode != shape)) {
            (Some(Off::Shape(_)), Some(mode)) => {
                format!(
                    "{name}, whose shape has {} Hz and is mostly that of {} Hz",
                    apart(shape, mode),
                    apart(mode, shape)
                )
            }
            (_, Some(mode)) => format!("{name}, which is mostly that of {} Hz", apart(mode, stated)),
            (Some(Off::Residual), None) => {
                format!("{name}, whose shape has that within {} Hz by its residual", scientific(pair.error_bar_hz, 2))
            }
            (_, None) => format!("{name}, whose shape has {} Hz", apart(shape, stated)),
        }
    }

    /// C-05.
    pub(super) fn rigid_frequencies(&self) -> Option<Check> {
        let first = self.completed.first_elastic?;
        let is_rigid = |claim: &usize| self.judged.pairs[*claim].mode_hz == Some(0.0);
        let kinds = [PairKind::RigidBody, PairKind::Inexact];
        let rigid: Vec<usize> = self.of_kinds(&kinds).into_iter().filter(is_rigid).collect();
        let stated = |claim: usize| self.claims.lambda.as_ref().map_or(self.measured.lambda[claim], |all| all[claim]);
        let of_pair = |claim: usize| {
            let data = of_digits_in_energy(self.measured, claim, first);
            // What digits explain is no failure up to where they may explain the energy of K itself: it warns.
            let excused = data.min(LARGEST_EXPLAINED_ENERGY);
            let limits = Limits { engineering: RIGID_ENERGY, arithmetic: 0.0, data }.capped(0.0, MOST_OF_DIGITS);
            // Where nothing is stated, the energy of a rounded shape is that of its rounding.
            let is_unsaid = self.claims.lambda.is_none() && self.judged.is_rounded[claim];
            let value = if is_unsaid { 0.0 } else { stated(claim).abs() / first };
            OfPair { claim, value, limits, fail_above: NOT_RIGID.max(excused) }
        };
        let found = OfPair::worst(rigid.into_iter().map(of_pair))?;
        Some(Check {
            id: "C-05",
            name: "rigid-body modes have no frequency",
            equation: "max |λ| / λ of the first elastic mode",
            value: found.value,
            limits: found.limits,
            fail_above: found.fail_above,
            worst: Some(self.name(found.claim)),
        })
    }
}
