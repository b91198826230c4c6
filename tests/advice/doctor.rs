//! `supel doctor`: what a pair of matrices is, and what is wrong with it.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::transform::{grounded, join, scaled, supported};
use supel_models::{Material, Model, brick};
use supel_testing::place::{Ended, Place, steel_brick, supel};
use supel_testing::schema::{assert_follows, validator};

/// `supel doctor K.mtx M.mtx` with further arguments, in which a word that ends like a file is one of the folder.
fn doctor(place: &Place, rest: &str) -> Ended {
    let word = |word: &str| if word.contains('.') { place.text(word) } else { word.to_owned() };
    let rest: Vec<String> = rest.split_whitespace().map(word).collect();
    let mut args = vec!["doctor"];
    args.extend(rest.iter().map(String::as_str));
    supel(&args)
}

const ALL: &str = "K.mtx M.mtx --dofs dofs.txt --nodes nodes.csv";

/// The document, which follows its schema.
#[track_caller]
fn examined(place: &Place, rest: &str, code: ExitCode) -> Value {
    let document = serde_json::from_str(&doctor(place, &format!("{rest} --json")).expect(code).out).expect("JSON");
    assert_follows(&validator("examination"), &document);
    document
}

/// What is found, by code; an empty one where there is none.
fn findings(document: &Value) -> Vec<(&str, String)> {
    let findings = document["findings"].as_array().expect("findings").iter();
    findings.map(|finding| (finding["code"].as_str().unwrap_or_default(), finding.to_string())).collect()
}

/// The only finding of a code.
#[track_caller]
fn finding(document: &Value, code: &str) -> String {
    let of_code: Vec<String> =
        findings(document).into_iter().filter(|(of_finding, _)| *of_finding == code).map(|(_, text)| text).collect();
    assert_eq!(of_code.len(), 1, "{code}: {document}");
    of_code[0].clone()
}

#[test]
fn a_sound_pair_has_nothing_to_be_found() {
    let place = Place::with(&steel_brick());
    let found = examined(&place, ALL, ExitCode::Done);
    assert_eq!((&found["severity"], findings(&found).len()), (&Value::Null, 0), "{found}");
    assert_eq!(found["modes"].as_array().expect("modes").len(), 8);
    assert_eq!(found["units"][0]["label"], "m-kg-s");
    let text = doctor(&place, ALL).expect(ExitCode::Done).out;
    for told in [
        "six free",
        "135 rows · 45 nodes · 1 body",
        "m, kg, s",
        "1 × 0.31 × 0.23",
        "✓ nothing: the pair can be reduced",
    ] {
        assert!(text.contains(told), "{told}: {text}");
    }
    // Matrices alone are a pair, too.
    let alone = examined(&place, "K.mtx M.mtx", ExitCode::Done);
    assert_eq!((&alone["extents"], &alone["grounded"], findings(&alone).len()), (&Value::Null, &Value::Null, 0));
}

#[test]
fn one_file_given_twice() {
    let place = Place::with(&steel_brick());
    let found = examined(&place, "K.mtx K.mtx", ExitCode::CheckFailed);
    assert!(finding(&found, "E-SAME-MATRIX").contains("give the file of the other one"), "{found}");
    let copy = place.bytes("M.mtx");
    place.write("copy.mtx", &copy);
    finding(&examined(&place, "M.mtx copy.mtx", ExitCode::CheckFailed), "E-SAME-MATRIX");
}

/// The examination goes on with the files exchanged, and finds the frequencies of the pair.
#[test]
fn exchanged_matrices() {
    let place = Place::with(&steel_brick());
    let right = examined(&place, ALL, ExitCode::Done);
    let found = examined(&place, &ALL.replace("K.mtx M.mtx", "M.mtx K.mtx"), ExitCode::CheckFailed);
    assert!(finding(&found, "E-SWAPPED").contains("with the two files exchanged"), "{found}");
    assert_eq!(found["modes"], right["modes"]);
}

#[test]
fn a_map_of_another_mesh() {
    let place = Place::with(&steel_brick());
    let other = Place::with(&brick([2, 2, 4], [0.31, 0.23, 1.0], &Material::STEEL_SI));
    place.write("nodes.csv", &other.bytes("nodes.csv"));
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    let code = findings(&found)[0].0.to_owned();
    assert!(code == "E-COORD" || code.starts_with("E-MAP"), "{found}");
    assert!(finding(&found, &code).contains("without the"), "{found}");
    assert_eq!(found["modes"].as_array().expect("modes").len(), 8, "it goes on");
    // One of another size does not even begin to fit.
    let other = Place::with(&brick([3, 2, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI));
    place.write("dofs.txt", &other.bytes("dofs.txt"));
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    assert!(finding(&found, findings(&found)[0].0).contains("without the dof map"), "{found}");
}

#[test]
fn matrices_of_two_models() {
    let place = Place::with(&steel_brick());
    let other = Place::with(&brick([3, 2, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI));
    place.write("M.mtx", &other.bytes("M.mtx"));
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    assert_eq!((findings(&found).len(), &found["modes"]), (1, &Value::Null), "{found}");
}

/// A spring to the ground is named with its node, its direction and its stiffness.
#[test]
fn a_support_left_in_is_named() {
    // Node 17 uz.
    let model = grounded(&steel_brick(), 3 * 16 + 2, 3e6);
    let found = examined(&Place::with(&model), ALL, ExitCode::Done);
    let told = finding(&found, "");
    for part in ["1 dof is grounded", "node 17 uz (3.00e+06 N/m)", "a support left in the step", "\"warning\""] {
        assert!(told.contains(part), "{part}: {told}");
    }
    assert_eq!(found["grounded"]["n_touched"], 1);
    let stiffness = found["grounded"]["culprits"][0]["stiffness"].as_f64().expect("a stiffness");
    assert!((stiffness / 3e6 - 1.0).abs() < 1e-6, "{stiffness}");
    assert!(told.contains("*BOUNDARY, OP=NEW"), "lines for the deck: {told}");
}

/// Rows that supports took out are told by their neighbours; the component is held, which may be meant.
#[test]
fn supports_that_took_rows_out() {
    let model = supported(&steel_brick(), |(label, _)| label <= 9);
    let found = examined(&Place::with(&model), ALL, ExitCode::Done);
    let all = findings(&found);
    let (_, told) = all.iter().find(|(_, text)| text.contains("supports hold the component")).expect("told");
    assert!(told.contains("\"severity\":\"remark\""), "{told}");
    assert!(all.iter().any(|(_, text)| text.contains("9 nodes have no row")), "{all:?}");
    let text = doctor(&Place::with(&model), ALL).expect(ExitCode::Done).out;
    assert!(text.contains("none free: supports hold it"), "{text}");
}

/// What is held by a flag is meant.
#[test]
fn dofs_held_by_a_flag_are_no_finding() {
    let place = Place::with(&steel_brick());
    let found = examined(&place, &format!("{ALL} --fix foot=1,2,3,4,5,6,7,8,9"), ExitCode::Done);
    assert!(findings(&found).iter().all(|(_, text)| !text.contains("grounded")), "{found}");
}

#[test]
fn parts_that_nothing_joins() {
    let far = supel_models::transform::translated(&steel_brick(), [3.0, 0.0, 0.0]);
    let both: Model = join(&steel_brick(), &far, &[]);
    let place = Place::with(&both);
    let text = doctor(&place, ALL).out;
    assert!(text.contains("2 bodies") && text.contains("12 motions are free"), "{text}");
}

/// Steel in millimetres, with stiffness in N/mm and mass in kilograms: frequencies are wrong by √1000, and nothing else shows it.
#[test]
fn units_that_do_not_go_together() {
    let in_millimetres = Material { young: 210_000.0, poisson: 0.3, density: 7.85e-9 };
    let sound = brick([4, 2, 2], [100.0, 31.0, 23.0], &in_millimetres);
    let found = examined(&Place::with(&sound), ALL, ExitCode::Done);
    assert_eq!((&found["units"][0]["label"], findings(&found).len()), (&"mm-t-s".into(), 0), "{found}");
    let found = examined(&Place::with(&scaled(&sound, 1.0, 1e3)), ALL, ExitCode::Done);
    let told = finding(&found, "");
    assert!(told.contains("31.6 times too low: divide the mass by 1000"), "{told}");
    // kN/mm, kg and ms go together; frequencies are in kHz.
    let found = examined(&Place::with(&scaled(&sound, 1e-3, 1e3)), ALL, ExitCode::Done);
    let told = finding(&found, "");
    assert!(told.contains("kHz") && told.contains("units = \\\"mm-kg-ms\\\""), "{told}");
}

/// An error of reading is a finding like any other; a file that is not there is none of the pair.
#[test]
fn files_that_cannot_be_read() {
    let place = Place::with(&steel_brick());
    let text = String::from_utf8(place.bytes("K.mtx")).expect("UTF-8");
    place.write("K.mtx", text.replacen("e9", "x9", 1).as_bytes());
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    assert!(found["stiffness"].is_null() && findings(&found).len() == 1, "{found}");
    let ended = doctor(&place, "none.mtx M.mtx").expect(ExitCode::Io);
    assert!(ended.err.contains("E-READ"), "{}", ended.err);
}

#[test]
fn empty_rows_are_left_out() {
    // The last node has neither stiffness nor mass.
    let mut model = steel_brick();
    for entries in [&mut model.stiffness, &mut model.mass] {
        entries.retain(|(row, column, _)| *row < 132 && *column < 132);
    }
    let place = Place::with(&model);
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    let told = finding(&found, "E-EMPTY-ROWS");
    assert!(told.contains("without the empty rows") && told.contains("drop_empty = true"), "{told}");
}

/// The groups of a mesh are listed with what they can be.
#[cfg(feature = "hdf5")]
#[test]
fn groups_that_may_be_interfaces() {
    let place = Place::with_example();
    let found = examined(&place, "stiffness.mtx.gz mass.mtx.gz --nodes bracket.med", ExitCode::Done);
    let groups: Vec<(&str, String)> = found["interfaces"]
        .as_array()
        .expect("groups")
        .iter()
        .map(|group| (group["group"].as_str().expect("a name"), group["couplings"].to_string()))
        .collect();
    let of = |name: &str| groups.iter().find(|(group, _)| *group == name).map(|(_, couplings)| couplings.as_str());
    assert_eq!(of("EYE"), Some("[\"rigid\",\"average\"]"), "{groups:?}");
    let text = doctor(&place, "stiffness.mtx.gz mass.mtx.gz --nodes bracket.med").expect(ExitCode::Done).out;
    assert!(text.contains("Groups that may be interfaces"), "{text}");
}

/// The answer is the same for any number of threads.
#[test]
fn the_number_of_threads_changes_nothing() {
    let place = Place::with(&steel_brick());
    let [one, three] =
        ["--threads 1", "--threads 3"].map(|threads| doctor(&place, &format!("{ALL} --json {threads}")).out);
    assert_eq!(one, three);
}
