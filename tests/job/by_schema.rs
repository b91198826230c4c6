//! Every value of jobs with every key, replaced by every kind of value: the schema and the program accept the same ones.

use std::collections::BTreeSet;
use std::path::Path;

use rayon::prelude::*;
use serde_json::{Map, Value, json};
use supel::error::{Error, Result};
use supel::job::Job;

use super::schema;

/// Every kind of region.
fn regions() -> [Value; 4] {
    [
        json!({ "box": { "min": [-9.5, -9.5, -9.5], "max": [9.5, 9.5, 9.5] } }),
        json!({ "plane": { "point": [0.25, 1.25, 2.25], "normal": [0.5, 0.5, 0.5], "tolerance": 0.25 } }),
        json!({ "cylinder": { "from": [0.25, 0.5, 0.75], "to": [3.25, 4.25, 5.25], "radius": 9.5, "inner_radius": 0.25 } }),
        json!({ "sphere": { "center": [0.25, 1.25, 2.25], "radius": 0.25 } }),
    ]
}

/// A job with these interfaces, modes and recovered nodes.
fn job(interfaces: &Value, modes: &Value, recovered: &Value) -> Value {
    json!({
        "model": {
            "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "m.dof", "nodes": "n.csv", "layout": "op4", "symmetric": "lower", "duplicates": "refuse",
            "drop_empty": true, "units": "mm", "stiffness_digits": 7, "mass_digits": 5, "held_rotations": ["rx", "rz"],
            "frames": "frames.csv", "constraints": "G.mtx", "constraints_to_ground": "accept", "mechanisms": "accept", "state": "preloaded", "internal_forces": "q.mtx",
            "expect": { "mass": 2.5, "cg": [0.25, 1.25, 2.25] },
            "assumes": { "sentences": ["nothing moves"], "gravity": [0.25, 0.5, 1.5], "at_rest": ["hub.ux"], "left_out": ["hub.rx", "hub.ry"], "unseen_hz": [21.5, 22.5] },
        },
        "interface": interfaces,
        "fixed": [{ "name": "foot", "nodes": recovered, "dofs": ["uy", "ry"] }],
        "load": [
            { "name": "thrust", "nodes": recovered, "force": [0.25, 1.25, 2.25] },
            { "name": "pressure", "file": "f.mtx", "column": 3, "residual": false },
            { "name": "water", "nodes": recovered, "pressure": 2.5 },
            { "name": "spin", "rotation": { "axis": [0.25, 1.25, 2.25], "through": [0.5, 1.5, 2.5] } },
        ],
        "added_mass": [{ "node": 7, "mass": 2.5, "inertia": [2.5, 3.5, 4.5, 0.25, 0.5, 0.75], "offset": [0.25, 1.25, 2.25] }],
        "matrix": [{ "name": "seal", "kind": "damping", "file": "C.mtx" }],
        "damping": { "rayleigh": { "mass": 0.25, "stiffness": 0.5, "mass_acts_on": "deformation" }, "modal": { "ratio": 0.25 }, "rigid_motion": "resist" },
        "reduction": { "method": "herting", "modes": modes, "inertia_relief": true, "eigensolver": "arpack" },
        "scene": { "analysis": "transient", "gravity": [0.25, 0.5, 1.5], "unloaded": ["hub.ry", "hub.rx"], "grounded": ["hub.ux"], "prescribed": [], "outputs": { "nodes": [7] }, "band_hz": [0.25, 500.5], "boundaries": ["free", "fix:hub", "mass:hub", "mass:hub=2.5", "spring:hub=1e5"], "damping": { "ratio": 0.25 }, "accept": { "frequency": 0.25, "response_db": 1.5, "internal_load": 0.5, "static": 0.125 } },
        "run": { "certify": "full", "memory_gib": 4.5, "precision": "mixed", "constraint_modes": "stored", "skip": "nothing" },
        "write": {
            "superelement": "x.supel", "report": "x.json", "html": "x.html", "junit": "x.xml",
            "recovery": { "nodes": recovered, "precision": "single" },
            "quantities": { "matrix": "stress.mtx", "names": "stress.csv" },
        },
    })
}

/// Jobs that together have every key. No number that the changes put in crosses another one: corners of a box stay in order.
fn jobs() -> Vec<Value> {
    let labels = json!([{ "name": "hub", "nodes": [7, 8], "coupling": "direct", "dofs": ["ux", "rz"], "axes": { "z": [0.25, 1.25, 2.25], "x": [1.5, 0.5, 0.25] } }]);
    let mut jobs = vec![
        job(&labels, &json!({ "count": 5 }), &json!([4, 6])),
        job(
            &json!([{ "name": "hub", "nodes": { "rows": [3, 5] } }]),
            &json!({ "up_to_hz": 100.5 }),
            &json!("group:SKIN"),
        ),
        job(
            &json!([{ "name": "hub", "nodes": [7, 8], "coupling": "average", "weights": [1.5, 2.5], "origin": "area" }]),
            &json!({ "count": 5 }),
            &json!("group:SKIN"),
        ),
        job(
            &json!([{ "name": "hub", "nodes": "group:HUB", "coupling": "rigid", "origin": "centroid", "axes": "hole" }]),
            &json!({ "count": 5 }),
            &json!("group:SKIN"),
        ),
    ];
    let hub = json!([{ "name": "hub", "nodes": "group:HUB" }]);
    let mut of_file = job(&hub, &json!({ "file": "V.mtx" }), &json!([4, 6]));
    of_file["reduction"]["method"] = "mode-acceleration".into();
    of_file["damping"]["modal"] = json!({ "ratios": [0.25, 0.5] });
    jobs[1]["damping"]["modal"] = json!({ "table": [[10.5, 0.25]] });
    jobs[1]["scene"] =
        json!({ "analysis": "static", "gravity": false, "prescribed": [{ "name": "table", "interfaces": ["hub"] }] });
    jobs[2]["scene"] = json!({ "analysis": "modal", "connected": ["hub"], "band_hz": [0.25, 500.5] });
    if let Value::Object(reduction) = &mut jobs[2]["reduction"] {
        reduction.remove("modes");
    }
    jobs[3]["reduction"] = json!({ "method": "mixed-interface", "modes": { "count": 5 }, "held": ["hub", "hub.rx"] });
    jobs.push(of_file);
    let mut of_statics = jobs[1].clone();
    if let Value::Object(reduction) = &mut of_statics["reduction"] {
        reduction.remove("modes");
    }
    if let Value::Object(run) = &mut of_statics["run"] {
        run.remove("skip");
    }
    jobs.push(of_statics);
    jobs.extend(regions().map(|region| {
        let hub = json!([{ "name": "hub", "nodes": { "within": region }, "coupling": "rigid", "origin": [0.25, 1.25, 2.25] }]);
        job(&hub, &json!({ "count": 5 }), &json!({ "within": { "sphere": { "center": [0.25, 1.25, 2.25], "radius": 0.25 } } }))
    }));
    jobs
}

/// What is put in the place of every value.
fn values() -> Vec<Value> {
    vec![
        Value::Null,
        json!(true),
        json!(0),
        json!(-1),
        json!(1.5),
        json!(-0.5),
        json!(7),
        json!(7.0),
        json!(""),
        json!(" "),
        json!("x"),
        json!("nan"),
        json!("group:"),
        json!("group:X"),
        json!("mass:hub=0"),
        json!("mass:hub=-2"),
        json!("mass:hub=nan"),
        json!("mass:hub=1e"),
        json!("mass:hub=+.5e-3"),
        json!("spring:hub"),
        json!("spring:=2"),
        json!("spring:hub=0"),
        json!("spring:hub=1e5"),
        json!([]),
        json!([1.5]),
        json!([1, 2, 3]),
        json!([1.0, 2.0]),
        json!(["ux"]),
        json!(["ux", "ux"]),
        json!(["x"]),
        json!([null]),
        json!([[]]),
        json!({}),
        json!({ "zzz": 1 }),
        json!({ "none": {} }),
        json!({ "none": null }),
    ]
}

/// The places of all values of a document, the document itself first.
fn places(value: &Value, place: &str, found: &mut Vec<String>) {
    found.push(place.to_owned());
    match value {
        Value::Object(fields) => fields.iter().for_each(|(key, value)| places(value, &format!("{place}/{key}"), found)),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(at, item)| places(item, &format!("{place}/{at}"), found));
        }
        _ => {}
    }
}

/// The job with one thing changed, in every way; what `seen` has at a place was changed there in another job.
fn changed(job: &Value, seen: &mut BTreeSet<(String, String)>) -> Vec<Value> {
    let (mut all, mut cases) = (Vec::new(), Vec::new());
    places(job, "", &mut all);
    all.retain(|place| seen.insert((place.clone(), job.pointer(place).expect("a place").to_string())));
    for place in all {
        let mut put = |value: Value| {
            let mut case = job.clone();
            *case.pointer_mut(&place).expect("a place") = value;
            cases.push(case);
        };
        values().into_iter().for_each(&mut put);
        match job.pointer(&place).expect("a place") {
            Value::Object(fields) => {
                let with =
                    |key: &str| fields.iter().map(|(k, v)| (k.clone(), v.clone())).chain([(key.to_owned(), json!(1))]);
                put(Value::Object(with("zzz").collect()));
                for key in fields.keys() {
                    put(Value::Object(
                        fields.iter().filter(|(k, _)| *k != key).map(|(k, v)| (k.clone(), v.clone())).collect(),
                    ));
                }
                // Values by position, without their keys.
                put(Value::Array(fields.values().cloned().collect()));
            }
            Value::Array(items) => {
                put(Value::Array(items.iter().skip(1).cloned().collect()));
                put(Value::Array(items.iter().chain(items.first()).cloned().collect()));
                put(Value::Object(
                    items.iter().enumerate().map(|(at, item)| (at.to_string(), item.clone())).collect::<Map<_, _>>(),
                ));
            }
            _ => {}
        }
    }
    cases
}

/// Whether an error is about two keys that do not go together, which a schema of single values cannot tell.
fn is_about_two_keys(error: &Error) -> bool {
    matches!(
        error,
        Error::SceneInterface { .. }
            | Error::ScenePart { .. }
            | Error::SceneConflict { .. }
            | Error::SceneCarrier { .. }
            | Error::SceneLeftOut { .. }
            | Error::AssumedGravity { .. }
            | Error::SceneStatic { .. }
            | Error::JobMass
            | Error::HeldInterface { .. }
            | Error::InterfaceConflict { .. }
            | Error::InterfaceOverlap { .. }
            | Error::InterfaceTwice { .. }
            | Error::FixedTwice { .. }
            | Error::LoadTwice { .. }
            | Error::MatrixTwice { .. }
            | Error::WeightCount { .. }
            | Error::WeightSpread { .. }
    )
}

/// Asserts that a message has no words of a deserialiser, which are those of the program's language.
#[track_caller]
fn assert_plain(message: &str, document: &str) {
    const FOREIGN: [&str; 9] = [
        "usize",
        "i64",
        "f64",
        "struct",
        "invalid type",
        "invalid value",
        "invalid length",
        "unknown variant",
        "missing field",
    ];
    assert!(!FOREIGN.iter().any(|words| message.contains(words)), "{message}: {document}");
}

fn accepted(text: &str, path: &str) -> Result<()> {
    Job::parse(text, Path::new(path))?.validate()
}

#[test]
fn schema_and_program_agree_on_every_value() {
    let schema = schema();
    let (mut cases, mut seen) = (BTreeSet::new(), BTreeSet::new());
    for job in jobs() {
        assert!(schema.is_valid(&job), "{job:#}");
        cases.extend(changed(&job, &mut seen).iter().map(Value::to_string));
    }
    let compared = cases.par_iter().map(|text| {
        let case: Value = serde_json::from_str(text).expect("JSON");
        let is_valid = schema.is_valid(&case);
        let mut programs = vec![accepted(text, "job.json")];
        // TOML has no null.
        programs.extend(
            toml::to_string(&case).ok().filter(|_| !text.contains("null")).map(|text| accepted(&text, "job.toml")),
        );
        let n_accepted = programs.iter().filter(|found| found.is_ok()).count();
        let mut disagreements = Vec::new();
        for found in &programs {
            if let Err(error @ Error::JobSyntax { .. }) = found {
                assert_plain(&error.to_string(), text);
            }
            let is_allowed = found.as_ref().is_err_and(is_about_two_keys);
            if is_valid != found.is_ok() && !is_allowed {
                disagreements.push(format!("{is_valid} by the schema, {found:?}: {text}"));
            }
        }
        (programs.len(), n_accepted, disagreements)
    });
    let (n_cases, n_accepted, disagreements) = compared.reduce(
        || (0, 0, Vec::new()),
        |(n_cases, n_accepted, mut all), (more_cases, more_accepted, more)| {
            all.extend(more);
            (n_cases + more_cases, n_accepted + more_accepted, all)
        },
    );
    assert!(
        disagreements.is_empty(),
        "{} of {n_cases}, first {:#?}",
        disagreements.len(),
        &disagreements[..disagreements.len().min(12)]
    );
    assert!(n_cases > 5000 && n_accepted > 200, "{n_accepted} of {n_cases} are accepted");
}

/// Statics need no modes, unless nothing is left out.
#[test]
fn a_job_of_statics_names_modes_where_nothing_is_skipped() {
    let schema = schema();
    for (run, modes, is_right) in [
        (json!({}), None, true),
        (json!({ "skip": "nothing" }), None, false),
        (json!({ "skip": "nothing" }), Some(json!({ "count": 5 })), true),
    ] {
        let mut job = json!({
            "model": { "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "m.dof" },
            "interface": [{ "name": "hub", "nodes": [7] }],
            "reduction": { "method": "herting" },
            "scene": { "analysis": "static" },
            "run": run,
            "write": { "superelement": "x.supel" },
        });
        if let Some(modes) = modes {
            job["reduction"]["modes"] = modes;
        }
        let found = accepted(&job.to_string(), "job.json");
        assert_eq!((schema.is_valid(&job), found.is_ok()), (is_right, is_right), "{job}: {found:?}");
    }
}

/// The jobs have every key, so that every key was changed.
#[test]
fn the_changed_jobs_have_every_key() {
    fn keys(part: &Value, found: &mut BTreeSet<String>) {
        match part {
            Value::Object(fields) => fields.values().for_each(|value| keys(value, found)),
            Value::Array(items) => items.iter().for_each(|item| keys(item, found)),
            _ => {}
        }
        found.extend(part["properties"].as_object().into_iter().flat_map(|keys| keys.keys().cloned()));
    }
    let mut wanted = BTreeSet::new();
    keys(&supel::job::schema(), &mut wanted);
    let mut there = Vec::new();
    jobs().iter().for_each(|job| places(job, "", &mut there));
    let there: BTreeSet<&str> = there.iter().filter_map(|place| place.rsplit('/').next()).collect();
    let missing: Vec<&String> = wanted.iter().filter(|key| !there.contains(key.as_str())).collect();
    assert!(missing.is_empty() && wanted.len() > 40, "{missing:?} of {}", wanted.len());
}

/// TOML has numbers that JSON has not.
#[test]
fn numbers_that_are_none_are_refused_everywhere() {
    let mut n_numbers = 0;
    for job in jobs() {
        let mut all = Vec::new();
        places(&job, "", &mut all);
        for place in all.iter().filter(|place| job.pointer(place).is_some_and(Value::is_number)) {
            let mut marked = job.clone();
            *marked.pointer_mut(place).expect("a place") = json!(123_456.5);
            let text = toml::to_string(&marked).expect("TOML");
            for none in ["nan", "-nan", "inf", "-inf"] {
                let case = text.replace("123456.5", none);
                assert_ne!(case, text);
                assert!(accepted(&case, "job.toml").is_err(), "{place} = {none}");
            }
            n_numbers += 1;
        }
    }
    assert!(n_numbers > 50, "{n_numbers}");
}
