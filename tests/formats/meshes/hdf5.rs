//! Exodus and CGNS, as far as the HDF5 library reads them.

#![cfg(feature = "hdf5")]

use supel::error::Error;
use supel::input::Faces;
use supel::job::ModelJob;

use super::{Folder, faces, fixture, group, read};

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

/// Cells are compared with what K couples, and a note says where they are not. Of Exodus and `.hmf` their kinds are not read, and which
/// nodes each has is.
#[test]
fn cells_that_are_not_read_are_told() {
    let folder = Folder::new();
    let unit = |n: usize| (1..=n).map(|row| format!("{row} {row} 1.5\n")).collect::<String>();
    let structured = folder.0.path().join("structured.cgns");
    write_structured_zone(&structured);
    let of_file = |nodes: &std::path::Path| {
        let n = 3 * read(nodes).expect("a mesh").labels.len();
        let text = format!("%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {n}\n{}", unit(n));
        let [stiffness, mass] = ["K.mtx", "M.mtx"].map(|name| folder.write(name, text.as_bytes()));
        let model = ModelJob { stiffness, mass: Some(mass), nodes: Some(nodes.to_owned()), ..ModelJob::default() };
        let read = supel::input::read(&model).expect("a model");
        let notes: Vec<String> = read.notes.iter().map(ToString::to_string).collect();
        let is_told = notes.iter().any(|note| note.contains("its cells are not compared with the stiffness"));
        let mut cells: Vec<Vec<u32>> = Vec::new();
        for table in &read.cells {
            cells.extend(table.nodes.chunks_exact(table.n_nodes).map(|cell| sorted(cell.to_vec())));
        }
        cells.sort();
        (cells, is_told)
    };
    let expected = of_file(&fixture("mesh/box22.msh")).0;
    assert!(!expected.is_empty());
    for name in ["mesh/box22.msh", "mesh/box.e", "mesh/box.hmf"] {
        assert_eq!(of_file(&fixture(name)), (expected.clone(), false), "{name}");
    }
    assert_eq!(of_file(&structured), (Vec::new(), true));
}

fn sorted(mut nodes: Vec<u32>) -> Vec<u32> {
    nodes.sort_unstable();
    nodes
}

/// A zone of CGNS that states the sizes of a grid, of three axes, in place of elements.
fn write_structured_zone(path: &std::path::Path) {
    let file = hdf5_metno::File::create(path).expect("a file");
    let zone = file.create_group("Base").and_then(|base| base.create_group("Zone")).expect("a zone");
    let sizes = zone.new_dataset_builder().with_data(&[2_i32, 2, 2, 1, 1, 1, 0, 0, 0]);
    sizes.create(" data").expect("sizes");
    let places = zone.create_group("GridCoordinates").expect("a group");
    for (axis, name) in ["CoordinateX", "CoordinateY", "CoordinateZ"].iter().enumerate() {
        let values: Vec<f64> = (0..8).map(|node| f64::from(node >> axis & 1)).collect();
        let group = places.create_group(name).expect("a group");
        group.new_dataset_builder().with_data(&values).create(" data").expect("places");
    }
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

/// Faces may be given by the elements that they belong to, which is told and not taken for damage.
#[test]
fn faces_of_cgns_by_their_parents_alone() {
    let folder = Folder::new();
    let path = folder.write("parents.cgns", std::fs::read(fixture("mesh/box.cgns")).expect("a fixture"));
    let file = hdf5_metno::File::open_rw(&path).expect("HDF5");
    let base = file
        .groups()
        .expect("groups")
        .into_iter()
        .find(|group| !group.groups().expect("groups").is_empty())
        .expect("a base");
    let zone =
        base.groups().expect("groups").into_iter().find(|zone| zone.link_exists("GridCoordinates")).expect("a zone");
    let skin = zone.group("Skin").expect("a section");
    let nodes = skin.dataset("ElementConnectivity/ data").expect("nodes");
    let zeros = vec![0i32; nodes.size()];
    skin.group("ElementConnectivity").expect("a group").unlink(" data").expect("unlinked");
    skin.new_dataset::<i32>()
        .shape(zeros.len())
        .create("ElementConnectivity/ data")
        .expect("a dataset")
        .write_raw(&zeros)
        .expect("written");
    drop((nodes, skin.create_group("ParentElements").expect("a group"), skin, zone, base, file));
    let refused = read(&path).expect_err("a refusal");
    assert!(matches!(refused, Error::MeshUnsupported { .. }), "{refused:?}");
    let said = refused.to_string();
    assert!(said.contains("ParentElements") && said.contains("Skin") && said.contains("write them into"), "{said}");
}
