//! How an examination goes on after a stage has refused a model.

use std::path::Path;

use crate::error::{Error, ErrorClass};
use crate::job::{Job, NodeSelection};
use crate::sparse::Triangle;

/// A job that a stage may accept after it has refused another one.
#[derive(Clone, Debug)]
pub struct Retreat {
    /// The job.
    pub job: Job,
    /// What is different, in words.
    pub how: String,
}

/// Whether an error speaks of the model, and not of the machine or of the command line.
pub fn is_of_model(error: &Error) -> bool {
    error.class() == ErrorClass::InputData || error.class().is_of_matrices()
}

/// What to try after an error; none where nothing is left to be tried, or the error does not speak of the model.
pub(super) fn retreat(job: &Job, error: &Error) -> Option<Retreat> {
    if !is_of_model(error) {
        return None;
    }
    let mut next = job.clone();
    let model = &mut next.model;
    let how = match error {
        Error::Swapped { .. } => {
            std::mem::swap(&mut model.stiffness, model.mass.as_mut()?);
            "with the two files exchanged"
        }
        Error::EmptyRows { .. } if !model.drop_empty => {
            model.drop_empty = true;
            "without the empty rows"
        }
        // Where each triangle lacks entries of the other, neither of them is the matrix.
        Error::Unsymmetric { unpaired, .. } if !unpaired.contains(&0) => return None,
        Error::Unsymmetric { unpaired: [0, above], .. } if *above > 0 && model.symmetric.is_none() => {
            model.symmetric = Some(Triangle::Upper);
            "with the upper triangle for both"
        }
        Error::Unsymmetric { .. } if model.symmetric.is_none() => {
            model.symmetric = Some(Triangle::Lower);
            "with the lower triangle for both"
        }
        Error::SameMatrix { .. } | Error::SizeMismatch { .. } => return None,
        // Rows turned by axes of few digits fit no coordinates, and not turned at all they fit them less.
        Error::FrameDigits { .. } if model.dofs.is_some() && model.nodes.take().is_some() => "without the nodes",
        // Whatever is wrong with nodes, map or constraints: matrices alone may be sound.
        _ if is_of_frames(error, model.frames.as_deref()) && model.frames.take().is_some() => {
            "without the axes of nodes"
        }
        _ if model.constraints.take().is_some() => "without the constraints",
        // The matrix names its rows.
        Error::RowUnknown { .. } if model.dofs.take().is_some() => "without the dof map",
        // Nothing else says which rows are those of a node.
        _ if is_of_map(error, model.dofs.as_deref()) && model.dofs.take().is_some() => match model.nodes.take() {
            Some(_) => "without the dof map, and so without the nodes",
            None => "without the dof map",
        },
        _ if model.nodes.take().is_some() => "without the nodes",
        _ if model.dofs.take().is_some() => "without the dof map",
        _ => return None,
    };
    let how = with_what_needs_labels(&mut next, how);
    Some(Retreat { job: next, how })
}

/// Leaves out what names nodes where nothing says any longer which rows these have, and says so.
fn with_what_needs_labels(next: &mut Job, how: &str) -> String {
    let mut left_out = vec![how.to_owned()];
    if next.model.dofs.is_none() && next.model.nodes.is_none() {
        left_out.extend(next.model.frames.take().map(|_| "without the axes of nodes".to_owned()));
        let n_fixed = next.fixed.len();
        next.fixed.retain(|fixed| matches!(fixed.nodes, NodeSelection::Rows { .. }));
        left_out.extend((next.fixed.len() < n_fixed).then(|| "with nothing held at nodes".to_owned()));
    }
    left_out.join(", ")
}

/// Whether an error speaks of the table of axes, which is at `table`.
fn is_of_frames(error: &Error, table: Option<&Path>) -> bool {
    match error {
        Error::TableColumn { path, .. } | Error::TableRow { path, .. } | Error::TableField { path, .. } => {
            Some(path.as_path()) == table
        }
        Error::NodeRepeated { path, .. } | Error::NoData { path, .. } => Some(path.as_path()) == table,
        _ => error.code().starts_with("E-FRAME"),
    }
}

/// Whether an error speaks of the dof map, which is at `map`.
fn is_of_map(error: &Error, map: Option<&Path>) -> bool {
    match error {
        Error::DofCount { .. } | Error::DofNodeMissing { .. } => true,
        Error::TableColumn { path, .. }
        | Error::TableRow { path, .. }
        | Error::TableField { path, .. }
        | Error::MatrixFormat { path, .. }
        | Error::PackedDamaged { path, .. } => Some(path.as_path()) == map,
        _ => error.code().starts_with("E-MAP"),
    }
}
