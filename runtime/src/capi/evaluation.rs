//! Evaluations through the C interface.

use alloc::boxed::Box;

use super::{Outcome, SupelComponent, SupelMotion, SupelState, SupelStatus, SupelWorkspace};
use super::{failed, guarded, null, values};
use crate::component::{EvaluationError, ModalComponent, State, Workspace};
use crate::motion::Motion;

/// Room for the evaluations of a component by one thread, to be freed by `supel_workspace_free`.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`; `workspace` is null or points to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_workspace_new(
    component: *const SupelComponent,
    workspace: *mut *mut SupelWorkspace,
) -> SupelStatus {
    guarded(|| {
        // SAFETY: null or a component by the promise of the caller.
        let component = &unsafe { component.as_ref() }.ok_or_else(|| null("component"))?.component;
        if workspace.is_null() {
            return Err(null("workspace"));
        }
        let made = SupelWorkspace { workspace: component.workspace() };
        // SAFETY: not null, and a place for a pointer by the promise of the caller.
        unsafe { workspace.write(Box::into_raw(Box::new(made))) };
        Ok(())
    })
}

/// Frees a workspace; null is allowed.
///
/// # Safety
///
/// `workspace` comes from `supel_workspace_new` and is not used afterwards.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_workspace_free(workspace: *mut SupelWorkspace) {
    if !workspace.is_null() {
        // SAFETY: made by `Box::into_raw`, and given up by the caller.
        drop(unsafe { Box::from_raw(workspace) });
    }
}

/// Before anything is done: the wrong workspace is a mistake of the program, not of the state.
pub(super) fn check_workspace(component: &ModalComponent, workspace: &Workspace) -> Outcome {
    workspace.check_component(component).map_err(|error| failed(SupelStatus::Argument)(&error))
}

type Evaluate = fn(&ModalComponent, &State<'_>, &mut Workspace) -> Result<(), EvaluationError>;

/// # Safety
///
/// As of [`supel_evaluate`].
unsafe fn evaluate(
    component: *const SupelComponent,
    state: *const SupelState,
    workspace: *mut SupelWorkspace,
    wanted: Evaluate,
) -> Outcome {
    // SAFETY: null, or what their names say and not used by others, by the promise of the caller.
    let (component, state, workspace) = unsafe { (component.as_ref(), state.as_ref(), workspace.as_mut()) };
    let component = &component.ok_or_else(|| null("component"))?.component;
    let state = state.ok_or_else(|| null("state"))?;
    let workspace = &mut workspace.ok_or_else(|| null("workspace"))?.workspace;
    let r = component.n_coordinates();
    // SAFETY: as many values as the header asks for, by the promise of the caller.
    let (motions, amplitudes, velocities, accelerations) = unsafe {
        (
            values(state.motions.cast::<Motion>(), component.n_nodes(), "state.motions")?,
            values(state.amplitudes, component.n_modal(), "state.amplitudes")?,
            values(state.velocities, r, "state.velocities")?,
            values(state.accelerations, r, "state.accelerations")?,
        )
    };
    let state = State { motions, amplitudes, velocities, accelerations };
    check_workspace(component, workspace)?;
    wanted(component, &state, workspace).map_err(|error| failed(SupelStatus::State)(&error))
}

/// Floating frame, deformation, forces and energies of a state.
///
/// # Safety
///
/// `component` and `workspace` come from this library; `state` points to a state
/// whose arrays have as many values as the component has nodes, amplitudes and coordinates. Each may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_evaluate(
    component: *const SupelComponent,
    state: *const SupelState,
    workspace: *mut SupelWorkspace,
) -> SupelStatus {
    // SAFETY: the same promises.
    guarded(|| unsafe { evaluate(component, state, workspace, ModalComponent::evaluate) })
}

/// Stiffness, mass, gyroscopic and damping matrix of a state, as the paper has them.
///
/// # Safety
///
/// As of `supel_evaluate`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_tangents(
    component: *const SupelComponent,
    state: *const SupelState,
    workspace: *mut SupelWorkspace,
) -> SupelStatus {
    // SAFETY: the same promises.
    guarded(|| unsafe { evaluate(component, state, workspace, ModalComponent::tangents) })
}

/// Forces, tangents and exact stiffness of a state: all derivatives of elastic, inertial and damping forces, by the place
/// (`supel_exact_stiffness`), by the velocities (`supel_gyroscopic`, `supel_damping`) and by the accelerations (`supel_mass`).
///
/// `supel_stiffness` has no derivative of inertial forces and no geometric part: use this for linear vibration about a fast
/// rotation. A component has no stress stiffening inside, neither here nor there.
///
/// # Safety
///
/// As of `supel_evaluate`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_exact_tangents(
    component: *const SupelComponent,
    state: *const SupelState,
    workspace: *mut SupelWorkspace,
) -> SupelStatus {
    // SAFETY: the same promises.
    guarded(|| unsafe { evaluate(component, state, workspace, ModalComponent::exact_tangents) })
}

/// Change of configuration of the floating frame.
///
/// # Safety
///
/// `workspace` comes from this library, `frame` points to a motion. Each may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_floating_frame(
    workspace: *const SupelWorkspace,
    frame: *mut SupelMotion,
) -> SupelStatus {
    guarded(|| {
        // SAFETY: null, or what their names say by the promise of the caller.
        let (workspace, frame) = unsafe { (workspace.as_ref(), frame.as_mut()) };
        let own = workspace.ok_or_else(|| null("workspace"))?.workspace.floating_frame();
        *frame.ok_or_else(|| null("frame"))? = SupelMotion { rotation: own.rotation, translation: own.translation };
        Ok(())
    })
}

/// Starts the next search for the floating frame from `frame`, which the next evaluation checks.
///
/// # Safety
///
/// `workspace` comes from this library, `frame` points to a motion. Each may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_set_floating_frame(
    workspace: *mut SupelWorkspace,
    frame: *const SupelMotion,
) -> SupelStatus {
    guarded(|| {
        // SAFETY: null, or what their names say and not used by others, by the promise of the caller.
        let (workspace, frame) = unsafe { (workspace.as_mut(), frame.as_ref()) };
        let frame = frame.ok_or_else(|| null("frame"))?;
        let frame = Motion { rotation: frame.rotation, translation: frame.translation };
        workspace.ok_or_else(|| null("workspace"))?.workspace.set_floating_frame(&frame);
        Ok(())
    })
}
