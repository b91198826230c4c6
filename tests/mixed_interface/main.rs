//! Modes with mixed boundaries: some of the interfaces held while they are computed, the others free.

mod refused;
mod theory;
mod told;

use supel::cli::ExitCode;
use supel_runtime::Superelement;
use supel_testing::place::{Ended, Place, supel};

/// Two interfaces of the brick, three nodes each.
const ENDS: &str = r#"{ name = "base", nodes = [1, 11, 41] }, { name = "tip", nodes = [5, 15, 45] }"#;

/// What of a job is not the model.
#[derive(Clone, Copy)]
struct Case {
    interfaces: &'static str,
    reduction: &'static str,
    /// Further tables, as they stand in the job.
    rest: &'static str,
}

impl Case {
    fn of(reduction: &'static str) -> Self {
        Self { interfaces: ENDS, reduction, rest: "" }
    }

    /// Runs the job `job.toml` in a folder.
    fn run(self, place: &Place) -> Ended {
        let Self { interfaces, reduction, rest } = self;
        let job = format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{interfaces}]
reduction = {{ {reduction} }}
write     = {{ superelement = "x.supel", html = "x.html" }}
{rest}
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
        supel(&["verify", "--strict", &file]).expect(ExitCode::Done);
        supel(&["verify", &file, "--job", &job]).expect(ExitCode::Done);
        place.superelement("x.supel")
    }
}
