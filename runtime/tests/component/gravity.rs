//! Forces of gravity, their potential and their stiffness.

use supel_runtime::component::{EvaluationError, FloatingFrame, ModalComponent};
use supel_runtime::motion::{cross, dot};
use supel_runtime::{Matrix, Superelement};

use crate::beam;
use crate::situation::{CHOICES, Situation, assert_close, gradient, one_minus_derivative, superelements};
use supel_models::SplitMix64;

/// Nodes turn by up to 0.8 rad against each other.
const LARGE: f64 = 0.25;

/// Central differences at this step have truncation errors of 1e-10 times third derivatives, rounding of 1e-11.
const STEP: f64 = 1e-5;
const DIFFERENCE_TOLERANCE: f64 = 1e-8;

const G: [f64; 3] = [1.0, -2.0, 3.0];

/// The arc with loads of gravity that are not M̂Û, as where the mass is lumped otherwise than in the model, and those loads.
fn own_gravity() -> (Superelement, Matrix) {
    let (mut tensors, metadata, _) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[0, 8], 3);
    let mut random = SplitMix64::new(14);
    let own = Matrix::from_fn(15, 3, |_, _| random.either_sign());
    tensors.gravity = Some(own.clone());
    (Superelement::new(tensors, metadata).expect("the parts fit"), own)
}

fn component(superelement: &Superelement) -> ModalComponent {
    ModalComponent::new(superelement, FloatingFrame::MassWeighted).expect("a free body")
}

#[test]
fn gravity_forces_are_the_gradient_of_the_potential() {
    for (frame, measures) in CHOICES {
        let superelement = beam::arc(5).superelement;
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        let situation = Situation::random(&component, LARGE, 12);
        let potential = |at: &Situation| component.gravity_potential(&G, &at.evaluated(&component)).expect("a weight");
        let expected: Vec<f64> = gradient(STEP, &situation, potential).iter().map(|x| -x).collect();
        let mut workspace = situation.evaluated(&component);
        let found = component.gravity_forces(&G, &mut workspace).expect("finite");
        assert_close(found, &expected, DIFFERENCE_TOLERANCE);
    }
}

/// A superelement that was made for gravity along one axis of its own, or for none, is refused under any other.
#[test]
fn gravity_that_the_superelement_was_not_made_for_is_refused() {
    let made_for = |along: Option<[f64; 3]>| {
        let (tensors, mut metadata, _) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[0, 8], 2);
        metadata.validity.gravity = along;
        component(&Superelement::new(tensors, metadata).expect("the parts fit"))
    };
    // (1, 0, −1) in axes of the component, of any length and either sign.
    let along = made_for(Some([1e-200, 0.0, -1e-200]));
    let situation = Situation::random(&along, 0.1, 7);
    let mut workspace = situation.evaluated(&along);
    let turned = |g: [f64; 3]| supel_runtime::motion::times_3(&workspace.floating_frame().rotation, &g);
    let (told, other, near) = (turned([-3.0, 0.0, 3.0]), turned([0.0, 9.81, 0.0]), turned([3.0, 0.02, -3.0]));
    assert!(along.gravity_forces(&told, &mut workspace).is_ok() && along.gravity_forces(&near, &mut workspace).is_ok());
    let refused = along.gravity_forces(&other, &mut workspace).map(<[f64]>::to_vec);
    assert!(matches!(refused, Err(EvaluationError::GravityNotTold { along }) if (along[1] - 9.81).abs() < 1e-12));
    assert!(along.gravity_potential(&other, &workspace).is_err());
    assert!(along.add_gravity_stiffness(&other, &mut workspace, &mut [0.0; 14 * 14]).is_err());
    assert!(along.gravity_forces(&[0.0; 3], &mut workspace).is_ok(), "without gravity");
    for (component, is_refused) in [(made_for(Some([0.0; 3])), true), (made_for(None), false)] {
        let mut workspace = Situation::random(&component, 0.1, 7).evaluated(&component);
        assert_eq!(component.gravity_forces(&G, &mut workspace).is_err(), is_refused);
        assert!(component.gravity_forces(&[0.0; 3], &mut workspace).is_ok());
    }
}

/// −m gᵀ(R c + u) wherever the component is.
#[test]
fn the_potential_is_that_of_the_weight_at_the_centre_of_mass() {
    for (frame, measures) in CHOICES {
        let superelement = beam::arc(3).superelement;
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        let m_f = superelement.tensors().rigid_body_mass.as_slice();
        let (mass, centre) = (m_f[0], [m_f[11], m_f[15], m_f[4]].map(|moment| moment / m_f[0]));
        let mut situation = Situation::random(&component, 0.0, 3);
        situation.amplitudes.fill(0.0);
        let expected = -mass * dot(&G, &situation.motions[0].apply(&centre));
        let found = component.gravity_potential(&G, &situation.evaluated(&component));
        assert_close(&[found.expect("a weight")], &[expected], 1e-12);
    }
}

#[test]
fn loads_that_are_no_weight_have_no_potential() {
    let random = Superelement::new(beam::random_parts(2, 3, 12).0, beam::random_parts(2, 3, 12).1);
    for superelement in [own_gravity().0, random.expect("the parts fit")] {
        let component = component(&superelement);
        let found = component.gravity_potential(&G, &component.workspace());
        assert_eq!(found, Err(EvaluationError::NoPotential));
    }
    // Loads printed with six digits are a weight.
    let (mut tensors, metadata, _) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[0, 8], 3);
    let whole =
        |i: usize, a: usize| (0..12).map(|j| tensors.mass[(i, j)] * tensors.rigid_body_modes[(j, a)]).sum::<f64>();
    let six = |x: f64| format!("{x:.5e}").parse::<f64>().expect("a number");
    tensors.gravity = Some(Matrix::from_fn(15, 3, |i, a| six(whole(i, a))));
    let component = component(&Superelement::new(tensors, metadata).expect("the parts fit"));
    assert!(component.gravity_potential(&G, &component.workspace()).is_ok());
}

#[test]
fn gravity_of_the_file_is_taken_in_every_choice() {
    let (superelement, own) = own_gravity();
    // Loads on displacements at the nodes; the coordinates of the component have the moment about the origin.
    let mut expected: Vec<f64> = (0..15).map(|i| (0..3).map(|a| own[(i, a)] * G[a]).sum()).collect();
    for (six, x) in expected[..12].as_chunks_mut::<6>().0.iter_mut().zip(&superelement.tensors().interface_positions) {
        let lever = cross(x, &[six[0], six[1], six[2]]);
        (0..3).for_each(|i| six[3 + i] += lever[i]);
    }
    for (frame, measures) in CHOICES {
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        // In the reference configuration every motion of the nodes is a deformation or a rigid motion, of which Ĝ has both.
        assert_close(component.gravity_forces(&G, &mut component.workspace()).expect("finite"), &expected, 1e-12);
    }
}

#[test]
fn gravity_of_a_rigid_beam_is_its_weight_at_its_centre() {
    let component = component(&beam::arc(3).superelement);
    let mut workspace = component.workspace();
    let g = [0.0, 0.0, -10.0];
    let forces = component.gravity_forces(&g, &mut workspace).expect("finite");
    let sum: [f64; 6] = std::array::from_fn(|a| forces[a] + forces[6 + a]);
    let m_f = component.rigid_mass();
    let (mass, moment) = (m_f[0][0], [m_f[1][5], m_f[2][3], m_f[0][4]]);
    let torque = cross(&moment, &g);
    assert_close(&sum, &[0.0, 0.0, -10.0 * mass, torque[0], torque[1], torque[2]], 1e-12);
}

#[test]
fn the_stiffness_of_gravity_is_minus_the_derivative_of_its_forces() {
    for superelement in superelements().iter().chain([&own_gravity().0]) {
        for (frame, measures) in CHOICES {
            let component = ModalComponent::with_measures(superelement, frame, measures).expect("a free body");
            let situation = Situation::random(&component, LARGE, 15);
            let forces =
                |at: &Situation| component.gravity_forces(&G, &mut at.evaluated(&component)).expect("finite").to_vec();
            let expected = one_minus_derivative(STEP, &situation, forces);
            // It is added to what is there.
            let mut found = vec![1.0; expected.len()];
            let mut workspace = situation.evaluated(&component);
            component.add_gravity_stiffness(&G, &mut workspace, &mut found).expect("finite");
            assert_close(&found, &expected, DIFFERENCE_TOLERANCE);
        }
    }
}

#[test]
fn gravity_that_is_not_finite_is_refused() {
    let component = component(&beam::arc(2).superelement);
    let (mut workspace, mut matrix) = (component.workspace(), vec![0.0; 14 * 14]);
    for (axis, value) in [(0, f64::NAN), (1, f64::INFINITY), (2, f64::NEG_INFINITY)] {
        let mut g = G;
        g[axis] = value;
        let expected = EvaluationError::NotFinite { what: "acceleration of gravity", index: axis };
        assert_eq!(component.gravity_forces(&g, &mut workspace), Err(expected.clone()));
        assert_eq!(component.gravity_potential(&g, &workspace), Err(expected.clone()));
        assert_eq!(component.add_gravity_stiffness(&g, &mut workspace, &mut matrix), Err(expected));
    }
    let huge = [0.0, 0.0, 1e308];
    let overflow = |what| EvaluationError::Overflow { what };
    assert_eq!(component.gravity_forces(&huge, &mut workspace), Err(overflow("forces of gravity")));
    assert_eq!(component.gravity_potential(&huge, &workspace), Err(overflow("potential of gravity")));
    let outcome = component.add_gravity_stiffness(&huge, &mut workspace, &mut matrix);
    assert_eq!(outcome, Err(overflow("stiffness of gravity")));
    let wrong = EvaluationError::WrongLength { what: "entries of the result", found: 14, expected: 196 };
    assert_eq!(component.add_gravity_stiffness(&G, &mut workspace, &mut matrix[..14]), Err(wrong));
    assert!(matrix.iter().all(|value| *value == 0.0), "a refusal adds nothing");
}
