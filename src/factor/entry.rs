//! How the entries of a factor are kept.

/// A number as it is kept in a factor: in double precision, or rounded to single. Elimination and solves compute in double
/// precision either way.
pub(super) trait Entry: Copy + Default + Send + Sync + Into<f64> + std::fmt::Debug + 'static {
    /// The number nearest to a double.
    fn of(value: f64) -> Self;

    /// Where doubles that are to become these entries are computed, and where they are then rounded to.
    fn room(entries: &mut [Self]) -> Room<'_, Self>;
}

/// What becomes of the memory of some entries.
pub(super) struct Room<'a, T> {
    /// They are computed in place; empty where they are not.
    pub(super) here: &'a mut [f64],
    /// They are rounded from doubles computed elsewhere; empty where they are not.
    pub(super) rounded: &'a mut [T],
}

impl Entry for f64 {
    fn of(value: f64) -> Self {
        value
    }

    fn room(entries: &mut [Self]) -> Room<'_, Self> {
        Room { here: entries, rounded: &mut [] }
    }
}

impl Entry for f32 {
    fn of(value: f64) -> Self {
        value as f32
    }

    fn room(entries: &mut [Self]) -> Room<'_, Self> {
        Room { here: &mut [], rounded: entries }
    }
}
