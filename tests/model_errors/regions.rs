//! Regions, groups and lists that select the same nodes.

use supel::job::{Coupling, NodeSelection, Region};
use supel_models::transform::supported;
use supel_models::{Material, Model, brick};

use crate::chain::{interface, partition};

/// Nodes at whole coordinates 0 to 4, 0 to 2, 0 to 2; label 1 + i + 5 (j + 3 k).
fn block() -> Model {
    brick([4, 2, 2], [4.0, 2.0, 2.0], &Material::UNIT)
}

fn selected(model: &Model, nodes: NodeSelection) -> Vec<i64> {
    let partition = partition(model, &[interface("it", nodes, Coupling::Direct)]).expect("a selection");
    partition.interface.iter().filter_map(|node| node.label).collect()
}

fn within(region: Region) -> Vec<i64> {
    selected(&block(), NodeSelection::Region { within: region })
}

fn labels(at: impl Fn([f64; 3]) -> bool) -> Vec<i64> {
    let model = block();
    model.labels.iter().zip(&model.nodes).filter(|(_, x)| at(**x)).map(|(label, _)| *label).collect()
}

#[test]
fn box_with_its_border() {
    let found = within(Region::Box { min: [3.0, 0.0, 0.0], max: [4.0, 1.0, 2.0] });
    let expected = labels(|[x, y, _]| x >= 3.0 && y <= 1.0);
    assert_eq!((found.len(), found), (12, expected));
}

#[test]
fn plane_with_its_tolerance() {
    let slanted = Region::Plane { point: [2.0, 0.0, 0.0], normal: [2.0, 2.0, 0.0], tolerance: 1e-9 };
    assert_eq!(within(slanted), labels(|[x, y, _]| x + y == 2.0));
    let thick = Region::Plane { point: [2.0, 0.0, 0.0], normal: [2.0, 2.0, 0.0], tolerance: 0.72 };
    assert_eq!(within(thick), labels(|[x, y, _]| (x + y - 2.0).abs() <= 1.0));
}

#[test]
fn cylinder_and_its_shell() {
    let cylinder =
        |inner_radius| Region::Cylinder { from: [0.0, 1.0, 1.0], to: [2.0, 1.0, 1.0], radius: 1.1, inner_radius };
    assert_eq!(within(cylinder(0.0)), labels(|[x, y, z]| x <= 2.0 && (y - 1.0).abs() + (z - 1.0).abs() <= 1.0));
    assert_eq!(within(cylinder(0.9)), labels(|[x, y, z]| x <= 2.0 && (y - 1.0).abs() + (z - 1.0).abs() == 1.0));
}

#[test]
fn sphere_is_solid() {
    let ball = Region::Sphere { center: [2.0, 1.0, 1.0], radius: 1.0 };
    assert_eq!(within(ball), labels(|[x, y, z]| (x - 2.0).abs() + (y - 1.0).abs() + (z - 1.0).abs() <= 1.0));
}

/// A region takes the nodes that have rows; a list that names one without is refused elsewhere.
#[test]
fn region_passes_over_nodes_without_rows() {
    let held = supported(&block(), |(label, _)| label == 1);
    let face = Region::Plane { point: [0.0; 3], normal: [1.0, 0.0, 0.0], tolerance: 0.0 };
    let found = selected(&held, NodeSelection::Region { within: face });
    assert_eq!(found, labels(|[x, ..]| x == 0.0)[1..]);
}

#[test]
fn group_and_list_select_alike() {
    let by_group = selected(&block(), NodeSelection::Group("group:XMAX".to_owned()));
    let expected = labels(|[x, ..]| x == 4.0);
    assert_eq!(by_group, expected);
    assert_eq!(selected(&block(), NodeSelection::Labels(expected.clone())), expected);
}
