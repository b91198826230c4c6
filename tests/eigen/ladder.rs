//! What happens when modes are lost on the way: another start, slices of the band, an error with both numbers.

use std::sync::atomic::{AtomicUsize, Ordering};

use supel::eigen::{Interval, Modes};
use supel::error::{Error, ErrorClass};
use supel::job::{Boundary, Certify, Eigensolver};
use supel::modes::{Mending, ModeSource, Search, certified};
use supel::random::SEED;
use supel_models::*;

use crate::chain::certified::{Certified, count, free, held, judge, mixed, with_component, with_component_of};
use crate::chain::direct;

/// A search that loses one mode as often as it is told to.
struct Forgetful<'a> {
    search: &'a Search<'a>,
    /// The mode that is lost, from zero.
    loses: usize,
    /// Searches from the start that lose it.
    starts: AtomicUsize,
    /// Searches of a slice that find nothing.
    slices: AtomicUsize,
}

impl Forgetful<'_> {
    fn loses_again(times: &AtomicUsize) -> bool {
        times.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1)).is_ok()
    }
}

impl ModeSource for Forgetful<'_> {
    fn lowest(&self, seed: u64) -> Result<Modes, Error> {
        let modes = self.search.lowest(seed)?;
        Ok(if Self::loses_again(&self.starts) { modes.without(self.loses) } else { modes })
    }

    fn between(&self, interval: Interval, known: &Modes, seed: u64) -> Result<Modes, Error> {
        let modes = self.search.between(interval, known, seed)?;
        Ok(if Self::loses_again(&self.slices) { Modes::none(modes.shapes.nrows()) } else { modes })
    }
}

/// Loses a mode so many times from the start and so many times in a slice; the modes and how they were mended.
fn lose(model: &Model, boundary: Boundary, loses: usize, times: (usize, usize)) -> Result<(Vec<f64>, Mending), Error> {
    let (interfaces, job) = match boundary {
        Boundary::FreeInterface => (vec![direct("ends", &[1, 2, 4, 7])], free(count(12), Eigensolver::Lanczos)),
        Boundary::FixedInterface => (Vec::new(), held(count(12), Eigensolver::Lanczos)),
        // One node is held, about which the component turns.
        Boundary::MixedInterface => {
            let interfaces = vec![direct("pivot", &[1]), direct("ends", &[2, 4, 7])];
            (interfaces, mixed(&["pivot"], count(12), Eigensolver::Lanczos))
        }
    };
    with_component_of(model, &interfaces, &job, |component| {
        let search = Search::new(component, &job)?;
        let source = Forgetful { search: &search, loses, starts: times.0.into(), slices: times.1.into() };
        let found = source.lowest(SEED)?;
        let (modes, certificate) = certified(&source, &search.problem, found, search.edge(), Certify::Count)?;
        let certificate = certificate.expect("a count was asked for");
        let mending = certificate.mending;
        let certified = judge(&search, modes, certificate);
        // A mode found in a slice is made orthogonal to all the others.
        assert!(certified.orthogonality <= 1e-11, "{:e}", certified.orthogonality);
        Ok((certified.lambda, mending))
    })
}

#[test]
fn each_rung_of_the_ladder_finds_what_the_one_before_has_lost() {
    for (model, boundary) in [
        (brick([5, 2, 2], [5.0, 2.0, 1.5], &Material::UNIT), Boundary::FreeInterface),
        (brick([5, 2, 2], [5.0, 2.0, 1.5], &Material::UNIT), Boundary::MixedInterface),
        (bar(120), Boundary::FixedInterface),
        (known(&(1..=90).map(f64::from).collect::<Vec<_>>(), fnv1a("ladder")), Boundary::FixedInterface),
    ] {
        let (reference, mending) = lose(&model, boundary, 0, (0, 0)).expect("all modes");
        assert_eq!(mending, Mending::None);
        for loses in [0, 5, 10] {
            for (times, expected) in [((1, 0), Mending::Restart), ((2, 0), Mending::Slices), ((2, 3), Mending::Slices)]
            {
                let (lambda, mending) = lose(&model, boundary, loses, times).expect("all modes");
                assert_eq!(mending, expected, "mode {loses} lost {times:?} times");
                for (lambda, reference) in lambda.iter().zip(&reference) {
                    // Both are Rayleigh quotients of vectors to a residual of 1e-13; κ of these models is below 1e5.
                    assert!((lambda / reference - 1.0).abs() <= 1e-10, "{lambda} for {reference}");
                }
            }
        }
    }
}

/// A search with a count between its sixth mode and the seventh, whose modes are changed.
struct Changed<'a, F> {
    search: &'a Search<'a>,
    change: F,
}

impl<F: Fn(Modes, u64) -> Modes + Sync> ModeSource for Changed<'_, F> {
    fn lowest(&self, seed: u64) -> Result<Modes, Error> {
        let mut modes = self.search.lowest(seed)?;
        modes.counts.push(self.search.problem.count_below(0.5 * (modes.lambda[5] + modes.lambda[6]))?);
        Ok((self.change)(modes, seed))
    }

    fn between(&self, interval: Interval, known: &Modes, seed: u64) -> Result<Modes, Error> {
        self.search.between(interval, known, seed)
    }
}

/// Twelve modes of a held model whose search is changed so, in two intervals that were mended as expected.
fn mended(model: &Model, change: impl Fn(Modes, u64) -> Modes + Sync, expected: Mending) -> Certified {
    with_component(model, &[], |component| {
        let search = Search::new(component, &held(count(12), Eigensolver::Lanczos))?;
        let source = Changed { search: &search, change };
        let found = source.lowest(SEED)?;
        let (modes, certificate) = certified(&source, &search.problem, found, search.edge(), Certify::Count)?;
        let certificate = certificate.expect("a count was asked for");
        assert_eq!((certificate.mending, certificate.intervals.len()), (expected, 2));
        Ok(judge(&search, modes, certificate))
    })
    .expect("certified")
}

/// A mode missing below a count and one too many above it: the total is right and the intervals are not.
#[test]
fn a_mode_too_many_does_not_hide_one_that_is_missing() {
    let swap = |modes: Modes, seed: u64| {
        if seed != SEED {
            return modes;
        }
        let last = modes.count() - 1;
        let copy = Modes {
            lambda: vec![modes.lambda[last]],
            errors: vec![modes.errors[last]],
            shapes: modes.shapes.as_ref().subcols(last, 1).to_owned(),
            ..Modes::none(modes.shapes.nrows())
        };
        modes.without(2).joined([copy])
    };
    mended(&bar(120), swap, Mending::Restart).assert_lambda(&bar_spectrum(120)[..12]);
}

/// Modes on either side of a count, nearer to each other than to any other, are found in slices of their own: rounding of 1e-16 over a
/// gap of 2e-6 leaves them orthogonal to 5e-11 alone, unless the second is made so.
#[test]
fn modes_of_slices_that_touch_are_orthogonal() {
    let mut exact: Vec<f64> = (1..=90).map(f64::from).collect();
    exact[6] = 6.0 * (1.0 + 2e-6);
    let certified = mended(&known(&exact, fnv1a("torn")), |modes, _| modes.without(6).without(5), Mending::Slices);
    // Rounding of a product of vectors of 90 numbers, some twenty times.
    assert!(certified.orthogonality <= 4e-13, "{:e}", certified.orthogonality);
    certified.assert_known(&exact[..12], 90.0);
}

#[test]
fn modes_that_nothing_finds_are_an_error_with_both_numbers() {
    let model = brick([5, 2, 2], [5.0, 2.0, 1.5], &Material::UNIT);
    let error = lose(&model, Boundary::FreeInterface, 4, (usize::MAX, usize::MAX)).expect_err("a mode is missing");
    // Six rigid-body modes and twelve elastic ones; the interval given up may end below the last of them.
    let Error::ModesMissing { found, counted, .. } = error else { panic!("{error}") };
    assert_eq!(counted, found + 1);
    assert_eq!(error.class(), ErrorClass::NumericalLimit);
    assert!(error.to_string().contains("neither another start nor slices"), "{error}");
}
