//! Further matrices of the model on the dofs of the partition.
//!
//! ```text
//! A       n × n      as it was read, symmetric or not, without the rows that were dropped
//! TᵀAT    n' × n'    held dofs are at rest, and rows of a patch follow its node
//! |T|ᵀS|T|           what the entries are sums of: those of a patch may cancel
//! S_ij = |A_ij|, of damping max(|A_ij|, √(A_ii A_jj))
//! ```
//! Damping is itself a sum, of dampers or of modes, ∑ c_k d_k d_kᵀ. The terms of an entry are at most √(A_ii A_jj) together, however well they
//! cancel: those of symmetric bodies do to the last digit.
//! Each is kept with its largest entry in [1, 2).

use faer::{Mat, MatRef};
use supel_runtime::{MatrixKind, NamedMatrix, Symmetry};

use super::congruence::general_congruence;
use super::interface::row_of_model;
use super::transformation::Transformation;
use super::transformation_row::TransformationRow;
use crate::error::{Error, Result, Selector};
use crate::input::FurtherMatrix;
use crate::model::{Model, rounding_of};
use crate::sparse::{SparseMatrix, absolute_product};

/// Exponents of the largest entry in the user's units: products of two such numbers with squares of shapes are numbers.
const EXPONENTS: std::ops::RangeInclusive<i32> = -400..=400;

/// What is left of an entry whose terms cancel, relative to these: factors of T are made of tens of rounded numbers, and sums have hundreds of
/// terms.
const ROUNDING: f64 = 4096.0 * f64::EPSILON;

/// A further matrix on the dofs of a partition.
#[derive(Clone, Debug)]
pub struct CarriedMatrix {
    /// What it is.
    pub facts: MatrixFacts,
    /// TᵀAT in its unit, n' × n'. Of a symmetric or skew A it is so up to rounding.
    pub matrix: SparseMatrix,
    /// |T|ᵀS|T|, where an entry may be a sum.
    sizes: Option<SparseMatrix>,
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
    /// [`Error::MatrixNothing`] where a matrix is zero on the dofs that move, or what rounding leaves of zero.
    pub fn carried(matrices: Vec<RowMatrix>, transformation: &Transformation) -> Result<Vec<Self>> {
        let has_sums = transformation.rows.iter().any(|row| matches!(row, TransformationRow::Tied(_)));
        let moduli = has_sums.then(|| transformation.of_moduli());
        let of_row = |RowMatrix { facts, matrix: mut of_rows }: RowMatrix| {
            let matrix = general_congruence(&of_rows, transformation);
            let found = match is_all_held(&of_rows, transformation) {
                true => "all of it on held dofs",
                false => "nothing of it but rounding where patches and constraints let dofs move",
            };
            let is_damping = facts.kind == MatrixKind::Damping;
            let sizes = (is_damping || has_sums).then(|| {
                to_terms(&mut of_rows, facts.kind);
                general_congruence(&of_rows, moduli.as_ref().unwrap_or(transformation))
            });
            match is_rounding(&matrix, sizes.as_ref().filter(|_| has_sums)) {
                true => Err(Error::MatrixNothing { matrix: facts.name, found }),
                false => Ok(Self { facts, matrix, sizes }),
            }
        };
        matrices.into_iter().map(of_row).collect()
    }

    /// What the forces A u and Aᵀu of motions are sums of, relative to its unit: |T|ᵀS|T||u| and |T|ᵀSᵀ|T||u|, n' × n_u each.
    pub(crate) fn sizes_of_forces(&self, u: MatRef<'_, f64>) -> [Mat<f64>; 2] {
        let sizes = self.sizes.as_ref().unwrap_or(&self.matrix);
        [absolute_product(sizes, u), absolute_product(&sizes.transpose_view().to_csr(), u)]
    }
}

/// Whether every entry is in a row or a column at rest.
fn is_all_held(matrix: &SparseMatrix, transformation: &Transformation) -> bool {
    let is_held = |row: usize| matches!(transformation.rows[row], TransformationRow::Held);
    let of_row = |row: usize| matrix.outer_view(row).into_iter().flat_map(|row| row.into_raw_storage().0);
    (0..matrix.rows()).filter(|row| !is_held(*row)).flat_map(of_row).all(|col| is_held(*col as usize))
}

/// Whether all entries are zero or what rounding leaves of sums of these sizes.
fn is_rounding(matrix: &SparseMatrix, sizes: Option<&SparseMatrix>) -> bool {
    let size = |row: usize, col: usize| sizes.and_then(|sizes| sizes.get(row, col)).copied().unwrap_or(0.0);
    let mut rows = matrix.outer_iterator().enumerate();
    rows.all(|(i, row)| row.iter().all(|(j, value)| value.abs() <= ROUNDING * size(i, j)))
}

/// S of the module in place of A.
fn to_terms(matrix: &mut SparseMatrix, kind: MatrixKind) {
    let roots: Vec<f64> = match kind {
        MatrixKind::Damping => {
            (0..matrix.rows()).map(|i| matrix.get(i, i).copied().unwrap_or(0.0).abs().sqrt()).collect()
        }
        _ => vec![0.0; matrix.rows()],
    };
    for (i, mut row) in matrix.outer_iterator_mut().enumerate() {
        for (j, value) in row.iter_mut() {
            *value = value.abs().max(roots[i] * roots[j]);
        }
    }
}
