//! Axes of nodes that the job gives to few digits: whether K shows that they are off by as much as the digits leave open.
//!
//! ```text
//! δ_a    what components of the axes of node a may be off by: half a unit of the last decimal
//! F      n × 6    K C, the forces of the six motions
//! B      n × 6    Σ |K_ij| 2 δ (|c_k| + |c_l|) over the rows j of these nodes, c_k and c_l along the two other axes of the node
//! ```
//! Axes whose components are off by δ are turned by up to 2δ about each axis. Turning a row pair by a wrong angle is a similarity of both
//! matrices: frequencies stay what they are, and no digits of K and M are lost. But the rows are not along the axes that coordinates,
//! interfaces and the superelement take them to be, and the motions by the coordinates make forces, at most B. A node all of whose forces
//! are within B, and some beyond what the digits of K and of the coordinates make, has rounded axes: to few digits they are refused, to more
//! the motions of a free body are those that K lets pass.

use std::collections::BTreeMap;

use faer::Mat;

use super::doubt::SIX_DIGITS;
use super::motions::Motions;
use super::nodes::{FIRST_ROTATION, TOUCHED};
use crate::dofs::AxisDigits;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::number::counted;

/// Share of what the digits may do below which they do nothing: a matrix in single precision leaves less than that of four decimals.
const FELT: f64 = 1e-3;

/// Refuses axes of few digits where K shows them to be off.
pub(super) fn refuse_few_digits(motions: &Motions<'_>) -> Result<()> {
    let Some(axes) = &motions.model.axes else { return Ok(()) };
    let coarse: BTreeMap<i64, AxisDigits> =
        axes.of_node.iter().filter(|(_, digits)| !digits.are_enough()).map(|(node, digits)| (*node, *digits)).collect();
    if coarse.is_empty() {
        return Ok(());
    }
    let explained = Explained::by(motions, &coarse);
    let turned: Vec<(i64, f64)> =
        explained.axes.rows_of.iter().filter_map(|(node, rows)| Some((*node, explained.angle(rows)?))).collect();
    let Some((node, angle)) = turned.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)) else { return Ok(()) };
    let AxisDigits { line, decimals } = coarse[&node];
    let found = format!(
        "the axes of node {node} have {}, and motion of the component as a whole makes forces at {} that no digits of the stiffness explain",
        counted(decimals as usize, "decimal", "decimals"),
        if turned.len() > 1 {
            format!("it and {} of the table", counted(turned.len() - 1, "other node", "other nodes"))
        } else {
            "it".to_owned()
        },
    );
    Err(Error::FrameDigits { path: axes.path.clone(), line, found, angle })
}

/// The forces that roundings of axes may make.
struct Explained<'a> {
    motions: &'a Motions<'a>,
    axes: Rounded<'a>,
    /// Motions that are asked: rotations of a preloaded state make forces of their own.
    n_motions: usize,
}

impl<'a> Explained<'a> {
    fn by(motions: &'a Motions<'a>, coarse: &BTreeMap<i64, AxisDigits>) -> Self {
        let n_motions = if motions.model.internal_forces.is_some() { FIRST_ROTATION } else { motions.centred.ncols() };
        Self { motions, axes: Rounded::of(motions.model, &motions.centred, coarse), n_motions }
    }

    /// How far some rows are turned at least, where roundings of axes explain all their forces and nothing else does.
    fn angle(&self, rows: &[usize]) -> Option<f64> {
        let mut angle = 0.0f64;
        for row in rows {
            let bounds = self.axes.bounds(*row);
            let scale = self.motions.scale_of(*row);
            let of_stiffness = TOUCHED.max(self.motions.rounding_at(*row)) * scale;
            for (motion, bound) in bounds.into_iter().enumerate().take(self.n_motions) {
                let force = self.motions.forces[(*row, motion)].abs();
                if force > bound + of_stiffness {
                    return None;
                }
                let of_coordinates = if motion < FIRST_ROTATION { 0.0 } else { SIX_DIGITS * scale };
                if force > of_stiffness.max(FELT * bound).max(of_coordinates) {
                    angle = angle.max(force / scale);
                }
            }
        }
        (angle > 0.0).then_some(angle)
    }
}

/// B of every row, n × 6; none where no axes look rounded.
pub(super) fn forces_of_rounding(model: &Model, centred: &Mat<f64>) -> Option<Mat<f64>> {
    let axes = Rounded::of(model, centred, &model.axes.as_ref()?.of_node);
    let mut bounds = Mat::zeros(centred.nrows(), centred.ncols());
    for row in 0..bounds.nrows() {
        axes.bounds(row).into_iter().enumerate().for_each(|(j, bound)| bounds[(row, j)] = bound);
    }
    Some(bounds)
}

/// The rows whose axes may be off.
struct Rounded<'a> {
    model: &'a Model,
    /// C, n × 6.
    centred: &'a Mat<f64>,
    /// What the axes of a row may be off by, zero where they are exact.
    off: Vec<f64>,
    /// The rows of each node with rounded axes.
    rows_of: BTreeMap<i64, Vec<usize>>,
}

impl<'a> Rounded<'a> {
    fn of(model: &'a Model, centred: &'a Mat<f64>, digits: &BTreeMap<i64, AxisDigits>) -> Self {
        let mut rounded = Self { model, centred, off: vec![0.0; centred.nrows()], rows_of: BTreeMap::new() };
        let dofs = model.dofs.iter().flat_map(|dofs| dofs.iter().enumerate());
        for (row, node) in dofs.filter_map(|(row, dof)| Some((row, dof.as_ref()?.node))) {
            if let Some(digits) = digits.get(&node) {
                rounded.off[row] = digits.off();
                rounded.rows_of.entry(node).or_default().push(row);
            }
        }
        rounded
    }

    /// B at a row.
    fn bounds(&self, row: usize) -> [f64; 6] {
        let entries = self.model.stiffness.outer_view(row);
        let mut bounds = [0.0; 6];
        for (col, value) in entries.iter().flat_map(|view| view.iter()).filter(|(col, _)| self.off[*col] > 0.0) {
            let across = self.across(col);
            bounds.iter_mut().zip(across).for_each(|(bound, size)| *bound += value.abs() * 2.0 * self.off[col] * size);
        }
        bounds
    }

    /// Σ |c| of the six motions along the two other axes at the node of a row.
    fn across(&self, row: usize) -> [f64; 6] {
        let of_node = |row: usize| self.model.dofs.as_ref().and_then(|dofs| dofs[row]);
        let Some(own) = of_node(row) else { return [0.0; 6] };
        let is_other = |other: &&usize| {
            of_node(**other).is_some_and(|dof| {
                dof.direction != own.direction && dof.direction.is_rotation() == own.direction.is_rotation()
            })
        };
        let others = self.rows_of[&own.node].iter().filter(is_other);
        others.fold([0.0; 6], |sum, other| std::array::from_fn(|j| sum[j] + self.centred[(*other, j)].abs()))
    }
}
