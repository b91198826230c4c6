//! Many jobs by one command: those of a folder, and those of an assembly, whose joined interfaces are compared.

use serde_json::Value;
use supel::cli::ExitCode;
use supel::error::Error;
use supel_models::Model;
use supel_testing::place::{Ended, Place, supel_as_typed};
use supel_testing::schema::{assert_follows, validator};

use crate::{beams, line};

/// Writes a model and a job of two interfaces, the nodes 1 and 7, as NAME-K.mtx and so on and NAME.toml.
fn write_component(place: &Place, name: &str, (model, units): (&Model, &str)) {
    let own = Place::with(model);
    for file in ["K.mtx", "M.mtx", "dofs.txt", "nodes.csv"] {
        place.write(&format!("{name}-{file}"), &own.bytes(file));
    }
    let job = format!(
        r#"
interface = [{{ name = "first", nodes = [1] }}, {{ name = "last", nodes = [7] }}]
reduction = {{ method = "craig-bampton", modes = {{ count = 4 }} }}
write     = {{ superelement = "{name}.supel" }}

[model]
stiffness = "{name}-K.mtx"
mass      = "{name}-M.mtx"
dofs      = "{name}-dofs.txt"
nodes     = "{name}-nodes.csv"
units     = "{units}"
"#
    );
    place.write(&format!("{name}.toml"), job.as_bytes());
}

/// A line of beams in two halves, which meet in the last node of the left one and the first of the right one.
fn halves(units_of_right: &str) -> Place {
    let place = Place::new();
    write_component(&place, "left", (&beams(&line()[..7]), "m-kg-s"));
    write_component(&place, "right", (&beams(&line()[6..]), units_of_right));
    place
}

const ASSEMBLY: &str = r#"
join = ["left.last=right.first"]

[[component]]
name = "left"
job  = "left.toml"

[[component]]
name = "right"
job  = "right.toml"
"#;

fn reduce_all(place: &Place, name: &str, flags: &[&str]) -> Ended {
    supel_as_typed(supel::PIPELINE, &[&["reduce", "--all", &place.text(name)], flags].concat())
}

/// The JSON answer, held against its schema.
#[track_caller]
fn answered(ended: &Ended) -> Value {
    let document = serde_json::from_str(&ended.out).unwrap_or_else(|_| panic!("{}{}", ended.out, ended.err));
    assert_follows(&validator("reductions"), &document);
    document
}

/// What became of each component: its name, its outcome, and the code of its error.
fn outcomes(document: &Value) -> Vec<[&str; 3]> {
    let rows = document["components"].as_array().expect("rows").iter();
    let text = |value: &Value, key: &str| value[key].as_str().unwrap_or("").to_owned().leak() as &str;
    rows.map(|row| [text(row, "name"), text(row, "outcome"), text(&row["error"], "code")]).collect()
}

#[test]
fn a_folder_is_reduced_and_what_is_up_to_date_is_not_again() {
    let place = halves("m-kg-s");
    std::fs::create_dir_all(place.path("below/.hidden")).expect("folders");
    let broken = std::fs::read_to_string(place.path("left.toml")).expect("a job").replace("left-K", "none-K");
    place.write("below/broken.toml", broken.as_bytes());
    place.write("below/.hidden/job.toml", broken.as_bytes());
    place.write("notes.toml", b"author = \"nobody\"\n");
    place.write("typo.toml", b"model = {{\n");
    let first = reduce_all(&place, "", &["--json"]).expect(ExitCode::Io);
    assert!(first.err.contains("notes.toml: passed over"), "{}", first.err);
    let document = answered(&first);
    let failed = [["below/broken", "failed", "E-READ"], ["typo", "failed", "E-JOB"]];
    let expected = |outcome| [failed[0], ["left", outcome, ""], ["right", outcome, ""], failed[1]];
    assert_eq!(outcomes(&document), expected("reduced"));
    assert_eq!(document["exit_code"], ExitCode::Io as u8);

    let text = reduce_all(&place, "", &[]).expect(ExitCode::Io);
    assert!(text.out.contains("2 of 4 components not verified"), "{}", text.out);
    let again = answered(&reduce_all(&place, "", &["--json"]));
    assert_eq!(outcomes(&again), expected("up-to-date"));
    let forced = answered(&reduce_all(&place, "", &["--json", "--force"]));
    assert_eq!(outcomes(&forced), expected("reduced"));
    let quiet = reduce_all(&place, "", &["--quiet"]).expect(ExitCode::Io);
    assert_eq!(quiet.out, "");
    assert!(quiet.err.contains("below/broken: error[E-READ]"), "{}", quiet.err);
}

/// A link that leads nowhere, or to itself, stands where a job was meant to be.
#[cfg(unix)]
#[test]
fn a_link_to_no_document_is_a_job_that_fails() {
    let place = halves("m-kg-s");
    std::os::unix::fs::symlink("gone.toml", place.path("lost.toml")).expect("a link");
    std::os::unix::fs::symlink("self.toml", place.path("self.toml")).expect("a link");
    let ended = reduce_all(&place, "", &["--json"]).expect(ExitCode::Io);
    let document = answered(&ended);
    let found = outcomes(&document);
    let failed = ["lost", "self"].map(|name| [name, "failed", "E-READ"]);
    assert_eq!(found, [["left", "reduced", ""], failed[0], ["right", "reduced", ""], failed[1]]);
}

/// By the program, which runs both at the same time, each in a process of its own.
#[test]
fn side_by_side_each_has_the_bytes_that_it_has_alone() {
    let place = halves("m-kg-s");
    let program = || assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("supel"));
    let output =
        program().args(["reduce", "--all", &place.text(""), "--threads", "2", "--json"]).output().expect("run");
    let text = String::from_utf8_lossy(&output.stdout);
    let document: Value = serde_json::from_str(&text).expect("an answer");
    assert_follows(&validator("reductions"), &document);
    assert_eq!(outcomes(&document), [["left", "reduced", ""], ["right", "reduced", ""]]);
    assert_eq!(output.status.code(), Some(0), "{text}{}", String::from_utf8_lossy(&output.stderr));
    for name in ["left", "right"] {
        let together = place.bytes(&format!("{name}.supel"));
        program().args(["reduce", &place.text(&format!("{name}.toml")), "--force"]).assert().success();
        assert!(together == place.bytes(&format!("{name}.supel")), "{name} has other bytes");
    }
}

#[test]
fn interfaces_that_an_assembly_joins_are_compared() {
    let place = halves("m-kg-s");
    place.write("assembly.toml", ASSEMBLY.as_bytes());
    let document = answered(&reduce_all(&place, "assembly.toml", &["--json"]).expect(ExitCode::Done));
    let join = &document["joins"][0];
    assert_eq!((join["n_nodes"].as_u64(), join["n_dofs"].as_u64()), (Some(1), Some(6)), "{join}");
    place.write("turned.toml", ASSEMBLY.replace("right.first", "right.last").as_bytes());
    let apart = reduce_all(&place, "turned.toml", &["--json"]);
    let document = answered(&apart);
    assert_eq!(document["joins"][0]["error"]["code"], "E-JOIN-POSITION");
    assert_eq!(apart.code as u8, document["exit_code"].as_u64().expect("a code") as u8);
    assert_ne!(apart.code, ExitCode::Done);
    let text = reduce_all(&place, "turned.toml", &[]);
    assert!(text.out.contains("joined interfaces do not fit: 1 pair"), "{}", text.out);
    let reason = document["joins"][0]["error"]["message"].as_str().expect("a message");
    assert!(text.err.contains("error[E-JOIN-POSITION]") && text.err.contains(reason), "{}", text.err);

    let place = halves("mm-t-s");
    place.write("assembly.toml", ASSEMBLY.as_bytes());
    let document = answered(&reduce_all(&place, "assembly.toml", &["--json"]));
    assert_eq!(document["joins"][0]["error"]["code"], "E-JOIN-UNITS");
}

/// A component whose check fails has no superelement to compare: the pair is not at fault, nor the document that joins it.
#[test]
fn a_pair_is_not_compared_without_a_superelement() {
    let place = halves("m-kg-s");
    place.write("assembly.toml", ASSEMBLY.as_bytes());
    let job = String::from_utf8(place.bytes("left.toml")).expect("text");
    place.write("left.toml", format!("{job}expect = {{ mass = 1e9 }}\n").as_bytes());
    let ended = reduce_all(&place, "assembly.toml", &["--json"]).expect(ExitCode::CheckFailed);
    let document = answered(&ended);
    let join = &document["joins"][0];
    assert_eq!((join["not_compared"].as_str(), join["error"].is_null()), (Some("left"), true), "{join}");
    let text = reduce_all(&place, "assembly.toml", &[]).expect(ExitCode::CheckFailed);
    assert!(text.out.contains("not compared, `left` has no verified superelement"), "{}", text.out);
    assert!(text.out.contains("1 of 2 components not verified") && !text.out.contains("do not fit"), "{}", text.out);
    assert!(!text.err.contains("E-ASSEMBLY-NAME"), "{}", text.err);
}

/// Two wheels of one job: it runs once, whichever way its document is named, and both components have what it made.
#[test]
fn a_job_of_several_components_is_reduced_once() {
    let place = halves("m-kg-s");
    std::fs::create_dir_all(place.path("below")).expect("a folder");
    let wheels = ASSEMBLY.replace("right.toml", "below/../left.toml").replace("right.first", "right.last");
    place.write("assembly.toml", wheels.as_bytes());
    for outcome in ["reduced", "up-to-date"] {
        let document = answered(&reduce_all(&place, "assembly.toml", &["--json"]).expect(ExitCode::Done));
        assert_eq!(outcomes(&document), [["left", outcome, ""], ["right", outcome, ""]]);
        assert_eq!(document["components"][0]["superelement"], document["components"][1]["superelement"]);
        assert_eq!(document["joins"].as_array().map(Vec::len), Some(1), "{}", document["joins"]);
    }
}

/// A document in capitals is a job as any other, and a name of several lines has one line of the table.
#[test]
fn names_of_any_kind_have_one_line_of_the_table() {
    let place = halves("m-kg-s");
    std::fs::rename(place.path("left.toml"), place.path("LEFT.TOML")).expect("renamed");
    std::fs::rename(place.path("right.toml"), place.path("ri\nght.toml")).expect("renamed");
    let said = reduce_all(&place, "", &[]).expect(ExitCode::Done).out;
    let of = |name: &str| said.lines().find(|line| line.contains(name)).unwrap_or_else(|| panic!("{said}"));
    let column = |line: &str| line.split("verified").next().map(|before| before.chars().count());
    assert_eq!(column(of("  LEFT ")), column(of("  ri\\nght ")), "{said}");
}

#[test]
fn what_cannot_be_many_jobs_is_refused_before_anything_runs() {
    let place = halves("m-kg-s");
    std::fs::create_dir(place.path("empty")).expect("a folder");
    let refused = |name: &str, code: &str| {
        let ended = reduce_all(&place, name, &[]);
        assert!(ended.err.contains(&format!("error[{code}]")), "{name}: {}{}", ended.out, ended.err);
        assert!(!place.path("left.supel").exists(), "{name}");
        ended.err
    };
    refused("empty", "E-NO-JOBS");
    refused("missing", "E-READ");
    place.write("none.toml", b"component = []\n");
    refused("none.toml", "E-NO-JOBS");
    place.write("twice.toml", ASSEMBLY.replace("name = \"right\"", "name = \"left\"").as_bytes());
    refused("twice.toml", Error::ComponentTwice { name: String::new() }.code());
    place.write("odd.toml", ASSEMBLY.replace("join", "joins").as_bytes());
    refused("odd.toml", "E-JOB");
    let same = std::fs::read_to_string(place.path("right.toml")).expect("a job").replace("right.supel", "left.supel");
    place.write("right.toml", same.as_bytes());
    place.write("assembly.toml", ASSEMBLY.as_bytes());
    let told = refused("assembly.toml", "E-OUTPUT-TWICE");
    let named = ["left.toml", "right.toml"].map(|name| told.contains(&format!("of {}", place.text(name))));
    assert_eq!(named, [true; 2], "{told}");
}
