//! What was typed after `supel convert`, checked.

use std::path::{Path, PathBuf};

use super::flags::ConvertFlags;
use crate::conversion::{LETTERS_OF_AN_OP4_NAME, Target};
use crate::error::{Error, Result};
use crate::input::SingleMatrix;

/// What is written in another format.
#[derive(Debug)]
pub(super) enum ConvertCommand {
    Matrix(MatrixConversion),
    Mesh(MeshConversion),
}

/// Write a matrix in another format.
#[derive(Debug)]
pub(super) struct MatrixConversion {
    pub(super) matrix: SingleMatrix,
    pub(super) target: Target,
    pub(super) output: PathBuf,
    /// Where the dof of each row is written, where that is asked for.
    pub(super) dofs_output: Option<PathBuf>,
    /// The name that was typed.
    pub(super) name: Option<String>,
    pub(super) answer: ConvertAnswer,
}

/// Write a mesh as VTKHDF.
#[derive(Debug)]
pub(super) struct MeshConversion {
    pub(super) file: PathBuf,
    pub(super) output: PathBuf,
    pub(super) answer: ConvertAnswer,
}

/// What `supel convert` prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ConvertAnswer {
    Text,
    Json,
}

impl ConvertCommand {
    /// # Errors
    /// [`Error::FlagText`] for a name that says no format, for one that a matrix cannot have, and for flags of matrices where a mesh is
    /// written; [`Error::NameNotText`].
    pub(super) fn build(flags: ConvertFlags) -> Result<Self> {
        let ConvertFlags { from, output, layout, to, dofs, write_dofs, name, json } = flags;
        for (key, path) in [("FROM", &from), ("OUTPUT", &output)] {
            path.to_str().ok_or_else(|| Error::NameNotText { key, path: path.clone() })?;
        }
        let text = |path: &Path| path.display().to_string();
        let target = to.or_else(|| Target::of_ending(&output)).ok_or_else(|| Error::FlagText {
            flag: "OUTPUT",
            text: text(&output),
            expected: "a name that ends in .mtx, .mat, .npz, .op4 or, of a mesh, .vtkhdf, or a format by --to",
        })?;
        if let Some(name) = name.as_ref().filter(|name| !is_name(name)) {
            let expected = "a letter, then letters, digits and underscores";
            return Err(Error::FlagText { flag: "--name", text: name.clone(), expected });
        }
        let is_op4 = matches!(target, Target::Op4 | Target::Op4Binary);
        if let Some(name) = name.as_ref().filter(|name| is_op4 && name.len() > LETTERS_OF_AN_OP4_NAME) {
            let expected = "eight letters, digits and underscores at most, which is all that an OP4 file has room for";
            return Err(Error::FlagText { flag: "--name", text: name.clone(), expected });
        }
        let answer = if json { ConvertAnswer::Json } else { ConvertAnswer::Text };
        if target == Target::Vtkhdf {
            if layout.is_some() || dofs.is_some() || write_dofs.is_some() || name.is_some() {
                let expected = "neither --layout, --dofs, --write-dofs nor --name, which are those of a matrix";
                return Err(Error::FlagText { flag: "--to", text: target.name(), expected });
            }
            return Ok(Self::Mesh(MeshConversion { file: from, output, answer }));
        }
        let matrix = SingleMatrix { file: from, layout, dofs };
        Ok(Self::Matrix(MatrixConversion { matrix, target, output, dofs_output: write_dofs, name, answer }))
    }
}

impl MatrixConversion {
    /// The name of the matrix: as typed, as in the file that was read, or as the file that is written.
    pub(super) fn name(&self, in_file: Option<&str>) -> String {
        let of_file = in_file.and_then(|name| name.rsplit('/').next()).map(str::to_owned);
        let of_output = || self.output.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let names = [self.name.clone(), of_file, of_output()];
        names.into_iter().flatten().find(|name| is_name(name)).unwrap_or_else(|| "A".to_owned())
    }
}

/// Whether a text can be the name of a variable.
fn is_name(text: &str) -> bool {
    text.starts_with(|first: char| first.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}
