//! Finite element structures: both eigensolvers agree with each other and, where small enough, with a dense spectrum.

use supel::eigen::{Modes, Wanted};
use supel::job::Eigensolver;
use supel_models::*;

use crate::chain::certified::eigensolvers;
use crate::component::Component;

/// The lowest modes by Lanczos, the same by ARPACK.
fn agreed(component: &Component, wanted: Wanted) -> Modes {
    let lanczos = component.modes(wanted, Eigensolver::Lanczos);
    let reference: Vec<f64> = lanczos.lambda.iter().map(|lambda| lambda * component.unit()).collect();
    for &eigensolver in eigensolvers() {
        component.assert_lambda(&component.modes(wanted, eigensolver), &reference);
    }
    lanczos
}

/// Elastic eigenvalues of a dense solution, which errs by a few ε of its largest eigenvalue.
fn assert_dense(component: &Component, modes: &Modes, model: &Model) {
    let exact = spectrum(model);
    let n_rigid = component.rigid.count();
    let rounding = model.n as f64 * 1e-15 * exact[model.n - 1];
    for (j, lambda) in modes.lambda.iter().enumerate() {
        let (lambda, exact) = (lambda * component.unit(), exact[n_rigid + j]);
        assert!((lambda - exact).abs() <= rounding, "λ_{j} = {lambda}, dense {exact}, rounding {rounding:e}");
    }
}

#[test]
fn free_brick_has_elastic_modes_only() {
    let model = brick([5, 3, 2], [10.0, 4.0, 3.0], &Material::UNIT);
    let component = Component::new(&model);
    assert_eq!(component.rigid.count(), 6);
    let modes = agreed(&component, Wanted::Count(12));
    assert_eq!(modes.count(), 12);
    assert_dense(&component, &modes, &model);
}

#[test]
fn cube_has_multiple_modes_by_symmetry() {
    let model = brick([3, 3, 3], [1.0, 1.0, 1.0], &Material::STEEL_SI);
    let component = Component::new(&model);
    let modes = agreed(&component, Wanted::Count(20));
    assert_dense(&component, &modes, &model);
}

#[test]
fn slender_brick_keeps_its_bending_modes() {
    // Length to height 1000: bending is 1e-6 of the axial stiffness, so cancellation costs digits that the bars know.
    let component = Component::new(&brick([100, 1, 1], [100.0, 0.1, 0.1], &Material::UNIT));
    assert_eq!(component.rigid.count(), 6);
    let modes = agreed(&component, Wanted::Count(12));
    // A square section bends alike in both directions.
    for pair in [0, 2, 4] {
        let (a, b) = (modes.lambda[pair], modes.lambda[pair + 1]);
        let bar = 32.0 * f64::EPSILON * modes.errors[pair].cancellation;
        assert!((a / b - 1.0).abs() <= bar, "pair {pair}: {a} and {b}, bar {bar:e}");
    }
}

#[test]
fn plane_membrane_has_three_rigid_body_modes() {
    let model = membrane([8, 5], [8.0, 5.0], &Material::UNIT);
    let component = Component::new(&model);
    assert_eq!(component.rigid.count(), 3);
    let modes = agreed(&component, Wanted::Count(10));
    assert_dense(&component, &modes, &model);
}

/// A spatial frame of five nodes that no axis is parallel to.
fn small_frame(inertia: Inertia) -> Model {
    let nodes = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [1.3, 1.1, 0.0], [0.2, 1.0, 0.4], [0.6, 0.5, 1.2]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [2, 4]];
    frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, inertia)
}

#[test]
fn frame_with_consistent_mass_agrees_with_a_dense_spectrum() {
    let model = small_frame(Inertia::Consistent);
    let component = Component::new(&model);
    assert_eq!(component.rigid.count(), 6);
    let modes = agreed(&component, Wanted::Count(8));
    assert_dense(&component, &modes, &model);
}

#[test]
fn massless_rotations_have_no_modes() {
    // rank M = 15 of 30, six of them rigid-body modes: nine finite elastic eigenvalues.
    let component = Component::new(&small_frame(Inertia::LumpedTranslations));
    assert_eq!(component.rigid.count(), 6);
    for count in [4, 8] {
        assert_eq!(agreed(&component, Wanted::Count(count)).count(), count);
    }
    for count in [9, 15, 30] {
        let modes = agreed(&component, Wanted::Count(count));
        assert_eq!(modes.count(), 9);
        assert_eq!(modes.next, None);
    }
}
