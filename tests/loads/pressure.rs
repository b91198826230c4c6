//! Pressure on faces of a mesh: resultants by hand, and an answer that is known.

use supel::cli::ExitCode;
use supel_models::Material;
use supel_models::transform::supported;
use supel_runtime::Superelement;
use supel_testing::place::{Ended, Place, bricks_of_27, bricks_of_eight, steel_brick, supel, xdmf};

use crate::statics::{difference, reduced_answer};
use crate::{EVERY_NODE, array};

const SIZE: [f64; 3] = [1.0, 0.31, 0.23];
/// Sums of some dozen products.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

type Cells = (&'static str, Vec<Vec<usize>>);

fn place(cells: &[Cells]) -> Place {
    let model = steel_brick();
    let place = Place::with(&model);
    place.write("mesh.xdmf", xdmf(&model.nodes, cells).as_bytes());
    place
}

fn run(place: &Place, interface: &str, fixed: &str, loads: &str) -> Ended {
    let job = format!(
        r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "mesh.xdmf" }}
interface = [{interface}]
fixed     = [{fixed}]
load      = [{loads}]
reduction = {{ method = "craig-bampton", modes = {{ count = 3 }} }}
write     = {{ superelement = "x.supel", recovery = {{ nodes = {EVERY_NODE} }} }}
"#
    );
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")])
}

const TIP: &str = r#"{ name = "tip", nodes = [5, 15, 45] }"#;
/// Nodes at the far end.
const END: &str = "{ within = { plane = { point = [1, 0, 0], normal = [1, 0, 0], tolerance = 1e-9 } } }";

/// Force and moment about the origin of a load of the file, by its work on the unit motions.
fn resultant(file: &Superelement, load: usize) -> [f64; 6] {
    let (u, f) = (&file.tensors().rigid_body_modes, file.tensors().load_vectors.as_ref().expect("loads"));
    std::array::from_fn(|motion| (0..u.rows()).map(|row| u[(row, motion)] * f[(row, load)]).sum())
}

/// The resultant of a pressure on a flat end acts at its middle, whatever the cells, and its forces are those of the textbook.
#[test]
fn a_flat_face_takes_pressure_times_area_at_its_middle() {
    let quarter = [1.0, 2.0, 1.0, 2.0, 4.0, 2.0, 1.0, 2.0, 1.0].map(|share| share / 16.0);
    let simpson = [1.0, 4.0, 1.0, 4.0, 16.0, 4.0, 1.0, 4.0, 1.0].map(|share| share / 36.0);
    for (cells, shares, n_faces) in [(bricks_of_eight(), quarter, "4 faces"), (bricks_of_27(), simpson, "1 face")] {
        let place = place(&[cells]);
        let area = SIZE[1] * SIZE[2];
        let mut by_hand = vec![0.0; steel_brick().n];
        shares.iter().enumerate().for_each(|(node, share)| by_hand[3 * (5 * node + 4)] = -2.5 * area * share);
        place.write("hand.mtx", array(&[by_hand]).as_bytes());
        let loads =
            format!("{{ name = \"push\", nodes = {END}, pressure = 2.5 }}, {{ name = \"hand\", file = \"hand.mtx\" }}");
        let ended = run(&place, TIP, "", &loads).expect(ExitCode::Done);
        assert!(ended.out.contains(&format!("push: pressure on {n_faces}, total (-0.17")), "{}", ended.out);
        let file = place.superelement("x.supel");
        let force = 2.5 * area;
        let wanted = [-force, 0.0, 0.0, 0.0, -force * SIZE[2] / 2.0, force * SIZE[1] / 2.0];
        for (found, wanted) in resultant(&file, 0).iter().zip(wanted) {
            // Ψ carries the unit motions to 1e-13 or so.
            assert!((found - wanted).abs() <= 1e-11 * force, "{found} for {wanted}");
        }
        let vectors = file.tensors().load_vectors.as_ref().expect("loads");
        let of = |load: usize| (0..vectors.rows()).map(|row| vectors[(row, load)]).collect::<Vec<f64>>();
        // Both go through Ψ: their forces differ by rounding, and the amplitudes of modes by no more than their sum.
        assert!(difference(&of(0), &of(1)) <= 1e2 * ROUNDING, "{:e}", difference(&of(0), &of(1)));
        supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
    }
}

/// A pressure p on the whole surface is a uniform stress −p: with supports that hold nothing but rigid-body motion every length shrinks by
/// p (1 − 2ν)/E, which linear bricks represent.
#[test]
fn a_block_under_pressure_on_all_sides_shrinks_as_it_should() {
    let place = place(&[bricks_of_eight()]);
    let fixed = r#"{ nodes = [1] }, { nodes = [5], dofs = ["uy", "uz"] }, { nodes = [11], dofs = ["uz"] }"#;
    let pressure = 3e7;
    let loads = format!("{{ name = \"sea\", nodes = {EVERY_NODE}, pressure = {pressure} }}");
    let ended = run(&place, r#"{ name = "tip", nodes = [45] }"#, fixed, &loads).expect(ExitCode::Done);
    assert!(ended.out.contains("sea: pressure on 40 faces, total"), "{}", ended.out);
    let found = reduced_answer(&place.superelement("x.supel"), 0, 0);
    let Material { young, poisson, .. } = Material::STEEL_SI;
    let strain = -pressure * (1.0 - 2.0 * poisson) / young;
    let expected: Vec<f64> = steel_brick().nodes.iter().flatten().map(|x| strain * x).collect();
    // As other static answers: the condition of some 1e4 times rounding of a dozen operations.
    assert!(difference(&found, &expected) <= 1e-10, "{:e}", difference(&found, &expected));
}

#[test]
fn faces_that_are_not_known_are_asked_for() {
    let says = |place: &Place, loads: &str, code: ExitCode, words: &[&str]| {
        let ended = run(place, TIP, "", loads).expect(code);
        words.iter().for_each(|word| assert!(ended.err.contains(word), "{word:?} is not in {}", ended.err));
        assert!(!place.path("x.supel").exists());
    };
    let push = |nodes: &str, pressure: &str| format!("{{ name = \"push\", nodes = {nodes}, pressure = {pressure} }}");
    let bricks = place(&[bricks_of_eight()]);
    let few = ["E-LOAD-FACES", "load `push`", "no face of the mesh has all its nodes among them"];
    says(&bricks, &push("[5, 10, 45]", "1.0"), ExitCode::InputData, &few);
    says(&place(&[]), &push(END, "1.0"), ExitCode::InputData, &few);
    let strange = place(&[bricks_of_eight(), ("3DSMesh", vec![])]);
    says(&strange, &push(END, "1.0"), ExitCode::InputData, &["E-LOAD-FACES", "3DSMesh"]);
    for wrong in ["0", "nan", "inf", "1e60"] {
        says(&bricks, &push(END, wrong), ExitCode::Usage, &["E-ARG", "load[0].pressure", "either sign"]);
    }
    let both = "{ name = \"push\", nodes = [5], pressure = 1.0, force = [0, 0, 1] }";
    says(&bricks, both, ExitCode::Usage, &["E-LOAD-KEYS", "`force` and `pressure`"]);
    // A support outside the matrices took the row of a direction.
    let model = steel_brick();
    let held = Place::with(&supported(&model, |(label, direction)| label == 45 && direction == 2));
    held.write("mesh.xdmf", xdmf(&model.nodes, &[bricks_of_eight()]).as_bytes());
    let top = "{ within = { plane = { point = [0, 0, 0.23], normal = [0, 0, 1], tolerance = 1e-9 } } }";
    let ended =
        run(&held, r#"{ name = "tip", nodes = [5, 15, 31] }"#, "", &push(top, "1.0")).expect(ExitCode::InputData);
    assert!(ended.err.contains("E-DOF-MISSING") && ended.err.contains("load \"push\""), "{}", ended.err);
    // Across that direction there is no force.
    run(&held, r#"{ name = "tip", nodes = [5, 15, 31] }"#, "", &push(END, "1.0")).expect(ExitCode::Done);
}
