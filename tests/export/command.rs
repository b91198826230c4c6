//! The command: what it says, what it refuses, and that its files appear together or not at all.

use serde_json::Value;
use supel::cli::ExitCode;
use supel::export::{FORMATS, Names};
use supel_runtime::{Superelement, Verdict};
use supel_testing::place::{Place, supel};

use super::{export, reduced};

/// Names of all files in a folder, sorted.
fn files(place: &Place) -> Vec<String> {
    let entries = std::fs::read_dir(place.path("")).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn violations(document: &Value) -> Vec<String> {
    let schema: Value = serde_json::from_str(include_str!("../../schemas/export.schema.json")).expect("schema is JSON");
    let validator = jsonschema::validator_for(&schema).expect("schema is a schema");
    validator.iter_errors(document).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

/// x.supel with another recorded verdict.
fn record(place: &Place, verdict: Verdict) {
    let superelement = place.superelement("x.supel");
    let mut metadata = superelement.metadata().clone();
    metadata.verification.verdict = verdict;
    metadata.verification.checks[0].verdict = verdict;
    let changed = Superelement::new(superelement.tensors().clone(), metadata).expect("a superelement");
    changed.write(&place.path("x.supel")).expect("written");
}

#[test]
fn text_says_what_was_written_and_what_the_file_records() {
    let place = reduced("herting", "");
    let ended = export(&place, "op4", &[]).expect(ExitCode::Done);
    let lines: Vec<&str> = ended.out.lines().collect();
    assert_eq!(lines.len(), 3, "{}", ended.out);
    assert_eq!(lines[0], format!("{}: verified, as recorded when it was made", place.text("x.supel")));
    let start = format!("{}: KAA, MAA, GRAVITY, RECOVERY, RECDOFS, ", place.text("x.op4"));
    assert!(lines[1].starts_with(&start), "{}", lines[1]);
    assert_eq!((lines[2], ended.err.as_str()), ("numbers are in the units of the model, SI", ""));
}

#[test]
fn json_follows_its_schema() {
    let place = reduced("herting", "");
    for format in ["matrix-market", "op4", "op4-binary"] {
        let ended = export(&place, format, &["--json"]).expect(ExitCode::Done);
        let document: Value = serde_json::from_str(&ended.out).expect("JSON");
        assert_eq!(violations(&document), Vec::<String>::new());
        assert_eq!((&document["verdict"], &document["format"]), (&"pass".into(), &format.into()));
        for file in document["files"].as_array().expect("files") {
            let bytes = std::fs::read(file["path"].as_str().expect("a path")).expect("it was written");
            assert_eq!(file["bytes"], bytes.len());
            assert_eq!(file["blake3"], blake3::hash(&bytes).to_hex().to_string());
        }
        let mut less = document;
        less.as_object_mut().expect("an object").remove("files");
        assert_ne!(violations(&less), Vec::<String>::new());
    }
}

/// A folder that is there takes files without a start; others are the start of the names.
#[test]
fn outputs_go_where_they_are_sent() {
    let place = reduced("guyan", "");
    std::fs::create_dir(place.path("far")).expect("a folder");
    export(&place, "matrix-market", &["--output", &place.text("far")]).expect(ExitCode::Done);
    assert!(place.path("far/stiffness.mtx").exists() && place.path("far/job.toml").exists());
    supel(&["reduce", &place.text("far/job.toml")]).expect(ExitCode::Done);
    export(&place, "op4", &["-o", &place.text("far/y.op4")]).expect(ExitCode::Done);
    export(&place, "op4-binary", &["-o", &place.text("z")]).expect(ExitCode::Done);
    assert!(place.path("far/y.op4").exists() && place.path("z.op4").exists());
}

#[test]
fn what_failed_a_check_leaves_only_on_request() {
    let place = reduced("herting", "");
    record(&place, Verdict::Warn);
    let ended = export(&place, "op4", &[]).expect(ExitCode::Done);
    assert!(ended.out.contains("x.supel: verified with warnings, as recorded"), "{}", ended.out);
    std::fs::remove_file(place.path("x.op4")).expect("removed");
    record(&place, Verdict::Fail);
    let before = files(&place);
    let ended = export(&place, "op4", &[]).expect(ExitCode::CheckFailed);
    assert_eq!(files(&place), before);
    assert!(ended.err.contains("x.supel: not exported: a check failed when it was made"), "{}", ended.err);
    assert!(ended.err.contains("--allow-unverified"), "{}", ended.err);
    let refused = export(&place, "op4", &["--json"]).expect(ExitCode::CheckFailed);
    let document: Value = serde_json::from_str(&refused.out).expect("JSON");
    assert_eq!(violations(&document), Vec::<String>::new());
    assert_eq!((&document["verdict"], &document["files"]), (&"fail".into(), &Value::Array(Vec::new())));
    let ended = export(&place, "op4", &["--allow-unverified"]).expect(ExitCode::CheckFailed);
    assert!(place.path("x.op4").exists() && ended.err.is_empty(), "{}", ended.err);
    assert!(ended.out.contains("x.supel: a check failed, as recorded"), "{}", ended.out);
}

/// What stood at the names of an export stays where one of its files cannot be written.
#[test]
fn all_files_or_none() {
    let place = reduced("herting", "");
    place.write("x.stiffness.mtx", b"old");
    std::fs::create_dir(place.path("x.job.toml")).expect("a folder");
    let before = files(&place);
    let ended = export(&place, "matrix-market", &[]).expect(ExitCode::Io);
    assert!(ended.err.contains("x.job.toml"), "{}", ended.err);
    assert_eq!(files(&place), before);
    assert_eq!(place.bytes("x.stiffness.mtx"), b"old");
}

#[cfg(unix)]
#[test]
fn never_over_the_superelement() {
    let place = reduced("guyan", "");
    let before = place.bytes("x.supel");
    std::os::unix::fs::symlink(place.path("x.supel"), place.path("y.op4")).expect("a link");
    std::fs::hard_link(place.path("x.supel"), place.path("z.op4")).expect("a name");
    for name in ["y", "z"] {
        let ended = export(&place, "op4", &["--output", &place.text(name)]).expect(ExitCode::Usage);
        assert!(ended.err.contains("error[E-OVERWRITE]") && ended.err.contains("the superelement"), "{}", ended.err);
    }
    assert!(place.bytes("x.supel") == before);
}

/// The matrices that a superelement was reduced from keep their place, whatever they are called.
#[test]
fn never_over_the_model() {
    let place = reduced("guyan", "");
    std::fs::create_dir(place.path("model")).expect("a folder");
    for (name, exported) in [("M.mtx", "mass.mtx"), ("nodes.csv", "nodes.csv")] {
        let (before, path) = (place.bytes(name), format!("model/{exported}"));
        place.write(&path, &before);
        let ended = export(&place, "matrix-market", &["--output", &place.text("model")]).expect(ExitCode::Usage);
        let said = ["error[E-OVERWRITE]", exported, "an input of the reduction"];
        assert!(said.iter().all(|word| ended.err.contains(word)), "{}", ended.err);
        assert!(place.bytes(&path) == before);
        std::fs::remove_file(place.path(&path)).expect("removed");
    }
    for _ in 0..2 {
        export(&place, "matrix-market", &["--output", &place.text("model")]).expect(ExitCode::Done);
    }
}

#[test]
fn what_cannot_be_exported() {
    let place = reduced("guyan", "");
    let ended = export(&place, "abaqus", &[]).expect(ExitCode::Usage);
    assert!(ended.err.contains("matrix-market, op4, op4-binary"), "{}", ended.err);
    supel(&["export", &place.text("missing.supel"), "--to", "op4"]).expect(ExitCode::Io);
    supel(&["export", &place.text("K.mtx"), "--to", "op4"]).expect(ExitCode::InputData);
    supel(&["export", &place.text("x.supel")]).expect(ExitCode::Usage);
    let ended = export(&place, "op4", &["--output", &place.text("nowhere/x")]).expect(ExitCode::Io);
    assert!(ended.err.contains("error[E-FOLDER]"), "{}", ended.err);
}

/// A job of an export before would reduce the matrices of this one.
#[test]
fn nothing_is_exported_beside_files_of_another_export() {
    let place = reduced("herting", "");
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    // Over its own files an export goes.
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    let before = std::fs::read(place.path("x.stiffness.mtx")).expect("a file");
    let [k, m, x] = ["K.mtx", "M.mtx", "x.supel"].map(|name| place.text(name));
    let by_rows = ["--interface", "foot=rows:0,1,2,30,31,32,120,121,122", "--method", "guyan", "-o", &x];
    supel(&[&["reduce", "--stiffness", &k, "--mass", &m][..], &by_rows].concat()).expect(ExitCode::Done);
    let ended = export(&place, "matrix-market", &[]).expect(ExitCode::Usage);
    assert!(ended.err.contains("E-EXPORT-LEFT") && ended.err.contains("x.gravity.mtx (and"), "{}", ended.err);
    assert!(std::fs::read(place.path("x.stiffness.mtx")).expect("a file") == before, "something was written");
    for format in FORMATS {
        let names = Names::starting_with(&place.path("y"));
        let files = format.files(&reduced("herting", "").superelement("x.supel"), &names).expect("files");
        assert!(files.iter().all(|file| format.endings().contains(&file.ending)), "{}", format.name());
    }
}
