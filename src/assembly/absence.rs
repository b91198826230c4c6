//! Why a node of an interface lacks a direction, by the job that the file keeps.

use supel_runtime::{Direction, Superelement};

use crate::audit::kept_job;
use crate::job::{DofUse, FixedJob, InterfacePart, Job, NodeSelection};
use crate::plan::Plan;

/// Why a node lacks a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Absence {
    /// It is at rest there: so is whatever is connected to it.
    AtRest,
    /// It moves there, and the interface was made without it, or nobody knows: nothing can act on it.
    LeftOut,
    /// The model has no such dof, as solids have no rotations and models in a plane no motion out of it.
    NotThere,
}

/// Why an interface node, by its number, lacks a direction.
pub fn absence(superelement: &Superelement, node: usize, direction: Direction) -> Absence {
    let node = &superelement.metadata().interface_nodes[node];
    let Some(job) = kept_job(superelement) else { return Absence::LeftOut };
    let dof = (node.name.as_str(), Some(direction));
    let of_scene = Plan::of(&job).statements().map(|scene| scene.use_of(&job.interfaces, dof));
    match of_scene.unwrap_or(DofUse::Connected) {
        DofUse::Grounded => Absence::AtRest,
        DofUse::Unloaded => Absence::LeftOut,
        DofUse::Connected | DofUse::Prescribed(_) => {
            of_model(&job, dof).unwrap_or_else(|| of_interface(&job, (&node.name, node.label), direction))
        }
    }
}

/// What the superelement whose matrices were reduced says of the direction.
fn of_model(job: &Job, (name, direction): (&str, Option<Direction>)) -> Option<Absence> {
    let assumes = job.model.assumes.as_ref()?;
    let is_listed = |parts: &[InterfacePart]| {
        let named = |part: &InterfacePart| part.of(|other| other == name).is_some_and(|(_, own)| own == direction);
        parts.iter().any(named)
    };
    let of_lists = [(&assumes.at_rest, Absence::AtRest), (&assumes.left_out, Absence::LeftOut)];
    of_lists.into_iter().find_map(|(parts, absence)| is_listed(parts).then_some(absence))
}

/// Why an interface of which neither scene nor model says anything lacks a direction.
fn of_interface(job: &Job, (name, label): (&str, Option<i64>), direction: Direction) -> Absence {
    let interface = job.interfaces.iter().find(|interface| interface.name == name);
    let is_listed = |dofs: &Vec<Direction>| dofs.contains(&direction);
    match interface.map(|interface| interface.dofs.as_ref().is_none_or(is_listed)) {
        Some(true) => Absence::NotThere,
        Some(false) if job.fixed.iter().any(|fixed| holds(fixed, label, direction)) => Absence::AtRest,
        Some(false) | None => Absence::LeftOut,
    }
}

/// Whether dofs of a node that the job holds are these, as far as it names nodes by their labels.
fn holds(fixed: &FixedJob, label: Option<i64>, direction: Direction) -> bool {
    let is_meant = fixed.dofs.as_ref().is_none_or(|dofs| dofs.contains(&direction));
    let NodeSelection::Labels(labels) = &fixed.nodes else { return false };
    is_meant && label.is_some_and(|label| labels.contains(&label))
}
