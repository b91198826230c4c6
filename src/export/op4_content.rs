//! What the files for Nastran hold: its names for the matrices of a superelement.

use supel_runtime::{Matrix, Recovery, Superelement, Tensors};

use super::load_transformation::transformations;
use super::matrix_market::side_by_side;
use crate::error::{Error, Result};

/// A real matrix of an OUTPUT4 file.
pub(super) struct Named {
    /// At most eight characters.
    pub(super) name: &'static str,
    pub(super) form: Form,
    pub(super) matrix: Matrix,
}

/// What Nastran is told of a matrix.
#[derive(Clone, Copy)]
pub(super) enum Form {
    Rectangular = 2,
    Symmetric = 6,
}

/// The type of matrices of doubles.
pub(super) const REAL_DOUBLE: usize = 2;

/// The value that the record after the last column carries.
pub(super) const LAST: f64 = std::f64::consts::SQRT_2;

/// The matrices of a superelement in their order in the file.
///
/// # Errors
/// [`Error::ExportLabel`].
pub(super) fn matrices(superelement: &Superelement) -> Result<Vec<Named>> {
    let Tensors { stiffness, mass, damping, gravity, load_vectors, recovery, quantities, matrices, .. } =
        superelement.tensors();
    let further = side_by_side(matrices);
    let recovery_dofs = recovery.as_ref().map(recovery_dofs).transpose()?;
    let all = [
        ("KAA", Form::Symmetric, Some(stiffness)),
        ("MAA", Form::Symmetric, Some(mass).filter(|mass| mass.rows() > 0)),
        ("BAA", Form::Rectangular, damping.as_ref()),
        ("GRAVITY", Form::Rectangular, gravity.as_ref()),
        ("LOADS", Form::Rectangular, load_vectors.as_ref()),
        ("RECOVERY", Form::Rectangular, recovery.as_ref().map(|recovery| recovery.rows())),
        ("RECDOFS", Form::Rectangular, recovery_dofs.as_ref()),
        ("OTM", Form::Rectangular, quantities.as_ref()),
        ("FURTHER", Form::Rectangular, further.as_ref()),
    ];
    let named = all.into_iter().filter_map(|(name, form, matrix)| Some(Named { name, form, matrix: matrix?.clone() }));
    let transformations = transformations(superelement).into_iter();
    let derived = transformations.map(|own| Named { name: own.name, form: Form::Rectangular, matrix: own.matrix });
    Ok(named.chain(derived).collect())
}

/// The names, for people.
pub(super) fn content(matrices: &[Named]) -> String {
    matrices.iter().map(|named| named.name).collect::<Vec<_>>().join(", ")
}

/// Label and component, 1 to 6, of each recovered dof, m × 2.
fn recovery_dofs(recovery: &Recovery) -> Result<Matrix> {
    /// Every whole number up to this is a double.
    const EXACT: u64 = 1 << f64::MANTISSA_DIGITS;
    let dofs = recovery.dofs();
    if let Some(dof) = dofs.iter().find(|dof| dof.node.unsigned_abs() > EXACT) {
        return Err(Error::ExportLabel { node: dof.node });
    }
    let component = |row: usize| dofs[row].direction as usize as f64 + 1.0;
    Ok(Matrix::from_fn(dofs.len(), 2, |i, j| if j == 0 { dofs[i].node as f64 } else { component(i) }))
}

impl Named {
    /// The columns that have an entry: number from one, row of the first entry from one, values from there to the last entry.
    pub(super) fn columns(&self) -> impl Iterator<Item = (usize, usize, Vec<f64>)> {
        (0..self.matrix.cols()).filter_map(|j| {
            let entries = || (0..self.matrix.rows()).filter(|i| self.matrix[(*i, j)] != 0.0);
            let (first, last) = (entries().next()?, entries().next_back()?);
            Some((j + 1, first + 1, (first..=last).map(|i| self.matrix[(i, j)]).collect()))
        })
    }
}
