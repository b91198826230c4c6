//! The largest error of one kind with its limit: M-29 to M-31, M-34.

use serde::Serialize;

use crate::number::{no_less_than, quantity, scientific};
use crate::verification::check::{Check, Limits};

/// A relative error from which on it is told in per cent.
const SEEN: f64 = 1e-5;

/// The largest error of one kind with its limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Accuracy {
    /// What was measured.
    pub measure: AccuracyMeasure,
    /// The largest error, relative or in dB; none where it was not measured.
    pub error: Option<f64>,
    /// What it is compared with; none where nobody asks.
    pub limit: Option<f64>,
    /// Who says so.
    pub set_by: LimitSource,
    /// Where the error is largest, or why it was not measured.
    pub at: Option<String>,
    /// Up to where the limit is met and what would meet it, where it is exceeded.
    pub advice: Option<String>,
}

/// What an error is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AccuracyMeasure {
    /// Frequencies in the band, relative.
    Frequency,
    /// The frequency response in the band, in dB.
    Response,
    /// Internal loads in the band, relative.
    #[serde(rename = "internal_load")]
    InternalLoad,
    /// Static stiffness of the interfaces and static answers to loads, relative.
    Static,
}

/// Who sets a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum LimitSource {
    /// `scene.accept` of the job: past it the reduction fails.
    Scene,
    /// Practice, where the scene says nothing: past it there is a warning.
    Practice,
}

impl Accuracy {
    /// An error that was not measured, and why not.
    pub(super) fn unmeasured(
        measure: AccuracyMeasure,
        (limit, set_by): (Option<f64>, LimitSource),
        at: Option<String>,
    ) -> Self {
        Self { measure, error: None, limit, set_by, at, advice: None }
    }

    /// Whether the error is within its limit. What was not measured meets no limit of the scene, and has none of practice.
    pub fn is_met(&self) -> bool {
        match (self.error, self.limit) {
            (_, None) => true,
            (Some(error), Some(limit)) => error <= limit,
            (None, Some(_)) => self.set_by == LimitSource::Practice,
        }
    }

    /// An error or a limit of this measure in its unit.
    pub fn in_words(&self, value: f64) -> String {
        match self.measure {
            AccuracyMeasure::Response => format!("{} dB", quantity(value, 2)),
            _ if value >= SEEN => format!("{} %", quantity(100.0 * value, 2)),
            _ => scientific(value, 1),
        }
    }

    /// An error of this measure in its unit, rounded up.
    pub fn at_least_in_words(&self, error: f64) -> String {
        let digits = if self.measure == AccuracyMeasure::Response || error >= SEEN { 2 } else { 1 };
        self.in_words(no_less_than(error, digits))
    }

    /// M-29 to M-31 and M-34, where the scene sets the limit.
    pub(crate) fn check(&self) -> Option<Check> {
        let limit = self.limit.filter(|_| self.set_by == LimitSource::Scene)?;
        let (id, name, equation) = match self.measure {
            AccuracyMeasure::Frequency => (
                "M-29",
                "frequencies within what the scene accepts",
                "max |f̂ − f| / f over boundaries and frequencies in the band",
            ),
            AccuracyMeasure::Response => (
                "M-30",
                "response within what the scene accepts",
                "max |20 log₁₀ |Ĥ/H||, 20 log₁₀(1 + |Ĥ − H|/|H|) in dB over pairs of dofs and the band",
            ),
            AccuracyMeasure::InternalLoad => (
                "M-34",
                "internal loads within what the scene accepts",
                "max ‖û − u‖_K / ‖u‖_K of the answer to a unit force on an interface dof, over the band",
            ),
            AccuracyMeasure::Static => (
                "M-31",
                "statics within what the scene accepts",
                "max of |K_full − K_reduced|_ij / √(K_ii K_jj) of an interface and ‖u − û‖_K / ‖u‖_K of a load",
            ),
        };
        let at = match self.error {
            Some(_) => self.at.clone(),
            None => Some(format!("not measured: {}", self.at.as_deref().unwrap_or("the comparison was not made"))),
        };
        let worst = [at, self.advice.clone()].into_iter().flatten().collect::<Vec<_>>().join(" – ");
        Some(Check {
            id,
            name,
            equation,
            value: self.error.unwrap_or(f64::NAN),
            limits: Limits { engineering: limit, ..Limits::default() },
            fail_above: Check::AT_LIMIT,
            worst: Some(worst),
        })
    }
}
