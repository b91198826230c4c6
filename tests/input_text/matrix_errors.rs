//! One test for each way a matrix file can be wrong.

use supel::error::{Error, ErrorClass};
use supel::input::read;

use crate::{Folder, error_of, gzip, job, mtx};

const HEAD: &str = "%%MatrixMarket matrix coordinate real symmetric\n";

/// Checks that a message names the file, and the line where it has one.
fn assert_names(error: &Error, place: &str) {
    let message = error.to_string();
    assert!(message.contains(place), "{message}");
    assert!(!message.ends_with('.'), "{message}");
    assert_eq!(error.class(), ErrorClass::InputData, "{message}");
}

#[test]
fn a_missing_file() {
    let folder = Folder::new();
    let path = folder.path().join("none.mtx");
    let error = read(&job(&path, &path)).expect_err("an error");
    assert!(matches!(error, Error::Read { .. }), "{error}");
}

#[test]
fn a_folder_instead_of_a_file() {
    let folder = Folder::new();
    let error = read(&job(folder.path(), folder.path())).expect_err("an error");
    assert!(matches!(error, Error::NotAFile { .. }), "{error}");
    #[cfg(unix)]
    {
        let device = std::path::Path::new("/dev/zero");
        let error = read(&job(device, device)).expect_err("an error");
        assert!(matches!(error, Error::NotAFile { .. }), "{error}");
    }
}

#[test]
fn gzip_cut_short() {
    let bytes = gzip(mtx("symmetric", 1, &[(1, 1, 1.0)]).as_bytes());
    let error = error_of(&bytes[..bytes.len() - 3]);
    assert!(matches!(error, Error::PackedDamaged { .. }), "{error}");
    assert_names(&error, "a.mtx");
}

#[test]
fn gzip_that_inflates_beyond_reason() {
    // Sixteen MiB of comment: deflate shrinks equal bytes by 1030.
    let text = [HEAD.as_bytes(), &b"%\n".repeat(8 << 20)].concat();
    let error = error_of(gzip(&text));
    assert!(matches!(error, Error::PackedExpansion { limit: 1000, .. }), "{error}");
}

#[test]
fn an_endless_line() {
    let text = format!("{HEAD}1 1 1\n% {}\n1 1 1\n", "x".repeat(1 << 23));
    let error = error_of(text);
    assert!(matches!(error, Error::LineTooLong { line: 3, .. }), "{error}");
    assert_names(&error, "a.mtx:3");
}

#[test]
fn nothing_at_all() {
    for text in ["", "\n\n", "% only a comment\n"] {
        let error = error_of(text);
        assert!(matches!(error, Error::NoData { .. }), "{error}");
    }
}

#[test]
fn a_bad_banner() {
    for text in
        ["%%MatrixMarkt matrix coordinate real symmetric\n1 1 1\n", "%%MatrixMarket matrix\n", "hello\n", "-1 1 2\n"]
    {
        let error = error_of(format!("\n{text}"));
        assert!(matches!(error, Error::MatrixBanner { line: 2, .. }), "{error}");
        assert_names(&error, "a.mtx:2");
    }
}

#[test]
fn a_flavour_that_is_not_read() {
    let flavours = [
        ("coordinate pattern symmetric", "pattern"),
        ("coordinate complex symmetric", "complex"),
        ("coordinate real hermitian", "hermitian"),
        ("coordinate real skew-symmetric", "skew-symmetric"),
    ];
    for (flavour, word) in flavours {
        let error = error_of(format!("%%MatrixMarket matrix {flavour}\n1 1 1\n1 1 1\n"));
        assert!(matches!(&error, Error::MatrixFlavour { found, .. } if found == word), "{error}");
        assert_names(&error, "expected `coordinate` or `array`, of `real` or");
    }
}

#[test]
fn a_bad_size_line() {
    for size in ["3 3", "3 3 -1", "3 3 1.0", "3 3 3 3", "99999999999999999999 1 1", ""] {
        let error = error_of(format!("{HEAD}% comment\n{size}\n"));
        assert!(matches!(error, Error::MatrixSizeLine { .. }), "{size}: {error}");
    }
}

#[test]
fn a_rectangular_matrix() {
    let error = error_of(format!("{HEAD}3 2 1\n1 1 1\n"));
    assert!(matches!(error, Error::MatrixNotSquare { line: 2, rows: 3, cols: 2, .. }), "{error}");
    let bare = error_of("3 2 1\n1 1 1\n");
    assert!(matches!(bare, Error::MatrixNotSquare { line: 1, .. }), "{bare}");
}

#[test]
fn an_order_of_zero_or_beyond_numbering() {
    for n in [0_u64, 1 << 31, 1 << 62] {
        let error = error_of(format!("{HEAD}{n} {n} 0\n"));
        assert!(matches!(error, Error::MatrixOrder { line: 2, .. }), "{error}");
    }
}

#[test]
fn a_promise_of_rows_without_entries() {
    let error = error_of(format!("{HEAD}2147483647 2147483647 1\n1 1 1\n"));
    assert!(matches!(error, Error::MatrixMostlyEmpty { entries: 1, .. }), "{error}");
    let bare = error_of("1 1 1\n2147483647 2147483647 1\n");
    assert!(matches!(bare, Error::MatrixMostlyEmpty { entries: 2, .. }), "{bare}");
}

#[test]
fn a_field_that_is_no_number() {
    let cases = [
        ("x 1 1", "row"),
        ("1.5 1 1", "row"),
        ("1 -1 1", "column"),
        ("1", "column"),
        ("1 1", "value"),
        ("1 1 1,5", "value"),
        ("1 1 1.0.0", "value"),
        ("1 1 1e", "value"),
        ("1 1 abc", "value"),
    ];
    for (line, wrong) in cases {
        let error = error_of(format!("{HEAD}2 2 2\n1 1 1\n{line}\n"));
        assert!(matches!(error, Error::EntryField { line: 4, field, .. } if field == wrong), "{line}: {error}");
        assert_names(&error, "a.mtx:4");
    }
}

#[test]
fn a_field_too_many() {
    let error = error_of(format!("{HEAD}2 2 1\n1 1 1 0\n"));
    assert!(matches!(&error, Error::EntryExcess { line: 3, found, .. } if found == "0"), "{error}");
}

#[test]
fn an_index_outside() {
    for (line, wrong, index) in
        [("0 1 1", "row", 0), ("1 3 1", "column", 3), ("1 99999999999999999999999 1", "column", u64::MAX)]
    {
        let error = error_of(format!("{HEAD}2 2 1\n{line}\n"));
        let Error::EntryIndex { line: 3, field, found, n: 2, .. } = error else { panic!("{error}") };
        assert_eq!((field, found), (wrong, index));
    }
    assert!(error_of("0 0 1.5\n1 1 2.5\n").to_string().contains("count from 1"));
}

#[test]
fn a_value_that_is_not_finite() {
    for value in ["nan", "NaN", "inf", "-Infinity", "1e400", "1d+999"] {
        let error = error_of(format!("{HEAD}3 3 2\n1 1 1\n3 2 {value}\n"));
        let Error::NonFinite { line: 4, row: 3, col: 2, found, .. } = error else { panic!("{error}") };
        assert_eq!(found, value);
    }
}

#[test]
fn too_few_entries() {
    let error = error_of(format!("{HEAD}3 3 1000000000000000000\n1 1 1\n"));
    assert!(
        matches!(error, Error::EntryCount { line: 3, declared: 1_000_000_000_000_000_000, found: 1, .. }),
        "{error}"
    );
    let bare = error_of("3 3 5\n1 1 1\n2 2 1\n3 3 1\n");
    assert!(matches!(bare, Error::EntryCount { line: 4, declared: 5, found: 3, .. }), "{bare}");
    let open = error_of(format!("{HEAD}3 3 5\n1 1 1\n2 2 1"));
    assert!(matches!(open, Error::EntryCount { line: 4, declared: 5, found: 2, .. }), "{open}");
}

#[test]
fn too_many_entries() {
    let error = error_of(format!("{HEAD}3 3 1\n1 1 1\n\n2 2 1\n"));
    assert!(matches!(error, Error::EntriesSurplus { line: 5, declared: 1, .. }), "{error}");
    assert_names(&error, "a.mtx:5");
}

#[test]
fn a_pair_of_a_symmetric_matrix_given_twice() {
    let error = error_of(mtx("symmetric", 3, &[(1, 1, 1.0), (3, 1, 1.0), (1, 2, 1.0), (2, 1, 1.0)]));
    assert!(matches!(error, Error::DoubleTriangle { lower: (2, 1), upper: (1, 2), .. }), "{error}");
    assert_names(&error, "a.mtx");
}

#[test]
fn matrices_of_different_size() {
    let folder = Folder::new();
    let stiffness = folder.write("k.mtx", mtx("symmetric", 2, &[(1, 1, 1.0)]));
    let mass = folder.write("m.mtx", mtx("symmetric", 3, &[(1, 1, 1.0)]));
    let error = read(&job(&stiffness, &mass)).expect_err("an error");
    assert!(matches!(error, Error::SizeMismatch { n_stiffness: 2, n_mass: 3, .. }), "{error}");
    assert_names(&error, "m.mtx");
}

#[test]
fn errors_count_lines_across_blocks() {
    // Three MiB of entries, more than one block, and the fault on the last line.
    let n_good = 200_000;
    let mut text = format!("{HEAD}1 1 {}\r\n", n_good + 1);
    text += &"1 1 1.000000000\r\n".repeat(n_good);
    text += "1 1 oops\r\n";
    let error = error_of(text);
    let expected = n_good as u64 + 3;
    assert!(matches!(error, Error::EntryField { line, .. } if line == expected), "{error}");
}
