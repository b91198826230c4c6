//! The full model: its zero modes, and static answers by conjugate gradients.
//!
//! K u = f is solved on the space M-orthogonal to the zero modes, preconditioned with the factor of K − σM, whose σ lies
//! near the first elastic eigenvalue: K (K − σM)⁻¹ has its eigenvalues between 1/11 and 1, so that twenty steps give
//! every digit, and the answer is that of K, whatever the factor.

use faer::{Mat, MatRef};

use super::scaled::Scaled;
use crate::dense;
use crate::error::Result;
use crate::factor::{Analysis, Cholesky, SolveOperator};
use crate::model::diagonal;
use crate::modes::{ModalProblem, shifted};
use crate::partition::Partition;
use crate::rigid::RigidBodyModes;
use crate::sparse::product;
use crate::verification::check::Limits;

/// Steps after which a static answer is taken as it is; its residual is a check.
const MAX_STEPS: usize = 200;
/// Residual, relative to the first, below which rounding is all that is left.
const SOLVED: f64 = 1e-14;
/// Roundings may add up to this many times those of the motion they are known of.
const NOISE_FACTOR: f64 = 10.0;
/// The most that roundings excuse: a motion that may be any other is compared with nothing.
pub(super) const LARGEST_TURN: f64 = 1.0;
/// Steps without progress after which rounding is all that is left.
const STALLED: usize = 4;

/// The full model with a factor of K − σM on all dofs.
pub(super) struct Full<'a> {
    pub(super) partition: &'a Partition,
    /// The structure of K − σM.
    pub(super) analysis: &'a Analysis,
    /// L Lᵀ = K − σM.
    pub(super) factor: Cholesky<'a>,
    /// σ < 0.
    pub(super) sigma: f64,
    /// Zero modes found by inverse iteration.
    pub(super) rigid: RigidBodyModes,
    /// The first elastic eigenvalue.
    pub(super) first: f64,
    /// What roundings of K leave of an energy, relative to that: how far they turn motions towards each other.
    noise: f64,
}

/// Solutions of K u = f and how well they solve it.
pub(super) struct Solutions {
    /// n' × k.
    pub(super) u: Mat<f64>,
    /// The largest residual left, relative to the load, in the norm of (K − σM)⁻¹.
    pub(super) residual: f64,
}

impl<'a> Full<'a> {
    pub(super) fn new(partition: &'a Partition, analysis: &'a Analysis) -> Result<Self> {
        let problem = ModalProblem::free(partition, None);
        let found = shifted(analysis, problem, &|dof| partition.name_of(dof))?;
        let shapes = found.lowest.shapes.as_ref().subcols(0, found.n_zero).to_owned();
        let first = found.lowest.lambda.get(found.n_zero).copied().or(found.lowest.next).unwrap_or(1.0);
        let looked_at = &found.lowest.errors[..found.lowest.count().min(found.n_zero + 1)];
        let noise = looked_at.iter().map(|error| error.zero_level / first).fold(0.0, f64::max);
        let rigid = RigidBodyModes {
            modes: shapes.clone(),
            mass_orthonormal: product(&partition.mass, shapes.as_ref()),
            orthonormal: shapes,
            ..RigidBodyModes::none(partition.n_dofs())
        };
        Ok(Self { partition, analysis, factor: found.factor, sigma: found.sigma, rigid, first, noise })
    }

    /// Q_B, n_B × n_r.
    pub(super) fn rigid_interface(&self) -> MatRef<'_, f64> {
        let n_i = self.partition.n_internal;
        self.rigid.orthonormal.as_ref().subrows(n_i, self.partition.n_interface())
    }

    /// The largest K_ii/M_ii over the first elastic eigenvalue: what rounding of K is amplified by.
    pub(super) fn condition(&self) -> f64 {
        let (k, m) = (diagonal(&self.partition.stiffness), diagonal(&self.partition.mass));
        let ratios = k.iter().zip(&m).filter(|(_, m)| **m > 0.0).map(|(k, m)| k / m);
        ratios.fold(1.0, f64::max) / self.first
    }

    /// The same limits where roundings of K are the reason. Zero modes and answers found here are those of K as it stands, in which
    /// roundings turn rigid-body motion towards elastic motion; the reduction has the motions of the coordinates, and makes
    /// the interface carry them exactly, which turns the interior by as much of its own first eigenvalue.
    pub(super) fn by_roundings(&self, scaled: &Scaled, limits: Limits) -> Limits {
        self.by_roundings_beside(1.0, scaled, limits)
    }

    /// Those of directions of modes, which the same roundings turn towards modes a share of their eigenvalue away.
    pub(super) fn by_roundings_beside(&self, share: f64, scaled: &Scaled, limits: Limits) -> Limits {
        let turn = NOISE_FACTOR * self.turn(scaled) / share;
        let limits = match self.partition.has_few_digits() {
            true => Limits { data: turn, ..limits },
            false => Limits { arithmetic: limits.arithmetic.max(turn), ..limits },
        };
        limits.capped(LARGEST_TURN, LARGEST_TURN)
    }

    /// How far roundings turn motions.
    pub(super) fn turn(&self, scaled: &Scaled) -> f64 {
        self.noise * (self.first / scaled.first_held.unwrap_or(self.first)).max(1.0)
    }

    /// Takes zero motion out of displacements.
    fn deflate(&self, u: &mut Mat<f64>) {
        let motion = dense::gram(self.rigid.mass_orthonormal.as_ref(), u.as_ref());
        dense::add_product(u.as_mut(), -1.0, self.rigid.orthonormal.as_ref(), motion.as_ref());
    }

    /// Takes the resultant out of loads.
    fn equilibrate(&self, f: &mut Mat<f64>) {
        let resultant = dense::gram(self.rigid.orthonormal.as_ref(), f.as_ref());
        dense::add_product(f.as_mut(), -1.0, self.rigid.mass_orthonormal.as_ref(), resultant.as_ref());
    }

    fn precondition(&self, r: &Mat<f64>) -> Mat<f64> {
        let mut z = r.clone();
        self.factor.solve_in_place(z.as_mut());
        self.deflate(&mut z);
        z
    }

    /// K⁺ f for loads on the interface, n_B × k.
    pub(super) fn solve_interface_loads(&self, loads: MatRef<'_, f64>) -> Solutions {
        let n_i = self.partition.n_internal;
        let mut residual = Mat::zeros(self.partition.n_dofs(), loads.ncols());
        residual.as_mut().subrows_mut(n_i, loads.nrows()).copy_from(loads);
        self.equilibrate(&mut residual);
        let mut u = Mat::zeros(residual.nrows(), residual.ncols());
        let mut z = self.precondition(&residual);
        let start = column_products(&residual, &z);
        let (mut rho, mut best, mut since_best) = (start.clone(), f64::INFINITY, 0);
        let mut direction = z.clone();
        for _ in 0..MAX_STEPS {
            let worst = largest_ratio(&rho, &start);
            since_best = if worst < best { 0 } else { since_best + 1 };
            best = best.min(worst);
            if worst <= SOLVED || since_best >= STALLED {
                break;
            }
            let force = product(&self.partition.stiffness, direction.as_ref());
            let curvature = column_products(&direction, &force);
            for j in 0..u.ncols() {
                let step = if curvature[j] > 0.0 { rho[j] / curvature[j] } else { 0.0 };
                dense::add_scaled(dense::column_mut(u.as_mut(), j), step, dense::column(direction.as_ref(), j));
                dense::add_scaled(dense::column_mut(residual.as_mut(), j), -step, dense::column(force.as_ref(), j));
            }
            self.equilibrate(&mut residual);
            z = self.precondition(&residual);
            let next = column_products(&residual, &z);
            for j in 0..u.ncols() {
                let ratio = if rho[j] > 0.0 { next[j] / rho[j] } else { 0.0 };
                let p = dense::column_mut(direction.as_mut(), j);
                p.iter_mut().zip(dense::column(z.as_ref(), j)).for_each(|(p, z)| *p = z + ratio * *p);
            }
            rho = next;
        }
        self.deflate(&mut u);
        Solutions { residual: self.residual(&u, loads, &start), u }
    }

    /// The residual as it is, not as the recurrence has it.
    fn residual(&self, u: &Mat<f64>, loads: MatRef<'_, f64>, start: &[f64]) -> f64 {
        let n_i = self.partition.n_internal;
        let mut left = product(&self.partition.stiffness, u.as_ref());
        left *= faer::Scale(-1.0);
        let mut interface = left.as_mut().subrows_mut(n_i, loads.nrows());
        interface += loads;
        self.equilibrate(&mut left);
        let z = self.precondition(&left);
        largest_ratio(&column_products(&left, &z), start)
    }
}

fn column_products(a: &Mat<f64>, b: &Mat<f64>) -> Vec<f64> {
    (0..a.ncols()).map(|j| dense::dot(dense::column(a.as_ref(), j), dense::column(b.as_ref(), j))).collect()
}

/// The largest √(a/b).
fn largest_ratio(a: &[f64], b: &[f64]) -> f64 {
    // Rounding may leave a square below zero; what is left of nothing, or is no number, is no small error.
    let ratio = |(a, b): (&f64, &f64)| if *a <= 0.0 { 0.0 } else { (a / b).sqrt() };
    dense::worst(a.iter().zip(b).map(ratio))
}
