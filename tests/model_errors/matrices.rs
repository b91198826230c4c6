//! The checks that matrices pass before anything is factored.

use supel::error::{Error, ErrorClass};
use supel::model::{Finding, Model};
use supel::sparse::{Rounding, TurnedRoundings};
use supel_models as models;
use supel_models::model::Entry;
use supel_models::transform::{join, scaled, supported};
use supel_models::{Ends, Inertia, Material, Section, brick, frame, spring};

use crate::chain::input;
use crate::{assert_says, refusal};

fn cube() -> models::Model {
    brick([1, 1, 1], [1.0; 3], &Material::UNIT)
}

fn refused(model: &models::Model) -> Error {
    refusal(Model::new(input(model)))
}

/// The model with the value at a position of both triangles replaced.
fn with_entry(entries: &[Entry], at: (u32, u32), value: f64) -> Vec<Entry> {
    let is_there = |entry: &&Entry| (entry.0, entry.1) != at && (entry.1, entry.0) != at;
    let mut changed: Vec<Entry> = entries.iter().filter(is_there).copied().collect();
    changed.push((at.0, at.1, value));
    if at.0 != at.1 {
        changed.push((at.1, at.0, value));
    }
    changed
}

#[test]
fn unsymmetric_stiffness() {
    let mut model = cube();
    let at = model.stiffness.iter().position(|entry| (entry.0, entry.1) == (4, 1)).expect("an entry");
    let largest = model.stiffness.iter().fold(0.0f64, |max, entry| max.max(entry.2.abs()));
    model.stiffness[at].2 += 1e-3 * largest;
    let error = refused(&model);
    let Error::Unsymmetric { matrix: "stiffness", asymmetry, .. } = error else { panic!("{error}") };
    // A corner and another of a cube have like diagonals, three eighths of the largest entry.
    let ends = |row: u32| model.stiffness.iter().find(|entry| (entry.0, entry.1) == (row, row)).expect("a diagonal").2;
    let expected = 1e-3 * largest / (ends(4) * ends(1)).sqrt();
    assert!((asymmetry - expected).abs() < 1e-12 * expected, "{asymmetry:e}");
    assert_says(
        &error,
        ErrorClass::InputData,
        &["stiffness", "row 5 (node 2 uy), column 2 (node 1 uy)", &format!("{expected:.1e} of its rows"), "[[matrix]]"],
    );
}

#[test]
fn unsymmetric_mass_with_an_entry_on_one_side() {
    // Nodes 1 and 3 share no element: only the lower triangle has this entry.
    let mut model = brick([2, 1, 1], [2.0, 1.0, 1.0], &Material::UNIT);
    let largest = model.mass.iter().fold(0.0f64, |max, entry| max.max(entry.2));
    model.mass.push((6, 0, 0.5 * largest));
    let error = refused(&model);
    let Error::Unsymmetric { matrix: "mass", place, .. } = &error else { panic!("{error}") };
    assert!(place.contains("(node 3 ux)") && place.contains("(node 1 ux)"), "{place}");
    assert_says(&error, ErrorClass::InputData, &["mass", "of its rows"]);
}

/// A chain of springs of 1000 with one of 10⁹ in it: an entry of a soft one is 10⁻⁶ of the largest, and all of its row.
#[test]
fn asymmetry_of_a_soft_row_is_not_hidden_by_a_stiff_one() {
    let chain = |stiff: f64| {
        let mut model = spring(6, Ends::Fixed);
        let mut springs = [1000.0; 7];
        springs[2] = stiff;
        model.stiffness = (0..6u32)
            .flat_map(|row| {
                let [left, right] = [springs[row as usize], springs[row as usize + 1]];
                let next = (row < 5).then_some((row + 1, row, -right)).into_iter().chain((row < 5).then_some((
                    row,
                    row + 1,
                    -right,
                )));
                next.chain([(row, row, left + right)])
            })
            .collect();
        model
    };
    for stiff in [1e9, 1e13] {
        let mut model = chain(stiff);
        let at = model.stiffness.iter().position(|entry| (entry.0, entry.1) == (4, 5)).expect("an entry");
        model.stiffness[at].2 = 0.0;
        let error = refused(&model);
        assert_says(&error, ErrorClass::InputData, &["stiffness", "row 6 (node 6 ux), column 5 (node 5 ux)"]);
    }
}

/// What two triangles leave open is in what the entries are known to.
#[test]
fn rows_are_known_to_what_two_triangles_leave_open() {
    let mut model = cube();
    let at = model.stiffness.iter().position(|entry| (entry.0, entry.1) == (4, 1)).expect("an entry");
    let ends = |row: u32| model.stiffness.iter().find(|entry| (entry.0, entry.1) == (row, row)).expect("a diagonal").2;
    model.stiffness[at].2 += 4e-7 * (ends(4) * ends(1)).sqrt();
    let known = Model::new(input(&model)).expect("symmetric to 4e-7 of its rows").precision.stiffness;
    assert!(known.is_of_parts && (known.relative / 2e-7 - 1.0).abs() < 1e-6, "{known:?}");
    // Six digits explain a difference by so much of the rows, though not of an entry that is small for them.
    let mut rounded = input(&model);
    rounded.stiffness.digits.significant = 6;
    let known = Model::new(rounded).expect("symmetric but for digits").precision.stiffness;
    assert!(known.is_of_parts && known.differing.is_none() && known.relative == 5e-6, "{known:?}");
}

/// Rounding of the producer is mended and told, not refused.
#[test]
fn asymmetry_of_rounding_is_a_finding() {
    let mut model = cube();
    let at = model.stiffness.iter().position(|entry| (entry.0, entry.1) == (4, 1)).expect("an entry");
    model.stiffness[at].2 *= 1.0 + 1e-13;
    let model = Model::new(input(&model)).expect("symmetric but for rounding");
    assert!(
        matches!(model.findings[..], [Finding::Symmetrised { matrix: "stiffness", of_rows, .. }] if of_rows < 1e-12),
        "{:?}",
        model.findings
    );
}

/// Free or held, with directions or without: every row of the stiffness of a free solid lets a translation pass, and no
/// row of a mass does.
#[test]
fn stiffness_and_mass_exchanged() {
    let solid = brick([4, 4, 4], [1.0; 3], &Material::STEEL_SI);
    let held = supported(&solid, |dof| solid.groups["XMIN"].contains(&dof.0));
    let anonymous = models::Model { dofs: Vec::new(), ..solid.clone() };
    for model in [solid, held, anonymous, spring(40, Ends::Free), spring(40, Ends::Fixed)] {
        assert!(Model::new(input(&model)).is_ok(), "the right way round");
        let exchanged = models::Model { stiffness: model.mass.clone(), mass: model.stiffness.clone(), ..model };
        let error = refused(&exchanged);
        assert!(
            matches!(error, Error::Swapped { in_stiffness, in_mass } if in_stiffness == 0.0 && in_mass > 0.5),
            "{error}"
        );
        assert_says(&error, ErrorClass::InputData, &["exchanged", "exchange the two files"]);
    }
}

#[test]
fn mass_of_zeros() {
    for model in [scaled(&cube(), 1.0, 0.0), models::Model { mass: Vec::new(), ..cube() }] {
        let error = refused(&model);
        assert!(matches!(error, Error::NoMass), "{error}");
        assert_says(&error, ErrorClass::InputData, &["mass", "give the mass matrix"]);
    }
}

#[test]
fn rows_without_stiffness_and_mass() {
    let model = cube();
    let keep = |entries: &[Entry]| -> Vec<Entry> {
        entries.iter().filter(|entry| ![7, 12].contains(&entry.0) && ![7, 12].contains(&entry.1)).copied().collect()
    };
    let empty = models::Model { stiffness: keep(&model.stiffness), mass: keep(&model.mass), ..model };
    let error = refused(&empty);
    assert!(matches!(error, Error::EmptyRows { n_rows: 2, row: 8, .. }), "{error}");
    assert_says(&error, ErrorClass::InputData, &["2 rows", "row 8 (node 3 uy)", "leave unused"]);
    let anonymous = models::Model { dofs: Vec::new(), ..empty };
    assert_says(&refused(&anonymous), ErrorClass::InputData, &["the first is row 8 –"]);
}

#[test]
fn constraint_multiplier() {
    let mut model = spring(4, Ends::Fixed);
    model.stiffness = with_entry(&model.stiffness, (2, 2), 0.0);
    let error = refused(&model);
    assert!(matches!(error, Error::MultiplierRow { n_single: 1, n_of_pairs: 0, row: 3, .. }), "{error}");
    assert_says(&error, ErrorClass::InputData, &["row 3 (node 3 ux)", "multiplier", "eliminate"]);
}

/// Two multipliers for each constraint, as Code_Aster writes them: their diagonal is −α, and α with the other sign of the equations.
#[test]
fn pairs_of_constraint_multipliers() {
    let chain = || spring(4, Ends::Free);
    for alpha in [7.5, -7.5] {
        let mut model = chain();
        // u₁ = u₂ in rows 5 and 6, u₃ = u₄ in rows 7 and 8.
        for (first, [a, b]) in [(4, [0, 1]), (6, [2, 3])] {
            for multiplier in [first, first + 1] {
                model.stiffness = with_entry(&model.stiffness, (multiplier, a), alpha);
                model.stiffness = with_entry(&model.stiffness, (multiplier, b), -alpha);
                model.stiffness = with_entry(&model.stiffness, (multiplier, multiplier), -alpha);
            }
            model.stiffness = with_entry(&model.stiffness, (first, first + 1), alpha);
        }
        model = models::Model { n: 8, dofs: Vec::new(), ..model };
        let error = refused(&model);
        assert!(matches!(error, Error::MultiplierRow { n_single: 0, n_of_pairs: 4, row: 5, .. }), "{error}");
        assert_says(&error, ErrorClass::InputData, &["4 rows of constraint multipliers", "in pairs", "row 5 –"]);
    }
    // A spring between two massless dofs that nothing else holds is a structure.
    let mut model = chain();
    for (row, other, value) in [(4, 4, 2.0), (5, 5, 2.0), (4, 5, -2.0)] {
        model.stiffness = with_entry(&model.stiffness, (row, other), value);
    }
    Model::new(input(&models::Model { n: 6, dofs: Vec::new(), ..model })).expect("a structure");
}

#[test]
fn negative_stiffness() {
    let mut model = spring(4, Ends::Fixed);
    model.stiffness = with_entry(&model.stiffness, (1, 1), -0.25);
    let error = refused(&model);
    assert!(matches!(error, Error::NegativeStiffness { row: 2, value: -0.25, .. }), "{error}");
    assert_says(&error, ErrorClass::ModelPhysics, &["row 2 (node 2 ux)", "-2.5", "buckling"]);
}

#[test]
fn negative_mass() {
    let mut model = spring(4, Ends::Fixed);
    model.mass = with_entry(&model.mass, (0, 0), -1.0);
    let error = refused(&model);
    assert!(matches!(error, Error::NegativeMass { row: 1, value: -1.0, .. }), "{error}");
    assert_says(&error, ErrorClass::ModelPhysics, &["row 1 (node 1 ux)", "check point masses"]);
}

#[test]
fn rows_without_mass_and_free_particles_are_findings() {
    let nodes = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    let section = Section::round(0.1);
    let lumped = frame(&nodes, &[[0, 1], [1, 2]], &section, &Material::UNIT, Inertia::LumpedTranslations);
    let model = Model::new(input(&lumped)).expect("rotations without mass");
    assert_eq!(model.findings, [Finding::MasslessRows { n_rows: 9 }]);
    let particle = models::Model { stiffness: Vec::new(), ..spring(1, Ends::Free) };
    let model = Model::new(input(&join(&spring(3, Ends::Fixed), &particle, &[]))).expect("a free particle");
    assert_eq!(model.findings, [Finding::FreeParticles { rows: vec![3], first: "row 4 (node 4 ux)".to_owned() }]);
    assert_eq!(model.bodies.n_bodies, 2);
}

#[test]
fn mass_negative_by_rounding_is_a_finding() {
    let mut model = spring(4, Ends::Fixed);
    model.mass = with_entry(&model.mass, (2, 2), -1e-17);
    let model = Model::new(input(&model)).expect("a negative rounding");
    assert_eq!(model.findings, [Finding::NegativeMassByRounding { n_rows: 1 }]);
}

/// Rows that were turned are sums: the rounding of a stiff direction reaches the others.
#[test]
fn turned_rows_know_what_rounding_of_a_stiff_direction_makes() {
    let six_digits = Rounding { absolute: 0.5, ..Rounding::relative(0.5e-5) };
    let turned = six_digits.turned(TurnedRoundings { enlargement: 40.0, left_out: 0.0 });
    // Relative to the ends: 40 of its own; three times half a unit of fixed point.
    assert!((turned.of_entry(0.0, 1e6) / 200.0 - 1.0).abs() < 1e-12 && turned.of_entry(0.0, 0.0) == 1.5, "{turned:?}");
    let binary = Rounding::BINARY.turned(TurnedRoundings { enlargement: 40.0, left_out: 0.0 });
    assert!(binary.is_of_parts && !binary.is_coarse(), "{binary:?}");
}
