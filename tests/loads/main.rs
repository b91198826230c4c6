//! Loads that the job names: what the superelement has of them.

mod centrifugal;
#[cfg(feature = "hdf5")]
mod pressure;
mod refused;
mod statics;
mod told;
mod vectors;

use supel::cli::ExitCode;
use supel_models::model::multiply;
use supel_models::{Inertia, Material, Model, Section, frame};
use supel_runtime::Superelement;
use supel_testing::place::{Ended, Place, supel};

const METHODS: [&str; 5] = ["craig-bampton", "herting", "rubin", "macneal", "guyan"];

/// A model in a folder, with what its job says of interfaces, held dofs and loads.
struct Case {
    name: &'static str,
    model: Model,
    interface: &'static str,
    fixed: &'static str,
    loads: &'static str,
}

impl Case {
    fn job(&self, method: &str, n_modes: usize) -> String {
        let modes = if method == "guyan" { String::new() } else { format!(", modes = {{ count = {n_modes} }}") };
        format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{}]
fixed     = [{}]
load      = [{}]
reduction = {{ method = "{method}"{modes} }}
write     = {{ superelement = "x.supel", html = "x.html", recovery = {{ nodes = {EVERY_NODE} }} }}
"#,
            self.interface, self.fixed, self.loads
        )
    }

    fn place(&self) -> Place {
        let place = Place::with(&self.model);
        place.write("pressure.mtx", array(&[pressure(&self.model)]).as_bytes());
        place
    }

    fn run(&self, method: &str, n_modes: usize) -> (Place, Ended) {
        let place = self.place();
        place.write("job.toml", self.job(method, n_modes).as_bytes());
        let ended = supel(&["reduce", &place.text("job.toml")]);
        (place, ended)
    }

    fn made(&self, method: &str, n_modes: usize) -> (Place, Superelement) {
        let (place, ended) = self.run(method, n_modes);
        assert_eq!(ended.code, ExitCode::Done, "{}, {method}: {}{}", self.name, ended.out, ended.err);
        let file = place.superelement("x.supel");
        (place, file)
    }
}

const EVERY_NODE: &str = "{ within = { sphere = { center = [0, 0, 0], radius = 1000 } } }";

/// A load without a pattern: every row has another force.
fn pressure(model: &Model) -> Vec<f64> {
    (0..model.n).map(|row| (1.7 * row as f64 + 0.3).sin()).collect()
}

/// Columns as a Matrix Market array.
fn array(columns: &[Vec<f64>]) -> String {
    let mut text = format!("%%MatrixMarket matrix array real general\n{} {}\n", columns[0].len(), columns.len());
    columns.iter().flatten().for_each(|value| text += &format!("{value:.17e}\n"));
    text
}

/// Five beams with a bend, six nodes.
fn elbow() -> Model {
    let nodes = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.1, 0.0, 0.0], [2.1, 0.9, 0.0], [2.1, 1.7, 0.3], [2.1, 2.8, 0.3]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]];
    frame(&nodes, &edges, &Section::round(0.05), &Material::STEEL_SI, Inertia::Consistent)
}

/// A force shared out among nodes, on the rows of a model.
fn shared_out(model: &Model, nodes: &[i64], force: [f64; 3]) -> Vec<f64> {
    let of_row = |(node, direction): &(i64, u8)| match force.get(usize::from(*direction)) {
        Some(force) if nodes.contains(node) => force / nodes.len() as f64,
        _ => 0.0,
    };
    model.dofs.iter().map(of_row).collect()
}

/// M p of the displacements p away from an axis of unit length through a point.
fn centrifugal(model: &Model, axis: [f64; 3], through: [f64; 3]) -> Vec<f64> {
    let place_of = |node: i64| model.nodes[node as usize - 1];
    let of_row = |(node, direction): &(i64, u8)| {
        let arm: [f64; 3] = std::array::from_fn(|i| place_of(*node)[i] - through[i]);
        let along: f64 = (0..3).map(|i| arm[i] * axis[i]).sum();
        let i = usize::from(*direction);
        if i < 3 { arm[i] - along * axis[i] } else { 0.0 }
    };
    multiply(&model.mass, &model.dofs.iter().map(of_row).collect::<Vec<f64>>())
}
