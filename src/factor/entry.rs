//! How the entries of a factor are kept.

use crate::cache::Number;

/// A number as it is kept in a factor: in double precision, or rounded to single. Elimination and solves compute in double
/// precision either way.
pub(super) trait Entry: Number + Default + Send + Sync + Into<f64> + std::fmt::Debug {
    /// The number nearest to a double.
    fn of(value: f64) -> Self;
}

impl Entry for f64 {
    fn of(value: f64) -> Self {
        value
    }
}

impl Entry for f32 {
    fn of(value: f64) -> Self {
        value as f32
    }
}
