//! Interfaces that a model cannot have.

use supel::dofs::Direction;
use supel::error::{Error, ErrorClass, Selector};
use supel::job::{Coupling, InterfaceJob, NodeSelection, Origin, Region};
use supel::partition::Partition;
use supel_models as models;
use supel_models::transform::supported;
use supel_models::{Ends, Material, brick, spring};

use crate::chain::{direct, interface, partition, rigid_group, rows};
use crate::{assert_says, refusal};

/// Labels 1 + i + 3 (j + 2 k) at (i, j, k).
fn beam() -> models::Model {
    brick([2, 1, 1], [2.0, 1.0, 1.0], &Material::UNIT)
}

fn anonymous() -> models::Model {
    models::Model { dofs: Vec::new(), ..beam() }
}

fn refused(model: &models::Model, interfaces: &[InterfaceJob]) -> Error {
    refusal(partition(model, interfaces))
}

fn patch(name: &str, labels: &[i64]) -> InterfaceJob {
    interface(name, NodeSelection::Labels(labels.to_vec()), Coupling::Rigid)
}

fn labels_of(partition: &Partition) -> Vec<Option<i64>> {
    partition.interface.iter().map(|node| node.label).collect()
}

/// Refused before any dense matrix of that size is made.
#[test]
fn interface_too_large_for_dense_matrices() {
    let rows_of = |n: usize| rows("all", &(0..n).collect::<Vec<_>>());
    let error = refused(&spring(20_002, Ends::Free), &[rows_of(20_001)]);
    assert!(matches!(error, Error::InterfaceTooLarge { n_interface: 20_001, limit: 20_000 }), "{error}");
    assert_says(&error, ErrorClass::InputData, &["20,001 dofs", "at most 20,000", "couple their patches rigidly"]);
}

#[test]
fn nodes_of_a_model_without_nodes() {
    for job in [direct("tip", &[1]), rigid_group("XMAX"), patch("tip", &[1])] {
        let name = job.name.clone();
        let error = refused(&anonymous(), &[job]);
        assert!(
            matches!(&error, Error::SelectionNeedsNodes { selector: Selector::Interface(found) } if *found == name),
            "{error}"
        );
        assert_says(&error, ErrorClass::InputData, &[&name, "give model.dofs and model.nodes"]);
    }
}

#[test]
fn rigid_patch_of_rows() {
    let job = InterfaceJob { coupling: Coupling::Rigid, ..rows("tip", &[0, 1, 2]) };
    let error = refused(&anonymous(), &[job]);
    assert!(matches!(&error, Error::RigidNeedsCoordinates { interface } if interface == "tip"), "{error}");
    assert_says(&error, ErrorClass::InputData, &["tip", "node table or mesh"]);
}

#[test]
fn rigid_patch_without_coordinates() {
    let mut input = crate::chain::input(&beam());
    input.nodes = None;
    let model = || supel::model::Model::new(input.clone()).expect("dofs without nodes");
    let error = refusal(Partition::new(model(), &[patch("hub", &[1, 2, 4])]));
    assert!(matches!(&error, Error::RigidNeedsCoordinates { interface } if interface == "hub"), "{error}");
    // The nodes' own dofs need no coordinates.
    let partition = Partition::new(model(), &[direct("hub", &[1, 2, 4])]).expect("direct nodes");
    assert_eq!((partition.n_interface(), partition.sites()), (9, None));
}

#[test]
fn group_that_the_mesh_lacks() {
    let error = refused(&beam(), &[rigid_group("HUB")]);
    assert!(
        matches!(&error, Error::UnknownGroup { group, known, .. } if group == "HUB" && known.len() == 6),
        "{error}"
    );
    assert_says(&error, ErrorClass::InputData, &["HUB", "XMAX, XMIN, YMAX", "name one of them"]);
}

#[test]
fn selection_without_nodes() {
    let nowhere = Region::Sphere { center: [10.0; 3], radius: 1.0 };
    for nodes in [NodeSelection::Region { within: nowhere }, NodeSelection::Labels(Vec::new())] {
        let error = refused(&beam(), &[interface("hub", nodes, Coupling::Direct)]);
        assert!(
            matches!(&error, Error::EmptyInterface { selector: Selector::Interface(found) } if found == "hub"),
            "{error}"
        );
        assert_says(&error, ErrorClass::InputData, &["hub", "check the list or the region"]);
    }
}

#[test]
fn node_without_rows() {
    let held = supported(&beam(), |(label, _)| label == 4);
    for (model, node) in [(&held, 4), (&beam(), 99)] {
        for job in [direct("tip", &[1, node]), patch("tip", &[1, 2, node])] {
            let error = refused(model, &[job]);
            assert!(matches!(error, Error::InterfaceNodeWithoutRows { node: found, .. } if found == node), "{error}");
            assert_says(&error, ErrorClass::InputData, &["tip", &format!("node {node}"), "constrained"]);
        }
    }
}

#[test]
fn rotation_of_a_solid_node() {
    let job = InterfaceJob { dofs: Some(vec![Direction::Ux, Direction::Ry]), ..direct("tip", &[5]) };
    let error = refused(&beam(), &[job]);
    assert!(
        matches!(&error, Error::DofMissing { dof, .. } if (dof.node, dof.direction) == (5, Direction::Ry)),
        "{error}"
    );
    assert_says(&error, ErrorClass::InputData, &["tip", "node 5 ry", "coupling = \"rigid\""]);
}

#[test]
fn row_beyond_the_matrices() {
    let error = refused(&spring(5, Ends::Free), &[rows("end", &[0, 5])]);
    assert!(matches!(error, Error::InterfaceRow { row: 5, n: 5, .. }), "{error}");
    assert_says(&error, ErrorClass::InputData, &["end", "row 5", "0 to 4"]);
}

#[test]
fn dof_with_two_owners() {
    let node_and_patch = [direct("tip", &[12]), rigid_group("XMAX")];
    let two_patches = [rigid_group("XMIN"), patch("corner", &[2, 5, 4])];
    for (jobs, dof) in [(&node_and_patch, "node 12 ux"), (&two_patches, "node 4 ux")] {
        let error = refused(&beam(), jobs);
        let Error::DofTwice { first, second, .. } = &error else { panic!("{error}") };
        assert_eq!((first, second), (&jobs[0].name, &jobs[1].name));
        assert_says(&error, ErrorClass::InputData, &[dof, "take it out of one"]);
    }
    let error = refused(&anonymous(), &[rows("a", &[3, 4]), rows("b", &[4])]);
    assert_says(&error, ErrorClass::InputData, &["row 4 (from zero) belongs", "\"a\"", "\"b\""]);
}

#[test]
fn patch_that_cannot_turn() {
    for (labels, rank) in [(vec![1], 3), (vec![1, 2], 5), (vec![1, 2, 3], 5)] {
        let error = refused(&beam(), &[patch("hub", &labels)]);
        let n_rows = 3 * labels.len();
        assert!(
            matches!(error, Error::PatchRank { n_rows: found, rank: r, expected: 6, .. } if found == n_rows && r == rank),
            "{error}"
        );
        assert_says(&error, ErrorClass::InputData, &["hub", &format!("only {rank} of 6"), "not in line"]);
    }
}

/// The bore of the bundled bracket has its axis along y, 112 above the ground; nodes in the middle of its length are closer together.
#[test]
fn origin_of_a_hole_and_of_a_sphere() {
    let bore = InterfaceJob { origin: Origin::Hole, ..rigid_group("EYE") };
    let bracket = models::bracket();
    let found = partition(&bracket, &[bore]).expect("a bore").interface[0].clone();
    let (place, fit) = (found.position.expect("a place"), found.fit.expect("a fit"));
    // Coordinates of a hundred, rounded as they were made.
    let rounding = 112.0 * 64.0 * f64::EPSILON;
    for (found, expected) in place.iter().zip([0.0, 0.0, 112.0]) {
        assert!((found - expected).abs() < rounding, "{place:?}");
    }
    assert!((fit.radius - 18.0).abs() < rounding && fit.residual < rounding, "{fit:?}");
    for (origin, shape) in [(Origin::Sphere, "sphere"), (Origin::Hole, "cylinder")] {
        // Four bolt holes lie on no cylinder and on no sphere.
        let error = refused(&bracket, &[InterfaceJob { origin, ..rigid_group("BASE") }]);
        assert!(matches!(&error, Error::OriginNotFitted { shape: found, .. } if *found == shape), "{error}");
        assert_says(&error, ErrorClass::InputData, &["BASE", shape, "or give them as numbers"]);
    }
}

#[test]
fn origin_of_faces_that_nobody_knows() {
    let job = InterfaceJob { origin: Origin::Area, ..rigid_group("XMAX") };
    let error = refused(&beam(), &[job]);
    assert!(
        matches!(&error, Error::PatchWithoutFaces { interface, key: "origin", .. } if interface == "XMAX"),
        "{error}"
    );
    assert_says(&error, ErrorClass::InputData, &["XMAX", "has no cells", "give such a mesh, or another `origin`"]);
}

/// A patch off its origin still follows; one on a line does not.
#[test]
fn patch_may_sit_off_its_origin() {
    let job = InterfaceJob { origin: Origin::Point([5.0, 5.0, 5.0]), ..rigid_group("XMAX") };
    let partition = partition(&beam(), &[job]).expect("a patch");
    assert_eq!(partition.interface[0].position, Some([5.0, 5.0, 5.0]));
    assert_eq!((partition.n_interface(), partition.n_internal), (6, 36 - 12));
    let line = InterfaceJob { origin: Origin::Point([5.0, 5.0, 5.0]), ..patch("line", &[1, 2, 3]) };
    assert!(matches!(refused(&beam(), &[line]), Error::PatchRank { rank: 5, .. }));
}

/// A dof of a patch that stays free to deform is named by its node.
#[test]
fn distortions_have_names() {
    let job = InterfaceJob { coupling: Coupling::Average, ..rigid_group("XMAX") };
    let partition = partition(&beam(), &[job]).expect("a patch");
    // Four nodes with twelve translations: six stand for the others, next to the mean motion.
    let names: Vec<String> = (0..partition.n_internal).map(|dof| partition.name_of(dof)).collect();
    assert_eq!((partition.n_internal, partition.n_interface()), (30, 6));
    assert_eq!(names.iter().filter(|name| name.ends_with(" in the patch of XMAX")).count(), 6, "{names:?}");
}

#[test]
fn lists_keep_their_order() {
    let partition = partition(&beam(), &[direct("b", &[7, 2]), direct("a", &[12])]).expect("nodes");
    assert_eq!(labels_of(&partition), [Some(7), Some(2), Some(12)]);
    let names: Vec<String> = (partition.n_internal..partition.n_dofs()).map(|dof| partition.name_of(dof)).collect();
    assert_eq!(names[..4], ["node 7 ux", "node 7 uy", "node 7 uz", "node 2 ux"]);
}

/// Directions left out of a node's own dofs stay internal; those listed come in the order of the classical six.
#[test]
fn listed_directions_of_a_node() {
    let job = InterfaceJob { dofs: Some(vec![Direction::Uz, Direction::Ux]), ..direct("tip", &[12]) };
    let partition = partition(&beam(), &[job]).expect("a node");
    assert_eq!((partition.n_interface(), partition.n_internal), (2, 34));
    assert_eq!(partition.interface[0].directions, [Direction::Ux, Direction::Uz]);
    assert_eq!(partition.name_of(34), "node 12 ux");
}

/// Directions left out of a rigid node stay degrees of freedom of the patch, as internal ones: condensing them out of the
/// full interface gives the interface of those listed.
#[test]
fn listed_directions_of_a_rigid_node() {
    use crate::chain::{Method, reduce};
    let listed = [Direction::Ux, Direction::Uy, Direction::Uz, Direction::Rx, Direction::Ry];
    let short = InterfaceJob { dofs: Some(listed.to_vec()), ..rigid_group("XMAX") };
    let all =
        reduce(&beam(), &[rigid_group("XMIN"), rigid_group("XMAX")], Method::CraigBampton, 2).expect("two patches");
    let some = reduce(&beam(), &[rigid_group("XMIN"), short], Method::CraigBampton, 2).expect("two patches");
    assert_eq!((all.partition.n_interface(), some.partition.n_interface()), (12, 11));
    assert_eq!((all.partition.n_internal, some.partition.n_internal), (12, 13));
    let (full, condensed) = (&all.constraint.stiffness, &some.constraint.stiffness);
    for i in 0..11 {
        for j in 0..11 {
            let expected = full[(i, j)] - full[(i, 11)] * full[(11, j)] / full[(11, 11)];
            let size = (full[(i, i)] * full[(j, j)]).sqrt();
            // Some 36 products a side of stiffnesses up to a hundred times the condensed ones.
            let error = (condensed[(i, j)] - expected).abs() / size;
            assert!(error <= 36.0 * 100.0 * f64::EPSILON, "({i}, {j}): {error:e}");
        }
    }
}
