//! Average coupling: the mean motion of a patch, against dense algebra and against a bar.

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Side};
use supel::dofs::Direction;
use supel::error::Error;
use supel::job::{InterfaceJob, NodeSelection, Weights};
use supel_models::transform::supported;
use supel_models::{Material, Model, brick};

use crate::cases::{average, broad};
use crate::chain::certified::{certify, count, free, held};
use crate::chain::{EPS, Method, mean_motion, reduce, rigid_group, spectrum};

const N_MODES: usize = 12;

/// K and M of a model.
fn matrices(model: &Model) -> [Mat<f64>; 2] {
    [&model.stiffness, &model.mass].map(|entries| {
        let mut full = Mat::zeros(model.n, model.n);
        entries.iter().for_each(|&(i, j, value)| full[(i as usize, j as usize)] = value);
        full
    })
}

/// Z with G Z = 0 and ZᵀZ = I.
fn null_space(g: MatRef<'_, f64>) -> Mat<f64> {
    let q = g.transpose().qr().compute_Q();
    q.subcols(g.nrows(), g.ncols() - g.nrows()).to_owned()
}

/// Relative error of the eigenvalues of dense matrices of some hundred rows, on top of what their elements have: the largest is some
/// 1e5 times the smallest one here, and its rounding is in all.
const DENSE: f64 = 1e5 * 100.0 * EPS;

fn assert_eigenvalues(found: &[f64], expected: &[f64]) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < DENSE, "{found} where {expected} was expected");
    }
}

/// Fixed-interface modes are those on G u = 0, as a null space has them, and a Sturm count certifies them; free modes are those of the
/// model, as nothing is tied.
#[test]
fn modes_are_those_of_the_null_space() {
    let (model, interfaces) = (broad(), [average("XMAX")]);
    let [k, m] = matrices(&model);
    let z = null_space(mean_motion(&model, &interfaces[0], &Direction::ALL).as_ref());
    let on_null_space = |a: &Mat<f64>| z.transpose() * a * &z;
    let expected = spectrum(on_null_space(&k).as_ref(), on_null_space(&m).as_ref());
    for eigensolver in crate::chain::certified::eigensolvers() {
        let found = certify(&model, &interfaces, &held(count(N_MODES), *eigensolver)).expect("modes").lambda;
        assert!(found.len() >= N_MODES);
        assert_eigenvalues(&found, &expected);
        let found = certify(&model, &interfaces, &free(count(N_MODES), *eigensolver)).expect("modes").lambda;
        assert_eigenvalues(&found, &spectrum(k.as_ref(), m.as_ref())[6..]);
    }
}

/// A patch that is free to deform is softer than a rigid one, mode by mode.
#[test]
fn average_is_softer_than_rigid() {
    let lambda = |job: InterfaceJob| {
        certify(&broad(), &[job], &held(count(N_MODES), crate::chain::certified::eigensolvers()[0]))
            .expect("modes")
            .lambda
    };
    let (soft, stiff) = (lambda(average("XMAX")), lambda(rigid_group("XMAX")));
    assert!(soft.iter().zip(&stiff).all(|(soft, stiff)| *soft < stiff * (1.0 + DENSE)), "{soft:?} {stiff:?}");
    assert!(soft[0] < 0.99 * stiff[0], "{} {}", soft[0], stiff[0]);
}

/// A force f on the node moves it as the forces Gᵀf move the mean of the full model.
#[test]
fn a_force_on_the_node_is_shared_out_as_the_mean_is_taken() {
    let model = supported(&broad(), |(label, _)| label % 3 == 1);
    let interfaces = [average("XMAX")];
    let chain = reduce(&model, &interfaces, Method::CraigBampton, N_MODES).expect("a superelement");
    let [k, _] = matrices(&model);
    let g = mean_motion(&model, &interfaces[0], &Direction::ALL);
    let factor = k.llt(Side::Lower).expect("K is definite");
    let expected = &g * factor.solve(g.transpose());
    let stiffness = &chain.constraint.stiffness * faer::Scale(chain.partition.scaling.stiffness_unit());
    let product = stiffness * &expected;
    for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
        // Solves with matrices whose condition is some 1e4; rotations are of the size of translations.
        assert!((product[(i, j)] - f64::from(u8::from(i == j))).abs() < 1e4 * 100.0 * EPS, "{product:?}");
    }
}

/// Weights that are too unlike leave nothing of the mean motion of the nodes that count.
#[test]
fn weights_a_million_times_apart_are_the_most_that_count() {
    let model = broad();
    let labels = model.groups["XMAX"].clone();
    let weighted = |least: f64| {
        let weights = (0..labels.len()).map(|at| if at % 2 == 0 { 1.0 } else { least }).collect();
        let nodes = NodeSelection::Labels(labels.clone());
        let patch = InterfaceJob { nodes, weights: Some(Weights::Given(weights)), ..average("XMAX") };
        reduce(&model, &[patch], Method::CraigBampton, 3).map(|_| ())
    };
    weighted(1e-6).expect("a superelement");
    let refused = weighted(1e-7);
    assert!(matches!(refused, Err(Error::WeightSpread { smallest: 1e-7, largest: 1.0, .. })), "{refused:?}");
}

/// Two ends of a bar, weighted by area: pulled apart, they are as far as EA/L says, since the bar may get thinner. Rigid ends hold it.
#[test]
fn a_bar_is_as_stiff_as_a_bar() {
    let [length, width, height] = [2.0, 1.2, 0.7];
    let model = brick([4, 2, 2], [length, width, height], &Material::UNIT);
    let end = |name: &str| {
        let labels = model.groups[name].clone();
        let at = |label: &i64| model.nodes[model.labels.iter().position(|other| other == label).expect("a node")];
        // The faces around a node: one at a corner, two at an edge, four inside.
        let n_inside = |[_, y, z]: [f64; 3]| [y / width, z / height].iter().filter(|s| (0.1..0.9).contains(*s)).count();
        let weights = labels.iter().map(|label| (1 << n_inside(at(label))) as f64).collect();
        let nodes = NodeSelection::Labels(labels);
        InterfaceJob { nodes, weights: Some(Weights::Given(weights)), ..average(name) }
    };
    let flexibility = |interfaces: &[InterfaceJob]| {
        let chain = reduce(&model, interfaces, Method::CraigBampton, 3).expect("a superelement");
        let second = chain.constraint.stiffness.submatrix(6, 6, 6, 6).to_owned();
        let unit = Mat::from_fn(6, 1, |i, _| if i == 0 { 1.0 } else { 0.0 });
        second.llt(Side::Lower).expect("definite").solve(unit)[(0, 0)] / chain.partition.scaling.stiffness_unit()
    };
    let expected = length / (width * height);
    let found = flexibility(&[end("XMIN"), end("XMAX")]);
    // A condition of some 1e3.
    assert!((found / expected - 1.0).abs() < 1e3 * 100.0 * EPS, "{found} where {expected} was expected");
    let held = flexibility(&[rigid_group("XMIN"), rigid_group("XMAX")]);
    assert!(held < 0.98 * expected, "{held} {expected}");
}
