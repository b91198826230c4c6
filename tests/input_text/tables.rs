//! Dof maps and node tables.

use supel::dofs::{Direction, Dof, DofMap};
use supel::error::{Error, Result};
use supel::input::{Input, InputNote, read};

use crate::{Folder, gzip, job, mtx};

/// Reads a model of n rows with these tables.
fn read_tables(n: usize, dofs: Option<&[u8]>, nodes: Option<&[u8]>) -> Result<Input> {
    let folder = Folder::new();
    let matrix = folder.write("k.mtx", mtx("symmetric", n, &[(1, 1, 1.0), (n, n, 1.0)]));
    let mut model = job(&matrix, &matrix);
    model.dofs = dofs.map(|bytes| folder.write("map.dof", bytes));
    model.nodes = nodes.map(|bytes| folder.write("nodes.csv", bytes));
    read(&model)
}

fn dofs_of(n: usize, text: &str) -> Result<DofMap> {
    read_tables(n, Some(text.as_bytes()), None).map(|input| input.dofs.expect("a dof map"))
}

fn dof(node: i64, direction: Direction) -> Option<Dof> {
    Some(Dof { node, direction })
}

fn dof_error(n: usize, text: &str) -> Error {
    dofs_of(n, text).expect_err("an error")
}

fn node_error(text: &str) -> Error {
    read_tables(3, None, Some(text.as_bytes())).expect_err("an error")
}

#[test]
fn a_dof_map_line_by_line() {
    let expected = vec![dof(5, Direction::Ux), dof(7, Direction::Rz)];
    assert_eq!(dofs_of(2, "5.1\n7.6\n").expect("a map"), expected);
    assert_eq!(dofs_of(2, "\u{feff}5.1\r\n\r\n 7.6").expect("a map"), expected);
    let input = read_tables(2, Some(&gzip(b"5.1\n7.6\n")), None).expect("a map");
    assert_eq!(input.dofs, Some(expected));
}

/// A row that no node has says so, and names none.
#[test]
fn scalar_dofs_of_a_table() {
    let map = dofs_of(3, "node,dof\n101,uz\n,scalar\n,Scalar\n").expect("a map");
    assert_eq!(map, [dof(101, Direction::Uz), None, None]);
    let from_zero = dofs_of(3, "node,dof\n101,0\n,scalar\n101,2\n").expect("a map");
    assert_eq!(from_zero, [dof(101, Direction::Ux), None, dof(101, Direction::Uz)]);
    // Its label is no node, and neither is that of a dof that a program numbers beyond six.
    let labelled = dofs_of(3, "node,dof\n101,uz\n102,scalar\n101,scalar:8\n").expect("a map");
    assert_eq!(labelled, [dof(101, Direction::Uz), None, None]);
    assert!(matches!(dof_error(2, "node,dof\n101,uz\n102,scalar8\n"), Error::DofDirection { line: 3, .. }));
    assert!(matches!(dof_error(2, "node,dof\n101,uz\n,ux\n"), Error::TableField { line: 3, .. }));
    // A scalar dof is no node that a table of nodes could lack, and no two of them repeat each other.
    let nodes = Some(b"node,x,y,z\n101,0,0,0\n".as_slice());
    let input = read_tables(3, Some(b"node,dof\n101,uz\n,scalar\n,scalar\n"), nodes).expect("a map");
    assert!(input.notes.iter().all(|note| !matches!(note, InputNote::UnusedNodes { .. })), "{:?}", input.notes);
}

#[test]
fn a_dof_map_as_a_table() {
    let expected = vec![dof(101, Direction::Uz), dof(101, Direction::Rx)];
    let from_one = [
        "grid,component\n101,3\n101,4\n",
        "dof;node\n3;101\n4;101\n",
        "node\tdirection\n101\tuz\n101\tROTX\n",
        "row,node,dof\n0,101,3\n1,101,4\n",
        "row,node,dof\n1,101,3\n2,101,4\n",
    ];
    for text in from_one {
        let input = read_tables(2, Some(text.as_bytes()), None).expect("a map");
        assert_eq!(input.dofs.as_ref(), Some(&expected), "{text}");
        assert!(!input.notes.iter().any(|note| matches!(note, InputNote::DirectionsFromZero { .. })), "{text}");
    }
}

#[test]
fn directions_from_zero_are_known_and_reported() {
    let cases = [
        ("node,dof(0=UX)\n1,1\n1,2\n", [Direction::Uy, Direction::Uz]),
        ("node,dof\n1,0\n1,5\n", [Direction::Ux, Direction::Rz]),
    ];
    for (text, directions) in cases {
        let input = read_tables(2, Some(text.as_bytes()), None).expect("a map");
        assert_eq!(input.dofs, Some(directions.map(|direction| dof(1, direction)).to_vec()), "{text}");
        assert!(matches!(input.notes[0], InputNote::DirectionsFromZero { .. }), "{:?}", input.notes);
    }
}

#[test]
fn node_tables_in_any_dress() {
    let tables = [
        "node,x,y,z\n4,1,2,3\n",
        "z;group;NODE;x;y\n3;skin;4;1.0;2e0\n",
        "\u{feff}\"node\"\t\"x\"\t\"y\"\t\"z\"\r\n4\t1\t2\t3\r\n",
        "# node, x, y, z\n4, 1, 2, 3\n",
        // Comments above a header, behind a mark or not, with what may stand between fields in them or not.
        "# exported by my tool, version 2\nnode,x,y,z\n4,1,2,3\n",
        "# exported by my tool\n# units: m, kg\n\n# node,x,y,z\n 4,1,2,3\n",
        "# mine\n\"node\",\"x\",\"y\",\"z\"\n\"4\",1,2,3\n",
        // As Fortran writes numbers, and as a table looks that was saved as one array.
        "node,x,y,z\n4,1.D0,0.2D+01,3.0\n",
        "node,x,y,z\n4.000000000000000000e+00,1.000000000000000000e+00,2.0e+00,3.0e+00\n",
    ];
    for text in tables {
        let input = read_tables(3, None, Some(text.as_bytes())).expect("a model");
        let nodes = input.nodes.expect("nodes");
        assert_eq!((nodes.labels, nodes.coordinates), (vec![4], vec![[1.0, 2.0, 3.0]]), "{text}");
    }
    assert!(read_tables(3, None, Some(&gzip(tables[0].as_bytes()))).is_ok());
}

#[test]
fn a_comment_above_a_map_without_a_header() {
    for comment in ["# rows of K by node", "# rows of K, by node\n# my map"] {
        let text = format!("{comment}\n7.1\n7.3\n");
        let input = read_tables(2, Some(text.as_bytes()), None).expect("a map");
        assert_eq!(
            input.dofs,
            Some([Direction::Ux, Direction::Uz].map(|direction| dof(7, direction)).to_vec()),
            "{text}"
        );
    }
}

#[test]
fn a_label_that_is_no_whole_number() {
    for label in ["4.5", "1e300", "9007199254740993.0", "inf", ""] {
        let table = format!("node,x,y,z\n{label},1,2,3\n");
        let error = read_tables(3, None, Some(table.as_bytes())).expect_err("an error");
        assert!(error.to_string().contains("expected a whole number"), "{label}: {error}");
    }
}

#[test]
fn without_a_map_rows_go_node_by_node_where_counts_fit() {
    let table = b"node,x,y,z\n9,0,0,0\n4,1,0,0\n";
    for (n, per_node) in [(6, 3), (12, 6)] {
        let input = read_tables(n, None, Some(table)).expect("a model");
        let dofs = input.dofs.expect("an order");
        assert_eq!(dofs.len(), n);
        assert_eq!(dofs[0], dof(9, Direction::Ux));
        assert_eq!(dofs[per_node], dof(4, Direction::Ux), "order of the table, not of the labels");
        assert!(matches!(input.notes[0], InputNote::DefaultOrder { dofs_per_node, .. } if dofs_per_node == per_node));
    }
}

#[test]
fn counts_that_do_not_fit_are_never_guessed() {
    let error = read_tables(7, None, Some(b"node,x,y,z\n9,0,0,0\n4,1,0,0\n")).expect_err("an error");
    assert!(matches!(error, Error::DofOrderUnknown { n_nodes: 2, n: 7, .. }), "{error}");
}

#[test]
fn a_map_of_another_length() {
    let error = dof_error(3, "1.1\n1.2\n");
    assert!(matches!(error, Error::DofCount { found: 2, n: 3, .. }), "{error}");
}

#[test]
fn a_line_that_is_no_dof() {
    for line in ["11", "x.1", "1.a", "1.-1", "99999999999999999999.1", "1.1.1"] {
        let error = dof_error(2, &format!("1.1\n{line}\n"));
        assert!(matches!(error, Error::DofText { line: 2, .. }), "{line}: {error}");
        assert!(error.to_string().contains("map.dof:2"), "{error}");
    }
}

#[test]
fn a_direction_that_does_not_exist() {
    let cases = [
        ("1.1\n1.0\n", 2),
        ("1.1\n1.7\n", 2),
        ("node,dof\n1,1\n1,7\n", 3),
        ("node,dof\n1,0\n1,6\n", 3),
        ("node,dof\n1,temp\n", 2),
    ];
    for (text, at) in cases {
        let error = dof_error(2, text);
        assert!(matches!(error, Error::DofDirection { line, node: 1, .. } if line == at), "{text}: {error}");
    }
}

#[test]
fn a_dof_twice() {
    let error = dof_error(3, "1.1\n2.1\n1.1\n");
    assert!(
        matches!(error, Error::DofRepeated { row: 3, first_row: 1, node: 1, direction: Direction::Ux, .. }),
        "{error}"
    );
}

#[test]
fn numbered_rows_out_of_order() {
    let error = dof_error(2, "row,node,dof\n1,1,1\n3,1,2\n");
    assert!(matches!(error, Error::DofRowOrder { line: 3, expected: 2, .. }), "{error}");
}

#[test]
fn a_node_of_the_map_without_position() {
    let error = read_tables(2, Some(b"1.1\n2.1\n"), Some(b"node,x,y,z\n1,0,0,0\n")).expect_err("an error");
    assert!(matches!(error, Error::DofNodeMissing { row: 2, node: 2, .. }), "{error}");
    assert!(error.to_string().contains("nodes.csv"), "{error}");
}

#[test]
fn a_table_without_a_needed_column() {
    let error = node_error("node,x,y\n1,0,0\n");
    assert!(matches!(error, Error::TableColumn { column: "z", .. }), "{error}");
    let error = dof_error(1, "node,weight\n1,1\n");
    assert!(matches!(error, Error::TableColumn { column: "dof", .. }), "{error}");
}

#[test]
fn a_short_row() {
    let error = node_error("node,x,y,z\n1,0,0\n");
    assert!(matches!(error, Error::TableRow { line: 2, found: 3, expected: 4, .. }), "{error}");
}

#[test]
fn a_field_that_is_no_number() {
    for row in ["1,0,0,nan", "1,0,0,inf", "1,0,0,", "1,0,0,a", "1.5,0,0,0"] {
        let error = node_error(&format!("node,x,y,z\n2,0,0,0\n{row}\n"));
        assert!(matches!(error, Error::TableField { line: 3, .. }), "{row}: {error}");
    }
}

#[test]
fn bytes_that_are_no_text() {
    let error = read_tables(3, None, Some(b"node,x,y,z\n1,0,0,\xff\n")).expect_err("an error");
    assert!(matches!(error, Error::TableField { line: 2, .. }), "{error}");
}

/// Comments may be in another encoding, and so may what no number is read from.
#[test]
fn bytes_that_are_no_text_where_no_number_belongs() {
    let nodes = b"% f\xfcr alle\nnode,x,y,z\n# Gr\xf6\xdfe\n1,0,0,0\n";
    read_tables(3, None, Some(nodes)).expect("comments of a table");
    let map = b"% f\xfcr alle\n1.1\n1.2\n1.3\n";
    read_tables(3, Some(map), Some(b"node,x,y,z\n1,0,0,0\n")).expect("comments of a dof map");
}

#[test]
fn a_node_twice() {
    let error = node_error("node,x,y,z\n1,0,0,0\n\n1,1,0,0\n");
    assert!(matches!(error, Error::NodeRepeated { line: 4, node: 1, first_line: 2, .. }), "{error}");
}

#[test]
fn tables_without_rows() {
    for text in ["", "node,x,y,z\n"] {
        assert!(matches!(node_error(text), Error::NoData { .. }));
    }
    for text in ["", "node,dof\n"] {
        assert!(matches!(dof_error(1, text), Error::NoData { .. }));
    }
}

#[test]
fn an_endless_first_line() {
    let error = node_error(&"x".repeat(1 << 20));
    assert!(matches!(error, Error::LineTooLong { line: 1, .. }), "{error}");
}
