//! The exact tangent against differences of the component's own forces.

use supel_runtime::component::{DeadLoad, ModalComponent, Workspace};
use supel_runtime::motion::{Motion, join, transposed_times_3, velocity_to_point};

use crate::beam;
use crate::situation::{CHOICES, Situation, assert_close, central_difference, components, largest, times, units};
use supel_models::SplitMix64;

/// Nodes turn by up to 0.8 rad against each other.
const LARGE: f64 = 0.25;

/// All forces of the component, f_E + f_I + f_D.
fn forces(workspace: &Workspace) -> Vec<f64> {
    let sums = workspace.elastic_forces().iter().zip(workspace.inertial_forces()).zip(workspace.damping_forces());
    sums.map(|((elastic, inertial), damping)| elastic + inertial + damping).collect()
}

/// Every column, in every choice of frame and measures, for components with symmetric and unsymmetric damping.
#[test]
fn the_exact_stiffness_is_the_derivative_of_all_forces() {
    for component in components() {
        let (r, situation) = (component.n_coordinates(), Situation::random(&component, LARGE, 20));
        let workspace = situation.exact_tangents(&component);
        let mut expected = vec![0.0; r * r];
        for (j, unit) in units(r).iter().enumerate() {
            let column = central_difference(1e-5, |s| forces(&situation.moved(s, unit).evaluated(&component)));
            column.iter().enumerate().for_each(|(i, value)| expected[i * r + j] = *value);
        }
        // Truncation of 1e-10 times third derivatives, rounding of 1e-11.
        assert_close(workspace.exact_stiffness(), &expected, 1e-8);
    }
}

/// f(s) − f(−s) − 2 s K d is of the third order: halved steps leave an eighth, a quarter of the difference quotient, down to
/// rounding. A wrong K would leave a constant.
#[test]
fn the_error_of_differences_falls_with_the_square_of_the_step() {
    for component in components().iter().filter(|component| component.n_nodes() > 1) {
        let situation = Situation::random(component, LARGE, 21);
        let direction = SplitMix64::new(22).vector(component.n_coordinates(), 1.0);
        let expected = times(situation.exact_tangents(component).exact_stiffness(), &direction);
        let error = |step: f64| {
            let found = central_difference(step, |s| forces(&situation.moved(s, &direction).evaluated(component)));
            let differences: Vec<f64> = found.iter().zip(&expected).map(|(x, y)| x - y).collect();
            largest(&differences) / largest(&expected)
        };
        // Terms of fifth order: some step² of those of third order.
        let errors = [8e-3, 4e-3, 2e-3, 1e-3].map(error);
        for pair in errors.windows(2) {
            assert!((3.8..4.2).contains(&(pair[0] / pair[1])), "{errors:?}");
        }
        assert!(error(1e-5) < 1e-8, "{:e}", error(1e-5));
    }
}

#[test]
fn exact_tangents_are_evaluation_and_tangents_too() {
    for component in components() {
        let situation = Situation::random(&component, LARGE, 23);
        let (found, forces, tangents) =
            (situation.exact_tangents(&component), situation.evaluated(&component), situation.tangents(&component));
        assert_eq!(found.elastic_forces(), forces.elastic_forces());
        assert_eq!(found.inertial_forces(), forces.inertial_forces());
        assert_eq!(found.damping_forces(), forces.damping_forces());
        assert_eq!(found.kinetic_energy(), forces.kinetic_energy());
        assert_eq!(found.dissipated_power(), forces.dissipated_power());
        assert_eq!(found.stiffness(), tangents.stiffness());
        assert_eq!((found.mass(), found.gyroscopic()), (tangents.mass(), tangents.gyroscopic()));
        assert_eq!(found.damping(), tangents.damping());
        assert_eq!(found.frame_gyroscopic(), tangents.frame_gyroscopic());
    }
}

/// At rest without deformation there are no forces, and the exact stiffness is the paper's.
#[test]
fn at_rest_without_deformation_it_is_the_papers() {
    for component in components() {
        let mut situation = Situation::random(&component, 0.0, 24);
        situation.amplitudes.fill(0.0);
        situation.velocities.fill(0.0);
        situation.accelerations.fill(0.0);
        let workspace = situation.exact_tangents(&component);
        // Deformation of order 1e-16 times the stiffness of its neighbours.
        assert_close(workspace.exact_stiffness(), component.reference_stiffness(), 1e-12);
        assert_eq!(component.workspace().exact_stiffness(), component.reference_stiffness());
    }
}

/// In statics K_T leaves out just the geometric part, of the order of the deformation.
#[test]
fn the_papers_stiffness_lacks_the_geometric_part() {
    for component in components().iter().filter(|component| component.n_nodes() > 1) {
        let missing = [LARGE, 0.5 * LARGE].map(|size| {
            let mut situation = Situation::random(component, size, 25);
            situation.velocities.fill(0.0);
            situation.accelerations.fill(0.0);
            let workspace = situation.exact_tangents(component);
            let pairs = workspace.exact_stiffness().iter().zip(workspace.stiffness());
            largest(&pairs.map(|(exact, papers)| exact - papers).collect::<Vec<_>>()) / largest(workspace.stiffness())
        });
        assert!(missing[0] > 0.01, "{missing:?}");
        // Of first order, with terms of second.
        assert!((1.5..2.7).contains(&(missing[0] / missing[1])), "{missing:?}");
    }
}

/// A superposed rigid motion changes no force of a body that is seen with its velocities.
#[test]
fn rigid_increments_change_no_force() {
    for component in components() {
        let situation = Situation::random(&component, LARGE, 26);
        let spatial = SplitMix64::new(27).vector_6(1.0);
        // The material increment of a spatial one: C(H)⁻¹.
        let mut direction = vec![0.0; component.n_coordinates()];
        for (target, motion) in direction.as_chunks_mut::<6>().0.iter_mut().zip(&situation.motions) {
            let at_place = velocity_to_point(&motion.translation, &spatial);
            let turned =
                |first: usize| transposed_times_3(&motion.rotation, &std::array::from_fn(|i| at_place[first + i]));
            *target = join(&turned(0), &turned(3));
        }
        let workspace = situation.exact_tangents(&component);
        let change = times(workspace.exact_stiffness(), &direction);
        assert!(
            largest(&change) <= 1e-12 * largest(workspace.exact_stiffness()) * direction.len() as f64,
            "{change:?}"
        );
    }
}

#[test]
fn a_superposed_rigid_motion_changes_nothing() {
    for component in components().iter().filter(|component| component.n_nodes() > 1) {
        let situation = Situation::random(component, 0.2, 1);
        let carrier = SplitMix64::new(2).motion(3.0);
        let mut carried = situation.clone();
        carried.motions.iter_mut().for_each(|motion| *motion = carrier.compose(motion));
        let (found, expected) = (carried.exact_tangents(component), situation.exact_tangents(component));
        assert_close(found.exact_stiffness(), expected.exact_stiffness(), 1e-12);
    }
}

/// What earlier evaluations left in the scratch does not matter.
#[test]
fn the_history_of_a_workspace_does_not_matter() {
    for component in components() {
        let (first, second) = (Situation::random(&component, 0.2, 5), Situation::random(&component, 0.2, 6));
        let mut workspace = first.exact_tangents(&component);
        workspace.set_floating_frame(&second.motions[0]);
        let mut fresh = component.workspace();
        fresh.set_floating_frame(&second.motions[0]);
        for workspace in [&mut workspace, &mut fresh] {
            component.exact_tangents(&second.state(), workspace).expect("a moderate deformation");
        }
        assert_eq!(workspace.exact_stiffness(), fresh.exact_stiffness());
    }
}

/// Newton's method on a free beam under a large dead force at both ends: the residual squares, where the paper's tangent takes
/// a constant share of it.
#[test]
fn newtons_method_converges_quadratically() {
    let superelement = beam::arc(2).superelement;
    for (frame, measures) in CHOICES {
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        let steps = |exact| newton(&component, exact);
        let (own, papers) = (steps(Stiffness::Exact), steps(Stiffness::Papers));
        let last = own.len() - 1;
        // Below 1e-13 of the forces is rounding.
        assert!(own[last] < 1e-13 && own.len() <= 8, "{own:?}");
        assert!(own[last] < 10.0 * own[last - 1].powf(1.7).max(1e-13), "{own:?}");
        assert!(papers.len() > 2 * own.len(), "{papers:?}");
    }
}

#[derive(Clone, Copy)]
enum Stiffness {
    Exact,
    Papers,
}

/// Relative residuals of the iterations, node 0 clamped and node 1 pulled.
fn newton(component: &ModalComponent, stiffness: Stiffness) -> Vec<f64> {
    let load = DeadLoad { node: 1, force: [5.0, -8.0, 12.0], moment: [0.0; 3] };
    let r = component.n_coordinates();
    let mut situation = Situation::random(component, 0.0, 1);
    situation.motions.fill(Motion::IDENTITY);
    situation.amplitudes.fill(0.0);
    situation.velocities.fill(0.0);
    situation.accelerations.fill(0.0);
    let mut residuals = Vec::new();
    for _ in 0..100 {
        let workspace = situation.exact_tangents(component);
        let mut external = vec![0.0; r];
        component.add_load(&load, &situation.motions, &mut external).expect("a node");
        let mut tangent = match stiffness {
            Stiffness::Exact => workspace.exact_stiffness().to_vec(),
            Stiffness::Papers => workspace.stiffness().to_vec(),
        };
        component.add_load_stiffness(&load, &situation.motions, &mut tangent).expect("a node");
        let residual: Vec<f64> = (6..r).map(|i| external[i] - workspace.elastic_forces()[i]).collect();
        residuals.push(largest(&residual) / largest(&external));
        if residuals.last().is_some_and(|last| *last < 1e-13) {
            break;
        }
        let data = (6..r).flat_map(|i| (6..r).map(move |j| (i, j))).map(|(i, j)| tangent[i * r + j]).collect();
        let change = beam::Square { n: r - 6, data }.solve(&residual);
        situation = situation.moved(1.0, &[vec![0.0; 6], change].concat());
    }
    residuals
}
