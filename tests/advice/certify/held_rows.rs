//! Rows that a program held in the matrices themselves: nothing of K but a diagonal entry, nothing of M.

use supel::cli::ExitCode;
use supel_models::Model;
use supel_models::transform::supported;
use supel_testing::place::{Place, assert_close, frequencies_hz, steel_brick, supel};

use super::strayed::held;
use super::{document, lowest, missing, of_kind, place_of};

/// A model whose rows of some nodes are held so, by diagonal entries of this size.
fn held_by_diagonal(model: &Model, is_held: impl Fn(i64) -> bool, diagonal: f64) -> Model {
    let is_free = |row: u32| !is_held(model.dofs[row as usize].0);
    let kept = |entries: &[(u32, u32, f64)]| -> Vec<(u32, u32, f64)> {
        entries.iter().copied().filter(|(i, j, _)| is_free(*i) && is_free(*j)).collect()
    };
    let mut stiffness = kept(&model.stiffness);
    stiffness.extend((0..model.n as u32).filter(|row| !is_free(*row)).map(|row| (row, row, diagonal)));
    stiffness.sort_by_key(|(i, j, _)| (*i, *j));
    Model { stiffness, mass: kept(&model.mass), ..model.clone() }
}

fn is_of_wall(label: i64) -> bool {
    label % 5 == 1
}

/// What nodes add to the answer is names: the rows are no bodies that could move.
#[test]
fn rows_held_by_a_diagonal_entry_move_nothing() {
    let (free, pairs, _) = held();
    for diagonal in [1.0, 1e9] {
        let model = held_by_diagonal(&free, is_of_wall, diagonal);
        let place = Place::with(&model);
        pairs.write(&place);
        let [dofs, nodes] = ["dofs.txt", "nodes.csv"].map(|name| place.text(name));
        for flags in [String::new(), format!("--dofs {dofs} --nodes {nodes}")] {
            let found = document(&place, &flags, ExitCode::Done);
            assert_eq!((&found["verdict"], &found["model"]["n_rigid"]), (&"pass".into(), &0.into()), "{found}");
            assert_eq!((of_kind(&found, "mode").len(), missing(&found).len()), (10, 0), "{found}");
            let notes = found["model"]["notes"].to_string();
            assert!(notes.contains("27 rows are held by a diagonal entry of K alone"), "{notes}");
        }
        let [k, m] = ["K.mtx", "M.mtx"].map(|name| place.text(name));
        supel(&["doctor", &k, &m]).expect(ExitCode::Done);
        supel(&["doctor", &k, &m, "--dofs", &dofs, "--nodes", &nodes]).expect(ExitCode::Done);
        for interface in ["--interface tip=5,15,45", "--rigid-interface tip=5,15,45"] {
            let flags = format!("{interface} --method craig-bampton --modes 4");
            place.reduce(&place.model_flags(), &flags).expect(ExitCode::Done);
            let found = frequencies_hz(&place.superelement("x.supel"));
            // The rows of the wall are taken out of this model.
            let without = Place::with(&supported(&free, |(label, _)| is_of_wall(label)));
            without.reduce(&without.model_flags(), &flags).expect(ExitCode::Done);
            assert_close(&found, &frequencies_hz(&without.superelement("x.supel")), 1e-8);
        }
    }
}

/// A single node of that kind next to a free body takes none of the body's motions and adds none.
#[test]
fn a_held_node_without_mass_leaves_a_body_free() {
    let pairs = lowest(&steel_brick(), 12);
    for diagonal in [1.0, 1e9] {
        let mut model = steel_brick();
        let (n, label) = (model.n as u32, 1 + model.labels.len() as i64);
        model.labels.push(label);
        model.nodes.push([2.0, 0.5, 0.25]);
        model.dofs.extend((0..3).map(|direction| (label, direction)));
        model.stiffness.extend((n..n + 3).map(|row| (row, row, diagonal)));
        model.n += 3;
        let mut longer = pairs.clone();
        longer.shapes.iter_mut().for_each(|shape| shape.extend([0.0; 3]));
        let place = place_of(&model, &longer);
        let [k, m, dofs, nodes] = ["K.mtx", "M.mtx", "dofs.txt", "nodes.csv"].map(|name| place.text(name));
        for flags in [String::new(), format!("--dofs {dofs} --nodes {nodes}")] {
            let found = document(&place, &flags, ExitCode::Done);
            assert_eq!((&found["model"]["n_rigid"], of_kind(&found, "rigid-body").len()), (&6.into(), 6), "{found}");
        }
        let text = supel(&["doctor", &k, &m, "--dofs", &dofs, "--nodes", &nodes]).out;
        assert!(!text.contains("E-RIGID-MASS") && !text.contains(" E-"), "{text}");
        place
            .reduce(&place.model_flags(), "--interface ends=1,5,41,45 --method craig-bampton --modes 4")
            .expect(ExitCode::Done);
    }
}
