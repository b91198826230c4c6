//! Masses at nodes, against matrices made by hand.

use supel::cli::ExitCode;
use supel_models::transform::supported;
use supel_models::{Inertia, Material, Section, frame};
use supel_testing::place::steel_brick;

use super::{CRAIG_BAMPTON, Case, FOOT_AND_HUB, HERTING};

/// A rigid body of four point masses, and its mass, centre and inertia about that.
const POINTS: [(f64, [f64; 3]); 4] =
    [(0.5, [0.3, 0.1, -0.2]), (1.5, [0.1, -0.3, 0.2]), (0.25, [-0.2, 0.4, 0.1]), (0.75, [0.2, 0.2, 0.5])];

/// The mass matrix of the points on a node by their kinetic energy, 2T = Σ m |u̇ + θ̇ × p|².
fn of_points() -> [[f64; 6]; 6] {
    let motion =
        |[x, y, z]: [f64; 3]| [[1.0, 0.0, 0.0, 0.0, z, -y], [0.0, 1.0, 0.0, -z, 0.0, x], [0.0, 0.0, 1.0, y, -x, 0.0]];
    let of_pair = |i: usize, j: usize| {
        POINTS.iter().map(|(m, p)| motion(*p).iter().map(|row| m * row[i] * row[j]).sum::<f64>()).sum()
    };
    std::array::from_fn(|i| std::array::from_fn(|j| of_pair(i, j)))
}

/// What the job says of the points.
fn added() -> String {
    let mass: f64 = POINTS.iter().map(|(m, _)| m).sum();
    let centre: [f64; 3] = std::array::from_fn(|i| POINTS.iter().map(|(m, p)| m * p[i]).sum::<f64>() / mass);
    let product =
        |i: usize, j: usize| POINTS.iter().map(|(m, p)| m * (p[i] - centre[i]) * (p[j] - centre[j])).sum::<f64>();
    let trace = product(0, 0) + product(1, 1) + product(2, 2);
    let inertia = [
        trace - product(0, 0),
        trace - product(1, 1),
        trace - product(2, 2),
        -product(0, 1),
        -product(1, 2),
        -product(2, 0),
    ];
    format!("mass = {mass:e}, inertia = {inertia:?}, offset = {centre:?}")
}

#[test]
fn masses_at_nodes_are_those_of_matrices_made_by_hand() {
    let nodes: Vec<[f64; 3]> = (0..7).map(|k| [0.1 * f64::from(k), 0.02 * f64::from(k * k), 0.0]).collect();
    let edges: Vec<[usize; 2]> = (0..6).map(|k| [k, k + 1]).collect();
    let model = frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, Inertia::Consistent);
    let mut by_hand = model.clone();
    for (i, row) in of_points().iter().enumerate() {
        for (j, value) in row.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            let at = (18 + i as u32, 18 + j as u32);
            match by_hand.mass.iter_mut().find(|(i, j, _)| (*i, *j) == at) {
                Some(entry) => entry.2 += value,
                None => by_hand.mass.push((at.0, at.1, *value)),
            }
        }
    }
    by_hand.mass.sort_by_key(|(i, j, _)| (*i, *j));
    let total = by_hand.total_mass(0);
    let interfaces = "{ name = \"a\", nodes = [1] }, { name = \"b\", nodes = [7] }";
    let hand = Case::new(by_hand).reduced(interfaces, HERTING, "");
    let case = Case::new(model);
    let more = format!("added_mass = [{{ node = 4, {} }}]", added());
    let file = case.reduced(interfaces, HERTING, &more);
    let close = |a: f64, b: f64, size: f64| (a - b).abs() <= 1e-10 * size;
    for (omega, expected) in file.tensors().frequencies.iter().zip(&hand.tensors().frequencies) {
        assert!(close(*omega, *expected, *expected), "{omega} for {expected}");
    }
    let (mass, expected) = (&file.tensors().rigid_body_mass, &hand.tensors().rigid_body_mass);
    assert!((0..6).all(|i| (0..6).all(|j| close(
        mass[(i, j)],
        expected[(i, j)],
        (expected[(i, i)] * expected[(j, j)]).sqrt()
    ))));
    assert!(close(file.metadata().model.mass_properties.expect("a body").mass, total, total));
    let report = String::from_utf8(case.place.bytes("x.report.json")).expect("UTF-8");
    assert!(report.contains("mass added at node 4"));
    case.verify(&[]).expect(ExitCode::Done);
    case.verify_with_job().expect(ExitCode::Done);
    // Two masses at one node add up, and another job is told from this one.
    let job = String::from_utf8(case.place.bytes("job.toml")).expect("UTF-8");
    case.place.write("job.toml", job.replace("node = 4", "node = 5").as_bytes());
    case.verify_with_job().expect(ExitCode::CheckFailed);
}

/// Of a body on a model that moves in a plane only motion in it counts.
#[test]
fn a_mass_on_a_model_in_a_plane() {
    let nodes: Vec<[f64; 3]> = (0..7).map(|k| [0.1 * f64::from(k), 0.02 * f64::from(k * k), 0.0]).collect();
    let edges: Vec<[usize; 2]> = (0..6).map(|k| [k, k + 1]).collect();
    let space = frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, Inertia::Consistent);
    for directions in [[0, 1, 5], [2, 3, 4]] {
        let model = supported(&space, |(_, direction)| !directions.contains(&direction));
        let mut by_hand = model.clone();
        for (i, axis) in directions.into_iter().enumerate() {
            for (j, other) in directions.into_iter().enumerate() {
                let at = (9 + i as u32, 9 + j as u32);
                let value = of_points()[usize::from(axis)][usize::from(other)];
                match by_hand.mass.iter_mut().find(|(i, j, _)| (*i, *j) == at) {
                    Some(entry) => entry.2 += value,
                    None => by_hand.mass.push((at.0, at.1, value)),
                }
            }
        }
        by_hand.mass.sort_by_key(|(i, j, _)| (*i, *j));
        let interfaces = "{ name = \"a\", nodes = [1] }, { name = \"b\", nodes = [7] }";
        let hand = Case::new(by_hand).reduced(interfaces, HERTING, "");
        let case = Case::new(model);
        let file = case.reduced(interfaces, HERTING, &format!("added_mass = [{{ node = 4, {} }}]", added()));
        for (omega, expected) in file.tensors().frequencies.iter().zip(&hand.tensors().frequencies) {
            assert!((omega / expected - 1.0).abs() <= 1e-10, "{directions:?}: {omega} for {expected}");
        }
        case.verify_with_job().expect(ExitCode::Done);
    }
}

/// `expect` counts added masses.
#[test]
fn expected_mass_counts_them() {
    let case = Case::new(steel_brick());
    let total = case.model.total_mass(0);
    let added = "added_mass = [{ node = 23, mass = 40 }, { node = 23, mass = 2 }]";
    case.run(FOOT_AND_HUB, CRAIG_BAMPTON, added).expect(ExitCode::Done);
    let job = String::from_utf8(case.place.bytes("job.toml")).expect("UTF-8");
    let expecting = |mass: f64| {
        let text = job.replace("nodes.csv\" }", &format!("nodes.csv\", expect = {{ mass = {mass:e} }} }}"));
        case.place.write("job.toml", text.as_bytes());
        supel_testing::place::supel(&["reduce", &case.place.text("job.toml"), "--quiet"]).code
    };
    assert_eq!(expecting(total + 42.0), ExitCode::Done);
    assert_eq!(expecting(total), ExitCode::CheckFailed);
}

#[test]
fn masses_that_cannot_be_added() {
    let case = Case::new(steel_brick());
    for (mass, said) in [
        ("node = 99, mass = 1", "no translation of that node"),
        ("node = 23, mass = 1, offset = [0, 0, 0.1]", "no ry"),
        ("node = 23, mass = 1, inertia = [1, 1, 1, 0, 0, 0]", "no rx"),
        ("node = 23, mass = 1, inertia = [1, 1, 1, 2, 0, 0]", "a principal inertia of -"),
    ] {
        let ended =
            case.run(FOOT_AND_HUB, CRAIG_BAMPTON, &format!("added_mass = [{{ {mass} }}]")).expect(ExitCode::InputData);
        assert!(ended.err.contains("E-ADDED-MASS") && ended.err.contains(said), "{}", ended.err);
    }
    let ended =
        case.run(FOOT_AND_HUB, CRAIG_BAMPTON, "added_mass = [{ node = 23, mass = -1 }]").expect(ExitCode::Usage);
    assert!(ended.err.contains("added_mass[0].mass"), "{}", ended.err);
}

/// Two million times the part in the middle of it, as for motion that is prescribed by a large mass: its inertia about its own centre is
/// what is left of numbers 10⁸ times larger.
#[test]
fn a_heavy_mass_keeps_its_verdict() {
    let nodes: Vec<[f64; 3]> = (0..6).map(|k| [0.2 * f64::from(k), 0.05 * f64::from(k % 3), 0.0]).collect();
    let edges: Vec<[usize; 2]> = (1..6).map(|k| [k - 1, k]).collect();
    let model = frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent);
    let case = Case::new(model);
    let ends = r#"{ name = "a", nodes = [1] }, { name = "b", nodes = [6] }"#;
    for mass in [2e6, 1e7, 1e8] {
        let file = case.reduced(ends, HERTING, &format!("added_mass = [{{ node = 3, mass = {mass:e} }}]"));
        let stated = file.metadata().model.mass_properties.expect("a body");
        assert!((stated.mass / mass - 1.0).abs() < 1e-5);
        case.verify(&[]).expect(ExitCode::Done);
    }
}

/// The polar inertia of a disc alone is no inertia of a body, and is taken all the same.
#[test]
fn inertia_that_no_body_has_is_said() {
    let nodes = [[0.0; 3], [0.1, 0.0, 0.0], [0.2, 0.0, 0.0]];
    let model = frame(&nodes, &[[0, 1], [1, 2]], &Section::round(0.02), &Material::STEEL_SI, Inertia::Consistent);
    let case = Case::new(model);
    let notes = |added: &str| {
        let ends = r#"{ name = "a", nodes = [1] }, { name = "b", nodes = [3] }"#;
        case.run(ends, HERTING, &format!("added_mass = [{{ node = 2, {added} }}]")).expect(ExitCode::Done);
        String::from_utf8(case.place.bytes("x.report.json")).expect("UTF-8")
    };
    let disc = notes("mass = 0, inertia = [2e-3, 0, 0, 0, 0, 0]");
    assert!(disc.contains("inertia without mass added at node 2"), "{disc}");
    assert!(disc.contains("which no rigid body has"), "{disc}");
    let ring = notes("mass = 1, inertia = [2e-3, 1e-3, 1e-3, 0, 0, 0]");
    assert!(ring.contains("principal inertias 0.001, 0.001, 0.002") && !ring.contains("no rigid body"), "{ring}");
}
