//! Superelements joined, held and loaded: their modes against those of the whole model, which must lie between the bounds.

mod absent;
mod again;
mod bounds;
mod document;
mod halves;
mod joints;
mod many_jobs;
mod nastran;
mod refused;

use supel::assembly::{Assembly, AssemblyMode, AssemblyModes, Component, Kind, Wanted};
use supel::cli::ExitCode;
use supel_models::{Inertia, Material, Model, Section, frame};
use supel_testing::place::Place;

/// A model reduced by flags, as a component of an assembly.
fn reduced(name: &str, model: &Model, flags: &str) -> Component {
    let place = Place::with(model);
    let files = if model.dofs.is_empty() { place.matrix_flags() } else { place.model_flags() };
    place.reduce(&files, flags).expect(ExitCode::Done);
    Component::new(name.to_owned(), place.superelement("x.supel")).expect("a component")
}

fn all_modes(assembly: &Assembly) -> AssemblyModes {
    assembly.modes(Wanted::Count(usize::MAX)).expect("modes")
}

fn hertz(lambda: f64) -> f64 {
    lambda.max(0.0).sqrt() / std::f64::consts::TAU
}

/// Asserts that the eigenvalues of the whole model, ascending, lie between the bounds of the assembly.
///
/// The oracle works on the dense matrices at once: each of its eigenvalues is known to n ε of the largest.
#[track_caller]
fn assert_enclosed(found: &AssemblyModes, whole: &[f64]) {
    let known = whole.len() as f64 * f64::EPSILON * whole.last().expect("eigenvalues").abs();
    assert!(found.modes.len() <= whole.len());
    for (mode, lambda) in found.modes.iter().zip(whole) {
        let AssemblyMode { number, frequency_hz, rounding_hz, at_least_hz, .. } = *mode;
        let at_most = hertz(lambda - known);
        assert!(at_most <= frequency_hz + rounding_hz, "mode {number}: {frequency_hz} Hz is below {at_most} Hz");
        let at_least = hertz(lambda + known);
        let lower = at_least_hz.expect("a bound");
        assert!(lower <= at_least, "mode {number}: the bound {lower} Hz is above {at_least} Hz");
    }
}

fn n_rigid(modes: &AssemblyModes) -> usize {
    modes.modes.iter().filter(|mode| mode.kind == Kind::RigidBody).count()
}

/// Nodes of a bent and twisted line of twelve beams; no two of its frequencies are alike.
fn line() -> Vec<[f64; 3]> {
    let along = |i: usize| i as f64 / 12.0;
    (0..=12).map(|i| [1.3 * along(i), 0.4 * along(i).powi(2), 0.2 * along(i).powi(3)]).collect()
}

/// Beams along some nodes, labelled from one.
fn beams(nodes: &[[f64; 3]]) -> Model {
    let edges: Vec<[usize; 2]> = (1..nodes.len()).map(|i| [i - 1, i]).collect();
    frame(nodes, &edges, &Section::round(0.03), &Material::STEEL_SI, Inertia::Consistent)
}

/// The model with a mass and moments of inertia at a node.
fn loaded(model: &Model, label: i64, masses: [f64; 6]) -> Model {
    let mut sum = supel_models::Assembler::default();
    sum.extend(model.mass.iter().copied());
    for (row, (node, direction)) in (0..).zip(&model.dofs) {
        if *node == label {
            sum.add(row, row, masses[*direction as usize]);
        }
    }
    Model { mass: sum.finish(), ..model.clone() }
}
