//! Meshes of VTK, and groups from whole numbers at points and cells as meshio writes them.

use supel::error::Error;
use supel::input::Faces;

use super::{faces, fixture, group, read, read_text, refused};

/// One box in all forms: its bottom and top are sets of points, its cells carry the number of a part, and some a set.
#[test]
fn every_form_has_the_points_groups_and_faces() {
    let mut files = vec!["box.vtk", "box-text.vtk", "box42.vtk", "box.vtu", "box-text.vtu", "box-raw.vtu"];
    if cfg!(feature = "hdf5") {
        files.extend(["box.vtkhdf", "box.hmf", "box.xdmf"]);
    }
    let expected = read(&fixture("mesh/box22.msh")).expect("a mesh").coordinates;
    for name in files {
        let path = fixture(&format!("mesh/{name}"));
        let nodes = read(&path).unwrap_or_else(|error| panic!("{error}"));
        for (found, expected) in nodes.coordinates.iter().flatten().zip(expected.iter().flatten()) {
            // meshio writes twelve digits into XML in text, and all of them elsewhere.
            let digits = if name == "box-text.vtu" { 5e-12 * expected.abs() } else { 0.0 };
            assert!((found - expected).abs() <= digits, "{name}: {found} {expected}");
        }
        assert_eq!(nodes.labels, (1..=32).collect::<Vec<i64>>(), "{name}");
        let z = |name: &str| nodes.groups[name].iter().map(|node| nodes.coordinates[*node][2]).collect::<Vec<_>>();
        assert_eq!((z("BOTTOM"), z("TOP")), (vec![0.0; 13], vec![1.0; 13]), "{name}");
        assert!(!nodes.groups.contains_key("BOTTOM-TOP"), "{name}: what belongs to no set is none");
        if !matches!(name, "box-raw.vtu" | "box.xdmf") {
            assert_eq!((nodes.groups["part 3"].len(), nodes.groups["part 5"].len()), (26, 32), "{name}");
        }
        if !matches!(name, "box-raw.vtu" | "box.vtkhdf" | "box.xdmf") {
            assert_eq!(
                (group(&nodes, "LOW"), group(&nodes, "HIGH")),
                (group(&nodes, "BOTTOM"), group(&nodes, "TOP")),
                "{name}"
            );
        }
        match faces(&path, "BOTTOM").expect("faces") {
            Some(Faces::Known { faces: found, areas, .. }) => {
                // The coordinates of the file are right to 1e-11.
                assert!(
                    found.len() == 2 && (areas.iter().sum::<f64>() - 6.0).abs() < 1e-10,
                    "{name}: {found:?} {areas:?}"
                );
            }
            other => assert!(name == "box.hmf", "{name}: {other:?}"),
        }
    }
}

/// Several pieces count as one mesh, and a mark that only some of them have is none.
#[test]
fn pieces_are_put_together() {
    let piece = |x: f64, marks: &str| {
        format!(
            "<Piece NumberOfPoints=\"2\" NumberOfCells=\"1\"><PointData>{marks}</PointData>\
             <Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">{x} 0 0 {x} 1 0</DataArray></Points>\
             <Cells><DataArray type=\"Int32\" Name=\"connectivity\">0 1</DataArray><DataArray type=\"Int32\" Name=\"offsets\">2</DataArray>\
             <DataArray type=\"UInt8\" Name=\"types\">3</DataArray></Cells></Piece>"
        )
    };
    let both = |tags: &str| format!("<DataArray type=\"Int8\" Name=\"side\">{tags}</DataArray>");
    let odd = "<DataArray type=\"Int8\" Name=\"odd\">1 1</DataArray>";
    let grid = format!(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>{}{}</UnstructuredGrid></VTKFile>",
        piece(0.0, &(both("7 8") + odd)),
        piece(1.0, &both("8 8"))
    );
    let nodes = read_text("a.vtu", grid).expect("a mesh");
    assert_eq!(nodes.coordinates, [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
    let groups: Vec<&str> = nodes.groups.keys().map(String::as_str).collect();
    assert_eq!((groups, group(&nodes, "side 8")), (vec!["side 7", "side 8"], vec![2, 3, 4]));
}

#[test]
fn wrong_grids_are_refused() {
    let head = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 2 float\n0 0 0 1 0 0\n";
    let cases = [
        (format!("{head}CELLS 1 3\n2 0 2\nCELL_TYPES 1\n3\n"), "the point 2 in a cell"),
        (format!("{head}CELLS 1 3\n9 0 1\nCELL_TYPES 1\n3\n"), "a cell of 9 points"),
        (format!("{head}CELLS 1 3\n2 0 1\nCELL_TYPES 2\n3 3\n"), "1 offsets for 2 cells"),
        (format!("{head}CELLS 1 99999999999\n2 0 1\n"), "the end of the file"),
        (format!("{head}HELLO\n"), "`HELLO`"),
        (
            "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 float\n0 nan 0\n".to_owned(),
            "finite",
        ),
    ];
    for (grid, words) in cases {
        let error = refused("a.vtk", &grid);
        assert!(matches!(error, Error::MeshText { .. }) && error.to_string().contains(words), "{error}");
    }
    let other = refused("a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n");
    assert!(matches!(other, Error::DeckUnsupported { line: 4, .. }), "{other:?}");
    let array = |text: &str, attributes: &str| {
        format!(
            "<VTKFile type=\"UnstructuredGrid\" compressor=\"{attributes}\"><UnstructuredGrid><Piece><Points>\
             <DataArray type=\"Float64\" format=\"binary\">{text}</DataArray></Points></Piece></UnstructuredGrid></VTKFile>"
        )
    };
    let cases = [
        (array("////////AAAA", "vtkZLibDataCompressor"), "4294967295 blocks"),
        (array("AQAAAACAAAAIAAAABAAAAA==AAAAAA==", "vtkLZ4DataCompressor"), "the compressor vtkLZ4DataCompressor"),
        (array("AQAAAACAAAAIAAAABAAAAA==AAAAAA==", "vtkZLibDataCompressor"), "packed data that are damaged"),
        (array("!", "vtkZLibDataCompressor"), "text that is not base64"),
        ("<VTKFile type=\"PolyData\"/>".to_owned(), "UnstructuredGrid"),
    ];
    for (grid, words) in cases {
        let error = refused("a.vtu", &grid);
        assert!(error.to_string().contains(words), "{error}");
    }
}
