//! A check: a measured value, the limits it is judged by, and the verdict.
//!
//! Some measures have no limit that would be true of every model: they are shown, not judged.

use serde::Serialize;

/// The three sources a limit can come from; the largest one is active.
///
/// A figure from engineering practice may be out of reach of the arithmetic (ε·κ) or of the data (digits of the text).
/// The limit is then what can be attained, and the check says so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Limits {
    /// What practice asks.
    pub engineering: f64,
    /// What double precision can give for this model.
    pub arithmetic: f64,
    /// What the digits of the input can give.
    pub data: f64,
}

/// Which of the three limits was the largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ActiveLimit {
    /// Engineering practice.
    Engineering,
    /// Double precision.
    Arithmetic,
    /// Digits of the input.
    Data,
}

impl Limits {
    /// No limit: the value is shown, not judged.
    pub const NONE: Self = Self { engineering: f64::INFINITY, arithmetic: 0.0, data: 0.0 };

    /// These limits with what arithmetic and data may excuse capped.
    ///
    /// An excuse is computed from the results it excuses. Without a cap a bad result would loosen its own limit.
    pub fn capped(self, arithmetic: f64, data: f64) -> Self {
        // NaN never counts as an excuse.
        let cap = |value: f64, most: f64| if value.is_nan() { 0.0 } else { value.min(most) };
        Self { arithmetic: cap(self.arithmetic, arithmetic), data: cap(self.data, data), ..self }
    }

    /// The limit in force.
    pub fn value(&self) -> f64 {
        self.engineering.max(self.arithmetic).max(self.data)
    }

    /// The source of the limit in force.
    pub fn active(&self) -> ActiveLimit {
        if self.engineering >= self.arithmetic && self.engineering >= self.data {
            ActiveLimit::Engineering
        } else if self.arithmetic >= self.data {
            ActiveLimit::Arithmetic
        } else {
            ActiveLimit::Data
        }
    }
}

/// The most that arithmetic and data excuse of a relative measure. One part in a hundred is an error that anybody would see, and where rows
/// are exchanged residuals relative to their terms are of the order of one.
pub(crate) const MAX_EXCUSE: f64 = 1e-2;

/// How many times its limit a value is at least where a check fails.
const FAR_ABOVE: f64 = 2.0;

/// What a check says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Shown, not judged: there is no limit.
    Info,
    /// Within the limit.
    Pass,
    /// Past the limit, not past the point of failure.
    Warn,
    /// Past the point of failure.
    Fail,
}

/// One measure of the reduction.
///
/// A check without a limit ([`Limits::NONE`]) and with `fail_above` infinite only shows its value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// Stable identifier, `M-05`.
    pub id: &'static str,
    /// What is measured, in a structural engineer's words.
    pub name: &'static str,
    /// The equation of the paper or the definition.
    pub equation: &'static str,
    /// The measured value, not negative.
    pub value: f64,
    /// What it is judged by.
    pub limits: Limits,
    /// The figure of the check above which it fails, unless that is near its limit: [`Check::fails_above`].
    pub fail_above: f64,
    /// Where the value is worst: a mode, a node and direction, a column.
    pub worst: Option<String>,
}

impl Check {
    /// `fail_above` of a check that warns above its limit and never fails. It is finite, so that an infinite value does fail.
    pub const NEVER: f64 = f64::MAX;

    /// `fail_above` of a check that fails above its limit and never warns.
    pub const AT_LIMIT: f64 = f64::NEG_INFINITY;

    /// The verdict. NaN fails, and so does a value that only an infinite limit would let pass.
    pub fn verdict(&self) -> Verdict {
        if self.value.is_finite() && !self.is_judged() {
            Verdict::Info
        } else if self.limits.value().is_finite() && self.value <= self.limits.value() {
            Verdict::Pass
        } else if self.fail_above.is_finite() && self.value <= self.fails_above() {
            Verdict::Warn
        } else {
            Verdict::Fail
        }
    }

    /// Above this the check fails; between the limit and this it warns. Limits that arithmetic or data excuse may reach the figure at
    /// which a check fails, and a value just above them is no worse than one just below.
    pub fn fails_above(&self) -> f64 {
        if self.fail_above == Self::AT_LIMIT {
            return self.limits.value();
        }
        if self.is_judged() { self.fail_above.max(FAR_ABOVE * self.limits.value()) } else { self.fail_above }
    }

    /// False where there is no limit and the value is only shown.
    pub fn is_judged(&self) -> bool {
        self.limits.engineering.is_finite()
    }

    /// Limit over value: above one is good.
    pub fn margin(&self) -> f64 {
        // A value of nothing may be a negative zero.
        self.limits.value() / self.value.abs()
    }
}
