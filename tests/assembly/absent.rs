//! Interface nodes that lack directions: those at rest, those that nothing acts on, and those that the model does not have.

use supel::assembly::{Assembly, Component, PointMass};
use supel::cli::ExitCode;
use supel::error::Error;
use supel_models::transform::supported;
use supel_models::{Model, spectrum};
use supel_testing::place::{Place, supel};

use crate::{all_modes, assert_enclosed, beams, line, loaded, n_rigid, reduced};

const METHOD: &str = "--method herting --modes 6";
const MASS: PointMass = PointMass { mass: 3.0, inertia: [0.0; 3] };

/// A model reduced with interfaces at two of its nodes; `rest` are further keys of the second one and further tables.
fn of_job(name: &str, model: &Model, nodes: [i64; 2], rest: &str) -> Component {
    let place = Place::with(model);
    let [first, second] = nodes;
    let job = format!(
        "reduction = {{ method = \"herting\", modes = {{ count = 6 }} }}\nwrite = {{ superelement = \"x.supel\" }}\n\
        model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
        [[interface]]\nname = \"end\"\nnodes = [{second}]\n[[interface]]\nname = \"middle\"\nnodes = [{first}]\n{rest}\n"
    );
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    Component::new(name.to_owned(), place.superelement("x.supel")).expect("a component")
}

/// The line in two parts, the left one with a scene or with other keys of its middle.
fn halves(rest: &str) -> Assembly {
    let nodes = line();
    let left = of_job("left", &beams(&nodes[..7]), [7, 1], rest);
    let right = reduced("right", &beams(&nodes[6..]), &format!("--interface middle=1 --interface end=7 {METHOD}"));
    Assembly::new(vec![left, right]).expect("two names")
}

/// What is at rest in one component is so in whatever is joined to it there.
#[test]
fn what_is_joined_to_a_node_at_rest_rests_with_it() {
    let fixed = "dofs = [\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n[[fixed]]\nnodes = [7]\ndofs = [\"ux\"]";
    for rest in ["[scene]\ngrounded = [\"middle.ux\"]", fixed] {
        for turned in [false, true] {
            let mut assembly = halves(rest);
            let (a, b) = if turned { ("right.middle", "left.middle") } else { ("left.middle", "right.middle") };
            assembly.join(a, b).expect("five dofs in common");
            assert_eq!(assembly.notes, ["right.middle: ux at rest, as those of left.middle are"]);
            assert_eq!(assembly.held.len(), 1);
            assert_eq!(assembly.held[0].name, "right.middle.ux");
            let modes = all_modes(&assembly);
            assert_eq!(n_rigid(&modes), 5);
            let whole = supported(&beams(&line()), |(label, direction)| label == 7 && direction == 0);
            assert_enclosed(&modes, &spectrum(&whole));
            let model = assembly.model(&[]).expect("one model");
            assert_eq!((model.n_fixed(), model.fixed[0].name.as_str()), (1, "right.middle"));
        }
    }
    // A single direction is joined where it is named, and no other is touched.
    let mut assembly = halves("[scene]\ngrounded = [\"middle.ux\"]");
    assembly.join("left.middle.uy", "right.middle").expect("one dof");
    assert!(assembly.held.is_empty());
}

/// A mass moves in every direction in which its node does.
#[test]
fn a_mass_needs_every_direction_in_which_its_node_moves() {
    let of_dofs = "dofs = [\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]";
    let of_scene = ["unloaded = [\"middle.ux\"]", "connected = [\"end\", \"middle.uy\", \"middle.uz\"]"];
    let of_scene = of_scene.map(|scene| format!("[scene]\n{scene}"));
    for rest in of_scene.iter().map(String::as_str).chain([of_dofs]) {
        let mut assembly = halves(rest);
        let error = assembly.load("left.middle", MASS).expect_err("it moves along x");
        assert!(matches!(error, Error::PointMassDofs { .. }), "{error}");
        assert!(error.to_string().contains("left.middle cannot carry the mass"), "{error}");
        assert!(error.to_string().contains("expected ux"), "{error}");
        // Where the other node has all of them, the mass is on that one.
        assembly.load("right.middle", MASS).expect("six dofs");
        assembly.load("left.middle.uy", MASS).expect("a direction by its name");
    }
}

/// What is at rest carries no mass, and needs none.
#[test]
fn a_mass_at_rest_in_a_direction_is_that_of_the_others() {
    let nodes = line();
    let model = beams(&nodes[..7]);
    let component = of_job("left", &model, [7, 1], "[scene]\ngrounded = [\"middle.ux\"]");
    let mut assembly = Assembly::new(vec![component]).expect("a name");
    assembly.load("middle", MASS).expect("at rest along x");
    let carrying = loaded(&model, 7, [3.0, 3.0, 3.0, 0.0, 0.0, 0.0]);
    let whole = supported(&carrying, |(label, direction)| label == 7 && direction == 0);
    assert_enclosed(&all_modes(&assembly), &spectrum(&whole));
}
