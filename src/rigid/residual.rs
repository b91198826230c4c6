//! The force of motions without energy, next to what rounding makes of it.

use crate::dense;

/// Force of a motion relative to its terms that practice accepts: some fifty roundings. What it accepts needs no explanation.
pub(crate) const FORCE_ASKED: f64 = 1e-14;

/// The force of motions relative to its terms, ‖Kq‖ / ‖ |K||q| ‖, and what rounding makes of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Residual {
    pub(crate) value: f64,
    pub(crate) rounding: f64,
}

impl Residual {
    /// That of the motions of both: the larger one. A motion with more force than rounding makes of it is not excused by what rounding makes
    /// of another.
    pub(crate) fn and(self, other: Self) -> Self {
        let is_other = dense::worse(other.value, self.value);
        let larger = if is_other { other } else { self };
        let rounding = match (self.is_past(), other.is_past()) {
            (true, true) => self.rounding.min(other.rounding),
            (true, false) => self.rounding,
            (false, true) => other.rounding,
            (false, false) => larger.rounding,
        };
        Self { value: larger.value, rounding }
    }

    /// Whether rounding does not explain it.
    fn is_past(self) -> bool {
        dense::worse(self.value, self.rounding.max(FORCE_ASKED))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_past_its_own_rounding_is_not_excused_by_that_of_another() {
        let of = |value, rounding| Residual { value, rounding };
        // A motion that turns about distant coordinates, one that nothing excuses, and one that practice accepts.
        let (turning, held, free) = (of(1e-12, 1e-11), of(5e-13, 1e-15), of(5e-15, 0.0));
        assert_eq!(turning.and(free), turning);
        assert_eq!(free.and(turning), turning);
        assert_eq!(turning.and(held), of(1e-12, 1e-15));
        assert_eq!(held.and(turning).and(free), of(1e-12, 1e-15));
        assert!(turning.and(of(f64::NAN, 1.0)).value.is_nan());
    }
}
