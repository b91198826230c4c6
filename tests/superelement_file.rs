//! The superelement file as others see it: its JSON Schema, and a Python program that trusts nothing but its numbers.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use supel_models::superelements::particle as sample;

use serde_json::{Value, json};
use supel_runtime::{Coordinate, Direction, Flag, Matrix, Metadata, Method, Superelement, Tensors, Verdict};

fn in_project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

// ---- schema --------------------------------------------------------------------------------------------------------

fn schema() -> jsonschema::Validator {
    let text = std::fs::read_to_string(in_project("schemas/superelement.schema.json")).unwrap();
    let schema = serde_json::from_str(&text).unwrap();
    jsonschema::meta::validate(&schema).expect("the schema itself is valid");
    jsonschema::validator_for(&schema).unwrap()
}

/// The metadata document as it stands in the file.
fn document(superelement: &Superelement) -> Value {
    let bytes = superelement.to_bytes().unwrap().bytes;
    let length = u64::from_le_bytes(*bytes.first_chunk().unwrap()) as usize;
    let header: Value = serde_json::from_slice(&bytes[8..8 + length]).unwrap();
    serde_json::from_str(header["__metadata__"]["supel"].as_str().unwrap()).unwrap()
}

#[track_caller]
fn assert_follows(schema: &jsonschema::Validator, document: &Value) {
    let errors = schema.iter_errors(document).map(|error| format!("{}: {error}", error.instance_path()));
    assert_eq!(errors.collect::<Vec<_>>(), Vec::<String>::new());
}

#[test]
fn metadata_of_every_kind_follow_the_schema() {
    let schema = schema();
    for superelement in [sample::complete(), sample::two_particles(), sample::component(Method::CraigBampton)] {
        assert_follows(&schema, &document(&superelement));
    }
    let methods = [
        Method::CraigBampton,
        Method::Herting,
        Method::Rubin,
        Method::Macneal,
        Method::MixedInterface,
        Method::Guyan,
        Method::ModeAcceleration,
    ];
    let mut document = document(&sample::complete());
    for method in methods {
        document["method"] = serde_json::to_value(method).unwrap();
        assert_follows(&schema, &document);
    }
    for verdict in [Verdict::Pass, Verdict::Warn, Verdict::Fail] {
        document["verification"]["verdict"] = serde_json::to_value(verdict).unwrap();
        assert_follows(&schema, &document);
    }
    document["flags"] = serde_json::to_value([Flag::SingularMass]).unwrap();
    let mode = |error_bar_hz| Coordinate::FixedInterfaceMode { mode: 3, frequency_hz: 12.5, error_bar_hz };
    let mut coordinates = vec![mode(None), mode(Some(1e-6)), Coordinate::InertiaRelief { index: 0 }];
    coordinates.push(Coordinate::InterfaceRow { row: 7 });
    coordinates.push(Coordinate::ResidualVector { load: 0 });
    coordinates.push(Coordinate::ExpansionMode { column: 2 });
    coordinates.push(Coordinate::ElasticMode { mode: 0, frequency_hz: 1.0, error_bar_hz: None });
    coordinates.extend(Direction::ALL.map(|direction| Coordinate::Interface { node: 0, direction }));
    document["coordinates"] = serde_json::to_value(coordinates).unwrap();
    assert_follows(&schema, &document);
}

/// The objects of a document, each as a JSON pointer; the job has a schema of its own and the inputs have free names.
fn objects(value: &Value, pointer: String, found: &mut Vec<String>) {
    let free = ["/job", "/inputs"].contains(&pointer.as_str());
    match value {
        Value::Object(fields) if !free => {
            for (key, field) in fields {
                objects(field, format!("{pointer}/{key}"), found);
            }
            found.push(pointer);
        }
        Value::Array(items) => {
            for (k, item) in items.iter().enumerate() {
                objects(item, format!("{pointer}/{k}"), found);
            }
        }
        _ => {}
    }
}

/// The list of dofs without load: most scenes have none.
const ABSENT_WHERE_EMPTY: &str = "unloaded";

#[test]
fn schema_allows_no_other_field_and_misses_none() {
    let schema = schema();
    let good = document(&sample::complete());
    let mut pointers = Vec::new();
    objects(&good, String::new(), &mut pointers);
    assert!(pointers.len() > 15, "{pointers:?}");
    for pointer in pointers {
        let mut document = good.clone();
        document.pointer_mut(&pointer).unwrap()["surprise"] = json!(1);
        assert!(!schema.is_valid(&document), "a foreign field is allowed at `{pointer}`");
        let fields = good.pointer(&pointer).unwrap().as_object().unwrap();
        for key in fields.keys().filter(|key| **key != ABSENT_WHERE_EMPTY) {
            let mut document = good.clone();
            document.pointer_mut(&pointer).unwrap().as_object_mut().unwrap().remove(key);
            assert!(!schema.is_valid(&document), "`{key}` may be missing at `{pointer}`");
        }
    }
}

// ---- python --------------------------------------------------------------------------------------------------------

/// Runs the Python check on a superelement; `None` where there is no Python with numpy and safetensors.
///
/// The interpreter is `SUPEL_PYTHON`, or `python3`.
fn python_check(superelement: &Superelement) -> Option<Output> {
    let interpreter = std::env::var_os("SUPEL_PYTHON").unwrap_or_else(|| "python3".into());
    let probe = Command::new(&interpreter).args(["-c", "import numpy, safetensors"]).output();
    if !probe.is_ok_and(|probe| probe.status.success()) {
        println!("skipped: {} has no numpy and safetensors; set SUPEL_PYTHON", interpreter.display());
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sample.supel");
    superelement.write(&path).unwrap();
    let script = in_project("tests/superelement_file.py");
    Some(Command::new(&interpreter).arg(script).arg(&path).env("PYTHONUTF8", "1").output().unwrap())
}

#[test]
fn python_confirms_good_files() {
    let by_method = [Method::CraigBampton, Method::Herting].map(sample::component);
    for superelement in by_method.into_iter().chain([sample::complete(), sample::two_particles()]) {
        let Some(output) = python_check(&superelement) else {
            return;
        };
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
        assert!(text.contains("frequencies: ") && !text.contains("frequencies: skipped"), "{text}");
        let has_mass_properties = superelement.metadata().model.mass_properties.is_some();
        assert_eq!(text.contains("mass properties: mass 4,"), has_mass_properties, "{text}");
    }
}

/// Well-formed files of wrong content, which only the physics can tell.
#[test]
fn python_refuses_wrong_physics() {
    type Change = fn(&mut Tensors, &mut Metadata);
    let changes: [(&str, Change); 5] = [
        ("rigid-body motion is resisted", |t, _| t.stiffness = changed(&t.stiffness, (4, 4), 1e-3)),
        ("the reduced matrices give", |t, _| t.stiffness = changed(&t.stiffness, (7, 7), 1.0)),
        ("differs from rigid_body_mass", |t, _| t.mass = changed(&t.mass, (5, 5), 1e-6)),
        ("centre of mass is", |_, m| m.model.mass_properties.as_mut().unwrap().center_of_mass[1] += 1e-6),
        ("inertia is", |_, m| m.model.mass_properties.as_mut().unwrap().inertia[0][2] += 1e-6),
    ];
    for (message, change) in changes {
        let (mut tensors, mut metadata) = sample::parts(Method::Herting);
        change(&mut tensors, &mut metadata);
        let Some(output) = python_check(&Superelement::new(tensors, metadata).unwrap()) else {
            return;
        };
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(text.contains(message), "`{message}` expected, said: {text}");
    }
}

/// A copy of a matrix with something added to one entry.
fn changed(matrix: &Matrix, place: (usize, usize), added: f64) -> Matrix {
    let entry = |i, j| matrix[(i, j)] + if (i, j) == place { added } else { 0.0 };
    Matrix::from_fn(matrix.rows(), matrix.cols(), entry)
}
