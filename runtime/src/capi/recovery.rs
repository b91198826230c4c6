//! Displacements inside the component through the C interface.

use super::evaluation::check_workspace;
use super::{SupelComponent, SupelStatus, SupelWorkspace};
use super::{failed, guarded, null, values};
use crate::component::RecoveredNode;

/// Where a node inside the component has gone.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupelRecoveredNode {
    /// Displacement, in inertial axes.
    pub displacement: [f64; 3],
    /// Rotation matrix, row by row: that of the floating frame where the file recovers no rotation of the node.
    pub rotation: [[f64; 3]; 3],
}

// The two are one type in memory: the same fields, in the order of C.
const _: () =
    assert!(size_of::<SupelRecoveredNode>() == size_of::<RecoveredNode>() && size_of::<RecoveredNode>() == 96);

/// Number of nodes that the file recovers; 0 for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_n_recovered(component: *const SupelComponent) -> usize {
    // SAFETY: null or a component by the promise of the caller.
    unsafe { component.as_ref() }.map_or(0, |component| component.component.recovered_labels().len())
}

/// Labels of the recovered nodes, in the order of their displacements; null for null and where there are none.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_recovered_labels(component: *const SupelComponent) -> *const i64 {
    // SAFETY: null or a component by the promise of the caller.
    let labels = unsafe { component.as_ref() }.map(|component| component.component.recovered_labels());
    labels.filter(|labels| !labels.is_empty()).map_or(std::ptr::null(), <[i64]>::as_ptr)
}

/// Positions of the recovered nodes in the reference configuration, three values for each; null for null and where the file does
/// not have them.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_recovered_positions(component: *const SupelComponent) -> *const f64 {
    // SAFETY: null or a component by the promise of the caller.
    let positions = unsafe { component.as_ref() }.and_then(|component| component.component.recovered_positions());
    positions.filter(|positions| !positions.is_empty()).map_or(std::ptr::null(), |positions| positions[0].as_ptr())
}

/// Displacements and rotations of the recovered nodes in the state last evaluated in the workspace.
///
/// `positions` gives three values for each of these nodes, in the reference configuration: those of `supel_recovered_positions`, or
/// the caller's own for a file that does not have them. Nodes of which a file holds only some directions cannot be turned with the
/// floating frame; they are none of the recovered nodes.
///
/// # Safety
///
/// `component` and `workspace` as of `supel_evaluate`; `positions` points to three values and `nodes` to one node for each
/// recovered node. Each may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_recover(
    component: *const SupelComponent,
    workspace: *const SupelWorkspace,
    positions: *const f64,
    nodes: *mut SupelRecoveredNode,
) -> SupelStatus {
    guarded(|| {
        // SAFETY: null, or what their names say by the promise of the caller.
        let (component, workspace) = unsafe { (component.as_ref(), workspace.as_ref()) };
        let component = &component.ok_or_else(|| null("component"))?.component;
        let workspace = &workspace.ok_or_else(|| null("workspace"))?.workspace;
        check_workspace(component, workspace)?;
        let n = component.recovered_labels().len();
        // SAFETY: three values for each node by the promise of the caller.
        let positions = unsafe { values(positions, 3 * n, "positions")? };
        if n == 0 {
            return Ok(());
        }
        if nodes.is_null() {
            return Err(null("nodes"));
        }
        // SAFETY: not null, and as many as there are recovered nodes by the promise of the caller.
        let nodes = unsafe { std::slice::from_raw_parts_mut(nodes.cast::<RecoveredNode>(), n) };
        let outcome = component.recover(workspace, positions.as_chunks::<3>().0, nodes);
        outcome.map_err(|error| failed(SupelStatus::State)(&error))
    })
}
