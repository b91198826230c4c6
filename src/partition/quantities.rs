//! Quantities that follow from displacements inside the component.
//!
//! ```text
//! R      m × n     rows of the job on all rows of the model
//! R T    m × n'    on the dofs of the partition; held dofs are at rest, and rows of a rigid patch follow its node
//! ```

use supel_runtime::Quantity;

use super::interface::row_of_model;
use super::transformation::Transformation;
use crate::error::{Result, Selector};
use crate::input::QuantityRows;
use crate::model::Model;

/// Rows on the dofs of a partition; none unless a job asks for some.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Quantities {
    /// What each row is.
    pub names: Vec<Quantity>,
    /// R T: for each row its dofs, ascending, with their factors.
    pub rows: Vec<Vec<(u32, f64)>>,
}

/// Rows on all rows of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelQuantities {
    names: Vec<Quantity>,
    /// R: for each row its rows of the model with their factors.
    rows: Vec<Vec<(usize, f64)>>,
}

/// The rows that were read, on the rows that are left of those of the files.
///
/// # Errors
/// A quantity of a row that was dropped.
pub fn quantities(model: &Model, read: Option<QuantityRows>) -> Result<ModelQuantities> {
    let Some(QuantityRows { names, entries, .. }) = read else { return Ok(ModelQuantities::default()) };
    let mut rows = vec![Vec::new(); names.len()];
    for (quantity, row, value) in entries {
        rows[quantity as usize].push((row_of_model(model, &Selector::Quantities, row as usize)?, value));
    }
    Ok(ModelQuantities { names, rows })
}

impl Quantities {
    /// R T.
    pub fn carried(quantities: ModelQuantities, transformation: &Transformation) -> Self {
        let of_row = |row: Vec<(usize, f64)>| {
            let terms = row.into_iter().flat_map(|(row, value)| {
                transformation.rows[row].entries().map(move |(dof, factor)| (dof, factor * value))
            });
            let mut terms: Vec<(u32, f64)> = terms.collect();
            // Terms of one dof stay in the order of the file, so that their sum has the same bits in every run.
            terms.sort_by_key(|(dof, _)| *dof);
            let mut merged: Vec<(u32, f64)> = Vec::with_capacity(terms.len());
            for (dof, value) in terms {
                match merged.last_mut() {
                    Some((last, sum)) if *last == dof => *sum += value,
                    _ => merged.push((dof, value)),
                }
            }
            merged
        };
        Self { names: quantities.names, rows: quantities.rows.into_iter().map(of_row).collect() }
    }
}
