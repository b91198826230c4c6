//! `supel convert` of meshes: VTKHDF with the points, cells and groups of the file that was read.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use hdf5_metno::types::FixedAscii;
use serde_json::Value;
use supel::cli::ExitCode;
use supel::input::{Allowance, MeshInput};
use supel_testing::place::supel;
use supel_testing::schema::{assert_follows, validator};

use super::{Folder, fixture, root};

fn mesh(path: &Path) -> MeshInput {
    MeshInput::read(path, &Allowance::of(None)).unwrap_or_else(|error| panic!("{error}"))
}

/// What was written, under another name: a process that another test started in between may hold the lock of the file.
fn copied(path: &Path) -> PathBuf {
    let copy = path.with_file_name("copied.vtkhdf");
    std::fs::copy(path, &copy).expect("copied");
    copy
}

/// Cells by the places of their nodes, in whatever order they come.
fn places(mesh: &MeshInput) -> BTreeSet<(u8, Vec<[u64; 3]>)> {
    let place = |node: &u32| mesh.nodes.coordinates[*node as usize].map(|x| (1e6 * x).round() as u64);
    let of_run = |run: &supel::input::VtkCells| -> Vec<(u8, Vec<[u64; 3]>)> {
        run.nodes.chunks(run.n_nodes).map(|nodes| (run.number, nodes.iter().map(place).collect())).collect()
    };
    mesh.cells.iter().flat_map(of_run).collect()
}

/// The answer of `supel convert --json`, which follows its schema.
fn converted(from: &Path, to: &Path) -> Value {
    let [from, to] = [from, to].map(|path| path.display().to_string());
    let ended = supel(&["convert", &from, &to, "--json"]).expect(ExitCode::Done);
    let answer: Value = serde_json::from_str(&ended.out).expect("JSON");
    assert_follows(&validator("conversion"), &answer);
    answer
}

/// One box of two bricks of twenty nodes in all forms that bring their cells.
#[test]
fn every_format_gives_the_same_cells_points_and_groups() {
    let files = [
        "box22.msh",
        "box22b.msh",
        "box41.msh",
        "box41b.msh",
        "box.vtk",
        "box-text.vtk",
        "box42.vtk",
        "box.vtu",
        "box-text.vtu",
        "box-raw.vtu",
        "box.vtkhdf",
        "box.xdmf",
        "box.cgns",
    ];
    let expected = places(&mesh(&fixture("mesh/box.vtk")));
    assert_eq!(expected.iter().filter(|(number, _)| *number == 25).count(), 2, "{expected:?}");
    let folder = Folder::new();
    for name in files {
        let source = fixture(&format!("mesh/{name}"));
        let output = folder.0.path().join("box.vtkhdf");
        let answer = converted(&source, &output);
        let [read, written] = [&source, &copied(&output)].map(|path| mesh(path));
        assert_eq!(read.nodes.coordinates, written.nodes.coordinates, "{name}");
        assert_eq!(places(&read), places(&written), "{name}");
        let bricks =
            |mesh: &MeshInput| places(mesh).into_iter().filter(|(number, _)| *number == 25).collect::<BTreeSet<_>>();
        assert_eq!(bricks(&written), bricks(&mesh(&fixture("mesh/box.vtk"))), "{name}");
        assert_eq!(answer["mesh"]["nodes"], 32, "{name}");
        assert_eq!(answer["mesh"]["groups"].as_array().expect("groups").len(), read.nodes.groups.len(), "{name}");
        assert_eq!((&read.nodes.labels, &read.nodes.groups), (&written.nodes.labels, &written.nodes.groups), "{name}");
        assert_eq!(answer["notes"], Value::Array(Vec::new()), "{name}");
    }
}

/// CalculiX lists the nodes of a brick in its results in another order than in its decks.
#[test]
fn a_deck_and_its_results_are_the_same_mesh() {
    let deck = mesh(&root().join("examples/calculix/crank.inp"));
    let results = mesh(&fixture("calculix/held.frd.gz"));
    assert_eq!(deck.nodes.labels, results.nodes.labels);
    let cells = |mesh: &MeshInput| {
        mesh.cells.iter().filter(|run| run.number == 25).flat_map(|run| run.nodes.clone()).collect::<Vec<_>>()
    };
    assert_eq!((cells(&deck), deck.n_cells()), (cells(&results), results.n_cells()));
    assert!(deck.n_cells() > 8);
}

/// The file as VTK asks for it: attributes, counts, labels, arrays of groups, a vertex at a point without a cell, and always the same bytes.
#[test]
fn the_file_is_what_vtk_reads() {
    let folder = Folder::new();
    let table = folder.write(
        "part.inp",
        "*NODE\n7, 0, 0, 0\n3, 1, 0, 0\n5, 0, 1, 0\n9, 0, 0, 1\n4, 5, 5, 5\n*ELEMENT, TYPE=C3D4, ELSET=A\n1, 7, 3, 5, 9\n\
         *NSET, NSET=node\n4\n*NSET, NSET=A/B\n3, 9\n",
    );
    let output = folder.0.path().join("part.vtkhdf");
    let answer = converted(&table, &output);
    assert_eq!((&answer["mesh"]["cells"], &answer["output"]["format"]), (&1.into(), &"vtkhdf".into()));
    let file = hdf5_metno::File::open(copied(&output)).expect("HDF5");
    let group = file.group("VTKHDF").expect("a group");
    let kind: FixedAscii<16> = group.attr("Type").expect("Type").read_scalar().expect("text");
    let version: Vec<i64> = group.attr("Version").expect("Version").read_raw().expect("numbers");
    assert_eq!((kind.as_str(), version), ("UnstructuredGrid", vec![2, 0]));
    let whole = |name: &str| group.dataset(name).expect(name).read_raw::<i64>().expect("numbers");
    assert_eq!(["NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"].map(whole), [vec![5], vec![2], vec![5]]);
    assert_eq!(
        (whole("Connectivity"), whole("Offsets"), whole("Types")),
        (vec![0, 1, 2, 3, 4], vec![0, 4, 5], vec![10, 1])
    );
    let array = |name: &str| whole(&format!("PointData/{name}"));
    assert_eq!((array("node"), array("node (2)")), (vec![7, 3, 5, 9, 4], vec![0, 0, 0, 0, 1]));
    assert_eq!((array("A"), array("A_B")), (vec![1, 1, 1, 1, 0], vec![0, 1, 0, 1, 0]));
    drop(file);
    // What was written is read again: labels, and groups by their names.
    let (written, again) = (mesh(&table).nodes, mesh(&copied(&output)).nodes);
    assert_eq!((again.labels, &again.groups), (written.labels, &written.groups));
    assert!(again.groups.contains_key("A/B") && again.groups.contains_key("node"), "{:?}", again.groups);
    let bytes = std::fs::read(&output).expect("written");
    std::fs::remove_file(&output).expect("removed");
    converted(&table, &output);
    assert!(std::fs::read(&output).expect("written") == bytes, "the same bytes again");
}

/// A mesh whose cells are not read is points, which a note tells; a table has none.
#[test]
fn meshes_without_cells_are_points() {
    let folder = Folder::new();
    let output = folder.0.path().join("points.vtkhdf");
    for (name, told) in [("box.e", "the kinds of elements in the layout of Exodus"), ("box.hmf", "the kinds of cells")]
    {
        let answer = converted(&fixture(&format!("mesh/{name}")), &output);
        assert_eq!(answer["mesh"]["cells"], 0, "{name}");
        assert!(answer["notes"][0].as_str().expect("a note").contains(told), "{answer}");
        let written = mesh(&copied(&output));
        assert_eq!(written.nodes.coordinates, mesh(&fixture("mesh/box.vtk")).nodes.coordinates, "{name}");
    }
    let table = folder.write("nodes.csv", "node,x,y,z\n1,0,0,0\n2,1,0,0\n");
    assert_eq!(converted(&table, &output)["mesh"]["nodes"], 2);
}

#[test]
fn what_is_no_mesh_is_refused() {
    let folder = Folder::new();
    let output = folder.0.path().join("a.vtkhdf").display().to_string();
    let source = fixture("mesh/box22.msh").display().to_string();
    for flags in [["--name", "K"], ["--layout", "op4"], ["--dofs", "a.dof"], ["--write-dofs", "b.csv"]] {
        let ended = supel(&[&["convert", &source, &output], flags.as_slice()].concat()).expect(ExitCode::Usage);
        assert!(ended.err.contains("E-FLAG") && ended.err.contains(flags[0]), "{}", ended.err);
    }
    let matrix = fixture("matrices/k.npy").display().to_string();
    let ended = supel(&["convert", &matrix, &output]).expect(ExitCode::InputData);
    assert!(ended.err.contains("NumPy array"), "{}", ended.err);
    let into = folder.0.path().join("a.mtx").display().to_string();
    let ended = supel(&["convert", &source, &into]).expect(ExitCode::InputData);
    assert!(ended.err.contains("Gmsh mesh") && ended.err.contains(".vtkhdf"), "{}", ended.err);
    assert!(!Path::new(&output).exists());
}
