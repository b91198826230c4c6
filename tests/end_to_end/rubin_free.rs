//! Rubin's method where the interface leaves rigid-body motions free: K_II is singular, and no constraint modes exist.

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef};
use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::Model;
use supel_runtime::{Coordinate, Method, Superelement};
use supel_testing::pencil::{eigen, matrices, unpacked};

use crate::place::{Place, steel_brick, supel};

const N_MODES: usize = 5;
/// A point, which leaves three rotations free, and two points, which leave one about their line.
const INTERFACES: [(&str, &[usize]); 2] =
    [("--interface pin=1", &[0, 1, 2]), ("--interface pin=1 --interface tip=5", &[0, 1, 2, 12, 13, 14])];
/// A load on node 23, inside.
const LOAD: (usize, [f64; 3]) = (66, [1.5, 2.5, 3.5]);

/// Reduces the brick, has the file verified by itself and against the model, and returns it.
fn verified(place: &Place, flags: &str) -> Superelement {
    place.reduce(&place.model_flags(), flags).expect(ExitCode::Done);
    assert_verified(place, &[]);
    place.superelement("x.supel")
}

/// Verifies x.supel by itself, and with its job against the model; nothing is to be remarked.
#[track_caller]
fn assert_verified(place: &Place, more: &[&str]) {
    let file = place.text("x.supel");
    supel(&["verify", &file, "--strict"]).expect(ExitCode::Done);
    place.write("kept.json", supel(&["inspect", &file, "--job"]).expect(ExitCode::Done).out.as_bytes());
    let job = place.text("kept.json");
    let args = ["verify", &file, "--strict", "--job", &job];
    supel(&args.iter().chain(more).copied().collect::<Vec<_>>()).expect(ExitCode::Done);
}

/// The full model by dense algebra that shares nothing with the program.
struct Full {
    k: Mat<f64>,
    m: Mat<f64>,
    u: Mat<f64>,
    lambda: Vec<f64>,
    shapes: Mat<f64>,
}

impl Full {
    fn of(model: &Model) -> Self {
        let [k, m] = matrices(model);
        let motions = model.rigid_body_modes();
        let u = Mat::from_fn(model.n, 6, |i, j| motions[j][i]);
        let (lambda, shapes) = eigen(k.as_ref(), m.as_ref(), 1e6);
        Self { k, m, u, lambda, shapes }
    }

    /// ε κ of the elastic motions, n times: what a dense solve of the bordered system, or with K − λM, may lose.
    fn rounding(&self) -> f64 {
        self.k.nrows() as f64 * f64::EPSILON * self.lambda[self.lambda.len() - 1] / self.lambda[6]
    }

    fn answers(&self, loads: MatRef<'_, f64>) -> Mat<f64> {
        balanced_answers([&self.k, &self.m, &self.u], self.lambda[6], loads)
    }

    /// The columns that Rubin's method has: answers to unit loads at the interface, rigid-body motions, elastic modes, answers to loads.
    fn rubin(&self, interface: &[usize], loads: MatRef<'_, f64>) -> Mat<f64> {
        let n = self.k.nrows();
        let unit = Mat::from_fn(n, interface.len(), |i, j| f64::from(u8::from(i == interface[j])));
        let (a, extra) = (self.answers(unit.as_ref()), self.answers(loads));
        let modes = self.shapes.subcols(6, N_MODES);
        let columns = faer::concat![[a, self.u.as_ref(), modes, extra]];
        // Of unit length, as the condition of what they make should be.
        Mat::from_fn(n, columns.ncols(), |i, j| columns[(i, j)] / columns.col(j).norm_l2())
    }
}

/// Answers to loads with the inertia that they set free and without rigid-body motion: [K MU; UᵀM 0] [x; a] = [f; 0], every row and column
/// in units of its own.
fn balanced_answers([k, m, u]: [&Mat<f64>; 3], first: f64, loads: MatRef<'_, f64>) -> Mat<f64> {
    let (n, n_r) = (k.nrows(), u.ncols());
    let momenta = m * u;
    let mut scale: Vec<f64> = (0..n).map(|i| (k[(i, i)] + first * m[(i, i)]).sqrt().recip()).collect();
    let size = |j: usize| (0..n).map(|i| (momenta[(i, j)] * scale[i]).powi(2)).sum::<f64>().sqrt().recip();
    let of_motions: Vec<f64> = (0..n_r).map(size).collect();
    scale.extend(of_motions);
    let entry = |i: usize, j: usize| match (i < n, j < n) {
        (true, true) => k[(i, j)],
        (true, false) => momenta[(i, j - n)],
        (false, true) => momenta[(j, i - n)],
        (false, false) => 0.0,
    };
    let bordered = Mat::from_fn(n + n_r, n + n_r, |i, j| entry(i, j) * scale[i] * scale[j]);
    let whole = Mat::from_fn(n + n_r, loads.ncols(), |i, j| if i < n { loads[(i, j)] * scale[i] } else { 0.0 });
    let solved = bordered.partial_piv_lu().solve(whole);
    Mat::from_fn(n, loads.ncols(), |i, j| solved[(i, j)] * scale[i])
}

/// Displacements of `rows` under loads on the same coordinates at λ: P(K − λM)⁻¹Pᵀ.
fn receptance(k: MatRef<'_, f64>, m: MatRef<'_, f64>, lambda: f64, rows: MatRef<'_, f64>) -> Mat<f64> {
    let n = k.nrows();
    let scale: Vec<f64> = (0..n).map(|i| (k[(i, i)] + lambda * m[(i, i)]).sqrt().recip()).collect();
    let dynamic = Mat::from_fn(n, n, |i, j| (k[(i, j)] - lambda * m[(i, j)]) * scale[i] * scale[j]);
    let of = Mat::from_fn(rows.nrows(), n, |i, j| rows[(i, j)] * scale[j]);
    let answers = dynamic.partial_piv_lu().solve(of.transpose().to_owned());
    &of * answers
}

fn difference(found: &Mat<f64>, expected: &Mat<f64>) -> f64 {
    let n = expected.nrows();
    let size = |i: usize| expected[(i, i)].abs();
    let of = |(i, j): (usize, usize)| (found[(i, j)] - expected[(i, j)]).abs() / (size(i) * size(j)).sqrt();
    (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(of).fold(0.0, f64::max)
}

/// The space of the file is that of attachment modes, rigid-body motions and elastic modes: its interface answers as theirs does, at
/// every frequency; and at rest as the full model does.
#[test]
fn a_free_interface_answers_as_attachment_modes_do() {
    let model = steel_brick();
    let (place, full) = (Place::with(&model), Full::of(&model));
    for (flags, interface) in INTERFACES {
        let file = verified(&place, &format!("{flags} --method rubin --modes {N_MODES}"));
        let n_b = interface.len();
        assert_eq!((file.metadata().method, file.n_interface()), (Method::Rubin, n_b));
        assert_eq!(file.n_coordinates(), n_b + 6 + N_MODES, "{flags}");
        for (omega, lambda) in file.tensors().frequencies.iter().zip(&full.lambda[6..]) {
            assert!((omega * omega / lambda - 1.0).abs() <= full.rounding(), "{flags}: {omega}");
        }
        let [k, m] = [&file.tensors().stiffness, &file.tensors().mass].map(unpacked);
        // K̂_BB = A_B⁻¹.
        let unit = Mat::from_fn(model.n, n_b, |i, j| f64::from(u8::from(i == interface[j])));
        let a = full.answers(unit.as_ref());
        let a_b = Mat::from_fn(n_b, n_b, |i, j| a[(interface[i], j)]);
        let inverse = a_b.partial_piv_lu().solve(Mat::<f64>::identity(n_b, n_b));
        let values = a_b.singular_values().expect("finite");
        let error = difference(&k.as_ref().submatrix(0, 0, n_b, n_b).to_owned(), &inverse);
        let bound = full.rounding() * values[0] / values[n_b - 1];
        assert!(error <= bound && bound < 1e-6, "{flags}: {error:e}, bound {bound:e}");

        let columns = full.rubin(interface, Mat::zeros(model.n, 0).as_ref());
        let [own_k, own_m] = [&full.k, &full.m].map(|a| columns.transpose() * a * &columns);
        let of_file = Mat::from_fn(n_b, file.n_coordinates(), |i, j| f64::from(u8::from(i == j)));
        let of_columns = Mat::from_fn(n_b, columns.ncols(), |i, j| columns[(interface[i], j)]);
        for share in [1e-3, 0.4, 1.7, 12.0] {
            let lambda = share * full.lambda[6];
            let found = receptance(k.as_ref(), m.as_ref(), lambda, of_file.as_ref());
            let expected = receptance(own_k.as_ref(), own_m.as_ref(), lambda, of_columns.as_ref());
            let error = difference(&found, &expected);
            // Close to no resonance: a hundredfold of what a solve loses.
            assert!(error <= 100.0 * bound, "{flags}, {share}: {error:e}, bound {bound:e}");
        }
        let lambda = 1e-3 * full.lambda[6];
        let of_full = Mat::from_fn(n_b, model.n, |i, j| f64::from(u8::from(j == interface[i])));
        let found = receptance(k.as_ref(), m.as_ref(), lambda, of_file.as_ref());
        let expected = receptance(full.k.as_ref(), full.m.as_ref(), lambda, of_full.as_ref());
        // Statics is exact; what modes left out lack is λ/λ_j of their own share, twice, and a share is at most the whole.
        let lacking = (lambda / full.lambda[6 + N_MODES]).powi(2) + 100.0 * bound;
        let error = difference(&found, &expected);
        assert!(error <= lacking, "{flags}: {error:e}, {lacking:e}");
    }
}

/// Loads inside are answered exactly, the whole body has its inertia, and rows of recovery follow.
#[test]
fn loads_and_motions_of_a_free_interface() {
    let model = steel_brick();
    let (place, full) = (Place::with(&model), Full::of(&model));
    let job = "interface = [{ name = \"pin\", nodes = [1] }]\n\
        load = [{ name = \"thrust\", nodes = [23], force = [1.5, 2.5, 3.5] }]\n\
        reduction = { method = \"rubin\", modes = { count = 5 } }\n\
        write = { superelement = \"x.supel\", recovery = { nodes = [23, 40] } }\n\
        [model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n";
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    assert_verified(&place, &["--reproduce"]);
    let file = place.superelement("x.supel");
    let coordinates = &file.metadata().coordinates;
    let count = |is_kind: fn(&Coordinate) -> bool| coordinates.iter().filter(|c| is_kind(c)).count();
    assert_eq!(count(|c| matches!(c, Coordinate::RigidBodyMode { .. })), 6);
    assert_eq!(count(|c| matches!(c, Coordinate::ResidualVector { .. })), 1);

    let [k, m, u] = [&file.tensors().stiffness, &file.tensors().mass, &file.tensors().rigid_body_modes].map(unpacked);
    let rows = file.tensors().recovery.as_ref().expect("rows");
    let recovered = unpacked(rows.rows());
    let row_of = |dof: &supel_runtime::RecoveredDof| 3 * (dof.node as usize - 1) + dof.direction as usize;
    let rows: Vec<usize> = rows.dofs().iter().map(row_of).collect();
    assert_eq!(rows, [66, 67, 68, 117, 118, 119]);
    // Rigid-body motion moves the recovered rows, and costs nothing.
    let moved = &recovered * &u;
    for (i, row) in rows.iter().enumerate() {
        for j in 0..6 {
            assert!((moved[(i, j)] - full.u[(*row, j)]).abs() <= full.rounding(), "{row}, {j}");
        }
    }
    let own = |i: usize| (k[(i, i)] + full.lambda[6] * m[(i, i)]).sqrt();
    let force = &k * &u;
    assert!((0..k.nrows()).all(|i| (0..6).all(|j| force[(i, j)].abs() <= full.rounding() * own(i) * own(i))));
    let mass = u.transpose() * &m * &u;
    let expected = full.u.transpose() * &full.m * &full.u;
    assert!(difference(&mass, &expected) <= full.rounding());

    // The elastic answer to the load: of the file with inertia in balance, of the model by the bordered system.
    let load =
        Mat::from_fn(model.n, 1, |i, _| if (LOAD.0..LOAD.0 + 3).contains(&i) { LOAD.1[i - LOAD.0] } else { 0.0 });
    let f_hat = unpacked(file.tensors().load_vectors.as_ref().expect("loads"));
    let found = &recovered * balanced_answers([&k, &m, &u], full.lambda[6], f_hat.as_ref());
    let expected = full.answers(load.as_ref());
    let size = expected.norm_max();
    for (i, row) in rows.iter().enumerate() {
        let error = (found[(i, 0)] - expected[(*row, 0)]).abs();
        // Both solve, the file with K̂_BB = A_B⁻¹ of a condition of its own.
        assert!(error <= 100.0 * full.rounding() * size, "row {row}: {error:e} of {size:e}");
    }
}

/// Other methods need an interface that holds the component, and so does statics without a mass.
#[test]
fn a_free_interface_is_for_rubins_method_alone() {
    let place = Place::with_brick();
    for method in ["herting --modes 3", "craig-bampton --modes 3", "macneal --modes 3", "guyan"] {
        let refused = place.reduce(&place.model_flags(), &format!("--interface pin=1 --method {method}"));
        let told = refused.expect(ExitCode::ModelPhysics).err;
        assert!(told.contains("E-INTERFACE-RANK"), "{method}: {told}");
    }
    let refused = |method: &str| {
        let job = format!(
            "interface = [{{ name = \"pin\", nodes = [1] }}]\n\
             reduction = {{ {method} }}\n\
             scene = {{ analysis = \"static\", gravity = false }}\n\
             write = {{ superelement = \"x.supel\" }}\n\
             [model]\nstiffness = \"K.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n"
        );
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::ModelPhysics).err
    };
    let told = refused("method = \"rubin\", modes = { count = 5 }");
    assert!(told.contains("E-INTERFACE-RANK"), "{told}");
    let planned = supel(&["plan", &place.text("job.toml")]).expect(ExitCode::ModelPhysics).err;
    assert_eq!(planned, told, "found before anything is factored");
    assert_eq!(told, refused("method = \"guyan\""));
}

/// The plan says that constraint modes do not exist there, and the matrices of the file are Rubin's already.
#[test]
fn the_plan_and_the_form_of_a_free_interface() {
    let place = Place::with_brick();
    let file = verified(&place, &format!("--interface pin=1 --method rubin --modes {N_MODES}"));
    let printed = supel(&["plan", &place.text("kept.json"), "--json"]).expect(ExitCode::Done).out;
    let plan: Value = serde_json::from_str(&printed).expect("json");
    let rules = plan["rules"].as_array().expect("rules");
    let rule = |name: &str| rules.iter().find(|rule| rule["id"] == name).unwrap_or_else(|| panic!("{name}: {plan:#}"));
    assert!(rule("K-5").to_string().contains("leaves rigid-body motions free"), "{:#}", rule("K-5"));

    let printed = supel(&["inspect", &place.text("x.supel"), "--rubin"]).expect(ExitCode::Done).out;
    let rubin: Value = serde_json::from_str(&printed).expect("json");
    let matrix = |key: &str| -> Vec<Vec<f64>> { serde_json::from_value(rubin[key].clone()).expect("rows") };
    let (stiffness, k) = (matrix("stiffness"), unpacked(&file.tensors().stiffness));
    // (45): the first rows are those of u_B.
    for i in 0..3 {
        for j in 0..3 {
            assert!((stiffness[i][j] - k[(i, j)]).abs() <= 1e-12 * k.norm_max(), "{i}, {j}");
        }
    }
}

/// Two dofs that a stiff spring makes one have nearly the same answers to unit loads, whose inverse has no digits.
#[test]
fn answers_that_depend_on_each_other_are_refused() {
    let model = steel_brick();
    let stiffest = model.stiffness.iter().fold(0.0f64, |most, (_, _, value)| most.max(value.abs()));
    // Few digits are left of the inverse, and none, for which there is no inverse.
    for times in [1e9, 1e11] {
        let mut model = model.clone();
        // Along the line from node 1 to node 2.
        for (i, j, value) in &mut model.stiffness {
            match (*i, *j) {
                (0, 0) | (3, 3) => *value += times * stiffest,
                (0, 3) | (3, 0) => *value -= times * stiffest,
                _ => {}
            }
        }
        let place = Place::with(&model);
        let refused = place.reduce(&place.model_flags(), "--interface a=1 --interface b=2 --method rubin --modes 3");
        let told = refused.expect(ExitCode::NumericalLimit).err;
        assert!(told.contains("E-ATTACHMENT-ILL"), "{times:e}: {told}");
    }
}
