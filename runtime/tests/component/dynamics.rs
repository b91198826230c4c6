//! Small motion, and a free flight.

use supel_runtime::component::{FloatingFrame, ModalComponent, Workspace};
use supel_runtime::motion::{Motion, Vector6};
use supel_runtime::{Matrix, Superelement};

use crate::beam::{self, Square};
use crate::situation::{CHOICES, Situation, components, largest, random_skew, times};
use supel_models::SplitMix64;

/// For motion of size s the forces are s (K q, M q̈) up to s².
#[test]
fn small_motion_is_that_of_the_linear_reduced_model() {
    for component in components() {
        let errors = [1e-4, 5e-5].map(|size| {
            let mut random = SplitMix64::new(1);
            let direction = random.vector(component.n_coordinates(), 1.0);
            let mut situation = Situation::random(&component, 0.0, 2);
            situation.motions.fill(Motion::IDENTITY);
            situation.amplitudes.fill(0.0);
            let mut moved = situation.moved(size, &direction);
            moved.velocities.iter_mut().for_each(|v| *v *= size);
            moved.accelerations.iter_mut().for_each(|a| *a *= size);
            let workspace = moved.evaluated(&component);
            let error = |found: &[f64], matrix: &[f64], x: &[f64], scale: f64| {
                let expected: Vec<f64> = times(matrix, x).iter().map(|f| scale * f).collect();
                let difference: Vec<f64> = found.iter().zip(&expected).map(|(f, e)| f - e).collect();
                largest(&difference) / largest(&expected).max(f64::MIN_POSITIVE)
            };
            let inertial = error(workspace.inertial_forces(), component.reference_mass(), &moved.accelerations, 1.0);
            let elastic = error(workspace.elastic_forces(), component.reference_stiffness(), &direction, size);
            [elastic, inertial]
        });
        for (coarse, fine) in errors[0].iter().zip(errors[1]) {
            // One node is never deformed, and its amplitudes are linear.
            if component.n_nodes() == 1 && *coarse < 1e-15 {
                continue;
            }
            // Relative errors of first order: halved with the size.
            // Terms of second order have the size 1e-4 and lever arms of at most 3; ten of them.
            assert!(*coarse < 10.0 * 3.0 * 1e-4, "{errors:?}");
            assert!((1.9..2.1).contains(&(coarse / fine)), "{errors:?}");
        }
    }
}

/// Generalised-α on the Lie group, spectral radius at infinity ρ.
struct Integrator<'a> {
    component: &'a ModalComponent,
    workspace: Workspace,
    situation: Situation,
    /// Auxiliary acceleration.
    a: Vec<f64>,
    step: f64,
}

impl Integrator<'_> {
    const RHO: f64 = 1.0;

    fn advance(&mut self) {
        let am = (2.0 * Self::RHO - 1.0) / (Self::RHO + 1.0);
        let af = Self::RHO / (Self::RHO + 1.0);
        let gamma = 0.5 - am + af;
        let beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
        let (h, r) = (self.step, self.a.len());
        let start = self.situation.clone();
        let previous = self.a.clone();
        for _ in 0..20 {
            // (1 − α_m) a₁ + α_m a₀ = (1 − α_f) v̇₁ + α_f v̇₀.
            let now = &self.situation.accelerations;
            self.a = (0..r)
                .map(|i| ((1.0 - af) * now[i] + af * start.accelerations[i] - am * previous[i]) / (1.0 - am))
                .collect();
            let way: Vec<f64> =
                (0..r).map(|i| start.velocities[i] + h * ((0.5 - beta) * previous[i] + beta * self.a[i])).collect();
            let moved = start.moved(h, &way);
            (self.situation.motions, self.situation.amplitudes) = (moved.motions, moved.amplitudes);
            self.situation.velocities =
                (0..r).map(|i| start.velocities[i] + h * ((1.0 - gamma) * previous[i] + gamma * self.a[i])).collect();
            let state = self.situation.state();
            self.component.evaluate(&state, &mut self.workspace).expect("a moderate deformation");
            let (f_e, f_i, f_d) =
                (self.workspace.elastic_forces(), self.workspace.inertial_forces(), self.workspace.damping_forces());
            let residual: Vec<f64> = (0..r).map(|i| f_e[i] + f_i[i] + f_d[i]).collect();
            if largest(&residual) <= 1e-10 * (largest(f_e) + largest(f_i) + 1.0) {
                return;
            }
            self.component.tangents(&state, &mut self.workspace).expect("a moderate deformation");
            let factor = (1.0 - af) / (1.0 - am);
            let (by_place, by_velocity) = (h * h * beta * factor, h * gamma * factor);
            let entry = |i: usize| {
                let w = &self.workspace;
                let damping = w.damping().get(i).unwrap_or(&0.0);
                w.mass()[i] + by_velocity * (w.gyroscopic()[i] + damping) + by_place * w.stiffness()[i]
            };
            let system = Square { n: r, data: (0..r * r).map(entry).collect() };
            let correction = system.solve(&residual);
            self.situation.accelerations.iter_mut().zip(correction).for_each(|(a, c)| *a -= c);
        }
        panic!("no equilibrium");
    }

    fn energy(&self) -> f64 {
        self.workspace.strain_energy() + self.workspace.kinetic_energy()
    }
}

/// What half a second of flight shows, as shares of the energy at the start.
struct Flight {
    /// Largest change of the energy and of what the damping has taken of it, together.
    change: f64,
    /// What the damping has taken.
    taken: f64,
    /// Where node 0 is at the end.
    place: [f64; 3],
}

/// A beam thrown spinning and vibrating.
fn flown(component: &ModalComponent, step: f64) -> Flight {
    let (k, r) = (component.n_nodes(), component.n_coordinates());
    let mut situation = Situation::random(component, 0.0, 3);
    situation.motions.fill(Motion::IDENTITY);
    situation.amplitudes.fill(0.0);
    let spin: Vector6 = [0.5, 0.0, 1.0, 1.0, 2.0, 3.0];
    let mut random = SplitMix64::new(4);
    let stir: Vec<f64> = random.vector(r, 0.02);
    situation.velocities = (0..r).map(|i| if i < 6 * k { spin[i % 6] + stir[i] } else { stir[i] }).collect();
    situation.accelerations.fill(0.0);
    let workspace = situation.evaluated(component);
    // M v̇ = −f_I(v̇ = 0) − f_D without deformation.
    let mass = Square { n: r, data: component.reference_mass().to_vec() };
    let forces = workspace.inertial_forces().iter().zip(workspace.damping_forces());
    let load: Vec<f64> = forces.map(|(inertial, damping)| -inertial - damping).collect();
    situation.accelerations = mass.solve(&load);
    let a = situation.accelerations.clone();
    let mut flight = Integrator { component, workspace, situation, a, step };
    let start = flight.energy();
    let n_steps = (0.5 / step).round() as usize;
    let (mut change, mut taken) = (0.0_f64, 0.0);
    for _ in 0..n_steps {
        let before = flight.workspace.dissipated_power();
        flight.advance();
        taken += 0.5 * step * (before + flight.workspace.dissipated_power());
        change = change.max((flight.energy() + taken - start).abs() / start);
    }
    let place = flight.situation.motions[0].apply(&component.positions()[0]);
    Flight { change, taken: taken / start, place }
}

fn energy_error(component: &ModalComponent, step: f64) -> f64 {
    flown(component, step).change
}

/// Damped by 2e-4 K + M/10 and a rotor's forces, or by those alone.
#[test]
fn damping_takes_the_energy_that_is_missing() {
    let arc = |brake: f64, rotor: f64| {
        let (mut tensors, metadata, _) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[0, 8], 3);
        let (k, m, skew, r) = (&tensors.stiffness, &tensors.mass, random_skew(15), 15);
        let half = Matrix::from_fn(r, r, |i, j| (0..r).map(|c| skew[(i, c)] * m[(c, j)]).sum());
        let turning = |i, j| (0..r).map(|c| m[(i, c)] * half[(c, j)]).sum::<f64>();
        let damping = |i, j| brake * (2e-4 * k[(i, j)] + 0.1 * m[(i, j)]) + rotor * turning(i, j);
        tensors.damping = Some(Matrix::from_fn(r, r, damping));
        let superelement = Superelement::new(tensors, metadata).expect("the parts fit");
        ModalComponent::new(&superelement, FloatingFrame::MassWeighted).expect("a free body")
    };
    let free = flown(&arc(0.0, 0.0), 1e-3);
    for (brake, rotor) in [(1.0, 0.0), (1.0, 3.0), (0.0, 3.0)] {
        let component = arc(brake, rotor);
        let [coarse, fine] = [2e-3, 1e-3].map(|step| flown(&component, step));
        let ratio = coarse.change / fine.change;
        println!("{brake}, {rotor}: {:e} {ratio}, {:e} taken", fine.change, fine.taken);
        // Of the second order, as without damping.
        assert!((3.9..4.1).contains(&ratio), "{brake}, {rotor}: {ratio}");
        // Half a second of a rate of 0.1 takes a tenth of the kinetic energy or less; a rotor takes nothing, but moves the beam.
        match brake {
            0.0 => assert!(fine.taken.abs() < 1e-13, "{:e}", fine.taken),
            _ => assert!((0.03..0.15).contains(&fine.taken), "{}", fine.taken),
        }
        let apart = fine.place.iter().zip(free.place).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(apart > 1e-2, "{brake}, {rotor}: {apart:e}");
    }
}

#[test]
fn a_free_component_keeps_its_energy_to_second_order() {
    for (frame, measures) in CHOICES {
        let superelement = beam::arc(if frame == FloatingFrame::Rigid { 0 } else { 3 }).superelement;
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        // The rigid frame shakes with its nodes, whose fastest vibrations a step of 2 ms cuts into six: the error is of second
        // order from steps of an eighth on.
        let step = if frame == FloatingFrame::Rigid { 2.5e-4 } else { 2e-3 };
        let [coarse, middle, fine] = [1.0, 0.5, 0.25].map(|share| energy_error(&component, share * step));
        // Four, but for terms of fourth order: (ω h)² of it, 0.13² for the fastest vibration of 2 π in six steps of 2 ms.
        let ratios = [coarse / middle, middle / fine];
        assert!(ratios.iter().all(|ratio| (3.9..4.1).contains(ratio)), "{coarse:e}, {ratios:?}");
        if frame == FloatingFrame::MassWeighted {
            // (Ω h)²/12 of the trapezoidal rule at Ω = √(1² + 2² + 3²); the vibrations have 1e-4 of the energy.
            let limit = 14.0 * step * step / 12.0;
            assert!(coarse < limit, "{coarse:e}, {limit:e}");
        }
    }
}
