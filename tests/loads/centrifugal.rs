//! The centrifugal load of masses that are not where their rows are.

use supel::cli::ExitCode;
use supel_models::model::cross;
use supel_runtime::{Coordinate, Superelement};
use supel_testing::place::{Place, supel};

use crate::elbow;

const AXIS: [f64; 3] = [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0];
const THROUGH: [f64; 3] = [0.3, -0.2, 0.5];
/// Node 6 of the elbow.
const NODE: [f64; 3] = [2.1, 2.8, 0.3];
/// Four masses, and where they are from the node.
const POINTS: [(f64, [f64; 3]); 4] =
    [(300.0, [0.5, 0.1, -0.3]), (150.0, [0.1, 0.4, 0.2]), (200.0, [-0.2, 0.3, 0.6]), (100.0, [0.3, 0.3, 0.1])];

/// The job of the elbow whose end at node 6 is an interface, with more of it.
fn job(more: &str) -> String {
    format!(
        r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{{ name = "ends", nodes = [1, 6] }}]
load      = [{{ name = "spin", rotation = {{ axis = {AXIS:?}, through = {THROUGH:?} }} }}]
reduction = {{ method = "guyan" }}
write     = {{ superelement = "x.supel" }}
{more}"#
    )
}

/// Force and moment of the load at node 6, those that the interior hands to it among them.
fn at_node(file: &Superelement) -> [f64; 6] {
    let loads = file.tensors().load_vectors.as_ref().expect("loads");
    let labels = file.metadata().interface_labels();
    let mut found = [0.0; 6];
    for (row, coordinate) in file.metadata().coordinates.iter().enumerate() {
        if let Coordinate::Interface { node, direction } = coordinate
            && labels[*node] == 6
        {
            found[*direction as usize] = loads[(row, 0)];
        }
    }
    found
}

/// The masses as one rigid body, by its mass, centre and inertia about the centre.
fn as_one_body() -> String {
    let mass: f64 = POINTS.iter().map(|(m, _)| m).sum();
    let centre: [f64; 3] = std::array::from_fn(|i| POINTS.iter().map(|(m, d)| m * d[i]).sum::<f64>() / mass);
    let moment = |i: usize, j: usize| -> f64 {
        let of_point = |(m, d): &(f64, [f64; 3])| {
            let r: [f64; 3] = std::array::from_fn(|k| d[k] - centre[k]);
            let square: f64 = r.iter().map(|r| r * r).sum();
            m * (if i == j { square } else { 0.0 } - r[i] * r[j])
        };
        POINTS.iter().map(of_point).sum()
    };
    let inertia = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].map(|(i, j)| moment(i, j));
    format!("added_mass = [{{ node = 6, mass = {mass:?}, offset = {centre:?}, inertia = {inertia:?} }}]\n")
}

/// Four masses on stiff arms pull at their node, each by its own distance from the axis.
#[test]
fn an_added_mass_pulls_where_its_centre_is() {
    let place = Place::with(&elbow());
    let made = |more: &str| {
        place.write("job.toml", job(more).as_bytes());
        supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
        supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
        at_node(&place.superelement("x.supel"))
    };
    let (without, with) = (made(""), made(&as_one_body()));
    let mut expected = [0.0; 6];
    for (mass, arm) in POINTS {
        let way: [f64; 3] = std::array::from_fn(|i| NODE[i] + arm[i] - THROUGH[i]);
        let along: f64 = (0..3).map(|i| way[i] * AXIS[i]).sum();
        let force: [f64; 3] = std::array::from_fn(|i| mass * (way[i] - along * AXIS[i]));
        let moment = cross(arm, force);
        (0..3).for_each(|i| (expected[i], expected[i + 3]) = (expected[i] + force[i], expected[i + 3] + moment[i]));
    }
    for i in 0..6 {
        // Sums of some ten products of the size of the largest.
        let largest = expected.iter().chain(&without).fold(0.0f64, |max, value| max.max(value.abs()));
        let error = (with[i] - without[i] - expected[i]).abs() / largest;
        assert!(error < 1e-13, "{i}: found {}, expected {}", with[i] - without[i], expected[i]);
    }
}

/// E-LOAD-CONDENSED: the mass of a superelement does not tell where inside it is; the load that its file has is told as the way to go.
#[test]
fn a_superelement_does_not_spin() {
    let place = Place::with(&elbow());
    place.write("job.toml", job("").as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    let of_file = |load: &str| {
        format!(
            r#"
model     = {{ stiffness = "x.supel", mass = "x.supel", dofs = "x.supel", nodes = "x.supel" }}
interface = [{{ name = "end", nodes = [6] }}]
load      = [{{ name = "spin", {load} }}]
reduction = {{ method = "guyan" }}
write     = {{ superelement = "y.supel" }}
"#
        )
    };
    place.write("again.toml", of_file("rotation = { axis = [0, 0, 1] }").as_bytes());
    for command in ["reduce", "plan"] {
        let ended = supel(&[command, &place.text("again.toml")]).expect(ExitCode::InputData);
        for word in ["E-LOAD-CONDENSED", "load `spin`", "x.supel", "by `file`"] {
            assert!(ended.err.contains(word), "{word}: {}", ended.err);
        }
    }
    place.write("again.toml", of_file("file = \"x.supel\", column = 0").as_bytes());
    supel(&["reduce", &place.text("again.toml")]).expect(ExitCode::Done);
}
