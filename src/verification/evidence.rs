//! What the checks look at, and how they name and scale it.

use faer::{Mat, MatRef};

use crate::basis::Basis;
use crate::constraint::ConstraintModes;
use crate::damping::Damping;
use crate::dense;
use crate::dofs::Direction;
use crate::eigen::Equilibrated;
use crate::factor::Cholesky;
use crate::job::Expectation;
use crate::modes::{Certificate, Retained};
use crate::partition::{DofOrigin, Partition, ReducedDof};
use crate::reduction::{Reduction, sizes_of_modes, transpose_apply};
use crate::rigid::{InterfaceRank, RigidBodyModes};
use crate::rubin::Rubin;
use crate::sparse::product;
use crate::unseen::UnseenMode;

use super::enclosure::Enclosures;

/// The six unit motions, the columns of U of one free body.
pub(super) const NAMES: [&str; 6] =
    ["translation x", "translation y", "translation z", "rotation x", "rotation y", "rotation z"];

/// Everything that the checks examine: the results of the stages.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a> {
    /// The partitioned matrices.
    pub partition: &'a Partition,
    /// The factor of K_II; of (K − σM)_II below the spectrum where the interface leaves rigid-body motions free.
    pub factor: &'a Cholesky<'a>,
    /// The rigid-body modes.
    pub rigid: &'a RigidBodyModes,
    /// How well the interface reacts the rigid-body modes.
    pub rank: InterfaceRank,
    /// The constraint modes, or Rubin's static modes where the interface leaves rigid-body motions free.
    pub constraint: &'a ConstraintModes<'a>,
    /// The retained modes.
    pub retained: &'a Retained,
    /// The basis.
    pub basis: &'a Basis<'a>,
    /// The reduced matrices.
    pub reduction: &'a Reduction,
    /// K_II⁻¹ f_I of each load of the job, n_I × n_l, where they were solved.
    pub answers: Option<&'a Mat<f64>>,
    /// Rubin's form of the reduced matrices, where the method is his.
    pub rubin: Option<&'a Rubin>,
    /// Ĉ, where the job asks for damping.
    pub damping: Option<&'a Damping>,
    /// The modes that the superelement leaves out.
    pub unseen: &'a [UnseenMode],
    /// The Sturm count, where one was asked for.
    pub certificate: Option<&'a Certificate>,
    /// The intervals that are proved to hold the modes, where they were asked for.
    pub enclosures: Option<&'a Enclosures>,
    /// What the user expects of the mass properties.
    pub expect: Option<&'a Expectation>,
}

impl Evidence<'_> {
    /// Whether the interface at rest leaves nothing free: K_II is regular, and its answers are those of the factor.
    pub(super) fn is_held(&self) -> bool {
        self.constraint.attachment.is_none()
    }

    /// Û in a basis that is orthonormal in M̂, r × n_r.
    pub(super) fn reduced_rigid(&self) -> Mat<f64> {
        let (_, mass, motions) = self.reduction.pencil();
        dense::orthonormal(motions, mass)
    }

    /// Rigid-body motions, n' × k, in reduced coordinates, r × k.
    pub(super) fn rigid_coordinates(&self, motions: MatRef<'_, f64>) -> Mat<f64> {
        let q = self.reduced_rigid();
        let momenta = transpose_apply(self.basis, product(&self.partition.mass, motions).as_ref());
        dense::product(q.as_ref(), dense::gram(q.as_ref(), momenta.as_ref()).as_ref())
    }

    /// The direction of each reduced coordinate; none of those that belong to no node of the interface.
    pub(super) fn directions(&self) -> Vec<Option<Direction>> {
        let of = |dof: &ReducedDof| match dof.origin {
            DofOrigin::PatchNode(_, direction) => Some(direction),
            DofOrigin::Row(_) => dof.dof.map(|dof| dof.direction),
            DofOrigin::Distortion(..) => None,
        };
        let mut directions: Vec<_> = self.partition.dofs[self.partition.n_internal..].iter().map(of).collect();
        directions.resize(self.reduction.n_reduced(), None);
        directions
    }

    /// Zero modes of the boundary that the retained modes were computed under.
    pub(super) fn n_zero(&self) -> usize {
        self.rigid.under(self.retained.boundary).map_or(0, RigidBodyModes::count)
    }

    /// Numbers of the reduced coordinates that take part in the eigenproblem of the retained modes: those that are not held.
    pub(super) fn moving(&self) -> Vec<usize> {
        let held = self.partition.held_under(self.retained.boundary);
        (0..self.reduction.n_reduced()).filter(|i| !held.get(*i).copied().unwrap_or(false)).collect()
    }
}

/// The name of a rigid-body mode: `rotation z` of one free body, otherwise its number.
pub(super) fn rigid_name(evidence: &Evidence<'_>, mode: usize) -> String {
    match NAMES.get(mode).filter(|_| evidence.rigid.is_classical) {
        Some(name) => (*name).to_owned(),
        None => format!("rigid-body mode {}", mode + 1),
    }
}

/// The name of a reduced coordinate: `node 12 uz`, `mode 3`, `inertia relief 2`.
pub(super) fn coordinate_name(evidence: &Evidence<'_>, coordinate: usize) -> String {
    let n_b = evidence.partition.n_interface();
    match coordinate.checked_sub(n_b).map(|slot| evidence.basis.coordinates.get(slot).copied()) {
        Some(None) => format!("coordinate {}", coordinate + 1),
        None => evidence.partition.name_of(evidence.partition.n_internal + coordinate),
        Some(Some(dynamic)) => dynamic.name(&evidence.partition.loads.facts),
    }
}

/// The precision of the data of K where it is coarser than that of the arithmetic, otherwise zero.
pub(super) fn data_noise(partition: &Partition) -> f64 {
    let precision = partition.precision.stiffness.share;
    if precision > f64::EPSILON { precision * partition.cancellation } else { 0.0 }
}

/// Scales of the reduced coordinates, powers of two: near 1/√K_BB,ii for an interface dof and near 1/√K̂_ηη,ii for a mode, with what stands
/// for it where a rigid-body mode has none.
///
/// The stiffness of an interface dof before condensation is what rounding of K̂_BB is relative to. What condensation
/// leaves of it may be nothing: an interface that just holds the component has K̂_BB = 0.
pub(super) fn coordinate_scales(evidence: &Evidence<'_>) -> Vec<f64> {
    let (partition, k) = (evidence.partition, &evidence.reduction.stiffness);
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let uncondensed = |i: usize| partition.stiffness.get(n_i + i, n_i + i).copied().unwrap_or(0.0);
    let of_modes = sizes_of_modes(k.as_ref(), n_b, evidence.basis);
    (0..k.nrows()).map(|i| dense::power_of_two_root(if i < n_b { uncondensed(i) } else { of_modes[i - n_b] })).collect()
}

/// The norms of the reduced pencil that backward errors are relative to; that of K̂ is at least that of its terms before
/// they cancel, which is one in these scales.
pub(super) fn reduced_norms(evidence: &Evidence<'_>) -> Equilibrated {
    let reduction = evidence.reduction;
    let mut norms =
        Equilibrated::of_dense(reduction.stiffness.as_ref(), reduction.mass.as_ref(), coordinate_scales(evidence));
    norms.stiffness_norm = norms.stiffness_norm.max(1.0);
    norms
}
