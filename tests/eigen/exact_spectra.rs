//! Families whose eigenvalues are known in closed form or chosen.

use supel::eigen::Wanted;
use supel_models::*;

use crate::chain::certified::eigensolvers;
use crate::component::Component;

/// Whether every eigensolver finds the lowest `count` of an exact spectrum.
fn finds_lowest(model: &Model, exact: &[f64], counts: &[usize]) {
    let component = Component::new(model);
    for &eigensolver in eigensolvers() {
        for &count in counts {
            let modes = component.modes(Wanted::Count(count), eigensolver);
            component.assert_lambda(&modes, &exact[..count]);
            let next = modes.next.expect("a next eigenvalue") * component.unit();
            // The pair beyond is found to a residual of 1e-4, its eigenvalue to the square of that.
            assert!((next / exact[count] - 1.0).abs() < 1e-7, "{eigensolver:?}: next {next}, exact {}", exact[count]);
        }
    }
}

#[test]
fn bar_spectrum_is_found() {
    finds_lowest(&bar(200), &bar_spectrum(200), &[0, 1, 2, 7, 20, 60]);
}

#[test]
fn spring_spectra_are_found() {
    finds_lowest(&spring(150, Ends::Fixed), &spring_spectrum(150, Ends::Fixed), &[1, 10, 40]);
    finds_lowest(&spring(150, Ends::Free), &spring_spectrum(150, Ends::Free)[1..], &[1, 10, 40]);
}

#[test]
fn double_eigenvalues_of_a_ring_come_in_pairs() {
    let exact = ring_spectrum(240, 0.01);
    finds_lowest(&ring(240, 0.01), &exact, &[1, 3, 21, 41]);
    let component = Component::new(&ring(240, 0.01));
    for &eigensolver in eigensolvers() {
        for cut in [2, 8, 20, 40] {
            let modes = component.modes(Wanted::Count(cut), eigensolver);
            component.assert_lambda(&modes, &exact[..cut + 1]);
        }
    }
}

/// Ten simple eigenvalues, one of the given multiplicity, then simple ones up to n.
fn with_cluster(multiplicity: usize, n: usize) -> Vec<f64> {
    let mut lambda: Vec<f64> = (1..=10).map(f64::from).collect();
    lambda.extend(vec![20.0; multiplicity]);
    lambda.extend((0..n - 10 - multiplicity).map(|i| 30.0 + 3.0 * i as f64));
    lambda
}

#[test]
fn clusters_are_completed_whatever_their_multiplicity() {
    for multiplicity in [2, 3, 4, 5, 6, 13, 20] {
        let exact = with_cluster(multiplicity, 160);
        let component = Component::new(&known(&exact, fnv1a("cluster")));
        for &eigensolver in eigensolvers() {
            for count in [10, 11, 10 + multiplicity, 13 + multiplicity] {
                let whole = if count == 11 { 10 + multiplicity } else { count };
                let modes = component.modes(Wanted::Count(count), eigensolver);
                assert_known(&component, &modes.lambda, &exact[..whole]);
            }
        }
    }
}

/// K of a chosen spectrum is rounded in units of its largest eigenvalue, and cond(C)² is below 100.
fn assert_known(component: &Component, lambda: &[f64], exact: &[f64]) {
    assert_eq!(lambda.len(), exact.len(), "{lambda:?}");
    for (lambda, exact) in lambda.iter().zip(exact) {
        let lambda = lambda * component.unit();
        assert!((lambda - exact).abs() <= 500.0 * 100.0 * f64::EPSILON, "{lambda} for {exact}");
    }
}

#[test]
fn near_multiple_eigenvalues_within_the_cluster_gap_stay_together() {
    let mut exact: Vec<f64> = (1..=10).map(f64::from).collect();
    exact.extend([20.0, 20.0 + 1e-9, 20.0 + 2e-9]);
    exact.extend((0..100).map(|i| 30.0 + f64::from(i)));
    let component = Component::new(&known(&exact, fnv1a("near")));
    for &eigensolver in eigensolvers() {
        let modes = component.modes(Wanted::Count(11), eigensolver);
        assert_known(&component, &modes.lambda, &exact[..13]);
    }
}

#[test]
fn more_modes_than_there_are_gives_them_all() {
    for n in [1, 2, 3, 6, 12] {
        let exact = bar_spectrum(n);
        let component = Component::new(&bar(n));
        for &eigensolver in eigensolvers() {
            for count in [n.saturating_sub(1), n, n + 5] {
                let modes = component.modes(Wanted::Count(count), eigensolver);
                component.assert_lambda(&modes, &exact[..count.min(n)]);
                assert_eq!(modes.next.is_some(), count < n, "{eigensolver:?}: {count} of {n}");
            }
        }
    }
}

#[test]
fn units_do_not_matter() {
    let exact: Vec<f64> = bar_spectrum(80).iter().map(|lambda| lambda * 1e24).collect();
    finds_lowest(&transform::scaled(&bar(80), 1e12, 1e-12), &exact, &[5]);
}

#[test]
fn powers_of_two_change_no_bit() {
    let model = brick([4, 2, 2], [4.0, 2.0, 1.0], &Material::UNIT);
    let reference = Component::new(&model);
    for (of_stiffness, of_mass) in [(3, -7), (40, 1), (-60, 33)] {
        let scaled = transform::scaled(&model, 2f64.powi(of_stiffness), 2f64.powi(of_mass));
        let component = Component::new(&scaled);
        for &eigensolver in eigensolvers() {
            let expected = reference.modes(Wanted::Count(8), eigensolver);
            let modes = component.modes(Wanted::Count(8), eigensolver);
            assert_eq!(modes.lambda, expected.lambda, "{eigensolver:?}");
            assert_eq!(modes.shapes, expected.shapes, "{eigensolver:?}");
            assert_eq!(component.unit(), reference.unit() * 2f64.powi(of_stiffness - of_mass));
        }
    }
}

/// Two eigenvalues a few roundings apart are printed as their mean, whose bar reaches both.
#[test]
fn nearly_double_eigenvalues_lie_within_their_bar() {
    let of_spectrum = |exact: &[f64]| {
        let diagonal = |values: &[f64]| (0..).zip(values).map(|(i, value)| (i, i, *value)).collect();
        let (stiffness, mass) = (diagonal(exact), diagonal(&vec![1.0; exact.len()]));
        Model { stiffness, mass, ..known(exact, fnv1a("double")) }
    };
    for n_ulps in [1.0, 4.0, 7.0, 8.0, 20.0] {
        let mut exact: Vec<f64> = (0..60).map(|i| 1.0 + 3.0 * f64::from(i)).collect();
        exact.insert(1, 1.0 + n_ulps * f64::EPSILON);
        let component = Component::new(&of_spectrum(&exact));
        for &eigensolver in eigensolvers() {
            let modes = component.modes(Wanted::Count(2), eigensolver);
            for (j, exact) in exact.iter().enumerate().take(2) {
                let (found, bar) = (modes.lambda[j] * component.unit(), modes.errors[j].relative_bar);
                let error = (found / exact - 1.0).abs();
                assert!(error <= bar, "{eigensolver:?}, {n_ulps} ulps: {found:e} is off by {error:e}, bar {bar:e}");
            }
        }
    }
}
