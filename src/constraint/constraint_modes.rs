//! Constraint modes: unit displacements of the interface, one at a time.

use faer::linalg::solvers::SolveLstsq;
use faer::{Mat, MatMut, MatRef};

use crate::dense;
use crate::factor::Cholesky;
use crate::partition::Partition;
use crate::rigid::{RigidBodyModes, scales, unit_motions};
use crate::sparse::absolute_energy;
use crate::sparse::product;

/// Ψ_S with what it took to make it exact.
#[derive(Clone, Debug)]
pub struct ConstraintModes {
    /// Ψ_S, n_I × n_B, corrected.
    pub modes: Mat<f64>,
    /// The correction at the interface.
    pub carried: Carried,
    /// K̂_BB = [Ψ_S; I]ᵀ K [Ψ_S; I], n_B × n_B: second order in the error of Ψ_S.
    pub stiffness: Mat<f64>,
    /// max (|Ψ|ᵀ|K||Ψ|)_ii / K_BB,ii over the interface dofs: rounding of K̂_BB is ε times this, relative to the stiffness of
    /// the interface before condensation.
    pub cancellation: f64,
    /// Error of equation (24) as solved: max |Ψ_S U_B − U_I| / max |U_I|.
    pub raw_rigid_error: f64,
    /// Error of equation (24) after the correction, and the dof it is worst at.
    pub rigid_error: (f64, usize),
}

/// The correction of Ψ_S as the interface sees it.
///
/// Ψ_S is corrected by (U_I − Ψ_S U_B) U_B⁺ and its transpose, which hands loads on to the interface, by the transpose of that. Of
/// loads without resultant, Uᵀf = 0, nothing but the interface is needed for it: with g = f_B + Ψ_Sᵀ f_I before the correction,
/// g − (U_B U_B⁺)ᵀ g after it.
#[derive(Clone, Debug)]
pub struct Carried {
    /// U_B, n_B × n_r; no columns where nothing was corrected.
    motions: Mat<f64>,
    /// U_B⁺, n_r × n_B.
    lift: Mat<f64>,
}

impl Carried {
    /// U_B⁺, n_r × n_B.
    pub fn lift(&self) -> MatRef<'_, f64> {
        self.lift.as_ref()
    }

    /// No correction of an interface of n_B dofs.
    fn nothing(n_b: usize) -> Self {
        Self { motions: Mat::zeros(n_b, 0), lift: Mat::zeros(0, n_b) }
    }

    /// G ← G − (U_B U_B⁺)ᵀ G: what the corrected Ψ_Sᵀ makes of loads without resultant, from what −K_BI K_II⁻¹ made of them.
    pub fn correct(&self, interface_loads: MatMut<'_, f64>) {
        if self.motions.ncols() > 0 {
            let along = dense::gram(self.motions.as_ref(), interface_loads.as_ref());
            dense::add_product(interface_loads, -1.0, self.lift.transpose(), along.as_ref());
        }
    }
}

/// Ψ_S = −K_II⁻¹ K_IB (23), then Ψ_S ← Ψ_S + (U_I − Ψ_S U_B) U_B⁺.
///
/// The correction has rank n_r and removes exactly the part of the error that the condition of K_II amplifies: after
/// it the interface carries every rigid-body motion to rounding, and with it the mass properties.
pub fn constraint_modes(partition: &Partition, factor: &Cholesky<'_>, rigid: &RigidBodyModes) -> ConstraintModes {
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let mut modes = factor.follow_border(Mat::<f64>::identity(n_b, n_b).as_ref());
    let u_i = rigid.orthonormal.as_ref().subrows(0, n_i);
    let u_b = rigid.orthonormal.as_ref().subrows(n_i, n_b);
    let scale = scales(partition);
    let mut raw_rigid_error = 0.0;
    let mut carried = Carried::nothing(n_b);
    // Without an interface there is nothing to be carried.
    let is_carried = rigid.count() > 0 && n_b > 0;
    if is_carried {
        raw_rigid_error = rigid_error(&scale, modes.as_ref(), (u_i, u_b)).0;
        // Any basis of the motions serves; those of unit length U_B⁺ can tell apart whatever the mass they move.
        let unit = unit_motions(partition, rigid).unwrap_or_else(|_| rigid.orthonormal.clone());
        let (u_i, u_b) = unit.as_ref().split_at_row(n_i);
        let defect = defect(modes.as_ref(), u_i, u_b);
        carried = Carried { motions: u_b.to_owned(), lift: left_inverse(partition, u_b) };
        dense::add_product(modes.as_mut(), 1.0, defect.as_ref(), carried.lift.as_ref());
    }
    let rigid_error = if is_carried { rigid_error(&scale, modes.as_ref(), (u_i, u_b)) } else { (0.0, 0) };
    let (stiffness, cancellation) = condensed_stiffness(partition, modes.as_ref());
    ConstraintModes { modes, carried, stiffness, cancellation, raw_rigid_error, rigid_error }
}

/// U_I − Ψ_S U_B, n_I × n_r.
fn defect(modes: MatRef<'_, f64>, u_i: MatRef<'_, f64>, u_b: MatRef<'_, f64>) -> Mat<f64> {
    let mut defect = u_i.to_owned();
    dense::add_product(defect.as_mut(), -1.0, modes, u_b);
    defect
}

/// Largest defect of a rigid-body mode relative to the largest displacement of the mode, both in the scales of the dofs, and
/// where it is.
///
/// A mode that moves interface dofs alone, that of a free mass at the interface, is measured by those.
fn rigid_error(scale: &[f64], modes: MatRef<'_, f64>, (u_i, u_b): (MatRef<'_, f64>, MatRef<'_, f64>)) -> (f64, usize) {
    let defect = defect(modes, u_i, u_b);
    let (internal, interface) = scale.split_at(u_i.nrows());
    let mut worst = (0.0, 0);
    for j in 0..defect.ncols() {
        let size = |u: MatRef<'_, f64>, scale: &[f64]| {
            dense::column(u, j).iter().zip(scale).fold(0.0f64, |max, (value, d)| max.max((value * d).abs()))
        };
        let largest = if size(u_i, internal) > 0.0 { size(u_i, internal) } else { size(u_b, interface) };
        for (i, (value, d)) in dense::column(defect.as_ref(), j).iter().zip(internal).enumerate() {
            let error = (value * d).abs() / largest;
            if dense::worse(error, worst.0) {
                worst = (error, i);
            }
        }
    }
    worst
}

/// A matrix U_B⁺ with U_B⁺ U_B = I, n_r × n_B: least squares with rows weighted by stiffness, so that translations and
/// rotations count alike whatever their units.
fn left_inverse(partition: &Partition, u_b: MatRef<'_, f64>) -> Mat<f64> {
    let (n_i, n_b) = (partition.n_internal, u_b.nrows());
    let diagonal = |i: usize| partition.stiffness.get(n_i + i, n_i + i).copied().unwrap_or(0.0);
    let weight: Vec<f64> = (0..n_b).map(|i| if diagonal(i) > 0.0 { diagonal(i).sqrt() } else { 1.0 }).collect();
    let weighted = Mat::from_fn(n_b, u_b.ncols(), |i, j| weight[i] * u_b[(i, j)]);
    let weights = Mat::from_fn(n_b, n_b, |i, j| if i == j { weight[i] } else { 0.0 });
    weighted.qr().solve_lstsq(&weights)
}

/// K̂_BB and how far its terms cancel.
fn condensed_stiffness(partition: &Partition, modes: MatRef<'_, f64>) -> (Mat<f64>, f64) {
    let (n_i, n_b) = (modes.nrows(), modes.ncols());
    let mut psi = Mat::zeros(partition.n_dofs(), n_b);
    psi.as_mut().subrows_mut(0, n_i).copy_from(modes);
    psi.as_mut().subrows_mut(n_i, n_b).copy_from(Mat::<f64>::identity(n_b, n_b));
    let mut stiffness = dense::gram(psi.as_ref(), product(&partition.stiffness, psi.as_ref()).as_ref());
    dense::symmetrise(&mut stiffness);
    let terms = absolute_energy(&partition.stiffness, psi.as_ref());
    let ratio = |(i, terms): (usize, f64)| {
        let uncondensed = partition.stiffness.get(n_i + i, n_i + i).copied().unwrap_or(0.0);
        if uncondensed > 0.0 { terms / uncondensed } else { 1.0 }
    };
    (stiffness, terms.into_iter().enumerate().map(ratio).fold(1.0, f64::max))
}
