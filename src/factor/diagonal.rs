//! The diagonal of the triangle of a supernode, and the order of its pivots.

use super::elimination::PANEL;
use super::entry::Entry;

/// The diagonal of the triangle.
#[derive(Clone, Copy)]
pub(super) enum Diagonal<'a> {
    /// As it is stored.
    OfTriangle,
    /// Ones; the columns of each panel in an order of their own.
    Ones { order: &'a [u32] },
}

impl Diagonal<'_> {
    /// The reciprocal of one of its entries, which is stored as `entry`.
    #[inline(always)]
    pub(super) fn inverse<T: Entry>(self, entry: T) -> f64 {
        match self {
            Self::OfTriangle => 1.0 / entry.into(),
            Self::Ones { .. } => 1.0,
        }
    }

    /// Puts the rows of the panel that begins at `start` in the order of its pivots.
    pub(super) fn permute<R: Copy>(self, start: usize, top: &mut [R]) {
        self.exchange(start, top, |rows, before, place, column| rows[place] = before[column]);
    }

    /// Undoes [`Diagonal::permute`].
    pub(super) fn restore<R: Copy>(self, start: usize, top: &mut [R]) {
        self.exchange(start, top, |rows, before, place, column| rows[column] = before[place]);
    }

    fn exchange<R: Copy>(self, start: usize, top: &mut [R], exchange: impl Fn(&mut [R], &[R], usize, usize)) {
        let Self::Ones { order } = self else { return };
        let end = top.len().min(start + PANEL);
        let rows = &mut top[start..end];
        let before = rows.to_vec();
        for (place, column) in order[start..end].iter().enumerate() {
            exchange(rows, &before, place, *column as usize);
        }
    }
}
