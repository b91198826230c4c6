//! Rigid-body motions of the assembly: those of the components that agree where they are joined and rest where they are held.
//!
//! ```text
//! Û = diag(Û_c)      Σr_c × Σn_r     at unit modal mass
//! C Û a = 0          one row for each pair of joined dofs and each held dof
//! ```

use faer::{Mat, MatRef};

use super::component::Component;
use crate::dense;
use crate::error::Result;

/// Disagreement relative to the motion itself that rounding leaves.
const ROUNDING: f64 = 1e-9;

/// What ties coordinates of the components, before anything is joined.
pub(super) struct Ties<'a> {
    /// Pairs of coordinates that are one.
    pub(super) joined: &'a [[usize; 2]],
    /// Coordinates that are held.
    pub(super) held: &'a [usize],
    /// How far joined nodes are from each other, relative to the components: rotations disagree by as much.
    pub(super) distance: f64,
}

/// The rigid-body motions of the assembly in the coordinates of the components, Σr_c × their number.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(super) fn rigid_motions(components: &[Component], ties: &Ties<'_>) -> Result<Mat<f64>> {
    let n: usize = components.iter().map(Component::n_coordinates).sum();
    let mut own: Vec<Mat<f64>> = Vec::new();
    for component in components {
        own.push(dense::orthonormal(component.rigid.as_ref(), component.mass.as_ref()));
    }
    let mut motions = Mat::zeros(n, own.iter().map(Mat::ncols).sum());
    let (mut row, mut column) = (0, 0);
    for part in &own {
        motions.as_mut().submatrix_mut(row, column, part.nrows(), part.ncols()).copy_from(part);
        (row, column) = (row + part.nrows(), column + part.ncols());
    }
    let sizes = sizes(components, motions.as_ref());
    let n_rows = (ties.joined.len() + ties.held.len()).max(motions.ncols());
    let mut disagreement = Mat::zeros(n_rows, motions.ncols());
    let tied = ties.joined.iter().map(|[i, j]| (*i, Some(*j))).chain(ties.held.iter().map(|i| (*i, None)));
    for (row, (i, j)) in tied.enumerate() {
        let size = sizes[i].max(j.map_or(0.0, |j| sizes[j]));
        for column in 0..motions.ncols() {
            let difference = motions[(i, column)] - j.map_or(0.0, |j| motions[(j, column)]);
            disagreement[(row, column)] = if size > 0.0 { difference / size } else { 0.0 };
        }
    }
    let (values, vectors) = dense::right_singular(disagreement.as_ref())?;
    // A rotation about a joint whose two nodes are a distance apart moves them apart by as much.
    let agree = ROUNDING + 4.0 * ties.distance * ((n_rows as f64).sqrt());
    let rigid: Vec<usize> = (0..values.len()).filter(|j| values[*j] <= agree).collect();
    Ok(dense::product(motions.as_ref(), dense::columns(vectors.as_ref(), &rigid).as_ref()))
}

/// How far the motions of unit mass go in each coordinate, the largest over the coordinates of its kind in its component: displacements
/// are compared with displacements and rotations with rotations.
fn sizes(components: &[Component], motions: MatRef<'_, f64>) -> Vec<f64> {
    let mut sizes = Vec::new();
    for component in components {
        let first = sizes.len();
        let coordinates = &component.superelement.metadata().coordinates;
        let kind = |i: usize| match coordinates[i] {
            supel_runtime::Coordinate::Interface { direction, .. } => usize::from(direction.is_rotation()),
            _ => 2,
        };
        let length = |i: usize| (0..motions.ncols()).map(|j| motions[(first + i, j)].powi(2)).sum::<f64>().sqrt();
        let mut largest = [0.0f64; 3];
        (0..coordinates.len()).for_each(|i| largest[kind(i)] = largest[kind(i)].max(length(i)));
        sizes.extend((0..coordinates.len()).map(|i| largest[kind(i)]));
    }
    sizes
}
