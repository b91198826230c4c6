//! Meshes that `supel convert` wrote, as VTK opens them. Skipped, with a message, where Python has no VTK.

use std::collections::BTreeSet;
use std::path::Path;

use supel::cli::ExitCode;
use supel_testing::place::supel;
use supel_testing::vtk::{self, Grid};

use super::{Folder, fixture};

/// The grid in a file that was converted.
fn opened(source: &Path, folder: &Folder) -> Option<Grid> {
    let output = folder.0.path().join("mesh.vtkhdf");
    let [from, to] = [source, &output].map(|path| path.display().to_string());
    supel(&["convert", &from, &to]).expect(ExitCode::Done);
    let mut grids = vtk::read(&output)?;
    assert_eq!((grids.len(), grids[0].time), (1, None), "a mesh has no times");
    grids.pop()
}

/// A brick under a tetrahedron and a node alone: points, cells, labels, and sets that overlap, one with a slash in its name.
#[test]
fn vtk_sees_the_points_cells_and_sets_of_a_deck() {
    let folder = Folder::new();
    let deck = folder.write(
        "part.inp",
        "*NODE\n11, 0.1, 0, 0\n12, 1.1, 0, 0\n13, 1.1, 0.7, 0\n14, 0.1, 0.7, 0\n15, 0.1, 0, 0.3\n16, 1.1, 0, 0.3\n\
         17, 1.1, 0.7, 0.3\n18, 0.1, 0.7, 0.3\n9, 0.2, 0.1, 1e-300\n4, 5, 5, -1e300\n\
         *ELEMENT, TYPE=C3D8, ELSET=BLOCK\n1, 11, 12, 13, 14, 15, 16, 17, 18\n\
         *ELEMENT, TYPE=C3D4, ELSET=TIP\n2, 15, 16, 18, 9\n\
         *NSET, NSET=A/B\n15, 4\n",
    );
    let Some(Grid { points, cells, arrays, .. }) = opened(&deck, &folder) else { return };
    let expected = [
        [0.1, 0.0, 0.0],
        [1.1, 0.0, 0.0],
        [1.1, 0.7, 0.0],
        [0.1, 0.7, 0.0],
        [0.1, 0.0, 0.3],
        [1.1, 0.0, 0.3],
        [1.1, 0.7, 0.3],
        [0.1, 0.7, 0.3],
        [0.2, 0.1, 1e-300],
        [5.0, 5.0, -1e300],
    ];
    assert_eq!(points, expected);
    let cells: Vec<(u64, Vec<usize>)> = cells.into_iter().map(|cell| (cell.kind, cell.points)).collect();
    assert_eq!(cells, [(12, (0..8).collect()), (10, vec![4, 5, 7, 8]), (1, vec![9])]);
    let names: Vec<&str> = arrays.keys().map(String::as_str).collect();
    assert_eq!(names, ["A_B", "BLOCK", "TIP", "node"]);
    assert_eq!(arrays["node"], [11.0, 12.0, 13.0, 14.0, 15.0, 16.0, 17.0, 18.0, 9.0, 4.0]);
    let members = |name: &str| {
        let values = arrays[name].iter().enumerate();
        assert!(arrays[name].iter().all(|value| [0.0, 1.0].contains(value)), "{name}");
        values.filter(|(_, value)| **value == 1.0).map(|(point, _)| point).collect::<Vec<_>>()
    };
    assert_eq!((members("BLOCK"), members("TIP")), ((0..8).collect(), vec![4, 5, 7, 8]));
    assert_eq!(members("A_B"), [4, 9]);
}

/// Gmsh orders the twenty nodes of a brick in another way. For VTK each edge of the box has its two ends along one axis and its middle
/// between them.
#[test]
fn vtk_finds_nodes_in_the_middles_of_edges() {
    /// Gmsh's places are right to 1e-11.
    const GMSH: f64 = 1e-10;
    let folder = Folder::new();
    let source = fixture("mesh/box22.msh");
    let Some(Grid { points, cells, arrays, .. }) = opened(&source, &folder) else { return };
    let text = std::fs::read_to_string(&source).expect("a mesh");
    let nodes = text.lines().skip_while(|line| *line != "$Nodes").skip(2).take_while(|line| *line != "$EndNodes");
    let place = |line: &str| -> Vec<f64> { line.split(' ').skip(1).map(|x| x.parse().expect("a number")).collect() };
    assert_eq!(points.iter().map(|point| point.to_vec()).collect::<Vec<_>>(), nodes.map(place).collect::<Vec<_>>());
    let kinds: Vec<u64> = cells.iter().map(|cell| cell.kind).filter(|kind| *kind != 1).collect();
    assert_eq!(kinds.iter().filter(|kind| **kind == 25).count(), 2, "{kinds:?}");
    for (kind, edge) in cells.iter().flat_map(|cell| cell.edges.iter().map(move |edge| (cell.kind, edge))) {
        let [a, b, middle] = [0, 1, 2].map(|at| points[edge[at]]);
        assert_eq!(
            (0..3).filter(|axis| (a[*axis] - b[*axis]).abs() > GMSH).count(),
            1,
            "an edge of {kind}: {a:?} {b:?}"
        );
        assert!((0..3).all(|axis| (middle[axis] - 0.5 * (a[axis] + b[axis])).abs() < GMSH), "{kind}: {a:?} {middle:?}");
    }
    let at_height = |z: f64| points.iter().map(|point| f64::from(u8::from(point[2] == z))).collect::<Vec<_>>();
    assert_eq!((&arrays["BOTTOM"], &arrays["TOP and more"]), (&at_height(0.0), &at_height(1.0)));
    assert_eq!(arrays["BODY"], vec![1.0; 32]);
    let names: BTreeSet<&str> = arrays.keys().map(String::as_str).collect();
    assert_eq!(names, BTreeSet::from(["BODY", "BOTTOM", "TOP and more", "curve 7", "node"]));
}
