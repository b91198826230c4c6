//! Conventions of HDF5 that other programs wrote, and what Octave wrote in either of its MATLAB formats.

use supel::error::Error;
use supel::input::{Allowance, SingleMatrix, read};

use super::{fixture, job, pair, stiffness};

#[test]
fn conventions_of_other_programs() {
    let reference = pair("k.mtx", "m.mtx").expect("the reference").stiffness.matrix;
    for name in ["julia.h5", "julia.h5:/K", "binsparse.h5"] {
        assert!(stiffness(&fixture(name)).unwrap_or_else(|error| panic!("{name}: {error}")) == reference, "{name}");
    }
}

/// K = [2 −1/3 0; −1/3 3 −0.5; 0 −0.5 4] and M = diag(1/7, 2, 3).
#[test]
fn files_of_octave() {
    for name in ["octave.h5", "octave6.mat", "octave7.mat"] {
        let input = read(&job(&fixture(name), &fixture(name))).unwrap_or_else(|error| panic!("{name}: {error}"));
        let (k, m) = (&input.stiffness.matrix, &input.mass.matrix);
        assert_eq!((k.rows(), k.nnz(), m.nnz()), (3, 7, 3), "{name}");
        assert_eq!((k.get(0, 1), k.get(1, 2), k.get(2, 2)), (Some(&(-1.0 / 3.0)), Some(&-0.5), Some(&4.0)), "{name}");
        assert_eq!(m.get(0, 0), Some(&(1.0 / 7.0)), "{name}");
    }
}

/// Binsparse says in a text, which is not read, that a triangle is half of a symmetric matrix.
#[test]
fn a_triangle_of_binsparse_is_mirrored_for_conversion_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("k.h5");
    let write = |pointers: &[i64], indices: &[i64], values: &[f64]| {
        let file = hdf5_metno::File::create(&path).expect("a file");
        let group = file.create_group("K").expect("a group");
        let list = |name: &str, numbers: &[i64]| {
            let dataset = group.new_dataset::<i64>().shape(numbers.len()).create(name);
            dataset.and_then(|dataset| dataset.write_raw(numbers)).expect("numbers");
        };
        list("pointers_to_1", pointers);
        list("indices_1", indices);
        let dataset = group.new_dataset::<f64>().shape(values.len()).create("values").expect("a dataset");
        dataset.write_raw(values).expect("numbers");
    };
    let read = || {
        let matrix = SingleMatrix { file: path.with_file_name("k.h5:/K"), layout: None, dofs: None };
        matrix.read(&Allowance::of(None))
    };
    write(&[0, 1, 3], &[0, 0, 1], &[2.0, -1.0, 3.0]);
    let lower = read().expect("half of a matrix");
    assert_eq!(lower.input.matrix.get(0, 1), Some(&-1.0));
    let told = lower.notes.iter().map(ToString::to_string).collect::<String>() + &format!("{:?}", lower.input.notes);
    assert!(told.contains("OneTriangle"), "{told}");
    // Without a diagonal it may be half of a skew one.
    write(&[0, 0, 1], &[0], &[-1.0]);
    let error = read().expect_err("no diagonal");
    assert!(matches!(error, Error::Hdf5Orientation { .. }), "{error}");
}

/// The tables of MSC Nastran, in which matrices follow one another: K and M by their names, as others have them.
#[test]
fn small_tables_of_msc_nastran() {
    let fixtures = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/hdf5");
    let [nastran, exudyn] = ["nastran.h5", "exudyn.hdf5"].map(|name| fixtures.join(name));
    let [input, reference] = [nastran, exudyn].map(|file| read(&job(&file, &file)).expect("K and M"));
    assert!(input.stiffness.matrix == reference.stiffness.matrix && input.mass.matrix == reference.mass.matrix);
}

/// FORM 6 is symmetric, whatever the matrix is wanted for: one triangle stands for both.
#[test]
fn a_triangle_of_a_symmetric_matrix_of_msc_nastran_is_the_whole_of_it() {
    let fixtures = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/hdf5");
    let [whole, half] = ["nastran.h5:/KGG", "nastran_triangle.h5:/KGG"].map(|name| {
        let matrix = SingleMatrix { file: fixtures.join(name), layout: None, dofs: None };
        matrix.read(&Allowance::of(None)).expect("a matrix").input.matrix
    });
    assert!(whole == half && whole.get(0, 1) == Some(&-1.0));
}

#[test]
fn tables_of_msc_nastran() {
    let Some(pairs) = supel_testing::corpus::corpus() else { return };
    let folder = pairs.join("nastran_h5_dc3_SOL103_structure_only");
    let file = folder.join("SOL103_structure_only.mtx.h5");
    let input = read(&job(&file, &file)).expect("K and M by their names");
    let reference = read(&job(&folder.join("K.mtx.gz"), &folder.join("M.mtx.gz"))).expect("as Matrix Market");
    assert!(input.stiffness.matrix == reference.stiffness.matrix);
    assert!(input.mass.matrix == reference.mass.matrix);
    let place = |name: &str| file.with_file_name(format!("SOL103_structure_only.mtx.h5:{name}"));
    let error = read(&job(&place("GM"), &file)).expect_err("rectangular");
    assert!(matches!(&error, Error::MatrixSize { n_rows: 1170, n_cols: 498, .. }), "{error}");
    assert!(matches!(read(&job(&place("KAA"), &file)), Err(Error::MatrixName { .. })));
}
