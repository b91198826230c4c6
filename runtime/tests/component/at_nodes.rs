//! Coordinates at the nodes.

use supel_runtime::component::{EvaluationError, FloatingFrame, ModalComponent};
use supel_runtime::motion::{
    Motion, Vector3, force_to_origin, force_to_point, transposed_times_3, velocity_to_origin, velocity_to_point,
};

use crate::beam;
use crate::situation::{Situation, assert_close, central_difference, dot, times};
use supel_models::SplitMix64;

fn arc() -> ModalComponent {
    ModalComponent::new(&beam::arc(3).superelement, FloatingFrame::MassWeighted).expect("a free body")
}

/// The point moves with Rᵀẋ as its material velocity says.
#[test]
fn the_velocity_at_a_point_is_that_of_the_point() {
    let mut random = SplitMix64::new(1);
    let (motion, position, velocity) = (random.motion(1.0), random.vector_3(2.0), random.vector_6(1.0));
    let place = |s: f64| motion.compose(&Motion::exp(&velocity.map(|x| s * x))).apply(&position).to_vec();
    let moved = central_difference(1e-5, place);
    let expected: Vector3 = transposed_times_3(&motion.rotation, &[moved[0], moved[1], moved[2]]);
    let at_point = velocity_to_point(&position, &velocity);
    assert_close(&at_point[..3], &expected, 1e-9);
    assert_eq!(at_point[3..], velocity[3..]);
    assert_close(&velocity_to_origin(&position, &at_point), &velocity, 1e-15);
    // A force does the same work in both.
    let force = random.vector_6(1.0);
    assert_close(&[dot(&force_to_point(&position, &force), &at_point)], &[dot(&force, &velocity)], 1e-14);
    assert_close(&force_to_origin(&position, &force_to_point(&position, &force)), &force, 1e-15);
}

#[test]
fn vectors_and_matrices_keep_power_and_energy() {
    let component = arc();
    let r = component.n_coordinates();
    let situation = Situation::random(&component, 0.2, 3);
    let workspace = situation.tangents(&component);
    let mut random = SplitMix64::new(4);
    let (forces, at_nodes) = (random.vector(r, 1.0), random.vector(r, 1.0));
    let mut velocities = at_nodes.clone();
    component.velocities_to_origin(&mut velocities).expect("all coordinates");
    let mut own_forces = forces.clone();
    component.forces_to_nodes(&mut own_forces).expect("all coordinates");
    assert_close(&[dot(&own_forces, &at_nodes)], &[dot(&forces, &velocities)], 1e-13);
    // An unsymmetric matrix, column by column: SᵀA S x = Sᵀ(A (S x)).
    let mut matrix = workspace.gyroscopic().to_vec();
    component.matrix_to_nodes(&mut matrix).expect("a matrix");
    let mut expected = times(workspace.gyroscopic(), &velocities);
    component.forces_to_nodes(&mut expected).expect("all coordinates");
    assert_close(&times(&matrix, &at_nodes), &expected, 1e-12);
    component.velocities_to_nodes(&mut velocities).expect("all coordinates");
    assert_close(&velocities, &at_nodes, 1e-14);
    assert_eq!(velocities[12..], at_nodes[12..], "amplitudes stay");
}

/// The mass at the nodes is that of the file, whose coordinates are displacements and rotations of the nodes.
#[test]
fn matrices_at_the_nodes_are_those_of_the_file() {
    let superelement = beam::arc(3).superelement;
    let component = ModalComponent::new(&superelement, FloatingFrame::Rigid).expect("a free body");
    for (own, of_file) in [
        (component.reference_mass(), &superelement.tensors().mass),
        (component.reference_stiffness(), &superelement.tensors().stiffness),
    ] {
        let mut matrix = own.to_vec();
        component.matrix_to_nodes(&mut matrix).expect("a matrix");
        assert_close(&matrix, of_file.as_slice(), 1e-12);
    }
    // A node that turns about itself stays where it is.
    let mut turn = vec![0.0; component.n_coordinates()];
    turn[11] = 1.0;
    component.velocities_to_origin(&mut turn).expect("all coordinates");
    let motion = Motion::exp(&std::array::from_fn(|i| turn[6 + i]));
    assert_close(&motion.apply(&component.positions()[1]), &component.positions()[1], 1e-15);
}

#[test]
fn wrong_lengths_are_refused() {
    let component = arc();
    let wrong = |what, found, expected| Err(EvaluationError::WrongLength { what, found, expected });
    let mut short = vec![0.0; 14];
    assert_eq!(component.velocities_to_origin(&mut short), wrong("values of coordinates", 14, 15));
    assert_eq!(component.velocities_to_nodes(&mut short), wrong("values of coordinates", 14, 15));
    assert_eq!(component.forces_to_nodes(&mut short), wrong("values of coordinates", 14, 15));
    assert_eq!(component.matrix_to_nodes(&mut short), wrong("entries of the matrix", 14, 225));
}
