//! Evaluations through the C interface.

use alloc::boxed::Box;

use super::{Outcome, SupelComponent, SupelDeadLoad, SupelMotion, SupelState, SupelStatus, SupelWorkspace};
use super::{failed, guarded, null, values};
use crate::component::{DeadLoad, ModalComponent, State, Workspace};
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
    component.check_workspace(workspace).map_err(|error| failed(SupelStatus::Argument)(&error))
}

/// What an evaluation fills.
#[derive(Clone, Copy)]
enum Wanted {
    Forces,
    Tangents,
}

/// # Safety
///
/// As of [`supel_evaluate`].
unsafe fn evaluate(
    component: *const SupelComponent,
    state: *const SupelState,
    workspace: *mut SupelWorkspace,
    wanted: Wanted,
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
    let outcome = match wanted {
        Wanted::Forces => component.evaluate(&state, workspace),
        Wanted::Tangents => component.tangents(&state, workspace),
    };
    outcome.map_err(|error| failed(SupelStatus::State)(&error))
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
    guarded(|| unsafe { evaluate(component, state, workspace, Wanted::Forces) })
}

/// Stiffness, mass and gyroscopic matrix of a state.
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
    guarded(|| unsafe { evaluate(component, state, workspace, Wanted::Tangents) })
}

/// Adds the forces of gravity, an acceleration in inertial axes, in the state last evaluated in the workspace.
///
/// # Safety
///
/// `component` and `workspace` as of `supel_evaluate`; `gravity` points to three values, `forces` to as many as the
/// component has coordinates. Each may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_add_gravity(
    component: *const SupelComponent,
    gravity: *const f64,
    workspace: *mut SupelWorkspace,
    forces: *mut f64,
) -> SupelStatus {
    guarded(|| {
        // SAFETY: null, or what their names say and not used by others, by the promise of the caller.
        let (component, workspace) = unsafe { (component.as_ref(), workspace.as_mut()) };
        let component = &component.ok_or_else(|| null("component"))?.component;
        let workspace = &mut workspace.ok_or_else(|| null("workspace"))?.workspace;
        check_workspace(component, workspace)?;
        // SAFETY: three values by the promise of the caller.
        let gravity = unsafe { values(gravity, 3, "gravity")? };
        if forces.is_null() {
            return Err(null("forces"));
        }
        // SAFETY: not null, and as long as the component has coordinates by the promise of the caller.
        let forces = unsafe { std::slice::from_raw_parts_mut(forces, component.n_coordinates()) };
        let added = component.gravity_forces(&[gravity[0], gravity[1], gravity[2]], workspace);
        let added = added.map_err(|error| failed(SupelStatus::State)(&error))?;
        forces.iter_mut().zip(added).for_each(|(sum, force)| *sum += force);
        Ok(())
    })
}

/// Adds a dead load to `forces`.
///
/// # Safety
///
/// `component` comes from this library, `load` points to a load, `motions` to as many motions as the component has nodes,
/// `forces` to as many values as it has coordinates. Each may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_add_load(
    component: *const SupelComponent,
    load: *const SupelDeadLoad,
    motions: *const SupelMotion,
    forces: *mut f64,
) -> SupelStatus {
    // SAFETY: the same promises.
    guarded(|| unsafe { add_load(component, load, motions, forces, Wanted::Forces) })
}

/// Adds the load stiffness of a dead load to `stiffness`, a matrix.
///
/// # Safety
///
/// As of `supel_add_load`, `stiffness` being a matrix.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_add_load_stiffness(
    component: *const SupelComponent,
    load: *const SupelDeadLoad,
    motions: *const SupelMotion,
    stiffness: *mut f64,
) -> SupelStatus {
    // SAFETY: the same promises.
    guarded(|| unsafe { add_load(component, load, motions, stiffness, Wanted::Tangents) })
}

/// # Safety
///
/// As of [`supel_add_load`], `result` being a matrix where tangents are wanted.
unsafe fn add_load(
    component: *const SupelComponent,
    load: *const SupelDeadLoad,
    motions: *const SupelMotion,
    result: *mut f64,
    wanted: Wanted,
) -> Outcome {
    // SAFETY: null, or what their names say by the promise of the caller.
    let (component, load) = unsafe { (component.as_ref(), load.as_ref()) };
    let component = &component.ok_or_else(|| null("component"))?.component;
    let load = load.ok_or_else(|| null("load"))?;
    if result.is_null() {
        return Err(null("result"));
    }
    // SAFETY: as many motions as nodes by the promise of the caller.
    let motions = unsafe { values(motions.cast::<Motion>(), component.n_nodes(), "motions")? };
    let load = DeadLoad { node: load.node, force: load.force, moment: load.moment };
    let r = component.n_coordinates();
    // SAFETY: not null, and a vector or a matrix by the promise of the caller.
    let outcome = unsafe {
        match wanted {
            Wanted::Forces => component.add_load(&load, motions, std::slice::from_raw_parts_mut(result, r)),
            Wanted::Tangents => {
                component.add_load_stiffness(&load, motions, std::slice::from_raw_parts_mut(result, r * r))
            }
        }
    };
    outcome.map_err(|error| failed(SupelStatus::State)(&error))
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
