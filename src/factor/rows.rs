//! One supernode times blocks of right-hand sides, stored row by row.
//!
//! ```text
//! X       n × W, row-major: the W numbers that an entry of L meets are neighbours in memory
//! panel   N columns of L, row-major as well: N entries meet one row of X
//! ```
//! A solve reads L once down and once up and does 2·W multiplications with each entry, so for a narrow block it is bound
//! by memory traffic: every panel is read from end to end. Going down a row of X is loaded once for N entries; going up the sums of N
//! rows of X stay in registers.
//!
//! Every sum has a fixed order: the rows of a large supernode may be shared among threads, never the terms of a row.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::diagonal::Diagonal;
use super::elimination::{Inverse, Kind, PANEL};
use super::entry::Entry;
use super::multifrontal::Eliminated;
use super::panels::{Panel, Panels};
use super::prefetch::prefetch;

/// Rows or columns of a supernode given to one task; a multiple of the columns of a panel.
const CHUNK: usize = 128;
/// Entries of a trapezoid above which its rows are shared among threads: at a few nanoseconds an entry the work is then
/// ten times what starting a task costs.
const PARALLEL_ABOVE: usize = 1 << 16;

/// One row of a block of W right-hand sides.
pub(super) type Row<const W: usize> = [f64; W];

/// One supernode of a factor.
pub(super) struct Block<'a, T> {
    numbers: Eliminated<'a, T>,
    kind: Kind,
}

impl<'a, T: Entry> Block<'a, T> {
    pub(super) fn new(numbers: Eliminated<'a, T>, kind: Kind) -> Self {
        Self { numbers, kind }
    }

    /// L_11⁻¹ P on the rows of its columns, `top`; `update` becomes −L_21 times the result.
    pub(super) fn forward<const W: usize>(&self, top: &mut [Row<W>], update: &mut Vec<Row<W>>) {
        let (panels, diagonal, size) = (self.numbers.panels, self.diagonal(), top.len());
        update.clear();
        update.resize(panels.shape().rows - size, [0.0; W]);
        if !is_shared(size, update) {
            return Kernel::Forward { panels, diagonal, top, update }.run();
        }
        Kernel::Forward { panels, diagonal, top: &mut *top, update: &mut [] }.run();
        for_chunks(update, |first, rows| Kernel::Rows { panels, first: size + first, top, rows }.run());
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
        let (panels, diagonal) = (self.numbers.panels, self.diagonal());
        if !is_shared(below.len(), top) {
            return Kernel::Backward { panels, diagonal, top, below }.run();
        }
        for_chunks(top, |first, targets| Kernel::Columns { panels, first, below, targets }.run());
        Kernel::Backward { panels, diagonal, top, below: &[] }.run();
    }

    fn diagonal(&self) -> Diagonal<'a> {
        match self.kind {
            Kind::Definite => Diagonal::OfTriangle,
            Kind::Indefinite => Diagonal::Ones { order: self.numbers.order },
        }
    }
}

/// Whether rows are worth sharing among threads, each of which takes `depth` entries.
fn is_shared<const W: usize>(depth: usize, rows: &[Row<W>]) -> bool {
    depth * rows.len() > PARALLEL_ABOVE
}

fn for_chunks<const W: usize>(rows: &mut [Row<W>], work: impl Fn(usize, &mut [Row<W>]) + Sync) {
    rows.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, rows)| work(chunk * CHUNK, rows));
}

/// The inner loops, compiled for the vector unit that the machine turns out to have.
enum Kernel<'a, T, const W: usize> {
    /// Solves the triangle on top and takes the rows below along.
    Forward { panels: Panels<'a, T>, diagonal: Diagonal<'a>, top: &'a mut [Row<W>], update: &'a mut [Row<W>] },
    /// Subtracts from rows what the trapezoid makes of the solved top.
    Rows { panels: Panels<'a, T>, first: usize, top: &'a [Row<W>], rows: &'a mut [Row<W>] },
    /// Takes the rows below into rows of the top.
    Columns { panels: Panels<'a, T>, first: usize, below: &'a [Row<W>], targets: &'a mut [Row<W>] },
    /// Takes the rows below into all rows of the top, and solves the transposed triangle.
    Backward { panels: Panels<'a, T>, diagonal: Diagonal<'a>, top: &'a mut [Row<W>], below: &'a [Row<W>] },
}

impl<T: Entry, const W: usize> Kernel<'_, T, W> {
    fn run(self) {
        // A vector of eight numbers would hold two rows of four.
        #[cfg(target_arch = "x86_64")]
        if let (4, Some(narrow)) = (W, pulp::x86::V3::try_new()) {
            return Simd::vectorize(narrow, self);
        }
        Arch::new().dispatch(self);
    }

    /// With V vectors to a row of W numbers, and C columns whose sums fit into registers together.
    #[inline(always)]
    fn with_vectors<S: Simd, const V: usize, const C: usize>(self, simd: S) {
        let unit = Unit::<S, V, C>(simd);
        match self {
            Self::Forward { panels, diagonal, top, update } => unit.forward(panels, diagonal, top, update),
            Self::Rows { panels, first, top, rows } => unit.rows(panels, first, top, rows),
            Self::Columns { panels, first, below, targets } => unit.columns(panels, first, below, targets),
            Self::Backward { panels, diagonal, top, below } => unit.backward(panels, diagonal, top, below),
        }
    }
}

impl<T: Entry, const W: usize> WithSimd for Kernel<'_, T, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // A constant, so that of the arms all but one are never compiled.
        match const { W / S::F64_LANES } {
            1 => self.with_vectors::<S, 1, 8>(simd),
            2 if S::REGISTER_COUNT >= 32 => self.with_vectors::<S, 2, 8>(simd),
            2 => self.with_vectors::<S, 2, 4>(simd),
            4 => self.with_vectors::<S, 4, 2>(simd),
            8 => self.with_vectors::<S, 8, 1>(simd),
            16 => self.with_vectors::<S, 16, 1>(simd),
            vectors => unreachable!("no kernel for {vectors} vectors to a row"),
        }
    }
}

/// Calls a method for the columns that a panel has.
macro_rules! of_width {
    ($unit:ident.$method:ident($panel:expr; $($argument:expr),*)) => {
        match $panel.width {
            8 => $unit.$method::<T, 8>($($argument),*),
            4 => $unit.$method::<T, 4>($($argument),*),
            2 => $unit.$method::<T, 2>($($argument),*),
            _ => $unit.$method::<T, 1>($($argument),*),
        }
    };
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

    #[inline(always)]
    fn forward<T: Entry, const W: usize>(
        &self,
        panels: Panels<'_, T>,
        diagonal: Diagonal<'_>,
        top: &mut [Row<W>],
        update: &mut [Row<W>],
    ) {
        let size = top.len();
        let update = Self::vectors_mut(update);
        let mut left = panels.shape().panels().peekable();
        while let Some(panel) = left.next() {
            let next = left.peek().copied();
            let Panel { first, width, .. } = panel;
            if first % PANEL == 0 {
                diagonal.permute(first, top);
            }
            let (own, rest) = Self::vectors_mut(&mut top[first..]).split_at_mut(width);
            let triangle = panels.rows(panel, first..first + width);
            of_width!(self.solve(panel; triangle, diagonal, own));
            of_width!(self.subtract_rows(panel; panels.rows_and_next(panel, first + width..size, next), own, rest));
            of_width!(self.subtract_rows(panel; panels.rows_and_next(panel, size..size + update.len(), next), own, update));
        }
    }

    #[inline(always)]
    fn rows<T: Entry, const W: usize>(&self, panels: Panels<'_, T>, first: usize, top: &[Row<W>], rows: &mut [Row<W>]) {
        let (top, rows) = (Self::vectors(top), Self::vectors_mut(rows));
        let mut left = panels.shape().panels().peekable();
        while let Some(panel) = left.next() {
            let next = left.peek().copied();
            let own = &top[panel.first..panel.first + panel.width];
            of_width!(self.subtract_rows(panel; panels.rows_and_next(panel, first..first + rows.len(), next), own, rows));
        }
    }

    #[inline(always)]
    fn columns<T: Entry, const W: usize>(
        &self,
        panels: Panels<'_, T>,
        first: usize,
        below: &[Row<W>],
        targets: &mut [Row<W>],
    ) {
        let (below, targets) = (Self::vectors(below), Self::vectors_mut(targets));
        let size = panels.shape().size;
        let inside = first..first + targets.len();
        let mut left = panels.shape().panels().filter(|panel| inside.contains(&panel.first)).peekable();
        while let Some(panel) = left.next() {
            let next = left.peek().copied();
            let own = &mut targets[panel.first - first..][..panel.width];
            of_width!(self.subtract_columns(panel; panels.rows_and_next(panel, size..size + below.len(), next), below, own));
        }
    }

    #[inline(always)]
    fn backward<T: Entry, const W: usize>(
        &self,
        panels: Panels<'_, T>,
        diagonal: Diagonal<'_>,
        top: &mut [Row<W>],
        below: &[Row<W>],
    ) {
        let size = top.len();
        let below = Self::vectors(below);
        let mut left = panels.shape().panels().rev().peekable();
        while let Some(panel) = left.next() {
            let next = left.peek().copied();
            let Panel { first, width, .. } = panel;
            let (own, rest) = Self::vectors_mut(&mut top[first..]).split_at_mut(width);
            of_width!(self.subtract_columns(panel; panels.rows_and_next(panel, size..size + below.len(), next), below, own));
            of_width!(self.subtract_columns(panel; panels.rows_and_next(panel, first + width..size, next), rest, own));
            let triangle = panels.rows(panel, first..first + width);
            of_width!(self.solve_transposed(panel; triangle, diagonal, own));
            if first % PANEL == 0 {
                diagonal.restore(first, top);
            }
        }
    }

    /// −x, by a loop: the maps of arrays are calls where a compiler does not inline them.
    #[inline(always)]
    fn negated(&self, x: &[S::f64s; V]) -> [S::f64s; V] {
        let mut negative = *x;
        for entry in &mut negative {
            *entry = self.0.neg_f64s(*entry);
        }
        negative
    }

    /// X ← L⁻¹ X for the triangle L of a panel.
    #[inline(always)]
    fn solve<T: Entry, const N: usize>(&self, triangle: &[T], diagonal: Diagonal<'_>, x: &mut [[S::f64s; V]]) {
        let simd = self.0;
        let triangle = triangle.as_chunks::<N>().0;
        for j in 0..N {
            let inverse = simd.splat_f64s(diagonal.inverse(triangle[j][j]));
            for entry in &mut x[j] {
                *entry = simd.mul_f64s(*entry, inverse);
            }
            let negative = self.negated(&x[j]);
            for i in j + 1..N {
                let entry = simd.splat_f64s(triangle[i][j].into());
                for v in 0..V {
                    x[i][v] = simd.mul_add_f64s(entry, negative[v], x[i][v]);
                }
            }
        }
    }

    /// X ← L⁻ᵀ X for the triangle L of a panel.
    #[inline(always)]
    fn solve_transposed<T: Entry, const N: usize>(
        &self,
        triangle: &[T],
        diagonal: Diagonal<'_>,
        x: &mut [[S::f64s; V]],
    ) {
        let simd = self.0;
        let triangle = triangle.as_chunks::<N>().0;
        for j in (0..N).rev() {
            let inverse = simd.splat_f64s(diagonal.inverse(triangle[j][j]));
            for entry in &mut x[j] {
                *entry = simd.mul_f64s(*entry, inverse);
            }
            let negative = self.negated(&x[j]);
            for i in 0..j {
                let entry = simd.splat_f64s(triangle[j][i].into());
                for v in 0..V {
                    x[i][v] = simd.mul_add_f64s(entry, negative[v], x[i][v]);
                }
            }
        }
    }

    /// `rows` − A X for some rows A of a panel, while the `next` entries are loaded.
    #[inline(always)]
    fn subtract_rows<T: Entry, const N: usize>(
        &self,
        [a, next]: [&[T]; 2],
        x: &[[S::f64s; V]],
        rows: &mut [[S::f64s; V]],
    ) {
        let simd = self.0;
        let mut negative = [[simd.splat_f64s(0.0); V]; N];
        for (negative, x) in negative.iter_mut().zip(x) {
            *negative = self.negated(x);
        }
        for (i, (row, entries)) in rows.iter_mut().zip(a.as_chunks::<N>().0).enumerate() {
            prefetch(next, i * N);
            let mut sum = *row;
            for (entry, x) in entries.iter().zip(&negative) {
                let entry = simd.splat_f64s((*entry).into());
                for v in 0..V {
                    sum[v] = simd.mul_add_f64s(entry, x[v], sum[v]);
                }
            }
            *row = sum;
        }
    }

    /// `targets` − Aᵀ X for some rows A of a panel, C columns at a time, while the `next` entries are loaded.
    #[inline(always)]
    fn subtract_columns<T: Entry, const N: usize>(
        &self,
        [a, next]: [&[T]; 2],
        x: &[[S::f64s; V]],
        targets: &mut [[S::f64s; V]],
    ) {
        let simd = self.0;
        let rows = a.as_chunks::<N>().0;
        for (group, targets) in targets.chunks_mut(C).enumerate() {
            let mut sums = [[simd.splat_f64s(0.0); V]; C];
            for (i, (entries, x)) in rows.iter().zip(x).enumerate() {
                prefetch(next, i * N);
                for (k, sum) in sums.iter_mut().enumerate().take(N) {
                    let entry = simd.splat_f64s(entries[(group * C + k) % N].into());
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
    }
}
