//! Models in a plane, and of other directions than all six: what is known of their mass.

use supel::cli::ExitCode;
use supel_models::model::Entry;
use supel_models::transform::{supported, translated};
use supel_models::{Inertia, Material, Model, Section, Wall, brick, frame, shell};

use crate::mass::{direction_by_direction, lumped_of, with_mass};
use crate::place::supel;
use crate::table::said;
use crate::told::{by_job, expected};

/// A frame in the plane of x and y, with one leg shorter.
fn portal() -> Model {
    let nodes: Vec<[f64; 3]> = (0..4)
        .map(|k| [0.0, 0.25 * f64::from(k), 0.0])
        .chain((1..5).map(|k| [0.3 * f64::from(k), 0.75, 0.0]))
        .chain((1..3).map(|k| [1.2, 0.75 - 0.25 * f64::from(k), 0.0]))
        .collect();
    let edges: Vec<[usize; 2]> = (1..nodes.len()).map(|k| [k - 1, k]).collect();
    frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, Inertia::Consistent)
}

/// The rows of some directions of a model in space, and what it has in space.
struct Planar {
    what: &'static str,
    model: Model,
    mass: f64,
    centre: [f64; 3],
}

impl Planar {
    fn of(what: &'static str, whole: &Model, directions: &[u8]) -> Self {
        let whole = translated(whole, [0.4, -0.3, 0.2]);
        let motions = whole.rigid_body_modes();
        let product = |i: usize, j: usize| product_of(&whole.mass, [&motions[i], &motions[j]]);
        let mass = product(0, 0);
        let centre = [product(1, 5), product(2, 3), product(0, 4)].map(|moment| moment / mass);
        Self { what, model: supported(&whole, |(_, direction)| !directions.contains(&direction)), mass, centre }
    }
}

fn product_of(entries: &[Entry], [x, y]: [&[f64]; 2]) -> f64 {
    entries.iter().map(|(i, j, value)| x[*i as usize] * value * y[*j as usize]).sum()
}

/// A grid of flat elements, uneven along x, whose membrane needs no rotations.
fn flat(at: impl Fn([f64; 2]) -> [f64; 3]) -> Model {
    with_drilling(0.0, at)
}

fn with_drilling(drilling: f64, at: impl Fn([f64; 2]) -> [f64; 3]) -> Model {
    let wall = Wall { material: Material::STEEL_SI, thickness: 0.02, drilling };
    shell([5, 3], |[x, y]| at([1.2 * x * (1.0 + 0.3 * x), 0.5 * y]), &wall)
}

fn planar_models() -> Vec<Planar> {
    vec![
        Planar::of("a membrane", &flat(|[x, y]| [x, y, 0.0]), &[0, 1]),
        Planar::of("a membrane upright", &flat(|[x, y]| [x, 0.0, y]), &[0, 2]),
        Planar::of("a membrane across", &flat(|[x, y]| [0.0, x, y]), &[1, 2]),
        Planar::of("layers of one membrane", &brick([5, 3, 1], [1.0, 0.45, 0.2], &Material::STEEL_SI), &[0, 1]),
        Planar::of("a frame", &portal(), &[0, 1, 5]),
        Planar::of("a plate", &flat(|[x, y]| [x, y, 0.0]), &[2, 3, 4]),
    ]
}

/// Which entries of the rigid-body mass have the centre depends on the directions that there are, and with translations along one axis alone
/// the coordinate along it is in none.
#[test]
fn mass_and_centre_of_a_model_in_a_plane() {
    for Planar { what, model, mass, centre } in planar_models() {
        let interface = "nodes = [1, 2, 6]";
        let expecting =
            |centre: [f64; 3]| by_job(&model, &format!("expect = {{ mass = {mass}, cg = {centre:?} }}"), interface);
        let (place, ended) = expecting(centre);
        assert_eq!(ended.code, ExitCode::Done, "{what}: {}{}", ended.out, ended.err);
        assert_eq!(expected(&place).expect("a check").0, "pass", "{what}");
        let verified = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
        assert_eq!(verified.code, ExitCode::Done, "{what}: {}{}", verified.out, verified.err);
        assert!(verified.out.contains("mass and centre are those expected"), "{what}: {}", verified.out);
        for axis in 0..3 {
            let mut wrong = centre;
            wrong[axis] += 0.05;
            let (place, ended) = expecting(wrong);
            assert_eq!(ended.code, ExitCode::CheckFailed, "{what}, {wrong:?}: {}{}", ended.out, ended.err);
            assert_eq!(expected(&place).expect("a check").0, "fail", "{what}, {wrong:?}");
        }
    }
}

/// Supports take mass out of one direction, and a part in a plane has none across it: the other directions tell the centre.
#[test]
fn the_centre_is_told_by_directions_that_lack_no_mass() {
    let plate = with_drilling(1e-3, |[x, y]| [x, y, 0.0]);
    let lacks = |what: &'static str, whole: &Model, is_taken: &dyn Fn((i64, u8)) -> bool| {
        let all = Planar::of(what, whole, &[0, 1, 2, 3, 4, 5]);
        Planar { model: supported(&all.model, is_taken), ..all }
    };
    for Planar { what, model, mass, centre } in [
        lacks("a frame on a roller", &portal(), &|(node, direction)| {
            [2, 3, 4].contains(&direction) || (node, direction) == (1, 1)
        }),
        lacks("a plate on a roller", &plate, &|(node, direction)| (node, direction) == (1, 0)),
        lacks("a plate, half of it a membrane", &plate, &|(node, direction)| {
            node > 12 && [2, 3, 4].contains(&direction)
        }),
    ] {
        let expecting = |centre: [f64; 3]| {
            by_job(&model, &format!("expect = {{ mass = {mass}, cg = {centre:?} }}"), "nodes = [3, 4]")
        };
        let (place, ended) = expecting(centre);
        assert!(ended.err.is_empty(), "{what}: {}", ended.err);
        assert_eq!(expected(&place).expect("a check").0, "pass", "{what}: {}", ended.out);
        for axis in 0..3 {
            let mut wrong = centre;
            wrong[axis] += 0.05;
            let (place, _) = expecting(wrong);
            assert_eq!(expected(&place).expect("a check").0, "fail", "{what}, {wrong:?}");
        }
    }
}

/// Each of two translations has the same mass, at every node and all together.
#[test]
fn a_mass_in_a_plane_that_depends_on_the_direction() {
    for sound in planar_models().into_iter().take(3) {
        let sound = Planar { model: lumped_of(&sound.model), ..sound };
        let what = sound.what;
        let said_of = |model: &Model| {
            let (place, ended) = by_job(model, "", "nodes = [1, 2, 8]");
            (said(&place, &ended), place)
        };
        assert_eq!(said_of(&sound.model).0, "verified", "{what}");
        let mut heavier = sound.model.mass.clone();
        heavier[20].2 *= 1.5;
        // Of the even nodes of this mesh and of the odd ones the mass is the same.
        for (fault, model, expected, of_the_whole) in [
            ("one direction of a node", with_mass(&sound.model, heavier), "W-MASS-DIRECTION, M-16", "fail"),
            ("direction by direction", direction_by_direction(&sound.model), "W-MASS-DIRECTION", "pass"),
        ] {
            let (said, place) = said_of(&model);
            assert_eq!(said, expected, "{what}, {fault}");
            let report = place.report("x.report.json");
            let mut checks = report["body"]["checks"].as_array().expect("checks").iter();
            let of_a_body = checks.find(|check| check["name"] == "mass is that of a body").expect("M-16");
            assert_eq!(of_a_body["verdict"], of_the_whole, "{what}, {fault}");
        }
    }
}

/// A mass on an interface has the radius of gyration of the component about the axes that the model turns about.
#[test]
fn a_mass_on_a_frame_in_a_plane_has_its_radius_of_gyration() {
    let Planar { model, mass, centre: [x, y, _], .. } = Planar::of("a frame", &portal(), &[0, 1, 5]);
    let turn = &model.rigid_body_modes()[5];
    let about_origin = product_of(&model.mass, [turn, turn]);
    let moment = 2.0 * (about_origin / mass - x * x - y * y);
    let (place, ended) = by_job(&model, "", "nodes = [1]\n[scene]\nboundaries = [\"free\", \"mass:foot=2\"]");
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    let report = place.report("x.report.json").to_string();
    let (_, said) = report.split_once("foot carries a mass of 2 with moments of inertia of ").expect("a boundary");
    let said: f64 = said.split_once(';').expect("its end").0.parse().expect("a number");
    // It is shown with three digits.
    assert!((said / moment - 1.0).abs() < 5e-3, "{said}, {moment}");
}
