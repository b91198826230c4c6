//! Rows of nodes that have axes of their own, turned to the axes of the model when they are read.

use super::allowance::Allowance;
use super::constraint_file::ConstraintRows;
use super::map_and_nodes::{Digests, SaidFrames};
use super::node_frames::{NodeFrames, node_frames};
use super::{FurtherMatrix, InputNote, LoadColumn, MatrixInput, ModeColumns, QuantityRows};
use crate::dofs::DofMap;
use crate::error::{Error, Result};
use crate::job::{Layout, ModelJob};
use crate::regular_file::{digest, unchanged};
use crate::sparse::{Turned, Turning};

/// Which rows of a model are along axes of their own: those of the file of the job, otherwise those that map or deck say.
///
/// Abaqus writes rows along the axes of `*TRANSFORM`, CalculiX along those of the model; labelled matrices are of Abaqus. Where nothing
/// tells which program it was, a note says so.
///
/// # Errors
/// Those of reading the file; [`Error::FrameRows`]; [`Error::FrameNodes`]; [`Error::DeckUnsupported`] for a deck with parts.
pub(super) fn turning(
    model: &ModelJob,
    (dofs, layout): (Option<&DofMap>, Option<Layout>),
    said: SaidFrames,
    allowance: &Allowance,
    (digests, notes): (&mut Digests, &mut Vec<InputNote>),
) -> Result<Option<Turning>> {
    let Some(path) = &model.frames else {
        let frames = match (said.by_map?, said.by_nodes) {
            (Some(frames), _) => frames,
            (None, Some(frames)) if layout == Some(Layout::AbaqusLabels) => frames,
            (None, Some(NodeFrames { place: (path, line), .. })) => {
                notes.push(InputNote::Transformed { path, line });
                return Ok(None);
            }
            (None, None) => return Ok(None),
        };
        if frames.axes.is_empty() {
            let ((path, line), found) = (frames.place, "*TRANSFORM in a deck with parts".to_owned());
            let advice = "give the axes of the nodes with `model.frames`";
            return Err(Error::DeckUnsupported { path, line, found, advice });
        }
        let turned = dofs.map(|dofs| frames.turning(dofs)).transpose()?.filter(|(_, n_nodes)| *n_nodes > 0);
        return Ok(turned.map(|(turning, n_nodes)| {
            notes.push(InputNote::Turned { path: frames.place.0, n_nodes });
            turning
        }));
    };
    let (frames, of_frames) = unchanged(path, || Ok((node_frames(path, allowance)?, digest(path)?)))?;
    digests.insert("frames", of_frames);
    let n_nodes = frames.axes.len();
    let none = |found| Error::FrameNodes { path: path.clone(), n_nodes, found };
    let dofs = dofs.ok_or_else(|| none("none is known without a dof map"))?;
    let (turning, n_nodes) = frames.turning(dofs)?;
    if n_nodes == 0 {
        return Err(none("none has rows"));
    }
    notes.push(InputNote::Turned { path: path.clone(), n_nodes });
    Ok(Some(turning))
}

/// What has rows of the model.
pub(super) trait Turn {
    /// The same along the axes of the model.
    #[must_use]
    fn turned(self, turning: &Turning) -> Self;
}

impl Turn for MatrixInput {
    fn turned(mut self, turning: &Turning) -> Self {
        let Turned { matrix, roundings } = turning.turned(&self.matrix);
        (self.matrix, self.notes.turned) = (matrix, Some(roundings));
        self
    }
}

impl Turn for FurtherMatrix {
    fn turned(self, turning: &Turning) -> Self {
        Self { input: self.input.turned(turning), ..self }
    }
}

impl Turn for ConstraintRows {
    fn turned(mut self, turning: &Turning) -> Self {
        self.list.iter_mut().for_each(|row| row.terms = turning.turned_terms(&row.terms));
        self
    }
}

impl Turn for LoadColumn {
    fn turned(mut self, turning: &Turning) -> Self {
        turning.turn(&mut self.values);
        self
    }
}

impl Turn for ModeColumns {
    fn turned(mut self, turning: &Turning) -> Self {
        self.columns.iter_mut().for_each(|column| turning.turn(column));
        self
    }
}

impl Turn for QuantityRows {
    fn turned(mut self, turning: &Turning) -> Self {
        let mut of_quantity: std::collections::BTreeMap<u32, Vec<(u32, f64)>> = std::collections::BTreeMap::new();
        self.entries
            .iter()
            .for_each(|(quantity, row, value)| of_quantity.entry(*quantity).or_default().push((*row, *value)));
        let turned = of_quantity.into_iter().map(|(quantity, terms)| (quantity, turning.turned_terms(&terms)));
        self.entries = turned
            .flat_map(|(quantity, terms)| terms.into_iter().map(move |(row, value)| (quantity, row, value)))
            .collect();
        self
    }
}

/// What is turned where rows are.
pub(super) fn turned<T: Turn>(rows: T, turning: Option<&Turning>) -> T {
    match turning {
        Some(turning) => rows.turned(turning),
        None => rows,
    }
}
