//! A superelement of another program as it was read.

use std::path::{Path, PathBuf};

use faer::Mat;

use crate::error::{Error, Result};
use crate::input::{self, Allowance, ForeignModes, SingleMatrix};

/// Where a superelement of another program is.
#[derive(Clone, Debug)]
pub struct ReducedFiles {
    /// Ψ: a column for each coordinate, a value for every row of K.
    pub basis: PathBuf,
    /// K̂.
    pub stiffness: PathBuf,
    /// M̂.
    pub mass: PathBuf,
}

/// A superelement of another program, in the units of its files.
#[derive(Clone, Debug)]
pub struct ForeignSuperelement {
    /// Ψ.
    pub basis: ForeignModes,
    /// K̂.
    pub stiffness: ReducedMatrix,
    /// M̂.
    pub mass: ReducedMatrix,
}

/// A reduced matrix as it was read.
#[derive(Clone, Debug)]
pub struct ReducedMatrix {
    /// All of its entries, r × r.
    pub values: Mat<f64>,
    /// What an entry may be off by: relative to it, and whatever it is.
    pub rounding: [f64; 2],
    /// BLAKE3 digest of the file's bytes, lower-case hexadecimal.
    pub digest: String,
}

impl ForeignSuperelement {
    /// Reads a superelement, for matrices of `n_rows` rows in their files.
    ///
    /// # Errors
    /// Those of the readers; [`Error::ReducedSize`] where a matrix has not as many rows as the basis has columns.
    pub fn read(files: &ReducedFiles, n_rows: usize, allowance: &Allowance) -> Result<Self> {
        let basis = input::foreign_modes(&files.basis, n_rows, allowance)?;
        let n_columns = basis.columns.len();
        let matrix = |path: &Path| ReducedMatrix::read(path, n_columns, allowance);
        Ok(Self { stiffness: matrix(&files.stiffness)?, mass: matrix(&files.mass)?, basis })
    }

    /// r.
    pub fn n_coordinates(&self) -> usize {
        self.basis.columns.len()
    }
}

impl ReducedMatrix {
    fn read(path: &Path, n_columns: usize, allowance: &Allowance) -> Result<Self> {
        let matrix = SingleMatrix { file: path.to_owned(), layout: None, dofs: None };
        let input = matrix.read(allowance)?.input;
        let found = input.matrix.rows();
        if found != n_columns {
            return Err(Error::ReducedSize { path: input.path, found, n_columns });
        }
        let mut values = Mat::zeros(n_columns, n_columns);
        input.matrix.iter().for_each(|(value, (row, column))| values[(row as usize, column as usize)] = *value);
        Ok(Self { values, rounding: input.digits.half_a_unit(), digest: input.digest })
    }
}
