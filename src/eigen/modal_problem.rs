//! What the eigenproblem of one boundary is made of.

use std::fmt::Debug;

use faer::{Mat, MatRef};

use super::equilibration::Equilibrated;
use super::operator::ShiftInvert;
use crate::dense;
use crate::random::{SEED, SplitMix64};
use crate::sparse::{Leading, Pencil, Precision, product};

/// A symmetric pencil whose modes are wanted, with what is deflated.
#[derive(Clone, Copy, Debug)]
pub struct ModalProblem<'a> {
    /// K, n × n.
    pub stiffness: Leading<'a>,
    /// M, n × n.
    pub mass: Leading<'a>,
    /// Motions without energy that are no elastic modes, Q and MQ, n × n_r each with QᵀMQ = I; no columns where there are none.
    pub deflated: [MatRef<'a, f64>; 2],
    /// How many motions that are not deflated are known to be free by other means than K.
    pub n_free: usize,
    /// How well the entries of K and M are known.
    pub precision: Precision,
    /// What is known of the roundings in the entries of K one by one, where something is.
    pub noise: Option<&'a dyn EnergyNoise>,
}

/// What is known of the roundings in the entries of K and M.
pub trait EnergyNoise: Debug + Sync {
    /// What the digits of K leave open of xᵀKx for each column of x (n × k); nothing where K has as many digits as a double.
    fn energy_noise(&self, x: MatRef<'_, f64>) -> Option<Vec<f64>>;

    /// What the digits of M leave open of xᵀMx for each column of x; nothing where each entry is known to a share of itself.
    fn mass_noise(&self, x: MatRef<'_, f64>) -> Option<Vec<f64>>;

    /// |x|ᵀ|K||x| of terms that cancelled while K was made, and of which it shows nothing but the roundings.
    fn hidden_terms(&self, x: MatRef<'_, f64>) -> Vec<f64>;
}

impl<'a> ModalProblem<'a> {
    /// The problem of a pencil from which nothing is deflated.
    pub fn of(pencil: Pencil<'a>, precision: Precision) -> Self {
        let Pencil { stiffness, mass } = pencil;
        let nothing = MatRef::from_column_major_slice(&[], stiffness.rows(), 0);
        Self { stiffness, mass, deflated: [nothing, nothing], n_free: 0, precision, noise: None }
    }

    /// The problem with motions deflated, Q and MQ.
    pub fn deflating(self, deflated: [MatRef<'a, f64>; 2]) -> Self {
        Self { deflated, ..self }
    }

    /// The problem with motions that are known to be free.
    pub fn knowing_free(self, n_free: usize) -> Self {
        Self { n_free, ..self }
    }

    /// The problem with roundings of K that are known entry by entry.
    pub fn with_noise(self, noise: &'a dyn EnergyNoise) -> Self {
        Self { noise: Some(noise), ..self }
    }

    /// Number of motions that are deflated, n_r.
    pub fn n_deflated(&self) -> usize {
        self.deflated[0].ncols()
    }

    /// K and M.
    pub fn pencil(&self) -> Pencil<'a> {
        Pencil { stiffness: self.stiffness, mass: self.mass }
    }
}

/// The median of K_ii / M_ii over the dofs that have both: the size of the largest eigenvalue where all dofs are alike, and
/// not moved by a few rotations of tiny inertia. One where no dof has both.
pub(crate) fn median_ratio(problem: ModalProblem<'_>) -> f64 {
    let ratios = ratios(problem);
    ratios.get(ratios.len() / 2).copied().unwrap_or(1.0)
}

/// K_ii / M_ii over the dofs that have both, ascending.
pub(crate) fn ratios(problem: ModalProblem<'_>) -> Vec<f64> {
    let (k, m) = (problem.stiffness.diagonal(), problem.mass.diagonal());
    let mut ratios: Vec<f64> = k.iter().zip(&m).filter(|(k, m)| **k > 0.0 && **m > 0.0).map(|(k, m)| k / m).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    ratios
}

/// How well an operator at shift zero solves K x = f for a self-equilibrated load: ‖Kx − f‖ / (‖K‖‖x‖ + ‖f‖), equilibrated.
pub(crate) fn relative_residual(problem: ModalProblem<'_>, operator: &dyn ShiftInvert) -> f64 {
    let [q, mass_q] = problem.deflated;
    let mut probe = Mat::zeros(operator.n(), 1);
    SplitMix64::new(SEED).fill(probe.as_mut());
    let mut load = product(problem.mass, probe.as_ref());
    let resultant = dense::gram(q, load.as_ref());
    dense::add_product(load.as_mut(), -1.0, mass_q, resultant.as_ref());
    let mut x = load.clone();
    operator.solve_in_place(x.as_mut());
    let motion = dense::gram(mass_q, x.as_ref());
    dense::add_product(x.as_mut(), -1.0, q, motion.as_ref());
    let force = product(problem.stiffness, x.as_ref());
    let norms = Equilibrated::of(problem.pencil());
    let load = dense::column(load.as_ref(), 0);
    let residual: Vec<f64> = dense::column(force.as_ref(), 0).iter().zip(load).map(|(k, f)| k - f).collect();
    let of = |column: &[f64]| {
        let scaled: Vec<f64> = column.iter().zip(&norms.scale).map(|(a, d)| a * d).collect();
        dense::norm(&scaled)
    };
    of(&residual) / (norms.stiffness_norm * norms.scaled_norm(dense::column(x.as_ref(), 0)) + of(load))
}

/// Rows of M with an entry other than zero.
pub(crate) fn rows_with_mass(mass: Leading<'_>) -> usize {
    (0..mass.rows()).filter(|row| mass.row(*row).1.iter().any(|value| *value != 0.0)).count()
}
