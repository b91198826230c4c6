//! Modes of a result as those of the space that they span.
//!
//! ```text
//! V    n' × m   shapes of a result, M-orthonormal
//! H    VᵀKV     diagonal for modes; of two whose eigenvalues are near, any combinations have nearly the same quotients
//! θ ≈ H_ij / (H_jj − H_ii)    how far two of them are turned against the modes that they span
//! ```
//! Modes that are turned by more than rounding are turned back, block by block (Rayleigh and Ritz). What is left of H between blocks is
//! beyond what any measure sees.

use faer::{Mat, MatRef};

use crate::dense;
use crate::eigen::{EigenWork, Eigenpairs, ModalProblem, Modes, Problem, ShiftInvert, judged};
use crate::error::Result;
use crate::sparse::product;

/// θ up to which shapes stay as they are: the measure of shapes notices a thousandth (M-08).
const LEAST_ANGLE: f64 = 1e-6;

/// The modes of the space of M-orthonormal shapes, ascending, with what is known of their errors; `around` is what all other modes lie beyond.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn modes_of(
    problem: ModalProblem<'_>,
    operator: &dyn ShiftInvert,
    mut shapes: Mat<f64>,
    around: [Option<f64>; 2],
) -> Result<Modes> {
    if shapes.ncols() == 0 {
        return Ok(Modes::none(shapes.nrows()));
    }
    let mut h = dense::gram(shapes.as_ref(), product(problem.stiffness, shapes.as_ref()).as_ref());
    dense::symmetrise(&mut h);
    let mut values = dense::diagonal(h.as_ref());
    for block in blocks(h.as_ref()).into_iter().filter(|block| block.len() > 1) {
        let of_block = Mat::from_fn(block.len(), block.len(), |i, j| h[(block[i], block[j])]);
        let (of_block, turn) = dense::symmetric_eigen(of_block.as_ref())?;
        let turned = dense::product(dense::columns(shapes.as_ref(), &block).as_ref(), turn.as_ref());
        for (at, mode) in block.into_iter().enumerate() {
            values[mode] = of_block[at];
            dense::column_mut(shapes.as_mut(), mode).copy_from_slice(dense::column(turned.as_ref(), at));
        }
    }
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let vectors = dense::columns(shapes.as_ref(), &order);
    let values = order.iter().map(|mode| values[*mode]).collect();
    let pairs = Eigenpairs { values, vectors, next: None, work: EigenWork::default() };
    let eigenproblem = Problem { operator, mass: problem.mass, deflated: problem.deflated };
    Ok(judged(problem, eigenproblem, pairs, around).ascending())
}

/// Modes that are turned against each other, each with those that it reaches through others.
fn blocks(h: MatRef<'_, f64>) -> Vec<Vec<usize>> {
    let is_turned = |i: usize, j: usize| h[(i, j)].abs() > LEAST_ANGLE * (h[(i, i)] - h[(j, j)]).abs();
    dense::joined_parts(h.nrows(), is_turned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_that_are_turned_are_of_one_block() {
        let h = [[1.0, 0.0, 1e-3, 0.0], [0.0, 2.0, 0.0, 1e-9], [1e-3, 0.0, 1.1, 0.0], [0.0, 1e-9, 0.0, 3.0]];
        let h = Mat::from_fn(4, 4, |i, j| h[i][j]);
        assert_eq!(blocks(h.as_ref()), [vec![0, 2], vec![1], vec![3]]);
    }
}
