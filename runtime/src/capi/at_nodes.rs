//! Coordinates at the nodes through the C interface.

use super::{SupelComponent, SupelStatus, failed, guarded, null, values_mut};
use crate::component::{EvaluationError, ModalComponent};

type Change = fn(&ModalComponent, &mut [f64]) -> Result<(), EvaluationError>;

/// Turns velocities, accelerations or increments at the nodes, (R^T dx/dt; omega) of each, into those of the component, in
/// place.
///
/// # Safety
///
/// `component` comes from this library, `velocities` points to as many values as it has coordinates. Each may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_velocities_to_origin(
    component: *const SupelComponent,
    velocities: *mut f64,
) -> SupelStatus {
    // SAFETY: the same promises.
    unsafe { changed(component, (velocities, "velocities"), 1, ModalComponent::velocities_to_origin) }
}

/// Turns velocities, accelerations or increments of the component into those at the nodes, (R^T dx/dt; omega) of each, in
/// place.
///
/// # Safety
///
/// As of `supel_velocities_to_origin`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_velocities_to_nodes(
    component: *const SupelComponent,
    velocities: *mut f64,
) -> SupelStatus {
    // SAFETY: the same promises.
    unsafe { changed(component, (velocities, "velocities"), 1, ModalComponent::velocities_to_nodes) }
}

/// Turns forces of the component into forces and moments at the nodes, in their own axes, in place.
///
/// # Safety
///
/// As of `supel_velocities_to_origin`, of `forces`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_forces_to_nodes(component: *const SupelComponent, forces: *mut f64) -> SupelStatus {
    // SAFETY: the same promises.
    unsafe { changed(component, (forces, "forces"), 1, ModalComponent::forces_to_nodes) }
}

/// Turns a matrix of the component into one for coordinates at the nodes, in place.
///
/// # Safety
///
/// As of `supel_velocities_to_origin`, `matrix` being a matrix.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_matrix_to_nodes(component: *const SupelComponent, matrix: *mut f64) -> SupelStatus {
    // SAFETY: the same promises.
    unsafe { changed(component, (matrix, "matrix"), 2, ModalComponent::matrix_to_nodes) }
}

/// # Safety
///
/// `component` is null or comes from this library, the array is null or has as many values as its power of the number of
/// coordinates.
unsafe fn changed(
    component: *const SupelComponent,
    (array, what): (*mut f64, &str),
    power: u32,
    change: Change,
) -> SupelStatus {
    guarded(|| {
        // SAFETY: null or a component by the promise of the caller.
        let component = &unsafe { component.as_ref() }.ok_or_else(|| null("component"))?.component;
        // SAFETY: as many values as that by the promise of the caller.
        let array = unsafe { values_mut(array, component.n_coordinates().pow(power), what)? };
        change(component, array).map_err(|error| failed(SupelStatus::Argument)(&error))
    })
}
