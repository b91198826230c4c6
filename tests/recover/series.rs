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
