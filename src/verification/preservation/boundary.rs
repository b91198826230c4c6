//! What a boundary of the scene does to the interface dofs.

use super::interfaces::{Inertia, Interface};
use crate::job::Support;
use crate::number::quantity;
use crate::verification::evidence::Evidence;

/// A support: which interface dofs it holds and which it loads.
#[derive(Clone, Debug)]
pub(super) struct Boundary {
    pub(super) name: String,
    pub(super) description: String,
    /// Held or not, for each interface dof.
    pub(super) held: Vec<bool>,
    /// Mass added to each interface dof, in scaled units.
    pub(super) load: Vec<f64>,
    /// Stiffness of the spring from each interface dof to the ground, in scaled units.
    pub(super) springs: Vec<f64>,
}

impl Boundary {
    pub(super) fn new(evidence: &Evidence<'_>, interfaces: &[Interface], support: &Support) -> Self {
        let partition = evidence.partition;
        let n_b = partition.n_interface();
        let mut boundary = Self {
            name: support.to_string(),
            description: "no interface held or loaded".to_owned(),
            held: vec![false; n_b],
            load: vec![0.0; n_b],
            springs: vec![0.0; n_b],
        };
        let Some(interface) = interfaces.iter().find(|interface| Some(interface.name.as_str()) == support.interface())
        else {
            return boundary;
        };
        match support {
            Support::Free => {}
            Support::Fixed { .. } => {
                interface.dofs.iter().for_each(|dof| boundary.held[*dof] = true);
                boundary.description = format!("all dofs of {} held, the other interfaces free", interface.name);
            }
            Support::Loaded { mass, .. } => boundary.load(evidence, interface, *mass),
            Support::Sprung { stiffness, .. } => boundary.spring(evidence, interface, *stiffness),
        }
        boundary
    }

    /// Spreads a mass and its moment of inertia evenly over the nodes of an interface.
    fn load(&mut self, evidence: &Evidence<'_>, interface: &Interface, mass: Option<f64>) {
        let partition = evidence.partition;
        let unit = partition.scaling.mass_unit();
        let own = Inertia::of(evidence);
        let inertia = mass.map_or(own, |mass| own.with_mass(mass / unit));
        let n_nodes = interface.n_nodes.max(1) as f64;
        let is_rotation = |dof: usize| {
            let site = partition.dofs[partition.n_internal + dof].site;
            site.is_some_and(|site| site.direction.is_rotation())
        };
        for dof in &interface.dofs {
            self.load[*dof] = if is_rotation(*dof) { inertia.moment } else { inertia.mass } / n_nodes;
        }
        // Nodes without rotations carry no moment.
        let moments = match interface.dofs.iter().any(|dof| is_rotation(*dof)) {
            true => format!(" with moments of inertia of {}", quantity(inertia.moment * unit, 4)),
            false => String::new(),
        };
        let whose = match (mass, moments.is_empty()) {
            (Some(_), _) => "",
            (None, true) => ", that of the component itself",
            (None, false) => ", that of the component itself and the mean of its moments",
        };
        let without = partition.internal_directions(&interface.name);
        let words: Vec<String> = without.iter().map(ToString::to_string).collect();
        let but = if words.is_empty() { String::new() } else { format!(", but not along {}", words.join(" ")) };
        self.description = format!(
            "{} carries a mass of {}{moments}{whose}{but}; nothing is held",
            interface.name,
            quantity(inertia.mass * unit, 4)
        );
    }

    /// Ties each translation of an interface to the ground, by a spring that its nodes share evenly.
    fn spring(&mut self, evidence: &Evidence<'_>, interface: &Interface, stiffness: f64) {
        let partition = evidence.partition;
        let unit = partition.scaling.stiffness_unit();
        let share = stiffness / unit / interface.n_nodes.max(1) as f64;
        for dof in &interface.dofs {
            let direction = partition.dofs[partition.n_internal + dof].site.map(|site| site.direction);
            if !direction.is_some_and(|direction| direction.is_rotation()) {
                self.springs[*dof] = share;
            }
        }
        self.description = format!(
            "each translation of {} on a spring of {} to the ground, rotations and the other interfaces free",
            interface.name,
            quantity(stiffness, 4)
        );
    }

    /// Whether any dof is on a spring.
    pub(super) fn has_springs(&self) -> bool {
        self.springs.iter().any(|spring| *spring > 0.0)
    }

    /// The interface dofs that a rigid-body motion has to leave at rest to pass: those held, and those on springs.
    pub(super) fn resisting(&self) -> Vec<bool> {
        self.held.iter().zip(&self.springs).map(|(held, spring)| *held || *spring > 0.0).collect()
    }

    /// Whether the retained modes are those of this boundary.
    pub(super) fn is_own(&self, evidence: &Evidence<'_>) -> bool {
        let held = evidence.partition.held_under(evidence.retained.boundary);
        // A load on a dof that is held changes nothing.
        self.held == held && !self.has_springs() && self.load.iter().zip(held).all(|(load, held)| held || *load == 0.0)
    }
}
