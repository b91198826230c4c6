//! What the numbers of modes may be off by, as their digits tell.

use super::digits::Digits;

/// Half a unit of the last digit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeRounding {
    /// Relative to each number; rounding of double precision where they have all digits.
    pub relative: f64,
    /// Whatever the number: half a unit of the last decimal of numbers in fixed point.
    pub absolute: f64,
}

impl ModeRounding {
    pub(super) fn of(digits: Digits) -> Self {
        let [relative, absolute] = digits.half_a_unit();
        Self { relative, absolute }
    }
}
