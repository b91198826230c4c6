//! Meshes of VTK, and groups from whole numbers at points and cells as meshio writes them.

use std::io::Write;

use base64::Engine;
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

/// meshio joins names by hyphens. Where a name has one itself, or where two names were doubled, nothing tells whose number is which.
#[test]
fn joined_names_are_those_of_as_many_numbers() {
    let groups_of = |name: &str, tags: &str| -> Vec<String> {
        let head =
            "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 1 0 0 2 0 0\n";
        let cells = "CELLS 1 3\n2 0 1\nCELL_TYPES 1\n3\n";
        let array = format!("POINT_DATA 3\nSCALARS {name} int 1\nLOOKUP_TABLE default\n{tags}\n");
        let nodes = read_text("a.vtk", format!("{head}{cells}{array}")).expect("a mesh");
        nodes.groups.into_keys().collect()
    };
    assert_eq!(groups_of("HUB-FOOT", "-1 1 0"), ["FOOT", "HUB"]);
    let apart = ["BOLT-HOLE-HUB 0", "BOLT-HOLE-HUB 1"];
    assert_eq!(groups_of("BOLT-HOLE-HUB", "0 1 0"), apart);
    assert_eq!(groups_of("AA-AAAA", "0 1 0"), ["AA-AAAA 0", "AA-AAAA 1"]);
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
        (
            array("AQAAAACAAAAIAAAABAAAAA==AAAAAA==", "vtkLZ4DataCompressor"),
            "vtkLZ4DataCompressor packed – write the mesh again with vtkZLibDataCompressor (zlib) or without a compressor",
        ),
        (array("AQAAAACAAAAIAAAABAAAAA==AAAAAA==", "vtkZLibDataCompressor"), "packed data that are damaged"),
        (array("!", "vtkZLibDataCompressor"), "text that is not base64"),
        ("<VTKFile type=\"PolyData\"/>".to_owned(), "UnstructuredGrid"),
    ];
    for (grid, words) in cases {
        let error = refused("a.vtu", &grid);
        assert!(error.to_string().contains(words), "{error}");
    }
}

/// Arrays of XML in every form that VTK writes: base64 in place or in one block behind the grid, the default, packed or not.
#[test]
fn arrays_in_base64_follow_each_other() {
    let encode = |bytes: &[u8]| base64::engine::general_purpose::STANDARD.encode(bytes);
    let packed = |bytes: &[u8]| {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("packed")
    };
    let reals: Vec<u8> = [0.0f64, 0.0, 0.0, 1.0, 0.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let [points, ends] =
        [[0i64, 1].as_slice(), &[2]].map(|n| n.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>());
    let arrays = [
        (reals, "Float64"),
        (points, "Int64"),
        (ends, "Int64"),
        (vec![3], "UInt8"),
        (vec![4, 5], "UInt8"),
        (vec![], "Int8"),
    ];
    let forms =
        [4, 8].into_iter().flat_map(|header| ["", "vtkZLibDataCompressor"].map(|compressor| (header, compressor)));
    let forms = forms.flat_map(|form| [(form, "joined"), (form, "apart")]);
    for ((header, compressor), heads) in forms {
        for is_appended in [true, false] {
            let number = |n: usize| (n as u64).to_le_bytes()[..header].to_vec();
            let coded = |bytes: &[u8]| match (compressor, heads) {
                ("", "joined") => encode(&[number(bytes.len()), bytes.to_vec()].concat()),
                ("", _) => encode(&number(bytes.len())) + &encode(bytes),
                _ => {
                    let packed = packed(bytes);
                    let sizes = [1, bytes.len(), bytes.len(), packed.len()].map(number);
                    encode(&sizes.concat()) + &encode(&packed)
                }
            };
            let mut block = String::new();
            let mut array = |at: usize, name: &str| {
                let (bytes, kind) = &arrays[at];
                let (offset, text) = (block.len(), coded(bytes));
                let head = format!("<DataArray type=\"{kind}\" Name=\"{name}\"");
                if is_appended {
                    block += &text;
                    format!("{head} format=\"appended\" offset=\"{offset}\"/>")
                } else {
                    format!("{head} format=\"binary\">\n {text}\n</DataArray>")
                }
            };
            let grid = grid_of_two_points(header, compressor, &mut array);
            let grid = if compressor.is_empty() { grid.replace(" compressor=\"\"", "") } else { grid };
            let grid = format!("{grid}<AppendedData encoding=\"base64\">\n_{block}\n</AppendedData></VTKFile>");
            let form = format!("{header} {compressor} {heads} {is_appended}");
            let nodes = read_text("a.vtu", &grid).unwrap_or_else(|error| panic!("{form}: {error}"));
            assert_eq!(nodes.coordinates, [[0.0; 3], [1.0, 0.0, 0.0]], "{form}");
            assert_eq!((group(&nodes, "side 4"), group(&nodes, "side 5")), (vec![1], vec![2]), "{form}");
        }
    }
}

/// A grid of two points, a line between them, and marks; `array` gives the element of an array by its number and name.
fn grid_of_two_points(header: usize, compressor: &str, array: &mut impl FnMut(usize, &str) -> String) -> String {
    let [side, nothing, points] = [(4, "side"), (5, "nothing"), (0, "Points")].map(|(at, name)| array(at, name));
    let cells = [(1, "connectivity"), (2, "offsets"), (3, "types")].map(|(at, name)| array(at, name)).concat();
    format!(
        "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt{}\" compressor=\"{compressor}\"><UnstructuredGrid>\
         <Piece NumberOfPoints=\"2\" NumberOfCells=\"1\"><PointData>{side}{nothing}</PointData><Points>{points}</Points>\
         <Cells>{cells}</Cells></Piece></UnstructuredGrid>",
        8 * header
    )
}

/// A piece that has other points or cells than it says is not whole.
#[test]
fn pieces_have_what_they_say() {
    let piece = |points: &str, cells: &str| {
        format!(
            "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\"><Points>\
             <DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0</DataArray></Points><Cells/></Piece></UnstructuredGrid></VTKFile>"
        )
    };
    assert_eq!(read_text("a.vtu", piece("1", "0")).expect("a mesh").coordinates, [[0.0; 3]]);
    for (grid, words) in [
        (piece("9000000000", "0"), "NumberOfPoints=\"9000000000\" and 1 of them"),
        (piece("1", "2"), "NumberOfCells=\"2\" and 0 of them"),
    ] {
        let error = refused("a.vtu", grid);
        assert!(matches!(error, Error::MeshText { .. }) && error.to_string().contains(words), "{error}");
    }
}
