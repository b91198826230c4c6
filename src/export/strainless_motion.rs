//! How a model moves without strain, next to what its nodes say of rigid-body motion.

use std::collections::BTreeSet;

use faer::{Mat, MatRef};
use supel_runtime::Direction;

use crate::dense;
use crate::error::Result;
use crate::input::strainless::{Place, basis, lengths};
use crate::job::AssumesJob;
use crate::model::{Frame, Site};

/// The sine of the angle between a motion and those of the nodes. Coordinates of five digits leave less.
const OTHER: f64 = 1e-4;

/// Whether supports hold a rigid-body motion of the nodes, and a motion without strain is none of theirs: a hinge on a support. Supports
/// touch all rows of a condensed stiffness, and its nodes cannot be compared with it by the motions that are left. Rows of Û without a
/// place, which are at rest, do not count. `masses` are those of the rows, M_ii.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(super) fn is_held_and_gives_way(rows: (&[Option<Place>], &[f64]), rigid: MatRef<'_, f64>) -> Result<bool> {
    let all: Vec<usize> = (0..rows.0.len()).collect();
    let motions = Motions::of(rows, &all, rigid)?;
    Ok(motions.give_way()? && motions.hold()?)
}

/// Whether a part that stiffness or mass joins moves without strain as its nodes do not: a hinge.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(super) fn gives_way(
    rows: (&[Option<Place>], &[f64]),
    matrices: [MatRef<'_, f64>; 2],
    rigid: MatRef<'_, f64>,
) -> Result<bool> {
    for part in parts(matrices) {
        if Motions::of(rows, &part, rigid)?.give_way()? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Rotations that supports hold of a part which they let move along every axis; where nodes lack rotations that the model has, also those
/// that nothing makes, however it moves along the axes: no row of these nodes answers for them.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(super) fn rotations_held_alone(
    rows: (&[Option<Place>], &[f64]),
    matrices: [MatRef<'_, f64>; 2],
    (rigid, assumed): (MatRef<'_, f64>, &AssumesJob),
) -> Result<BTreeSet<Direction>> {
    let missing = assumed.at_rest.iter().chain(&assumed.left_out);
    let lack_rotations = missing.filter_map(|part| part.ending()).any(|(_, direction)| direction.is_rotation());
    let mut held = BTreeSet::new();
    for part in parts(matrices) {
        let motions = Motions::of(rows, &part, rigid)?;
        let costly = motions.held()?;
        if costly.iter().all(|direction| direction.is_rotation()) {
            held.extend(costly);
        } else if lack_rotations {
            held.extend(motions.unturned()?);
        }
    }
    Ok(held)
}

/// Motions of rows that have a place, as displacements.
struct Motions {
    /// The six of the nodes about their mean.
    of_nodes: Mat<f64>,
    /// An orthonormal basis of those without strain.
    free: Mat<f64>,
}

impl Motions {
    /// Of the rows that are listed.
    fn of((places, masses): (&[Option<Place>], &[f64]), listed: &[usize], rigid: MatRef<'_, f64>) -> Result<Self> {
        let rows: Vec<usize> = listed.iter().copied().filter(|row| places[*row].is_some()).collect();
        let places: Vec<Option<Place>> = rows.iter().map(|row| places[*row]).collect();
        let masses: Vec<f64> = rows.iter().filter_map(|row| masses.get(*row).copied()).collect();
        let lengths = lengths(&places, &masses);
        let site = |place: &Option<Place>| place.map(|(direction, position)| Site { position, direction });
        let sites: Vec<Option<Site>> = places.iter().map(site).collect();
        let centre = Frame::of(&sites, &(0..sites.len()).collect::<Vec<_>>()).centre;
        let of_nodes: Vec<[f64; 6]> = sites.iter().flatten().map(|site| site.rigid_motion_about(centre)).collect();
        let of_nodes = Mat::from_fn(rows.len(), 6, |i, j| lengths[i] * of_nodes[i][j]);
        let free = basis(Mat::from_fn(rows.len(), rigid.ncols(), |i, j| rigid[(rows[i], j)]).as_ref(), &lengths)?;
        Ok(Self { of_nodes, free })
    }

    /// Whether a motion without strain is none of the nodes.
    fn give_way(&self) -> Result<bool> {
        let ones = vec![1.0; self.of_nodes.nrows()];
        Ok(beyond(self.free.as_ref(), basis(self.of_nodes.as_ref(), &ones)?.as_ref())? > OTHER)
    }

    /// Whether a motion of the nodes costs energy.
    fn hold(&self) -> Result<bool> {
        let ones = vec![1.0; self.of_nodes.nrows()];
        Ok(beyond(basis(self.of_nodes.as_ref(), &ones)?.as_ref(), self.free.as_ref())? > OTHER)
    }

    /// Directions in which a motion of the nodes costs energy, rotations about their mean.
    fn held(&self) -> Result<Vec<Direction>> {
        let ones = vec![1.0; self.of_nodes.nrows()];
        let mut held = Vec::new();
        for (column, direction) in Direction::ALL.into_iter().enumerate() {
            let own = basis(self.of_nodes.as_ref().subcols(column, 1), &ones)?;
            if beyond(own.as_ref(), self.free.as_ref())? > OTHER {
                held.push(direction);
            }
        }
        Ok(held)
    }

    /// Rotations that no motion without strain makes, together with any translation: those that translations and motions without strain do
    /// not span.
    fn unturned(&self) -> Result<Vec<Direction>> {
        const FIRST: usize = 3;
        let n_rows = self.of_nodes.nrows();
        let ones = vec![1.0; n_rows];
        let along = |i: usize, j: usize| if j < FIRST { self.of_nodes[(i, j)] } else { self.free[(i, j - FIRST)] };
        let spanned = basis(Mat::from_fn(n_rows, FIRST + self.free.ncols(), along).as_ref(), &ones)?;
        let mut unturned = Vec::new();
        for column in FIRST..Direction::ALL.len() {
            let own = basis(self.of_nodes.as_ref().subcols(column, 1), &ones)?;
            if beyond(own.as_ref(), spanned.as_ref())? > OTHER {
                unturned.push(Direction::ALL[column]);
            }
        }
        Ok(unturned)
    }
}

/// Rows that an entry of one of the matrices joins, directly or by others.
fn parts(matrices: [MatRef<'_, f64>; 2]) -> Vec<Vec<usize>> {
    let are_joined = |a: usize, b: usize| matrices.iter().any(|matrix| matrix[(a, b)] != 0.0 || matrix[(b, a)] != 0.0);
    dense::joined_parts(matrices[0].nrows(), are_joined)
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
