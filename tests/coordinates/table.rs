//! Faults × couplings × methods: refused or warned, never verified.

use supel::cli::ExitCode;
use supel_models::Model;

use crate::faults::{FAULTS, FAULTS_OF_DIRECTIONS, UNSEEN, against_rotation, block, clamped, ends};
use crate::place::{Ended, Place, warnings_of_reduction};

/// Methods with their modes.
const METHODS: [&str; 5] =
    ["herting --modes 5", "craig-bampton --modes 5", "rubin --modes 5", "macneal --modes 5", "guyan"];

/// How the two ends of the block are coupled.
const COUPLINGS: [&str; 3] = ["direct", "rigid", "both"];

pub(crate) fn listed(labels: &[i64]) -> String {
    labels.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
}

fn interfaces(model: &Model, coupling: &str) -> String {
    let [first, second] = ends(model).map(|labels| listed(&labels));
    match coupling {
        "direct" => format!("--interface first={first} --interface second={second}"),
        "rigid" => format!("--rigid-interface first={first} --rigid-interface second={second}"),
        _ => format!("--interface first={first} --rigid-interface second={second}"),
    }
}

/// Reduces a model whose interfaces are those of another.
fn reduced(model: &Model, of: &Model, coupling: &str, method: &str) -> (Place, Ended) {
    let place = Place::with(model);
    let rest = format!("{} --method {method} --threads 1", interfaces(of, coupling));
    let ended = place.reduce(&place.model_flags(), &rest);
    (place, ended)
}

/// The code of the refusal, or the warnings of the report.
pub(crate) fn said(place: &Place, ended: &Ended) -> String {
    if let Some(code) = ended.err.strip_prefix("supel: error[").and_then(|rest| rest.split_once(']')) {
        return code.0.to_owned();
    }
    let report = place.report("x.report.json");
    let mut codes = warnings_of_reduction(&report);
    let checks = report["body"]["checks"].as_array().expect("checks");
    let of = |verdict: &str| checks.iter().filter(|check| check["verdict"] == verdict).collect::<Vec<_>>();
    codes.extend(of("fail").iter().map(|check| check["id"].as_str().expect("an id").to_owned()));
    if codes.is_empty() && of("warn").is_empty() {
        assert_eq!(ended.code, ExitCode::Done);
        return "verified".to_owned();
    }
    codes.join(", ")
}

/// What was said of a fault with a coupling and a method.
struct Outcome {
    fault: &'static str,
    coupling: &'static str,
    method: &'static str,
    said: String,
}

/// Every fault with every coupling and method, one after the other.
fn outcomes<'a>(sound: &'a Model, faults: &'a [crate::faults::Fault]) -> impl Iterator<Item = Outcome> + 'a {
    faults.iter().flat_map(move |(fault, make)| {
        let model = make(sound);
        let ways = COUPLINGS.into_iter().flat_map(|coupling| METHODS.map(|method| (coupling, method)));
        ways.map(move |(coupling, method)| {
            let (place, ended) = reduced(&model, sound, coupling, method);
            Outcome { fault, coupling, method, said: said(&place, &ended) }
        })
    })
}

#[track_caller]
fn assert_all(outcomes: impl Iterator<Item = Outcome>, expected: impl Fn(&str) -> bool) {
    for Outcome { fault, coupling, method, said } in outcomes {
        assert!(expected(&said), "{fault}, {coupling}, {method}: {said}");
    }
}

#[test]
fn sound_models_are_verified() {
    for sound in [block(), clamped()] {
        assert_all(outcomes(&sound, &[("none", Clone::clone)]), |said| said == "verified");
    }
}

#[test]
fn wrong_maps_and_coordinates_of_a_free_component() {
    assert_all(outcomes(&block(), FAULTS), |said| said == "E-COORD");
    assert_all(outcomes(&block(), FAULTS_OF_DIRECTIONS), |said| said == "E-COORD");
}

/// Where supports hold every motion, K has no zero modes to count; rows that no support touches show the fault.
#[test]
fn wrong_maps_and_coordinates_of_a_clamped_component() {
    assert_all(outcomes(&clamped(), FAULTS), |said| said == "E-COORD");
}

/// Frames at a few nodes of a clamped component look like one more support to K. The mass tells, unless it is lumped: the same
/// in every frame; then only a patch that ties such a node is told that nothing confirms it. A map that mixes directions makes
/// forces at so many rows that no witness is left.
#[test]
fn directions_of_a_clamped_component() {
    for Outcome { fault, coupling, method, said } in outcomes(&clamped(), FAULTS_OF_DIRECTIONS) {
        let is_told = said.contains("W-MASS-DIRECTION");
        let leaves_no_witness = ["rows ordered direction by direction", "local frames at every fifth node"];
        let is_untested = !leaves_no_witness.contains(&fault) || said.contains("W-COORD-UNTESTED");
        assert!(is_told && is_untested, "{fault}, {coupling}, {method}: {said}");
    }
    let mut lumped = clamped();
    lumped.mass.retain(|(row, col, _)| row == col);
    let at_one_node = &FAULTS_OF_DIRECTIONS[3..];
    assert_eq!(at_one_node[0].0, "a local frame at one node");
    for Outcome { coupling, method, said, .. } in outcomes(&lumped, at_one_node) {
        let expected = if coupling == "direct" { "verified" } else { "W-COORD-UNTESTED" };
        assert_eq!(said, expected, "{coupling}, {method}");
    }
}

#[test]
fn what_nobody_can_see_is_verified_and_documented() {
    assert_all(outcomes(&block(), UNSEEN), |said| said == "verified");
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/what-the-report-proves.md"));
    let page = page.expect("the page");
    for (fault, _) in UNSEEN {
        assert!(page.contains(fault), "{fault}");
    }
}

#[test]
fn rotations_held_without_a_support() {
    let fault: crate::faults::Fault = ("springs against rotation", |model| against_rotation(model, &[0, 1, 2], 1e-3));
    assert_all(outcomes(&block(), &[fault]), |said| said == "E-ROTATIONS-HELD");
}

/// Natural frequencies and their error bars.
fn modes(place: &Place) -> Vec<(f64, f64)> {
    let report = place.report("x.report.json");
    let modes = report["body"]["reduction"]["modes"].as_array().expect("modes").clone();
    let number = |mode: &serde_json::Value, key: &str| mode[key].as_f64().expect("a number");
    modes.iter().map(|mode| (number(mode, "frequency_hz"), number(mode, "error_bar_hz"))).collect()
}

/// Rigid patches tie their nodes by motions that K knows, so that few digits of the coordinates hold nothing.
#[test]
fn rounded_coordinates_change_no_frequency() {
    let sound = supel_models::brick([6, 3, 2], [8.0 / 7.0, 4.0 / 7.0, 2.0 / 7.0], &supel_models::Material::STEEL_SI);
    for coupling in COUPLINGS {
        for method in METHODS[..2].iter().copied() {
            let (exact, ended) = reduced(&sound, &sound, coupling, method);
            assert_eq!(said(&exact, &ended), "verified", "{coupling}, {method}");
            for digits in [12, 5] {
                let mut model = sound.clone();
                let round = |value: &mut f64| *value = format!("{value:.*e}", digits - 1).parse().expect("a number");
                model.nodes.iter_mut().flatten().for_each(round);
                let (place, ended) = reduced(&model, &sound, coupling, method);
                assert_eq!(
                    said(&place, &ended),
                    "W-COORD-ROUNDED",
                    "{coupling}, {method}, {digits} digits: {}",
                    ended.out
                );
                for (mode, reference) in modes(&place).into_iter().zip(modes(&exact)) {
                    // The levers of a patch are those of K to the digits of its zero modes, ten or more.
                    let allowed = mode.1 + reference.1 + 1e-9 * reference.0;
                    assert!(
                        (mode.0 - reference.0).abs() <= allowed,
                        "{coupling}, {method}, {digits} digits: {mode:?} {reference:?}"
                    );
                }
            }
        }
    }
}
