//! The few dense operations the method needs, on faer's kernels.
//!
//! Matrix products are cut into tiles of a fixed size, each done by one thread: the same bits for any number of threads.
//! Decompositions of small matrices run sequentially.

use std::collections::BTreeSet;

use faer::linalg::matmul::matmul;
use faer::linalg::solvers::{Solve, SolveLstsq};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, Mat, MatMut, MatRef, Par, Side};

use crate::error::{Error, Result};

/// How much faster operations of dense blocks are than those of a triangular solve, which waits for memory. For forecasts of time.
pub const GAIN: f64 = 4.0;

/// How far roundings of one sign may exceed their typical sum: for limits of what sums of many terms leave.
pub const NOISE_FACTOR: f64 = 10.0;

/// Products smaller than this many multiplications are done by one thread: starting a second one costs more.
const PARALLEL_ABOVE: usize = 1 << 18;

/// Rows of a tile of [`gram`]: fixed, so that the order of the sum never depends on the number of threads.
const GRAM_ROWS: usize = 4096;
/// Rows of a tile of [`add_product`] and [`divide`].
const PRODUCT_ROWS: usize = 1024;

/// Xᵀ Y for tall X and Y: tile by tile in parallel, the tiles summed in order.
pub fn gram(x: MatRef<'_, f64>, y: MatRef<'_, f64>) -> Mat<f64> {
    use rayon::prelude::*;
    let n = x.nrows();
    let tiles: Vec<Mat<f64>> = (0..n.div_ceil(GRAM_ROWS))
        .into_par_iter()
        .map(|tile| {
            let (start, rows) = (tile * GRAM_ROWS, GRAM_ROWS.min(n - tile * GRAM_ROWS));
            let mut part = Mat::zeros(x.ncols(), y.ncols());
            let (x, y) = (x.subrows(start, rows), y.subrows(start, rows));
            matmul(part.as_mut(), Accum::Replace, x.transpose(), y, 1.0, Par::Seq);
            part
        })
        .collect();
    let mut sum = Mat::zeros(x.ncols(), y.ncols());
    for part in &tiles {
        sum += part;
    }
    sum
}

/// The rows of a square matrix with the numbers given, and the same columns.
pub fn part(a: MatRef<'_, f64>, numbers: &[usize]) -> Mat<f64> {
    Mat::from_fn(numbers.len(), numbers.len(), |i, j| a[(numbers[i], numbers[j])])
}

/// The columns of X with these numbers, in their order.
pub fn columns(x: MatRef<'_, f64>, numbers: &[usize]) -> Mat<f64> {
    Mat::from_fn(x.nrows(), numbers.len(), |i, j| x[(i, numbers[j])])
}

/// X C.
pub fn product(x: MatRef<'_, f64>, c: MatRef<'_, f64>) -> Mat<f64> {
    let mut out = Mat::zeros(x.nrows(), c.ncols());
    add_product(out.as_mut(), 1.0, x, c);
    out
}

/// Y ← Y + α X C.
pub fn add_product(mut y: MatMut<'_, f64>, alpha: f64, x: MatRef<'_, f64>, c: MatRef<'_, f64>) {
    use rayon::prelude::*;
    let tile = |first: usize, y: MatMut<'_, f64>| {
        let x = x.subrows(first, y.nrows());
        matmul(y, Accum::Add, x, c, alpha, Par::Seq);
    };
    let n = y.nrows();
    if x.nrows() * x.ncols() * c.ncols() > PARALLEL_ABOVE {
        y.par_row_chunks_mut(PRODUCT_ROWS).enumerate().for_each(|(at, y)| tile(at * PRODUCT_ROWS, y));
        return;
    }
    for first in (0..n).step_by(PRODUCT_ROWS) {
        tile(first, y.as_mut().subrows_mut(first, PRODUCT_ROWS.min(n - first)));
    }
}

/// X ← X L⁻ᵀ.
pub fn divide(x: MatMut<'_, f64>, lower: MatRef<'_, f64>) {
    use rayon::prelude::*;
    x.par_row_chunks_mut(PRODUCT_ROWS).for_each(|tile| {
        faer::linalg::triangular_solve::solve_lower_triangular_in_place(lower, tile.transpose_mut(), Par::Seq);
    });
}

/// L⁻¹ A L⁻ᵀ of a symmetric matrix by the Cholesky factor L of another: the pencil of the two in standard form. Symmetric to rounding.
pub fn standard_form(l: MatRef<'_, f64>, mut a: Mat<f64>) -> Mat<f64> {
    for _ in 0..2 {
        solve_lower_triangular_in_place(l, a.as_mut(), Par::Seq);
        a = a.transpose().to_owned();
    }
    a
}

/// Eigenvalues in ascending order and orthonormal eigenvectors of a symmetric matrix (lower triangle read).
///
/// # Errors
/// The iteration did not converge, which means that the matrix holds values that are not numbers.
pub fn symmetric_eigen(a: MatRef<'_, f64>) -> Result<(Vec<f64>, Mat<f64>)> {
    if a.nrows() == 0 {
        return Ok((Vec::new(), Mat::zeros(0, 0)));
    }
    if !a.is_all_finite() {
        return Err(Error::DenseEigen { n: a.nrows() });
    }
    // The decomposition of large matrices drops couplings below an absolute size, so that only a matrix of size one keeps its digits.
    let largest = a.norm_max();
    let unit = if largest.is_normal() { 2f64.powi(-(largest.log2().round() as i32)) } else { 1.0 };
    let scaled = a * faer::Scale(unit);
    let eigen = scaled.self_adjoint_eigen(Side::Lower).map_err(|_| Error::DenseEigen { n: a.nrows() })?;
    Ok((eigen.S().column_vector().iter().map(|value| value / unit).collect(), eigen.U().to_owned()))
}

/// D A D with diagonal entries near one, for a symmetric matrix A, and the powers of two on the diagonal of D.
pub(crate) fn unit_diagonal(a: MatRef<'_, f64>) -> (Mat<f64>, Vec<f64>) {
    let scale: Vec<f64> = (0..a.nrows()).map(|i| power_of_two_root(a[(i, i)])).collect();
    (Mat::from_fn(a.nrows(), a.nrows(), |i, j| a[(i, j)] * scale[i] * scale[j]), scale)
}

/// The numbers below n in parts, each of those that `are_joined` directly or by others.
pub(crate) fn joined_parts(n: usize, are_joined: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut left: BTreeSet<usize> = (0..n).collect();
    let mut parts = Vec::new();
    while let Some(first) = left.pop_first() {
        let (mut part, mut next) = (vec![first], 0);
        while let Some(at) = part.get(next).copied() {
            let joined: Vec<usize> = left.iter().copied().filter(|other| are_joined(at, *other)).collect();
            joined.iter().for_each(|other| _ = left.remove(other));
            part.extend(joined);
            next += 1;
        }
        parts.push(part);
    }
    parts
}

/// The space of some columns in a basis that is orthonormal in M; what M does not see is left out, and what is rounding of the columns.
///
/// By Gram and Schmidt with pivots, and not from the Gram matrix, which holds the squares of what columns keep beyond the others: next to a
/// heavy mass that is 10⁻⁷ of rotations about it.
pub(crate) fn orthonormal(columns: MatRef<'_, f64>, m: MatRef<'_, f64>) -> Mat<f64> {
    let rounding = NOISE_FACTOR * columns.nrows() as f64 * f64::EPSILON;
    let sizes = absolute(m);
    let terms = |x: MatRef<'_, f64>| {
        let x = absolute(x);
        dots(x.as_ref(), product(sizes.as_ref(), x.as_ref()).as_ref())
    };
    let whole: Vec<f64> = terms(columns).into_iter().map(f64::sqrt).collect();
    let (mut left, mut momenta) = (columns.to_owned(), product(m, columns));
    let mut basis = Mat::zeros(columns.nrows(), 0);
    let mut open: Vec<usize> = (0..columns.ncols()).collect();
    let share = |left: &Mat<f64>, momenta: &Mat<f64>, j: usize| {
        let square = dot(column(left.as_ref(), j), column(momenta.as_ref(), j)).max(0.0);
        if whole[j] > 0.0 { square.sqrt() / whole[j] } else { 0.0 }
    };
    while let Some(place) =
        (0..open.len()).max_by(|a, b| share(&left, &momenta, open[*a]).total_cmp(&share(&left, &momenta, open[*b])))
    {
        let j = open.swap_remove(place);
        let mut next = left.as_ref().subcols(j, 1).to_owned();
        // Once more for orthogonality to rounding.
        let along = gram(product(m, basis.as_ref()).as_ref(), next.as_ref());
        add_product(next.as_mut(), -1.0, basis.as_ref(), along.as_ref());
        let momentum = product(m, next.as_ref());
        let square = dots(next.as_ref(), momentum.as_ref())[0].max(0.0);
        if square.sqrt() <= rounding * whole[j] || square <= rounding * terms(next.as_ref())[0] {
            continue;
        }
        let [next, momentum] = [next, momentum].map(|column| column * faer::Scale(1.0 / square.sqrt()));
        for other in &open {
            let along = dot(column(momentum.as_ref(), 0), column(left.as_ref(), *other));
            add_scaled(column_mut(left.as_mut(), *other), -along, column(next.as_ref(), 0));
            add_scaled(column_mut(momenta.as_mut(), *other), -along, column(momentum.as_ref(), 0));
        }
        basis = side_by_side(basis.as_ref(), next.as_ref());
    }
    basis
}

/// Singular values (descending) and right singular vectors of a matrix with at least as many rows as columns.
///
/// # Errors
/// As [`symmetric_eigen`].
pub fn right_singular(a: MatRef<'_, f64>) -> Result<(Vec<f64>, Mat<f64>)> {
    if a.ncols() == 0 {
        return Ok((Vec::new(), Mat::zeros(0, 0)));
    }
    let svd = a.thin_svd().map_err(|_| Error::DenseEigen { n: a.ncols() })?;
    Ok((svd.S().column_vector().iter().copied().collect(), svd.V().to_owned()))
}

/// The rank of a set of rows of six, with every column scaled to unit length first.
pub fn rank_of_rows(rows: &[[f64; 6]], tolerance: f64) -> usize {
    let mut scale = [0.0f64; 6];
    for row in rows {
        for (sum, value) in scale.iter_mut().zip(row) {
            *sum += value * value;
        }
    }
    // The square of a short column disappears next to that of a long one; a QR factorisation of the rows keeps it.
    let n_rows = rows.len().max(6);
    let scaled = Mat::from_fn(n_rows, 6, |i, j| match rows.get(i) {
        Some(row) if scale[j] > 0.0 => row[j] / scale[j].sqrt(),
        _ => 0.0,
    });
    let Ok((singular, _)) = right_singular(scaled.as_ref()) else {
        return 0;
    };
    let largest = singular.first().copied().unwrap_or(0.0);
    singular.iter().filter(|value| **value > tolerance * largest).count()
}

/// The power of two nearest 1/√d, by which a dof of stiffness d is scaled to order one; one where d is not positive.
pub fn power_of_two_root(d: f64) -> f64 {
    if d > 0.0 && d.is_finite() { 2f64.powi((-0.5 * d.log2()).round() as i32) } else { 1.0 }
}

/// Whether an error is worse than the worst so far: a value that is not a number is the worst of all and stays so.
pub fn worse(error: f64, worst: f64) -> bool {
    !worst.is_nan() && (error.is_nan() || error > worst)
}

/// x with the least ‖A x − f‖; A has at least as many rows as columns. Where columns vanish or are the same, because the interface
/// has modes of its own at this frequency, x is the shortest such.
pub fn least_squares(a: MatRef<'_, f64>, f: MatRef<'_, f64>) -> Mat<f64> {
    let x = a.qr().solve_lstsq(f);
    if x.is_all_finite() {
        return x;
    }
    let Ok(svd) = a.thin_svd() else { return x };
    let singular: Vec<f64> = svd.S().column_vector().iter().copied().collect();
    let least = a.nrows() as f64 * f64::EPSILON * singular.first().copied().unwrap_or(0.0);
    let mut parts = product(svd.U().transpose(), f);
    for (i, value) in singular.iter().enumerate() {
        let factor = if *value > least { 1.0 / value } else { 0.0 };
        parts.row_mut(i).iter_mut().for_each(|part| *part *= factor);
    }
    product(svd.V(), parts.as_ref())
}

/// A⁻¹ of a small regular matrix.
pub fn inverse(a: MatRef<'_, f64>) -> Mat<f64> {
    a.partial_piv_lu().solve(Mat::<f64>::identity(a.nrows(), a.nrows()))
}

/// B A⁻¹ of a small regular matrix A by the pivots of A: of an upper triangle they are its diagonal, and columns of any sizes keep their
/// digits.
pub fn divided(b: MatRef<'_, f64>, a: MatRef<'_, f64>) -> Mat<f64> {
    a.partial_piv_lu().solve_transpose(b.transpose().to_owned()).transpose().to_owned()
}

/// |A|, entry by entry.
pub fn absolute(a: MatRef<'_, f64>) -> Mat<f64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)].abs())
}

/// A matrix of a superelement by columns.
pub fn unpacked(matrix: &supel_runtime::Matrix) -> Mat<f64> {
    Mat::from_fn(matrix.rows(), matrix.cols(), |i, j| matrix[(i, j)])
}

/// [A B].
pub fn side_by_side(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    concatenated(a.nrows(), [a, b])
}

/// [A B …] of `n_rows` rows, however many parts there are.
pub fn concatenated<'a>(n_rows: usize, parts: impl IntoIterator<Item = MatRef<'a, f64>>) -> Mat<f64> {
    let parts: Vec<_> = parts.into_iter().collect();
    let mut whole = Mat::zeros(n_rows, parts.iter().map(|part| part.ncols()).sum());
    let mut at = 0;
    for part in parts {
        whole.as_mut().subcols_mut(at, part.ncols()).copy_from(part);
        at += part.ncols();
    }
    whole
}

/// The worst of some errors; zero where there are none.
pub fn worst(errors: impl IntoIterator<Item = f64>) -> f64 {
    errors.into_iter().fold(0.0, |worst, error| if worse(error, worst) { error } else { worst })
}

/// The Euclidean norm of a column.
pub fn norm(column: &[f64]) -> f64 {
    dot(column, column).sqrt()
}

/// The scalar product of two columns, summed in a fixed order.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    // Eight partial sums let the compiler use vector registers; their order never depends on the machine.
    let mut sums = [0.0; 8];
    let (x_blocks, x_rest) = x.as_chunks::<8>();
    let (y_blocks, y_rest) = y.as_chunks::<8>();
    for (a, b) in x_blocks.iter().zip(y_blocks) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = x_rest.iter().zip(y_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// x_jᵀ y_j of the columns of two blocks of one shape.
pub fn dots(x: MatRef<'_, f64>, y: MatRef<'_, f64>) -> Vec<f64> {
    (0..x.ncols()).map(|j| dot(column(x, j), column(y, j))).collect()
}

/// Y ← Y + α X on columns.
pub fn add_scaled(y: &mut [f64], alpha: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += alpha * x;
    }
}

/// A column of a matrix as a slice.
///
/// # Panics
/// If the matrix is not stored by columns.
pub fn column<'a>(a: MatRef<'a, f64>, j: usize) -> &'a [f64] {
    a.col(j).try_as_col_major().expect("stored by columns").as_slice()
}

/// A column of a matrix as a mutable slice.
///
/// # Panics
/// If the matrix is not stored by columns.
pub fn column_mut<'a>(a: MatMut<'a, f64>, j: usize) -> &'a mut [f64] {
    a.col_mut(j).try_as_col_major_mut().expect("stored by columns").as_slice_mut()
}

/// A ← (A + Aᵀ)/2; returns max |A − Aᵀ| / max |A|.
pub fn symmetrise(a: &mut Mat<f64>) -> f64 {
    let (mut difference, mut largest) = (0.0f64, 0.0f64);
    for j in 0..a.ncols() {
        for i in 0..=j {
            difference = difference.max((a[(i, j)] - a[(j, i)]).abs());
            largest = largest.max(a[(i, j)].abs());
            let mean = 0.5 * (a[(i, j)] + a[(j, i)]);
            a[(i, j)] = mean;
            a[(j, i)] = mean;
        }
    }
    if largest > 0.0 { difference / largest } else { 0.0 }
}

/// The diagonal of a square matrix.
pub(crate) fn diagonal(a: MatRef<'_, f64>) -> Vec<f64> {
    (0..a.ncols()).map(|i| a[(i, i)]).collect()
}

/// |B|ᵀs: what combinations of columns of sizes s add up to at most.
pub(crate) fn summed_sizes(sizes: &[f64], b: MatRef<'_, f64>) -> Vec<f64> {
    (0..b.ncols()).map(|k| sizes.iter().enumerate().map(|(j, size)| size * b[(j, k)].abs()).sum()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    /// Of matrices large enough to be divided, down to sizes that an absolute threshold would take for nothing.
    #[test]
    fn eigenpairs_are_as_good_whatever_the_size_of_the_matrix() {
        let n = 150;
        let mut random = Mat::zeros(n, n);
        SplitMix64::new(1).fill(random.as_mut());
        for size in [1.0, 1e-10, 1e-200, 1e200] {
            let a = Mat::from_fn(n, n, |i, j| size * (random[(i, j)] + random[(j, i)]));
            let (values, vectors) = symmetric_eigen(a.as_ref()).expect("numbers");
            let image = product(a.as_ref(), vectors.as_ref());
            let residual = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
            let worst = residual.map(|(i, j)| (image[(i, j)] - values[j] * vectors[(i, j)]).abs()).fold(0.0, f64::max);
            // Backward stable: n ε ‖A‖₂, and ‖A‖₂ is the largest of the values.
            let norm = values[n - 1].max(-values[0]);
            assert!(worst <= n as f64 * f64::EPSILON * norm, "{size:e}: {:.1e}", worst / norm);
        }
    }
}
