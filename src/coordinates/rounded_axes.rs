//! The forces that roundings of the axes of nodes may make of motions of the component as a whole.
//!
//! ```text
//! δ_a    what components of the axes of node a may be off by: half a unit of the last decimal
//! B      n × 6    Σ |K_ij| 2 δ (|c_k| + |c_l| + 2 δ |c_j|) over the rows j of these nodes, c_k and c_l along the two other axes of the node
//! ```
//! Axes whose components are off by δ are turned by up to 2δ about each axis. Turned by two such angles a row keeps 1 − (2δ)² of what it has
//! along its own axis: next to nothing, and all there is where K couples a row with that axis alone, as a block that is its own mirror image does.

use std::collections::BTreeMap;

use faer::Mat;

use crate::dofs::AxisDigits;
use crate::model::Model;

/// B of every row, n × 6; none where no axes look rounded.
pub(super) fn forces_of_rounding(model: &Model, centred: &Mat<f64>) -> Option<Mat<f64>> {
    let axes = RoundedAxes::of(model, centred, &model.axes.as_ref()?.of_node);
    let mut bounds = Mat::zeros(centred.nrows(), centred.ncols());
    for row in 0..bounds.nrows() {
        axes.bounds(row).into_iter().enumerate().for_each(|(j, bound)| bounds[(row, j)] = bound);
    }
    Some(bounds)
}

/// The rows whose axes may be off.
pub(super) struct RoundedAxes<'a> {
    model: &'a Model,
    /// C, n × 6.
    centred: &'a Mat<f64>,
    /// What the axes of a row may be off by, zero where they are exact.
    off: Vec<f64>,
    /// The rows of each node with rounded axes.
    pub(super) rows_of: BTreeMap<i64, Vec<usize>>,
}

impl<'a> RoundedAxes<'a> {
    /// Of some nodes.
    pub(super) fn of(model: &'a Model, centred: &'a Mat<f64>, digits: &BTreeMap<i64, AxisDigits>) -> Self {
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
    pub(super) fn bounds(&self, row: usize) -> [f64; 6] {
        let entries = self.model.stiffness.outer_view(row);
        let mut bounds = [0.0; 6];
        for (col, value) in entries.iter().flat_map(|view| view.iter()).filter(|(col, _)| self.off[*col] > 0.0) {
            let (across, angle) = (self.across(col), 2.0 * self.off[col]);
            let size = |j: usize| across[j] + angle * self.centred[(col, j)].abs();
            (0..6).for_each(|j| bounds[j] += value.abs() * angle * size(j));
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
