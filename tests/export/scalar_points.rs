//! The rows of scalar dofs in a dof map that `supel convert` writes.

use supel::cli::ExitCode;
use supel_testing::place::{Place, supel};

/// K has two scalar points and M one of them: what K's rows are is what M's are looked up in, from a table and from the deck.
#[test]
fn a_map_with_scalar_points_fits_the_matrix_that_lacks_some() {
    let place = Place::new();
    place.write(
        "sp.pch",
        b"DMIG,KAAX,0,6,2,0\nDMIG,KAAX,1,1,,1,1,2.0\n,10,0,-1.\n,11,0,-.5\nDMIG,KAAX,10,0,,10,0,3.0\nDMIG,KAAX,11,0,,11,0,4.0\n\
          DMIG,MAAX,0,6,2,0\nDMIG,MAAX,1,1,,1,1,1.0\nDMIG,MAAX,11,0,,11,0,7.0\n",
    );
    place.write("sp.bdf", b"GRID,1,,0.,0.,0.\nSPOINT,10,11\nENDDATA\n");
    let convert = |matrix: &str, [output, flag, file]: [&str; 3]| {
        let matrix = format!("{}:{matrix}", place.text("sp.pch"));
        supel(&["convert", &matrix, &place.text(output), flag, &place.text(file)])
    };
    convert("KAAX", ["k.mtx", "--write-dofs", "rows.csv"]).expect(ExitCode::Done);
    assert_eq!(place.bytes("rows.csv"), b"node,dof\n1,ux\n10,scalar\n11,scalar\n");
    convert("MAAX", ["m.mtx", "--dofs", "rows.csv"]).expect(ExitCode::Done);
    let text = String::from_utf8(place.bytes("m.mtx")).expect("text");
    assert!(text.contains("\n3 3 2\n1 1 1e0\n3 3 7e0\n"), "{text}");
    convert("MAAX", ["deck.mtx", "--dofs", "sp.bdf"]).expect(ExitCode::Done);
    let text = String::from_utf8(place.bytes("deck.mtx")).expect("text");
    assert!(text.contains("\n8 8 2\n1 1 1e0\n8 8 7e0\n"), "{text}");
    // A label that two rows have is none.
    place.write("twice.csv", b"node,dof\n1,ux\n11,scalar\n11,scalar\n");
    let refused = convert("MAAX", ["no.mtx", "--dofs", "twice.csv"]);
    assert_eq!(refused.code, ExitCode::InputData, "{}", refused.err);
    assert!(refused.err.contains("row 3") && refused.err.contains("row 2 too"), "{}", refused.err);
}

/// The rows of a matrix that names none stay where they are, and a map of another number of rows is not theirs.
#[test]
fn a_map_orders_no_matrix_that_names_no_rows() {
    let place = Place::new();
    place.write("k.mtx", b"%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 2.\n2 2 3.\n");
    place.write("rows.csv", b"node,dof\n2,ux\n1,ux\n");
    place.write("long.csv", b"node,dof\n1,ux\n2,ux\n3,ux\n");
    let convert =
        |map: &str| supel(&["convert", &place.text("k.mtx"), &place.text("k.npz"), "--dofs", &place.text(map)]);
    let told = convert("rows.csv").expect(ExitCode::Done).out;
    assert!(
        told.contains("note: rows.csv: k.mtx names none of its rows, which stay in the order of the matrix"),
        "{told}"
    );
    let refused = convert("long.csv");
    assert_eq!(refused.code, ExitCode::InputData, "{}", refused.err);
    assert!(refused.err.contains("E-MAP-COUNT") && refused.err.contains("3 rows"), "{}", refused.err);
}

/// What Abaqus numbers below zero and beyond six has labels too.
#[test]
fn dofs_beyond_six_and_nodes_below_zero_are_told_apart() {
    let place = Place::new();
    place.write("ab.mtx", b"1,1,1,1,2.\n1,7,1,1,-1.\n1,7,1,7,3.\n-3,1,-3,1,5.\n");
    let (from, map) = (place.text("ab.mtx"), place.text("rows.csv"));
    supel(&["convert", &from, &place.text("a.mtx"), "--write-dofs", &map]).expect(ExitCode::Done);
    assert_eq!(place.bytes("rows.csv"), b"node,dof\n-3,scalar:1\n1,ux\n1,scalar:7\n");
    supel(&["convert", &from, &place.text("b.mtx"), "--dofs", &map]).expect(ExitCode::Done);
    assert_eq!(place.bytes("a.mtx"), place.bytes("b.mtx"));
}
