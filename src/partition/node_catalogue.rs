//! The rows and the position of each node of a model, and the nodes that a job selects.

use std::collections::{BTreeMap, HashMap};

use super::region::contains;
use crate::dofs::{Direction, Dof};
use crate::error::{Error, Result};
use crate::job::{InterfaceJob, NodeSelection};
use crate::model::Model;

/// The rows and the position of each node of the model.
pub(super) struct NodeCatalogue {
    rows: HashMap<i64, BTreeMap<Direction, usize>>,
    positions: HashMap<i64, [f64; 3]>,
}

impl NodeCatalogue {
    pub(super) fn new(model: &Model) -> Self {
        let mut rows: HashMap<i64, BTreeMap<Direction, usize>> = HashMap::new();
        for (row, Dof { node, direction }) in model.dofs.iter().flatten().enumerate() {
            rows.entry(*node).or_default().insert(*direction, row);
        }
        // A mesh may have any number of nodes; those without rows are refused before their place is looked up.
        let places =
            model.nodes.iter().flat_map(|nodes| nodes.labels.iter().copied().zip(nodes.coordinates.iter().copied()));
        let positions = places.filter(|(label, _)| rows.contains_key(label)).collect();
        Self { rows, positions }
    }

    /// The labels a job's selection names, in its own order for a list and in table order otherwise.
    pub(super) fn select(&self, model: &Model, job: &InterfaceJob) -> Result<Vec<i64>> {
        let interface = || job.name.clone();
        let nodes = || model.nodes.as_ref().ok_or_else(|| Error::SelectionNeedsNodes { interface: interface() });
        let labels: Vec<i64> = match &job.nodes {
            NodeSelection::Labels(labels) => labels.clone(),
            NodeSelection::Group(text) => {
                let nodes = nodes()?;
                let name = text.strip_prefix("group:").unwrap_or(text);
                let members = nodes.groups.get(name).ok_or_else(|| Error::UnknownGroup {
                    interface: interface(),
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
        if labels.is_empty() { Err(Error::EmptyInterface { interface: interface() }) } else { Ok(labels) }
    }

    /// The rows of a node by direction.
    pub(super) fn rows_of(&self, job: &InterfaceJob, label: i64) -> Result<&BTreeMap<Direction, usize>> {
        if self.rows.is_empty() {
            return Err(Error::SelectionNeedsNodes { interface: job.name.clone() });
        }
        self.rows
            .get(&label)
            .ok_or_else(|| Error::InterfaceNodeWithoutRows { interface: job.name.clone(), node: label })
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
