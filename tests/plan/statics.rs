//! K-1 and K-2: statics needs neither modes nor mass, and K̂ alone no constraint mode.

use supel::cli::ExitCode;
use supel_runtime::Flag;
use supel_runtime::component::{ComponentError, FloatingFrame, ModalComponent};
use supel_testing::place::supel;

use crate::{CONDENSED, CRAIG_BAMPTON, Case, HERTING, PATCHES, difference, part};

const STATIC: &str = "analysis = \"static\"\ngravity = false";
const STORED: &str = "[run]\nconstraint_modes = \"stored\"";

/// K̂ of statics is that of any analysis, although no mass is read and no mode is computed. The basis of the rigid-body motions that correct
/// the constraint modes is orthonormal in the mass, whose rounding is all that may differ.
#[test]
fn stiffness_of_statics_is_that_of_every_analysis() {
    let statics = Case { rest: STORED, ..Case::new(PATCHES, HERTING, STATIC) }.made();
    let whole = Case { rest: STORED, ..Case::new(PATCHES, HERTING, STATIC) }.made_with(&["--no-skip"]);
    let n_b = statics.n_b();
    assert_eq!((n_b, statics.file.n_coordinates(), whole.file.n_coordinates()), (12, 12, 24));
    let interface: Vec<usize> = (0..n_b).collect();
    let error = difference(&statics.stiffness(), &part(&whole.stiffness(), &interface, &interface));
    assert!(error <= CONDENSED, "{error:e}");
    let [of_statics, of_whole] = [&statics, &whole].map(|made| &made.file.tensors().rigid_body_modes);
    let same = (0..n_b).all(|i| (0..6).all(|j| of_statics[(i, j)].to_bits() == of_whole[(i, j)].to_bits()));
    assert!(same, "Û differs");
    assert!(statics.work("n_factorisations") < whole.work("n_factorisations"));
    assert!(statics.work("n_solves") < whole.work("n_solves"));
}

/// The file of M may be anything, even nothing: it is not opened.
#[test]
fn a_mass_that_nothing_depends_on_is_not_read() {
    let case = Case::new(PATCHES, CRAIG_BAMPTON, STATIC);
    let with_mass = case.made();
    let place = &with_mass.place;
    place.write("M.mtx", b"no matrix");
    let job = case.job().replace("mass = \"M.mtx\"\n", "");
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    let without = place.superelement("x.supel");
    assert_eq!(without.tensors(), with_mass.file.tensors());
    let needs_it = job.replace("gravity = false", "gravity = true");
    place.write("job.toml", needs_it.as_bytes());
    let refused = supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Usage);
    assert!(refused.err.contains("E-JOB-MASS"), "{}", refused.err);
}

/// A job that says no number of modes has none to say where statics is all that is asked; with nothing left out its method keeps some.
#[test]
fn statics_needs_no_number_of_modes() {
    for method in ["herting", "craig-bampton"] {
        let reduction: &'static str = Box::leak(format!("method = \"{method}\"").into_boxed_str());
        let stated = Case::new(PATCHES, reduction, "analysis = \"static\"").made();
        assert_eq!(stated.file.n_coordinates(), stated.n_b(), "{method}");
        let job = stated.place.text("job.toml");
        let refused = supel(&["reduce", &job, "--no-skip"]).expect(ExitCode::Usage);
        assert!(refused.err.contains("E-JOB-MODES"), "{}", refused.err);
    }
}

/// The file says what it lacks, and a component in large motion, modes and a mass of other programs are refused by name.
#[test]
fn a_superelement_of_statics_says_so() {
    let made = Case::new(PATCHES, HERTING, STATIC).made();
    let metadata = made.file.metadata();
    assert!(metadata.flags.iter().eq([&Flag::StiffnessOnly]));
    assert!(made.assumptions().iter().any(|words| words.contains("statics is all that is asked")));
    assert_eq!((made.file.tensors().mass.rows(), made.file.tensors().gravity.is_some()), (0, false));
    assert!(!metadata.inputs.contains_key("mass") && metadata.model.mass_properties.is_none());
    assert!(made.report["body"]["model"].get("mass").is_none());
    let refused = ModalComponent::new(&made.file, FloatingFrame::Rigid);
    assert!(matches!(refused, Err(ComponentError::NoMass)));
    let modes = supel(&["modes", &made.place.text("x.supel")]);
    assert!(modes.code == ExitCode::InputData && modes.err.contains("E-ASSEMBLY-STATIC"), "{}", modes.err);
    let exported = supel(&["export", &made.place.text("x.supel"), "--to", "matrix-market"]).expect(ExitCode::Done);
    assert!(exported.out.contains("stiffness") && !exported.out.contains("x.mass.mtx"), "{}", exported.out);
    // Forces on the interface follow displacements alone.
    let has = |ending: &str| made.place.path(&format!("x.ltm-{ending}.mtx")).exists();
    assert_eq!((has("displacement"), has("acceleration")), (true, false), "{}", exported.out);
}

/// With gravity the mass is read and kept, without a mode.
#[test]
fn statics_under_gravity_has_a_mass_and_no_modes() {
    let made = Case::new(PATCHES, HERTING, "analysis = \"static\"").made();
    assert_eq!((made.file.n_coordinates(), made.file.tensors().frequencies.len()), (12, 0));
    assert!(made.file.metadata().flags.is_empty() && made.file.tensors().gravity.is_some());
    assert_eq!(made.work("n_factorisations"), 1);
    let guyan = Case::new(PATCHES, "method = \"guyan\"", "").made();
    assert_eq!(made.file.tensors(), guyan.file.tensors(), "Guyan's method, without its count");
}

/// What elimination leaves of the interface is ΨᵀKΨ to the rounding of its terms, and the guard is measured.
#[test]
fn stiffness_without_constraint_modes_is_that_with_them() {
    let condensed = Case::new(PATCHES, HERTING, STATIC).made();
    let stored = Case { rest: STORED, ..Case::new(PATCHES, HERTING, STATIC) }.made();
    let error = difference(&condensed.stiffness(), &stored.stiffness());
    assert!(error > 0.0 && error <= CONDENSED, "{error:e}");
    assert!(condensed.checks().contains(&"M-32") && !stored.checks().contains(&"M-32"));
    assert!(condensed.checks().contains(&"M-10") && condensed.checks().contains(&"M-17"));
}

/// A load inside has its residual vector and a limit of its own in statics, too.
#[test]
fn loads_and_accepted_errors_of_statics() {
    let load = "[[load]]\nname = \"push\"\nnodes = [40]\nforce = [0, 0, 1]\n";
    let scene = "analysis = \"static\"\ngravity = false\naccept = { static = 1e-6 }";
    let made = Case { rest: load, ..Case::new(PATCHES, HERTING, scene) }.made();
    assert_eq!((made.file.n_coordinates(), made.file.tensors().load_vectors.is_some()), (13, true));
    assert!(made.checks().contains(&"M-27") && made.checks().contains(&"M-31"));
    let alone = Case::new(PATCHES, HERTING, STATIC).made();
    let interface: Vec<usize> = (0..12).collect();
    assert_eq!(part(&made.stiffness(), &interface, &interface), alone.stiffness(), "more is asked, the rest stays");
}

/// Displacements inside are recovered from the stored modes: those of the whole reduction, to the rounding of the
/// motions that correct them.
#[test]
fn recovered_rows_of_statics() {
    let write = ", recovery = { nodes = [18, 45] }";
    let made = Case { write, ..Case::new(PATCHES, HERTING, STATIC) }.made();
    let whole = Case { write, ..Case::new(PATCHES, HERTING, STATIC) }.made_with(&["--no-skip"]);
    let [rows, all] = [&made, &whole].map(|made| made.file.tensors().recovery.as_ref().expect("rows").rows().clone());
    assert_eq!((rows.rows(), rows.cols()), (all.rows(), 12));
    let entries = || (0..rows.rows()).flat_map(|i| (0..12).map(move |j| (i, j)));
    let error = entries().map(|at| (rows[at] - all[at]).abs()).fold(0.0, f64::max);
    let size = entries().map(|at| all[at].abs()).fold(0.0, f64::max);
    assert!(error <= CONDENSED * size, "the columns of the interface: {error:e} of {size:e}");
}
