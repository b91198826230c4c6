//! Springs to the ground, and supports in earnest: S-13.

use supel::job::Method;
use supel::verification::{Findings, Restraint, verify};
use supel_models::model::Assembler;
use supel_models::transform::{grounded, supported};
use supel_models::{Material, Model, brick};

use crate::chain::direct;
use crate::evidence::with_model;

fn findings(model: &Model, corners: &[i64]) -> Findings {
    let interfaces = [direct("corners", corners)];
    with_model(model, &interfaces, (Method::CraigBampton, 4), |evidence| verify(&evidence).expect("decompositions"))
}

fn largest_diagonal(model: &Model) -> f64 {
    model.stiffness.iter().map(|entry| entry.2).fold(0.0, f64::max)
}

/// A thin plate with a spring of r max(K) at one corner, across the plate.
#[test]
fn a_weak_spring_to_the_ground_is_found_and_named() {
    let plate = brick([12, 12, 1], [1.0, 1.0, 1e-2], &Material::UNIT);
    let corners = [1, 13, 157];
    // The dof uz of node 79, away from the corners.
    let row = 3 * 78 + 2;
    let unit = largest_diagonal(&plate);
    for r in [0.0, 1e-16, 1e-11, 1e-10, 1e-9, 1e-8] {
        let found = findings(&grounded(&plate, row, r * unit), &corners).rigid_body.grounding;
        let grounded: Vec<_> = found.iter().filter(|direction| direction.restraint == Restraint::Grounded).collect();
        let most = found.iter().map(|direction| direction.energy_ratio).fold(0.0, f64::max);
        println!("r = {r:e}: {most:.1e}, {grounded:?}");
        if r <= 1e-16 {
            assert!(grounded.is_empty(), "r = {r:e}: {grounded:?}");
        } else {
            assert!(!grounded.is_empty(), "r = {r:e}: {found:?}");
            assert!(grounded.iter().all(|direction| direction.worst.as_deref() == Some("node 79 uz")), "{grounded:?}");
        }
    }
}

/// A clamped beam with a heavy mass at its end: moved as a whole it has little of the energy of the first mode beyond six, because
/// of its mass, and none of its modes moves it as a whole.
#[test]
fn a_heavy_mass_on_a_clamped_beam_is_no_weak_spring() {
    let beam = brick([8, 1, 1], [8.0, 1.0, 1.0], &Material::UNIT);
    let tip: Vec<u32> = (0..beam.n as u32).filter(|row| beam.dofs[*row as usize].0 % 9 == 0).collect();
    let mut mass = Assembler::default();
    mass.extend(beam.mass.iter().copied());
    tip.iter().for_each(|row| mass.add(*row, *row, 1e4));
    let clamped = supported(&Model { mass: mass.finish(), ..beam }, |(label, _)| label % 9 == 1);
    let found = findings(&clamped, &[5]).rigid_body.grounding;
    assert!(found.iter().any(|direction| direction.energy_ratio < 1e-2), "{found:?}");
    assert!(found.iter().all(|direction| direction.restraint == Restraint::Held), "{found:?}");
}

/// A component that is really held is not grounded by accident.
#[test]
fn a_support_is_no_accident() {
    let model = brick([6, 2, 2], [6.0, 1.1, 0.9], &Material::UNIT);
    let held = supported(&model, |(label, _)| label % 7 == 1);
    let hinged = supported(&model, |(label, direction)| label == 1 || (label == 8 && direction != 0));
    for model in [&model, &held, &hinged] {
        let found = findings(model, &[7, 14, 28, 63]).rigid_body;
        let none = found.grounding.iter().all(|direction| direction.restraint != Restraint::Grounded);
        assert!(none, "{:?}", found.grounding);
    }
}
