//! What report, page, `inspect` and `verify` say of a preloaded state, and what assemblies make of it.

use supel::cli::ExitCode;
use supel_models::Model;
use supel_models::transform::{in_local_frames, rounded};
use supel_runtime::{Flag, MassProperties, Superelement};
use supel_testing::pencil::{eigen, matrices, part};
use supel_testing::place::{supel, supel_as_typed};

use crate::network::{Network, Nodes, cloud, tied_frame, tower};
use crate::{ENDS, PRELOADED, made, place_of, reduced};

const STRAIN: f64 = 2e-3;
const HERTING: &str = r#"method = "herting", modes = { count = 8 }"#;
const STATE: &str = "the stiffness is the tangent of a preloaded state";

#[test]
fn the_state_is_told_wherever_results_are() {
    let made = made(&tower(Nodes::Bodies, STRAIN), ENDS, HERTING);
    assert!(made.report.to_string().contains(STATE));
    let page = String::from_utf8(made.place.bytes("x.html")).expect("UTF-8");
    assert!(page.contains(STATE));
    let file = made.place.text("x.supel");
    let shown = supel(&["inspect", &file]).expect(ExitCode::Done).out;
    let words: Vec<&str> = shown.split_whitespace().collect();
    let shown = words.join(" ");
    assert!(shown.contains("preloaded: translations alone are free"), "{shown}");
    assert!(shown.contains("stays near the preloaded state"), "{shown}");
    let metadata = made.file.metadata();
    assert_eq!(metadata.inputs["internal_forces"], blake3::hash(&made.place.bytes("q.mtx")).to_hex().as_str());
    // Made again in another folder: the bytes of the file do not depend on its folder.
    let again = crate::made(&tower(Nodes::Bodies, STRAIN), ENDS, HERTING);
    assert_eq!(again.place.bytes("x.supel"), made.place.bytes("x.supel"));
}

/// A file that lost its flag would be taken for one that may turn.
#[test]
fn a_file_without_its_flag_is_noticed() {
    let made = made(&tower(Nodes::Bodies, STRAIN), ENDS, HERTING);
    let mut metadata = made.file.metadata().clone();
    assert!(metadata.flags.remove(&Flag::Preloaded));
    let altered = Superelement::new(made.file.tensors().clone(), metadata).expect("a superelement");
    altered.write(&made.place.path("altered.supel")).expect("written");
    let (file, job) = (made.place.text("altered.supel"), made.place.text("job.toml"));
    for args in [vec!["verify", &file], vec!["verify", "--job", &job, &file]] {
        let ended = supel(&args);
        assert_eq!(ended.code, ExitCode::CheckFailed, "{}{}", ended.out, ended.err);
        assert!(ended.out.contains("flags"), "{}", ended.out);
    }
}

/// Forces of another file are another model.
#[test]
fn other_forces_are_another_input() {
    let made = made(&tower(Nodes::Points, STRAIN), ENDS, HERTING);
    let reduced_as_typed = || supel_as_typed(supel::PIPELINE, &["reduce", &made.place.text("job.toml")]);
    let unchanged = reduced_as_typed();
    assert!(unchanged.out.contains("x.supel is up to date"), "{}{}", unchanged.out, unchanged.err);
    let forces = String::from_utf8(made.place.bytes("q.mtx")).expect("UTF-8");
    made.place.write("q.mtx", format!("{forces}\n").as_bytes());
    let ended = supel(&["verify", "--job", &made.place.text("job.toml"), &made.place.text("x.supel")]);
    // Another file may hold the same forces, so that this is a warning as it is for every input.
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    assert!(ended.out.contains("worst at internal_forces"), "{}", ended.out);
    let changed = reduced_as_typed();
    assert!(changed.err.contains("the input \"internal forces\" has changed"), "{}", changed.err);
}

/// What the preload costs a rotation is no spring to the ground.
#[test]
fn preload_is_not_taken_for_a_support() {
    for strain in [1e-5, 4e-4, 1e-3] {
        let network = tower(Nodes::Points, strain);
        let ended = reduced(&place_of(&network, &network.forces, (PRELOADED, ENDS), HERTING));
        assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
        assert!(!ended.out.contains("W-GROUNDED") && !ended.err.contains("W-GROUNDED"), "{strain}: {}", ended.out);
    }
}

/// Mass and centre are compared by the mass of the model, for the free motions do not have them.
#[test]
fn an_expected_mass_is_compared() {
    let network = tower(Nodes::Bodies, STRAIN);
    let centre = centre(&network);
    for (mass, code) in [(24.0, ExitCode::Done), (25.0, ExitCode::CheckFailed)] {
        let says = format!("{PRELOADED}, expect = {{ mass = {mass:?}, cg = {centre:?} }}");
        let place = place_of(&network, &network.forces, (&says, ENDS), HERTING);
        let ended = reduced(&place);
        assert_eq!(ended.code, code, "{}{}", ended.out, ended.err);
        assert!(!ended.err.contains("W-EXPECT-UNCHECKED"), "{}", ended.err);
        if code == ExitCode::Done {
            let job = String::from_utf8(place.bytes("job.toml")).expect("UTF-8");
            place.write("heavier.toml", job.replace("mass = 24.0", "mass = 25.0").as_bytes());
            let ended = supel(&["verify", "--job", &place.text("heavier.toml"), &place.text("x.supel")]);
            assert!(ended.out.contains("expected 25"), "{}{}", ended.out, ended.err);
        }
    }
}

/// The mean of the nodes, whose masses are alike.
fn centre(network: &Network) -> [f64; 3] {
    [0, 1, 2].map(|i| network.model.nodes.iter().map(|node| node[i] / 12.0).sum::<f64>())
}

/// Mass, centre and inertia are those of all rows, and the loads of gravity what the model has.
#[test]
fn mass_properties_and_loads_of_gravity() {
    for nodes in [Nodes::Points, Nodes::Bodies] {
        let network = tower(nodes, STRAIN);
        let made = made(&network, ENDS, HERTING);
        let found = made.file.metadata().model.mass_properties.expect("of one body");
        let about = centre(&network);
        // Twelve masses of two, and the rotary inertia of nodes with rotations.
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let of_node = |at: &[f64; 3]| {
                let d = [0, 1, 2].map(|axis| at[axis] - about[axis]);
                2.0 * (if i == j { d.iter().map(|x| x * x).sum() } else { 0.0 } - d[i] * d[j])
            };
            let own = if i == j && nodes == Nodes::Bodies { 12.0 * (0.08 + 0.01 * i as f64) } else { 0.0 };
            let expected = own + network.model.nodes.iter().map(of_node).sum::<f64>();
            assert!((found.inertia[i][j] - expected).abs() < 1e-12 * 100.0, "{:?} {expected}", found.inertia);
        }
        assert!((found.mass - 24.0).abs() < 1e-12, "{}", found.mass);
        assert!((0..3).all(|i| (found.center_of_mass[i] - about[i]).abs() < 1e-13), "{:?}", found.center_of_mass);
        assert_eq!(made.report["body"]["model"]["mass_properties"]["mass"].as_f64(), Some(found.mass));
        // A unit translation of the interface carries the whole mass.
        let gravity = made.file.tensors().gravity.clone().expect("loads of gravity");
        let n = network.n_directions;
        for (axis, direction) in (0..3).flat_map(|axis| (0..3).map(move |direction| (axis, direction))) {
            let work: f64 = (0..4).map(|node| gravity[(n * node + direction, axis)]).sum();
            let expected = if axis == direction { 24.0 } else { 0.0 };
            assert!((work - expected).abs() < 1e-10, "{axis} {direction}: {work}");
        }
        // With all nodes among the coordinates they are the masses themselves.
        let all = crate::made(
            &network,
            r#"{ name = "all", nodes = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12] }"#,
            r#"method = "guyan""#,
        );
        let gravity = all.file.tensors().gravity.clone().expect("loads of gravity");
        for (row, axis) in (0..gravity.rows()).flat_map(|row| (0..3).map(move |axis| (row, axis))) {
            assert_eq!(gravity[(row, axis)], if row % n == axis { 2.0 } else { 0.0 }, "{row} {axis}");
        }
    }
}

/// A change to what a preloaded file says of its mass is noticed: of mass and gravity by the file itself, of the rest by the model.
#[test]
fn a_changed_mass_is_noticed() {
    let made = made(&tower(Nodes::Bodies, STRAIN), ENDS, HERTING);
    let (sound, job) = (made.place.text("x.supel"), made.place.text("job.toml"));
    let properties = || made.file.metadata().model.mass_properties.expect("mass properties");
    let altered = |change: &dyn Fn(&mut supel_runtime::Tensors, &mut supel_runtime::Metadata)| {
        let (mut tensors, mut metadata) = (made.file.tensors().clone(), made.file.metadata().clone());
        change(&mut tensors, &mut metadata);
        let path = made.place.path("altered.supel");
        Superelement::new(tensors, metadata).expect("a superelement").write(&path).expect("written");
        [vec!["verify", "altered.supel"], vec!["verify", "--job", "job.toml", "altered.supel"]].map(|args| {
            let args: Vec<String> =
                args.into_iter().map(|arg| if arg.contains('.') { made.place.text(arg) } else { arg.into() }).collect();
            supel(&args.iter().map(String::as_str).collect::<Vec<_>>())
        })
    };
    supel(&["verify", "--job", &job, &sound]).expect(ExitCode::Done);
    let heavier =
        altered(&|_, metadata| metadata.model.mass_properties = Some(MassProperties { mass: 24.1, ..properties() }));
    assert!(heavier.iter().all(|ended| ended.code == ExitCode::CheckFailed && ended.out.contains("M-16")));
    let centre = MassProperties { center_of_mass: [0.5, 0.4, 0.8], ..properties() };
    let [alone, with_job] = altered(&|_, metadata| metadata.model.mass_properties = Some(centre));
    assert_eq!(alone.code, ExitCode::Done, "{}", alone.out);
    assert!(alone.out.contains("model.mass_properties"), "it says that nothing vouches for it: {}", alone.out);
    assert!(with_job.code == ExitCode::CheckFailed && with_job.out.contains("M-16"), "{}", with_job.out);
    let without = altered(&|_, metadata| metadata.model.mass_properties = None);
    assert_eq!(without[1].code, ExitCode::CheckFailed, "{}", without[1].out);
    let lighter = altered(&|tensors, _| {
        let gravity = tensors.gravity.clone().expect("loads");
        tensors.gravity =
            Some(supel_runtime::Matrix::from_fn(gravity.rows(), 3, |i, j| gravity[(i, j)] * (1.0 - 1e-5)));
    });
    assert!(lighter.iter().all(|ended| ended.code == ExitCode::CheckFailed && ended.out.contains("M-18")));
    let without = altered(&|tensors, _| tensors.gravity = None);
    assert!(without.iter().all(|ended| ended.code == ExitCode::CheckFailed && ended.out.contains("gravity")));
}

/// Linear assemblies take a preloaded component, free and held.
#[test]
fn modes_of_an_assembly() {
    let network = tower(Nodes::Bodies, STRAIN);
    let [k, m] = matrices(&network.model);
    let made = made(&network, ENDS, r#"method = "herting", modes = { count = 20 }"#);
    let file = made.place.text("x.supel");
    let frequencies = |args: &[&str]| -> Vec<f64> {
        let mut all = vec!["modes", file.as_str(), "--count", "8", "--json"];
        all.extend(args);
        let ended = supel(&all).expect(ExitCode::Done);
        let modes: serde_json::Value = serde_json::from_str(&ended.out).expect("JSON");
        let modes = modes["modes"].as_array().expect("modes");
        modes.iter().map(|mode| mode["frequency_hz"].as_f64().expect("a frequency")).collect()
    };
    let hertz = |lambda: f64| lambda.max(0.0).sqrt() / std::f64::consts::TAU;
    let free = eigen(k.as_ref(), m.as_ref(), 1e3).0;
    for (found, lambda) in frequencies(&[]).iter().zip(&free).skip(3) {
        assert!((found / hertz(*lambda) - 1.0).abs() < 1e-9, "{found} {}", hertz(*lambda));
    }
    assert!(frequencies(&[])[..3].iter().all(|hz| *hz == 0.0));
    // All four nodes of the interface at rest: modes of the free component bound those of the held one from above.
    let moving: Vec<usize> = (12..60).collect();
    let held = eigen(part(k.as_ref(), &moving).as_ref(), part(m.as_ref(), &moving).as_ref(), 1e3).0;
    for (found, lambda) in frequencies(&["--fix", "x.ends"]).iter().zip(&held).take(4) {
        assert!((1.0 - 1e-9..1.1).contains(&(found / hertz(*lambda))), "{found} {}", hertz(*lambda));
    }
}

/// A second reduction would need internal forces of its own: matrices are written, and no job that is refused.
#[test]
fn exported_matrices_have_no_job() {
    let made = made(&tower(Nodes::Points, STRAIN), ENDS, HERTING);
    let folder = made.place.text("again");
    std::fs::create_dir(&folder).expect("made");
    let flags = ["export", &made.place.text("x.supel"), "--to", "matrix-market", "--output", &folder];
    let ended = supel(&flags).expect(ExitCode::Done);
    assert!(
        !format!("{}{}", ended.out, ended.err).contains("held dofs"),
        "nothing is held: {}{}",
        ended.out,
        ended.err
    );
    let names: Vec<String> = std::fs::read_dir(&folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    assert!(names.iter().any(|name| name.ends_with("stiffness.mtx")), "{names:?}");
    assert!(!names.iter().any(|name| name.ends_with("job.toml")), "{names:?}");
}

/// Axes of nodes put rounding of stiff directions where soft rows are. A tension may be so small that this hides the force that it makes in a
/// turn, and not its energy: translations have no share of that turn.
#[test]
fn translations_have_no_turns() {
    const AXES: [[f64; 3]; 3] =
        [[2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0], [3.0 / 7.0, -6.0 / 7.0, 2.0 / 7.0], [6.0 / 7.0, 2.0 / 7.0, -3.0 / 7.0]];
    let is_turned = |node: i64| node % 2 == 1;
    let [x, y, _] = AXES.map(|axis| axis.map(|value| format!("{value:?}")).join(","));
    let table = (1..=9).filter(|node| is_turned(*node)).map(|node| format!("{node},{x},{y}\n"));
    let table = format!("node,x1,x2,x3,y1,y2,y3\n{}", table.collect::<String>());
    for (digits, tension) in [(9, 3e-2), (10, 3e-3), (10, 1e-2), (11, 3e-4)] {
        let network = tied_frame(tension);
        let local = in_local_frames(&network.model, &AXES, is_turned);
        let model = Model { mass: local.mass.clone(), ..rounded(&local, digits) };
        let mut forces = network.forces.clone();
        for (at, three) in forces.chunks_exact_mut(3).enumerate() {
            if is_turned(model.dofs[3 * at].0) {
                let global = [three[0], three[1], three[2]];
                (0..3).for_each(|i| three[i] = (0..3).map(|j| AXES[i][j] * global[j]).sum());
            }
        }
        let network = Network { model, ..network };
        let model_keys = format!(r#"{PRELOADED}, frames = "frames.csv""#);
        let place = place_of(&network, &forces, (&model_keys, r#"{ name = "a", nodes = [1, 7] }"#), HERTING);
        place.write("frames.csv", table.as_bytes());
        reduced(&place).expect(ExitCode::Done);
        let file = place.superelement("x.supel");
        let u = &file.tensors().rigid_body_modes;
        // Rotations of the two nodes come behind their displacements.
        let of_rotations = [3, 4, 5, 9, 10, 11].into_iter().flat_map(|row| (0..u.cols()).map(move |j| u[(row, j)]));
        assert!(of_rotations.into_iter().all(|turn| turn == 0.0), "{digits} digits, tension {tension}");
        let path = place.text("x.supel");
        supel(&["verify", &path]).expect(ExitCode::Done);
        supel(&["verify", &path, "--job", &place.text("job.toml")]).expect(ExitCode::Done);
    }
}

/// Few digits hide what rotations cost, and no spring to the ground makes it.
#[test]
fn rotations_within_few_digits_are_not_grounded() {
    let mut n_made = 0;
    for strain in [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2] {
        for digits in [4, 5, 6] {
            let network = tower(Nodes::Points, strain);
            let printed = Network { model: rounded(&network.model, digits), ..network };
            let ended = reduced(&place_of(&printed, &printed.forces, (PRELOADED, ENDS), HERTING));
            n_made += usize::from(ended.out.contains("M-05"));
            assert!(!ended.out.contains("W-GROUNDED"), "{strain:e}, {digits} digits: {}", ended.out);
        }
    }
    assert!(n_made >= 6, "{n_made}");
}

/// So they do of one rotation, where others cost more and are told.
#[test]
fn a_rotation_that_digits_hide_among_others_is_not_grounded() {
    let mut n_made = 0;
    for seed in 0..8 {
        for (strain, digits) in [(5e-2, 4), (1e-2, 5), (1e-3, 6), (3e-3, 6), (2e-4, 7), (1e-3, 7)] {
            let network = cloud(6 + seed as usize, seed, strain);
            let printed = Network { model: rounded(&network.model, digits), ..network };
            let ends = r#"{ name = "ends", nodes = [1, 2, 3] }"#;
            let few = r#"method = "herting", modes = { count = 4 }"#;
            let ended = reduced(&place_of(&printed, &printed.forces, (PRELOADED, ends), few));
            n_made += usize::from(ended.out.contains("M-05"));
            assert!(!ended.out.contains("W-GROUNDED"), "{seed}, {strain:e}, {digits} digits: {}", ended.out);
        }
    }
    assert!(n_made >= 12, "{n_made}");
}
