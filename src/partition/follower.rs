//! Rows of the model that are no dof of the partition: what holds a result of another program to them.

use super::transformation::Transformation;
use super::transformation_row::TransformationRow;
use crate::dofs::{Dof, FileRows};
use crate::model::Model;
use crate::sparse::diagonal;

/// A row of the model that is held, or that follows dofs of the partition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follower {
    /// The row.
    pub row: usize,
    /// Node and direction, where a map tells them.
    pub dof: Option<Dof>,
    /// Whether it is at rest.
    pub is_held: bool,
    /// K_ii of the model, in scaled units.
    pub stiffness: f64,
}

impl Follower {
    /// What the row is called in messages.
    pub fn name(&self, rows: &FileRows) -> String {
        self.dof.map_or_else(|| format!("row {}", rows.of(self.row) + 1), |dof| dof.to_string())
    }
}

/// The rows that have no dof of their own, ascending.
pub(super) fn followers(model: &Model, transformation: &Transformation) -> Vec<Follower> {
    let is_follower = |row: &usize| !matches!(transformation.rows[*row], TransformationRow::Dof(_));
    let rows: Vec<usize> = (0..transformation.rows.len()).filter(is_follower).collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let stiffness = diagonal(&model.stiffness);
    let dof = |row: usize| model.dofs.as_ref().and_then(|dofs| dofs[row]);
    let is_held = |row: usize| match &transformation.rows[row] {
        TransformationRow::Held => true,
        TransformationRow::Tied(terms) => terms.is_empty(),
        TransformationRow::Dof(_) => false,
    };
    let of = |row: usize| Follower { row, dof: dof(row), is_held: is_held(row), stiffness: stiffness[row] };
    rows.into_iter().map(of).collect()
}
