//! L B Lᵀ of a symmetric indefinite matrix K − σM.

mod backward_error;
mod whole;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::supernodal::{
    SupernodalIntranodeLbltRef, factorize_supernodal_numeric_intranode_lblt,
    factorize_supernodal_numeric_intranode_lblt_scratch,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, MatRef, Par, Spec};

use super::cholesky::zeros;
use super::{Analysis, Pencil, Triangle};
use crate::dense;
use crate::error::{Error, Result};
use crate::model::diagonal;

pub use whole::{WholeCount, whole_count};

/// L B Lᵀ of D (K − σM) D with pivots of order one and two inside each supernode.
///
/// D holds powers of two that bring the diagonal of |K| + |σ| M near one, which no entry then exceeds by much: pivots are
/// compared on equal terms whatever the units of translations and rotations, and however far up σ lies.
pub(super) struct Indefinite<'a> {
    analysis: &'a Analysis,
    scale: Vec<f64>,
    largest: f64,
    values: Vec<f64>,
    subdiagonal: Vec<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

/// Signs of the pivots of B and what they can be trusted with.
pub(super) struct Signs {
    /// Negative eigenvalues of B.
    pub(super) negative: usize,
    /// Bound of the largest entry of |L||B||Lᵀ| over the largest entry of the scaled matrix.
    pub(super) growth: f64,
    /// Smallest pivot over largest entry of the scaled matrix.
    pub(super) smallest: f64,
}

impl<'a> Indefinite<'a> {
    pub(super) fn new(analysis: &'a Analysis, pencil: Pencil<'_>, sigma: f64) -> Result<Self> {
        let (symbolic, n) = (&analysis.symbolic, analysis.n);
        let diagonals = diagonal(pencil.stiffness).into_iter().zip(diagonal(pencil.mass));
        let terms: Vec<f64> = diagonals.map(|(k, m)| k.abs() + sigma.abs() * m.abs()).collect();
        let scale: Vec<f64> = terms.iter().map(|terms| dense::power_of_two_root(*terms)).collect();
        let lower = Triangle::shifted_and_scaled(pencil, sigma, &scale);
        // On an eigenvalue all of K − σM may cancel: what is left is measured by the terms it is left of.
        let largest_term = terms.iter().zip(&scale).fold(0.0, |max: f64, (terms, d)| max.max(terms * d * d));
        let largest = lower.values.iter().fold(largest_term, |max: f64, value| max.max(value.abs()));
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &lower.pointers, None, &lower.indices);
        let mut factor = Self {
            analysis,
            scale,
            largest,
            values: zeros(symbolic.len_val())?,
            subdiagonal: vec![0.0; n],
            forward: vec![0; n],
            inverse: vec![0; n],
        };
        let parameters = Spec::default();
        let scratch = factorize_supernodal_numeric_intranode_lblt_scratch::<usize, f64>(symbolic, Par::Seq, parameters);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| Error::OutOfMemory { what: "the Sturm count" })?;
        factorize_supernodal_numeric_intranode_lblt(
            &mut factor.values,
            &mut factor.subdiagonal,
            &mut factor.forward,
            &mut factor.inverse,
            SparseColMatRef::new(pattern, lower.values.as_slice()),
            symbolic,
            Par::Seq,
            MemStack::new(&mut memory),
            parameters,
        );
        Ok(factor)
    }

    fn as_ref(&self) -> SupernodalIntranodeLbltRef<'_, usize, f64> {
        let permutation = PermRef::new_checked(&self.forward, &self.inverse, self.analysis.n);
        SupernodalIntranodeLbltRef::new(&self.analysis.symbolic, &self.values, &self.subdiagonal, permutation)
    }

    /// The diagonal of B; what stands below it is `subdiagonal`.
    fn diagonal(&self) -> Vec<f64> {
        let factor = self.as_ref();
        let nodes = (0..self.analysis.symbolic.n_supernodes()).map(|s| factor.supernode(s));
        nodes.flat_map(|node| (0..node.val().ncols()).map(move |j| node.val()[(j, j)])).collect()
    }

    /// Row, column and value of the entries of L by columns, the unit diagonal first; rows are numbered as the pivots came.
    fn visit(&self, mut with: impl FnMut(usize, usize, f64)) {
        let factor = self.as_ref();
        for s in 0..self.analysis.symbolic.n_supernodes() {
            let node = factor.supernode(s);
            let (start, size, pattern) = (node.start(), node.val().ncols(), node.pattern());
            for j in 0..size {
                with(start + j, start + j, 1.0);
                for i in j + 1..node.val().nrows() {
                    let row = if i < size { start + i } else { self.inverse[pattern[i - size]] };
                    with(row, start + j, node.val()[(i, j)]);
                }
            }
        }
    }

    /// Signs of the pivots of B.
    pub(super) fn signs(&self) -> Result<Signs> {
        if self.analysis.n == 0 {
            return Ok(Signs { negative: 0, growth: 1.0, smallest: 1.0 });
        }
        let pivots = self.diagonal();
        let (mut negative, mut smallest) = (0, f64::INFINITY);
        let mut j = 0;
        while j < pivots.len() {
            let (d, below) = (pivots[j], self.subdiagonal[j]);
            if !d.is_finite() || !below.is_finite() || (d == 0.0 && below == 0.0) {
                return Err(Error::SturmPivot { step: j });
            }
            if below == 0.0 {
                negative += usize::from(d < 0.0);
                smallest = smallest.min(d.abs());
                j += 1;
            } else {
                let next = pivots[j + 1];
                let determinant = d * next - below * below;
                if !determinant.is_finite() || determinant == 0.0 {
                    return Err(Error::SturmPivot { step: j });
                }
                smallest = smallest.min(determinant.abs() / d.abs().max(next.abs()).max(below.abs()));
                // One of each sign unless the determinant is positive; then both have the sign of the trace.
                negative += if determinant < 0.0 { 1 } else { 2 * usize::from(d < 0.0) };
                j += 2;
            }
        }
        let growth = self.largest_product(&pivots) / self.largest;
        Ok(Signs { negative, growth, smallest: smallest / self.largest })
    }

    /// (K − σM)_II⁻¹ applied to a block.
    pub(super) fn solve(&self, block: MatRef<'_, f64>) -> Mat<f64> {
        let mut x = Mat::from_fn(block.nrows(), block.ncols(), |i, j| {
            let row = self.forward[i];
            block[(row, j)] * self.scale[row]
        });
        let scratch = self.analysis.symbolic.solve_in_place_scratch::<f64>(x.ncols(), Par::Seq);
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        self.as_ref().solve_in_place_no_numeric_permute_with_conj(Conj::No, x.as_mut(), Par::Seq, stack);
        Mat::from_fn(x.nrows(), x.ncols(), |i, j| x[(self.inverse[i], j)] * self.scale[i])
    }
}
