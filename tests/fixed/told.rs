//! What report, page and file say of held dofs.

use serde_json::{Value, json};
use supel::cli::ExitCode;
use supel::memory_forecast::Resources;
use supel::verification::check::Verdict;
use supel_runtime::{Metadata, Superelement};
use supel_testing::place::{Place, steel_brick, supel};

use crate::Case;

fn case() -> Case {
    let fixed = r#"{ name = "foot", nodes = [1, 6, 11] }, { nodes = { within = { box = { min = [0, 0, 0], max = [0, 1, 0] } } }, dofs = ["ux", "uz"] }"#;
    let interface = r#"{ name = "tip", nodes = [5, 15, 45] }"#;
    Case { name: "told", model: steel_brick(), interface, fixed, has_nodes: true }
}

#[test]
fn report_page_and_file_name_what_is_held() {
    let (place, ended) = case().run("herting", 4);
    let text = ended.expect(ExitCode::Done).out;
    let line = "held              9 of 135 dofs · foot: 3 nodes, 9 dofs · fixed[1]: 3 nodes, 6 dofs";
    assert!(text.contains(line), "{text}");
    let report = place.report("x.report.json");
    let held = json!({ "n_dofs": 9, "selections": [
        { "name": "foot", "n_nodes": 3, "n_dofs": 9 }, { "name": "fixed[1]", "n_nodes": 3, "n_dofs": 6 }] });
    assert_eq!(report["body"]["model"]["held"], held);
    let schema: Value = serde_json::from_str(include_str!("../../schemas/report.schema.json")).expect("a schema");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let violations: Vec<String> = validator.iter_errors(&report).map(|error| error.to_string()).collect();
    assert_eq!(violations, Vec::<String>::new());
    let page = String::from_utf8(place.bytes("x.html")).expect("UTF-8");
    assert!(page.contains("Held at rest") && page.contains("foot: 3 nodes, 9 dofs"), "the page names them");
    let file = place.superelement("x.supel");
    let expected =
        ["foot is at rest: every direction of the nodes 1, 6, 11", "fixed[1] is at rest: ux uz of the nodes in a box"];
    assert_eq!(file.metadata().validity.assumptions, expected);
    let shown = supel(&["inspect", &place.text("x.supel")]).expect(ExitCode::Done).out;
    expected.iter().for_each(|sentence| assert!(shown.contains(sentence), "{shown}"));
}

/// A component of which the job holds nothing says nothing of it.
#[test]
fn nothing_is_said_where_nothing_is_held() {
    let case = Case { fixed: "", ..case() };
    let made = case.made("herting", 4);
    assert_eq!(made.report["body"]["model"].get("held"), None);
    assert!(made.file.metadata().validity.assumptions.is_empty());
}

/// `--fix` is `[[fixed]]`: in place of one of its name, or after the others.
#[test]
fn flags_hold_dofs() {
    let place = Place::with_brick();
    let flags =
        "--interface tip=5,15,45 --method herting --modes 3 --fix foot=1,6,11 --fix wall=2:ux,uz --fix rest=rows:33";
    place.reduce(&place.model_flags(), flags).expect(ExitCode::Done);
    let report = place.report("x.report.json");
    let held = &report["body"]["model"]["held"];
    assert_eq!(held["n_dofs"], 12);
    assert_eq!(held["selections"][2], json!({ "name": "rest", "n_dofs": 1 }));
    let (place, _) = case().run("herting", 3);
    let job = place.text("job.toml");
    let ended = supel(&["reduce", &job, "--fix", "foot=1:ux", "--fix", "more=26,31"]).expect(ExitCode::Done);
    assert!(ended.err.contains("the flag replaces fixed \"foot\" of the job"), "{}", ended.err);
    assert!(ended.err.contains("the flag adds fixed \"more\" to the 2 of the job"), "{}", ended.err);
    let report = place.report("x.report.json");
    let names: Vec<&Value> = report["body"]["model"]["held"]["selections"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|held| &held["name"])
        .collect();
    assert_eq!(names, ["foot", "fixed[1]", "more"]);
}

/// Another assumption, none, or a job that holds something else, each sealed again: by the file alone and by the job.
#[test]
fn a_file_that_says_other_dofs_are_held_is_refused() {
    let made = case().made("herting", 4);
    let job = supel::job::Job::read(&made.place.path("job.toml")).expect("a job");
    let check = |file: &Superelement, with_job: Option<&supel::job::Job>| {
        supel::verify(file, with_job, Resources::default(), &mut ()).expect("an audit").verdict()
    };
    assert_ne!([check(&made.file, None), check(&made.file, Some(&job))], [Verdict::Fail; 2]);
    let altered = |alter: &dyn Fn(&mut Metadata)| {
        let mut metadata = made.file.metadata().clone();
        alter(&mut metadata);
        Superelement::new(made.file.tensors().clone(), metadata).expect("a file")
    };
    let files = [
        altered(&|metadata| metadata.validity.assumptions[0] = "nobody pulls".to_owned()),
        altered(&|metadata| metadata.validity.assumptions.clear()),
        altered(&|metadata| metadata.job["fixed"][0]["nodes"] = json!([1, 6, 16])),
        altered(&|metadata| metadata.job["fixed"] = json!([])),
    ];
    for (at, file) in files.iter().enumerate() {
        assert_eq!(check(file, None), Verdict::Fail, "alteration {at} alone");
    }
    // The words are the only sign where the job kept in the file is believed.
    assert_eq!(check(&files[0], Some(&job)), Verdict::Fail);
}
