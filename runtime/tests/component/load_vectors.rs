//! Forces of the loads that the file carries, and their stiffness.

use supel_runtime::component::{EvaluationError, FloatingFrame, Measures, ModalComponent};
use supel_runtime::motion::{Vector6, cross, dot};
use supel_runtime::{Matrix, Superelement};

use crate::beam;
use crate::situation::{CHOICES, Situation, assert_close, one_minus_derivative, superelements};
use supel_models::SplitMix64;

/// Nodes turn by up to 0.8 rad against each other.
const LARGE: f64 = 0.25;

/// Central differences at this step have truncation errors of 1e-10 times third derivatives, rounding of 1e-11.
const STEP: f64 = 1e-5;
const DIFFERENCE_TOLERANCE: f64 = 1e-8;

/// A superelement with two loads of random numbers.
fn loaded(superelement: &Superelement) -> Superelement {
    let (mut tensors, mut metadata) = (superelement.tensors().clone(), superelement.metadata().clone());
    let mut random = SplitMix64::new(21);
    tensors.load_vectors = Some(Matrix::from_fn(superelement.n_coordinates(), 2, |_, _| random.either_sign()));
    metadata.load_names = vec!["thrust".to_owned(), "pressure".to_owned()];
    Superelement::new(tensors, metadata).expect("the parts fit")
}

fn arc() -> Superelement {
    loaded(&beam::arc(3).superelement)
}

/// A load on the displacements of a node at x makes the moment x̃ f about the origin, to which its material coordinates belong.
fn at_origin(superelement: &Superelement, load: usize, amplitude: f64) -> Vec<f64> {
    let vectors = superelement.tensors().load_vectors.as_ref().expect("loads");
    let mut forces: Vec<f64> = (0..vectors.rows()).map(|i| amplitude * vectors[(i, load)]).collect();
    let n_nodal = superelement.n_interface();
    let places = &superelement.tensors().interface_positions;
    for (six, x) in forces[..n_nodal].as_chunks_mut::<6>().0.iter_mut().zip(places) {
        let lever = cross(x, &[six[0], six[1], six[2]]);
        (0..3).for_each(|i| six[3 + i] += lever[i]);
    }
    forces
}

/// In the reference configuration, and wherever the component is carried without deformation: a load turns with its frame.
#[test]
fn a_load_is_that_of_the_file_and_turns_with_the_component() {
    let superelement = arc();
    for (frame, measures) in CHOICES {
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        assert_eq!(component.load_names(), ["thrust", "pressure"]);
        for load in 0..2 {
            let expected = at_origin(&superelement, load, -2.5);
            let mut workspace = component.workspace();
            assert_close(component.load_vector_forces(load, -2.5, &mut workspace).expect("finite"), &expected, 1e-12);
            let mut carried = Situation::random(&component, 0.0, 5);
            carried.amplitudes.fill(0.0);
            let mut workspace = carried.evaluated(&component);
            assert_close(component.load_vector_forces(load, -2.5, &mut workspace).expect("finite"), &expected, 1e-12);
        }
    }
}

/// fᵀv = a ℓᵀ(ė + U V_F), the power of forces on the finite element model: with motion-based measures U is six unit motions at each node.
#[test]
fn the_power_of_a_load_is_that_of_its_forces_on_the_model() {
    let superelement = arc();
    for frame in [FloatingFrame::MassWeighted, FloatingFrame::Rigid] {
        let component =
            ModalComponent::with_measures(&superelement, frame, Measures::MotionBased).expect("a free body");
        let situation = Situation::random(&component, LARGE, 6);
        let mut workspace = situation.evaluated(&component);
        let load = at_origin(&superelement, 1, 3.0);
        let (rate, of_frame): (Vec<f64>, Vector6) =
            (workspace.deformation_rate().to_vec(), *workspace.frame_velocity());
        let n_nodal = superelement.n_interface();
        let carried = |i: usize| if i < n_nodal { of_frame[i % 6] } else { 0.0 };
        let expected: f64 = (0..load.len()).map(|i| load[i] * (rate[i] + carried(i))).sum();
        let forces = component.load_vector_forces(1, 3.0, &mut workspace).expect("finite");
        let found: f64 = forces.iter().zip(&situation.velocities).map(|(f, v)| f * v).sum();
        assert_close(&[found], &[expected], 1e-11);
    }
}

/// The force that a deformed component hands to the world is that of the load, turned with the floating frame.
#[test]
fn the_resultant_turns_with_the_floating_frame() {
    let superelement = arc();
    for (frame, measures) in CHOICES {
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        let situation = Situation::random(&component, LARGE, 7);
        let mut workspace = situation.evaluated(&component);
        let frame = *workspace.floating_frame();
        let load = at_origin(&superelement, 0, 1.0);
        let forces = component.load_vector_forces(0, 1.0, &mut workspace).expect("finite");
        let (mut found, mut expected) = ([0.0; 3], [0.0; 3]);
        for ((six, own), motion) in
            forces.as_chunks::<6>().0.iter().zip(load.as_chunks::<6>().0).zip(&situation.motions)
        {
            (0..3).for_each(|i| found[i] += dot(&motion.rotation[i], &[six[0], six[1], six[2]]));
            (0..3).for_each(|i| expected[i] += dot(&frame.rotation[i], &[own[0], own[1], own[2]]));
        }
        assert_close(&found, &expected, 1e-11);
    }
}

#[test]
fn the_stiffness_of_a_load_is_minus_the_derivative_of_its_forces() {
    for superelement in superelements().iter().map(loaded) {
        for (frame, measures) in CHOICES {
            let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
            let situation = Situation::random(&component, LARGE, 15);
            let forces = |at: &Situation| {
                component.load_vector_forces(1, 1.5, &mut at.evaluated(&component)).expect("finite").to_vec()
            };
            let expected = one_minus_derivative(STEP, &situation, forces);
            // It is added to what is there.
            let mut found = vec![1.0; expected.len()];
            let mut workspace = situation.evaluated(&component);
            component.add_load_vector_stiffness(1, 1.5, &mut workspace, &mut found).expect("finite");
            assert_close(&found, &expected, DIFFERENCE_TOLERANCE);
        }
    }
}

#[test]
fn loads_that_cannot_act_are_refused() {
    let superelement = arc();
    let component = ModalComponent::new(&superelement, FloatingFrame::MassWeighted).expect("a free body");
    let (mut workspace, r) = (component.workspace(), component.n_coordinates());
    let mut matrix = vec![0.0; r * r];
    let unknown = EvaluationError::UnknownLoad { load: 2, n_loads: 2 };
    assert_eq!(component.load_vector_forces(2, 1.0, &mut workspace), Err(unknown.clone()));
    assert_eq!(component.add_load_vector_stiffness(2, 1.0, &mut workspace, &mut matrix), Err(unknown));
    for amplitude in [f64::NAN, f64::INFINITY] {
        let expected = EvaluationError::NotFinite { what: "amplitude", index: 0 };
        assert_eq!(component.load_vector_forces(0, amplitude, &mut workspace), Err(expected.clone()));
        assert_eq!(component.add_load_vector_stiffness(0, amplitude, &mut workspace, &mut matrix), Err(expected));
    }
    let twin = ModalComponent::new(&superelement, FloatingFrame::MassWeighted).expect("a free body");
    let foreign = EvaluationError::ForeignWorkspace;
    assert_eq!(twin.load_vector_forces(0, 1.0, &mut workspace), Err(foreign));
    let wrong = EvaluationError::WrongLength { what: "entries of the result", found: 3, expected: r * r };
    assert_eq!(component.add_load_vector_stiffness(0, 1.0, &mut workspace, &mut matrix[..3]), Err(wrong));
    assert!(matrix.iter().all(|value| *value == 0.0), "a refusal adds nothing");
    let without = ModalComponent::new(&beam::arc(3).superelement, FloatingFrame::MassWeighted).expect("a free body");
    let none = EvaluationError::UnknownLoad { load: 0, n_loads: 0 };
    assert_eq!(without.load_vector_forces(0, 1.0, &mut without.workspace()), Err(none));
}
