//! Further matrices and damping: projected, carried, checked, refused, against dense algebra of the full model.

mod added;
mod law;
mod projected;
mod refused;
mod rotor;

use faer::{Mat, MatRef};
use supel::cli::ExitCode;
use supel_models::{Model, SplitMix64};
use supel_runtime::Superelement;
use supel_testing::pencil::unpacked;
use supel_testing::place::{Ended, Place, supel};

/// A model in a folder of its own, with the superelement x.supel of job.toml.
struct Case {
    place: Place,
    model: Model,
}

/// A matrix of the full model as entries, each place once.
type Entries = Vec<(u32, u32, f64)>;

impl Case {
    fn new(model: Model) -> Self {
        Self { place: Place::with(&model), model }
    }

    /// Writes a matrix as Matrix Market with this word for its symmetry; of one that is declared so the lower triangle.
    fn matrix(&self, name: &str, symmetry: &str, entries: &Entries) {
        let is_kept = |(i, j, _): &&(u32, u32, f64)| symmetry == "general" || i >= j;
        let kept: Vec<_> = entries.iter().filter(is_kept).collect();
        let n = self.model.n;
        let mut text = format!("%%MatrixMarket matrix coordinate real {symmetry}\n{n} {n} {}\n", kept.len());
        kept.iter().for_each(|(i, j, value)| text += &format!("{} {} {value:e}\n", i + 1, j + 1));
        self.place.write(name, text.as_bytes());
    }

    /// Runs a job of these further keys.
    fn run(&self, interfaces: &str, reduction: &str, more: &str) -> Ended {
        let job = format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{interfaces}]
reduction = {{ {reduction} }}
{more}
[write]
superelement = "x.supel"
recovery = {{ nodes = {{ within = {{ box = {{ min = [-9, -9, -9], max = [9, 9, 9] }} }} }} }}
"#
        );
        self.place.write("job.toml", job.as_bytes());
        supel(&["reduce", &self.place.text("job.toml"), "--quiet"])
    }

    #[track_caller]
    fn reduced(&self, interfaces: &str, reduction: &str, more: &str) -> Superelement {
        self.run(interfaces, reduction, more).expect(ExitCode::Done);
        self.place.superelement("x.supel")
    }

    fn verify(&self, more: &[&str]) -> Ended {
        supel(&[&["verify", &self.place.text("x.supel")][..], more].concat())
    }

    fn verify_with_job(&self) -> Ended {
        self.verify(&["--job", &self.place.text("job.toml")])
    }
}

/// A direct interface and a rigid patch of the steel brick.
const FOOT_AND_HUB: &str =
    r#"{ name = "foot", nodes = [1, 11, 31] }, { name = "hub", nodes = [5, 10, 15, 20, 25], coupling = "rigid" }"#;

const CRAIG_BAMPTON: &str = r#"method = "craig-bampton", modes = { count = 5 }"#;

const HERTING: &str = r#"method = "herting", modes = { count = 5 }"#;

fn dense(n: usize, entries: &Entries) -> Mat<f64> {
    let mut matrix = Mat::zeros(n, n);
    entries.iter().for_each(|(i, j, value)| matrix[(*i as usize, *j as usize)] += value);
    matrix
}

fn absolute(a: MatRef<'_, f64>) -> Mat<f64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)].abs())
}

/// WᵀAW and its terms, W all rows of the model on the coordinates of a superelement.
fn projected(superelement: &Superelement, a: &Mat<f64>) -> [Mat<f64>; 2] {
    let w = unpacked(superelement.tensors().recovery.as_ref().expect("all rows").rows());
    assert_eq!(w.nrows(), a.nrows(), "a row for each of the model");
    let sizes = absolute(w.as_ref());
    [w.transpose() * a * &w, sizes.transpose() * absolute(a.as_ref()) * &sizes]
}

/// Asserts that every entry is that of another matrix, to a share of its terms.
#[track_caller]
fn assert_entries(found: &Mat<f64>, [expected, terms]: &[Mat<f64>; 2], share: f64) {
    for (i, j) in (0..found.ncols()).flat_map(|j| (0..found.nrows()).map(move |i| (i, j))) {
        let difference = (found[(i, j)] - expected[(i, j)]).abs();
        assert!(difference <= share * terms[(i, j)], "{i}, {j}: {} for {}", found[(i, j)], expected[(i, j)]);
    }
}

/// Entries of the pattern of the stiffness with values that have nothing to do with each other.
fn any(model: &Model, seed: u64) -> Entries {
    let mut random = SplitMix64::new(seed);
    model.stiffness.iter().map(|(i, j, _)| (*i, *j, 2.0 * random.uniform() - 1.0)).collect()
}

/// A − Aᵀ.
fn skew(entries: &Entries, n: usize) -> Entries {
    let a = dense(n, entries);
    let value = |i: u32, j: u32| a[(i as usize, j as usize)] - a[(j as usize, i as usize)];
    entries.iter().filter(|(i, j, _)| i != j).map(|(i, j, _)| (*i, *j, value(*i, *j))).collect()
}

/// λ ascending and X with XᵀMX = I, by the root of M.
fn modes([k, m]: [&Mat<f64>; 2]) -> (Vec<f64>, Mat<f64>) {
    let l = m.llt(faer::Side::Lower).expect("a definite mass").L().to_owned();
    let half = |mut a: Mat<f64>| {
        faer::linalg::triangular_solve::solve_lower_triangular_in_place(l.as_ref(), a.as_mut(), faer::Par::Seq);
        a
    };
    let standard = half(half(k.clone()).transpose().to_owned());
    // Couplings below an absolute size are dropped: only a matrix of size one keeps its digits.
    let unit = standard.norm_max();
    let sum = Mat::from_fn(l.nrows(), l.nrows(), |i, j| 0.5 / unit * (standard[(i, j)] + standard[(j, i)]));
    let eigen = sum.self_adjoint_eigen(faer::Side::Lower).expect("eigenvalues");
    let mut shapes = eigen.U().to_owned();
    faer::linalg::triangular_solve::solve_upper_triangular_in_place(l.transpose(), shapes.as_mut(), faer::Par::Seq);
    (eigen.S().column_vector().iter().map(|value| value * unit).collect(), shapes)
}

/// The modes of a superelement with its interface free.
fn free_modes(superelement: &Superelement) -> (Vec<f64>, Mat<f64>) {
    let tensors = superelement.tensors();
    modes([&unpacked(&tensors.stiffness), &unpacked(&tensors.mass)])
}

/// The eigenvalues μ of μ²M + μC + K with positive imaginary part, by it. In coordinates of the undamped modes, where nothing stiff spoils
/// what is soft: those of [0 Ω; −Ω −XᵀCX].
fn damped_eigenvalues([k, c, m]: [&Mat<f64>; 3]) -> Vec<[f64; 2]> {
    let (lambda, x) = modes([k, m]);
    let (n, damping) = (lambda.len(), x.transpose() * c * &x);
    let omega = |i: usize| lambda[i].max(0.0).sqrt();
    let first_order = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => 0.0,
        (true, false) => {
            if i == j - n {
                omega(i)
            } else {
                0.0
            }
        }
        (false, true) => {
            if i - n == j {
                -omega(j)
            } else {
                0.0
            }
        }
        (false, false) => -damping[(i - n, j - n)],
    });
    let values = first_order.eigenvalues().expect("eigenvalues");
    let upper = values.iter().filter(|value| value.im > 0.0).map(|value| [value.re, value.im]);
    let mut upper: Vec<[f64; 2]> = upper.collect();
    upper.sort_by(|a, b| a[1].total_cmp(&b[1]));
    upper
}
