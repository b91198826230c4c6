//! What superelements take for granted of the simulation, for the job of a model that is made of them.

use std::collections::BTreeSet;

use supel_runtime::{Direction, InterfaceNode, Superelement};

use crate::assembly::{Absence, Assembly, absence};
use crate::audit::kept_job;
use crate::job::{AssumesJob, InterfacePart, unseen_hz};

/// What a superelement takes for granted, with the names of its interfaces.
pub(super) fn assumed(superelement: &Superelement) -> AssumesJob {
    let metadata = superelement.metadata();
    let validity = &metadata.validity;
    let mut sentences = validity.assumptions.clone();
    if !validity.unloaded.is_empty() {
        let name = |node: usize| metadata.interface_nodes.get(node).map_or("", |node: &InterfaceNode| &node.name);
        let dofs: Vec<String> =
            validity.unloaded.iter().map(|dof| format!("{}.{}", name(dof.node), dof.direction)).collect();
        sentences.push(format!("no load acts on these interface dofs: {}", dofs.join(", ")));
    }
    let parts = |wanted: Absence| -> Vec<InterfacePart> {
        let nodes = metadata.interface_nodes.iter().enumerate();
        let of_nodes = nodes.flat_map(|(number, node)| absent(node).map(move |direction| (number, node, direction)));
        let meant = of_nodes.filter(|(number, _, direction)| absence(superelement, *number, *direction) == wanted);
        let names: BTreeSet<String> = meant.map(|(_, node, direction)| format!("{}.{direction}", node.name)).collect();
        names.into_iter().map(InterfacePart).collect()
    };
    // Of files of other programs nobody knows why a direction is not there.
    let is_known = kept_job(superelement).is_some();
    let [at_rest, left_out] =
        [Absence::AtRest, Absence::LeftOut].map(|wanted| if is_known { parts(wanted) } else { Vec::new() });
    AssumesJob { sentences, gravity: validity.gravity, at_rest, left_out, unseen_hz: unseen_hz(superelement) }
}

/// What the components of an assembly take for granted, under their names in it.
pub(super) fn assumed_by_all(assembly: &Assembly) -> AssumesJob {
    let mut all = AssumesJob::default();
    for component in &assembly.components {
        let AssumesJob { sentences, gravity, at_rest, left_out, unseen_hz } = assumed(&component.superelement);
        let part = |part: InterfacePart| InterfacePart(format!("{}.{}", component.name, part.0));
        all.add(AssumesJob {
            sentences: sentences.into_iter().map(|sentence| format!("{}: {sentence}", component.name)).collect(),
            gravity,
            at_rest: at_rest.into_iter().map(part).collect(),
            left_out: left_out.into_iter().map(part).collect(),
            unseen_hz,
        });
    }
    all
}

fn absent(node: &InterfaceNode) -> impl Iterator<Item = Direction> {
    Direction::ALL.into_iter().filter(|direction| !node.dofs.contains(direction))
}
