//! How a supernode of a factor is kept: in panels of a few columns, row by row.
//!
//! ```text
//! trapezoid   rows × size: L_11 on top, L_21 below
//! panel       columns c to c + N, rows from c on; the N entries of a row are neighbours
//! N           8, and 4, 2, 1 for what is left of the columns
//! ```
//! A solve reads a panel from end to end and asks for the next one meanwhile: one stream of memory instead of many short ones. Eight
//! right-hand sides and a factor of 300 MB take 25 ms on two threads; stored by columns they took 38, asking ahead 31. The upper
//! triangle of the panels on the diagonal is not stored, a seventh of the memory.

use std::ops::Range;

use faer::MatRef;
use rayon::prelude::*;

use super::entry::Entry;
use crate::dense;

/// Columns of most panels.
const WIDEST: usize = 8;
/// Entries of a trapezoid above which several threads clear it and make its panels: a millisecond of one.
pub(super) const PARALLEL_ABOVE: usize = 1 << 20;

/// The shape of a supernode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shape {
    /// Rows of the trapezoid.
    pub(super) rows: usize,
    /// Columns.
    pub(super) size: usize,
}

/// Where a panel is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Panel {
    /// Its first column, and its first row.
    pub(super) first: usize,
    /// Columns.
    pub(super) width: usize,
    /// Its place among the entries of the supernode.
    at: usize,
}

impl Shape {
    /// From the first columns to the last.
    pub(super) fn panels(self) -> impl DoubleEndedIterator<Item = Panel> {
        let n_panels = self.size / WIDEST + (self.size % WIDEST).count_ones() as usize;
        (0..n_panels).map(move |number| self.panel(number))
    }

    fn panel(self, number: usize) -> Panel {
        let n_widest = number.min(self.size / WIDEST);
        let mut panel = Panel {
            first: n_widest * WIDEST,
            width: WIDEST,
            // Panel q has WIDEST (rows − q WIDEST) entries.
            at: WIDEST * (n_widest * self.rows - WIDEST * (n_widest * n_widest.saturating_sub(1) / 2)),
        };
        let width_from = |first: usize| WIDEST.min(1 << (self.size - first).ilog2());
        panel.width = width_from(panel.first);
        for _ in n_widest..number {
            panel.at += self.n_values_of(panel);
            panel.first += panel.width;
            panel.width = width_from(panel.first);
        }
        panel
    }

    fn n_values_of(self, panel: Panel) -> usize {
        panel.width * (self.rows - panel.first)
    }

    /// Entries, with those above the diagonal of each panel.
    pub(super) fn n_values(self) -> usize {
        self.panels().map(|panel| self.n_values_of(panel)).sum()
    }
}

/// The panels of a supernode.
#[derive(Clone, Copy, Debug)]
pub(super) struct Panels<'a, T> {
    shape: Shape,
    values: &'a [T],
}

impl<'a, T: Entry> Panels<'a, T> {
    pub(super) fn new(shape: Shape, values: &'a [T]) -> Self {
        Self { shape, values }
    }

    pub(super) fn shape(&self) -> Shape {
        self.shape
    }

    /// Some rows of a panel, counted from the top of the trapezoid.
    #[inline(always)]
    pub(super) fn rows(&self, panel: Panel, rows: Range<usize>) -> &'a [T] {
        let row = |row: usize| panel.at + (row - panel.first) * panel.width;
        &self.values[row(rows.start)..row(rows.end)]
    }

    /// These rows of a panel, and what another panel, which is read next, holds of them and after.
    #[inline(always)]
    pub(super) fn rows_and_next(&self, panel: Panel, rows: Range<usize>, next: Option<Panel>) -> [&'a [T]; 2] {
        let after = |next: Panel| &self.values[next.at + (rows.start - next.first) * next.width..];
        [self.rows(panel, rows.clone()), next.map_or(&[], after)]
    }

    /// Row, column and value of all entries on and below the diagonal, by panels.
    pub(super) fn visit(&self, mut with: impl FnMut(usize, usize, f64)) {
        for panel in self.shape.panels() {
            let rows = self.rows(panel, panel.first..self.shape.rows).chunks_exact(panel.width);
            for (i, row) in rows.enumerate() {
                for (k, value) in row.iter().enumerate().take(i + 1) {
                    with(panel.first + i, panel.first + k, (*value).into());
                }
            }
        }
    }
}

/// Makes panels of a trapezoid stored by columns.
pub(super) fn pack<T: Entry>(trapezoid: MatRef<'_, f64>, mut values: &mut [T]) {
    let shape = Shape { rows: trapezoid.nrows(), size: trapezoid.ncols() };
    let mut split =
        |panel: Panel| (panel, values.split_off_mut(..shape.n_values_of(panel)).expect("room for all panels"));
    let fill = |(panel, values): (Panel, &mut [T])| fill(trapezoid, panel, values);
    if shape.rows * shape.size > PARALLEL_ABOVE {
        shape.panels().map(split).collect::<Vec<_>>().into_par_iter().for_each(fill);
    } else {
        shape.panels().for_each(|panel| fill(split(panel)));
    }
}

fn fill<T: Entry>(trapezoid: MatRef<'_, f64>, panel: Panel, values: &mut [T]) {
    for k in 0..panel.width {
        let column = &dense::column(trapezoid, panel.first + k)[panel.first..];
        for (entry, value) in values[k..].iter_mut().step_by(panel.width).zip(column) {
            *entry = T::of(*value);
        }
    }
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::*;

    /// Every width, none, and a trapezoid that several threads take apart.
    #[test]
    fn panels_hold_the_lower_trapezoid() {
        let shapes = [(1, 1), (5, 0), (3, 3), (40, 7), (17, 8), (31, 15), (29, 22), (2100, 520)];
        for (rows, size) in shapes {
            let trapezoid = Mat::from_fn(rows, size, |i, j| (i * 1000 + j) as f64);
            let shape = Shape { rows, size };
            let mut values = vec![f64::NAN; shape.n_values()];
            pack(trapezoid.as_ref(), &mut values);
            assert!(shape.n_values() <= rows * size);
            assert_eq!(shape.panels().map(|panel| panel.width).sum::<usize>(), size);
            let mut n_seen = 0;
            Panels::new(shape, &values).visit(|i, j, value| {
                assert_eq!(value, trapezoid[(i, j)], "entry {i}, {j} of {rows} by {size}");
                assert!(i >= j);
                n_seen += 1;
            });
            assert_eq!(n_seen, rows * size - size * size.saturating_sub(1) / 2, "{rows} by {size}");
        }
    }

    #[test]
    fn a_row_of_a_panel_is_contiguous() {
        let trapezoid = Mat::from_fn(20, 11, |i, j| (100 * i + j) as f64);
        let shape = Shape { rows: 20, size: 11 };
        let mut values = vec![0.0_f32; shape.n_values()];
        pack(trapezoid.as_ref(), &mut values);
        let panels = Panels::new(shape, &values);
        let second = panels.shape().panels().rev().nth(1).expect("8, 2 and 1 columns");
        assert_eq!((second.first, second.width), (8, 2));
        assert_eq!(panels.rows(second, 12..14), [1208.0, 1209.0, 1308.0, 1309.0]);
    }
}
