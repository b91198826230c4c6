//! Loads of gravity on a held component, and the displacements of its held nodes.

use supel::cli::ExitCode;
use supel_models::model::{dot, multiply};
use supel_testing::place::{Place, steel_brick, supel};

use crate::{Case, METHODS, elbow};

/// A face of the brick is clamped, and one node on a slide.
fn case() -> Case {
    let fixed = r#"{ nodes = [1, 6, 11, 16, 21, 26, 31, 36, 41] }, { nodes = [25], dofs = ["uy"] }"#;
    Case {
        name: "cantilever",
        model: steel_brick(),
        interface: r#"{ name = "tip", nodes = [5, 15, 45] }"#,
        fixed,
        has_nodes: true,
    }
}

fn is_held((node, direction): (i64, u8)) -> bool {
    node % 5 == 1 || (node == 25 && direction == 1)
}

/// The rows of W: zero where the job holds a dof, and at no other.
#[test]
fn held_nodes_are_recovered_at_rest() {
    let case = case();
    let made = case.made("herting", 6);
    let recovery = made.file.tensors().recovery.as_ref().expect("rows");
    assert_eq!(recovery.dofs().len(), case.model.n, "every row of the model, held ones included");
    for (row, (dof, (node, direction))) in recovery.dofs().iter().zip(&case.model.dofs).enumerate() {
        assert_eq!((dof.node, dof.direction as u8), (*node, *direction));
        let is_zero = recovery.rows().row(row).expect("a row").iter().all(|value| *value == 0.0);
        assert_eq!(is_zero, is_held((*node, *direction)), "node {node}, direction {direction}");
    }
}

/// ĝ = WᵀMe over all rows of the files, e the unit translations of all nodes: the mass that couples held dofs with others takes part.
#[test]
fn gravity_loads_what_moves_and_not_its_supports() {
    let case = case();
    let made = case.made("herting", 6);
    let gravity = made.file.tensors().gravity.as_ref().expect("loads of gravity");
    let w = made.file.tensors().recovery.as_ref().expect("rows").rows();
    let absolute: Vec<_> = case.model.mass.iter().map(|(i, j, value)| (*i, *j, value.abs())).collect();
    let mut largest_coupling = 0.0f64;
    for axis in 0..3 {
        let unit = &case.model.rigid_body_modes()[axis];
        let (loads, terms) = (multiply(&case.model.mass, unit), multiply(&absolute, unit));
        let moving: Vec<f64> =
            unit.iter().zip(&case.model.dofs).map(|(e, dof)| if is_held(*dof) { 0.0 } else { *e }).collect();
        let without = multiply(&case.model.mass, &moving);
        for column in 0..w.cols() {
            let shape: Vec<f64> = (0..w.rows()).map(|row| w[(row, column)]).collect();
            let sizes: Vec<f64> = shape.iter().map(|value| value.abs()).collect();
            // Two sums of n products of sums of at most n, here and in supel.
            let bound = 4.0 * case.model.n as f64 * f64::EPSILON * dot(&sizes, &terms);
            let error = (gravity[(column, axis)] - dot(&shape, &loads)).abs();
            assert!(error <= bound, "coordinate {column} along {axis}: {error:e} above {bound:e}");
            largest_coupling = largest_coupling.max((dot(&shape, &loads) - dot(&shape, &without)).abs() / bound);
        }
    }
    assert!(largest_coupling > 1e6, "held dofs have a part that would be missed: {largest_coupling:e}");
}

/// Mass, centre and inertia are those of the whole component, and so is what the job expects of them.
#[test]
fn the_mass_is_that_of_the_whole_component() {
    let case = case();
    let made = case.made("craig-bampton", 4);
    let model = &made.report["body"]["model"];
    let mass = model["mass_properties"]["mass"].as_f64().expect("a mass");
    let expected = case.model.total_mass(0);
    // A sum of n² terms of one sign in either.
    assert!(
        (mass / expected - 1.0).abs() <= (case.model.n * case.model.n) as f64 * f64::EPSILON,
        "{mass} and {expected}"
    );
    let notes = model["notes"].as_array().expect("notes");
    assert!(notes.iter().any(|note| note.as_str().is_some_and(|note| note.contains("whole component"))), "{notes:?}");
    assert_eq!(made.file.metadata().model.mass_properties, None, "the file has what moves");
}

/// Without recovered rows nothing but gravity tells the sign of a mode that the interface hardly sees.
#[test]
fn the_full_model_has_the_same_loads_of_gravity() {
    let case = Case {
        name: "elbow",
        model: elbow(),
        interface: r#"{ name = "tip", nodes = [5, 6] }"#,
        fixed: r#"{ nodes = [2], dofs = ["uy", "rz"] }"#,
        has_nodes: true,
    };
    for method in METHODS {
        for n_modes in [3, 6, 9] {
            let place = Place::with(&case.model);
            let job = case.job(method, n_modes, &format!("fixed = [{}]", case.fixed));
            let (job, _) = job.split_once(", recovery").expect("recovery comes last");
            place.write("job.toml", format!("{job} }}\n").as_bytes());
            supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
            let ended = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
            assert_eq!(ended.code, ExitCode::Done, "{method}, {n_modes} modes: {}", ended.out);
        }
    }
}
