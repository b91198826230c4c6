//! Loads on the interface: what the full model needs there to move so.

use supel::cli::ExitCode;
use supel_models::model::multiply;
use supel_models::transform::{join, translated};
use supel_testing::place::{Place, steel_brick};

use super::{Case, any, difference, foot_and_hub, foot_rows, largest};
use crate::displacements::static_answer;

/// Loads on the dofs of the interface nodes, in the order of the coordinates.
fn nodal(case: &Case, state: usize) -> Vec<f64> {
    let rows = case.rows("f.csv");
    let of_state = rows.iter().filter(|row| row["state"] == state.to_string() && row["node"] != "all");
    of_state.map(|row| row["load"].parse().expect("a number")).collect()
}

/// The resultant on an interface, or on the whole component for no name.
fn resultant(case: &Case, state: usize, interface: &str) -> Vec<f64> {
    let rows = case.rows("f.csv");
    let is_its = |row: &&std::collections::BTreeMap<String, String>| {
        row["state"] == state.to_string() && row["node"] == "all" && row["interface"] == interface
    };
    rows.iter().filter(is_its).map(|row| row["load"].parse().expect("a number")).collect()
}

/// Force and moment about the origin of loads on all rows of the full model: their work on its rigid-body motions.
fn total(case: &Case, loads: &[f64]) -> Vec<f64> {
    let work = |mode: &Vec<f64>| mode.iter().zip(loads).map(|(u, f)| u * f).sum::<f64>();
    case.model.rigid_body_modes().iter().map(work).collect()
}

/// A static state takes K u at the interface, and in sum nothing.
#[test]
fn loads_of_a_static_state_are_those_of_the_full_model() {
    let case = Case::new("craig-bampton");
    let state = [any(9, 7), vec![0.0; 5]].concat();
    case.table("q.csv", &case.header(), std::slice::from_ref(&state));
    let ended = case.recover(&["--loads", "f.csv"]).expect(ExitCode::Done);
    assert!(ended.out.contains("loads on the interface, without those of inertia, in 1 state"), "{}", ended.out);
    let forces = multiply(&case.model.stiffness, &static_answer(&case, &state[..9]));
    let at_interface: Vec<f64> = foot_rows(&case.model).iter().map(|row| forces[*row]).collect();
    let error = difference(&nodal(&case, 1), &at_interface);
    // As displacements of a static state are good to 1e-10, and forces are their differences.
    assert!(error <= 1e-9, "{error:e}");
    let net = resultant(&case, 1, "");
    assert!(net.len() == 6 && largest(&net) <= 1e-9 * largest(&at_interface), "{net:?}");
    let first = &case.rows("f.csv")[4];
    let words = ["interface", "node", "component"].map(|column| first[column].as_str());
    assert_eq!(words, ["foot", "11", "fy"]);
}

/// Whatever moves, loads and resultants are K u + M ü of the full model with the motion that is recovered: at the nodes of a direct interface
/// as they are, and in sum the change of momentum.
#[test]
fn loads_of_a_motion_change_its_momentum() {
    let all = "recovery = { nodes = { within = { box = { min = [0, 0, 0], max = [1, 1, 1] } } } }";
    let case = Case::writing("craig-bampton", foot_and_hub(), all);
    let n = case.header().split(',').count();
    let omega = case.place.superelement("x.supel").tensors().frequencies.clone();
    // A mode with the interface held, which obeys the equations inside, and a turn with its acceleration.
    let mode = |factor: f64| (0..n).map(|at| if at + 5 == n { factor } else { 0.0 }).collect::<Vec<f64>>();
    let turning: Vec<f64> = {
        let u = case.place.superelement("x.supel").tensors().rigid_body_modes.clone();
        (0..n).map(|row| u[(row, 4)] + 0.5 * u[(row, 0)]).collect()
    };
    case.table("q.csv", &case.header(), &[mode(1.0), vec![0.0; n]]);
    case.table("a.csv", &case.header(), &[mode(-omega[0] * omega[0]), turning]);
    case.recover(&["-o", "u.csv", "--loads", "f.csv", "--acceleration", "a.csv"]).expect(ExitCode::Done);
    for state in [1, 2] {
        let [u, a] = ["displacement", "acceleration"].map(|name| case.values("u.csv", state, name));
        let (elastic, inertial) = (multiply(&case.model.stiffness, &u), multiply(&case.model.mass, &a));
        let outer: Vec<f64> = elastic.iter().zip(&inertial).map(|(k, m)| k + m).collect();
        if state == 1 {
            let at_foot: Vec<f64> = foot_rows(&case.model).iter().map(|row| outer[*row]).collect();
            let error = difference(&nodal(&case, state)[..9], &at_foot);
            // The residual of a mode, as in the test of its swing.
            assert!(error <= 1e-8, "{error:e}");
        }
        let error = difference(&resultant(&case, state, ""), &total(&case, &inertial));
        // Rounding of K, which lets rigid-body motion pass to 1e-12 of the forces inside.
        assert!(error <= 1e-9, "state {state}: {error:e}");
        let [foot, hub] = ["foot", "hub"].map(|name| resultant(&case, state, name));
        let sum: Vec<f64> = foot.iter().zip(&hub).map(|(a, b)| a + b).collect();
        assert!(difference(&sum, &resultant(&case, state, "")) <= 1e-13);
    }
}

/// A matrix of the export, row by row.
fn exported(case: &Case, name: &str) -> Vec<Vec<f64>> {
    let text = String::from_utf8(case.place.bytes(name)).expect("text");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("%%MatrixMarket matrix array real general"));
    let sizes: Vec<usize> = lines.next().expect("sizes").split(' ').map(|size| size.parse().expect("a size")).collect();
    let values: Vec<f64> = lines.map(|line| line.parse().expect("a number")).collect();
    (0..sizes[0]).map(|i| (0..sizes[1]).map(|j| values[i + j * sizes[0]]).collect()).collect()
}

fn times(rows: &[Vec<f64>], state: &[f64]) -> Vec<f64> {
    rows.iter().map(|row| row.iter().zip(state).map(|(a, b)| a * b).sum()).collect()
}

fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

/// The transformation matrices of an export give what the full model needs: forces on the interface, their resultant, the acceleration of
/// the centre of mass. All are products of states that obey the equations inside.
#[test]
fn transformation_matrices_are_those_of_the_full_model() {
    let all = "recovery = { nodes = { within = { box = { min = [0, 0, 0], max = [1, 1, 1] } } } }";
    let case = Case::writing("craig-bampton", foot_and_hub(), all);
    let to_matrices = ["export", &case.place.text("x.supel"), "--to", "matrix-market"];
    supel_testing::place::supel(&to_matrices).expect(ExitCode::Done);
    let of = |name: &str| exported(&case, &format!("x.{name}.mtx"));
    let [forces_of_a, forces_of_u, net_of_a, net_of_u] =
        ["ltm-acceleration", "ltm-displacement", "net-ltm-acceleration", "net-ltm-displacement"].map(of);
    let (of_centre, w) = (of("cg-atm"), of("recovery"));
    let file = case.place.superelement("x.supel");
    let n = file.n_coordinates();
    let (omega, u) = (file.tensors().frequencies[0], &file.tensors().rigid_body_modes);
    let mode: Vec<f64> = (0..n).map(|at| f64::from(u8::from(at + 5 == n))).collect();
    let swing: Vec<f64> = mode.iter().map(|q| -omega * omega * q).collect();
    let turn: Vec<f64> = (0..n).map(|row| u[(row, 4)] + 0.5 * u[(row, 0)]).collect();
    let statics = [any(15, 3), vec![0.0; n - 15]].concat();
    let rest = vec![0.0; n];
    let weight = case.model.total_mass(0);
    // The block is uniform.
    let centre = [0.5, 0.31 / 2.0, 0.23 / 2.0];
    for (q, a, obeys) in [(&mode, &swing, true), (&rest, &turn, false), (&statics, &rest, true)] {
        let (motion, acceleration) = (times(&w, q), times(&w, a));
        let inertial = multiply(&case.model.mass, &acceleration);
        let outer = sum(&multiply(&case.model.stiffness, &motion), &inertial);
        let found = sum(&times(&forces_of_u, q), &times(&forces_of_a, a));
        assert_eq!(found.len(), 15);
        if obeys {
            let at_foot: Vec<f64> = foot_rows(&case.model).iter().map(|row| outer[*row]).collect();
            // The residual of a mode, and that of static answers.
            let error = difference(&found[..9], &at_foot);
            assert!(error <= 1e-8, "{error:e}");
        }
        let net = sum(&times(&net_of_u, q), &times(&net_of_a, a));
        let size = largest(&found);
        let momentum = total(&case, &inertial);
        // Rounding of K, which lets rigid-body motion pass to 1e-12 of the forces inside.
        assert!(
            largest(&sum(&net, &momentum.iter().map(|m| -m).collect::<Vec<_>>())) <= 1e-9 * size,
            "{net:?} {momentum:?}"
        );
        // Forces over the mass, and about the centre.
        let found = times(&of_centre, a);
        for axis in 0..3 {
            assert!((found[axis] - momentum[axis] / weight).abs() <= 1e-9 * (1.0 + largest(&found)), "{found:?}");
        }
    }
    // A turn about y through the origin with a translation along x.
    let found = times(&of_centre, &turn);
    let wanted = [0.5 + centre[2], 0.0, -centre[0], 0.0, 1.0, 0.0];
    assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() <= 1e-11), "{found:?}");
}

/// At rest the interface carries the weight; in free fall it carries nothing.
#[test]
fn gravity_is_carried_by_the_interface() {
    let case = Case::new("herting");
    let (file, n) = (case.place.superelement("x.supel"), case.header().split(',').count());
    let u = &file.tensors().rigid_body_modes;
    let g = [0.5, -2.0, -9.81];
    case.table("q.csv", &case.header(), &[vec![0.0; n], vec![0.0; n]]);
    let falling = (0..n).map(|row| (0..3).map(|axis| g[axis] * u[(row, axis)]).sum()).collect();
    case.table("a.csv", &case.header(), &[vec![0.0; n], falling]);
    let more = ["--loads", "f.csv", "--acceleration", "a.csv", "--gravity=0.5,-2,-9.81"];
    case.recover(&more).expect(ExitCode::Done);
    let weight: Vec<f64> = g.map(|g| -g * case.model.total_mass(0)).into();
    let found = resultant(&case, 1, "");
    // Roundings of the mass, summed over the model.
    assert!(difference(&found[..3], &weight) <= 1e-12, "{found:?} for {weight:?}");
    assert!(largest(&nodal(&case, 2)) <= 1e-10 * largest(&weight), "{:?}", nodal(&case, 2));
    for wrong in ["--gravity=1,2", "--gravity=1,2,x", "--gravity=1,2,inf"] {
        let ended = case.recover(&["--loads", "f.csv", wrong]).expect(ExitCode::Usage);
        assert!(ended.err.contains("E-FLAG-TEXT"), "{}", ended.err);
    }
    case.recover(&["-o", "u.csv", "--gravity=1,2,3"]).expect(ExitCode::Usage);
}

/// Two free bodies: no direction is that of their motions, and it is said where loads of gravity are missing.
#[test]
fn several_bodies_have_no_loads_of_gravity() {
    let model = join(&steel_brick(), &translated(&steel_brick(), [3.0, 0.0, 0.0]), &[]);
    let case = Case { place: Place::with(&model), model };
    let case =
        case.reduced("herting", r#"{ name = "a", nodes = [1, 11, 31] }, { name = "b", nodes = [46, 56, 76] }"#, "");
    assert!(case.place.superelement("x.supel").tensors().gravity.is_none());
    let notes = case.place.report("x.report.json")["body"]["model"]["notes"].to_string();
    assert!(notes.contains("the model is 2 bodies: mass properties and loads of gravity"), "{notes}");
    let n = case.place.superelement("x.supel").n_coordinates();
    case.table("q.csv", &case.header(), &[vec![0.0; n]]);
    let said = case.recover(&["--loads", "f.csv", "--gravity=0,0,-9.81"]).expect(ExitCode::Usage).err;
    assert!(said.contains("E-NO-RECOVERY") && said.contains("a model of one free body"), "{said}");
    assert!(!said.contains("model.dofs"), "{said}");
}
