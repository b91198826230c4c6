//! Static answers of the interior while the interface is held, by conjugate gradients on K_II.
//!
//! ```text
//! K_II x = f              n_I × k
//! K_II − σM_II = L Lᵀ     σ < 0, the preconditioner: a [`Nearby`] one
//! ```
//! K_II (K_II − σM_II)⁻¹ has its eigenvalues between λ/(λ − σ) and 1, λ the first eigenvalue with the interface held. With
//! −σ a hundredth of the first elastic eigenvalue of the free component only motions that the interface hardly holds, as
//! many as there are rigid-body modes, are not next to 1: a dozen steps give every digit, and the answer is that of K,
//! whatever the factor.

use faer::{Mat, MatRef};

use super::nearby::Nearby;
use crate::dense;
use crate::error::Result;
use crate::factor::{Analysis, Cholesky, SolveOperator};
use crate::partition::Partition;
use crate::sparse::Pencil;
use crate::sparse::{panels, product};

/// −σ over the first elastic eigenvalue of the free component.
const SHIFT: f64 = 1e-2;
/// Steps after which an answer is taken as it is; its residual is a check.
const MAX_STEPS: usize = 200;
/// Residual, relative to the first, below which rounding is all that is left.
const SOLVED: f64 = 1e-15;
/// Residual at which a solution is known in size: the softest motion that the interface holds may have a millionth of it.
const KNOWN_IN_SIZE: f64 = 1e-6;
/// Steps without progress after which rounding is all that is left: twice the motions that the interface may hardly hold, for which the
/// residual grows before it falls.
const STALLED: usize = 12;

/// The interior with a factor of K_II − σM_II.
pub(super) struct Interior<'a> {
    pencil: Pencil<'a>,
    pub(super) factor: Cholesky<'a>,
    /// σ < 0.
    pub(super) sigma: f64,
}

/// How well static answers solve their equations, the worst of them: energies relative to those of the answers, as ratios of lengths.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Solved {
    /// Of what is left of the load.
    pub(super) residual: f64,
    /// Of what rounding of the terms of the equations makes.
    pub(super) rounding: f64,
}

/// Solutions of K_II x = f.
pub(super) struct Answers {
    /// x, n_I × k.
    pub(super) x: Mat<f64>,
    /// (K_II − σM_II)⁻¹ (f − K_II x), n_I × k: what x lacks, but for the share of σ.
    pub(super) errors: Mat<f64>,
    /// The largest energy of such an error relative to that of its solution, as a ratio of lengths.
    pub(super) residual: f64,
}

impl<'a> Interior<'a> {
    /// Factors K_II − σM_II; `first` is the first elastic eigenvalue of the free component.
    ///
    /// # Errors
    /// K_II − σM_II is not definite; no memory.
    pub(super) fn new(partition: &'a Partition, analysis: &'a Analysis, first: f64) -> Result<Self> {
        let pencil = partition.internal();
        let Nearby { factor, sigma } =
            Nearby::new(partition, (analysis, pencil), -SHIFT * first, &|dof| partition.name_of(dof))?;
        Ok(Self { pencil, factor, sigma })
    }

    /// K_II⁻¹ F, panel by panel.
    pub(super) fn solve(&self, loads: MatRef<'_, f64>) -> Answers {
        let (n, k) = (loads.nrows(), loads.ncols());
        let nothing = || Mat::zeros(n, k);
        let mut answers = Answers { x: nothing(), errors: nothing(), residual: 0.0 };
        for columns in panels(k) {
            let f = loads.get(.., columns.clone());
            let x = self.iterate(f, SOLVED);
            let mut left = product(self.pencil.stiffness, x.as_ref());
            left *= faer::Scale(-1.0);
            left += f;
            let errors = self.precondition(&left);
            let energy = column_products(f, x.as_ref());
            let of_errors = column_products(left.as_ref(), errors.as_ref());
            answers.residual = dense::worst([answers.residual, largest_ratio(&of_errors, &energy)]);
            answers.x.as_mut().get_mut(.., columns.clone()).copy_from(x);
            answers.errors.as_mut().get_mut(.., columns).copy_from(errors);
        }
        answers
    }

    /// K_II⁻¹ G as far as its size goes, panel by panel.
    pub(super) fn known_in_size(&self, loads: MatRef<'_, f64>) -> Mat<f64> {
        let mut x = Mat::zeros(loads.nrows(), loads.ncols());
        for columns in panels(loads.ncols()) {
            let solved = self.iterate(loads.get(.., columns.clone()), KNOWN_IN_SIZE);
            x.as_mut().get_mut(.., columns).copy_from(solved);
        }
        x
    }

    fn precondition(&self, r: &Mat<f64>) -> Mat<f64> {
        let mut z = r.clone();
        self.factor.solve_in_place(z.as_mut());
        z
    }

    fn iterate(&self, loads: MatRef<'_, f64>, solved: f64) -> Mat<f64> {
        let mut residual = loads.to_owned();
        let mut u = Mat::zeros(residual.nrows(), residual.ncols());
        let mut direction = self.precondition(&residual);
        let start = column_products(residual.as_ref(), direction.as_ref());
        let (mut rho, mut best, mut since_best) = (start.clone(), f64::INFINITY, 0);
        for _ in 0..MAX_STEPS {
            let worst = largest_ratio(&rho, &start);
            since_best = if worst < best { 0 } else { since_best + 1 };
            best = best.min(worst);
            if worst <= solved || since_best >= STALLED {
                break;
            }
            let force = product(self.pencil.stiffness, direction.as_ref());
            let curvature = column_products(direction.as_ref(), force.as_ref());
            for j in 0..u.ncols() {
                let step = if curvature[j] > 0.0 { rho[j] / curvature[j] } else { 0.0 };
                dense::add_scaled(dense::column_mut(u.as_mut(), j), step, dense::column(direction.as_ref(), j));
                dense::add_scaled(dense::column_mut(residual.as_mut(), j), -step, dense::column(force.as_ref(), j));
            }
            let z = self.precondition(&residual);
            let next = column_products(residual.as_ref(), z.as_ref());
            for j in 0..u.ncols() {
                let ratio = if rho[j] > 0.0 { next[j] / rho[j] } else { 0.0 };
                let p = dense::column_mut(direction.as_mut(), j);
                p.iter_mut().zip(dense::column(z.as_ref(), j)).for_each(|(p, z)| *p = z + ratio * *p);
            }
            rho = next;
        }
        u
    }
}

/// x_jᵀ y_j.
pub(super) fn column_products(x: MatRef<'_, f64>, y: MatRef<'_, f64>) -> Vec<f64> {
    dense::dots(x, y)
}

/// The largest √(a/b).
fn largest_ratio(a: &[f64], b: &[f64]) -> f64 {
    // Rounding may leave a square below zero; what is left of nothing, or is not a number, is not a small error.
    let ratio = |(a, b): (&f64, &f64)| if *a <= 0.0 { 0.0 } else { (a / b).sqrt() };
    dense::worst(a.iter().zip(b).map(ratio))
}
