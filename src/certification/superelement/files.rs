//! A superelement of another program as it was read.

use std::path::PathBuf;

use faer::Mat;

use crate::dofs::DofMap;
use crate::error::{Error, Result};
use crate::input::{self, Allowance, ForeignModes, MatrixInput, ModeRows, ReducedPair};
use crate::job::Duplicates;

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
    /// What each row of K̂ and M̂ is, where they name their rows.
    pub dofs: Option<DofMap>,
    /// What reading K̂ and M̂ did beyond copying, one sentence each.
    pub notes: Vec<String>,
}

/// A reduced matrix as it was read.
#[derive(Clone, Debug)]
pub struct ReducedMatrix {
    /// All of its entries, r × r.
    pub values: Mat<f64>,
    /// What the rounding of each entry is relative to: how large it is in the file, and where coordinates were turned the terms that it is
    /// the sum of.
    pub sizes: Mat<f64>,
    /// What an entry may be off by: relative to its size, and whatever it is.
    pub rounding: [f64; 2],
    /// BLAKE3 digest of the file's bytes, lower-case hexadecimal.
    pub digest: String,
}

impl ForeignSuperelement {
    /// Reads a superelement, for matrices of these rows. What becomes of entries of K̂ and M̂ that repeat a position is as it is in K and M.
    ///
    /// # Errors
    /// Those of the readers; [`Error::ReducedSize`] where a matrix has not as many rows as the basis has columns.
    pub fn read(
        files: &ReducedFiles,
        rows: &ModeRows,
        (duplicates, allowance): (Duplicates, &Allowance),
    ) -> Result<Self> {
        let basis = input::foreign_modes(&files.basis, rows, allowance)?;
        let n_columns = basis.columns.len();
        let ReducedPair { stiffness, mass, dofs, notes } =
            ReducedPair::read([&files.stiffness, &files.mass], (duplicates, allowance))?;
        // Rows that are named are those that either matrix names.
        let of_rows = if dofs.is_some() { " by the names that K̂ and M̂ have together" } else { "" };
        let matrix = |input| ReducedMatrix::of(input, (n_columns, of_rows));
        let notes = notes.iter().map(ToString::to_string).collect();
        Ok(Self { stiffness: matrix(stiffness)?, mass: matrix(mass)?, basis, dofs, notes })
    }

    /// r.
    pub fn n_coordinates(&self) -> usize {
        self.basis.columns.len()
    }
}

impl ReducedMatrix {
    fn of(input: MatrixInput, (n_columns, of): (usize, &'static str)) -> Result<Self> {
        let found = input.matrix.rows();
        if found != n_columns {
            return Err(Error::ReducedSize { path: input.path, found, of, n_columns });
        }
        let mut values = Mat::zeros(n_columns, n_columns);
        input.matrix.iter().for_each(|(value, (row, column))| values[(row as usize, column as usize)] = *value);
        let sizes = Mat::from_fn(n_columns, n_columns, |i, j| values[(i, j)].abs());
        Ok(Self { values, sizes, rounding: input.digits.half_a_unit(), digest: input.digest })
    }
}
