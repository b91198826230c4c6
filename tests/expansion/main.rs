//! Mode acceleration with the modes of a file.

mod files;
mod refused;
mod theory;
mod told;

use faer::{Mat, MatRef, Side};
use supel::cli::ExitCode;
use supel_models::{Model, dense};
use supel_runtime::{Matrix, Superelement};
use supel_testing::place::{Ended, Place, supel};

/// Columns as a Matrix Market array, every double to the bit.
fn array(columns: &[Vec<f64>]) -> String {
    let mut text = format!("%%MatrixMarket matrix array real general\n{} {}\n", columns[0].len(), columns.len());
    columns.iter().flatten().for_each(|value| text += &format!("{value:.17e}\n"));
    text
}

/// What of a job is not the model.
#[derive(Clone, Copy)]
struct Case {
    interface: &'static str,
    fixed: &'static str,
    reduction: &'static str,
}

/// The interface of the tip of the brick, by its nodes.
const TIP: &str = r#"{ name = "tip", nodes = [5, 15, 45] }"#;
/// All nodes of the tip as one rigid body.
const PATCH: &str =
    r#"{ name = "tip", coupling = "rigid", nodes = { within = { box = { min = [0.9, 0, 0], max = [1, 1, 1] } } } }"#;
/// The mean motion of these nodes, which stay free to deform.
const AVERAGE: &str =
    r#"{ name = "tip", coupling = "average", nodes = { within = { box = { min = [0.9, 0, 0], max = [1, 1, 1] } } } }"#;
const WALL: &str = "{ nodes = [1, 6, 11, 16, 21, 26, 31, 36, 41] }";
const OF_FILE: &str = r#"method = "mode-acceleration", modes = { file = "modes.mtx" }"#;

impl Case {
    /// Runs the job `job.toml` in a folder.
    fn run(self, place: &Place) -> Ended {
        let Self { interface, fixed, reduction } = self;
        let job = format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{interface}]
fixed     = [{fixed}]
reduction = {{ {reduction} }}
write     = {{ superelement = "x.supel", html = "x.html" }}
"#
        );
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml")])
    }

    /// The superelement of the job, verified by itself and against the model.
    #[track_caller]
    fn made(self, place: &Place) -> Superelement {
        self.run(place).expect(ExitCode::Done);
        let (file, job) = (place.text("x.supel"), place.text("job.toml"));
        supel(&["verify", &file]).expect(ExitCode::Done);
        supel(&["verify", &file, "--job", &job]).expect(ExitCode::Done);
        place.superelement("x.supel")
    }
}

/// A folder with a model and modes.
fn place_with(model: &Model, modes: &[Vec<f64>]) -> Place {
    let place = Place::with(model);
    place.write("modes.mtx", array(modes).as_bytes());
    place
}

fn unpacked(matrix: &Matrix) -> Mat<f64> {
    Mat::from_fn(matrix.rows(), matrix.cols(), |i, j| matrix[(i, j)])
}

/// K and M of a model.
fn matrices(model: &Model) -> [Mat<f64>; 2] {
    [&model.stiffness, &model.mass].map(|entries| {
        let rows = dense::dense(model.n, entries);
        Mat::from_fn(model.n, model.n, |i, j| rows[i][j])
    })
}

/// λ and shapes of K x = λ M x by a Cholesky factor of K + αM with unit diagonal, ascending: θ = 1/(λ + α) is known to rounding of the
/// largest θ, and with it the low end of the spectrum.
fn eigen(k: MatRef<'_, f64>, m: MatRef<'_, f64>, alpha: f64) -> (Vec<f64>, Mat<f64>) {
    let n = k.nrows();
    let shifted = |i: usize, j: usize| k[(i, j)] + alpha * m[(i, j)];
    let scale: Vec<f64> = (0..n).map(|i| shifted(i, i).sqrt().recip()).collect();
    let a = Mat::from_fn(n, n, |i, j| shifted(i, j) * scale[i] * scale[j]);
    let mut c = Mat::from_fn(n, n, |i, j| m[(i, j)] * scale[i] * scale[j]);
    let factor = a.llt(Side::Lower).expect("definite");
    let lower = factor.L();
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(lower, c.as_mut(), faer::Par::Seq);
    let mut c = c.transpose().to_owned();
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(lower, c.as_mut(), faer::Par::Seq);
    let found = c.self_adjoint_eigen(Side::Lower).expect("converges");
    let theta: Vec<f64> = found.S().column_vector().iter().rev().copied().collect();
    let mut shapes = Mat::from_fn(n, n, |i, j| found.U()[(i, n - 1 - j)]);
    faer::linalg::triangular_solve::solve_upper_triangular_in_place(lower.transpose(), shapes.as_mut(), faer::Par::Seq);
    let shapes = Mat::from_fn(n, n, |i, j| shapes[(i, j)] * scale[i] / theta[j].abs().sqrt());
    (theta.into_iter().map(|theta| 1.0 / theta - alpha).collect(), shapes)
}

/// λ of a superelement with its first `n_held` coordinates at rest.
fn spectrum(file: &Superelement, n_held: usize, alpha: f64) -> Vec<f64> {
    let [k, m] = [&file.tensors().stiffness, &file.tensors().mass].map(unpacked);
    let n = k.nrows() - n_held;
    eigen(k.as_ref().submatrix(n_held, n_held, n, n), m.as_ref().submatrix(n_held, n_held, n, n), alpha).0
}

/// The largest difference of θ = 1/(λ + α) of two spectra of as many eigenvalues, relative to the largest θ.
#[track_caller]
fn difference(found: &[f64], expected: &[f64], alpha: f64) -> f64 {
    assert_eq!(found.len(), expected.len(), "as many eigenvalues");
    let theta = |lambda: f64| (expected[0] + alpha) / (lambda + alpha);
    found.iter().zip(expected).fold(0.0, |worst, (a, b)| f64::max(worst, (theta(*a) - theta(*b)).abs()))
}
