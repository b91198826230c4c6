//! One supernode times blocks of right-hand sides, stored row by row.
//!
//! ```text
//! trapezoid   `size` columns: the triangle on top, rows below
//! X           n × W, row-major: the W numbers that an entry of L meets are neighbours in memory
//! ```
//! A solve reads L once down and once up and does 2·W multiplications with each entry, so for a narrow block it is bound
//! by memory traffic. Column-major right-hand sides would touch W cache lines for every row index; row-major ones touch
//! one. Columns of a supernode are taken four at a time, so that a row of X is loaded once for four entries, and each is
//! read in the order of memory, which is what a factor larger than the cache asks for.
//!
//! Every sum has a fixed order: the rows of a large supernode may be shared among threads, never the terms of a row.

use faer::MatRef;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::elimination::{Inverse, Kind, PANEL};
use super::entry::Entry;
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
pub(super) struct Block<'a, T> {
    numbers: Eliminated<'a, T>,
    columns: Columns<'a, T>,
    kind: Kind,
}

impl<'a, T: Entry> Block<'a, T> {
    pub(super) fn new(numbers: Eliminated<'a, T>, kind: Kind) -> Self {
        Self { columns: Columns(numbers.trapezoid), numbers, kind }
    }

    /// L_11⁻¹ P on the rows of its columns, `top`; `update` becomes −L_21 times the result.
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
                    let [first, second] = [top[j], top[j + 1]];
                    for (lane, (x, y)) in first.into_iter().zip(second).enumerate() {
                        [top[j][lane], top[j + 1][lane]] = inverse.times([x, y]);
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
    fn inverse<T: Entry>(self, column: &[T], j: usize) -> f64 {
        match self {
            Self::OfTriangle => 1.0 / column[j].into(),
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

/// The inner loops, compiled for the vector unit that the machine turns out to have.
enum Kernel<'a, T, const W: usize> {
    /// Solves the triangle on top.
    Triangle { columns: &'a Columns<'a, T>, diagonal: Diagonal<'a>, top: &'a mut [Row<W>] },
    /// Subtracts from rows what the trapezoid makes of the solved top.
    Rows { columns: &'a Columns<'a, T>, first: usize, top: &'a [Row<W>], rows: &'a mut [Row<W>] },
    /// Takes the rows below into rows of the top.
    Columns { columns: &'a Columns<'a, T>, first: usize, size: usize, below: &'a [Row<W>], targets: &'a mut [Row<W>] },
    /// Solves the transposed triangle.
    TransposedTriangle { columns: &'a Columns<'a, T>, diagonal: Diagonal<'a>, top: &'a mut [Row<W>] },
}

impl<T: Entry, const W: usize> Kernel<'_, T, W> {
    fn run(self) {
        Arch::new().dispatch(self);
    }

    /// With V vectors to a row of W numbers, and C columns whose sums fit into registers together.
    #[inline(always)]
    fn with_vectors<S: Simd, const V: usize, const C: usize>(self, simd: S) {
        let unit = Unit::<S, V, C>(simd);
        match self {
            Self::Triangle { columns, diagonal, top } => unit.solve_triangle(columns, diagonal, top),
            Self::Rows { columns, first, top, rows } => unit.subtract_rows(columns, (first, 0), top, rows),
            Self::Columns { columns, first, size, below, targets } => {
                unit.subtract_columns(columns, (size, first), below, targets);
            }
            Self::TransposedTriangle { columns, diagonal, top } => {
                unit.solve_transposed_triangle(columns, diagonal, top);
            }
        }
    }
}

impl<T: Entry, const W: usize> WithSimd for Kernel<'_, T, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        const { assert!(W >= S::F64_LANES, "a row is narrower than a vector") };
        match W / S::F64_LANES {
            1 => self.with_vectors::<S, 1, 4>(simd),
            2 => self.with_vectors::<S, 2, 4>(simd),
            4 => self.with_vectors::<S, 4, 2>(simd),
            8 => self.with_vectors::<S, 8, 1>(simd),
            16 => self.with_vectors::<S, 16, 1>(simd),
            vectors => unreachable!("no kernel for {vectors} vectors to a row"),
        }
    }
}

/// The columns of a trapezoid.
struct Columns<'a, T>(MatRef<'a, T>);

impl<'a, T> Columns<'a, T> {
    #[inline(always)]
    fn get(&self, j: usize) -> &'a [T] {
        self.0.col(j).try_as_col_major().expect("stored by columns").as_slice()
    }
}

/// A vector unit that holds a row of right-hand sides in V vectors.
struct Unit<S, const V: usize, const C: usize>(S);

impl<S: Simd, const V: usize, const C: usize> Unit<S, V, C> {
    #[inline(always)]
    fn vectors<const W: usize>(rows: &[Row<W>]) -> &[[S::f64s; V]] {
        S::as_simd_f64s(rows.as_flattened()).0.as_chunks::<V>().0
    }

    #[inline(always)]
    fn vectors_mut<const W: usize>(rows: &mut [Row<W>]) -> &mut [[S::f64s; V]] {
        S::as_mut_simd_f64s(rows.as_flattened_mut()).0.as_chunks_mut::<V>().0
    }

    /// `rows` − A X, where A begins at row and column `at` of the trapezoid. Four columns are read side by side, each in the
    /// order of memory.
    #[inline(always)]
    fn subtract_rows<T: Entry, const W: usize>(
        &self,
        columns: &Columns<'_, T>,
        at: (usize, usize),
        x: &[Row<W>],
        rows: &mut [Row<W>],
    ) {
        let simd = self.0;
        let (x, rows) = (Self::vectors(x), Self::vectors_mut(rows));
        let range = at.0..at.0 + rows.len();
        let (quads, single) = x.as_chunks::<4>();
        for (quad, x) in quads.iter().enumerate() {
            let [a, b, c, d]: [&[T]; 4] = std::array::from_fn(|k| &columns.get(at.1 + 4 * quad + k)[range.clone()]);
            for ((((row, a), b), c), d) in rows.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                let entries = [a, b, c, d].map(|entry| simd.splat_f64s(-(*entry).into()));
                for v in 0..V {
                    row[v] = entries.iter().zip(x).fold(row[v], |sum, (entry, x)| simd.mul_add_f64s(*entry, x[v], sum));
                }
            }
        }
        for (k, x) in single.iter().enumerate() {
            for (row, entry) in rows.iter_mut().zip(&columns.get(at.1 + 4 * quads.len() + k)[range.clone()]) {
                let entry = simd.splat_f64s(-(*entry).into());
                for v in 0..V {
                    row[v] = simd.mul_add_f64s(entry, x[v], row[v]);
                }
            }
        }
    }

    /// `targets` − Aᵀ X, where A begins at row and column `at` of the trapezoid.
    #[inline(always)]
    fn subtract_columns<T: Entry, const W: usize>(
        &self,
        columns: &Columns<'_, T>,
        at: (usize, usize),
        x: &[Row<W>],
        targets: &mut [Row<W>],
    ) {
        let (x, targets) = (Self::vectors(x), Self::vectors_mut(targets));
        let rows = at.0..at.0 + x.len();
        let (groups, single) = targets.as_chunks_mut::<C>();
        let n_grouped = C * groups.len();
        for (group, targets) in groups.iter_mut().enumerate() {
            let entries = std::array::from_fn(|k| &columns.get(at.1 + C * group + k)[rows.clone()]);
            self.subtract_group(entries, x, targets);
        }
        for (k, target) in single.iter_mut().enumerate() {
            let entries = [&columns.get(at.1 + n_grouped + k)[rows.clone()]];
            self.subtract_group(entries, x, std::array::from_mut(target));
        }
    }

    #[inline(always)]
    fn subtract_group<T: Entry, const N: usize>(
        &self,
        entries: [&[T]; N],
        x: &[[S::f64s; V]],
        targets: &mut [[S::f64s; V]; N],
    ) {
        let simd = self.0;
        let entries = entries.map(|entries| &entries[..x.len()]);
        let mut sums = [[simd.splat_f64s(0.0); V]; N];
        for (i, x) in x.iter().enumerate() {
            for (sum, entries) in sums.iter_mut().zip(&entries) {
                let entry = simd.splat_f64s(entries[i].into());
                for v in 0..V {
                    sum[v] = simd.mul_add_f64s(entry, x[v], sum[v]);
                }
            }
        }
        for (target, sum) in targets.iter_mut().zip(&sums) {
            for v in 0..V {
                target[v] = simd.sub_f64s(target[v], sum[v]);
            }
        }
    }

    /// Solves the triangle strip by strip.
    #[inline(always)]
    fn solve_triangle<T: Entry, const W: usize>(
        &self,
        columns: &Columns<'_, T>,
        diagonal: Diagonal<'_>,
        top: &mut [Row<W>],
    ) {
        for start in (0..top.len()).step_by(STRIP) {
            if start % PANEL == 0 {
                diagonal.permute(start, top);
            }
            let end = (start + STRIP).min(top.len());
            for j in start..end {
                let column = columns.get(j);
                let (solved, rest) = top[..end].split_at_mut(j + 1);
                let inverse = diagonal.inverse(column, j);
                solved[j].iter_mut().for_each(|x| *x *= inverse);
                self.subtract_rows(columns, (j + 1, j), &solved[j..], rest);
            }
            let (strip, rest) = top.split_at_mut(end);
            self.subtract_rows(columns, (end, start), &strip[start..], rest);
        }
    }

    /// Solves the transposed triangle from its last strip up.
    #[inline(always)]
    fn solve_transposed_triangle<T: Entry, const W: usize>(
        &self,
        columns: &Columns<'_, T>,
        diagonal: Diagonal<'_>,
        top: &mut [Row<W>],
    ) {
        for start in (0..top.len()).step_by(STRIP).rev() {
            let end = (start + STRIP).min(top.len());
            let (strip, below) = top.split_at_mut(end);
            self.subtract_columns(columns, (end, start), below, &mut strip[start..]);
            for j in (start..end).rev() {
                let (target, below) = top[..end].split_at_mut(j + 1);
                self.subtract_columns(columns, (j + 1, j), below, &mut target[j..]);
                let inverse = diagonal.inverse(columns.get(j), j);
                target[j].iter_mut().for_each(|x| *x *= inverse);
            }
            if start % PANEL == 0 {
                diagonal.restore(start, top);
            }
        }
    }
}
