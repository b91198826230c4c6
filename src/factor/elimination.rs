//! Dense elimination of one supernode, panel by panel, on faer's kernels.
//!
//! ```text
//! trapezoid   (size + b) × size: A_11 on top, A_21 below   →   L_11, L_21
//! rest        b × b                                        ←   −L_21 B L_21ᵀ
//! ```
//! A large supernode is cut into tiles of a fixed size, each done by one thread with kernels of one thread: the tiles may be
//! shared among threads without any sum changing its order. Only lower triangles are read.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::lblt::factor::LbltParams;
use faer::linalg::cholesky::{lblt, llt};
use faer::linalg::matmul::{matmul, triangular};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place};
use faer::{Accum, ColMut, Mat, MatMut, MatRef, Par, Spec};
use rayon::prelude::*;

/// Columns that are eliminated at a time. Pivots of an indefinite matrix are exchanged inside a panel only.
pub(super) const PANEL: usize = 256;
/// Rows and columns of the tiles that are shared among threads.
const TILE: usize = 256;
/// Operations above which sharing pays: a few hundred microseconds of one thread.
const PARALLEL_ABOVE: f64 = 2e7;
/// Columns up to which computing a square costs less than sparing its upper triangle.
const SQUARE_BELOW: usize = 64;

/// What kind of factor is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// L Lᵀ; B is the identity.
    Definite,
    /// L B Lᵀ with a unit diagonal in L and pivots of order one and two in B.
    Indefinite,
}

/// B of some columns, and the order in which a panel takes them.
#[derive(Debug)]
pub(super) struct Pivots<'a> {
    /// Diagonal of B; of a definite matrix the squares of the diagonal of L.
    pub(super) diagonal: &'a mut [f64],
    /// Not zero where a pivot of order two begins: its coupling.
    pub(super) subdiagonal: &'a mut [f64],
    /// Column of the panel at each place.
    pub(super) order: &'a mut [u32],
}

impl<'a> Pivots<'a> {
    /// Splits off those of the first `n` columns.
    pub(super) fn split_off(&mut self, n: usize) -> Pivots<'a> {
        const WHOLE: &str = "columns are split off once";
        Pivots {
            diagonal: self.diagonal.split_off_mut(..n).expect(WHOLE),
            subdiagonal: self.subdiagonal.split_off_mut(..n).expect(WHOLE),
            order: self.order.split_off_mut(..n).expect(WHOLE),
        }
    }

    /// The pivots of columns `start` .. `end`.
    fn part(&mut self, start: usize, end: usize) -> Pivots<'_> {
        Pivots {
            diagonal: &mut self.diagonal[start..end],
            subdiagonal: &mut self.subdiagonal[start..end],
            order: &mut self.order[start..end],
        }
    }
}

/// Memory of the dense kernels for a panel.
pub(super) fn scratch() -> StackReq {
    llt::factor::cholesky_in_place_scratch::<f64>(PANEL, Par::Seq, Spec::default())
        .or(lblt::factor::cholesky_in_place_scratch::<usize, f64>(PANEL, Par::Seq, one_block()))
}

/// L B Lᵀ of a panel without blocks inside: in a blocked step faer 0.24 leaves a column that has become zero as it was before.
fn one_block() -> Spec<LbltParams, f64> {
    let mut parameters = Spec::<LbltParams, f64>::default();
    parameters.config.block_size = PANEL;
    parameters
}

/// A_11 and A_21 become L_11 and L_21. The column at which a pivot of a definite matrix is not positive is the error.
pub(super) fn eliminate_columns(
    kind: Kind,
    mut trapezoid: MatMut<'_, f64>,
    pivots: &mut Pivots<'_>,
    memory: &mut MemBuffer,
) -> Result<(), usize> {
    let (m, size) = trapezoid.shape();
    for start in (0..size).step_by(PANEL) {
        let width = PANEL.min(size - start);
        let (done, rest) = trapezoid.as_mut().split_at_col_mut(start);
        let mut panel = rest.subcols_mut(0, width).subrows_mut(start, m - start);
        if start > 0 {
            let done = done.as_ref().subrows(start, m - start);
            let weighted = weighted(kind, done.subrows(0, width), &pivots.part(0, start));
            for_row_tiles(panel.as_mut(), (2 * start) as f64, |first, tile| {
                let rows = done.subrows(first, tile.nrows());
                matmul(tile, Accum::Add, rows, weighted.as_ref().transpose(), -1.0, Par::Seq);
            });
        }
        let (mut top, below) = panel.split_at_row_mut(width);
        let mut pivots = pivots.part(start, start + width);
        match kind {
            Kind::Definite => {
                factor_definite(top.as_mut(), pivots.diagonal, memory).map_err(|column| start + column)?;
                let top = top.as_ref();
                for_row_tiles(below, width as f64, |_, mut tile| {
                    solve_lower_triangular_in_place(top, tile.as_mut().transpose_mut(), Par::Seq);
                });
            }
            Kind::Indefinite => {
                factor_indefinite(top.as_mut(), &mut pivots, memory);
                let (top, pivots) = (top.as_ref(), &pivots);
                for_row_tiles(below, width as f64, |_, mut tile| {
                    reorder_columns(tile.as_mut(), pivots.order);
                    solve_unit_lower_triangular_in_place(top, tile.as_mut().transpose_mut(), Par::Seq);
                    divide_by_pivots(tile, pivots);
                });
            }
        }
    }
    Ok(())
}

/// Adds the diagonal of |L| |B| |Lᵀ| as far as these columns make it up, with the row sums of |B| on its diagonal; rows of the
/// triangle are those of the front as it was assembled.
pub(super) fn add_products(trapezoid: MatRef<'_, f64>, pivots: &Pivots<'_>, products: &mut [f64]) {
    let size = trapezoid.ncols();
    for j in 0..size {
        let coupling = |at: usize| pivots.subdiagonal[at].abs();
        let weight = pivots.diagonal[j].abs() + coupling(j) + if j > 0 { coupling(j - 1) } else { 0.0 };
        let panel = j - j % PANEL;
        let end = size.min(panel + PANEL);
        let column = crate::dense::column(trapezoid, j);
        products[panel + pivots.order[j] as usize] += weight;
        for (place, value) in pivots.order[j + 1..end].iter().zip(&column[j + 1..end]) {
            products[panel + *place as usize] += value * value * weight;
        }
        for (product, value) in products[end..].iter_mut().zip(&column[end..]) {
            *product += value * value * weight;
        }
    }
}

/// Lower triangle of −L_21 B L_21ᵀ.
pub(super) fn outer_product(kind: Kind, l_21: MatRef<'_, f64>, pivots: &Pivots<'_>, mut rest: MatMut<'_, f64>) {
    let (b, size) = l_21.shape();
    if b == 0 {
        return;
    }
    let column_tile = |first: usize, tile: MatMut<'_, f64>| {
        let width = tile.ncols();
        let weighted_rows = (kind == Kind::Indefinite).then(|| weighted(kind, l_21.subrows(first, width), pivots));
        let right = weighted_rows.as_ref().map_or(l_21.subrows(first, width), Mat::as_ref).transpose();
        let (mut corner, mut below) = tile.subrows_mut(first, b - first).split_at_row_mut(width);
        if width <= SQUARE_BELOW {
            matmul(corner.as_mut(), Accum::Replace, l_21.subrows(first, width), right, -1.0, Par::Seq);
        } else {
            use triangular::BlockStructure::{Rectangular, TriangularLower};
            let left = l_21.subrows(first, width);
            let corner = corner.as_mut();
            triangular::matmul(
                corner,
                TriangularLower,
                Accum::Replace,
                left,
                Rectangular,
                right,
                Rectangular,
                -1.0,
                Par::Seq,
            );
        }
        for start in (0..below.nrows()).step_by(TILE) {
            let height = TILE.min(below.nrows() - start);
            let left = l_21.subrows(first + width + start, height);
            matmul(below.as_mut().subrows_mut(start, height), Accum::Replace, left, right, -1.0, Par::Seq);
        }
    };
    if (b * b) as f64 * size as f64 > PARALLEL_ABOVE {
        rest.par_col_chunks_mut(TILE).enumerate().for_each(|(at, tile)| column_tile(at * TILE, tile));
    } else {
        for first in (0..b).step_by(TILE) {
            column_tile(first, rest.as_mut().subcols_mut(first, TILE.min(b - first)));
        }
    }
}

/// Does some work on tiles of rows, side by side where `per_entry` operations on each entry make that worth it.
fn for_row_tiles(mut block: MatMut<'_, f64>, per_entry: f64, work: impl Fn(usize, MatMut<'_, f64>) + Sync) {
    let entries = (block.nrows() * block.ncols()) as f64;
    if entries * per_entry > PARALLEL_ABOVE {
        block.par_row_chunks_mut(TILE).enumerate().for_each(|(at, tile)| work(at * TILE, tile));
        return;
    }
    for first in (0..block.nrows()).step_by(TILE) {
        let height = TILE.min(block.nrows() - first);
        work(first, block.as_mut().subrows_mut(first, height));
    }
}

fn factor_definite(mut top: MatMut<'_, f64>, diagonal: &mut [f64], memory: &mut MemBuffer) -> Result<(), usize> {
    let stack = MemStack::new(memory);
    llt::factor::cholesky_in_place(top.as_mut(), Default::default(), Par::Seq, stack, Spec::default())
        .map_err(|llt::factor::LltError::NonPositivePivot { index }| index)?;
    for (j, pivot) in diagonal.iter_mut().enumerate() {
        *pivot = top[(j, j)] * top[(j, j)];
    }
    Ok(())
}

fn factor_indefinite(mut top: MatMut<'_, f64>, pivots: &mut Pivots<'_>, memory: &mut MemBuffer) {
    let n = top.nrows();
    let (mut forward, mut inverse) = (vec![0usize; n], vec![0usize; n]);
    lblt::factor::cholesky_in_place(
        top.as_mut(),
        ColMut::from_slice_mut(pivots.subdiagonal).as_diagonal_mut(),
        &mut forward,
        &mut inverse,
        Par::Seq,
        MemStack::new(memory),
        one_block(),
    );
    for (j, pivot) in pivots.diagonal.iter_mut().enumerate() {
        *pivot = top[(j, j)];
    }
    for (place, column) in pivots.order.iter_mut().zip(forward) {
        *place = column as u32;
    }
}

/// Puts columns in the order of their pivots.
fn reorder_columns(mut tile: MatMut<'_, f64>, order: &[u32]) {
    if order.iter().enumerate().all(|(place, column)| place == *column as usize) {
        return;
    }
    let before = tile.as_ref().to_owned();
    for (place, column) in order.iter().enumerate() {
        tile.as_mut().col_mut(place).copy_from(before.col(*column as usize));
    }
}

/// L B; L itself for a definite matrix.
fn weighted(kind: Kind, l: MatRef<'_, f64>, pivots: &Pivots<'_>) -> Mat<f64> {
    let mut product = l.to_owned();
    if kind == Kind::Definite {
        return product;
    }
    let mut j = 0;
    while j < l.ncols() {
        let (d, coupling) = (pivots.diagonal[j], pivots.subdiagonal[j]);
        if coupling == 0.0 {
            product.col_mut(j).iter_mut().for_each(|x| *x *= d);
            j += 1;
        } else {
            let next = pivots.diagonal[j + 1];
            for i in 0..l.nrows() {
                let (x, y) = (l[(i, j)], l[(i, j + 1)]);
                product[(i, j)] = d * x + coupling * y;
                product[(i, j + 1)] = coupling * x + next * y;
            }
            j += 2;
        }
    }
    product
}

/// X B⁻¹.
fn divide_by_pivots(mut x: MatMut<'_, f64>, pivots: &Pivots<'_>) {
    let mut j = 0;
    while j < x.ncols() {
        match Inverse::of(pivots.diagonal, pivots.subdiagonal, j) {
            Inverse::One(inverse) => {
                x.as_mut().col_mut(j).iter_mut().for_each(|x| *x *= inverse);
                j += 1;
            }
            Inverse::Two(inverse) => {
                for i in 0..x.nrows() {
                    let [first, second] = inverse.times([x[(i, j)], x[(i, j + 1)]]);
                    x[(i, j)] = first;
                    x[(i, j + 1)] = second;
                }
                j += 2;
            }
        }
    }
}

/// The inverse of a pivot.
pub(super) enum Inverse {
    /// Of order one.
    One(f64),
    /// Of order two.
    Two(InverseOfTwo),
}

/// The inverse of [a c; c b], scaled by c, which is the largest of the three.
#[derive(Clone, Copy)]
pub(super) struct InverseOfTwo {
    a: f64,
    b: f64,
    factor: f64,
}

impl Inverse {
    /// Of the pivot at column j.
    pub(super) fn of(diagonal: &[f64], subdiagonal: &[f64], j: usize) -> Self {
        let coupling = subdiagonal[j];
        if coupling == 0.0 {
            return Self::One(1.0 / diagonal[j]);
        }
        let (a, b) = (diagonal[j] / coupling, diagonal[j + 1] / coupling);
        Self::Two(InverseOfTwo { a, b, factor: 1.0 / (a * b - 1.0) / coupling })
    }
}

impl InverseOfTwo {
    pub(super) fn times(self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(self.b * x - y) * self.factor, (self.a * y - x) * self.factor]
    }
}
