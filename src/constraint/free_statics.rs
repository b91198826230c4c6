//! The static answers to some interface dofs alone, the others held: what the operator at zero of a mixed boundary is made of.

use faer::Mat;

use super::free_at_zero::FreeAtZero;
use super::static_modes::StaticModes;
use crate::dense;
use crate::error::Result;
use crate::factor::Cholesky;
use crate::rigid::RigidBodyModes;
use crate::sparse::{Leading, product};

/// Ψ_S of the interface dofs that are free, and the stiffness that they see.
pub struct FreeStatics<'a> {
    factor: &'a Cholesky<'a>,
    /// K without the dofs that are held, n_I + n_F.
    stiffness: Leading<'a>,
    /// −K_II⁻¹ K_IF, n_I × n_F, as a solve leaves it.
    constraint_modes: StaticModes<'static>,
    /// S = K_FF + K_FI Ψ_S, n_F × n_F.
    schur: Mat<f64>,
}

impl<'a> FreeStatics<'a> {
    /// Solves for the answers to the interface dofs that are free, `free` of `n_b`; `stiffness` has them after the internal dofs.
    ///
    /// The loads of a support have a resultant, and what K does not know of rigid-body motion is part of what holds it: Ψ_S is not
    /// corrected.
    pub fn of(factor: &'a Cholesky<'a>, stiffness: Leading<'a>, (free, n_b): (&[usize], usize)) -> Self {
        let unit = Mat::from_fn(n_b, free.len(), |i, j| f64::from(u8::from(i == free[j])));
        let constraint_modes = factor.follow_border(unit.as_ref());
        let identity = Mat::<f64>::identity(free.len(), free.len());
        let psi = faer::concat![[constraint_modes.as_ref()], [identity.as_ref()]];
        let mut schur = dense::gram(psi.as_ref(), product(stiffness, psi.as_ref()).as_ref());
        dense::symmetrise(&mut schur);
        let constraint_modes = StaticModes::stored(constraint_modes);
        Self { factor, stiffness, constraint_modes, schur }
    }

    /// The operator at zero; `rigid` are the motions that pass, which are deflated.
    ///
    /// # Errors
    /// S has more zero-energy motions than there are rigid-body motions that pass: a mechanism.
    pub fn operator(&'a self, rigid: &RigidBodyModes) -> Result<FreeAtZero<'a>> {
        let condensed = (self.constraint_modes.clone(), self.schur.as_ref());
        FreeAtZero::uncorrected(self.factor, self.stiffness, condensed, rigid)
    }
}
