//! Mode acceleration with the modes of a file.

mod files;
mod refused;
mod theory;
mod told;

use supel::cli::ExitCode;
use supel_models::Model;
use supel_runtime::Superelement;
use supel_testing::place::{Ended, Place, supel};

/// Columns as a Matrix Market array, every double to the bit.
fn array(columns: &[Vec<f64>]) -> String {
    let mut text = format!("%%MatrixMarket matrix array real general\n{} {}\n", columns[0].len(), columns.len());
    columns.iter().flatten().for_each(|value| text += &format!("{value:.17e}\n"));
    text
}

/// What of a job is not the model.
#[derive(Clone, Copy)]
struct Case {
    interface: &'static str,
    fixed: &'static str,
    reduction: &'static str,
}

/// The interface of the tip of the brick, by its nodes.
const TIP: &str = r#"{ name = "tip", nodes = [5, 15, 45] }"#;
/// All nodes of the tip as one rigid body.
const PATCH: &str =
    r#"{ name = "tip", coupling = "rigid", nodes = { within = { box = { min = [0.9, 0, 0], max = [1, 1, 1] } } } }"#;
/// The mean motion of these nodes, which stay free to deform.
const AVERAGE: &str =
    r#"{ name = "tip", coupling = "average", nodes = { within = { box = { min = [0.9, 0, 0], max = [1, 1, 1] } } } }"#;
const WALL: &str = "{ nodes = [1, 6, 11, 16, 21, 26, 31, 36, 41] }";
const OF_FILE: &str = r#"method = "mode-acceleration", modes = { file = "modes.mtx" }"#;

impl Case {
    /// Runs the job `job.toml` in a folder.
    fn run(self, place: &Place) -> Ended {
        let Self { interface, fixed, reduction } = self;
        let job = format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{interface}]
fixed     = [{fixed}]
reduction = {{ {reduction} }}
write     = {{ superelement = "x.supel", html = "x.html" }}
"#
        );
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml")])
    }

    /// The superelement of the job, verified by itself and against the model.
    #[track_caller]
    fn made(self, place: &Place) -> Superelement {
        self.run(place).expect(ExitCode::Done);
        let (file, job) = (place.text("x.supel"), place.text("job.toml"));
        supel(&["verify", &file]).expect(ExitCode::Done);
        supel(&["verify", &file, "--job", &job]).expect(ExitCode::Done);
        place.superelement("x.supel")
    }
}

/// A folder with a model and modes.
fn place_with(model: &Model, modes: &[Vec<f64>]) -> Place {
    let place = Place::with(model);
    place.write("modes.mtx", array(modes).as_bytes());
    place
}
