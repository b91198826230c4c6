//! The correction of rank n_r that makes constraint modes carry rigid-body motion exactly (24).

use faer::linalg::solvers::SolveLstsq;
use faer::{Mat, MatMut, MatRef};

use super::static_modes::StaticModes;
use crate::dense;
use crate::partition::Partition;
use crate::rigid::scales;
use crate::sparse::{diagonal, panels};

/// Share of the largest displacement of the interface, in the scales of its dofs, below which a motion leaves a dof at rest: modes of the matrices
/// have rounding there, which carries nothing and is the size of nothing.
const AT_REST: f64 = 1e-8;

/// The correction of Ψ_S as the interface sees it.
///
/// Ψ_S is corrected by (U_I − Ψ_S U_B) U_B⁺ and its transpose, which hands loads on to the interface, by the transpose of that. Of
/// loads without resultant, Uᵀf = 0, nothing but the interface is needed for it: with g = f_B + Ψ_Sᵀ f_I before the correction,
/// g − (U_B U_B⁺)ᵀ g after it.
#[derive(Clone, Debug)]
pub struct Carried {
    /// U_B, n_B × n_r; no columns where nothing was corrected.
    pub(super) motions: Mat<f64>,
    /// U_B⁺, n_r × n_B.
    pub(super) lift: Mat<f64>,
}

impl Carried {
    /// U_B⁺, n_r × n_B.
    pub fn lift(&self) -> MatRef<'_, f64> {
        self.lift.as_ref()
    }

    /// No correction of an interface of n_B dofs.
    pub(super) fn nothing(n_b: usize) -> Self {
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

/// U_I − Ψ_S U_B, n_I × n_r.
pub(super) fn defect(modes: &StaticModes<'_>, u_i: MatRef<'_, f64>, u_b: MatRef<'_, f64>) -> Mat<f64> {
    let mut defect = u_i.to_owned();
    modes.add_followed(defect.as_mut(), -1.0, u_b);
    defect
}

/// The largest defect of equation (24), and where it is.
#[derive(Clone, Copy, Debug, Default)]
pub struct RigidError {
    /// max |Ψ_S U_B − U_I| / max |U_I| of one rigid-body mode, both in the scales of the dofs.
    pub value: f64,
    /// The rigid-body mode and the internal dof; absent where there is no defect at all.
    pub at: Option<(usize, usize)>,
}

/// Largest defect of a rigid-body mode relative to the largest displacement of the mode.
///
/// Rounding of a dof is relative to its own scale, and a motion may be small in the dofs of the largest one. A mode that moves
/// interface dofs alone, that of a free mass at the interface or of a part that a hinge leaves to one, is measured by those; modes of the
/// matrices and of mechanisms have rounding inside instead of nothing.
pub fn rigid_error(partition: &Partition, modes: &StaticModes<'_>, u: MatRef<'_, f64>) -> RigidError {
    let (u_i, u_b) = u.split_at_row(partition.n_internal);
    let defect = defect(modes, u_i, u_b);
    let scale = scales(partition);
    let (internal, interface) = scale.split_at(partition.n_internal);
    let mut worst = RigidError::default();
    for j in 0..defect.ncols() {
        let size = |u: MatRef<'_, f64>, scale: &[f64]| {
            dense::column(u, j).iter().zip(scale).fold(0.0f64, |max, (value, d)| max.max((value * d).abs()))
        };
        let [inner, outer] = [size(u_i, internal), size(u_b, interface)];
        let largest = if inner > AT_REST * outer { inner } else { outer };
        for (i, (value, d)) in dense::column(defect.as_ref(), j).iter().zip(internal).enumerate() {
            let error = (value * d).abs() / largest;
            if dense::worse(error, worst.value) {
                worst = RigidError { value: error, at: Some((j, i)) };
            }
        }
    }
    worst
}

/// Least weight of an interface dof in [`left_inverse`], relative to the root of its stiffness: dofs that move nothing inside count
/// where no other ones carry a motion.
const LEAST_WEIGHT: f64 = 1e-6;

/// A matrix U_B⁺ with U_B⁺ U_B = I, n_r × n_B: least squares with rows weighted by what the solves of their columns lack.
///
/// Backward errors of a solve are ε|K_II||ψ|, so that the root of ψᵀ diag(K_II) ψ measures them, whatever the units. A column that moves
/// little inside is nearly right and takes little of the correction: on a long part that two neighbouring nodes hold, the one that no
/// internal dof touches would otherwise take the error of the other one, times the length of the part over their distance.
pub(crate) fn left_inverse(partition: &Partition, modes: MatRef<'_, f64>, u_b: MatRef<'_, f64>) -> Mat<f64> {
    left_inverse_by(partition, &weights_inside(partition, modes), u_b)
}

/// U_B⁺ of [`left_inverse`] by constraint modes that are made some columns at a time.
pub(super) fn left_inverse_of(partition: &Partition, modes: &StaticModes<'_>, u_b: MatRef<'_, f64>) -> Mat<f64> {
    let of_panel = |columns| weights_inside(partition, modes.columns(columns).as_ref());
    let inside: Vec<f64> = panels(modes.n_interface()).flat_map(of_panel).collect();
    left_inverse_by(partition, &inside, u_b)
}

/// ψᵀ diag(K_II) ψ of some constraint modes.
fn weights_inside(partition: &Partition, modes: MatRef<'_, f64>) -> Vec<f64> {
    let stiffness = diagonal(&partition.stiffness);
    let weight = |j: usize| dense::column(modes, j).iter().zip(&stiffness).map(|(psi, k)| psi * psi * k).sum();
    (0..modes.ncols()).map(weight).collect()
}

/// The matrix of [`left_inverse`] by what the solve of each column lacks, squared.
pub(super) fn left_inverse_by(partition: &Partition, inside: &[f64], u_b: MatRef<'_, f64>) -> Mat<f64> {
    let n_b = u_b.nrows();
    let outer = diagonal(&partition.stiffness).split_off(partition.n_internal);
    let own = |j: usize| (inside[j] + LEAST_WEIGHT * LEAST_WEIGHT * outer[j]).max(0.0).sqrt();
    let length = |j: usize| (0..u_b.ncols()).map(|k| u_b[(j, k)].powi(2)).sum::<f64>().sqrt();
    let scale = scales(partition).split_off(partition.n_internal);
    let largest = (0..n_b).map(|j| scale[j] * length(j)).fold(0.0, f64::max);
    let moves = |j: usize| scale[j] * length(j) > AT_REST * largest;
    // A dof without stiffness has no error, and may be the only one of a motion: it counts as much as the least of the others that move, and
    // where nothing but rounding moves it not at all.
    let sizes = (0..n_b).filter(|j| moves(*j)).map(|j| own(j) * length(j));
    let least = sizes.filter(|size| *size > 0.0).reduce(f64::min).unwrap_or(1.0);
    let weight = |j: usize| match own(j) {
        own if own > 0.0 => own,
        _ if moves(j) => least / length(j),
        _ => 0.0,
    };
    let weight: Vec<f64> = (0..n_b).map(weight).collect();
    let weighted = Mat::from_fn(n_b, u_b.ncols(), |i, j| weight[i] * u_b[(i, j)]);
    let weights = Mat::from_fn(n_b, n_b, |i, j| if i == j { weight[i] } else { 0.0 });
    weighted.qr().solve_lstsq(&weights)
}
