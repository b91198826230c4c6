//! Sound superelements of every kind, with the jobs that made them.

use std::path::Path;

use supel::cli::ExitCode;
use supel::job::Job;
use supel_models::transform::supported;
use supel_models::{Ends, Material, brick, spring};
use supel_runtime::Superelement;

use crate::place::{Place, steel_brick, supel};

/// A sound superelement and its job.
pub(super) struct Subject {
    pub(super) name: &'static str,
    pub(super) superelement: Superelement,
    /// The file's own bytes are in its folder.
    place: Place,
}

impl Subject {
    /// The job, its paths absolute.
    pub(super) fn job(&self) -> Job {
        Job::read(&self.place.path("job.toml")).expect("a job")
    }

    fn of(name: &'static str, place: Place, job: &str) -> Self {
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml"), "--quiet"]).expect(ExitCode::Done);
        Self { name, superelement: place.superelement("x.supel"), place }
    }
}

const FILES: &str = r#"
    stiffness = "K.mtx"
    mass = "M.mtx"
"#;
const MESH: &str = r#"
    dofs = "dofs.txt"
    nodes = "nodes.csv"
    units = "SI"
"#;

fn text(model: &str, interfaces: &str, reduction: &str, write: &str) -> String {
    format!("[model]\n{model}\n{interfaces}\n[reduction]\n{reduction}\n[write]\nsuperelement = \"x.supel\"\n{write}\n")
}

fn patch(name: &str, nodes: &str, coupling: &str) -> String {
    format!("[[interface]]\nname = \"{name}\"\nnodes = {nodes}\ncoupling = \"{coupling}\"\n")
}

/// The bundled bracket by both methods, with recovered nodes.
#[cfg(feature = "hdf5")]
fn bracket(name: &'static str, method: &str) -> Subject {
    let place = Place::with_example();
    let job = String::from_utf8(place.bytes("job.toml")).expect("UTF-8");
    let job = job.replace("herting", method).replace("bracket.supel", "x.supel");
    let job = job + "recovery = { nodes = { within = { sphere = { center = [0, 0, 40], radius = 16 } } } }\n";
    Subject::of(name, place, &job)
}

#[cfg(feature = "hdf5")]
fn brackets() -> Vec<Subject> {
    vec![bracket("bracket, Herting", "herting"), bracket("bracket, Craig-Bampton", "craig-bampton")]
}

/// The mesh of the bundled example takes HDF5.
#[cfg(not(feature = "hdf5"))]
fn brackets() -> Vec<Subject> {
    Vec::new()
}

/// A brick with direct and rigid interfaces, recovered in single precision.
fn solid(name: &'static str, method: &str) -> Subject {
    let place = Place::with(&steel_brick());
    let interfaces = patch("foot", "[1, 11, 31, 41]", "direct") + &patch("head", "[5, 15, 35]", "rigid");
    let reduction = format!("method = \"{method}\"\nmodes = {{ count = 6 }}");
    let recovery = "recovery = { nodes = [22, 23, 24], precision = \"single\" }";
    Subject::of(name, place, &text(&(FILES.to_owned() + MESH), &interfaces, &reduction, recovery))
}

/// So many modes that some depend on others: nine nodes of two layers are interface.
fn dropped() -> Subject {
    let place = Place::with(&brick([2, 2, 2], [0.4, 0.31, 0.23], &Material::STEEL_SI));
    let labels = (1..=24).map(|label: i32| label.to_string()).collect::<Vec<_>>().join(", ");
    let interfaces = patch("most", &format!("[{labels}]"), "direct");
    let reduction = "method = \"herting\"\nmodes = { count = 12 }";
    Subject::of("columns left out", place, &text(&(FILES.to_owned() + MESH), &interfaces, reduction, ""))
}

/// A beam of square section, whose bending modes are in pairs.
fn square() -> Subject {
    let place = Place::with(&brick([6, 2, 2], [1.0, 0.2, 0.2], &Material::STEEL_SI));
    let interfaces = patch("foot", "[1, 8, 22, 29]", "rigid");
    let reduction = "method = \"craig-bampton\"\nmodes = { up_to_hz = 6000 }";
    let recovery = "recovery = { nodes = [18, 49] }\n[scene]\nboundaries = [\"fix:foot\"]";
    Subject::of("repeated modes", place, &text(&(FILES.to_owned() + MESH), &interfaces, reduction, recovery))
}

/// Rows alone, free and held.
fn rows(name: &'static str, ends: Ends, method: &str) -> Subject {
    let place = Place::with(&spring(12, ends));
    let interfaces = "[[interface]]\nname = \"ends\"\nnodes = { rows = [0, 11] }\n";
    let reduction = format!("method = \"{method}\"\nmodes = {{ count = 4 }}");
    Subject::of(name, place, &text(FILES, interfaces, &reduction, ""))
}

/// A solid with quantities and loads: one answered by its residual vector, one by that of the first, one by the modes alone.
fn loaded() -> Subject {
    let place = Place::with(&steel_brick());
    let interfaces = patch("foot", "[1, 11, 31, 41]", "direct")
        + "[[load]]\nname = \"thrust\"\nnodes = [23]\nforce = [1.5, 2.5, 3.5]\n"
        + "[[load]]\nname = \"again\"\nnodes = [23]\nforce = [3.0, 5.0, 7.0]\n"
        + "[[load]]\nname = \"spin\"\nrotation = { axis = [1.5, 0.5, 2.5] }\nresidual = false\n";
    let reduction = "method = \"herting\"\nmodes = { count = 5 }";
    // A strain of an element inside, and another one that is 10⁹ times as large as a number.
    place.write(
        "R.mtx",
        b"%%MatrixMarket matrix coordinate real general\n2 135 4\n1 67 4\n1 64 -4\n2 41 1e9\n2 38 -2e9\n",
    );
    place.write("names.csv", b"name,unit\nstrain,1\nstress,Pa\n");
    let write = "quantities = { matrix = \"R.mtx\", names = \"names.csv\" }";
    Subject::of("loads", place, &text(&(FILES.to_owned() + MESH), &interfaces, reduction, write))
}

/// A solid with a skew matrix and a damping one, and damping of its modes.
fn damped() -> Subject {
    let model = steel_brick();
    let place = Place::with(&model);
    let n = model.n;
    place.write(
        "G.mtx",
        format!("%%MatrixMarket matrix coordinate real skew-symmetric\n{n} {n} 2\n68 67 4\n41 2 3\n").as_bytes(),
    );
    // A damper between two nodes, and one that pushes across.
    let damper = "67 67 9\n67 64 -9\n64 67 -9\n64 64 9\n37 37 5\n37 34 -5\n34 37 -5\n34 34 5\n37 67 2\n34 67 -2\n37 64 -2\n34 64 2\n";
    place.write("C.mtx", format!("%%MatrixMarket matrix coordinate real general\n{n} {n} 12\n{damper}").as_bytes());
    let interfaces = patch("foot", "[1, 11, 31, 41]", "direct")
        + "[[matrix]]\nname = \"spin\"\nkind = \"gyroscopic\"\nfile = \"G.mtx\"\n"
        + "[[matrix]]\nname = \"seal\"\nkind = \"damping\"\nfile = \"C.mtx\"\n"
        + "[damping]\nmodal = { ratio = 0.01 }\n";
    let reduction = "method = \"herting\"\nmodes = { count = 5 }";
    Subject::of("damped", place, &text(&(FILES.to_owned() + MESH), &interfaces, reduction, ""))
}

/// A solid with the modes of a file, of which the last is the first one again.
fn expanded() -> Subject {
    let model = steel_brick();
    let place = Place::with(&model);
    let mut modes = format!("%%MatrixMarket matrix array real general\n{} 4\n", model.n);
    for phase in [0.3, 1.1, 2.3, 0.3] {
        (0..model.n).for_each(|row| modes += &format!("{:.17e}\n", (phase + 1.7 * phase * row as f64).sin()));
    }
    place.write("modes.mtx", modes.as_bytes());
    let interfaces = patch("foot", "[1, 11, 31, 41]", "direct");
    let reduction = "method = \"mode-acceleration\"\nmodes = { file = \"modes.mtx\" }";
    Subject::of("modes of a file", place, &text(&(FILES.to_owned() + MESH), &interfaces, reduction, ""))
}

/// A solid whose modes were computed with one of its interfaces held.
fn mixed() -> Subject {
    let place = Place::with(&steel_brick());
    let interfaces = patch("foot", "[1, 11, 31, 41]", "direct") + &patch("head", "[5, 15, 35]", "rigid");
    let reduction = "method = \"mixed-interface\"\nmodes = { count = 6 }\nheld = [\"head\"]";
    Subject::of("mixed boundaries", place, &text(&(FILES.to_owned() + MESH), &interfaces, reduction, ""))
}

/// A solid that its interface leaves free to turn: static modes are Rubin's, and rigid-body modes are coordinates next to them.
fn turning() -> Subject {
    let place = Place::with(&steel_brick());
    let interfaces = patch("pin", "[1]", "direct")
        + &patch("tip", "[5]", "direct")
        + "[[load]]\nname = \"thrust\"\nnodes = [23]\nforce = [1.5, 2.5, 3.5]\n";
    let reduction = "method = \"rubin\"\nmodes = { count = 5 }";
    let recovery = "recovery = { nodes = [22, 23, 24] }";
    Subject::of("Rubin, free to turn", place, &text(&(FILES.to_owned() + MESH), &interfaces, reduction, recovery))
}

/// A solid on supports: nothing of rigid-body motion ties its fields.
fn held() -> Subject {
    let place = Place::with(&supported(&steel_brick(), |(node, _)| node % 5 == 0));
    let interfaces = patch("foot", "[1, 11, 31, 41]", "rigid")
        + &patch("side", "[23]", "direct")
        + "[[load]]\nname = \"thrust\"\nnodes = [22]\nforce = [1.5, 2.5, 3.5]\n";
    let reduction = "method = \"herting\"\nmodes = { count = 5 }";
    Subject::of("held", place, &text(&(FILES.to_owned() + MESH), &interfaces, reduction, ""))
}

/// A solid without interface: its own modes.
fn modal() -> Subject {
    let place = Place::with(&steel_brick());
    let reduction = "method = \"herting\"\nmodes = { count = 5 }";
    let recovery = "recovery = { nodes = [22, 23, 24] }";
    Subject::of("no interface", place, &text(&(FILES.to_owned() + MESH), "", reduction, recovery))
}

/// Rows without mass: M is singular.
fn massless() -> Subject {
    let mut model = steel_brick();
    // Node 23, inside.
    model.mass.retain(|(i, j, _)| !(66..69).contains(i) && !(66..69).contains(j));
    let place = Place::with(&model);
    let interfaces = patch("foot", "[1, 11, 31, 41]", "direct");
    let reduction = "method = \"craig-bampton\"\nmodes = { count = 5 }";
    Subject::of("rows without mass", place, &text(&(FILES.to_owned() + MESH), &interfaces, reduction, ""))
}

pub(super) fn subjects() -> Vec<Subject> {
    let mut subjects = vec![
        solid("solid, Herting", "herting"),
        solid("solid, Craig-Bampton", "craig-bampton"),
        dropped(),
        square(),
        rows("rows, free", Ends::Free, "herting"),
        rows("rows, held", Ends::Fixed, "craig-bampton"),
        loaded(),
        damped(),
        expanded(),
        mixed(),
        turning(),
        held(),
        modal(),
        massless(),
    ];
    subjects.extend(brackets());
    subjects
}

/// Where the documents are.
pub(super) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}
