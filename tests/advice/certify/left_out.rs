//! Superelements that lost one of the modes they are made of: static columns make up for most of its shape, and not for its frequency.

use faer::Mat;
use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::{Model, brick};
use supel_testing::pencil::{eigen, matrices, part};

use super::superelement::{Foreign, document};
use super::{assert_near, verdict};

/// A free bar of square section, with bending modes in pairs.
fn bar() -> Model {
    brick([5, 1, 1], [1.0, 0.1, 0.1], &supel_models::Material::STEEL_SI)
}

/// All dofs of both ends.
fn ends() -> Vec<usize> {
    let nodes = bar().nodes;
    let is_end = |node: &usize| [0.0, 1.0].contains(&nodes[*node][0]);
    (0..nodes.len()).filter(is_end).flat_map(|node| 3 * node..3 * node + 3).collect()
}

/// Frequencies with both ends held, in Hz, by dense algebra.
fn held_hz() -> Vec<f64> {
    let [k, m] = matrices(&bar());
    let ends = ends();
    let inner: Vec<usize> = (0..k.nrows()).filter(|row| !ends.contains(row)).collect();
    let (lambda, _) = eigen(part(k.as_ref(), &inner).as_ref(), part(m.as_ref(), &inner).as_ref(), 1e6);
    lambda.into_iter().map(|lambda| lambda.sqrt() / std::f64::consts::TAU).collect()
}

fn without(right: &Foreign, column: usize) -> Foreign {
    let basis = &right.basis;
    let kept = Mat::from_fn(basis.nrows(), basis.ncols() - 1, |i, j| basis[(i, if j < column { j } else { j + 1 })]);
    Foreign::of(&bar(), kept)
}

/// What a check says of its worst place.
fn told(document: &Value, id: &str) -> String {
    let checks = document["checks"].as_array().expect("checks");
    let check = checks.iter().find(|check| check["id"] == id).unwrap_or_else(|| panic!("{id}: {document}"));
    check["worst"].as_str().unwrap_or_default().to_owned()
}

/// The first number of a text.
fn number(text: &str) -> f64 {
    text.split_whitespace().find_map(|word| word.parse().ok()).unwrap_or_else(|| panic!("no number in {text}"))
}

const N_MODES: usize = 9;

#[test]
fn a_lost_mode_fails_and_is_the_one_that_is_named() {
    let right = Foreign::craig_bampton(&bar(), &ends(), N_MODES);
    let found = document(&bar(), &right, ExitCode::Done);
    assert_eq!(verdict(&found, "C-12"), Some("pass"), "{found}");
    assert!(told(&found, "C-12").contains("9 modes with the interface held"), "{found}");
    let held = held_hz();
    // One of the first pair, and one of the second.
    for lost in [0, 3] {
        let found = document(&bar(), &without(&right, lost), ExitCode::CheckFailed);
        assert_eq!(verdict(&found, "C-12"), Some("fail"), "{found}");
        assert_near(number(&told(&found, "C-12")), held[lost], 1e-5);
        // The component's own mode that suffers is a bending mode: its twin is right, and no mode above them is blamed.
        let frequencies = found["free"]["frequencies"].as_array().expect("pairs");
        let pair = |key: &str| -> Vec<f64> {
            frequencies.iter().map(|pair| pair[key].as_f64().unwrap_or(f64::INFINITY)).collect()
        };
        let (full, off) = (pair("full_hz"), pair("relative_difference"));
        let worst =
            (0..full.len()).filter(|at| frequencies[*at]["in_band"] == true).max_by(|a, b| off[*a].total_cmp(&off[*b]));
        let worst = worst.expect("a pair");
        assert!(off[worst] > 0.1, "{found}");
        let twin =
            [worst.wrapping_sub(1), worst + 1].into_iter().find(|at| (full[*at] / full[worst] - 1.0).abs() < 1e-6);
        assert!(off[twin.expect("a twin")] < 1e-2, "{found}");
        assert!(told(&found, "C-08").contains(&format!("elastic mode {} at", worst + 1)), "{found}");
        let others = (0..full.len()).filter(|at| *at != worst && frequencies[*at]["in_band"] == true);
        assert!(others.into_iter().all(|at| off[at] < 0.1), "{found}");
    }
}

/// What an eigensolver that stops early leaves of other modes in one makes its frequency wrong by the square of that: the mode is there.
#[test]
fn a_mode_with_a_share_of_another_is_not_left_out() {
    let right = Foreign::craig_bampton(&bar(), &ends(), N_MODES);
    let more = Foreign::craig_bampton(&bar(), &ends(), 4 * N_MODES);
    for share in [1e-6, 1e-5, 1e-4, 1e-3] {
        let mut basis = right.basis.clone();
        (0..basis.nrows()).for_each(|row| basis[(row, 2)] += share * more.basis[(row, 4 * N_MODES - 1)]);
        let found = document(&bar(), &Foreign::of(&bar(), basis), ExitCode::Done);
        assert_eq!(verdict(&found, "C-12"), Some("pass"), "{share}: {found}");
        assert!(told(&found, "C-12").contains("9 modes with the interface held"), "{share}: {found}");
    }
}

#[test]
fn modes_of_few_digits_are_not_left_out() {
    let right = Foreign::craig_bampton(&bar(), &ends(), N_MODES);
    for digits in 3..=7 {
        let rounded = |value: f64| format!("{value:.*e}", digits - 1).parse().expect("a number");
        let of = |right: &Foreign| {
            Mat::from_fn(right.basis.nrows(), right.basis.ncols(), |i, j| rounded(right.basis[(i, j)]))
        };
        let found = document(&bar(), &Foreign { basis: of(&right), ..right.clone() }, ExitCode::Done);
        assert_eq!(verdict(&found, "C-12"), Some("pass"), "{digits} digits: {found}");
        // And so are the comparisons at its interface.
        assert_ne!(verdict(&found, "M-33"), Some("warn"), "{digits} digits: {found}");
        // A lost one is told in few digits, too.
        let lost = without(&right, 3);
        let found = document(&bar(), &Foreign { basis: of(&lost), ..lost }, ExitCode::CheckFailed);
        assert_eq!(verdict(&found, "C-12"), Some("fail"), "{digits} digits: {found}");
    }
}

/// Modes that nobody needs may be left out, and few modes are no lost ones.
#[test]
fn what_is_left_out_on_purpose_is_a_warning_and_what_is_coarse_none() {
    let right = Foreign::craig_bampton(&bar(), &ends(), N_MODES);
    let found = document(&bar(), &without(&right, 6), ExitCode::Done);
    assert_eq!(verdict(&found, "C-12"), Some("warn"), "{found}");
    let one_node: Vec<usize> = (0..9).collect();
    let coarse = Foreign::craig_bampton(&bar(), &one_node, 3);
    let found = document(&bar(), &coarse, ExitCode::Done);
    assert_eq!((verdict(&found, "C-12"), verdict(&found, "C-08")), (Some("pass"), Some("warn")), "{found}");
}

/// Free modes next to static columns, as of Herting's method.
#[test]
fn a_lost_mode_of_the_free_component_is_named() {
    let statics = Foreign::craig_bampton(&bar(), &ends(), 0);
    let [k, m] = matrices(&bar());
    let (lambda, shapes) = eigen(k.as_ref(), m.as_ref(), 1e6);
    let (model, rows) = (bar(), ends());
    let of_modes = |modes: &[usize]| {
        // Modes at rest at the interface: less the static answer to their motion there.
        let at_rest = |i: usize, mode: usize| {
            let statics = rows.iter().enumerate().map(|(at, row)| statics.basis[(i, at)] * shapes[(*row, mode)]);
            shapes[(i, mode)] - statics.sum::<f64>()
        };
        let basis = Mat::from_fn(model.n, modes.len() + rows.len(), |i, j| match modes.get(j) {
            Some(mode) => at_rest(i, *mode),
            None => statics.basis[(i, j - modes.len())],
        });
        Foreign::of(&model, basis)
    };
    let all: Vec<usize> = (6..6 + N_MODES).collect();
    let found = document(&bar(), &of_modes(&all), ExitCode::Done);
    assert!(told(&found, "C-12").contains("9 modes of the free component"), "{found}");
    let lost: Vec<usize> = all.iter().copied().filter(|mode| *mode != 9).collect();
    let found = document(&bar(), &of_modes(&lost), ExitCode::CheckFailed);
    assert_eq!(verdict(&found, "C-12"), Some("fail"), "{found}");
    assert_near(number(&told(&found, "C-12")), lambda[9].sqrt() / std::f64::consts::TAU, 1e-5);
}
