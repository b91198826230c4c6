//! One component under an integrator of one's own: a free flight in gravity, by the implicit midpoint rule.
//!
//!     cargo run --release -p supel-runtime --example own_integrator -- FILE.supel [SPIN] [STEP] [STEPS]
//!
//! A step from H₀, v₀ looks for the acceleration a for which the forces balance in its middle:
//!
//! v_m = v₀ + h/2 a, H_m = H₀ exp(h/2 v_m), f(H_m, v_m, a) = 0; then v₁ = v₀ + h a, H₁ = H₀ exp(h v_m).
//!
//! Newton's method takes the derivative of f by a, M + h/2 (G + C) + h²/4 K, with the exact stiffness; that of the exponential is
//! left out, which costs an iteration. Energy and momentum are kept to the second order in the step.

use std::error::Error;

use supel_runtime::Superelement;
use supel_runtime::component::{FloatingFrame, ModalComponent, State, Workspace};
use supel_runtime::motion::{Motion, Vector3, cross, split, times_3};

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Share of the forces that may be left in the middle of a step.
const TOLERANCE: f64 = 1e-10;

/// What a free body keeps: its energy, its horizontal momentum, its angular momentum about the vertical; and the vertical momentum,
/// which falls by m g in each second.
#[derive(Clone, Copy, Debug)]
pub struct Kept {
    /// Time, s.
    pub time: f64,
    /// Kinetic energy, energy of deformation and potential of gravity, J.
    pub energy: f64,
    /// Momentum, kg m/s.
    pub momentum: Vector3,
    /// Angular momentum about the vertical, kg m²/s.
    pub about_vertical: f64,
    /// Iterations of the step before.
    pub iterations: usize,
}

/// A component that flies.
pub struct Flight {
    component: ModalComponent,
    workspace: Workspace,
    gravity: Vector3,
    motions: Vec<Motion>,
    amplitudes: Vec<f64>,
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
}

impl Flight {
    /// In the reference configuration, turning about all axes, its last node pushed a little.
    pub fn new(superelement: &Superelement, spin: f64, gravity: f64) -> Outcome<Self> {
        let component = ModalComponent::new(superelement, FloatingFrame::MassWeighted)?;
        let (k, r) = (component.n_nodes(), component.n_coordinates());
        let turn = [spin, 2.0 * spin, 3.0 * spin];
        // Velocities of the nodes themselves, about the origin, in their own axes; the component wants those at the origin.
        let mut velocities = vec![0.0; r];
        for (six, x) in velocities.as_chunks_mut::<6>().0.iter_mut().zip(component.positions()) {
            six[..3].copy_from_slice(&cross(&turn, x));
            six[3..].copy_from_slice(&turn);
        }
        velocities[6 * k - 1] += 0.01 * spin;
        component.velocities_to_origin(&mut velocities)?;
        Ok(Self {
            workspace: component.workspace(),
            gravity: [0.0, 0.0, -gravity],
            motions: vec![Motion::IDENTITY; k],
            amplitudes: vec![0.0; component.n_modal()],
            velocities,
            accelerations: vec![0.0; r],
            component,
        })
    }

    /// One step; the number of iterations.
    pub fn step(&mut self, h: f64) -> Outcome<usize> {
        let r = self.component.n_coordinates();
        for iteration in 0..20 {
            let velocities: Vec<f64> =
                self.velocities.iter().zip(&self.accelerations).map(|(v, a)| v + 0.5 * h * a).collect();
            let (motions, amplitudes) = self.moved(0.5 * h, &velocities);
            let accelerations = &self.accelerations;
            let state = State { motions: &motions, amplitudes: &amplitudes, velocities: &velocities, accelerations };
            self.component.exact_tangents(&state, &mut self.workspace)?;
            let weight = self.component.gravity_forces(&self.gravity, &mut self.workspace)?.to_vec();
            let w = &self.workspace;
            let sizes = [w.elastic_forces(), w.inertial_forces(), w.damping_forces(), &weight].map(largest);
            let residual: Vec<f64> = (0..r)
                .map(|i| w.elastic_forces()[i] + w.inertial_forces()[i] + w.damping_forces()[i] - weight[i])
                .collect();
            if largest(&residual) <= TOLERANCE * sizes.iter().sum::<f64>() {
                let motions = self.moved(h, &velocities);
                (self.motions, self.amplitudes) = motions;
                self.velocities.iter_mut().zip(&self.accelerations).for_each(|(v, a)| *v += h * a);
                return Ok(iteration);
            }
            let mut stiffness = w.exact_stiffness().to_vec();
            self.component.add_gravity_stiffness(&self.gravity, &mut self.workspace, &mut stiffness)?;
            let w = &self.workspace;
            let entry = |i: usize| {
                let damping = w.damping().get(i).unwrap_or(&0.0);
                w.mass()[i] + 0.5 * h * (w.gyroscopic()[i] + damping) + 0.25 * h * h * stiffness[i]
            };
            let change = solved((0..r * r).map(entry).collect(), residual);
            self.accelerations.iter_mut().zip(change).for_each(|(a, d)| *a -= d);
        }
        Err("the step is too long: no balance of the forces in 20 iterations".into())
    }

    /// Where everything is after a time with constant velocities.
    fn moved(&self, time: f64, velocities: &[f64]) -> (Vec<Motion>, Vec<f64>) {
        let (of_nodes, of_modes) = velocities.split_at(6 * self.motions.len());
        let nodes = self.motions.iter().zip(of_nodes.as_chunks::<6>().0);
        let motions = nodes.map(|(motion, v)| motion.compose(&Motion::exp(&v.map(|x| time * x)))).collect();
        (motions, self.amplitudes.iter().zip(of_modes).map(|(eta, rate)| eta + time * rate).collect())
    }

    /// What should be kept, now.
    pub fn kept(&mut self, time: f64, iterations: usize) -> Outcome<Kept> {
        let Self { component, workspace, gravity, motions, amplitudes, velocities, accelerations } = self;
        component.evaluate(&State { motions, amplitudes, velocities, accelerations }, workspace)?;
        let potential = component.gravity_potential(gravity, workspace)?;
        // From the floating frame to inertial axes.
        let (frame, (linear, angular)) = (workspace.floating_frame(), split(workspace.frame_momentum()));
        let momentum = times_3(&frame.rotation, &linear);
        let about_origin = times_3(&frame.rotation, &angular)[2] + cross(&frame.translation, &momentum)[2];
        let energy = workspace.kinetic_energy() + workspace.strain_energy() + potential;
        Ok(Kept { time, energy, momentum, about_vertical: about_origin, iterations })
    }

    /// The component's mass.
    pub fn mass(&self) -> f64 {
        self.component.rigid_mass()[0][0]
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |size, x| size.max(x.abs()))
}

/// Solution of A x = b, A row by row, by elimination with row exchanges.
fn solved(mut a: Vec<f64>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for c in 0..n {
        let pivot = (c..n).fold(c, |best, i| if a[i * n + c].abs() > a[best * n + c].abs() { i } else { best });
        (0..n).for_each(|j| a.swap(c * n + j, pivot * n + j));
        b.swap(c, pivot);
        for i in c + 1..n {
            let factor = a[i * n + c] / a[c * n + c];
            (c..n).for_each(|j| a[i * n + j] -= factor * a[c * n + j]);
            b[i] -= factor * b[c];
        }
    }
    for c in (0..n).rev() {
        let rest: f64 = (c + 1..n).map(|j| a[c * n + j] * b[j]).sum();
        b[c] = (b[c] - rest) / a[c * n + c];
    }
    b
}

fn main() -> Outcome<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    fly(&arguments, &mut std::io::stdout())
}

/// The program: flies the superelement of a file, and writes what it keeps as a table.
pub fn fly(arguments: &[String], out: &mut impl std::io::Write) -> Outcome<()> {
    let [file, numbers @ ..] = arguments else {
        return Err("usage: own_integrator FILE.supel [SPIN] [STEP] [STEPS]".into());
    };
    let superelement = Superelement::open(file.as_ref())?;
    let number = |place: usize, default: f64| numbers.get(place).map_or(Ok(default), |text| text.parse());
    // A twentieth of the first period, where the file names one.
    let period = superelement.tensors().frequencies.first().map_or(1.0, |omega| std::f64::consts::TAU / omega);
    let (spin, step, n_steps) = (number(0, 1.0)?, number(1, 0.05 * period)?, number(2, 100.0)? as usize);
    // Gravity in the units of the file: millimetres where its label says so.
    let in_millimetres = superelement.metadata().units.as_deref().is_some_and(|units| units.starts_with("mm"));
    let gravity = if in_millimetres { 9810.0 } else { 9.81 };
    let mut flight = Flight::new(&superelement, spin, gravity)?;
    writeln!(
        out,
        "{:>12} {:>16} {:>16} {:>16} {:>10}",
        "time", "energy", "momentum x", "about vertical", "iterations"
    )?;
    let mut iterations = 0;
    for i in 0..=n_steps {
        if i.is_multiple_of((n_steps / 10).max(1)) {
            let Kept { time, energy, momentum, about_vertical, iterations } =
                flight.kept(i as f64 * step, iterations)?;
            writeln!(out, "{time:12.5e} {energy:16.9e} {:16.9e} {about_vertical:16.9e} {iterations:10}", momentum[0])?;
        }
        iterations = flight.step(step)?;
    }
    Ok(())
}
