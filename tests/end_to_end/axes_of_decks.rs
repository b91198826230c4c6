//! Nodes of Nastran with axes of their own, where the decks of the matrices state them: in whichever deck CD stands, rows are along it.

use supel::cli::ExitCode;
use supel_models::Model;
use supel_models::transform::in_local_frames;

use crate::node_frames::assert_is_that_of;
use crate::place::{Place, steel_brick, supel};

/// The node whose rows are along axes of its own: x along (1, 1, 0), y along (-1, 1, 0).
const TURNED: i64 = 7;
const SYSTEM: &str = "CORD2R,4,,0.,0.,0.,0.,0.,1.\n,1.,1.,0.\n";
const REDUCTION: &str = "--interface hub=5,15,45 --method guyan";

/// GRID entries of a model, with the system of the node that is turned.
fn grids(model: &Model, cd: &str) -> String {
    let system = |label: i64| if label == TURNED { cd } else { "" };
    let grid = |(label, [x, y, z]): (i64, &[f64; 3])| format!("GRID,{label},,{x:?},{y:?},{z:?},{}\n", system(label));
    SYSTEM.to_owned() + &(1i64..).zip(&model.nodes).map(grid).collect::<String>()
}

/// The entries of a matrix.
fn dmig(name: &str, entries: &[(u32, u32, f64)], dofs: &[(i64, u8)]) -> String {
    let row = |row: u32| dofs[row as usize];
    let entry = |(i, j, value): &(u32, u32, f64)| {
        let ((g, c), (h, d)) = (row(*i), row(*j));
        format!("DMIG,{name},{h},{},,{g},{},{value:E}\n", d + 1, c + 1)
    };
    let below = entries.iter().filter(|(i, j, _)| i >= j);
    format!("DMIG,{name},0,6,2,0\n") + &below.map(entry).collect::<String>()
}

/// A model as decks: its matrices alone, and behind grid points that state the axes and those that do not.
struct Decks {
    sound: Model,
    place: Place,
}

impl Decks {
    fn new() -> Self {
        let sound = steel_brick();
        let h = 0.5f64.sqrt();
        let model = in_local_frames(&sound, &[[h, h, 0.0], [-h, h, 0.0], [0.0, 0.0, 1.0]], |node| node == TURNED);
        let place = Place::with(&model);
        for (name, entries) in [("K", &model.stiffness), ("M", &model.mass)] {
            let matrix = dmig(&format!("{name}AAX"), entries, &model.dofs);
            place.write(&format!("{name}.pch"), matrix.as_bytes());
            for (kind, cd) in [("turned", "4"), ("along", "")] {
                let deck = format!("BEGIN BULK\n{}{matrix}ENDDATA\n", grids(&sound, cd));
                place.write(&format!("{name}-{kind}.bdf"), deck.as_bytes());
            }
        }
        let rows: String = (1..=sound.nodes.len()).map(|label| format!("EXTRN,{label},123\n")).collect();
        for (kind, cd) in [("turned", "4"), ("along", "")] {
            place.write(&format!("rows-{kind}.bdf"), format!("BEGIN BULK\n{}{rows}", grids(&sound, cd)).as_bytes());
        }
        Self { sound, place }
    }

    fn flags(&self, [stiffness, mass]: [&str; 2], dofs: Option<&str>) -> Vec<String> {
        let text = |name: &str| self.place.text(name);
        let mut flags = vec!["--stiffness".to_owned(), text(stiffness), "--mass".to_owned(), text(mass)];
        flags.extend(dofs.iter().flat_map(|name| ["--dofs".to_owned(), text(name)]));
        flags
    }

    #[track_caller]
    fn assert_turned(&self, matrices: [&str; 2], dofs: Option<&str>) {
        self.place.reduce(&self.flags(matrices, dofs), REDUCTION).expect(ExitCode::Done);
        assert_is_that_of(&self.place, &self.sound, REDUCTION);
    }

    #[track_caller]
    fn assert_refused(&self, matrices: [&str; 2], dofs: Option<&str>, named: [&str; 2]) {
        let ended = self.place.reduce(&self.flags(matrices, dofs), REDUCTION).expect(ExitCode::InputData);
        for expected in ["E-FRAME-DIFFER", "node 7 is along", named[0], named[1]] {
            assert!(ended.err.contains(expected), "{expected}: {}", ended.err);
        }
    }
}

#[test]
fn the_deck_of_a_matrix_says_the_axes_of_its_rows_whatever_the_map_is() {
    let decks = Decks::new();
    for dofs in [None, Some("dofs.txt"), Some("rows-turned.bdf")] {
        decks.assert_turned(["K-turned.bdf", "M.pch"], dofs);
    }
    decks.assert_refused(["K-turned.bdf", "M.pch"], Some("rows-along.bdf"), ["rows-along.bdf", "K-turned.bdf"]);
    decks.assert_refused(["K-along.bdf", "M.pch"], Some("rows-turned.bdf"), ["rows-turned.bdf", "K-along.bdf"]);
}

#[test]
fn the_deck_of_the_mass_says_the_axes_too() {
    let decks = Decks::new();
    for dofs in [None, Some("dofs.txt"), Some("rows-turned.bdf")] {
        decks.assert_turned(["K.pch", "M-turned.bdf"], dofs);
    }
    decks.assert_turned(["K-turned.bdf", "M-turned.bdf"], None);
    decks.assert_turned(["K.mtx", "M-turned.bdf"], Some("dofs.txt"));
    decks.assert_refused(["K.pch", "M-along.bdf"], Some("rows-turned.bdf"), ["rows-turned.bdf", "M-along.bdf"]);
}

#[test]
fn decks_of_stiffness_and_mass_that_state_other_axes_are_refused_with_both() {
    let decks = Decks::new();
    decks.assert_refused(["K-turned.bdf", "M-along.bdf"], None, ["K-turned.bdf", "M-along.bdf"]);
    decks.assert_refused(["K-along.bdf", "M-turned.bdf"], None, ["K-along.bdf", "M-turned.bdf"]);
    // The table of the job holds whatever they state, and a note says so.
    decks.place.write("frames.csv", b"node,x1,x2,x3,y1,y2,y3\n7,1,1,0,-1,1,0\n");
    let mut flags = decks.flags(["K-turned.bdf", "M-along.bdf"], None);
    flags.extend(["--frames".to_owned(), decks.place.text("frames.csv")]);
    decks.place.reduce(&flags, REDUCTION).expect(ExitCode::Done);
    let report = decks.place.report("x.report.json").to_string();
    assert!(report.contains("frames.csv: M-along.bdf states other axes of node 7"), "{report}");
    assert_is_that_of(&decks.place, &decks.sound, REDUCTION);
}

#[test]
fn the_deck_of_a_further_matrix_has_to_state_the_same_axes() {
    let decks = Decks::new();
    let job = |matrix: &str, model: &str| {
        format!(
            "interface = [{{ name = \"hub\", nodes = [5, 15, 45] }}]\nreduction = {{ method = \"guyan\" }}\n\
             matrix = [{{ name = \"c\", file = \"{matrix}\", kind = \"other\" }}]\n[model]\n{model}\n\
             [write]\nsuperelement = \"x.supel\"\n"
        )
    };
    let turned = "stiffness = \"K-turned.bdf\"\nmass = \"M.pch\"";
    // Neither K nor M says where its rows are.
    let silent = "stiffness = \"K.pch\"\nmass = \"M.pch\"";
    for (matrix, model, code) in [
        ("M-turned.bdf", turned, ExitCode::Done),
        ("M.pch", turned, ExitCode::Done),
        ("M-along.bdf", turned, ExitCode::InputData),
        ("M-turned.bdf", silent, ExitCode::InputData),
    ] {
        decks.place.write("job.toml", job(matrix, model).as_bytes());
        let ended = supel(&["reduce", &decks.place.text("job.toml")]).expect(code);
        let is_named = ended.err.contains("E-FRAME-DIFFER") && ended.err.contains(matrix);
        assert_eq!(is_named, code == ExitCode::InputData, "{matrix}: {}", ended.err);
    }
}

/// Grid points of a deck are nodes, in whatever system they are given and by their labels, and CD is that of the rows.
#[test]
fn grid_points_of_a_deck_are_nodes() {
    let decks = Decks::new();
    let h = 0.5f64.sqrt();
    let grid = |(label, [x, y, z]): (i64, &[f64; 3])| {
        let [a, b] = [h * (x + y), h * (y - x)];
        let cd = if label == TURNED { "4" } else { "" };
        format!("GRID,{label},4,{a:?},{b:?},{z:?},{cd}\n")
    };
    let grids: String = (1i64..).zip(&decks.sound.nodes).map(grid).collect();
    decks.place.write("grids.inc", grids.as_bytes());
    decks.place.write("nodes.bdf", format!("BEGIN BULK\n{SYSTEM}INCLUDE 'grids.inc'\n").as_bytes());
    let mut flags = decks.flags(["K.mtx", "M.mtx"], Some("dofs.txt"));
    flags.extend(["--nodes".to_owned(), decks.place.text("nodes.bdf")]);
    let ended = decks.place.reduce(&flags, REDUCTION).expect(ExitCode::Done);
    assert!(ended.out.contains("6 modes from the coordinates"), "{}", ended.out);
    assert_is_that_of(&decks.place, &decks.sound, REDUCTION);
    decks.place.write("nodes.bdf", b"BEGIN BULK\nGRID,1,,x,0.,0.\n");
    let ended = decks.place.reduce(&flags, REDUCTION).expect(ExitCode::InputData);
    assert!(ended.err.contains("three coordinates of a grid point"), "{}", ended.err);
    decks.place.write("nodes.bdf", b"BEGIN BULK\nSPOINT,1\n");
    let ended = decks.place.reduce(&flags, REDUCTION).expect(ExitCode::InputData);
    assert!(ended.err.contains("E-NO-DATA"), "{}", ended.err);
}
