//! Factorisations, counts and eigensolutions that cannot be had.

use faer::MatMut;
use supel::constraint::{FreeAtZero, constraint_modes};
use supel::eigen::{ModalProblem, ModeRequest, ShiftInvert, Wanted, elastic_modes};
use supel::error::{Error, ErrorClass};
use supel::factor::{Cholesky, count_below};
use supel::job::Eigensolver;
use supel::random::SEED;
use supel::rigid;
use supel_models as models;
use supel_models::transform::{grounded, supported};
use supel_models::{Ends, Material, SplitMix64, brick, spring};

use crate::cases::{hinged, hinged_pins};
use crate::chain::{Method, direct, partition, reduce, rigid_of, rows};
use crate::{assert_says, refusal};

/// With the interface on one side of a hinge the other side is loose although every rigid-body motion is reacted.
#[test]
fn loose_part_beyond_a_hinge() {
    for method in [Method::CraigBampton, Method::Herting] {
        let error = refusal(reduce(&hinged(), &[direct("pins", &[1, 3, 4, 9])], method, 2));
        assert!(matches!(error, Error::NotDefinite { .. }), "{error}");
        assert_says(&error, ErrorClass::ModelPhysics, &["elimination stopped at node ", "mechanism"]);
    }
}

/// A held component with a spring so negative that it buckles, though every diagonal entry is positive.
#[test]
fn buckled_component() {
    let block = brick([3, 1, 1], [3.0, 1.0, 1.0], &Material::UNIT);
    let held = supported(&block, |(label, _)| label % 4 == 1);
    // A beam of this length and section is softer at its tip than 3EI/L³ = 1/108 and a rigid motion of it costs more.
    let row = held.dofs.iter().position(|dof| *dof == (8, 1)).expect("a dof");
    let buckled = grounded(&held, row, -2.0 / 108.0);
    let error = refusal(reduce(&buckled, &[direct("pins", &[2])], Method::CraigBampton, 2));
    assert!(matches!(error, Error::IndefiniteStiffness { count: 1, boundary: "held" }), "{error}");
    assert_says(&error, ErrorClass::ModelPhysics, &["1 negative eigenvalue with", "Sturm count", "smaller preload"]);
}

/// With the interface on both sides of a hinge everything can be factored; the hinge shows in the condensed stiffness.
#[test]
fn hinge_between_interfaces() {
    // A mechanism costs no energy, and is kept among the rigid-body modes, whatever holds the interface.
    for method in [Method::Herting, Method::CraigBampton] {
        let chain = reduce(&hinged(), &hinged_pins(), method, 2).expect("a component on a hinge");
        assert_eq!(chain.rigid.count(), 7, "{method:?}");
    }
}

/// Where nobody looks for mechanisms, the operator of free modes finds one motion more than it was told of.
#[test]
fn hinge_that_nobody_looked_for() {
    let (partition, rigid) = rigid_of(&hinged(), &hinged_pins()).expect("a component");
    let analysis = partition.analysis().expect("a pattern");
    let factor = Cholesky::new(&analysis, partition.pencil(), 0.0, &|dof| partition.name_of(dof)).expect("held");
    let constraint = constraint_modes(&partition, &factor, &rigid);
    let error = refusal(FreeAtZero::new(&factor, &partition.stiffness, &constraint, &rigid));
    assert!(matches!(error, Error::Mechanism { n_rigid: 6, n_more: 1 }), "{error}");
    assert_says(&error, ErrorClass::ModelPhysics, &["1 motion without", "6 rigid-body modes", "close hinges"]);
}

/// A shift on an eigenvalue of the only internal dof.
#[test]
fn sturm_count_on_an_eigenvalue() {
    let model = spring(2, Ends::Fixed);
    let partition = partition(&model, &[rows("end", &[1])]).expect("two masses");
    let analysis = partition.analysis().expect("one dof");
    // K_II = 2 and M_II = 1; counts are taken in scaled units.
    let sigma = 2.0 / partition.scaling.eigenvalue_unit();
    let error = refusal(count_below(&analysis, partition.pencil(), sigma));
    assert!(matches!(error, Error::SturmPivot), "{error}");
    assert_says(&error, ErrorClass::NumericalLimit, &["the shift lies on an eigenvalue", "one mode more or less"]);
    // λ = 1 and 3 free, 2 held.
    for (lambda, clamped, free) in [(0.5, 0, 0), (1.5, 0, 1), (2.5, 1, 1), (3.5, 1, 2)] {
        let count =
            count_below(&analysis, partition.pencil(), lambda / partition.scaling.eigenvalue_unit()).expect("a count");
        assert_eq!((count.clamped, count.free), (clamped, free), "below {lambda}");
    }
}

/// An operator that answers the same load differently each time.
struct Unreliable {
    n: usize,
    random: std::sync::Mutex<SplitMix64>,
}

impl ShiftInvert for Unreliable {
    fn n(&self) -> usize {
        self.n
    }

    fn shift(&self) -> f64 {
        0.0
    }

    fn solve_in_place(&self, mut block: MatMut<'_, f64>) {
        let mut random = self.random.lock().expect("one thread");
        for j in 0..block.ncols() {
            for i in 0..block.nrows() {
                block[(i, j)] *= 1.0 + 0.1 * random.normal();
            }
        }
    }
}

#[test]
fn eigensolver_that_does_not_converge() {
    let partition = partition(&spring(200, Ends::Fixed), &[]).expect("a chain");
    let problem = ModalProblem::of(partition.pencil(), partition.precision);
    let request = ModeRequest { wanted: Wanted::Count(3), eigensolver: Eigensolver::Lanczos, seed: SEED };
    let operator = Unreliable { n: 200, random: SplitMix64::new(1).into() };
    let error = refusal(elastic_modes(problem, &operator, request));
    assert!(matches!(error, Error::LanczosStalled { restarts: 1.., .. }), "{error}");
    assert_says(&error, ErrorClass::NumericalLimit, &["restarts", "ask for another number of modes"]);
}

/// Magnitudes far from one are only units.
#[test]
fn extreme_units_are_only_units() {
    let unit = spring(12, Ends::Free);
    let reference = reduce(&unit, &[direct("end", &[1])], Method::Herting, 3).expect("a chain");
    for (stiffness, mass) in [(2f64.powi(498), 2f64.powi(-498)), (2f64.powi(-470), 2f64.powi(480))] {
        let model: models::Model = models::transform::scaled(&unit, stiffness, mass);
        let chain = reduce(&model, &[direct("end", &[1])], Method::Herting, 3).expect("a chain");
        assert_eq!(chain.reduction.stiffness, reference.reduction.stiffness);
        assert_eq!(chain.reduction.mass, reference.reduction.mass);
    }
}

/// A dense stiffness with these eigenvalues, unit mass, as a program writes a component that it reduced itself.
fn with_spectrum(lambda: &[f64]) -> models::Model {
    let n = lambda.len();
    // The reflection at a plane: orthogonal, and no entry is zero.
    let w: Vec<f64> = (0..n).map(|i| 1.0 + 0.1 * (7 * i % 5) as f64).collect();
    let square: f64 = w.iter().map(|w| w * w).sum();
    let q = |i: usize, j: usize| f64::from(u8::from(i == j)) - 2.0 * w[i] * w[j] / square;
    let entry = |i: usize, j: usize| (0..n).map(|k| q(i, k) * lambda[k] * q(j, k)).sum::<f64>();
    let all = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let stiffness = all.map(|(i, j)| (i as u32, j as u32, entry(i.max(j), i.min(j)))).collect();
    let mass = (0..n as u32).map(|i| (i, i, 1.0)).collect();
    // Its rows have no place: no translation is among its motions without energy.
    models::Model { stiffness, mass, dofs: Vec::new(), ..spring(n, Ends::Free) }
}

/// A rigid-body motion of an energy below zero is rounding of the program that wrote K as long as it is nothing compared with the first elastic mode;
/// what is more is an eigenvalue of K, which is counted before K is called indefinite.
#[test]
fn negative_energy_of_a_rigid_body_motion_is_rounding_or_counted() {
    let spectrum = |lowest: f64| -> Vec<f64> { std::iter::once(lowest).chain((1..12).map(f64::from)).collect() };
    for lowest in [-7e-12, -1e-9] {
        let partition = partition(&with_spectrum(&spectrum(lowest)), &[]).expect("a model");
        assert_eq!(rigid::from_matrices(&partition).expect("a zero mode").0.count(), 1, "{lowest:e}");
    }
    let partition = partition(&with_spectrum(&spectrum(-1e-7)), &[]).expect("a model");
    let error = refusal(rigid::from_matrices(&partition));
    assert!(matches!(error, Error::IndefiniteStiffness { count: 1, .. }), "{error}");
    assert_says(&error, ErrorClass::ModelPhysics, &["1 negative eigenvalue", "by a Sturm count"]);
}
