//! Quantities that follow from displacements inside the component: which rows, and what they are called.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// Rows of a recovery matrix R, of which the superelement keeps R T Ψ: stresses, strains and whatever else is linear in displacements.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuantitiesJob {
    /// Matrix Market file of R, with a row for each quantity and a column for each row of the matrices.
    #[schemars(length(min = 1), extend("x-role" = "place"))]
    pub matrix: PathBuf,
    /// Table with the name of each row, in their order, and its unit where there is one.
    #[schemars(length(min = 1), extend("x-role" = "place"))]
    pub names: PathBuf,
}

pub(super) fn validate(quantities: &QuantitiesJob) -> Result<()> {
    let files = [("write.quantities.matrix", &quantities.matrix), ("write.quantities.names", &quantities.names)];
    match files.into_iter().find(|(_, path)| path.as_os_str().is_empty()) {
        Some((key, _)) => Err(Error::JobEmpty { key: key.to_owned(), expected: "the name of a file" }),
        None => Ok(()),
    }
}
