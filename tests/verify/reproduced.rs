//! `supel verify --reproduce`: the job run again, its bytes compared.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_runtime::{Metadata, Superelement, Tensors};

use crate::place::{Ended, Place, supel};

const JOB: &str = r#"
[model]
stiffness = "K.mtx"
mass = "M.mtx"
dofs = "dofs.txt"
nodes = "nodes.csv"

[[interface]]
name = "foot"
nodes = [1, 11, 31, 41]

[reduction]
method = "herting"
modes = { count = 5 }

[write]
superelement = "x.supel"
recovery = { nodes = [22, 23] }
"#;

/// A folder with a job, its files and its superelement.
fn reduced() -> Place {
    let place = Place::with_brick();
    place.write("job.toml", JOB.as_bytes());
    supel(&["reduce", &place.text("job.toml"), "--quiet"]).expect(ExitCode::Done);
    place
}

fn reproduce(place: &Place, name: &str, more: &[&str]) -> Ended {
    supel(&[&["verify", &place.text(name), "--reproduce", "--json"], more].concat())
}

fn document(ended: &Ended) -> Value {
    serde_json::from_str(&ended.out).expect("JSON")
}

/// The check of the bytes.
fn check(document: &Value) -> Value {
    let checks = document["checks"].as_array().expect("checks").iter();
    checks.last().filter(|check| check["name"] == "the same job makes it again").expect("the check").clone()
}

/// Writes an altered superelement to altered.supel.
fn alter(place: &Place, alter: impl FnOnce(&mut Tensors, &mut Metadata)) {
    let original = place.superelement("x.supel");
    let (mut tensors, mut metadata) = (original.tensors().clone(), original.metadata().clone());
    alter(&mut tensors, &mut metadata);
    let altered = Superelement::new(tensors, metadata).expect("a superelement still");
    altered.write(&place.path("altered.supel")).expect("written");
}

#[test]
fn the_same_job_makes_the_same_bytes_from_the_file_and_from_the_document_by_any_threads() {
    let place = reduced();
    let job = place.text("job.toml");
    for (more, against) in [(vec![], "file"), (vec!["--job", job.as_str()], "model")] {
        for threads in ["1", "3"] {
            let ended = reproduce(&place, "x.supel", &[more.as_slice(), &["--threads", threads]].concat());
            let ended = ended.expect(ExitCode::Done);
            let document = document(&ended);
            assert_eq!((&document["reproduced"], &document["against"]), (&true.into(), &against.into()));
            assert_eq!(check(&document)["verdict"], "pass");
            let unvouched = document["unvouched"].as_array().expect("a list").iter();
            assert_eq!(unvouched.map(|unvouched| &unvouched["field"]).collect::<Vec<_>>(), ["job"]);
        }
    }
    let text = supel(&["verify", &place.text("x.supel"), "--reproduce"]).expect(ExitCode::Done).out;
    assert!(text.contains("the same job makes now"), "{text}");
}

/// Paths of the kept job are relative to the file: folders move as a whole.
#[test]
fn a_folder_that_moved_makes_the_same_bytes() {
    let (place, other) = (reduced(), Place::new());
    for name in ["K.mtx", "M.mtx", "dofs.txt", "nodes.csv", "x.supel"] {
        other.write(name, &place.bytes(name));
    }
    drop(place);
    reproduce(&other, "x.supel", &[]).expect(ExitCode::Done);
}

#[test]
fn the_last_bit_of_a_number_and_what_differs_is_named() {
    let place = reduced();
    alter(&place, |tensors, metadata| {
        let rows = tensors.stiffness.rows();
        let last = |i: usize, j: usize| if (i, j) == (rows - 1, rows - 1) { f64::EPSILON } else { 0.0 };
        let stiffness = &tensors.stiffness;
        tensors.stiffness = supel_runtime::Matrix::from_fn(rows, rows, |i, j| stiffness[(i, j)] * (1.0 + last(i, j)));
        metadata.verification.checks[0].value = Some(1e-17);
    });
    // Nothing else sees either.
    supel(&["verify", &place.text("altered.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
    for more in [&[][..], &["--job", &place.text("job.toml")]] {
        let ended = reproduce(&place, "altered.supel", more).expect(ExitCode::CheckFailed);
        let document = document(&ended);
        let check = check(&document);
        assert_eq!((&check["verdict"], &check["value"]), (&"fail".into(), &2.0.into()));
        let worst = check["worst"].as_str().expect("text").to_owned();
        assert!(worst.contains("stiffness (by ") && worst.contains("verification.checks[0].value"), "{worst}");
        assert!(document["unvouched"].as_array().expect("a list").len() > 1);
    }
}

/// The job asks for other things than the one that made the file.
#[test]
fn another_job_is_told() {
    let place = reduced();
    place.write("other.toml", JOB.replace("count = 5", "count = 4").as_bytes());
    let ended = reproduce(&place, "x.supel", &["--job", &place.text("other.toml")]).expect(ExitCode::CheckFailed);
    assert_eq!(check(&document(&ended))["verdict"], "fail");
}

#[test]
fn a_file_of_another_version_is_not_made_again() {
    let place = reduced();
    alter(&place, |_, metadata| metadata.generator.version = "0.0.1".to_owned());
    let ended = reproduce(&place, "altered.supel", &[]).expect(ExitCode::Usage);
    assert!(ended.out.contains("E-OTHER-VERSION") && ended.out.contains("0.0.1"), "{}", ended.out);
}

#[test]
fn a_file_whose_job_cannot_be_read_takes_one() {
    let place = reduced();
    alter(&place, |_, metadata| metadata.job["future"] = 1.into());
    let ended = reproduce(&place, "altered.supel", &[]).expect(ExitCode::Usage);
    assert!(ended.out.contains("E-KEPT-JOB") && ended.out.contains("--job"), "{}", ended.out);
    let ended = reproduce(&place, "altered.supel", &["--job", &place.text("job.toml")]).expect(ExitCode::CheckFailed);
    assert_eq!(check(&document(&ended))["verdict"], "fail");
}
