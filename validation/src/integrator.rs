//! Lie-group generalised-α method with a constant iteration matrix.
//!
//! ```text
//! S   n × n   β' M + γ' C + K of the first configuration, without gyroscopic terms, without the skew part of the damping C and
//!             without the tangent operator of the increment; factored once
//! B   m × n   gradients of the joints; those of the iteration matrix are renewed once per step because they turn with the nodes
//! ```
//!
//! Reactions act along the gradients of the configuration itself, so that those of two nodes balance. The iteration converges
//! linearly: gyroscopic terms, those of a skew damping and the tangent operator, which S lacks, leave a part of the order φ̇ h of
//! the error each time; S remains positive definite.
//! Against them the derivative of Bᵀλ, which S lacks too, does not count: it is of the order h².
//!
//! Source: Brüls and Cardona's scheme as the corrected section 2.5 of the paper's equations has it.

use faer::Mat;

use crate::Result;
use crate::joint::Support;
use crate::saddle::{Gradients, Saddle};
use crate::system::{Configuration, Matrices, System};

/// Step, damping and when a step has converged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Time step h, s.
    pub step: f64,
    /// Number of steps.
    pub n_steps: usize,
    /// Spectral radius at infinite frequency ϱ∞.
    pub spectral_radius: f64,
    /// A step has converged when |r| ≤ tolerance · (|f_E| + |f_I| + |f_D| + |f_ext| + floor).
    pub tolerance: f64,
    /// Force below which differences do not count, N: rounding of a stiff component's forces at rest.
    pub floor: f64,
    /// Whether the iteration matrix may change.
    pub matrix: IterationMatrix,
}

/// Whether the iteration matrix may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IterationMatrix {
    /// It is that of the first configuration.
    Constant,
    /// It is computed anew in every step that has not converged after so many iterations.
    RenewedAfter(usize),
}

/// Iterations in one step beyond which it has failed.
const MOST_ITERATIONS: usize = 60;

/// What a simulation took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Steps made.
    pub steps: usize,
    /// Linear solves.
    pub iterations: usize,
    /// The most in one step.
    pub most: usize,
    /// Iteration matrices beyond the first.
    pub renewals: usize,
}

impl Effort {
    /// Mean number of iterations per step.
    pub fn mean(&self) -> f64 {
        self.iterations as f64 / self.steps.max(1) as f64
    }
}

/// Position, velocity and accelerations at one time.
#[derive(Clone, Debug)]
pub struct Instant {
    /// Time, s.
    pub time: f64,
    /// Where everything is.
    pub at: Configuration,
    /// Velocities, in the nodes' own axes.
    pub velocity: Vec<f64>,
    /// Their derivatives.
    pub acceleration: Vec<f64>,
    /// The scheme's own accelerations a.
    algorithmic: Vec<f64>,
    /// Multipliers λ of the rows of all joints, N or N m: the joints act on the nodes with −Bᵀλ.
    pub multipliers: Vec<f64>,
}

/// Moves a mechanism from its initial velocity through all steps; `look` sees the start and the end of each step.
///
/// # Errors
/// The joints do not allow the initial velocity; a step does not converge, or the component cannot express the deformation; the
/// message says when.
pub fn simulate(system: &mut System, scheme: &Scheme, mut look: impl FnMut(&System, &Instant)) -> Result<Effort> {
    let mut now = start(system, scheme.step)?;
    let mut newton = Newton::new(system, scheme, &now.at)?;
    let mut effort = Effort::default();
    // Whoever looks at the start asks for its energies, not for those of the matrices' state of rest.
    system.forces(now.time, &now.at, &now.velocity, &now.acceleration)?;
    look(system, &now);
    for step in 1..=scheme.n_steps {
        let time = step as f64 * scheme.step;
        let iterations =
            newton.step(system, &mut now, time, &mut effort).map_err(|why| format!("at {time:.3} s: {why}"))?;
        effort.steps += 1;
        effort.iterations += iterations;
        effort.most = effort.most.max(iterations);
        look(system, &now);
    }
    Ok(effort)
}

/// The accelerations that loads, drives, damping and the initial velocity give: M v̇ + Bᵀλ = f, B v̇ = −g″ with g″ the second derivative of
/// the violations on the way with constant velocity.
fn start(system: &mut System, step: f64) -> Result<Instant> {
    let (n, at) = (system.n(), system.initial());
    let mut acceleration = vec![0.0; n];
    for (i, support) in system.supports.iter().enumerate() {
        if let Support::Driven { initial_acceleration, .. } = support {
            acceleration[i] = *initial_acceleration;
        }
    }
    let velocity = system.initial_velocity.clone();
    let residual = system.forces(0.0, &at, &velocity, &acceleration)?.residual();
    let mass = system.matrices_at_rest(&at)?.mass;
    let kkt = Saddle::new(&mass, system.free())?;
    let joints = Gradients::new(system, 0.0, &at);
    let faster = violation_acceleration(system, step, &joints)?;
    let violation: Vec<f64> = joints.times(&acceleration).iter().zip(faster).map(|(own, other)| own + other).collect();
    let (change, multipliers) = kkt.solve(&kkt.bordered(&joints)?, &residual, &violation);
    acceleration.iter_mut().zip(&change).for_each(|(a, d)| *a += d);
    Ok(Instant { time: 0.0, at, velocity, algorithmic: acceleration.clone(), acceleration, multipliers })
}

/// Share of the velocities that a joint holds by which the initial velocity may break it; differences over a step are right to
/// some (ω h)².
const ALLOWED: f64 = 1e-2;

/// g″ at the start, from the violations a step before and after on the way with constant velocity: right to the second order in the
/// step, as the scheme is, and exact at rest.
///
/// # Errors
/// g′ is not zero: the joints do not allow the initial velocity.
fn violation_acceleration(system: &System, step: f64, joints: &Gradients) -> Result<Vec<f64>> {
    let [before, after] = [-step, step].map(|time| {
        let way: Vec<f64> = system.initial_velocity.iter().map(|v| time * v).collect();
        Gradients::new(system, time, &system.moved(&system.initial(), &way)).violations
    });
    let largest = joints.magnitudes(&system.initial_velocity).into_iter().fold(0.0, f64::max);
    let broken = before.iter().zip(&after).any(|(b, a)| (a - b).abs() > 2.0 * step * ALLOWED * largest);
    if broken {
        return Err("the joints do not allow the initial velocity".into());
    }
    let sum = |((b, a), now): ((&f64, &f64), &f64)| ((a - now) + (b - now)) / (step * step);
    Ok(before.iter().zip(&after).zip(&joints.violations).map(sum).collect())
}

/// Coefficients of the scheme.
#[derive(Clone, Copy, Debug)]
struct Coefficients {
    alpha_m: f64,
    alpha_f: f64,
    gamma: f64,
    beta: f64,
    h: f64,
}

impl Coefficients {
    fn of(scheme: &Scheme) -> Self {
        let rho = scheme.spectral_radius;
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let gamma = 0.5 - alpha_m + alpha_f;
        Self { alpha_m, alpha_f, gamma, beta: 0.25 * (gamma + 0.5).powi(2), h: scheme.step }
    }

    /// Derivative of the velocity with respect to the increment.
    fn velocity(&self) -> f64 {
        self.gamma / (self.beta * self.h)
    }

    /// Derivative of the acceleration with respect to the increment.
    fn acceleration(&self) -> f64 {
        (1.0 - self.alpha_m) / (self.beta * self.h * self.h * (1.0 - self.alpha_f))
    }
}

struct Newton<'a> {
    scheme: &'a Scheme,
    coefficients: Coefficients,
    kkt: Saddle,
    /// Size of β'M, which makes metres of a joint comparable with forces.
    constraint_scale: f64,
}

/// The end of a step that is being looked for.
struct Trial {
    increment: Vec<f64>,
    at: Configuration,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    algorithmic: Vec<f64>,
    multipliers: Vec<f64>,
}

impl<'a> Newton<'a> {
    fn new(system: &mut System, scheme: &'a Scheme, at: &Configuration) -> Result<Self> {
        let coefficients = Coefficients::of(scheme);
        let (kkt, constraint_scale) = Self::factored(system, at, coefficients)?;
        Ok(Self { scheme, coefficients, kkt, constraint_scale })
    }

    fn factored(system: &mut System, at: &Configuration, coefficients: Coefficients) -> Result<(Saddle, f64)> {
        let Matrices { stiffness, mass, damping, .. } = system.matrices_at_rest(at)?;
        let (factor, of_rate) = (coefficients.acceleration(), coefficients.velocity());
        let n = system.n();
        let braked = |i: usize, j: usize| 0.5 * of_rate * (damping[(i, j)] + damping[(j, i)]);
        let s = Mat::from_fn(n, n, |i, j| factor * mass[(i, j)] + braked(i, j) + stiffness[(i, j)]);
        let free = system.free();
        let mean = free.iter().map(|i| mass[(*i, *i)]).sum::<f64>() / free.len() as f64;
        Ok((Saddle::new(&s, free)?, factor * mean))
    }

    /// One step; the number of iterations.
    fn step(&mut self, system: &mut System, now: &mut Instant, time: f64, effort: &mut Effort) -> Result<usize> {
        let mut trial = self.predicted(system, now, time);
        let mut bordered = self.kkt.bordered(&Gradients::new(system, time, &trial.at))?;
        for iteration in 0..=MOST_ITERATIONS {
            let forces = system.forces(time, &trial.at, &trial.velocity, &trial.acceleration)?;
            let mut residual = forces.residual();
            let joints = Gradients::new(system, time, &trial.at);
            joints.add_reactions(&trial.multipliers, &mut residual);
            let violation = &joints.violations;
            let free = &self.kkt.free;
            let size = |v: &[f64]| free.iter().map(|i| v[*i] * v[*i]).sum::<f64>().sqrt();
            let gap = violation.iter().map(|g| (self.constraint_scale * g).powi(2)).sum::<f64>();
            let error = (size(&residual).powi(2) + gap).sqrt();
            let sizes = [&forces.elastic, &forces.inertial, &forces.damping, &forces.applied].map(|force| size(force));
            let scale = sizes.iter().sum::<f64>() + self.scheme.floor;
            if !error.is_finite() {
                break;
            }
            if error <= self.scheme.tolerance * scale {
                *now = trial.finished(time);
                return Ok(iteration);
            }
            if let IterationMatrix::RenewedAfter(patience) = self.scheme.matrix
                && iteration == patience
            {
                (self.kkt, self.constraint_scale) = Self::factored(system, &trial.at, self.coefficients)?;
                bordered = self.kkt.bordered(&joints)?;
                effort.renewals += 1;
            }
            let (change, multipliers) = self.kkt.solve(&bordered, &residual, violation);
            self.correct(system, now, &mut trial, &change);
            trial.multipliers.iter_mut().zip(&multipliers).for_each(|(m, d)| *m += d);
        }
        Err("the iteration does not converge".into())
    }

    /// The end of the step with the acceleration of its start; a driven coordinate gets the acceleration that takes it
    /// where it has to be.
    fn predicted(&self, system: &System, now: &Instant, time: f64) -> Trial {
        let Coefficients { alpha_m, alpha_f, gamma, beta, h } = self.coefficients;
        let n = system.n();
        let mut acceleration = now.acceleration.clone();
        let mut algorithmic = vec![0.0; n];
        for (i, support) in system.supports.iter().enumerate() {
            let (a0, vd0, v0) = (now.algorithmic[i], now.acceleration[i], now.velocity[i]);
            if let Support::Driven { angle, .. } = support {
                let turn = angle(time) - angle(now.time);
                algorithmic[i] = (turn / h - v0 - (0.5 - beta) * h * a0) / (beta * h);
                acceleration[i] = ((1.0 - alpha_m) * algorithmic[i] + alpha_m * a0 - alpha_f * vd0) / (1.0 - alpha_f);
            } else {
                algorithmic[i] = (vd0 - alpha_m * a0) / (1.0 - alpha_m);
            }
        }
        let increment: Vec<f64> = (0..n)
            .map(|i| h * (now.velocity[i] + h * ((0.5 - beta) * now.algorithmic[i] + beta * algorithmic[i])))
            .collect();
        let velocity = (0..n)
            .map(|i| now.velocity[i] + h * ((1.0 - gamma) * now.algorithmic[i] + gamma * algorithmic[i]))
            .collect();
        let at = system.moved(&now.at, &increment);
        Trial { increment, at, velocity, acceleration, algorithmic, multipliers: now.multipliers.clone() }
    }

    fn correct(&self, system: &System, now: &Instant, trial: &mut Trial, change: &[f64]) {
        let Coefficients { beta, h, .. } = self.coefficients;
        for (i, d) in change.iter().enumerate() {
            trial.increment[i] += d;
            trial.velocity[i] += self.coefficients.velocity() * d;
            trial.acceleration[i] += self.coefficients.acceleration() * d;
            trial.algorithmic[i] += d / (beta * h * h);
        }
        trial.at = system.moved(&now.at, &trial.increment);
    }
}

impl Trial {
    fn finished(self, time: f64) -> Instant {
        let Self { at, velocity, acceleration, algorithmic, multipliers, .. } = self;
        Instant { time, at, velocity, acceleration, algorithmic, multipliers }
    }
}
