//! What the scene says of interface nodes: dofs that are no coordinates because nothing acts on them, they are at rest, or a rigid body
//! moves them.
//!
//! ```text
//! u       6 × 1    displacement and rotation of an interface node
//! connected        a dof of the interface
//! unloaded         an internal dof
//! grounded         u_d = 0
//! prescribed       u = D u_c of a carrier c: u_d = t + θ × (x − x_c) or θ
//! ```

use super::held::{Ground, Held};
use super::interface_node::{InterfaceNode, Interfaces, Resolved, Rows};
use super::rigid_patch::rank_of_levers;
use super::sites::Sites;
use super::unloaded::Unloaded;
use crate::dofs::Direction;
use crate::error::{Error, Result};
use crate::job::{Coupling, DofUse, InterfaceJob, SceneJob};
use crate::model::{Model, Site};

/// The interface as the scene leaves it, where it says anything of it: nodes with coordinates first, then carriers, then patches without any, which stay rigid or keep
/// their mean all the same. What is at rest is added to what is held.
///
/// # Errors
/// [`Error::SceneCarrier`] where coordinates are unknown; [`Error::PatchRank`] where what a carrier moves does not tell its six motions
/// apart.
pub(super) fn heeded(
    model: &Model,
    interfaces: Interfaces,
    (scene, jobs): (Option<&SceneJob>, &[InterfaceJob]),
    held: &mut Held,
) -> Result<Interfaces> {
    let Some(scene) = scene else { return Ok(interfaces) };
    let (mut kept, mut without, mut unloaded) = (Vec::new(), Vec::new(), Unloaded::default());
    let mut carried: Vec<Vec<Resolved>> = scene.prescribed.iter().map(|_| Vec::new()).collect();
    for resolved in interfaces.list {
        let use_of = |direction| scene.use_of(jobs, (&resolved.node.name, direction));
        if let DofUse::Prescribed(carrier) = use_of(None) {
            carried[carrier].push(resolved);
            continue;
        }
        unloaded.rows.extend(unloaded_rows(&resolved, use_of));
        let resolved = apart(model, resolved.clone(), use_of, held);
        match (&resolved.rows, resolved.is_coordinate()) {
            (_, true) => kept.push(resolved),
            (Rows::Own(_), false) => {}
            (Rows::Patch(_) | Rows::Average { .. }, false) => without.push(resolved),
        }
    }
    for (job, members) in scene.prescribed.iter().zip(carried) {
        let carrier = kept.len();
        kept.push(Resolved::carrier(model, &job.name, &members)?);
        without.extend(members.into_iter().map(|member| Resolved { carrier: Some(carrier), ..member }));
    }
    let n_kept = kept.len();
    kept.extend(without);
    for (number, resolved) in kept.iter().enumerate() {
        let use_of = |direction| scene.use_of(jobs, (&resolved.node.name, direction));
        unloaded.of_patches.extend(unloaded_of_patch((number, resolved), use_of));
    }
    Ok(Interfaces { list: kept, n_kept, unloaded })
}

/// The rows of a node of its own that are unloaded, with their names.
fn unloaded_rows(resolved: &Resolved, use_of: impl Fn(Option<Direction>) -> DofUse) -> Vec<(usize, String)> {
    let Rows::Own(rows) = &resolved.rows else { return Vec::new() };
    let node = &resolved.node;
    let directions = |at: usize| node.directions.get(at).copied();
    let is_meant = |(at, _): &(usize, &usize)| use_of(directions(*at)) == DofUse::Unloaded;
    let named = |(at, row): (usize, &usize)| (*row, part_name(&node.name, directions(at)));
    rows.iter().enumerate().filter(is_meant).map(named).collect()
}

/// The directions of a patch that are unloaded, of a node by its number, with their names.
fn unloaded_of_patch(
    (number, resolved): (usize, &Resolved),
    use_of: impl Fn(Option<Direction>) -> DofUse,
) -> Vec<((usize, Direction), String)> {
    if matches!(resolved.rows, Rows::Own(_)) || resolved.carrier.is_some() {
        return Vec::new();
    }
    let unloaded = Direction::ALL.into_iter().filter(|direction| use_of(Some(*direction)) == DofUse::Unloaded);
    unloaded.map(|direction| ((number, direction), part_name(&resolved.node.name, Some(direction)))).collect()
}

fn part_name(interface: &str, direction: Option<Direction>) -> String {
    direction.map_or_else(|| interface.to_owned(), |direction| format!("{interface}.{direction}"))
}

/// A node without the dofs that are no coordinates; those at rest join what is held.
fn apart(
    model: &Model,
    mut resolved: Resolved,
    use_of: impl Fn(Option<Direction>) -> DofUse,
    held: &mut Held,
) -> Resolved {
    let node = &mut resolved.node;
    if node.directions.is_empty() {
        // Bare rows are one thing.
        if let (Rows::Own(rows), of) = (&mut resolved.rows, use_of(None))
            && of != DofUse::Connected
        {
            let rows = std::mem::take(rows);
            if of == DofUse::Grounded {
                held.ground(model, &node.name, Ground { n_nodes: None, rows, sites: Vec::new() });
            }
        }
        return resolved;
    }
    let of: Vec<DofUse> = node.directions.iter().map(|direction| use_of(Some(*direction))).collect();
    let is = |at: usize, wanted: DofUse| of[at] == wanted;
    let all = 0..node.directions.len();
    let grounded: Vec<Direction> =
        all.clone().filter(|at| is(*at, DofUse::Grounded)).map(|at| node.directions[at]).collect();
    if !grounded.is_empty() {
        let (mut rows, mut sites) = (Vec::new(), Vec::new());
        match &resolved.rows {
            Rows::Own(own) => rows.extend(all.clone().filter(|at| is(*at, DofUse::Grounded)).map(|at| own[at])),
            Rows::Patch(_) | Rows::Average { .. } => {
                let position = node.position.unwrap_or_default();
                sites.extend(grounded.iter().map(|direction| Site { position, direction: *direction }));
            }
        }
        held.ground(model, &node.name, Ground { n_nodes: Some(node.n_nodes), rows, sites });
    }
    if let Rows::Own(own) = &mut resolved.rows {
        *own = all.clone().filter(|at| is(*at, DofUse::Connected)).map(|at| own[at]).collect();
    }
    node.directions = all.filter(|at| is(*at, DofUse::Connected)).map(|at| node.directions[at]).collect();
    resolved.grounded = grounded;
    resolved
}

impl Resolved {
    /// Whether any dof of it is a coordinate.
    fn is_coordinate(&self) -> bool {
        match &self.rows {
            Rows::Own(rows) => !rows.is_empty(),
            Rows::Patch(_) | Rows::Average { .. } => !self.node.directions.is_empty(),
        }
    }

    /// The node of a rigid body, at the mean of the nodes that it moves.
    fn carrier(model: &Model, name: &str, members: &[Self]) -> Result<Self> {
        let unknown =
            || Error::SceneCarrier { name: name.to_owned(), found: "needs the coordinates of its nodes".to_owned() };
        let points: Vec<[f64; 3]> =
            members.iter().map(|member| member.node.position.ok_or_else(unknown)).collect::<Result<_>>()?;
        let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
        let position = [0, 1, 2].map(mean);
        let sites = Sites::new(model);
        let levers: Vec<[f64; 6]> = members.iter().flat_map(|member| member.levers(&sites, position)).collect();
        let (rank, expected) = (rank_of_levers(&levers), Direction::ALL.len());
        if rank < expected {
            return Err(Error::PatchRank { interface: name.to_owned(), n_rows: levers.len(), rank, expected });
        }
        let node = InterfaceNode {
            name: name.to_owned(),
            label: None,
            position: Some(position),
            fit: None,
            axes: None,
            directions: Direction::ALL.to_vec(),
            coupling: Coupling::Rigid,
            n_nodes: members.iter().map(|member| member.node.n_nodes).sum(),
        };
        Ok(Self::new(node, Rows::Patch(Vec::new())))
    }

    /// How the dofs of the node move with the six of a carrier at a position.
    pub(super) fn levers(&self, sites: &Sites<'_>, position: [f64; 3]) -> Vec<[f64; 6]> {
        match &self.rows {
            Rows::Own(rows) => rows.iter().map(|row| sites.lever(*row, position)).collect(),
            Rows::Patch(_) | Rows::Average { .. } => {
                let own = self.node.position.unwrap_or_default();
                let lever =
                    |direction: &Direction| Site { position: own, direction: *direction }.rigid_motion_about(position);
                self.node.directions.iter().map(lever).collect()
            }
        }
    }
}
