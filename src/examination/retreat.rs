//! How an examination goes on after a stage has refused a model.

use std::path::Path;

use crate::error::{Error, ErrorClass};
use crate::job::Job;
use crate::sparse::Triangle;

/// A job that a stage may accept after it has refused another one.
#[derive(Clone, Debug)]
pub struct Retreat {
    /// The job.
    pub job: Job,
    /// What is different, in words.
    pub how: &'static str,
}

/// Whether an error speaks of the model, and not of the machine or of the command line.
pub fn is_of_model(error: &Error) -> bool {
    matches!(error.class(), ErrorClass::InputData | ErrorClass::ModelPhysics | ErrorClass::NumericalLimit)
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
        // Whatever is wrong with nodes, map or constraints: matrices alone may be sound.
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
    // Held dofs are named by nodes, which rows alone do not have.
    let has_labels = next.model.dofs.is_some() || next.model.nodes.is_some();
    if !has_labels {
        next.model.frames = None;
        next.fixed.retain(|fixed| matches!(fixed.nodes, crate::job::NodeSelection::Rows { .. }));
    }
    Some(Retreat { job: next, how })
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
