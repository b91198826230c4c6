//! What forces must not depend on: place and orientation, the origin, the history, the thread; and states that are refused.

use std::f64::consts::PI;

use supel_runtime::Superelement;
use supel_runtime::component::{EvaluationError, FloatingFrame, ModalComponent, State, Workspace};
use supel_runtime::motion::{Motion, cross};

use crate::beam;
use crate::situation::{Situation, assert_close, components, largest};
use supel_models::SplitMix64;

fn arc() -> ModalComponent {
    ModalComponent::new(&beam::arc(5).superelement, FloatingFrame::MassWeighted).expect("a free body")
}

#[track_caller]
fn assert_same_results(found: &Workspace, expected: &Workspace, tolerance: f64) {
    assert_close(found.elastic_forces(), expected.elastic_forces(), tolerance);
    assert_close(found.inertial_forces(), expected.inertial_forces(), tolerance);
    assert_close(
        &[found.strain_energy(), found.kinetic_energy()],
        &[expected.strain_energy(), expected.kinetic_energy()],
        tolerance,
    );
}

#[test]
fn a_superposed_rigid_motion_changes_nothing_but_the_frame() {
    for component in components().iter().filter(|component| component.n_nodes() > 1) {
        let situation = Situation::random(component, 0.2, 1);
        let carrier = SplitMix64::new(2).motion(3.0);
        let mut carried = situation.clone();
        carried.motions.iter_mut().for_each(|motion| *motion = carrier.compose(motion));
        let (found, expected) = (carried.evaluated(component), situation.evaluated(component));
        // Displacements of order ten lose a digit.
        assert_same_results(&found, &expected, 1e-12);
        let (found, expected) = (found.floating_frame(), carrier.compose(expected.floating_frame()));
        assert_close(found.rotation.as_flattened(), expected.rotation.as_flattened(), 1e-13);
        assert_close(&found.translation, &expected.translation, 1e-13);
        let (found, expected) = (carried.tangents(component), situation.tangents(component));
        assert_close(found.stiffness(), expected.stiffness(), 1e-12);
        assert_close(found.mass(), expected.mass(), 1e-12);
        assert_close(found.gyroscopic(), expected.gyroscopic(), 1e-12);
    }
}

#[test]
fn rigid_motion_of_any_size_makes_no_elastic_force() {
    for component in components() {
        let mut situation = Situation::random(&component, 0.0, 3);
        situation.amplitudes.fill(0.0);
        for angle in [0.1, 3.0, PI, 6.0] {
            let motion = Motion::exp(&[10.0, -20.0, 5.0, 0.6 * angle, 0.0, 0.8 * angle]);
            situation.motions.fill(motion);
            let workspace = situation.evaluated(&component);
            let limit = 1e-12 * largest(component.reference_stiffness());
            assert!(largest(workspace.elastic_forces()) <= limit, "{:?}", workspace.elastic_forces());
        }
    }
}

/// The force and moment on the material points of the nodes do not depend on where the origin is.
#[test]
fn the_origin_does_not_matter() {
    let shift = [50.0, -30.0, 20.0];
    let nodes = beam::arc_nodes();
    let moved: Vec<[f64; 3]> = nodes.iter().map(|x| std::array::from_fn(|i| x[i] + shift[i])).collect();
    let make = |nodes: &[[f64; 3]]| {
        let superelement = beam::reduced(nodes, &beam::SOFT, &[0, 8], 4).superelement;
        ModalComponent::new(&superelement, FloatingFrame::MassWeighted).expect("a free body")
    };
    let (near, far) = (make(&nodes), make(&moved));
    let situation = Situation::random(&near, 0.2, 4);
    // H' = T H T⁻¹ with T the shift; velocities by the motion tensor of T.
    let t = Motion { translation: shift, ..Motion::IDENTITY };
    let mut seen = situation.clone();
    seen.motions.iter_mut().for_each(|motion| *motion = t.compose(motion).compose(&t.inverse()));
    for values in [&mut seen.velocities, &mut seen.accelerations] {
        for six in values[..12].as_chunks_mut::<6>().0 {
            let turned = cross(&shift, &[six[3], six[4], six[5]]);
            (0..3).for_each(|i| six[i] += turned[i]);
        }
    }
    let at_nodes = |component: &ModalComponent, forces: &[f64]| -> Vec<f64> {
        let mut forces = forces.to_vec();
        for (six, x) in forces[..12].as_chunks_mut::<6>().0.iter_mut().zip(component.positions()) {
            let lever = cross(x, &[six[0], six[1], six[2]]);
            (0..3).for_each(|i| six[3 + i] -= lever[i]);
        }
        forces
    };
    let (near_results, far_results) = (situation.evaluated(&near), seen.evaluated(&far));
    for of in [Workspace::elastic_forces, Workspace::inertial_forces] {
        // The stiffness of rotations about an origin sixty away is 3600 · 1e4, its rounding 1e-8 of forces of order ten.
        assert_close(&at_nodes(&far, of(&far_results)), &at_nodes(&near, of(&near_results)), 1e-9);
    }
}

#[test]
fn the_history_of_a_workspace_does_not_matter() {
    for component in components() {
        let (first, second) = (Situation::random(&component, 0.2, 5), Situation::random(&component, 0.2, 6));
        let mut workspace = first.evaluated(&component);
        component.evaluate(&second.state(), &mut workspace).expect("a moderate deformation");
        let expected = second.evaluated(&component);
        assert_close(workspace.inertial_forces(), expected.inertial_forces(), 1e-11);
        // Frames that another program may have kept: those of the nodes, and the right one.
        for start in second.motions.iter().chain([expected.floating_frame()]) {
            workspace.set_floating_frame(start);
            component.evaluate(&second.state(), &mut workspace).expect("a moderate deformation");
            assert_close(workspace.inertial_forces(), expected.inertial_forces(), 1e-11);
        }
    }
}

#[test]
fn a_beam_finds_its_frame_from_anywhere() {
    let component = arc();
    for seed in 0..50 {
        let situation = Situation::random(&component, 0.1, seed);
        let expected = situation.evaluated(&component);
        let mut workspace = component.workspace();
        workspace.set_floating_frame(&SplitMix64::new(seed).motion(3.0));
        component.evaluate(&situation.state(), &mut workspace).expect("a moderate deformation");
        assert_same_results(&workspace, &expected, 1e-11);
    }
}

#[test]
fn an_evaluation_after_an_error_is_as_good_as_new() {
    let component = arc();
    let good = Situation::random(&component, 0.2, 8);
    let mut bad = good.clone();
    bad.motions[1] = bad.motions[0].compose(&Motion::exp(&[0.0, 0.0, 0.0, 0.0, 0.0, 2.0 * PI - 1e-9]));
    bad.motions[1] = bad.motions[1].compose(&Motion::exp(&[0.0, 0.0, 0.0, 0.0, PI, 0.0]));
    bad.amplitudes.fill(10.0);
    let mut workspace = component.workspace();
    assert!(component.evaluate(&bad.state(), &mut workspace).is_err());
    component.evaluate(&good.state(), &mut workspace).expect("a moderate deformation");
    assert_same_results(&workspace, &good.evaluated(&component), 1e-11);
}

#[test]
fn threads_share_a_component_and_get_the_same_bits() {
    let component = arc();
    let situations: Vec<Situation> = (0..32).map(|seed| Situation::random(&component, 0.2, seed)).collect();
    let forces = |part: &[Situation]| -> Vec<Vec<f64>> {
        part.iter().map(|situation| situation.evaluated(&component).inertial_forces().to_vec()).collect()
    };
    let alone = forces(&situations);
    let together: Vec<Vec<f64>> = std::thread::scope(|scope| {
        let threads: Vec<_> = situations.chunks(8).map(|part| scope.spawn(move || forces(part))).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("no panic")).collect()
    });
    assert_eq!(alone, together);
}

#[test]
fn components_and_workspaces_may_go_to_other_threads() {
    fn check<T: Send + Sync>() {}
    check::<Superelement>();
    check::<ModalComponent>();
    check::<Workspace>();
}

fn refusal(component: &ModalComponent, state: &State<'_>) -> EvaluationError {
    let error = component.evaluate(state, &mut component.workspace()).expect_err("an invalid state");
    assert_eq!(component.tangents(state, &mut component.workspace()), Err(error.clone()));
    assert_eq!(component.exact_tangents(state, &mut component.workspace()), Err(error.clone()));
    error
}

#[test]
fn arguments_of_the_wrong_length_are_refused() {
    let component = arc();
    let situation = Situation::random(&component, 0.1, 9);
    let state = situation.state();
    let wrong = |what, found, expected| EvaluationError::WrongLength { what, found, expected };
    let short = State { motions: &state.motions[1..], ..state };
    assert_eq!(refusal(&component, &short), wrong("motions of nodes", 1, 2));
    let short = State { amplitudes: &state.amplitudes[1..], ..state };
    assert_eq!(refusal(&component, &short), wrong("amplitudes", 4, 5));
    let short = State { velocities: &state.velocities[1..], ..state };
    assert_eq!(refusal(&component, &short), wrong("velocities", 16, 17));
    let short = State { accelerations: &[], ..state };
    assert_eq!(refusal(&component, &short), wrong("accelerations", 0, 17));
}

/// A workspace that has the same size holds the results of another body all the same.
#[test]
fn the_workspace_of_another_component_is_refused() {
    let (component, same_size) = (arc(), arc());
    let smaller = ModalComponent::new(&beam::arc(2).superelement, FloatingFrame::Rigid).expect("a free body");
    let situation = Situation::random(&component, 0.1, 9);
    let refused = Err(EvaluationError::ForeignWorkspace);
    for other in [&smaller, &same_size] {
        let mut workspace = other.workspace();
        assert_eq!(component.evaluate(&situation.state(), &mut workspace), refused);
        assert_eq!(component.tangents(&situation.state(), &mut workspace), refused);
        assert_eq!(component.exact_tangents(&situation.state(), &mut workspace), refused);
        let g = [0.0, 0.0, -9.81];
        assert_eq!(component.gravity_forces(&g, &mut workspace), Err(EvaluationError::ForeignWorkspace));
        assert_eq!(component.gravity_potential(&g, &workspace), Err(EvaluationError::ForeignWorkspace));
        assert_eq!(component.add_gravity_stiffness(&g, &mut workspace, &mut [0.0; 289]), refused);
        assert_eq!(component.recover(&workspace, &[], &mut []), refused);
        // Its own component finds it unharmed.
        assert!(other.gravity_forces(&g, &mut workspace).is_ok());
    }
    // A copy of a component is the same component, and so is a copy of a workspace.
    let mut workspace = component.workspace().clone();
    assert_eq!(component.clone().evaluate(&situation.state(), &mut workspace), Ok(()));
}

/// After a failure there are no results to ask further questions of.
#[test]
fn a_workspace_without_a_state_is_refused_until_the_next_evaluation() {
    let component = arc();
    let good = Situation::random(&component, 0.1, 9);
    let mut bad = good.clone();
    bad.velocities[2] = f64::NAN;
    let mut huge = good.clone();
    huge.velocities.iter_mut().for_each(|v| *v *= 1.7e308);
    let g = [0.0, 0.0, -9.81];
    let mut workspace = component.workspace();
    type Evaluate = fn(&ModalComponent, &State<'_>, &mut Workspace) -> Result<(), EvaluationError>;
    let evaluations: [Evaluate; 3] =
        [ModalComponent::evaluate, ModalComponent::tangents, ModalComponent::exact_tangents];
    for (evaluate, state) in evaluations.into_iter().flat_map(|evaluate| [(evaluate, &bad), (evaluate, &huge)]) {
        assert!(evaluate(&component, &state.state(), &mut workspace).is_err());
        let refused = Err(EvaluationError::NoState);
        assert_eq!(component.gravity_forces(&g, &mut workspace), Err(EvaluationError::NoState));
        assert_eq!(component.gravity_potential(&g, &workspace), Err(EvaluationError::NoState));
        assert_eq!(component.add_gravity_stiffness(&g, &mut workspace, &mut [0.0; 289]), refused);
        assert_eq!(component.recover(&workspace, &[], &mut []), refused);
        evaluate(&component, &good.state(), &mut workspace).expect("a moderate deformation");
        assert!(component.gravity_forces(&g, &mut workspace).is_ok());
    }
}

#[test]
fn a_floating_frame_that_is_no_motion_is_refused_and_forgotten() {
    let component = arc();
    let situation = Situation::random(&component, 0.2, 8);
    let expected = situation.evaluated(&component);
    let mut stretched = Motion::IDENTITY;
    stretched.rotation[0][0] = 1.1;
    let infinite = Motion { translation: [0.0, f64::INFINITY, 0.0], ..Motion::IDENTITY };
    let empty = Motion { rotation: [[f64::NAN; 3]; 3], ..Motion::IDENTITY };
    let mut workspace = component.workspace();
    for frame in [stretched, infinite, empty] {
        workspace.set_floating_frame(&frame);
        assert_eq!(component.evaluate(&situation.state(), &mut workspace), Err(EvaluationError::InvalidFrame));
        component.evaluate(&situation.state(), &mut workspace).expect("a moderate deformation");
        assert_same_results(&workspace, &expected, 1e-11);
    }
}

/// A node whose rotation has drifted within the tolerance hands its drift to the frame that it carries, once for each
/// evaluation: after 1e5 of them (1 + 2e-7)^1e5 = 1.02 would be left of it.
#[test]
fn a_drifted_node_does_not_stretch_the_frame() {
    let component = arc();
    for drift in [1e-9, 2e-7] {
        let mut situation = Situation::random(&component, 0.2, 9);
        situation.motions[0].rotation.as_flattened_mut().iter_mut().for_each(|x| *x *= 1.0 + drift);
        let expected = situation.evaluated(&component);
        let mut workspace = component.workspace();
        for _ in 0..100_000 {
            component.evaluate(&situation.state(), &mut workspace).expect("a moderate deformation");
        }
        // The drift left is 1.5 (2e-7)² = 6e-14, of positions of order one; a stiffness whose eigenvalues are 1e3 apart
        // makes 1e-10 of the forces of it, and deformations of 0.2 another digit.
        assert_same_results(&workspace, &expected, 1e-9);
    }
}

/// Displacements lose digits with the distance, but nothing else goes wrong.
#[test]
fn a_component_may_go_far() {
    let component = arc();
    for distance in [1e3, 1e6, 1e9] {
        let mut situation = Situation::random(&component, 0.1, 12);
        let near = situation.evaluated(&component);
        situation.motions.iter_mut().for_each(|motion| motion.translation[0] += distance);
        let far = situation.evaluated(&component);
        // Displacements rounded at 1e-16 of the distance, against deformations of 0.1 and a stiffness whose largest and
        // smallest eigenvalues are 1e3 apart.
        assert_close(far.elastic_forces(), near.elastic_forces(), 1e-12 + 1e-12 * distance);
    }
}

#[test]
fn values_that_are_not_finite_are_refused() {
    let component = arc();
    let good = Situation::random(&component, 0.1, 10);
    let refused = |change: &dyn Fn(&mut Situation)| {
        let mut bad = good.clone();
        change(&mut bad);
        refusal(&component, &bad.state())
    };
    let not_finite = |what, index| EvaluationError::NotFinite { what, index };
    assert_eq!(refused(&|bad| bad.amplitudes[2] = f64::NAN), not_finite("amplitudes", 2));
    assert_eq!(refused(&|bad| bad.velocities[3] = f64::INFINITY), not_finite("velocities", 3));
    assert_eq!(refused(&|bad| bad.accelerations[16] = f64::NAN), not_finite("accelerations", 16));
    assert_eq!(refused(&|bad| bad.motions[1].translation[2] = f64::NAN), not_finite("translations of nodes", 5));
    assert_eq!(refused(&|bad| bad.motions[1].rotation[0][0] = f64::NAN), EvaluationError::NotRotation { node: 1 });
    let mirror = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
    assert_eq!(refused(&|bad| bad.motions[0].rotation = mirror), EvaluationError::NotRotation { node: 0 });
}

#[test]
fn half_a_turn_between_nodes_is_an_error_and_not_a_number() {
    let superelement = beam::arc(0).superelement;
    let component = ModalComponent::new(&superelement, FloatingFrame::Rigid).expect("a free body");
    let mut situation = Situation::random(&component, 0.0, 11);
    let half_turn = Motion::exp(&[0.0, 0.0, 0.0, 0.0, PI, 0.0]);
    situation.motions[1] = situation.motions[0].compose(&half_turn);
    let mut workspace = component.workspace();
    workspace.set_floating_frame(&situation.motions[0]);
    let outcome = component.evaluate(&situation.state(), &mut workspace);
    assert!(matches!(outcome, Err(EvaluationError::HalfTurn { .. })), "{outcome:?}");
}

#[test]
fn velocities_whose_square_is_no_number_are_refused() {
    let component = arc();
    let mut situation = Situation::random(&component, 0.1, 13);
    situation.velocities.iter_mut().for_each(|v| *v *= 1e200);
    let outcome = component.evaluate(&situation.state(), &mut component.workspace());
    assert!(matches!(outcome, Err(EvaluationError::Overflow { .. })), "{outcome:?}");
}

#[test]
fn states_of_any_finite_size_give_finite_results_or_an_error() {
    let component = arc();
    let mut workspace = component.workspace();
    let mut outcomes = [0, 0];
    for seed in 0..200 {
        for (size, speed) in
            [1e-300_f64, 1e-3, 1.0, 3.0, 1e3, 1e150].into_iter().zip([1.0, 1e200, 1e100, 1.0, 1e308, 1.0])
        {
            let mut situation = Situation::random(&component, 1.0, seed);
            let mut random = SplitMix64::new(seed);
            situation.motions.iter_mut().for_each(|motion| *motion = random.motion(size.min(3.0)));
            situation.motions.iter_mut().for_each(|motion| motion.translation = random.vector_3(size));
            situation.amplitudes = random.vector(5, size);
            situation.velocities = random.vector(17, speed);
            let energies = |workspace: &Workspace| vec![workspace.strain_energy(), workspace.kinetic_energy()];
            let finite = |results: &[&[f64]]| results.iter().all(|values| values.iter().all(|x| x.is_finite()));
            match component.evaluate(&situation.state(), &mut workspace) {
                Ok(()) => {
                    outcomes[0] += 1;
                    let forces = [workspace.elastic_forces(), workspace.inertial_forces(), workspace.damping_forces()];
                    assert!(finite(&[workspace.deformation(), workspace.deformation_rate(), &energies(&workspace)]));
                    assert!(finite(&forces), "{forces:?}");
                }
                Err(_) => outcomes[1] += 1,
            }
            if component.tangents(&situation.state(), &mut workspace).is_ok() {
                assert!(finite(&[workspace.stiffness(), workspace.mass(), workspace.gyroscopic()]));
            }
            if component.exact_tangents(&situation.state(), &mut workspace).is_ok() {
                assert!(finite(&[workspace.exact_stiffness(), workspace.frame_momentum()]));
            }
        }
    }
    assert!(outcomes.iter().all(|count| *count > 100), "both happen: {outcomes:?}");
}

#[test]
fn the_frame_is_found_for_any_deformation_a_component_is_made_for() {
    let superelement = beam::arc(5).superelement;
    for frame in [FloatingFrame::MassWeighted, FloatingFrame::Rigid] {
        let component = ModalComponent::new(&superelement, frame).expect("a free body");
        for seed in 0..100 {
            // Nodes turned by up to 1.7 rad against each other.
            let situation = Situation::random(&component, 0.5, seed);
            let outcome = component.evaluate(&situation.state(), &mut component.workspace());
            assert_eq!(outcome, Ok(()), "seed {seed}");
        }
    }
}
