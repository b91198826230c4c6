//! The few products of small dense matrices that an evaluation needs, none of which allocates.
//!
//! | symbol | meaning | layout |
//! |---|---|---|
//! | A | r × r | row by row |
//! | Q, Y | r × 6 | one array of six for each of the r coordinates |
//! | J, F | 6 × 6 for each interface node; the identity and zero at the modal amplitudes | [`Matrix6`] |

use crate::motion::{Matrix6, Vector6, transposed_times_6};

/// A x for symmetric A, r × r. The rows are added four at a time, which keeps the sums in registers.
pub(crate) fn symmetric_times(a: &[f64], x: &[f64], product: &mut [f64]) {
    let r = x.len();
    product.fill(0.0);
    let mut rows = a.chunks_exact(4 * r);
    let mut factors = x.chunks_exact(4);
    for (four, factor) in rows.by_ref().zip(factors.by_ref()) {
        let (first, rest) = four.split_at(r);
        let (second, rest) = rest.split_at(r);
        let (third, fourth) = rest.split_at(r);
        let entries = first.iter().zip(second).zip(third.iter().zip(fourth));
        for (sum, ((a, b), (c, d))) in product.iter_mut().zip(entries) {
            *sum += (factor[0] * a + factor[1] * b) + (factor[2] * c + factor[3] * d);
        }
    }
    for (row, factor) in rows.remainder().chunks_exact(r).zip(factors.remainder()) {
        add_scaled(product, *factor, row);
    }
}

/// A x for any A, r × r. Four rows at a time, whose sums do not wait for each other.
pub(crate) fn times(a: &[f64], x: &[f64], product: &mut [f64]) {
    let r = x.len();
    let mut rows = a.chunks_exact(4 * r);
    let mut targets = product.chunks_exact_mut(4);
    for (four, target) in rows.by_ref().zip(targets.by_ref()) {
        let (first, rest) = four.split_at(r);
        let (second, rest) = rest.split_at(r);
        let (third, fourth) = rest.split_at(r);
        let mut sums = [0.0; 4];
        for ((x, (a, b)), (c, d)) in x.iter().zip(first.iter().zip(second)).zip(third.iter().zip(fourth)) {
            sums = [sums[0] + a * x, sums[1] + b * x, sums[2] + c * x, sums[3] + d * x];
        }
        target.copy_from_slice(&sums);
    }
    for (row, target) in rows.remainder().chunks_exact(r).zip(targets.into_remainder()) {
        *target = dot(row, x);
    }
}

/// y += s x.
#[inline]
pub(crate) fn add_scaled(y: &mut [f64], s: f64, x: &[f64]) {
    for (sum, value) in y.iter_mut().zip(x) {
        *sum += s * value;
    }
}

/// a + s b.
#[inline]
pub(crate) fn plus_scaled(a: &Vector6, s: f64, b: &Vector6) -> Vector6 {
    core::array::from_fn(|i| a[i] + s * b[i])
}

/// xᵀy.
#[inline]
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(a, b)| a * b).sum()
}

/// Yᵀx, six values.
#[inline]
pub(crate) fn columns_times(y: &[Vector6], x: &[f64]) -> Vector6 {
    let mut sum = [0.0; 6];
    for (row, value) in y.iter().zip(x) {
        sum = plus_scaled(&sum, *value, row);
    }
    sum
}

/// Σ Y_jᵀ A_j over the nodes, 6 × 6.
pub(crate) fn block_sum<'a>(y: &[Vector6], blocks: impl Iterator<Item = &'a Matrix6>) -> Matrix6 {
    let mut sum = [[0.0; 6]; 6];
    for (rows, block) in y.as_chunks::<6>().0.iter().zip(blocks) {
        for (row, block_row) in rows.iter().zip(block) {
            for (target, value) in sum.iter_mut().zip(row) {
                *target = plus_scaled(target, *value, block_row);
            }
        }
    }
    sum
}

/// Row i: Σ_c A_ci Y_c, the rows of AᵀY for a 6 × 6 block A and six rows Y.
#[inline]
pub(crate) fn turned_rows(block: &Matrix6, rows: &[Vector6; 6]) -> [Vector6; 6] {
    let mut turned = [[0.0; 6]; 6];
    for (block_row, row) in block.iter().zip(rows) {
        for (target, factor) in turned.iter_mut().zip(block_row) {
            *target = plus_scaled(target, *factor, row);
        }
    }
    turned
}

/// Inverse of a 6 × 6 matrix of order one by elimination with row exchanges; `None` where a pivot falls below
/// `smallest` or is not a number.
pub(crate) fn inverse(a: &Matrix6, smallest: f64) -> Option<Matrix6> {
    let mut left = *a;
    let mut right = crate::motion::IDENTITY_6;
    for column in 0..6 {
        let pivot_row = (column..6)
            .fold(column, |best, row| if left[row][column].abs() > left[best][column].abs() { row } else { best });
        left.swap(column, pivot_row);
        right.swap(column, pivot_row);
        let pivot = left[column][column];
        let is_sound = pivot.abs() >= smallest;
        if !is_sound {
            return None;
        }
        (left[column], right[column]) = (left[column].map(|x| x / pivot), right[column].map(|x| x / pivot));
        let (pivot_left, pivot_right) = (left[column], right[column]);
        for row in (0..6).filter(|row| *row != column) {
            let factor = left[row][column];
            left[row] = plus_scaled(&left[row], -factor, &pivot_left);
            right[row] = plus_scaled(&right[row], -factor, &pivot_right);
        }
    }
    Some(right)
}

/// Aᵀ.
#[inline]
pub(crate) fn transposed(a: &Matrix6) -> Matrix6 {
    core::array::from_fn(|i| core::array::from_fn(|j| a[j][i]))
}

/// y_i ← S y_i for each of the rows of Y.
#[inline]
pub(crate) fn apply_to_rows(s: &Matrix6, rows: &mut [Vector6]) {
    // Sᵀ once, so that each row is a sum of rows.
    let transposed = transposed(s);
    for row in rows {
        *row = transposed_times_6(&transposed, row);
    }
}

/// The six rows of length r of an r × 6 matrix.
pub(crate) fn transpose(tall: &[Vector6], wide: &mut [f64]) {
    let r = tall.len();
    for (i, row) in tall.iter().enumerate() {
        for (c, value) in row.iter().enumerate() {
            wide[c * r + i] = *value;
        }
    }
}

/// y += Σ_c f_c x_c for six rows x_c, of which the first `skip` entries are left out.
#[inline]
pub(crate) fn add_six(y: &mut [f64], f: &Vector6, rows: &[f64], skip: usize) {
    let n = y.len();
    let row = |c: usize| &rows[c * (n + skip) + skip..(c + 1) * (n + skip)][..n];
    let [x0, x1, x2, x3, x4, x5] = [row(0), row(1), row(2), row(3), row(4), row(5)];
    for (i, sum) in y.iter_mut().enumerate() {
        *sum += (f[0] * x0[i] + f[1] * x1[i] + f[2] * x2[i]) + (f[3] * x3[i] + f[4] * x4[i] + f[5] * x5[i]);
    }
}

/// Whether an r × r matrix is that of its transpose, to the bit.
pub(crate) fn is_symmetric(a: &[f64], r: usize) -> bool {
    (0..r).all(|i| (0..i).all(|j| a[i * r + j] == a[j * r + i]))
}

/// Copies the upper triangle of an r × r matrix to the lower one.
pub(crate) fn mirror(a: &mut [f64], r: usize) {
    for i in 0..r {
        for j in 0..i {
            a[i * r + j] = a[j * r + i];
        }
    }
}
