//! The modal component itself: what is kept of a superelement for its evaluations.

use alloc::vec::Vec;

use super::acts_on::ActsOn;
use super::frame_condition::FrameRounding;
use super::identity::Identity;
use super::load_map::LoadVectors;
use super::measures::Measures;
use super::recovery_map::RecoveryMap;
use super::weight::Weight;
use crate::metadata::Validity;
use crate::motion::{Matrix6, Vector3, Vector6};

/// A superelement in large motion; see the [module page](super).
///
/// It cannot be changed: threads may share it, each with a [`Workspace`](super::Workspace) of its own.
#[derive(Clone, Debug)]
pub struct ModalComponent {
    pub(super) identity: Identity,
    pub(super) measures: Measures,
    pub(super) positions: Vec<Vector3>,
    pub(super) n_modal: usize,
    /// In the coordinates of the nodes; also in those of the measures where these are motion-based.
    pub(super) nodal: Matrices,
    /// In the coordinates of the classical measures.
    pub(super) measured: Option<Matrices>,
    /// Columns of U at each node, in the coordinates of the measures.
    pub(super) rigid: Vec<Matrix6>,
    /// M U, one row of six for each coordinate.
    pub(super) momenta: Vec<Vector6>,
    /// M_F = UᵀMU.
    pub(super) rigid_mass: Matrix6,
    /// Y, scaled so that YᵀU = I.
    pub(super) frame: Vec<Vector6>,
    pub(super) frame_rounding: FrameRounding,
    /// Loads of unit gravity, one row of three for each coordinate.
    pub(super) gravity: Vec<Vector3>,
    /// Mass and moment of mass that these loads are the weight of.
    pub(super) weight: Option<Weight>,
    pub(super) damping_is_symmetric: bool,
    pub(super) damping_acts_on: ActsOn,
    pub(super) loads: LoadVectors,
    pub(super) validity: Validity,
    pub(super) recovery: Option<RecoveryMap>,
    pub(super) rigid_motion_residual: f64,
}

/// Reduced matrices, r × r, row by row.
#[derive(Clone, Debug)]
pub(super) struct Matrices {
    pub(super) stiffness: Vec<f64>,
    pub(super) mass: Vec<f64>,
    pub(super) damping: Option<Vec<f64>>,
}

impl ModalComponent {
    /// Measures of deformation.
    pub fn measures(&self) -> Measures {
        self.measures
    }

    /// Number of interface nodes k.
    pub fn n_nodes(&self) -> usize {
        self.positions.len()
    }

    /// Number of modal amplitudes n_η.
    pub fn n_modal(&self) -> usize {
        self.n_modal
    }

    /// Number of coordinates r = 6k + n_η.
    pub fn n_coordinates(&self) -> usize {
        6 * self.n_nodes() + self.n_modal
    }

    /// Positions of the k interface nodes in the reference configuration.
    pub fn positions(&self) -> &[Vector3] {
        &self.positions
    }

    /// Stiffness without deformation, r × r, row by row: the constant matrix for small deformation, eq. (82) at e = 0.
    pub fn reference_stiffness(&self) -> &[f64] {
        &self.nodal.stiffness
    }

    /// Mass without deformation, r × r, row by row: the constant matrix for small deformation.
    pub fn reference_mass(&self) -> &[f64] {
        &self.nodal.mass
    }

    /// Damping without deformation, r × r, row by row; none where the file has none.
    pub fn reference_damping(&self) -> Option<&[f64]> {
        self.nodal.damping.as_deref()
    }

    /// Rigid-body mass M_F = UᵀM̂U about the inertial origin.
    pub fn rigid_mass(&self) -> &Matrix6 {
        &self.rigid_mass
    }

    /// Largest force that a rigid-body motion makes, relative to the sum of the magnitudes of its parts and of its inertia in the
    /// first mode.
    pub fn rigid_motion_residual(&self) -> f64 {
        self.rigid_motion_residual
    }

    /// Matrices in the coordinates of the measures.
    pub(super) fn matrices(&self) -> &Matrices {
        self.measured.as_ref().unwrap_or(&self.nodal)
    }
}
