//! Rows in frames that the map does not know, turned by however little, and supports that look like them.

use supel::coordinates;
use supel::error::Error;
use supel::input::{Digits, Input, MatrixInput};
use supel::job::Mechanisms;
use supel::model::{CoordinateFit, Model as Checked};
use supel_models::transform::{grounded, in_local_frames, join, rounded, supported};
use supel_models::{Assembler, Inertia, Material, Model, Section, SplitMix64, TetMesh, brick, frame, membrane};

use crate::chain::input;
use crate::faults::{block, clamped};
use crate::{Ties, compared};

/// Axes turned by an angle about a line that is no axis (Rodrigues).
pub(crate) fn axes_turned_by(angle: f64) -> [[f64; 3]; 3] {
    let [x, y, z] = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];
    let across = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let (sine, versine) = (angle.sin(), 2.0 * (angle / 2.0).sin().powi(2));
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let twice: f64 = (0..3).map(|k| across[i][k] * across[k][j]).sum();
            f64::from(u8::from(i == j)) + sine * across[i][j] + versine * twice
        })
    })
}

pub(crate) fn lumped(model: &Model) -> Model {
    let mut lumped = model.clone();
    lumped.mass.retain(|(row, col, _)| row == col);
    lumped
}

/// A frame of beams without order, six dofs a node.
fn beams() -> Model {
    let mut random = SplitMix64::new(11);
    let nodes: Vec<[f64; 3]> = (0..14).map(|_| std::array::from_fn(|_| random.uniform())).collect();
    let edges: Vec<[usize; 2]> = (1..14).map(|node| [node, node / 2]).chain([[13, 5], [9, 12]]).collect();
    frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, Inertia::Consistent)
}

/// The block clamped at an end across its longest side: nodes 28 and 68 are six and four elements away.
fn clamped_across() -> Model {
    let block = block();
    let wall = block.groups["XMIN"].clone();
    supported(&block, |(label, _)| wall.contains(&label))
}

fn tetrahedra() -> Model {
    let map = |[x, y, z]: [f64; 3]| [0.4 * x, 0.15 * y + 0.02 * x, 0.1 * z];
    TetMesh::structured([6, 1, 1], map, |_| true).assemble(&Material::STEEL_SI)
}

/// Its matrices in so many digits, as a file tells them.
pub(crate) fn with_digits(model: &Model, digits: u32) -> Input {
    let input = input(&rounded(model, digits as usize));
    let known = Digits { significant: digits, ..Digits::DOUBLE };
    let of = |matrix: MatrixInput| MatrixInput { digits: known, ..matrix };
    Input { stiffness: of(input.stiffness), mass: of(input.mass), ..input }
}

#[track_caller]
fn assert_names(model: &Input, nodes: &[i64], what: &str) {
    for ties in [Ties::All, Ties::None] {
        let found = Checked::new(model.clone()).and_then(|model| compared(model, ties)).map(|model| model.fit);
        let Err(Error::CoordinatesDoNotFit { found, .. }) = &found else { panic!("{what}: {found:?}") };
        assert!(found.contains("along axes of their own"), "{what}: {found}");
        for node in nodes {
            let is_named = found.split([',', ' ']).any(|word| word == node.to_string());
            assert!(is_named, "{what}: {found} does not name node {node}");
        }
    }
}

/// The fault is the frame, however small the angle and whatever the mass; of a component held elsewhere too.
#[test]
fn a_small_local_frame_is_refused_and_its_nodes_are_named() {
    for (name, sound, nodes) in [
        ("block", block(), [1, 41]),
        ("block with a lumped mass", lumped(&block()), [1, 41]),
        ("clamped block", clamped_across(), [28, 68]),
        ("clamped block with a lumped mass", lumped(&clamped_across()), [28, 68]),
        ("plate", brick([8, 6, 1], [0.5, 0.4, 0.006], &Material::STEEL_SI), [1, 60]),
        ("tetrahedra", tetrahedra(), [1, 20]),
        ("beams", beams(), [1, 10]),
        ("beams on a foot", supported(&beams(), |(label, _)| label == 14), [1, 9]),
    ] {
        for angle in [1e-3, 1e-2, 0.1, 1.0] {
            for chosen in [&nodes[..1], &nodes[1..], &nodes[..]] {
                let faulty = in_local_frames(&sound, &axes_turned_by(angle), |label| chosen.contains(&label));
                assert_names(&input(&faulty), chosen, &format!("{name}, {angle}, {chosen:?}"));
            }
        }
    }
}

/// Few digits leave forces at every node; those of the frame stand above them.
#[test]
fn local_frames_show_in_few_digits() {
    for (digits, angle) in [(12, 1e-4), (8, 1e-2), (6, 0.1)] {
        for sound in [block(), clamped_across(), lumped(&clamped_across())] {
            let faulty = in_local_frames(&sound, &axes_turned_by(angle), |label| label == 28);
            assert_names(&with_digits(&faulty, digits), &[28], &format!("{digits} digits, {angle}"));
        }
    }
}

/// Next to a wall that is at rest already when K is written a frame is one more support.
#[test]
fn a_local_frame_next_to_a_support_is_not_told_from_it() {
    let wall = block().groups["YMIN"].clone();
    let next_to = clamped().dofs[0].0;
    assert!(!wall.contains(&next_to));
    let faulty = in_local_frames(&lumped(&clamped()), &axes_turned_by(0.1), |label| label == next_to);
    let found = Checked::new(input(&faulty)).and_then(|model| compared(model, Ties::All));
    assert!(found.is_ok(), "{:?}", found.err());
}

/// Springs to the ground of any stiffness, at one node or at several, in one direction, in all or along no axis, at parts of other
/// materials: they hold something, and a frame does not.
#[test]
fn supports_of_any_stiffness_are_no_local_frames() {
    let soft = Material { young: 1e-4 * Material::STEEL_SI.young, ..Material::STEEL_SI };
    let welded = {
        let (steel, other) = (block(), brick([6, 3, 2], [1.2, 0.55, 0.31], &soft));
        let size = steel.nodes.last().expect("a node")[0];
        let seam = |model: &Model, x: f64| -> Vec<i64> {
            model
                .labels
                .iter()
                .copied()
                .filter(|label| (model.nodes[*label as usize - 1][0] - x).abs() < 1e-9)
                .collect()
        };
        let pairs: Vec<(i64, i64)> = seam(&steel, size).into_iter().zip(seam(&other, 0.0)).collect();
        join(&steel, &other, &pairs)
    };
    let mut random = SplitMix64::new(5);
    for (name, sound) in [
        ("block", block()),
        ("clamped block", clamped()),
        ("welded blocks", welded),
        ("beams", beams()),
        ("tetrahedra", tetrahedra()),
        ("plate", brick([8, 6, 1], [0.5, 0.4, 0.006], &Material::STEEL_SI)),
        ("membrane", membrane([6, 4], [3.0, 2.0], &Material::UNIT)),
    ] {
        let largest = sound.stiffness.iter().fold(0.0f64, |max, entry| max.max(entry.2));
        let displacements: Vec<usize> = (0..sound.n).filter(|row| sound.dofs[*row].1 < 3).collect();
        for exponent in [-11, -5, -2, 0, 10] {
            for n_springs in [1, 3, 7] {
                let mut held = sound.clone();
                for _ in 0..n_springs {
                    let row = displacements[random.below(displacements.len() as u64) as usize];
                    held = grounded(&held, row, largest * 10f64.powi(exponent) * (0.5 + random.uniform()));
                }
                // Along no axis: the whole model in a frame of its own but for the springs is a support askew.
                let is_flat = held.dofs.iter().all(|dof| dof.1 != 2);
                let askew = if is_flat { held.clone() } else { in_local_frames(&held, &axes_turned_by(0.7), |_| true) };
                for (how, model) in [("along axes", held), ("askew", askew)] {
                    let Ok(model) = Checked::new(input(&model)) else { continue };
                    let found = coordinates::compared(
                        model,
                        (&[], Mechanisms::default()),
                        &supel::partition::TiedNodes::default(),
                    );
                    let is_frame =
                        matches!(&found, Err(error) if error.to_string().contains("along axes of their own"));
                    assert!(!is_frame, "{name}, {n_springs} springs of 1e{exponent} {how}: {:?}", found.err());
                }
            }
        }
    }
}

/// A node that springs along x and z tie to a block and one along y to the ground: the block moves along y and leaves it behind, without a
/// force. What stays behind is in no frame of its own.
#[test]
fn a_node_left_behind_is_in_no_local_frame() {
    let mut model = block();
    let (host, k) = (model.dofs[0].0, 1e6);
    let row = model.n as u32;
    let row_of_host =
        |direction| model.dofs.iter().position(|dof| *dof == (host, direction)).expect("a row of the host") as u32;
    let tied = [(row_of_host(0), row), (row_of_host(2), row + 2)];
    model.labels.push(900);
    model.nodes.push(model.nodes[0]);
    model.dofs.extend([0, 1, 2].map(|direction| (900, direction)));
    model.n += 3;
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    stiffness.extend(model.stiffness.iter().copied());
    mass.extend(model.mass.iter().copied());
    for (i, j) in tied {
        [(i, i, k), (j, j, k), (i, j, -k)].into_iter().for_each(|(i, j, k)| stiffness.add(i, j, k));
    }
    stiffness.add(row + 1, row + 1, k);
    (row..row + 3).for_each(|row| mass.add(row, row, 1.0));
    let model = Model { stiffness: stiffness.finish(), mass: mass.finish(), ..model };
    let found = Checked::new(input(&model)).and_then(|model| compared(model, Ties::None));
    assert!(found.is_ok(), "{:?}", found.err());
}

/// An upright of a frame whose rows are along axes turned about it moves as a rigid body by its own coordinates, mirrored or turned: to K the
/// whole is a chain of links that something holds at the joint. Six motions without energy are those of a free component, unless the job
/// says that mechanisms are meant.
#[test]
fn an_upright_along_turned_axes_is_no_held_chain() {
    let nodes: Vec<[f64; 3]> =
        (0..6).map(|node| [if node < 3 { 0.0 } else { 1.0 }, 0.0, 0.5 * f64::from(node % 3)]).collect();
    let edges = [[0, 1], [1, 2], [3, 4], [4, 5], [1, 4]];
    let sound = frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, Inertia::Consistent);
    let tied = supel::partition::TiedNodes::default();
    for degrees in [180.0_f64, 90.0, 20.0, 3.0, 1.0, 0.1, 1e-3] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let axes = [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]];
        let faulty = in_local_frames(&sound, &axes, |label| label > 3);
        let settled = |mechanisms| {
            coordinates::compared(Checked::new(input(&faulty)).expect("a model"), (&[], mechanisms), &tied)
        };
        let Err(Error::CoordinatesDoNotFit { found, energy, expected, .. }) = settled(Mechanisms::Warn) else {
            panic!("{degrees}")
        };
        // What is said to be expected is not what was found.
        assert!(energy >= expected, "{degrees}: {found}: {energy} and {expected}");
        let is_told = found.contains("6 motions without energy") && found.contains("mechanisms");
        assert!(is_told || found.contains("nothing holds the body"), "{degrees}: {found}");
        assert!(settled(Mechanisms::Accept).is_ok(), "{degrees}");
    }
}

/// The node inside a block of eight elements is coupled with every other, and its axes make forces at all of them.
#[test]
fn a_local_frame_inside_a_small_block_is_named() {
    let sound = brick([2, 2, 2], [0.2, 0.3, 0.25], &Material::STEEL_SI);
    for (name, sound) in [("block", lumped(&sound)), ("block with a full mass", sound)] {
        for angle in [1e-4, 1e-3, 1e-2, 1.0] {
            let faulty = in_local_frames(&sound, &axes_turned_by(angle), |label| label == 14);
            assert_names(&input(&faulty), &[14], &format!("{name}, {angle}"));
        }
        // A spring at that node touches all of them too, and is a support.
        let row = sound.dofs.iter().position(|dof| *dof == (14, 0)).expect("a row");
        let held = grounded(&sound, row, 1e-3 * sound.stiffness.iter().fold(0.0f64, |max, entry| max.max(entry.2)));
        let found = Checked::new(input(&held)).and_then(|model| compared(model, Ties::All));
        assert!(found.is_ok(), "{name}: {:?}", found.err());
    }
}

/// Axes that are off by less than six digits tell are wrong for nobody: motions as a whole are those that K lets pass, and no mechanism. What
/// they cost may be less than rounding, and the forces are not.
#[test]
fn axes_off_by_rounding_are_mended() {
    let sound = brick([2, 2, 2], [0.2, 0.3, 0.25], &Material::STEEL_SI);
    for (label, angle) in [1, 2].into_iter().flat_map(|label| [5e-7, 8e-7].map(|angle| (label, angle))) {
        for sound in [lumped(&sound), sound.clone()] {
            let off = in_local_frames(&sound, &axes_turned_by(angle), |other| other == label);
            let found = Checked::new(input(&off)).and_then(|model| compared(model, Ties::None)).map(|model| model.fit);
            assert!(matches!(found, Ok(CoordinateFit::Rounded(_))), "node {label}, {angle}: {found:?}");
        }
    }
}
