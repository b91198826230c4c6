//! Bodies tied by penalties: whoever looks comes to one conclusion, and where the penalty takes the digits it is named.

use std::collections::BTreeSet;

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::model::Assembler;
use supel_models::transform::join;
use supel_models::{Material, Model, brick};

use crate::place::{Place, supel, warnings_of_reduction};

/// Nodes of one end of the first body, tied to those of the second that lie at the same places.
const TIED: [i64; 4] = [1, 6, 11, 16];
/// Nodes of its other end.
const END: [i64; 4] = [5, 10, 15, 20];

fn body() -> Model {
    brick([4, 1, 1], [4.0, 1.1, 0.9], &Material::UNIT)
}

/// Two equal bodies at one place, their ends tied by springs of this stiffness.
fn tied(penalty: f64) -> Model {
    let joined = join(&body(), &body(), &[]);
    let row =
        |node: i64, direction: u8| joined.dofs.iter().position(|dof| *dof == (node, direction)).expect("a dof") as u32;
    let mut stiffness = Assembler::default();
    stiffness.extend(joined.stiffness.iter().copied());
    for node in TIED {
        for direction in 0..3 {
            let (a, b) = (row(node, direction), row(node + 20, direction));
            for (i, j, value) in [(a, a, penalty), (b, b, penalty), (a, b, -penalty), (b, a, -penalty)] {
                stiffness.add(i, j, value);
            }
        }
    }
    Model { stiffness: stiffness.finish(), ..joined }
}

/// How an interface is chosen in the tied bodies, and in one where the nodes are joined.
const INTERFACES: [(&str, &[i64], &[i64]); 3] = [
    ("interface", &END, &END),
    ("rigid-interface", &END, &END),
    // Both sides of the ties in one patch, of whose stiffness nothing is left in K but its roundings.
    ("rigid-interface", &[1, 6, 11, 16, 21, 26, 31, 36], &TIED),
];

fn flags(method: &str, coupling: &str, nodes: &[i64]) -> String {
    let nodes: Vec<String> = nodes.iter().map(ToString::to_string).collect();
    format!("--{coupling} end={} --method {method} --modes 6", nodes.join(","))
}

/// Frequencies and bars, in Hz.
fn frequencies(report: &Value) -> Vec<[f64; 2]> {
    let modes = report["body"]["reduction"]["modes"].as_array().expect("modes").iter();
    let number = |value: &Value| value.as_f64().expect("a number");
    modes.map(|mode| [number(&mode["frequency_hz"]), number(&mode["error_bar_hz"])]).collect()
}

/// Codes of the warnings of a report.
fn codes(report: &Value) -> BTreeSet<String> {
    warnings_of_reduction(report).into_iter().collect()
}

#[test]
fn reduction_and_both_verifications_conclude_alike_of_penalties_of_any_size() {
    // Stiffnesses of a node are about one.
    let exact = Place::with(&join(&body(), &body(), &TIED.map(|node| (node, node))));
    let mut faults = Vec::new();
    let mut n_verified = 0;
    let ways =
        ["herting", "craig-bampton"].into_iter().flat_map(|method| INTERFACES.map(|interface| (method, interface)));
    for (method, (coupling, nodes, nodes_joined)) in ways {
        exact.reduce(&exact.model_flags(), &flags(method, coupling, nodes_joined)).expect(ExitCode::Done);
        let joined = frequencies(&exact.report("x.report.json"));
        let flags = flags(method, coupling, nodes);
        for exponent in [1, 3, 4, 5, 6, 7, 8, 9, 10, 12] {
            let place = Place::with(&tied(10f64.powi(exponent)));
            let at = format!("{method}, {flags}, 1e{exponent}");
            let ended = place.reduce(&place.model_flags(), &flags);
            if ended.code == ExitCode::Done {
                n_verified += 1;
                let report = place.report("x.report.json");
                if report["body"]["model"]["rigid_body_modes"]["count"] != 6 {
                    faults.push(format!("{at}: not free"));
                }
                let job = place.text("job.json");
                let kept = supel(&["inspect", &place.text("x.supel"), "--job"]).expect(ExitCode::Done).out;
                place.write("job.json", kept.as_bytes());
                for rest in [&[][..], &["--job", &job]] {
                    let file = place.text("x.supel");
                    let verified = supel(&[&["verify", &file, "--quiet"], rest].concat());
                    if verified.code != ExitCode::Done {
                        faults.push(format!("{at}: verified, and then {rest:?}: {}", verified.err));
                    }
                }
                // A spring of a thousand elements in series with the body is no softer than a hundredth of it.
                let off = frequencies(&report)
                    .iter()
                    .zip(&joined)
                    .fold(0.0, |most: f64, (a, b)| most.max(((a[0] - b[0]).abs() - a[1] - b[1]) / b[0]));
                if off > 10.0 / 10f64.powi(exponent) {
                    faults.push(format!("{at}: frequencies off by {off:e}"));
                }
            } else if ended.code == ExitCode::CheckFailed {
                let codes = codes(&place.report("x.report.json"));
                if !codes.contains("W-PENALTY") {
                    faults.push(format!("{at}: fails without a word of the penalty, {codes:?}: {}", ended.err));
                }
            } else if !ended.err.contains("penalty") {
                faults.push(format!("{at}: refused without a word of the penalty: {}", ended.err));
            }
        }
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
    // Up to ten thousand times the stiffness of the bodies nothing is lost that a check asks for.
    assert!(n_verified >= 18, "{n_verified} verified");
}
