//! An example of the paper has the same curves, to the last bit, from a superelement in memory, from its file, and from the
//! program.

use std::path::Path;

use supel_runtime::Superelement;
use validation::examples::{Example, Run, elbow, motion_based};
use validation::integrator::Scheme;
use validation::part::{Part, reduced, reduced_by_command};

/// The first twentieth of the strategy of two legs: a shared node, a load, modes.
fn curves(parts: &[Superelement]) -> Run {
    let scheme = Scheme { n_steps: 150, ..elbow::SCHEME };
    let run = elbow::run(parts, &motion_based(2, 6), &scheme).expect("accepted");
    assert_eq!((run.stopped.as_ref(), run.curves.times.len()), (None, 151));
    run
}

#[test]
fn memory_file_and_program_give_the_same_curves() {
    let folder = tempfile::tempdir().expect("folder");
    let parts = Example::Elbow.parts(2);
    let each = |one: &dyn Fn(&Part, &Path) -> Superelement| -> Vec<Superelement> {
        parts.iter().map(|part| one(part, &folder.path().join(&part.name))).collect()
    };
    let in_memory = each(&|part, folder| reduced(&part.write(folder).expect("written")).expect("verified"));
    let expected = curves(&in_memory);
    assert!(expected.curves.column(0).iter().any(|uz| uz.abs() > 0.01), "nothing moves");

    in_memory.iter().zip(&parts).for_each(|(superelement, part)| {
        superelement.write(&folder.path().join(&part.name).join("copy.supel")).expect("written");
    });
    let from_file = each(&|_, folder| Superelement::open(&folder.join("copy.supel")).expect("read"));
    assert_eq!(curves(&from_file), expected);

    let program = assert_cmd::cargo::cargo_bin!("supel");
    let by_program = each(&|_, folder| reduced_by_command(program, &folder.join("job.toml")).expect("verified"));
    assert_eq!(by_program, in_memory);
    assert_eq!(curves(&by_program), expected);
}
