//! What results must not depend on: the order of rows, units, the number of other bodies.

use proptest::prelude::*;
use supel_models as models;
use supel_models::transform::scaled;
use supel_models::{Material, brick};

use crate::chain::{Chain, Method, reduce, rigid_group, spectrum};

fn block() -> models::Model {
    brick([3, 2, 2], [3.0, 1.3, 0.9], &Material::STEEL_SI)
}

fn reduced(model: &models::Model, method: Method) -> Chain {
    reduce(model, &[rigid_group("XMIN"), rigid_group("XMAX")], method, 5).expect("a block between two patches")
}

/// Eigenvalues of the free reduced model in the user's units.
fn eigenvalues(chain: &Chain) -> Vec<f64> {
    let unit = chain.partition.scaling.eigenvalue_unit();
    let found = spectrum(chain.reduction.stiffness.as_ref(), chain.reduction.mass.as_ref());
    found.iter().map(|lambda| lambda * unit).collect()
}

/// `model` with its rows in another order; row k of the old becomes row `place[k]`.
fn permuted(model: &models::Model, place: &[u32]) -> models::Model {
    let moved = |entries: &[models::model::Entry]| {
        entries.iter().map(|&(i, j, value)| (place[i as usize], place[j as usize], value)).collect()
    };
    let mut dofs = model.dofs.clone();
    for (old, new) in place.iter().enumerate() {
        dofs[*new as usize] = model.dofs[old];
    }
    models::Model { stiffness: moved(&model.stiffness), mass: moved(&model.mass), dofs, ..model.clone() }
}

fn method() -> impl Strategy<Value = Method> {
    prop_oneof![Just(Method::CraigBampton), Just(Method::Herting)]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn order_of_rows_does_not_matter(
        place in Just((0..108u32).collect::<Vec<_>>()).prop_shuffle(),
        method in method(),
    ) {
        let (model, n_rigid) = (block(), 6);
        let (before, after) = (eigenvalues(&reduced(&model, method)), eigenvalues(&reduced(&permuted(&model, &place), method)));
        prop_assert_eq!(before.len(), after.len());
        // Other orders of elimination round otherwise: a hundred rows, a condition near a hundred, 1e-14 each.
        for (before, after) in before.iter().zip(&after).skip(n_rigid) {
            prop_assert!((before - after).abs() <= 1e-11 * before, "{:e} became {:e}", before, after);
        }
    }

    #[test]
    fn units_that_are_powers_of_two_change_no_bit(a in -60i32..60, b in -60i32..60, method in method()) {
        let reference = reduced(&block(), method);
        let chain = reduced(&scaled(&block(), 2f64.powi(a), 2f64.powi(b)), method);
        prop_assert_eq!(&chain.reduction.stiffness, &reference.reduction.stiffness);
        prop_assert_eq!(&chain.reduction.mass, &reference.reduction.mass);
        prop_assert_eq!(chain.partition.scaling.stiffness, reference.partition.scaling.stiffness + a);
        prop_assert_eq!(chain.partition.scaling.mass, reference.partition.scaling.mass + b);
    }

    /// Units that are no powers of two change the last bits only.
    #[test]
    fn units_scale_eigenvalues(a in 1e-6f64..1e6, b in 1e-6f64..1e6, method in method()) {
        let reference = eigenvalues(&reduced(&block(), method));
        let found = eigenvalues(&reduced(&scaled(&block(), a, b), method));
        for (found, reference) in found.iter().zip(&reference).skip(6) {
            let expected = reference * a / b;
            prop_assert!((found - expected).abs() <= 1e-11 * expected, "{:e} for {:e}", found, expected);
        }
    }
}

/// The largest diagonal entry may lie just below a power of two, where a logarithm rounds up.
#[test]
fn scaling_is_exact_just_below_a_power_of_two() {
    for exponent in [-950, -300, -1, 0, 1, 52, 300, 1000] {
        let just_below = f64::from_bits(2f64.powi(exponent).to_bits() - 1);
        let unit = models::spring(3, models::Ends::Fixed);
        let model = models::transform::scaled(&unit, just_below / 2.0, 1.0);
        let scaled = supel::model::Model::new(crate::chain::input(&model)).expect("a chain");
        let largest = supel::sparse::diagonal(&scaled.stiffness).into_iter().fold(0.0, f64::max);
        assert!((1.0..2.0).contains(&largest), "2^{exponent}: {largest:e}");
    }
}
