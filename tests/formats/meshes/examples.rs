//! The bundled examples reduce as they are, and their programs make them again where they are installed.

use std::path::Path;
use std::process::Command;

use supel::job::Job;
use supel::memory_forecast::Resources;
use supel::verification::check::Verdict;

use super::{Folder, root};

/// Copies an example into a folder of its own.
fn copied(name: &str) -> Folder {
    let folder = Folder::new();
    for entry in std::fs::read_dir(root().join("examples").join(name)).expect("the example") {
        let path = entry.expect("an entry").path();
        if path.is_file() {
            let file = path.file_name().and_then(|name| name.to_str()).expect("a name");
            std::fs::copy(&path, folder.0.path().join(file)).expect("copied");
        }
    }
    folder
}

/// The frequencies of the superelement of an example, all of whose checks pass.
fn reduced(folder: &Path) -> Vec<f64> {
    let job = Job::read(&folder.join("job.toml")).expect("a job");
    let outcome = supel::reduce(&job, Resources::default(), &mut ()).expect("a reduction");
    for check in &outcome.report.body.checks {
        let is_sound = matches!(check.verdict(), Verdict::Pass | Verdict::Info);
        assert!(is_sound, "{} {}: {:e}", check.id, check.name, check.value);
    }
    outcome.superelement.tensors().frequencies.to_vec()
}

fn assert_alike(one: &[f64], other: &[f64], tolerance: f64) {
    assert!(!one.is_empty() && one.len() == other.len(), "{one:?} {other:?}");
    for (one, other) in one.iter().zip(other) {
        assert!((one - other).abs() <= tolerance * other, "{one} {other}");
    }
}

/// Runs a script of an example, or says why not.
fn made_again(folder: &Path, needed: (&str, &[&str]), python: Option<&str>) -> bool {
    let (program, args) = needed;
    let has_program = Command::new(program).args(args).output().is_ok_and(|output| output.status.success());
    if !has_program {
        eprintln!("skipped: {program} {} does not run here", args.join(" "));
        return false;
    }
    let mut script = Command::new("sh");
    script.arg("make.sh").current_dir(folder);
    python.map(|python| script.env("PYTHON", python));
    let output = script.output().expect("a shell");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    true
}

#[test]
fn the_crank_of_calculix() {
    let folder = copied("calculix");
    let bundled = reduced(folder.0.path());
    if made_again(folder.0.path(), ("sh", &["-c", "command -v ccx python3"]), None) {
        // Versions of CalculiX differ in the last of the 14 digits that they write.
        assert_alike(&reduced(folder.0.path()), &bundled, 1e-9);
    }
}

#[test]
fn the_lug_of_gmsh_and_scikit_fem() {
    let folder = copied("gmsh");
    let bundled = reduced(folder.0.path());
    let python = std::env::var("SUPEL_MESH_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    if made_again(folder.0.path(), (&python, &["-c", "import gmsh, skfem, meshio"]), Some(&python)) {
        // Another version of Gmsh makes another mesh, of the same fineness: frequencies agree to a few percent.
        assert_alike(&reduced(folder.0.path()), &bundled, 5e-2);
    }
}
