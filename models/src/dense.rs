//! Eigenvalues of small models by dense Jacobi rotations, the oracle of the tests.
//!
//! Shapes: K, M n × n; C = L⁻¹ K L⁻ᵀ with M = L Lᵀ. Cost about 30 n³; meant for n up to a few hundred.

// Index loops read like the formulas they compute.
#![allow(clippy::needless_range_loop)]

use crate::model::{Entry, Model};

/// All eigenvalues λ of K x = λ M x, ascending.
///
/// # Panics
/// If M is not positive definite or the sweeps do not converge.
pub fn spectrum(model: &Model) -> Vec<f64> {
    let lower = cholesky(dense(model.n, &model.mass));
    let mut c = dense(model.n, &model.stiffness);
    forward_substitute(&lower, &mut c);
    transpose(&mut c);
    forward_substitute(&lower, &mut c);
    symmetrise(&mut c);
    let mut eigenvalues = jacobi(c);
    eigenvalues.sort_by(f64::total_cmp);
    eigenvalues
}

/// The largest absolute difference of two lists of equal length.
///
/// # Panics
/// If the lengths differ.
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "lists of different length");
    a.iter().zip(b).fold(0.0, |worst, (x, y)| (x - y).abs().max(worst))
}

/// A dense matrix by rows.
pub fn dense(n: usize, entries: &[Entry]) -> Vec<Vec<f64>> {
    let mut matrix = vec![vec![0.0; n]; n];
    for &(row, column, value) in entries {
        matrix[row as usize][column as usize] = value;
    }
    matrix
}

/// Lower Cholesky factor.
fn cholesky(mut a: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = a.len();
    for j in 0..n {
        let pivot = a[j][j] - a[j][..j].iter().map(|x| x * x).sum::<f64>();
        assert!(pivot > 0.0, "mass matrix is not positive definite at row {j}: pivot {pivot}");
        a[j][j] = pivot.sqrt();
        for i in j + 1..n {
            let product: f64 = a[i][..j].iter().zip(&a[j][..j]).map(|(x, y)| x * y).sum();
            a[i][j] = (a[i][j] - product) / a[j][j];
        }
    }
    a
}

/// B ← L⁻¹ B.
fn forward_substitute(lower: &[Vec<f64>], b: &mut [Vec<f64>]) {
    for i in 0..b.len() {
        let (done, rest) = b.split_at_mut(i);
        let row = &mut rest[0];
        for (k, solved) in done.iter().enumerate() {
            let factor = lower[i][k];
            if factor != 0.0 {
                row.iter_mut().zip(solved).for_each(|(x, y)| *x -= factor * y);
            }
        }
        row.iter_mut().for_each(|x| *x /= lower[i][i]);
    }
}

fn transpose(a: &mut [Vec<f64>]) {
    for i in 0..a.len() {
        for j in 0..i {
            let (above, below) = a.split_at_mut(i);
            std::mem::swap(&mut above[j][i], &mut below[0][j]);
        }
    }
}

fn symmetrise(a: &mut [Vec<f64>]) {
    for i in 0..a.len() {
        for j in 0..i {
            let mean = 0.5 * (a[i][j] + a[j][i]);
            a[i][j] = mean;
            a[j][i] = mean;
        }
    }
}

/// Eigenvalues of a symmetric matrix by cyclic Jacobi rotations.
fn jacobi(mut a: Vec<Vec<f64>>) -> Vec<f64> {
    // Convergence is quadratic, but inside an exactly multiple eigenvalue a sweep may only halve what is left.
    const MAX_SWEEPS: usize = 100;
    let n = a.len();
    let scale = a.iter().flatten().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    for _ in 0..MAX_SWEEPS {
        let off = (0..n).flat_map(|i| a[i][..i].iter()).fold(0.0_f64, |largest, x| largest.max(x.abs()));
        if off <= scale * 1e-18 {
            return (0..n).map(|i| a[i][i]).collect();
        }
        for p in 0..n {
            for q in p + 1..n {
                rotate(&mut a, p, q);
            }
        }
    }
    panic!("Jacobi rotations did not converge in {MAX_SWEEPS} sweeps");
}

/// One rotation in the plane (p, q) that annihilates a_pq.
fn rotate(a: &mut [Vec<f64>], p: usize, q: usize) {
    let a_pq = a[p][q];
    if a_pq == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a_pq);
    // The smaller root, so that the angle stays below 45°.
    let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
    let c = 1.0 / t.hypot(1.0);
    let s = t * c;
    a[p][p] -= t * a_pq;
    a[q][q] += t * a_pq;
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    for i in (0..a.len()).filter(|&i| i != p && i != q) {
        let (x, y) = (a[p][i], a[q][i]);
        a[p][i] = c * x - s * y;
        a[q][i] = s * x + c * y;
        a[i][p] = a[p][i];
        a[i][q] = a[q][i];
    }
}
