//! The motion as a VTKHDF file: that of the table, which other tests compare with the full model, at the places of the model.

use hdf5_metno::File;
use supel::cli::ExitCode;

use super::{Case, any, files};

/// A list of numbers.
fn list(file: &File, name: &str) -> Vec<i64> {
    file.dataset(&format!("VTKHDF/{name}")).and_then(|set| set.read_raw()).expect("a list")
}

/// Vectors, and how many there are.
fn vectors(file: &File, name: &str) -> (usize, Vec<f64>) {
    let set = file.dataset(&format!("VTKHDF/{name}")).expect("a dataset");
    assert_eq!(set.shape()[1], 3, "{name}");
    (set.shape()[0], set.read_raw().expect("vectors"))
}

/// Every state has the vectors of its row, from where its offset says; the nodes stand once, where the model has them.
#[test]
fn a_series_holds_the_motion_of_every_state() {
    let case = Case::new("craig-bampton");
    let header = format!("time,{}", case.header());
    let states = |seed| (0..3_u64).map(|at| [vec![0.25 * at as f64], any(14, seed + at)].concat()).collect::<Vec<_>>();
    case.table("q.csv", &header, &states(1));
    case.table("a.csv", &header, &states(11));
    let path = case.place.text("u.vtkhdf");
    let arguments = ["-o", "u.csv", "--acceleration", "a.csv", "--vtkhdf", &path];
    let ended = case.recover(&arguments).expect(ExitCode::Done);
    assert!(ended.out.ends_with(&format!("{path}: motion of 45 nodes in 3 states\n")), "{}", ended.out);

    let file = File::open(&path).expect("HDF5");
    for name in ["displacement", "acceleration"] {
        let (n, found) = vectors(&file, &format!("PointData/{name}"));
        let expected: Vec<f64> = (1..4).flat_map(|state| case.values("u.csv", state, name)).collect();
        assert!(expected.iter().any(|value| *value != 0.0));
        // Both are the same doubles.
        assert_eq!((n, found), (3 * 45, expected), "{name}");
        assert_eq!(list(&file, &format!("Steps/PointDataOffsets/{name}")), [0, 45, 90]);
    }
    assert!(file.dataset("VTKHDF/PointData/velocity").is_err(), "nobody gave velocities");
    assert!(file.dataset("VTKHDF/PointData/rotation").is_err(), "a solid has no rotations");
    let nodes = case.model.nodes.as_flattened().to_vec();
    assert_eq!(vectors(&file, "Points"), (45, nodes));
    assert_eq!(list(&file, "Steps/PointOffsets"), [0; 3]);
    assert_eq!(list(&file, "NumberOfPoints"), [45; 3]);
    assert_eq!(list(&file, "Types"), [1; 45]);
    assert_eq!(list(&file, "Connectivity"), (0..45).collect::<Vec<_>>());
    assert_eq!(list(&file, "Offsets"), (0..=45).collect::<Vec<_>>());
    let times: Vec<f64> = file.dataset("VTKHDF/Steps/Values").and_then(|set| set.read_raw()).expect("times");
    assert_eq!(times, [0.0, 0.25, 0.5]);
    drop(file);

    // A later second, the same bytes.
    let before = case.place.bytes("u.vtkhdf");
    std::thread::sleep(std::time::Duration::from_millis(1100));
    case.recover(&arguments).expect(ExitCode::Done);
    assert!(case.place.bytes("u.vtkhdf") == before, "the same states, the same bytes");
}

/// Where the mesh has cells, the outer faces of the recovered nodes are cells of the series, and nodes inside are vertices.
#[test]
fn a_series_has_the_surface_of_the_mesh() {
    use supel_testing::place::{bricks_of_27, bricks_of_eight, xdmf};
    // 2 (4·2 + 4·2 + 2·2) squares around three nodes inside; 2 (2 + 2 + 1) squares of nine nodes around the same and two centres of bricks.
    for (cells, n_faces, kind, n_inside) in [(bricks_of_eight(), 40, 9, 3), (bricks_of_27(), 10, 28, 3)] {
        let case =
            Case { place: supel_testing::place::Place::with_brick(), model: supel_testing::place::steel_brick() };
        case.place.write("mesh.xdmf", xdmf(&case.model.nodes, &[cells]).as_bytes());
        let all = "recovery = { nodes = { within = { box = { min = [0, 0, 0], max = [1, 1, 1] } } } }";
        let case = case.reduced("craig-bampton", "{ name = \"foot\", nodes = [1, 11, 31] }", all);
        let made = case.place.superelement("x.supel");
        let recovery = made.tensors().recovery.as_ref().expect("rows");
        let (faces, positions) = (recovery.faces().expect("faces"), recovery.positions().expect("positions"));
        assert_eq!(faces.count(), n_faces);
        // Seen from outside their corners are counterclockwise: the volume is a third of the sum of x · n dA.
        let volume: f64 = faces
            .iter()
            .map(|face| {
                let [a, b, c, d] = [0, 1, 2, 3].map(|corner| positions[face[corner]]);
                let minus = |p: [f64; 3], q: [f64; 3]| -> [f64; 3] { std::array::from_fn(|axis| p[axis] - q[axis]) };
                let twice = supel_runtime::motion::cross(&minus(c, a), &minus(d, b));
                supel_runtime::motion::dot(&a, &twice) / 6.0
            })
            .sum();
        assert!((volume / (0.31 * 0.23) - 1.0).abs() < 1e-14, "{volume}");
        case.table("q.csv", &case.header(), &[any(14, 1)]);
        let path = case.place.text("u.vtkhdf");
        case.recover(&["--vtkhdf", &path]).expect(ExitCode::Done);
        let file = File::open(&path).expect("HDF5");
        let types = list(&file, "Types");
        assert_eq!(types, [vec![kind; n_faces], vec![1; n_inside]].concat());
        let (offsets, ids) = (list(&file, "Offsets"), list(&file, "Connectivity"));
        let of = |cell: usize| ids[offsets[cell] as usize..offsets[cell + 1] as usize].to_vec();
        for (cell, face) in faces.iter().enumerate() {
            assert_eq!(of(cell), face.iter().map(|node| *node as i64).collect::<Vec<_>>());
        }
        let inside: Vec<i64> = (n_faces..types.len()).flat_map(of).collect();
        assert_eq!(inside, [21, 22, 23], "the middle line but for its ends");
        assert_eq!(list(&file, "NumberOfCells"), [types.len() as i64]);
        assert_eq!(list(&file, "NumberOfConnectivityIds"), [ids.len() as i64]);
        drop(file);
        let verify = ["verify", &case.place.text("x.supel"), "--job", &case.place.text("job.toml")];
        supel_testing::place::supel(&verify).expect(ExitCode::Done);
    }
}

/// A mesh whose cells are not read leaves the nodes alone, and the report says why.
#[test]
fn a_mesh_that_does_not_tell_leaves_vertices() {
    use supel_testing::place::{Place, bricks_of_eight, steel_brick, xdmf};
    let case = Case { place: Place::with_brick(), model: steel_brick() };
    let cells = [bricks_of_eight(), ("3DSMesh", vec![])];
    case.place.write("mesh.xdmf", xdmf(&case.model.nodes, &cells).as_bytes());
    let case = case.reduced(
        "craig-bampton",
        "{ name = \"foot\", nodes = [1, 11, 31] }",
        "recovery = { nodes = [1, 2, 6, 7, 16, 17, 21, 22] }",
    );
    assert!(case.place.superelement("x.supel").tensors().recovery.as_ref().expect("rows").faces().is_none());
    let report = case.place.report("x.report.json");
    let said = report["body"]["model"]["notes"].to_string();
    assert!(
        said.contains("faces between recovered nodes are not known: the mesh has what supel does not read"),
        "{said}"
    );
}

/// Nothing is left where a state is wrong, the name is not that of a series, or it is that of an input.
#[test]
fn a_series_appears_whole_or_not_at_all() {
    let case = Case::new("craig-bampton");
    let path = case.place.text("u.vtkhdf");
    let refused = |path: &str, code, said: &str| {
        let before = files(&case);
        let ended = case.recover(&["--vtkhdf", path]).expect(code);
        assert!(ended.err.contains(said), "{said} in {}", ended.err);
        assert_eq!(files(&case), before);
    };
    case.place.write("u.vtkhdf", b"what was there");
    // The largest double is finite; what it moves is not.
    case.table("q.csv", &case.header(), &[any(14, 1), vec![1.7e308; 14]]);
    refused(&path, ExitCode::InputData, "E-STATE-RANGE");
    assert_eq!(case.place.bytes("u.vtkhdf"), b"what was there");
    refused(&case.place.text("u.vtk"), ExitCode::Usage, "E-OUTPUT-NAME");
    let bytes = case.place.bytes("q.csv");
    case.place.write("q.vtkhdf", &bytes);
    let (x, q) = (case.place.text("x.supel"), case.place.text("q.vtkhdf"));
    let ended = supel_testing::place::supel(&["recover", &x, "--state", &q, "--vtkhdf", &q]).expect(ExitCode::Usage);
    assert!(ended.err.contains("E-OVERWRITE"), "{}", ended.err);
    assert_eq!(case.place.bytes("q.vtkhdf"), bytes);
}
