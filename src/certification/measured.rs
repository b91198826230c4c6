//! What is measured of each pair by itself.

use faer::{Mat, MatRef};

use super::claims::Claims;
use crate::dense;
use crate::eigen::{Equilibrated, ModalProblem, ModeError, ShiftInvert, rayleigh_quotients};
use crate::sparse::panels;

/// What is measured of the pairs of a result.
pub(super) struct Measured {
    /// ρ, in scaled units.
    pub(super) lambda: Vec<f64>,
    /// What rounding and the digits of K and M leave open of each ρ, and what else is known of it.
    pub(super) errors: Vec<ModeError>,
    /// δ.
    pub(super) lacking: Vec<f64>,
    /// Normwise backward error of each shape with its own quotient (M-01).
    pub(super) backward: Vec<f64>,
    /// The dof where that residual is largest.
    pub(super) worst: Vec<usize>,
    /// QᵀMx: each shape along the rigid-body modes, n_r × k.
    pub(super) along_rigid: Mat<f64>,
    /// σ.
    pub(super) sigma: f64,
}

impl Measured {
    /// Measures all pairs; `operator` is (K − σM)⁻¹ with a definite matrix.
    pub(super) fn of(problem: ModalProblem<'_>, operator: &dyn ShiftInvert, claims: &Claims) -> Self {
        let norms = Equilibrated::of(problem.pencil());
        let mut found = Self {
            lambda: Vec::new(),
            errors: Vec::new(),
            lacking: Vec::new(),
            backward: Vec::new(),
            worst: Vec::new(),
            along_rigid: dense::gram(problem.deflated[1], claims.shapes.as_ref()),
            sigma: operator.shift(),
        };
        for panel in panels(claims.count()) {
            let shapes = claims.shapes.as_ref().get(.., panel.clone());
            let (lambda, errors, residual) = rayleigh_quotients(problem, shapes);
            found.lacking.extend(lacking(operator, &lambda, residual.as_ref()));
            found.backward.extend(errors.iter().map(|error| error.backward));
            let worst = (0..panel.len()).map(|at| norms.largest(dense::column(residual.as_ref(), at)));
            found.worst.extend(worst);
            found.lambda.extend(lambda);
            found.errors.extend(errors);
        }
        found
    }

    /// ‖QᵀMx‖²: the share of the modal mass that is rigid-body motion.
    pub(super) fn rigid_share(&self, claim: usize) -> f64 {
        dense::column(self.along_rigid.as_ref(), claim).iter().map(|along| along * along).sum()
    }
}

/// δ of shapes with these quotients and residuals. A quotient at or below σ belongs to no shape: nothing is known of it.
pub(super) fn lacking(operator: &dyn ShiftInvert, lambda: &[f64], residual: MatRef<'_, f64>) -> Vec<f64> {
    let energies = operator.compliances(residual);
    let of_pair = |(energy, lambda): (&f64, &f64)| {
        let distance = lambda - operator.shift();
        if distance > 0.0 { (energy.max(0.0) / distance).sqrt() } else { f64::INFINITY }
    };
    energies.iter().zip(lambda).map(of_pair).collect()
}
