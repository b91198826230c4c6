//! One component of a mechanism: what goes in and comes out, in the mechanism's coordinates.

use supel_runtime::Superelement;
use supel_runtime::component::{ModalComponent, State, Workspace};
use supel_runtime::motion::{Motion, Vector3, Vector6, cross, join};

use crate::Result;
use crate::system::{Configuration, Forces, Formulation, Matrices};

/// A component with its place in the mechanism.
#[derive(Debug)]
pub(crate) struct Body {
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
    pub(crate) fn new(
        superelement: &Superelement,
        nodes: &[usize],
        first_amplitude: usize,
        formulation: Formulation,
    ) -> Result<Self> {
        let component = ModalComponent::with_measures(superelement, formulation.frame, formulation.measures)?;
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

    pub(crate) fn place(&mut self, positions: &[Vector3], at: &Configuration, velocity: &[f64], acceleration: &[f64]) {
        let n_nodes = self.nodes.len();
        for (place, node) in self.nodes.iter().enumerate() {
            self.motions[place] = at.motions[*node];
            let own = 6 * node..6 * node + 6;
            let there = 6 * place..6 * place + 6;
            self.velocities[there.clone()].copy_from_slice(&to_origin(&positions[*node], &velocity[own.clone()]));
            self.accelerations[there].copy_from_slice(&to_origin(&positions[*node], &acceleration[own]));
        }
        for (place, row) in self.rows.iter().enumerate().skip(6 * n_nodes) {
            self.amplitudes[place - 6 * n_nodes] = at.amplitudes[row - 6 * positions.len()];
            self.velocities[place] = velocity[*row];
            self.accelerations[place] = acceleration[*row];
        }
    }

    pub(crate) fn evaluate(&mut self) -> Result<()> {
        let Self { component, motions, amplitudes, velocities, accelerations, workspace, .. } = self;
        Ok(component.evaluate(&State { motions, amplitudes, velocities, accelerations }, workspace)?)
    }

    pub(crate) fn tangents(&mut self) -> Result<()> {
        let Self { component, motions, amplitudes, velocities, accelerations, workspace, .. } = self;
        Ok(component.tangents(&State { motions, amplitudes, velocities, accelerations }, workspace)?)
    }

    pub(crate) fn energy(&self) -> [f64; 2] {
        [self.workspace.kinetic_energy(), self.workspace.strain_energy()]
    }

    pub(crate) fn add_forces(&self, positions: &[Vector3], forces: &mut Forces) {
        let sources = [self.workspace.elastic_forces(), self.workspace.inertial_forces()];
        for (target, source) in [&mut forces.elastic, &mut forces.inertial].into_iter().zip(sources) {
            let own = self.at_nodes(positions, source);
            self.rows.iter().zip(own).for_each(|(row, force)| target[*row] += force);
        }
    }

    pub(crate) fn add_matrices(&self, positions: &[Vector3], matrices: &mut Matrices) {
        let sources = [self.workspace.stiffness(), self.workspace.mass()];
        for (target, source) in [&mut matrices.stiffness, &mut matrices.mass].into_iter().zip(sources) {
            let n = self.rows.len();
            // SᵀA S: every row of A as a force, then every column of the result.
            let right: Vec<Vec<f64>> = source.chunks_exact(n).map(|row| self.at_nodes(positions, row)).collect();
            for j in 0..n {
                let column: Vec<f64> = right.iter().map(|row| row[j]).collect();
                for (i, value) in self.at_nodes(positions, &column).into_iter().enumerate() {
                    target[(self.rows[i], self.rows[j])] += value;
                }
            }
        }
    }

    /// Sᵀ f.
    fn at_nodes(&self, positions: &[Vector3], forces: &[f64]) -> Vec<f64> {
        let mut own = forces.to_vec();
        for (place, node) in self.nodes.iter().enumerate() {
            let six = &mut own[6 * place..6 * place + 6];
            let moment = cross(&positions[*node], &[six[0], six[1], six[2]]);
            (0..3).for_each(|d| six[3 + d] -= moment[d]);
        }
        own
    }
}

/// S v: the velocity of the point at the inertial origin, from that at the node.
pub(crate) fn to_origin(position: &Vector3, velocity: &[f64]) -> Vector6 {
    let turn = [velocity[3], velocity[4], velocity[5]];
    let by_turn = cross(position, &turn);
    join(&std::array::from_fn(|d| velocity[d] + by_turn[d]), &turn)
}
