//! The same curves, to the last bit, from a superelement in memory, from its file, and from the program `supel`.

use std::path::{Path, PathBuf};
use std::process::Command;

use supel_runtime::Superelement;
use validation::examples::{Example, Run, elbow, motion_based, rotating};
use validation::integrator::Scheme;
use validation::part::{Part, reduced, reduced_by_command};

/// The program, built from this workspace with the profile of this test.
fn supel() -> PathBuf {
    let profile = if cfg!(debug_assertions) { "dev" } else { "release" };
    let arguments = ["build", "--quiet", "--package", "supel", "--bin", "supel", "--profile", profile];
    let status = Command::new(env!("CARGO")).args(arguments).status().expect("cargo runs");
    assert!(status.success(), "supel is not built");
    // The test is in `deps` beside the program.
    let test = std::env::current_exe().expect("this test");
    test.parent().and_then(Path::parent).expect("a folder").join("supel")
}

/// The first twentieth of the strategy of two legs: joints, loads, modes.
fn curves(parts: &[Superelement]) -> Run {
    let scheme = Scheme { n_steps: 150, ..elbow::SCHEME };
    let run = elbow::run(parts, &motion_based(2, 6), &scheme).expect("accepted");
    assert_eq!((run.stopped.as_ref(), run.curves.times.len()), (None, 151));
    run
}

fn all(parts: &[Part], mut one: impl FnMut(&Part) -> Superelement) -> Vec<Superelement> {
    parts.iter().map(|part| one(part)).collect()
}

#[test]
fn memory_file_and_program_give_the_same_curves() {
    let folder = tempfile::tempdir().expect("folder");
    let parts = Example::Elbow.parts(2);
    let job = |part: &Part| folder.path().join(&part.name).join("job.toml");
    let in_memory = all(&parts, |part| {
        part.write(&folder.path().join(&part.name)).expect("written");
        reduced(&job(part)).expect("verified")
    });
    let expected = curves(&in_memory);

    let from_file = all(&parts, |part| {
        let path = folder.path().join(format!("{}.supel", part.name));
        in_memory[parts.iter().position(|other| other.name == part.name).expect("a part")]
            .write(&path)
            .expect("written");
        Superelement::open(&path).expect("read")
    });
    assert_eq!(curves(&from_file), expected);

    let program = supel();
    let by_program = all(&parts, |part| reduced_by_command(&program, &job(part)).expect("done and verified"));
    assert_eq!(by_program, in_memory);
    assert_eq!(curves(&by_program), expected);
}

#[test]
fn curves_do_not_depend_on_the_order_of_runs() {
    // A workspace keeps its floating frame: a second mechanism must not see the first.
    let folder = tempfile::tempdir().expect("folder");
    let parts = rotating::parts(1);
    let superelement = [reduced(&parts[0].write(folder.path()).expect("written")).expect("verified")];
    let scheme = Scheme { n_steps: 200, ..rotating::SCHEME };
    let run = |modes| rotating::run(&superelement, &motion_based(1, modes), &scheme).expect("accepted");
    let first = run(3);
    run(0);
    assert_eq!(run(3), first);
}
