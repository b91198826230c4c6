//! Same input, same bytes: whatever the threads, the folder, the memory, the day, and what else the process does.

use supel::cli::ExitCode;
use supel_models::{Ends, Material, brick, spring};
use supel_testing::chain::certified::eigensolver_words;

use crate::place::{Place, frequencies_hz, supel};

/// Superelement and body of the report.
type Written = (Vec<u8>, String);

/// Numbers of threads; more than any machine of ours has among them.
const THREADS: [&str; 4] = ["1", "2", "3", "8"];

/// The bundled example.
fn reduced(place: &Place, method: &str, threads: &str) -> Written {
    reduced_by(place, &["--method", method, "--threads", threads])
}

fn reduced_by(place: &Place, flags: &[&str]) -> Written {
    let job = place.text("job.toml");
    supel(&[["reduce", &job].as_slice(), flags].concat()).expect(ExitCode::Done);
    (place.bytes("bracket.supel"), place.report_body("bracket.report.json"))
}

#[track_caller]
fn assert_same(found: &Written, expected: &Written, what: &str) {
    assert!(found.0 == expected.0, "the superelement differs: {what}");
    assert_eq!(found.1, expected.1, "the report differs: {what}");
}

fn assert_threads_change_nothing(method: &str) {
    let place = Place::with_example();
    for solver in eigensolver_words() {
        let by = |threads| reduced_by(&place, &["--method", method, "--eigensolver", solver, "--threads", threads]);
        let first = by("1");
        for threads in THREADS {
            assert_same(&by(threads), &first, &format!("{method} by {solver} with {threads} threads"));
        }
    }
}

#[test]
fn pages_for_people_do_not_touch_the_superelement() {
    let place = Place::with_example();
    let plain = reduced_by(&place, &[]);
    let (html, junit) = (place.text("bracket.html"), place.text("bracket.xml"));
    assert_same(&reduced_by(&place, &["--html", &html, "--junit", &junit]), &plain, "with a page");
}

#[test]
fn herting_does_not_depend_on_threads() {
    assert_threads_change_nothing("herting");
}

#[test]
fn craig_bampton_does_not_depend_on_threads() {
    assert_threads_change_nothing("craig-bampton");
}

/// A beam of square section, whose bending modes come in pairs, with an interface at both ends.
fn square_beam() -> Place {
    // 2325 dofs: the sparse products of five tiles run on as many threads as there are.
    Place::with(&brick([30, 4, 4], [10.0, 1.0, 1.0], &Material::STEEL_SI))
}

/// The corners of the two ends of [`square_beam`].
const ENDS: &str = "--interface root=1,125,621,745 --interface tip=31,155,651,775";

fn beam(place: &Place, rest: &str) -> Written {
    place.reduce(&place.model_flags(), &format!("{ENDS} {rest}")).expect(ExitCode::Done);
    (place.bytes("x.supel"), place.report_body("x.report.json"))
}

/// Copies of a repeated frequency may turn into each other by any rounding; that none differs shows in the bytes.
#[test]
fn pairs_of_modes_do_not_depend_on_threads_nor_on_the_run() {
    let place = square_beam();
    for method in ["herting", "craig-bampton", "mixed-interface --held root"] {
        for solver in eigensolver_words() {
            let flags = format!("--method {method} --eigensolver {solver} --modes 8 --threads");
            let first = beam(&place, &format!("{flags} 1"));
            let found = frequencies_hz(&place.superelement("x.supel"));
            assert!(found.windows(2).any(|pair| pair[1] / pair[0] - 1.0 < 1e-6), "no repeated frequency: {found:?}");
            for threads in THREADS {
                let again = beam(&place, &format!("{flags} {threads}"));
                assert_same(&again, &first, &format!("{flags} {threads}"));
            }
        }
    }
}

/// METIS draws from `rand` and ARPACK keeps the state of its generator: a job before must not be felt by the one after.
#[test]
fn a_job_does_not_depend_on_the_jobs_before_it() {
    let (beams, chains) = (square_beam(), Place::with(&spring(200, Ends::Free)));
    for solver in eigensolver_words() {
        let of_beam = || beam(&beams, &format!("--method herting --eigensolver {solver} --modes 6"));
        let of_chain = || {
            let flags = format!("--interface ends=rows:0,199 --method herting --eigensolver {solver} --modes 9");
            chains.reduce(&chains.matrix_flags(), &flags).expect(ExitCode::Done);
            (chains.bytes("x.supel"), chains.report_body("x.report.json"))
        };
        let (first_beam, first_chain) = (of_beam(), of_chain());
        let (second_chain, second_beam) = (of_chain(), of_beam());
        assert_same(&second_beam, &first_beam, &format!("{solver}, the beam after the chain"));
        assert_same(&second_chain, &first_chain, &format!("{solver}, the chain before the beam"));
    }
}

/// Jobs that run at the same time share the state of the process.
#[test]
fn a_job_does_not_depend_on_jobs_that_run_at_its_side() {
    for solver in eigensolver_words() {
        let flags = |method: &str| format!("--method {method} --eigensolver {solver} --modes 6 --threads 2");
        let methods = ["herting", "craig-bampton", "herting", "craig-bampton"];
        let alone = methods.map(|method| beam(&square_beam(), &flags(method)));
        let together = std::thread::scope(|scope| {
            let started = methods.map(|method| scope.spawn(move || beam(&square_beam(), &flags(method))));
            started.map(|job| job.join().expect("a job that ends"))
        });
        for (job, (together, alone)) in together.iter().zip(&alone).enumerate() {
            assert_same(together, alone, &format!("{solver}, job {job} together with three others"));
        }
    }
}

#[test]
fn nothing_depends_on_the_folder_and_the_body_names_none() {
    let (a, b) = (Place::with_example(), Place::with_example());
    let (first, second) = (reduced(&a, "herting", "2"), reduced(&b, "herting", "2"));
    assert_same(&first, &second, "another folder");
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
