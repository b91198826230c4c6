//! One component of a mechanism: what goes in and comes out, in the mechanism's coordinates.

use faer::Mat;
use supel_runtime::Superelement;
use supel_runtime::component::{FloatingFrame, Measures, ModalComponent, RecoveredNode, State, Workspace};
use supel_runtime::motion::{IDENTITY_3, Motion, Vector3};

use super::configuration::Configuration;
use super::forces::{Forces, Matrices};
use crate::Result;

/// How far a node of the mechanism may be from the interface node that it is, as a share of the largest coordinate: two programs
/// write the same place in ten digits.
const SAME_PLACE: f64 = 1e-9;

/// How a component defines its floating frame and its deformation.
#[derive(Clone, Copy, Debug)]
pub struct Formulation {
    /// Y of eq. (8).
    pub frame: FloatingFrame,
    /// Motion-based or classical.
    pub measures: Measures,
}

/// A component with its place in the mechanism.
#[derive(Debug)]
pub(super) struct Body {
    component: ModalComponent,
    nodes: Vec<usize>,
    /// Coordinate of the mechanism of each coordinate of the component.
    rows: Vec<usize>,
    motions: Vec<Motion>,
    amplitudes: Vec<f64>,
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
    workspace: Workspace,
}

impl Body {
    /// A component whose interface nodes are nodes of the mechanism, and whose amplitudes are coordinates from the given one on.
    ///
    /// # Errors
    /// A superelement that the component refuses; a node of the mechanism that is not where the interface node is.
    pub(super) fn new(
        superelement: &Superelement,
        nodes: &[usize],
        positions: &[Vector3],
        first_amplitude: usize,
        formulation: Formulation,
    ) -> Result<Self> {
        let component = ModalComponent::with_measures(superelement, formulation.frame, formulation.measures)?;
        check_places(&component, nodes, positions)?;
        let (workspace, n_modal, n) = (component.workspace(), component.n_modal(), component.n_coordinates());
        let of_nodes = nodes.iter().flat_map(|node| 6 * node..6 * node + 6);
        let rows = of_nodes.chain(first_amplitude..first_amplitude + n_modal).collect();
        Ok(Self {
            component,
            nodes: nodes.to_vec(),
            rows,
            motions: vec![Motion::IDENTITY; nodes.len()],
            amplitudes: vec![0.0; n_modal],
            velocities: vec![0.0; n],
            accelerations: vec![0.0; n],
            workspace,
        })
    }

    /// The state of the mechanism, as far as it is this component's.
    pub(super) fn place(&mut self, at: &Configuration, velocity: &[f64], acceleration: &[f64]) -> Result<()> {
        for (motion, node) in self.motions.iter_mut().zip(&self.nodes) {
            *motion = at.motions[*node];
        }
        let (n_nodal, n_nodes) = (6 * self.nodes.len(), at.motions.len());
        for (amplitude, row) in self.amplitudes.iter_mut().zip(&self.rows[n_nodal..]) {
            *amplitude = at.amplitudes[row - 6 * n_nodes];
        }
        for (own, all) in [(&mut self.velocities, velocity), (&mut self.accelerations, acceleration)] {
            own.iter_mut().zip(&self.rows).for_each(|(value, row)| *value = all[*row]);
            self.component.velocities_to_origin(own)?;
        }
        Ok(())
    }

    pub(super) fn evaluate(&mut self) -> Result<()> {
        let Self { component, motions, amplitudes, velocities, accelerations, workspace, .. } = self;
        Ok(component.evaluate(&State { motions, amplitudes, velocities, accelerations }, workspace)?)
    }

    pub(super) fn tangents(&mut self) -> Result<()> {
        let Self { component, motions, amplitudes, velocities, accelerations, workspace, .. } = self;
        Ok(component.exact_tangents(&State { motions, amplitudes, velocities, accelerations }, workspace)?)
    }

    /// Kinetic energy, strain energy and potential energy in gravity of the state last evaluated.
    pub(super) fn energies(&self, gravity: &Vector3) -> Result<[f64; 3]> {
        let (workspace, potential) = (&self.workspace, self.component.gravity_potential(gravity, &self.workspace)?);
        Ok([workspace.kinetic_energy(), workspace.strain_energy(), potential])
    }

    /// Power that the damping takes in the state last evaluated.
    pub(super) fn dissipated_power(&self) -> f64 {
        self.workspace.dissipated_power()
    }

    /// Where the recovered nodes are, in the state last evaluated.
    pub(super) fn recovered(&self, positions: &[Vector3]) -> Result<Vec<RecoveredNode>> {
        let still = RecoveredNode { displacement: [0.0; 3], rotation: IDENTITY_3 };
        let mut nodes = vec![still; self.component.recovered_labels().len()];
        self.component.recover(&self.workspace, positions, &mut nodes)?;
        Ok(nodes)
    }

    pub(super) fn floating_frame(&self) -> &Motion {
        self.workspace.floating_frame()
    }

    pub(super) fn add_forces(&mut self, gravity: &Vector3, forces: &mut Forces) -> Result<()> {
        let weight = self.component.gravity_forces(gravity, &mut self.workspace)?.to_vec();
        let workspace = &self.workspace;
        let sources = [workspace.elastic_forces(), workspace.inertial_forces(), workspace.damping_forces(), &weight];
        let targets = [&mut forces.elastic, &mut forces.inertial, &mut forces.damping, &mut forces.applied];
        for (target, source) in targets.into_iter().zip(sources) {
            let mut own = source.to_vec();
            self.component.forces_to_nodes(&mut own)?;
            self.rows.iter().zip(own).for_each(|(row, force)| target[*row] += force);
        }
        Ok(())
    }

    pub(super) fn add_matrices(&self, matrices: &mut Matrices) -> Result<()> {
        let workspace = &self.workspace;
        self.add(workspace.stiffness(), &mut matrices.stiffness)?;
        self.add(workspace.exact_stiffness(), &mut matrices.exact_stiffness)?;
        self.add(workspace.mass(), &mut matrices.mass)?;
        self.add(workspace.gyroscopic(), &mut matrices.gyroscopic)?;
        // Empty where the file has no damping.
        if workspace.damping().is_empty() { Ok(()) } else { self.add(workspace.damping(), &mut matrices.damping) }
    }

    fn add(&self, source: &[f64], target: &mut Mat<f64>) -> Result<()> {
        let mut own = source.to_vec();
        self.component.matrix_to_nodes(&mut own)?;
        for (row, values) in self.rows.iter().zip(own.chunks_exact(self.rows.len())) {
            self.rows.iter().zip(values).for_each(|(column, value)| target[(*row, *column)] += value);
        }
        Ok(())
    }
}

/// The mechanism takes velocities at its nodes to the origin by its own positions, the component by those of the file.
fn check_places(component: &ModalComponent, nodes: &[usize], positions: &[Vector3]) -> Result<()> {
    if nodes.len() != component.n_nodes() {
        return Err(
            format!("a component of {} nodes with {} of the mechanism", component.n_nodes(), nodes.len()).into()
        );
    }
    let size = positions.as_flattened().iter().fold(0.0, |size: f64, x| size.max(x.abs()));
    for (own, node) in component.positions().iter().zip(nodes) {
        let apart = (0..3).map(|d| (own[d] - positions[*node][d]).abs()).fold(0.0, f64::max);
        if apart > SAME_PLACE * size {
            return Err(format!("node {node} is at {:?}, its component's at {own:?}", positions[*node]).into());
        }
    }
    Ok(())
}
