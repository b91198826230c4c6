//! The smallest models, no modes, and counts beyond 32 bits: I-24 to I-26.

use supel::cli::ExitCode;
use supel_models::model::Entry;
use supel_models::{Ends, Inertia, Material, Model, Section, brick, frame, spring, spring_spectrum};

use supel::error::Error;
use supel::verification::check::Verdict;

use super::{CHAIN, assert_done, assert_refused, chain};
use crate::chain::{direct, rows};
use crate::place::{Ended, Place, assert_close, frequencies_hz};
use crate::program::{ALL, Case, lines};

fn reduce(model: &Model, rest: &str) -> (Place, Ended) {
    let place = Place::with(model);
    let flags = if rest.contains("rows:") { place.matrix_flags() } else { place.model_flags() };
    let ended = place.reduce(&flags, &format!("{rest} --threads 1"));
    (place, ended)
}

/// Chains of one, two, three, six and twelve masses, held and free, by both methods.
#[test]
fn i_24_few_masses() {
    for n in [2, 3, 6, 12] {
        for method in ["herting", "craig-bampton"] {
            let (place, ended) =
                reduce(&spring(n, Ends::Free), &format!("--interface end=rows:0 --method {method} --modes 1"));
            assert_done(&place, &ended, &[]);
            let exact = match method {
                "herting" => spring_spectrum(n, Ends::Free)[1],
                // Held at one end: λ = 4 sin²(π / (4(n − 1) + 2)).
                _ => 4.0 * (std::f64::consts::PI / (4 * (n - 1) + 2) as f64).sin().powi(2),
            };
            assert_close(
                &frequencies_hz(&place.superelement("x.supel")),
                &[exact.sqrt() / std::f64::consts::TAU],
                1e-12,
            );
        }
    }
    let (place, ended) = reduce(&spring(2, Ends::Fixed), "--interface end=rows:0 --method herting --modes 5");
    assert_done(&place, &ended, &["W-FEWER-MODES"]);
}

/// The smallest models by every method: a sound superelement of as many coordinates as there are motions, or an error by name.
#[test]
fn i_24_smallest_models_by_every_method() {
    let cube = brick([1, 1, 1], [1.0, 1.0, 1.0], &Material::STEEL_SI);
    let nodes = [[0.0; 3], [1.0, 0.0, 0.0]];
    let beam = frame(&nodes, &[[0, 1]], &Section::round(0.05), &Material::STEEL_SI, Inertia::Consistent);
    let chains = [2, 3, 6, 12].map(|n| (format!("{n} masses"), spring(n, Ends::Free), rows("end", &[0])));
    let solids =
        [("cube".to_owned(), cube, direct("foot", &[1, 2, 3])), ("beam".to_owned(), beam, direct("foot", &[1]))];
    for method in ALL {
        for (name, model, interface) in chains.iter().chain(&solids) {
            let case = Case::new(model, std::slice::from_ref(interface)).method(method).count(2);
            match case.run() {
                Ok(outcome) => {
                    assert_eq!(lines(&outcome, Verdict::Fail), [""; 0], "{name}, {method}");
                    assert!(outcome.report.body.reduction.n_reduced <= model.n, "{name}, {method}");
                }
                Err(error) => {
                    println!("{name}, {method}: {error}");
                    assert!(Error::CODES.iter().any(|entry| entry.code == error.code()), "{name}, {method}: {error}");
                    assert!(error.to_string().contains(" – "), "{name}, {method}: {error}");
                }
            }
        }
    }
}

/// A single mass, held by springs or free: there is nothing to reduce.
#[test]
fn i_24_a_single_mass() {
    let held = spring(1, Ends::Fixed);
    let free = Model { stiffness: vec![(0, 0, 0.0)], ..held.clone() };
    for model in [&held, &free] {
        let (place, ended) = reduce(model, "--interface end=rows:0 --method herting --modes 1");
        // Nothing is inside: the matrices are kept as they are.
        assert!(place.path("x.supel").exists(), "{}{}", ended.out, ended.err);
    }
    let (place, ended) = reduce(&held, "--interface end=rows:1 --method herting --modes 1");
    assert_refused(&place, &ended, "E-INTERFACE-ROW", &["row 1 does not exist", "expected one of 0 to 0"]);
}

/// K = 0: every motion is rigid, none is elastic, and the interface holds one of three.
#[test]
fn i_24_no_stiffness_at_all() {
    let model = spring(3, Ends::Free);
    let zeros: Vec<Entry> = model.stiffness.iter().map(|&(row, col, _)| (row, col, 0.0)).collect();
    for stiffness in [zeros, Vec::new()] {
        let model = Model { stiffness, ..model.clone() };
        let (place, ended) = reduce(&model, "--interface end=rows:0 --method herting --modes 1");
        assert_refused(&place, &ended, "E-INTERFACE-RANK", &["only 1 of the 3 rigid-body motions"]);
    }
}

/// One element: eight nodes of a solid, two of a beam.
#[test]
fn i_24_a_single_element() {
    let cube = brick([1, 1, 1], [1.0, 1.0, 1.0], &Material::STEEL_SI);
    let nodes = [[0.0; 3], [1.0, 0.0, 0.0]];
    let beam = frame(&nodes, &[[0, 1]], &Section::round(0.05), &Material::STEEL_SI, Inertia::Consistent);
    for (model, interface) in [(cube, "1,2,3"), (beam, "1")] {
        for method in ["herting", "craig-bampton"] {
            let (place, ended) = reduce(&model, &format!("--interface foot={interface} --method {method} --modes 2"));
            assert_done(&place, &ended, &[]);
            assert_eq!(place.superelement("x.supel").n_rigid(), 6);
        }
    }
}

/// No modes: Guyan's condensation, exact in statics. A chain of unit springs between its ends is one spring of 1/(n − 1).
#[test]
fn i_25_no_modes_at_all() {
    let place = chain();
    let ended = place.reduce(&place.matrix_flags(), &CHAIN.replace("--modes 1", "--modes 0"));
    assert_done(&place, &ended, &[]);
    let superelement = place.superelement("x.supel");
    let tensors = superelement.tensors();
    assert_eq!((tensors.frequencies.len(), tensors.stiffness.rows()), (0, 2));
    for (i, j, exact) in [(0, 0, 0.25), (0, 1, -0.25), (1, 1, 0.25)] {
        // Four pivots, each rounded once.
        assert!((tensors.stiffness[(i, j)] - exact).abs() <= 4.0 * f64::EPSILON, "{}", tensors.stiffness[(i, j)]);
    }
    let mass: f64 = [(0, 0), (0, 1), (1, 0), (1, 1)].iter().map(|at| tensors.mass[*at]).sum();
    assert!((mass - 5.0).abs() <= 20.0 * f64::EPSILON, "{mass}");
}

#[test]
fn i_25_bands_that_are_none() {
    let place = chain();
    for (key, code) in [
        ("up_to_hz = -1.0", "E-ARG"),
        ("up_to_hz = 0.0", "E-ARG"),
        ("up_to_hz = nan", "E-ARG"),
        ("up_to_hz = inf", "E-ARG"),
        ("count = -1", "E-JOB"),
        ("count = 1.5", "E-JOB"),
        ("count = 1, up_to_hz = 5.0", "E-JOB"),
    ] {
        let job = super::chain_job_with("\"K.mtx\"", key);
        place.write("job.toml", job.as_bytes());
        assert_refused(&place, &crate::place::supel(&["reduce", &place.text("job.toml")]), code, &["expected"]);
    }
    for flags in ["--up-to-hz -1", "--up-to-hz nan", "--modes -1", "--modes 99999999999999999999"] {
        let ended = place.reduce(&place.matrix_flags(), &CHAIN.replace("--modes 1", flags));
        assert_eq!(ended.code, ExitCode::Usage, "{flags}: {}{}", ended.out, ended.err);
        assert!(ended.err.starts_with("supel: error[E-"), "{}", ended.err);
    }
    // More modes than there are: all of them, and a warning.
    let ended = place.reduce(&place.matrix_flags(), &CHAIN.replace("--modes 1", "--modes 18446744073709551615"));
    assert_done(&place, &ended, &["W-FEWER-MODES"]);
    assert_eq!(place.superelement("x.supel").tensors().frequencies.len(), 3);
}
