//! Same input, same bytes: whatever the threads, the folder, the memory and the day.

use supel::cli::ExitCode;

use crate::place::{Place, supel};

/// Superelement and body of the report of the bundled example.
fn reduced(place: &Place, method: &str, threads: &str) -> (Vec<u8>, String) {
    let job = place.text("job.toml");
    supel(&["reduce", &job, "--method", method, "--threads", threads]).expect(ExitCode::Done);
    (place.bytes("bracket.supel"), place.report_body("bracket.report.json"))
}

fn assert_threads_change_nothing(method: &str) {
    let place = Place::with_example();
    let first = reduced(&place, method, "1");
    for threads in ["1", "2", "3"] {
        let again = reduced(&place, method, threads);
        assert!(again.0 == first.0, "the superelement of {method} with {threads} threads differs");
        assert_eq!(again.1, first.1, "{method}, {threads} threads");
    }
}

#[test]
fn herting_does_not_depend_on_threads() {
    assert_threads_change_nothing("herting");
}

#[test]
fn craig_bampton_does_not_depend_on_threads() {
    assert_threads_change_nothing("craig-bampton");
}

#[test]
fn nothing_depends_on_the_folder_and_the_body_names_none() {
    let (a, b) = (Place::with_example(), Place::with_example());
    let (first, second) = (reduced(&a, "herting", "2"), reduced(&b, "herting", "2"));
    assert!(first.0 == second.0, "the superelement depends on its folder");
    assert_eq!(first.1, second.1);
    for place in [&a, &b] {
        let folder = place.text("");
        assert!(!first.1.contains(folder.trim_end_matches('/')), "the body names {folder}");
    }
}

#[test]
fn the_job_in_the_file_makes_the_file_again() {
    let place = Place::with_example();
    for method in ["herting", "craig-bampton"] {
        let (bytes, body) = reduced(&place, method, "2");
        let job = supel(&["inspect", &place.text("bracket.supel"), "--job"]).expect(ExitCode::Done);
        place.write("again.json", job.out.as_bytes());
        std::fs::remove_file(place.path("bracket.supel")).expect("removed");
        supel(&["reduce", &place.text("again.json")]).expect(ExitCode::Done);
        assert!(place.bytes("bracket.supel") == bytes, "{method}: the file differs");
        assert_eq!(place.report_body("bracket.report.json"), body);
    }
}
