//! One supernode times blocks of right-hand sides, stored row by row.
//!
//! ```text
//! trapezoid   `size` columns: the triangle on top, rows below
//! X           n × W, row-major: the W numbers that an entry of L meets are neighbours in memory
//! ```
//! A solve reads L once down and once up and does 2·W multiplications with each entry, so for a narrow block it is bound
//! by memory traffic. Column-major right-hand sides would touch W cache lines for every row index; row-major ones touch
//! one. Columns of a supernode are taken four at a time, so that a row of X is loaded once for four entries.
//!
//! Every sum has a fixed order: the rows of a large supernode may be shared among threads, never the terms of a row.

use faer::MatRef;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::elimination::{Inverse, Kind, PANEL};
use super::multifrontal::Eliminated;

/// Columns of the triangle that are solved one by one before the rest is updated.
const STRIP: usize = 32;
/// Rows or columns of a supernode given to one task.
const CHUNK: usize = 128;
/// Entries of a trapezoid above which its rows are shared among threads: at a few nanoseconds an entry the work is then
/// ten times what starting a task costs.
const PARALLEL_ABOVE: usize = 1 << 16;

/// One row of a block of W right-hand sides.
pub(super) type Row<const W: usize> = [f64; W];

/// One supernode of a factor.
pub(super) struct Block<'a> {
    numbers: Eliminated<'a>,
    columns: Columns<'a>,
    kind: Kind,
}

impl<'a> Block<'a> {
    pub(super) fn new(numbers: Eliminated<'a>, kind: Kind) -> Self {
        Self { columns: Columns(numbers.trapezoid), numbers, kind }
    }

    /// L_11⁻¹ P on the rows of its columns, `top`; `update` becomes L_21 times the result.
    pub(super) fn forward<const W: usize>(&self, top: &mut [Row<W>], update: &mut Vec<Row<W>>) {
        let (columns, size) = (&self.columns, top.len());
        Kernel::Triangle { columns, diagonal: self.diagonal(), top: &mut *top }.run();
        update.clear();
        update.resize(self.numbers.trapezoid.nrows() - size, [0.0; W]);
        let top = &*top;
        for_chunks(size, update, |first, rows| {
            Kernel::Rows { columns, first: size + first, top, rows }.run();
        });
    }

    /// B⁻¹ on the rows of its columns.
    pub(super) fn divide<const W: usize>(&self, top: &mut [Row<W>]) {
        if self.kind == Kind::Definite {
            return;
        }
        let mut j = 0;
        while j < top.len() {
            match Inverse::of(self.numbers.diagonal, self.numbers.subdiagonal, j) {
                Inverse::One(inverse) => {
                    top[j].iter_mut().for_each(|x| *x *= inverse);
                    j += 1;
                }
                Inverse::Two(inverse) => {
                    for lane in 0..W {
                        [top[j][lane], top[j + 1][lane]] = inverse.times([top[j][lane], top[j + 1][lane]]);
                    }
                    j += 2;
                }
            }
        }
    }

    /// Pᵀ L_11⁻ᵀ (X − L_21ᵀ `below`) on the rows of its columns.
    pub(super) fn backward<const W: usize>(&self, top: &mut [Row<W>], below: &[Row<W>]) {
        let (columns, size) = (&self.columns, top.len());
        for_chunks(below.len(), top, |first, targets| {
            Kernel::Columns { columns, first, size, below, targets }.run();
        });
        Kernel::TransposedTriangle { columns, diagonal: self.diagonal(), top }.run();
    }

    fn diagonal(&self) -> Diagonal<'a> {
        match self.kind {
            Kind::Definite => Diagonal::OfTriangle,
            Kind::Indefinite => Diagonal::Ones { order: self.numbers.order },
        }
    }
}

/// The diagonal of the triangle.
#[derive(Clone, Copy)]
enum Diagonal<'a> {
    /// As it is stored.
    OfTriangle,
    /// Ones; the columns of each panel in an order of their own.
    Ones { order: &'a [u32] },
}

impl Diagonal<'_> {
    #[inline(always)]
    fn inverse(self, column: &[f64], j: usize) -> f64 {
        match self {
            Self::OfTriangle => 1.0 / column[j],
            Self::Ones { .. } => 1.0,
        }
    }

    /// Puts the rows of the panel that begins at `start` in the order of its pivots.
    fn permute<const W: usize>(self, start: usize, top: &mut [Row<W>]) {
        self.exchange(start, top, |rows, before, place, column| rows[place] = before[column]);
    }

    /// Undoes [`Diagonal::permute`].
    fn restore<const W: usize>(self, start: usize, top: &mut [Row<W>]) {
        self.exchange(start, top, |rows, before, place, column| rows[column] = before[place]);
    }

    fn exchange<const W: usize>(
        self,
        start: usize,
        top: &mut [Row<W>],
        exchange: impl Fn(&mut [Row<W>], &[Row<W>], usize, usize),
    ) {
        let Self::Ones { order } = self else { return };
        let end = top.len().min(start + PANEL);
        let rows = &mut top[start..end];
        let before = rows.to_vec();
        for (place, column) in order[start..end].iter().enumerate() {
            exchange(rows, &before, place, *column as usize);
        }
    }
}

/// Gives chunks of rows to tasks where the work (rows times `depth`) is worth it.
fn for_chunks<const W: usize>(depth: usize, rows: &mut [Row<W>], work: impl Fn(usize, &mut [Row<W>]) + Sync) {
    if depth * rows.len() > PARALLEL_ABOVE {
        rows.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, rows)| work(chunk * CHUNK, rows));
    } else {
        rows.chunks_mut(CHUNK).enumerate().for_each(|(chunk, rows)| work(chunk * CHUNK, rows));
    }
}

/// The four inner loops, compiled for the vector unit that the machine turns out to have.
enum Kernel<'a, const W: usize> {
    /// Solves the triangle on top.
    Triangle { columns: &'a Columns<'a>, diagonal: Diagonal<'a>, top: &'a mut [Row<W>] },
    /// Multiplies rows of the trapezoid with the solved top.
    Rows { columns: &'a Columns<'a>, first: usize, top: &'a [Row<W>], rows: &'a mut [Row<W>] },
    /// Takes the rows below into rows of the top.
    Columns { columns: &'a Columns<'a>, first: usize, size: usize, below: &'a [Row<W>], targets: &'a mut [Row<W>] },
    /// Solves the transposed triangle.
    TransposedTriangle { columns: &'a Columns<'a>, diagonal: Diagonal<'a>, top: &'a mut [Row<W>] },
}

impl<const W: usize> Kernel<'_, W> {
    fn run(self) {
        Arch::new().dispatch(self);
    }
}

impl<const W: usize> WithSimd for Kernel<'_, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        match self {
            Self::Triangle { columns, diagonal, top } => solve_triangle(columns, diagonal, top),
            Self::Rows { columns, first, top, rows } => accumulate_rows(columns, first, top, rows),
            Self::Columns { columns, first, size, below, targets } => {
                subtract_columns(columns, first, size, below, targets);
            }
            Self::TransposedTriangle { columns, diagonal, top } => {
                solve_transposed_triangle(columns, diagonal, top);
            }
        }
    }
}

/// The columns of a trapezoid.
struct Columns<'a>(MatRef<'a, f64>);

impl<'a> Columns<'a> {
    #[inline(always)]
    fn get(&self, j: usize) -> &'a [f64] {
        crate::dense::column(self.0, j)
    }
}

/// Solves the triangle strip by strip.
#[inline(always)]
fn solve_triangle<const W: usize>(columns: &Columns<'_>, diagonal: Diagonal<'_>, top: &mut [Row<W>]) {
    let size = top.len();
    for start in (0..size).step_by(STRIP) {
        if start % PANEL == 0 {
            diagonal.permute(start, top);
        }
        let end = (start + STRIP).min(size);
        for j in start..end {
            let column = columns.get(j);
            let inverse = diagonal.inverse(column, j);
            let pivot: Row<W> = std::array::from_fn(|lane| top[j][lane] * inverse);
            top[j] = pivot;
            for (row, entry) in top[j + 1..end].iter_mut().zip(&column[j + 1..end]) {
                subtract(row, *entry, &pivot);
            }
        }
        let (strip, rest) = top.split_at_mut(end);
        let strip = &strip[start..];
        let (quads, single) = (strip.len() / 4, strip.len() / 4 * 4);
        for quad in 0..quads {
            let at = 4 * quad;
            let [a, b, c, d]: [&[f64]; 4] = std::array::from_fn(|k| &columns.get(start + at + k)[end..size]);
            for ((((row, a), b), c), d) in rest.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                for lane in 0..W {
                    row[lane] -= a * strip[at][lane]
                        + b * strip[at + 1][lane]
                        + (c * strip[at + 2][lane] + d * strip[at + 3][lane]);
                }
            }
        }
        for (k, pivot) in strip.iter().enumerate().skip(single) {
            for (row, entry) in rest.iter_mut().zip(&columns.get(start + k)[end..size]) {
                subtract(row, *entry, pivot);
            }
        }
    }
}

/// Rows `first` .. of the trapezoid times the solved top, added to `rows`.
#[inline(always)]
fn accumulate_rows<const W: usize>(columns: &Columns<'_>, first: usize, top: &[Row<W>], rows: &mut [Row<W>]) {
    let range = first..first + rows.len();
    let (quads, rest) = top.as_chunks::<4>();
    for (quad, x) in quads.iter().enumerate() {
        let [a, b, c, d]: [&[f64]; 4] = std::array::from_fn(|k| &columns.get(4 * quad + k)[range.clone()]);
        for ((((row, a), b), c), d) in rows.iter_mut().zip(a).zip(b).zip(c).zip(d) {
            for lane in 0..W {
                row[lane] += a * x[0][lane] + b * x[1][lane] + (c * x[2][lane] + d * x[3][lane]);
            }
        }
    }
    for (k, x) in rest.iter().enumerate() {
        for (row, entry) in rows.iter_mut().zip(&columns.get(4 * quads.len() + k)[range.clone()]) {
            for lane in 0..W {
                row[lane] += entry * x[lane];
            }
        }
    }
}

/// Subtracts from the rows of some columns of the supernode their products with the rows below the triangle.
#[inline(always)]
fn subtract_columns<const W: usize>(
    columns: &Columns<'_>,
    first: usize,
    size: usize,
    below: &[Row<W>],
    targets: &mut [Row<W>],
) {
    let bottom = size..size + below.len();
    let (quads, rest) = targets.as_chunks_mut::<4>();
    let n_quads = quads.len();
    for (quad, target) in quads.iter_mut().enumerate() {
        let [a, b, c, d]: [&[f64]; 4] = std::array::from_fn(|k| &columns.get(first + 4 * quad + k)[bottom.clone()]);
        let mut sums = [[0.0; W]; 4];
        for ((((x, a), b), c), d) in below.iter().zip(a).zip(b).zip(c).zip(d) {
            for lane in 0..W {
                sums[0][lane] += a * x[lane];
                sums[1][lane] += b * x[lane];
                sums[2][lane] += c * x[lane];
                sums[3][lane] += d * x[lane];
            }
        }
        for (target, sum) in target.iter_mut().zip(&sums) {
            for lane in 0..W {
                target[lane] -= sum[lane];
            }
        }
    }
    for (k, target) in rest.iter_mut().enumerate() {
        let column = &columns.get(first + 4 * n_quads + k)[bottom.clone()];
        let mut sum = [0.0; W];
        for (x, entry) in below.iter().zip(column) {
            for lane in 0..W {
                sum[lane] += entry * x[lane];
            }
        }
        for lane in 0..W {
            target[lane] -= sum[lane];
        }
    }
}

/// Solves the transposed triangle from its last row up.
#[inline(always)]
fn solve_transposed_triangle<const W: usize>(columns: &Columns<'_>, diagonal: Diagonal<'_>, top: &mut [Row<W>]) {
    for j in (0..top.len()).rev() {
        let column = columns.get(j);
        let (upper, lower) = top.split_at_mut(j + 1);
        // Two sums, so that one addition need not wait for the other.
        let mut sums = [[0.0; W]; 2];
        let (pairs, rest) = lower.as_chunks::<2>();
        let (entry_pairs, entry_rest) = column[j + 1..j + 1 + lower.len()].as_chunks::<2>();
        for (x, entry) in pairs.iter().zip(entry_pairs) {
            for lane in 0..W {
                sums[0][lane] += entry[0] * x[0][lane];
                sums[1][lane] += entry[1] * x[1][lane];
            }
        }
        for (x, entry) in rest.iter().zip(entry_rest) {
            for lane in 0..W {
                sums[0][lane] += entry * x[lane];
            }
        }
        let inverse = diagonal.inverse(column, j);
        for lane in 0..W {
            upper[j][lane] = (upper[j][lane] - (sums[0][lane] + sums[1][lane])) * inverse;
        }
        if j % PANEL == 0 {
            diagonal.restore(j, top);
        }
    }
}

#[inline(always)]
fn subtract<const W: usize>(row: &mut Row<W>, entry: f64, pivot: &Row<W>) {
    for lane in 0..W {
        row[lane] -= entry * pivot[lane];
    }
}
