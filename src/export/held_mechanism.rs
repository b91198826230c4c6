//! Whether the nodes of a model can say how it moves without strain.

use faer::{Mat, MatRef};

use crate::dense;
use crate::error::Result;
use crate::input::strainless::{Place, basis, lengths};
use crate::model::{Frame, Site};

/// Whether supports hold a rigid-body motion of the nodes, and a motion without strain is none of theirs: a hinge on a support. Supports
/// touch all rows of a condensed stiffness, and its nodes cannot be compared with it by the motions that are left. Rows of Û without a
/// place, which are at rest, do not count. `masses` are those of the rows, M_ii.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(super) fn is_held_and_gives_way(
    (places, masses): (&[Option<Place>], &[f64]),
    rigid: MatRef<'_, f64>,
) -> Result<bool> {
    /// The sine of the angle between a motion and those of the nodes. Coordinates of five digits leave less.
    const OTHER: f64 = 1e-4;
    let rows: Vec<usize> = (0..places.len()).filter(|row| places[*row].is_some()).collect();
    let places: Vec<Option<Place>> = rows.iter().map(|row| places[*row]).collect();
    let masses: Vec<f64> = rows.iter().filter_map(|row| masses.get(*row).copied()).collect();
    let lengths = lengths(&places, &masses);
    let site = |place: &Option<Place>| place.map(|(direction, position)| Site { position, direction });
    let sites: Vec<Option<Site>> = places.iter().map(site).collect();
    let centre = Frame::of(&sites, &(0..sites.len()).collect::<Vec<_>>()).centre;
    let of_nodes: Vec<[f64; 6]> = sites.iter().flatten().map(|site| site.rigid_motion_about(centre)).collect();
    let of_nodes = basis(Mat::from_fn(rows.len(), 6, |i, j| of_nodes[i][j]).as_ref(), &lengths)?;
    let free = basis(Mat::from_fn(rows.len(), rigid.ncols(), |i, j| rigid[(rows[i], j)]).as_ref(), &lengths)?;
    Ok(beyond(free.as_ref(), of_nodes.as_ref())? > OTHER && beyond(of_nodes.as_ref(), free.as_ref())? > OTHER)
}

/// The largest sine of a motion of the first basis to the second.
fn beyond(motions: MatRef<'_, f64>, others: MatRef<'_, f64>) -> Result<f64> {
    let mut left = motions.to_owned();
    let along = dense::gram(others, motions);
    dense::add_product(left.as_mut(), -1.0, others, along.as_ref());
    let mut squares = dense::gram(left.as_ref(), left.as_ref());
    dense::symmetrise(&mut squares);
    let (squares, _) = dense::symmetric_eigen(squares.as_ref())?;
    Ok(squares.last().copied().unwrap_or(0.0).max(0.0).sqrt())
}
