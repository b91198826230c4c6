//! The files that superelements of other programs come in: whichever it is, the answer is the same.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_testing::place::{Ended, Place, steel_brick, supel};

use super::superelement::{Foreign, certify, failed, interface};
use super::verdict;

/// `supel certify --json` of a superelement with these reduced matrices.
fn certified(place: &Place, [stiffness, mass]: [&str; 2]) -> Ended {
    let flags = ["--reduced-stiffness", stiffness, "--reduced-mass", mass];
    let paths = ["K.mtx", "M.mtx", "psi.mtx", "dofs.txt", "nodes.csv"].map(|name| place.text(name));
    let [k, m, psi, dofs, nodes] = &paths;
    supel(&[&["certify", k, m, psi, "--dofs", dofs, "--nodes", nodes, "--json"], flags.as_slice()].concat())
}

/// What is said of a superelement, without digests.
fn answer(place: &Place, files: [&str; 2]) -> Value {
    let mut found: Value = serde_json::from_str(&certified(place, files).expect(ExitCode::Done).out).expect("JSON");
    found["superelement"] = Value::Null;
    // Only matrices that name their rows are asked for the names.
    found["checks"].as_array_mut().expect("checks").retain(|check| check["id"] != "C-13");
    found
}

/// A coordinate in a file that names its rows: its number, its node and its degree of freedom.
pub(super) type Named = (usize, i64, u8);

/// Coordinates of a superelement whose last ones are the interface, in another order than that of its basis: nodes backwards, amplitudes as
/// scalar points of high numbers behind them.
pub(super) fn named(n_modes: usize) -> Vec<Named> {
    let model = steel_brick();
    let rows = interface();
    let mut of_interface: Vec<Named> = (0..rows.len())
        .map(|at| {
            let (node, direction) = model.dofs[rows[at]];
            (n_modes + at, node, direction + 1)
        })
        .collect();
    of_interface.sort_by_key(|(_, node, dof)| (-node, *dof));
    of_interface.into_iter().chain((0..n_modes).map(|at| (at, 9001 + at as i64, 1))).collect()
}

/// Whether a file names the nodes of its rows.
#[derive(PartialEq)]
enum Nodes {
    Named,
    Unnamed,
}

/// `*SUBSTRUCTURE MATRIX OUTPUT` of these coordinates, each with a node of its own, or without names.
fn user_element(foreign: &Foreign, order: &[Named], nodes: Nodes) -> String {
    let mut text = format!("**\n** GENERATION OF SUBSTRUCTURE\n*USER ELEMENT,NODES={:>11},LINEAR\n", order.len());
    if nodes == Nodes::Named {
        text += "** ELEMENT NODES\n";
        for line in order.chunks(10) {
            let nodes: Vec<String> = line.iter().map(|(_, node, _)| format!("{node:>10}")).collect();
            text += &format!("**{},\n", nodes.join(","));
        }
    }
    for (at, (_, _, dof)) in order.iter().enumerate() {
        text += &if at == 0 { format!("{dof:>10}\n") } else { format!("{:>10},{dof:>10}\n", at + 1) };
    }
    for (kind, matrix) in [("STIFFNESS", &foreign.stiffness), ("MASS", &foreign.mass)] {
        text += &format!("*MATRIX,TYPE={kind}\n");
        for j in 0..order.len() {
            let entry = |i: &Named| 0.5 * (matrix[(i.0, order[j].0)] + matrix[(order[j].0, i.0)]);
            let values: Vec<String> = order[..=j].iter().map(|i| format!("{:e},", entry(i))).collect();
            values.chunks(4).for_each(|line| text += &(line.concat() + "\n"));
        }
    }
    text
}

/// `*MATRIX OUTPUT, FORMAT=MATRIX INPUT`: a line for each pair of rows.
pub(super) fn labels(matrix: &faer::Mat<f64>, order: &[Named]) -> String {
    let mut text = String::new();
    for (at, (i, of_i, dof_i)) in order.iter().enumerate() {
        for (j, of_j, dof_j) in &order[..=at] {
            let value = 0.5 * (matrix[(*i, *j)] + matrix[(*j, *i)]);
            text += &format!("{of_i}, {dof_i}, {of_j}, {dof_j}, {value:e}\n");
        }
    }
    text
}

#[test]
fn text_files_of_abaqus_give_the_same_answer_in_any_order_of_rows() {
    let n_modes = 12;
    let foreign = Foreign::craig_bampton(&steel_brick(), &interface(), n_modes);
    let place = Place::with(&steel_brick());
    foreign.write(&place);
    let mut expected: Value =
        serde_json::from_str(&certify(&place, "--json").expect(ExitCode::Done).out).expect("JSON");
    expected["superelement"] = Value::Null;
    let order = named(n_modes);
    place.write("named.mtx", user_element(&foreign, &order, Nodes::Named).as_bytes());
    place.write("k.txt", labels(&foreign.stiffness, &order).as_bytes());
    place.write("m.txt", labels(&foreign.mass, &order).as_bytes());
    let named = place.text("named.mtx");
    let of_element = [named.clone() + ":STIFFNESS", named + ":MASS"];
    let of_lines = [place.text("k.txt"), place.text("m.txt")];
    // A line for each pair of rows does not say that it stands for both.
    for (files, mirrored) in [(of_element, &[][..]), (of_lines, &["k.txt: ", "m.txt: "])] {
        let mut found = answer(&place, [&files[0], &files[1]]);
        let notes = found["notes"].as_array_mut().expect("notes");
        let told = notes.pop().expect("a note").to_string();
        assert!(told.contains("12 rows of K̂ and M̂ were put to the columns"), "{told}");
        let of_files = notes.split_off(notes.len() - mirrored.len());
        for (note, file) in of_files.iter().zip(mirrored) {
            assert!(note.to_string().contains(file) && note.to_string().contains("it was mirrored"), "{note}");
        }
        assert_eq!(found, expected, "{files:?}");
    }
    let in_order: Vec<_> = (0..order.len()).map(|at| (at, 0, 1)).collect();
    place.write("unnamed.mtx", user_element(&foreign, &in_order, Nodes::Unnamed).as_bytes());
    let unnamed = place.text("unnamed.mtx");
    assert_eq!(answer(&place, [&(unnamed.clone() + ":stiffness"), &(unnamed + ":mass")]), expected);
}

/// Whoever joins the superelement by the names of its rows would join another node.
#[test]
fn rows_that_have_the_names_of_other_nodes_are_told() {
    let n_modes = 12;
    let foreign = Foreign::craig_bampton(&steel_brick(), &interface(), n_modes);
    let place = Place::with(&steel_brick());
    foreign.write(&place);
    let said = |name_of: &dyn Fn(i64) -> i64| -> Value {
        let order: Vec<Named> = named(n_modes).into_iter().map(|(at, node, dof)| (at, name_of(node), dof)).collect();
        place.write("k.txt", labels(&foreign.stiffness, &order).as_bytes());
        place.write("m.txt", labels(&foreign.mass, &order).as_bytes());
        serde_json::from_str(&certified(&place, [&place.text("k.txt"), &place.text("m.txt")]).out).expect("JSON")
    };
    let last = interface()[9];
    let (own, other) = (steel_brick().dofs[last].0, 20);
    assert_eq!(verdict(&said(&|node| node), "C-13"), Some("pass"));
    let found = failed(&said(&|node| if node == own { other } else { node }));
    let (_, worst) = found.iter().find(|(id, _)| id == "C-13").expect("C-13");
    assert!(worst.contains(&format!("node {own} ux")) && worst.contains(&format!("node {other} ux")), "{worst}");
    let found = failed(&said(&|node| if node < 9000 { node + 1 } else { node }));
    assert!(found.iter().any(|(id, _)| id == "C-13"), "all nodes by one: {found:?}");
    // A number that the model has not may be one of the superelement's own.
    let found = said(&|node| if node == own { 901 } else { node });
    assert_eq!(verdict(&found, "C-13"), Some("warn"), "{found}");
}

/// Abaqus numbers what it makes for itself down from −1: amplitudes are in the order in which a user element lists them, and away from zero
/// where lines have no order.
#[test]
fn amplitudes_of_negative_labels_keep_their_order() {
    let n_modes = 12;
    let foreign = Foreign::craig_bampton(&steel_brick(), &interface(), n_modes);
    let place = Place::with(&steel_brick());
    foreign.write(&place);
    let checks = |found: &Value| found["checks"].clone();
    let expected = checks(&serde_json::from_str(&certify(&place, "--json").expect(ExitCode::Done).out).expect("JSON"));
    let last = n_modes as i64;
    let labelled = |label: &dyn Fn(i64) -> i64| -> Vec<Named> {
        let renamed = named(n_modes).into_iter();
        renamed
            .map(|(at, node, dof)| if at < n_modes { (at, label(at as i64), dof) } else { (at, node, dof) })
            .collect()
    };
    for (name, order) in [("down.mtx", labelled(&|at| -1 - at)), ("up.mtx", labelled(&|at| at - last))] {
        place.write(name, user_element(&foreign, &order, Nodes::Named).as_bytes());
        let file = place.text(name);
        let found = answer(&place, [&(file.clone() + ":STIFFNESS"), &(file + ":MASS")]);
        assert_eq!(checks(&found), expected, "{name}");
    }
    let mut order = labelled(&|at| -1 - at);
    order.reverse();
    place.write("k.txt", labels(&foreign.stiffness, &order).as_bytes());
    place.write("m.txt", labels(&foreign.mass, &order).as_bytes());
    assert_eq!(checks(&answer(&place, [&place.text("k.txt"), &place.text("m.txt")])), expected);
}

/// K̂ and M̂ are symmetric as K and M are: one triangle stands for both where a file does not say so, and the answer tells.
#[test]
fn one_triangle_of_reduced_matrices_is_mirrored() {
    let foreign = Foreign::craig_bampton(&steel_brick(), &interface(), 12);
    let place = Place::with(&steel_brick());
    foreign.write(&place);
    let mut expected: Value =
        serde_json::from_str(&certify(&place, "--json").expect(ExitCode::Done).out).expect("JSON");
    expected["superelement"] = Value::Null;
    for (name, matrix) in [("k", &foreign.stiffness), ("m", &foreign.mass)] {
        let r = matrix.nrows();
        let value = |i: usize, j: usize| 0.5 * (matrix[(i, j)] + matrix[(j, i)]);
        let mut text = format!("%%MatrixMarket matrix coordinate real general\n{r} {r} {}\n", r * (r + 1) / 2);
        for (i, j) in (0..r).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            text += &format!("{} {} {:e}\n", i + 1, j + 1, value(i, j));
        }
        place.write(&format!("{name}.mtx"), text.as_bytes());
        let head = format!("{{'descr': '<f8', 'fortran_order': True, 'shape': ({r}, {r}), }}\n");
        let length = u16::try_from(head.len()).expect("short").to_le_bytes();
        let triangle = (0..r).flat_map(|j| (0..r).map(move |i| if i <= j { value(i, j) } else { 0.0 }));
        let bytes: Vec<u8> = triangle.flat_map(f64::to_le_bytes).collect();
        let array = [b"\x93NUMPY\x01\x00".as_slice(), &length, head.as_bytes(), &bytes].concat();
        place.write(&format!("{name}.npy"), &array);
    }
    for ending in ["mtx", "npy"] {
        let files = ["k", "m"].map(|name| format!("{name}.{ending}"));
        let mut found = answer(&place, [&place.text(&files[0]), &place.text(&files[1])]);
        let notes = found["notes"].as_array_mut().expect("notes");
        let told = notes.split_off(notes.len() - 2);
        for (note, file) in told.iter().zip(&files) {
            assert!(
                note.to_string().contains(&format!("{file}: only one triangle is given; it was mirrored")),
                "{note}"
            );
        }
        assert_eq!(found, expected, "{ending}");
    }
}

fn root(name: &str) -> String {
    format!("{}/fixtures/results/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// What Exudyn made of two nodes at each end of a free bar, by Hurty, Craig and Bampton, in the three forms that it saves.
#[cfg(feature = "hdf5")]
#[test]
fn a_superelement_of_exudyn_is_certified_in_every_form() {
    let [k, m] = ["stiffnessMatrix", "massMatrix"].map(|name| root(&format!("exudyn_free_bar.hdf5:/{name}")));
    let certified = |file: &str| {
        let [psi, khat, mhat] =
            ["modeBasis", "stiffnessMatrixReduced", "massMatrixReduced"].map(|name| format!("{file}{name}"));
        let args = ["certify", &k, &m, &psi, "--reduced-stiffness", &khat, "--reduced-mass", &mhat, "--json"];
        let mut found: Value = serde_json::from_str(&supel(&args).expect(ExitCode::Done).out).expect("JSON");
        found["superelement"] = Value::Null;
        found
    };
    let found = certified(&root("exudyn_part.hdf5:/"));
    assert_eq!((&found["n_coordinates"], &found["n_interface"]), (&20.into(), &12.into()), "{found}");
    assert_eq!(failed(&found), Vec::new(), "{found}");
    assert_eq!(certified(&root("exudyn_part.npz:")), found);
    assert_eq!(certified(&root("exudyn_part.npy:")), found);
}

#[test]
fn arrays_that_are_not_there_are_named() {
    let place = Place::with(&steel_brick());
    let [k, m] = ["K.mtx", "M.mtx"].map(|name| place.text(name));
    for (result, code, told) in [
        ("exudyn_part.npy:psi", "E-NO-SUCH-MATRIX", "modeBasis"),
        ("exudyn_part.npy:postProcessingModes", "E-MATRIX", "Python objects"),
        ("exudyn_part.npy:modeBasis", "E-MODES-ROWS", "351 rows"),
        ("exudyn_part.npz:modeBasis", "E-MODES-ROWS", "351 rows"),
        ("exudyn_part.npz:psi", "E-NO-SUCH-MATRIX", "modeBasis"),
        ("exudyn_part.npz", "E-MATRIX-AMBIGUOUS", "modeBasis"),
        ("exudyn_part.npz:postProcessingModes", "E-", "Python objects"),
    ] {
        let ended = supel(&["certify", &k, &m, &root(result)]).expect(ExitCode::InputData);
        assert!(ended.err.contains(code) && ended.err.contains(told), "{result}: {}", ended.err);
    }
}
