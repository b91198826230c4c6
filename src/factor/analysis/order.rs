//! The elimination tree and a postorder of it.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::cholesky::simplicial::{
    prefactorize_symbolic_cholesky, prefactorize_symbolic_cholesky_scratch,
};

use crate::error::{Error, Result};
use crate::heap::fallibly;
use crate::sparse::Pencil;

/// No parent.
pub(super) const NONE: u32 = u32::MAX;

/// The elimination tree of K ∪ M in the order of its steps, children before parents and subtrees whole.
pub(super) struct EliminationTree {
    /// Dof of the pencil that is eliminated at each step; the border follows as it is.
    pub(super) given: Vec<u32>,
    /// Step of each dof.
    pub(super) step: Vec<u32>,
    /// Parent of each step, [`NONE`] for a root and where the parent lies in the border.
    pub(super) parent: Vec<u32>,
    /// Entries of each column of L, the diagonal included.
    pub(super) counts: Vec<u32>,
}

impl EliminationTree {
    /// Of the first `n` dofs; those after them are the border.
    pub(super) fn new(pencil: Pencil<'_>, n: usize) -> Result<Self> {
        let (parent, counts) = in_given_order(pencil, n)?;
        let given = postorder(&parent, &counts);
        let n_total = pencil.stiffness.rows();
        let mut step: Vec<u32> = (0..n_total as u32).collect();
        for (at, dof) in given.iter().enumerate() {
            step[*dof as usize] = at as u32;
        }
        let of_step = |dof: &u32| match parent[*dof as usize] {
            NONE => NONE,
            up => step[up as usize],
        };
        Ok(Self {
            parent: given.iter().map(of_step).collect(),
            counts: given.iter().map(|dof| counts[*dof as usize]).collect(),
            given,
            step,
        })
    }
}

/// Parents and column counts in the order of the pencil (Liu 1986; Gilbert, Ng, Peyton 1994).
fn in_given_order(pencil: Pencil<'_>, n: usize) -> Result<(Vec<u32>, Vec<u32>)> {
    let n_total = pencil.stiffness.rows();
    let (pointers, indices) = upper_triangle(pencil);
    let pattern = SymbolicSparseColMatRef::new_checked(n_total, n_total, &pointers, None, &indices);
    let mut tree = vec![0isize; n_total];
    let mut counts = vec![0usize; n_total];
    let scratch = prefactorize_symbolic_cholesky_scratch::<usize>(n_total, indices.len());
    let memory = fallibly(|| MemBuffer::try_new(scratch));
    let mut memory = memory.map_err(|_| Error::OutOfMemory { what: "the symbolic factorisation" })?;
    let tree = prefactorize_symbolic_cholesky(&mut tree, &mut counts, pattern, MemStack::new(&mut memory)).into_inner();
    let is_internal = |parent: &isize| (0..n as isize).contains(parent);
    let parent = tree[..n].iter().map(|parent| if is_internal(parent) { *parent as u32 } else { NONE }).collect();
    Ok((parent, counts[..n].iter().map(|count| *count as u32).collect()))
}

/// Positions of K ∪ M up to the diagonal, by columns.
fn upper_triangle(pencil: Pencil<'_>) -> (Vec<usize>, Vec<usize>) {
    let n = pencil.stiffness.rows();
    let mut pointers = Vec::with_capacity(n + 1);
    let mut indices = Vec::with_capacity(pencil.stiffness.nnz() / 2 + n);
    pointers.push(0);
    for col in 0..n {
        let [k, m] = [pencil.stiffness, pencil.mass].map(|matrix| {
            let (rows, _) = matrix.row(col);
            &rows[..rows.partition_point(|row| *row as usize <= col)]
        });
        let (mut k, mut m) = (k.iter().peekable(), m.iter().peekable());
        while let Some(next) = [k.peek(), m.peek()].into_iter().flatten().min().map(|row| **row) {
            k.next_if(|row| **row == next);
            m.next_if(|row| **row == next);
            indices.push(next as usize);
        }
        pointers.push(indices.len());
    }
    (pointers, indices)
}

/// A postorder of the forest in which the child with the longest column comes last: it is the one a supernode can take in.
fn postorder(parent: &[u32], counts: &[u32]) -> Vec<u32> {
    let n = parent.len();
    let (mut first_child, mut next_sibling) = (vec![NONE; n], vec![NONE; n]);
    let mut roots = Vec::new();
    let mut by_length: Vec<u32> = (0..n as u32).collect();
    by_length.sort_by_key(|step| counts[*step as usize]);
    for step in by_length.into_iter().rev() {
        match parent[step as usize] {
            NONE => roots.push(step),
            up => {
                next_sibling[step as usize] = first_child[up as usize];
                first_child[up as usize] = step;
            }
        }
    }
    let mut order = Vec::with_capacity(n);
    let mut stack = roots;
    while let Some(step) = stack.last().copied() {
        let child = first_child[step as usize];
        if child == NONE {
            order.push(step);
            stack.pop();
        } else {
            first_child[step as usize] = next_sibling[child as usize];
            stack.push(child);
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn postorder_visits_children_first_subtrees_whole_and_the_longest_child_last() {
        // 0 and 2 are leaves of 4, 1 is a leaf of 3, 3 and 4 meet in 5.
        let parent = [4, 3, 4, 5, 5, NONE];
        assert_eq!(postorder(&parent, &[2; 6]), [1, 3, 0, 2, 4, 5]);
        assert_eq!(postorder(&parent, &[4, 3, 3, 5, 2, 1]), [2, 0, 4, 1, 3, 5]);
    }
}
