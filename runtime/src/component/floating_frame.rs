//! The floating frame: Newton's method on Yᵀe = 0, eqs. (62), (76) and section 4.2.1.
//!
//! Each step sets H_F ← H_F H(ΔU_F) with ΔU_F = S Yᵀe and S = (YᵀF)⁻¹. Y is scaled so that YᵀU = I: S is near the identity
//! and the residual Yᵀe is itself a small motion.

use super::dense;
use super::error::EvaluationError;
use super::modal_component::ModalComponent;
use super::projection::{add_rigid, measure_rate};
use super::state::State;
use super::workspace::{Workspace, all_finite};
use crate::motion::{Matrix3, Motion, cross, dot, times_6};

/// Steps from one start. From a node turned by half a radian four are needed; the limit is for those that diverge.
const MAX_ITERATIONS: usize = 25;

/// Smallest pivot of YᵀF, which is the identity without deformation.
const SMALLEST_PIVOT: f64 = 1e-3;

/// How far RᵀR of a node may be from the identity: 1e7 steps that each round at 1e-16 drift by 1e-9.
const ROTATION_TOLERANCE: f64 = 1e-6;

/// Checks the state; finds H_F, e, J, F, S, Q, V_F and ė.
pub(super) fn kinematics(
    component: &ModalComponent,
    state: &State<'_>,
    workspace: &mut Workspace,
) -> Result<(), EvaluationError> {
    workspace.check_component(component)?;
    workspace.has_state = false;
    check(component, state)?;
    find_frame(component, state, workspace)?;
    project_frame(component, workspace);
    velocities(component, state.velocities, workspace);
    Ok(())
}

fn check(component: &ModalComponent, state: &State<'_>) -> Result<(), EvaluationError> {
    let r = component.n_coordinates();
    let numbers = [
        ("amplitudes", state.amplitudes, component.n_modal),
        ("velocities", state.velocities, r),
        ("accelerations", state.accelerations, r),
    ];
    check_motions(component, state.motions)?;
    for (what, values, expected) in numbers {
        if values.len() != expected {
            return Err(EvaluationError::WrongLength { what, found: values.len(), expected });
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(EvaluationError::NotFinite { what, index });
        }
    }
    Ok(())
}

/// As many motions as nodes, each a finite translation and a rotation.
pub(super) fn check_motions(component: &ModalComponent, motions: &[Motion]) -> Result<(), EvaluationError> {
    if motions.len() != component.n_nodes() {
        let (what, found, expected) = ("motions of nodes", motions.len(), component.n_nodes());
        return Err(EvaluationError::WrongLength { what, found, expected });
    }
    for (node, motion) in motions.iter().enumerate() {
        if let Some(axis) = motion.translation.iter().position(|value| !value.is_finite()) {
            let (what, index) = ("translations of nodes", 3 * node + axis);
            return Err(EvaluationError::NotFinite { what, index });
        }
        if !is_rotation(&motion.rotation) {
            return Err(EvaluationError::NotRotation { node });
        }
    }
    Ok(())
}

/// From the given frame, or the last one carried along with node 0; failing that from each node in turn.
fn find_frame(component: &ModalComponent, state: &State<'_>, workspace: &mut Workspace) -> Result<(), EvaluationError> {
    let first = match workspace.given_frame.take() {
        Some(frame) if is_rotation(&frame.rotation) && all_finite(&frame.translation) => frame,
        Some(_) => return Err(EvaluationError::InvalidFrame),
        None => state.motions[0].compose(&workspace.frame_in_node),
    };
    let mut outcome = newton(component, state, first, workspace);
    for start in state.motions {
        if outcome.is_ok() {
            break;
        }
        outcome = newton(component, state, *start, workspace);
    }
    workspace.frame_in_node = state.motions[0].relative(&workspace.floating_frame);
    if outcome.is_err() {
        workspace.frame_in_node = Motion::IDENTITY;
    }
    outcome
}

fn newton(
    component: &ModalComponent,
    state: &State<'_>,
    start: Motion,
    workspace: &mut Workspace,
) -> Result<(), EvaluationError> {
    let rounding = component.frame_rounding.of(state);
    workspace.floating_frame = start.orthonormalised();
    let mut correction = [0.0; 6];
    for _ in 0..MAX_ITERATIONS {
        measure(component, state, workspace)?;
        let gradient = dense::block_sum(&component.frame, workspace.nodes.iter().map(|node| &node.f));
        workspace.s = dense::inverse(&gradient, SMALLEST_PIVOT).ok_or(EvaluationError::FrameSingular)?;
        let residual = dense::columns_times(&component.frame, &workspace.deformation);
        if residual.iter().zip(&rounding).all(|(x, limit)| x.abs() <= *limit) {
            return Ok(());
        }
        correction = times_6(&workspace.s, &residual);
        workspace.floating_frame = workspace.floating_frame.compose(&Motion::exp(&correction));
    }
    let correction = correction.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    Err(EvaluationError::FrameNotConverged { iterations: MAX_ITERATIONS, correction })
}

/// e, J and F of the nodes for the current floating frame.
fn measure(component: &ModalComponent, state: &State<'_>, workspace: &mut Workspace) -> Result<(), EvaluationError> {
    let (blocks, amplitudes) = workspace.deformation.split_at_mut(6 * component.n_nodes());
    let each = workspace.nodes.iter_mut().zip(state.motions).zip(&component.positions);
    for (j, (((node, motion), position), e)) in each.zip(blocks.as_chunks_mut::<6>().0).enumerate() {
        let relative = workspace.floating_frame.relative(motion);
        *node = component.measures.of(&relative, position).ok_or(EvaluationError::HalfTurn { node: j })?;
        *e = node.e;
    }
    amplitudes.copy_from_slice(state.amplitudes);
    Ok(())
}

/// Qᵀ = JᵀY Sᵀ, r × 6, and F − U.
pub(super) fn project_frame(component: &ModalComponent, workspace: &mut Workspace) {
    let n_nodal = 6 * component.n_nodes();
    let (blocks, amplitudes) = workspace.q.split_at_mut(n_nodal);
    let (frame_blocks, frame_amplitudes) = component.frame.split_at(n_nodal);
    let each = blocks.as_chunks_mut::<6>().0.iter_mut().zip(frame_blocks.as_chunks::<6>().0);
    for ((q, y), node) in each.zip(&workspace.nodes) {
        *q = dense::turned_rows(&node.j, y);
    }
    amplitudes.copy_from_slice(frame_amplitudes);
    for (node, rigid) in workspace.nodes.iter_mut().zip(&component.rigid) {
        node.excess = core::array::from_fn(|i| dense::plus_scaled(&node.f[i], -1.0, &rigid[i]));
    }
    dense::apply_to_rows(&workspace.s, &mut workspace.q);
}

/// V_F = Q v, ė = J v − F V_F and ε = ė + U V_F.
fn velocities(component: &ModalComponent, v: &[f64], workspace: &mut Workspace) {
    let v_f = workspace.frame_part(v);
    workspace.frame_velocity = v_f;
    measure_rate(v, &v_f, &workspace.nodes, &mut workspace.deformation_rate);
    add_rigid(&component.rigid, &workspace.deformation_rate, &v_f, &mut workspace.velocity);
}

fn is_rotation([a, b, c]: &Matrix3) -> bool {
    let near = |value: f64, target: f64| (value - target).abs() <= ROTATION_TOLERANCE;
    let unit = [a, b, c].into_iter().all(|row| near(dot(row, row), 1.0));
    let orthogonal = [(a, b), (a, c), (b, c)].into_iter().all(|(x, y)| near(dot(x, y), 0.0));
    unit && orthogonal && near(dot(&cross(a, b), c), 1.0)
}
