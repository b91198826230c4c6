//! Meshes of Gmsh.

use supel::error::Error;
use supel::input::Faces;

use super::{faces, fixture, group, read, read_text, refused};

/// The box in all forms that Gmsh writes.
#[test]
fn every_form_has_the_nodes_groups_and_faces() {
    for name in ["mesh/box22.msh", "mesh/box22b.msh", "mesh/box41.msh", "mesh/box41b.msh"] {
        let path = fixture(name);
        let nodes = read(&path).expect("a mesh");
        assert_eq!(nodes.labels.len(), 32, "{name}");
        let names: Vec<&str> = nodes.groups.keys().map(String::as_str).collect();
        assert_eq!(names, ["BODY", "BOTTOM", "TOP and more", "curve 7"], "{name}");
        let z = |name: &str| nodes.groups[name].iter().map(|node| nodes.coordinates[*node][2]).collect::<Vec<_>>();
        assert_eq!((z("BOTTOM"), z("TOP and more")), (vec![0.0; 13], vec![1.0; 13]));
        assert_eq!((nodes.groups["BODY"].len(), group(&nodes, "curve 7")), (32, vec![1, 4, 16]));
        let Some(Faces::Known { faces: found, centroid, areas }) = faces(&path, "BOTTOM").expect("faces") else {
            panic!("no faces")
        };
        assert_eq!(found.len(), 2, "{name}");
        let area: f64 = areas.iter().sum();
        // The coordinates of the file are right to 1e-11.
        let off = [area - 6.0, centroid[0] - 1.5, centroid[1] - 1.0, centroid[2]];
        assert!(off.iter().all(|off| off.abs() < 1e-10), "{name}: {off:?}");
    }
}

/// A binary mesh of a machine that stores the high byte first.
#[test]
fn the_order_of_bytes_is_that_of_the_file() {
    let mut bytes = b"$MeshFormat\n2.2 1 8\n".to_vec();
    bytes.extend(1_i32.to_be_bytes());
    bytes.extend(b"\n$EndMeshFormat\n$Nodes\n2\n");
    for (label, x) in [(10, 0.25), (13, 8.0)] {
        bytes.extend(i32::to_be_bytes(label));
        [x, 2.0, -3.0].into_iter().for_each(|x: f64| bytes.extend(x.to_be_bytes()));
    }
    bytes.extend(b"\n$EndNodes\n$Elements\n1\n");
    [1, 1, 2, 7, 5, 5, 13, 10].into_iter().for_each(|number: i32| bytes.extend(number.to_be_bytes()));
    bytes.extend(b"\n$EndElements\n");
    let nodes = read_text("a.msh", bytes).expect("a mesh");
    assert_eq!(nodes.labels, [10, 13]);
    assert_eq!(nodes.coordinates, [[0.25, 2.0, -3.0], [8.0, 2.0, -3.0]]);
    assert_eq!(group(&nodes, "curve 5"), [10, 13]);
}

/// Cells of an order whose faces are not known count for groups.
#[test]
fn cells_of_high_order() {
    let nodes: String = (1..=10).map(|k| format!("{k} {k} {} 0\n", k * k)).collect();
    let mesh = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 3 \"CUBIC\"\n$EndPhysicalNames\n$Nodes\n10\n{nodes}$EndNodes\n\
         $Elements\n1\n1 21 2 3 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n"
    );
    let folder = super::Folder::new();
    let path = folder.write("a.msh", &mesh);
    assert_eq!(group(&read(&path).expect("a mesh"), "CUBIC").len(), 10);
    let Some(Faces::Unknown { reason }) = faces(&path, "CUBIC").expect("faces") else { panic!("faces of order three") };
    assert!(reason.contains("surfaces of 10 nodes"), "{reason}");
}

#[test]
fn wrong_meshes_are_refused_with_their_place() {
    let head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n";
    let cases = [
        ("$MeshFormat\n2.2 0\n$EndMeshFormat\n".to_owned(), 3, "`2.2 0`"),
        (format!("{head}1 1 0 0\n$EndNodes\n$Elements\n0\n$EndElements\n"), 10, "node 1 twice"),
        (format!("{head}2 1 0 x\n$EndNodes\n"), 7, "`x`"),
        (format!("{head}2 1 0 inf\n$EndNodes\n"), 7, "inf"),
        (format!("{head}2 1 0 0\n$EndNodes\n$Elements\n1\n1 1 0 1 3\n$EndElements\n"), 11, "node 3"),
        (format!("{head}2 1 0 0\n$EndNodes\n$Elements\n1\n1 999 0 1 3\n$EndElements\n"), 11, "elements of type 999"),
        (format!("{head}2 1 0 0\n"), 8, "the end of the file"),
    ];
    for (mesh, wanted, words) in cases {
        let error = refused("a.msh", &mesh);
        let Error::MeshText { line, .. } = error else { panic!("{error:?}") };
        assert!(line == wanted && error.to_string().contains(words), "{line}: {error}");
    }
    let commented = format!("\u{feff}$Comments\nhello $Nodes\n$EndComments\n{head}2 1 0 0\n$EndNodes\n");
    assert_eq!(read_text("a.msh", commented).expect("a mesh").labels, [1, 2]);
    let other = refused("a.msh", "$MeshFormat\n4 0 8\n$EndMeshFormat\n");
    assert!(other.to_string().contains("version 4 of the format"), "{other}");
    assert!(matches!(refused("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"), Error::NoData { .. }));
    let binary = [&b"$MeshFormat\n2.2 1 8\n"[..], &7_i32.to_le_bytes(), b"\n$EndMeshFormat\n"].concat();
    assert!(matches!(refused("a.msh", binary), Error::MeshBinary { offset: 24, .. }));
}
