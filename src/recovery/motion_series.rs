//! Motion of the recovered nodes as a series for ParaView, on the faces between them: W q, W q̇ and W q̈ as vectors.

use std::path::Path;

use supel_runtime::{RecoveredFaces, Recovery};

use super::product::times;
use super::state::{Order, State};
use super::vtk_grid::{Cells, Field, Values};
use super::vtk_series::Series;
use crate::error::{Error, Result};

/// Translations of a node, or its rotations, and what their derivatives are called.
const KINDS: [[&str; 3]; 2] =
    [["displacement", "velocity", "acceleration"], ["rotation", "angular_velocity", "angular_acceleration"]];

/// A VTKHDF file of the motion of recovered nodes.
pub struct MotionSeries<'a> {
    recovery: &'a Recovery,
    positions: &'a [[f64; 3]],
    /// For each node the row of each direction.
    rows: Vec<[Option<usize>; 6]>,
    /// Which derivative of translations, 0, or rotations, 1.
    fields: Vec<(Order, usize)>,
    series: Series,
    /// What messages call the file, which has another name while it grows.
    name: &'a Path,
    is_first: bool,
}

impl<'a> MotionSeries<'a> {
    /// An empty series at `path`, which messages call `name`, of the rows W of a file and the positions of their nodes, with these derivatives. Rotations are there where a
    /// node has some.
    ///
    /// # Errors
    /// [`Error::Write`]; [`Error::FeatureMissing`] where the program is
    /// built without HDF5.
    pub fn create(
        path: &Path,
        name: &'a Path,
        recovery: &'a Recovery,
        positions: &'a [[f64; 3]],
        orders: &[Order],
    ) -> Result<MotionSeries<'a>> {
        let rows = rows_of_nodes(recovery);
        let turns = rows.iter().any(|row| row[3..].iter().any(Option::is_some));
        let n_kinds = if turns { 2 } else { 1 };
        let fields: Vec<(Order, usize)> =
            (0..n_kinds).flat_map(|kind| orders.iter().map(move |order| (*order, kind))).collect();
        let named = |(order, kind): &(Order, usize)| Field { name: KINDS[*kind][*order as usize], n_components: 3 };
        let names: Vec<Field> = fields.iter().map(named).collect();
        let faces = recovery.faces().into_iter().flat_map(RecoveredFaces::iter);
        let series = Series::create(path, rows.len(), &Cells::of_faces(faces, rows.len()), &names);
        let series = series.map_err(|error| renamed(error, name))?;
        Ok(Self { recovery, positions, rows, fields, series, name, is_first: true })
    }

    /// Appends a state. One without a time has its number as the time. A direction that a node does not have is at rest.
    ///
    /// # Errors
    /// What overflows, in words, inside; [`Error::Write`] outside.
    pub fn push(&mut self, state: &State) -> Result<std::result::Result<(), String>> {
        let mut all = Vec::with_capacity(self.fields.len());
        for (order, kind) in &self.fields {
            let q = state.of(*order).unwrap_or_default();
            let at = |row: Option<usize>| row.map_or(0.0, |row| times(self.recovery.rows(), row, q));
            let value = |row: &[Option<usize>; 6]| std::array::from_fn(|axis| at(row[3 * kind + axis]));
            let vectors: Vec<[f64; 3]> = self.rows.iter().map(value).collect();
            if let Some(node) = vectors.iter().position(|vector| vector.iter().any(|value| !value.is_finite())) {
                return Ok(Err(format!("the motion of node {}", self.recovery.labels()[node])));
            }
            all.push(vectors);
        }
        let values: Vec<Values<'_>> = all.iter().map(|vectors| Values::Vectors(vectors)).collect();
        let points = self.is_first.then_some(self.positions);
        self.is_first = false;
        self.series
            .push(state.time.unwrap_or(state.number as f64), points, &values)
            .map(Ok)
            .map_err(|error| renamed(error, self.name))
    }

    /// Ends the file.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn finish(self) -> Result<()> {
        self.series.finish().map_err(|error| renamed(error, self.name))
    }
}

/// An error of writing that names the file as the user did.
fn renamed(error: Error, name: &Path) -> Error {
    let path = name.to_owned();
    match error {
        Error::Write { source, .. } => Error::Write { path, source },
        Error::FeatureMissing { feature, .. } => Error::FeatureMissing { path, feature },
        other => other,
    }
}

/// The rows of each node, in the order of their first ones.
fn rows_of_nodes(recovery: &Recovery) -> Vec<[Option<usize>; 6]> {
    let labels = recovery.labels();
    let places: std::collections::HashMap<i64, usize> = labels.iter().copied().zip(0..).collect();
    let mut rows = vec![[None; 6]; labels.len()];
    for (row, dof) in recovery.dofs().iter().enumerate() {
        rows[places[&dof.node]][dof.direction as usize] = Some(row);
    }
    rows
}
