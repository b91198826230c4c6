//! Dead loads, gravity and the loads of the file through the C interface.

use alloc::string::String;

use super::evaluation::check_workspace;
use super::{SupelComponent, SupelDeadLoad, SupelMotion, SupelStatus, SupelWorkspace};
use super::{failed, guarded, null, values, values_mut};
use crate::component::{DeadLoad, ModalComponent, Workspace};
use crate::motion::{Motion, Vector3};

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
    guarded(|| {
        // SAFETY: the same promises.
        let (component, load, motions) = unsafe { checked_load(component, load, motions)? };
        // SAFETY: as many values as coordinates by the promise of the caller.
        let forces = unsafe { values_mut(forces, component.n_coordinates(), "forces")? };
        component.add_load(&load, motions, forces).map_err(|error| failed(SupelStatus::State)(&error))
    })
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
    guarded(|| {
        // SAFETY: the same promises.
        let (component, load, motions) = unsafe { checked_load(component, load, motions)? };
        // SAFETY: a matrix by the promise of the caller.
        let stiffness = unsafe { values_mut(stiffness, component.n_coordinates().pow(2), "stiffness")? };
        component.add_load_stiffness(&load, motions, stiffness).map_err(|error| failed(SupelStatus::State)(&error))
    })
}

/// # Safety
///
/// As of [`supel_add_load`].
unsafe fn checked_load<'a>(
    component: *const SupelComponent,
    load: *const SupelDeadLoad,
    motions: *const SupelMotion,
) -> Result<(&'a ModalComponent, DeadLoad, &'a [Motion]), (SupelStatus, String)> {
    // SAFETY: null, or what their names say by the promise of the caller.
    let (component, load) = unsafe { (component.as_ref(), load.as_ref()) };
    let component = &component.ok_or_else(|| null("component"))?.component;
    let load = load.ok_or_else(|| null("load"))?;
    // SAFETY: as many motions as nodes by the promise of the caller.
    let motions = unsafe { values(motions.cast::<Motion>(), component.n_nodes(), "motions")? };
    Ok((component, DeadLoad { node: load.node, force: load.force, moment: load.moment }, motions))
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
        // SAFETY: null, or what its name says and not used by others, by the promise of the caller.
        let workspace = &mut unsafe { workspace.as_mut() }.ok_or_else(|| null("workspace"))?.workspace;
        // SAFETY: the same promises.
        let (component, gravity) = unsafe { checked_gravity(component, gravity, workspace)? };
        // SAFETY: as many values as coordinates by the promise of the caller.
        let forces = unsafe { values_mut(forces, component.n_coordinates(), "forces")? };
        let added = component.gravity_forces(&gravity, workspace);
        let added = added.map_err(|error| failed(SupelStatus::State)(&error))?;
        forces.iter_mut().zip(added).for_each(|(sum, force)| *sum += force);
        Ok(())
    })
}

/// Adds the stiffness of gravity, minus the derivative of its forces by the place, to `stiffness`, a matrix, in the state last
/// evaluated in the workspace.
///
/// # Safety
///
/// As of `supel_add_gravity`, `stiffness` being a matrix.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_add_gravity_stiffness(
    component: *const SupelComponent,
    gravity: *const f64,
    workspace: *mut SupelWorkspace,
    stiffness: *mut f64,
) -> SupelStatus {
    guarded(|| {
        // SAFETY: null, or what its name says and not used by others, by the promise of the caller.
        let workspace = &mut unsafe { workspace.as_mut() }.ok_or_else(|| null("workspace"))?.workspace;
        // SAFETY: the same promises.
        let (component, gravity) = unsafe { checked_gravity(component, gravity, workspace)? };
        // SAFETY: a matrix by the promise of the caller.
        let stiffness = unsafe { values_mut(stiffness, component.n_coordinates().pow(2), "stiffness")? };
        let outcome = component.add_gravity_stiffness(&gravity, workspace, stiffness);
        outcome.map_err(|error| failed(SupelStatus::State)(&error))
    })
}

/// Potential energy in a gravity field, an acceleration in inertial axes, in the state last evaluated in the workspace; zero
/// with all mass at the inertial origin.
///
/// # Safety
///
/// `component` and `workspace` as of `supel_evaluate`; `gravity` points to three values, `potential` to one. Each may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_gravity_potential(
    component: *const SupelComponent,
    gravity: *const f64,
    workspace: *const SupelWorkspace,
    potential: *mut f64,
) -> SupelStatus {
    guarded(|| {
        // SAFETY: null, or what its name says by the promise of the caller.
        let workspace = &unsafe { workspace.as_ref() }.ok_or_else(|| null("workspace"))?.workspace;
        // SAFETY: the same promises.
        let (component, gravity) = unsafe { checked_gravity(component, gravity, workspace)? };
        // SAFETY: one value by the promise of the caller.
        let potential = unsafe { values_mut(potential, 1, "potential")? };
        let found = component.gravity_potential(&gravity, workspace);
        potential[0] = found.map_err(|error| failed(SupelStatus::State)(&error))?;
        Ok(())
    })
}

/// # Safety
///
/// `component` is null or comes from this library, `gravity` is null or points to three values.
unsafe fn checked_gravity<'a>(
    component: *const SupelComponent,
    gravity: *const f64,
    workspace: &Workspace,
) -> Result<(&'a ModalComponent, Vector3), (SupelStatus, String)> {
    // SAFETY: null or a component by the promise of the caller.
    let component = &unsafe { component.as_ref() }.ok_or_else(|| null("component"))?.component;
    check_workspace(component, workspace)?;
    // SAFETY: three values by the promise of the caller.
    let gravity = unsafe { values(gravity, 3, "gravity")? };
    Ok((component, [gravity[0], gravity[1], gravity[2]]))
}

/// Adds the forces of load number `load` of the file, from 0, with an amplitude, in the state last evaluated in the workspace. The
/// load turns with the floating frame.
///
/// # Safety
///
/// `component` and `workspace` as of `supel_evaluate`; `forces` points to as many values as the component has coordinates. Each
/// may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_add_load_vector(
    component: *const SupelComponent,
    load: usize,
    amplitude: f64,
    workspace: *mut SupelWorkspace,
    forces: *mut f64,
) -> SupelStatus {
    guarded(|| {
        // SAFETY: null, or what their names say and not used by others, by the promise of the caller.
        let (component, workspace) = unsafe { evaluated(component, workspace)? };
        // SAFETY: as many values as coordinates by the promise of the caller.
        let forces = unsafe { values_mut(forces, component.n_coordinates(), "forces")? };
        let added = component.load_vector_forces(load, amplitude, workspace);
        let added = added.map_err(|error| failed(SupelStatus::State)(&error))?;
        forces.iter_mut().zip(added).for_each(|(sum, force)| *sum += force);
        Ok(())
    })
}

/// Adds the stiffness of load number `load` of the file, minus the derivative of its forces by the place, to `stiffness`, a matrix,
/// in the state last evaluated in the workspace.
///
/// # Safety
///
/// As of `supel_add_load_vector`, `stiffness` being a matrix.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_add_load_vector_stiffness(
    component: *const SupelComponent,
    load: usize,
    amplitude: f64,
    workspace: *mut SupelWorkspace,
    stiffness: *mut f64,
) -> SupelStatus {
    guarded(|| {
        // SAFETY: null, or what their names say and not used by others, by the promise of the caller.
        let (component, workspace) = unsafe { evaluated(component, workspace)? };
        // SAFETY: a matrix by the promise of the caller.
        let stiffness = unsafe { values_mut(stiffness, component.n_coordinates().pow(2), "stiffness")? };
        let outcome = component.add_load_vector_stiffness(load, amplitude, workspace, stiffness);
        outcome.map_err(|error| failed(SupelStatus::State)(&error))
    })
}

/// # Safety
///
/// `component` and `workspace` as of `supel_evaluate`.
unsafe fn evaluated<'a>(
    component: *const SupelComponent,
    workspace: *mut SupelWorkspace,
) -> Result<(&'a ModalComponent, &'a mut Workspace), (SupelStatus, String)> {
    // SAFETY: null, or what their names say and not used by others, by the promise of the caller.
    let (component, workspace) = unsafe { (component.as_ref(), workspace.as_mut()) };
    let component = &component.ok_or_else(|| null("component"))?.component;
    let workspace = &mut workspace.ok_or_else(|| null("workspace"))?.workspace;
    check_workspace(component, workspace)?;
    Ok((component, workspace))
}
