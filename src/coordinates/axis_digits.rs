//! Axes of nodes that the job gives to few digits: whether K shows that they are off by as much as the digits leave open.
//!
//! ```text
//! δ_a    what components of the axes of node a may be off by: half a unit of the last decimal
//! F      n × 6    K C, the forces of the six motions
//! B      n × 6    what roundings of axes may make of them
//! ```
//! Turning a row pair by a wrong angle is a similarity of both matrices: frequencies stay what they are, and no digits of K and M are lost.
//! But the rows are not along the axes that coordinates, interfaces and the superelement take them to be, and the motions by the coordinates
//! make forces, at most B. A node all of whose forces are within B, and some beyond what the digits of K and of the coordinates make, has
//! rounded axes: to few digits they are refused, to more the motions of a free body are those that K lets pass.

use std::collections::BTreeMap;

use super::motions::{Motions, SIX_DIGITS};
use super::nodes::{FIRST_ROTATION, TOUCHED};
use super::rounded_axes::RoundedAxes;
use crate::dofs::AxisDigits;
use crate::error::{Error, Result};
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
    axes: RoundedAxes<'a>,
    /// Motions that are asked: rotations of a preloaded state make forces of their own.
    n_motions: usize,
}

impl<'a> Explained<'a> {
    fn by(motions: &'a Motions<'a>, coarse: &BTreeMap<i64, AxisDigits>) -> Self {
        let n_motions = if motions.model.internal_forces.is_some() { FIRST_ROTATION } else { motions.centred.ncols() };
        Self { motions, axes: RoundedAxes::of(motions.model, &motions.centred, coarse), n_motions }
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
