//! What `supel recover` refuses; it leaves nothing behind then.

use supel::cli::ExitCode;
use supel_runtime::{Superelement, Verdict};

use super::{Case, any, files};

#[track_caller]
fn refused(case: &Case, more: &[&str], code: ExitCode, said: &[&str]) {
    let before = files(case);
    let ended = case.recover(more).expect(code);
    assert!(said.iter().all(|words| ended.err.contains(words)), "{said:?} in {}", ended.err);
    assert_eq!(files(case), before, "nothing is left behind");
}

#[test]
fn tables_that_are_not_those_of_the_coordinates() {
    let case = Case::new("craig-bampton");
    let header = case.header();
    let row = any(14, 1).iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let write =
        |header: &str, rows: &[&str]| case.place.write("q.csv", [&[header], rows].concat().join("\n").as_bytes());
    let headers = [
        (header.replace("foot.11.ux", "foot.11.uq"), "`foot.11.uq`, which is no coordinate"),
        (header.replace("foot.11.ux", "foot.1.ux"), "two columns of `foot.1.ux`"),
        (header.replace("foot.11.ux,", ""), "no column `foot.11.ux`"),
        (format!("time,TIME,{header}"), "two columns of `TIME`"),
        (row.clone(), "which is no coordinate"),
    ];
    for (header, said) in headers {
        write(&header, &[&row]);
        refused(&case, &["-o", "u.csv"], ExitCode::InputData, &["E-STATE-COLUMN", said, "14 coordinates"]);
    }
    write(&header.replace("foot.11.ux", "foot.11.uq"), &[&row]);
    refused(&case, &["-o", "u.csv"], ExitCode::InputData, &["did you mean `foot.11.u"]);
    let rows = [
        (format!("{row},1"), "E-TABLE-ROW"),
        (row[..row.rfind(',').expect("columns")].to_owned(), "E-TABLE-ROW"),
        (row.replacen("0.", "nan", 1), "E-TABLE-FIELD"),
        (["inf", "1", "1", "1", "1", "1", "1", "1", "1", "1", "1", "1", "1", "1"].join(","), "E-TABLE-FIELD"),
        // The largest double is finite; what it moves is not.
        (["1.7e308"; 14].join(","), "E-STATE-RANGE"),
    ];
    for (wrong, code) in rows {
        write(&header, &[&row, &wrong]);
        refused(&case, &["-o", "u.csv"], ExitCode::InputData, &[code]);
    }
    write(&header, &[]);
    refused(&case, &["-o", "u.csv"], ExitCode::InputData, &["E-NO-DATA", "a row for each state"]);
}

#[test]
fn velocities_of_other_states() {
    let case = Case::new("craig-bampton");
    let header = format!("time,{}", case.header());
    let states = |times: &[f64]| times.iter().map(|time| [vec![*time], any(14, 3)].concat()).collect::<Vec<_>>();
    case.table("q.csv", &header, &states(&[0.0, 0.5]));
    let others = [
        (&[0.0][..], "1 states"),
        (&[0.0, 0.5, 1.0], "one state more at line 4"),
        (&[0.0, 0.25], "time 0.25 in place of 0.5 at line 3"),
    ];
    for (times, said) in others {
        case.table("v.csv", &header, &states(times));
        refused(&case, &["-o", "u.csv", "--velocity", "v.csv"], ExitCode::InputData, &["E-STATE-ROWS", "v.csv", said]);
        refused(&case, &["-o", "u.csv", "--acceleration", "v.csv"], ExitCode::InputData, &["E-STATE-ROWS", said]);
    }
}

#[test]
fn files_that_hold_nothing_to_recover_and_places_that_are_taken() {
    let case = Case::writing("craig-bampton", "{ name = \"foot\", nodes = [1, 11, 31] }", "");
    case.table("q.csv", &case.header(), &[any(14, 1)]);
    refused(&case, &["-o", "u.csv"], ExitCode::Usage, &["E-NO-RECOVERY", "reduce it with write.recovery"]);
    let case = Case::new("craig-bampton");
    case.table("q.csv", &case.header(), &[any(14, 1)]);
    refused(&case, &["-o", "u.xlsx"], ExitCode::Usage, &["E-OUTPUT-NAME", ".csv"]);
    refused(&case, &["-o", "q.csv"], ExitCode::Usage, &["E-OVERWRITE", "a table of states"]);
    refused(&case, &["-o", "nowhere/u.csv"], ExitCode::Io, &["E-FOLDER"]);
    refused(&case, &["-o", "u.csv", "--velocity", "missing.csv"], ExitCode::Io, &["E-READ"]);
}

/// What was there stays there where a state far down the table is wrong.
#[test]
fn results_appear_whole_or_not_at_all() {
    let case = Case::new("craig-bampton");
    let mut states: Vec<Vec<f64>> = (0..300).map(|seed| any(14, seed)).collect();
    states[299][3] = f64::NAN;
    case.table("q.csv", &case.header(), &states);
    case.place.write("u.csv", b"what was there");
    refused(&case, &["-o", "u.csv"], ExitCode::InputData, &["q.csv:301", "foot.11.ux"]);
    assert_eq!(case.place.bytes("u.csv"), b"what was there");
}

#[test]
fn a_superelement_that_failed_is_used_on_request_only() {
    let case = Case::new("craig-bampton");
    case.table("q.csv", &case.header(), &[any(14, 1)]);
    let superelement = case.place.superelement("x.supel");
    let mut metadata = superelement.metadata().clone();
    metadata.verification.verdict = Verdict::Fail;
    let failed = Superelement::new(superelement.tensors().clone(), metadata).expect("a superelement");
    failed.write(&case.place.path("x.supel")).expect("written");
    refused(&case, &["-o", "u.csv"], ExitCode::CheckFailed, &["--allow-unverified"]);
    case.recover(&["-o", "u.csv", "--allow-unverified"]).expect(ExitCode::CheckFailed);
    assert_eq!(case.rows("u.csv").len(), 135);
}
