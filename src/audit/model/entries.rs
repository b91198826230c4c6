//! K̂, M̂, loads and recovered rows entry by entry against those of the columns made again: M-15, M-16, M-17, M-18.
//!
//! An entry may differ by what both columns and their products are known to be off, and by no more:
//!
//! ```text
//! bound_ij = F (e_i n_j + n_i e_j + e_i e_j + ε t_i t_j)    n = √A_ii, e = √(eᵀAe), t = √(|w|ᵀ|A||w|)
//! ```
//! by Schwarz. Columns whose interior is in equilibrium are stationary in energy: of their errors in K̂ only e_i e_j is left. F
//! covers that the errors of the file's columns are not measured but taken to be like those of the ones made again.

use faer::{Mat, MatRef};

use super::bilinear::Bilinear;
use super::projection::{Form, Rows};
use crate::dense;
use crate::error::Result;
use crate::verification::check::{Check, Limits};

/// F.
const BOTH: f64 = 10.0;
/// Relative difference of an entry that is always accepted.
const ENGINEERING: f64 = 1e-12;
/// A difference this many times its bound is none of rounding.
pub(super) const FAR: f64 = 10.0;

/// Identifier, name and equation of a check.
type Words = (&'static str, &'static str, &'static str);

/// What columns are in a form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Of K: the first columns are in equilibrium.
    Energy,
    /// Of M.
    Inertia,
}

/// The largest difference in terms of its bound.
struct Worst {
    /// Relative difference.
    value: f64,
    /// Its relative bound.
    bound: f64,
    at: (usize, usize),
}

impl Default for Worst {
    fn default() -> Self {
        Self { value: 0.0, bound: 0.0, at: (0, 0) }
    }
}

impl Worst {
    /// Takes in an entry: its difference, its bound, its size.
    fn take(&mut self, at: (usize, usize), (difference, bound, size): (f64, f64, f64)) {
        let size = if size > 0.0 { size } else { 1.0 };
        let (value, bound) = (difference / size, (bound / size).max(ENGINEERING));
        let share = |value: f64, bound: f64| if bound > 0.0 { value / bound } else { 0.0 };
        if self.bound == 0.0 || dense::worse(share(value, bound), share(self.value, self.bound)) {
            *self = Self { value, bound, at };
        }
    }

    fn limits(&self) -> Limits {
        Limits {
            engineering: ENGINEERING,
            arithmetic: if self.bound > ENGINEERING { self.bound } else { 0.0 },
            data: 0.0,
        }
    }
}

/// How the errors of two columns enter an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Each by itself, times the other column.
    First,
    /// As a product: the entry is stationary.
    Second,
}

/// The bound of an entry.
fn bound(form: &Form, (i, j): (usize, usize), order: Order) -> f64 {
    let norm = |i: usize| form.matrix[(i, i)].max(0.0).sqrt();
    let (e_i, e_j) = (form.errors[i], form.errors[j]);
    let first = match order {
        Order::First => e_i * norm(j) + norm(i) * e_j,
        Order::Second => 0.0,
    };
    BOTH * (first + e_i * e_j + f64::EPSILON * form.terms[i] * form.terms[j])
}

/// What an entry of a coordinate is relative to. Of an interface that just holds the component nothing is left of K̂ but rounding
/// of its terms, which then stand for it. Where neither is more than a rounding of `inertia`, a coordinate of its own, that stands for it: a row
/// without stiffness has rounding of rounding.
fn sizes(form: &Form, inertia: &[f64]) -> Vec<f64> {
    let size = |(i, terms): (usize, &f64)| {
        let norm = form.matrix[(i, i)].max(0.0).sqrt();
        let own = if norm * norm > BOTH * f64::EPSILON * terms * terms { norm } else { *terms };
        if own * own > f64::EPSILON * inertia[i] { own } else { inertia[i].sqrt() }
    };
    form.terms.iter().enumerate().map(size).collect()
}

/// A matrix of the file, its interface rows mixed as the probes are, against the form of the columns made again; `inertia` is what a coordinate
/// has of it in the first elastic mode, as an energy.
pub(super) fn compared(
    found: MatRef<'_, f64>,
    (expected, inertia): (&Form, &[f64]),
    (kind, n_stationary): (Kind, usize),
    name: &dyn Fn(usize) -> String,
) -> Check {
    let mut worst = Worst::default();
    let sizes = sizes(expected, inertia);
    for j in 0..found.ncols() {
        for i in 0..=j {
            let is_stationary = kind == Kind::Energy && i < n_stationary && j < n_stationary;
            // Interface and modes are uncoupled in K̂ (29), and what projection leaves there is set to zero.
            let is_coupling = kind == Kind::Energy && i < n_stationary && j >= n_stationary;
            let entry = if is_coupling { 0.0 } else { expected.matrix[(i, j)] };
            let difference = (found[(i, j)] - entry).abs();
            let bound = bound(expected, (i, j), if is_stationary { Order::Second } else { Order::First });
            worst.take((i, j), (difference, bound, sizes[i] * sizes[j]));
        }
    }
    let (id, what, equation) = match kind {
        Kind::Energy => ("M-17", "stiffness is that of the full model", "max |K̂ − ΨᵀKΨ|_ij / √(ii jj), Ψ made again"),
        Kind::Inertia => ("M-16", "mass is that of the full model", "max |M̂ − ΨᵀMΨ|_ij / √(ii jj), Ψ made again"),
    };
    let (i, j) = worst.at;
    check((id, what, equation), &worst, if i == j { name(i) } else { format!("{} and {}", name(i), name(j)) })
}

fn check((id, name, equation): Words, worst: &Worst, at: String) -> Check {
    let limits = worst.limits();
    Check {
        id,
        name,
        equation,
        value: worst.value,
        limits,
        fail_above: FAR * limits.value(),
        worst: (worst.value > 0.0).then_some(at),
    }
}

/// Rows of loads or displacements against those of the columns made again; `rounding` is that of the entries as they are kept.
pub(super) fn rows(
    found: MatRef<'_, f64>,
    expected: &Rows,
    rounding: f64,
    (words, name): (Words, &dyn Fn(usize, usize) -> String),
) -> Check {
    let mut worst = Worst::default();
    for j in 0..found.ncols() {
        let column = dense::column(expected.rows.as_ref(), j);
        for (i, value) in column.iter().enumerate() {
            let bound = BOTH * expected.errors[j] + rounding * value.abs();
            worst.take((i, j), ((found[(i, j)] - value).abs(), bound, expected.sizes[j]));
        }
    }
    let at = name(worst.at.0, worst.at.1);
    check(words, &worst, at)
}

/// M-28: a further matrix against that of the columns made again, entry by entry.
pub(super) fn bilinear(found: MatRef<'_, f64>, expected: &Bilinear, name: &dyn Fn(usize, usize) -> String) -> Check {
    let mut worst = Worst::default();
    for (i, j) in (0..found.ncols()).flat_map(|j| (0..found.nrows()).map(move |i| (i, j))) {
        let difference = (found[(i, j)] - expected.matrix[(i, j)]).abs();
        worst.take((i, j), (difference, BOTH * expected.errors[(i, j)], expected.terms[(i, j)]));
    }
    let words =
        ("M-28", "further matrices are those of the full model", "max |ΨᵀAΨ − Â|_ij / (|Ψ|ᵀ|A||Ψ|)_ij, Ψ made again");
    check(words, &worst, name(worst.at.0, worst.at.1))
}

/// M-17: what the interface needs to be moved, in every direction: a soft one is seen as well as stiff ones.
///
/// X are motions of the interface orthonormal in K̂_BB + λ₁M̂_BB, those of rigid bodies left out: Xᵀ(K̂ − K)X relative to the energy of each.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn statics(
    found: MatRef<'_, f64>,
    forms: [&Form; 2],
    first: f64,
    (p, order): (usize, Order),
) -> Result<Check> {
    /// Share of the energy in that of K̂_BB + λ₁M̂_BB below which a motion is that of a rigid body.
    const RIGID: f64 = 1e-6;
    let [energy, inertia] = forms;
    let (k, m) = (energy.matrix.as_ref().submatrix(0, 0, p, p), inertia.matrix.as_ref().submatrix(0, 0, p, p));
    let (shares, x) = pencil(k, m, first)?;
    let difference = Mat::from_fn(p, p, |i, j| found[(i, j)] - k[(i, j)]);
    let image = dense::gram(x.as_ref(), dense::product(difference.as_ref(), x.as_ref()).as_ref());
    let mut worst = Worst::default();
    for (j, share_j) in shares.iter().enumerate().filter(|(_, share)| **share > RIGID) {
        for (i, share_i) in shares.iter().enumerate().take(j + 1).filter(|(_, share)| **share > RIGID) {
            // Roundings of entries are independent: their squares add up.
            let size = |column: usize| {
                let of_row = |row: usize| (x[(row, column)] * energy.terms[row]).powi(2);
                (0..p).map(of_row).sum::<f64>().sqrt()
            };
            let error = |column: usize| (0..p).map(|row| (x[(row, column)] * energy.errors[row]).abs()).sum::<f64>();
            let of_errors = match order {
                // The energy of each by itself is no more than its share.
                Order::First => error(i) * share_j.sqrt() + share_i.sqrt() * error(j),
                Order::Second => 0.0,
            };
            let bound = BOTH * (f64::EPSILON * size(i) * size(j) + error(i) * error(j) + of_errors);
            worst.take((i, j), (image[(i, j)].abs(), bound, (share_i * share_j).sqrt()));
        }
    }
    let words = (
        "M-17",
        "static stiffness is that of the full model",
        "max |Xᵀ(K̂ − ΨᵀKΨ)X| over energies, X in every direction of the interface",
    );
    let at = format!("motions {} and {} of {p}", worst.at.0 + 1, worst.at.1 + 1);
    Ok(check(words, &worst, at))
}

/// Eigenpairs K x = τ (K + λM) x, xᵀ(K + λM)x = 1; motions without either are left out.
fn pencil(k: MatRef<'_, f64>, m: MatRef<'_, f64>, lambda: f64) -> Result<(Vec<f64>, Mat<f64>)> {
    let n = k.nrows();
    let sum = Mat::from_fn(n, n, |i, j| k[(i, j)] + lambda * m[(i, j)]);
    let d: Vec<f64> = (0..n).map(|i| dense::power_of_two_root(sum[(i, i)])).collect();
    let scaled = |a: &Mat<f64>| Mat::from_fn(n, n, |i, j| a[(i, j)] * d[i] * d[j]);
    let (sizes, directions) = dense::symmetric_eigen(scaled(&sum).as_ref())?;
    let largest = sizes.last().copied().unwrap_or(0.0);
    let kept: Vec<usize> = (0..n).filter(|j| sizes[*j] > n as f64 * f64::EPSILON * largest).collect();
    let half = Mat::from_fn(n, kept.len(), |i, j| directions[(i, kept[j])] / sizes[kept[j]].sqrt());
    let mut small = dense::gram(half.as_ref(), dense::product(scaled(&k.to_owned()).as_ref(), half.as_ref()).as_ref());
    dense::symmetrise(&mut small);
    let (shares, turn) = dense::symmetric_eigen(small.as_ref())?;
    let x = dense::product(half.as_ref(), turn.as_ref());
    Ok((shares, Mat::from_fn(n, kept.len(), |i, j| x[(i, j)] * d[i])))
}
