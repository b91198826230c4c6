//! Models that leave few witnesses: thin, slender, flat, or of a single node.

use supel::error::Error;
use supel::model::{CoordinateFit, Model as Checked};
use supel::partition::TiedNodes;
use supel_models::transform::supported;
use supel_models::{Inertia, Material, Model, Section, SplitMix64, brick, frame};

use crate::Ties;
use crate::chain::input;
use crate::frames::with_digits;

fn fit(model: &Model, ties: Ties) -> Result<CoordinateFit, Error> {
    Ok(crate::compared(Checked::new(input(model))?, ties)?.fit)
}

#[track_caller]
fn assert_refused(model: &Model, what: &str) {
    for ties in [Ties::All, Ties::None] {
        let found = fit(model, ties);
        assert!(matches!(found, Err(Error::CoordinatesDoNotFit { .. })), "{what}: {found:?}");
    }
}

fn with_nodes(model: &Model, place: impl Fn([f64; 3]) -> [f64; 3]) -> Model {
    Model { nodes: model.nodes.iter().map(|node| place(*node)).collect(), ..model.clone() }
}

/// Beams that cross in a plane, with the dofs of bending alone: uz, rx and ry.
fn grillage() -> Model {
    let (nx, ny) = (6, 5);
    let nodes: Vec<[f64; 3]> = (0..nx * ny).map(|k| [0.2 * f64::from(k % nx), 0.17 * f64::from(k / nx), 0.0]).collect();
    let along = (0..nx * ny).filter(|k| k % nx + 1 < nx).map(|k| [k as usize, k as usize + 1]);
    let across = (0..nx * (ny - 1)).map(|k| [k as usize, (k + nx) as usize]);
    let edges: Vec<[usize; 2]> = along.chain(across).collect();
    let whole = frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent);
    supported(&whole, |(_, direction)| matches!(direction, 0 | 1 | 5))
}

/// No node of a plate in bending has in-plane displacements: right coordinates make none, and wrong ones are seen all the same.
#[test]
fn wrong_coordinates_of_a_plate_without_inplane_dofs() {
    let sound = grillage();
    assert!(matches!(fit(&sound, Ties::All), Ok(CoordinateFit::Exact)));
    // In-plane places matter and heights do not: nothing in K depends on them.
    assert!(matches!(fit(&with_nodes(&sound, |[x, y, z]| [x, y, z + 0.3]), Ties::All), Ok(CoordinateFit::Exact)));
    assert_refused(&with_nodes(&sound, |[x, y, z]| [z, y, x]), "x and z exchanged");
    assert_refused(&with_nodes(&sound, |[x, y, z]| [x, z, y]), "y and z exchanged");
    assert_refused(&with_nodes(&sound, |[x, y, z]| [y, z, x]), "axes cycled");
    assert_refused(&with_nodes(&sound, |[x, y, z]| [y, x, z]), "x and y exchanged");
    let mut bent = sound.clone();
    bent.nodes[13] = [bent.nodes[13][0] + 0.03, bent.nodes[13][1], 0.01];
    assert_refused(&bent, "one node out of place");
}

/// A map that goes direction by direction makes forces at all rows of a free frame, as if supports held it everywhere. What is left of
/// a straight one shows rounding of coordinates at most, and the number of motions alone says that it is none.
#[test]
fn rows_in_another_order_of_a_slender_frame() {
    let curved = |k: f64| [0.1 * k, 0.2 * (0.7 * k).sin(), 0.15 * (0.4 * k).cos()];
    let straight = |k: f64| [0.1 * k, 0.0, 0.0];
    for (n, place) in [(20, &curved as &dyn Fn(f64) -> [f64; 3]), (30, &straight)] {
        let nodes: Vec<[f64; 3]> = (0..n).map(f64::from).map(place).collect();
        let edges: Vec<[usize; 2]> = (1..nodes.len()).map(|k| [k - 1, k]).collect();
        for diameter in [0.02, 0.002, 0.0002] {
            let sound = frame(&nodes, &edges, &Section::round(diameter), &Material::STEEL_SI, Inertia::Consistent);
            assert!(matches!(fit(&sound, Ties::All), Ok(CoordinateFit::Exact)), "{n} nodes, {diameter}");
            let mut wrong = sound.clone();
            wrong.dofs.sort_by_key(|(node, direction)| (*direction, *node));
            assert_refused(&wrong, &format!("{n} nodes, {diameter}, direction by direction"));
        }
    }
}

/// What is left of a beam behind a clamped node is a node by itself, held by the rest of its beam.
#[test]
fn a_body_of_one_node_is_held_like_any_other() {
    let nodes: Vec<[f64; 3]> = (0..12).map(|k| [0.31 * f64::from(k), 0.7, 0.2 + 0.1 * f64::from(k)]).collect();
    let edges: Vec<[usize; 2]> = (0..11).map(|k| [k, k + 1]).collect();
    let whole = frame(&nodes, &edges, &Section::round(0.03), &Material::STEEL_SI, Inertia::Consistent);
    let clamped = supported(&whole, |(label, _)| label == 11);
    let found = fit(&clamped, Ties::All);
    assert!(matches!(found, Ok(CoordinateFit::Exact)), "{found:?}");
}

/// Of a held part the result depends on the coordinates of the nodes that rigid patches tie, and on no others.
#[test]
fn coordinates_of_another_state_count_where_patches_tie() {
    let plate = brick([16, 8, 1], [1.0, 0.5, 0.005], &Material::STEEL_SI);
    let wall = plate.groups["XMIN"].clone();
    let held = supported(&plate, move |(label, _)| wall.contains(&label));
    // The quarter next to the wall is as it was.
    let wavy = with_nodes(&held, |[x, y, z]| [x, y, z + 0.002 * (9.0 * (x - 0.25).max(0.0)).sin()]);
    let tied_at = |x: f64| {
        let at = |place: &[f64; 3]| (place[0] - x).abs() < 1e-9;
        let labels = wavy.labels.iter().zip(&wavy.nodes).filter(|(_, place)| at(place)).map(|(label, _)| *label);
        let tied = TiedNodes { rigid: labels.collect(), ..TiedNodes::default() };
        supel::coordinates::compared(
            Checked::new(input(&wavy)).expect("a model"),
            (&[], supel::job::Mechanisms::default()),
            &tied,
        )
    };
    let found = tied_at(1.0).map(|model| model.fit);
    assert!(matches!(&found, Err(Error::CoordinatesDoNotFit { .. })), "{found:?}");
    let found = tied_at(0.125).map(|model| model.fit);
    assert!(matches!(&found, Ok(CoordinateFit::Rounded(_))), "{found:?}");
}

/// Nothing mends what rigid patches tie by the coordinates of another state of a held part; without patches nothing depends on them.
#[test]
fn coordinates_of_another_state_of_a_thin_held_part() {
    let plate = brick([16, 8, 1], [1.0, 0.5, 0.005], &Material::STEEL_SI);
    let wall = plate.groups["XMIN"].clone();
    let held = supported(&plate, move |(label, _)| wall.contains(&label));
    let wavy = with_nodes(&held, |[x, y, z]| [x, y, z + 0.002 * (9.0 * x).sin()]);
    let found = fit(&wavy, Ties::All);
    assert!(matches!(found, Err(Error::CoordinatesDoNotFit { .. })), "{found:?}");
    let five_digits =
        with_nodes(&held, |place| place.map(|x| format!("{:.4e}", x + 0.1234567).parse().expect("a number")));
    assert!(fit(&five_digits, Ties::All).is_ok());
}

/// Held at some nodes anywhere, its supports are far stiffer than what other axes or another state cost: that is no rounding, whatever
/// ties the nodes.
#[test]
fn other_axes_of_a_held_component_are_no_rounding() {
    for (cells, size) in [([3, 2, 2], [1.0, 0.6, 0.45]), ([4, 3, 1], [1.0, 0.7, 0.2]), ([3, 3, 3], [1.0, 0.9, 0.8])] {
        let whole = brick(cells, size, &Material::STEEL_SI);
        let n = whole.nodes.len() as u64;
        for seed in 0..20 {
            let mut random = SplitMix64::new(seed);
            let at_rest: Vec<i64> = (0..3 + seed % 3).map(|_| 1 + random.below(n) as i64).collect();
            let held = supported(&whole, |(label, _)| at_rest.contains(&label));
            for faulty in [
                with_nodes(&held, |[x, y, z]| [y, x, z]),
                with_nodes(&held, |[x, y, z]| [x, z, y]),
                with_nodes(&held, |[x, y, z]| [x, y + 0.13 * z, z - 0.13 * y]),
                with_nodes(&held, |[x, y, z]| [x, y, z + 0.1 * (3.0 * x).sin() * y]),
            ] {
                let found = fit(&faulty, Ties::None);
                assert!(!matches!(found, Ok(CoordinateFit::Rounded(_))), "seed {seed}, {at_rest:?}: {found:?}");
            }
        }
    }
}

/// Masts in a line, of eight digits: what their rotations cost by other heights is less than what digits may make of them, and as many motions
/// cost nothing as bodies have, or but one that digits alone hold. Nothing holds them in rotation, so that it is the coordinates that are wrong.
#[test]
fn wrong_heights_of_a_mast_of_few_digits_are_no_supports() {
    for n in [20, 30, 40, 60] {
        let nodes: Vec<[f64; 3]> = (0..n).map(|i| [0.0, 0.0, f64::from(i)]).collect();
        let edges: Vec<[usize; 2]> = (1..n as usize).map(|i| [i - 1, i]).collect();
        let sound = frame(&nodes, &edges, &Section::round(0.004), &Material::STEEL_SI, Inertia::Consistent);
        for factor in [2.0, 1000.0] {
            let stretched = with_nodes(&sound, |[x, y, z]| [x, y, factor * z]);
            for ties in [Ties::All, Ties::None] {
                let told = with_digits(&stretched, 8);
                let found = Checked::new(told).and_then(|model| crate::compared(model, ties)).map(|model| model.fit);
                assert!(matches!(found, Err(Error::CoordinatesDoNotFit { .. })), "{n}, {factor}: {found:?}");
            }
        }
    }
}
