//! The rows and the position of each node of a model, and the nodes that a job selects.

use std::collections::{BTreeMap, HashMap};

use super::region::contains;
use crate::dofs::{Direction, Dof};
use crate::error::{Error, Result, Selector};
use crate::job::{NodeSelection, Selection};
use crate::model::Model;

/// The rows and the position of each node of the model.
pub(super) struct NodeCatalogue {
    rows: HashMap<i64, BTreeMap<Direction, usize>>,
    positions: HashMap<i64, [f64; 3]>,
}

impl NodeCatalogue {
    pub(super) fn new(model: &Model) -> Self {
        let mut rows: HashMap<i64, BTreeMap<Direction, usize>> = HashMap::new();
        for (row, dof) in model.dofs.iter().flatten().enumerate() {
            let Some(Dof { node, direction }) = dof else { continue };
            rows.entry(*node).or_default().insert(*direction, row);
        }
        // A mesh may have any number of nodes; those without rows are refused before their place is looked up.
        let places =
            model.nodes.iter().flat_map(|nodes| nodes.labels.iter().copied().zip(nodes.coordinates.iter().copied()));
        let positions = places.filter(|(label, _)| rows.contains_key(label)).collect();
        Self { rows, positions }
    }

    /// The labels a job's selection names, in its own order for a list and in table order otherwise.
    pub(super) fn select(&self, model: &Model, selection: &Selection<'_>) -> Result<Vec<i64>> {
        let selector = || selection.selector.clone();
        let nodes = || model.nodes.as_ref().ok_or_else(|| Error::SelectionNeedsNodes { selector: selector() });
        let labels: Vec<i64> = match selection.nodes {
            NodeSelection::Labels(labels) => labels.clone(),
            NodeSelection::Group(text) => {
                let nodes = nodes()?;
                let name = text.strip_prefix("group:").unwrap_or(text);
                let members = nodes.groups.get(name).ok_or_else(|| Error::UnknownGroup {
                    selector: selector(),
                    group: name.to_owned(),
                    known: nodes.groups.keys().cloned().collect(),
                })?;
                members.iter().map(|index| nodes.labels[*index]).collect()
            }
            NodeSelection::Region { within } => {
                let nodes = nodes()?;
                let all = nodes.labels.iter().zip(&nodes.coordinates);
                all.filter(|(label, point)| contains(within, **point) && self.rows.contains_key(label))
                    .map(|(label, _)| *label)
                    .collect()
            }
            NodeSelection::Rows { .. } => Vec::new(),
        };
        if labels.is_empty() { Err(Error::EmptyInterface { selector: selector() }) } else { Ok(labels) }
    }

    /// The rows of a node by direction.
    pub(super) fn rows_of(&self, selector: &Selector, label: i64) -> Result<&BTreeMap<Direction, usize>> {
        if self.rows.is_empty() {
            return Err(Error::SelectionNeedsNodes { selector: selector.clone() });
        }
        self.rows.get(&label).ok_or_else(|| Error::InterfaceNodeWithoutRows { selector: selector.clone(), node: label })
    }

    /// The dofs of a node that a selection names, in the order of the six directions, and their rows.
    pub(super) fn dofs_of(&self, selection: &Selection<'_>, label: i64) -> Result<Vec<(Direction, usize)>> {
        let of_node = self.rows_of(&selection.selector, label)?;
        let Some(directions) = selection.directions else {
            return Ok(of_node.iter().map(|(direction, row)| (*direction, *row)).collect());
        };
        let mut directions = directions.to_vec();
        directions.sort_unstable();
        let with_row = |direction: Direction| match of_node.get(&direction) {
            Some(row) => Ok((direction, *row)),
            None => {
                let dof = Dof { node: label, direction };
                Err(Error::DofMissing { selector: selection.selector.clone(), dof })
            }
        };
        directions.into_iter().map(with_row).collect()
    }

    /// The position of a node.
    pub(super) fn position(&self, label: i64) -> Option<[f64; 3]> {
        self.positions.get(&label).copied()
    }

    /// Whether the positions of nodes are known.
    pub(super) fn has_positions(&self) -> bool {
        !self.positions.is_empty()
    }
}
