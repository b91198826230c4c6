//! Coordinates that K does not know: I-16 to I-20.
//!
//! The figures are Rayleigh quotients of the rotations by the coordinates over the first elastic eigenvalue.

use supel_models::transform::turned;
use supel_models::{Inertia, Material, Model, Section, brick, frame};

use super::{assert_done, assert_refused};
use crate::place::{Place, steel_brick};
use supel::cli::ExitCode;

/// A block of 4 × 2 × 2 bricks, its foot, and a plate of 1 : 100 whose edge is held.
fn models() -> [(&'static str, Model, &'static str); 2] {
    let plate = brick([6, 5, 1], [1.0, 0.9, 0.01], &Material::STEEL_SI);
    [
        ("block", steel_brick(), "--interface foot=1,11,31,41 --method herting --modes 5 --threads 1"),
        ("plate", plate, "--interface foot=1,7,36,42 --method herting --modes 5 --threads 1"),
    ]
}

fn with_nodes(model: &Model, at: impl Fn(usize, [f64; 3]) -> [f64; 3]) -> Place {
    let nodes = model.nodes.iter().enumerate().map(|(index, position)| at(index, *position)).collect();
    Place::with(&Model { nodes, ..model.clone() })
}

#[track_caller]
fn coordinates_refused(place: &Place, rest: &str, parts: &[&str]) {
    let ended = place.reduce(&place.model_flags(), rest);
    assert_refused(place, &ended, "E-COORD", &[parts, &["check units, axes and local node frames"]].concat());
}

/// Millimetres for metres: rotational dofs know the difference; translations alone do not, but expected properties do.
#[test]
fn i_16_units_of_length() {
    let nodes: Vec<[f64; 3]> = (0..6).map(|i| [0.2 * f64::from(i), 0.1 * f64::from(i % 2), 0.0]).collect();
    let edges: Vec<[usize; 2]> = (0..5).map(|i| [i, i + 1]).collect();
    let beam = frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, Inertia::Consistent);
    let rest = "--interface end=1 --method herting --modes 3 --threads 1";
    let right = Place::with(&beam);
    assert_done(&right, &right.reduce(&right.model_flags(), rest), &[]);
    coordinates_refused(&with_nodes(&beam, |_, x| x.map(|x| 1000.0 * x)), rest, &["rotation about"]);

    let block = with_nodes(&steel_brick(), |_, x| x.map(|x| 1000.0 * x));
    let job = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv", expect = { cg = [0.5, 0.155, 0.115] } }
interface = [{ name = "foot", nodes = [1, 11, 31, 41] }]
reduction = { method = "herting", modes = { count = 5 } }
write     = { superelement = "x.supel" }
"#;
    block.write("job.toml", job.as_bytes());
    let ended = crate::place::supel(&["reduce", &block.text("job.toml")]);
    assert_eq!(ended.code, supel::cli::ExitCode::CheckFailed, "{}{}", ended.out, ended.err);
    let checks = block.report("x.report.json")["body"]["checks"].as_array().expect("checks").clone();
    let failed: Vec<_> = checks.iter().filter(|check| check["verdict"] == "fail").map(|check| &check["id"]).collect();
    assert_eq!(failed, ["M-16"]);
}

/// Squares of coordinates that are no numbers, or nothing: the file says so, not an eigensolver.
#[test]
fn i_16_sizes_beyond_double_precision() {
    let (_, model, rest) = models().into_iter().next().expect("a block");
    for factor in [1e200, 1e60, 1e-60, 1e-200] {
        let place = with_nodes(&model, |_, x| x.map(|x| factor * x));
        let ended = place.reduce(&place.model_flags(), rest);
        assert_refused(
            &place,
            &ended,
            "E-NODE-RANGE",
            &["nodes.csv: coordinate x of node", "between 2^-160 and 2^160"],
        );
    }
    let place = with_nodes(&model, |node, x| if node == 17 { [x[0], 1e200, x[2]] } else { x });
    let ended = place.reduce(&place.model_flags(), rest);
    assert_refused(&place, &ended, "E-NODE-RANGE", &["coordinate y of node 18 is 1e200"]);
}

#[test]
fn i_17_axes_exchanged() {
    for (name, model, rest) in models() {
        eprintln!("{name}");
        coordinates_refused(&with_nodes(&model, |_, [x, y, z]| [y, x, z]), rest, &["rotation about"]);
    }
}

/// A hundredth of the length, at one node: it is named, with two of its neighbours.
#[test]
fn i_18_one_node_out_of_place() {
    for (name, model, rest) in models() {
        eprintln!("{name}");
        let moved = |index, [x, y, z]: [f64; 3]| if index == 17 { [x, y + 0.01, z] } else { [x, y, z] };
        coordinates_refused(&with_nodes(&model, moved), rest, &["node 18 u"]);
        // Among coordinates of five digits it still stands out.
        let rounded = |index, position: [f64; 3]| moved(index, position.map(|x| rounded(x, 5)));
        coordinates_refused(&with_nodes(&model, rounded), rest, &["node 18 u"]);
    }
}

/// Frequency and error bar of every mode.
fn modes(place: &Place) -> Vec<(f64, f64)> {
    let report = place.report("x.report.json");
    let modes = report["body"]["reduction"]["modes"].as_array().expect("modes").clone();
    let number = |mode: &serde_json::Value, key: &str| mode[key].as_f64().expect("a number");
    modes.iter().map(|mode| (number(mode, "frequency_hz"), number(mode, "error_bar_hz"))).collect()
}

/// A number of so many significant digits.
fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits - 1).parse().expect("a number")
}

/// Rounded coordinates cost a warning, not the result: the modes are those of the matrices. Lengths in sevenths, so that
/// every coordinate but zero is rounded.
#[test]
fn i_19_rounded_coordinates() {
    for (name, _, rest) in models() {
        let model = match name {
            "block" => brick([4, 2, 2], [8.0 / 7.0, 3.0 / 7.0, 2.0 / 7.0], &Material::STEEL_SI),
            _ => brick([6, 5, 1], [6.0 / 7.0, 5.0 / 7.0, 0.01 / 7.0], &Material::STEEL_SI),
        };
        let exact = Place::with(&model);
        assert_done(&exact, &exact.reduce(&exact.model_flags(), rest), &[]);
        for digits in [7, 5] {
            let place = with_nodes(&model, |_, x| x.map(|x| rounded(x, digits)));
            let ended = place.reduce(&place.model_flags(), rest);
            assert_done(&place, &ended, &["W-COORD-ROUNDED"]);
            let words = ended.out.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(words.contains("rigid-body modes were taken from the matrices"), "{words}");
            let superelement = place.superelement("x.supel");
            assert_eq!(superelement.tensors().rigid_body_modes.cols(), 6, "{name}, {digits} digits");
            // What is verified stays verified.
            let (file, job) = (place.text("x.supel"), place.text("kept.json"));
            place.write("kept.json", crate::place::supel(&["inspect", &file, "--job"]).out.as_bytes());
            crate::place::supel(&["verify", &file]).expect(ExitCode::Done);
            crate::place::supel(&["verify", &file, "--job", &job]).expect(ExitCode::Done);
            // Frequencies as with exact coordinates, within the bars of both.
            for (mode, reference) in modes(&place).into_iter().zip(modes(&exact)) {
                assert!(
                    (mode.0 - reference.0).abs() <= mode.1 + reference.1,
                    "{name}, {digits} digits: {mode:?} {reference:?}"
                );
            }
            // Unit motions still mean what they say: the mass is that of the volume.
            let volume = model.nodes.last().expect("a node").iter().product::<f64>();
            let mass = superelement.tensors().rigid_body_mass[(0, 0)];
            assert!((mass / (7850.0 * volume) - 1.0).abs() < 1e-9, "{name}: {mass}");
        }
    }
}

/// Every dof in one frame that is not that of the coordinates: translations are combinations of translations, rotations are
/// none of rotations.
#[test]
fn i_20_a_frame_that_was_not_declared() {
    let block = steel_brick();
    let place = with_nodes(&block, |_, [x, y, z]| [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z]);
    coordinates_refused(&place, "--interface foot=1,11,31,41 --method herting --modes 5 --threads 1", &[]);
}

/// Frames at some nodes only: no translation of the coordinates is free, and still motions without energy are. Coordinates
/// cannot tell them from supports with a mechanism; they are never accepted without a warning or an error.
#[test]
fn i_20_frames_at_some_nodes() {
    let block = turned(&steel_brick(), |node| node % 5 == 4);
    for method in ["herting", "craig-bampton"] {
        let place = Place::with(&block);
        let rest = format!("--interface foot=1,11,31,41 --method {method} --modes 5 --threads 1");
        let ended = place.reduce(&place.model_flags(), &rest);
        let is_named = ended.err.starts_with("supel: error[E-COORD]") || ended.out.contains("W-MECHANISM");
        let is_refused = ended.code == supel::cli::ExitCode::CheckFailed && !place.path("x.supel").exists();
        assert!(is_named || is_refused, "{method}: {:?} {}{}", ended.code, ended.out, ended.err);
    }
}
