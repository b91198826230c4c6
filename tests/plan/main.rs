//! What a run leaves out because its scene never asks for it: the same answers without it, and what says that it is gone.

mod again;
mod command;
mod interface;
mod mechanisms;
mod modes;
mod refused;
mod statics;
mod storage;
mod table;

use faer::Mat;
use serde_json::Value;
use supel::cli::ExitCode;
use supel::dense::unpacked;
use supel_models::{Material, Model, brick};
use supel_runtime::Superelement;
use supel_testing::place::{Ended, Place, supel};

/// A job on a free steel brick of 6 × 3 × 2 elements, 252 dofs, with a rigid patch at one end and another one, or nodes, at the other.
struct Case {
    /// `[[interface]]` tables.
    interfaces: &'static str,
    reduction: &'static str,
    /// Keys of `[scene]`.
    scene: &'static str,
    /// Further tables.
    rest: &'static str,
    /// Further keys of `[write]`.
    write: &'static str,
}

/// Two rigid patches.
const PATCHES: &str = r#"
[[interface]]
name = "root"
coupling = "rigid"
nodes = { within = { box = { min = [0, 0, 0], max = [0, 9, 9] } } }
[[interface]]
name = "tip"
coupling = "rigid"
nodes = { within = { box = { min = [1, 0, 0], max = [1, 9, 9] } } }
"#;

/// A rigid patch and three nodes of their own.
const PATCH_AND_NODES: &str = r#"
[[interface]]
name = "root"
coupling = "rigid"
nodes = { within = { box = { min = [0, 0, 0], max = [0, 9, 9] } } }
[[interface]]
name = "tip"
nodes = [7, 28, 63]
"#;

const CRAIG_BAMPTON: &str = r#"method = "craig-bampton", modes = { count = 6 }"#;
const HERTING: &str = r#"method = "herting", modes = { count = 6 }"#;

impl Case {
    const fn new(interfaces: &'static str, reduction: &'static str, scene: &'static str) -> Self {
        Self { interfaces, reduction, scene, rest: "", write: "" }
    }

    fn job(&self) -> String {
        let Self { interfaces, reduction, scene, rest, write } = self;
        let scene = if scene.is_empty() { String::new() } else { format!("[scene]\n{scene}\n") };
        format!(
            r#"
reduction = {{ {reduction} }}
write = {{ superelement = "x.supel"{write} }}
[model]
stiffness = "K.mtx"
mass = "M.mtx"
dofs = "dofs.txt"
nodes = "nodes.csv"
{interfaces}
{scene}
{rest}
"#
        )
    }

    fn run(&self, flags: &[&str]) -> (Place, Ended) {
        self.run_of(&model(), flags)
    }

    fn run_of(&self, model: &Model, flags: &[&str]) -> (Place, Ended) {
        let place = Place::with(model);
        place.write("job.toml", self.job().as_bytes());
        let job = place.text("job.toml");
        let ended = supel(&[&["reduce", &job], flags].concat());
        (place, ended)
    }

    /// What a run makes, seen sound by every way of looking at its file.
    #[track_caller]
    fn made(&self) -> Made {
        self.made_with(&[])
    }

    #[track_caller]
    fn made_with(&self, flags: &[&str]) -> Made {
        self.made_of(&model(), flags)
    }

    #[track_caller]
    fn made_of(&self, model: &Model, flags: &[&str]) -> Made {
        let (place, ended) = self.run_of(model, flags);
        ended.expect(ExitCode::Done);
        let (file, job) = (place.text("x.supel"), place.text("job.toml"));
        supel(&["verify", &file]).expect(ExitCode::Done);
        if flags.is_empty() {
            supel(&["verify", &file, "--job", &job]).expect(ExitCode::Done);
        }
        Made { file: place.superelement("x.supel"), report: place.report("x.report.json"), place }
    }
}

/// What a run made.
struct Made {
    file: Superelement,
    report: Value,
    place: Place,
}

impl Made {
    fn stiffness(&self) -> Mat<f64> {
        unpacked(&self.file.tensors().stiffness)
    }

    fn mass(&self) -> Mat<f64> {
        unpacked(&self.file.tensors().mass)
    }

    fn n_b(&self) -> usize {
        self.file.n_interface()
    }

    fn names(&self) -> Vec<&str> {
        self.file.metadata().interface_nodes.iter().map(|node| node.name.as_str()).collect()
    }

    fn assumptions(&self) -> &[String] {
        &self.file.metadata().validity.assumptions
    }

    fn work(&self, counter: &str) -> u64 {
        self.report["run"]["work"][counter].as_u64().expect("a counter")
    }

    /// Identifiers of the checks on record, each once.
    fn checks(&self) -> Vec<&str> {
        let checks = self.report["body"]["checks"].as_array().expect("checks").iter();
        let mut ids: Vec<&str> = checks.map(|check| check["id"].as_str().expect("an identifier")).collect();
        ids.dedup();
        ids
    }
}

fn model() -> Model {
    brick([6, 3, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI)
}

/// The rows and columns with the numbers given.
fn part(a: &Mat<f64>, rows: &[usize], columns: &[usize]) -> Mat<f64> {
    Mat::from_fn(rows.len(), columns.len(), |i, j| a[(rows[i], columns[j])])
}

/// The largest difference of two matrices, entry by entry relative to the roots of the diagonal of the second, rotations and translations
/// alike.
#[track_caller]
fn difference(found: &Mat<f64>, expected: &Mat<f64>) -> f64 {
    assert_eq!(found.shape(), expected.shape());
    let size = |i: usize| expected[(i, i)].abs().sqrt();
    let entry = |i: usize, j: usize| (found[(i, j)] - expected[(i, j)]).abs() / (size(i) * size(j));
    (0..found.nrows())
        .flat_map(|i| (0..found.ncols()).map(move |j| (i, j)))
        .map(|(i, j)| entry(i, j))
        .fold(0.0, f64::max)
}

/// ε times what a condensation of this brick amplifies: |Ψ|ᵀ|K||Ψ| is 10² times the stiffness of a patch that is left, with a factor of a
/// hundred for the sums.
const CONDENSED: f64 = 1e4 * f64::EPSILON;
