//! A beam that spins about its root: its linear vibration about steady rotation, by the tangents of its components.
//!
//! ```text
//! M δ̈ + (G + C + M v̂) δ̇ + (K + (G + C) v̂) δ = 0
//! ```
//! with the derivatives M, G, C, K of the forces and v̂ the operator of each node's steady velocity. Lengths are in those of the
//! beam, masses in its mass, times in √(m L⁴/EI): a slender beam that does not spin vibrates at 3.516 across its length.
//!
//! Inside a component nothing stiffens with the centrifugal force and the inertia is that of the undeformed shape: one component
//! alone misses what several find between them.

use faer::Mat;
use faer::linalg::solvers::Solve;
use supel_runtime::Superelement;
use supel_runtime::component::{FloatingFrame, Measures};
use supel_runtime::motion::{Vector3, Vector6, cross, hat, join, transposed_times_3, transposed_times_6};

use crate::Result;
use crate::beam::{Section, polyline};
use crate::examples::reduced_parts;
use crate::joint::{CLAMPED, FREE};
use crate::part::Part;
use crate::selection::{Modes, selected};
use crate::system::{Configuration, Formulation, System};

/// Finite elements of the whole beam.
const ELEMENTS: usize = 32;

/// EI = 1 and mass 1 on the length 1; so slender that shear, stretch and rotary inertia change frequencies by less than a thousandth.
const SECTION: Section =
    Section { axial: 1e5, shear: [4e4; 2], torsion: 10.0, bending: [1.0; 2], mass: 1.0, inertia: [2e-5, 1e-5, 1e-5] };

/// Which stiffness the linear vibration takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stiffness {
    /// K_T of the paper (82).
    Papers,
    /// The derivative of the forces.
    Exact,
    /// Central differences of the forces.
    Differences,
}

/// A spinning beam in its steady state.
#[derive(Debug)]
pub struct Spinning {
    system: System,
    at: Configuration,
    /// Angular velocity about z.
    spin: f64,
}

/// The beam's parts, each with its static modes and `n_modes` free modes.
///
/// # Errors
/// The errors of the reduction.
pub fn parts(n_components: usize, n_modes: usize, folder: &std::path::Path) -> Result<Vec<Superelement>> {
    let elements = ELEMENTS / n_components;
    let end = |number: usize| [number as f64 / n_components as f64, 0.0, 0.0];
    let part = |number: usize| Part {
        name: format!("spinning-{number}-of-{n_components}"),
        model: polyline(&[end(number), end(number + 1)], elements, &SECTION),
        interface: vec![vec![1], vec![elements as i64 + 1]],
        recovered: Vec::new(),
        units: "m-kg-s",
        n_modes: n_modes + 6,
    };
    let parts: Vec<Part> = (0..n_components).map(part).collect();
    reduced_parts(&parts, folder)?.iter().map(|rich| selected(rich, Modes::Free(n_modes))).collect()
}

impl Spinning {
    /// The beam of these parts, clamped at its root to a hub without radius that turns at `spin`.
    ///
    /// # Errors
    /// A superelement that the component refuses; a steady state that is not found.
    pub fn new(parts: &[Superelement], spin: f64) -> Result<Self> {
        let n = parts.len();
        let positions: Vec<Vector3> = (0..=n).map(|j| [j as f64 / n as f64, 0.0, 0.0]).collect();
        let nodes: Vec<[usize; 2]> = (0..n).map(|j| [j, j + 1]).collect();
        let placed: Vec<_> = parts.iter().zip(&nodes).map(|(part, nodes)| (part, nodes.as_slice())).collect();
        let mut supports = vec![FREE; n + 1];
        supports[0] = CLAMPED;
        let formulation = Formulation { frame: FloatingFrame::MassWeighted, measures: Measures::MotionBased };
        let system = System::new(positions, &supports, &placed, formulation)?;
        let mut spinning = Self { at: system.initial(), system, spin };
        spinning.settle()?;
        Ok(spinning)
    }

    /// Newton's method on the forces of steady rotation.
    fn settle(&mut self) -> Result<()> {
        for _ in 0..20 {
            let free = self.system.free();
            let load = self.forces(&self.at.clone())?;
            let [stiffness, ..] = self.matrices(Stiffness::Exact)?;
            let right = Mat::from_fn(free.len(), 1, |i, _| -load[free[i]]);
            let change = stiffness.partial_piv_lu().solve(&right);
            let mut increment = vec![0.0; self.system.n()];
            free.iter().enumerate().for_each(|(i, row)| increment[*row] = change[(i, 0)]);
            self.at = self.system.moved(&self.at, &increment);
            if increment.iter().all(|step| step.abs() < 1e-13) {
                return Ok(());
            }
        }
        Err("no steady state was found".into())
    }

    /// Material velocities (Rᵀẋ; ω) of rotation about the z axis; accelerations are zero.
    fn velocities(&self, at: &Configuration) -> Vec<f64> {
        let spin = [0.0, 0.0, self.spin];
        let mut velocities = vec![0.0; self.system.n()];
        for (node, six) in velocities.chunks_exact_mut(6).take(at.motions.len()).enumerate() {
            let moving = cross(&spin, &self.system.position(at, node));
            let turned = |v: &Vector3| transposed_times_3(&at.motions[node].rotation, v);
            six.copy_from_slice(&join(&turned(&moving), &turned(&spin)));
        }
        velocities
    }

    /// Forces of steady rotation at a configuration.
    fn forces(&mut self, at: &Configuration) -> Result<Vec<f64>> {
        let (velocity, rest) = (self.velocities(at), vec![0.0; self.system.n()]);
        Ok(self.system.forces(0.0, at, &velocity, &rest)?.residual())
    }

    /// K + (G + C) v̂, G + C + M v̂ and M on the free coordinates.
    fn matrices(&mut self, stiffness: Stiffness) -> Result<[Mat<f64>; 3]> {
        let (at, free) = (self.at.clone(), self.system.free());
        let (velocity, rest) = (self.velocities(&at), vec![0.0; self.system.n()]);
        let own = self.system.matrices(&at, &velocity, &rest)?;
        let by_rate = &own.gyroscopic + &own.damping;
        let by_place = match stiffness {
            Stiffness::Papers => own.stiffness,
            Stiffness::Exact => own.exact_stiffness + self.turned(&by_rate, &velocity),
            Stiffness::Differences => self.differences()?,
        };
        let by_rate = &by_rate + self.turned(&own.mass, &velocity);
        Ok([by_place, by_rate, own.mass].map(|a| Mat::from_fn(free.len(), free.len(), |i, j| a[(free[i], free[j])])))
    }

    /// A v̂.
    fn turned(&self, a: &Mat<f64>, velocity: &[f64]) -> Mat<f64> {
        let mut product = Mat::zeros(a.nrows(), a.ncols());
        for node in 0..self.system.positions.len() {
            let v: Vector6 = std::array::from_fn(|i| velocity[6 * node + i]);
            for i in 0..a.nrows() {
                let row = transposed_times_6(&hat(&v), &std::array::from_fn(|c| a[(i, 6 * node + c)]));
                row.iter().enumerate().for_each(|(c, value)| product[(i, 6 * node + c)] = *value);
            }
        }
        product
    }

    /// Derivative of the forces of steady rotation by the place, by differences of the fourth order: the stretch of a node that
    /// goes sideways grows so fast that those of the second order would show it.
    fn differences(&mut self) -> Result<Mat<f64>> {
        const STEP: f64 = 1e-4;
        let n = self.system.n();
        let mut columns = Mat::zeros(n, n);
        for j in 0..n {
            for (steps, share) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
                let mut increment = vec![0.0; n];
                increment[j] = steps * STEP;
                let forces = self.forces(&self.system.moved(&self.at, &increment))?;
                (0..n).for_each(|i| columns[(i, j)] += share * forces[i] / (12.0 * STEP));
            }
        }
        Ok(columns)
    }

    /// Natural frequencies of the vibration about steady rotation, ascending.
    ///
    /// # Errors
    /// A state that the component cannot express, or eigenvalues that are not found.
    pub fn frequencies(&mut self, stiffness: Stiffness) -> Result<Vec<f64>> {
        let [by_place, by_rate, mass] = self.matrices(stiffness)?;
        let n = mass.nrows();
        let factor = mass.partial_piv_lu();
        let (by_place, by_rate) = (factor.solve(&by_place), factor.solve(&by_rate));
        let companion = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, _) => f64::from(u8::from(j == i + n)),
            (false, true) => -by_place[(i - n, j)],
            (false, false) => -by_rate[(i - n, j - n)],
        });
        let values = companion.eigenvalues().map_err(|error| format!("eigenvalues: {error:?}"))?;
        let mut found: Vec<f64> = values.iter().map(|value| value.im).filter(|omega| *omega > 0.0).collect();
        found.sort_by(f64::total_cmp);
        Ok(found)
    }
}
