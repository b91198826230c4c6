//! Triangular solves on blocks of right-hand sides, stored row by row.
//!
//! ```text
//! L    n × n, by supernodes: a dense trapezoid of `size` columns, the triangle on top, `pattern` rows below
//! X    n × W, row-major: the W numbers that an entry of L meets are neighbours in memory
//! ```
//! A solve reads L once down and once up and does 2·W multiplications with each entry, so for a narrow block it is bound
//! by memory traffic. Column-major right-hand sides would touch W cache lines for every row index; row-major ones touch
//! one. Columns of a supernode are taken four at a time, so that a row of X is loaded once for four entries.
//!
//! Every sum has a fixed order: the rows of a large supernode may be shared among threads, never the terms of a row.

use faer::sparse::linalg::cholesky::supernodal::{SupernodalLltRef, SupernodeRef};
use faer::{MatMut, MatRef};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Columns of the triangle that are solved one by one before the rest is updated.
const PANEL: usize = 32;
/// Rows or columns of a supernode given to one task.
const CHUNK: usize = 128;
/// Entries of a trapezoid above which its rows are shared among threads: at a few nanoseconds an entry the work is then
/// ten times what starting a task costs.
const PARALLEL_ABOVE: usize = 1 << 16;

/// One row of a block of W right-hand sides.
type Row<const W: usize> = [f64; W];

/// X ← (L Lᵀ)⁻¹ X for a column-major block.
pub(super) fn solve_in_place(factor: SupernodalLltRef<'_, usize, f64>, block: MatMut<'_, f64>) {
    match block.ncols() {
        0 => {}
        1..=4 => solve_width::<4>(factor, block),
        _ => solve_width::<8>(factor, block),
    }
}

fn solve_width<const W: usize>(factor: SupernodalLltRef<'_, usize, f64>, mut block: MatMut<'_, f64>) {
    let n = block.nrows();
    let mut x = vec![[0.0; W]; n];
    for start in (0..block.ncols()).step_by(W) {
        let width = W.min(block.ncols() - start);
        let mut tile = block.as_mut().subcols_mut(start, width);
        for (i, row) in x.iter_mut().enumerate() {
            *row = std::array::from_fn(|j| if j < width { tile[(i, j)] } else { 0.0 });
        }
        let n_supernodes = factor.symbolic().n_supernodes();
        let mut gathered = Vec::new();
        for s in 0..n_supernodes {
            forward(factor.supernode(s), &mut x, &mut gathered);
        }
        for s in (0..n_supernodes).rev() {
            backward(factor.supernode(s), &mut x, &mut gathered);
        }
        for (i, row) in x.iter().enumerate() {
            for j in 0..width {
                tile[(i, j)] = row[j];
            }
        }
    }
}

/// L X = B on one supernode: solves its triangle and subtracts its rows from those below.
fn forward<const W: usize>(node: SupernodeRef<'_, usize, f64>, x: &mut [Row<W>], update: &mut Vec<Row<W>>) {
    let (size, pattern) = (node.val().ncols(), node.pattern());
    let columns = Columns::of(node.val());
    let top = &mut x[node.start()..node.start() + size];
    Kernel::Triangle { columns: &columns, top }.run();
    update.clear();
    update.resize(pattern.len(), [0.0; W]);
    let top = &*top;
    for_chunks(size, update, |first, rows| {
        Kernel::Rows { columns: &columns, first: size + first, top, rows }.run();
    });
    for (row, change) in pattern.iter().zip(&*update) {
        for (x, change) in x[*row].iter_mut().zip(change) {
            *x -= change;
        }
    }
}

/// Lᵀ X = B on one supernode: takes in the rows below, then solves its triangle.
fn backward<const W: usize>(node: SupernodeRef<'_, usize, f64>, x: &mut [Row<W>], below: &mut Vec<Row<W>>) {
    let (size, pattern) = (node.val().ncols(), node.pattern());
    let columns = Columns::of(node.val());
    below.clear();
    below.extend(pattern.iter().map(|row| x[*row]));
    let below = &*below;
    let top = &mut x[node.start()..node.start() + size];
    for_chunks(below.len(), top, |first, targets| {
        Kernel::Columns { columns: &columns, first, size, below, targets }.run();
    });
    Kernel::TransposedTriangle { columns: &columns, top }.run();
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
    Triangle { columns: &'a Columns<'a>, top: &'a mut [Row<W>] },
    /// Multiplies rows of the trapezoid with the solved top.
    Rows { columns: &'a Columns<'a>, first: usize, top: &'a [Row<W>], rows: &'a mut [Row<W>] },
    /// Takes the rows below into rows of the top.
    Columns { columns: &'a Columns<'a>, first: usize, size: usize, below: &'a [Row<W>], targets: &'a mut [Row<W>] },
    /// Solves the transposed triangle.
    TransposedTriangle { columns: &'a Columns<'a>, top: &'a mut [Row<W>] },
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
            Self::Triangle { columns, top } => solve_triangle(columns, top),
            Self::Rows { columns, first, top, rows } => accumulate_rows(columns, first, top, rows),
            Self::Columns { columns, first, size, below, targets } => {
                subtract_columns(columns, first, size, below, targets);
            }
            Self::TransposedTriangle { columns, top } => solve_transposed_triangle(columns, top),
        }
    }
}

/// The columns of a trapezoid.
struct Columns<'a>(MatRef<'a, f64>);

impl<'a> Columns<'a> {
    fn of(trapezoid: MatRef<'a, f64>) -> Self {
        Self(trapezoid)
    }

    #[inline(always)]
    fn get(&self, j: usize) -> &'a [f64] {
        crate::dense::column(self.0, j)
    }
}

/// Solves the triangle panel by panel.
#[inline(always)]
fn solve_triangle<const W: usize>(columns: &Columns<'_>, top: &mut [Row<W>]) {
    let size = top.len();
    for start in (0..size).step_by(PANEL) {
        let end = (start + PANEL).min(size);
        for j in start..end {
            let column = columns.get(j);
            let inverse = 1.0 / column[j];
            let pivot: Row<W> = std::array::from_fn(|lane| top[j][lane] * inverse);
            top[j] = pivot;
            for (row, entry) in top[j + 1..end].iter_mut().zip(&column[j + 1..end]) {
                subtract(row, *entry, &pivot);
            }
        }
        let (panel, rest) = top.split_at_mut(end);
        let panel = &panel[start..];
        let (quads, single) = (panel.len() / 4, panel.len() / 4 * 4);
        for quad in 0..quads {
            let at = 4 * quad;
            let [a, b, c, d]: [&[f64]; 4] = std::array::from_fn(|k| &columns.get(start + at + k)[end..size]);
            for ((((row, a), b), c), d) in rest.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                for lane in 0..W {
                    row[lane] -= a * panel[at][lane]
                        + b * panel[at + 1][lane]
                        + (c * panel[at + 2][lane] + d * panel[at + 3][lane]);
                }
            }
        }
        for (k, pivot) in panel.iter().enumerate().skip(single) {
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
fn solve_transposed_triangle<const W: usize>(columns: &Columns<'_>, top: &mut [Row<W>]) {
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
        let inverse = 1.0 / column[j];
        for lane in 0..W {
            upper[j][lane] = (upper[j][lane] - (sums[0][lane] + sums[1][lane])) * inverse;
        }
    }
}

#[inline(always)]
fn subtract<const W: usize>(row: &mut Row<W>, entry: f64, pivot: &Row<W>) {
    for lane in 0..W {
        row[lane] -= entry * pivot[lane];
    }
}
