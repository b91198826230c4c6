//! Files of another model fail against the job, in the line that is there for it.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::Model;

use crate::place::{Place, steel_brick, supel};

const INTERFACES: &str = "--interface foot=1,11,31,41 --rigid-interface head=5,15,35";

/// A folder with the brick's superelement of a method and its job.
fn reduced(method: &str) -> Place {
    let place = Place::with_brick();
    place.reduce(&place.model_flags(), &format!("{INTERFACES} --method {method} --modes 5")).expect(ExitCode::Done);
    let job = supel(&["inspect", &place.text("x.supel"), "--job"]).expect(ExitCode::Done).out;
    place.write("kept.json", job.as_bytes());
    place
}

/// Writes the matrices of another model over those of the folder.
fn replace(place: &Place, model: &Model) {
    let other = Place::with(model);
    for name in ["K.mtx", "M.mtx"] {
        place.write(name, &other.bytes(name));
    }
}

/// The names of the failed checks against the job.
#[track_caller]
fn failures(place: &Place) -> Vec<String> {
    let ended = supel(&["verify", &place.text("x.supel"), "--job", &place.text("kept.json"), "--json"]);
    assert_eq!(ended.code, ExitCode::CheckFailed, "{}{}", ended.out, ended.err);
    let document: Value = serde_json::from_str(&ended.out).expect("JSON");
    assert_eq!(document["against"], "model");
    let checks = document["checks"].as_array().expect("checks");
    let failed = checks.iter().filter(|check| check["verdict"] == "fail");
    failed.map(|check| check["name"].as_str().expect("text").to_owned()).collect()
}

#[track_caller]
fn assert_fails(failures: &[String], expected: &str) {
    assert!(failures.iter().any(|name| name == expected), "expected {expected}, failed {failures:#?}");
}

/// A spring between two nodes along x: one entry of K changes by a thousandth, and its neighbours so that the component
/// stays free.
#[test]
fn a_stiffness_entry_off_by_a_thousandth() {
    for method in ["herting", "craig-bampton"] {
        let place = reduced(method);
        let mut model = steel_brick();
        // Nodes 1 and 2 lie along x: their x dofs are rows 0 and 3.
        let largest = model.stiffness.iter().find(|(i, j, _)| (*i, *j) == (0, 0)).expect("diagonal").2;
        for (i, j, value) in &mut model.stiffness {
            match (*i, *j) {
                (0, 0) | (3, 3) => *value += 1e-3 * largest,
                (0, 3) | (3, 0) => *value -= 1e-3 * largest,
                _ => {}
            }
        }
        replace(&place, &model);
        let failures = failures(&place);
        assert_fails(&failures, "static stiffness is that of the full model");
        assert_fails(&failures, "frequencies are those of the full model");
    }
}

#[test]
fn a_mass_entry_off_by_a_thousandth() {
    for method in ["herting", "craig-bampton"] {
        let place = reduced(method);
        let mut model = steel_brick();
        // Node 23, inside: no dof of an interface.
        for (i, j, value) in &mut model.mass {
            if i == j && (66..69).contains(i) {
                *value *= 1.001;
            }
        }
        replace(&place, &model);
        let failures = failures(&place);
        assert_fails(&failures, "rigid-body mass is that of the full model");
        assert_fails(&failures, "mass is that of the full model");
        assert_fails(&failures, "loads of gravity are those of the full model");
        assert!(!failures.iter().any(|name| name == "static stiffness is that of the full model"), "{failures:?}");
    }
}

#[test]
fn interfaces_in_another_order() {
    let place = reduced("herting");
    let mut job: Value = serde_json::from_slice(&place.bytes("kept.json")).expect("JSON");
    let interfaces = job["interface"].as_array_mut().expect("interfaces");
    interfaces[0]["nodes"] = serde_json::json!([11, 1, 31, 41]);
    place.write("kept.json", job.to_string().as_bytes());
    let failures = failures(&place);
    assert_fails(&failures, "interface is that of the job");
    assert_fails(&failures, "static stiffness is that of the full model");
}

#[test]
fn an_interface_left_out() {
    let place = reduced("herting");
    let mut job: Value = serde_json::from_slice(&place.bytes("kept.json")).expect("JSON");
    job["interface"].as_array_mut().expect("interfaces").remove(1);
    place.write("kept.json", job.to_string().as_bytes());
    assert_fails(&failures(&place), "interface is that of the job");
}

#[test]
fn a_model_that_is_held() {
    let place = reduced("herting");
    replace(&place, &supel_models::transform::grounded(&steel_brick(), 67, 1e9));
    assert_fails(&failures(&place), "full model has as many free motions");
}

/// The model's matrices in other bytes: a warning names the file, and nothing fails.
#[test]
fn the_same_matrices_in_another_file_warn() {
    let place = reduced("herting");
    let mut bytes = place.bytes("M.mtx");
    bytes.extend_from_slice(b"\n");
    place.write("M.mtx", &bytes);
    let args = ["verify", &place.text("x.supel"), "--job", &place.text("kept.json")];
    let ended = supel(&args).expect(ExitCode::Done);
    assert!(ended.out.contains("! warn") && ended.out.contains("worst at mass"), "{}", ended.out);
    supel(&[args.as_slice(), &["--strict"]].concat()).expect(ExitCode::CheckFailed);
}

/// A file that lacks the digest of one of its inputs: the line of the inputs warns, whatever others say of it.
#[test]
fn a_digest_that_the_file_does_not_have_warns() {
    let place = reduced("herting");
    let original = place.superelement("x.supel");
    let mut metadata = original.metadata().clone();
    metadata.inputs.remove("mass").expect("a digest");
    let altered = supel_runtime::Superelement::new(original.tensors().clone(), metadata).expect("a superelement still");
    altered.write(&place.path("x.supel")).expect("written");
    let ended = supel(&["verify", &place.text("x.supel"), "--job", &place.text("kept.json"), "--json"]);
    let document: Value = serde_json::from_str(&ended.out).expect("JSON");
    let mut checks = document["checks"].as_array().expect("checks").iter();
    let of_inputs = checks.find(|check| check["name"] == "it was made from the files of the job").expect("the check");
    assert_eq!((&of_inputs["verdict"], &of_inputs["worst"]), (&"warn".into(), &"mass".into()));
}

/// A mode missing from the file: what is left is right, and the count of the whole matrix tells.
#[test]
fn a_mode_that_the_file_does_not_have() {
    let place = reduced("craig-bampton");
    let original = place.superelement("x.supel");
    let (mut tensors, mut metadata) = (original.tensors().clone(), original.metadata().clone());
    let left_out = original.n_interface() + 1;
    let keep: Vec<usize> = (0..original.n_coordinates()).filter(|i| *i != left_out).collect();
    let matrix = |a: &supel_runtime::Matrix, cols: &[usize]| {
        supel_runtime::Matrix::from_fn(keep.len(), cols.len(), |i, j| a[(keep[i], cols[j])])
    };
    tensors.stiffness = matrix(&tensors.stiffness, &keep);
    tensors.mass = matrix(&tensors.mass, &keep);
    tensors.rigid_body_modes = matrix(&tensors.rigid_body_modes, &[0, 1, 2, 3, 4, 5]);
    tensors.gravity = tensors.gravity.as_ref().map(|gravity| matrix(gravity, &[0, 1, 2]));
    tensors.frequencies.remove(1);
    metadata.coordinates.remove(left_out);
    for coordinate in &mut metadata.coordinates {
        if let supel_runtime::Coordinate::FixedInterfaceMode { mode, .. } = coordinate {
            *mode = mode.saturating_sub(usize::from(*mode > 0));
        }
    }
    let altered = supel_runtime::Superelement::new(tensors, metadata).expect("a superelement still");
    altered.write(&place.path("x.supel")).expect("written");
    supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
    let failures = failures(&place);
    assert_fails(&failures, "frequencies are those of the full model");
    assert_fails(&failures, "it has the modes that the job asks for");
}
