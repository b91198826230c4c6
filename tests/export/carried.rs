//! What a first reduction left out or was told, and the reduction of its superelement has to know.

use supel::cli::ExitCode;
use supel_models::transform::rounded;
use supel_models::{Inertia, Material, Model, Section, Wall, brick, frame, shell};
use supel_testing::cases::hinged;
use supel_testing::place::{Place, assert_close, frequencies_hz, supel};

use super::export;

/// A block with one end at rest, which interface and output see in its plane of symmetry alone: torsion is left out.
const BLOCK: &str = "fixed = [{ name = \"wall\", nodes = [1, 6, 11, 16, 21, 26, 31, 36, 41] }]\n\
     interface = [{ name = \"tip\", nodes = [10, 25, 40], dofs = [\"ux\", \"uz\"] }]\n\
     reduction = { method = \"craig-bampton\", modes = { count = 10 } }\n\
     scene = { outputs = { nodes = [23] }, boundaries = [\"free\"], band_hz = [0, 2000] }\n";

/// Reduces the files of a place to x.supel by a job with these keys of the model and these tables.
fn reduced(place: &Place, (keys, tables): (&str, &str)) {
    let text = format!(
        "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\"{keys} }}\n{tables}\
         write = {{ superelement = \"x.supel\" }}\n"
    );
    place.write("job.toml", text.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
}

fn again(place: &Place, [from, to]: [&str; 2]) {
    supel(&["reduce", &place.text(from), "--output", &place.text(to)]).expect(ExitCode::Done);
}

fn job_text(place: &Place, name: &str) -> String {
    String::from_utf8(place.bytes(name)).expect("text")
}

/// What `supel modes` says of modes that nothing starts or sees, without the name of the component.
fn note(place: &Place, name: &str) -> String {
    let told = supel(&["modes", &place.text(name), "--json"]).expect(ExitCode::Done).out;
    let told: serde_json::Value = serde_json::from_str(&told).expect("JSON");
    let notes = told["notes"].as_array().expect("notes").iter().filter_map(|note| note.as_str());
    let own =
        notes.filter_map(|note| note.split_once(" leaves out ")).find(|(_, rest)| rest.contains("nothing starts"));
    own.map(|(_, rest)| rest.to_owned()).unwrap_or_default()
}

/// A mode that nothing sees is one of the component whatever is made of its superelement: no later file forgets it.
#[test]
fn modes_left_out_as_unseen_are_told_by_every_further_reduction() {
    let place = Place::with_brick();
    reduced(&place, ("", BLOCK));
    let n = place.superelement("x.supel").metadata().unseen_modes().count();
    let of_first = note(&place, "x.supel");
    assert!(n > 0 && of_first.starts_with(&format!("{n} mode")), "{of_first}");
    again(&place, ["x.supel", "y.supel"]);
    again(&place, ["y.supel", "z.supel"]);
    for name in ["y.supel", "z.supel"] {
        assert_eq!(place.superelement(name).metadata().dropped, [], "{name}");
        assert_eq!(note(&place, name), of_first, "{name}");
        let inspected = supel(&["inspect", &place.text(name)]).expect(ExitCode::Done).out;
        assert!(inspected.contains("model lacks"), "{inspected}");
    }
    supel(&["verify", &place.text("y.supel"), "--job", &place.text("x.supel")]).expect(ExitCode::Done);
    // The job that is exported says it, and one that does not is refused.
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    let text = job_text(&place, "x.job.toml");
    let (before, rest) = text.split_once(", unseen_hz = [").expect("frequencies");
    let (frequencies, after) = rest.split_once(']').expect("a list");
    assert_eq!(frequencies.split(',').count(), n, "{text}");
    let files = ["x.stiffness.mtx", "x.mass.mtx", "x.dofs.csv", "x.nodes.csv"];
    let silent = files.iter().fold(format!("{before}{after}"), |text, file| text.replace(file, "x.supel"));
    place.write("silent.toml", silent.as_bytes());
    let ended = supel(&["reduce", &place.text("silent.toml")]);
    assert!(ended.err.contains("E-ASSUMED") && ended.err.contains("unseen_hz"), "{}", ended.err);
    // So does that of an assembly, of each of its components.
    place.write("b.supel", &place.bytes("x.supel"));
    let [x, b, whole] = ["x.supel", "b.supel", "whole"].map(|name| place.text(name));
    let flags = ["--join", "x.tip=b.tip", "--keep", "x.tip", "--to", "matrix-market", "--output", &whole];
    let exported = supel(&[&["export", &x, &b][..], &flags].concat()).expect(ExitCode::Done).out;
    assert_eq!(exported.matches("that nothing starts or sees").count(), 2, "{exported}");
    let text = job_text(&place, "whole.job.toml");
    let (_, rest) = text.split_once("unseen_hz = [").expect("frequencies");
    assert_eq!(rest.split(']').next().expect("a list").split(',').count(), 2 * n, "{text}");
}

/// Of few digits a hinge is meant where the job says so, and the second job says it too.
#[test]
fn mechanisms_that_are_meant_are_meant_again() {
    let place = Place::with(&rounded(&hinged(), 7));
    let tables = "interface = [{ name = \"here\", nodes = [1, 2, 4, 7] }, { name = \"there\", nodes = [15, 18, 21] }]\n\
         reduction = { method = \"herting\", modes = { count = 3 } }\n";
    reduced(&place, (", mechanisms = \"accept\"", tables));
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    assert!(job_text(&place, "x.job.toml").contains("mechanisms = \"accept\""));
    supel(&["reduce", &place.text("x.job.toml")]).expect(ExitCode::Done);
    again(&place, ["x.supel", "y.supel"]);
    let [first, second] = ["x.supel", "y.supel"].map(|name| place.superelement(name));
    assert_eq!([first.n_rigid(), second.n_rigid()], [7, 7]);
    assert_eq!(first.metadata().validity.assumptions, second.metadata().validity.assumptions);
}

/// So is a hinge that nobody had announced: digits of a superelement are measured, and a hinge in few of them would be refused.
#[test]
fn a_hinge_that_was_found_is_meant_again() {
    let place = Place::with(&hinged());
    let tables = "interface = [{ name = \"here\", nodes = [1, 2, 4, 7] }, { name = \"there\", nodes = [15, 18, 21] }]\n\
         reduction = { method = \"herting\", modes = { count = 3 } }\n";
    reduced(&place, ("", tables));
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    assert!(job_text(&place, "x.job.toml").contains("mechanisms = \"accept\""));
    supel(&["reduce", &place.text("x.job.toml")]).expect(ExitCode::Done);
    supel(&["reduce", &place.text("x.supel"), "--output", &place.text("direct.supel")]).expect(ExitCode::Done);
    let of = |name: &str| place.superelement(name).n_rigid();
    assert_eq!(["x.supel", "x.again.supel", "direct.supel"].map(of), [7, 7, 7]);
}

/// Two frames of eight nodes, the end of one on the start of the other, which is its ninth to sixteenth node; nothing ties them.
fn two_frames() -> Model {
    let at = |i: usize, turn: f64| {
        let of_axis = |size: f64, step: f64, turns: f64| size * (1.0 + (step * i as f64 + turns * turn).sin());
        [of_axis(0.5, 12.9, 1.0), of_axis(0.4, 7.3, 2.0), of_axis(0.3, 5.1, 3.0)]
    };
    let (end, start) = (at(8, 1.0), at(1, 2.0));
    let moved = |i: usize| {
        let x = at(i, 2.0);
        [0, 1, 2].map(|k| x[k] - start[k] + end[k])
    };
    let nodes: Vec<[f64; 3]> = (1..=8).map(|i| at(i, 1.0)).chain((1..=8).map(moved)).collect();
    let along = |first: usize| (first..first + 7).map(|i| [i, i + 1]);
    let edges: Vec<[usize; 2]> = along(0).chain(along(8)).chain([[0, 3], [2, 6], [8, 12], [11, 15]]).collect();
    frame(&nodes, &edges, &Section::round(0.005), &Material::STEEL_SI, Inertia::Consistent)
}

/// A part that two directions of a joint hold has rows in K̂ that are soft next to those of a stiff pair of nodes, with the rounding of its
/// own stiffness: taken for as exact as these, they would be negative.
#[test]
fn rows_of_a_part_hardly_held_are_known_to_digits_of_their_own() {
    let place = Place::with(&two_frames());
    place.write(
        "G.mtx",
        b"%%MatrixMarket matrix coordinate real general\n2 96 4\n1 43 1.0\n1 49 -1.0\n2 44 1.0\n2 50 -1.0\n",
    );
    let tables = "interface = [{ name = \"here\", nodes = [2] }, { name = \"there\", nodes = [10] }, { name = \"next\", nodes = [11] }]\n\
         reduction = { method = \"craig-bampton\", modes = { count = 6 } }\n";
    reduced(&place, (", constraints = \"G.mtx\", mechanisms = \"accept\"", tables));
    again(&place, ["x.supel", "y.supel"]);
    let [first, second] = ["x.supel", "y.supel"].map(|name| place.superelement(name));
    // Six motions of the whole, one of sliding and three of turning.
    assert_eq!([first.n_rigid(), second.n_rigid()], [10, 10]);
}

/// Motions without energy are all that this interface can do: nothing of its stiffness is left, and the matrices tell how far the next motion
/// is.
#[test]
fn a_mechanism_that_fills_its_interface_is_counted_by_the_matrices() {
    let place = Place::with(&hinged());
    let one = |name: &str, node: i64, dofs: &str| format!("{{ name = \"{name}\", nodes = [{node}], dofs = [{dofs}] }}");
    let all = "\"ux\", \"uy\", \"uz\"";
    let interfaces = [one("a", 1, all), one("b", 3, "\"uy\", \"uz\""), one("c", 4, "\"uz\""), one("d", 21, "\"uy\"")];
    let tables = format!(
        "interface = [{}]\nreduction = {{ method = \"herting\", modes = {{ count = 3 }} }}\n",
        interfaces.join(", ")
    );
    for digits in [17, 12] {
        reduced(&place, (&format!(", mechanisms = \"accept\", stiffness_digits = {digits}"), &tables));
        let found = place.superelement("x.supel");
        assert_eq!((found.n_interface(), found.n_rigid()), (7, 7), "{digits} digits");
    }
    // Held along an edge it has two such motions, no more than a body may have, and of five digits nothing tells.
    let held = format!(
        "interface = [{}, {}]\nfixed = [{{ nodes = [1, 4] }}]\nreduction = {{ method = \"herting\", modes = {{ count = 3 }} }}\n",
        one("c", 3, "\"uz\""),
        one("d", 15, "\"uy\"")
    );
    let keys = |digits: u32| format!(", mechanisms = \"accept\", stiffness_digits = {digits}");
    reduced(&place, (&keys(9), &held));
    assert_eq!(place.superelement("x.supel").n_rigid(), 2);
    let few = job_text(&place, "job.toml").replace("stiffness_digits = 9", "stiffness_digits = 5");
    place.write("few.toml", few.as_bytes());
    let ended = supel(&["reduce", &place.text("few.toml")]);
    assert!(ended.err.contains("E-DATA-PRECISION"), "{}{}", ended.out, ended.err);
    // Of three digits nothing tells of the free one.
    reduced(&place, (&keys(12), &tables));
    let text = job_text(&place, "job.toml").replace("stiffness_digits = 12", "stiffness_digits = 3");
    place.write("job.toml", text.as_bytes());
    let ended = supel(&["reduce", &place.text("job.toml")]);
    assert!(ended.err.contains("E-DATA-PRECISION"), "{}{}", ended.out, ended.err);
}

/// What rigid-body motion moves alone has no stiffness but rounding, in an assembly as in the component by itself.
#[test]
fn an_assembly_states_the_digits_of_its_components() {
    let wall = Wall { material: Material::STEEL_SI, thickness: 6e-4, drilling: 1e-3 };
    let place = Place::with(&shell([4, 3], |[x, y]| [0.2 * x, 0.05 * y, 0.0], &wall));
    let tables = "interface = [{ name = \"l\", nodes = [1, 6, 11, 16], coupling = \"rigid\", dofs = [\"ux\", \"uy\", \"uz\"] },\n\
         { name = \"r\", nodes = [5, 10, 15, 20], coupling = \"rigid\", dofs = [\"ux\", \"uy\", \"uz\"] }]\n\
         reduction = { method = \"rubin\", modes = { count = 6 } }\n";
    reduced(&place, ("", tables));
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    export(&place, "matrix-market", &["--mass", "x.l=0.1", "--output", &place.text("whole")]).expect(ExitCode::Done);
    let digits = |name: &str| {
        let text = job_text(&place, name);
        let stated = text.lines().find_map(|line| line.strip_prefix("stiffness_digits = ")?.parse::<u32>().ok());
        stated.unwrap_or(17)
    };
    assert_eq!(digits("whole.job.toml"), digits("x.job.toml"));
    supel(&["reduce", &place.text("whole.job.toml")]).expect(ExitCode::Done);
}

/// A frame in space, of nine nodes.
fn bent() -> Model {
    let at = |i: usize| {
        let t = i as f64 / 8.0;
        [0.8 * t, 0.3 * (3.0 * t).sin(), 0.2 * t * t]
    };
    let nodes: Vec<[f64; 3]> = (0..9).map(at).collect();
    let edges: Vec<[usize; 2]> = (1..9).map(|i| [i - 1, i]).chain([[0, 4], [3, 7]]).collect();
    frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent)
}

/// The superelement, reduced once more, moves as rigidly and has its frequencies; the second one agrees with the job of the first.
#[track_caller]
fn assert_same_again(place: &Place, n_rigid: usize, what: &str) {
    again(place, ["x.supel", "y.supel"]);
    supel(&["verify", &place.text("y.supel"), "--job", &place.text("x.supel")]).expect(ExitCode::Done);
    let [first, second] = ["x.supel", "y.supel"].map(|name| place.superelement(name));
    assert_eq!([first.n_rigid(), second.n_rigid()], [n_rigid; 2], "{what}");
    assert_close(&frequencies_hz(&second), &frequencies_hz(&first), 1e-8);
}

/// Rotations that supports hold alone are no mistake of the coordinates of the second model, wherever the first job holds them.
#[test]
fn rotations_that_are_held_alone_are_known_again() {
    let interface = "interface = [{ name = \"i\", nodes = [1] }, { name = \"j\", nodes = [9] }]\n";
    for method in ["herting", "craig-bampton"] {
        let method = format!("reduction = {{ method = \"{method}\", modes = {{ count = 3 }} }}\n");
        for (held, n_rigid) in [
            ("scene = { grounded = [\"i.rz\"] }\n", 5),
            ("scene = { grounded = [\"i.rx\", \"i.ry\", \"i.rz\"] }\n", 3),
            ("fixed = [{ nodes = [5], dofs = [\"rz\"] }]\n", 5),
            ("fixed = [{ nodes = [5], dofs = [\"uz\", \"rz\"] }]\n", 4),
        ] {
            let place = Place::with(&bent());
            reduced(&place, ("", &format!("{interface}{method}{held}")));
            assert_same_again(&place, n_rigid, held);
            export(&place, "matrix-market", &[]).expect(ExitCode::Done);
            let says = job_text(&place, "x.job.toml").contains("held_rotations");
            assert_eq!(says, !held.contains("uz"), "{held}");
        }
    }
}

/// Nodes in line along x, of which supports hold one along x and in bending: no translation makes a force at it, and of two nodes it lacks the
/// rotation that would answer. So it is where both nodes lack it, of each of which the scene says something else.
#[test]
fn rotations_that_are_held_with_a_translation_are_known_again() {
    let nodes: Vec<[f64; 3]> = (0..5).map(|i| [0.2 * f64::from(i), 0.0, 0.0]).collect();
    let edges: Vec<[usize; 2]> = (1..5).map(|i| [i - 1, i]).collect();
    let line = frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent);
    let interface = "interface = [{ name = \"i\", nodes = [1] }, { name = \"j\", nodes = [5] }]\n";
    for method in ["herting", "craig-bampton"] {
        let method = format!("reduction = {{ method = \"{method}\", modes = {{ count = 3 }} }}\n");
        for (scene, n_rigid) in [
            ("grounded = [\"i.ux\", \"i.ry\"]", 4),
            ("grounded = [\"i.ux\", \"i.rz\"]", 4),
            ("grounded = [\"i.ux\", \"i.ry\", \"j.rx\"], unloaded = [\"i.uy\", \"i.rz\", \"j.ry\"]", 3),
        ] {
            let place = Place::with(&line);
            reduced(&place, ("", &format!("{interface}{method}scene = {{ {scene} }}\n")));
            assert_same_again(&place, n_rigid, scene);
        }
    }
}

/// A block whose face is one node: the scene holds a rotation of it, or all but one. The mass that is left is not that of a whole body, and is not
/// compared with one. A node beside the face that feels what is held is not along axes of its own.
#[test]
fn the_mass_of_a_face_that_a_scene_holds_is_not_judged() {
    let block = brick([4, 2, 2], [0.3, 0.05, 0.04], &Material::STEEL_SI);
    let end = &block.groups["XMIN"];
    let line: Vec<i64> =
        block.groups["XMAX"].iter().copied().filter(|label| block.nodes[*label as usize - 1][1] == 0.0).collect();
    let face = format!("{{ name = \"i\", nodes = {end:?}, coupling = \"rigid\" }}");
    let both = format!("{face}, {{ name = \"j\", nodes = {line:?} }}");
    for (interface, grounded, n_rigid) in [
        (&face, "\"i.rz\"", 5),
        (&face, "\"i.ry\"", 5),
        (&face, "\"i.ux\", \"i.uy\", \"i.uz\", \"i.rx\", \"i.ry\"", 1),
        (&both, "\"i.uy\"", 5),
    ] {
        let place = Place::with(&block);
        let reduction = "reduction = { method = \"craig-bampton\", modes = { count = 4 } }";
        reduced(
            &place,
            ("", &format!("interface = [{interface}]\n{reduction}\nscene = {{ grounded = [{grounded}] }}\n")),
        );
        assert_same_again(&place, n_rigid, grounded);
    }
}
