//! Results of evaluations through the C interface.

use super::{SupelWorkspace, pointer};

/// Rate of the deformation measure of the state last evaluated; null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_deformation_rate(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.deformation_rate()))
}

/// Material velocity of the floating frame of the state last evaluated, six values; null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_frame_velocity(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.frame_velocity().as_slice()))
}

/// Damping matrix of the state whose tangents were last asked for; null for null and where the file has no damping.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_damping(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(
        unsafe { workspace.as_ref() }
            .map(|workspace| workspace.workspace.damping())
            .filter(|damping| !damping.is_empty()),
    )
}

/// The part of the gyroscopic matrix that comes from the momentum of the floating frame, the paper's eq. (87); null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_frame_gyroscopic(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.frame_gyroscopic()))
}

/// Deformation measure of the state last evaluated; null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_deformation(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.deformation()))
}

/// Elastic forces of the state last evaluated; null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_elastic_forces(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.elastic_forces()))
}

/// Inertial forces of the state last evaluated; null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_inertial_forces(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.inertial_forces()))
}

/// Damping forces of the state last evaluated; null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_damping_forces(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.damping_forces()))
}

/// Tangent stiffness of the state whose tangents were last asked for, a symmetric matrix without the derivative of inertial
/// forces by the place; null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_stiffness(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.stiffness()))
}

/// Exact stiffness of the state last given to `supel_exact_tangents`, a matrix that is not symmetric; null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_exact_stiffness(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.exact_stiffness()))
}

/// Mass of the state whose tangents were last asked for, a matrix; null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_mass(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.mass()))
}

/// Gyroscopic matrix of the state whose tangents were last asked for; null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_gyroscopic(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.gyroscopic()))
}

/// Momentum of the state last evaluated in the floating frame: linear, then angular about the frame's origin; null for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_frame_momentum(workspace: *const SupelWorkspace) -> *const f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    pointer(unsafe { workspace.as_ref() }.map(|workspace| workspace.workspace.frame_momentum().as_slice()))
}

/// Power that the damping takes from the motion in the state last evaluated; not a number for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_dissipated_power(workspace: *const SupelWorkspace) -> f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    unsafe { workspace.as_ref() }.map_or(f64::NAN, |workspace| workspace.workspace.dissipated_power())
}

/// Strain energy of the state last evaluated; not a number for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_strain_energy(workspace: *const SupelWorkspace) -> f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    unsafe { workspace.as_ref() }.map_or(f64::NAN, |workspace| workspace.workspace.strain_energy())
}

/// Kinetic energy of the state last evaluated; not a number for null.
///
/// # Safety
///
/// `workspace` is null or comes from `supel_workspace_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_kinetic_energy(workspace: *const SupelWorkspace) -> f64 {
    // SAFETY: null or a workspace by the promise of the caller.
    unsafe { workspace.as_ref() }.map_or(f64::NAN, |workspace| workspace.workspace.kinetic_energy())
}
