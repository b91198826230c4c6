//! One basis for a repeated eigenvalue, independent of the one that the eigensolver found.
//!
//! Any rotation of the modes of a repeated eigenvalue is a basis too: a last bit of K, another start vector or another machine
//! turns them by arbitrary angles. Of all rotations X Q one is taken that depends on the subspace alone: at the dof with
//! the largest share of the modal mass only the first mode moves, at the next such dof only the first two, and so on.

use std::ops::Range;

use faer::{Mat, MatMut};

use super::ModeError;
use crate::dense;
use crate::sparse::Leading;

/// Eigenvalues nearer than this many roundings ε c of them are one: c adds all roundings with one sign, and neither of the
/// two is off by more.
pub const REPEATED_WITHIN: f64 = 4.0;
/// Shares of the modal mass nearer than this, relatively, are alike, as in symmetric structures; the first dof is then
/// taken. Far above the error of a subspace, far below what differs by design.
const ALIKE: f64 = 1e-6;

/// The modes of each repeated eigenvalue: runs of eigenvalues that the rounding of their quotients cannot tell apart.
pub(super) fn repeated(lambda: &[f64], errors: &[ModeError]) -> Vec<Range<usize>> {
    runs(lambda, errors, REPEATED_WITHIN)
}

/// For each mode how many, itself among them, may have been taken for copies of one eigenvalue by whoever has these quotients but for
/// their rounding.
pub(crate) fn taken_for_one(lambda: &[f64], errors: &[ModeError]) -> Vec<usize> {
    let mut n_alike = vec![1; lambda.len()];
    for run in runs(lambda, errors, 2.0 * REPEATED_WITHIN) {
        n_alike[run.clone()].fill(run.len());
    }
    n_alike
}

/// How far the mean of so many quotients may be from each, relative to it: half of what neighbours of a run may differ by, for each of them.
/// It is not what they differ by here, which another eigensolver would find otherwise.
pub(crate) fn mean_is_away(cancellation: f64, n_quotients: usize) -> f64 {
    0.5 * REPEATED_WITHIN * (n_quotients - 1) as f64 * f64::EPSILON * cancellation
}

/// Runs of eigenvalues no further from each other than so many roundings.
fn runs(lambda: &[f64], errors: &[ModeError], within: f64) -> Vec<Range<usize>> {
    let is_tied = |j: usize| {
        let rounding = |j: usize| f64::EPSILON * errors[j].cancellation * lambda[j].abs();
        // Zero modes are left as they are: all of them are rounding of one size, whatever body they belong to.
        let is_known = |j: usize| f64::EPSILON * errors[j].cancellation < 0.1;
        is_known(j) && is_known(j - 1) && (lambda[j] - lambda[j - 1]).abs() <= within * rounding(j).max(rounding(j - 1))
    };
    let mut runs = Vec::new();
    let mut start = 0;
    for end in 1..=lambda.len() {
        if end == lambda.len() || !is_tied(end) {
            if end - start > 1 {
                runs.push(start..end);
            }
            start = end;
        }
    }
    runs
}

/// Turns the modes of every repeated eigenvalue into the basis that the subspace defines.
pub(super) fn canonicalise(mass: Leading<'_>, runs: &[Range<usize>], shapes: &mut Mat<f64>) {
    let weights = if runs.is_empty() { Vec::new() } else { mass.diagonal() };
    for run in runs {
        turn(&weights, shapes.as_mut().subcols_mut(run.start, run.len()));
    }
}

/// Gives every mode of a repeated eigenvalue the mean of the quotients, and the largest bar of them, which holds for the mean
/// whatever the basis. What a quotient may be away from the mean adds to it.
///
/// Bars are relative to a quotient: one that stayed relative to its own quotient would be wrong for the mean.
pub(super) fn average(runs: &[Range<usize>], lambda: &mut [f64], errors: &mut [ModeError]) {
    for run in runs {
        let (of_run, errors) = (&mut lambda[run.clone()], &mut errors[run.clone()]);
        let mean = of_run.iter().sum::<f64>() / of_run.len() as f64;
        let largest = |bar: &dyn Fn(&ModeError) -> f64| {
            let absolute = errors.iter().zip(of_run.iter()).map(|(error, lambda)| bar(error) * lambda.abs());
            absolute.fold(0.0, f64::max) / mean.abs()
        };
        let cancellation = largest(&|error| error.cancellation);
        let data_bar = largest(&|error| error.data_bar) + mean_is_away(cancellation, of_run.len());
        let rounding_floor = errors.iter().map(|error| error.rounding_floor).fold(0.0, f64::max);
        let zero_level = errors.iter().map(|error| error.zero_level).fold(0.0, f64::max);
        for error in errors {
            let relative_bar = data_bar;
            *error = ModeError { cancellation, data_bar, relative_bar, rounding_floor, zero_level, ..*error };
        }
        of_run.fill(mean);
    }
}

/// X ← X Q with the rows of the pivots lower triangular and positive on their diagonal.
fn turn(weights: &[f64], mut x: MatMut<'_, f64>) {
    for first in 0..x.ncols() {
        let width = x.ncols() - first;
        let mut rest = x.as_mut().subcols_mut(first, width);
        let row = pivot(weights, &rest);
        // The reflection that takes the pivot's row r to (|r|, 0, …, 0), written as I − v vᵀ / (vᵀv / 2).
        let mut v: Vec<f64> = (0..rest.ncols()).map(|j| rest[(row, j)]).collect();
        let length = dense::norm(&v);
        let sign = if v[0] > 0.0 { 1.0 } else { -1.0 };
        v[0] += sign * length;
        let half = 0.5 * dense::dot(&v, &v);
        for i in 0..rest.nrows() {
            let along: f64 = (0..v.len()).map(|j| rest[(i, j)] * v[j]).sum::<f64>() / half;
            (0..v.len()).for_each(|j| rest[(i, j)] -= along * v[j]);
            // The reflection makes the pivot −sign·|r|.
            rest[(i, 0)] *= -sign;
        }
    }
}

/// The first dof whose share of the modal mass, summed over the modes, is the largest.
fn pivot(weights: &[f64], x: &MatMut<'_, f64>) -> usize {
    let share = |i: usize| weights[i].max(0.0) * (0..x.ncols()).map(|j| x[(i, j)].powi(2)).sum::<f64>();
    let shares: Vec<f64> = (0..x.nrows()).map(share).collect();
    let largest = shares.iter().fold(0.0f64, |max, share| max.max(*share));
    shares.iter().position(|share| *share >= (1.0 - ALIKE) * largest).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two bases of one subspace become one basis, whose first pivot moves in the first mode alone.
    #[test]
    fn rotated_pair_comes_back() {
        let n = 7;
        let mass = crate::sparse::SparseMatrix::new((n, n), (0..=n).collect(), (0..n as u32).collect(), vec![1.0; n]);
        let plane = Mat::from_fn(n, 2, |i, j| if i % 2 == j { (1.0 + i as f64) / 9.0 } else { 0.0 });
        let error = ModeError { cancellation: 4.0, ..ModeError::default() };
        let turned = |angle: f64| {
            let (s, c) = angle.sin_cos();
            let mut x = Mat::from_fn(n, 2, |i, j| {
                if j == 0 { c * plane[(i, 0)] + s * plane[(i, 1)] } else { c * plane[(i, 1)] - s * plane[(i, 0)] }
            });
            canonicalise(Leading::from(&mass), &repeated(&[1.0, 1.0], &[error; 2]), &mut x);
            x
        };
        let reference = turned(0.0);
        assert!((reference.as_ref() - plane.as_ref()).norm_max() < 1e-15, "{reference:?}");
        for angle in [0.3, 1.0, 2.0, 4.0] {
            assert!((turned(angle) - &reference).norm_max() < 1e-15, "{angle}");
        }
        assert_eq!(repeated(&[1.0, 1.0, 1.0 + 1e-12, 2.0, 2.0], &[error; 5]), [0..2, 3..5]);
    }

    /// Zero modes are no run; were they one, their mean would be rounding by the bars of every one of them.
    #[test]
    fn motions_without_energy_are_left_alone_and_their_mean_has_none() {
        let noise = 1e-13;
        let mut lambda = [-0.8 * noise, 0.01 * noise, 2.5 * noise];
        let mut errors = lambda.map(|lambda: f64| ModeError {
            cancellation: noise / (f64::EPSILON * lambda.abs()),
            data_bar: noise / lambda.abs(),
            ..ModeError::default()
        });
        assert!(repeated(&lambda, &errors).is_empty());
        average(std::slice::from_ref(&(0..3)), &mut lambda, &mut errors);
        for (lambda, error) in lambda.iter().zip(&errors) {
            // The bar of one, and half of four roundings for each of two neighbours.
            assert!((error.data_bar * lambda / noise / 5.0 - 1.0).abs() <= 8.0 * f64::EPSILON, "{lambda:e}, {error:?}");
        }
    }

    /// Two eigenvalues that bars cannot tell apart lie within the bar of their mean.
    #[test]
    fn the_bar_of_a_mean_reaches_every_quotient() {
        let bar = 1e-12;
        let error = ModeError { cancellation: bar / f64::EPSILON, data_bar: bar, ..ModeError::default() };
        let mut lambda = [1.0, 1.0 + 3.5 * bar];
        let (each, mut errors) = (lambda, [error; 2]);
        let runs = repeated(&lambda, &errors);
        assert_eq!((runs.len(), runs[0].clone()), (1, 0..2));
        average(&runs, &mut lambda, &mut errors);
        for (mean, error) in lambda.iter().zip(&errors) {
            // Each quotient may itself be off by its bar.
            let reached = each.iter().all(|own| (own / mean - 1.0).abs() + bar <= error.data_bar * (1.0 + 1e-3));
            assert!(reached, "{lambda:?}, {error:?}");
        }
    }
}
