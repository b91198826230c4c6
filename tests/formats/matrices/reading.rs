//! Every file of the fixtures gives the matrices that it was made from, to the bit.

use supel::dofs::{Direction, Dof};
use supel::error::Error;
use supel::input::{Allowance, Digits, SingleMatrix, read};
use supel::job::ModelJob;
use supel::sparse::Given;

use super::{fixture, job, pair, stiffness};

/// Files that hold K, or K and M, in doubles; of one that holds several matrices both are taken by their names alone.
const FILES: [[&str; 2]; 29] = [
    ["k_csr.npz", "m_csc.npz"],
    ["k_csc.npz", "m_csc.npz"],
    ["k_coo.npz", "m_csc.npz"],
    ["k_bsr.npz", "m_csc.npz"],
    ["k_bsr_wide.npz", "m_csc.npz"],
    ["k_dia.npz", "m_csc.npz"],
    ["k_bsr_fortran.npz", "m_csc.npz"],
    ["k_dia_fortran.npz", "m_csc.npz"],
    ["k_coords_fortran.npz", "m_csc.npz"],
    ["k_reserve.npz", "m_csc.npz"],
    ["k_bsr_reserve.npz", "m_csc.npz"],
    ["dense.npz", "dense.npz"],
    ["dense.npz:K", "dense.npz:M"],
    ["k.npy", "m_fortran_big.npy"],
    ["sparse.mat", "sparse.mat"],
    ["sparse_deflated.mat", "sparse_deflated.mat:m"],
    ["sparse_big.mat", "m.mtx"],
    ["dense.mat", "dense.mat"],
    ["dense_text.op4", "dense_text.op4"],
    ["dense_little.op4:KAA", "dense_little.op4:MAA"],
    ["dense_big_endian.op4", "dense_big_endian.op4"],
    ["big_text.op4", "big_text.op4"],
    ["big_little.op4", "big_little.op4"],
    ["big_big_endian.op4", "big_big_endian.op4"],
    ["string_text.op4", "string_text.op4"],
    ["string_little.op4", "string_little.op4"],
    ["string_big_endian.op4", "string_big_endian.op4"],
    ["wide_words.op4", "m.mtx"],
    ["k.rsa", "m.rsa"],
];

#[test]
fn every_bit_is_that_of_matrix_market() {
    let reference = pair("k.mtx", "m.mtx").expect("the reference");
    for [k, m] in FILES {
        let input = pair(k, m).unwrap_or_else(|error| panic!("{k}, {m}: {error}"));
        assert!(input.stiffness.matrix == reference.stiffness.matrix, "{k}: {:?}", input.stiffness.matrix);
        assert!(input.mass.matrix == reference.mass.matrix, "{m}: {:?}", input.mass.matrix);
        assert_eq!(input.stiffness.digits, Digits::DOUBLE, "{k}");
        assert_eq!(input.stiffness.notes.n_duplicates, 0, "{k}");
        assert_eq!(input.stiffness.digest.len(), 64, "{k}");
        assert!(input.dofs.is_none(), "{k} names no rows");
    }
}

/// Half precision has three digits, whatever its numbers are.
#[test]
fn arrays_in_half_precision() {
    let reference = pair("k_short.mtx", "m_short.mtx").expect("the reference");
    let half = pair("k_half.npy", "m_short.mtx").expect("half precision");
    assert!(half.stiffness.matrix == reference.stiffness.matrix, "{:?}", half.stiffness.matrix);
    assert_eq!(half.stiffness.digits.significant, 3);
}

/// `array` lists every value of a general matrix, and those from the diagonal down of a symmetric one.
#[test]
fn arrays_of_matrix_market() {
    let folder = tempfile::tempdir().expect("a folder");
    let k = pair("k.mtx", "m.mtx").expect("the reference").stiffness.matrix;
    let value = |row: usize, col: usize| k.get(row, col).copied().unwrap_or(0.0);
    for (symmetry, first) in [("general", [0; 6]), ("symmetric", [0, 1, 2, 3, 4, 5])] {
        let values: Vec<String> =
            (0..6).flat_map(|col| (first[col]..6).map(move |row| format!("{:e}", value(row, col)))).collect();
        let head = format!("%%MatrixMarket matrix array real {symmetry}\n% by hand\n6 6\n");
        let path = folder.path().join("a.mtx");
        std::fs::write(&path, head.clone() + &values.join("\n") + "\n").expect("written");
        assert!(stiffness(&path).expect("an array") == k, "{symmetry}");
        std::fs::write(&path, head.clone() + &values[1..].join("\n") + "\n").expect("written");
        let n = values.len() as u64;
        let error = stiffness(&path).expect_err("one too few");
        assert!(
            matches!(error, Error::EntryCount { line, declared, found, .. } if (line, declared, found) == (n + 2, n, n - 1)),
            "{error}"
        );
        std::fs::write(&path, head + &values.join("\n") + "\n1\n").expect("written");
        assert!(matches!(stiffness(&path), Err(Error::EntriesSurplus { .. })), "{symmetry}");
    }
}

fn labels(nodes: [(i64, u8); 6]) -> Vec<Option<Dof>> {
    let dof = |(node, component): (i64, u8)| {
        (component > 0).then(|| Dof { node, direction: Direction::ALL[usize::from(component) - 1] })
    };
    nodes.map(dof).to_vec()
}

/// What each row of the fixtures is: two nodes and a scalar point.
const CHAIN: [(i64, u8); 6] = [(1, 1), (1, 2), (1, 3), (7, 1), (7, 2), (20, 0)];

#[test]
fn dmig_brings_its_dof_map() {
    let reference = pair("k_short.mtx", "m_short.mtx").expect("the reference");
    for [k, m] in [
        ["k_large.pch", "m_large.pch"],
        ["free.bdf", "m_large.pch"],
        ["small.bdf", "small.bdf"],
        ["small.bdf:K2PP", "small.bdf:m2pp"],
    ] {
        let input = pair(k, m).unwrap_or_else(|error| panic!("{k}, {m}: {error}"));
        assert!(input.stiffness.matrix == reference.stiffness.matrix, "{k}: {:?}", input.stiffness.matrix);
        assert!(input.mass.matrix == reference.mass.matrix, "{m}: {:?}", input.mass.matrix);
        assert_eq!(input.dofs.as_deref(), Some(labels(CHAIN).as_slice()), "{k}");
        assert_eq!(input.stiffness.notes.given, Given::Whole, "the form says that one triangle stands for both");
    }
    let unsymmetric = stiffness(&fixture("k.rua")).expect("whole");
    assert!(unsymmetric == reference.stiffness.matrix);
}

/// The internal node −1 comes first, and is scalar; each pair stands once, in either order.
#[test]
fn matrix_lines_of_abaqus_bring_their_dof_map() {
    let reference = pair("k.mtx", "m.mtx").expect("the reference");
    let input = pair("k_labels.mtx", "m_labels.mtx").expect("both");
    let place = |row: usize| if row == 5 { 0 } else { row + 1 };
    for (of_reference, found) in
        [(&reference.stiffness, &input.stiffness), (&reference.mass, &input.mass)].map(|(a, b)| (&a.matrix, &b.matrix))
    {
        assert_eq!(of_reference.nnz(), found.nnz());
        for (value, (row, col)) in of_reference {
            assert_eq!(found.get(place(row as usize), place(col as usize)), Some(value), "{row} {col}");
        }
    }
    let mut expected = labels(CHAIN);
    expected.rotate_right(1);
    assert_eq!(input.dofs, Some(expected));
    assert!(matches!(input.stiffness.notes.given, Given::EitherOrder { .. }), "{:?}", input.stiffness.notes);
    assert!(input.notes.iter().any(|note| note.to_string().contains("6 rows are named")));
}

/// Rows that the matrices name are put in the order of a dof map; further ones of one matrix alone are in both.
#[test]
fn rows_follow_the_dof_map_or_both_matrices() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        path
    };
    let k = write("k.mtx", "3, 1, 3, 1, 2.0\n3, 2, 3, 1, -1.0\n3, 2, 3, 2, 2.0\n");
    let m = write("m.mtx", "3, 1, 3, 1, 4.0\n5, 1, 5, 1, 8.0\n");
    let joined = read(&job(&k, &m)).expect("on rows of both");
    assert_eq!(joined.stiffness.matrix.rows(), 3);
    assert_eq!((joined.mass.matrix.get(2, 2), joined.stiffness.matrix.get(0, 1)), (Some(&8.0), Some(&-1.0)));
    let map = write("map.csv", "node,dof\n5,1\n3,2\n3,1\n");
    let mapped = read(&ModelJob { dofs: Some(map), ..job(&k, &m) }).expect("in the order of the map");
    assert_eq!((mapped.mass.matrix.get(0, 0), mapped.stiffness.matrix.get(2, 2)), (Some(&8.0), Some(&2.0)));
    assert_eq!((mapped.mass.matrix.get(2, 2), mapped.stiffness.matrix.get(1, 2)), (Some(&4.0), Some(&-1.0)));
    let short = write("short.csv", "node,dof\n3,2\n3,1\n");
    let error = read(&ModelJob { dofs: Some(short), ..job(&k, &m) }).expect_err("a node that the map lacks");
    assert!(matches!(&error, Error::RowUnknown { missing, n_rows: 2, .. } if missing == &["node 5 ux"]), "{error}");
    let bare = write("bare.mtx", "1 1 1.0\n2 2 1.0\n3 3 1.0\n");
    let error = read(&job(&k, &bare)).expect_err("rows without a name");
    assert!(matches!(&error, Error::RowsUnnamed { path, .. } if path == &bare), "{error}");
}

/// What HBMAT writes next to a matrix, its equations in any order, and bulk data without EXTRN.
#[test]
fn dof_maps_of_ansys_and_nastran() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        path
    };
    let mapping = "  Matrix Eqn      Node       DOF\n      2       1     UY\n      1       1     UX\n      3       1     UZ\n\
        4       7     UX\n      5       7     UY\n      6      20     PRES\n";
    let of_map = |path| read(&ModelJob { dofs: Some(path), ..job(&fixture("k.rsa"), &fixture("m.rsa")) });
    let input = of_map(write("k.mapping", mapping)).expect("a mapping");
    assert_eq!(input.dofs, Some(labels(CHAIN)));
    let bulk = "BEGIN BULK\nSPOINT,20\nGRID,3,,0.,0.,0.\n";
    let error = of_map(write("a.bdf", bulk)).expect_err("seven rows");
    assert!(matches!(error, Error::DofCount { found: 7, n: 6, .. }), "{error}");
    // A range is a few characters for as many points as it likes.
    let points = of_map(write("b.bdf", "SPOINT,1,THRU,6\n")).expect("six scalar points");
    assert_eq!(points.dofs.map(|dofs| dofs.len()), Some(6));
    for range in ["SPOINT,1,THRU,9223372\n", "SPOINT,1,THRU,4\nSPOINT,11,THRU,13\n"] {
        let error = of_map(write("c.bdf", range)).expect_err("more points than rows");
        assert!(error.to_string().contains("no more points than the 6 rows of the matrices"), "{error}");
    }
    let listed = "BEGIN SUPER 1\nEXTRN,1,123,7,12,20,0\n";
    assert_eq!(of_map(write("a.pch", listed)).expect("as EXTRN lists them").dofs, Some(labels(CHAIN)));
    for (text, words) in [
        ("Eqn Node DOF\n1 1 UX\n2 1 UQ\n", "line 3"),
        ("Eqn Node DOF\n1 1 UX\n3 1 UY\n", "2"),
        ("BEGIN SUPER 1\nEXTRN,1,127\n", "components from 1 to 6"),
    ] {
        let error = of_map(write("wrong", text)).expect_err("no map").to_string();
        assert!(error.contains(words) && error.contains("wrong"), "{error}");
    }
}

#[test]
fn packed_files_are_what_they_hold() {
    use std::io::Write;
    let folder = tempfile::tempdir().expect("a folder");
    let reference = pair("k.mtx", "m.mtx").expect("the reference").stiffness.matrix;
    for name in ["k.mtx", "dense_text.op4", "string_little.op4", "sparse.mat", "k.npy", "k.rsa"] {
        let content = std::fs::read(fixture(name)).expect("a fixture");
        let gzipped = {
            let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
            encoder.write_all(&content).and_then(|()| encoder.finish()).expect("gzipped")
        };
        let bzipped = {
            let mut encoder = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::best());
            encoder.write_all(&content).and_then(|()| encoder.finish()).expect("packed")
        };
        let frame = |part: &[u8]| ruzstd::encoding::compress_to_vec(part, ruzstd::encoding::CompressionLevel::Fastest);
        // Two frames, and one between them that is to be skipped.
        let (front, back) = content.split_at(content.len() / 2);
        let skipped = [&b"\x50\x2a\x4d\x18\x03\0\0\0"[..], b"abc"].concat();
        let zstd = [frame(front), skipped, frame(back)].concat();
        for (packed, ending) in [(gzipped, "gz"), (bzipped, "bz2"), (zstd, "zst")] {
            let path = folder.path().join(format!("{name}.{ending}"));
            std::fs::write(&path, &packed).expect("written");
            let read = stiffness(&path).unwrap_or_else(|error| panic!("{name}.{ending}: {error}"));
            assert!(read == reference, "{name}.{ending}");
            let cut = folder.path().join(format!("cut.{name}.{ending}"));
            std::fs::write(&cut, &packed[..packed.len() - 6]).expect("written");
            assert!(stiffness(&cut).is_err(), "{name}.{ending} cut short");
        }
    }
}

/// As Fortran reads them: without a point the last digits before the exponent are decimals, without an exponent the scale counts.
#[test]
fn decimals_that_a_format_implies() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("k.rsa");
    for (format, values) in [
        ("(3F10.3)", ["1500", "2000.", "-3"]),
        ("(3E10.2)", ["15E1", "2.0E3", "-3-1"]),
        ("(1P,3D10.3)", ["15D2", "2.D+3", "-30"]),
        ("(3F10.0)", ["1.5", "2000", "-.003"]),
    ] {
        let values: String = values.iter().map(|value| format!("{value:>10}")).collect();
        let text = format!(
            "a\n 3 1 1 1\nRSA           3 3 3 0\n(4I4)           (3I4)           {format:<20}\n   1   2   3   4\n   1   2   3\n{values}\n"
        );
        std::fs::write(&path, text).expect("written");
        let matrix = SingleMatrix { file: path.clone(), layout: None, dofs: None };
        let read = matrix.read(&Allowance::of(None)).unwrap_or_else(|error| panic!("{format}: {error}"));
        let diagonal: Vec<f64> = (0..3).filter_map(|row| read.input.matrix.get(row, row).copied()).collect();
        assert_eq!(diagonal, [1.5, 2000.0, -0.003], "{format}");
    }
}

/// Groups in brackets, with blanks before each number, within twenty columns and beyond.
#[test]
fn formats_with_groups_in_brackets() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("k.rsa");
    let numbers = |width: usize| ["1.5", "2000.0", "-3.0"].map(|value| format!("{value:>width$}"));
    // A scale counts where there is no exponent.
    let scaled = ["1.5E0", "2.0E3", "-3.0E0"].map(|value| format!("{value:>10}"));
    let far = |between: &str| numbers(10).map(|value| format!("{between}{value}")).concat();
    for (formats, pointers, values) in [
        ("(4(1X,I3))      (3I4)           (3(1X,F10.3))", "   1   2   3   4", far(" ")),
        (
            "(4I4)           (3I4)           (1P,3(2X,E10.2))",
            "   1   2   3   4",
            scaled.clone().map(|value| format!("  {value}")).concat(),
        ),
        (
            "(2(1X,I3))      (3I4)           (2(2X,D10.2))",
            "   1   2\n   3   4",
            far("  ").replacen("  2000.0", "  2000.0\n", 1),
        ),
        (
            "(2(2(1X,I3))) (3(1X,I3)) (3(2X,1P,E10.2,1X))",
            "   1   2   3   4",
            scaled.map(|value| format!("  {value} ")).concat(),
        ),
        // Without blanks the numbers are where the format says, and nothing else.
        ("(4I4)           (3I4)           (3(2X,F6.1))", "   1   2   3   4", "xx1.5   xx2000.0xx-3.0  ".to_owned()),
    ] {
        let text = format!("a\n 3 1 1 1\nRSA           3 3 3 0\n{formats}\n{pointers}\n   1   2   3\n{values}\n");
        std::fs::write(&path, text).expect("written");
        let matrix = SingleMatrix { file: path.clone(), layout: None, dofs: None };
        let read = matrix.read(&Allowance::of(None)).unwrap_or_else(|error| panic!("{formats}: {error}"));
        let diagonal: Vec<f64> = (0..3).filter_map(|row| read.input.matrix.get(row, row).copied()).collect();
        assert_eq!(diagonal, [1.5, 2000.0, -3.0], "{formats}");
    }
}
