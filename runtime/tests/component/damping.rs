//! Damping matrices, symmetric and not.

use supel_runtime::component::{FloatingFrame, Measures, ModalComponent, Workspace};
use supel_runtime::motion::{Motion, hat, transposed_times_6};
use supel_runtime::{Matrix, Superelement, Tensors};

use crate::beam;
use crate::situation::{
    CHOICES, Situation, assert_close, components, dot, largest, random_skew, times, unsymmetric_deformation,
    unsymmetric_motion,
};

/// Nodes turn by up to 0.8 rad against each other.
const LARGE: f64 = 0.25;

fn damped(damping: fn(&Tensors) -> Matrix) -> Superelement {
    let (mut tensors, metadata) = beam::random_parts(2, 3, 12);
    tensors.damping = Some(damping(&tensors));
    Superelement::new(tensors, metadata).expect("the parts fit")
}

#[test]
fn damping_forces_are_those_of_the_damping_matrix() {
    for component in components() {
        let situation = Situation::random(&component, LARGE, 10);
        let (workspace, v) = (situation.evaluated(&component), &situation.velocities);
        let forces = workspace.damping_forces();
        if component.reference_damping().is_none() {
            assert!(forces.iter().all(|force| *force == 0.0) && workspace.dissipated_power() == 0.0);
            assert!(situation.tangents(&component).damping().is_empty());
            continue;
        }
        assert_close(forces, &times(situation.tangents(&component).damping(), v), 1e-12);
        // All of these have a definite symmetric part.
        assert!(workspace.dissipated_power() > 0.0);
        assert_close(&[dot(forces, v)], &[workspace.dissipated_power()], 1e-11);
    }
}

/// Without deformation a component takes the file's own matrix, row by row, changed to its coordinates.
#[test]
fn the_damping_of_the_file_is_kept_whether_symmetric_or_not() {
    for damping in [unsymmetric_motion, unsymmetric_deformation, |tensors: &Tensors| random_skew(tensors.mass.rows())] {
        let superelement = damped(damping);
        let own = superelement.tensors().damping.as_ref().expect("a damping");
        let positions = &superelement.tensors().interface_positions;
        let r = own.rows();
        // AᵀC A with A = diag(D_1, D_2, I).
        let change = Matrix::from_fn(r, r, |i, j| match (i < 12, j < 12) {
            (true, true) if i / 6 == j / 6 => beam::rigid_motion(&positions[i / 6..=i / 6], i % 6, j % 6),
            _ if i == j => 1.0,
            _ => 0.0,
        });
        let half = Matrix::from_fn(r, r, |i, j| (0..r).map(|c| own[(i, c)] * change[(c, j)]).sum());
        let expected = Matrix::from_fn(r, r, |i, j| (0..r).map(|c| change[(c, i)] * half[(c, j)]).sum());
        for (frame, measures) in CHOICES {
            let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
            assert_close(component.reference_damping().expect("a damping"), expected.as_slice(), 1e-13);
            let mut situation = Situation::random(&component, 0.0, 9);
            situation.amplitudes.fill(0.0);
            assert_close(situation.tangents(&component).damping(), expected.as_slice(), 1e-12);
        }
    }
}

/// A symmetric damping stays symmetric to the bit on its way.
#[test]
fn a_symmetric_damping_has_symmetric_tangents() {
    let superelement = damped(|tensors| tensors.mass.clone());
    for (frame, measures) in CHOICES {
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        let (r, workspace) = (component.n_coordinates(), Situation::random(&component, LARGE, 2).tangents(&component));
        for matrix in [workspace.damping(), component.reference_damping().expect("a damping")] {
            assert!((0..r * r).all(|i| matrix[i] == matrix[i % r * r + i / r]));
        }
    }
}

/// A rotor inside turns the motion and takes no power from it, though its forces are as large as those of any damping.
#[test]
fn a_skew_damping_takes_no_power() {
    let superelement = damped(|tensors| random_skew(tensors.mass.rows()));
    for (frame, measures) in CHOICES {
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        let situation = Situation::random(&component, LARGE, 11);
        let (workspace, v) = (situation.evaluated(&component), &situation.velocities);
        let forces = workspace.damping_forces();
        // Sums of r products of order one.
        let rounding = 1e-14 * dot(v, v) * component.n_coordinates() as f64;
        assert!(largest(forces) > 0.1, "{forces:?}");
        assert!(workspace.dissipated_power().abs() <= rounding, "{:e}", workspace.dissipated_power());
        assert!(dot(forces, v).abs() <= 10.0 * rounding, "{:e}", dot(forces, v));
    }
}

#[test]
fn only_a_damping_of_rigid_motion_brakes_it() {
    for component in components().iter().filter(|component| component.reference_damping().is_some()) {
        let mut situation = Situation::random(component, 0.0, 11);
        situation.amplitudes.fill(0.0);
        situation.velocities.fill(0.0);
        // All nodes with one material velocity.
        (0..6 * component.n_nodes()).for_each(|i| situation.velocities[i] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0][i % 6]);
        let forces = situation.evaluated(component);
        let brake = dot(forces.damping_forces(), &situation.velocities);
        // Three nodes: damped in proportion to the mass, a skew part added or not; two: in proportion to the stiffness.
        match component.n_nodes() {
            3 => assert_close(&[brake], &[2.0 * forces.kinetic_energy()], 1e-12),
            _ => assert!(largest(forces.damping_forces()) <= 1e-13, "{:?}", forces.damping_forces()),
        }
    }
}

/// A rigid body with a rotor inside, which only its own velocity turns.
#[test]
fn a_rotor_in_a_rigid_body_acts_on_its_motion() {
    let (tensors, metadata) = beam::random_parts(1, 0, 3);
    let tensors = Tensors { damping: Some(random_skew(6)), ..tensors };
    let superelement = Superelement::new(tensors, metadata).expect("the parts fit");
    for (frame, measures) in CHOICES {
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        let situation = Situation::random(&component, LARGE, 14);
        let expected = times(component.reference_damping().expect("a damping"), &situation.velocities);
        assert_close(situation.evaluated(&component).damping_forces(), &expected, 1e-12);
    }
}

/// Forces on rigid-body motion that the deformation rate makes, UᵀC without C U: the resultant is there.
#[test]
fn a_damping_that_pushes_the_whole_component_does_so() {
    let (mut tensors, metadata) = beam::random_parts(2, 3, 12);
    let (k, m) = (&tensors.stiffness, &tensors.mass);
    let r = k.rows();
    tensors.damping = Some(Matrix::from_fn(r, r, |i, j| (0..r).map(|c| m[(i, c)] * k[(c, j)]).sum()));
    let superelement = Superelement::new(tensors, metadata).expect("the parts fit");
    let component = ModalComponent::new(&superelement, FloatingFrame::MassWeighted).expect("a free body");
    let mut situation = Situation::random(&component, 0.0, 13);
    situation.motions.fill(Motion::IDENTITY);
    situation.amplitudes.fill(0.0);
    let forces = situation.evaluated(&component).damping_forces().to_vec();
    assert_close(&forces, &times(component.reference_damping().expect("a damping"), &situation.velocities), 1e-12);
    assert!((0..6).any(|a| (forces[a] + forces[6 + a]).abs() > 0.1 * largest(&forces)), "{forces:?}");
}

/// A disk of mass m on a massless isotropic shaft that turns at Ω, damped inside: in turning axes
/// m δ̈ + (c I + 2 m Ω J) δ̇ + (k − m Ω²) δ = 0 of the translations across the axis. In inertial axes the damping is circulatory,
/// −c Ω J: above Ω² = k/m the rotor is unstable in both.
#[test]
fn linearised_rotor_with_inner_damping_has_the_closed_form() {
    let (mass, inertia, stiffness, damping, spin) = (3.0, [0.4, 0.4, 0.7], 50.0, 2.0, 5.0);
    let superelement = rotor(mass, inertia, stiffness, damping);
    // The frame goes with the disk, which has all the mass: nothing is left out.
    let component = ModalComponent::with_measures(&superelement, FloatingFrame::MassWeighted, Measures::MotionBased);
    let component = component.expect("a free body");
    let mut situation = Situation::random(&component, 0.0, 1);
    situation.velocities.fill(0.0);
    situation.accelerations.fill(0.0);
    (situation.velocities[5], situation.velocities[11]) = (spin, spin);
    situation.motions.fill(Motion::exp(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.8]));
    let workspace = situation.exact_tangents(&component);
    let [mut k, mut d, mut m] = linearised(&component, &workspace, &situation.velocities);
    for matrix in [&mut k, &mut d, &mut m] {
        component.matrix_to_nodes(matrix).expect("a matrix");
    }
    let turn = 2.0 * mass * spin;
    let expected = [
        [stiffness - mass * spin * spin, 0.0, 0.0, stiffness - mass * spin * spin],
        [damping, -turn, turn, damping],
        [mass, 0.0, 0.0, mass],
    ];
    for (matrix, expected) in [k, d, m].iter().zip(expected) {
        let across = [(6, 6), (6, 7), (7, 6), (7, 7)].map(|(i, j)| matrix[12 * i + j]);
        assert_close(&across, &expected, 1e-12);
    }
    // The paper's tangent does not know that the rotor is unstable.
    let mut papers = workspace.stiffness().to_vec();
    component.matrix_to_nodes(&mut papers).expect("a matrix");
    assert_close(&[papers[12 * 6 + 6]], &[stiffness], 1e-12);
}

/// K + (G + C) v̂ + M v̇^, G + C + M v̂ and M, for a steady motion.
fn linearised(component: &ModalComponent, workspace: &Workspace, velocities: &[f64]) -> [Vec<f64>; 3] {
    let r = component.n_coordinates();
    let with_velocity = |a: &[f64]| -> Vec<f64> {
        let mut product = vec![0.0; r * r];
        for (row, target) in a.chunks_exact(r).zip(product.chunks_exact_mut(r)) {
            for j in 0..component.n_nodes() {
                let v = hat(&std::array::from_fn(|i| velocities[6 * j + i]));
                let entries: [f64; 6] = std::array::from_fn(|i| row[6 * j + i]);
                let turned = transposed_times_6(&v, &entries);
                target[6 * j..6 * j + 6].copy_from_slice(&turned);
            }
        }
        product
    };
    let sum = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a + b).collect() };
    let by_velocity = sum(workspace.gyroscopic(), workspace.damping());
    let mass = workspace.mass().to_vec();
    [sum(workspace.exact_stiffness(), &with_velocity(&by_velocity)), sum(&by_velocity, &with_velocity(&mass)), mass]
}

/// Hub and disk at one place on the z axis, joined by springs and dampers.
fn rotor(mass: f64, inertia: [f64; 3], stiffness: f64, damping: f64) -> Superelement {
    let join = |value: f64| {
        Matrix::from_fn(12, 12, |i, j| match i % 6 == j % 6 {
            true if i == j => value,
            true => -value,
            false => 0.0,
        })
    };
    // About the place of the disk; the coordinates of the file are those of the nodes.
    let masses = [mass, mass, mass, inertia[0], inertia[1], inertia[2]];
    let mass = Matrix::from_fn(12, 12, |i, j| if i == j && i >= 6 { masses[i - 6] } else { 0.0 });
    let (mut tensors, metadata) = beam::parts(join(stiffness), mass, &[[0.0, 0.0, 0.7]; 2]);
    tensors.damping = Some(join(damping));
    Superelement::new(tensors, metadata).expect("the parts fit")
}
