//! Multipoint constraints: the null space of G by dense algebra, rigid elements, ties between meshes, and what is refused.

mod limits;
mod model;
mod refused;
mod theory;

use faer::{Mat, MatRef};
use supel::cli::ExitCode;
use supel_models::Model;
use supel_runtime::Superelement;
use supel_testing::pencil::unpacked;
use supel_testing::place::{Ended, Place, supel, warnings_of_reduction};

/// A matrix by rows: columns and values.
type Rows = Vec<Vec<(u32, f64)>>;

/// A model in a folder of its own with its constraints.
struct Case {
    place: Place,
    model: Model,
    constraints: Rows,
}

impl Case {
    fn new(model: Model, constraints: Rows) -> Self {
        let place = Place::with(&model);
        place.write("G.mtx", matrix_market(model.n, &constraints, |value| format!("{value:e}")).as_bytes());
        Self { place, model, constraints }
    }

    /// Runs a job with further keys of the model, interfaces, a reduction and further tables.
    fn run(&self, of_model: &str, interfaces: &str, reduction: &str, more: &str) -> Ended {
        let nodes = if self.model.dofs.is_empty() { "" } else { r#", dofs = "dofs.txt", nodes = "nodes.csv""# };
        let recovery = match self.model.dofs.is_empty() {
            true => "",
            false => "recovery = { nodes = { within = { box = { min = [-9, -9, -9], max = [9, 9, 9] } } } }",
        };
        let job = format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx"{nodes}, constraints = "G.mtx"{of_model} }}
interface = [{interfaces}]
reduction = {{ {reduction} }}
{more}
[write]
superelement = "x.supel"
{recovery}
"#
        );
        self.place.write("job.toml", job.as_bytes());
        supel(&["reduce", &self.place.text("job.toml")])
    }

    /// A superelement that its job and its own content confirm.
    #[track_caller]
    fn reduced(&self, interfaces: &str, reduction: &str, more: &str) -> Superelement {
        self.run("", interfaces, reduction, more).expect(ExitCode::Done);
        let (file, job) = (self.place.text("x.supel"), self.place.text("job.toml"));
        supel(&["verify", &file, "--reproduce"]).expect(ExitCode::Done);
        supel(&["verify", &file, "--job", &job]).expect(ExitCode::Done);
        self.place.superelement("x.supel")
    }

    fn g(&self) -> Mat<f64> {
        let mut g = Mat::zeros(self.constraints.len(), self.model.n);
        for (i, row) in self.constraints.iter().enumerate() {
            row.iter().for_each(|(j, value)| g[(i, *j as usize)] += value);
        }
        g
    }

    fn stiffness(&self) -> Mat<f64> {
        dense(self.model.n, &self.model.stiffness)
    }

    fn mass(&self) -> Mat<f64> {
        dense(self.model.n, &self.model.mass)
    }

    /// Codes of the warnings of the report, and its remarks as one text.
    fn told(&self) -> (Vec<String>, String) {
        let report = self.place.report("x.report.json");
        (warnings_of_reduction(&report), report.to_string())
    }
}

fn matrix_market(n: usize, rows: &Rows, number: impl Fn(f64) -> String) -> String {
    let n_entries: usize = rows.iter().map(Vec::len).sum();
    let mut text = format!("%%MatrixMarket matrix coordinate real general\n{} {n} {n_entries}\n", rows.len());
    for (i, row) in rows.iter().enumerate() {
        row.iter().for_each(|(j, value)| text += &format!("{} {} {}\n", i + 1, j + 1, number(*value)));
    }
    text
}

fn dense(n: usize, entries: &[(u32, u32, f64)]) -> Mat<f64> {
    let mut matrix = Mat::zeros(n, n);
    entries.iter().for_each(|(i, j, value)| matrix[(*i as usize, *j as usize)] += value);
    matrix
}

/// W, all rows of the model on the coordinates of a superelement.
fn recovery(superelement: &Superelement) -> Mat<f64> {
    unpacked(superelement.tensors().recovery.as_ref().expect("all rows").rows())
}

fn absolute(a: MatRef<'_, f64>) -> Mat<f64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)].abs())
}

/// An orthonormal basis of the motions with G u = 0, n × (n − rank).
fn null_space(g: &Mat<f64>) -> Mat<f64> {
    let n = g.ncols();
    let padded = Mat::from_fn(n.max(g.nrows()), n, |i, j| if i < g.nrows() { g[(i, j)] } else { 0.0 });
    let svd = padded.thin_svd().expect("finite");
    let singular = svd.S().column_vector();
    let rank = (0..n).filter(|k| singular[*k] > 1e-9 * singular[0]).count();
    svd.V().subcols(rank, n - rank).to_owned()
}

/// Eigenvalues of the pencil of a model on a space of motions, ascending, by the root of M.
fn eigenvalues([k, m]: [&Mat<f64>; 2], z: &Mat<f64>) -> Vec<f64> {
    let (k, m) = (z.transpose() * k * z, z.transpose() * m * z);
    let l = m.llt(faer::Side::Lower).expect("a definite mass").L().to_owned();
    let half = |mut a: Mat<f64>| {
        faer::linalg::triangular_solve::solve_lower_triangular_in_place(l.as_ref(), a.as_mut(), faer::Par::Seq);
        a
    };
    let standard = half(half(k).transpose().to_owned());
    let n = standard.nrows();
    let sum = Mat::from_fn(n, n, |i, j| 0.5 * (standard[(i, j)] + standard[(j, i)]));
    sum.self_adjoint_eigenvalues(faer::Side::Lower).expect("eigenvalues")
}

/// Asserts that two matrices agree, relative to the sizes of terms.
#[track_caller]
fn assert_entries(found: &Mat<f64>, expected: &Mat<f64>, terms: impl Fn(usize, usize) -> f64) {
    assert_eq!([found.nrows(), found.ncols()], [expected.nrows(), expected.ncols()]);
    for (i, j) in (0..found.ncols()).flat_map(|j| (0..found.nrows()).map(move |i| (i, j))) {
        let difference = (found[(i, j)] - expected[(i, j)]).abs();
        assert!(difference <= terms(i, j), "{i}, {j}: {} for {}", found[(i, j)], expected[(i, j)]);
    }
}

/// The recovered motions satisfy the constraints, and the reduced matrices are those of these motions.
#[track_caller]
fn assert_projected(case: &Case, superelement: &Superelement) {
    let (w, g) = (recovery(superelement), case.g());
    assert_eq!(w.nrows(), case.model.n);
    let left = &g * &w;
    let sizes = absolute(g.as_ref()) * absolute(w.as_ref());
    // Sums of a hundred terms at most, of factors that were rounded a few times.
    assert_entries(&left, &Mat::zeros(left.nrows(), left.ncols()), |i, j| 100.0 * f64::EPSILON * sizes[(i, j)]);
    for (full, reduced) in
        [(case.stiffness(), &superelement.tensors().stiffness), (case.mass(), &superelement.tensors().mass)]
    {
        let projected = w.transpose() * &full * &w;
        let terms = absolute(w.transpose()) * absolute(full.as_ref()) * absolute(w.as_ref());
        // Congruences in two orders; what W loses by rounding of factors shows in the terms.
        assert_entries(&unpacked(reduced), &projected, |i, j| 1e-12 * terms[(i, j)]);
    }
}
