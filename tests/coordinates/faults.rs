//! One thing wrong with a model: its map, its coordinates, the frames of its rows or K itself.

use supel_models::model::Assembler;
use supel_models::transform::{supported, turned};
use supel_models::{Material, Model, SplitMix64, brick};

/// A steel block of 6 × 3 × 2 bricks, no two of whose sizes are alike.
pub(crate) fn block() -> Model {
    brick([6, 3, 2], [1.2, 0.55, 0.31], &Material::STEEL_SI)
}

/// The block clamped at one of its ends: the rows of those nodes are not there.
pub(crate) fn clamped() -> Model {
    let block = block();
    let wall = block.groups["YMIN"].clone();
    supported(&block, |(label, _)| wall.contains(&label))
}

/// The two ends of the block, along x.
pub(crate) fn ends(model: &Model) -> [Vec<i64>; 2] {
    let has_rows = |label: &i64| model.dofs.iter().any(|(node, _)| node == label);
    ["XMIN", "XMAX"].map(|name| model.groups[name].iter().copied().filter(has_rows).collect())
}

/// A change that makes dof map, coordinates or K wrong.
pub(crate) type Fault = (&'static str, fn(&Model) -> Model);

/// Wrong maps and coordinates.
pub(crate) const FAULTS: &[Fault] = &[
    ("nodes of the map shifted by one", |model| with_labels(model, |node, n| (node + 1) % n)),
    ("x and y of the map exchanged", |model| {
        with_dofs(model, |(node, direction)| (node, [1, 0, 2][direction as usize]))
    }),
    ("two nodes of the map exchanged", |model| {
        with_labels(model, |node, n| match node {
            k if k == n / 3 => n - 2,
            k if k == n - 2 => n / 3,
            k => k,
        })
    }),
    ("a block of nodes permuted in the map", |model| {
        let order = shuffled(12);
        with_labels(
            model,
            |node, n| if node >= n / 2 && node < n / 2 + 12 { n / 2 + order[node - n / 2] } else { node },
        )
    }),
    ("coordinates mirrored", |model| with_nodes(model, |_, [x, y, z]| [-x, y, z])),
    ("axes of the coordinates permuted", |model| with_nodes(model, |_, [x, y, z]| [y, z, x])),
    ("coordinates in a turned frame", |model| {
        with_nodes(model, |_, [x, y, z]| [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z])
    }),
    ("one node out of place", |model| with_nodes(model, |k, [x, y, z]| [x, y + if k == 40 { 0.02 } else { 0.0 }, z])),
    ("a deformed state", |model| with_nodes(model, |_, [x, y, z]| [x, y, z + 0.2 * x * x])),
    ("one length in another unit", |model| with_nodes(model, |_, [x, y, z]| [x, y, 25.4 * z])),
    ("the nodes of another mesh", |model| {
        let mut random = SplitMix64::new(7);
        let mut nodes = model.nodes.clone();
        nodes.iter_mut().flatten().for_each(|value| *value = random.uniform());
        Model { nodes, ..model.clone() }
    }),
];

/// Rows in an order or in frames that the map does not say: translations are not free by it.
pub(crate) const FAULTS_OF_DIRECTIONS: &[Fault] = &[
    ("rows ordered direction by direction", |model| {
        let n_nodes = model.n / 3;
        let dofs: Vec<(i64, u8)> =
            (0..model.n).map(|row| (model.dofs[3 * (row % n_nodes)].0, (row / n_nodes) as u8)).collect();
        Model { dofs, ..model.clone() }
    }),
    ("local frames at every fifth node", |model| turned(model, |node| node % 5 == 4)),
    ("local frames at one end", |model| turned(model, |node| model.nodes[node][0] > 1.1)),
    ("a local frame at one node", |model| turned(model, |node| node == 40)),
];

/// What changes nothing that K, M, map and coordinates could contradict.
pub(crate) const UNSEEN: &[Fault] = &[
    ("another unit of length", |model| with_nodes(model, |_, x| x.map(|x| 1000.0 * x))),
    ("another origin", |model| with_nodes(model, |_, [x, y, z]| [x + 3.0, y - 5.0, z + 0.5])),
    ("all axes reversed", |model| with_nodes(model, |_, x| x.map(|x| -x))),
    ("x and y exchanged in map and coordinates", |model| {
        let model = with_dofs(model, |(node, direction)| (node, [1, 0, 2][direction as usize]));
        with_nodes(&model, |_, [x, y, z]| [y, x, z])
    }),
];

fn with_nodes(model: &Model, at: impl Fn(usize, [f64; 3]) -> [f64; 3]) -> Model {
    let nodes = model.nodes.iter().enumerate().map(|(index, position)| at(index, *position)).collect();
    Model { nodes, ..model.clone() }
}

fn with_dofs(model: &Model, dof: impl Fn((i64, u8)) -> (i64, u8)) -> Model {
    Model { dofs: model.dofs.iter().map(|at| dof(*at)).collect(), ..model.clone() }
}

/// The map with its nodes, counted as they come, renumbered among themselves.
fn with_labels(model: &Model, number: impl Fn(usize, usize) -> usize) -> Model {
    let mut labels: Vec<i64> = model.dofs.iter().map(|dof| dof.0).collect();
    labels.dedup();
    let n = labels.len();
    let at = |label: i64| labels.iter().position(|other| *other == label).expect("a node");
    with_dofs(model, |(node, direction)| (labels[number(at(node), n)], direction))
}

pub(crate) fn shuffled(n: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    let mut random = SplitMix64::new(3);
    (1..n).rev().for_each(|k| order.swap(k, (random.uniform() * (k + 1) as f64) as usize));
    order
}

/// K with a spring against each rotation about the middle and none against translation: no support of a solid does that.
/// `share` is its energy relative to that of a unit of the largest entry of K.
pub(crate) fn against_rotation(model: &Model, axes: &[usize], share: f64) -> Model {
    let largest = model.stiffness.iter().fold(0.0f64, |max, entry| max.max(entry.2));
    let rigid = model.rigid_body_modes();
    let translations = [&rigid[0], &rigid[1], &rigid[2]];
    let mut sum = Assembler::default();
    sum.extend(model.stiffness.iter().copied());
    for axis in axes {
        let mut motion = rigid[3 + axis].clone();
        for translation in translations {
            // All translations have the same number of rows.
            let mean = 3.0 * supel_models::model::dot(translation, &motion) / model.n as f64;
            motion.iter_mut().zip(translation).for_each(|(value, moved)| *value -= mean * moved);
        }
        let square = supel_models::model::dot(&motion, &motion);
        for i in 0..model.n {
            for j in i..model.n {
                sum.add(i as u32, j as u32, share * largest * motion[i] * motion[j] / square);
            }
        }
    }
    Model { stiffness: sum.finish(), ..model.clone() }
}
