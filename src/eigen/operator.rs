//! The shift-invert operators that the eigensolvers iterate with.

use faer::{MatMut, MatRef};

use crate::dense;
use crate::factor::SolveOperator;

/// X ← (K − σM)⁻¹ F on blocks.
pub trait ShiftInvert: Sync {
    /// Order of K.
    fn n(&self) -> usize;

    /// σ.
    fn shift(&self) -> f64;

    /// Replaces forces by displacements; on a free component the forces are self-equilibrated.
    fn solve_in_place(&self, block: MatMut<'_, f64>);

    /// fᵀ(K − σM)⁻¹f of each column of loads that nothing has to be taken out of.
    fn compliances(&self, loads: MatRef<'_, f64>) -> Vec<f64> {
        let mut x = loads.to_owned();
        self.solve_in_place(x.as_mut());
        dense::dots(loads, x.as_ref())
    }

    /// Bytes that one application reads; they decide how many right-hand sides it is given at once. Few unless said otherwise.
    fn bytes(&self) -> u64 {
        0
    }
}

/// A factor of K − σM used as it is.
pub struct Factored<'a> {
    factor: &'a dyn SolveOperator,
    sigma: f64,
}

impl<'a> Factored<'a> {
    /// The operator of a factor of K − σM.
    pub fn new(factor: &'a dyn SolveOperator, sigma: f64) -> Self {
        Self { factor, sigma }
    }
}

impl ShiftInvert for Factored<'_> {
    fn n(&self) -> usize {
        self.factor.n()
    }

    fn shift(&self) -> f64 {
        self.sigma
    }

    fn solve_in_place(&self, block: MatMut<'_, f64>) {
        self.factor.solve_in_place(block);
    }

    fn compliances(&self, loads: MatRef<'_, f64>) -> Vec<f64> {
        self.factor.compliances(loads)
    }

    fn bytes(&self) -> u64 {
        self.factor.bytes()
    }
}
