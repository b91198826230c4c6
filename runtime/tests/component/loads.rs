//! Dead loads on interface nodes.

use supel_runtime::component::{DeadLoad, EvaluationError, FloatingFrame, ModalComponent};
use supel_runtime::motion::{Motion, Vector3, dot, times_3, times_6, transposed_times_3};
use supel_runtime::{Direction, InterfaceDof, Superelement};

use crate::beam;
use crate::situation::{Situation, assert_close};
use supel_models::SplitMix64;

const LOAD: DeadLoad = DeadLoad { node: 1, force: [3.0, -4.0, 5.0], moment: [1.0, 2.0, -3.0] };
const STEP: f64 = 1e-5;

fn arc() -> ModalComponent {
    ModalComponent::new(&beam::arc(2).superelement, FloatingFrame::Rigid).expect("a free body")
}

#[test]
fn a_load_does_the_work_of_its_force_and_moment() {
    let mut random = SplitMix64::new(1);
    let (motion, position, v) = (random.motion(1.0), random.vector_3(2.0), random.vector_6(1.0));
    let moved = |s: f64| motion.compose(&Motion::exp(&v.map(|x| s * x)));
    let (ahead, behind) = (moved(STEP).apply(&position), moved(-STEP).apply(&position));
    let velocity: Vector3 = std::array::from_fn(|i| (ahead[i] - behind[i]) / (2.0 * STEP));
    let moment = transposed_times_3(&motion.rotation, &LOAD.moment);
    let power = dot(&LOAD.force, &velocity) + dot(&moment, &[v[3], v[4], v[5]]);
    let found: f64 = LOAD.in_node(&motion, &position).iter().zip(&v).map(|(f, v)| f * v).sum();
    assert_close(&[found], &[power], 1e-9);
}

#[test]
fn load_stiffness_is_minus_the_derivative_of_the_load() {
    let mut random = SplitMix64::new(2);
    let (motion, position, v) = (random.motion(1.0), random.vector_3(2.0), random.vector_6(1.0));
    let at = |s: f64| LOAD.in_node(&motion.compose(&Motion::exp(&v.map(|x| s * x))), &position);
    let expected: Vec<f64> = (0..6).map(|i| -(at(STEP)[i] - at(-STEP)[i]) / (2.0 * STEP)).collect();
    assert_close(&times_6(&LOAD.stiffness_in_node(&motion, &position), &v), &expected, 1e-9);
}

#[test]
fn loads_add_up_at_their_node() {
    let component = arc();
    let situation = Situation::random(&component, 0.2, 3);
    let (motion, position) = (&situation.motions[1], &component.positions()[1]);
    let (mut forces, mut stiffness) = (vec![1.0; 14], vec![1.0; 14 * 14]);
    for _ in 0..2 {
        component.add_load(&LOAD, &situation.motions, &mut forces).expect("a node of the component");
        component.add_load_stiffness(&LOAD, &situation.motions, &mut stiffness).expect("a node of the component");
    }
    let (f, k) = (LOAD.in_node(motion, position), LOAD.stiffness_in_node(motion, position));
    for i in 0..14 {
        let expected = if (6..12).contains(&i) { 1.0 + f[i - 6] + f[i - 6] } else { 1.0 };
        assert_eq!(forces[i], expected);
        for j in 0..14 {
            let here = (6..12).contains(&i) && (6..12).contains(&j);
            let expected = if here { 1.0 + k[i - 6][j - 6] + k[i - 6][j - 6] } else { 1.0 };
            assert_eq!(stiffness[14 * i + j], expected);
        }
    }
}

#[test]
fn a_load_on_a_dof_declared_unloaded_is_refused() {
    let (tensors, mut metadata, _) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[0, 8], 2);
    metadata.validity.unloaded = vec![InterfaceDof { node: 1, direction: Direction::Ry }];
    let superelement = Superelement::new(tensors, metadata).expect("the parts fit");
    let component = ModalComponent::new(&superelement, FloatingFrame::Rigid).expect("a free body");
    let situation = Situation::random(&component, 0.1, 5);
    let (mut forces, mut stiffness) = (vec![0.0; 14], vec![0.0; 14 * 14]);
    let unloaded = Err(EvaluationError::UnloadedDof { node: 1, direction: Direction::Ry });
    assert_eq!(component.add_load(&LOAD, &situation.motions, &mut forces), unloaded);
    assert_eq!(component.add_load_stiffness(&LOAD, &situation.motions, &mut stiffness), unloaded);
    // Of the other node nothing was said, and forces and moments about the node's other axes are allowed.
    assert_eq!(component.add_load(&DeadLoad { node: 0, ..LOAD }, &situation.motions, &mut forces), Ok(()));
    let about_others = times_3(&situation.motions[1].rotation, &[2.0, 0.0, -3.0]);
    let allowed = DeadLoad { moment: about_others, ..LOAD };
    assert_eq!(component.add_load(&allowed, &situation.motions, &mut forces), Ok(()));
    assert_eq!(component.add_load(&DeadLoad { moment: [0.0; 3], ..LOAD }, &situation.motions, &mut forces), Ok(()));
}

/// A client that moves a force of 1e5 by its lever arm leaves 1e-16 of their product in the moment.
#[test]
fn rounding_of_a_lever_arm_is_no_load() {
    let (tensors, mut metadata, _) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[0, 8], 2);
    metadata.validity.unloaded = vec![InterfaceDof { node: 1, direction: Direction::Ry }];
    let superelement = Superelement::new(tensors, metadata).expect("the parts fit");
    let component = ModalComponent::new(&superelement, FloatingFrame::Rigid).expect("a free body");
    let mut forces = [0.0; 14];
    let mut outcome = |moment: f64| {
        let load = DeadLoad { node: 1, force: [1e5, 0.0, 0.0], moment: [0.0, moment, 0.0] };
        component.add_load(&load, &[Motion::IDENTITY; 2], &mut forces)
    };
    assert_eq!(outcome(1e-13), Ok(()));
    assert_eq!(outcome(1e-3), Err(EvaluationError::UnloadedDof { node: 1, direction: Direction::Ry }));
}

#[test]
fn impossible_loads_are_refused() {
    let component = arc();
    let situation = Situation::random(&component, 0.2, 4);
    let mut forces = [0.0; 14];
    let mut refusal = |load: DeadLoad, length: usize, nodes: usize| {
        component.add_load(&load, &situation.motions[..nodes], &mut forces[..length]).expect_err("an impossible load")
    };
    let stray = DeadLoad { node: 2, ..LOAD };
    assert_eq!(refusal(stray, 14, 2), EvaluationError::UnknownNode { node: 2, n_nodes: 2 });
    let wrong = |what, found, expected| EvaluationError::WrongLength { what, found, expected };
    assert_eq!(refusal(LOAD, 13, 2), wrong("entries of the result", 13, 14));
    assert_eq!(refusal(LOAD, 14, 1), wrong("motions of nodes", 1, 2));
    let infinite = DeadLoad { force: [0.0, f64::INFINITY, 0.0], ..LOAD };
    assert_eq!(refusal(infinite, 14, 2), EvaluationError::NotFinite { what: "force", index: 1 });
    let nothing = DeadLoad { moment: [f64::NAN, 0.0, 0.0], ..LOAD };
    assert_eq!(refusal(nothing, 14, 2), EvaluationError::NotFinite { what: "moment", index: 0 });
    let overflow = |what| EvaluationError::Overflow { what };
    let huge = DeadLoad { force: [1.7e308; 3], ..LOAD };
    assert_eq!(refusal(huge, 14, 2), overflow("load at the origin"));
    let outcome = component.add_load_stiffness(&huge, &situation.motions, &mut vec![0.0; 196]);
    assert_eq!(outcome, Err(overflow("load stiffness")));
    let mut small = vec![0.0; 14];
    let outcome = component.add_load_stiffness(&LOAD, &situation.motions, &mut small);
    assert_eq!(outcome, Err(wrong("entries of the result", 14, 196)));
}
