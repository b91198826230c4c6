//! Paths and files that are none: I-23, and of I-21 what a model has no key for.

use std::path::Path;

use super::{assert_done, assert_refused, chain, reduce_chain};
use crate::place::{Place, supel};

fn job(stiffness: &str) -> String {
    super::chain_job_with(stiffness, "count = 1")
}

#[track_caller]
fn stiffness_path_refused(place: &Place, path: &str, code: &str, parts: &[&str]) {
    place.write("job.toml", job(path).as_bytes());
    assert_refused(place, &supel(&["reduce", &place.text("job.toml")]), code, parts);
}

/// Damping and gyroscopic matrices have tables of their own: a key of the model is refused, not half obeyed. What the tables do is in
/// `tests/further_matrices`.
#[test]
fn i_21_matrices_are_no_keys_of_the_model() {
    let place = chain();
    for key in ["damping", "gyroscopic"] {
        stiffness_path_refused(
            &place,
            &format!("\"K.mtx\", {key} = \"C.mtx\""),
            "E-JOB-KEY",
            &[&format!("model.{key}")],
        );
    }
}

#[cfg(unix)]
#[test]
fn i_23_what_is_no_file() {
    let place = chain();
    std::fs::create_dir(place.path("folder")).expect("a folder");
    let made = std::process::Command::new("mkfifo").arg(place.path("pipe")).status().expect("mkfifo");
    assert!(made.success());
    for path in ["folder", "pipe", "/dev/zero", "/dev/stdin", ".", ".."] {
        stiffness_path_refused(&place, &format!("{path:?}"), "E-NOT-A-FILE", &["give the path of a file on disk"]);
    }
    for (path, part) in [
        ("\"none.mtx\"", "none.mtx: cannot be read"),
        ("\"a\\u0000b.mtx\"", "cannot be read"),
        (&format!("\"{}\"", "a".repeat(5000)), "cannot be read"),
        (&format!("\"{}K.mtx\"", "d/".repeat(5000)), "cannot be read"),
    ] {
        stiffness_path_refused(&place, path, "E-READ", &[part]);
    }
    stiffness_path_refused(&place, "\"\"", "E-JOB-EMPTY", &["model.stiffness"]);
}

/// Tables, maps and the job itself that are not files are refused, not waited for.
#[cfg(unix)]
#[test]
fn i_23_tables_and_jobs_that_are_no_files() {
    let place = chain();
    let made = std::process::Command::new("mkfifo").arg(place.path("pipe")).status().expect("mkfifo");
    assert!(made.success());
    for path in [place.text("pipe"), "/dev/zero".to_owned(), place.text(".")] {
        for flag in ["--dofs", "--nodes", "--mass"] {
            let mut flags = place.matrix_flags();
            flags.extend([flag.to_owned(), path.clone()]);
            if flag == "--mass" {
                flags.drain(2..4);
            }
            assert_refused(&place, &place.reduce(&flags, super::CHAIN), "E-NOT-A-FILE", &["regular file"]);
        }
        assert_refused(&place, &supel(&["reduce", &path]), "E-NOT-A-FILE", &["regular file"]);
        let inspected = supel(&["inspect", &path]);
        assert!(inspected.err.starts_with("supel: error[E-NOT-A-FILE]: "), "{}", inspected.err);
    }
}

/// By whatever name: what would be waited for is refused before any library opens it, directly and through links.
#[cfg(all(target_os = "linux", feature = "hdf5"))]
#[test]
fn i_23_endings_make_no_difference() {
    let place = chain();
    for (ending, is_mesh) in
        [("h5", true), ("mat", false), ("med", true), ("xdmf", true), ("h5m", true), ("mtx", false)]
    {
        let (pipe, device, kernel) = (format!("pipe.{ending}"), format!("zero.{ending}"), format!("kernel.{ending}"));
        let made = std::process::Command::new("mkfifo").arg(place.path(&pipe)).status().expect("mkfifo");
        assert!(made.success());
        std::os::unix::fs::symlink("/dev/zero", place.path(&device)).expect("a link");
        std::os::unix::fs::symlink("/proc/kmsg", place.path(&kernel)).expect("a link");
        for name in [&pipe, &device, &kernel] {
            let path = place.text(name);
            stiffness_path_refused(&place, &format!("{path:?}"), "E-NOT-A-FILE", &["give the path of a file on disk"]);
            if is_mesh {
                let mut flags = place.matrix_flags();
                flags.extend(["--nodes".to_owned(), path]);
                assert_refused(&place, &place.reduce(&flags, super::CHAIN), "E-NOT-A-FILE", &["regular file"]);
            }
        }
        let text = "<Xdmf><Domain><Grid><Geometry GeometryType=\"XYZ\"><DataItem Format=\"HDF\">";
        for name in [&pipe, &device, &kernel] {
            let text = format!("{text}{name}:/x</DataItem></Geometry></Grid></Domain></Xdmf>");
            place.write("mesh.xdmf", text.as_bytes());
            let mut flags = place.matrix_flags();
            flags.extend(["--nodes".to_owned(), place.text("mesh.xdmf")]);
            assert_refused(&place, &place.reduce(&flags, super::CHAIN), "E-NOT-A-FILE", &[name, "regular file"]);
        }
    }
    for path in ["/proc/kmsg", "/proc/self/mem", "/dev/stdin"] {
        let ended = supel(&["inspect", path]);
        assert!(ended.err.starts_with("supel: error[E-"), "{}", ended.err);
        assert_eq!(ended.code, supel::cli::ExitCode::InputData, "{}", ended.err);
    }
}

/// A file that is touched while it is read may hold what nobody wrote: it is refused although all of it parses.
#[test]
fn i_23_a_file_that_is_written_while_it_is_read() {
    use std::sync::atomic::{AtomicBool, Ordering};
    use supel::error::Error;
    use supel::job::ModelJob;

    let place = Place::with(&supel_models::spring(30_000, supel_models::Ends::Free));
    let model = ModelJob { stiffness: place.path("K.mtx"), mass: Some(place.path("M.mtx")), ..ModelJob::default() };
    assert!(supel::input::read(&model).is_ok());
    let (file, is_read) =
        (std::fs::File::options().write(true).open(place.path("K.mtx")).expect("a file"), AtomicBool::new(false));
    let error = std::thread::scope(|scope| {
        scope.spawn(|| {
            while !is_read.load(Ordering::Relaxed) {
                file.set_modified(std::time::SystemTime::now()).expect("touched");
            }
        });
        // On a busy machine the other thread may not run during one reading.
        let error = (0..100).find_map(|_| supel::input::read(&model).err());
        is_read.store(true, Ordering::Relaxed);
        error.expect("a file that changes")
    });
    assert!(matches!(&error, Error::Changed { path } if *path == place.path("K.mtx")), "{error}");
    assert_eq!((error.code(), error.class() as u8), ("E-CHANGED", 7));
}

/// Paths lead where they say, by `..`, absolute or through a link: a job may name any file its user may read. What another
/// file names is held in its folder (see the XDMF references).
#[cfg(unix)]
#[test]
fn i_23_paths_out_of_the_folder() {
    let (place, other) = (chain(), chain());
    std::os::unix::fs::symlink(other.path("K.mtx"), place.path("link.mtx")).expect("a link");
    let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    let folder = other.path("");
    for path in ["link.mtx".to_owned(), other.text("K.mtx"), format!("../{}/K.mtx", name(&folder))] {
        place.write("job.toml", job(&format!("{path:?}")).as_bytes());
        assert_done(&place, &supel(&["reduce", &place.text("job.toml")]), &[]);
    }
}

#[cfg(feature = "hdf5")]
#[test]
fn i_23_a_mesh_that_names_other_files() {
    let place = Place::with_brick();
    for reference in ["../nodes.h5:/x", "/etc/passwd:/x", "sub/../../nodes.h5:/x"] {
        let text = format!(
            "<Xdmf Version=\"3.0\"><Domain><Grid><Geometry GeometryType=\"XYZ\">\
             <DataItem Format=\"HDF\" Dimensions=\"45 3\" NumberType=\"Float\" Precision=\"8\">{reference}</DataItem>\
             </Geometry></Grid></Domain></Xdmf>"
        );
        place.write("nodes.xdmf", text.as_bytes());
        let mut flags = place.matrix_flags();
        flags.extend(["--nodes".into(), place.text("nodes.xdmf")]);
        let ended = place.reduce(&flags, "--interface foot=1,11,31,41 --method herting --modes 5");
        assert_refused(&place, &ended, "E-XDMF-REFERENCE", &[reference, "in the folder of the XDMF file"]);
    }
}

/// The output side: folders, devices and names that say nothing.
#[test]
fn i_23_outputs_that_cannot_be() {
    let place = chain();
    std::fs::create_dir(place.path("folder.supel")).expect("a folder");
    for (output, code) in [
        (place.text("missing/x.supel"), "E-FOLDER"),
        (format!("{}/{}.supel", place.text(""), "a".repeat(300)), "E-WRITE"),
        (place.text("x.txt"), "E-OUTPUT-NAME"),
        (place.text(".supel"), "E-OUTPUT-NAME"),
    ] {
        let mut flags = place.matrix_flags();
        flags.extend(super::CHAIN.split(' ').map(str::to_owned));
        let flags: Vec<&str> = flags.iter().map(String::as_str).collect();
        let ended = supel(&[["reduce", "--output", &output].as_slice(), &flags].concat());
        assert_refused(&place, &ended, code, &[]);
    }
    assert_done(&place, &reduce_chain(&place), &[]);
}

#[test]
fn i_23_a_folder_in_the_place_of_the_output() {
    let place = chain();
    std::fs::create_dir(place.path("x.supel")).expect("a folder");
    let ended = reduce_chain(&place).expect(supel::cli::ExitCode::Io);
    assert!(ended.err.contains("x.supel: not a regular file"), "{}", ended.err);
    assert!(place.path("x.supel").is_dir());
}
