//! Folders with models in them, and the command line run on them in process.

use std::ffi::OsString;
use std::fs;
use std::path::PathBuf;

use serde_json::Value;
use supel::cli::{ExitCode, Terminal, run};
use supel::cost_forecast::{NOMINAL, Rates};
use supel_models::{Material, Model, brick, write};
use supel_runtime::Superelement;

/// What a command left behind.
pub struct Ended {
    pub code: ExitCode,
    pub out: String,
    pub err: String,
}

impl Ended {
    #[track_caller]
    pub fn expect(self, code: ExitCode) -> Self {
        assert_eq!(self.code, code, "{}{}", self.out, self.err);
        self
    }
}

/// Runs `supel` with these arguments. A job that is up to date runs all the same: what a test asks for is what it looks at.
pub fn supel(args: &[&str]) -> Ended {
    let is_run = args.first() == Some(&"reduce");
    let pipeline = supel::cli::Pipeline { rates: nominal_rates, ..supel::PIPELINE };
    supel_as_typed(pipeline, &[args, if is_run { &["--force"] } else { &[] }].concat())
}

/// Runs `supel` with these arguments and no others.
pub fn supel_as_typed(pipeline: supel::cli::Pipeline, args: &[&str]) -> Ended {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let args = std::iter::once("supel").chain(args.iter().copied()).map(OsString::from);
    let code = run(args, pipeline, &mut Terminal::plain(&mut out, &mut err));
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    Ended { code, out: text(out), err: text(err) }
}

/// How fast a machine is that no test has to be measured on.
fn nominal_rates(
    _: usize,
    _: supel::cli::Calibration,
    _: &mut dyn supel::report::Observer,
) -> supel::error::Result<Rates> {
    Ok(NOMINAL)
}

/// A folder of its own.
pub struct Place(tempfile::TempDir);

impl Place {
    #[expect(clippy::new_without_default, reason = "it makes a folder")]
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("folder"))
    }

    /// A folder with K.mtx, M.mtx, dofs.txt and nodes.csv of a model.
    pub fn with(model: &Model) -> Self {
        let place = Self::new();
        let write = |name: &str, put: &dyn Fn(&mut Vec<u8>)| {
            let mut bytes = Vec::new();
            put(&mut bytes);
            place.write(name, &bytes);
        };
        let matrix = |bytes: &mut Vec<u8>, entries| write::matrix_market(bytes, model.n, entries, "").expect("written");
        write("K.mtx", &|bytes| matrix(bytes, &model.stiffness));
        write("M.mtx", &|bytes| matrix(bytes, &model.mass));
        write("dofs.txt", &|bytes| write::dof_map(bytes, model).expect("written"));
        write("nodes.csv", &|bytes| write::nodes_csv(bytes, model).expect("written"));
        place
    }

    /// A steel block of 4 × 2 × 2 bricks, 135 dofs: free, with no two natural frequencies alike.
    pub fn with_brick() -> Self {
        Self::with(&steel_brick())
    }

    /// The folder with the bundled example.
    pub fn with_example() -> Self {
        let place = Self::new();
        let example = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/bracket");
        for name in ["job.toml", "stiffness.mtx.gz", "mass.mtx.gz", "bracket.med"] {
            fs::copy(example.join(name), place.path(name)).expect("copied");
        }
        place
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn text(&self, name: &str) -> String {
        self.path(name).display().to_string()
    }

    pub fn write(&self, name: &str, content: &[u8]) {
        // A file written over waits for the disk on some systems; a new one does not.
        let _ = fs::remove_file(self.path(name));
        fs::write(self.path(name), content).expect("written");
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).expect("read")
    }

    /// The flags that name the files of a model with coordinates.
    pub fn model_flags(&self) -> Vec<String> {
        let mut flags = self.matrix_flags();
        flags.extend(["--dofs".into(), self.text("dofs.txt")]);
        flags.extend(["--nodes".into(), self.text("nodes.csv")]);
        flags
    }

    /// The flags that name the matrices alone.
    pub fn matrix_flags(&self) -> Vec<String> {
        let flags = ["--stiffness".into(), self.text("K.mtx"), "--mass".into(), self.text("M.mtx")];
        flags.into()
    }

    /// `supel reduce` by flags alone to x.supel; `rest` is split at spaces.
    pub fn reduce(&self, model: &[String], rest: &str) -> Ended {
        let output = self.text("x.supel");
        let mut args: Vec<&str> = vec!["reduce", "--output", &output];
        args.extend(model.iter().map(String::as_str));
        args.extend(rest.split_whitespace());
        supel(&args)
    }

    pub fn superelement(&self, name: &str) -> Superelement {
        Superelement::open(&self.path(name)).expect("a superelement")
    }

    pub fn report(&self, name: &str) -> Value {
        serde_json::from_slice(&self.bytes(name)).expect("JSON")
    }

    /// The bytes of the report's body, everything before the facts of the run.
    pub fn report_body(&self, name: &str) -> String {
        let report = String::from_utf8(self.bytes(name)).expect("UTF-8");
        let (body, _) = report.split_once("\n  \"run\": {").expect("facts of the run");
        body.to_owned()
    }
}

pub fn steel_brick() -> Model {
    brick([4, 2, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI)
}

/// A mesh as an XDMF document: points, and topologies by their names with the cells of each.
pub fn xdmf(points: &[[f64; 3]], topologies: &[(&str, Vec<Vec<usize>>)]) -> String {
    let item = |values: Vec<String>| {
        format!("<DataItem Dimensions=\"{}\" Format=\"XML\">{}</DataItem>", values.len(), values.join(" "))
    };
    let cells = topologies.iter().map(|(kind, cells)| {
        let numbers = item(cells.iter().flatten().map(usize::to_string).collect());
        format!("<Topology TopologyType=\"{kind}\">{numbers}</Topology>")
    });
    let (cells, places) = (cells.collect::<String>(), item(points.iter().flatten().map(f64::to_string).collect()));
    format!("<Xdmf><Domain><Grid>{cells}<Geometry GeometryType=\"XYZ\">{places}</Geometry></Grid></Domain></Xdmf>")
}

/// The eight bricks of the steel block, each of eight nodes.
pub fn bricks_of_eight() -> (&'static str, Vec<Vec<usize>>) {
    let mesh = supel_models::HexMesh::structured([4, 2, 2], |point| point, |_| true);
    let cell = |corners: &[u32; 8]| corners.iter().map(|corner| *corner as usize).collect();
    ("Hexahedron", mesh.elements.iter().map(cell).collect())
}

/// The nodes of the steel block as two bricks of 27 nodes, in the order of VTK.
pub fn bricks_of_27() -> (&'static str, Vec<Vec<usize>>) {
    /// Places in a brick, in halves of it: corners, edges below, above and upright, and the six faces, as far as supel looks at them.
    const PLACES: [[usize; 3]; 27] = [
        [0, 0, 0],
        [2, 0, 0],
        [2, 2, 0],
        [0, 2, 0],
        [0, 0, 2],
        [2, 0, 2],
        [2, 2, 2],
        [0, 2, 2],
        [1, 0, 0],
        [2, 1, 0],
        [1, 2, 0],
        [0, 1, 0],
        [1, 0, 2],
        [2, 1, 2],
        [1, 2, 2],
        [0, 1, 2],
        [0, 0, 1],
        [2, 0, 1],
        [2, 2, 1],
        [0, 2, 1],
        [0, 1, 1],
        [2, 1, 1],
        [1, 0, 1],
        [1, 2, 1],
        [1, 1, 0],
        [1, 1, 2],
        [1, 1, 1],
    ];
    let node = |first: usize, [i, j, k]: [usize; 3]| first + i + 5 * (j + 3 * k);
    let cell = |first: usize| PLACES.iter().map(|place| node(first, *place)).collect();
    ("Hexahedron_27", vec![cell(0), cell(2)])
}

/// The natural frequencies a superelement names, in Hz.
pub fn frequencies_hz(superelement: &Superelement) -> Vec<f64> {
    let omega = &superelement.tensors().frequencies;
    omega.iter().map(|omega| omega / std::f64::consts::TAU).collect()
}

/// Asserts that two lists of frequencies agree relatively.
#[track_caller]
pub fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?}\n{expected:?}");
    for (found, expected) in found.iter().zip(expected) {
        let difference = (found / expected - 1.0).abs();
        assert!(difference <= tolerance, "{found} and {expected} differ by {difference:e}");
    }
}

/// Codes of the warnings in a report that say something of the reduction, in their order: how far it suits a scene is another matter.
pub fn warnings_of_reduction(report: &Value) -> Vec<String> {
    let warnings = report["body"]["warnings"].as_array().expect("warnings").iter();
    let codes = warnings.map(|warning| warning["code"].as_str().expect("a code").to_owned());
    codes.filter(|code| !["W-ACCURACY", "W-LARGE", "W-NO-MODES"].contains(&code.as_str())).collect()
}
