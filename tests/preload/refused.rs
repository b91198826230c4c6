//! States that are not what the job says of them.

use supel::cli::ExitCode;
use supel_models::Model;
use supel_testing::place::Ended;

use crate::network::{Network, Nodes, bolted_tower, tied_tower, tower};
use crate::{ENDS, PRELOADED, place_of, reduced};

const STRAIN: f64 = 2e-3;
const HERTING: &str = r#"method = "herting", modes = { count = 8 }"#;

fn run(network: &Network, forces: &[f64], says: (&str, &str)) -> Ended {
    reduced(&place_of(network, forces, says, HERTING))
}

#[track_caller]
fn assert_says(ended: &Ended, expected: ExitCode, words: &[&str]) {
    assert_eq!(ended.code, expected, "{}{}", ended.out, ended.err);
    words.iter().for_each(|word| assert!(ended.err.contains(word), "{word:?} is not in {}", ended.err));
}

/// Forces that K does not turn: of the wrong sign, in another unit, of another step, of one node alone.
#[test]
fn forces_of_another_state() {
    for nodes in [Nodes::Points, Nodes::Bodies] {
        let network = tower(nodes, STRAIN);
        for (factor, answer) in [(-1.0, "-1"), (1024.0, "9.77e-04"), (1.0 / 1024.0, "1024"), (1.03, "0.971")] {
            let forces: Vec<f64> = network.forces.iter().map(|force| factor * force).collect();
            let words =
                ["E-PRELOAD-FORCES", "rotation about", "node ", &format!(" {answer} times the internal forces")];
            assert_says(&run(&network, &forces, (PRELOADED, ENDS)), ExitCode::InputData, &words);
        }
        // Two nodes on one line of action: resultants stay, and only the nodes themselves tell.
        let mut forces = network.forces.clone();
        let arm = [0, 1, 2].map(|i| network.model.nodes[11][i] - network.model.nodes[4][i]);
        let n = network.model.n / 12;
        for i in 0..3 {
            forces[4 * n + i] += 0.3 * STRAIN * 1e6 * arm[i];
            forces[11 * n + i] -= 0.3 * STRAIN * 1e6 * arm[i];
        }
        let ended = run(&network, &forces, (PRELOADED, ENDS));
        assert_says(&ended, ExitCode::InputData, &["E-PRELOAD-FORCES"]);
        assert!(["at node 5 u", "at node 12 u"].iter().any(|node| ended.err.contains(node)), "{}", ended.err);
    }
}

/// The forces of a bolt far from a patch are hundreds of times those of the patch, whose arms turn with these: they are not excused by it.
#[test]
fn forces_of_a_patch_next_to_a_bolt() {
    const PATCH: &str =
        r#"{ name = "foot", nodes = [1, 2, 3, 4], coupling = "rigid" }, { name = "tip", nodes = [11, 12] }"#;
    for nodes in [Nodes::Points, Nodes::Bodies] {
        let [strained, slack] = [1.5e-4, 0.0].map(|strain| bolted_tower(nodes, strain, 0.5));
        let sound = run(&strained, &strained.forces, (PRELOADED, PATCH));
        assert_eq!(sound.code, ExitCode::Done, "{}{}", sound.out, sound.err);
        let ended = run(&strained, &slack.forces, (PRELOADED, PATCH));
        assert_says(&ended, ExitCode::InputData, &["E-PRELOAD-FORCES", "rotation about"]);
        assert!((1..=4).any(|node| ended.err.contains(&format!("at node {node} "))), "{}", ended.err);
        // Where nothing turns with a patch they are a hundredth of the largest.
        let direct = run(&strained, &slack.forces, (PRELOADED, ENDS));
        assert_eq!(direct.code, ExitCode::Done, "{}{}", direct.out, direct.err);
    }
}

/// Nodes in another order, and reactions that were left out.
#[test]
fn forces_with_a_resultant() {
    let network = tower(Nodes::Points, STRAIN);
    let mut shifted = network.forces.clone();
    shifted.rotate_right(3);
    assert_says(
        &run(&network, &shifted, (PRELOADED, ENDS)),
        ExitCode::InputData,
        &["E-PRELOAD-BALANCE", "rotation about"],
    );
    let mut without = network.forces.clone();
    without[..3].fill(0.0);
    let words = ["E-PRELOAD-BALANCE", "resultant along the translation along", "those at supports and interfaces"];
    assert_says(&run(&network, &without, (PRELOADED, ENDS)), ExitCode::InputData, &words);
}

#[test]
fn a_state_without_forces_and_forces_without_a_state() {
    let network = tower(Nodes::Points, STRAIN);
    let run = |says| run(&network, &network.forces, (says, ENDS));
    let words = ["E-JOB-PRELOAD", "missing", "expected the file"];
    assert_says(&run(r#", state = "preloaded""#), ExitCode::Usage, &words);
    let words = ["E-JOB-PRELOAD", "given without", "or remove the key"];
    assert_says(&run(r#", internal_forces = "q.mtx""#), ExitCode::Usage, &words);
    assert_says(&run(r#", state = "unloaded", internal_forces = "q.mtx""#), ExitCode::Usage, &words);
    assert_says(&run(r#", state = "loaded""#), ExitCode::Usage, &["preloaded"]);
    // A file of another size, and none.
    let place = place_of(&network, &network.forces[3..], (PRELOADED, ENDS), HERTING);
    assert_says(&reduced(&place), ExitCode::InputData, &["E-LOAD-ROWS", "`internal forces` has 33 rows"]);
    std::fs::remove_file(place.path("q.mtx")).expect("removed");
    assert_says(&reduced(&place), ExitCode::Io, &["E-READ", "q.mtx"]);
}

/// Nobody said that the stiffness is that of a preloaded state: it does not let the component turn.
#[test]
fn a_preloaded_stiffness_that_nobody_announced() {
    for nodes in [Nodes::Points, Nodes::Bodies] {
        let network = tower(nodes, STRAIN);
        assert_says(&run(&network, &[], ("", ENDS)), ExitCode::InputData, &["E-ROTATIONS-HELD"]);
    }
}

#[test]
fn rows_that_nothing_places() {
    let network = tower(Nodes::Points, STRAIN);
    let place =
        place_of(&network, &network.forces, (PRELOADED, r#"{ name = "ends", nodes = { rows = [0, 1, 2] } }"#), HERTING);
    let job = String::from_utf8(place.bytes("job.toml")).expect("UTF-8");
    place.write("job.toml", job.replace(r#", dofs = "dofs.txt", nodes = "nodes.csv""#, "").as_bytes());
    assert_says(&reduced(&place), ExitCode::InputData, &["E-PRELOAD-COORDINATES", "give model.dofs and model.nodes"]);
}

/// Supports took the rows of the first node out, and their forces with them.
#[test]
fn a_stiffness_without_the_rows_of_its_supports() {
    let Network { model, forces, springs, .. } = tower(Nodes::Points, STRAIN);
    let rest = |entries: &[(u32, u32, f64)]| {
        entries.iter().filter(|(i, j, _)| *i >= 3 && *j >= 3).map(|(i, j, value)| (i - 3, j - 3, *value)).collect()
    };
    let model = Model {
        n: model.n - 3,
        stiffness: rest(&model.stiffness),
        mass: rest(&model.mass),
        dofs: model.dofs[3..].to_vec(),
        ..model
    };
    let held = Network { model, forces: forces[3..].to_vec(), springs, n_directions: 3 };
    let words = ["E-PRELOAD-HELD", "of 11", "hold its supports by [[fixed]]"];
    let interface = r#"{ name = "ends", nodes = [2, 11, 12] }"#;
    assert_says(&run(&held, &held.forces, (PRELOADED, interface)), ExitCode::InputData, &words);
}

/// A row that was dropped has no element that could make a force.
#[test]
fn a_force_at_an_empty_row() {
    let mut network = tower(Nodes::Points, STRAIN);
    let model = &mut network.model;
    model.n += 3;
    model.nodes.push([3.0, 3.0, 3.0]);
    model.labels.push(13);
    model.dofs.extend([(13, 0), (13, 1), (13, 2)]);
    let mut forces = network.forces.clone();
    forces.extend([0.0, 0.0, 0.0]);
    let says = (&*format!("{PRELOADED}, drop_empty = true"), ENDS);
    let sound = run(&network, &forces, says);
    assert_eq!(sound.code, ExitCode::Done, "{}{}", sound.out, sound.err);
    forces[37] = 1.0;
    assert_says(
        &run(&network, &forces, says),
        ExitCode::InputData,
        &["E-PRELOAD-EMPTY", "row 38 has an internal force"],
    );
}

/// Where no node has a force, rotations are free and the state is no preloaded one.
#[test]
fn forces_that_rounding_hides() {
    let network = tower(Nodes::Points, 0.0);
    assert_says(
        &run(&network, &vec![0.0; network.model.n], (PRELOADED, ENDS)),
        ExitCode::InputData,
        &["E-PRELOAD-NONE", "leave model.state out"],
    );
    // No more can be said where K is that of a preloaded state, and the forces lie along directions without rows.
    let network = tower(Nodes::Points, STRAIN);
    let without = run(&network, &vec![0.0; network.model.n], (PRELOADED, ENDS));
    assert!(without.err.contains("E-PRELOAD-NONE") && !without.err.contains("NaN"), "{}", without.err);
    let network = tower(Nodes::Points, 1e-15);
    assert_says(&run(&network, &network.forces, (PRELOADED, ENDS)), ExitCode::InputData, &["E-PRELOAD-NONE"]);
}

/// The arm of a force turns with what ties it: a mean motion and a row of G do not say how.
#[test]
fn forces_at_tied_nodes() {
    let network = tower(Nodes::Bodies, STRAIN);
    let patch = r#"{ name = "ends", nodes = [1, 2, 3, 4], coupling = "average" }"#;
    let words = ["E-PRELOAD-TIED", "node 1 ux has an internal force", "an average ties it", "coupling = \"direct\""];
    assert_says(&run(&network, &network.forces, (PRELOADED, patch)), ExitCode::InputData, &words);
    let constrained = |network: &Network, interface: &str, rows: &str| {
        let says = format!("{PRELOADED}, constraints = \"G.mtx\", constraints_to_ground = \"accept\"");
        let place = place_of(network, &network.forces, (&says, interface), HERTING);
        place.write("G.mtx", format!("%%MatrixMarket matrix coordinate real general\n1 72 {rows}").as_bytes());
        reduced(&place)
    };
    // u_1z − u_2z + (x_2 − x_1) r_1y = 0.
    let ended = constrained(&network, r#"{ name = "ends", nodes = [11, 12] }"#, "3\n1 3 1\n1 9 -1\n1 5 -1\n");
    assert_says(&ended, ExitCode::InputData, &["E-PRELOAD-TIED", "a constraint ties it"]);
    // Of the nodes below the first one alone has a force, of the others the last.
    let network = tied_tower(Nodes::Bodies, 0.1);
    let patch = r#"{ name = "foot", nodes = [1, 2, 3, 4], coupling = "rigid", dofs = ["ux", "uy", "uz"] }"#;
    let ended = constrained(&network, patch, "2\n1 69 1\n1 9 -1\n");
    assert_says(&ended, ExitCode::InputData, &["E-PRELOAD-TIED", "node 12 uz", "a constraint ties it"]);
    let ended = constrained(&network, patch, "2\n1 9 1\n1 15 -1\n");
    assert_says(&ended, ExitCode::InputData, &["E-PRELOAD-DEPENDENT", "interface foot r", "out of model.constraints"]);
}

/// A carrier that moves a patch without turning it.
#[test]
fn a_patch_that_turns_otherwise_than_its_carrier() {
    let network = tower(Nodes::Bodies, STRAIN);
    let interface = r#"{ name = "foot", nodes = [1, 2, 3, 4], coupling = "rigid", dofs = ["ux", "uy", "uz"] },
        { name = "tip", nodes = [11, 12] }]
        scene.prescribed = [{ name = "table", interfaces = ["foot", "tip"] }"#;
    let words =
        ["E-PRELOAD-CARRIED", "\"foot\" have internal forces", "\"table\" moves its node", "all six directions"];
    assert_says(&run(&network, &network.forces, (PRELOADED, interface)), ExitCode::InputData, &words);
}

/// Compression turns the component over where nothing holds it; where something does, it is a structure like others.
#[test]
fn compression() {
    let network = tower(Nodes::Points, -STRAIN);
    let words = ["E-PRELOAD-NEGATIVE", "compression", "[[fixed]]"];
    assert_says(&run(&network, &network.forces, (PRELOADED, ENDS)), ExitCode::ModelPhysics, &words);
    let held = "{ name = \"ends\", nodes = [11, 12] }]\nfixed = [{ nodes = [1, 2, 3] }";
    let ended = run(&network, &network.forces, (PRELOADED, held));
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
}
