//! Rows of the basis by which displacements inside the component, and what follows from them, are recovered.
//!
//! ```text
//! T      n × n'              rows of the model from dofs of the partition
//! Ψ      n' × (n_B + n_η)    the basis
//! W      m × (n_B + n_η)     the m rows of TΨ asked for: u = W [u_B; η]
//! ```

use supel_runtime::{Matrix, Precision, RecoveredDof, Recovery};

use super::results::Results;
use super::user_basis::combined_rows;
use crate::error::{Error, Result};

/// Single precision keeps all its digits, 24 bits, of numbers from 2⁻¹²⁶ to 2¹²⁸. Shapes whose largest entry lies between these
/// powers of two keep them down to 2⁻²⁶ of that entry, below which the digits are those of its rounding.
const RANGE_OF_SINGLE: [i32; 2] = [-100, 127];

/// W in the user's units; rows of a rigid patch follow its node.
///
/// # Errors
/// [`Error::RecoveryRange`] where single precision cannot hold the shapes.
pub(super) fn recovery(results: &Results<'_>) -> Result<Option<Recovery>> {
    let Some(job) = &results.job().write.recovery else { return Ok(None) };
    let partition = results.evidence.partition;
    let rows = &partition.recovered.rows;
    let entries = rows.iter().map(|(row, _)| partition.transformation.rows[*row].entries().collect());
    let values = combined_rows(results, &entries.collect::<Vec<_>>());
    if job.precision == Precision::Single {
        refuse_beyond_single(&values, partition.n_interface())?;
    }
    let dofs = rows.iter().map(|(_, dof)| RecoveredDof { node: dof.node, direction: dof.direction });
    let recovery = Recovery::new(values, dofs.collect(), job.precision);
    let recovered = &partition.recovered;
    let placed = |recovery: Recovery| match &recovered.positions {
        Some(positions) => recovery.with_positions(positions.clone()),
        None => Ok(recovery),
    };
    let with_faces = |recovery: Recovery| match recovered.faces.as_ref().filter(|faces| faces.count() > 0) {
        Some(faces) => recovery.with_faces(faces.clone()),
        None => Ok(recovery),
    };
    recovery
        .and_then(placed)
        .and_then(with_faces)
        .map(Some)
        .map_err(|error| Error::of_superelement(&results.job().write.superelement, error))
}

/// R T Ψ in the user's units, m × r; none where the job asks for no quantities.
pub(super) fn quantities(results: &Results<'_>) -> Option<Matrix> {
    let rows = &results.evidence.partition.quantities.rows;
    (!rows.is_empty()).then(|| combined_rows(results, rows))
}

/// The size of the dynamic modes depends on the units; the constraint modes are displacements under unit displacements.
fn refuse_beyond_single(values: &Matrix, n_b: usize) -> Result<()> {
    let shapes = values.as_slice().chunks_exact(values.cols().max(1)).flat_map(|row| &row[n_b..]);
    let largest = shapes.fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let [low, high] = RANGE_OF_SINGLE;
    if largest == 0.0 || (f64::from(low).exp2()..f64::from(high).exp2()).contains(&largest) {
        return Ok(());
    }
    Err(Error::RecoveryRange { largest, low, high })
}
