//! Mechanisms that the job accepts are coordinates, and a plan counts them as a reduction does.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_testing::cases::hinged;
use supel_testing::place::{Place, supel};

#[test]
fn accepted_mechanisms_are_planned_as_they_are_found() {
    let place = Place::with(&hinged());
    // Six rigid-body motions and the hinge, where the method has coordinates of them.
    for (reduction, n_relief) in [
        ("method = \"herting\", modes = { count = 3 }", 7),
        ("method = \"rubin\", modes = { count = 3 }", 7),
        ("method = \"craig-bampton\", modes = { count = 3 }", 0),
        ("method = \"craig-bampton\", modes = { count = 3 }, inertia_relief = true", 7),
        ("method = \"herting\", modes = { up_to_hz = 0.05 }", 7),
        ("method = \"mixed-interface\", held = [\"there\"], modes = { up_to_hz = 0.05 }", 0),
    ] {
        let job = format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv", mechanisms = "accept" }}
interface = [{{ name = "here", nodes = [1, 2, 4, 7] }}, {{ name = "there", nodes = [15, 18, 21] }}]
reduction = {{ {reduction} }}
write     = {{ superelement = "x.supel" }}
"#
        );
        place.write("job.toml", job.as_bytes());
        let job = place.text("job.toml");
        let plan: Value =
            serde_json::from_str(&supel(&["plan", &job, "--json"]).expect(ExitCode::Done).out).expect("JSON");
        supel(&["reduce", &job]).expect(ExitCode::Done);
        let made = place.superelement("x.supel");
        let n_modes = made.tensors().frequencies.len();
        assert_eq!(made.n_coordinates(), 21 + n_relief + n_modes, "{reduction}");
        assert_eq!(plan["answer"]["n_coordinates"], made.n_coordinates(), "{reduction}");
        assert_eq!(plan["model"]["n_rigid"], 7, "{reduction}");
        assert_eq!(plan["modes"]["count"], n_modes, "{reduction}");
    }
}
