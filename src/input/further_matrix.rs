//! Further matrices of a model as they were read: all entries, symmetric or not.

use supel_runtime::{MatrixKind, Symmetry};

use super::MatrixInput;
use crate::error::{Error, Result};
use crate::job::MatrixJob;
use crate::sparse::SparseMatrix;

/// A further matrix as it was read. It is what its kind demands, to the bit.
#[derive(Clone, Debug)]
pub struct FurtherMatrix {
    /// Its name in the job.
    pub name: String,
    /// What it is.
    pub kind: MatrixKind,
    /// What its entries are, whatever its kind demands; none for a matrix that is neither.
    pub symmetry: Option<Symmetry>,
    /// The matrix, all of its entries stored.
    pub input: MatrixInput,
}

impl FurtherMatrix {
    /// A matrix that was read, once it is known to be what its kind demands. Nothing is made symmetric or skew: a difference in the last
    /// digit is for the user to judge.
    ///
    /// # Errors
    /// [`Error::MatrixKind`] where entries at (i, j) and (j, i) are not what the kind demands.
    pub(super) fn checked(job: &MatrixJob, input: MatrixInput) -> Result<Self> {
        let breach = |symmetry| first_breach(&input.matrix, symmetry);
        let (name, kind) = (job.name.clone(), job.kind);
        let symmetry = match kind.symmetry() {
            Some(demanded) => match breach(demanded) {
                None => Some(demanded),
                Some((row, col, values)) => {
                    let place = [row + 1, col + 1];
                    return Err(Error::MatrixKind { path: input.path, matrix: name, kind, place, values });
                }
            },
            None => [Symmetry::Symmetric, Symmetry::Skew].into_iter().find(|symmetry| breach(*symmetry).is_none()),
        };
        Ok(Self { name, kind, symmetry, input })
    }
}

/// The first place whose entry and that across the diagonal are not what a symmetry says, with both.
pub(super) fn first_breach(matrix: &SparseMatrix, symmetry: Symmetry) -> Option<(usize, usize, [f64; 2])> {
    let transposed = matrix.transpose_view().to_csr();
    let holds = |own: f64, other: f64| match symmetry {
        Symmetry::Symmetric => own == other,
        Symmetry::Skew => own == -other,
    };
    // Each pair is looked at from the side that stores an entry; zeros may be stored on one side alone.
    let mut entries = matrix.iter();
    entries.find_map(|(own, (row, col))| {
        let other = transposed.get(row as usize, col as usize).copied().unwrap_or(0.0);
        (!holds(*own, other)).then_some((row as usize, col as usize, [*own, other]))
    })
}
