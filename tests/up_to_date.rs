//! A job that is up to date does not run; whatever has changed lets it run.

use std::fs;
use std::path::Path;

use supel::cli::{ExitCode, Pipeline};
use supel::error::{Error, Result};
use supel::job::Job;
use supel::memory_forecast::Resources;
use supel::outcome::Outcome;
use supel::report::Observer;
use supel_models::{Material, brick};
use supel_runtime::{Metadata, Superelement, Verdict};
use supel_testing::place::{Ended, Place, supel, supel_as_typed};
use supel_testing::schema::{assert_follows, validator};

/// A pipeline whose stages all refuse to run: a command that ends well has used none of them.
const IDLE: Pipeline = Pipeline { reduce: refuse, ..supel::PIPELINE };

fn refuse(_: &Job, _: Resources, _: &mut dyn Observer) -> Result<Outcome> {
    Err(Error::NoMass)
}

/// A command that would reduce, as it is typed, where every reduction is refused: nothing is ever written.
fn idle(args: &[&str]) -> Ended {
    supel_as_typed(IDLE, &[&["reduce"], args].concat())
}

#[track_caller]
fn assert_up_to_date(args: &[&str], why: &str) {
    let ended = idle(args);
    assert_eq!(ended.code, ExitCode::Done, "{why}: {}{}", ended.out, ended.err);
}

/// That a command reduces; gives what it says of that.
#[track_caller]
fn assert_runs(args: &[&str], why: &str) -> String {
    let ended = idle(args);
    assert_eq!(ended.code, ExitCode::from(Error::NoMass.class()), "{why}: {}{}", ended.out, ended.err);
    ended.err
}

/// A steel block with a job that reads as many kinds of files as one may.
fn place(of_model: &str, reduction: &str) -> Place {
    let model = brick([4, 2, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI);
    let place = Place::with(&model);
    let nodes = String::from_utf8(place.bytes("nodes.csv")).expect("text");
    let nodes: Vec<&str> = nodes.lines().skip(1).collect();
    place.write("block.inp", b"*INCLUDE, INPUT=nodes.inc\n*NSET, NSET=ROOT\n1, 6\n");
    place.write("nodes.inc", format!("*NODE\n{}\n", nodes.join("\n")).as_bytes());
    let stiffness = String::from_utf8(place.bytes("K.mtx")).expect("text");
    place.write("C.mtx", stiffness.as_bytes());
    let column = |name: &str, value: f64| {
        let values = format!("{value:e}\n").repeat(model.n);
        place.write(name, format!("%%MatrixMarket matrix array real general\n{} 1\n{values}", model.n).as_bytes());
    };
    column("f.mtx", 1.0);
    column("modes.mtx", 1e-3);
    // Three nodes in a row, as far from each other: their displacements follow a line, as in any rigid-body motion.
    let tie = format!("%%MatrixMarket matrix coordinate real general\n1 {} 3\n1 4 1\n1 7 -2\n1 10 1\n", model.n);
    place.write("G.mtx", tie.as_bytes());
    let row = format!("%%MatrixMarket matrix coordinate real general\n1 {} 1\n1 13 2.5\n", model.n);
    place.write("R.mtx", row.as_bytes());
    place.write("R.csv", b"name,unit\nstress,Pa\n");
    let job = format!(
        r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "block.inp"{of_model} }}
interface = [{{ name = "foot", nodes = [1, 11, 31, 41] }}]
load      = [{{ name = "wind", file = "f.mtx" }}]
matrix    = [{{ name = "fluid", kind = "other", file = "C.mtx" }}]
reduction = {{ {reduction} }}
scene     = {{ boundaries = [] }}

[write]
superelement = "x.supel"
html         = "x.html"
junit        = "x.xml"
quantities   = {{ matrix = "R.mtx", names = "R.csv" }}
"#
    );
    place.write("job.toml", job.as_bytes());
    place
}

const HERTING: &str = r#"method = "herting", modes = { count = 4 }"#;
const OUTPUTS: [&str; 4] = ["x.supel", "x.report.json", "x.html", "x.xml"];

/// A place whose job has run, and the job.
fn made(of_model: &str, reduction: &str) -> (Place, String) {
    let place = place(of_model, reduction);
    let job = place.text("job.toml");
    supel(&["reduce", &job, "--quiet"]).expect(ExitCode::Done);
    (place, job)
}

#[test]
fn a_job_that_is_up_to_date_does_no_work_and_writes_nothing() {
    let (place, job) = made("", HERTING);
    let times = || OUTPUTS.map(|name| fs::metadata(place.path(name)).expect("a file").modified().expect("a time"));
    let before = times();
    for flags in [&[][..], &["--threads", "1"], &["--threads", "3"], &["--allow-unverified"]] {
        let ended = idle(&[&[job.as_str()], flags].concat()).expect(ExitCode::Done);
        assert!(ended.out.starts_with(&place.text("x.supel")), "{}", ended.out);
        assert!(ended.out.contains(" is up to date: verified"), "{}", ended.out);
        assert_eq!((ended.out.lines().count(), ended.err.as_str()), (1, ""), "{flags:?}");
    }
    let quiet = idle(&[&job, "--quiet"]).expect(ExitCode::Done);
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
    assert_eq!(times(), before);
    for unread in ["dofs.12d", "dofs.frd", "other.mtx"] {
        place.write(unread, b"");
    }
    assert_up_to_date(&[&job], "files that the job does not read");
    let forced = assert_runs(&[&job, "--force"], "--force");
    assert!(!forced.contains("not up to date"), "{forced}");
}

#[test]
fn the_document_is_the_report_of_the_run_that_made_it() {
    let (place, job) = made("", HERTING);
    let answer = idle(&[&job, "--json"]).expect(ExitCode::Done).out;
    let document: serde_json::Value = serde_json::from_str(&answer).expect("JSON");
    assert_follows(&validator("report"), &document);
    assert_eq!(document["run"]["up_to_date"], true);
    let mut report = place.report("x.report.json");
    assert!(report["run"]["up_to_date"].is_null(), "a run that did something");
    report["run"]["up_to_date"] = true.into();
    assert_eq!(document, report);
    let (body, _) = answer.split_once("\n  \"run\": {").expect("facts of the run");
    assert_eq!(body, place.report_body("x.report.json"), "the body as it is written, every digit");
    assert_eq!(idle(&[&job, "--json", "--threads", "2"]).out, answer);
}

#[test]
fn a_folder_that_moves_as_a_whole_is_up_to_date() {
    // Constraints are among the files that the superelement finds from its own folder.
    let (place, _) = made(r#", constraints = "G.mtx""#, HERTING);
    let elsewhere = Place::new();
    for entry in fs::read_dir(place.path("")).expect("a folder") {
        let path = entry.expect("an entry").path();
        fs::copy(&path, elsewhere.path(&path.file_name().expect("a name").to_string_lossy())).expect("copied");
    }
    drop(place);
    let job = elsewhere.text("job.toml");
    assert_up_to_date(&[&job], "moved");
    let answer = idle(&[&job, "--json"]).out;
    let document: serde_json::Value = serde_json::from_str(&answer).expect("JSON");
    assert_eq!(document["run"]["superelement"], elsewhere.text("x.supel"));
    assert_eq!(document["run"]["report"], elsewhere.text("x.report.json"));
}

/// Changes a file by one byte and sees that the job runs; puts it back and sees that it does not.
#[track_caller]
fn assert_reads(place: &Place, job: &str, name: &str, says: &str) {
    let before = place.bytes(name);
    let mut other = before.clone();
    // The last line stays one in every format here.
    *other.last_mut().expect("a byte") ^= 1;
    for other in [other, [before.as_slice(), b"\n"].concat()] {
        place.write(name, &other);
        let said = assert_runs(&[job], name);
        assert!(said.contains(&format!("x.supel: not up to date: {says}\n")), "{name}: {said}");
        assert!(!assert_runs(&[job, "--quiet"], name).contains("up to date"), "{name}");
    }
    place.write(name, &before);
    assert_up_to_date(&[job], name);
}

#[test]
fn every_input_counts() {
    let common = [
        ("K.mtx", "stiffness"),
        ("M.mtx", "mass"),
        ("dofs.txt", "dof map"),
        ("block.inp", "nodes"),
        ("nodes.inc", "data of nodes"),
        ("f.mtx", "load wind"),
        ("C.mtx", "matrix fluid"),
        ("R.mtx", "quantities"),
        ("R.csv", "names of quantities"),
    ];
    let further = [
        ("", HERTING, None),
        (r#", constraints = "G.mtx""#, HERTING, Some(("G.mtx", "constraints"))),
        ("", r#"method = "mode-acceleration", modes = { file = "modes.mtx" }"#, Some(("modes.mtx", "modes"))),
    ];
    for (of_model, reduction, file) in further {
        let (place, job) = made(of_model, reduction);
        assert_up_to_date(&[&job], "unchanged");
        for (name, role) in common.into_iter().chain(file) {
            assert_reads(&place, &job, name, &format!("the input {role:?} has changed"));
        }
        let recorded = place.superelement("x.supel").metadata().inputs.len();
        assert_eq!(recorded, common.len() + usize::from(file.is_some()), "every file that is recorded was changed");
        fs::remove_file(place.path("K.mtx")).expect("removed");
        assert_ne!(idle(&[&job]).code, ExitCode::Done, "an input that is gone");
    }
}

/// CalculiX writes what it made of shells next to the dof map, under names that no job has.
#[test]
fn files_next_to_a_dof_map_count_where_it_needs_them() {
    let place = Place::new();
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/calculix");
    for kind in ["sti.gz", "mas.gz", "dof", "inp", "12d", "frd"] {
        place.write(&format!("plate.{kind}"), &fs::read(fixtures.join(format!("plate.{kind}"))).expect("a fixture"));
    }
    place.write(
        "job.toml",
        br#"
model     = { stiffness = "plate.sti.gz", mass = "plate.mas.gz", dofs = "plate.dof", nodes = "plate.inp" }
interface = [{ name = "left", nodes = "group:LEFT", coupling = "rigid" }]
reduction = { method = "herting", modes = { count = 4 } }
scene     = { boundaries = [] }
write     = { superelement = "x.supel" }
"#,
    );
    let job = place.text("job.toml");
    supel(&["reduce", &job, "--quiet"]).expect(ExitCode::Done);
    for name in ["plate.12d", "plate.frd"] {
        assert_reads(&place, &job, name, "the input \"nodes made of shells and beams\" has changed");
    }
    // A file that is looked for before the one that was read.
    place.write("plate.frd.gz", b"");
    assert_up_to_date(&[&job], "looked for afterwards");
    let topology = place.bytes("plate.12d");
    fs::remove_file(place.path("plate.12d")).expect("removed");
    assert_runs(&[&job], "without the topology");
    place.write("plate.12d", &topology);
}

/// The block names rows that belong to no node: a file that told more of them would count, if there were one.
#[test]
fn a_file_that_was_looked_for_in_vain_counts_once_it_is_there() {
    let place = Place::new();
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/calculix");
    for kind in ["sti.gz", "mas.gz", "dof", "inp"] {
        place.write(&format!("block.{kind}"), &fs::read(fixtures.join(format!("block.{kind}"))).expect("a fixture"));
    }
    place.write(
        "job.toml",
        br#"
model     = { stiffness = "block.sti.gz", mass = "block.mas.gz", dofs = "block.dof", nodes = "block.inp" }
interface = [{ name = "foot", nodes = [1, 2, 3, 4] }]
reduction = { method = "herting", modes = { count = 4 } }
scene     = { boundaries = [] }
write     = { superelement = "x.supel" }
"#,
    );
    let job = place.text("job.toml");
    supel(&["reduce", &job, "--quiet"]).expect(ExitCode::Done);
    assert_up_to_date(&[&job], "unchanged");
    place.write("block.frd", b"");
    assert_up_to_date(&[&job], "positions are not looked for");
    place.write("block.12d", b"Integration point in a one-dimensional element\n");
    assert_runs(&[&job], "the topology is there now");
}

#[test]
fn every_flag_counts_that_the_result_may_depend_on() {
    let (place, job) = made("", HERTING);
    place.write("K2.mtx", &place.bytes("K.mtx"));
    let in_place = |name: &str| place.text(name);
    let flags: [&[&str]; 28] = [
        &["--stiffness", &in_place("K2.mtx")],
        &["--mass", &in_place("K2.mtx")],
        &["--dofs", &in_place("K2.mtx")],
        &["--nodes", &in_place("nodes.csv")],
        &["--layout", "matrix-market"],
        &["--symmetric", "lower"],
        &["--drop-empty"],
        &["--interface", "foot=1,11,31"],
        &["--interface", "top=5"],
        &["--rigid-interface", "top=5,10,15"],
        &["--fix", "wall=45"],
        &["--method", "craig-bampton"],
        &["--modes", "5"],
        &["--up-to-hz", "9000"],
        &["--method", "mixed-interface", "--held", "foot"],
        &["--method", "craig-bampton", "--inertia-relief"],
        &["--inertia-relief"],
        &["--certify", "none"],
        &["--certify", "full"],
        &["--output", &in_place("y.supel")],
        &["--report", &in_place("y.json")],
        &["--html", &in_place("y.html")],
        &["--junit", &in_place("y.xml")],
        &["--strict"],
        &["--memory-gib", "4"],
        &["--precision", "mixed"],
        &["--no-skip"],
        &["--force"],
    ];
    for flags in flags {
        assert_runs(&[&[job.as_str()], flags].concat(), &flags.join(" "));
    }
    assert_up_to_date(&[&job, "--method", "herting", "--modes", "4"], "what the job says anyway");
}

#[test]
fn every_key_of_the_document_counts() {
    let (place, job) = made("", HERTING);
    let text = String::from_utf8(place.bytes("job.toml")).expect("text");
    for (before, after) in [
        ("count = 4", "count = 5"),
        ("[1, 11, 31, 41]", "[1, 11, 41, 31]"),
        ("\"wind\"", "\"sun\""),
        ("\"foot\"", "\"Foot\""),
        ("boundaries = []", "boundaries = [\"free\"]"),
        ("dofs = \"dofs.txt\"", "dofs = \"dofs.txt\", units = \"SI\""),
    ] {
        assert!(text.contains(before));
        place.write("job.toml", text.replace(before, after).as_bytes());
        assert_runs(&[&job], after);
    }
    place.write("job.toml", format!("# a remark\n{text}").as_bytes());
    assert_up_to_date(&[&job], "a remark is no key");
}

#[test]
fn every_output_counts() {
    let (place, job) = made("", HERTING);
    let outputs = OUTPUTS.map(|name| (name, place.bytes(name)));
    supel(&["reduce", &job, "--quiet", "--modes", "5"]).expect(ExitCode::Done);
    let of_another = OUTPUTS.map(|name| place.bytes(name));
    outputs.iter().for_each(|(name, content)| place.write(name, content));
    for ((name, content), other) in outputs.iter().zip(of_another) {
        assert_ne!(*content, other);
        let cut = &content[..content.len() / 2];
        for replaced in [Some(other.as_slice()), Some(cut), Some(b"".as_slice()), None] {
            match replaced {
                Some(bytes) => place.write(name, bytes),
                None => fs::remove_file(place.path(name)).expect("removed"),
            }
            let said = assert_runs(&[&job], name);
            assert!(*name == "x.supel" || said.contains(&format!("{name} is not there, or of another run")), "{said}");
        }
        place.write(name, content);
        assert_up_to_date(&[&job], name);
    }
}

/// The file with other content, sealed again.
fn sealed_again(place: &Place, change: impl FnOnce(&mut Metadata)) -> [String; 2] {
    let superelement = place.superelement("x.supel");
    let (tensors, mut metadata) = (superelement.tensors().clone(), superelement.metadata().clone());
    let digest = |superelement: &Superelement| superelement.to_bytes().expect("bytes").digest;
    change(&mut metadata);
    let other = Superelement::new(tensors, metadata).expect("a superelement");
    place.write("x.supel", &other.to_bytes().expect("bytes").bytes);
    [digest(&superelement), digest(&other)]
}

#[test]
fn a_file_that_was_tampered_with_counts() {
    let (place, job) = made("", HERTING);
    let good = place.bytes("x.supel");
    for at in (8..good.len()).step_by(good.len() / 40) {
        let mut damaged = good.clone();
        damaged[at] ^= 1;
        place.write("x.supel", &damaged);
        assert_runs(&[&job], &format!("byte {at}"));
    }
    place.write("x.supel", &good);
    sealed_again(&place, |metadata| metadata.model.n_dofs += 1);
    let said = assert_runs(&[&job], "sealed again");
    assert!(said.contains("x.report.json is not there, or of another run"), "{said}");
    place.write("x.supel", &good);
    assert_up_to_date(&[&job], "put back");
}

#[test]
fn another_version_and_a_file_that_failed_count() {
    type Change = fn(&mut Metadata);
    let changes: [(Change, &str); 4] = [
        (|metadata| metadata.generator.version = "0.0.9".to_owned(), "not up to date: it was made by supel 0.0.9"),
        (|metadata| metadata.generator.name = "other".to_owned(), "not up to date: it was made by other"),
        (|metadata| metadata.verification.verdict = Verdict::Fail, ""),
        (|metadata| metadata.inputs.clear(), "not up to date: the input"),
    ];
    for (change, says) in changes {
        let (place, job) = made("", HERTING);
        let [was, is] = sealed_again(&place, change);
        // Whoever seals the file again may write its digest into everything else.
        for name in &OUTPUTS[1..] {
            let text = String::from_utf8(place.bytes(name)).expect("text");
            assert!(text.contains(&was), "{name}");
            place.write(name, text.replace(&was, &is).as_bytes());
        }
        let said = assert_runs(&[&job], says);
        assert!(said.contains(says), "{said}");
    }
}

/// A run judges the warnings of its report by its own flags.
#[test]
fn warnings_count_with_strict() {
    let (place, job) = made(r#", duplicates = "refuse""#, HERTING);
    assert_up_to_date(&[&job, "--strict"], "no warnings");
    assert_up_to_date(&[&job], "no warnings");
    let text = String::from_utf8(place.bytes("x.report.json")).expect("text");
    let verdict = "\"verdict\": \"pass\"";
    for (verdict_now, is_strict_up_to_date, says) in
        [("\"verdict\": \"warn\"", true, "verified, with"), ("\"verdict\": \"fail\"", false, "")]
    {
        place.write("x.report.json", text.replacen(verdict, verdict_now, 1).as_bytes());
        assert_runs(&[&job, "--strict"], verdict_now);
        let ended = idle(&[&job]);
        assert_eq!(ended.code == ExitCode::Done, is_strict_up_to_date, "{}{}", ended.out, ended.err);
        assert!(ended.out.contains(says), "{}", ended.out);
    }
}

/// A page of checks in which warnings were failures is not that of a run for which they are none.
#[test]
fn checks_that_were_written_as_failures_count() {
    let (place, job) = made("", HERTING);
    let text = String::from_utf8(place.bytes("x.xml")).expect("text");
    place.write("x.xml", text.replace("failures=\"0\"", "failures=\"1\"").as_bytes());
    assert_runs(&[&job], "failures");
}
