//! Rows of one direction, or of all rotations, under the labels of other nodes, where no rigid-body motion shows it.

use supel_models::model::{Assembler, Entry};
use supel_models::{Inertia, Material, Model, Section, SplitMix64, Wall, frame, shell};

use crate::faults::block;
use crate::place::{Place, supel};
use crate::table::{listed, said};

/// A bridge of beams, bent out of its plane: two chords of six nodes, and rungs between them.
fn ladder() -> Model {
    ladder_of(0.05)
}

fn ladder_of(bend: f64) -> Model {
    let nodes: Vec<[f64; 3]> =
        (0..12).map(|k| [f64::from(k / 2), 0.7 * f64::from(k % 2), bend * f64::from(k * k % 7)]).collect();
    let mut edges: Vec<[usize; 2]> = (0..10).map(|k| [k, k + 2]).collect();
    edges.extend((0..6).map(|k| [2 * k, 2 * k + 1]));
    let section = Section { second_moment_z: 3e-6, ..Section::round(0.03) };
    frame(&nodes, &edges, &section, &Material::STEEL_SI, Inertia::Consistent)
}

/// Half a tube of shells.
fn gutter() -> Model {
    let wall = Wall { material: Material::STEEL_SI, thickness: 0.02, drilling: 1e-3 };
    let angle = |x: f64| std::f64::consts::PI * x;
    shell([6, 4], |[x, y]| [angle(x).cos(), 2.0 * y, -angle(x).sin()], &wall)
}

/// The map with the labels of some directions, counted from one, changed.
fn relabelled(model: &Model, asked: impl Fn(u8) -> bool, label: impl Fn(i64, i64) -> i64) -> Model {
    let n = model.nodes.len() as i64;
    let of_row = |(node, direction): &(i64, u8)| match asked(*direction) {
        true => (label(*node, n), *direction),
        false => (*node, *direction),
    };
    Model { dofs: model.dofs.iter().map(of_row).collect(), ..model.clone() }
}

/// The mass with rows and columns of some directions where those of other nodes were.
fn with_mass_moved(model: &Model, asked: impl Fn(u8) -> bool, label: impl Fn(i64, i64) -> i64) -> Model {
    let moved = relabelled(model, asked, label);
    let place = |row: u32| model.dofs.iter().position(|dof| *dof == moved.dofs[row as usize]).expect("a row") as u32;
    let mut mass = Assembler::default();
    mass.extend(model.mass.iter().map(|&(row, col, value)| -> Entry { (place(row), place(col), value) }));
    Model { mass: mass.finish(), ..model.clone() }
}

fn is_rotation(direction: u8) -> bool {
    direction > 2
}

fn next(node: i64, n: i64) -> i64 {
    node % n + 1
}

fn backwards(node: i64, n: i64) -> i64 {
    n + 1 - node
}

fn exchanged(pair: [i64; 2]) -> impl Fn(i64, i64) -> i64 {
    move |node, _| match pair.iter().position(|other| *other == node) {
        Some(at) => pair[1 - at],
        None => node,
    }
}

/// What is said of a model, for two methods and ties.
#[track_caller]
fn assert_said(model: &Model, ends: [&[i64]; 2], expected: &str) {
    for coupling in ["interface", "rigid-interface"] {
        for method in ["herting", "craig-bampton"] {
            let place = Place::with(model);
            let [first, second] = ends.map(listed);
            let flags = format!("--{coupling} first={first} --{coupling} second={second} --modes 3 --method {method}");
            let ended = place.reduce(&place.model_flags(), &flags);
            let said = said(&place, &ended);
            assert!(said.split(", ").any(|code| code == expected), "{coupling}, {method}, {} rows: {said}", model.n);
        }
    }
}

#[test]
fn rotations_of_other_nodes() {
    let (ladder, gutter) = (ladder(), gutter());
    for (model, ends) in [(&ladder, [&[1, 2][..], &[11, 12]]), (&gutter, [&[1, 2, 3][..], &[33, 34, 35]])] {
        assert_said(model, ends, "verified");
        for label in [next, backwards] {
            assert_said(&relabelled(model, is_rotation, label), ends, "E-DIRECTION-ORDER");
        }
        // Of the second pair of the shell one has all neighbours of the other.
        for pair in [[1, 12], [1, 9], [4, 10]] {
            let some = relabelled(model, |direction| direction == 4, exchanged(pair));
            assert_said(&some, ends, "W-DIRECTION-ORDER");
        }
    }
}

/// The consistent mass of beams couples rotations with displacements.
#[test]
fn rotations_of_a_mass_at_other_nodes() {
    for label in [next, backwards] {
        assert_said(&with_mass_moved(&ladder(), is_rotation, label), [&[1, 2], &[11, 12]], "E-DIRECTION-ORDER");
    }
}

/// Nodes that have two coordinates in common may exchange the displacement along the third with no force under rigid-body motion.
#[test]
fn one_displacement_of_two_nodes() {
    let block = block();
    let ends = ["XMIN", "XMAX"].map(|name| &block.groups[name][..8]);
    for pair in [[1, 2], [9, 12], [30, 31]] {
        let [a, b] = pair.map(|label| block.nodes[label as usize - 1]);
        assert_eq!(a[1..], b[1..], "in line along x");
        let model = relabelled(&block, |direction| direction == 0, exchanged(pair));
        assert_said(&model, ends, "W-DIRECTION-ORDER");
    }
}

/// Springs between any directions, and levers of which one direction takes part, couple nodes in some of their directions alone.
#[test]
fn springs_and_levers_are_no_other_order() {
    for round in 0..6 {
        let ladder = ladder();
        let mut random = SplitMix64::new(round);
        let mut any = |n: usize| (random.uniform() * n as f64) as usize;
        let mut stiffness = Assembler::default();
        stiffness.extend(ladder.stiffness.iter().copied());
        for _ in 0..8 {
            let (i, j) = (any(ladder.n) as u32, any(ladder.n) as u32);
            let spring = [(i, i, 1e6), (j, j, 1e6), (i.min(j), i.max(j), -1e6)];
            stiffness.extend(spring.into_iter().filter(|_| i != j));
        }
        // u_y of one node follows that of another by its rotation about z.
        let (lever, arm) = ([any(12), any(12)], 1.3);
        let terms = [(6 * lever[0] + 1, 1.0), (6 * lever[1] + 1, -1.0), (6 * lever[1] + 5, -arm)];
        for (i, a) in terms {
            terms.iter().for_each(|(j, b)| stiffness.add(i as u32, *j as u32, 1e9 * a * b));
        }
        assert_silent(&Model { stiffness: stiffness.finish(), ..ladder });
    }
    // Of a flat one the beams couple ux with no uy: springs alone do, of two nodes that are neighbours of no third.
    let flat = ladder_of(0.0);
    let mut stiffness = Assembler::default();
    stiffness.extend(flat.stiffness.iter().copied());
    for (node, others) in [(1, [5, 12]), (3, [8, 11])] {
        for other in others {
            let (i, j) = (6 * (node - 1), 6 * (other - 1) + 1);
            stiffness.extend([(i, i, 1e6), (j, j, 1e6), (i, j, -1e6)]);
        }
    }
    assert_silent(&Model { stiffness: stiffness.finish(), ..flat });
}

#[track_caller]
fn assert_silent(model: &Model) {
    let place = Place::with(model);
    let [k, m, nodes, dofs] = ["K.mtx", "M.mtx", "nodes.csv", "dofs.txt"].map(|name| place.text(name));
    let ended = supel(&["doctor", &k, &m, "--nodes", &nodes, "--dofs", &dofs]);
    assert!(ended.out.contains("Findings"), "{}{}", ended.out, ended.err);
    assert!(!ended.out.contains("DIRECTION-ORDER"), "{}", ended.out);
}
