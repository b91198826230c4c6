//! Further matrices of the model on the dofs of the partition.
//!
//! ```text
//! A       n × n      as it was read, symmetric or not, without the rows that were dropped
//! TᵀAT    n' × n'    held dofs are at rest, and rows of a patch follow its node
//! ```
//! Each is kept with its largest entry in [1, 2).

use supel_runtime::{MatrixKind, NamedMatrix, Symmetry};

use super::congruence::general_congruence;
use super::interface::row_of_model;
use super::transformation::Transformation;
use crate::error::{Error, Result, Selector};
use crate::input::FurtherMatrix;
use crate::model::{Model, rounding_of};
use crate::sparse::SparseMatrix;

/// Exponents of the largest entry in the user's units: products of two such numbers with squares of shapes are numbers.
const EXPONENTS: std::ops::RangeInclusive<i32> = -400..=400;

/// A further matrix on the dofs of a partition.
#[derive(Clone, Debug)]
pub struct CarriedMatrix {
    /// What it is.
    pub facts: MatrixFacts,
    /// TᵀAT in its unit, n' × n'. Of a symmetric or skew A it is so up to rounding.
    pub matrix: SparseMatrix,
}

/// What is remembered of a further matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct MatrixFacts {
    /// Its name in the job.
    pub name: String,
    /// What it is.
    pub kind: MatrixKind,
    /// What its entries are; none for a matrix that is neither.
    pub symmetry: Option<Symmetry>,
    /// The number in the user's units that an entry of one stands for, a power of two.
    pub unit: f64,
    /// The largest share of its size that an entry may be off by, as far as the digits of the file tell.
    pub rounding: f64,
}

impl MatrixFacts {
    /// What the superelement says of it.
    pub fn in_file(&self) -> NamedMatrix {
        NamedMatrix { name: self.name.clone(), kind: self.kind }
    }
}

/// A further matrix on all rows of a model.
#[derive(Clone, Debug)]
pub struct RowMatrix {
    facts: MatrixFacts,
    matrix: SparseMatrix,
}

/// The matrices that were read, on the rows that are left of those of the files.
///
/// # Errors
/// [`Error::MatrixNothing`] for a matrix of zeros; [`Error::UnitRange`]; an entry in a row that was dropped.
pub fn further_matrices(model: &Model, read: Vec<FurtherMatrix>) -> Result<Vec<RowMatrix>> {
    read.into_iter().map(|matrix| on_rows(model, matrix)).collect()
}

fn on_rows(model: &Model, read: FurtherMatrix) -> Result<RowMatrix> {
    let FurtherMatrix { name, kind, symmetry, input } = read;
    let largest = input.matrix.data().iter().fold(0.0f64, |max, value| max.max(value.abs()));
    if largest == 0.0 {
        return Err(Error::MatrixNothing { matrix: name, found: "zero everywhere" });
    }
    let exponent = largest.log2().floor() as i32;
    if !EXPONENTS.contains(&exponent) {
        return Err(Error::UnitRange { what: "a further matrix", exponent });
    }
    let rounding = rounding_of(&input).measured((&input.matrix).into()).share;
    let mut matrix = if model.rows.n_dropped() > 0 { kept(model, &name, &input.matrix)? } else { input.matrix };
    let unit = f64::from(exponent).exp2();
    matrix.data_mut().iter_mut().for_each(|value| *value /= unit);
    Ok(RowMatrix { facts: MatrixFacts { name, kind, symmetry, unit, rounding }, matrix })
}

/// The rows and columns that the model has.
fn kept(model: &Model, name: &str, matrix: &SparseMatrix) -> Result<SparseMatrix> {
    let (n, selector) = (model.n_dofs(), Selector::Matrix(name.to_owned()));
    let (mut pointers, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
    for (in_files, row) in matrix.outer_iterator().enumerate() {
        for (col, value) in row.iter().filter(|(_, value)| **value != 0.0) {
            row_of_model(model, &selector, in_files)?;
            // Rows keep their order, and so do columns.
            indices.push(row_of_model(model, &selector, col)? as u32);
            data.push(*value);
        }
        if model.rows.find(in_files).is_some() {
            pointers.push(indices.len());
        }
    }
    Ok(SparseMatrix::new((n, n), pointers, indices, data))
}

impl CarriedMatrix {
    /// TᵀAT of each matrix.
    ///
    /// # Errors
    /// [`Error::MatrixNothing`] where a matrix is zero on the dofs that move.
    pub fn carried(matrices: Vec<RowMatrix>, transformation: &Transformation) -> Result<Vec<Self>> {
        let of_row = |RowMatrix { facts, matrix }: RowMatrix| {
            let matrix = general_congruence(&matrix, transformation);
            match matrix.data().iter().all(|value| *value == 0.0) {
                true => Err(Error::MatrixNothing { matrix: facts.name, found: "all of it on held dofs" }),
                false => Ok(Self { facts, matrix }),
            }
        };
        matrices.into_iter().map(of_row).collect()
    }
}
