//! `supel recover`: states of a simulation expanded to what happens inside, against the full model.

mod displacements;
mod loads;
#[cfg(feature = "hdf5")]
mod opened_by_vtk;
mod quantities;
mod refused;
#[cfg(feature = "hdf5")]
mod series;

use std::collections::BTreeMap;

use supel::cli::ExitCode;
use supel_models::Model;
use supel_testing::place::{Ended, Place, steel_brick, supel};

/// Labels of the interface nodes, which keep their own dofs.
const FOOT: [i64; 3] = [1, 11, 31];

/// The steel block with an interface of three nodes and as many as nine coordinates, all nodes recovered, reduced to x.supel.
struct Case {
    place: Place,
    model: Model,
}

impl Case {
    fn new(method: &str) -> Self {
        Self::with(method, "{ name = \"foot\", nodes = [1, 11, 31] }")
    }

    fn with(method: &str, interfaces: &str) -> Self {
        let labels: Vec<String> = (1..=45).map(|label| label.to_string()).collect();
        Self::writing(method, interfaces, &format!("recovery = {{ nodes = [{}] }}", labels.join(", ")))
    }

    /// With other keys of `[write]`.
    fn writing(method: &str, interfaces: &str, write: &str) -> Self {
        Self { place: Place::with_brick(), model: steel_brick() }.reduced(method, interfaces, write)
    }

    /// The place once more, with other keys of `[write]`.
    fn again(self, interfaces: &str, write: &str) -> Self {
        self.reduced("craig-bampton", interfaces, write)
    }

    fn reduced(self, method: &str, interfaces: &str, write: &str) -> Self {
        let nodes = if self.place.path("mesh.xdmf").exists() { "mesh.xdmf" } else { "nodes.csv" };
        let job = format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "{nodes}" }}
interface = [{interfaces}]
reduction = {{ method = "{method}", modes = {{ count = 5 }} }}
[write]
superelement = "x.supel"
{write}
"#
        );
        self.place.write("job.toml", job.as_bytes());
        supel(&["reduce", &self.place.text("job.toml"), "--quiet"]).expect(ExitCode::Done);
        self
    }

    /// The header that a table of states of x.supel has.
    fn header(&self) -> String {
        let ended = supel(&["inspect", &self.place.text("x.supel"), "--coordinates"]).expect(ExitCode::Done);
        ended.out.trim_end().to_owned()
    }

    /// Writes a table of states.
    fn table(&self, name: &str, header: &str, states: &[Vec<f64>]) {
        let rows = states.iter().map(|state| state.iter().map(f64::to_string).collect::<Vec<_>>().join(","));
        let text = std::iter::once(header.to_owned()).chain(rows).collect::<Vec<_>>().join("\n") + "\n";
        self.place.write(name, text.as_bytes());
    }

    /// `supel recover x.supel --state q.csv`, with more arguments; words that end in `.csv` are files of the folder.
    fn recover(&self, more: &[&str]) -> Ended {
        let in_place = |word: &&str| if word.ends_with(".csv") { self.place.text(word) } else { (*word).to_owned() };
        let mut args =
            vec!["recover".to_owned(), self.place.text("x.supel"), "--state".to_owned(), self.place.text("q.csv")];
        args.extend(more.iter().map(in_place));
        supel(&args.iter().map(String::as_str).collect::<Vec<_>>())
    }

    /// The rows of a table, each by the names of its columns.
    fn rows(&self, name: &str) -> Vec<BTreeMap<String, String>> {
        let text = String::from_utf8(self.place.bytes(name)).expect("UTF-8");
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        let header = lines.next().expect("a header");
        let row = |fields: Vec<String>| {
            assert_eq!(fields.len(), header.len(), "{fields:?}");
            header.iter().cloned().zip(fields).collect()
        };
        lines.map(row).collect()
    }

    /// One column of the rows of a state, in the order of the table.
    fn values(&self, name: &str, state: usize, column: &str) -> Vec<f64> {
        let of_state = |row: &&BTreeMap<String, String>| row["state"] == state.to_string();
        self.rows(name).iter().filter(of_state).map(|row| row[column].parse().expect("a number")).collect()
    }
}

/// Names of all files in the folder of a case.
fn files(case: &Case) -> Vec<String> {
    let entries = std::fs::read_dir(case.place.path("")).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// A direct interface and a rigid patch.
fn foot_and_hub() -> &'static str {
    "{ name = \"foot\", nodes = [1, 11, 31] }, { name = \"hub\", nodes = [5, 10, 15, 20, 25], coupling = \"rigid\" }"
}

/// Rows of the interface in the full model, in the order of the coordinates.
fn foot_rows(model: &Model) -> Vec<usize> {
    (0..model.n).filter(|row| FOOT.contains(&model.dofs[*row].0)).collect()
}

/// The largest entry.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max: f64, value| max.max(value.abs()))
}

/// The largest difference, relative to the largest entry of what is expected.
fn difference(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    assert!(largest(expected) > 0.0, "there is something to compare with");
    largest(&found.iter().zip(expected).map(|(a, b)| a - b).collect::<Vec<_>>()) / largest(expected)
}

/// Numbers between −1 and 1 that have nothing to do with each other.
fn any(n: usize, seed: u64) -> Vec<f64> {
    let mut random = supel_models::SplitMix64::new(seed);
    (0..n).map(|_| 2.0 * random.uniform() - 1.0).collect()
}
