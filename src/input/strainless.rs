//! Rows of K̂ that rigid-body motion moves alone, where K̂ holds nothing but rounding.
//!
//! ```text
//! Q    r × n_r    orthonormal basis of Û, rows of rotations times a length
//! ```
//! Where rigid-body motion can move one coordinate and leave all others at rest, the column of K̂ is zero: a single node of six dofs or a
//! single rigid patch that holds its component, and three nodes in a plane across it. What stands there was left by the condensation, of
//! either sign, and is more than the last digit of anything next to it. A model made of K̂ has zeros in its place.

use faer::{Mat, MatRef};
use supel_runtime::{Coordinate, Direction, Matrix, Superelement};

use crate::dense;
use crate::error::Result;

/// K̂ with zeros where it has nothing but rounding.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(crate) fn condensed_stiffness(superelement: &Superelement) -> Result<Matrix> {
    let tensors = superelement.tensors();
    let rigid = dense::unpacked(&tensors.rigid_body_modes);
    let alone = moved_alone(rigid.as_ref(), &lengths(&places(superelement)))?;
    let stiffness = &tensors.stiffness;
    Ok(Matrix::from_fn(stiffness.rows(), stiffness.cols(), |i, j| {
        if alone.contains(&i) || alone.contains(&j) { 0.0 } else { stiffness[(i, j)] }
    }))
}

/// The rows that rigid-body motion moves alone, ascending. Each row of Û times its length is a displacement.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(crate) fn moved_alone(rigid: MatRef<'_, f64>, lengths: &[f64]) -> Result<Vec<usize>> {
    /// Sine between the row and rigid-body motion: two bodies a hundred times their size apart leave 10⁻¹² of rounding. Three nodes that
    /// are off a plane across the row by 10⁻⁷ of their distance have a stiffness along it that is a thousand times that rounding.
    const ALONE: f64 = 1e-11;
    let basis = basis(rigid, lengths)?;
    let is_alone = |row: &usize| {
        // 1 − Σ Q_ij² would be the rounding of one.
        let along = |other: usize| (0..basis.ncols()).map(|j| basis[(other, j)] * basis[(*row, j)]).sum::<f64>();
        let left = |other: usize| if other == *row { 1.0 - along(other) } else { along(other) };
        (0..basis.nrows()).map(|other| left(other).powi(2)).sum::<f64>().sqrt() <= ALONE
    };
    Ok((0..basis.nrows()).filter(is_alone).collect())
}

/// An orthonormal basis of the motions whose rows times their lengths are displacements.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(crate) fn basis(motions: MatRef<'_, f64>, lengths: &[f64]) -> Result<Mat<f64>> {
    /// Singular values of unit columns, relative to the largest, that are rounding.
    const NOTHING: f64 = 1e-9;
    let displacements = Mat::from_fn(motions.nrows(), motions.ncols(), |i, j| lengths[i] * motions[(i, j)]);
    let norms: Vec<f64> = (0..motions.ncols()).map(|j| dense::norm(dense::column(displacements.as_ref(), j))).collect();
    let moving: Vec<usize> = (0..norms.len()).filter(|j| norms[*j] > 0.0).collect();
    // No fewer rows than columns.
    let n_rows = motions.nrows().max(moving.len());
    let unit = Mat::from_fn(n_rows, moving.len(), |i, j| {
        if i < motions.nrows() { displacements[(i, moving[j])] / norms[moving[j]] } else { 0.0 }
    });
    let (singular, directions) = dense::right_singular(unit.as_ref())?;
    let kept: Vec<usize> = (0..singular.len()).filter(|j| singular[*j] > NOTHING * singular[0]).collect();
    let scaled = Mat::from_fn(moving.len(), kept.len(), |i, j| directions[(i, kept[j])] / singular[kept[j]]);
    Ok(dense::product(unit.as_ref().subrows(0, motions.nrows()), scaled.as_ref()))
}

/// What turns each row into a displacement: of a rotation the largest distance of the rows' places from their mean, or one where they are one
/// place; one of all else.
pub(crate) fn lengths(places: &[Option<(Direction, [f64; 3])>]) -> Vec<f64> {
    let positions: Vec<[f64; 3]> = places.iter().flatten().map(|(_, position)| *position).collect();
    let length = span(&positions);
    let turns = |place: &Option<(Direction, [f64; 3])>| place.is_some_and(|(direction, _)| direction.is_rotation());
    places.iter().map(|place| if turns(place) { length } else { 1.0 }).collect()
}

fn span(positions: &[[f64; 3]]) -> f64 {
    /// Distances relative to the farthest coordinate that are rounding of the mean.
    const ONE_PLACE: f64 = 1e-12;
    let count = positions.len().max(1) as f64;
    let mean = [0, 1, 2].map(|axis| positions.iter().map(|position| position[axis]).sum::<f64>() / count);
    let distance = |position: &[f64; 3]| dense::norm(&[0, 1, 2].map(|axis| position[axis] - mean[axis]));
    let span = positions.iter().map(distance).fold(0.0, f64::max);
    let far = positions.iter().flatten().fold(0.0f64, |max, x| max.max(x.abs()));
    if span > ONE_PLACE * far { span } else { 1.0 }
}

/// Direction and position of each coordinate that is one of an interface node.
pub(crate) fn places(superelement: &Superelement) -> Vec<Option<(Direction, [f64; 3])>> {
    let metadata = superelement.metadata();
    let place = |coordinate: &Coordinate| match coordinate {
        Coordinate::Interface { node, direction } => Some((*direction, metadata.interface_nodes[*node].position)),
        _ => None,
    };
    metadata.coordinates.iter().map(place).collect()
}
