//! Degrees of freedom that the job holds at rest: their rows of T are empty, so that TᵀKT and TᵀMT are without them.

use std::collections::{BTreeMap, HashSet};

use serde::Serialize;

use super::interface::row_of_model;
use super::interface_node::{Interfaces, Resolved};
use super::node_catalogue::NodeCatalogue;
use crate::error::{Error, Result, Selector};
use crate::job::{FixedJob, NodeSelection};
use crate::model::{Model, Site};

/// The dofs that a job holds.
#[derive(Clone, Debug, Default)]
pub struct Held {
    /// Rows of the model with the number of the first selection that holds each.
    rows: BTreeMap<usize, usize>,
    /// What holds them, in the order of the job.
    pub selections: Vec<HeldSelection>,
    /// Where they are, where coordinates are known.
    sites: Vec<Site>,
    /// Dofs of nodes of patches that are at rest, which are no rows of the model.
    n_of_patches: usize,
}

/// Interface dofs that the scene says are at rest.
pub(super) struct Ground {
    /// Nodes that they belong to; none for rows.
    pub(super) n_nodes: Option<usize>,
    /// Those that are rows of the model.
    pub(super) rows: Vec<usize>,
    /// Those of the node of a patch.
    pub(super) sites: Vec<Site>,
}

/// One selection of held dofs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct HeldSelection {
    /// Its name, or its place in the job.
    pub name: String,
    /// Nodes that it names; none for rows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub n_nodes: Option<usize>,
    /// Dofs that it holds, whether others hold them as well or not.
    pub n_dofs: usize,
}

/// Displacement by a unit rotation, relative to the size of the component, below which it is rounding.
const NO_LEVER: f64 = 1e-9;

impl Held {
    /// Rows that are held for a look at the model without them.
    pub(crate) fn of_rows(rows: Vec<usize>) -> Self {
        Self { rows: rows.into_iter().map(|row| (row, 0)).collect(), ..Self::default() }
    }

    /// Dofs that are held, each counted once.
    pub fn count(&self) -> usize {
        self.rows.len() + self.n_of_patches
    }

    /// Holds dofs of an interface as well.
    pub(super) fn ground(&mut self, model: &Model, interface: &str, ground: Ground) {
        let Ground { n_nodes, rows, sites } = ground;
        let n_dofs = rows.len() + sites.len();
        let name = format!("{interface}, by the scene");
        match self.selections.last_mut().filter(|last| last.name == name) {
            Some(last) => {
                last.n_dofs += n_dofs;
                last.n_nodes = last.n_nodes.zip(n_nodes).map(|(a, b)| a + b);
            }
            None => self.selections.push(HeldSelection { name, n_nodes, n_dofs }),
        }
        let of_rows = model.sites().unwrap_or_default();
        self.sites.extend(rows.iter().filter_map(|row| of_rows.get(*row).copied().flatten()));
        self.n_of_patches += sites.len();
        self.sites.extend(sites);
        self.rows.extend(rows.into_iter().map(|row| (row, self.selections.len() - 1)));
    }

    /// Whether a row of the model is held.
    pub fn holds(&self, row: usize) -> bool {
        self.rows.contains_key(&row)
    }

    /// Where held dofs are, node by node as often as they have some; nothing where coordinates are unknown.
    pub fn positions(&self) -> impl Iterator<Item = [f64; 3]> {
        self.sites.iter().map(|site| site.position)
    }

    /// Which of the six unit motions, rotations about a centre of a component of some size, move a held dof; none where
    /// coordinates are unknown.
    pub fn moved_by(&self, centre: [f64; 3], size: f64) -> [bool; 6] {
        let is_moved = |site: &Site, motion: usize| {
            let is_lever = motion >= 3 && !site.direction.is_rotation();
            site.rigid_motion_about(centre)[motion].abs() > NO_LEVER * if is_lever { size } else { 1.0 }
        };
        std::array::from_fn(|motion| self.sites.iter().any(|site| is_moved(site, motion)))
    }

    /// Refuses interfaces that move a held dof.
    pub(super) fn refuse_interface(&self, model: &Model, interfaces: &Interfaces) -> Result<()> {
        for Resolved { node, rows, .. } in &interfaces.list {
            if let Some((row, selection)) = rows.all().iter().find_map(|row| Some((*row, *self.rows.get(row)?))) {
                let fixed = Selector::Fixed(self.selections[selection].name.clone());
                return Err(Error::FixedInterface {
                    dof: model.names().short(row),
                    fixed,
                    interface: node.name.clone(),
                });
            }
        }
        Ok(())
    }
}

/// Finds the dofs that a job holds. One that several selections name is held once.
///
/// # Errors
/// Nodes or rows that do not exist, a direction that a node lacks, a selection without nodes; nothing left to move.
pub fn held(model: &Model, fixed: &[FixedJob]) -> Result<Held> {
    let mut held = Held::default();
    if fixed.is_empty() {
        return Ok(held);
    }
    let catalogue = NodeCatalogue::new(model);
    for (index, job) in fixed.iter().enumerate() {
        let (rows, n_nodes) = selected(model, &catalogue, (index, job))?;
        held.selections.push(HeldSelection { name: job.title(index), n_nodes, n_dofs: rows.len() });
        rows.into_iter().for_each(|row| {
            held.rows.entry(row).or_insert(index);
        });
    }
    refuse_all(model, &held)?;
    if let Some(sites) = model.sites() {
        held.sites = held.rows.keys().filter_map(|row| sites[*row]).collect();
    }
    Ok(held)
}

/// The rows that one selection names, and of how many nodes.
fn selected(
    model: &Model,
    catalogue: &NodeCatalogue,
    (index, job): (usize, &FixedJob),
) -> Result<(Vec<usize>, Option<usize>)> {
    let selection = job.selection(index);
    if let NodeSelection::Rows { rows } = selection.nodes {
        let rows = rows.iter().map(|row| row_of_model(model, &selection.selector, *row)).collect::<Result<_>>()?;
        return Ok((rows, None));
    }
    let labels = catalogue.select(model, &selection)?;
    let mut rows = Vec::new();
    for label in &labels {
        rows.extend(catalogue.dofs_of(&selection, *label)?.into_iter().map(|(_, row)| row));
    }
    Ok((rows, Some(labels.iter().collect::<HashSet<_>>().len())))
}

fn refuse_all(model: &Model, held: &Held) -> Result<()> {
    let (n_held, n_dofs) = (held.count(), model.n_dofs());
    let nothing = |left| Err(Error::AllFixed { n_held, n_dofs, left });
    let has_mass = |row: usize| model.mass.get(row, row).is_some_and(|mass| *mass > 0.0);
    match (0..n_dofs).filter(|row| !held.holds(*row)).any(has_mass) {
        _ if n_held == n_dofs => nothing("no dof is left"),
        false => nothing("no dof with mass is left"),
        true => Ok(()),
    }
}
