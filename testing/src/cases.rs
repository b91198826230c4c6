//! The models the theorems are tested on.

use supel::dofs::Direction;
use supel::job::{Coupling, InterfaceJob, NodeSelection, Origin, Weights};
use supel_models::transform::{carrying, join, supported, translated};
use supel_models::{Inertia, Material, Model, Section, brick, frame, membrane};

use crate::chain::{Chain, Method, Twin, direct, reduce, rigid_group, rows};

/// A model, its interfaces and the number of its rigid-body modes.
pub struct Case {
    pub name: &'static str,
    pub model: Model,
    pub interfaces: Vec<InterfaceJob>,
    pub n_rigid: usize,
}

/// Expansion modes asked for.
pub const N_MODES: usize = 6;

pub fn cases() -> Vec<Case> {
    let case = |name, model, interfaces: Vec<InterfaceJob>, n_rigid| Case { name, model, interfaces, n_rigid };
    let patches = || vec![rigid_group("XMIN"), rigid_group("XMAX")];
    let two_bodies = join(&solid(), &small_solid(), &[]);
    let offset = solid().labels.len() as i64;
    let pins = || vec![direct("pins", &[1, 5, 45]), direct("others", &[1, 3, 4].map(|l| l + offset))];
    let one_device = carrying(&two_bodies, &[40, 44, 45, offset + 1, offset + 2], 1.0);
    vec![
        case("free solid, nodes", solid(), vec![direct("pins", &[1, 5, 15, 45])], 6),
        case("free solid, patches", steel(), patches(), 6),
        case("free solid, patch and node", steel(), vec![rigid_group("XMIN"), direct("tip", &[45])], 6),
        case("free solid without coordinates", anonymous(solid()), vec![rows("rows", &[0, 1, 2, 12, 13, 14, 44])], 6),
        case("free frame", elbow(Inertia::Consistent), vec![direct("ends", &[1, 6])], 6),
        case("free frame, massless rotations", elbow(Inertia::LumpedTranslations), vec![direct("ends", &[1, 6])], 6),
        case("free membrane", sheet(), vec![direct("corners", &[1, 20])], 3),
        case("two bodies", two_bodies, pins(), 12),
        case("two bodies that carry one device", one_device, pins(), 12),
        case("two bodies on a hinge", hinged(), hinged_pins().to_vec(), 7),
        case("held solid", supported(&solid(), |(label, _)| label % 5 == 1), vec![rigid_group("XMAX")], 0),
        case("pendulum", pendulum(), vec![direct("tip", &[6])], 1),
        case("free solid, average and patch", broad(), vec![weighted(&broad(), "XMAX"), rigid_group("XMIN")], 6),
        case("held solid, average", supported(&solid(), |(label, _)| label % 5 == 1), vec![average("XMAX")], 0),
        case(
            "free frame, average and node",
            elbow(Inertia::Consistent),
            vec![of_nodes(&[2, 4, 5, 6]), direct("end", &[1])],
            6,
        ),
        case("free membrane, average", sheet(), vec![plane(of_nodes(&[1, 5, 7, 12, 20]))], 3),
    ]
}

/// Runs a check on every case with one method.
pub fn for_each_case(method: Method, check: impl Fn(&Case, &Chain, &Twin)) {
    for case in cases() {
        let chain = reduce(&case.model, &case.interfaces, method, N_MODES);
        let chain = chain.unwrap_or_else(|error| panic!("{}, {method:?}: {error}", case.name));
        let twin = Twin::new(&case.model, &case.interfaces, &chain.partition);
        check(&case, &chain, &twin);
    }
}

/// Runs a check on every case with both methods.
pub fn for_each_method(check: impl Fn(&Case, &Chain, &Twin)) {
    for method in [Method::CraigBampton, Method::Herting] {
        for_each_case(method, &check);
    }
}

/// Unequal sides keep the natural frequencies apart.
pub fn solid() -> Model {
    brick([4, 2, 2], [4.0, 1.2, 0.7], &Material::UNIT)
}

/// A model with a spring along the line between two of its nodes.
pub fn tied(mut model: Model, labels: [i64; 2], stiffness: f64) -> Model {
    let at = |label: i64| model.labels.iter().position(|other| *other == label).expect("a node");
    let [a, b] = labels.map(|label| model.nodes[at(label)]);
    let length = (0..3).map(|i| (b[i] - a[i]).powi(2)).sum::<f64>().sqrt();
    let row = |label: i64, axis: u8| model.dofs.iter().position(|dof| *dof == (label, axis)).expect("a dof") as u32;
    let ends: Vec<(u32, f64)> = [(labels[0], -1.0), (labels[1], 1.0)]
        .into_iter()
        .flat_map(|(label, sign)| (0..3u8).map(move |axis| (label, axis, sign)))
        .map(|(label, axis, sign)| (row(label, axis), sign * (b[axis as usize] - a[axis as usize]) / length))
        .collect();
    let spring = ends.iter().flat_map(|&(i, x)| ends.iter().map(move |&(j, y)| (i, j, stiffness * x * y)));
    for (i, j, value) in spring.filter(|(_, _, value)| *value != 0.0).collect::<Vec<_>>() {
        match model.stiffness.iter_mut().find(|entry| (entry.0, entry.1) == (i, j)) {
            Some(entry) => entry.2 += value,
            None => model.stiffness.push((i, j, value)),
        }
    }
    model
}

/// Interfaces on both bodies of [`hinged`].
pub fn hinged_pins() -> [InterfaceJob; 2] {
    [direct("here", &[1, 2, 4, 7]), direct("there", &[15, 18, 21])]
}

/// Two beams that share the edge x = 2, y = 1: a hinge about z. The first has the labels 1 to 12.
pub fn hinged() -> Model {
    let beam = brick([2, 1, 1], [2.0, 1.0, 1.0], &Material::UNIT);
    join(&beam, &translated(&beam, [2.0, 1.0, 0.0]), &[(6, 1), (12, 7)])
}

/// Its ends have more nodes than a group that is divided no further.
pub fn broad() -> Model {
    brick([2, 6, 5], [1.0, 3.0, 2.2], &Material::UNIT)
}

/// The mean motion of a group.
pub fn average(name: &str) -> InterfaceJob {
    InterfaceJob { coupling: Coupling::Average, ..rigid_group(name) }
}

/// The mean motion of a group, with weights of a factor of ten, about a point that is not among its nodes.
fn weighted(model: &Model, name: &str) -> InterfaceJob {
    let labels = model.groups[name].clone();
    let weights = labels.iter().map(|label| 1.0 + 9.0 * (12.9 * *label as f64).sin().abs()).collect();
    InterfaceJob {
        nodes: NodeSelection::Labels(labels),
        origin: Origin::Point([1.5, 1.0, 1.0]),
        weights: Some(Weights::Given(weights)),
        ..average(name)
    }
}

/// The mean motion of some nodes.
fn of_nodes(labels: &[i64]) -> InterfaceJob {
    InterfaceJob { nodes: NodeSelection::Labels(labels.to_vec()), ..average("mean") }
}

/// In the plane of a membrane.
fn plane(job: InterfaceJob) -> InterfaceJob {
    InterfaceJob { dofs: Some(vec![Direction::Ux, Direction::Uy, Direction::Rz]), ..job }
}

fn small_solid() -> Model {
    brick([1, 1, 3], [1.0, 1.3, 2.0], &Material::UNIT)
}

fn steel() -> Model {
    brick([4, 2, 2], [80.0, 24.0, 14.0], &Material::STEEL_MM_T_S)
}

fn sheet() -> Model {
    membrane([4, 3], [4.0, 2.0], &Material::UNIT)
}

/// The matrices of a model without the meaning of their rows.
fn anonymous(model: Model) -> Model {
    Model { dofs: Vec::new(), ..model }
}

/// Five beams with a bend, six nodes.
fn elbow(inertia: Inertia) -> Model {
    let nodes = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.1, 0.0, 0.0], [2.1, 0.9, 0.0], [2.1, 1.7, 0.3], [2.1, 2.8, 0.3]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]];
    frame(&nodes, &edges, &Section::round(0.05), &Material::STEEL_SI, inertia)
}

/// The elbow on a hinge about z at its first node.
fn pendulum() -> Model {
    supported(&elbow(Inertia::Consistent), |(label, direction)| label == 1 && direction != 5)
}
