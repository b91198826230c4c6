//! Components whose stiffness is the tangent of a preloaded state: springs under tension between points that nodes carry.

mod network;
mod patches;
mod refused;
mod theory;
mod told;
mod unstable;

use serde_json::Value;
use supel::cli::ExitCode;
use supel_runtime::Superelement;
use supel_testing::place::{Ended, Place, supel};

use network::Network;

/// Four nodes, the first and the last ones, of which some have internal forces.
const ENDS: &str = r#"{ name = "ends", nodes = [1, 2, 11, 12] }"#;
/// What `[model]` says of the state.
const PRELOADED: &str = r#", state = "preloaded", internal_forces = "q.mtx""#;

/// A run and its folder.
struct Made {
    place: Place,
    file: Superelement,
    report: Value,
}

/// A folder with the model and the job.
fn place_of(network: &Network, forces: &[f64], (state, interface): (&str, &str), reduction: &str) -> Place {
    let place = Place::with(&network.model);
    place.write("q.mtx", column(forces).as_bytes());
    let job = format!(
        r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv"{state} }}
interface = [{interface}]
reduction = {{ {reduction} }}
write     = {{ superelement = "x.supel", html = "x.html" }}
"#
    );
    place.write("job.toml", job.as_bytes());
    place
}

/// A Matrix Market file of one column.
fn column(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| format!("{value:e}\n")).collect();
    format!("%%MatrixMarket matrix array real general\n{} 1\n{}", values.len(), values.concat())
}

fn reduced(place: &Place) -> Ended {
    supel(&["reduce", &place.text("job.toml")])
}

fn made(network: &Network, interface: &str, reduction: &str) -> Made {
    let place = place_of(network, &network.forces, (PRELOADED, interface), reduction);
    let ended = reduced(&place);
    assert_eq!(ended.code, ExitCode::Done, "{reduction}: {}{}", ended.out, ended.err);
    Made { file: place.superelement("x.supel"), report: place.report("x.report.json"), place }
}

fn n_rigid(report: &Value) -> u64 {
    report["body"]["model"]["rigid_body_modes"]["count"].as_u64().expect("a count")
}
