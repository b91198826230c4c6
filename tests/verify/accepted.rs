//! What the scene accepts, measured by `supel verify --job` on the matrices of the file.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_runtime::{Matrix, Superelement};

use crate::place::{Place, supel};

const JOB: &str = r#"
model = { stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }
interface = [{ name = "foot", nodes = [1, 11, 31, 41] }]
reduction = { method = "craig-bampton", modes = { count = 4 } }
scene = { accept = { frequency = FREQUENCY, response_db = 60.0, static = 1e-6 } }
write = { superelement = "x.supel" }
"#;

fn reduced(limit: f64, more: &[&str]) -> (Place, Value, ExitCode) {
    let place = Place::with_brick();
    place.write("job.toml", JOB.replace("FREQUENCY", &limit.to_string()).as_bytes());
    let ended = supel(&[&["reduce", &place.text("job.toml"), "--json"], more].concat());
    let document = serde_json::from_str::<Value>(&ended.out).expect("JSON")["body"].clone();
    (place, document, ended.code)
}

fn verified(place: &Place, name: &str) -> (Value, ExitCode) {
    let ended = supel(&["verify", &place.text(name), "--job", &place.text("job.toml"), "--json"]);
    (serde_json::from_str(&ended.out).unwrap_or_else(|_| panic!("{}{}", ended.out, ended.err)), ended.code)
}

fn check<'a>(document: &'a Value, id: &str) -> &'a Value {
    document["checks"].as_array().expect("checks").iter().find(|check| check["id"] == id).expect(id)
}

#[test]
fn reduction_and_verification_say_the_same() {
    let (place, document, code) = reduced(5.0, &[]);
    assert_eq!(code, ExitCode::Done);
    let (again, code) = verified(&place, "x.supel");
    assert_eq!(code, ExitCode::Done, "{again:#}");
    for id in ["M-29", "M-30", "M-31"] {
        let (made, found) = (check(&document, id), check(&again, id));
        assert_eq!((&made["verdict"], &found["verdict"]), (&Value::from("pass"), &Value::from("pass")), "{id}");
        assert_eq!(made["worst"], found["worst"], "{id}");
    }
    let limit = 0.5 * check(&document, "M-29")["value"].as_f64().expect("a number");
    let (place, document, code) = reduced(limit, &["--allow-unverified"]);
    assert_eq!((code, &document["verdict"]), (ExitCode::CheckFailed, &Value::from("fail")));
    let (again, code) = verified(&place, "x.supel");
    assert_eq!((code, &check(&again, "M-29")["verdict"]), (ExitCode::CheckFailed, &Value::from("fail")));
    // Without --allow-unverified there is no file.
    let (place, _, code) = reduced(limit, &[]);
    assert_eq!((code, place.path("x.supel").exists()), (ExitCode::CheckFailed, false));
}

/// It is the file that is measured, and not a reduction that is made again.
#[test]
fn a_file_that_is_worse_than_its_reduction_is_measured() {
    let (place, document, _) = reduced(5.0, &[]);
    let original = place.superelement("x.supel");
    let (mut tensors, metadata) = (original.tensors().clone(), original.metadata().clone());
    // The modal stiffness of the first mode is doubled.
    let (n_b, k) = (original.n_interface(), &original.tensors().stiffness);
    tensors.stiffness =
        Matrix::from_fn(k.rows(), k.cols(), |i, j| if i == n_b && j == n_b { 2.0 * k[(i, j)] } else { k[(i, j)] });
    let altered = Superelement::new(tensors, metadata).expect("a superelement still");
    altered.write(&place.path("altered.supel")).expect("written");
    let (again, code) = verified(&place, "altered.supel");
    assert_eq!(code, ExitCode::CheckFailed);
    let value = |document: &Value| check(document, "M-29")["value"].as_f64().expect("a number");
    assert!(value(&again) > 1.01 * value(&document), "{} and {}", value(&again), value(&document));
}
