//! Answers of a free component to loads, with the inertia that these set free: what Rubin's static modes are made of where the interface
//! holds nothing.
//!
//! ```text
//! P    1 − Q (MQ)ᵀ             takes rigid-body motion out, Pᵀ what moves the component as a whole
//! x    P K⁺ Pᵀ f   n' × 1      Kx = Pᵀf, (MQ)ᵀx = 0
//! B    (K − σM)⁻¹, σ < 0       the preconditioner: on the elastic motions λ/(λ − σ) lies between 1/(1 − σ/λ₁) and one
//! ```
//! Conjugate gradients on the elastic motions, where K is definite. σ lies about as far below zero as the first elastic eigenvalue above it,
//! so that each step takes a factor of four or more of the error. Every load has scalars of its own: its answer does not depend on the others.

use std::borrow::Cow;

use faer::{Mat, MatRef};

use super::boundary_problem::BoundaryProblem;
use super::component::Component;
use crate::constraint::{Attachment, ConstraintModes};
use crate::dense;
use crate::eigen::{ModalProblem, ShiftInvert};
use crate::error::Result;
use crate::job::Boundary;
use crate::sparse::product;

/// Steps of conjugate gradients: a factor of four a step reaches rounding in thirty, and of two, where σ is ten times as far, in sixty.
const MAX_STEPS: usize = 100;
/// Length of a residual relative to the load, in the energy of the preconditioner, below which it is rounding.
const ROUNDING: f64 = f64::EPSILON;
/// Passes, each of which starts from the true residual: that of the recurrence drifts from it.
const PASSES: usize = 2;

/// The static modes of a component: what an interface makes of it that moves slowly.
#[derive(Debug)]
pub struct StaticSet<'a> {
    /// Constraint modes; Rubin's static modes where the interface leaves rigid-body motions free.
    pub constraint: Cow<'a, ConstraintModes<'a>>,
    /// Factorisations that they took in addition to that of the interior.
    pub n_more: usize,
}

impl<'a> StaticSet<'a> {
    /// Those that there are, or those of [`Attachment`].
    ///
    /// # Errors
    /// K − σM is not definite; a rigid-body motion without mass; [`crate::error::Error::AttachmentCondition`].
    pub fn of(component: Component<'a>) -> Result<Self> {
        match component.constraint {
            Some(constraint) => Ok(Self { constraint: Cow::Borrowed(constraint), n_more: 0 }),
            None => attached(component).map(|(modes, n_more)| Self { constraint: Cow::Owned(modes), n_more }),
        }
    }
}

fn attached(component: Component<'_>) -> Result<(ConstraintModes<'static>, usize)> {
    let (partition, n_b) = (component.partition, component.partition.n_interface());
    let unit = Mat::from_fn(partition.n_dofs(), n_b, |i, j| f64::from(u8::from(i == partition.n_internal + j)));
    let loads = dense::side_by_side(unit.as_ref(), partition.loads.vectors.as_ref());
    let problem = BoundaryProblem { component, boundary: Boundary::FreeInterface };
    let answer = |operator: &dyn ShiftInvert| Ok(answers(problem.modal(), operator, loads.as_ref()));
    let (answers, n_factorisations) = problem.with_operator_below(answer)?;
    let (modes, of_loads) = answers.as_ref().split_at_col(n_b);
    let attachment = Attachment::new(partition, modes.to_owned(), of_loads.to_owned())?;
    Ok((ConstraintModes::attached(partition, attachment)?, n_factorisations))
}

/// P K⁺ Pᵀ F by an operator below the spectrum: answers of a free component to loads, with the inertia that these set free.
pub(crate) fn answers(problem: ModalProblem<'_>, operator: &dyn ShiftInvert, loads: MatRef<'_, f64>) -> Mat<f64> {
    let balanced = balanced(problem, loads.to_owned());
    let mut x = Mat::zeros(loads.nrows(), loads.ncols());
    for _ in 0..PASSES {
        let mut residual = balanced.clone();
        residual -= product(problem.stiffness, x.as_ref());
        descend(problem, operator, &mut x, residual, balanced.as_ref());
    }
    elastic(problem, x)
}

/// Conjugate gradients from X and its residual F − KX.
fn descend(
    problem: ModalProblem<'_>,
    operator: &dyn ShiftInvert,
    x: &mut Mat<f64>,
    residual: Mat<f64>,
    loads: MatRef<'_, f64>,
) {
    let energies = |f: MatRef<'_, f64>| -> Vec<f64> {
        let mut z = f.to_owned();
        operator.solve_in_place(z.as_mut());
        dense::dots(f, elastic(problem, z).as_ref())
    };
    let least: Vec<f64> = energies(loads).into_iter().map(|energy| ROUNDING * ROUNDING * energy).collect();
    let mut residual = balanced(problem, residual);
    let (n, k) = residual.shape();
    let mut direction = Mat::<f64>::zeros(n, k);
    let mut before = vec![f64::INFINITY; k];
    let mut is_open = vec![true; k];
    for _ in 0..MAX_STEPS {
        let mut z = residual.clone();
        operator.solve_in_place(z.as_mut());
        let z = elastic(problem, z);
        let rho = dense::dots(residual.as_ref(), z.as_ref());
        for j in 0..k {
            // Of a residual that is rounding, so is the direction.
            is_open[j] &= rho[j] > least[j] && rho[j].is_finite();
            let beta = if before[j].is_finite() { rho[j] / before[j] } else { 0.0 };
            let own = dense::column_mut(direction.as_mut(), j);
            own.iter_mut().zip(dense::column(z.as_ref(), j)).for_each(|(p, z)| *p = z + beta * *p);
        }
        if !is_open.contains(&true) {
            return;
        }
        let image = product(problem.stiffness, direction.as_ref());
        let curvature = dense::dots(direction.as_ref(), image.as_ref());
        for j in (0..k).filter(|j| is_open[*j] && curvature[*j] > 0.0) {
            let alpha = rho[j] / curvature[j];
            dense::add_scaled(dense::column_mut(x.as_mut(), j), alpha, dense::column(direction.as_ref(), j));
            dense::add_scaled(dense::column_mut(residual.as_mut(), j), -alpha, dense::column(image.as_ref(), j));
        }
        before.clone_from(&rho);
        residual = balanced(problem, residual);
    }
}

/// Pᵀ F: loads with the inertia of the rigid-body acceleration that they set free.
fn balanced(problem: ModalProblem<'_>, mut loads: Mat<f64>) -> Mat<f64> {
    let [q, mass_q] = problem.deflated;
    let resultant = dense::gram(q, loads.as_ref());
    dense::add_product(loads.as_mut(), -1.0, mass_q, resultant.as_ref());
    loads
}

/// P X: motions without that of rigid bodies.
fn elastic(problem: ModalProblem<'_>, mut motions: Mat<f64>) -> Mat<f64> {
    let [q, mass_q] = problem.deflated;
    let along = dense::gram(mass_q, motions.as_ref());
    dense::add_product(motions.as_mut(), -1.0, q, along.as_ref());
    motions
}
