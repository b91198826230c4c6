//! Models and constraints for these tests.

use supel_models::transform::join;
use supel_models::{Material, Model, brick};

use super::Rows;

pub(crate) const SIZE: [f64; 3] = [1.0, 0.31, 0.23];

/// A model with one more node, whose six rows have neither stiffness nor mass.
pub(crate) fn with_hub(model: &Model, at: [f64; 3]) -> (Model, i64) {
    let mut model = model.clone();
    let label = model.labels.iter().max().expect("a node") + 1;
    model.nodes.push(at);
    model.labels.push(label);
    model.dofs.extend((0..6).map(|direction| (label, direction)));
    model.n += 6;
    (model, label)
}

pub(crate) fn row(model: &Model, dof: (i64, u8)) -> u32 {
    model.dofs.iter().position(|other| *other == dof).expect("a dof") as u32
}

pub(crate) fn position(model: &Model, label: i64) -> [f64; 3] {
    model.nodes[model.labels.iter().position(|other| *other == label).expect("a node")]
}

/// The factors of the six dofs of a node in a displacement of a point that moves with it, at the end of a lever: e_a + θ × r.
pub(crate) fn lever([x, y, z]: [f64; 3], axis: usize) -> [f64; 6] {
    let turned = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]][axis];
    std::array::from_fn(|k| if k < 3 { f64::from(u8::from(k == axis)) } else { turned[k - 3] })
}

/// Rigid elements: u_s − u_h − θ_h × r = 0 for the nodes of a patch.
pub(crate) fn rigid_elements(model: &Model, hub: i64, slaves: &[i64]) -> Rows {
    let centre = position(model, hub);
    let of_slave = |(slave, axis): (i64, usize)| {
        let x = position(model, slave);
        let factors = lever([0, 1, 2].map(|k| x[k] - centre[k]), axis).into_iter().enumerate();
        let of_hub = factors.filter(|(_, factor)| *factor != 0.0);
        let terms = of_hub.map(|(direction, factor)| (row(model, (hub, direction as u8)), -factor));
        std::iter::once((row(model, (slave, axis as u8)), 1.0)).chain(terms).collect()
    };
    slaves.iter().flat_map(|slave| (0..3).map(move |axis| (*slave, axis))).map(of_slave).collect()
}

/// Two blocks of cells that meet in the plane x = 0.5, the second tied to the faces of the first by their shape functions.
pub(crate) fn tied_halves(first: [usize; 3], second: [usize; 3]) -> (Model, Rows) {
    let half = [0.5 * SIZE[0], SIZE[1], SIZE[2]];
    let (a, mut b) = (brick(first, half, &Material::STEEL_SI), brick(second, half, &Material::STEEL_SI));
    b.nodes.iter_mut().for_each(|x| x[0] += half[0]);
    let n_of_first = a.nodes.len();
    let model = join(&a, &b, &[]);
    let at_face = |x: [f64; 3]| (x[0] - half[0]).abs() < 1e-12;
    let nodes = || (0..model.nodes.len()).filter(|node| at_face(model.nodes[*node]));
    let mut rows = Rows::new();
    for slave in nodes().filter(|node| *node >= n_of_first) {
        let hat = |master: usize, axis: usize| {
            let distance = (model.nodes[slave][axis] - model.nodes[master][axis]).abs();
            (1.0 - distance * first[axis] as f64 / SIZE[axis]).max(0.0)
        };
        let weights: Vec<(usize, f64)> = nodes()
            .filter(|node| *node < n_of_first)
            .map(|master| (master, hat(master, 1) * hat(master, 2)))
            .filter(|(_, weight)| *weight > 1e-12)
            .collect();
        for direction in 0..3 {
            let of = |node: usize| row(&model, (model.labels[node], direction));
            let masters = weights.iter().map(|(master, weight)| (of(*master), -weight));
            rows.push(std::iter::once((of(slave), 1.0)).chain(masters).collect());
        }
    }
    (model, rows)
}

/// The labels of nodes at points.
pub(crate) fn labels_at(model: &Model, points: &[[f64; 3]]) -> Vec<i64> {
    let label = |point: &[f64; 3]| {
        let is_there = |x: &[f64; 3]| (0..3).all(|axis| (x[axis] - point[axis]).abs() < 1e-9);
        model.labels[model.nodes.iter().position(is_there).expect("a node")]
    };
    points.iter().map(label).collect()
}
