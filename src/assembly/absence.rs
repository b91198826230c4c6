//! Why a node of an interface lacks a direction, by the job that the file keeps.

use supel_runtime::Direction;

use super::component::Component;
use crate::audit::kept_job;
use crate::job::{DofUse, FixedJob, Job, NodeSelection};
use crate::plan::Plan;

/// Why a node lacks a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Absence {
    /// It is at rest there: so is whatever is connected to it.
    AtRest,
    /// It moves there, and the interface was made without it, or nobody knows: nothing can act on it.
    LeftOut,
    /// The model has no such dof, as solids have no rotations and models in a plane no motion out of it.
    NotThere,
}

impl Component {
    /// Why an interface node, by its number, lacks a direction.
    pub(super) fn absence(&self, node: usize, direction: Direction) -> Absence {
        let node = &self.superelement.metadata().interface_nodes[node];
        let Some(job) = kept_job(&self.superelement) else { return Absence::LeftOut };
        let dof = (node.name.as_str(), Some(direction));
        let of_scene = Plan::of(&job).statements().map(|scene| scene.use_of(&job.interfaces, dof));
        match of_scene.unwrap_or(DofUse::Connected) {
            DofUse::Grounded => Absence::AtRest,
            DofUse::Unloaded => Absence::LeftOut,
            DofUse::Connected | DofUse::Prescribed(_) => of_interface(&job, (&node.name, node.label), direction),
        }
    }
}

/// Why an interface of which the scene says nothing lacks a direction.
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
