//! Degrees of freedom that the job holds: the component is the one whose rows were left out of the matrices by hand.

mod alike;
mod gravity;
mod refused;
mod theory;
mod told;

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::{Inertia, Material, Model, Section, frame};
use supel_runtime::Superelement;
use supel_testing::place::{Ended, Place, supel};

const METHODS: [&str; 2] = ["craig-bampton", "herting"];

/// A model in a folder, with what its job says of interfaces and held dofs.
struct Case {
    name: &'static str,
    model: Model,
    interface: &'static str,
    fixed: &'static str,
    /// Whether the job names a dof map and nodes.
    has_nodes: bool,
}

/// What a run made.
struct Made {
    place: Place,
    file: Superelement,
    report: Value,
}

impl Case {
    fn job(&self, method: &str, n_modes: usize, fixed: &str) -> String {
        let nodes = if self.has_nodes { ", dofs = \"dofs.txt\", nodes = \"nodes.csv\"" } else { "" };
        let recovery = if self.has_nodes { format!(", recovery = {{ nodes = {EVERY_NODE} }}") } else { String::new() };
        format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx"{nodes} }}
interface = [{}]
{fixed}
reduction = {{ method = "{method}", modes = {{ count = {n_modes} }} }}
write     = {{ superelement = "x.supel", html = "x.html"{} }}
"#,
            self.interface, recovery
        )
    }

    fn run(&self, method: &str, n_modes: usize) -> (Place, Ended) {
        let place = Place::with(&self.model);
        place.write("job.toml", self.job(method, n_modes, &format!("fixed = [{}]", self.fixed)).as_bytes());
        let ended = supel(&["reduce", &place.text("job.toml")]);
        (place, ended)
    }

    fn made(&self, method: &str, n_modes: usize) -> Made {
        let (place, ended) = self.run(method, n_modes);
        assert_eq!(ended.code, ExitCode::Done, "{}, {method}: {}{}", self.name, ended.out, ended.err);
        Made { file: place.superelement("x.supel"), report: place.report("x.report.json"), place }
    }
}

const EVERY_NODE: &str = "{ within = { sphere = { center = [0, 0, 0], radius = 1000 } } }";

/// Beams of round steel along x, consistent mass.
fn beam(n_elements: usize, length: f64, radius: f64) -> Model {
    let nodes: Vec<[f64; 3]> = (0..=n_elements).map(|i| [length * i as f64 / n_elements as f64, 0.0, 0.0]).collect();
    let edges: Vec<[usize; 2]> = (0..n_elements).map(|i| [i, i + 1]).collect();
    frame(&nodes, &edges, &Section::round(radius), &Material::STEEL_SI, Inertia::Consistent)
}

/// Five beams with a bend, six nodes.
fn elbow() -> Model {
    let nodes = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.1, 0.0, 0.0], [2.1, 0.9, 0.0], [2.1, 1.7, 0.3], [2.1, 2.8, 0.3]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]];
    frame(&nodes, &edges, &Section::round(0.05), &Material::STEEL_SI, Inertia::Consistent)
}

fn n_rigid(report: &Value) -> u64 {
    report["body"]["model"]["rigid_body_modes"]["count"].as_u64().expect("a count")
}
