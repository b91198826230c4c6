//! VTKHDF files as VTK reads them, in a Python that has it.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

/// The grid at one time.
pub struct Grid {
    /// Where the file has times.
    pub time: Option<f64>,
    pub points: Vec<[f64; 3]>,
    pub cells: Vec<Cell>,
    /// Values at points by their name, those of a vector one after the other.
    pub arrays: BTreeMap<String, Vec<f64>>,
}

#[derive(Debug, PartialEq, Eq)]
pub struct Cell {
    /// VTK's number.
    pub kind: u64,
    pub points: Vec<usize>,
    /// Points of each edge as VTK sees them: both ends, then the middle where there is one.
    pub edges: Vec<Vec<usize>>,
}

/// What VTK reads of a file at each of its times; `None`, with a message, where `SUPEL_PYTHON`, or `python3`, has no VTK.
pub fn read(file: &Path) -> Option<Vec<Grid>> {
    let python = std::env::var("SUPEL_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let probe = Command::new(&python).args(["-c", "import numpy, vtkmodules.vtkIOHDF"]).output();
    if !probe.is_ok_and(|probe| probe.status.success()) {
        println!("skipped: {python} has no numpy and vtk; set SUPEL_PYTHON");
        return None;
    }
    // A process that another test started in between may hold the lock of the file that was written.
    let folder = tempfile::tempdir().expect("a folder");
    let copy = folder.path().join("copied.vtkhdf");
    std::fs::copy(file, &copy).expect("copied");
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/src/vtk.py");
    let ended = Command::new(python).arg(script).arg(copy).output().expect("Python");
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    let states: Value = serde_json::from_slice(&ended.stdout).expect("JSON");
    Some(listed(&states, grid))
}

fn grid(state: &Value) -> Grid {
    let arrays = state["arrays"].as_object().expect("arrays");
    Grid {
        time: state["time"].is_string().then(|| number(&state["time"])),
        points: listed(&state["points"], number).as_chunks().0.to_vec(),
        cells: listed(&state["cells"], cell),
        arrays: arrays.iter().map(|(name, values)| (name.clone(), listed(values, number))).collect(),
    }
}

fn cell(cell: &Value) -> Cell {
    let points = |points: &Value| listed(points, |point| point.as_u64().expect("a point") as usize);
    Cell {
        kind: cell["kind"].as_u64().expect("a kind"),
        points: points(&cell["points"]),
        edges: listed(&cell["edges"], points),
    }
}

fn listed<T>(list: &Value, of: impl Fn(&Value) -> T) -> Vec<T> {
    list.as_array().expect("a list").iter().map(of).collect()
}

fn number(text: &Value) -> f64 {
    text.as_str().expect("a text").parse().expect("a number")
}
