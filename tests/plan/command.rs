//! `supel plan`: what it says is what `supel reduce` does.

use assert_cmd::Command;
use serde_json::Value;
use supel::cli::ExitCode;
use supel_testing::place::{Place, supel};

use crate::{CRAIG_BAMPTON, Case, HERTING, PATCH_AND_NODES, PATCHES, model};

/// The plan of a case as JSON, seen to follow its schema.
#[track_caller]
fn planned(case: &Case, flags: &[&str]) -> Value {
    let place = Place::with(&model());
    place.write("job.toml", case.job().as_bytes());
    let job = place.text("job.toml");
    let text = supel(&[&["plan", &job, "--json"], flags].concat()).expect(ExitCode::Done).out;
    let document: Value = serde_json::from_str(&text).expect("JSON");
    let schema: Value = serde_json::from_str(include_str!("../../schemas/plan.schema.json")).expect("a schema");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let violations: Vec<String> =
        validator.iter_errors(&document).map(|error| format!("{}: {error}", error.instance_path())).collect();
    assert_eq!(violations, Vec::<String>::new());
    document
}

/// What becomes of a stage: `needed_by`, `skipped_by` or `left_out`.
fn stage<'a>(document: &'a Value, name: &str) -> &'a Value {
    let stages = document["stages"].as_array().expect("stages");
    stages.iter().find(|stage| stage["name"] == name).expect("a stage of that name")
}

#[test]
fn what_the_plan_says_is_what_the_run_does() {
    for (method, scene, write) in [
        (CRAIG_BAMPTON, "", ""),
        (HERTING, "", ", recovery = { nodes = [18, 45] }"),
        ("method = \"herting\"", "band_hz = [0, 1500]", ""),
        (HERTING, "analysis = \"static\"\ngravity = false", ""),
        (HERTING, "analysis = \"static\"", ""),
        (CRAIG_BAMPTON, "unloaded = [\"tip.rx\"]\ngrounded = [\"root\"]", ""),
    ] {
        let case = Case { write, ..Case::new(PATCHES, method, scene) };
        let plan = planned(&case, &[]);
        let made = case.made();
        let (answer, of_model) = (&plan["answer"], &plan["model"]);
        assert_eq!(answer["n_coordinates"], made.file.n_coordinates(), "{method} {scene}");
        assert_eq!(of_model["n_interface"], made.n_b(), "{method} {scene}");
        assert_eq!(of_model["n_rigid"], made.file.n_rigid(), "{method} {scene}");
        assert_eq!(plan["modes"]["count"], made.file.tensors().frequencies.len(), "{method} {scene}");
        let bytes = made.report["run"]["file_bytes"].as_f64().expect("bytes");
        let ratio = answer["file_bytes"].as_f64().expect("bytes") / bytes;
        assert!((0.6..1.6).contains(&ratio), "{method} {scene}: {ratio}");
        let assumptions: Vec<&str> =
            plan["assumptions"].as_array().expect("a list").iter().filter_map(Value::as_str).collect();
        assert_eq!(assumptions, made.assumptions(), "{method} {scene}");
        // Every stage of the run has its line.
        for run in made.report["run"]["stages"].as_array().expect("stages") {
            let name = run["name"].as_str().expect("a name");
            let named = plan["stages"].as_array().expect("stages").iter().any(|stage| {
                let of_plan = stage["name"].as_str().expect("a name");
                of_plan == name || of_plan.starts_with(&format!("{name} of"))
            });
            assert!(named || name == "write", "{method} {scene}: {name}");
        }
    }
}

/// A load without its residual vector has none, nor has one on the interface, no model has more modes than dofs, and a motion that the held interface does not let pass is elastic.
#[test]
fn coordinates_are_counted_as_the_run_makes_them() {
    const MIXED: &str = r#"method = "mixed-interface", held = ["root"], modes = { up_to_hz = 2500 }"#;
    const FORCE: &str = "[[load]]\nname = \"f\"\nnodes = [18]\nforce = [0, 1, 2]\n";
    const FORCE_ALONE: &str = "[[load]]\nname = \"f\"\nnodes = [18]\nforce = [0, 1, 2]\nresidual = false\n";
    const AT_TIP: &str = "[[load]]\nname = \"f\"\nnodes = [7, 28, 63]\nforce = [0, 1, 2]\n";
    const ALL: &str = r#"method = "craig-bampton", modes = { count = 400 }"#;
    for (reduction, rest) in
        [(MIXED, ""), (CRAIG_BAMPTON, FORCE_ALONE), (CRAIG_BAMPTON, FORCE), (CRAIG_BAMPTON, AT_TIP), (ALL, "")]
    {
        let case = Case { rest, ..Case::new(PATCHES, reduction, "") };
        let (plan, made) = (planned(&case, &[]), case.made());
        assert_eq!(plan["answer"]["n_coordinates"], made.file.n_coordinates(), "{reduction} {rest}");
        assert_eq!(plan["modes"]["count"], made.file.tensors().frequencies.len(), "{reduction}");
    }
}

/// The vectors of a comparison that is left out are not held.
#[test]
fn what_is_not_compared_takes_no_memory() {
    let guyan = r#"method = "guyan""#;
    let bytes = |scene: &'static str| {
        let plan = planned(&Case::new(PATCHES, guyan, scene), &[]);
        let compared = stage(&plan, "frequency response")["needed_by"].is_string();
        (compared, plan["memory"]["vector_bytes"].as_f64().expect("bytes"))
    };
    let (without, with) = (bytes(""), bytes("band_hz = [0, 1500]"));
    assert_eq!((without.0, with.0), (false, true));
    // Two rigid patches: twelve columns in a few blocks, where a response takes ten blocks of eighty.
    assert!(without.1 < 0.3 * with.1, "{without:?} {with:?}");
}

/// Every output has a part in every point of the scans between samples, and light damping makes these many.
#[test]
fn outputs_and_light_damping_take_time() {
    let seconds = |scene: &'static str| {
        let plan = planned(&Case::new(PATCHES, HERTING, scene), &[]);
        stage(&plan, "frequency response")["flops"].as_f64().expect("operations")
    };
    let plain = seconds("band_hz = [50, 1500]");
    let with_outputs = seconds(
        "band_hz = [50, 1500]\noutputs = { nodes = { within = { box = { min = [0, 0, 0], max = [9, 9, 9] } } } }",
    );
    let lightly_damped = seconds("band_hz = [50, 1500]\ndamping = { ratio = 0.001 }");
    // 252 outputs, of which 48 are followed; ten times as many steps.
    assert!(with_outputs > 2.0 * plain, "{with_outputs} {plain}");
    assert!(lightly_damped > 2.0 * plain, "{lightly_damped} {plain}");
}

#[test]
fn stages_that_a_scene_never_asks_for_are_skipped_by_their_rules() {
    let whole = planned(&Case::new(PATCHES, HERTING, ""), &[]);
    let statics = planned(&Case::new(PATCHES, HERTING, "analysis = \"static\"\ngravity = false"), &[]);
    for name in ["modes", "certificate", "enclosures"] {
        assert_eq!(stage(&statics, name)["skipped_by"], "K-1", "{name}");
        assert_eq!(stage(&statics, name)["flops"], 0.0);
    }
    assert_eq!(stage(&whole, "enclosures")["skipped_by"], "K-25", "the job asks for a count");
    assert!(stage(&whole, "modes")["needed_by"].is_string());
    assert!(stage(&statics, "frequency response")["left_out"].as_str().expect("why").contains("statics alone"));
    let total = |plan: &Value| plan["total"]["flops"].as_f64().expect("a number");
    assert!(total(&statics) < total(&whole) / 2.0);
    // The text of M is not read.
    let read = |plan: &Value| stage(plan, "read")["bytes"].as_f64().expect("bytes");
    assert!(read(&statics) < 0.8 * read(&whole));
    let everything = planned(&Case::new(PATCHES, HERTING, "analysis = \"static\"\ngravity = false"), &["--no-skip"]);
    assert!(stage(&everything, "modes")["needed_by"].is_string());
}

/// The text has what a person decides by, and no number in it depends on the machine that tests it.
#[test]
fn the_text_of_a_plan() {
    let place = Place::with(&model());
    let scene = "analysis = \"static\"\ngravity = false";
    place.write("job.toml", Case::new(PATCH_AND_NODES, HERTING, scene).job().as_bytes());
    let text =
        supel(&["plan", &place.text("job.toml"), "--memory-gib", "4", "--threads", "2"]).expect(ExitCode::Done).out;
    insta::assert_snapshot!(text);
    let refused = supel(&["plan", &place.text("job.toml"), "--memory-gib", "0.000001"]);
    let said = refused.out.contains("will refuse") || refused.err.contains("E-MEM") || refused.err.contains("memory");
    assert!(said, "{}{}", refused.out, refused.err);
}

/// Modes of a band are a guess where a count would take long, and the answer says so.
#[test]
fn large_answers_are_announced() {
    let plan = planned(&Case::new(PATCHES, "method = \"craig-bampton\", modes = { up_to_hz = 1e9 }", ""), &[]);
    assert_eq!(plan["modes"]["known"], "counted");
    assert_eq!(plan["warnings"].as_array().expect("a list").len(), 0, "240 dofs have no 400 modes");
    let all: Vec<String> = (1..=84).filter(|label| label % 7 != 1).map(|label| label.to_string()).collect();
    let many = format!("[[interface]]\nname = \"all\"\nnodes = [{}]\n", all.join(", "));
    let plan = planned(&Case::new(Box::leak(many.into_boxed_str()), CRAIG_BAMPTON, ""), &[]);
    assert_eq!(plan["warnings"][0]["code"], "W-LARGE");
}

/// How fast the machine is, is measured once for each number of threads; what cannot be read is measured again.
#[test]
fn the_machine_is_measured_once() {
    let place = Place::with(&model());
    place.write("job.toml", Case::new(PATCHES, CRAIG_BAMPTON, "").job().as_bytes());
    let rates = |flags: &[&str]| {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("supel"));
        command.args(["plan", &place.text("job.toml"), "--json"]).args(flags);
        let ended = command.env("XDG_CACHE_HOME", place.path("cache")).output().expect("a program");
        let document: Value = serde_json::from_slice(&ended.stdout).expect("JSON");
        document["machine"]["rates"].clone()
    };
    let first = rates(&["--threads", "1"]);
    let file = place.path("cache/supel/rates.json");
    let kept = || -> Value { serde_json::from_slice(&std::fs::read(&file).expect("kept")).expect("JSON") };
    assert_eq!((kept()[0]["rates"].clone(), kept().as_array().expect("a list").len()), (first.clone(), 1));
    assert_eq!(rates(&["--threads", "1"]), first, "not measured again");
    rates(&["--threads", "2"]);
    assert_eq!(kept().as_array().expect("a list").len(), 2);
    let again = rates(&["--threads", "1", "--calibrate"]);
    assert!(again != first && kept().as_array().expect("a list").len() == 2);
    std::fs::write(&file, "[{\"version\": 1}]").expect("written");
    let anew = rates(&["--threads", "1"]);
    assert_eq!(kept()[0]["rates"], anew);
    let mut unsound = kept();
    unsound[0]["rates"]["solve_byte"] = (-1.0).into();
    std::fs::write(&file, unsound.to_string()).expect("written");
    assert!(rates(&["--threads", "1"])["solve_byte"].as_f64().expect("a number") > 0.0);
}

/// A matrix of so many rows and columns, unlike one another.
fn array(n_rows: usize, n_columns: usize) -> String {
    let mut random = supel_models::SplitMix64::new(5);
    let values: String = (0..n_rows * n_columns).map(|_| format!("{:.6}\n", random.normal())).collect();
    format!("%%MatrixMarket matrix array real general\n{n_rows} {n_columns}\n{values}")
}

/// The peak of a process of its own is what the plan says, up to the pages that an allocator keeps and how soon the response converges.
#[test]
fn the_run_needs_the_memory_that_the_plan_says() {
    let brick = |elements| supel_models::brick(elements, [1.0, 0.31, 0.23], &supel_models::Material::STEEL_SI);
    let (model, larger) = (brick([16, 9, 7]), brick([24, 14, 10]));
    let many = "method = \"herting\", modes = { count = 60 }";
    let loads: String = (0..100)
        .map(|column| format!("[[load]]\nname = \"l{column}\"\nfile = \"loads.mtx\"\ncolumn = {column}\n"))
        .collect();
    let quantities = ", quantities = { matrix = \"q.mtx\", names = \"q.csv\" }";
    for (model, case, loads) in [
        (&model, Case::new(PATCHES, HERTING, ""), ""),
        (&model, Case::new(PATCHES, many, "boundaries = []\nband_hz = [0, 9000]"), ""),
        (&model, Case::new(PATCHES, HERTING, "analysis = \"modal\""), &loads),
        // Nothing holds this component, and K is singular. Two factors of K − σM are in memory at the same time.
        (&larger, Case::new("", "method = \"craig-bampton\", modes = { count = 10 }", ""), ""),
        (&model, Case { write: quantities, ..Case::new(PATCHES, HERTING, "") }, ""),
    ] {
        let place = Place::with(model);
        let scene = [case.scene, case.write].concat();
        place.write("job.toml", format!("{}{loads}", case.job()).as_bytes());
        place.write("loads.mtx", array(model.n, 100).as_bytes());
        if !case.write.is_empty() {
            let names: String = (0..400).map(|k| format!("q{k}\n")).collect();
            place.write("q.csv", format!("name\n{names}").as_bytes());
            place.write("q.mtx", array(400, model.n).as_bytes());
        }
        let answer = |command: &str| -> Value {
            let mut program = Command::cargo_bin("supel").expect("the program");
            let output = program.args([command, &place.text("job.toml"), "--json", "--threads", "2"]).output();
            serde_json::from_slice(&output.expect("it runs").stdout).expect("JSON")
        };
        let (plan, run) = (answer("plan"), answer("reduce"));
        let foreseen = plan["memory"]["peak_bytes"].as_f64().expect("bytes");
        let found = run["run"]["peak_memory_bytes"].as_f64().expect("bytes");
        assert!((0.75..1.35).contains(&(foreseen / found)), "{scene}: {foreseen} foreseen, {found} found");
        let foreseen = plan["answer"]["file_bytes"].as_f64().expect("bytes");
        let found = run["run"]["file_bytes"].as_f64().expect("bytes");
        assert!((0.85..1.15).contains(&(foreseen / found)), "{scene}: {foreseen} bytes foreseen, {found} written");
    }
}

/// Where the scene chooses the modes the plan has those that are looked through, says so, and counts what the choice costs.
#[test]
fn modes_that_the_scene_chooses_are_those_looked_through() {
    let scene = "band_hz = [0, 1500]\naccept = { frequency = 1e-2, response_db = 3.0 }";
    let case = Case::new(PATCHES, "method = \"herting\", modes = { accept = true }", scene);
    let plan = planned(&case, &[]);
    assert_eq!(plan["modes"]["chosen_by"], "accept");
    let choice = stage(&plan, "choice of modes");
    let response = stage(&plan, "frequency response");
    assert!(choice["flops"].as_f64() > response["flops"].as_f64(), "{choice} {response}");
    let made = case.made();
    let kept = made.file.tensors().frequencies.len();
    assert!(plan["modes"]["count"].as_u64() >= Some(kept as u64), "{} of {kept}", plan["modes"]);
    let place = Place::with(&model());
    place.write("job.toml", case.job().as_bytes());
    let said = supel(&["plan", &place.text("job.toml")]).expect(ExitCode::Done).out;
    let words: String = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("Hz that are looked through first; the fewest that `accept` allows stay"), "{said}");
    assert_eq!(planned(&Case::new(PATCHES, HERTING, ""), &[])["modes"]["chosen_by"], "job");
}
