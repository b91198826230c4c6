//! Rubin's and Guyan's methods, and inertia relief with any of them.

use faer::Mat;
use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::transform::join;
use supel_models::{Ends, Material, brick, spring};
use supel_runtime::{Coordinate, Method, Superelement};
use supel_testing::pencil::unpacked;

use crate::place::{Place, supel};

pub(super) const INTERFACE: &str = "--interface foot=1,11,31,41 --rigid-interface head=5,15,35";

/// Reduces the brick, has the file verified by itself and against the model, and returns it.
pub(super) fn verified(place: &Place, method: &str) -> Superelement {
    place.reduce(&place.model_flags(), &format!("{INTERFACE} --method {method}")).expect(ExitCode::Done);
    let file = place.text("x.supel");
    supel(&["verify", &file, "--strict"]).expect(ExitCode::Done);
    place.write("job.json", supel(&["inspect", &file, "--job"]).expect(ExitCode::Done).out.as_bytes());
    supel(&["verify", &file, "--strict", "--job", &place.text("job.json")]).expect(ExitCode::Done);
    place.superelement("x.supel")
}

fn value_of(place: &Place, name: &str) -> f64 {
    let report = place.report("x.report.json");
    let checks = report["body"]["checks"].as_array().expect("checks");
    let check = checks.iter().find(|check| check["name"] == name).unwrap_or_else(|| panic!("{name} is not there"));
    check["value"].as_f64().expect("a number")
}

#[test]
fn rubin_is_herting_with_a_proof_of_its_attachment_modes() {
    let place = Place::with_brick();
    let herting = verified(&place, "herting --modes 5");
    let rubin = verified(&place, "rubin --modes 5");
    assert_eq!(rubin.metadata().method, Method::Rubin);
    assert!(rubin.tensors() == herting.tensors(), "the matrices of both");
    assert!(value_of(&place, "attachment modes are free of rigid-body motion") <= 1e-12);
    assert!(value_of(&place, "attachment modes are in equilibrium with inertia") <= 1e-12);

    assert_rubins_matrices(&place, &rubin);
}

/// A slender bar bends so easily that its attachment modes are small differences of constraint modes and large relief modes. What rounding
/// leaves of rigid-body motion in them a second step takes out: one alone leaves 10⁻⁸.
#[test]
fn attachment_modes_of_a_slender_bar_are_as_free_as_those_of_a_block() {
    let place = Place::with(&brick([2, 2, 2], [2.0, 0.01, 0.01], &Material::STEEL_SI));
    for kind in ["--interface", "--rigid-interface"] {
        let [left, right] =
            [1, 3].map(|first| (0..9).map(|row| (first + 3 * row).to_string()).collect::<Vec<_>>().join(","));
        let rest = format!("{kind} left={left} {kind} right={right} --method rubin --modes 1");
        place.reduce(&place.model_flags(), &rest).expect(ExitCode::Done);
        assert!(value_of(&place, "attachment modes are free of rigid-body motion") <= 1e-10, "{kind}");
        supel(&["verify", &place.text("x.supel"), "--strict"]).expect(ExitCode::Done);
    }
}

/// Without an interior there is nothing to attach: Rubin's file is the whole model, as those of the other methods are.
#[test]
fn rubin_without_an_interior_is_the_model_itself() {
    let place = Place::with(&brick([1, 1, 1], [1.0, 0.3, 0.3], &Material::STEEL_SI));
    let file = |method: &str| {
        let rest = format!("--interface all=1,2,3,4,5,6,7,8 --method {method} --modes 2");
        place.reduce(&place.model_flags(), &rest).expect(ExitCode::Done);
        supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
        place.superelement("x.supel")
    };
    let [rubin, herting] = ["rubin", "herting"].map(file);
    assert_eq!(rubin.n_coordinates(), 24);
    assert!(rubin.tensors() == herting.tensors(), "the matrices of both");
}

/// What `inspect --rubin` prints of a file: (45) and (47) are its matrices in the coordinates of (51).
fn assert_rubins_matrices(place: &Place, rubin: &Superelement) {
    let printed = supel(&["inspect", &place.text("x.supel"), "--rubin"]).expect(ExitCode::Done).out;
    let printed: Value = serde_json::from_str(&printed).expect("json");
    let matrix = |key: &str| {
        let rows: Vec<Vec<f64>> = serde_json::from_value(printed[key].clone()).expect("rows");
        Mat::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
    };
    let (to, n) = (matrix("to_file"), rubin.n_coordinates());
    assert_eq!((to.nrows(), to.ncols()), (n, n));
    for (key, of_file) in [("stiffness", &rubin.tensors().stiffness), ("mass", &rubin.tensors().mass)] {
        let expected = to.transpose() * unpacked(of_file) * &to;
        let found = matrix(key);
        for i in 0..n {
            for j in 0..n {
                // Rows of K̂ cancel for rigid-body motion: what is left is relative to the largest entry of both coordinates.
                let size = (0..n).map(|k| expected[(i, k)].abs().max(expected[(j, k)].abs())).fold(0.0, f64::max);
                let error = (found[(i, j)] - expected[(i, j)]).abs();
                assert!(error <= 1e-8 * size, "{key} {i}, {j}: {error:e} of {size:e}");
            }
        }
    }
}

#[test]
fn guyan_is_craig_bampton_without_modes() {
    let place = Place::with_brick();
    let guyan = verified(&place, "guyan");
    assert_eq!(guyan.metadata().method, Method::Guyan);
    assert_eq!(guyan.n_modal(), 0);
    let craig_bampton = verified(&place, "craig-bampton --modes 0");
    assert!(guyan.tensors() == craig_bampton.tensors());
}

/// With inertia relief no deflection under unit accelerations is left out, whatever the method; without it most is.
#[test]
fn inertia_relief_makes_unit_accelerations_exact() {
    const DEFLECTION: &str = "deflection under unit accelerations";
    let place = Place::with_brick();
    for method in ["guyan", "craig-bampton --modes 2"] {
        verified(&place, method);
        assert!(value_of(&place, DEFLECTION) > 1e-3, "{method}");
        let relieved = verified(&place, &format!("{method} --inertia-relief"));
        assert!(value_of(&place, DEFLECTION) < 1e-9, "{method}");
        let is_relief = |c: &&Coordinate| matches!(c, Coordinate::InertiaRelief { .. });
        assert_eq!(relieved.metadata().coordinates.iter().filter(is_relief).count(), 6, "{method}");
        assert!(relieved.tensors().mixing.is_some(), "{method}");
    }
}

#[test]
fn modes_and_method_have_to_fit() {
    let place = Place::with(&spring(5, Ends::Free));
    let refused = |flags: &str| {
        place.reduce(&place.matrix_flags(), &format!("--interface ends=rows:0,4 {flags}")).expect(ExitCode::Usage).err
    };
    let given = refused("--method guyan --modes 3");
    assert!(given.contains("E-JOB-MODES") && given.contains("guyan keeps no modes"), "{given}");
    let missing = refused("--method rubin");
    assert!(missing.contains("--up-to-hz or --modes"), "{missing}");
    let job = |reduction: &str| {
        format!(
            "{{\"model\": {{\"stiffness\": \"K.mtx\", \"mass\": \"M.mtx\"}}, \"reduction\": {{{reduction}}}, \
             \"write\": {{\"superelement\": \"x.supel\"}}}}"
        )
    };
    place.write("job.json", job("\"method\": \"rubin\"").as_bytes());
    let missing = supel(&["reduce", &place.text("job.json")]).expect(ExitCode::Usage).err;
    assert!(missing.contains("`reduction.modes` is missing – expected how many modes rubin keeps"), "{missing}");
    // Modes of the job were meant for its own method.
    place.write("job.json", job("\"method\": \"rubin\", \"modes\": {\"count\": 1}").as_bytes());
    supel(&["reduce", &place.text("job.json"), "--method", "guyan", "--interface", "ends=rows:0,4"])
        .expect(ExitCode::Done);
}

#[test]
fn rubins_matrices_need_inertia_relief() {
    let place = Place::with(&spring(5, Ends::Free));
    place
        .reduce(&place.matrix_flags(), "--interface ends=rows:0,4 --method craig-bampton --modes 1")
        .expect(ExitCode::Done);
    let refused = supel(&["inspect", &place.text("x.supel"), "--rubin"]).expect(ExitCode::Usage).err;
    assert!(refused.contains("E-NO-RELIEF") && refused.contains("rubin or herting"), "{refused}");

    // All mass at the interface: nothing inside answers an acceleration.
    let mut bare = spring(5, Ends::Free);
    bare.mass.retain(|entry| [0, 4].contains(&entry.0) && [0, 4].contains(&entry.1));
    let place = Place::with(&bare);
    let refused = place
        .reduce(&place.matrix_flags(), "--interface ends=rows:0,4 --method rubin --modes 0")
        .expect(ExitCode::ModelPhysics)
        .err;
    assert!(refused.contains("E-ATTACHMENT"), "{refused}");
}

/// A body that one patch holds has no stiffness left there but rounding, and without modes nothing elastic is known of it.
#[test]
fn a_body_that_one_patch_holds_keeps_nothing_but_its_inertia() {
    let bar = brick([2, 1, 1], [2.0, 1.0, 0.9], &Material::UNIT);
    let place = Place::with(&join(&bar, &bar, &[]));
    let n = bar.labels.len();
    for method in ["guyan", "guyan --inertia-relief", "herting --modes 0", "macneal --modes 0"] {
        for b in ["--rigid-interface", "--interface"] {
            let interfaces = format!("--rigid-interface a=1,3,4,6 {b} b={},{},{},{}", n + 1, n + 3, n + 4, n + 6);
            place.reduce(&place.model_flags(), &format!("{interfaces} --method {method}")).expect(ExitCode::Done);
            let file = place.text("x.supel");
            supel(&["verify", &file]).expect(ExitCode::Done);
            place.write("job.json", supel(&["inspect", &file, "--job"]).expect(ExitCode::Done).out.as_bytes());
            supel(&["verify", &file, "--job", &place.text("job.json")]).expect(ExitCode::Done);
        }
    }
    let interfaces = format!("--rigid-interface a=1,3,4,6 --rigid-interface b={},{},{}", n + 1, n + 3, n + 4);
    place.reduce(&place.model_flags(), &format!("{interfaces} --method rubin --modes 3")).expect(ExitCode::Done);
    assert_rubins_matrices(&place, &place.superelement("x.supel"));
}

#[test]
fn a_reduction_without_coordinates_is_refused() {
    let place = Place::with(&spring(5, Ends::Fixed));
    for flags in ["--method guyan", "--method craig-bampton --modes 0", "--method herting --up-to-hz 1e-6"] {
        let refused = place.reduce(&place.matrix_flags(), flags).expect(ExitCode::Usage).err;
        assert!(refused.contains("E-NOTHING-LEFT"), "{flags}: {refused}");
    }
}

/// The table of costs in the README: Rubin's method needs no solve that Herting's does not make.
#[cfg(feature = "hdf5")]
#[test]
fn each_method_costs_what_the_readme_says() {
    let readme = include_str!("../../README.md");
    let (_, table) = readme.split_once("| method | coordinates | factorisations | solves |").expect("the table");
    let rows: Vec<Vec<&str>> = table
        .lines()
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .map(|line| line.trim_matches('|').split('|').map(|cell| cell.trim().trim_matches('`')).collect())
        .collect();
    assert_eq!(rows.len(), 6);
    let place = Place::with_example();
    for row in rows {
        let output = place.text("x.supel");
        let job = place.text("job.toml");
        let args = ["reduce", &job, "--output", &output, "--method"].into_iter().chain(row[0].split(' '));
        supel(&args.collect::<Vec<_>>()).expect(ExitCode::Done);
        let report = place.report("x.report.json");
        let (work, reduction) = (&report["run"]["work"], &report["body"]["reduction"]);
        let found = [&reduction["n_reduced"], &work["n_factorisations"], &work["n_solves"]].map(ToString::to_string);
        assert_eq!(row[1..], found, "{}", row[0]);
    }
}
