//! One triangle of K − σM on the union of both patterns, in the form faer reads.

use super::Pencil;
use crate::sparse::SparseMatrix;

/// Which entries of a row are taken. Rows of a symmetric matrix are its columns, so the entries up to the diagonal
/// of row j are the upper triangle of column j.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// Columns 0 ..= row.
    UpToDiagonal,
    /// Columns row .. n.
    FromDiagonal,
}

/// A triangle in compressed columns.
#[derive(Debug)]
pub(super) struct Triangle {
    pub(super) pointers: Vec<usize>,
    pub(super) indices: Vec<usize>,
    pub(super) values: Vec<f64>,
}

impl Triangle {
    /// The positions alone.
    pub(super) fn pattern(pencil: Pencil<'_>, part: Part) -> Self {
        Self::build(pencil, part, |_, _, _, _| None)
    }

    /// K − σM.
    pub(super) fn shifted(pencil: Pencil<'_>, sigma: f64) -> Self {
        Self::build(pencil, Part::FromDiagonal, |_, _, k, m| Some(k - sigma * m))
    }

    /// D (K − σM) D with a diagonal D.
    pub(super) fn shifted_and_scaled(pencil: Pencil<'_>, sigma: f64, scale: &[f64]) -> Self {
        Self::build(pencil, Part::FromDiagonal, |row, col, k, m| Some((k - sigma * m) * scale[row] * scale[col]))
    }

    fn build(pencil: Pencil<'_>, part: Part, value: impl Fn(usize, usize, f64, f64) -> Option<f64>) -> Self {
        let n = pencil.stiffness.rows();
        let capacity = pencil.stiffness.nnz() / 2 + n;
        let mut triangle =
            Self { pointers: Vec::with_capacity(n + 1), indices: Vec::with_capacity(capacity), values: Vec::new() };
        triangle.pointers.push(0);
        for row in 0..n {
            let ((k_cols, k_values), (m_cols, m_values)) =
                (part_of_row(pencil.stiffness, row, part), part_of_row(pencil.mass, row, part));
            let (mut at_k, mut at_m) = (0, 0);
            while at_k < k_cols.len() || at_m < m_cols.len() {
                let next_k = k_cols.get(at_k).copied().unwrap_or(u32::MAX);
                let next_m = m_cols.get(at_m).copied().unwrap_or(u32::MAX);
                let col = next_k.min(next_m);
                let (mut k, mut m) = (0.0, 0.0);
                if next_k == col {
                    k = k_values[at_k];
                    at_k += 1;
                }
                if next_m == col {
                    m = m_values[at_m];
                    at_m += 1;
                }
                triangle.indices.push(col as usize);
                triangle.values.extend(value(row, col as usize, k, m));
            }
            triangle.pointers.push(triangle.indices.len());
        }
        triangle
    }
}

fn part_of_row(matrix: &SparseMatrix, row: usize, part: Part) -> (&[u32], &[f64]) {
    let pointers = matrix.indptr();
    let pointers = pointers.raw_storage();
    let range = pointers[row]..pointers[row + 1];
    let (columns, values) = (&matrix.indices()[range.clone()], &matrix.data()[range]);
    match part {
        Part::UpToDiagonal => {
            let end = columns.partition_point(|col| *col as usize <= row);
            (&columns[..end], &values[..end])
        }
        Part::FromDiagonal => {
            let start = columns.partition_point(|col| (*col as usize) < row);
            (&columns[start..], &values[start..])
        }
    }
}
