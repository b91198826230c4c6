//! The report: its JSON document against its schema, its text against a snapshot.

use serde_json::Value;
use supel::report::{Completeness, Observer, Paint, Report, StageClock, summary};
use supel::verification::check::Verdict;
use supel_testing::sample;

fn validator() -> jsonschema::Validator {
    let schema: Value = serde_json::from_str(include_str!("../schemas/report.schema.json")).expect("schema is JSON");
    jsonschema::validator_for(&schema).expect("schema is a schema")
}

fn document(report: &Report) -> Value {
    serde_json::from_str(&report.to_json().expect("names in UTF-8")).expect("report is JSON")
}

fn violations(document: &Value) -> Vec<String> {
    validator().iter_errors(document).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

#[test]
fn report_follows_its_schema() {
    assert_eq!(violations(&document(&sample::full_report())), Vec::<String>::new());
    assert_eq!(violations(&document(&sample::passing_report())), Vec::<String>::new());
}

#[test]
fn report_without_anything_optional_follows_its_schema() {
    let mut report = sample::passing_report();
    report.body.model.n_nodes = None;
    report.body.model.units = None;
    report.body.model.mass_properties = Default::default();
    report.body.completeness = Completeness::NotCertified { reason: "--certify none was asked".to_owned() };
    report.run.peak_memory_bytes = None;
    report.run.file_bytes = None;
    report.run.superelement = None;
    report.run.report = None;
    assert_eq!(violations(&document(&report)), Vec::<String>::new());
}

#[test]
fn values_that_are_no_numbers_stay_a_document_that_fails() {
    let mut report = sample::passing_report();
    report.body.checks[0].value = f64::NAN;
    report.body.reduction.modes[0].backward_error = f64::INFINITY;
    let document = document(&report);
    assert_eq!(violations(&document), Vec::<String>::new());
    assert_eq!(document["body"]["checks"][0]["value"], Value::Null);
    assert_eq!(document["body"]["checks"][0]["verdict"], "fail");
    assert_eq!(document["body"]["verdict"], "fail");
}

/// Objects that list what there is: a job may do without any of it.
const LISTS: [&str; 3] = ["/body/model/files", "/run/cache/taken", "/run/cache/kept"];
/// What a report may do without: statics has no mass, and most runs have no cache.
const OPTIONAL: [(&str, &str); 2] = [("/body/model", "mass"), ("/run", "cache")];

/// Each object of the schema is closed: a field too many or too few anywhere is refused.
#[test]
fn schema_is_strict_at_every_object() {
    let good = document(&sample::full_report());
    let mut places = Vec::new();
    collect_objects(&good, String::new(), &mut places);
    assert!(places.len() >= 18, "only {} objects found", places.len());
    let validator = validator();
    for place in places {
        let mut more = good.clone();
        more.pointer_mut(&place).and_then(Value::as_object_mut).expect("object").insert("surplus".into(), 1.into());
        assert!(!validator.is_valid(&more), "surplus field accepted at `{place}`");
        if LISTS.contains(&place.as_str()) {
            continue;
        }
        for key in good.pointer(&place).and_then(Value::as_object).expect("object").keys() {
            let mut less = good.clone();
            less.pointer_mut(&place).and_then(Value::as_object_mut).expect("object").remove(key);
            let may_lack = OPTIONAL.contains(&(place.as_str(), key.as_str()));
            assert_eq!(validator.is_valid(&less), may_lack, "`{place}` without `{key}`");
        }
    }
}

fn collect_objects(value: &Value, place: String, places: &mut Vec<String>) {
    match value {
        Value::Object(fields) => {
            fields.iter().for_each(|(key, field)| collect_objects(field, format!("{place}/{key}"), places));
            places.push(place);
        }
        Value::Array(items) => {
            // One element speaks for a list.
            items.iter().take(1).for_each(|item| collect_objects(item, format!("{place}/0"), places));
        }
        _ => {}
    }
}

#[test]
fn verdicts_follow_from_values_and_limits() {
    let report = sample::full_report();
    let checks = document(&report)["body"]["checks"].clone();
    let of = |idx: usize| (checks[idx]["verdict"].clone(), checks[idx]["active_limit"].clone());
    assert_eq!(of(0), ("pass".into(), "engineering".into()));
    assert_eq!(of(1), ("warn".into(), "data".into()));
    assert_eq!(of(2), ("fail".into(), "arithmetic".into()));
    // Shown, not judged: no limit, no margin, and no part in the verdict.
    assert_eq!(of(3), ("info".into(), Value::Null));
    assert_eq!([&checks[3]["limit"], &checks[3]["margin"], &checks[3]["fail_above"]], [&Value::Null; 3]);
    // 4e-9 or the like would show that the margin is not limit over value: 1e-13 / 3.1e-16 = 322.58….
    assert!((checks[0]["margin"].as_f64().expect("margin") - 1e-13 / 3.1e-16).abs() < 1e-9);
    assert_eq!(report.body.verdict(), Verdict::Fail);
    assert_eq!(sample::passing_report().body.verdict(), Verdict::Pass);
}

#[test]
fn warnings_and_missing_modes_weigh_in_the_verdict() {
    let mut warned = sample::passing_report();
    warned.body.warnings = sample::full_report().body.warnings;
    assert_eq!(warned.body.verdict(), Verdict::Warn);
    let mut incomplete = sample::passing_report();
    incomplete.body.completeness = Completeness::SturmCount { below_hz: 1.0, n_counted: 8, n_found: 7, doubt: 0.0 };
    assert!(!incomplete.body.completeness.is_certified());
    assert_eq!(incomplete.body.verdict(), Verdict::Fail);
    let mut likely = sample::passing_report();
    likely.body.completeness = Completeness::SturmCount { below_hz: 1.0, n_counted: 8, n_found: 8, doubt: 1.5 };
    assert!(!likely.body.completeness.is_certified() && likely.body.completeness.statement().contains("likely"));
    assert_eq!(likely.body.verdict(), Verdict::Warn);
}

#[test]
fn body_has_no_facts_of_the_run() {
    let one = sample::passing_report();
    let mut other = sample::passing_report();
    other.run = Default::default();
    assert_eq!(document(&one)["body"], document(&other)["body"]);
}

#[test]
fn summary_reads_well() {
    insta::assert_snapshot!("summary_failing", summary(&sample::full_report(), Paint::Plain));
    insta::assert_snapshot!("summary_passing", summary(&sample::passing_report(), Paint::Plain));
}

#[test]
fn summary_fits_the_page_and_colour_changes_no_text() {
    let report = sample::full_report();
    let plain = summary(&report, Paint::Plain);
    for line in plain.lines() {
        assert!(line.chars().count() <= 100, "{} columns: {line}", line.chars().count());
    }
    let coloured = summary(&report, Paint::Colour);
    assert!(coloured.contains('\x1b'));
    let mut stripped = String::new();
    for (piece_idx, piece) in coloured.split('\x1b').enumerate() {
        stripped.push_str(if piece_idx == 0 { piece } else { piece.split_once('m').expect("sequence ends").1 });
    }
    // Blanks before a colour's end cannot be trimmed from the line.
    let lines = |text: &str| -> Vec<String> { text.lines().map(|line| line.trim_end().to_owned()).collect() };
    assert_eq!(lines(&stripped), lines(&plain));
}

#[test]
fn report_appears_whole_or_not_at_all() {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("a.report.json");
    sample::passing_report().write(&path).expect("written");
    assert_eq!(std::fs::read_to_string(&path).expect("read"), sample::passing_report().to_json().expect("JSON"));
    assert_eq!(std::fs::read_dir(folder.path()).expect("folder").count(), 1, "temporary file left");
    let error = sample::passing_report().write(&folder.path().join("missing/a.json")).expect_err("no such folder");
    assert_eq!(error.class(), supel::error::ErrorClass::Io);
}

#[test]
fn stage_clock_measures_each_stage_once_and_passes_it_on() {
    struct Names(Vec<&'static str>);
    impl Observer for Names {
        fn stage(&mut self, name: &'static str) {
            self.0.push(name);
        }
    }
    let mut names = Names(Vec::new());
    let mut clock = StageClock::new(&mut names);
    clock.stage("factor");
    std::thread::sleep(std::time::Duration::from_millis(20));
    clock.stage("modes");
    clock.stage("factor");
    let times = clock.finish();
    assert_eq!(times.iter().map(|time| time.name).collect::<Vec<_>>(), ["factor", "modes"]);
    assert!(times[0].seconds >= 0.02, "{}", times[0].seconds);
    assert!(times[1].seconds < 0.02, "{}", times[1].seconds);
    assert_eq!(names.0, ["factor", "modes", "factor"]);
}
