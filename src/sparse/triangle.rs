//! One triangle of a matrix taken for both, where the other is known to be incomplete.

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::SparseMatrix;
use super::pairs::{Completed, completed};

/// The triangle of K and M that holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Triangle {
    /// On and below the diagonal.
    Lower,
    /// On and above the diagonal.
    Upper,
}

/// What [`Triangle::mirrored`] made.
pub(crate) struct Mirrored {
    pub(crate) matrix: SparseMatrix,
    /// Positions of the other triangle that held another value.
    pub(crate) n_differing: usize,
    /// Pairs of a row and a column that had an entry in one triangle only.
    pub(crate) n_once: usize,
}

impl Triangle {
    fn holds(self, row: u32, col: u32) -> bool {
        match self {
            Self::Lower => col <= row,
            Self::Upper => col >= row,
        }
    }

    /// The matrix that this triangle of `matrix` stands for, and how many positions of the other triangle differed. What stands in the other
    /// one only is taken from there.
    pub(crate) fn mirrored(self, matrix: &SparseMatrix) -> Mirrored {
        let Completed { matrix, n_once, .. } = completed(matrix);
        let transposed = matrix.transpose_view().to_csr();
        let n = matrix.rows();
        let (mut pointers, mut indices, mut data) = (Vec::with_capacity(n + 1), Vec::new(), Vec::new());
        pointers.push(0);
        let mut n_differing = 0;
        for (row, (own, mirrored)) in matrix.outer_iterator().zip(transposed.outer_iterator()).enumerate() {
            let from = |view: &sprs::CsVecViewI<'_, f64, u32>, is_own: bool| -> Vec<(u32, f64)> {
                let entries = view.indices().iter().copied().zip(view.data().iter().copied());
                entries.filter(|(col, _)| self.holds(row as u32, *col) == is_own).collect()
            };
            let (kept, replaced, replacing) = (from(&own, true), from(&own, false), from(&mirrored, false));
            n_differing += n_different(&replaced, &replacing);
            let (front, back) = match self {
                Self::Lower => (kept, replacing),
                Self::Upper => (replacing, kept),
            };
            for (col, value) in front.into_iter().chain(back) {
                indices.push(col);
                data.push(value);
            }
            pointers.push(indices.len());
        }
        Mirrored { matrix: SparseMatrix::new((n, n), pointers, indices, data), n_differing, n_once }
    }
}

/// Positions at which two sorted rows hold different values; a missing entry is zero.
fn n_different(a: &[(u32, f64)], b: &[(u32, f64)]) -> usize {
    let value =
        |row: &[(u32, f64)], col: u32| row.binary_search_by_key(&col, |entry| entry.0).map_or(0.0, |at| row[at].1);
    let of_a = a.iter().filter(|(col, x)| *x != value(b, *col)).count();
    // Positions that only b stores.
    let of_b = b.iter().filter(|(col, x)| *x != 0.0 && a.binary_search_by_key(col, |entry| entry.0).is_err()).count();
    of_a + of_b
}
