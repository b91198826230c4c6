//! What is asked for: counts, bands, nothing.

use supel::eigen::Wanted;
use supel_models::*;

use crate::chain::certified::eigensolvers;
use crate::component::Component;

/// Number of modes a band gives, in user units of λ.
fn in_band(component: &Component, limit: f64) -> Vec<usize> {
    let wanted = Wanted::UpTo(limit / component.unit());
    eigensolvers().iter().map(|eigensolver| component.modes(wanted, *eigensolver).count()).collect()
}

#[test]
fn band_holds_all_modes_up_to_its_edge() {
    let exact = bar_spectrum(200);
    let component = Component::new(&bar(200));
    for count in [1, 15, 16, 17, 33, 70] {
        let between = 0.5 * (exact[count - 1] + exact[count]);
        assert!(in_band(&component, between).iter().all(|found| *found == count), "{count} modes below {between}");
    }
}

#[test]
fn edge_is_closed_to_the_gap_of_a_cluster() {
    // A mode within 1e-6 of the edge, above or below, belongs to the band; rounding at 1e-12 never decides.
    let exact = bar_spectrum(200);
    let component = Component::new(&bar(200));
    for (edge, count) in [(1.0 + 1e-9, 10), (1.0, 10), (1.0 - 1e-9, 10), (1.0 - 2e-6, 9)] {
        let edge = exact[9] * edge;
        assert!(in_band(&component, edge).iter().all(|found| *found == count), "edge {edge}");
    }
}

#[test]
fn edge_inside_a_pair_takes_both() {
    let exact = ring_spectrum(240, 0.01);
    let component = Component::new(&ring(240, 0.01));
    for edge in [1.0 - 1e-9, 1.0, 1.0 + 1e-9] {
        assert!(in_band(&component, exact[7] * edge).iter().all(|found| *found == 9));
    }
}

#[test]
fn empty_band_gives_no_modes_and_the_next() {
    let exact = bar_spectrum(200);
    let component = Component::new(&bar(200));
    for &eigensolver in eigensolvers() {
        for wanted in [Wanted::UpTo(0.5 * exact[0] / component.unit()), Wanted::Count(0), Wanted::UpTo(0.0)] {
            let modes = component.modes(wanted, eigensolver);
            assert_eq!((modes.count(), modes.shapes.ncols()), (0, 0), "{eigensolver:?}");
            let next = modes.next.expect("a next eigenvalue") * component.unit();
            assert!((next / exact[0] - 1.0).abs() < 1e-7, "{eigensolver:?}: {next}");
        }
    }
}

#[test]
fn band_above_the_spectrum_holds_it_all() {
    for n in [1, 2, 5, 30] {
        let component = Component::new(&spring(n, Ends::Fixed));
        // The largest eigenvalue of a spring chain is below four.
        assert!(in_band(&component, 5.0).iter().all(|found| *found == n), "n = {n}");
    }
    let free = Component::new(&spring(30, Ends::Free));
    assert!(in_band(&free, 5.0).iter().all(|found| *found == 29));
}

#[test]
fn same_request_gives_the_same_bits() {
    let component = Component::new(&membrane([10, 6], [5.0, 3.0], &Material::UNIT));
    let first = component.modes(Wanted::Count(15), supel::job::Eigensolver::Lanczos);
    let second = component.modes(Wanted::Count(15), supel::job::Eigensolver::Lanczos);
    assert!(first.shapes == second.shapes && first.lambda == second.lambda && first.work == second.work);
}

/// A basis for eight modes has no room for them all until it is seen that they are one cluster.
#[test]
fn count_that_ends_in_a_wide_cluster_takes_all_of_it() {
    let mut lambda = vec![1.0];
    lambda.extend((0..72).map(|i| 2.0 * (1.0 + 1.4e-10 * f64::from(i))));
    lambda.extend((0..400).map(|i| 3.0 + f64::from(i)));
    let component = Component::new(&known(&lambda, 5));
    for count in [2, 4, 8, 40] {
        assert_eq!(component.modes(Wanted::Count(count), supel::job::Eigensolver::Lanczos).count(), 73, "{count}");
    }
}

/// Chains of eight eigenvalues whose neighbours are nearer than a cluster is wide, a hundred million times above the others: a search
/// for modes inside a chain ends at its first gap and knows the next eigenvalue, though its space comes to an end before.
#[test]
fn chain_far_above_the_others_ends_at_its_first_gap() {
    let mut lambda: Vec<f64> = (1..=40).map(|i| 1e-3 * f64::from(i * i)).collect();
    let mut value = 1e5;
    for at in 0..40 {
        lambda.push(value);
        value *= 1.0 + if at % 8 == 7 { 3e-6 } else { 1e-7 };
    }
    let component = Component::new(&known(&lambda, 5));
    for (count, expected) in [(41, 48), (48, 48), (49, 56), (70, 72), (73, 80)] {
        let modes = component.modes(Wanted::Count(count), supel::job::Eigensolver::Lanczos);
        assert_eq!(modes.count(), expected, "{count}");
        assert_eq!(modes.next.is_some(), expected < 80, "{count}: {:?}", modes.next);
        for (found, exact) in modes.lambda.iter().zip(&lambda) {
            // The cancelling terms of this matrix are a few times its λ at the top, and 10⁸ times at the bottom.
            let terms = (1e5 / exact).max(1e2);
            assert!((found * component.unit() / exact - 1.0).abs() <= terms * f64::EPSILON, "{found} for {exact}");
        }
    }
}
