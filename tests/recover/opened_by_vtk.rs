//! Series as VTK opens them and goes from state to state. Skipped, with a message, where Python has no VTK.

use supel::cli::ExitCode;
use supel::recovery::{Cells, Field, Series, Values};
use supel_testing::place::{Place, bricks_of_eight, steel_brick, xdmf};
use supel_testing::vtk;

use super::{Case, any};

/// Three states: the times of the table of states, the surface of the block, and the vectors of the table of displacements.
#[test]
fn vtk_plays_the_recovered_states() {
    let case = Case { place: Place::with_brick(), model: steel_brick() };
    case.place.write("mesh.xdmf", xdmf(&case.model.nodes, &[bricks_of_eight()]).as_bytes());
    let all = "recovery = { nodes = { within = { box = { min = [0, 0, 0], max = [1, 1, 1] } } } }";
    let case = case.reduced("craig-bampton", "{ name = \"foot\", nodes = [1, 11, 31] }", all);
    let times = [0.0, 0.1, 0.7];
    let header = format!("time,{}", case.header());
    let states = |seed| (0..3).map(|at| [vec![times[at]], any(14, seed + at as u64)].concat()).collect::<Vec<_>>();
    case.table("q.csv", &header, &states(1));
    case.table("a.csv", &header, &states(11));
    let path = case.place.text("u.vtkhdf");
    case.recover(&["-o", "u.csv", "--acceleration", "a.csv", "--vtkhdf", &path]).expect(ExitCode::Done);
    let Some(grids) = vtk::read(path.as_ref()) else { return };

    assert_eq!(grids.iter().map(|grid| grid.time).collect::<Vec<_>>(), times.map(Some));
    let superelement = case.place.superelement("x.supel");
    let faces = superelement.tensors().recovery.as_ref().and_then(|recovery| recovery.faces()).expect("faces");
    let faces = faces.iter().map(|face| (9, face.to_vec()));
    // The middle line but for its ends is inside.
    let cells: Vec<(u64, Vec<usize>)> = faces.chain([21, 22, 23].map(|inside| (1, vec![inside]))).collect();
    assert_eq!(cells.len(), 40 + 3);
    for (number, grid) in (1..).zip(&grids) {
        assert_eq!(grid.points, case.model.nodes, "state {number}");
        let found: Vec<_> = grid.cells.iter().map(|cell| (cell.kind, cell.points.clone())).collect();
        assert_eq!(found, cells, "state {number}");
        assert_eq!(grid.arrays.keys().collect::<Vec<_>>(), ["acceleration", "displacement"], "state {number}");
        for (name, found) in &grid.arrays {
            // The table has all digits of the same doubles.
            assert_eq!(found, &case.values("u.csv", number, name), "{name} of state {number}");
        }
    }
    let displacements: Vec<_> = grids.iter().map(|grid| &grid.arrays["displacement"]).collect();
    assert!(displacements[0] != displacements[1] && displacements[1] != displacements[2], "states differ");
}

/// Points that move, and those of the state before where a state gives none.
#[test]
fn vtk_sees_points_that_move() {
    let place = Place::new();
    let path = place.path("moving.vtkhdf");
    let at = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
    let cells = Cells::of_faces([[0, 1, 2].as_slice()], 3);
    let mut series = Series::create(&path, 3, &cells, &[Field { name: "heat", n_components: 1 }]).expect("a file");
    for (time, points) in [(1.5, Some(at(0.1))), (2.5, Some(at(0.2))), (3.5, None)] {
        let values = [time, 2.0 * time, 3.0 * time];
        series.push(time, points.as_ref().map(<[_; 3]>::as_slice), &[Values::Scalars(&values)]).expect("a state");
    }
    series.finish().expect("written");
    let Some(grids) = vtk::read(&path) else { return };
    let found: Vec<_> = grids.iter().map(|grid| (grid.time, grid.points.clone())).collect();
    assert_eq!(found, [(1.5, 0.1), (2.5, 0.2), (3.5, 0.2)].map(|(time, z)| (Some(time), at(z).to_vec())));
    for (grid, time) in grids.iter().zip([1.5, 2.5, 3.5]) {
        assert_eq!(grid.arrays["heat"], [time, 2.0 * time, 3.0 * time]);
        assert_eq!((grid.cells.len(), grid.cells[0].kind, &grid.cells[0].points), (1, 5, &vec![0, 1, 2]));
    }
}
