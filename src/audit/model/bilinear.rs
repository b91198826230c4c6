//! Further matrices on the columns made again, with what is known of the errors of each entry.
//!
//! ```text
//! wᵀAw     q × q    of any A: nothing is symmetric
//! ```
//! Errors e of a column have the inertia eᵀMe. So |e_iᵀ A w_j| is about √(Σ_k (A w_j)_k² / M_kk) √(e_iᵀMe_i) at most. What a massless dof
//! lacks is like its own motion.

use faer::{Mat, MatRef};

use super::alignment::Combination;
use super::projection::Form;
use crate::dense;
use crate::sparse::{SparseMatrix, panels, product_and_terms};

/// A form on some columns that need not be symmetric.
#[derive(Clone)]
pub(super) struct Bilinear {
    /// WᵀAW, q × q.
    pub(super) matrix: Mat<f64>,
    /// What each entry may be off by, q × q.
    pub(super) errors: Mat<f64>,
    /// |W|ᵀ|A||W|, of which each entry is the rounding, q × q.
    pub(super) terms: Mat<f64>,
}

/// A on one side of some columns.
struct Side {
    /// √(Σ (A w_j)_k² / M_kk) over dofs with mass, of each column.
    norms: Vec<f64>,
    /// |W|ᵀ|AW| over dofs without mass, q × q.
    massless: Mat<f64>,
}

impl Bilinear {
    /// WᵀAW of columns W whose errors are those of the form of M; `diagonal` is that of M.
    pub(super) fn of(matrix: &SparseMatrix, shapes: MatRef<'_, f64>, (mass, diagonal): (&Form, &[f64])) -> Self {
        let (n, q) = shapes.shape();
        let sizes = dense::absolute(shapes);
        let massless = Mat::from_fn(n, q, |k, j| if diagonal[k] > 0.0 { 0.0 } else { sizes[(k, j)] });
        let (mut form, mut terms) = (Mat::zeros(q, q), Mat::zeros(q, q));
        let side = |matrix: &SparseMatrix, take: &mut dyn FnMut(std::ops::Range<usize>, [Mat<f64>; 2])| {
            let mut side = Side { norms: Vec::with_capacity(q), massless: Mat::zeros(q, q) };
            for columns in panels(q) {
                let (image, of_terms) = product_and_terms(matrix, shapes.get(.., columns.clone()));
                for j in 0..image.ncols() {
                    let share = |(v, m): (&f64, &f64)| if *m > 0.0 { v * v / m } else { 0.0 };
                    let squares = dense::column(image.as_ref(), j).iter().zip(diagonal).map(share);
                    side.norms.push(squares.sum::<f64>().sqrt());
                }
                let absolute = dense::absolute(image.as_ref());
                let of_massless = dense::gram(massless.as_ref(), absolute.as_ref());
                side.massless.as_mut().get_mut(.., columns.clone()).copy_from(of_massless);
                take(columns, [image, of_terms]);
            }
            side
        };
        let right = side(matrix, &mut |columns, [image, of_terms]| {
            form.as_mut().get_mut(.., columns.clone()).copy_from(dense::gram(shapes, image.as_ref()));
            terms.as_mut().get_mut(.., columns).copy_from(dense::gram(sizes.as_ref(), of_terms.as_ref()));
        });
        let left = side(&matrix.transpose_view().to_csr(), &mut |_, _| {});
        let errors = errors([&left, &right], mass, terms.as_ref());
        Self { matrix: form, errors, terms }
    }

    /// BᵀWᵀAWB: the form on combinations of the columns.
    pub(super) fn combined(&self, combination: &Combination) -> Self {
        let b = combination.columns.as_ref();
        let both = |a: &Mat<f64>, left: MatRef<'_, f64>, right: MatRef<'_, f64>| {
            dense::product(left.transpose(), dense::product(a.as_ref(), right).as_ref())
        };
        let size = dense::absolute(b);
        let (size, amplified) = (size.as_ref(), combination.amplified.as_ref());
        let of_rounding = both(&self.terms, amplified, size) + both(&self.terms, size, amplified);
        Self {
            matrix: both(&self.matrix, b, b),
            errors: both(&self.errors, size, size) + of_rounding * faer::Scale(f64::EPSILON),
            terms: both(&self.terms, size, size),
        }
    }
}

/// |e_iᵀAw_j| + |w_iᵀAe_j| + |e_iᵀAe_j| + ε|w_i|ᵀ|A||w_j| of each entry.
fn errors([left, right]: [&Side; 2], mass: &Form, terms: MatRef<'_, f64>) -> Mat<f64> {
    let length = |j: usize| mass.matrix[(j, j)].max(0.0).sqrt();
    let share = |j: usize| if length(j) > 0.0 { mass.errors[j] / length(j) } else { 0.0 };
    let gain = |j: usize| if length(j) > 0.0 { right.norms[j] / length(j) } else { 0.0 };
    // What A makes of an error is like what it makes of a column.
    let largest = (0..terms.ncols()).map(gain).fold(0.0, f64::max);
    Mat::from_fn(terms.nrows(), terms.ncols(), |i, j| {
        let (e_i, e_j) = (mass.errors[i], mass.errors[j]);
        let first = e_i * right.norms[j] + left.norms[i] * e_j;
        let massless = share(i) * right.massless[(i, j)] + share(j) * left.massless[(j, i)];
        first + massless + e_i * e_j * largest + f64::EPSILON * terms[(i, j)]
    })
}
