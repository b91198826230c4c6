//! Scratch and results of a component's evaluations, owned by the caller.

use alloc::vec::Vec;

use super::dense;
use super::error::EvaluationError;
use super::identity::Identity;
use super::measures::NodeMeasure;
use super::modal_component::ModalComponent;
use super::place_terms::PlaceTerms;
use super::projection::Load;
use crate::motion::{IDENTITY_6, Matrix6, Motion, Vector6};

/// Scratch and results of the evaluations of one component; made by [`ModalComponent::workspace`].
///
/// It keeps the floating frame for the next evaluation to start from. Matrices are r × r, row by row, in the coordinates
/// of the forces.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// The component that it is for.
    pub(super) component: Identity,
    /// Whether the last evaluation came to its end, so that there is a state to which the results belong.
    pub(super) has_state: bool,
    pub(super) floating_frame: Motion,
    /// The floating frame seen from node 0, which a rigid-body motion leaves as it is.
    pub(super) frame_in_node: Motion,
    /// A floating frame to start from, given by the caller.
    pub(super) given_frame: Option<Motion>,
    pub(super) nodes: Vec<NodeMeasure>,
    /// S = (YᵀF)⁻¹.
    pub(super) s: Matrix6,
    /// Qᵀ: six values for each coordinate.
    pub(super) q: Vec<Vector6>,
    pub(super) deformation: Vec<f64>,
    pub(super) deformation_rate: Vec<f64>,
    pub(super) frame_velocity: Vector6,
    /// V̇_F of the forces last evaluated.
    pub(super) frame_acceleration: Vector6,
    /// Velocity and acceleration ε = ė + U V_F of the component in its floating frame.
    pub(super) velocity: Vec<f64>,
    pub(super) acceleration: Vec<f64>,
    pub(super) product: Vec<f64>,
    /// Of the elastic, inertial and damping forces last evaluated.
    pub(super) load: Load,
    pub(super) results: Results,
    pub(super) scratch: Scratch,
}

/// What the getters return.
#[derive(Clone, Debug, Default)]
pub(super) struct Results {
    pub(super) elastic: Vec<f64>,
    pub(super) inertial: Vec<f64>,
    pub(super) damping_forces: Vec<f64>,
    pub(super) gravity: Vec<f64>,
    pub(super) load_vector: Vec<f64>,
    pub(super) strain_energy: f64,
    pub(super) kinetic_energy: f64,
    pub(super) dissipated_power: f64,
    /// P_F.
    pub(super) frame_momentum: Vector6,
    pub(super) stiffness: Vec<f64>,
    pub(super) mass: Vec<f64>,
    pub(super) damping: Vec<f64>,
    pub(super) gyroscopic: Vec<f64>,
    pub(super) frame_gyroscopic: Vec<f64>,
    pub(super) exact_stiffness: Vec<f64>,
}

/// Intermediate matrices of the tangents.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    /// r × r.
    pub(super) square: Vec<f64>,
    /// 6k × r.
    pub(super) rates: Vec<f64>,
    /// k.
    pub(super) terms: Vec<PlaceTerms>,
    /// Four 6 × r, row by row.
    pub(super) wide: [Vec<f64>; 4],
    /// r × 6.
    pub(super) tall: Vec<Vector6>,
}

impl Results {
    /// Fails unless forces and energies are finite.
    pub(super) fn check_forces(&self) -> Result<(), EvaluationError> {
        let each = [
            ("elastic forces", self.elastic.as_slice()),
            ("inertial forces", &self.inertial),
            ("damping forces", &self.damping_forces),
            ("strain energy", &[self.strain_energy]),
            ("kinetic energy", &[self.kinetic_energy]),
            ("dissipated power", &[self.dissipated_power]),
        ];
        check_finite(each)
    }

    /// Fails unless the tangent matrices are finite.
    pub(super) fn check_tangents(&self) -> Result<(), EvaluationError> {
        let each = [
            ("tangent stiffness", self.stiffness.as_slice()),
            ("mass", &self.mass),
            ("damping matrix", &self.damping),
            // Its part of the floating frame is in it.
            ("gyroscopic matrix", &self.gyroscopic),
        ];
        check_finite(each)
    }

    /// Fails unless the exact stiffness is finite.
    pub(super) fn check_exact_stiffness(&self) -> Result<(), EvaluationError> {
        check_finite([("exact stiffness", &self.exact_stiffness)])
    }
}

/// Fails unless a result has as many entries as it takes.
pub(super) fn check_result(found: usize, expected: usize) -> Result<(), EvaluationError> {
    let what = "entries of the result";
    if found == expected { Ok(()) } else { Err(EvaluationError::WrongLength { what, found, expected }) }
}

pub(super) fn check_finite<const N: usize>(each: [(&'static str, &[f64]); N]) -> Result<(), EvaluationError> {
    match each.into_iter().find(|(_, values)| !all_finite(values)) {
        Some((what, _)) => Err(EvaluationError::Overflow { what }),
        None => Ok(()),
    }
}

/// Zero times an infinity is not a number, nor is any sum with one: eight sums side by side take the processor's vectors.
pub(super) fn all_finite(values: &[f64]) -> bool {
    let (eights, rest) = values.as_chunks::<8>();
    let mut zeros = [0.0; 8];
    for eight in eights {
        zeros = core::array::from_fn(|i| zeros[i] + 0.0 * eight[i]);
    }
    zeros.iter().chain(rest).all(|value| value.is_finite())
}

impl Workspace {
    /// Without deformation; [`project_frame`](super::floating_frame::project_frame) fills what follows from it.
    pub(super) fn new(component: &ModalComponent) -> Self {
        let (k, r) = (component.n_nodes(), component.n_coordinates());
        let (vector, matrix, columns) = (|| vec![0.0; r], || vec![0.0; r * r], || vec![[0.0; 6]; r]);
        let results = Results {
            elastic: vector(),
            inertial: vector(),
            damping_forces: vector(),
            gravity: vector(),
            load_vector: vector(),
            stiffness: component.reference_stiffness().to_vec(),
            mass: component.reference_mass().to_vec(),
            damping: component.reference_damping().unwrap_or_default().to_vec(),
            gyroscopic: matrix(),
            frame_gyroscopic: matrix(),
            exact_stiffness: component.reference_stiffness().to_vec(),
            ..Results::default()
        };
        let scratch = Scratch {
            square: matrix(),
            rates: vec![0.0; 6 * k * r],
            terms: vec![PlaceTerms::ZERO; k],
            wide: core::array::from_fn(|_| vec![0.0; 6 * r]),
            tall: columns(),
        };
        Self {
            component: component.identity,
            has_state: true,
            floating_frame: Motion::IDENTITY,
            frame_in_node: Motion::IDENTITY,
            given_frame: None,
            nodes: component.rigid.iter().map(NodeMeasure::undeformed).collect(),
            s: IDENTITY_6,
            q: columns(),
            deformation: vector(),
            deformation_rate: vector(),
            frame_velocity: [0.0; 6],
            frame_acceleration: [0.0; 6],
            velocity: vector(),
            acceleration: vector(),
            product: vector(),
            load: Load { on_deformation: vector(), on_frame: [0.0; 6] },
            results,
            scratch,
        }
    }

    /// Fails for the workspace of another component, which has other results, though it may have their number.
    pub(crate) fn check_component(&self, component: &ModalComponent) -> Result<(), EvaluationError> {
        if self.component == component.identity { Ok(()) } else { Err(EvaluationError::ForeignWorkspace) }
    }

    /// Fails unless the last evaluation succeeded.
    pub(super) fn check_state(&self) -> Result<(), EvaluationError> {
        if self.has_state { Ok(()) } else { Err(EvaluationError::NoState) }
    }

    /// Starts the next search for the floating frame from `frame`: after a jump of the state, or to repeat a run. The next
    /// evaluation checks it ([`EvaluationError::InvalidFrame`]).
    pub fn set_floating_frame(&mut self, frame: &Motion) {
        self.given_frame = Some(*frame);
    }

    /// Change of configuration of the floating frame H_F, eq. (62).
    pub fn floating_frame(&self) -> &Motion {
        &self.floating_frame
    }

    /// Material velocity of the floating frame V_F = Q v.
    pub fn frame_velocity(&self) -> &Vector6 {
        &self.frame_velocity
    }

    /// Deformation measure e, r: six for each interface node, then the modal amplitudes; eq. (63).
    pub fn deformation(&self) -> &[f64] {
        &self.deformation
    }

    /// Rate of the deformation measure, r; eq. (73b).
    pub fn deformation_rate(&self) -> &[f64] {
        &self.deformation_rate
    }

    /// Elastic forces (J P_⊥)ᵀK e, r; the gradient of the strain energy; eq. (81).
    pub fn elastic_forces(&self) -> &[f64] {
        &self.results.elastic
    }

    /// Inertial forces, r; eq. (85) with J⁻¹.
    pub fn inertial_forces(&self) -> &[f64] {
        &self.results.inertial
    }

    /// Damping forces, r; zero where the file has no damping.
    pub fn damping_forces(&self) -> &[f64] {
        &self.results.damping_forces
    }

    /// Power ẋᵀC ẋ that the damping takes from the motion; the skew part of C takes none. Zero where the file has no damping.
    pub fn dissipated_power(&self) -> f64 {
        self.results.dissipated_power
    }

    /// Strain energy ½ eᵀK e.
    pub fn strain_energy(&self) -> f64 {
        self.results.strain_energy
    }

    /// Kinetic energy ½ (ė + U V_F)ᵀM (ė + U V_F); eq. (83).
    pub fn kinetic_energy(&self) -> f64 {
        self.results.kinetic_energy
    }

    /// Momentum P_F = M_F V_F + UᵀM ė of the component in its floating frame: linear momentum, then angular momentum about the
    /// frame's origin.
    ///
    /// A free component keeps it in inertial axes: R_F p, and R_F l + u_F × R_F p about the inertial origin.
    pub fn frame_momentum(&self) -> &Vector6 {
        &self.results.frame_momentum
    }

    /// Tangent stiffness (J P_⊥)ᵀK J P_⊥, r × r, symmetric; eq. (82). It lacks the derivative of J P_⊥ and that of the inertial
    /// and damping forces by the place, which [`exact_stiffness`](Self::exact_stiffness) has: enough for Newton's method on
    /// small deformation, but not for linear vibration about a fast rotation.
    pub fn stiffness(&self) -> &[f64] {
        &self.results.stiffness
    }

    /// Mass M_I, r × r, symmetric: the derivative of the inertial forces by the accelerations; eq. (84).
    pub fn mass(&self) -> &[f64] {
        &self.results.mass
    }

    /// Derivative of the inertial forces by the velocities, r × r.
    pub fn gyroscopic(&self) -> &[f64] {
        &self.results.gyroscopic
    }

    /// The part of [`gyroscopic`](Self::gyroscopic) that comes from the momentum of the floating frame, r × r: the paper's
    /// eq. (87). The rest, from the Coriolis forces, is of the same order.
    pub fn frame_gyroscopic(&self) -> &[f64] {
        &self.results.frame_gyroscopic
    }

    /// Derivative of the elastic, inertial and damping forces by the place, r × r: the increments ΔU_j of the nodes and those of
    /// the amplitudes, at fixed velocities and accelerations. It is not symmetric, but without deformation at rest.
    ///
    /// It belongs to the state last given to [`exact_tangents`](ModalComponent::exact_tangents).
    pub fn exact_stiffness(&self) -> &[f64] {
        &self.results.exact_stiffness
    }

    /// Derivative of the damping forces by the velocities, r × r, symmetric where the damping is; empty where the file has no
    /// damping.
    pub fn damping(&self) -> &[f64] {
        &self.results.damping
    }

    /// Q x.
    pub(super) fn frame_part(&self, x: &[f64]) -> Vector6 {
        dense::columns_times(&self.q, x)
    }
}
