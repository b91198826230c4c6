//! The command line, in process with a pipeline made by hand, and as a program.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use supel_testing::sample;

use supel::cli::{ExitCode, Pipeline, Reduce, Terminal, run};
use supel::error::{Error, Result};
use supel::job::{Coupling, Job, Method, ModeSelection, NodeSelection, Precision};
use supel::memory_forecast::Resources;
use supel::outcome::Outcome;
use supel::report::Observer;
use supel_runtime::Superelement;

/// What a command left behind.
struct Ended {
    code: ExitCode,
    out: String,
    err: String,
}

fn supel_with(reduce: Reduce, args: &[&str]) -> Ended {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let args = std::iter::once("supel").chain(args.iter().copied()).map(OsString::from);
    let code = run(args, Pipeline { reduce, ..supel::PIPELINE }, &mut Terminal::plain(&mut out, &mut err));
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    Ended { code, out: text(out), err: text(err) }
}

fn supel(args: &[&str]) -> Ended {
    supel_with(sample::pipeline, args)
}

/// A folder with a job in it.
struct Workplace {
    folder: tempfile::TempDir,
}

impl Workplace {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("folder");
        let job = r#"
[model]
stiffness = "K.mtx"
mass = "M.mtx"

[[interface]]
name = "hub"
nodes = [12]

[reduction]
method = "herting"
modes = { count = 3 }

[write]
superelement = "bracket.supel"
"#;
        std::fs::write(folder.path().join("job.toml"), job).expect("written");
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn job(&self) -> String {
        self.path("job.toml").display().to_string()
    }

    fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).expect("folder");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

fn failing(job: &Job, resources: Resources, observer: &mut dyn Observer) -> Result<Outcome> {
    let outcome = sample::pipeline(job, resources, observer)?;
    Ok(Outcome { report: sample::full_report(), ..outcome })
}

fn warning(job: &Job, resources: Resources, observer: &mut dyn Observer) -> Result<Outcome> {
    let mut outcome = sample::pipeline(job, resources, observer)?;
    outcome.report.body.warnings = sample::full_report().body.warnings;
    Ok(outcome)
}

fn panicking(_job: &Job, _resources: Resources, _observer: &mut dyn Observer) -> Result<Outcome> {
    panic!("a defect")
}

/// Says which job it was given, as an error.
fn echo(job: &Job, _resources: Resources, _observer: &mut dyn Observer) -> Result<Outcome> {
    let text = serde_json::to_string(job).expect("json");
    Err(Error::JobSyntax { path: "echo".into(), line: None, message: text })
}

fn echoed(args: &[&str]) -> Job {
    let ended = supel_with(echo, args);
    // What flags do to interfaces is said first.
    let (_, text) = ended.err.split_once("supel: error[E-JOB]: echo: ").unwrap_or_else(|| panic!("{}", ended.err));
    serde_json::from_str(text).expect("the job")
}

#[test]
fn reduce_writes_superelement_and_report_and_prints_the_summary() {
    let place = Workplace::new();
    let ended = supel(&["reduce", &place.job(), "--threads", "1"]);
    assert_eq!(ended.code, ExitCode::Done, "{}", ended.err);
    assert_eq!(ended.err, "");
    assert!(ended.out.contains("✓ verified: 2 checks passed"), "{}", ended.out);
    assert_eq!(place.files(), ["bracket.report.json", "bracket.supel", "job.toml"]);
    assert_eq!(Superelement::open(&place.path("bracket.supel")).expect("readable"), sample::superelement());
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(place.path("bracket.report.json")).expect("read")).expect("json");
    assert_eq!(report["run"]["n_threads"], 1);
    assert_eq!(report["body"]["checks"][1]["id"], "M-26");
    let stages = report["run"]["stages"].as_array().expect("stages");
    assert_eq!(stages.iter().map(|stage| &stage["name"]).collect::<Vec<_>>(), ["read", "factor", "write"]);
    let size = std::fs::metadata(place.path("bracket.supel")).expect("file").len();
    assert_eq!(report["run"]["file_bytes"], size);
}

#[test]
fn json_answer_is_the_report_and_quiet_is_silent() {
    let place = Workplace::new();
    let ended = supel(&["reduce", &place.job(), "--json"]);
    assert_eq!(ended.out, std::fs::read_to_string(place.path("bracket.report.json")).expect("read"));
    let ended = supel(&["reduce", &place.job(), "--quiet"]);
    assert_eq!((ended.code, ended.out.as_str(), ended.err.as_str()), (ExitCode::Done, "", ""));
    let both = supel(&["reduce", &place.job(), "--quiet", "--json"]);
    assert!(both.code == ExitCode::Done && both.out.starts_with('{') && both.err.is_empty(), "{}", both.err);
}

#[test]
fn failed_check_leaves_no_file_but_a_report() {
    let place = Workplace::new();
    let ended = supel_with(failing, &["reduce", &place.job()]);
    assert_eq!(ended.code, ExitCode::CheckFailed);
    assert_eq!(place.files(), ["bracket.report.json", "job.toml"]);
    assert!(ended.err.contains("bracket.supel: not written: a check failed – see the report"), "{}", ended.err);
    assert!(ended.out.contains("✗ not verified: 1 of 4 checks failed: M-16"), "{}", ended.out);
    let report = std::fs::read_to_string(place.path("bracket.report.json")).expect("read");
    assert!(report.contains("\"verdict\": \"fail\""));
}

#[test]
fn failed_check_keeps_the_file_of_an_earlier_run_and_says_so() {
    let place = Workplace::new();
    assert_eq!(supel(&["reduce", &place.job()]).code, ExitCode::Done);
    let ended = supel_with(failing, &["reduce", &place.job()]);
    assert_eq!(ended.code, ExitCode::CheckFailed);
    assert!(ended.err.contains("the file of that name is from an earlier run"), "{}", ended.err);
    assert!(Superelement::open(&place.path("bracket.supel")).is_ok());
}

#[test]
fn unverified_superelement_is_written_on_request_with_code_one() {
    let place = Workplace::new();
    let ended = supel_with(failing, &["reduce", &place.job(), "--allow-unverified"]);
    assert_eq!(ended.code, ExitCode::CheckFailed);
    assert_eq!(place.files(), ["bracket.report.json", "bracket.supel", "job.toml"]);
}

#[test]
fn warnings_fail_only_where_asked() {
    let place = Workplace::new();
    assert_eq!(supel_with(warning, &["reduce", &place.job()]).code, ExitCode::Done);
    let place = Workplace::new();
    let ended = supel_with(warning, &["reduce", &place.job(), "--strict"]);
    assert_eq!(ended.code, ExitCode::CheckFailed);
    assert_eq!(place.files(), ["bracket.report.json", "job.toml"]);
}

#[test]
fn left_over_parts_are_reported() {
    let place = Workplace::new();
    // No process has a number beyond 2²².
    std::fs::write(place.path(".bracket.supel.99999999-0.part"), "").expect("written");
    let running = format!(".bracket.supel.{}-7.part", std::process::id());
    std::fs::write(place.path(&running), "").expect("written");
    let ended = supel(&["reduce", &place.job()]);
    assert!(ended.err.contains("99999999-0.part: left by an interrupted run – it can be removed"), "{}", ended.err);
    assert!(ended.err.contains("-7.part: another run may be writing it"), "{}", ended.err);
}

#[test]
fn flags_alone_make_a_job() {
    let job = echoed(&[
        "reduce",
        "--stiffness",
        "K.mtx.gz",
        "--mass",
        "M.mtx.gz",
        "--nodes",
        "nodes.csv",
        "--interface",
        "hub=12,17,19",
        "--interface",
        "rows=rows:0,1",
        "--rigid-interface",
        "rim=group:RIM",
        "--method",
        "herting",
        "--up-to-hz",
        "500",
        "-o",
        "x.supel",
        "--certify",
        "none",
        "--memory-gib",
        "2",
        "--precision",
        "mixed",
    ]);
    let here = std::env::current_dir().expect("folder");
    assert_eq!(job.model.stiffness, here.join("K.mtx.gz"));
    assert_eq!(job.model.nodes, Some(here.join("nodes.csv")));
    assert_eq!(job.interfaces[0].nodes, NodeSelection::Labels(vec![12, 17, 19]));
    assert_eq!(job.interfaces[1].nodes, NodeSelection::Rows { rows: vec![0, 1] });
    assert_eq!(job.interfaces[2].nodes.group_name(), Some("RIM"));
    assert_eq!(job.interfaces[2].coupling, Coupling::Rigid);
    assert_eq!(job.reduction.modes, Some(ModeSelection::UpTo { up_to_hz: 500.0 }.into()));
    assert_eq!(job.run.memory_gib, Some(2.0));
    assert_eq!(job.run.precision, Precision::Mixed);
    assert_eq!(job.write.superelement, here.join("x.supel"));
}

#[test]
fn flags_override_keys_of_the_job() {
    let place = Workplace::new();
    let job = echoed(&["reduce", &place.job()]);
    assert_eq!(job.model.stiffness, place.path("K.mtx"));
    let changed = echoed(&[
        "reduce",
        &place.job(),
        "--method",
        "craig-bampton",
        "--modes",
        "7",
        "--interface",
        "pin=3",
        "--stiffness",
        "/other/K.mtx",
    ]);
    assert_eq!(changed.reduction.method, Method::CraigBampton);
    assert_eq!(changed.reduction.modes, Some(ModeSelection::Count { count: 7 }.into()));
    let names: Vec<&str> = changed.interfaces.iter().map(|interface| interface.name.as_str()).collect();
    assert_eq!(names, ["hub", "pin"]);
    assert_eq!(changed.model.stiffness, Path::new("/other/K.mtx"));
    assert_eq!(changed.model.mass, job.model.mass);
    assert_eq!(changed.write, job.write);
}

#[test]
fn mistakes_on_the_command_line_are_usage_errors() {
    let refused = |args: &[&str]| {
        let ended = supel(args);
        assert_eq!(ended.code, ExitCode::Usage, "{}", ended.err);
        assert!(ended.err.starts_with("supel: error[E-"), "{}", ended.err);
        assert_eq!(ended.out, "");
        ended.err
    };
    let place = Workplace::new();
    let job = place.job();
    insta::assert_snapshot!(refused(&["reduce", "--stiffness", "K.mtx"]), @"supel: error[E-FLAGS]: no job document, and without one --mass, --method, --up-to-hz or --modes, --output are missing – give a job document or these flags");
    insta::assert_snapshot!(refused(&["reduce", &job, "--interface", "hub"]), @"supel: error[E-FLAG-TEXT]: --interface hub – expected NAME=NODES, as in hub=12,17,19");
    insta::assert_snapshot!(refused(&["reduce", &job, "--interface", "hub=HUB"]), @"supel: error[E-FLAG-TEXT]: --interface hub=HUB – expected node labels, group:NAME or rows:0,1,2 after the =");
    insta::assert_snapshot!(refused(&["reduce", &job, "--interface", "hub=rows:-1"]), @"supel: error[E-FLAG-TEXT]: --interface hub=rows:-1 – expected row numbers from zero, as in hub=rows:0,1,2");
    insta::assert_snapshot!(refused(&["reduce", &job, "--up-to-hz", "-3"]), @"supel: error[E-ARG]: `reduction.modes.up_to_hz` is -3 – expected a positive number");
    assert!(refused(&["reduce", &job, "--up-to-hz", "3", "--modes", "4"]).contains("cannot be used with"));
    assert!(refused(&["reduce", &job, "--threads", "0"]).contains("--threads"));
    assert!(refused(&["reduce", &job, "--metod", "herting"]).contains("--method"));
    assert!(refused(&["frobnicate"]).contains("frobnicate"));
}

/// With `--json` stdout carries a document whatever happens, and stderr says the same in words.
#[test]
fn an_error_is_a_document_too() {
    let schema = serde_json::from_str(include_str!("../schemas/error.schema.json")).expect("schema");
    let schema = jsonschema::validator_for(&schema).expect("a schema");
    let place = Workplace::new();
    let job = place.job();
    let with_spaces = |args: &[&str]| args.join(" ");
    for (pipeline, args, code, exit_code) in [
        (sample::pipeline as Reduce, ["reduce", &job, "--json", "--up-to-hz=-3"], "E-ARG", 2),
        (sample::pipeline, ["reduce", &job, "--json", "--metod"], "E-USAGE", 2),
        (sample::pipeline, ["reduce", "no/such/job.toml", "--json", "--strict"], "E-READ", 7),
        (panicking, ["reduce", &job, "--json", "--strict"], "E-INTERNAL", 70),
    ] {
        let ended = supel_with(pipeline, &args);
        assert_eq!(ended.code as u8, exit_code, "{}: {}", with_spaces(&args), ended.err);
        let document: serde_json::Value = serde_json::from_str(&ended.out).expect("JSON");
        let faults: Vec<String> = schema.iter_errors(&document).map(|fault| fault.to_string()).collect();
        assert!(faults.is_empty(), "{}: {faults:?}", with_spaces(&args));
        assert_eq!((&document["error"]["code"], &document["error"]["exit_code"]), (&code.into(), &exit_code.into()));
        let message = document["error"]["message"].as_str().expect("text");
        assert_eq!(ended.err.lines().next(), format!("supel: error[{code}]: {message}").lines().next());
    }
}

#[test]
fn files_that_are_not_there_are_input_output_errors() {
    assert_eq!(supel(&["reduce", "no/such/job.toml"]).code, ExitCode::Io);
    assert_eq!(supel(&["inspect", "no/such/file.supel"]).code, ExitCode::Io);
    let place = Workplace::new();
    let output = place.path("missing/x.supel").display().to_string();
    let ended = supel(&["reduce", &place.job(), "-o", &output]);
    assert_eq!(ended.code, ExitCode::Io);
    assert!(ended.err.contains("cannot be written"), "{}", ended.err);
    assert_eq!(ended.err.lines().count(), 1, "the cause is said twice: {}", ended.err);
}

/// Told before the model is read: the pipeline here would panic.
#[test]
fn an_output_without_a_place_is_refused_before_the_run() {
    let place = Workplace::new();
    std::fs::create_dir(place.path("folder.html")).expect("made");
    for (flag, name, said) in [
        ("--output", "missing/x.supel", "cannot be written"),
        ("--report", "missing/x.json", "cannot be written"),
        ("--html", "job.toml/x.html", "cannot be written"),
        ("--junit", "missing/x.xml", "cannot be written"),
        ("--html", "folder.html", "not a regular file"),
    ] {
        let path = place.path(name).display().to_string();
        let ended = supel_with(panicking, &["reduce", &place.job(), flag, &path]);
        assert_eq!(ended.code, ExitCode::Io, "{flag} {name}: {}", ended.err);
        assert!(ended.err.contains(&path) && ended.err.contains(said), "{flag} {name}: {}", ended.err);
        assert_eq!(place.files(), ["folder.html", "job.toml"]);
    }
}

#[test]
fn a_damaged_superelement_is_an_input_error() {
    let place = Workplace::new();
    let path = place.path("x.supel");
    let mut bytes = sample::superelement().to_bytes().expect("bytes").bytes;
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    std::fs::write(&path, bytes).expect("written");
    let ended = supel(&["inspect", &path.display().to_string()]);
    assert_eq!(ended.code, ExitCode::InputData);
    assert!(ended.err.contains("x.supel: superelement file is damaged"), "{}", ended.err);
}

#[test]
fn inspect_shows_what_is_in_the_file() {
    let place = Workplace::new();
    let path = place.path("x.supel");
    sample::superelement().write(&path).expect("written");
    let file = path.display().to_string();
    let ended = supel(&["inspect", &file]);
    assert_eq!(ended.code, ExitCode::Done);
    insta::assert_snapshot!("inspect_text", ended.out);
    let json: serde_json::Value = serde_json::from_str(&supel(&["inspect", &file, "--json"]).out).expect("json");
    supel_testing::schema::assert_follows(&supel_testing::schema::validator("inspection"), &json);
    assert_eq!(json["sizes"]["n_reduced"], 2);
    assert_eq!(json["frequencies_hz"][0], 0.5);
    assert_eq!(json["metadata"]["interface_nodes"][1]["name"], "foot");
    let job = supel(&["inspect", &file, "--job"]).out;
    let job = Job::parse(&job, Path::new("job.json")).expect("the job");
    assert_eq!(job.write.superelement, Path::new("/models/bracket.supel"));
}

#[test]
fn a_panic_is_reported_as_a_defect() {
    let place = Workplace::new();
    let ended = supel_with(panicking, &["reduce", &place.job()]);
    assert_eq!(ended.code as u8, 70);
    assert!(ended.err.contains("this is a defect of supel"), "{}", ended.err);
    assert_eq!(place.files(), ["job.toml"]);
}

#[test]
fn help_is_an_answer() {
    assert_eq!(supel(&["reduce", "--help"]).code, ExitCode::Done);
    assert!(supel(&["--version"]).out.starts_with("supel "));
    // As a program without a terminal: with one, the text would be broken at its width.
    let help_of = |command: &str| {
        let mut program = std::process::Command::new(assert_cmd::cargo::cargo_bin!("supel"));
        let ended = program.args([command, "--help"]).stdin(std::process::Stdio::null()).env_remove("COLUMNS").output();
        String::from_utf8(ended.expect("ended").stdout).expect("UTF-8")
    };
    insta::assert_snapshot!("help_reduce", help_of("reduce"));
    insta::assert_snapshot!("help_verify", help_of("verify"));
    insta::assert_snapshot!("help_modes", help_of("modes"));
    insta::assert_snapshot!("help_recover", help_of("recover"));
}

#[test]
fn exit_codes_are_those_of_the_contract() {
    use supel::error::ErrorClass::{InputData, Io, ModelPhysics, NumericalLimit, Resources, Usage};
    let classes = [(Usage, 2), (InputData, 3), (ModelPhysics, 4), (NumericalLimit, 5), (Resources, 6), (Io, 7)];
    for (class, code) in classes {
        assert_eq!(ExitCode::from(class) as u8, code);
    }
}

#[test]
fn a_reader_that_goes_away_is_no_panic() {
    let mut program = std::process::Command::new(assert_cmd::cargo::cargo_bin!("supel"))
        .args(["reduce", "--help"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("started");
    drop(program.stdout.take());
    let ended = program.wait_with_output().expect("ended");
    assert_eq!(ended.status.code(), Some(0), "{}", String::from_utf8_lossy(&ended.stderr));
    assert!(ended.stderr.is_empty(), "{}", String::from_utf8_lossy(&ended.stderr));
}

/// Only a program whose stdout is a terminal colours its answer; this one writes to a pipe.
#[test]
fn a_pipe_gets_no_colour() {
    let ended = std::process::Command::new(assert_cmd::cargo::cargo_bin!("supel"))
        .args(["reduce", "--interface"])
        .output()
        .expect("ended");
    assert_eq!(ended.status.code(), Some(2));
    assert!(!ended.stderr.contains(&0x1b));
}

/// On a terminal, which `script` of util-linux makes, the stages are named in one line that is gone when the answer comes.
#[test]
fn a_terminal_shows_the_stages() {
    const CLEARED: &str = "\r\u{1b}[2K";
    if std::process::Command::new("script").arg("--version").output().is_err() {
        eprintln!("SKIPPED: `script` is not installed");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let job = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/bracket/job.toml");
    let program = assert_cmd::cargo::cargo_bin!("supel");
    let command = format!("'{}' reduce '{}' -o bracket.supel", program.display(), job.display());
    let ended = std::process::Command::new("script")
        .args(["--quiet", "--return", "--command", &command, "/dev/null"])
        .current_dir(folder.path())
        .output()
        .expect("ran");
    let said = String::from_utf8_lossy(&ended.stdout);
    assert_eq!(ended.status.code(), Some(0), "{said}");
    let (progress, answer) = said.rsplit_once(CLEARED).expect("a line that is cleared");
    for stage in ["read", "factor", "constraint modes", "modes", "preservation"] {
        assert!(progress.contains(&format!("{CLEARED}  {stage} …")), "{stage}: {progress:?}");
    }
    assert!(answer.contains("verified") && !answer.contains(" …"), "{answer:?}");
}

#[cfg(feature = "hdf5")]
#[test]
fn a_file_that_crashes_the_hdf5_library_is_an_input_error() {
    let place = Workplace::new();
    let fixture = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/hdf5/exudyn.hdf5");
    let mut bytes = std::fs::read(fixture).expect("fixture");
    // A byte of a message header in the metadata: version 1.10 of the library divides by zero when it opens a dataset.
    bytes[6249] = 2;
    let damaged = place.folder.path().join("damaged.hdf5");
    std::fs::write(&damaged, bytes).expect("written");
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin!("supel"));
    command.args(["reduce", "--interface", "hub=rows:0", "--method", "herting", "--modes", "1", "-o", "x.supel"]);
    command.current_dir(place.folder.path()).arg("--stiffness").arg(&damaged).arg("--mass").arg(&damaged);
    let ended = command.output().expect("ran");
    let said = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(3), "{said}");
    assert!(said.contains("damaged.hdf5"), "{said}");
    // Which of the two it is depends on the library's version.
    assert!(said.contains("error[E-HDF5-CRASH]") || said.contains("the HDF5 library says"), "{said}");
}
