//! Static equilibrium under dead loads, load step after load step.
//!
//! The tangent is K_T of the components (82), which leaves out the derivative of J_P, or their exact stiffness, plus the
//! stiffness of the loads: a dead force turns in the axes of its node, δ(Rᵀf) = (Rᵀf)~ δθ. Without the latter the iteration
//! fails at large loads; with K_T it converges linearly, with the exact stiffness quadratically, once it is close.

use faer::Mat;
use faer::linalg::solvers::Solve;

use crate::Result;
use crate::system::{Configuration, Forces, Matrices, System};

/// Largest turn of a node in one iteration, rad: larger ones leave the region where the iteration converges.
const LARGEST_TURN: f64 = 0.7;

/// Iterations in one load step beyond which it has failed.
const MOST_ITERATIONS: usize = 200;

/// |f_E − f_ext| of an equilibrium, as a share of |f_E| + |f_ext|: some hundred times the rounding of the elastic forces,
/// EA/l times the rounding of positions of 100 m against loads of 100 N.
const TOLERANCE: f64 = 1e-9;

/// Stiffness of the components in an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tangent {
    /// K_T (82).
    Papers,
    /// K_T from afar, where Newton's method may leave the equilibrium, then the derivative of their forces.
    Exact,
}

/// Share of the forces below which the residual is close enough for the exact tangent: from farther away Newton's method with four
/// elements strays among states whose axial forces are a thousand times the load.
const CLOSE: f64 = 0.1;

/// Equilibrium under the loads at "time" 1, 2, … `n_steps`; `look` sees each with its number of iterations.
///
/// # Errors
/// The mechanism has joints, which only the time integration enforces; a load step does not converge, the message says which.
pub fn equilibria(
    system: &mut System,
    n_steps: usize,
    tangent: Tangent,
    mut look: impl FnMut(&System, &Configuration, usize),
) -> Result<()> {
    if !system.joints.is_empty() {
        return Err("a static equilibrium of a mechanism with joints".into());
    }
    let mut at = system.initial();
    for step in 1..=n_steps {
        let iterations = equilibrium(system, &mut at, (step as f64, tangent));
        let iterations = iterations.map_err(|why| format!("load step {step}: {why}"))?;
        look(system, &at, iterations);
    }
    Ok(())
}

fn equilibrium(system: &mut System, at: &mut Configuration, (time, tangent): (f64, Tangent)) -> Result<usize> {
    let free = system.free();
    let rest = vec![0.0; system.n()];
    for iteration in 0..=MOST_ITERATIONS {
        let Forces { elastic, applied, .. } = system.forces(time, at, &rest, &rest)?;
        let size = |v: &dyn Fn(usize) -> f64| free.iter().map(|i| v(*i) * v(*i)).sum::<f64>().sqrt();
        let residual = size(&|i| elastic[i] - applied[i]);
        let forces = size(&|i| elastic[i]) + size(&|i| applied[i]);
        if residual <= TOLERANCE * forces {
            return Ok(iteration);
        }
        let Matrices { stiffness, exact_stiffness, .. } = system.matrices_at_rest(at)?;
        let is_exact = tangent == Tangent::Exact && residual < CLOSE * forces;
        let mut matrix = if is_exact { exact_stiffness } else { stiffness };
        system.add_load_stiffness(at, time, &mut matrix);
        let reduced = Mat::from_fn(free.len(), free.len(), |i, j| matrix[(free[i], free[j])]);
        let load = Mat::from_fn(free.len(), 1, |i, _| applied[free[i]] - elastic[free[i]]);
        let change = reduced.partial_piv_lu().solve(&load);
        let mut increment = rest.clone();
        free.iter().enumerate().for_each(|(i, row)| increment[*row] = change[(i, 0)]);
        let turns = (0..system.positions.len()).flat_map(|node| 6 * node + 3..6 * node + 6).map(|i| increment[i].abs());
        let largest = turns.fold(0.0, f64::max);
        if !largest.is_finite() {
            break;
        }
        let share = (LARGEST_TURN / largest).min(1.0);
        increment.iter_mut().for_each(|step| *step *= share);
        *at = system.moved(at, &increment);
    }
    Err("the iteration does not converge".into())
}
