//! Which rows of the model belong to which interface node.

use std::collections::{BTreeMap, HashMap};

use super::region::contains;
use crate::dofs::{Direction, Dof};
use crate::error::{Error, Result};
use crate::input::{Patch, Patches, has_mean_origin};
use crate::job::{Coupling, InterfaceJob, NodeSelection, Origin, RecoveryJob};
use crate::model::Model;

/// One node of the superelement's interface.
#[derive(Clone, Debug, PartialEq)]
pub struct InterfaceNode {
    /// Name of the job's interface it came from.
    pub name: String,
    /// Label of the model's node; none for a rigid patch and for rows without a dof map.
    pub label: Option<i64>,
    /// Position, where coordinates are known.
    pub position: Option<[f64; 3]>,
    /// Its directions, in the order of the interface dofs; empty where the model has no dof map.
    pub directions: Vec<Direction>,
    /// How it couples to the model.
    pub coupling: Coupling,
    /// Nodes of the model it stands for.
    pub n_nodes: usize,
}

/// An interface node with the rows it owns.
#[derive(Clone, Debug)]
pub(super) struct Resolved {
    pub(super) node: InterfaceNode,
    pub(super) rows: Rows,
}

/// The rows of the model that an interface node stands for.
#[derive(Clone, Debug)]
pub(super) enum Rows {
    /// The node's own rows, one for each interface dof.
    Own(Vec<usize>),
    /// All rows of a patch that moves with the node as a rigid body.
    Patch(Vec<usize>),
}

/// All interfaces of a job, resolved.
#[derive(Clone, Debug, Default)]
pub(super) struct Interfaces(pub(super) Vec<Resolved>);

impl Interfaces {
    pub(super) fn into_nodes(self) -> Vec<InterfaceNode> {
        self.0.into_iter().map(|resolved| resolved.node).collect()
    }
}

/// Finds the rows of every interface and checks that no row is asked for twice.
pub(super) fn resolve(model: &Model, interfaces: &[InterfaceJob]) -> Result<Interfaces> {
    let catalogue = Catalogue::new(model);
    let mut resolved = Vec::new();
    for job in interfaces {
        match (&job.nodes, job.coupling) {
            (NodeSelection::Rows { rows }, Coupling::Direct) => {
                resolved.extend(from_rows(model, &catalogue, job, rows)?)
            }
            (NodeSelection::Rows { .. }, Coupling::Rigid) => {
                return Err(Error::RigidNeedsCoordinates { interface: job.name.clone() });
            }
            (_, Coupling::Direct) => {
                for label in catalogue.select(model, job)? {
                    resolved.push(catalogue.direct(job, label)?);
                }
            }
            (_, Coupling::Rigid) => resolved.push(catalogue.patch(job, &catalogue.select(model, job)?)?),
        }
    }
    refuse_shared_rows(model, &resolved)?;
    Ok(Interfaces(resolved))
}

/// The rows of the model whose displacements a job recovers, node by node in the order of the selection, and which dof each of
/// them is; none where the job recovers nothing.
///
/// # Errors
/// Nodes that do not exist or have no rows, a group that the mesh does not have, a selection without nodes, a model without a
/// dof map or (where the selection needs them) nodes.
pub fn recovered_rows(model: &Model, recovery: Option<&RecoveryJob>) -> Result<Vec<(usize, Dof)>> {
    let Some(recovery) = recovery else { return Ok(Vec::new()) };
    let (catalogue, job) = (Catalogue::new(model), recovery.selection());
    let mut rows = Vec::new();
    for node in catalogue.select(model, &job)? {
        let of_node = catalogue.rows_of(&job, node)?.iter();
        rows.extend(of_node.map(|(direction, row)| (*row, Dof { node, direction: *direction })));
    }
    Ok(rows)
}

/// The patches of several nodes whose origin is the mean of these. A selection that finds none is refused where it is resolved.
pub fn patches(model: &Model, interfaces: &[InterfaceJob]) -> Patches {
    let Some(nodes) = &model.nodes else { return Patches::default() };
    let catalogue = Catalogue::new(model);
    let indices: HashMap<i64, usize> = nodes.labels.iter().copied().zip(0..).collect();
    let patch = |job: &InterfaceJob| {
        let labels = catalogue.select(model, job).ok().filter(|labels| labels.len() > 1)?;
        let nodes_of: Vec<usize> = labels.iter().map(|label| indices.get(label).copied()).collect::<Option<_>>()?;
        let positions = nodes_of.iter().map(|node| nodes.coordinates[*node]).collect();
        Some(Patch { interface: job.name.clone(), nodes: nodes_of, positions })
    };
    let list = interfaces.iter().filter(|job| has_mean_origin(job)).filter_map(patch).collect();
    Patches { list, n_nodes: nodes.labels.len() }
}

/// Rows by number: interface nodes where the rows belong to nodes with coordinates, bare rows otherwise.
fn from_rows(model: &Model, catalogue: &Catalogue, job: &InterfaceJob, rows: &[usize]) -> Result<Vec<Resolved>> {
    let rows = rows.iter().map(|row| row_of_model(model, job, *row)).collect::<Result<Vec<usize>>>()?;
    if let (Some(dofs), false) = (&model.dofs, catalogue.positions.is_empty()) {
        let mut labels: Vec<i64> = Vec::new();
        let mut directions: HashMap<i64, Vec<Direction>> = HashMap::new();
        for row in &rows {
            let Dof { node, direction } = dofs[*row];
            directions.entry(node).or_insert_with(|| {
                labels.push(node);
                Vec::new()
            });
            directions.entry(node).or_default().push(direction);
        }
        let of_node = |label: i64| {
            let mut listed = directions.get(&label).cloned().unwrap_or_default();
            listed.sort_unstable();
            catalogue.direct(&InterfaceJob { dofs: Some(listed), ..job.clone() }, label)
        };
        return labels.into_iter().map(of_node).collect();
    }
    let node = InterfaceNode {
        name: job.name.clone(),
        label: None,
        position: None,
        directions: Vec::new(),
        coupling: Coupling::Direct,
        n_nodes: rows.len(),
    };
    Ok(vec![Resolved { node, rows: Rows::Own(rows) }])
}

/// The row of the model that a row of the files, both from zero, has become.
fn row_of_model(model: &Model, job: &InterfaceJob, row: usize) -> Result<usize> {
    let n = model.n_dofs() + model.rows.n_dropped();
    let wrong = |found| Error::InterfaceRow { interface: job.name.clone(), row, found, n };
    if row >= n {
        return Err(wrong("does not exist"));
    }
    model.rows.find(row).ok_or_else(|| wrong("has neither stiffness nor mass and was dropped as asked"))
}

/// The rows and the position of each node of the model.
struct Catalogue {
    rows: HashMap<i64, BTreeMap<Direction, usize>>,
    positions: HashMap<i64, [f64; 3]>,
}

impl Catalogue {
    fn new(model: &Model) -> Self {
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
    fn select(&self, model: &Model, job: &InterfaceJob) -> Result<Vec<i64>> {
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

    fn rows_of(&self, job: &InterfaceJob, label: i64) -> Result<&BTreeMap<Direction, usize>> {
        if self.rows.is_empty() {
            return Err(Error::SelectionNeedsNodes { interface: job.name.clone() });
        }
        self.rows
            .get(&label)
            .ok_or_else(|| Error::InterfaceNodeWithoutRows { interface: job.name.clone(), node: label })
    }

    fn direct(&self, job: &InterfaceJob, label: i64) -> Result<Resolved> {
        let of_node = self.rows_of(job, label)?;
        let mut directions = job.dofs.clone().unwrap_or_else(|| of_node.keys().copied().collect());
        directions.sort_unstable();
        let rows = directions
            .iter()
            .map(|direction| {
                of_node.get(direction).copied().ok_or_else(|| Error::DofMissing {
                    interface: job.name.clone(),
                    dof: Dof { node: label, direction: *direction },
                })
            })
            .collect::<Result<_>>()?;
        let node = InterfaceNode {
            name: job.name.clone(),
            label: Some(label),
            position: self.positions.get(&label).copied(),
            directions,
            coupling: Coupling::Direct,
            n_nodes: 1,
        };
        Ok(Resolved { node, rows: Rows::Own(rows) })
    }

    fn patch(&self, job: &InterfaceJob, labels: &[i64]) -> Result<Resolved> {
        let mut rows = Vec::new();
        let mut centroid = [0.0; 3];
        for label in labels {
            rows.extend(self.rows_of(job, *label)?.values());
            let point = self
                .positions
                .get(label)
                .ok_or_else(|| Error::RigidNeedsCoordinates { interface: job.name.clone() })?;
            for axis in 0..3 {
                centroid[axis] += point[axis] / labels.len() as f64;
            }
        }
        let position = match job.origin {
            Origin::Centroid => centroid,
            Origin::Point(point) => point,
        };
        let mut directions = job.dofs.clone().unwrap_or_else(|| Direction::ALL.to_vec());
        directions.sort_unstable();
        let node = InterfaceNode {
            name: job.name.clone(),
            label: None,
            position: Some(position),
            directions,
            coupling: Coupling::Rigid,
            n_nodes: labels.len(),
        };
        Ok(Resolved { node, rows: Rows::Patch(rows) })
    }
}

fn refuse_shared_rows(model: &Model, resolved: &[Resolved]) -> Result<()> {
    let mut owner: HashMap<usize, &str> = HashMap::new();
    for Resolved { node, rows } in resolved {
        let (Rows::Own(rows) | Rows::Patch(rows)) = rows;
        for row in rows {
            if let Some(first) = owner.insert(*row, &node.name) {
                let in_files = || format!("row {} (from zero)", model.rows.of(*row));
                let dof = model.dofs.as_ref().map_or_else(in_files, |dofs| dofs[*row].to_string());
                return Err(Error::DofTwice { dof, first: first.to_owned(), second: node.name.clone() });
            }
        }
    }
    Ok(())
}
