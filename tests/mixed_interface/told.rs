//! What report, page and file say of the boundary, and whether a comparison notices another one.

use serde_json::{Value, json};
use supel::cli::ExitCode;
use supel_runtime::{Coordinate, Superelement};
use supel_testing::place::{Place, supel};

use crate::Case;

const BASE: &str = r#"method = "mixed-interface", modes = { count = 6 }, held = ["base", "tip.uz"]"#;

#[test]
fn report_page_and_file_tell_what_was_held() {
    let place = Place::with_brick();
    let text = Case::of(BASE).run(&place).expect(ExitCode::Done).out;
    assert!(text.contains("mixed-interface (base, tip.uz held)"), "{text}");
    let report = place.report("x.report.json");
    let schema: Value = serde_json::from_str(include_str!("../../schemas/report.schema.json")).expect("a schema");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let violations: Vec<String> = validator.iter_errors(&report).map(|error| error.to_string()).collect();
    assert_eq!(violations, Vec::<String>::new());
    let reduction = &report["body"]["reduction"];
    assert_eq!(reduction["modes_held"], json!(["base", "tip.uz"]));
    assert_eq!(reduction["modes"][0]["kind"], "mixed-interface");
    assert_eq!(report["body"]["trust_intervals"][0]["kind"], "mixed-interface");
    let page = String::from_utf8(place.bytes("x.html")).expect("UTF-8");
    assert!(page.contains("6 mixed-interface (base, tip.uz held) modes"));
    let shown = supel(&["inspect", &place.text("x.supel")]).expect(ExitCode::Done).out;
    assert!(shown.contains("base ux uy uz, tip uz while modes were computed"), "{shown}");
    let file = place.superelement("x.supel");
    assert_eq!(file.metadata().job["reduction"]["held"], json!(["base", "tip.uz"]));
}

/// The file with one change, verified by itself and with its job; the checks that fail.
fn changed(place: &Place, change: impl Fn(&mut supel_runtime::Metadata)) -> [Vec<String>; 2] {
    let file = place.superelement("x.supel");
    let mut metadata = file.metadata().clone();
    change(&mut metadata);
    let altered = Superelement::new(file.tensors().clone(), metadata).expect("a superelement");
    altered.write(&place.path("altered.supel")).expect("written");
    let altered = place.text("altered.supel");
    let job = place.text("job.toml");
    [&["verify", "--json", &altered][..], &["verify", "--json", &altered, "--job", &job][..]].map(|args| {
        let said: Value = serde_json::from_str(&supel(args).out).expect("JSON");
        let checks = said["checks"].as_array().expect("a list").iter();
        let failed = checks.filter(|check| check["verdict"] == "fail");
        failed.map(|check| check["id"].as_str().expect("an identifier").to_owned()).collect()
    })
}

/// Another boundary than the one of the modes is noticed by their equations, by the file alone.
#[test]
fn another_boundary_is_noticed() {
    let place = Place::with_brick();
    Case::of(BASE).made(&place);
    let [alone, with_job] = changed(&place, |_| {});
    assert!(alone.is_empty() && with_job.is_empty(), "{alone:?} {with_job:?}");
    for (what, held) in
        [("fewer", (0..9).collect::<Vec<usize>>()), ("others", vec![0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 15])]
    {
        let [alone, with_job] = changed(&place, |metadata| metadata.modes_held.clone_from(&held));
        for id in ["M-14", "M-26"] {
            assert!(alone.iter().any(|found| found == id), "{what}: {alone:?}");
        }
        assert!(with_job.iter().any(|found| found == "M-26"), "{what}: {with_job:?}");
    }
    // Modes said to be those of another boundary.
    let [alone, with_job] = changed(&place, |metadata| {
        for coordinate in &mut metadata.coordinates {
            if let Coordinate::MixedInterfaceMode { mode, frequency_hz, error_bar_hz } = *coordinate {
                *coordinate = Coordinate::FixedInterfaceMode { mode, frequency_hz, error_bar_hz };
            }
        }
    });
    assert!(alone.iter().any(|id| id == "M-26"), "{alone:?}");
    assert!(with_job.iter().any(|id| id == "M-26"), "{with_job:?}");
}

/// A job that holds something else makes another superelement.
#[test]
fn a_job_that_holds_something_else_is_noticed() {
    let place = Place::with_brick();
    Case::of(BASE).made(&place);
    let file = place.bytes("x.supel");
    Case::of(r#"method = "mixed-interface", modes = { count = 6 }, held = ["base"]"#)
        .run(&place)
        .expect(ExitCode::Done);
    place.write("x.supel", &file);
    let said = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
    assert_eq!(said.code, ExitCode::CheckFailed, "{}", said.out);
    assert!(said.out.contains("M-26") && said.out.contains("held"), "{}", said.out);
}

/// A superelement exported as a model and reduced again by its own job is itself.
#[test]
fn an_exported_model_has_the_boundary_in_its_job() {
    let place = Place::with_brick();
    Case::of(BASE).made(&place);
    supel(&["export", &place.text("x.supel"), "--to", "matrix-market"]).expect(ExitCode::Done);
    let text = String::from_utf8(place.bytes("x.job.toml")).expect("a job");
    assert!(text.contains(r#"method = "mixed-interface""#), "{text}");
    supel(&["reduce", &place.text("x.job.toml")]).expect(ExitCode::Done);
    let [first, again] = ["x.supel", "x.again.supel"].map(|name| place.superelement(name));
    assert_eq!(again.metadata().modes_held, first.metadata().modes_held);
    let frequencies = |file: &Superelement| file.tensors().frequencies.clone();
    for (found, expected) in frequencies(&again).iter().zip(&frequencies(&first)) {
        // Both are known by bars below 1e-9 here, and K̂ to thirteen digits.
        assert!((found / expected - 1.0).abs() <= 1e-8, "{found} for {expected}");
    }
}
