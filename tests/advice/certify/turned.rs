//! Superelements at nodes whose rows are along axes of their own: a coordinate is the direction that its column moves.

use supel::cli::ExitCode;
use supel_models::Model;
use supel_models::transform::in_local_frames;
use supel_testing::place::{Ended, Place, steel_brick, supel};

use super::foreign_files::{Named, labels, named};
use super::superelement::{Foreign, failed, interface};

/// x along (2, 2, 1) and y along (-2, 1, 2).
const ASKEW: [[f64; 3]; 3] = {
    let (a, b) = (2.0 / 3.0, 1.0 / 3.0);
    [[a, a, b], [-a, b, a], [b, -a, a]]
};
const N_MODES: usize = 24;

/// The block with the rows of two of the four interface nodes, and of one inside, along their own axes.
fn model() -> (Model, Vec<i64>) {
    let sound = steel_brick();
    let nodes: Vec<i64> = [interface()[3], interface()[9], 3 * 20].iter().map(|row| sound.dofs[*row].0).collect();
    (in_local_frames(&sound, &ASKEW, |node| nodes.contains(&node)), nodes)
}

fn table(nodes: &[i64]) -> String {
    let row = |node: &i64| format!("{node},2,2,1,-2,1,2\n");
    "node,x1,x2,x3,y1,y2,y3\n".to_owned() + &nodes.iter().map(row).collect::<String>()
}

/// What is said of a superelement whose matrices name their rows, in this order.
fn certified(foreign: &Foreign, order: &[Named], rest: &[&str]) -> Ended {
    let (model, nodes) = model();
    let place = Place::with(&model);
    foreign.write(&place);
    place.write("frames.csv", table(&nodes).as_bytes());
    place.write("khat.txt", labels(&foreign.stiffness, order).as_bytes());
    place.write("mhat.txt", labels(&foreign.mass, order).as_bytes());
    let paths = ["K.mtx", "M.mtx", "psi.mtx", "dofs.txt", "nodes.csv", "frames.csv", "khat.txt", "mhat.txt"];
    let [k, m, psi, dofs, nodes, frames, khat, mhat] = &paths.map(|name| place.text(name));
    let flags = ["--dofs", dofs, "--nodes", nodes, "--frames", frames];
    let reduced = ["--reduced-stiffness", khat, "--reduced-mass", mhat];
    supel(&[&["certify", k, m, psi], flags.as_slice(), &reduced, rest].concat())
}

#[test]
fn a_right_one_is_certified_and_all_of_its_interface_compared() {
    let foreign = Foreign::craig_bampton(&model().0, &interface(), N_MODES);
    let found = certified(&foreign, &named(N_MODES), &["--json"]).expect(ExitCode::Done).out;
    let found: serde_json::Value = serde_json::from_str(&found).expect("JSON");
    assert_eq!((&found["verdict"], &found["n_interface"]), (&"pass".into(), &12.into()), "{found}");
    assert_eq!(found["preservation"]["statics"].as_array().expect("statics").len(), 4, "{found}");
    let notes = found["notes"].to_string();
    assert!(notes.contains("12 rows of K̂ and M̂ were put") && notes.contains("6 coordinates are along"), "{notes}");
}

/// What its reduced matrices say at a turned node is looked at as it is anywhere.
#[test]
fn matrices_that_exchange_two_axes_of_a_node_are_wrong() {
    let foreign = Foreign::craig_bampton(&model().0, &interface(), N_MODES);
    let mut order = named(N_MODES);
    let first = order.iter().position(|(at, ..)| *at == N_MODES + 3).expect("x of the second node");
    let [x, y] = [order[first], order[first + 1]];
    (order[first].0, order[first + 1].0) = (y.0, x.0);
    let found = certified(&foreign, &order, &["--json"]).expect(ExitCode::CheckFailed).out;
    let failed = failed(&serde_json::from_str(&found).expect("JSON"));
    assert!(failed.iter().any(|(id, _)| id == "C-07"), "{failed:?}");
}

/// One direction of a node is no direction of the model: its coordinate is right, and no part of the interface.
#[test]
fn a_node_of_which_some_directions_are_kept_is_said_to_be_left_out() {
    let kept: Vec<usize> = interface().into_iter().filter(|row| *row != interface()[4]).collect();
    let foreign = Foreign::craig_bampton(&model().0, &kept, N_MODES);
    let order: Vec<Named> = {
        let dofs = steel_brick().dofs;
        let of_interface = kept.iter().enumerate().map(|(at, row)| (N_MODES + at, dofs[*row].0, dofs[*row].1 + 1));
        of_interface.rev().chain((0..N_MODES).map(|at| (at, 9001 + at as i64, 1))).collect()
    };
    let found = certified(&foreign, &order, &["--json"]).expect(ExitCode::Done).out;
    let found: serde_json::Value = serde_json::from_str(&found).expect("JSON");
    let notes = found["notes"].to_string();
    assert!(notes.contains("2 coordinates are along axes of a node") && notes.contains("11 rows of K̂"), "{notes}");
    assert_eq!((&found["n_interface"], &found["verdict"]), (&9.into(), &"warn".into()), "{found}");
}
