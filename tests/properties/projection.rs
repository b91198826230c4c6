//! Rayleigh and Ritz: what projection on more or fewer columns does to eigenvalues, and what it leaves alone.

use faer::Mat;
use proptest::prelude::*;
use supel_models::Model;
use supel_models::model::Entry;

use crate::chain::{Chain, EPS, Method, Twin, reduce, rows, spectrum};
use crate::component::{Component, component};
use crate::kept;

/// Relative rounding of the j-th eigenvalue of a projection that is computed densely: the terms of K̂ before they cancel, and the
/// oracle's own ε (λ + s)²/(s λ) with its shift s at the first elastic eigenvalue.
fn rounding(chain: &Chain, lambda: f64, first: f64) -> f64 {
    let n = chain.partition.n_dofs() as f64;
    let cancelled = chain.constraint.cancellation * stiffest(chain) / lambda;
    n * EPS * (cancelled + (lambda + first).powi(2) / (first * lambda))
}

/// The largest eigenvalue of the uncoupled interface: max K_BB,ii / M̂_BB,ii.
fn stiffest(chain: &Chain) -> f64 {
    let (partition, m) = (&chain.partition, &chain.reduction.mass);
    let ratio = |i: usize| {
        let row = partition.n_internal + i;
        partition.stiffness.get(row, row).expect("stored") / m[(i, i)]
    };
    (0..partition.n_interface()).map(ratio).fold(0.0, f64::max)
}

/// Asserts lower ≤ upper for every elastic pair, to rounding.
fn below(chain: &Chain, lower: &[f64], upper: &[f64], n_rigid: usize) -> Result<(), TestCaseError> {
    let first = lower[n_rigid.min(lower.len() - 1)];
    for (j, (lower, upper)) in lower.iter().zip(upper).enumerate().skip(n_rigid) {
        let allowed = rounding(chain, *lower, first);
        prop_assert!(
            *lower <= upper * (1.0 + allowed),
            "eigenvalue {}: {:e} above {:e}, rounding {:e}",
            j,
            lower,
            upper,
            allowed
        );
        // Rounding that allows a thousandth would hide the claim.
        prop_assert!(allowed < 1e-3, "rounding {:e}", allowed);
    }
    Ok(())
}

/// The reduced model as a model of its own: rows without names.
fn as_model(chain: &Chain) -> Model {
    let entries = |a: &Mat<f64>| -> Vec<Entry> {
        let all = (0..a.nrows()).flat_map(|i| (0..a.ncols()).map(move |j| (i, j)));
        all.filter(|&(i, j)| a[(i, j)] != 0.0).map(|(i, j)| (i as u32, j as u32, a[(i, j)])).collect()
    };
    Model {
        n: chain.reduction.n_reduced(),
        stiffness: entries(&chain.reduction.stiffness),
        mass: entries(&chain.reduction.mass),
        nodes: Vec::new(),
        labels: Vec::new(),
        dofs: Vec::new(),
        groups: std::collections::BTreeMap::new(),
    }
}

fn blocks(chain: &Chain, n: usize) -> [Mat<f64>; 2] {
    [&chain.reduction.stiffness, &chain.reduction.mass].map(|a| a.submatrix(0, 0, n, n).to_owned())
}

proptest! {
    #![proptest_config(kept!("projection"))]

    /// P2: full ≤ reduced, and more modes never raise an eigenvalue.
    #[test]
    fn more_modes_never_raise_an_eigenvalue(component in component(), more in 1..=5usize) {
        // A mass that leaves something out raises eigenvalues by that.
        prop_assume!(component.method != Method::Macneal);
        let (model, interfaces) = (component.model(), component.interfaces());
        let fewer = component.reduce();
        let further = reduce(&model, &interfaces, component.method, fewer.modes.count() + more).expect("a component");
        let of = |chain: &Chain| spectrum(chain.reduction.stiffness.as_ref(), chain.reduction.mass.as_ref());
        let (upper, middle) = (of(&fewer), of(&further));
        let full = Twin::new(&model, &interfaces, &fewer.partition).free_spectrum();
        below(&fewer, &full, &middle, component.n_rigid())?;
        below(&fewer, &middle, &upper, component.n_rigid())?;
    }

    /// Statics alone (Guyan) ≥ Craig-Bampton ≥ full: Guyan's matrices are the interface blocks of any of ours.
    #[test]
    fn statics_alone_lie_above_craig_bampton(component in component()) {
        let component = Component { method: Method::CraigBampton, ..component };
        let chain = component.reduce();
        let n_b = chain.partition.n_interface();
        let [k, m] = blocks(&chain, n_b);
        let guyan = spectrum(k.as_ref(), m.as_ref());
        let reduced = spectrum(chain.reduction.stiffness.as_ref(), chain.reduction.mass.as_ref());
        // With no more interface dofs than rigid-body modes nothing elastic is left of it.
        if n_b > component.n_rigid() {
            below(&chain, &reduced, &guyan, component.n_rigid())?;
        }
    }

    /// P13: reducing the reduced model on the same interface with all its modes changes nothing.
    #[test]
    fn reducing_again_with_all_modes_is_the_identity(component in component()) {
        let first = component.reduce();
        let (n_b, n) = (first.partition.n_interface(), first.reduction.n_reduced());
        prop_assume!(n > n_b && component.method != Method::Macneal);
        // K̂ hides the rounding of terms that cancelled when it was made. Where that exceeds a few ε of its low eigenvalues,
        // nothing in the file tells a rigid-body mode from a slow elastic one.
        let lowest = Component::eigenvalues(&first);
        let top = lowest[lowest.len().min(12) - 1] / first.partition.scaling.eigenvalue_unit();
        prop_assume!(EPS * first.constraint.cancellation * stiffest(&first) <= 1e-13 * top);
        let interface: Vec<usize> = (0..n_b).collect();
        let again = reduce(&as_model(&first), &[rows("same", &interface)], Method::CraigBampton, n - n_b);
        let again = again.expect("a reduced model is a model");
        prop_assert_eq!(again.reduction.n_reduced(), n);
        let unit = again.partition.scaling.eigenvalue_unit();
        let before = spectrum(first.reduction.stiffness.as_ref(), first.reduction.mass.as_ref());
        let after = spectrum(again.reduction.stiffness.as_ref(), again.reduction.mass.as_ref());
        for (before, after) in before.iter().zip(&after).skip(component.n_rigid()) {
            let allowed = 2.0 * rounding(&first, *before, before.min(first.modes.lambda[0]));
            let difference = (after * unit / before - 1.0).abs();
            prop_assert!(difference <= allowed, "{:e} became {:e}: {:e}, rounding {:e}", before, after * unit, difference, allowed);
        }
        // Statics: the interface block is copied, because K̂ has no other coupling.
        let scale = again.partition.scaling.stiffness_unit();
        let [expected, _] = blocks(&first, n_b);
        let [found, _] = blocks(&again, n_b);
        let error = (found * faer::Scale(scale) - &expected).norm_max();
        // The correction for rigid-body motion adds what K̂ Û leaves: ε of the terms before they cancelled.
        let terms = (0..n_b).map(|i| *first.partition.stiffness.get(first.partition.n_internal + i, first.partition.n_internal + i).expect("stored"));
        let allowed = 16.0 * first.partition.n_dofs() as f64 * EPS * first.constraint.cancellation * terms.fold(0.0, f64::max);
        prop_assert!(error <= allowed, "K̂_BB is off by {:e}, rounding {:e}", error, allowed);
    }

    /// P3: after the correction the interface carries every rigid-body motion.
    #[test]
    fn the_interface_carries_rigid_body_motion(component in component()) {
        let chain = component.reduce();
        let modes = &chain.constraint.modes;
        let error = supel::constraint::rigid_error(&chain.partition, modes, chain.rigid.orthonormal.as_ref());
        prop_assert!(error.value <= 1e-12, "{:?}", error);
        prop_assert_eq!(chain.rigid.count(), component.n_rigid());
    }
}
