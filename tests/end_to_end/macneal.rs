//! MacNeal's method: Herting's stiffness with the mass of the free modes, marked as singular, and what takes such a mass and what does not.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::{Ends, spring};
use supel_runtime::component::{FloatingFrame, ModalComponent};
use supel_runtime::{Flag, Matrix, Metadata, Method, Superelement, Tensors};
use supel_testing::pencil::unpacked;

use crate::methods::{INTERFACE, verified};
use crate::place::{Place, steel_brick, supel};

const N_MODES: usize = 5;

fn macneal() -> (Place, Superelement) {
    let place = Place::with_brick();
    let file = verified(&place, &format!("macneal --modes {N_MODES}"));
    (place, file)
}

/// The motions with mass, orthonormal in M̂, with their λ, ascending: by θ = 1/(λ + α), which is zero for all others.
fn massive(file: &Superelement) -> (Vec<f64>, Mat<f64>) {
    let (k, m) = (unpacked(&file.tensors().stiffness), unpacked(&file.tensors().mass));
    let (r, rank) = (k.nrows(), file.n_rigid() + file.tensors().frequencies.len());
    let alpha = file.tensors().frequencies[0].powi(2);
    let sum = Mat::from_fn(r, r, |i, j| k[(i, j)] + alpha * m[(i, j)]);
    let factor = sum.llt(Side::Lower).expect("definite with the mass of rigid-body motion");
    let l = factor.L().to_owned();
    let half = l.partial_piv_lu().solve(&m);
    let theta = l.partial_piv_lu().solve(half.transpose());
    let eigen = theta.self_adjoint_eigen(Side::Lower).expect("numbers");
    let largest: Vec<usize> = (0..rank).map(|j| r - 1 - j).collect();
    let values = eigen.S().column_vector();
    let q = Mat::from_fn(r, rank, |i, j| eigen.U()[(i, largest[j])] / values[largest[j]].sqrt());
    let shapes = l.transpose().partial_piv_lu().solve(q);
    (largest.iter().map(|j| 1.0 / values[*j] - alpha).collect(), shapes)
}

#[test]
fn macneal_is_herting_with_the_mass_of_its_modes() {
    let (place, file) = macneal();
    let report = place.report("x.report.json");
    let rank = file.n_rigid() + N_MODES;
    assert_eq!(report["body"]["reduction"]["mass_rank"], rank);
    let said = supel(&["inspect", &place.text("x.supel")]).expect(ExitCode::Done).out;
    assert!(said.contains("MacNeal") && said.contains("semidefinite"), "{said}");
    assert_eq!(file.metadata().method, Method::Macneal);
    assert!(file.metadata().flags.iter().eq([&Flag::SingularMass]));

    let herting = verified(&place, &format!("herting --modes {N_MODES}"));
    assert!(
        herting.metadata().flags.is_empty()
            && place.report("x.report.json")["body"]["reduction"]["mass_rank"].is_null()
    );
    let with_its_mass = Tensors { mass: herting.tensors().mass.clone(), ..file.tensors().clone() };
    assert!(with_its_mass == *herting.tensors(), "nothing but the mass differs");
    assert!(file.tensors().mass != herting.tensors().mass);
    // Motions without mass have no step that an explicit integrator could take.
    assert!(report["body"]["preservation"]["highest"].is_null());

    // A client's floating frame asks for the mass of rigid-body motion alone.
    let patches = "--rigid-interface foot=1,11,31,41 --rigid-interface head=5,15,35";
    place.reduce(&place.model_flags(), &format!("{patches} --method macneal --modes 2")).expect(ExitCode::Done);
    ModalComponent::new(&place.superelement("x.supel"), FloatingFrame::MassWeighted).expect("a free body");
}

/// Names of the checks that fail of an altered file, by itself and against the job.
fn failures(place: &Place, alter: impl Fn(&mut Tensors, &mut Metadata)) -> [Vec<String>; 2] {
    let original = place.superelement("x.supel");
    let (mut tensors, mut metadata) = (original.tensors().clone(), original.metadata().clone());
    alter(&mut tensors, &mut metadata);
    let altered = Superelement::new(tensors, metadata).expect("a superelement still");
    altered.write(&place.path("altered.supel")).expect("written");
    let (altered, job) = (place.text("altered.supel"), place.text("job.json"));
    [vec!["verify", &altered, "--json"], vec!["verify", &altered, "--json", "--job", &job]].map(|args| {
        let document: Value = serde_json::from_str(&supel(&args).out).expect("JSON");
        let checks = document["checks"].as_array().expect("checks");
        let failed = checks.iter().filter(|check| check["verdict"] == "fail");
        let text = |value: &Value| value.as_str().expect("text").to_owned();
        failed.map(|check| format!("{} {}", text(&check["id"]), text(&check["name"]))).collect()
    })
}

const OF_THE_MODES: &str = "M-03 mass is that of the modes and of rigid-body motion";
const OF_THE_MODEL: &str = "M-16 mass is that of the full model";

#[test]
fn another_mass_is_seen_alone_and_against_the_model() {
    let (place, file) = macneal();
    let other = Place::with_brick();
    other
        .reduce(&other.model_flags(), &format!("{INTERFACE} --method herting --modes {N_MODES}"))
        .expect(ExitCode::Done);
    let herting = other.superelement("x.supel");
    let assert_fails =
        |found: &[String], expected: &str| assert!(found.iter().any(|name| name == expected), "{found:?}");
    let [alone, with_job] = failures(&place, |tensors, _| tensors.mass = herting.tensors().mass.clone());
    assert_fails(&alone, OF_THE_MODES);
    assert_fails(&with_job, OF_THE_MODEL);

    // A mass where there was none, that neither the modes nor rigid-body motion see: frequencies and inertia stay.
    let (_, shapes) = massive(&file);
    let r = shapes.nrows();
    let unit = Mat::from_fn(r, 1, |i, _| f64::from(u8::from(i == 0)));
    let normal = shapes.transpose() * &shapes;
    let along = normal.partial_piv_lu().solve(shapes.transpose() * &unit);
    let z = &unit - &shapes * along;
    let size = 1e-4 * file.tensors().mass[(0, 0)] / z.norm_l2().powi(2);
    let [alone, with_job] = failures(&place, |tensors, _| {
        let mass = &file.tensors().mass;
        tensors.mass = Matrix::from_fn(r, r, |i, j| mass[(i, j)] + size * (z[(i, 0)] * z[(j, 0)]));
    });
    assert_eq!(alone, [OF_THE_MODES], "nothing else changes");
    assert_fails(&with_job, OF_THE_MODEL);

    // A mode that lost its mass.
    let momentum = unpacked(&file.tensors().mass) * shapes.as_ref().subcols(r.min(shapes.ncols()) - 1, 1);
    let [alone, with_job] = failures(&place, |tensors, _| {
        let mass = &file.tensors().mass;
        tensors.mass = Matrix::from_fn(r, r, |i, j| mass[(i, j)] - 0.5 * (momentum[(i, 0)] * momentum[(j, 0)]));
    });
    assert_fails(&alone, "M-14 reduced matrices have the stated frequencies");
    assert_fails(&with_job, OF_THE_MODEL);

    let [alone, with_job] = failures(&place, |_, metadata| metadata.flags.clear());
    assert_fails(&alone, "M-26 file is what its job asks for");
    assert_fails(&with_job, "M-26 it says of itself what the job makes");
    let [alone, _] = failures(&place, |_, metadata| {
        (metadata.method, metadata.job["reduction"]["method"]) = (Method::Herting, "herting".into());
        metadata.flags.clear();
    });
    assert_fails(&alone, "M-03 modal masses are one");
}

/// Modal damping is that of the modes, and takes nothing from the motions without mass, of which there are no modes.
#[test]
fn modal_damping_is_that_of_the_modes_alone() {
    let place = Place::with(&steel_brick());
    let job = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }
interface = [{ name = "foot", nodes = [1, 11, 31] }, { name = "head", nodes = [5, 15, 35], coupling = "rigid" }]
load      = [{ name = "pull", nodes = [45], force = [0, 1, 1] }]
damping   = { modal = { ratios = [0.01, 0.02] } }
scene     = { accept = { response_db = 30 } }
reduction = { method = "macneal", modes = { count = 5 } }
write     = { superelement = "x.supel" }
"#;
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml"), "--strict"]).expect(ExitCode::Done);
    supel(&["verify", &place.text("x.supel"), "--strict"]).expect(ExitCode::Done);
    supel(&["verify", &place.text("x.supel"), "--strict", "--job", &place.text("job.toml")]).expect(ExitCode::Done);
    let file = place.superelement("x.supel");
    let (lambda, shapes) = massive(&file);
    let c = unpacked(file.tensors().damping.as_ref().expect("damping"));
    let modal = shapes.transpose() * &c * &shapes;
    let last = lambda[lambda.len() - 1].sqrt();
    for (mode, lambda) in lambda.iter().enumerate().skip(file.n_rigid()) {
        let ratio = if mode == file.n_rigid() { 0.01 } else { 0.02 };
        // Eigenvalues near α are known to ε of the highest of them, and the ratio of the two is below 100 here.
        assert!((modal[(mode, mode)] / (2.0 * ratio * lambda.sqrt()) - 1.0).abs() < 1e-9, "mode {mode}");
        let coupling = (0..shapes.ncols()).filter(|other| *other != mode).map(|other| modal[(other, mode)].abs());
        assert!(coupling.fold(0.0, f64::max) < 1e-9 * last, "mode {mode}");
    }
    // Ĉ = M̂ΦDΦᵀM̂ has the rank of the elastic modes.
    let d: Vec<f64> = (0..c.nrows()).map(|i| c[(i, i)].sqrt().recip()).collect();
    let scaled = Mat::from_fn(c.nrows(), c.nrows(), |i, j| c[(i, j)] * d[i] * d[j]);
    let values = scaled.self_adjoint_eigenvalues(Side::Lower).expect("numbers");
    let n_damped = values.iter().filter(|value| value.abs() > 1e-10).count();
    assert_eq!(n_damped, 5, "{values:?}");
}

#[test]
fn what_needs_a_regular_mass_refuses_this_one_by_name() {
    let (place, _) = macneal();
    let file = place.text("x.supel");
    let refused = supel(&["modes", &file]).expect(ExitCode::InputData).err;
    assert!(refused.contains("E-ASSEMBLY-MASSLESS") && refused.contains("with herting"), "{refused}");
    let refused = supel(&["inspect", &file, "--rubin"]).expect(ExitCode::Usage).err;
    assert!(refused.contains("E-NO-RELIEF") && refused.contains("singular mass"), "{refused}");
    supel(&["export", &file, "--to", "matrix-market", "--output", &place.text("again")]).expect(ExitCode::Done);
    assert!(place.path("again.mass.mtx").exists() && !place.path("again.job.toml").exists());

    // Held, without a mode: nothing would have mass.
    let place = Place::with(&spring(5, Ends::Fixed));
    let refused = place.reduce(&place.matrix_flags(), "--interface end=rows:4 --method macneal --modes 0");
    let refused = refused.expect(ExitCode::InputData).err;
    assert!(refused.contains("E-MODAL-MASS") && refused.contains("guyan"), "{refused}");
    place.reduce(&place.matrix_flags(), "--interface end=rows:4 --method macneal --modes 1").expect(ExitCode::Done);
}
