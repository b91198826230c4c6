//! Two parts of a model, reduced, joined and solved, against the model in one piece.

use supel::assembly::{Assembly, AssemblyModes, Component, Omitted, PointMass, Wanted};
use supel::cli::ExitCode;
use supel_models::transform::{join, supported, translated};
use supel_models::{Material, Model, brick, spectrum};
use supel_testing::place::{Place, supel};

use crate::{all_modes, assert_enclosed, beams, line, loaded, n_rigid, reduced};

/// Seven and six nodes of the line; the last of the first is the first of the second.
fn two_lines() -> [Model; 2] {
    let nodes = line();
    [beams(&nodes[..7]), beams(&nodes[6..])]
}

/// The two lines reduced by a method and joined in the middle.
fn joined(method: &str) -> Assembly {
    let [left, right] = two_lines();
    let left = reduced("left", &left, &format!("--interface end=1 --interface middle=7 {method}"));
    let right = reduced("right", &right, &format!("--interface middle=1 --interface end=7 {method}"));
    let mut assembly = Assembly::new(vec![left, right]).expect("two names");
    assembly.join("left.middle", "right.middle").expect("one place");
    assembly
}

const METHODS: [&str; 6] = [
    "--method craig-bampton --modes 6",
    "--method craig-bampton --up-to-hz 2000 --inertia-relief",
    "--method herting --modes 6",
    "--method herting --up-to-hz 1500",
    "--method rubin --modes 5",
    "--method mixed-interface --held middle --modes 6",
];

#[test]
fn free_assembly_has_six_rigid_body_modes_and_encloses_the_whole() {
    let whole = spectrum(&beams(&line()));
    for method in METHODS {
        let modes = all_modes(&joined(method));
        assert_eq!((n_rigid(&modes), modes.n_rigid), (6, 6), "{method}");
        assert_enclosed(&modes, &whole);
        let first = &modes.modes[6];
        let width = 1.0 - first.at_least_hz.expect("a bound") / first.frequency_hz;
        // A bound that says less is of no use: the first mode is a twentieth of the band in frequency, 1/400 in λ/(κ − λ).
        assert!(width < 1.0 / 400.0, "{method}: {width:e}");
    }
}

#[test]
fn supports_and_masses_are_those_of_the_whole() {
    let line = beams(&line());
    let carrying = loaded(&line, 13, [3.0, 3.0, 3.0, 0.01, 0.02, 0.03]);
    for method in METHODS {
        let mut assembly = joined(method);
        assembly.load("right.end", PointMass { mass: 3.0, inertia: [0.01, 0.02, 0.03] }).expect("six dofs");
        let modes = all_modes(&assembly);
        assert_eq!(n_rigid(&modes), 6);
        assert_enclosed(&modes, &spectrum(&carrying));
        assembly.fix("left.end").expect("a node");
        let modes = all_modes(&assembly);
        assert_eq!(n_rigid(&modes), 0);
        assert_enclosed(&modes, &spectrum(&supported(&carrying, |(label, _)| label == 1)));
    }
}

/// One direction held after the other: a motion fewer each time, and none where the last one is held.
#[test]
fn single_directions_are_held() {
    let line = beams(&line());
    let mut assembly = joined(METHODS[2]);
    let directions = ["ux", "uy", "uz", "rx", "ry", "rz"];
    for (held, direction) in directions.iter().enumerate() {
        assembly.fix(&format!("left.end.{direction}")).expect("a dof");
        let modes = all_modes(&assembly);
        assert_eq!(n_rigid(&modes), 5 - held, "{direction}");
        let whole = supported(&line, |(label, direction)| label == 1 && usize::from(direction) <= held);
        assert_enclosed(&modes, &spectrum(&whole));
    }
}

/// Two blocks whose faces have nine nodes each at the same places, in another order of labels than that of their names.
#[test]
fn faces_are_joined_node_by_node() {
    let left = brick([2, 2, 2], [2.0, 1.2, 0.7], &Material::UNIT);
    let right = translated(&brick([3, 2, 2], [2.5, 1.2, 0.7], &Material::UNIT), [2.0, 0.0, 0.0]);
    let at = |model: &Model, x: f64| -> Vec<i64> {
        let nodes = model.labels.iter().zip(&model.nodes).filter(|(_, node)| (node[0] - x).abs() < 1e-9);
        nodes.map(|(label, _)| *label).collect()
    };
    let (of_left, mut of_right) = (at(&left, 2.0), at(&right, 2.0));
    let pairs: Vec<(i64, i64)> = of_left.iter().copied().zip(of_right.iter().copied()).collect();
    let whole = join(&left, &right, &pairs);
    of_right.reverse();
    let list = |labels: &[i64]| labels.iter().map(i64::to_string).collect::<Vec<_>>().join(",");
    for method in ["--method craig-bampton --modes 8", "--method herting --modes 8"] {
        let mut assembly = Assembly::new(vec![
            reduced("left", &left, &format!("--interface face={} {method}", list(&of_left))),
            reduced("right", &right, &format!("--interface face={} {method}", list(&of_right))),
        ])
        .expect("two names");
        assembly.join("left.face", "right.face").expect("nine pairs");
        assert_eq!((assembly.joints[0].n_nodes, assembly.joints[0].n_dofs), (9, 27));
        let modes = all_modes(&assembly);
        assert_eq!(n_rigid(&modes), 6, "{method}");
        assert_enclosed(&modes, &spectrum(&whole));
    }
}

#[test]
fn a_mass_is_shared_by_the_nodes_of_its_interface() {
    let block = brick([2, 2, 2], [2.0, 1.2, 0.7], &Material::UNIT);
    let face: Vec<i64> = (0..27).filter(|i| block.nodes[*i][0] == 0.0).map(|i| block.labels[i]).collect();
    let list = face.iter().map(i64::to_string).collect::<Vec<_>>().join(",");
    let component = reduced("block", &block, &format!("--interface face={list} --method herting --modes 10"));
    let mut assembly = Assembly::new(vec![component]).expect("one name");
    assembly.load("face", PointMass { mass: 0.9, inertia: [0.0; 3] }).expect("nodes with translations");
    let carrying = face.iter().fold(block, |model, label| loaded(&model, *label, [0.1; 6]));
    assert_enclosed(&all_modes(&assembly), &spectrum(&carrying));
}

/// Rigid patches are part of the full model: with all modes kept the assembly is exact, and with few of them it encloses that.
#[test]
fn rigid_patches_are_joined_by_six_dofs() {
    let left = brick([2, 2, 2], [2.0, 1.2, 0.7], &Material::UNIT);
    let right = translated(&brick([3, 2, 2], [2.5, 1.2, 0.7], &Material::UNIT), [2.0, 0.0, 0.0]);
    let face = |model: &Model| -> String {
        let nodes = model.labels.iter().zip(&model.nodes).filter(|(_, node)| (node[0] - 2.0).abs() < 1e-9);
        nodes.map(|(label, _)| label.to_string()).collect::<Vec<_>>().join(",")
    };
    let assembled = |method: &str| {
        let mut assembly = Assembly::new(vec![
            reduced("left", &left, &format!("--rigid-interface face={} {method}", face(&left))),
            reduced("right", &right, &format!("--rigid-interface face={} {method}", face(&right))),
        ])
        .expect("two names");
        assembly.join("left.face", "right.face").expect("one place");
        all_modes(&assembly)
    };
    let exact = assembled("--method craig-bampton --up-to-hz 1e3");
    let whole: Vec<f64> = exact.modes.iter().map(|mode| (std::f64::consts::TAU * mode.frequency_hz).powi(2)).collect();
    for method in ["--method craig-bampton --modes 8", "--method herting --modes 8"] {
        let few = assembled(method);
        assert_eq!(n_rigid(&few), 6);
        assert_enclosed(&few, &whole);
    }
}

/// Three parts that meet in one node, in a chain of joins.
#[test]
fn several_components_meet_in_one_node() {
    let nodes = line();
    let arm: Vec<[f64; 3]> = (0..5).map(|i| [nodes[6][0], nodes[6][1] + 0.1 * f64::from(i), nodes[6][2]]).collect();
    let [left, right] = two_lines();
    let method = "--method herting --modes 6";
    let mut assembly = Assembly::new(vec![
        reduced("left", &left, &format!("--interface middle=7 {method}")),
        reduced("right", &right, &format!("--interface middle=1 {method}")),
        reduced("arm", &beams(&arm), &format!("--interface foot=1 {method}")),
    ])
    .expect("three names");
    assembly.join("left.middle", "right.middle").expect("one place");
    assembly.join("right.middle", "arm.foot").expect("one place");
    let whole = join(&beams(&nodes), &beams(&arm), &[(7, 1)]);
    let modes = all_modes(&assembly);
    assert_eq!(n_rigid(&modes), 6);
    assert_enclosed(&modes, &spectrum(&whole));
}

/// A joint of translations alone is a ball joint: the parts turn against each other, and no energy is invented.
#[test]
fn joint_without_rotations_is_a_mechanism() {
    let [left, right] = two_lines();
    let method = "--method craig-bampton --modes 4";
    let mut assembly = Assembly::new(vec![
        reduced("left", &left, &format!("--interface middle=7 {method}")),
        reduced("right", &right, &format!("--interface middle=1 {method}")),
    ])
    .expect("two names");
    for direction in ["ux", "uy", "uz"] {
        assembly.join(&format!("left.middle.{direction}"), &format!("right.middle.{direction}")).expect("one place");
    }
    assert_eq!(n_rigid(&all_modes(&assembly)), 9);
    let apart = Assembly::new(assembly.components.clone()).expect("two names");
    assert_eq!(n_rigid(&all_modes(&apart)), 12);
}

/// What is asked for is what comes, and no thread count changes a bit of it.
#[test]
fn wanted_modes_are_the_lowest_and_the_same_for_any_thread_count() {
    let assembly = joined(METHODS[2]);
    let all = all_modes(&assembly);
    let eight = assembly.modes(Wanted::Count(8)).expect("modes");
    assert_eq!(eight.modes, all.modes[..8]);
    let up_to = all.modes[9].frequency_hz;
    assert_eq!(assembly.modes(Wanted::UpTo(up_to)).expect("modes").modes, all.modes[..10]);
    for threads in [1, 2, 3, 8] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        assert_eq!(pool.install(|| all_modes(&joined(METHODS[2]))), all, "{threads} threads");
    }
}

/// Components that keep everything are exact, and say so.
#[test]
fn nothing_is_bounded_where_nothing_is_left_out() {
    let [left, right] = two_lines();
    let whole = |name: &str, model: &Model| {
        let labels: Vec<String> = model.labels.iter().map(i64::to_string).collect();
        reduced(name, model, &format!("--interface all={} --method guyan", labels.join(",")))
    };
    let mut assembly = Assembly::new(vec![whole("left", &left), whole("right", &right)]).expect("two names");
    assert!(assembly.components.iter().all(|component| component.omitted == Omitted::Nothing));
    assembly.join("left.all.7", "right.all.1").expect("one place");
    let modes = all_modes(&assembly);
    assert_eq!(modes.band_hz, None);
    for mode in &modes.modes {
        let width = mode.frequency_hz - mode.at_least_hz.expect("a bound");
        // Both sides of the same rounding; what the square root makes of it differs by less than twice.
        assert!(width <= 2.0 * mode.rounding_hz && !mode.is_beyond_band, "{mode:?}");
    }
    assert_enclosed(&modes, &spectrum(&beams(&line())));
}

/// Mean motions are joined as rigid patches are, and stay free to deform: with all modes kept the assembly is exact, and with few of them it
/// encloses that. It is softer than with rigid patches.
#[test]
fn averages_are_joined_by_six_dofs() {
    let left = brick([2, 2, 2], [2.0, 1.2, 0.7], &Material::UNIT);
    let right = translated(&brick([3, 2, 2], [2.5, 1.2, 0.7], &Material::UNIT), [2.0, 0.0, 0.0]);
    let assembled = |coupling: &str, reduction: &str| {
        let component = |name: &str, model: &Model| {
            let place = Place::with(model);
            let nodes = model.labels.iter().zip(&model.nodes).filter(|(_, node)| (node[0] - 2.0).abs() < 1e-9);
            let labels: Vec<i64> = nodes.map(|(label, _)| *label).collect();
            let job = format!(
                "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
                 interface = [{{ name = \"face\", coupling = \"{coupling}\", nodes = {labels:?} }}]\n\
                 reduction = {{ {reduction} }}\nwrite = {{ superelement = \"x.supel\" }}\n"
            );
            place.write("job.toml", job.as_bytes());
            supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
            Component::new(name.to_owned(), place.superelement("x.supel")).expect("a component")
        };
        let mut assembly =
            Assembly::new(vec![component("left", &left), component("right", &right)]).expect("two names");
        assembly.join("left.face", "right.face").expect("one place");
        assert_eq!((assembly.joints[0].n_nodes, assembly.joints[0].n_dofs), (1, 6));
        all_modes(&assembly)
    };
    let all = r#"method = "craig-bampton", modes = { up_to_hz = 1e3 }"#;
    let exact = assembled("average", all);
    let square = |modes: &AssemblyModes| -> Vec<f64> {
        modes.modes.iter().map(|mode| (std::f64::consts::TAU * mode.frequency_hz).powi(2)).collect()
    };
    let (whole, rigid) = (square(&exact), square(&assembled("rigid", all)));
    assert!(whole[6..12].iter().zip(&rigid[6..12]).all(|(average, rigid)| average < rigid), "{whole:?}\n{rigid:?}");
    for reduction in [
        r#"method = "craig-bampton", modes = { count = 8 }"#,
        r#"method = "herting", modes = { count = 8 }"#,
        r#"method = "mixed-interface", held = ["face"], modes = { count = 8 }"#,
    ] {
        let few = assembled("average", reduction);
        assert_eq!(n_rigid(&few), 6, "{reduction}");
        assert_enclosed(&few, &whole);
    }
}
