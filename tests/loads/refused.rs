//! Loads that a component cannot have.

use supel::cli::ExitCode;
use supel_testing::place::{Place, supel};

use crate::{Case, array, elbow};

const ENDS: &str = r#"{ name = "ends", nodes = [1, 6] }"#;

fn refused(loads: &'static str, fixed: &'static str) -> (ExitCode, String) {
    let case = Case { name: "refused", model: elbow(), interface: ENDS, fixed, loads };
    let (_, ended) = case.run("craig-bampton", 3);
    (ended.code, ended.err)
}

#[track_caller]
fn assert_says((code, said): &(ExitCode, String), expected: ExitCode, words: &[&str]) {
    assert_eq!(*code, expected, "{said}");
    words.iter().for_each(|word| assert!(said.contains(word), "{word:?} is not in {said}"));
}

#[test]
fn mistakes_in_the_job() {
    for (loads, words) in [
        (
            r#"{ name = "a", nodes = [3], force = [0, 0, 1] }, { name = "a", file = "pressure.mtx" }"#,
            ["E-LOAD-NAME", "`a` is defined twice"],
        ),
        (r#"{ name = "a" }"#, ["E-LOAD-KEYS", "`a` has nothing but a name"]),
        (r#"{ name = "a", nodes = [3] }"#, ["E-LOAD-KEYS", "has `nodes` – expected"]),
        (r#"{ name = "a", force = [0, 0, 1] }"#, ["E-LOAD-KEYS", "has `force` – expected"]),
        (r#"{ name = "a", column = 2, rotation = { axis = [0, 0, 1] } }"#, ["E-LOAD-KEYS", "`column` and `rotation`"]),
        (r#"{ name = " ", file = "pressure.mtx" }"#, ["E-JOB-EMPTY", "load[0].name"]),
        (r#"{ name = "a", file = "" }"#, ["E-JOB-EMPTY", "load[0].file"]),
        (r#"{ name = "a", nodes = [3], force = [0, 0, 0] }"#, ["E-ARG", "load[0].force"]),
        (r#"{ name = "a", nodes = [3], force = [0, nan, 0] }"#, ["E-ARG", "load[0].force"]),
        (r#"{ name = "a", rotation = { axis = [0, 0, 0] } }"#, ["E-ARG", "load[0].rotation.axis"]),
        (r#"{ name = "a", rotation = { axis = [0, 0, 1], through = [inf, 0, 0] } }"#, ["E-ARG", "rotation.through"]),
        (r#"{ name = "a", nodes = { rows = [3] }, force = [0, 0, 1] }"#, ["E-JOB-KEY", "load[0].nodes.rows"]),
        (r#"{ name = "a", nodes = [3, 3], force = [0, 0, 1] }"#, ["E-DUP-INTERFACE", "load \"a\": node 3"]),
    ] {
        assert_says(&refused(loads, ""), ExitCode::Usage, &words);
    }
}

#[test]
fn selections_of_nothing() {
    for (loads, words) in [
        (
            r#"{ name = "a", nodes = { within = { sphere = { center = [9, 9, 9], radius = 1 } } }, force = [0, 0, 1] }"#,
            ["E-INTERFACE-EMPTY", "load \"a\" selects no node"],
        ),
        (r#"{ name = "a", nodes = "group:FOOT", force = [0, 0, 1] }"#, ["E-GROUP", "load \"a\": no group \"FOOT\""]),
        (r#"{ name = "a", nodes = [99], force = [0, 0, 1] }"#, ["E-CONSTRAINED-INTERFACE", "load \"a\": node 99"]),
    ] {
        assert_says(&refused(loads, ""), ExitCode::InputData, &words);
    }
}

/// E-LOAD-NOTHING: zeros, a mass on the axis of its rotation, and held dofs that take all of a force.
#[test]
fn loads_that_move_nothing() {
    let held = r#"{ name = "a", nodes = [3, 4], force = [0, 0, 1] }"#;
    let words = ["E-LOAD-NOTHING", "load `a` moves nothing", "all of it on held dofs"];
    assert_says(&refused(held, r#"{ nodes = [3, 4], dofs = ["uz"] }"#), ExitCode::InputData, &words);
    // One of its nodes moves.
    assert_eq!(refused(held, r#"{ nodes = [3], dofs = ["uz"] }"#).0, ExitCode::Done);
    let place = Place::with(&elbow());
    place.write("zero.mtx", array(&[vec![0.0; 36]]).as_bytes());
    let said = of_file(&place, "zero.mtx", "");
    assert_says(&said, ExitCode::InputData, &["E-LOAD-NOTHING", "zero everywhere"]);
}

/// What reducing with a load from a file says.
fn of_file(place: &Place, file: &str, keys: &str) -> (ExitCode, String) {
    let job = format!(
        r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx" }}
interface = [{{ name = "ends", nodes = {{ rows = [0, 1, 2, 3, 4, 5, 30, 31, 32, 33, 34, 35] }} }}]
load      = [{{ name = "a", file = "{file}"{keys} }}]
reduction = {{ method = "craig-bampton", modes = {{ count = 3 }} }}
write     = {{ superelement = "x.supel" }}
"#
    );
    place.write("job.toml", job.as_bytes());
    let ended = supel(&["reduce", &place.text("job.toml")]);
    (ended.code, ended.err)
}

#[test]
fn files_that_are_no_loads() {
    let place = Place::with(&elbow());
    let array_of = |n: usize| array(&[(0..n).map(|row| row as f64 + 1.0).collect()]);
    let places = |rest: &str| format!("%%MatrixMarket matrix coordinate real general\n{rest}");
    let few = array_of(36).trim_end().rsplit_once('\n').expect("lines").0.to_owned();
    let nan = array_of(36).replace("7.00000000000000000e0", "nan");
    let word = array_of(36).replace("7.00000000000000000e0", "seven");
    let two = array_of(36).replace("7.00000000000000000e0", "7 7");
    let several = array(&[vec![1.0; 36], vec![2.0; 36]]);
    for (content, keys, words) in [
        (array_of(35), "", vec!["E-LOAD-ROWS", "load `a` has 35 rows – expected 36"]),
        (array_of(37), "", vec!["E-LOAD-ROWS", "load `a` has 37 rows – expected 36"]),
        (several.clone(), "", vec!["E-LOAD-COLUMN", "the only column of a file of 2 columns"]),
        (several, ", column = 2", vec!["E-LOAD-COLUMN", "column 2 of a file of 2 columns"]),
        (few, "", vec!["E-NNZ", "a.mtx:37", "the end of the file after 35"]),
        (array_of(36) + "1\n", "", vec!["E-NNZ-SURPLUS", ":39:"]),
        (nan, "", vec!["E-NONFINITE", ":9:", "entry (7, 1)", "`nan`"]),
        (word, "", vec!["E-ENTRY", ":9:", "`seven`"]),
        (two, "", vec!["E-ENTRY-EXCESS", ":9:"]),
        ("1 2 3\n".to_owned(), "", vec!["E-LOAD-FORMAT", ":1: not a load – found `1 2 3`"]),
        (array_of(36).replace("real", "complex"), "", vec!["E-LOAD-FORMAT", "array real general"]),
        (array_of(36).replace("36 1", "36"), "", vec!["E-LOAD-FORMAT", ":2:", "`rows columns`"]),
        (places("36 1\n"), "", vec!["E-LOAD-FORMAT", ":2:", "`rows columns entries`"]),
        (places("36 1 1\n37 1 2\n"), "", vec!["E-INDEX", "row 37"]),
        (places("36 1 1\n0 1 2\n"), "", vec!["E-INDEX", "row 0"]),
        (places("36 1 1\n1 2 2\n"), "", vec!["E-INDEX", "column 2"]),
        (places("36 1 1\nx 1 2\n"), "", vec!["E-ENTRY", "`x`"]),
        (places("36 1 99999999999999999999\n"), "", vec!["E-LOAD-FORMAT"]),
        (
            "%%MatrixMarket matrix array real general\n36 18446744073709551615\n".to_owned(),
            ", column = 0",
            vec!["E-LOAD-FORMAT"],
        ),
        (String::new(), "", vec!["E-NO-DATA"]),
        ("%%MatrixMarket matrix array real general\n".to_owned(), "", vec!["E-LOAD-FORMAT", "end of file"]),
    ] {
        place.write("a.mtx", content.as_bytes());
        assert_says(&of_file(&place, "a.mtx", keys), ExitCode::InputData, &words);
        assert!(!place.path("x.supel").exists());
    }
    assert_says(&of_file(&place, "none.mtx", ""), ExitCode::Io, &["E-READ", "none.mtx"]);
}

/// E-LOAD-COORDINATES: nobody knows how far rows are from the axis.
#[test]
fn a_rotation_without_coordinates() {
    let place = Place::with(&elbow());
    let job = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt" }
interface = [{ name = "ends", nodes = { rows = [0, 1, 2, 3, 4, 5, 30, 31, 32, 33, 34, 35] } }]
load      = [{ name = "spin", rotation = { axis = [0, 0, 1] } }]
reduction = { method = "craig-bampton", modes = { count = 3 } }
write     = { superelement = "x.supel" }
"#;
    place.write("job.toml", job.as_bytes());
    let ended = supel(&["reduce", &place.text("job.toml")]);
    assert_says(&(ended.code, ended.err), ExitCode::InputData, &["E-LOAD-COORDINATES", "load `spin`"]);
}

/// E-OUTPUT-INPUT: a report over a load.
#[test]
fn outputs_leave_loads_alone() {
    let place = Place::with(&elbow());
    place.write("load.json", array(&[vec![1.0; 36]]).as_bytes());
    let job = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx" }
load      = [{ name = "a", file = "load.json" }]
reduction = { method = "craig-bampton", modes = { count = 3 } }
write     = { superelement = "x.supel", report = "load.json" }
"#;
    place.write("job.toml", job.as_bytes());
    let ended = supel(&["reduce", &place.text("job.toml")]);
    assert_eq!(ended.code, ExitCode::Usage, "{}", ended.err);
    assert!(ended.err.contains("a load"), "{}", ended.err);
}
