//! P14: where modes repeat, the start vector may turn them into each other; what is built on them stays.

use faer::Mat;
use proptest::prelude::*;
use supel::basis::Basis;
use supel::constraint::constraint_modes;
use supel::factor::Cholesky;
use supel::job::{Method, ModeSelection, ReductionJob};
use supel::modes::{Component, ModeSource, Retained, Search};
use supel::partition::Partition;
use supel::plan::Relief;
use supel::random::SEED;
use supel::reduction::Reduction;
use supel_models::{Material, brick};

use crate::chain::{direct, rigid_of};
use crate::kept;

/// A beam of square section: every bending mode is double.
fn square_beam() -> supel_models::Model {
    brick([6, 2, 2], [6.0, 1.0, 1.0], &Material::UNIT)
}

struct Built {
    partition: Partition,
    retained: Retained,
    reduction: Reduction,
}

fn built(method: Method, count: usize, seed: u64) -> Built {
    let (partition, rigid) = rigid_of(&square_beam(), &[direct("ends", &[1, 15, 43, 63])]).expect("a beam");
    let analysis = partition.analysis().expect("memory");
    let factor = Cholesky::new(&analysis, partition.pencil(), 0.0, &|dof| partition.name_of(dof)).expect("definite");
    let constraint = constraint_modes(&partition, &factor, &rigid);
    let component = Component {
        partition: &partition,
        analysis: &analysis,
        factor: &factor,
        rigid: &rigid,
        constraint: Some(&constraint),
    };
    let job = ReductionJob::new(method, ModeSelection::Count { count });
    let search = Search::new(component, &job).expect("counts");
    let found = search.lowest(seed).expect("converges");
    let retained = Retained::of(found, search.problem.boundary);
    let basis = Basis::new(
        &constraint,
        &supel::basis::retained_columns(component, &constraint, Relief::of_reduction(&job), &retained),
        partition.internal().mass,
    );
    let reduction = Reduction::new(&partition, &basis, &rigid);
    drop(factor);
    Built { reduction, retained, partition }
}

/// Receptance of the interface at a shift below the first elastic eigenvalue: (K̂ − σM̂)⁻¹ on its rows.
fn receptance(built: &Built, sigma: f64) -> Mat<f64> {
    use faer::linalg::solvers::Solve;
    let (k, m, n_b) = (&built.reduction.stiffness, &built.reduction.mass, built.partition.n_interface());
    let n = k.nrows();
    let dynamic = Mat::from_fn(n, n, |i, j| k[(i, j)] - sigma * m[(i, j)]);
    let loads = Mat::from_fn(n, n_b, |i, j| f64::from(u8::from(i == j)));
    dynamic.partial_piv_lu().solve(&loads).submatrix(0, 0, n_b, n_b).to_owned()
}

proptest! {
    #![proptest_config(kept!("seeds"))]

    #[test]
    fn the_start_vector_changes_neither_subspaces_nor_receptance(
        seed in any::<u64>(),
        count in 2..=8usize,
        method in prop_oneof![Just(Method::CraigBampton), Just(Method::Herting)],
        share in 0.05f64..0.9,
    ) {
        let (reference, other) = (built(method, count, SEED), built(method, count, seed));
        let (x, y) = (&reference.retained.modes, &other.retained.modes);
        prop_assert_eq!(x.count(), y.count(), "whole clusters are kept");
        for (a, b) in x.lambda.iter().zip(&y.lambda) {
            prop_assert!((a / b - 1.0).abs() < 1e-11, "{:e} and {:e}", a, b);
        }
        // sin² of the largest angle between the spans: what projecting one on the other loses.
        let mass = match method {
            Method::CraigBampton => reference.partition.internal().mass,
            _ => reference.partition.pencil().mass,
        };
        let image = supel::sparse::product(mass, y.shapes.as_ref());
        let coefficients = x.shapes.transpose() * &image;
        let left = &y.shapes - &x.shapes * &coefficients;
        let lost = left.transpose() * supel::sparse::product(mass, left.as_ref());
        prop_assert!(lost.norm_max().sqrt() <= 1e-8, "the spans differ by the angle {:e}", lost.norm_max().sqrt());
        let sigma = share * x.lambda[0];
        let (expected, found) = (receptance(&reference, sigma), receptance(&other, sigma));
        let difference = (&found - &expected).norm_max() / expected.norm_max();
        prop_assert!(difference <= 1e-10, "receptance differs by {:e}", difference);
    }
}
