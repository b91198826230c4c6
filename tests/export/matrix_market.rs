//! Matrix Market files and tables, read line by line.

use std::collections::BTreeSet;

use supel::cli::ExitCode;
use supel_runtime::Coordinate;
use supel_testing::place::Place;

use super::{HELD, assert_same_bits, export, reduced};

/// The lines of a file that are no comments.
fn lines(place: &Place, name: &str) -> Vec<String> {
    let text = String::from_utf8(place.bytes(name)).expect("text");
    text.lines().filter(|line| !line.starts_with('%')).map(str::to_owned).collect()
}

fn numbers(line: &str) -> Vec<f64> {
    line.split(' ').map(|number| number.parse().expect("a number")).collect()
}

/// A matrix of an export, row by row.
pub(super) fn matrix(place: &Place, name: &str) -> Vec<Vec<f64>> {
    let banner = String::from_utf8(place.bytes(name)).expect("text").lines().next().expect("a banner").to_owned();
    let lines = lines(place, name);
    let sizes: Vec<usize> = numbers(&lines[0]).into_iter().map(|size| size as usize).collect();
    let mut rows = vec![vec![0.0; sizes[1]]; sizes[0]];
    match banner.as_str() {
        "%%MatrixMarket matrix coordinate real symmetric" => {
            assert_eq!(lines.len(), 1 + sizes[2]);
            for line in &lines[1..] {
                let [i, j, value] = numbers(line)[..] else { panic!("{line}") };
                let (i, j) = (i as usize - 1, j as usize - 1);
                assert!(i >= j && value != 0.0, "{line}");
                (rows[i][j], rows[j][i]) = (value, value);
            }
        }
        "%%MatrixMarket matrix array real general" => {
            assert_eq!(lines.len(), 1 + sizes[0] * sizes[1]);
            for (k, line) in lines[1..].iter().enumerate() {
                rows[k % sizes[0]][k / sizes[0]] = line.parse().expect("a number");
            }
        }
        other => panic!("{other}"),
    }
    rows
}

#[test]
fn files_hold_the_tensors_to_the_bit() {
    for (method, fixed) in [("herting", ""), ("craig-bampton", HELD)] {
        let place = reduced(method, fixed);
        export(&place, "matrix-market", &[]).expect(ExitCode::Done);
        let superelement = place.superelement("x.supel");
        let names = ["x.stiffness.mtx", "x.mass.mtx", "x.gravity.mtx", "x.recovery.mtx"];
        for (name, expected) in names.into_iter().zip(super::tensors(&superelement)) {
            assert_same_bits(&matrix(&place, name), expected.unwrap_or_else(|| panic!("{name} is there")), name);
        }
        let recovered = lines(&place, "x.recovery-dofs.csv");
        assert_eq!((recovered.len(), recovered[0].as_str(), recovered[1].as_str()), (7, "node,dof", "2,ux"));
    }
}

/// Interface nodes keep their labels; the node of a rigid patch gets the first number that none of them has.
#[test]
fn rows_and_nodes_are_named() {
    let place = reduced("herting", "");
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    let superelement = place.superelement("x.supel");
    let dofs = lines(&place, "x.dofs.csv");
    assert_eq!(dofs.len(), 1 + superelement.n_coordinates());
    assert_eq!(&dofs[..4], ["node,dof", "1,ux", "1,uy", "1,uz"]);
    assert_eq!(&dofs[10..17], ["2,ux", "2,uy", "2,uz", "2,rx", "2,ry", "2,rz", ",scalar"]);
    assert!(dofs[17..].iter().all(|line| line == ",scalar"));
    let nodes = lines(&place, "x.nodes.csv");
    let labels: Vec<&str> = nodes[1..].iter().filter_map(|line| line.split(',').next()).collect();
    assert_eq!((nodes[0].as_str(), labels), ("node,x,y,z,interface", vec!["1", "11", "31", "2"]));
    for (line, node) in nodes[1..].iter().zip(&superelement.metadata().interface_nodes) {
        let fields: Vec<&str> = line.split(',').collect();
        let position: Vec<f64> = fields[1..4].iter().map(|number| number.parse().expect("a number")).collect();
        assert_eq!(position, node.position);
        assert_eq!(fields[4], node.name);
    }
    let text = String::from_utf8(place.bytes("x.stiffness.mtx")).expect("text");
    let rows: BTreeSet<&str> = text.lines().filter(|line| line.starts_with("% row ")).collect();
    assert_eq!(rows.len(), superelement.n_coordinates());
    assert!(rows.contains("% row 16: inertia relief 1") && rows.contains("% row 10: node 2 ux"), "{rows:?}");
}

/// A component of bare rows has neither map nor nodes, and its job takes the rows.
#[test]
fn an_interface_of_rows() {
    let place = Place::with_brick();
    let flags = "--interface ends=rows:0,1,2,30,31,32,120,121,122,132,133,134 --method craig-bampton --modes 4";
    place.reduce(&place.matrix_flags(), flags).expect(ExitCode::Done);
    let superelement = place.superelement("x.supel");
    assert!(superelement.metadata().coordinates.iter().any(|c| matches!(c, Coordinate::InterfaceRow { row: 132 })));
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    assert!(!place.path("x.dofs.csv").exists() && !place.path("x.nodes.csv").exists());
    let job = String::from_utf8(place.bytes("x.job.toml")).expect("text");
    assert!(job.contains("nodes = { rows = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11] }"), "{job}");
}
