//! The shift-invert operator of a free component at shift zero, from the factor of K_II and the constraint modes.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, MatMut, MatRef, Side};

use super::{Carried, ConstraintModes, StaticModes};
use crate::dense;
use crate::eigen::ShiftInvert;
use crate::error::{Error, Result};
use crate::factor::SolveOperator;
use crate::random::SplitMix64;
use crate::rigid::RigidBodyModes;
use crate::sparse::diagonal;
use crate::sparse::{Leading, product};

/// K⁺ of a free component from the factor of K_II alone, at shift zero.
///
/// ```text
/// y   = K_II⁻¹ f_I                       S = Ψᵀ K Ψ of Ψ = [Ψ_S; I], null space U_B
/// x_B = S⁺ (f_B + Ψ_Sᵀ f_I)              Ψ_Sᵀ f_I = −K_BI y, but for the correction of Ψ_S
/// x_I = y + Ψ_S x_B
/// ```
/// For a self-equilibrated load x is the elastic displacement up to a rigid-body motion, which deflation removes. The
/// factor that makes the constraint modes thus serves the free-free modes too.
///
/// Loads go to the interface by the transpose of what displacements come from it by. K of few digits has KU ≠ 0, the correction of
/// Ψ_S is of that size, and with it on one side alone the operator would be as unsymmetric, which no Lanczos iteration
/// survives. With it on both sides this is the inverse, but for U, of a symmetric matrix that differs from K by the forces KU.
pub struct FreeAtZero<'a> {
    factor: &'a dyn SolveOperator,
    stiffness: Leading<'a>,
    constraint_modes: StaticModes<'a>,
    carried: Option<&'a Carried>,
    schur: Schur,
}

/// An operator at zero after some steps of refinement: Σ (I − A K)ᵏ A with k up to their number, on the space without rigid-body motion, as
/// symmetric as A.
///
/// What A leaves of a load, the forces KU that K of few digits has, is a share of it that each step multiplies by itself once more. A motion so
/// soft that these forces are a hundredth of its own takes several steps.
pub struct RefinedAtZero<'a> {
    operator: &'a FreeAtZero<'a>,
    rigid: &'a RigidBodyModes,
    n_steps: usize,
}

/// Share that refinement may leave: a few roundings.
const LEFT_BY_REFINEMENT: f64 = 1e-14;
/// What one probe shows of the share, at least: in inertia, where the softest motions are most of it.
const SHOWN_BY_A_PROBE: f64 = 1.0 / 3.0;
/// The largest share that is refined: it takes a dozen steps.
const MOST_REFINED: f64 = 0.1;
/// Seed of the probe.
const SEED: u64 = 0x4ef1_4e5d;

impl<'a> RefinedAtZero<'a> {
    /// The operator with the motions that are deflated, in as many steps as it takes; none where refinement does not help.
    pub fn new(operator: &'a FreeAtZero<'a>, rigid: &'a RigidBodyModes, mass: Leading<'_>) -> Option<Self> {
        let unrefined = Self { operator, rigid, n_steps: 0 };
        let mut probe = Mat::zeros(operator.n(), 1);
        SplitMix64::new(SEED).fill(probe.as_mut());
        let mut load = product(mass, probe.as_ref());
        unrefined.equilibrate(&mut load);
        let answer = unrefined.answer(load.clone());
        let correction = unrefined.answer(unrefined.left(&load, &answer));
        let length = |x: &Mat<f64>| dense::dots(x.as_ref(), product(mass, x.as_ref()).as_ref())[0].max(0.0).sqrt();
        let share = length(&correction) / (SHOWN_BY_A_PROBE * length(&answer));
        if share.is_nan() || share > MOST_REFINED {
            return None;
        }
        // shareⁿ⁺¹ is left after n steps.
        let n_steps = (1..).find(|n| share.powi(n + 1) <= LEFT_BY_REFINEMENT)?;
        Some(Self { n_steps: n_steps as usize, ..unrefined })
    }

    /// Takes rigid-body resultants out of loads.
    fn equilibrate(&self, loads: &mut Mat<f64>) {
        let resultant = dense::gram(self.rigid.orthonormal.as_ref(), loads.as_ref());
        dense::add_product(loads.as_mut(), -1.0, self.rigid.mass_orthonormal.as_ref(), resultant.as_ref());
    }

    /// What is left of loads by some displacements, without resultants.
    fn left(&self, loads: &Mat<f64>, displacements: &Mat<f64>) -> Mat<f64> {
        let mut left = loads - product(self.operator.stiffness, displacements.as_ref());
        self.equilibrate(&mut left);
        left
    }

    /// A of loads, without rigid-body motion.
    fn answer(&self, mut loads: Mat<f64>) -> Mat<f64> {
        self.operator.solve_in_place(loads.as_mut());
        let motion = dense::gram(self.rigid.mass_orthonormal.as_ref(), loads.as_ref());
        dense::add_product(loads.as_mut(), -1.0, self.rigid.orthonormal.as_ref(), motion.as_ref());
        loads
    }
}

impl ShiftInvert for RefinedAtZero<'_> {
    fn n(&self) -> usize {
        self.operator.n()
    }

    fn shift(&self) -> f64 {
        0.0
    }

    fn solve_in_place(&self, mut block: MatMut<'_, f64>) {
        let loads = block.to_owned();
        let mut answers = self.answer(loads.clone());
        for _ in 0..self.n_steps {
            answers += self.answer(self.left(&loads, &answers));
        }
        block.copy_from(&answers);
    }

    fn bytes(&self) -> u64 {
        (self.n_steps as u64 + 1) * self.operator.bytes()
    }
}

/// S + α Z Zᵀ in scaled coordinates, with Z an orthonormal basis of U_B: S⁺ on self-equilibrated interface loads.
struct Schur {
    scale: Vec<f64>,
    rigid: Mat<f64>,
    factor: Llt<f64>,
}

impl<'a> FreeAtZero<'a> {
    /// The operator from the factor of K_II and the constraint modes, of loads without resultant.
    ///
    /// # Errors
    /// S has more zero-energy motions than there are rigid-body modes: a mechanism.
    pub fn new(
        factor: &'a dyn SolveOperator,
        stiffness: impl Into<Leading<'a>>,
        constraint: &'a ConstraintModes<'_>,
        rigid: &RigidBodyModes,
    ) -> Result<Self> {
        let condensed = (constraint.modes.clone(), constraint.stiffness.as_ref());
        let operator = Self::uncorrected(factor, stiffness, condensed, rigid)?;
        Ok(Self { carried: Some(&constraint.carried), ..operator })
    }

    /// The operator for any loads, with Ψ_S = −K_II⁻¹ K_IB (n_I × n_B) as a solve leaves it and S = K_BB + K_BI Ψ_S.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn uncorrected(
        factor: &'a dyn SolveOperator,
        stiffness: impl Into<Leading<'a>>,
        (constraint_modes, schur): (StaticModes<'a>, MatRef<'_, f64>),
        rigid: &RigidBodyModes,
    ) -> Result<Self> {
        let stiffness = stiffness.into();
        // The stiffness of the interface before condensation: what is left of it may be nothing where the interface just
        // holds the component, and rounding of S is relative to it.
        let uncondensed = diagonal(stiffness).split_off(factor.n());
        let schur = Schur::new(schur, rigid.orthonormal.as_ref().subrows(factor.n(), schur.nrows()), &uncondensed)?;
        Ok(Self { factor, stiffness, constraint_modes, carried: None, schur })
    }
}

impl Schur {
    fn new(schur: MatRef<'_, f64>, u_b: MatRef<'_, f64>, uncondensed: &[f64]) -> Result<Self> {
        let n_b = schur.nrows();
        let scale: Vec<f64> = uncondensed.iter().map(|d| dense::power_of_two_root(*d)).collect();
        let mut scaled = Mat::from_fn(n_b, n_b, |i, j| schur[(i, j)] * scale[i] * scale[j]);
        // In scaled coordinates the null space is D⁻¹ U_B.
        let unscaled = Mat::from_fn(n_b, u_b.ncols(), |i, j| u_b[(i, j)] / scale[i]);
        let rigid = if u_b.ncols() > 0 { unscaled.qr().compute_thin_Q() } else { Mat::zeros(n_b, 0) };
        // The terms of S are of order one in these scales, so adding Z Zᵀ lifts the null space above their rounding.
        dense::add_product(scaled.as_mut(), 1.0, rigid.as_ref(), rigid.transpose());
        dense::symmetrise(&mut scaled);
        let (eigenvalues, _) = dense::symmetric_eigen(scaled.as_ref())?;
        let (least, most) = (eigenvalues.first().copied().unwrap_or(1.0), eigenvalues.last().copied().unwrap_or(1.0));
        if least <= n_b as f64 * f64::EPSILON * most {
            let n_more = eigenvalues.iter().filter(|value| **value <= n_b as f64 * f64::EPSILON * most).count();
            return Err(Error::Mechanism { n_rigid: u_b.ncols(), n_more });
        }
        let factor = scaled.llt(Side::Lower).map_err(|_| Error::Mechanism { n_rigid: u_b.ncols(), n_more: 1 })?;
        Ok(Self { scale, rigid, factor })
    }

    fn solve(&self, loads: MatRef<'_, f64>) -> Mat<f64> {
        let mut x = Mat::from_fn(loads.nrows(), loads.ncols(), |i, j| loads[(i, j)] * self.scale[i]);
        let resultant = dense::gram(self.rigid.as_ref(), x.as_ref());
        dense::add_product(x.as_mut(), -1.0, self.rigid.as_ref(), resultant.as_ref());
        self.factor.solve_in_place(x.as_mut());
        Mat::from_fn(x.nrows(), x.ncols(), |i, j| x[(i, j)] * self.scale[i])
    }
}

impl ShiftInvert for FreeAtZero<'_> {
    fn n(&self) -> usize {
        self.stiffness.rows()
    }

    fn shift(&self) -> f64 {
        0.0
    }

    fn solve_in_place(&self, mut block: MatMut<'_, f64>) {
        let n_i = self.factor.n();
        let n_b = block.nrows() - n_i;
        self.factor.solve_in_place(block.as_mut().subrows_mut(0, n_i));
        let mut loads = block.as_ref().subrows(n_i, n_b).to_owned();
        for b in 0..n_b {
            for j in 0..block.ncols() {
                let y = &dense::column(block.as_ref(), j)[..n_i];
                let internal = self.stiffness.entries(n_i + b).filter(|(col, _)| *col < n_i);
                loads[(b, j)] -= internal.map(|(col, value)| value * y[col]).sum::<f64>();
            }
        }
        if let Some(carried) = self.carried {
            carried.correct(loads.as_mut());
        }
        let x_b = self.schur.solve(loads.as_ref());
        self.constraint_modes.add_followed(block.as_mut().subrows_mut(0, n_i), 1.0, x_b.as_ref());
        block.subrows_mut(n_i, n_b).copy_from(&x_b);
    }

    fn bytes(&self) -> u64 {
        self.factor.bytes()
    }
}
