//! How far L B Lᵀ can be from the matrix that was factored, from the magnitudes of L and B alone.
//!
//! ```text
//! A     n × n   as it was handed to the factorisation, in the order of its pivots
//! E, C          a pivot of B and the updated rows below it: L = C E⁻¹
//! u     half the distance of one to the next double; p, r = the diagonal of E over its off-diagonal entry; q = |pr|
//! ```
//! Every entry of L B Lᵀ is a sum of at most as many products as its shorter row of L has entries, taken in whatever order,
//! which errs by γ of their number times the sum of magnitudes (Higham 2002, lemma 8.4), and each product takes L E or C
//! for one another: |C − LE| ≤ c u |L||E|. So |A − LBLᵀ| ≤ γ_{m+c+1} |L||B||Lᵀ| with m the longest row of L.
//!
//! A pivot of one row is divided by, or multiplied with its reciprocal: c = 2. With one of two rows,
//! l₀ = (r c₀ − c₁)/(e (pr − 1)) and likewise l₁, everything divided by the off-diagonal e first. That is four roundings of p
//! and r, two more of their product and reciprocal with those of pr magnified by q/(1 − q), and the rest of the formula:
//! |L − CE⁻¹| ≤ (9 + 5q/(1 − q)) u |C||E⁻¹|. Multiplying out, |E||E⁻¹||E| ≤ (3 + q)/(1 − q) |E|, so that
//! c = (9 + 5q/(1 − q)) (3 + q)/(1 − q). Pivoting keeps q at 0.41 or below, which makes c = 73; q is measured, and where it reaches
//! one nothing is bounded.

use super::Indefinite;
use crate::factor::rounding::{gamma, largest_row_sum};

impl Indefinite<'_> {
    /// An upper bound of ‖A − LBLᵀ‖₂ of the scaled matrix: its largest row sum.
    pub(super) fn backward_error(&self) -> f64 {
        assert_eq!(self.analysis.n_border(), 0, "the bound is that of a whole matrix");
        let n = self.analysis.n();
        let (pivots, subdiagonal) = (self.diagonal(), self.subdiagonal());
        let (mut columns, mut lengths) = (vec![0.0; n], vec![0usize; n]);
        self.visit(|row, col, value| {
            columns[col] += value.abs();
            lengths[row] += 1;
        });
        let images = magnitudes(&pivots, &subdiagonal, &columns);
        let mut rows = vec![0.0; n];
        self.visit(|row, col, value| rows[row] += value.abs() * images[col]);
        let longest = lengths.into_iter().max().unwrap_or(0);
        match roundings_of_pivots(&pivots, &subdiagonal) {
            Some(c) => gamma(longest + c + 1) * largest_row_sum(&rows),
            None => f64::INFINITY,
        }
    }
}

/// |B| v.
fn magnitudes(pivots: &[f64], below: &[f64], v: &[f64]) -> Vec<f64> {
    let mut image: Vec<f64> = pivots.iter().zip(v).map(|(d, v)| d.abs() * v).collect();
    for (j, e) in below.iter().enumerate().filter(|(_, e)| **e != 0.0) {
        image[j] += e.abs() * v[j + 1];
        image[j + 1] += e.abs() * v[j];
    }
    image
}

/// c of the worst pivot; none where a pivot of two rows is no better than one of one.
fn roundings_of_pivots(pivots: &[f64], below: &[f64]) -> Option<usize> {
    let mut worst = 2;
    for (j, e) in below.iter().enumerate().filter(|(_, e)| **e != 0.0) {
        let q = ((pivots[j] / e) * (pivots[j + 1] / e)).abs();
        if q.is_nan() || q >= 1.0 {
            return None;
        }
        worst = worst.max(((9.0 + 5.0 * q / (1.0 - q)) * (3.0 + q) / (1.0 - q)).ceil() as usize);
    }
    Some(worst)
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::*;
    use crate::factor::Analysis;
    use crate::factor::multifrontal::Keep;
    use crate::random::SplitMix64;
    use crate::sparse::Pencil;
    use crate::sparse::SparseMatrix;

    /// Full blocks of eight coupled to the last one, without a diagonal in every third row: pivots of two rows are needed.
    fn matrix(n: usize, seed: u64) -> Mat<f64> {
        let mut random = Mat::zeros(n, n);
        SplitMix64::new(seed).fill(random.as_mut());
        let is_stored = |i: usize, j: usize| i / 8 == j / 8 || i.max(j) / 8 == (n - 1) / 8;
        Mat::from_fn(n, n, |i, j| match (i == j, is_stored(i, j)) {
            (true, _) => {
                if i % 3 == 0 {
                    0.0
                } else {
                    0.1 * random[(i, i)]
                }
            }
            (false, true) => random[(i.max(j), i.min(j))],
            (false, false) => 0.0,
        })
    }

    fn sparse(matrix: &Mat<f64>) -> SparseMatrix {
        let n = matrix.nrows();
        let (mut pointers, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for i in 0..n {
            for j in (0..n).filter(|j| *j == i || matrix[(i, *j)] != 0.0) {
                columns.push(j as u32);
                values.push(matrix[(i, j)]);
            }
            pointers.push(columns.len());
        }
        SparseMatrix::new((n, n), pointers, columns, values)
    }

    #[test]
    fn bound_holds_and_is_that_of_the_factors_multiplied_out() {
        let n = 64;
        for seed in 0..40 {
            let (k, m) = (sparse(&matrix(n, seed)), sparse(&Mat::identity(n, n)));
            let pencil = Pencil::new(&k, &m);
            let analysis = Analysis::new(pencil).expect("memory");
            let factor = Indefinite::new(&analysis, pencil, 0.0, Keep::Factor).expect("a factor");
            let (pivots, subdiagonal) = (factor.diagonal(), factor.subdiagonal());
            assert!(subdiagonal.iter().filter(|e| **e != 0.0).count() > 5);
            let mut l = Mat::<f64>::zeros(n, n);
            factor.visit(|row, col, value| l[(row, col)] = value);
            let b = Mat::from_fn(n, n, |i, j| match i.abs_diff(j) {
                0 => pivots[i],
                1 => subdiagonal[i.min(j)],
                _ => 0.0,
            });
            let places = factor.numbers.places_of_pivots(&analysis);
            let mut dof_at = vec![0; n];
            for (step, dof) in analysis.given().iter().enumerate() {
                dof_at[places[step]] = *dof as usize;
            }
            let scaled = |i: usize, j: usize| {
                let (i, j) = (dof_at[i], dof_at[j]);
                k.get(i, j).copied().unwrap_or(0.0) * factor.scale[i] * factor.scale[j]
            };
            let absolute = |matrix: &Mat<f64>| Mat::from_fn(n, n, |i, j| matrix[(i, j)].abs());
            let product = &l * &b * l.transpose();
            let sizes = absolute(&l) * absolute(&b) * absolute(&l).transpose();
            let error = (0..n).map(|i| (0..n).map(|j| (product[(i, j)] - scaled(i, j)).abs()).sum::<f64>());
            let error = error.fold(0.0, f64::max);
            let sum = (0..n).map(|i| (0..n).map(|j| sizes[(i, j)]).sum::<f64>()).fold(0.0, f64::max);
            let length = (0..n).map(|i| (0..n).filter(|j| l[(i, *j)] != 0.0).count()).max().expect("rows");
            let bound = factor.backward_error();
            // Multiplying out rounds on its own, by less than the bound does; stored zeros may make rows longer than counted.
            assert!(error <= bound && error > 0.0, "seed {seed}: {error:e} above {bound:e}");
            let least = gamma(length + 2) * sum;
            assert!((least..=gamma(n + 74) * sum * 1.02).contains(&bound), "seed {seed}: {bound:e}, {least:e}");
            let largest = sizes.norm_max();
            let bound = factor.numbers.largest_product;
            assert!(largest <= bound && bound <= 4.0 * largest, "seed {seed}: {largest:e} above {bound:e}");
        }
    }

    #[test]
    fn pivots_of_two_rows_are_bounded_by_what_they_are() {
        assert_eq!(roundings_of_pivots(&[1.0, -2.0], &[0.0, 0.0]), Some(2));
        // 9 · 3 where the diagonal vanishes.
        assert_eq!(roundings_of_pivots(&[0.0, -2.0], &[1.0, 0.0]), Some(27));
        // Bunch and Kaufman's worst: α² = ((1 + √17)/8)² = 0.41.
        let alpha = (1.0 + 17.0_f64.sqrt()) / 8.0;
        assert_eq!(roundings_of_pivots(&[alpha, -alpha], &[1.0, 0.0]), Some(73));
        assert_eq!(roundings_of_pivots(&[1.0, 1.0], &[1.0, 0.0]), None);
        assert_eq!(roundings_of_pivots(&[f64::NAN, 1.0], &[1.0, 0.0]), None);
    }
}
