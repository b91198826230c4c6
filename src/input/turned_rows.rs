//! Rows of nodes that have axes of their own, turned to the axes of the model when they are read.

use std::collections::BTreeMap;

use super::allowance::Allowance;
use super::constraint_file::ConstraintRows;
use super::deck_axes::together;
use super::map_and_nodes::{Digests, SaidFrames};
use super::node_frames::{NodeFrames, node_frames};
use super::{FurtherMatrix, InputNote, LoadColumn, MatrixInput, ModeColumns, QuantityRows};
use crate::dofs::{DofMap, RoundedAxes};
use crate::error::{Error, Result};
use crate::job::{Layout, ModelJob};
use crate::regular_file::{digest, unchanged};
use crate::sparse::{Turned, Turning};

/// Which rows of a model are along axes of their own: those of the file of the job, otherwise those that map or deck say. With them those
/// axes that look rounded.
///
/// # Errors
/// What reading the file refuses; [`Error::FrameRows`]; [`Error::FrameNodes`]; [`Error::DeckUnsupported`] for a deck with parts.
pub(super) fn turning(
    model: &ModelJob,
    (dofs, layouts): (Option<&DofMap>, [Option<Layout>; 2]),
    said: SaidFrames,
    allowance: &Allowance,
    (digests, notes): (&mut Digests, &mut Vec<InputNote>),
) -> Result<Option<(Turning, Option<RoundedAxes>)>> {
    let frames = match &model.frames {
        Some(path) => {
            let (frames, of_frames) = unchanged(path, || Ok((node_frames(path, allowance)?, digest(path)?)))?;
            digests.insert("frames", of_frames);
            notes.extend(said.by_decks.into_iter().flatten().flatten().find_map(|deck| other_axes(&frames, &deck)));
            Some(frames)
        }
        None => said_frames(layouts, said, notes)?,
    };
    let Some(frames) = frames else { return Ok(None) };
    let turned = dofs.map(|dofs| frames.turning(dofs)).transpose()?;
    if let Some((turning, n_nodes)) = turned.filter(|(_, n_nodes)| *n_nodes > 0) {
        let rounded = frames.rounded();
        if model.nodes.is_none() {
            notes.push(InputNote::TurnedUntested { path: frames.place.0.clone() });
        }
        notes.push(InputNote::Turned { path: frames.place.0, n_nodes });
        return Ok(Some((turning, rounded)));
    }
    // A deck may have nodes without rows; a table of none of the model is that of another one.
    match &model.frames {
        Some(path) => {
            let found = if dofs.is_some() { "none has rows" } else { "none is known without a dof map" };
            Err(Error::FrameNodes { path: path.clone(), n_nodes: frames.axes.len(), found })
        }
        None => Ok(None),
    }
}

/// The remark that a deck states other axes of a node than the table of the job, which holds.
fn other_axes(table: &NodeFrames, deck: &NodeFrames) -> Option<InputNote> {
    let node = table.differing(deck)?;
    Some(InputNote::OtherAxes { path: table.place.0.clone(), deck: deck.place.0.clone(), node })
}

/// The axes that map or deck say rows to be along.
///
/// Abaqus writes rows along the axes of `*TRANSFORM`, CalculiX along those of the model; labelled matrices are of Abaqus. Where nothing
/// tells which program it was, a note says so.
fn said_frames(
    layouts: [Option<Layout>; 2],
    said: SaidFrames,
    notes: &mut Vec<InputNote>,
) -> Result<Option<NodeFrames>> {
    let decks: Vec<Option<NodeFrames>> = said.by_decks.into_iter().collect::<Result<_>>()?;
    let by_decks = together(decks.into_iter().flatten().collect())?.filter(|frames| !frames.axes.is_empty());
    match (by_decks, said.by_nodes) {
        (Some(frames), _) => Ok(Some(frames)),
        (None, Some(frames)) if layouts.contains(&Some(Layout::AbaqusLabels)) => {
            if frames.axes.is_empty() {
                let ((path, line), found) = (frames.place, "*TRANSFORM in a deck with parts".to_owned());
                let advice = "give the axes of the nodes with `model.frames`";
                return Err(Error::DeckUnsupported { path, line, found, advice });
            }
            Ok(Some(frames))
        }
        (None, frames) => {
            notes.extend(frames.map(|NodeFrames { place: (path, line), .. }| InputNote::Transformed { path, line }));
            Ok(None)
        }
    }
}

/// What has rows of the model.
pub(super) trait Turn {
    /// What it is along the axes of the model.
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
        let mut of_quantity: BTreeMap<u32, Vec<(u32, f64)>> = BTreeMap::new();
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
