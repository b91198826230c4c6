//! Further matrices that the superelement carries by name.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use supel_runtime::MatrixKind;

use super::layout::Layout;
use crate::error::{Error, Result};

/// A matrix A of the model in addition to stiffness and mass, of which the superelement keeps ΨᵀAΨ with its skew part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MatrixJob {
    /// Name, unique among the matrices of the job.
    #[schemars(regex(pattern = r"\S"))]
    pub name: String,
    /// What it is.
    pub kind: MatrixKind,
    /// File of the matrix, with its name in the file after a colon where there are several, as in `model.h5:/C` and `model.op4:BAA`: rows and
    /// columns are those of stiffness and mass.
    #[schemars(length(min = 1), extend("x-role" = "place"))]
    pub file: PathBuf,
    /// The format of the file, where its content leaves several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<Layout>,
}

pub(super) fn validate(matrices: &[MatrixJob]) -> Result<()> {
    for (index, matrix) in matrices.iter().enumerate() {
        if matrix.name.trim().is_empty() {
            return Err(Error::JobEmpty { key: format!("matrix[{index}].name"), expected: "a name" });
        }
        if matrices[..index].iter().any(|other| other.name == matrix.name) {
            return Err(Error::MatrixTwice { name: matrix.name.clone() });
        }
        if matrix.file.as_os_str().is_empty() {
            return Err(Error::JobEmpty { key: format!("matrix[{index}].file"), expected: "the name of a file" });
        }
    }
    Ok(())
}
