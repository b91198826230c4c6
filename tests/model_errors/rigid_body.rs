//! Rigid-body modes: how many there are, what forbids them, and whether the interface can react them.

use supel::error::{Error, ErrorClass};
use supel::rigid::{self, RigidSource};
use supel_models as models;
use supel_models::transform::{carrying, grounded, join, scaled, supported, translated};
use supel_models::{Ends, Inertia, Material, Section, brick, frame, membrane, spring};

use crate::cases::hinged;
use crate::chain::{direct, rigid_of, rows};
use crate::{assert_says, refusal};

fn block() -> models::Model {
    brick([3, 2, 2], [3.0, 2.0, 2.0], &Material::UNIT)
}

fn count(model: &models::Model, labels: &[i64]) -> usize {
    rigid_of(model, &[direct("pins", labels)]).expect("rigid-body modes").1.count()
}

#[test]
fn counts_are_found_not_assumed() {
    let pair = join(&block(), &block(), &[]);
    let (_, of_pair) = rigid_of(&pair, &[direct("pins", &[3, 40])]).expect("rigid-body modes");
    assert_eq!(of_pair.count(), 12, "two disjoint blocks, held on both");
    let straight = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    let axial = frame(&straight, &[[0, 1], [1, 2]], &Section::round(0.1), &Material::UNIT, Inertia::Consistent);
    for (name, model, expected) in [
        ("free block", block(), 6),
        ("free membrane, in its plane", membrane([3, 2], [3.0, 2.0], &Material::UNIT), 3),
        ("free chain along x", spring(5, Ends::Free), 1),
        ("held chain", spring(5, Ends::Fixed), 0),
        ("free straight beam", axial, 6),
        ("block on a spherical joint", supported(&block(), |(label, _)| label == 1), 3),
        ("block on a hinge", supported(&block(), |(label, _)| label == 1 || label == 2), 1),
        ("block on a face", supported(&block(), |(label, _)| label % 4 == 1), 0),
        ("block on one spring", grounded(&block(), 0, 1e-3), 5),
    ] {
        assert_eq!(count(&model, &[3]), expected, "{name}");
    }
}

/// A hinge adds a zero mode that is not a rigid-body motion: coordinates give six, the matrices seven.
#[test]
fn hinged_pair_has_a_seventh_zero_mode() {
    let model = hinged();
    assert_eq!(count(&model, &[1]), 6);
    let anonymous = models::Model { dofs: Vec::new(), ..model };
    let (_, rigid) = rigid_of(&anonymous, &[rows("pins", &[0])]).expect("zero modes");
    assert_eq!((rigid.source, rigid.count()), (RigidSource::Algebraic, 7));
}

#[test]
fn matrices_alone_count_alike() {
    let pair = || spring(2, Ends::Free);
    for (name, model, expected) in [
        ("free block", block(), 6),
        ("two disjoint blocks", join(&block(), &block(), &[]), 12),
        ("two hundred pairs of masses", (1..200).fold(pair(), |pairs, _| join(&pairs, &pair(), &[])), 200),
        ("membrane", membrane([3, 2], [3.0, 2.0], &Material::UNIT), 3),
        ("held chain", spring(8, Ends::Fixed), 0),
        ("free chain", spring(8, Ends::Free), 1),
    ] {
        let anonymous = models::Model { dofs: Vec::new(), ..model };
        let (_, rigid) = rigid_of(&anonymous, &[rows("first", &[0])]).expect(name);
        assert_eq!(rigid.count(), expected, "{name}");
    }
}

fn coordinates_refused(model: &models::Model) -> Error {
    refusal(rigid_of(model, &[direct("pins", &[1])]))
}

#[test]
fn coordinates_with_axes_exchanged() {
    let model = block();
    let nodes = model.nodes.iter().map(|[x, y, z]| [*y, *x, *z]).collect();
    let error = coordinates_refused(&models::Model { nodes, ..model });
    assert!(matches!(error, Error::CoordinatesDoNotFit { energy, .. } if energy > 1e-3), "{error}");
    assert_says(&error, ErrorClass::InputData, &["coordinates", "node ", "check units, axes"]);
}

/// One node of sixty, moved by a hundredth of an edge, is found and named: the force is largest there or at a neighbour.
#[test]
fn one_node_out_of_place() {
    let mut model = brick([4, 3, 2], [4.0, 3.0, 2.0], &Material::UNIT);
    model.nodes[17][1] += 0.01;
    let error = coordinates_refused(&model);
    let Error::CoordinatesDoNotFit { energy, expected, ref dof, .. } = error else { panic!("{error}") };
    assert!(energy > 1e4 * expected, "{energy:e} of {expected:e}");
    assert_says(&error, ErrorClass::InputData, &["node 18 u", "rotation about"]);
    assert!(dof.starts_with("node 18 "), "{dof}");
}

/// Coordinates of seven digits are what many programs write: they are taken.
#[test]
fn rounded_coordinates_are_taken() {
    let mut model = brick([4, 3, 2], [4.0, 3.0, 2.0].map(|size| size / 7.0), &Material::UNIT);
    for value in model.nodes.iter_mut().flatten() {
        *value = format!("{value:.6e}").parse().expect("a number");
    }
    assert_eq!(count(&model, &[1]), 6);
}

#[test]
fn rigid_motion_of_negative_energy() {
    let error = coordinates_refused(&grounded(&block(), 4, -1e-3));
    assert!(matches!(error, Error::NegativeRigidEnergy { energy, noise, .. } if energy < -1e3 * noise), "{error}");
    assert_says(&error, ErrorClass::ModelPhysics, &["negative energy", "check preload"]);
}

#[test]
fn rigid_motion_without_mass() {
    let massless = join(&block(), &scaled(&brick([1, 1, 1], [1.0; 3], &Material::UNIT), 1.0, 0.0), &[]);
    let error = coordinates_refused(&massless);
    assert!(matches!(error, Error::MasslessRigidMotion { relative_mass: 0.0 }), "{error}");
    assert_says(&error, ErrorClass::ModelPhysics, &["moves no mass", "give the massless part"]);
}

/// A straight beam of lumped masses turns about its axis without inertia: five motions have mass, six are free.
#[test]
fn rotation_without_inertia_is_kept_apart() {
    let nodes = [[0.0; 3], [1.0, 2.0, 0.5], [2.0, 4.0, 1.0]];
    let section = Section::round(0.1);
    let spinning = frame(&nodes, &[[0, 1], [1, 2]], &section, &Material::UNIT, Inertia::LumpedTranslations);
    let (_, rigid) = rigid_of(&spinning, &[direct("pin", &[1])]).expect("rigid-body modes");
    assert_eq!((rigid.count(), rigid.n_massless, rigid.massive().ncols()), (6, 1, 5));
}

/// Two beams whose mass resists nothing but their motion against each other: what they do together has no mass, and six motions have.
#[test]
fn common_motion_of_bodies_without_mass_of_their_own_is_kept_apart() {
    let beam =
        frame(&[[0.0; 3], [1.0, 2.0, 0.5]], &[[0, 1]], &Section::round(0.1), &Material::UNIT, Inertia::Consistent);
    let n = beam.n as u32;
    // The second moves as far as the first, which cancels to the last bit, or farther, which leaves roundings.
    for share in [1.0, 0.3] {
        let mut pair = join(&beam, &scaled(&beam, 1.0, share * share), &[]);
        let between = beam.mass.iter().flat_map(|&(i, j, m)| [(i, j + n, -share * m), (i + n, j, -share * m)]);
        pair.mass.extend(between.collect::<Vec<_>>());
        pair.mass.sort_by_key(|&(i, j, _)| (i, j));
        let (partition, rigid) = rigid_of(&pair, &[direct("pins", &[1, 3])]).expect("rigid-body modes");
        assert_eq!((rigid.count(), rigid.n_massless, rigid.massive().ncols()), (12, 6, 6), "{share}");
        let momenta = supel::sparse::product(&partition.mass, rigid.massless());
        // Of 12 terms each, which cancel; scaled masses and motions are of order one.
        assert!(momenta.norm_max() <= 1e-13 * rigid.massless().norm_max(), "{share}: {:e}", momenta.norm_max());
    }
}

/// Coordinates of seven digits are mended by the zero modes of K: of each body by its own mass, whatever mass couples it with others.
#[test]
fn rounded_coordinates_of_bodies_that_carry_one_device_are_mended() {
    let part = brick([4, 3, 2], [4.0, 3.0, 2.0].map(|size| size / 7.0), &Material::UNIT);
    let pair = join(&part, &translated(&part, [1.0, 0.0, 0.0]), &[]);
    let offset = part.labels.len() as i64;
    // Ten times as heavy as both.
    let mut model = carrying(&pair, &[5, 10, offset + 1, offset + 6], 10.0 * pair.total_mass(0));
    for value in model.nodes.iter_mut().flatten() {
        *value = format!("{value:.6e}").parse().expect("a number");
    }
    let (_, rigid) = rigid_of(&model, &[direct("pins", &[1, offset + 1])]).expect("rigid-body modes");
    assert_eq!(rigid.count(), 12);
    // Seven digits of coordinates alone leave a residual of 10⁻⁷.
    assert!(rigid.energy.largest_residual < 1e-12, "{:e}", rigid.energy.largest_residual);
}

fn rank_refused(model: &models::Model, labels: &[i64]) -> (usize, usize, String) {
    let (partition, rigid) = rigid_of(model, &[direct("pins", labels)]).expect("rigid-body modes");
    let error = refusal(rigid::interface_rank(&partition, &rigid));
    assert_says(&error, ErrorClass::ModelPhysics, &["add interface nodes", "rotations"]);
    match error {
        Error::InterfaceRank { rank, n_rigid, motion, .. } => (rank, n_rigid, motion),
        other => panic!("{other}"),
    }
}

/// One node of three dofs leaves the rotations about it; the axis named passes through it.
#[test]
fn one_solid_node_reacts_no_rotation() {
    let model = block();
    let (rank, n_rigid, motion) = rank_refused(&model, &[7]);
    assert_eq!((rank, n_rigid), (3, 6));
    let (point, axis) = axis_of(&motion);
    assert!(distance(model.nodes[6], point, axis) < 1e-3, "{motion}");
}

/// Two nodes leave the rotation about the line through both, and the message names that line.
#[test]
fn two_solid_nodes_leave_the_axis_through_both() {
    let model = translated(&block(), [0.5, -2.0, 7.0]);
    let (first, second) = (2, 31);
    let (rank, n_rigid, motion) = rank_refused(&model, &[first, second]);
    assert_eq!((rank, n_rigid), (5, 6));
    let (point, axis) = axis_of(&motion);
    for label in [first, second] {
        // Four decimals are shown.
        assert!(distance(model.nodes[label as usize - 1], point, axis) < 2e-3, "{motion}");
    }
}

#[test]
fn body_without_interface_floats() {
    let model = join(&block(), &translated(&block(), [10.0, 0.0, 0.0]), &[]);
    let error = coordinates_refused(&model);
    assert!(matches!(error, Error::FloatingBody { n_floating: 1, n_bodies: 2, .. }), "{error}");
    assert_says(&error, ErrorClass::ModelPhysics, &["1 of the 2 bodies", "node ", "add an interface node there"]);
}

/// Without coordinates the rank is known, the motion has no words.
#[test]
fn rank_without_coordinates() {
    let anonymous = models::Model { dofs: Vec::new(), ..block() };
    let (partition, rigid) = rigid_of(&anonymous, &[rows("pin", &[0, 1, 2])]).expect("zero modes");
    let error = refusal(rigid::interface_rank(&partition, &rigid));
    assert!(matches!(&error, Error::InterfaceRank { rank: 3, n_rigid: 6, motion, .. } if motion.is_empty()), "{error}");
    assert_says(&error, ErrorClass::ModelPhysics, &["add rows to the interface that these motions move"]);
}

/// The point and the direction in `rotation about the axis through (x, y, z) along (a, b, c)`.
fn axis_of(motion: &str) -> ([f64; 3], [f64; 3]) {
    assert!(motion.starts_with("; free: rotation about the axis through ("), "{motion}");
    let numbers: Vec<f64> = motion.split(['(', ')', ',']).filter_map(|field| field.trim().parse().ok()).collect();
    let [x, y, z, a, b, c] = numbers[..] else { panic!("six numbers in {motion}") };
    ([x, y, z], [a, b, c])
}

/// Distance of a point from an axis of unit direction.
fn distance(x: [f64; 3], point: [f64; 3], axis: [f64; 3]) -> f64 {
    let r: [f64; 3] = std::array::from_fn(|i| x[i] - point[i]);
    let along: f64 = (0..3).map(|i| r[i] * axis[i]).sum();
    (0..3).map(|i| (r[i] - along * axis[i]).powi(2)).sum::<f64>().sqrt()
}

/// A negative spring against the rotation of one node, a billionth of what the node has: no force under translation shows it, and the cost of
/// a rotation that is below zero is not that of rounded coordinates.
#[test]
fn a_negative_spring_is_not_rounding_of_coordinates() {
    let n = 40;
    let place = |i: usize| if i <= 20 { [i as f64, 0.0, 0.0] } else { [20.0, (i - 20) as f64, 0.0] };
    let nodes: Vec<[f64; 3]> = (0..=n).map(place).collect();
    let edges: Vec<[usize; 2]> = (0..n).map(|i| [i, i + 1]).collect();
    let bent = frame(&nodes, &edges, &Section::round(0.1), &Material::UNIT, Inertia::Consistent);
    let row = bent.dofs.iter().position(|dof| *dof == (8, 5)).expect("node 8 rz");
    let own = bent.stiffness.iter().find(|(i, j, _)| (*i, *j) == (row as u32, row as u32)).expect("its stiffness").2;
    for share in [1e-9, 1e-8] {
        let error = coordinates_refused(&grounded(&bent, row, -share * own));
        assert!(matches!(error, Error::NegativeRigidEnergy { count: 1, .. }), "{share}: {error}");
        assert_says(&error, ErrorClass::ModelPhysics, &["negative energy", "node 8 rz", "negative springs"]);
    }
}
