//! Forces and tangents against energies and differences.

use supel_runtime::component::{Measures, ModalComponent};
use supel_runtime::motion::{check, hat, times_6, transposed_times_6};

use crate::situation::{
    CHOICES, Situation, assert_close, central_difference, components, dot, file_matrix, gradient, largest,
    superelements, times, units,
};
use supel_models::SplitMix64;

/// Deformation in the tests, rad and length, of each entry at each node: nodes turn by up to 0.8 rad against each other.
const LARGE: f64 = 0.25;

/// Central differences at this step have truncation errors of 1e-10 times third derivatives, rounding of 1e-11.
const STEP: f64 = 1e-5;
const DIFFERENCE_TOLERANCE: f64 = 1e-8;

fn difference(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    central_difference(STEP, f)
}

#[test]
fn elastic_forces_are_the_gradient_of_the_strain_energy() {
    for component in components().iter().filter(|component| component.n_nodes() > 1) {
        let situation = Situation::random(component, LARGE, 1);
        let expected = gradient(STEP, &situation, |moved| moved.evaluated(component).strain_energy());
        assert_close(situation.evaluated(component).elastic_forces(), &expected, DIFFERENCE_TOLERANCE);
    }
}

#[test]
fn the_deformation_satisfies_the_condition_of_the_floating_frame() {
    for superelement in superelements() {
        for (frame, measures) in [CHOICES[0], CHOICES[1]] {
            let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
            let workspace = Situation::random(&component, LARGE, 2).evaluated(&component);
            let (k, r) = (component.n_nodes(), component.n_coordinates());
            let e = workspace.deformation();
            // Y = M̂Û or Û in the coordinates of the nodes, where Û stacks identities.
            let weighted = match frame {
                supel_runtime::component::FloatingFrame::MassWeighted => times(component.reference_mass(), e),
                supel_runtime::component::FloatingFrame::Rigid => e.to_vec(),
            };
            for a in 0..6 {
                let sum: f64 = (0..k).map(|j| weighted[6 * j + a]).sum();
                // Sums of r products rounded at 1e-16, and the search ends at 1e-14.
                assert!(sum.abs() <= 1e-13 * largest(component.reference_mass()) * r as f64, "row {a}: {sum:e}");
            }
        }
    }
}

#[test]
fn deformation_rate_and_frame_velocity_are_derivatives() {
    for component in components() {
        let situation = Situation::random(&component, LARGE, 3);
        let workspace = situation.evaluated(&component);
        let moved = |s: f64| situation.moved(s, &situation.velocities).evaluated(&component);
        let expected = difference(|s| moved(s).deformation().to_vec());
        let scale = largest(&situation.velocities);
        for (x, y) in workspace.deformation_rate().iter().zip(&expected) {
            assert!((x - y).abs() <= DIFFERENCE_TOLERANCE * scale, "{x} instead of {y}");
        }
        let h = workspace.floating_frame();
        let expected = difference(|s| h.relative(moved(s).floating_frame()).parameters().expect("small").to_vec());
        assert_close(workspace.frame_velocity(), &expected, DIFFERENCE_TOLERANCE);
    }
}

#[test]
fn kinetic_energy_is_that_of_the_mass_matrix() {
    for component in components() {
        let situation = Situation::random(&component, LARGE, 4);
        let v = &situation.velocities;
        let expected = 0.5 * dot(v, &times(situation.tangents(&component).mass(), v));
        assert_close(&[situation.evaluated(&component).kinetic_energy()], &[expected], 1e-13);
    }
}

/// d/dt ∂T/∂v − v̂ᵀ ∂T/∂v − ∂T/∂q.
#[test]
fn inertial_forces_are_those_of_the_euler_lagrange_equation() {
    for component in components() {
        let situation = Situation::random(&component, LARGE, 5);
        let (v, a) = (&situation.velocities, &situation.accelerations);
        let momentum = |at: &Situation| times(at.tangents(&component).mass(), &at.velocities);
        // To second order in time the material velocity on this path is v + s a.
        let path: Vec<Vec<f64>> = [STEP, -STEP]
            .iter()
            .map(|s| {
                let way: Vec<f64> = v.iter().zip(a).map(|(v, a)| v + 0.5 * s * a).collect();
                let mut moved = situation.moved(*s, &way);
                moved.velocities.iter_mut().zip(a).for_each(|(v, a)| *v += s * a);
                momentum(&moved)
            })
            .collect();
        let by_place = gradient(STEP, &situation, |moved| moved.evaluated(&component).kinetic_energy());
        let p = momentum(&situation);
        let mut expected: Vec<f64> =
            (0..p.len()).map(|i| (path[0][i] - path[1][i]) / (2.0 * STEP) - by_place[i]).collect();
        for j in 0..component.n_nodes() {
            let six = |x: &[f64]| std::array::from_fn(|i| x[6 * j + i]);
            let turning = transposed_times_6(&hat(&six(v)), &six(&p));
            (0..6).for_each(|i| expected[6 * j + i] -= turning[i]);
        }
        assert_close(situation.evaluated(&component).inertial_forces(), &expected, DIFFERENCE_TOLERANCE);
    }
}

#[test]
fn mass_and_gyroscopic_matrix_are_derivatives_of_the_inertial_forces() {
    for component in components() {
        let situation = Situation::random(&component, LARGE, 6);
        let tangents = situation.tangents(&component);
        let direction = SplitMix64::new(60).vector(component.n_coordinates(), 1.0);
        let forces = |change: &dyn Fn(&mut Situation)| {
            let mut changed = situation.clone();
            change(&mut changed);
            changed.evaluated(&component).inertial_forces().to_vec()
        };
        let add = |x: &mut [f64], s: f64| x.iter_mut().zip(&direction).for_each(|(x, d)| *x += s * d);
        let expected = difference(|s| forces(&|changed| add(&mut changed.accelerations, s)));
        assert_close(&times(tangents.mass(), &direction), &expected, DIFFERENCE_TOLERANCE);
        let expected = difference(|s| forces(&|changed| add(&mut changed.velocities, s)));
        assert_close(&times(tangents.gyroscopic(), &direction), &expected, DIFFERENCE_TOLERANCE);
    }
}

/// −Qᵀ[V̂_FᵀM_F + P̌_F]Q without deformation, where Q = M_F⁻¹UᵀM.
#[test]
fn the_frame_part_of_the_gyroscopic_matrix_is_the_papers() {
    for superelement in superelements() {
        let (frame, measures) = CHOICES[0];
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        let mut situation = Situation::random(&component, 0.0, 7);
        situation.amplitudes.fill(0.0);
        let workspace = situation.tangents(&component);
        let v_f = workspace.frame_velocity();
        let m_f = component.rigid_mass();
        // The velocity of the frame for each unit velocity.
        let q: Vec<[f64; 6]> = units(component.n_coordinates())
            .into_iter()
            .map(|velocities| *Situation { velocities, ..situation.clone() }.evaluated(&component).frame_velocity())
            .collect();
        let momentum = times_6(m_f, v_f);
        let r = component.n_coordinates();
        let mut expected = vec![0.0; r * r];
        for (j, column) in q.iter().enumerate() {
            let turned = transposed_times_6(&hat(v_f), &times_6(m_f, column));
            let dragged = times_6(&check(&momentum), column);
            for (i, row) in q.iter().enumerate() {
                expected[i * r + j] = -(0..6).map(|a| row[a] * (turned[a] + dragged[a])).sum::<f64>();
            }
        }
        assert_close(workspace.frame_gyroscopic(), &expected, 1e-12);
    }
}

#[test]
fn tangent_stiffness_is_the_energy_of_the_deformation_rate() {
    for (superelement, component) in superelements().iter().flat_map(|s| CHOICES.map(move |choice| (s, choice))).map(
        |(superelement, (frame, measures))| {
            (superelement, ModalComponent::with_measures(superelement, frame, measures).expect("a free body"))
        },
    ) {
        if component.n_nodes() == 1 {
            continue;
        }
        let k = match component.measures() {
            Measures::MotionBased => component.reference_stiffness().to_vec(),
            Measures::Classical => file_matrix(superelement, |tensors| &tensors.stiffness),
        };
        let situation = Situation::random(&component, LARGE, 8);
        let rates: Vec<Vec<f64>> = units(component.n_coordinates())
            .into_iter()
            .map(|velocities| {
                Situation { velocities, ..situation.clone() }.evaluated(&component).deformation_rate().to_vec()
            })
            .collect();
        let forces: Vec<Vec<f64>> = rates.iter().map(|rate| times(&k, rate)).collect();
        let expected: Vec<f64> = rates.iter().flat_map(|x| forces.iter().map(|f| dot(x, f))).collect();
        assert_close(situation.tangents(&component).stiffness(), &expected, 1e-12);
    }
}

#[test]
fn tangents_without_deformation_are_the_reference_matrices() {
    for component in components() {
        let mut situation = Situation::random(&component, 0.0, 9);
        situation.amplitudes.fill(0.0);
        let workspace = situation.tangents(&component);
        // Deformation of order 1e-16 times the stiffness of its neighbours.
        assert_close(workspace.stiffness(), component.reference_stiffness(), 1e-12);
        assert_close(workspace.mass(), component.reference_mass(), 1e-12);
        if let Some(damping) = component.reference_damping() {
            assert_close(workspace.damping(), damping, 1e-12);
        }
    }
}
