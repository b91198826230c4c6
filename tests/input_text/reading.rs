//! What is read, and what readers say about it.

use std::path::Path;

use proptest::prelude::*;
use supel::input::{InputNote, read};
use supel::sparse::Given;

use crate::{Folder, dense, gzip, job, mtx, read_text};

const SPRING: &str = "%%MatrixMarket matrix coordinate real symmetric\n% two nodes\n2 2 3\n1 1 2.5\n2 1 -2.5\n2 2 4\n";

fn spring() -> Vec<Vec<f64>> {
    vec![vec![2.5, -2.5], vec![-2.5, 4.0]]
}

#[test]
fn one_triangle_stands_for_both() {
    let input = read_text(SPRING).expect("a matrix");
    assert_eq!(dense(&input), spring());
    assert!(input.notes.is_empty(), "{:?}", input.notes);
    assert!(input.dofs.is_none() && input.nodes.is_none());
}

/// Of a regular mesh or a uniform beam: a handful of different numbers, which show no pattern.
#[test]
fn few_numbers_in_a_fixed_format_have_its_digits() {
    let text = |values: [&str; 4]| {
        let [a, b, c, d] = values;
        format!("%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n1 1 {a}\n2 2 {b}\n3 3 {c}\n2 1 {b}\n3 2 {d}\n")
    };
    for (values, digits) in [
        (["1.31e-02", "6.54e-03", "-3.27e-03", "1.50e-03"], 3),
        (["1.5703e-01", "1.7494e-01", "2.0171e+03", "0.0000e+00"], 5),
        (["1.5700e-01", "1.7494e-01", "2.0171e+03", "1.5000e+00"], 5),
        (["1.0000e+02", "2.5000e-01", "1.0025e+02", "1.5000e+00"], 17),
        (["2.50e+00", "1.20e+01", "4.00e+00", "1.25e+00"], 17),
        (["2.5", "1.25", "4", "3.75"], 17),
        (["1e0", "2e0", "-5e-1", "4e0"], 17),
    ] {
        assert_eq!(read_text(text(values)).expect("a matrix").stiffness.digits.significant, digits, "{values:?}");
    }
}

/// A name that another format has does not keep a matrix from being read; without a banner the name decides.
#[test]
fn a_matrix_is_recognised_by_its_content() {
    let folder = Folder::new();
    for name in ["K.h5", "K.mat", "K.HDF5", "K"] {
        for text in [SPRING.to_owned(), format!("\u{feff}{SPRING}"), SPRING.replace("MatrixMarket", "MATRIXMARKET")] {
            let path = folder.write(name, &text);
            let input = read(&job(&path, &path)).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!(dense(&input), spring(), "{name}");
        }
    }
    let bare = folder.write("bare.h5", "1 1 2.5\n2 1 -2.5\n2 2 4\n");
    let code = read(&job(&bare, &bare)).expect_err("no HDF5").code();
    assert!(matches!(code, "E-HDF5-SIGNATURE" | "E-FEATURE"), "{code}");
}

#[test]
fn writing_habits_do_not_matter() {
    let habits = [
        SPRING.replace('\n', "\r\n"),
        format!("\u{feff}{SPRING}"),
        SPRING.replace("2 1 -2.5", "\t 2\t1   -2.5\t "),
        SPRING.replace("-2.5", "-0.25D+01"),
        SPRING.replace("-2.5", "-25d-1").replace("4", "+4.000E0"),
        SPRING.replace("2 1", "\n% a comment\n\n2 1"),
        SPRING.replace("%%MatrixMarket matrix coordinate real", "%%matrixmarket MATRIX Coordinate REAL"),
        SPRING.replace("2 1 -2.5", "1 2 -2.5"),
        SPRING.trim_end().to_owned(),
    ];
    for text in habits {
        assert_eq!(dense(&read_text(&text).expect("a matrix")), spring(), "{text:?}");
    }
}

#[test]
fn integers_are_numbers() {
    let text = SPRING.replace("real", "integer").replace(".5", "");
    assert_eq!(dense(&read_text(text).expect("a matrix")), [[2.0, -2.0], [-2.0, 4.0]]);
}

#[test]
fn gzip_is_told_by_content_and_may_have_members() {
    let (head, tail) = SPRING.split_at(70);
    let members = [gzip(head.as_bytes()), gzip(tail.as_bytes())].concat();
    for bytes in [gzip(SPRING.as_bytes()), members] {
        assert_eq!(dense(&read_text(bytes).expect("a matrix")), spring());
    }
}

#[test]
fn the_digest_is_that_of_the_bytes_on_disk() {
    for bytes in [SPRING.as_bytes().to_vec(), gzip(SPRING.as_bytes())] {
        let input = read_text(&bytes).expect("a matrix");
        assert_eq!(input.stiffness.digest, blake3::hash(&bytes).to_hex().to_string());
    }
}

#[test]
fn duplicates_are_added_and_reported() {
    let text = mtx("symmetric", 2, &[(2, 1, -1.0), (1, 1, 1.0), (2, 2, 3.0), (2, 1, -1.5), (1, 1, 1.5), (2, 2, 1.0)]);
    let input = read_text(text).expect("a matrix");
    assert_eq!(dense(&input), spring());
    assert_eq!(input.stiffness.notes.n_duplicates, 3, "one below the diagonal, two on it");
    assert!(matches!(input.notes[0], InputNote::Duplicates { count: 3, .. }), "{:?}", input.notes);
}

#[test]
fn a_general_matrix_of_one_triangle_is_mirrored_and_reported() {
    for entry in [(1, 2, -2.5), (2, 1, -2.5)] {
        let input = read_text(mtx("general", 2, &[(1, 1, 2.5), entry, (2, 2, 4.0)])).expect("a matrix");
        assert_eq!(dense(&input), spring());
        assert_eq!(input.stiffness.notes.given, Given::OneTriangle);
        assert!(matches!(input.notes[0], InputNote::Mirrored { .. }), "{:?}", input.notes);
    }
}

#[test]
fn a_general_matrix_is_left_as_it_is() {
    let input = read_text(mtx("general", 2, &[(1, 1, 1.0), (1, 2, 2.0), (2, 1, 3.0)])).expect("a matrix");
    assert_eq!(dense(&input), [[1.0, 2.0], [3.0, 0.0]]);
    let diagonal = read_text(mtx("general", 2, &[(1, 1, 1.0), (2, 2, 2.0)])).expect("a matrix");
    assert!(diagonal.stiffness.notes.given == Given::Whole && diagonal.notes.is_empty());
}

#[test]
fn bare_triplets_take_their_order_from_the_largest_index() {
    let input = read_text("1 1 2.5\n1 2 -2.5\n2 2 4\n").expect("a matrix");
    assert_eq!(dense(&input), spring());
    assert!(matches!(input.notes[0], InputNote::OrderFromIndices { n: 2, .. }), "{:?}", input.notes);
    assert_eq!(input.stiffness.notes.given, Given::OneTriangle);
}

#[test]
fn a_size_line_without_a_banner_is_known_by_its_count() {
    let input = read_text("2 2 3\n1 1 2.5\n2 1 -2.5\n2 2 4\n").expect("a matrix");
    assert_eq!(dense(&input), spring());
    let entries_only = read_text("1 1 3\n2 1 -1\n2 2 4\n").expect("a matrix");
    assert_eq!(dense(&entries_only), [[3.0, -1.0], [-1.0, 4.0]]);
}

#[test]
fn a_bare_matrix_is_filled_up_to_the_order_of_the_other() {
    let folder = Folder::new();
    let stiffness = folder.write("k.sti", "1 1 2.5\n1 2 -2.5\n2 2 4\n");
    let mass = folder.write("m.mas", "1 1 1\n");
    let input = read(&job(&stiffness, &mass)).expect("a model");
    assert_eq!(input.mass.matrix.shape(), (2, 2));
    assert_eq!(input.mass.matrix.nnz(), 1);
    assert!(input.notes.iter().any(|note| matches!(note, InputNote::Extended { from: 1, to: 2, .. })));
}

#[test]
fn a_last_line_without_an_end_is_reported() {
    let input = read_text(SPRING.trim_end()).expect("a matrix");
    assert!(matches!(input.notes[0], InputNote::OpenLastLine { .. }), "{:?}", input.notes);
}

#[test]
fn calculix_files_are_read_as_they_are() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/text");
    let mut model = job(&folder.join("truss.sti"), &folder.join("truss.mas"));
    model.dofs = Some(folder.join("truss.dof"));
    model.nodes = Some(folder.join("truss.csv"));
    let input = read(&model).expect("a model");
    assert_eq!(input.stiffness.matrix.shape(), (4, 4));
    assert_eq!(input.dofs.as_ref().map(Vec::len), Some(4));
    let unused = input.notes.iter().find(|note| matches!(note, InputNote::UnusedNodes { count: 1, .. }));
    assert!(unused.is_some(), "{:?}", input.notes);
}

#[test]
fn notes_are_lines_of_a_report() {
    let input = read_text("1 1 2.5\n1 2 -2.5\n2 2 4\n2 2 4").expect("a matrix");
    let lines: Vec<String> = input.notes.iter().take(4).map(|note| note.to_string()).collect();
    let told = ["largest index", "no line end", "1 entry repeats a position", "mirrored"];
    for (line, told) in lines.iter().zip(told) {
        assert!(line.contains("a.mtx") && line.contains(told), "{line}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any entries in any order give the matrix that adding them one by one gives, each at both its places where no pair is whole. Values are integers, so that sums
    /// are exact whatever their order.
    #[test]
    fn assembling_equals_adding_entries_one_by_one(
        n in 1_usize..12,
        raw in prop::collection::vec((0_usize..12, 0_usize..12, -100_i32..100), 0..200),
    ) {
        let entries: Vec<_> = raw.iter().map(|&(r, c, v)| (r % n + 1, c % n + 1, f64::from(v))).collect();
        let mut expected = vec![vec![0.0; n]; n];
        // Where no pair of rows is given at both its places, each entry stands for both.
        let is_once = !entries.iter().any(|e| e.0 != e.1 && entries.iter().any(|other| (other.0, other.1) == (e.1, e.0)));
        for &(row, col, value) in &entries {
            expected[row - 1][col - 1] += value;
            if is_once && row != col {
                expected[col - 1][row - 1] += value;
            }
        }
        let input = read_text(mtx("general", n, &entries)).expect("a matrix");
        prop_assert_eq!(dense(&input), expected);
        let matrix = &input.stiffness.matrix;
        for row in matrix.outer_iterator() {
            prop_assert!(row.indices().is_sorted_by(|a, b| a < b));
        }
    }

    /// Doubles written in seventeen digits come back with the same bits.
    #[test]
    fn values_come_back_bit_by_bit(
        values in prop::collection::vec(prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL, 1..50),
    ) {
        let entries: Vec<_> = values.iter().enumerate().map(|(k, &value)| (k + 1, k + 1, value)).collect();
        let input = read_text(mtx("symmetric", values.len(), &entries)).expect("a matrix");
        let read: Vec<u64> = input.stiffness.matrix.data().iter().map(|value| value.to_bits()).collect();
        prop_assert_eq!(read, values.iter().map(|value| value.to_bits()).collect::<Vec<_>>());
    }
}
