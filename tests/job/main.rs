//! The job document: what is accepted, and the one clear message for each mistake.

mod by_schema;

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use supel::dofs::Direction;
use supel::error::{Error, ErrorClass, Result};
use supel::job::{Coupling, DofUse, Job, Method, ModeSelection, NodeSelection, Origin, Region, Support};
use supel_runtime::Precision;

const FULL: &str = r#"
[model]
stiffness = "K.mtx.gz"
mass      = "model.h5:/M"
dofs      = "rows.dof"
nodes     = "mesh/bracket.med"
units     = "mm-t-s"
expect    = { mass = 1.5e-3, cg = [0, 0, 41.2] }

[[interface]]
name     = "hub"
nodes    = "group:HUB"
coupling = "rigid"
origin   = [0, 0, 12.5]

[[interface]]
name  = "foot"
nodes = [412, 413]
dofs  = ["ux", "uy", "uz"]

[[interface]]
name     = "rim"
nodes    = { within = { cylinder = { from = [0, 0, 0], to = [0, 0, 1], radius = 5 } } }
coupling = "rigid"

[reduction]
method      = "herting"
modes       = { up_to_hz = 1000 }
eigensolver = "arpack"

[scene]
band_hz    = [0, 500]
boundaries = ["free", "fix:hub", "mass:foot", "mass:rim=2.5"]
damping    = { ratio = 0.02 }

[run]
certify    = "none"
memory_gib = 4

[write]
superelement = "out/bracket.supel"
report       = "out/bracket.json"
html         = "out/bracket.html"
junit        = "out/bracket.xml"
recovery     = { nodes = "group:SKIN", precision = "single" }
"#;

fn small() -> Value {
    json!({
        "model": { "stiffness": "K.mtx", "mass": "M.mtx" },
        "interface": [{ "name": "hub", "nodes": [1, 2] }],
        "reduction": { "method": "craig-bampton", "modes": { "count": 5 } },
        "write": { "superelement": "x.supel" }
    })
}

fn read(document: &Value) -> Result<Job> {
    let job = Job::parse(&document.to_string(), Path::new("job.json"))?;
    job.validate().map(|()| job)
}

/// The small job with one value replaced or added.
fn with(pointer: &str, value: Value) -> Value {
    let mut document = small();
    let (parent, key) = pointer.rsplit_once('/').expect("pointer");
    match document.pointer_mut(parent).expect("parent") {
        Value::Object(fields) => drop(fields.insert(key.to_owned(), value)),
        Value::Array(items) => items.insert(key.parse().expect("index"), value),
        _ => panic!("{parent} holds no values"),
    }
    document
}

fn message(document: &Value) -> String {
    let error = read(document).expect_err("a mistake");
    assert_eq!(error.class(), ErrorClass::Usage);
    error.to_string()
}

fn schema() -> jsonschema::Validator {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/job.schema.json");
    let schema: Value =
        serde_json::from_str(&std::fs::read_to_string(path).expect("a schema")).expect("schema is JSON");
    jsonschema::validator_for(&schema).expect("schema is a schema")
}

#[test]
fn every_key_of_a_toml_job_is_read() {
    let job = Job::parse(FULL, Path::new("job.toml")).expect("a job");
    job.validate().expect("valid");
    assert_eq!(job.model.mass, Some(PathBuf::from("model.h5:/M")));
    assert_eq!(job.model.expect.as_ref().and_then(|expect| expect.cg), Some([0.0, 0.0, 41.2]));
    assert_eq!(job.interfaces[0].nodes.group_name(), Some("HUB"));
    assert_eq!(job.interfaces[0].coupling, Coupling::Rigid);
    assert_eq!(job.interfaces[0].origin, Origin::Point([0.0, 0.0, 12.5]));
    assert_eq!(job.interfaces[1].nodes, NodeSelection::Labels(vec![412, 413]));
    assert_eq!(job.interfaces[2].origin, Origin::Centroid);
    let rim = Region::Cylinder { from: [0.0; 3], to: [0.0, 0.0, 1.0], radius: 5.0, inner_radius: 0.0 };
    assert_eq!(job.interfaces[2].nodes, NodeSelection::Region { within: rim });
    assert_eq!(job.reduction.method, Method::Herting);
    assert_eq!(job.reduction.modes, Some(ModeSelection::UpTo { up_to_hz: 1000.0 }.into()));
    assert_eq!(job.run.memory_gib, Some(4.0));
    let recovery = job.write.recovery.expect("a recovery");
    assert_eq!((recovery.nodes.group_name(), recovery.precision), (Some("SKIN"), Precision::Single));
}

#[test]
fn a_job_survives_json_and_toml() {
    let job = Job::parse(FULL, Path::new("job.toml")).expect("a job");
    let text = serde_json::to_string(&job).expect("json");
    assert!(schema().is_valid(&serde_json::from_str(&text).expect("json")), "{text}");
    assert_eq!(Job::parse(&text, Path::new("job.json")).expect("its own JSON"), job);
    let text = toml::to_string(&job).expect("toml");
    assert_eq!(Job::parse(&text, Path::new("job.toml")).expect("its own TOML"), job);
}

#[test]
fn content_decides_where_the_extension_does_not() {
    assert!(Job::parse(&small().to_string(), Path::new("job")).is_ok());
    assert!(Job::parse(FULL, Path::new("job.txt")).is_ok());
}

#[test]
fn paths_are_relative_to_the_folder_of_the_job() {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("job.toml");
    std::fs::write(&path, FULL).expect("written");
    let job = Job::read(&path).expect("a job");
    assert_eq!(job.model.stiffness, folder.path().join("K.mtx.gz"));
    assert_eq!(job.model.mass, Some(folder.path().join("model.h5:/M")));
    assert_eq!(job.write.superelement, folder.path().join("out/bracket.supel"));
    assert_eq!(job.write.report_path(), folder.path().join("out/bracket.json"));
    assert_eq!(job.write.html, Some(folder.path().join("out/bracket.html")));
    assert_eq!(job.write.junit, Some(folder.path().join("out/bracket.xml")));
    let small = read(&small()).expect("a job").resolve(folder.path()).expect("resolved");
    assert_eq!(small.write.report_path(), folder.path().join("x.report.json"));
}

#[test]
fn a_missing_job_is_an_input_output_error() {
    let error = Job::read(Path::new("no/such/job.toml")).expect_err("no file");
    assert!(matches!(error, Error::Read { .. }));
    assert_eq!(error.class(), ErrorClass::Io);
}

#[test]
fn unknown_keys_are_located_with_a_suggestion() {
    let text = FULL.replace("stiffness = ", "stifness = ");
    let error = Job::parse(&text, Path::new("job.toml")).expect_err("a misspelt key");
    assert_eq!(error.to_string(), "job.toml:3: unknown key `model.stifness` – did you mean `stiffness`?");
    let text = FULL.replace("radius = 5", "radios = 5");
    let error = Job::parse(&text, Path::new("job.toml")).expect_err("a misspelt key");
    let expected = "job.toml:23: unknown key `interface[2].nodes.within.cylinder.radios` – did you mean `radius`?";
    assert_eq!(error.to_string(), expected);
    assert_eq!(
        message(&with("/interface/0/coupled", "rigid".into())),
        "job.json: unknown key `interface[0].coupled` – did you mean `coupling`?"
    );
    assert_eq!(
        message(&with("/zzz", 1.into())),
        "job.json: unknown key `zzz` – remove it; the keys are listed in schemas/job.schema.json"
    );
}

#[test]
fn values_of_the_wrong_kind_are_located() {
    let wrong = |from: &str, to: &str| {
        let text = FULL.replace(from, to);
        assert_ne!(text, FULL);
        let error = Job::parse(&text, Path::new("job.toml")).expect_err("a wrong value");
        assert!(matches!(error, Error::JobSyntax { .. }), "{error:?}");
        error.to_string()
    };
    let at_28 = |to: &str| wrong("{ up_to_hz = 1000 }", to);
    insta::assert_snapshot!(wrong("stiffness = \"K.mtx.gz\"", ""), @"job.toml:2: `model.stiffness` is missing");
    insta::assert_snapshot!(wrong("\"herting\"", "\"hurting\""), @r#"job.toml:27: `reduction.method` is "hurting" – expected "craig-bampton", "herting", "rubin", "macneal", "mixed-interface", "guyan" or "mode-acceleration""#);
    insta::assert_snapshot!(at_28("{ up_to_hz = 1000, count = 4 }"), @"job.toml:28: `reduction.modes` has `count` and `up_to_hz` – expected exactly one of `count`, `up_to_hz`, `accept` and `file`");
    insta::assert_snapshot!(at_28("{ }"), @"job.toml:28: `reduction.modes` is empty – expected exactly one of `count`, `up_to_hz`, `accept` and `file`");
    insta::assert_snapshot!(at_28("3"), @"job.toml:28: `reduction.modes` is 3 – expected a table with keys of accept, count, file, up_to_hz");
    insta::assert_snapshot!(at_28("{ count = 3.5 }"), @"job.toml:28: `reduction.modes.count` is 3.5 – expected a whole number, zero or more");
    insta::assert_snapshot!(at_28("{ count = -4 }"), @"job.toml:28: `reduction.modes.count` is -4 – expected a whole number, zero or more");
    insta::assert_snapshot!(at_28("{ count = 99999999999999999999 }"), @"job.toml:28: `reduction.modes.count` is 99999999999999999999 – expected a whole number, zero or more");
    insta::assert_snapshot!(at_28("{ count = \"4\" }"), @r#"job.toml:28: `reduction.modes.count` is "4" – expected a whole number, zero or more"#);
    insta::assert_snapshot!(at_28("{ count = 1979-05-27 }"), @"job.toml:28: `reduction.modes.count` is the date 1979-05-27 – expected a whole number, zero or more");
    insta::assert_snapshot!(at_28("{ up_to_hz = true }"), @"job.toml:28: `reduction.modes.up_to_hz` is true – expected a number");
    insta::assert_snapshot!(wrong("nodes = [412, 413]", "nodes = 412"), @r#"job.toml:18: `interface[1].nodes` is 412 – expected a text such as "group:HUB", a list or a table with keys of rows, within"#);
    insta::assert_snapshot!(wrong("nodes = [412, 413]", "nodes = [412, \"413\"]"), @r#"job.toml:18: `interface[1].nodes[1]` is "413" – expected a whole number"#);
    insta::assert_snapshot!(wrong("origin   = [0, 0, 12.5]", "origin = \"middle\""), @r#"job.toml:14: `interface[0].origin` is "middle" – expected "centroid", "area", "hole", "sphere" or a list of 3"#);
    insta::assert_snapshot!(wrong("radius = 5", "inner_radius = 5"), @"job.toml:23: `interface[2].nodes.within.cylinder.radius` is missing");
    insta::assert_snapshot!(wrong("{ cylinder = { from = [0, 0, 0], to = [0, 0, 1], radius = 5 } }", "{}"), @"job.toml:23: `interface[2].nodes.within` is empty – expected exactly one of `box`, `plane`, `cylinder` and `sphere`");
    insta::assert_snapshot!(wrong("[\"ux\", \"uy\", \"uz\"]", "[1]"), @r#"job.toml:19: `interface[1].dofs[0]` is 1 – expected "ux", "uy", "uz", "rx", "ry" or "rz""#);
    insta::assert_snapshot!(wrong("{ ratio = 0.02 }", "0.02"), @"job.toml:34: `scene.damping` is 0.02 – expected a table with keys of ratio");
    insta::assert_snapshot!(wrong("[0, 500]", "[0]"), @"job.toml:32: `scene.band_hz` is a list of 1 – expected a list of 2");
    insta::assert_snapshot!(wrong("[write]", "[write"), @"job.toml:40: this is no TOML: unclosed table, expected `]`");
    insta::assert_snapshot!(at_28("[3, 4]"), @"job.toml:28: `reduction.modes` is a list – expected a table with keys of accept, count, file, up_to_hz");
    insta::assert_snapshot!(wrong("12.5]", "12.5, 0]"), @r#"job.toml:14: `interface[0].origin` is a list of 4 – expected "centroid", "area", "hole", "sphere" or a list of 3"#);
    insta::assert_snapshot!(wrong("\"none\"", "{ none = {} }"), @r#"job.toml:37: `run.certify` is a table – expected "none", "count" or "full""#);
    insta::assert_snapshot!(message(&with("/model/dofs", Value::Null)), @"job.json: `model.dofs` is null – expected a value, or the key left out");
    insta::assert_snapshot!(message(&with("/model/dofs", 3.into())), @"job.json: `model.dofs` is 3 – expected a text");
    insta::assert_snapshot!(message(&with("/model/drop_empty", 1.into())), @"job.json: `model.drop_empty` is 1 – expected true or false");
    insta::assert_snapshot!(message(&json!([1, 2])), @"job.json: the job is a list – expected a table with keys of added_mass, damping, fixed, interface, load, matrix, model, reduction, run, scene, write");
    let error = Job::parse("{\n \"model\": }", Path::new("job.json")).expect_err("not JSON");
    assert_eq!(error.to_string(), "job.json:2: this is no JSON: expected value");
}

/// As the schema says: 3.0 is a whole number.
#[test]
fn whole_numbers_may_be_written_with_a_point() {
    let with_point = FULL.replace("up_to_hz = 1000", "count = 3.0").replace("[412, 413]", "[412.0, 4.13e2]");
    let job = Job::parse(&with_point, Path::new("job.toml")).expect("a job");
    assert_eq!(job.reduction.modes, Some(ModeSelection::Count { count: 3 }.into()));
    assert_eq!(job.interfaces[1].nodes, NodeSelection::Labels(vec![412, 413]));
    let rows = read(&with("/interface/0/nodes", json!({ "rows": [0.0, 2.0] }))).expect("a job");
    assert_eq!(rows.interfaces[0].nodes, NodeSelection::Rows { rows: vec![0, 2] });
}

#[test]
fn numbers_out_of_range_are_refused() {
    let band = |hz: f64| with("/reduction/modes", json!({ "up_to_hz": hz }));
    assert_eq!(message(&band(0.0)), "`reduction.modes.up_to_hz` is 0 – expected a positive number");
    assert_eq!(message(&band(-5.0)), "`reduction.modes.up_to_hz` is -5 – expected a positive number");
    let text = FULL.replace("up_to_hz = 1000", "up_to_hz = nan");
    let error = Job::parse(&text, Path::new("job.toml")).and_then(|job| job.validate()).expect_err("nan");
    assert!(matches!(error, Error::JobNumber { .. }));
    assert!(read(&with("/reduction/modes", json!({ "count": 0 }))).is_ok(), "no modes is static condensation");
    assert!(read(&with("/run", json!({ "memory_gib": 0 }))).is_err());
    assert!(read(&with("/model/expect", json!({ "mass": -1 }))).is_err());
    for key in ["stiffness_digits", "mass_digits"] {
        for digits in [1, 17] {
            assert!(read(&with(&format!("/model/{key}"), json!(digits))).is_ok());
        }
        for digits in [0, 18] {
            let message = message(&with(&format!("/model/{key}"), json!(digits)));
            let expected = format!("`model.{key}` is {digits} – expected a whole number from 1 to 17");
            assert!(message.ends_with(&expected), "{message}");
        }
    }
}

/// Numbers whose squares and products would leave the range of double precision are refused before anything is computed with them.
#[test]
fn sizes_that_cannot_be_meant_are_refused() {
    let sphere = |x: f64| json!({ "within": { "sphere": { "center": [x, 0, 0], "radius": 1e160 } } });
    let plane =
        |x: f64| json!({ "within": { "plane": { "point": [0, x, 0], "normal": [1e160, 0, 0], "tolerance": 0 } } });
    let cylinder = |x: f64| json!({ "within": { "cylinder": { "from": [0, 0, 0], "to": [0, 0, x], "radius": 1 } } });
    let documents = |x: f64| {
        [
            with("/reduction/modes", json!({ "up_to_hz": x })),
            with("/scene", json!({ "band_hz": [0, x] })),
            with("/scene", json!({ "boundaries": [format!("mass:hub={x:e}")] })),
            with("/model/expect", json!({ "mass": x })),
            with("/model/expect", json!({ "cg": [x, 0, 0] })),
            with("/interface/0/nodes", sphere(x)),
            with("/interface/0/nodes", plane(x)),
            with("/interface/0/nodes", cylinder(x)),
        ]
    };
    for document in documents(1e48).into_iter().chain(documents(1e-48)) {
        assert!(read(&document).is_ok(), "{document}");
    }
    for document in documents(1e49) {
        let message = message(&document);
        assert!(message.contains("is 1e49 – expected") && message.contains("1e48"), "{message}");
    }
    for document in &documents(1e-49)[..4] {
        assert!(message(document).ends_with("is 1e-49 – expected a positive number between 1e-48 and 1e48"));
    }
    let damping = message(&with("/scene", json!({ "damping": { "ratio": 1e-200 } })));
    assert_eq!(damping, "`scene.damping.ratio` is 1e-200 – expected a positive number between 1e-48 and 1e48");
}

#[test]
fn scenes_are_checked() {
    let scene = |scene: Value| with("/scene", scene);
    let job = Job::parse(FULL, Path::new("job.toml")).expect("a job").scene.expect("a scene");
    assert_eq!((job.band_hz, job.damping.map(|damping| damping.ratio)), (Some([0.0, 500.0]), Some(0.02)));
    let loaded = |interface: &str, mass| Support::Loaded { interface: interface.to_owned(), mass };
    let fixed = Support::Fixed { interface: "hub".to_owned() };
    assert_eq!(job.boundaries, Some(vec![Support::Free, fixed, loaded("foot", None), loaded("rim", Some(2.5))]));
    assert_eq!(
        message(&scene(json!({ "band_hz": [5, 4] }))),
        "`scene.band_hz[1]` is 4 – expected a frequency above that of `band_hz[0]`"
    );
    assert_eq!(
        message(&scene(json!({ "boundaries": ["free", "fix:pin"] }))),
        "scene.boundaries: `fix:pin`: no interface is called `pin` – the job has hub"
    );
    for (wrong, expected) in [
        (json!({ "band_hz": [-1, 4] }), "zero or more"),
        (json!({ "boundaries": ["mass:hub=-2"] }), "a positive number"),
        (json!({ "boundaries": ["mass:hub=much"] }), "expected `free`, `fix:NAME`"),
        (json!({ "boundaries": ["spring:hub=0"] }), "a positive number"),
        (json!({ "boundaries": ["spring:hub"] }), "`spring:NAME=1e5`"),
        (json!({ "boundaries": ["held"] }), "boundary `held`"),
        (json!({ "boundaries": ["fix:"] }), "boundary `fix:`"),
        (json!({ "damping": { "ratio": 0 } }), "a positive number"),
        (json!({ "damping": { "ratio": 1 } }), "below 1"),
        (json!({ "bandwidth": 3 }), "did you mean `band_hz`"),
    ] {
        let message = message(&scene(wrong));
        assert!(message.contains(expected), "{message}");
    }
    for wrong in ["band_hz    = [nan, 500]", "band_hz    = [0, nan]", "band_hz    = [0, inf]"] {
        let text = FULL.replace("band_hz    = [0, 500]", wrong);
        let error = Job::parse(&text, Path::new("job.toml")).and_then(|job| job.validate()).expect_err("not a number");
        assert!(matches!(error, Error::JobNumber { .. }), "{error}");
    }
    assert!(read(&scene(json!({ "boundaries": [] }))).is_ok(), "an empty list compares none");
}

#[test]
fn statements_of_the_scene_are_checked() {
    let scene = |scene: Value| with("/scene", scene);
    for (wrong, code, expected) in [
        (json!({ "grounded": ["pin"] }), "E-SCENE-PART", "scene.grounded: `pin` is no interface"),
        (json!({ "connected": ["hub.up"] }), "E-SCENE-PART", "the job has hub"),
        (json!({ "prescribed": [{ "name": "t", "interfaces": ["pin"] }] }), "E-SCENE-PART", "scene.prescribed"),
        (json!({ "grounded": ["hub"], "unloaded": ["hub.rx"] }), "E-SCENE-CONFLICT", "unloaded and grounded"),
        (json!({ "unloaded": ["hub.rx", "hub.rx"] }), "E-SCENE-CONFLICT", "`hub.rx` is unloaded and listed twice"),
        (json!({ "unloaded": ["hub.rx"], "connected": ["hub.ux"] }), "E-SCENE-CONFLICT", "unlisted as connected"),
        (
            json!({ "grounded": ["hub.ux"], "prescribed": [{ "name": "t", "interfaces": ["hub"] }] }),
            "E-SCENE-CONFLICT",
            "`hub` is grounded and prescribed",
        ),
        (json!({ "prescribed": [{ "name": " ", "interfaces": ["hub"] }] }), "E-SCENE-CARRIER", "has no name"),
        (json!({ "grounded": ["hub"], "boundaries": ["fix:hub"] }), "E-SCENE-LEFT-OUT", "`hub` is grounded"),
        (json!({ "connected": [], "gravity": true }), "E-JOB-EMPTY", "scene.connected"),
        (json!({ "analysis": "static", "band_hz": [0, 5] }), "E-SCENE-STATIC", "scene.band_hz: a static analysis"),
        (json!({ "analysis": "static", "accept": { "frequency": 0.1 } }), "E-SCENE-STATIC", "accept.frequency"),
        (json!({ "gravity": [0, 0, 0] }), "E-ARG", "a vector with a direction"),
        (json!({ "gravity": "down" }), "E-JOB", "expected"),
    ] {
        let error = read(&scene(wrong.clone())).expect_err("refused");
        assert!(error.to_string().contains(expected), "{wrong}: {error}");
        assert!(error.code().starts_with(code), "{wrong}: {}", error.code());
    }
    let carried = json!({ "prescribed": [{ "name": "table", "interfaces": ["hub"] }], "boundaries": ["fix:table"] });
    assert!(read(&scene(carried)).is_ok(), "a boundary may name a carrier");
    let half = json!({ "grounded": ["hub.ux"], "boundaries": ["fix:hub"] });
    assert!(read(&scene(half)).is_ok(), "what is left of an interface may be held");
}

#[test]
fn what_the_scene_says_of_a_dof_is_found() {
    let job = read(&with("/scene", json!({ "unloaded": ["hub.rx"], "grounded": ["hub.uz"] }))).expect("a job");
    let scene = job.scene.as_ref().expect("a scene");
    let of = |direction| scene.use_of(&job.interfaces, ("hub", Some(direction)));
    assert_eq!((of(Direction::Rx), of(Direction::Uz)), (DofUse::Unloaded, DofUse::Grounded));
    assert_eq!((of(Direction::Ux), scene.use_of_whole(&job.interfaces, "hub")), (DofUse::Connected, None));
    let job = read(&with("/scene", json!({ "connected": ["hub.ux"] }))).expect("a job");
    let scene = job.scene.as_ref().expect("a scene");
    let of = |direction| scene.use_of(&job.interfaces, ("hub", Some(direction)));
    assert_eq!((of(Direction::Ux), of(Direction::Uz)), (DofUse::Connected, DofUse::Unloaded));
}

#[test]
fn regions_must_hold_something() {
    let within = |region: Value| with("/interface/0/nodes", json!({ "within": region }));
    let good = [
        json!({ "box": { "min": [0, 0, 0], "max": [1, 0, 1] } }),
        json!({ "plane": { "point": [0, 0, 0], "normal": [0, 0, 2], "tolerance": 0 } }),
        json!({ "cylinder": { "from": [0, 0, 0], "to": [0, 0, 1], "radius": 2, "inner_radius": 2 } }),
        json!({ "sphere": { "center": [0, 0, 0], "radius": 1 } }),
    ];
    for region in good {
        assert!(read(&within(region.clone())).is_ok(), "{region}");
    }
    let bad = [
        (json!({ "box": { "min": [0, 2, 0], "max": [1, 1, 1] } }), "box.max` is 1"),
        (json!({ "plane": { "point": [0, 0, 0], "normal": [0, 0, 0], "tolerance": 1 } }), "a vector with a direction"),
        (json!({ "plane": { "point": [0, 0, 0], "normal": [0, 0, 1], "tolerance": -1 } }), "zero or more"),
        (json!({ "cylinder": { "from": [1, 1, 1], "to": [1, 1, 1], "radius": 2 } }), "a vector with a direction"),
        (json!({ "cylinder": { "from": [0, 0, 0], "to": [0, 0, 1], "radius": 2, "inner_radius": 3 } }), "at most"),
        (json!({ "sphere": { "center": [0, 0, 0], "radius": 0 } }), "a positive number"),
    ];
    for (region, expected) in bad {
        let message = message(&within(region));
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn names_and_selections_of_interfaces_are_checked() {
    let second = |name: &str, nodes: Value| with("/interface/1", json!({ "name": name, "nodes": nodes }));
    assert!(matches!(read(&second("hub", json!([9]))), Err(Error::InterfaceTwice { .. })));
    assert!(matches!(read(&second(" ", json!([9]))), Err(Error::JobEmpty { .. })));
    assert!(matches!(read(&second("b", json!([]))), Err(Error::JobEmpty { .. })));
    assert!(matches!(read(&second("b", json!({ "rows": [] }))), Err(Error::JobEmpty { .. })));
    assert!(matches!(read(&second("b", json!("HUB"))), Err(Error::InterfaceNodes { .. })));
    assert!(matches!(read(&second("b", json!("group:"))), Err(Error::InterfaceNodes { .. })));
    assert_eq!(message(&second("b", json!([7, 8, 7]))), "interface \"b\": node 7 is listed twice – list each once");
    assert_eq!(
        message(&second("b", json!({ "rows": [0, 0] }))),
        "interface \"b\": row 0 is listed twice – list each once"
    );
    assert_eq!(
        message(&second("b", json!([3, 2]))),
        "interfaces `hub` and `b` both list node 2 – it can belong to one of them"
    );
    assert!(matches!(read(&with("/model/stiffness", "".into())), Err(Error::JobEmpty { .. })));
}

#[test]
fn nodes_may_be_shared_direction_by_direction() {
    let mut document = with("/interface/1", json!({ "name": "b", "nodes": [2], "dofs": ["uz"] }));
    assert!(matches!(read(&document), Err(Error::InterfaceOverlap { .. })));
    document["interface"][0]["dofs"] = json!(["ux", "uy"]);
    assert!(read(&document).is_ok());
    document["interface"][1]["coupling"] = "rigid".into();
    assert!(matches!(read(&document), Err(Error::InterfaceOverlap { .. })));
}

#[test]
fn keys_that_contradict_the_coupling_are_refused() {
    assert_eq!(
        message(&with("/interface/0/origin", json!([0, 0, 0]))),
        "interface \"hub\": `origin` has no meaning for a direct coupling, whose nodes stay where they are – remove it, \
         or set coupling = \"rigid\""
    );
    for word in ["area", "hole", "sphere"] {
        assert!(
            matches!(read(&with("/interface/0/origin", word.into())), Err(Error::InterfaceConflict { .. })),
            "{word}"
        );
    }
    assert_eq!(
        message(&with("/interface/0/weights", "uniform".into())),
        "interface \"hub\": `weights` has no meaning for a coupling that takes no mean – remove it, or set coupling = \
         \"average\""
    );
    let weighted = |nodes: Value, weights: Value| {
        let mean = json!({ "name": "mean", "nodes": nodes, "coupling": "average", "weights": weights });
        read(&with("/interface/0", mean))
    };
    assert!(weighted(json!([5, 7, 6]), json!([1, 2.5, 1])).is_ok());
    let conflict = weighted("group:A".into(), json!([1, 2.5, 1]));
    assert!(matches!(conflict, Err(Error::InterfaceConflict { .. })), "{conflict:?}");
    let count = weighted(json!([5, 7, 6]), json!([1, 2.5]));
    assert!(matches!(count, Err(Error::WeightCount { n_weights: 2, n_nodes: 3, .. })), "{count:?}");
    assert!(matches!(weighted(json!([5, 7, 6]), json!([1, 0, 1])), Err(Error::JobNumber { .. })));
    let rows = |key: &str, value: Value| {
        let mut document = with("/interface/0/nodes", json!({ "rows": [0, 1] }));
        document["interface"][0][key] = value;
        read(&document)
    };
    assert!(matches!(rows("coupling", "rigid".into()), Err(Error::InterfaceConflict { .. })));
    assert!(matches!(rows("dofs", json!(["ux"])), Err(Error::InterfaceConflict { .. })));
    assert!(matches!(read(&with("/interface/0/dofs", json!([]))), Err(Error::JobEmpty { .. })));
    assert_eq!(
        message(&with("/interface/0/dofs", json!(["ux", "ux"]))),
        "interface \"hub\": direction ux is listed twice – list each once"
    );
}

#[test]
fn names_of_outputs_say_what_they_are() {
    assert_eq!(
        message(&with("/write/superelement", "x.h5".into())),
        "`write.superelement` is x.h5 – expected a name that ends in .supel"
    );
    for name in ["out/.supel", "x.supel/", "x.supel/.", ".supel", "supel", ""] {
        assert!(matches!(read(&with("/write/superelement", name.into())), Err(Error::OutputName { .. })), "{name}");
    }
    for (key, name) in [("/write/report", "x.txt"), ("/write/html", "x.htm"), ("/write/junit", ".xml")] {
        assert!(matches!(read(&with(key, name.into())), Err(Error::OutputName { .. })), "{key}");
    }
}

/// Names that JSON cannot hold are refused with their key before a file is looked at, wherever in the path they are.
#[cfg(unix)]
#[test]
fn names_that_are_not_utf8_are_refused() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = OsStr::from_bytes(b"/home/J\xf6rg/model");
    let error = read(&small()).expect("a job").resolve(Path::new(folder)).expect_err("a folder");
    assert_eq!((error.code(), error.class()), ("E-NAME", ErrorClass::Usage));
    assert_eq!(
        error.to_string(),
        "`model.stiffness` is \"/home/J\\xF6rg/model/K.mtx\" – expected a name in UTF-8, as the report and the superelement \
         keep names – rename \"J\\xF6rg\""
    );
    type Change = fn(&mut Job, PathBuf);
    let changes: [(&str, Change); 9] = [
        ("model.stiffness", |job, path| job.model.stiffness = path),
        ("model.mass", |job, path| job.model.mass = Some(path)),
        ("model.dofs", |job, path| job.model.dofs = Some(path)),
        ("model.nodes", |job, path| job.model.nodes = Some(path)),
        ("model.constraints", |job, path| job.model.constraints = Some(path)),
        ("write.superelement", |job, path| job.write.superelement = path),
        ("write.report", |job, path| job.write.report = Some(path)),
        ("write.html", |job, path| job.write.html = Some(path)),
        ("write.junit", |job, path| job.write.junit = Some(path)),
    ];
    for (key, change) in changes {
        let ending = match key {
            "write.superelement" => "supel",
            "write.report" => "json",
            "write.html" => "html",
            _ => "xml",
        };
        let mut job = read(&small()).expect("a job");
        change(&mut job, PathBuf::from(OsStr::from_bytes(&[b"x\xff.", ending.as_bytes()].concat())));
        job.validate().expect("the ending is right");
        let error = job.resolve(Path::new("/a")).expect_err(key);
        assert!(matches!(&error, Error::NameNotText { key: found, .. } if *found == key), "{key}: {error}");
    }
}

/// The small job with one thing changed, some changes allowed and some not.
fn changed_jobs() -> Vec<Value> {
    let interface = |value: Value| with("/interface/0", value);
    vec![
        small(),
        with("/zzz", 1.into()),
        with("/interface", json!([])),
        with("/interface/0/dofs", json!(["ux", "rz"])),
        with("/interface/0/dofs", json!(["ux", "up"])),
        with("/interface/0/dofs", json!([])),
        with("/interface/0/dofs", json!(["ux", "ux"])),
        with("/interface/0/coupling", "average".into()),
        with("/interface/0/origin", "centroid".into()),
        with("/interface/0/origin", "middle".into()),
        with("/interface/0", json!({ "name": "a", "nodes": "group:A", "coupling": "rigid", "origin": "area" })),
        with("/interface/0", json!({ "name": "a", "nodes": "group:A", "coupling": "rigid", "origin": "sphere" })),
        with("/interface/0/nodes", json!({ "within": { "sphere": { "center": [0, 0, 0], "radius": 1 } } })),
        with("/interface/0/nodes", json!({ "within": { "sphere": { "center": [0, 0], "radius": 1 } } })),
        with("/interface/0/nodes", json!({ "within": { "sphere": { "center": [0, 0, 0], "radius": 0 } } })),
        with("/interface/0/nodes", json!({ "within": { "cone": {} } })),
        with("/interface/0/nodes", json!({ "rows": [0] })),
        with("/interface/0/nodes", json!({ "rows": [-1] })),
        with("/interface/0/nodes", json!({ "rows": [0], "within": { "box": { "min": [0, 0, 0], "max": [1, 1, 1] } } })),
        with("/interface/0/nodes", json!({})),
        with("/interface/0/nodes", json!([1.5])),
        interface(json!({ "nodes": [7] })),
        interface(json!({ "name": "", "nodes": [7] })),
        interface(json!({ "name": "a", "nodes": "group:A" })),
        interface(json!({ "name": "a", "nodes": "A" })),
        with("/reduction/method", "guyan".into()),
        with("/reduction/modes", json!({})),
        with("/reduction/modes", json!({ "count": 3, "up_to_hz": 5 })),
        with("/reduction/modes", json!({ "count": -3 })),
        with("/reduction/modes", json!({ "up_to_hz": 0 })),
        with("/reduction/eigensolver", "arpack".into()),
        with("/run", json!({ "skip": "nothing" })),
        with("/run", json!({ "skip": true })),
        with("/run", json!({ "certify": "full" })),
        with("/run", json!({ "certify": "count", "memory_gib": 0.5 })),
        with("/run", json!({ "precision": "auto" })),
        with("/run", json!({ "precision": "single" })),
        with("/write/superelement", "x.json".into()),
        with("/write/report", "x.json".into()),
        with("/write/html", "x.html".into()),
        with("/write/html", ".html".into()),
        with("/write/junit", "x.xml".into()),
        with("/write/junit", "x.json".into()),
        with("/model/expect", json!({ "mass": 0 })),
        with("/model/expect", json!({ "cg": [1, 2, 3] })),
        with("/model/constraints", "G.mtx".into()),
        with("/model/constraints_to_ground", "accept".into()),
        with("/model/units", 3.into()),
    ]
}

/// The small job with a scene, some of them allowed and some not.
fn scenes() -> Vec<Value> {
    vec![
        with("/scene", json!({})),
        with("/scene", json!({ "band_hz": [0, 50], "boundaries": ["free", "fix:hub", "mass:hub", "mass:hub=2.5e3"] })),
        with("/scene", json!({ "band_hz": [0, -50] })),
        with("/scene", json!({ "band_hz": [0, 5, 50] })),
        with("/scene", json!({ "boundaries": "free" })),
        with("/scene", json!({ "boundaries": ["freed"] })),
        with("/scene", json!({ "boundaries": ["mass:hub="] })),
        with("/scene", json!({ "damping": { "ratio": 0.02 } })),
        with("/scene", json!({ "damping": { "ratio": 1.0 } })),
        with("/scene", json!({ "damping": {} })),
        with("/scene", json!({ "gravity": true })),
        with("/scene", json!({ "gravity": [0, 0, -1] })),
        with("/scene", json!({ "gravity": [0, -1] })),
        with("/scene", json!({ "analysis": "static" })),
        with("/scene", json!({ "analysis": "dynamic" })),
        with("/scene", json!({ "connected": ["hub.ux"] })),
        with("/scene", json!({ "connected": [] })),
    ]
}

/// The small job with a state of its stiffness, some of them allowed and some not.
fn states() -> Vec<Value> {
    vec![
        with("/model/state", "unloaded".into()),
        with("/model/state", "preloaded".into()),
        with("/model/state", "loaded".into()),
        with("/model/internal_forces", "q.mtx".into()),
        with(
            "/model",
            json!({ "stiffness": "K.mtx", "mass": "M.mtx", "state": "preloaded", "internal_forces": "q.mtx" }),
        ),
        with("/model", json!({ "stiffness": "K.mtx", "mass": "M.mtx", "state": "preloaded", "internal_forces": "" })),
        with(
            "/model",
            json!({ "stiffness": "K.mtx", "mass": "M.mtx", "state": "unloaded", "internal_forces": "q.mtx" }),
        ),
    ]
}

/// The small job with held dofs, some of them allowed and some not.
fn fixed() -> Vec<Value> {
    let fixed = |value: Value| with("/fixed", json!([value]));
    vec![
        fixed(json!({ "nodes": [4, 9] })),
        fixed(json!({ "nodes": "group:A", "dofs": ["ux", "rz"], "name": "a" })),
        fixed(json!({ "nodes": { "within": { "sphere": { "center": [0, 0, 0], "radius": 1 } } } })),
        fixed(json!({ "nodes": { "within": { "sphere": { "center": [0, 0, 0], "radius": 0 } } } })),
        fixed(json!({ "nodes": { "rows": [0] } })),
        fixed(json!({ "nodes": [4, 4] })),
        fixed(json!({ "nodes": [] })),
        fixed(json!({ "nodes": "A" })),
        fixed(json!({ "nodes": [4], "name": " " })),
        fixed(json!({ "nodes": [4], "dofs": [] })),
        fixed(json!({ "nodes": [4], "dofs": ["ux", "ux"] })),
        fixed(json!({ "nodes": [4], "coupling": "rigid" })),
        fixed(json!({ "dofs": ["ux"] })),
        with("/fixed", json!([])),
        with("/fixed", json!({ "nodes": [4] })),
    ]
}

/// The small job with a load, some of them allowed and some not.
fn loads() -> Vec<Value> {
    let load = |value: Value| with("/load", json!([value]));
    vec![
        load(json!({ "name": "a", "nodes": [4, 9], "force": [0, 0, 1] })),
        load(json!({ "name": "a", "nodes": "group:A", "force": [1, 0.5, 0] })),
        load(json!({ "name": "a", "nodes": { "rows": [0] }, "force": [0, 0, 1] })),
        load(json!({ "name": "a", "nodes": [4, 4], "force": [0, 0, 1] })),
        load(json!({ "name": "a", "nodes": [4] })),
        load(json!({ "name": "a", "nodes": [4, 9, 17], "pressure": 2.5 })),
        load(json!({ "name": "a", "nodes": "group:A", "pressure": -1e-6 })),
        load(json!({ "name": "a", "nodes": "group:A", "pressure": 0 })),
        load(json!({ "name": "a", "nodes": "group:A", "pressure": 1e60 })),
        load(json!({ "name": "a", "nodes": "group:A", "pressure": 1, "force": [0, 0, 1] })),
        load(json!({ "name": "a", "pressure": 1 })),
        load(json!({ "name": "a", "pressure": 1, "file": "f.mtx" })),
        load(json!({ "name": "a", "nodes": "group:A", "pressure": 1, "rotation": { "axis": [0, 0, 1] } })),
        load(json!({ "name": "a", "force": [0, 0, 1] })),
        load(json!({ "name": "a", "file": "f.mtx" })),
        load(json!({ "name": "a", "file": "f.mtx", "column": 0 })),
        load(json!({ "name": "a", "file": "f.mtx", "column": -1 })),
        load(json!({ "name": "a", "file": "f.mtx", "nodes": [4] })),
        load(json!({ "name": "a", "file": "f.mtx", "nodes": [4], "force": [0, 0, 1] })),
        load(json!({ "name": "a", "file": "f.mtx", "rotation": { "axis": [0, 0, 1] } })),
        load(json!({ "name": "a", "rotation": { "axis": [0, 0, 1] } })),
        load(json!({ "name": "a", "rotation": { "axis": [0, 0, 1], "through": [1, 2, 3] } })),
        load(json!({ "name": "a", "rotation": { "axis": [0, 0, 1] }, "column": 1 })),
        load(json!({ "name": "a", "rotation": { "through": [1, 2, 3] } })),
        load(json!({ "name": "a", "rotation": { "axis": [0, 1] } })),
        load(json!({ "name": "a", "file": "f.mtx", "residual": false })),
        load(json!({ "name": "a", "file": "f.mtx", "residual": "no" })),
        load(json!({ "name": "a" })),
        load(json!({ "file": "f.mtx" })),
    ]
}

/// The small job with modes of a file, for a method that takes them and for others.
fn modes_of_a_file() -> Vec<Value> {
    let method = |modes: Value| with("/reduction", json!({ "method": "mode-acceleration", "modes": modes }));
    vec![
        method(json!({ "file": "modes.mtx" })),
        method(json!({ "file": "" })),
        method(json!({ "file": "modes.mtx", "count": 3 })),
        method(json!({ "count": 3 })),
        with("/reduction", json!({ "method": "mode-acceleration" })),
        with("/reduction/modes", json!({ "file": "modes.mtx" })),
    ]
}

/// The small job with nodes to be recovered, some of them allowed and some not.
fn recoveries() -> Vec<Value> {
    vec![
        with("/write/recovery", json!({ "nodes": [4, 7] })),
        with("/write/recovery", json!({ "nodes": "group:A", "precision": "single" })),
        with("/write/recovery", json!({ "nodes": { "within": { "sphere": { "center": [0, 0, 0], "radius": 1 } } } })),
        with("/write/recovery", json!({ "nodes": { "within": { "sphere": { "center": [0, 0, 0], "radius": 0 } } } })),
        with("/write/recovery", json!({ "nodes": { "rows": [0] } })),
        with("/write/recovery", json!({ "nodes": [4, 4] })),
        with("/write/recovery", json!({ "nodes": [] })),
        with("/write/recovery", json!({ "nodes": "A" })),
        with("/write/recovery", json!({ "nodes": [4], "precision": "half" })),
        with("/write/recovery", json!({ "precision": "single" })),
    ]
}

/// The schema that editors get is that of the types; `SUPEL_UPDATE_DOCS=1` writes it.
#[test]
fn the_schema_is_that_of_the_types() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/job.schema.json");
    let made = serde_json::to_string_pretty(&supel::job::schema()).expect("JSON") + "\n";
    if std::env::var_os("SUPEL_UPDATE_DOCS").is_some() {
        std::fs::write(&path, made).expect("written");
        return;
    }
    assert!(
        std::fs::read_to_string(&path).expect("the schema") == made,
        "schemas/job.schema.json is not that of the types"
    );
}

/// Where the schema of the report repeats words of the job, it has those of the job; `SUPEL_UPDATE_DOCS=1` writes them.
#[test]
fn the_report_knows_the_words_of_the_job() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/report.schema.json");
    let text = std::fs::read_to_string(&path).expect("the schema");
    let schema = supel::job::schema();
    let mut made = text.clone();
    for (key, definition) in [("method", "Method"), ("eigensolver", "Eigensolver"), ("coupling", "Coupling")] {
        let variants = schema["$defs"][definition]["oneOf"].as_array().expect("variants").iter();
        let words: Vec<String> = variants.map(|variant| variant["const"].to_string()).collect();
        let (before, after) = made.split_once(&format!("\"{key}\": {{ \"enum\": [")).expect("the key");
        let (_, after) = after.split_once(']').expect("the end of its words");
        made = format!("{before}\"{key}\": {{ \"enum\": [{}]{after}", words.join(", "));
    }
    if std::env::var_os("SUPEL_UPDATE_DOCS").is_some() {
        std::fs::write(&path, made).expect("written");
        return;
    }
    assert!(text == made, "schemas/report.schema.json has other words than the job");
}

/// Every value that a job may have is said what it is for.
#[test]
fn every_key_is_described() {
    fn walk(schema: &Value, part: &Value, place: &str, bare: &mut Vec<String>) {
        let target = part["$ref"].as_str().map(|to| schema.pointer(to.trim_start_matches('#')).expect("a definition"));
        for (key, value) in part["properties"].as_object().into_iter().flatten() {
            let here = format!("{place}.{key}");
            let of_type = value["$ref"].as_str().and_then(|to| schema.pointer(to.trim_start_matches('#')));
            // A table of one key is described as a whole.
            let is_only = part["properties"].as_object().is_some_and(|keys| keys.len() == 1);
            let of_table = Some(part).filter(|_| is_only);
            if [Some(value), of_type, of_table].iter().flatten().all(|part| part["description"].is_null()) {
                bare.push(here.clone());
            }
            walk(schema, value, &here, bare);
        }
        // Choices next to keys are conditions on these.
        let choices = ["oneOf", "anyOf"].into_iter().filter(|_| part["properties"].is_null());
        let choices = choices.filter_map(|key| part[key].as_array()).flatten();
        choices.chain(target).for_each(|part| walk(schema, part, place, bare));
        if part["items"].is_object() {
            walk(schema, &part["items"], &format!("{place}[]"), bare);
        }
    }
    let (schema, mut bare) = (supel::job::schema(), Vec::new());
    walk(&schema, &schema, "", &mut bare);
    assert!(bare.is_empty(), "keys without a description: {bare:?}");
}

/// What the schema refuses supel refuses, and the other way round: editors that know the schema tell the truth.
#[test]
fn schema_and_program_agree() {
    let schema = schema();
    let mut n_accepted = 0;
    let cases = changed_jobs().into_iter().chain(recoveries()).chain(fixed()).chain(loads());
    for case in cases.chain(scenes()).chain(modes_of_a_file()).chain(states()) {
        let found = read(&case);
        assert_eq!(schema.is_valid(&case), found.is_ok(), "{case}: {:?}", found.err().map(|error| error.to_string()));
        n_accepted += usize::from(found.is_ok());
    }
    assert!((10..50).contains(&n_accepted), "{n_accepted} of the cases are accepted");
}

#[test]
fn bundled_example_follows_the_schema() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/bracket/job.toml");
    let job = Job::read(&path).expect("the example is a job");
    let document = serde_json::to_value(&job).expect("json");
    assert!(schema().is_valid(&document), "{document:#}");
}
