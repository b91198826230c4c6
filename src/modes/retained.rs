//! The modes a method retains: the one place where the reduction method is told apart.

use super::{Boundary, Factored, FreeAtZero, ModalProblem, ModeRequest, Modes, Wanted, elastic_modes};
use crate::basis::{ConstraintModes, DynamicColumns, fixed_interface_columns, mode_acceleration_columns};
use crate::error::Result;
use crate::factor::Cholesky;
use crate::job::{Method, ModeSelection, ReductionJob};
use crate::partition::Partition;
use crate::rigid::RigidBodyModes;
use crate::sparse::SparseMatrix;

/// What the modes are computed from.
#[derive(Clone, Copy, Debug)]
pub struct Component<'a> {
    /// The matrices in their order.
    pub partition: &'a Partition,
    /// K_II and M_II.
    pub internal: (&'a SparseMatrix, &'a SparseMatrix),
    /// The factor of K_II.
    pub factor: &'a Cholesky<'a>,
    /// The rigid-body modes.
    pub rigid: &'a RigidBodyModes,
    /// The constraint modes.
    pub constraint: &'a ConstraintModes,
}

/// The modes a method retains, and the columns of Ψ_D that they make.
#[derive(Clone, Debug)]
pub struct Retained {
    /// The elastic modes.
    pub modes: Modes,
    /// The boundary they were computed under.
    pub boundary: Boundary,
    /// The columns of Ψ_D.
    pub columns: DynamicColumns,
}

/// Computes the modes that the job's method retains.
///
/// # Errors
/// The eigensolver does not converge; a mechanism.
pub fn retained(component: Component<'_>, job: &ReductionJob, seed: u64) -> Result<Retained> {
    let Component { partition, internal, factor, rigid, constraint } = component;
    let request = ModeRequest { wanted: wanted(job.modes, partition), eigensolver: job.eigensolver, seed };
    match job.method {
        Method::CraigBampton => {
            let problem =
                ModalProblem { stiffness: internal.0, mass: internal.1, rigid: None, precision: partition.precision };
            let modes = elastic_modes(problem, &Factored::new(factor, 0.0), request)?;
            Ok(Retained { columns: fixed_interface_columns(&modes), modes, boundary: Boundary::FixedInterface })
        }
        Method::Herting => {
            let problem = ModalProblem {
                stiffness: &partition.stiffness,
                mass: &partition.mass,
                rigid: Some(rigid),
                precision: partition.precision,
            };
            let schur = constraint.stiffness.as_ref();
            let operator = FreeAtZero::new(factor, &partition.stiffness, constraint.modes.as_ref(), schur, rigid)?;
            let modes = elastic_modes(problem, &operator, request)?;
            let columns = mode_acceleration_columns(partition, factor, constraint, rigid, &modes);
            Ok(Retained { modes, boundary: Boundary::FreeInterface, columns })
        }
    }
}

fn wanted(selection: ModeSelection, partition: &Partition) -> Wanted {
    match selection {
        ModeSelection::Count { count } => Wanted::Count(count),
        ModeSelection::UpTo { up_to_hz } => {
            let omega = 2.0 * std::f64::consts::PI * up_to_hz;
            Wanted::UpTo(omega * omega / partition.scaling.eigenvalue_unit())
        }
    }
}
