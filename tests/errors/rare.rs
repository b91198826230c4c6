//! Errors that need a hand: operators that overflow, documents that lie, builds without a part.

use std::process::{Command, Stdio};

use faer::Mat;
use supel::job::Job;

/// What the program says under a shell's limit, and its exit code.
fn program(args: &[&str], stdin: &str) -> (String, Option<i32>) {
    use std::io::Write;
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("supel"));
    command.args(args).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("started");
    child.stdin.take().expect("a pipe").write_all(stdin.as_bytes()).expect("written");
    let ended = child.wait_with_output().expect("ended");
    (String::from_utf8_lossy(&ended.stderr).into_owned(), ended.status.code())
}

#[test]
fn a_dense_matrix_that_is_not_finite() {
    let error = supel::dense::symmetric_eigen(Mat::from_fn(3, 3, |_, _| f64::NAN).as_ref()).expect_err("no numbers");
    assert_eq!(error.code(), "E-DENSE-EIGEN");
}

/// What cannot be written as JSON is an error, not an empty file: here names that a program gives to the library.
#[cfg(unix)]
#[test]
fn names_that_json_cannot_hold() {
    use std::os::unix::ffi::OsStrExt;

    use supel::error::ErrorClass;
    use supel::memory_forecast::Resources;

    use crate::place::Place;

    let place = Place::with_brick();
    let text = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx" }
interface = [{ name = "ends", nodes = { rows = [0, 1, 2, 30, 31, 32, 90, 91, 92] } }]
reduction = { method = "craig-bampton", modes = { count = 1 } }
write     = { superelement = "x.supel" }
"#;
    let job = Job::parse(text, "job.toml".as_ref()).expect("a job").resolve(&place.path("")).expect("resolved");
    let mut report = supel::reduce(&job, Resources::default(), &mut ()).expect("reduced").report;
    let odd = place.path("").join(std::ffi::OsStr::from_bytes(b"x\xff.supel"));
    report.run.superelement = Some(odd.clone());
    let error = report.to_json().expect_err("no JSON");
    assert_eq!((error.code(), error.class()), ("E-JSON", ErrorClass::Usage));
    report.write(&place.path("x.json")).expect_err("no JSON");
    assert!(!place.path("x.json").exists());
    let mut job = job;
    job.write.superelement = odd;
    let error = supel::reduce(&job, Resources::default(), &mut ()).expect_err("no JSON");
    assert_eq!(error.code(), "E-JSON", "{error}");
}

#[test]
fn a_node_that_an_interface_lists_twice() {
    let text = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx" }
interface = [{ name = "ends", nodes = [4, 7, 4] }]
reduction = { method = "herting", modes = { count = 1 } }
write     = { superelement = "x.supel" }
"#;
    let job = Job::parse(text, "job.toml".as_ref()).expect("a job");
    let error = job.validate().expect_err("a repetition");
    assert_eq!(error.code(), "E-DUP-INTERFACE");
    assert!(error.to_string().contains("node 4"), "{error}");
}

#[test]
fn a_boundary_of_an_interface_that_is_none() {
    let text = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx" }
interface = [{ name = "hub", nodes = [4] }]
reduction = { method = "herting", modes = { count = 1 } }
scene     = { boundaries = ["fix:hob"] }
write     = { superelement = "x.supel" }
"#;
    let job = Job::parse(text, "job.toml".as_ref()).expect("a job");
    let error = job.validate().expect_err("no such interface");
    assert_eq!(error.code(), "E-SCENE-INTERFACE");
    assert!(error.to_string().contains("hob") && error.to_string().contains("hub"), "{error}");
}

/// The child that reads HDF5 first, given no model.
#[test]
fn a_child_without_a_model() {
    let (said, code) = program(&["rehearse-reading"], "no model");
    assert_eq!(code, Some(6), "{said}");
    assert!(said.starts_with("supel: error[E-CHILD]: "), "{said}");
}

#[test]
fn a_file_that_is_no_superelement() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("x.supel");
    std::fs::write(&path, "no superelement").expect("written");
    let (said, code) = program(&["inspect", &path.display().to_string()], "");
    assert_eq!(code, Some(3), "{said}");
    assert!(said.starts_with("supel: error[E-SUPERELEMENT]: "), "{said}");
}

/// An HDF5 matrix whose last value is an unsigned number that no signed one equals.
#[cfg(feature = "hdf5")]
#[test]
fn an_unsigned_number_beyond_the_signed() {
    use supel::error::Error;
    use supel::input::{MatrixRole, hdf5::read_matrix};

    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("K.h5");
    let file = hdf5_metno::File::create(&path).expect("a file");
    file.new_dataset_builder().with_data(&[0_i64, 1, 2]).create("indptr").expect("pointers");
    file.new_dataset_builder().with_data(&[0_i64, 1]).create("indices").expect("indices");
    file.new_dataset_builder().with_data(&[1, u64::MAX]).create("data").expect("values");
    drop(file);
    let error = read_matrix(&path, None, MatrixRole::Stiffness).expect_err("no such number");
    assert!(matches!(error, Error::Hdf5Value { position: 1, .. }), "{error}");
    assert_eq!(error.code(), "E-HDF5-VALUE");
}

#[cfg(feature = "arpack")]
#[test]
fn arpack_with_solves_that_overflow() {
    use faer::MatMut;
    use supel::eigen::{ModalProblem, ModeRequest, ShiftInvert, Wanted, elastic_modes};
    use supel::job::Eigensolver;
    use supel::random::SEED;
    use supel_models::{Ends, spring};

    struct Overflowing;

    impl ShiftInvert for Overflowing {
        fn n(&self) -> usize {
            40
        }

        fn shift(&self) -> f64 {
            0.0
        }

        fn solve_in_place(&self, mut block: MatMut<'_, f64>) {
            for j in 0..block.ncols() {
                block.as_mut().col_mut(j).iter_mut().for_each(|value| *value *= 1e308 * 10.0);
            }
        }
    }

    let partition = crate::chain::partition(&spring(40, Ends::Fixed), &[]).expect("a chain");
    let problem = ModalProblem::of(partition.pencil(), partition.precision);
    let request = ModeRequest { wanted: Wanted::Count(3), eigensolver: Eigensolver::Arpack, seed: SEED };
    let error = elastic_modes(problem, &Overflowing, request).expect_err("no numbers");
    assert!(matches!(error, supel::error::Error::Arpack { .. }), "{error}");
    assert_eq!(error.code(), "E-ARPACK");
}

#[cfg(not(feature = "arpack"))]
#[test]
fn arpack_that_was_not_built_in() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name).display().to_string();
    let text = "%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n1 1 2\n2 2 2\n3 3 2\n2 1 -1\n3 2 -1\n";
    std::fs::write(place("K.mtx"), text).expect("written");
    std::fs::write(place("M.mtx"), text.replace('-', "0.")).expect("written");
    let (said, code) = program(
        &[
            "reduce",
            "--stiffness",
            &place("K.mtx"),
            "--mass",
            &place("M.mtx"),
            "--interface",
            "end=rows:0",
            "--method",
            "herting",
            "--modes",
            "1",
            "--eigensolver",
            "arpack",
            "--output",
            &place("x.supel"),
        ],
        "",
    );
    assert_eq!(code, Some(2), "{said}");
    assert!(said.starts_with("supel: error[E-NO-ARPACK]: "), "{said}");
}

#[cfg(not(feature = "hdf5"))]
#[test]
fn hdf5_that_was_not_built_in() {
    let (said, code) = program(
        &[
            "reduce",
            "--stiffness",
            "K.h5",
            "--mass",
            "M.h5",
            "--interface",
            "end=rows:0",
            "--method",
            "herting",
            "--modes",
            "1",
            "--output",
            "x.supel",
        ],
        "",
    );
    assert_eq!(code, Some(2), "{said}");
    assert!(said.starts_with("supel: error[E-FEATURE]: "), "{said}");
}
