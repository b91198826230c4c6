//! Which rows of the model belong to which interface node.

use std::collections::{HashMap, HashSet};

use supel_runtime::RecoveredFaces;

use super::interface_node::{InterfaceNode, Interfaces, Resolved, Rows};
use super::node_catalogue::NodeCatalogue;
use super::{average_patch, direct_nodes, rigid_patch};
use crate::dofs::{Direction, Dof};
use crate::error::{Error, Result, Selector};
use crate::input::{Face, Faces, Patch, PatchFaces, Patches, looks_at_faces};
use crate::job::{Coupling, InterfaceJob, Job, LoadJob, NodeSelection, OutputsJob, RecoveryJob, SceneJob, Selection};
use crate::model::Model;

/// Finds the rows of every interface and checks that no row is asked for twice.
pub(super) fn resolve(model: &Model, interfaces: &[InterfaceJob]) -> Result<Interfaces> {
    let catalogue = NodeCatalogue::new(model);
    let mut resolved = Vec::new();
    for job in interfaces {
        match (&job.nodes, job.coupling) {
            (NodeSelection::Rows { rows }, Coupling::Direct) => {
                resolved.extend(from_rows(model, &catalogue, job, rows)?)
            }
            (NodeSelection::Rows { .. }, Coupling::Rigid | Coupling::Average) => {
                return Err(Error::RigidNeedsCoordinates { interface: job.name.clone() });
            }
            (_, Coupling::Direct) => {
                for label in catalogue.select(model, &job.selection())? {
                    resolved.push(direct_nodes::node(&catalogue, job, label)?);
                }
            }
            (_, Coupling::Rigid) => {
                resolved.push(rigid_patch::node(&catalogue, job, &catalogue.select(model, &job.selection())?)?)
            }
            (_, Coupling::Average) => {
                resolved.push(average_patch::node(&catalogue, job, &catalogue.select(model, &job.selection())?)?)
            }
        }
    }
    refuse_shared_rows(model, &resolved)?;
    Ok(Interfaces::all(resolved))
}

/// Rows of the model whose displacements the superelement recovers; none unless a job asks for some.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecoveredRows {
    /// The rows, node by node in the order of the selection, and which dof each of them is.
    pub rows: Vec<(usize, Dof)>,
    /// Where the nodes are, in their order; none where the model has no coordinates.
    pub positions: Option<Vec<[f64; 3]>>,
    /// Faces of the mesh all of whose nodes are among them; none where the mesh tells of none.
    pub faces: Option<RecoveredFaces>,
}

impl RecoveredRows {
    /// These rows with what the mesh tells of faces between their nodes, and a remark where it has cells but does not tell.
    pub fn with_faces(mut self, known: &[PatchFaces]) -> (Self, Option<String>) {
        let found = known.iter().find(|patch| patch.of == Selector::Recovery).map(|patch| &patch.faces);
        let remark = match found {
            Some(Faces::Unknown { reason }) => Some(format!("faces between recovered nodes are not known: {reason}")),
            _ => None,
        };
        if let (Some(Faces::Known { faces, .. }), Some(positions)) = (found, &self.positions) {
            let drawn: Vec<Vec<usize>> = faces.iter().filter_map(Face::drawn).collect();
            self.faces = RecoveredFaces::new(drawn.iter().map(Vec::as_slice), positions.len()).ok();
        }
        (self, remark)
    }
}

/// The rows of the model whose displacements a job recovers; none where the job recovers nothing.
///
/// # Errors
/// Nodes that do not exist or have no rows, a group that the mesh does not have, a selection without nodes, a model without a
/// dof map or (where the selection needs them) nodes.
pub fn recovered_rows(model: &Model, recovery: Option<&RecoveryJob>) -> Result<RecoveredRows> {
    let Some(recovery) = recovery else { return Ok(RecoveredRows::default()) };
    let (catalogue, selection) = (NodeCatalogue::new(model), recovery.selection());
    let (mut rows, nodes) = (Vec::new(), catalogue.select(model, &selection)?);
    let positions = nodes.iter().map(|node| catalogue.position(*node)).collect();
    for node in nodes {
        let of_node = catalogue.rows_of(&selection.selector, node)?.iter();
        rows.extend(of_node.map(|(direction, row)| (*row, Dof { node, direction: *direction })));
    }
    Ok(RecoveredRows { rows, positions, faces: None })
}

/// A dof inside at which a scene looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output {
    /// Its row of the model.
    pub row: usize,
    /// Its node and direction.
    pub dof: Dof,
}

/// The dofs at which a scene looks; none where it names no nodes.
///
/// # Errors
/// As [`recovered_rows`].
pub fn outputs(model: &Model, scene: Option<&SceneJob>) -> Result<Vec<Output>> {
    let outputs = scene.and_then(|scene| scene.outputs.as_ref());
    let Some(selection) = outputs.map(OutputsJob::selection) else { return Ok(Vec::new()) };
    let (catalogue, mut found) = (NodeCatalogue::new(model), Vec::new());
    for node in catalogue.select(model, &selection)? {
        let rows = catalogue.rows_of(&selection.selector, node)?.iter();
        found.extend(rows.map(|(direction, row)| Output { row: *row, dof: Dof { node, direction: *direction } }));
    }
    Ok(found)
}

/// Labels of the nodes of patches, whose coordinates count.
#[derive(Clone, Debug, Default)]
pub struct TiedNodes {
    /// Of patches that move as rigid bodies.
    pub rigid: HashSet<i64>,
    /// Of patches with a mean motion.
    pub average: HashSet<i64>,
}

impl TiedNodes {
    /// Whether a node belongs to any patch.
    pub fn contains(&self, node: i64) -> bool {
        self.rigid.contains(&node) || self.average.contains(&node)
    }
}

/// The nodes of patches. A selection that finds none is refused where it is resolved.
pub fn nodes_of_patches(model: &Model, interfaces: &[InterfaceJob]) -> TiedNodes {
    let catalogue = NodeCatalogue::new(model);
    let of = |coupling: Coupling| {
        let jobs = interfaces.iter().filter(|job| job.coupling == coupling);
        jobs.filter_map(|job| catalogue.select(model, &job.selection()).ok()).flatten().collect()
    };
    TiedNodes { rigid: of(Coupling::Rigid), average: of(Coupling::Average) }
}

/// The nodes of a job between which faces tell something: patches, those that a pressure acts on, and recovered ones. A selection that
/// finds none is refused where it is resolved.
pub fn patches<'a>(model: &'a Model, job: &Job) -> Patches<'a> {
    let Some(nodes) = &model.nodes else { return Patches::default() };
    let catalogue = NodeCatalogue::new(model);
    let indices: HashMap<i64, usize> = nodes.labels.iter().copied().zip(0..).collect();
    let patch = |selection: Selection<'_>| {
        let labels = catalogue.select(model, &selection).ok().filter(|labels| labels.len() > 1)?;
        let nodes: Vec<usize> = labels.iter().map(|label| indices.get(label).copied()).collect::<Option<_>>()?;
        Some(Patch { of: selection.selector, nodes })
    };
    let interfaces = job.interfaces.iter().filter(|job| looks_at_faces(job)).map(InterfaceJob::selection);
    let pressed = job.loads.iter().filter_map(LoadJob::pressed);
    let recovered = job.write.recovery.iter().map(RecoveryJob::selection);
    let list = interfaces.chain(pressed).chain(recovered).filter_map(patch).collect();
    Patches { list, coordinates: &nodes.coordinates }
}

/// Rows by number: interface nodes where the rows belong to nodes with coordinates, bare rows otherwise.
fn from_rows(model: &Model, catalogue: &NodeCatalogue, job: &InterfaceJob, rows: &[usize]) -> Result<Vec<Resolved>> {
    let selector = job.selection().selector;
    let rows = rows.iter().map(|row| row_of_model(model, &selector, *row)).collect::<Result<Vec<usize>>>()?;
    if let (Some(dofs), false) = (&model.dofs, !catalogue.has_positions()) {
        let mut labels: Vec<i64> = Vec::new();
        let mut directions: HashMap<i64, Vec<Direction>> = HashMap::new();
        for row in &rows {
            let Some(Dof { node, direction }) = dofs[*row] else {
                return Err(refused(model, &selector, model.rows.of(*row), "is a scalar dof, which no node has"));
            };
            directions.entry(node).or_insert_with(|| {
                labels.push(node);
                Vec::new()
            });
            directions.entry(node).or_default().push(direction);
        }
        let of_node = |label: i64| {
            let mut listed = directions.get(&label).cloned().unwrap_or_default();
            listed.sort_unstable();
            direct_nodes::node(catalogue, &InterfaceJob { dofs: Some(listed), ..job.clone() }, label)
        };
        return labels.into_iter().map(of_node).collect();
    }
    let node = InterfaceNode {
        name: job.name.clone(),
        label: None,
        position: None,
        fit: None,
        axes: None,
        directions: Vec::new(),
        coupling: Coupling::Direct,
        n_nodes: rows.len(),
    };
    Ok(vec![Resolved::new(node, Rows::Own(rows))])
}

/// The row of the model that a row of the files, both from zero, has become.
pub(super) fn row_of_model(model: &Model, selector: &Selector, row: usize) -> Result<usize> {
    let n = model.n_dofs() + model.rows.n_dropped();
    if row >= n {
        return Err(refused(model, selector, row, "does not exist"));
    }
    let dropped = "has neither stiffness nor mass and was dropped as asked";
    model.rows.find(row).ok_or_else(|| refused(model, selector, row, dropped))
}

/// The error of a row of the files that cannot be taken.
fn refused(model: &Model, selector: &Selector, row: usize, found: &'static str) -> Error {
    Error::InterfaceRow { selector: selector.clone(), row, found, n: model.n_dofs() + model.rows.n_dropped() }
}

fn refuse_shared_rows(model: &Model, resolved: &[Resolved]) -> Result<()> {
    let mut owner: HashMap<usize, &str> = HashMap::new();
    for Resolved { node, rows, .. } in resolved {
        for row in rows.all() {
            if let Some(first) = owner.insert(*row, &node.name) {
                let in_files = || format!("row {} (from zero)", model.rows.of(*row));
                let dof = model.dofs.as_ref().and_then(|dofs| dofs[*row]).map_or_else(in_files, |dof| dof.to_string());
                return Err(Error::DofTwice { dof, first: first.to_owned(), second: node.name.clone() });
            }
        }
    }
    Ok(())
}
