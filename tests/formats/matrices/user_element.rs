//! Matrices of a user element, as Abaqus and CalculiX write those of a substructure.

use std::path::Path;

use supel::dofs::{Direction, Dof};
use supel::error::Error;
use supel::input::{Allowance, ReadSingle, SingleMatrix, read};
use supel::job::{Layout, ModelJob};
use supel::sparse::{Given, SparseMatrix};

use super::{error_of, fixture, pair, stiffness};

/// Rows of the file in its order, node 7 first, an internal node last; the matrices have the internal one first, which is scalar.
#[test]
fn matrices_of_a_substructure_bring_their_dof_map() {
    let reference = pair("k.mtx", "m.mtx").expect("the reference");
    let input = pair("user_element.mtx", "user_element.mtx").expect("both by their names");
    let place = |row: usize| if row == 5 { 0 } else { row + 1 };
    for (of_reference, found) in [(&reference.stiffness, &input.stiffness), (&reference.mass, &input.mass)] {
        assert_eq!(of_reference.matrix.nnz(), found.matrix.nnz());
        for (value, (row, col)) in &of_reference.matrix {
            assert_eq!(found.matrix.get(place(row as usize), place(col as usize)), Some(value), "{row} {col}");
        }
        assert_eq!((found.notes.given, found.notes.n_duplicates), (Given::Whole, 0), "one triangle stands for both");
    }
    let nodes = [(1, 1), (1, 2), (1, 3), (7, 1), (7, 2)];
    let dofs = nodes.map(|(node, component)| Some(Dof { node, direction: Direction::ALL[component - 1] }));
    assert_eq!(input.dofs, Some([[None].as_slice(), &dofs].concat()));
    let named = pair("user_element.mtx:STIFFNESS", "user_element.mtx:mass").expect("both by name");
    assert!(named.stiffness.matrix == input.stiffness.matrix && named.mass.matrix == input.mass.matrix);
}

fn single(file: &Path) -> ReadSingle {
    let matrix = SingleMatrix { file: file.to_owned(), layout: None, dofs: None };
    matrix.read(&Allowance::of(None)).expect("a matrix")
}

/// The keyword says how many nodes there are where no comment lists them: the rows of a whole matrix have no names then.
#[test]
fn a_whole_matrix_without_a_list_of_nodes() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("whole.mtx");
    let head = "*USER ELEMENT,NODES=2,LINEAR,UNSYMM\n1,2\n2,1\n*MATRIX,TYPE=STIFFNESS\n";
    std::fs::write(&path, format!("{head}4.,-2.,0.,-1.,\n4.,-2.5,7.,-1.5,\n4.\n")).expect("written");
    let found = single(&path);
    let expected = [[4.0, -1.0, 7.0], [-2.0, 4.0, -1.5], [0.0, -2.5, 4.0]];
    for (i, row) in expected.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            assert_eq!(found.input.matrix.get(i, j).copied().unwrap_or(0.0), *value, "{i} {j}");
        }
    }
    assert!(found.dofs.is_none(), "{:?}", found.dofs);
}

/// CalculiX 2.20 condenses nothing here: what it wrote of the shaft of the crank are the rows of the shaft in the matrix of the whole.
#[test]
fn the_substructure_of_calculix_is_a_part_of_its_matrix() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let crank = |name: &str| root.join("examples/calculix").join(name);
    let whole = read(&ModelJob {
        stiffness: crank("crank.sti.gz"),
        mass: Some(crank("crank.mas.gz")),
        dofs: Some(crank("crank.dof")),
        ..ModelJob::default()
    });
    let whole = whole.expect("the crank");
    let reduced = single(&root.join("fixtures/calculix/substructure.mtx.gz"));
    assert_eq!(reduced.layout, Layout::UserElement);
    let (dofs, kept) = (whole.dofs.expect("a map"), reduced.dofs.expect("rows with names"));
    assert_eq!(kept.len(), 39);
    let interface: Vec<usize> =
        kept.iter().map(|dof| dofs.iter().position(|other| other == dof).expect("a row of the crank")).collect();
    let (k, part) = (&whole.stiffness.matrix, &reduced.input.matrix);
    let largest = part.data().iter().fold(0.0, |max: f64, value| max.max(value.abs()));
    let value = |matrix: &SparseMatrix, row: usize, col: usize| matrix.get(row, col).copied().unwrap_or(0.0);
    for (i, row) in interface.iter().enumerate() {
        for (j, col) in interface.iter().enumerate() {
            // Both went through texts of 13 digits.
            let difference = (value(k, *row, *col) - value(part, i, j)).abs();
            assert!(difference < 1e-12 * largest, "{:?} {:?}: {difference:e}", kept[i], kept[j]);
        }
    }
}

const HEAD: &str = "*User Element, Nodes=2, Linear\n** ELEMENT NODES\n** 3, 5\n1\n*MATRIX, TYPE=STIFFNESS\n";

/// An element that says UNSYMM has all entries, by columns; names that are no dof map leave the rows in the order of the file.
#[test]
fn matrices_of_other_forms() {
    let folder = tempfile::tempdir().expect("a folder");
    let read = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        single(&path)
    };
    let entries = |read: &ReadSingle| -> Vec<f64> {
        let entry = |at: usize| read.input.matrix.get(at / 2, at % 2).copied().unwrap_or(0.0);
        (0..4).map(entry).collect()
    };
    let unsymmetric =
        read("u.mtx", &(HEAD.replace("Linear", "Linear, UnSymm") + "1., 2.,\n3.\n** a comment\n4.,\n*LOAD CASE\n9.\n"));
    assert_eq!(entries(&unsymmetric), [1.0, 3.0, 2.0, 4.0]);
    assert_eq!(unsymmetric.dofs, Some([3, 5].map(|node| Some(Dof { node, direction: Direction::Ux })).to_vec()));
    for nodes in ["** 3, 3", "** 3", "** 3, 4, 5"] {
        let unnamed = read("n.mtx", &(HEAD.replace("** 3, 5", nodes) + "1.,\n2., 4.\n"));
        assert_eq!((entries(&unnamed), unnamed.dofs), (vec![1.0, 2.0, 2.0, 4.0], None), "{nodes}");
    }
}

#[test]
fn what_is_no_matrix_of_an_element_is_refused_by_its_reason() {
    let text = |rest: &str| HEAD.to_owned() + rest;
    for (text, told) in [
        (text("1.0,\n2.0, 3.0, 4.0\n"), "the end of the matrix in row 2 of column 3"),
        (text(""), "the end of the matrix in row 1 of column 1"),
        (text("1.0,\n2.0, x\n"), "line 7"),
        (text("1.0, nan, 2.0\n"), "line 6"),
        (text(&format!("1.0, 2.0, 3.0\n{HEAD}")), "a second element"),
        (HEAD.replace("\n1\n", "\n0x\n"), "line 4"),
        (HEAD.replace("Linear", "Linear, UNSYMM") + "1, 2, 3, 4, 5\n", "more numbers"),
    ] {
        let error = error_of("e.mtx", &text);
        assert!(matches!(error, Error::MatrixFormat { .. }), "{told}: {error}");
        assert!(error.to_string().contains(told) && error.to_string().contains("e.mtx"), "{told}: {error}");
    }
    let error = error_of("e.mtx", HEAD.replace("*MATRIX", "*LOAD"));
    assert!(matches!(error, Error::MatrixNone { .. }), "{error}");
    let error = error_of("e.mtx", HEAD.replace("STIFFNESS", "MASS") + "1, 2, 3\n");
    assert!(matches!(error, Error::MatrixAmbiguous { .. }), "{error}");
    // A stiffness alone is no mass, and its rows have names that those of another file have not.
    assert!(matches!(stiffness(&fixture("user_element.mtx")), Err(Error::RowsUnnamed { .. })));
}
