//! Further matrices on the columns made again, with what is known of the errors of each entry.
//!
//! ```text
//! wᵀAw     q × q    of any A: nothing is symmetric
//! ```
//! Errors e of a column have the inertia eᵀMe. So |e_iᵀ A w_j| is about √(Σ_k (A w_j)_k² / M_kk) √(e_iᵀMe_i) at most. What a massless dof
//! lacks is like its own motion.

use faer::{Mat, MatRef};

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

/// What is known of some columns.
#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    /// √(wᵀMw).
    pub(super) lengths: &'a [f64],
    /// √(eᵀMe).
    pub(super) errors: &'a [f64],
    /// The diagonal of M.
    pub(super) diagonal: &'a [f64],
}

/// A on one side of some columns.
struct Side {
    /// √(Σ (A w_j)_k² / M_kk) over dofs with mass, of each column.
    norms: Vec<f64>,
    /// |W|ᵀ|AW| over dofs without mass, q × q.
    massless: Mat<f64>,
}

impl Bilinear {
    /// WᵀAW of columns W.
    pub(super) fn of(matrix: &SparseMatrix, shapes: MatRef<'_, f64>, known: Known<'_>) -> Self {
        let ((n, q), diagonal) = (shapes.shape(), known.diagonal);
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
        let errors = errors([&left, &right], known, terms.as_ref());
        Self { matrix: form, errors, terms }
    }
}

/// |e_iᵀAw_j| + |w_iᵀAe_j| + |e_iᵀAe_j| + ε|w_i|ᵀ|A||w_j| of each entry.
fn errors([left, right]: [&Side; 2], known: Known<'_>, terms: MatRef<'_, f64>) -> Mat<f64> {
    let length = |j: usize| known.lengths[j];
    let share = |j: usize| if length(j) > 0.0 { known.errors[j] / length(j) } else { 0.0 };
    let gain = |j: usize| if length(j) > 0.0 { right.norms[j] / length(j) } else { 0.0 };
    // What A makes of an error is like what it makes of a column.
    let largest = (0..terms.ncols()).map(gain).fold(0.0, f64::max);
    Mat::from_fn(terms.nrows(), terms.ncols(), |i, j| {
        let (e_i, e_j) = (known.errors[i], known.errors[j]);
        let first = e_i * right.norms[j] + left.norms[i] * e_j;
        let massless = share(i) * right.massless[(i, j)] + share(j) * left.massless[(j, i)];
        first + massless + e_i * e_j * largest + f64::EPSILON * terms[(i, j)]
    })
}
