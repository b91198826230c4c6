//! mAEWing1: an aircraft as MSC Nastran punched it, with ten digits and rows without mass, against its own f06.
//!
//! Ten digits of K are worth little here: rounding alone turns rigid-body motions into frequencies of up to 1 Hz, below a
//! first elastic mode of 8 Hz. The report has to say so, and every frequency has to lie within its own error bar.

use std::io::Read;
use std::path::Path;

use serde_json::Value;
use supel::cli::ExitCode;

use crate::corpus;
use crate::place::{Place, supel};

const FOLDER: &str = "nastran_pch_mAEWing1_FEMv5p1";
/// Roots of the wings, left and right of the body.
const WING_ROOTS: &str = "roots=1010,2010";
const N_MODES: usize = 14;

/// The natural frequencies in Hz of the f06, zero modes included: `mode, order, eigenvalue, radians, cycles, …`.
fn frequencies_of_f06(path: &Path) -> Vec<f64> {
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).expect("the f06");
    flate2::read::GzDecoder::new(file).read_to_end(&mut bytes).expect("a gzip file");
    let text = String::from_utf8_lossy(&bytes);
    let mut cycles: Vec<f64> = Vec::new();
    for table in text.split("R E A L   E I G E N V A L U E S").skip(1) {
        // Two lines of headings follow the title; a page break ends the table.
        for line in table.lines().skip(3) {
            let words: Vec<&str> = line.split_whitespace().collect();
            match (words.first().and_then(|word| word.parse::<usize>().ok()), words.len()) {
                (Some(mode), 7) if mode == cycles.len() + 1 => cycles.push(words[4].parse().expect("a frequency")),
                _ => break,
            }
        }
    }
    cycles
}

/// Reduces on the wing roots and gives back the body of the report.
fn reduced(pairs: &Path, method: &str) -> Value {
    let folder = pairs.join(FOLDER);
    let place = Place::new();
    let path = |name: &str| folder.join(name).display().to_string();
    let output = place.text("wing.supel");
    let ended = supel(&[
        "reduce",
        "--stiffness",
        &path("K.mtx"),
        "--mass",
        &path("M.mtx"),
        "--dofs",
        &path("dof.csv"),
        "--interface",
        WING_ROOTS,
        "--method",
        method,
        "--modes",
        &N_MODES.to_string(),
        "--output",
        &output,
    ]);
    ended.expect(ExitCode::Done);
    assert!(place.path("wing.supel").exists());
    place.report("wing.report.json")["body"].clone()
}

fn warned(body: &Value) -> Vec<String> {
    let checks = body["checks"].as_array().expect("checks");
    let warned = checks.iter().filter(|check| check["verdict"] != "pass" && check["verdict"] != "info");
    warned.map(|check| format!("{} {}", check["id"].as_str().expect("an id"), check["name"])).collect()
}

#[test]
fn an_aircraft_of_ten_digits_is_reduced_and_its_frequencies_are_those_of_the_f06_within_their_bars() {
    let Some(pairs) = corpus() else { return };
    let reference = frequencies_of_f06(&pairs.join(FOLDER).join("sol103_maewing1_femv5p1.f06.gz"));
    let body = reduced(&pairs, "herting");
    let modes = body["reduction"]["modes"].as_array().expect("modes");
    assert!(modes.len() >= N_MODES, "{} modes", modes.len());
    let n_rigid = reference.iter().take_while(|frequency| **frequency == 0.0).count();
    assert_eq!(n_rigid, 6);
    let mut narrowest = f64::INFINITY;
    for (mode, expected) in modes.iter().zip(&reference[n_rigid..]) {
        let (found, bar) = (mode["frequency_hz"].as_f64().expect("Hz"), mode["error_bar_hz"].as_f64().expect("Hz"));
        // The f06 prints seven digits.
        let printed = 5e-7 * expected;
        let difference = (found - expected).abs();
        assert!(difference <= bar + printed, "{found} Hz ± {bar:e} for {expected}: off {difference:e}");
        narrowest = narrowest.min(bar / found);
    }
    // Bars that exclude nothing would pass everything: the best known mode has six digits.
    assert!(narrowest < 1e-6, "{narrowest:e}");
    assert_eq!(body["completeness"]["is_certified"], true);
    assert_eq!(body["verdict"], "warn");
}

/// What the report warns of is true: the rigid-body motions of this K have energy, and its digits do not hold the first
/// frequency to a tenth of a per mille.
#[test]
fn what_is_warned_of_the_aircraft_is_what_ten_digits_cost() {
    let Some(pairs) = corpus() else { return };
    for (method, expected) in [
        ("herting", vec!["M-05", "M-09", "M-14", "M-24", "M-25"]),
        ("craig-bampton", vec!["M-05", "M-09", "M-24", "M-25"]),
    ] {
        let body = reduced(&pairs, method);
        let found = warned(&body);
        let ids: Vec<&str> = found.iter().map(|line| &line[..4]).collect();
        assert_eq!(ids, expected, "{method}: {found:#?}");
        let checks = body["checks"].as_array().expect("checks");
        let energy =
            checks.iter().find(|check| check["id"] == "M-05").expect("M-05")["value"].as_f64().expect("a value");
        // A dense solver finds zero modes between −39.6 and 7.7 (rad/s)² below a first elastic one of 2478: 1.6 %.
        assert!((energy / (39.64 / 2478.0) - 1.0).abs() < 0.05, "{method}: {energy:e}");
    }
}

/// At the tip of a wing the same digits do not hold the motion of the rest: the reduction is refused by name.
#[test]
fn the_tip_of_a_wing_is_refused_as_an_interface() {
    let Some(pairs) = corpus() else { return };
    let folder = pairs.join(FOLDER);
    let place = Place::new();
    let path = |name: &str| folder.join(name).display().to_string();
    let files = format!("--dofs {} --interface tip=999028 --method herting --modes 14", path("dof.csv"));
    let model = ["--stiffness".to_owned(), path("K.mtx"), "--mass".to_owned(), path("M.mtx")];
    let ended = place.reduce(&model, &files).expect(ExitCode::ModelPhysics);
    assert!(ended.err.contains("E-INTERFACE-RANK"), "{}", ended.err);
    assert!(!place.path("x.supel").exists());
}
