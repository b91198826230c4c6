//! Matrices of which each pair of rows is given once: in one triangle, or some pairs in one order and some in the other.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use supel::error::Error;
use supel::input::read;
use supel::sparse::Given;

use super::converted::{supel, text, unsymmetric};
use super::{fixture, job, pair};

/// The entries of K of the fixtures: the whole diagonal, and of each pair the one that `is_kept` takes, by the number of the pair.
fn entries(is_kept: impl Fn(usize, usize, usize) -> bool) -> Vec<(usize, usize, f64)> {
    let whole = pair("k.mtx", "m.mtx").expect("the reference").stiffness.matrix;
    let number = |row: usize, col: usize| row.max(col) * 6 + row.min(col);
    let all = whole.iter().map(|(value, (row, col))| (row as usize, col as usize, *value));
    all.filter(|(row, col, _)| row == col || is_kept(number(*row, *col), *row, *col)).collect()
}

/// Every other pair above the diagonal.
fn either_order() -> Vec<(usize, usize, f64)> {
    entries(|number, row, col| (number % 2 == 0) == (row < col))
}

/// Bare triplets, or Matrix Market that does not say what its entries stand for.
fn written(path: &Path, head: &str, entries: &[(usize, usize, f64)]) -> PathBuf {
    let mut text = match head {
        "" => String::new(),
        _ => format!("%%MatrixMarket matrix coordinate real {head}\n6 6 {}\n", entries.len()),
    };
    for (row, col, value) in entries {
        let _ = writeln!(text, "{} {} {value:e}", row + 1, col + 1);
    }
    std::fs::write(path, text).expect("written");
    path.to_owned()
}

/// What `supel convert` answers, which succeeds.
fn converted(source: &Path, output: &Path) -> String {
    let ended = supel(&["convert", text(source), text(output)]);
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    String::from_utf8(ended.stdout).expect("UTF-8")
}

#[test]
fn pairs_given_once_in_either_order_stand_for_both() {
    let folder = tempfile::tempdir().expect("a folder");
    let reference = pair("k.mtx", "m.mtx").expect("the reference").stiffness.matrix;
    let once = either_order();
    let n_above = once.iter().filter(|(row, col, _)| row < col).count();
    let n_below = once.iter().filter(|(row, col, _)| row > col).count();
    assert!(n_above > 1 && n_below > 1, "{once:?}");
    let general = written(&folder.path().join("general.mtx"), "general", &once);
    let symmetric = written(&folder.path().join("symmetric.mtx"), "symmetric", &once);
    let mut files = vec![written(&folder.path().join("k.sti"), "", &once), general.clone(), symmetric];
    for name in ["k.npz", "k.op4", "k.mat"] {
        let output = folder.path().join(name);
        converted(&general, &output);
        files.push(output);
    }
    for file in files {
        let input = read(&job(&file, &fixture("m.mtx"))).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        assert!(input.stiffness.matrix == reference, "{}: {:?}", file.display(), input.stiffness.matrix);
        assert_eq!(input.stiffness.notes.given, Given::EitherOrder { n_below, n_above }, "{}", file.display());
        let told = format!("by {n_below} entries below the diagonal and {n_above} above it; it was mirrored");
        assert!(input.notes.iter().any(|note| note.to_string().contains(&told)), "{:?}", input.notes);
    }
}

/// Where a triangle is named, it holds for pairs that are given twice; what is given once is not lost, whichever triangle it is in.
#[test]
fn a_triangle_that_is_named_holds() {
    let folder = tempfile::tempdir().expect("a folder");
    let reference = pair("k.mtx", "m.mtx").expect("the reference").stiffness.matrix;
    let mut partly = either_order();
    let n_pairs = partly.iter().filter(|(row, col, _)| row != col).count();
    let (row, col, value) = *partly.iter().find(|(row, col, _)| row > col).expect("an entry below");
    for twice in [None, Some(7.0 * value)] {
        partly.extend(twice.map(|value| (col, row, value)));
        for head in ["", "general", "symmetric"] {
            let file = written(&folder.path().join("k.mtx"), head, &partly);
            let mut job = job(&file, &fixture("m.mtx"));
            job.layout = head.is_empty().then_some(supel::job::Layout::Coordinate);
            job.symmetric = Some(supel::sparse::Triangle::Lower);
            let input = read(&job).unwrap_or_else(|error| panic!("{head}: {error}"));
            assert!(input.stiffness.matrix == reference, "{head}: {:?}", input.stiffness.matrix);
            let told: Vec<String> = input.notes.iter().map(ToString::to_string).collect();
            let is_told = |words: &str| told.iter().any(|note| note.contains(words));
            assert!(is_told("the lower triangle was taken for both"), "{told:?}");
            assert!(
                is_told(&format!("of {} pairs of rows that are given once", n_pairs - usize::from(twice.is_some()))),
                "{told:?}"
            );
            assert_eq!(is_told("at 1 position above the diagonal differs"), twice.is_some(), "{told:?}");
        }
    }
}

/// A file that declares its matrix symmetric, of which it gives each pair of rows once or twice: what stands once stands for both, and two values
/// are refused, also by `convert`.
#[test]
fn pairs_of_symmetric_matrices_of_nastran() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = folder.path().join("out.npz");
    let head = "DMIG,K,0,6,1\nDMIG,K,1,1,,1,1,4.\nDMIG,K,2,1,,2,1,5.\nDMIG,K,3,1,,3,1,6.\nDMIG,K,1,1,,2,1,-1.\n";
    let written = |more: &str| {
        let path = folder.path().join("k.bdf");
        std::fs::write(&path, format!("{head}{more}")).expect("written");
        path
    };
    let once = "DMIG,K,2,1,,3,1,-2.\n";
    for more in [String::new(), "DMIG,K,2,1,,1,1,-1.\n".to_owned(), "DMIG,K,2,1,,1,1,-1.0000001\n".to_owned()] {
        let answer = converted(&written(&(more + once)), &output);
        assert!(answer.contains("7 entries"), "{answer}");
    }
    let ended = supel(&["convert", text(&written("DMIG,K,2,1,,1,1,-2.\n")), text(&output)]);
    let told = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(3), "{told}");
    assert!(told.contains("E-DOUBLE-TRIANGLE") && told.contains("(2, 1) and (1, 2)"), "{told}");
}

/// One entry more makes a matrix that is neither: it is refused.
#[test]
fn a_matrix_that_is_partly_whole_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut partly = either_order();
    let (row, col, value) = *partly.iter().find(|(row, col, _)| row > col).expect("an entry below");
    partly.push((col, row, value));
    let file = written(&folder.path().join("k.sti"), "", &partly);
    let input = read(&job(&file, &fixture("m.mtx"))).expect("read as it is");
    assert_eq!(input.stiffness.notes.given, Given::Whole);
    let error = supel::model::Model::new(input).expect_err("not symmetric");
    let Error::Unsymmetric { unpaired, .. } = &error else { panic!("{error}") };
    assert!(!unpaired.contains(&0), "{unpaired:?}");
}

/// What is converted keeps its entries. Half of a symmetric matrix is told; a truly general matrix, a diagonal and a whole one are not.
#[test]
fn convert_tells_half_matrices() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = folder.path().join("out.npz");
    let n_pairs = entries(|_, row, col| row > col).len() - 6;
    let told = format!("{n_pairs} pairs of rows are given in one order only");
    let diagonal = entries(|_, _, _| false);
    for (name, kept, is_told) in [
        ("lower.mtx", entries(|_, row, col| row > col), true),
        ("either.mtx", either_order(), true),
        ("diagonal.mtx", diagonal, false),
        ("whole.mtx", entries(|_, _, _| true), false),
    ] {
        let answer = converted(&written(&folder.path().join(name), "general", &kept), &output);
        assert_eq!(answer.contains(&told), is_told, "{name}: {answer}");
        assert!(answer.contains(&format!("{} entries", kept.len())), "every entry is kept: {answer}");
    }
    let answer = converted(&unsymmetric(folder.path()), &output);
    assert!(answer.contains("7 entries, general") && !answer.contains("note"), "{answer}");
    let truly = "%%MatrixMarket matrix coordinate real general\n3 3 4\n1 1 1\n1 2 2\n2 1 3\n3 1 4\n";
    let path = folder.path().join("truly.mtx");
    std::fs::write(&path, truly).expect("written");
    let answer = converted(&path, &output);
    assert!(answer.contains("4 entries, general") && !answer.contains("note"), "{answer}");
    // Bare triplets are those of K and M: they are mirrored, as one triangle of them is, and told.
    let answer = converted(&written(&folder.path().join("k.sti"), "", &either_order()), &output);
    assert!(answer.contains("symmetric") && answer.contains("each pair of rows is given once"), "{answer}");
}
