//! Exodus and CGNS, as far as the HDF5 library reads them.

#![cfg(feature = "hdf5")]

use supel::input::Faces;

use super::{faces, fixture, group, read};

/// Sets of nodes have the names of the file, and blocks their numbers.
#[test]
fn exodus_in_netcdf_4() {
    let path = fixture("mesh/box.e");
    let nodes = read(&path).expect("a mesh");
    assert_eq!(nodes.coordinates, read(&fixture("mesh/box22.msh")).expect("a mesh").coordinates);
    let z = |name: &str| nodes.groups[name].iter().map(|node| nodes.coordinates[*node][2]).collect::<Vec<_>>();
    assert_eq!((z("BOTTOM"), z("TOP")), (vec![0.0; 13], vec![1.0; 13]), "{:?}", nodes.groups.keys());
    assert_eq!((nodes.groups["block 0"].len(), nodes.groups["block 1"].len()), (26, 32));
    let Some(Faces::Unknown { reason }) = faces(&path, "TOP").expect("faces") else {
        panic!("kinds of elements are not read")
    };
    assert!(reason.contains("Exodus"), "{reason}");
}

/// Boundary conditions list nodes or elements; sections are groups of elements.
#[test]
fn cgns_in_hdf5() {
    let path = fixture("mesh/box.cgns");
    let nodes = read(&path).expect("a mesh");
    assert_eq!(nodes.coordinates, read(&fixture("mesh/box22.msh")).expect("a mesh").coordinates);
    let z = |name: &str| nodes.groups[name].iter().map(|node| nodes.coordinates[*node][2]).collect::<Vec<_>>();
    assert_eq!((z("BOTTOM"), z("TOP")), (vec![0.0; 13], vec![1.0; 13]), "{:?}", nodes.groups.keys());
    assert_eq!((group(&nodes, "Bricks").len(), group(&nodes, "Skin").len()), (32, 26));
    let Some(Faces::Known { faces: found, areas, .. }) = faces(&path, "BOTTOM").expect("faces") else {
        panic!("no faces")
    };
    // The coordinates of the file are right to 1e-11.
    assert!(found.len() == 2 && (areas.iter().sum::<f64>() - 6.0).abs() < 1e-10, "{found:?} {areas:?}");
}
