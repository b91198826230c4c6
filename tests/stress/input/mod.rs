//! Faults of matrices and maps: lines I-01 to I-26, each put through the program from files to files.

mod coordinates;
mod costs;
mod damage;
mod further_files;
mod maps;
mod matrices;
mod mutations;
mod paths;
mod sizes;
mod triangles;

use supel::cli::ExitCode;
use supel_models::model::Entry;
use supel_models::{Ends, spring};

use crate::place::{Ended, Place};

/// Five masses in a row without supports, reduced to its ends and one mode.
const CHAIN: &str = "--interface ends=rows:0,4 --method craig-bampton --modes 1 --threads 1";

/// A folder with the files of the chain.
fn chain() -> Place {
    Place::with(&spring(5, Ends::Free))
}

/// The chain held at both ends, so that small changes of K leave no rigid-body motion in doubt.
fn held_chain() -> Place {
    Place::with(&spring(5, Ends::Fixed))
}

/// The job of the chain.
fn chain_job() -> String {
    chain_job_with("\"K.mtx\"", "count = 1")
}

/// The job of the chain with another value for the stiffness, and other modes.
fn chain_job_with(stiffness: &str, modes: &str) -> String {
    format!(
        "model     = {{ stiffness = {stiffness}, mass = \"M.mtx\" }}\n\
         interface = [{{ name = \"ends\", nodes = {{ rows = [0, 4] }} }}]\n\
         reduction = {{ method = \"craig-bampton\", modes = {{ {modes} }} }}\n\
         write     = {{ superelement = \"x.supel\" }}\n"
    )
}

fn reduce_chain(place: &Place) -> Ended {
    place.reduce(&place.matrix_flags(), CHAIN)
}

/// A matrix in Matrix Market form with the entries as they are given.
fn mtx(symmetry: &str, n: usize, entries: &[Entry]) -> Vec<u8> {
    let mut text = format!("%%MatrixMarket matrix coordinate real {symmetry}\n{n} {n} {}\n", entries.len());
    for (row, col, value) in entries {
        text += &format!("{} {} {value:e}\n", row + 1, col + 1);
    }
    text.into_bytes()
}

/// Asserts that the run was refused with this code, that its message holds all parts, and that it left nothing behind.
#[track_caller]
fn assert_refused(place: &Place, ended: &Ended, code: &str, parts: &[&str]) {
    let said = ended.err.strip_prefix(&format!("supel: error[{code}]: "));
    let said = said.unwrap_or_else(|| panic!("no {code}: {:?} {}{}", ended.code, ended.out, ended.err));
    parts.iter().for_each(|part| assert!(said.contains(part), "{part:?} is not in {said:?}"));
    assert!(!place.path("x.supel").exists() && !place.path("x.report.json").exists(), "a refused run left files");
    let class = supel::error::Error::CODES.iter().find(|entry| entry.code == code).expect("a code of the enum").class;
    assert_eq!(ended.code, ExitCode::from(class));
}

/// Asserts that the run passed with every check, with these warnings and no other.
#[track_caller]
fn assert_done(place: &Place, ended: &Ended, warnings: &[&str]) {
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    let report = place.report("x.report.json");
    let checks = report["body"]["checks"].as_array().expect("checks");
    let failed: Vec<_> =
        checks.iter().filter(|check| check["verdict"] == "warn" || check["verdict"] == "fail").collect();
    assert!(failed.is_empty(), "{failed:#?}");
    let found: Vec<_> = report["body"]["warnings"].as_array().expect("warnings").iter().map(|w| &w["code"]).collect();
    assert_eq!(found, warnings, "{}", report["body"]["warnings"]);
}

/// Whether a note of the report says this.
fn notes_say(place: &Place, part: &str) -> bool {
    let report = place.report("x.report.json");
    let notes = report["body"]["model"]["notes"].as_array().expect("notes").clone();
    notes.iter().any(|note| note.as_str().expect("text").contains(part))
}
