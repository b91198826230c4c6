//! Internal forces of a preloaded state: a file of one column, as those of loads are.

use std::collections::BTreeMap;

use super::allowance::Allowance;
use super::load_file::{LoadColumn, WantedColumn, WantedColumns, columns_of_file};
use crate::dofs::FileRows;
use crate::error::{Error, Result};
use crate::job::ModelJob;

/// Reads the internal forces of a model whose matrices have `n_rows` rows in their files, where the job names some.
pub(super) fn read_internal_forces(
    model: &ModelJob,
    n_rows: usize,
    allowance: &Allowance,
    digests: &mut BTreeMap<&'static str, String>,
) -> Result<Option<LoadColumn>> {
    let Some(path) = &model.internal_forces else { return Ok(None) };
    let columns = [WantedColumn { load: "internal forces", column: None }];
    let forces = columns_of_file(WantedColumns { path, columns: &columns, n_rows }, allowance)?.pop();
    digests.extend(forces.iter().map(|forces| ("internal_forces", forces.digest.clone())));
    Ok(forces)
}

/// The internal forces of the rows that are left. Rows without stiffness and mass can have none.
pub(super) fn on_rows(LoadColumn { values: forces, .. }: LoadColumn, rows: &FileRows, n: usize) -> Result<Vec<f64>> {
    match forces.iter().enumerate().find(|(row, force)| **force != 0.0 && rows.find(*row).is_none()) {
        Some((row, _)) => Err(Error::PreloadEmptyRow { row: row + 1 }),
        None => Ok((0..n).map(|row| forces[rows.of(row)]).collect()),
    }
}
