//! One matrix as it is, for whoever wants no model.

use std::path::PathBuf;

use super::common_rows::RowLabels;
use super::format::MatrixSource;
use super::map_and_nodes::dof_map_for_labels;
use super::member::split_member;
use super::model_files::read_matrix;
use super::{Allowance, InputNote, MatrixInput, MatrixRole, common_rows, formats, superelement_file};
use crate::dofs::DofMap;
use crate::error::{Error, Result};
use crate::job::Layout;

/// What is asked of the file of one matrix.
#[derive(Clone, Debug)]
pub struct SingleMatrix {
    /// The file, with the name of the matrix after a colon where there are several.
    pub file: PathBuf,
    /// The format, where the content leaves several.
    pub layout: Option<Layout>,
    /// A dof map: the rows of a matrix that names its own are put in its order, and it has as many as one that names none.
    pub dofs: Option<PathBuf>,
}

/// A matrix as it was read.
#[derive(Clone, Debug)]
pub struct ReadSingle {
    /// The matrix.
    pub input: MatrixInput,
    /// The format that the file is in.
    pub layout: Layout,
    /// The name of the matrix in the file, where the path has one.
    pub name: Option<String>,
    /// What each row is, where the matrix or a map says so.
    pub dofs: Option<DofMap>,
    /// What the matrix or the map calls each row, with the labels of scalar dofs.
    pub labels: RowLabels,
    /// What reading needed beyond copying.
    pub notes: Vec<InputNote>,
}

impl SingleMatrix {
    /// The file, without the name of a matrix.
    pub fn path(&self) -> PathBuf {
        split_member(&self.file).0
    }

    /// Whether the HDF5 library reads it.
    pub fn is_parsed_in_c(&self) -> bool {
        formats::of_matrix(&self.source(&Allowance::of(None))).is_ok_and(|format| format.is_parsed_in_c())
    }

    fn source<'a>(&self, allowance: &'a Allowance) -> MatrixSource<'a> {
        let ((file, member), layout, role) = (split_member(&self.file), self.layout, MatrixRole::Conversion);
        MatrixSource { file, member, layout, role, triangle: None, stated_digits: None, allowance }
    }

    /// Reads it: every entry that is given, both triangles where the format says that one stands for both.
    ///
    /// # Errors
    /// The errors of the readers of matrices and dof maps.
    pub fn read(&self, allowance: &Allowance) -> Result<ReadSingle> {
        let source = self.source(allowance);
        let layout = formats::of_matrix(&source)?.layout();
        let read = read_matrix(&source)?;
        let map = self.dofs.as_deref().map(|path| dof_map_for_labels(path, allowance)).transpose()?;
        let (map, of_map) = map.unzip();
        let labels = match (&read.labels, of_map) {
            (_, Some(labels)) => labels,
            (Some(labels), None) => RowLabels::of_labels(labels),
            (None, None) => RowLabels::default(),
        };
        let mut notes = Vec::new();
        if let (Some(path), Some(map), None) = (&self.dofs, &map, &read.labels) {
            let (found, n) = (map.len(), read.input.matrix.rows());
            if found != n {
                return Err(Error::DofCount { path: path.clone(), found, n });
            }
            notes.push(InputNote::MapUnused { path: path.clone(), matrix: source.file.clone() });
        }
        let (input, _) = common_rows::take_notes(labels.placed(read)?, &mut notes);
        let mut dofs = map.or_else(|| labels.dof_map());
        if dofs.is_none() && layout == Layout::Superelement {
            dofs = superelement_file::dof_map(&source.file, allowance)?;
        }
        let dofs = dofs.filter(|dofs| dofs.len() == input.matrix.rows());
        Ok(ReadSingle { input, layout, name: source.member, dofs, labels, notes })
    }
}
