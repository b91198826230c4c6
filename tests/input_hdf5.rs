//! Sparse matrices and meshes in HDF5: every convention, every refusal, damaged files.

#![cfg(feature = "hdf5")]

use std::fs;
use std::path::{Path, PathBuf};

use hdf5_metno::{File, Group};
use supel::dofs::Nodes;
use supel::error::{Error, ErrorClass};
use supel::input::MatrixInput;
use supel::input::MatrixRole;
use supel::input::hdf5::{read_matrix, read_nodes};
use supel::sparse::Given;
use tempfile::TempDir;

const K: [[f64; 3]; 3] = [[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]];
const M: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.5]];

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/hdf5").join(name)
}

/// The shared corpus, or `None` with a message.
fn corpus(folder: &str) -> Option<PathBuf> {
    let root = std::env::var_os("SUPEL_CORPUS")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/corpus"), PathBuf::from);
    let path = root.join(folder);
    if path.is_dir() {
        return Some(path);
    }
    println!("skipped: no corpus at {}", path.display());
    None
}

fn dense(input: &MatrixInput) -> Vec<Vec<f64>> {
    let mut rows = vec![vec![0.0; input.matrix.cols()]; input.matrix.rows()];
    for (&value, (row, col)) in &input.matrix {
        rows[row as usize][col as usize] = value;
    }
    rows
}

fn stiffness(path: &Path, group: Option<&str>) -> Result<MatrixInput, Error> {
    read_matrix(path, group, MatrixRole::Stiffness)
}

/// A file made by `fill` in a folder that lives as long as the returned handle.
fn file_with(fill: impl FnOnce(&File)) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("made.h5");
    fill(&File::create(&path).unwrap());
    (folder, path)
}

fn put<T: hdf5_metno::H5Type>(group: &Group, name: &str, values: &[T]) {
    group.new_dataset_builder().with_data(values).create(name).unwrap();
}

fn put_attr<T: hdf5_metno::H5Type>(group: &Group, name: &str, values: &[T]) {
    group.new_attr_builder().with_data(values).create(name).unwrap();
}

fn put_matrix(file: &File, name: &str, indptr: &[i64], indices: &[i64], data: &[f64]) {
    let group = file.create_group(name).unwrap();
    put(&group, "indptr", indptr);
    put(&group, "indices", indices);
    put(&group, "data", data);
}

/// The error that reading a matrix made of these arrays gives.
fn refusal(indptr: &[i64], indices: &[i64], data: &[f64]) -> Error {
    let (_folder, path) = file_with(|f| put_matrix(f, "K", indptr, indices, data));
    let error = stiffness(&path, None).unwrap_err();
    assert_eq!(error.class(), ErrorClass::InputData);
    error
}

/// Julia counts from one, and messages show what its file has.
#[test]
fn indices_are_shown_as_they_are_counted() {
    let refused = |colptr: &[i64], rowval: &[i64]| {
        let (_folder, path) = file_with(|file| {
            let group = file.create_group("K").unwrap();
            put(&group, "m", &[2_i64]);
            put(&group, "n", &[2_i64]);
            put(&group, "colptr", colptr);
            put(&group, "rowval", rowval);
            put(&group, "nzval", &[2.0, 3.0]);
        });
        stiffness(&path, None).map(|input| dense(&input)).map_err(|error| error.to_string())
    };
    assert_eq!(refused(&[1, 2, 3], &[1, 2]), Ok(vec![vec![2.0, 0.0], vec![0.0, 3.0]]));
    for (colptr, rowval, said) in [
        ([0, 1, 2], [1, 2], "/K/colptr: pointer 0 is 0 – expected 1"),
        ([1, 3, 2], [1, 2], "/K/colptr: pointer 2 is 2 – expected at least 3"),
        ([1, 2, 4], [1, 2], "/K/colptr: pointer 2 is 4 – expected 3, one more than the number of values"),
        ([1, 2, 3], [1, 9], "/K/rowval: entry 1 is 9 – expected 1 to 2"),
        ([1, 2, 3], [0, 2], "/K/rowval: entry 0 is 0 – expected 1 to 2"),
    ] {
        let found = refused(&colptr, &rowval).expect_err("an error");
        assert!(found.contains(said), "{found}");
    }
}

/// Numbers that a reader would have to change are refused: unsigned ones beyond the signed, whole ones between two doubles.
#[test]
fn numbers_are_read_as_they_are_or_not_at_all() {
    let refused = |fill: &dyn Fn(&Group), object: &str, found: &str| {
        let (_folder, path) = file_with(|file| {
            let group = file.create_group("K").unwrap();
            fill(&group);
        });
        let error = stiffness(&path, None).unwrap_err();
        assert!(matches!(&error, Error::Hdf5Value { .. }), "{error}");
        assert_eq!(error.class(), ErrorClass::InputData);
        let said = error.to_string();
        assert!(said.contains(object) && said.contains(found), "{said}");
    };
    let beyond = 1_u64 << 63;
    refused(
        &|group| {
            put(group, "indptr", &[0_i64, 1, 2]);
            put(group, "indices", &[0_i64, 1]);
            put(group, "data", &[1, beyond]);
        },
        "/K/data: value 1",
        "9223372036854775808",
    );
    refused(
        &|group| {
            put(group, "indptr", &[0_i64, 1, 2]);
            put(group, "indices", &[0, beyond]);
            put(group, "data", &[1.0, 2.0]);
        },
        "/K/indices: value 1",
        "expected whole numbers below 2^63",
    );
    for inexact in [(1_i64 << 53) + 1, -(1_i64 << 53) - 1, i64::MAX, i64::MAX - 1] {
        refused(
            &|group| {
                put(group, "indptr", &[0_i64, 1, 2]);
                put(group, "indices", &[0_i64, 1]);
                put(group, "data", &[inexact, 1]);
            },
            "/K/data: value 0",
            &inexact.to_string(),
        );
    }
    refused(
        &|group| {
            put_attr(group, "shape", &[2, beyond]);
            put(group, "indptr", &[0_i64, 1, 2]);
            put(group, "indices", &[0_i64, 1]);
            put(group, "data", &[1.0, 2.0]);
        },
        "/K@shape: value 1",
        "9223372036854775808",
    );
    let exact = [1_i64 << 53, -(1 << 62)];
    let (_folder, path) = file_with(|file| {
        let group = file.create_group("K").unwrap();
        put(&group, "indptr", &[0_i64, 1, 2]);
        put(&group, "indices", &[0_i64, 1]);
        put(&group, "data", &exact);
    });
    assert_eq!(dense(&stiffness(&path, None).unwrap()), [[exact[0] as f64, 0.0], [0.0, exact[1] as f64]]);
}

/// Text of another encoding is the file's fault, not the system's.
#[test]
fn a_mesh_in_xml_that_is_not_utf_8() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.xdmf");
    fs::write(&path, b"<Xdmf Name=\"caf\xe9\"/>").unwrap();
    let error = read_nodes(&path).unwrap_err();
    assert!(matches!(error, Error::NotText { offset: 15, .. }), "{error}");
    assert_eq!((error.code(), error.class()), ("E-UTF8", ErrorClass::InputData));
}

/// A file called XDMF without an HDF5 signature is told about XML: in UTF-16, or empty.
#[test]
fn a_mesh_in_xml_of_another_encoding_or_empty() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.xdmf");
    let text: Vec<u8> = "\u{feff}<Xdmf/>".encode_utf16().flat_map(u16::to_be_bytes).collect();
    for (bytes, code, words) in [(&text[..], "E-FORMAT", "text in UTF-16"), (b"", "E-XDMF", "not well-formed XML")] {
        fs::write(&path, bytes).unwrap();
        let error = read_nodes(&path).unwrap_err();
        assert_eq!(error.code(), code, "{error}");
        assert!(error.to_string().contains(words), "{error}");
    }
    // A document is quoted, not repeated.
    let numbers = "0.5 0.25 0.125 ".repeat(1000);
    let error = xdmf(&geometry("XYZ", "HDF", &format!("../x.h5:/x {numbers}"))).unwrap_err();
    assert!(matches!(error, Error::XdmfReference { .. }) && error.to_string().len() < 300, "{error}");
}

#[test]
fn every_convention_gives_the_same_matrices() {
    for (file, k, m) in [
        ("matlab.mat", "/K", "/M"),
        ("anndata.h5ad", "/stiffness", "/mass"),
        ("h5sparse.h5", "/model/K", "model/M"),
        ("exudyn.hdf5", "stiffnessMatrix", "massMatrix"),
    ] {
        let path = fixture(file);
        // By name where the file holds both, except that `Z` of matlab.mat says nothing; and by path.
        for group in [None, Some(k)] {
            let input = stiffness(&path, group).unwrap_or_else(|e| panic!("{file} {group:?}: {e}"));
            assert_eq!(dense(&input), K, "{file}");
            assert_eq!(input.matrix.nnz(), 7, "{file}");
            assert_eq!(input.digest, blake3::hash(&fs::read(&path).unwrap()).to_hex().to_string());
        }
        for group in [None, Some(m)] {
            let input = read_matrix(&path, group, MatrixRole::Mass).unwrap_or_else(|e| panic!("{file} {group:?}: {e}"));
            assert_eq!(dense(&input), M, "{file}");
        }
    }
}

#[test]
fn plain_arrays_at_the_root_are_read_in_any_integer_type() {
    let input = stiffness(&fixture("plain.h5"), None).unwrap();
    assert_eq!(dense(&input), K);
    assert_eq!(dense(&stiffness(&fixture("plain.h5"), Some("/")).unwrap()), K);
}

#[test]
fn single_precision_carries_seven_digits() {
    let input = stiffness(&fixture("single_precision.h5"), None).unwrap();
    assert_eq!(dense(&input)[0][0], f64::from(2.0_f32 / 3.0));
    assert!(input.digits.significant <= 7, "{:?}", input.digits);
}

#[test]
fn half_storage_is_mirrored_and_told() {
    let input = stiffness(&fixture("half.h5"), None).unwrap();
    assert_eq!(dense(&input), K);
    assert_eq!(input.notes.given, Given::OneTriangle);
    assert_eq!(stiffness(&fixture("plain.h5"), None).unwrap().notes.given, Given::Whole);
}

#[test]
fn a_matlab_matrix_without_entries_is_read() {
    let input = stiffness(&fixture("matlab.mat"), Some("Z")).unwrap();
    assert_eq!((input.matrix.rows(), input.matrix.nnz()), (3, 0));
}

#[test]
fn the_only_matrix_is_taken_unless_its_name_says_otherwise() {
    let (_folder, path) = file_with(|f| put_matrix(f, "M", &[0, 1], &[0], &[4.0]));
    assert!(read_matrix(&path, None, MatrixRole::Mass).is_ok());
    let error = stiffness(&path, None).unwrap_err();
    assert!(matches!(&error, Error::MatrixAmbiguous { matrices, .. } if matrices == &["/M"]), "{error}");
    assert!(stiffness(&path, Some("/M")).is_ok(), "an explicit path is obeyed");
}

#[test]
fn several_matrices_without_a_telling_name_are_listed() {
    let (_folder, path) = file_with(|f| {
        put_matrix(f, "a/first", &[0, 1], &[0], &[4.0]);
        put_matrix(f, "b/second", &[0, 1], &[0], &[4.0]);
    });
    let error = stiffness(&path, None).unwrap_err();
    assert!(matches!(&error, Error::MatrixAmbiguous { matrices, .. } if matrices.len() == 2));
    let text = error.to_string();
    assert!(text.contains("/a/first, /b/second") && text.contains("made.h5:/a/first"), "{text}");
    assert!(stiffness(&path, Some("b")).is_ok(), "one matrix below the group given");
}

#[test]
fn a_file_without_a_matrix_is_refused_with_what_it_holds() {
    let error = stiffness(&fixture("mesh.hmf"), None).unwrap_err();
    assert!(
        matches!(&error, Error::Hdf5NoMatrix { holds, .. } if holds == &["/domain/grid/Geometry", "/domain/grid/Topology0"])
    );
}

#[test]
fn a_wrong_path_in_the_file_is_refused() {
    let path = fixture("h5sparse.h5");
    let missing = stiffness(&path, Some("/model/X")).unwrap_err();
    assert!(matches!(&missing, Error::Hdf5Missing { object, kind: "group", .. } if object == "/model/X"), "{missing}");
    let dataset = stiffness(&path, Some("/model/K/data")).unwrap_err();
    assert!(matches!(dataset, Error::Hdf5Type { expected: "a group", .. }), "{dataset}");
}

#[test]
fn an_incomplete_group_is_refused() {
    let (_folder, path) = file_with(|f| put_attr(&f.create_group("K").unwrap(), "h5sparse_shape", &[3_i64, 3]));
    let error = stiffness(&path, None).unwrap_err();
    assert!(matches!(&error, Error::Hdf5Missing { object, kind: "dataset", .. } if object == "/K/indptr"), "{error}");
}

#[test]
fn what_is_not_hdf5_is_named() {
    let folder = tempfile::tempdir().unwrap();
    for (bytes, expected) in [
        (&b"MATLAB 5.0 MAT-file"[..], "version 7 or older"),
        (b"", "an empty file"),
        (b"\x1f\x8b\x08", "gzip"),
        (b"hello", "other bytes"),
    ] {
        let path = folder.path().join("x.mat");
        fs::write(&path, bytes).unwrap();
        let error = stiffness(&path, None).unwrap_err();
        let is_named = matches!(error, Error::Hdf5Signature { .. } | Error::FormatNotRead { .. });
        assert!(is_named && error.to_string().contains(expected), "{error}");
    }
}

#[test]
fn a_file_that_cannot_be_read_is_an_io_error() {
    let error = stiffness(&fixture("absent.h5"), None).unwrap_err();
    assert!(matches!(error, Error::Read { .. }), "{error}");
    assert_eq!(error.class(), ErrorClass::Io);
    let error = stiffness(&fixture(""), None).unwrap_err();
    assert!(matches!(error, Error::NotAFile { .. }), "{error}");
    assert_eq!(error.class(), ErrorClass::InputData);
}

#[test]
fn a_cut_file_is_refused_by_the_library() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.h5");
    let bytes = fs::read(fixture("h5sparse.h5")).unwrap();
    fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let error = stiffness(&path, None).unwrap_err();
    assert!(matches!(error, Error::Hdf5Open { .. }), "{error}");
}

#[test]
fn damaged_values_are_refused_by_the_library() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("damaged.h5");
    let mut bytes = fs::read(fixture("anndata.h5ad")).unwrap();
    // The zlib streams of level 4 start with 78 5e; a wrong first byte cannot be inflated.
    let starts: Vec<usize> = (0..bytes.len() - 1).filter(|&i| bytes[i..].starts_with(b"\x78\x5e")).collect();
    assert!(!starts.is_empty());
    starts.iter().for_each(|&i| bytes[i] = 0);
    fs::write(&path, bytes).unwrap();
    let error = stiffness(&path, None).unwrap_err();
    assert!(matches!(error, Error::Hdf5Read { .. }), "{error}");
}

/// What a name leads to cannot be told where the header of the object is damaged: that is said, and not that the file has no mesh.
#[test]
fn a_damaged_member_is_not_absent() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("member.med");
    // Headers of this version begin with a signature.
    let file = File::with_options().with_fapl(|access| access.libver_latest()).create(&path).unwrap();
    file.create_group("ENS_MAA").unwrap();
    drop(file);
    let mut bytes = fs::read(&path).unwrap();
    let headers: Vec<usize> = (0..bytes.len() - 4).filter(|&i| bytes[i..].starts_with(b"OHDR")).collect();
    let [_root, member] = headers[..] else { panic!("headers at {headers:?}") };
    bytes[member] = 0;
    fs::write(&path, bytes).unwrap();
    let error = read_nodes(&path).unwrap_err();
    assert!(matches!(&error, Error::Hdf5Read { object, .. } if object == "/ENS_MAA"), "{error}");
}

#[test]
fn links_are_not_followed() {
    let (_folder, path) = file_with(|f| {
        put_matrix(f, "real", &[0, 1], &[0], &[4.0]);
        f.link_soft("/real", "soft").unwrap();
        f.link_external("/etc/passwd", "/", "external").unwrap();
    });
    for name in ["soft", "external", "external/K"] {
        let error = stiffness(&path, Some(name)).unwrap_err();
        assert!(matches!(error, Error::Hdf5Link { .. }), "{name}: {error}");
    }
    assert!(stiffness(&path, None).is_ok(), "the search passes over links");
}

#[test]
fn values_in_other_files_are_refused() {
    let (_folder, path) = file_with(|f| {
        put_matrix(f, "K", &[0, 1], &[0], &[4.0]);
        let group = f.group("K").unwrap();
        group.unlink("data").unwrap();
        group.new_dataset::<f64>().shape(1).external("other.bin", 0, 8).create("data").unwrap();
    });
    let error = stiffness(&path, None).unwrap_err();
    assert!(matches!(&error, Error::Hdf5ExternalStorage { object, .. } if object == "/K/data"), "{error}");
}

#[test]
fn filters_without_a_bound_are_refused() {
    for (group, expected) in
        [("lzf", "lzf"), ("twice", "deflate, a second time"), ("wide", "of more than 32 parameters")]
    {
        let error = stiffness(&fixture("filters.h5"), Some(group)).unwrap_err();
        assert!(matches!(&error, Error::Hdf5Filter { filter, .. } if filter == expected), "{error}");
    }
}

#[test]
fn a_promise_that_the_bytes_cannot_keep_is_refused_before_it_is_allocated() {
    let (_folder, path) = file_with(|f| {
        let group = f.create_group("K").unwrap();
        put(&group, "indptr", &[0_i64, 1]);
        put(&group, "indices", &[0_i64]);
        // Never written, so that nothing is stored: 8 TiB of fill values.
        group.new_dataset::<f64>().chunk(1024).shape(1_usize << 40).create("data").unwrap();
    });
    let error = stiffness(&path, None).unwrap_err();
    assert!(matches!(&error, Error::Hdf5Size { object, .. } if object == "/K/data"), "{error}");
}

#[test]
fn groups_that_contain_themselves_end_the_search() {
    let (_folder, path) = file_with(|f| {
        f.create_group("a").unwrap().link_hard("/a", "a").unwrap();
    });
    let error = stiffness(&path, None).unwrap_err();
    assert!(matches!(error, Error::Hdf5Depth { limit: 32, .. }), "{error}");
}

#[test]
fn values_that_are_not_real_numbers_are_refused() {
    let error = stiffness(&fixture("complex.h5"), None).unwrap_err();
    assert!(matches!(error, Error::Hdf5Type { expected: "real numbers", .. }), "{error}");
    let (_folder, path) = file_with(|f| {
        let group = f.create_group("K").unwrap();
        put(&group, "indptr", &[0.0, 1.0]);
        put(&group, "indices", &[0_i64]);
        put(&group, "data", &[1.0]);
    });
    let error = stiffness(&path, None).unwrap_err();
    assert!(matches!(error, Error::Hdf5Type { expected: "whole numbers", .. }), "{error}");
}

#[test]
fn numbers_in_another_byte_order_are_read() {
    assert_eq!(dense(&stiffness(&fixture("big_endian.h5"), None).unwrap()), K);
}

#[test]
fn dense_arrays_are_read_in_half_precision_and_in_either_order_of_bytes() {
    let path = fixture("dense_types.h5");
    for (name, digits) in [("f2_little", 3), ("f2_big", 3), ("f4_big", 7), ("f8_big", 17), ("i2_big", 17)] {
        let input = stiffness(&path, Some(name)).unwrap();
        assert_eq!(dense(&input), K, "{name}");
        assert!(input.digits.significant <= digits, "{name}: {:?}", input.digits);
    }
    for name in ["i4_big", "i8_big", "u2_big", "u4_big", "u8_big"] {
        let sign = if name.starts_with('u') { f64::abs } else { |x| x };
        assert_eq!(dense(&stiffness(&path, Some(name)).unwrap()), K.map(|row| row.map(sign)), "{name}");
    }
    // One bit of its description is another one.
    let error = stiffness(&path, Some("odd")).unwrap_err();
    assert!(matches!(error, Error::Hdf5Type { expected: "real numbers", .. }), "{error}");
}

/// A sparse matrix of MATLAB has doubles, or marks in a byte each.
#[test]
fn marks_of_matlab_are_no_ones() {
    let (_folder, path) = file_with(|f| {
        let marks = f.create_group("K").unwrap();
        put_attr(&marks, "MATLAB_sparse", &[2_u64]);
        put(&marks, "jc", &[0_u64, 1, 2]);
        put(&marks, "ir", &[0_u64, 1]);
        put(&marks, "data", &[1_u8, 1]);
    });
    let error = stiffness(&path, None).unwrap_err();
    assert!(matches!(&error, Error::Hdf5Type { object, .. } if object == "/K/data"), "{error}");
    assert!(error.to_string().contains("marks of true and false"), "{error}");
}

#[test]
fn a_matrix_that_is_not_square_or_empty_is_refused() {
    let (_folder, path) = file_with(|f| {
        for (name, shape) in [("wide", [1_i64, 2]), ("negative", [-1, -1]), ("three", [1, 1])] {
            put_matrix(f, name, &[0, 1], &[0], &[4.0]);
            let shape = if name == "three" { vec![1, 1, 1] } else { shape.to_vec() };
            put_attr(&f.group(name).unwrap(), "shape", &shape);
        }
        let empty = f.create_group("empty").unwrap();
        put_attr(&empty, "MATLAB_sparse", &[0_u64]);
        put(&empty, "jc", &[0_u64]);
    });
    let refused = |group| stiffness(&path, Some(group)).unwrap_err();
    assert!(matches!(refused("wide"), Error::MatrixSize { n_rows: 1, n_cols: 2, .. }));
    assert!(matches!(refused("negative"), Error::MatrixSize { .. }));
    assert!(matches!(refused("three"), Error::Hdf5Shape { .. }));
    assert!(matches!(refused("empty"), Error::MatrixSize { .. }));
}

#[test]
fn lengths_that_differ_are_refused() {
    let error = refusal(&[0, 1, 2], &[0], &[1.0, 2.0]);
    assert!(matches!(&error, Error::MatrixLength { array, .. } if array == "/K/indices"), "{error}");
    let (_folder, path) = file_with(|f| {
        put_matrix(f, "K", &[0, 1], &[0], &[4.0]);
        put_attr(&f.group("K").unwrap(), "shape", &[2_i64, 2]);
    });
    let error = stiffness(&path, None).unwrap_err();
    assert!(matches!(&error, Error::MatrixLength { array, .. } if array == "/K/indptr"), "{error}");
}

#[test]
fn pointers_that_do_not_rise_from_zero_to_the_number_of_entries_are_refused() {
    for (indptr, at) in [([1, 1, 2], 0), ([0, 3, 2], 2), ([0, 1, 1], 2), ([0, 1, 3], 2), ([0, -1, 2], 1)] {
        let error = refusal(&indptr, &[0, 1], &[1.0, 2.0]);
        assert!(matches!(error, Error::MatrixPointer { position, .. } if position == at), "{indptr:?}: {error}");
    }
}

#[test]
fn an_index_outside_the_matrix_is_refused() {
    for index in [2, -1, 1 << 32, i64::MAX, i64::MIN] {
        let error = refusal(&[0, 1, 2], &[0, index], &[1.0, 2.0]);
        assert!(matches!(error, Error::MatrixIndex { position: 1, found, .. } if found == index), "{error}");
    }
}

#[test]
fn an_unsigned_index_beyond_the_signed_range_is_refused() {
    let (_folder, path) = file_with(|f| {
        put_matrix(f, "K", &[0, 1], &[0], &[4.0]);
        let group = f.group("K").unwrap();
        group.unlink("indices").unwrap();
        put(&group, "indices", &[u64::MAX]);
    });
    assert!(matches!(stiffness(&path, None).unwrap_err(), Error::Hdf5Value { position: 0, .. }));
}

#[test]
fn a_value_that_is_not_finite_is_refused_with_its_row_and_column() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = refusal(&[0, 1, 2], &[0, 0], &[1.0, value]);
        assert!(matches!(error, Error::MatrixNotFinite { row: 2, col: 1, .. }), "{error}");
    }
}

#[test]
fn every_mesh_format_gives_the_same_points() {
    let expected: Vec<[f64; 3]> =
        (0..12).map(|i| [(i / 4) as f64 * 0.5, (i / 2 % 2) as f64 * 0.25, (i % 2) as f64 * 0.125]).collect();
    for file in ["mesh.hmf", "mesh.xdmf", "mesh.med", "mesh.h5m"] {
        let nodes = read_nodes(&fixture(file)).unwrap_or_else(|e| panic!("{file}: {e}"));
        assert_eq!(nodes.coordinates, expected, "{file}");
        let first = if file == "mesh.med" { 101 } else { 1 };
        assert_eq!(nodes.labels, (first..first + 12).collect::<Vec<i64>>(), "{file}");
    }
    let flat: Vec<[f64; 3]> = expected.iter().map(|p| [p[0], p[1], 0.0]).collect();
    assert_eq!(read_nodes(&fixture("flat.xdmf")).unwrap().coordinates, flat);
}

fn group<'a>(nodes: &'a Nodes, name: &str) -> &'a [usize] {
    nodes.groups.get(name).unwrap_or_else(|| panic!("no {name} in {:?}", nodes.groups.keys()))
}

#[test]
fn med_families_become_groups() {
    let nodes = read_nodes(&fixture("mesh.med")).unwrap();
    assert_eq!(group(&nodes, "FOOT"), [0, 1, 2, 3]);
    assert_eq!(group(&nodes, "TIP"), [8, 9, 10, 11]);
    assert_eq!(group(&nodes, "ENDS"), [0, 1, 2, 3, 8, 9, 10, 11]);
    assert_eq!(group(&nodes, "OUTER"), [4, 5, 6, 7, 8, 9, 10, 11]);
    assert_eq!(group(&nodes, "TIP (elements)"), [4, 5, 6, 7, 8, 9, 10, 11]);
    assert_eq!(nodes.groups.len(), 5);
}

#[test]
fn moab_sets_become_groups() {
    let nodes = read_nodes(&fixture("mesh.h5m")).unwrap();
    assert_eq!(group(&nodes, "DIRICHLET_SET 7"), [0, 1, 2, 3]);
    assert_eq!(group(&nodes, "DIRICHLET_SET 8"), [0, 1, 2, 3]);
    assert_eq!(group(&nodes, "NEUMANN_SET 3"), [4, 5, 6, 7, 8, 9, 10, 11]);
    assert_eq!(nodes.groups.len(), 3);
}

/// The error that reading the MED fixture gives after `change`.
fn med_refusal(change: impl FnOnce(&File)) -> Error {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed.med");
    fs::copy(fixture("mesh.med"), &path).unwrap();
    change(&File::open_rw(&path).unwrap());
    read_nodes(&path).unwrap_err()
}

const STEP: &str = "ENS_MAA/BAR/-0000000000000000001-0000000000000000001";

fn overwrite<T: hdf5_metno::H5Type>(file: &File, name: &str, values: &[T]) {
    file.unlink(name).unwrap();
    put(file, name, values);
}

#[test]
fn a_med_file_with_several_meshes_is_refused() {
    let error = med_refusal(|f| drop(f.create_group("ENS_MAA/OTHER").unwrap()));
    assert!(matches!(&error, Error::MeshNotOne { found, kind: "mesh", .. } if found.len() == 2), "{error}");
    let error = med_refusal(|f| drop(f.create_group("ENS_MAA/BAR/2").unwrap()));
    assert!(matches!(error, Error::MeshNotOne { kind: "step", .. }), "{error}");
}

#[test]
fn a_med_mesh_that_is_not_cartesian_or_has_no_dimension_is_refused() {
    let replace = |name: &'static str, value: i64| {
        move |f: &File| {
            let mesh = f.group("ENS_MAA/BAR").unwrap();
            mesh.delete_attr(name).unwrap();
            put_attr(&mesh, name, &[value]);
        }
    };
    assert!(matches!(med_refusal(replace("REP", 1)), Error::MeshUnsupported { .. }));
    assert!(matches!(med_refusal(replace("ESP", 4)), Error::MeshUnsupported { .. }));
    let error = med_refusal(|f| f.group("ENS_MAA/BAR").unwrap().delete_attr("ESP").unwrap());
    assert!(matches!(error, Error::Hdf5Missing { kind: "attribute", .. }), "{error}");
}

#[test]
fn med_arrays_that_do_not_fit_are_refused() {
    let coordinates = med_refusal(|f| overwrite(f, &format!("{STEP}/NOE/COO"), &[0.0; 35]));
    assert!(matches!(coordinates, Error::Hdf5Shape { .. }), "{coordinates}");
    let families = med_refusal(|f| overwrite(f, &format!("{STEP}/NOE/FAM"), &[1; 11]));
    assert!(matches!(families, Error::Hdf5Shape { .. }), "{families}");
    let labels = med_refusal(|f| overwrite(f, &format!("{STEP}/NOE/NUM"), &[1, 2, 3]));
    assert!(matches!(labels, Error::Hdf5Shape { .. }), "{labels}");
    let corners = med_refusal(|f| overwrite(f, &format!("{STEP}/MAI/HE8/NOD"), &[1; 15]));
    assert!(matches!(corners, Error::Hdf5Shape { .. }), "{corners}");
    let corner = med_refusal(|f| overwrite(f, &format!("{STEP}/MAI/HE8/NOD"), &[13; 16]));
    assert!(matches!(corner, Error::Hdf5Index { found: 13, first: 1, last: 12, .. }), "{corner}");
    let names = med_refusal(|f| overwrite(f, "FAS/BAR/NOEUD/FAM_1_FOOT/GRO/NOM", &[1.0]));
    assert!(matches!(names, Error::Hdf5Type { expected: "names of 80 characters", .. }), "{names}");
}

#[test]
fn polygons_in_a_named_group_are_refused() {
    let error = med_refusal(|f| put(&f.group(&format!("{STEP}/MAI/HE8")).unwrap(), "INN", &[1, 9, 17]));
    assert!(matches!(error, Error::MeshUnsupported { .. }), "{error}");
}

#[test]
fn labels_that_repeat_are_refused() {
    let error = med_refusal(|f| overwrite(f, &format!("{STEP}/NOE/NUM"), &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 5]));
    assert!(matches!(error, Error::MeshLabelTwice { label: 5, .. }), "{error}");
}

#[test]
fn coordinates_that_are_not_finite_are_refused() {
    let error = med_refusal(|f| {
        let mut coordinates = [0.0; 36];
        coordinates[12 + 3] = f64::NAN;
        overwrite(f, &format!("{STEP}/NOE/COO"), &coordinates);
    });
    assert!(matches!(error, Error::MeshNotFinite { label: 104, axis: 1, .. }), "{error}");
}

#[test]
fn hdf5_without_a_known_mesh_is_refused_with_what_it_holds() {
    let error = read_nodes(&fixture("mesh.h5")).unwrap_err();
    assert!(matches!(&error, Error::MeshUnknown { holds, .. } if holds == &["/data0", "/flat"]), "{error}");
}

#[test]
fn sets_that_cannot_be_right_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed.h5m");
    let refused = |change: &dyn Fn(&File)| {
        fs::copy(fixture("mesh.h5m"), &path).unwrap();
        change(&File::open_rw(&path).unwrap());
        read_nodes(&path).unwrap_err()
    };
    let beyond = refused(&|f| overwrite(f, "tstt/sets/contents", &[1, 4]));
    assert!(matches!(beyond, Error::Hdf5Index { .. }), "{beyond}");
    let flat = refused(&|f| overwrite(f, "tstt/sets/list", &[1, -1, -1, 2]));
    assert!(matches!(flat, Error::Hdf5Shape { .. }), "{flat}");
    let tags = refused(&|f| overwrite(f, "tstt/tags/NEUMANN_SET/values", &[1, 2]));
    assert!(matches!(tags, Error::Hdf5Shape { .. }), "{tags}");
    // A thousand ranges that name all thousand nodes each: in a larger file this would never end.
    let endless = refused(&|f| {
        f.unlink("tstt/nodes/coordinates").unwrap();
        let nodes = f.new_dataset::<f64>().shape((1000, 3)).create("tstt/nodes/coordinates").unwrap();
        nodes.write_raw(&[0.0; 3000]).unwrap();
        overwrite(f, "tstt/sets/contents", &[1, 1000].repeat(1000));
        f.unlink("tstt/sets/list").unwrap();
        let list = f.new_dataset::<i64>().shape((1, 4)).create("tstt/sets/list").unwrap();
        list.write_raw(&[1999, -1, -1, 8]).unwrap();
        list.new_attr::<i64>().create("start_id").unwrap().write_scalar(&5000).unwrap();
        overwrite(f, "tstt/tags/NEUMANN_SET/id_list", &[5000]);
    });
    assert!(matches!(endless, Error::Hdf5Depth { .. }), "{endless}");
}

/// Writes `mesh.xdmf` next to the data fixture and reads it.
fn xdmf(text: &str) -> Result<Nodes, Error> {
    let folder = tempfile::tempdir().unwrap();
    fs::copy(fixture("mesh.h5"), folder.path().join("mesh.h5")).unwrap();
    let path = folder.path().join("mesh.xdmf");
    fs::write(&path, text).unwrap();
    read_nodes(&path)
}

fn geometry(kind: &str, format: &str, content: &str) -> String {
    format!(
        "<Xdmf><Domain><Grid><Geometry GeometryType=\"{kind}\"><DataItem Dimensions=\"12 3\" Format=\"{format}\">{content}\
         </DataItem></Geometry></Grid></Domain></Xdmf>"
    )
}

#[test]
fn an_xdmf_reference_out_of_the_folder_is_refused() {
    for reference in [
        "/etc/mesh.h5:/data0",
        "../mesh.h5:/data0",
        "a/../../mesh.h5:/data0",
        "..\\mesh.h5:/data0",
        "mesh.h5",
        ":/data0",
    ] {
        let error = xdmf(&geometry("XYZ", "HDF", reference)).unwrap_err();
        assert!(matches!(error, Error::XdmfReference { .. }), "{reference}: {error}");
    }
    assert!(xdmf(&geometry("XYZ", "HDF", " ./mesh.h5:/data0\n")).is_ok());
}

/// Through a link to the document alone: the data are where the document is, unless the folder of the link has such a file.
#[cfg(unix)]
#[test]
fn xdmf_through_a_link_finds_its_data() {
    let (own, named) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    fs::copy(fixture("mesh.h5"), own.path().join("mesh.h5")).unwrap();
    fs::write(own.path().join("mesh.xdmf"), geometry("XYZ", "HDF", "mesh.h5:/data0")).unwrap();
    let link = named.path().join("link.xdmf");
    std::os::unix::fs::symlink(own.path().join("mesh.xdmf"), &link).unwrap();
    assert_eq!(read_nodes(&link).unwrap().labels.len(), 12);
    fs::write(named.path().join("mesh.h5"), b"another").unwrap();
    let error = read_nodes(&link).unwrap_err();
    assert!(matches!(&error, Error::Hdf5Signature { path, .. } if path.starts_with(named.path())), "{error}");
}

#[test]
fn xdmf_that_is_no_xml_or_defines_entities_is_refused() {
    assert!(matches!(xdmf("<Xdmf>").unwrap_err(), Error::XdmfSyntax { .. }));
    let laugh = |n: usize| format!("<!ENTITY l{n} \"{}\">", format!("&l{};", n - 1).repeat(10));
    let laughs: String = (1..12).map(laugh).collect();
    let content = geometry("XYZ", "XML", "&l11;");
    for declared in [
        "<!DOCTYPE Xdmf [<!ENTITY a \"b\">]>".to_owned(),
        format!("<!DOCTYPE Xdmf [<!ENTITY l0 \"1 \">{laughs}]>"),
        "<!DOCTYPE Xdmf [<!ENTITY l11 SYSTEM \"mesh.h5\">]>".to_owned(),
        "<!DOCTYPE Xdmf [<!ELEMENT Xdmf ANY>]>".to_owned(),
    ] {
        let start = std::time::Instant::now();
        let error = xdmf(&(declared + &content)).unwrap_err();
        assert!(matches!(error, Error::MeshUnsupported { .. }), "{error}");
        // Expanded it would be 10¹¹ numbers.
        assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
    }
}

/// The document type that FEniCS and XDMF 2 write; the file it names is not there and is not looked for.
#[test]
fn xdmf_with_a_document_type_is_read() {
    let plain = geometry("XYZ", "HDF", "mesh.h5:/data0");
    let expected = xdmf(&plain).unwrap().coordinates;
    for declared in
        ["<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>", "<!DOCTYPE Xdmf SYSTEM \"/etc/passwd\">", "<!DOCTYPE Xdmf>"]
    {
        assert_eq!(xdmf(&format!("<?xml version=\"1.0\" ?>\n{declared}\n{plain}")).unwrap().coordinates, expected);
    }
}

#[test]
fn xdmf_nested_very_deeply_is_read_or_refused() {
    let depth = 100_000;
    let text = format!("{}{}", "<Grid>".repeat(depth), "</Grid>".repeat(depth));
    assert!(xdmf(&text).is_err());
}

#[test]
fn xdmf_with_no_or_several_geometries_is_refused() {
    let none = xdmf("<Xdmf/>").unwrap_err();
    assert!(matches!(&none, Error::MeshNotOne { found, .. } if found.is_empty()), "{none}");
    let two =
        "<Xdmf><Geometry><DataItem>0 0 0</DataItem></Geometry><Geometry><DataItem>1 1 1</DataItem></Geometry></Xdmf>";
    assert!(matches!(xdmf(two).unwrap_err(), Error::MeshNotOne { found, .. } if found.len() == 2));
    let same =
        "<Xdmf><Geometry><DataItem>0 0 0</DataItem></Geometry><Geometry><DataItem>0 0 0</DataItem></Geometry></Xdmf>";
    assert_eq!(xdmf(same).unwrap().coordinates, [[0.0; 3]]);
}

#[test]
fn xdmf_geometries_that_are_not_lists_of_points_are_refused() {
    for text in [
        geometry("ORIGIN_DXDYDZ", "HDF", "mesh.h5:/data0"),
        geometry("XYZ", "Binary", "mesh.bin"),
        "<Xdmf><Geometry/></Xdmf>".to_owned(),
        "<Xdmf><Geometry><DataItem Reference=\"XML\">/x</DataItem></Geometry></Xdmf>".to_owned(),
    ] {
        let error = xdmf(&text).unwrap_err();
        assert!(matches!(error, Error::MeshUnsupported { .. }), "{error}");
    }
    let short = xdmf(&geometry("XYZ", "HDF", "mesh.h5:/flat")).unwrap_err();
    assert!(matches!(short, Error::Hdf5Shape { .. }), "{short}");
    let word = xdmf(&geometry("XYZ", "XML", "0 0 x")).unwrap_err();
    assert!(matches!(word, Error::Hdf5Type { expected: "real numbers", .. }), "{word}");
}

#[test]
fn no_cut_of_a_file_panics() {
    let folder = tempfile::tempdir().unwrap();
    let of_matrices = ["octave.h5", "julia.h5", "binsparse.h5"].map(|name| format!("../matrices/{name}"));
    let of_meshes = ["box.e", "box.cgns", "box.vtkhdf", "box.hmf"].map(|name| format!("../mesh/{name}"));
    let own = ["matlab.mat", "anndata.h5ad", "plain.h5", "h5sparse.h5", "exudyn.hdf5", "half.h5"];
    let meshes = ["mesh.med", "mesh.h5m", "mesh.hmf"];
    let files = own.into_iter().chain(meshes).map(str::to_owned).chain(of_matrices).chain(of_meshes);
    for name in files {
        let bytes = fs::read(fixture(&name)).unwrap();
        let file = name.rsplit('/').next().unwrap();
        let path = folder.path().join(file);
        // Every length of the smallest, and of the others below the first 100 bytes; then a prime step, so that every structure is cut
        // somewhere.
        let step = if bytes.len() < 1 << 12 { 1 } else { 89 };
        for length in (0..100).chain((100..bytes.len()).step_by(step)) {
            fs::write(&path, &bytes[..length]).unwrap();
            for error in [stiffness(&path, None).err(), read_nodes(&path).err()] {
                let said = error.unwrap_or_else(|| panic!("{name} cut to {length} bytes")).to_string();
                assert!(said.contains(file), "{name} cut to {length} bytes: {said}");
            }
        }
    }
}

#[test]
fn reading_from_several_threads_gives_the_same() {
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                for _ in 0..20 {
                    assert_eq!(dense(&stiffness(&fixture("anndata.h5ad"), None).unwrap()), K);
                    assert_eq!(read_nodes(&fixture("mesh.med")).unwrap().groups.len(), 5);
                }
            });
        }
    });
}

#[test]
fn corpus_matrices_are_read_or_refused_by_name() {
    let Some(folder) = corpus("h5sparse") else { return };
    let read = |file: &str, group| stiffness(&folder.join(file), group);
    let counts = |file: &str, group| {
        let input = read(file, Some(group)).unwrap_or_else(|e| panic!("{file}:{group}: {e}"));
        (input.matrix.rows(), input.matrix.nnz())
    };
    assert_eq!(counts("MAT_v7.3_sparse.mat", "sparse_eye"), (20, 20));
    assert_eq!(counts("MAT_v7.3_sparse.mat", "sparse_zeros"), (20, 0));
    assert!(matches!(read("MAT_v7.3_sparse.mat", Some("sparse_logical")), Err(Error::Hdf5Type { .. })));
    assert_eq!(counts("anndata_v0.5.0_adata.h5ad", "uns/neighbors/connectivities"), (700, 9992));
    assert_eq!(counts("anndata_v0.5.0_adata.h5ad", "uns/neighbors/distances"), (700, 6300));
    let petsc = read("petsc_matrices_tiny_system_with_x0.mat", None).unwrap();
    assert_eq!((petsc.matrix.rows(), petsc.matrix.nnz()), (4, 10));

    let refused = |file, group| read(file, group).unwrap_err();
    assert!(matches!(refused("MAT_v7.3_sparse.mat", None), Error::MatrixAmbiguous { .. }));
    assert!(matches!(refused("MAT_v7.3_sparse.mat", Some("sparse_empty")), Error::MatrixSize { .. }));
    assert!(matches!(refused("MAT_v7.3_sparse.mat", Some("sparse_complex")), Error::Hdf5Type { .. }));
    assert!(matches!(refused("MAT_v7.3_partial.mat", None), Error::Hdf5NoMatrix { .. }));
    assert!(matches!(refused("MAT_v7_sparse.mat", None), Error::FormatNotRead { .. }));
    assert!(matches!(refused("anndata_v0.5.0_adata.h5ad", None), Error::MatrixAmbiguous { .. }));
    assert!(matches!(refused("anndata_v0.5.0_adata.h5ad", Some("raw.X")), Error::MatrixSize { .. }));
    assert!(matches!(refused("anndata_v0.7.0_adata.h5ad", Some("obsp/sparse")), Error::Hdf5Filter { .. }));
    assert!(matches!(refused("mat7.3_tests_testfile6.mat", None), Error::Hdf5NoMatrix { .. }));
    assert!(matches!(refused("mat7.3_tests_testfile8.mat", None), Error::Hdf5NoMatrix { .. }));
}

#[test]
fn corpus_meshes_give_their_nodes_or_are_refused_by_name() {
    let Some(folder) = corpus("meshes") else { return };
    for (file, n_nodes) in [
        ("h5m/MOAB2_3k-tri-cube.h5m", 1472),
        ("h5m/MOAB2_64bricks_1khex.h5m", 2197),
        ("h5m/MOAB2_brick.h5m", 137),
        ("h5m/MOAB2_hex_2048.h5m", 2601),
        ("h5m/MOAB2_portable_x86_32.h5m", 81),
        ("h5m/MOAB2_portable_x86_64.h5m", 81),
        ("h5m/MOAB2_quad_1000.h5m", 1071),
        ("h5m/MOAB2_twoPolyh.h5m", 12),
        ("h5m/petsc_ex35_mesh.h5m", 344),
        ("med/AsterReader_hexmeshOverlappingGroups.med", 480),
        ("med/AsterReader_peruna.med", 135),
        ("med/AsterReader_quad4.med", 4),
        ("med/JuliaFEM_JuliaFEMSMP18.med", 14078),
        ("med/JuliaFEM_joint.med", 6361),
        ("med/JuliaFEM_model.med", 360),
        ("med/adapy_Cantilever_CA_EIG_bm.rmed", 51),
        ("med/adapy_Cantilever_CA_EIG_sh.rmed", 459),
        ("med/adapy_box.med", 8),
        ("med/code_aster_sslp119a.med", 6601),
        ("med/code_aster_xxModalMechanics001a.med", 557),
        ("med/code_aster_zzzz413c.med", 296),
        ("xdmf/meshio/out.xdmf", 4),
    ] {
        let nodes = read_nodes(&folder.join(file)).unwrap_or_else(|e| panic!("{file}: {e}"));
        assert_eq!((nodes.coordinates.len(), nodes.labels.len()), (n_nodes, n_nodes), "{file}");
    }
    for (folder_name, file) in [("cgns", ".cgns"), ("nastran_h5", ".h5"), ("petsc_dmplex", ".h5"), ("vtkhdf", ".hdf")] {
        for entry in fs::read_dir(folder.join(folder_name)).unwrap() {
            let path = entry.unwrap().path();
            assert!(path.to_string_lossy().ends_with(file));
            let adf = path.to_string_lossy().contains(".adf.");
            match read_nodes(&path) {
                Ok(nodes) => assert!(matches!(folder_name, "cgns" | "vtkhdf") && !nodes.labels.is_empty(), "{path:?}"),
                Err(Error::Hdf5Signature { .. }) => assert!(adf, "{path:?}"),
                Err(error) => assert!(error.to_string().contains(file), "{path:?}: {error}"),
            }
        }
    }
}

#[test]
fn corpus_meshes_written_in_four_formats_agree() {
    let Some(folder) = corpus("meshes/meshio_written") else {
        return;
    };
    for (mesh, n_nodes) in [("brick_tet", 137), ("joint", 6361), ("plate_quad", 6601)] {
        let read =
            |kind: &str| read_nodes(&folder.join(format!("{mesh}.{kind}"))).unwrap_or_else(|e| panic!("{mesh}: {e}"));
        let first = read("med").coordinates;
        assert_eq!(first.len(), n_nodes);
        for kind in ["hmf", "h5m", "xdmf"] {
            assert_eq!(read(kind).coordinates, first, "{mesh}.{kind}");
        }
    }
}

#[test]
fn corpus_med_groups_are_read_by_name() {
    let Some(folder) = corpus("meshes/med") else { return };
    let read = |file: &str| read_nodes(&folder.join(file)).unwrap_or_else(|e| panic!("{file}: {e}"));
    let quad = read("AsterReader_quad4.med");
    assert_eq!(group(&quad, "TOP_LEFT").len(), 1);
    assert_eq!(group(&quad, "TOP").len(), 2);
    assert_eq!(group(&quad, "BLOCK").len(), 4);
    let names: Vec<&str> = quad.groups.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        ["BLOCK", "BOTTOM", "BOTTOM_LEFT", "BOTTOM_RIGHT", "LEFT", "RIGHT", "TOP", "TOP_LEFT", "TOP_RIGHT"]
    );
    let [left, top] = ["LEFT", "TOP"].map(|name| group(&quad, name));
    let corner: Vec<&usize> = left.iter().filter(|n| top.contains(n)).collect();
    assert_eq!(corner, [&group(&quad, "TOP_LEFT")[0]]);
    let hexes = read("AsterReader_hexmeshOverlappingGroups.med");
    assert!(group(&hexes, "halfhex").iter().any(|n| group(&hexes, "mosthex").contains(n)));
    let box_ = read("adapy_box.med");
    assert_eq!((group(&box_, "Left").len(), group(&box_, "Right").len()), (4, 4));
    let joint = read("JuliaFEM_joint.med");
    assert_eq!(joint.groups.len(), 6);
}

/// A further matrix keeps its entries where they are. Only the layout of MATLAB says which index is that of the rows: any other serves
/// symmetric matrices.
#[test]
fn further_matrices_are_not_mirrored() {
    let further = |path: &Path, group: &str| read_matrix(path, Some(group), MatrixRole::Further);
    let (_folder, path) = file_with(|file| {
        // Columns 0, 1, 2 with entries 5 at (1, 0) and 7 at (2, 1).
        let matlab = file.create_group("C").unwrap();
        put_attr(&matlab, "MATLAB_sparse", &[3_u64]);
        put(&matlab, "jc", &[0_u64, 1, 2, 2]);
        put(&matlab, "ir", &[1_u64, 2]);
        put(&matlab, "data", &[5.0, 7.0]);
        put_matrix(file, "one_side", &[0, 1, 2, 2], &[1, 2], &[5.0, 7.0]);
        put_matrix(file, "both_sides", &[0, 1, 2, 2], &[1, 0], &[5.0, 5.0]);
    });
    let matrix = further(&path, "/C").unwrap().matrix;
    let entries: Vec<_> = matrix.iter().map(|(value, at)| (at, *value)).collect();
    assert_eq!(entries, [((1, 0), 5.0), ((2, 1), 7.0)]);
    let error = further(&path, "/one_side").unwrap_err();
    assert!(matches!(&error, Error::Hdf5Orientation { group, .. } if group == "/one_side"), "{error}");
    assert_eq!(error.code(), "E-HDF5-ORIENTATION");
    assert_eq!(further(&path, "/both_sides").unwrap().matrix.nnz(), 2);
}
