//! What the interior of a component does: the rows of the basis, taken from the stages of the library.
//!
//! ```text
//! Ψ     n × r        rows of the model from reduced coordinates, u = T [Ψ_S Ψ_D; I 0] q
//! T     n × n'       identity but for the rows of rigid patches
//! ```

use supel::basis::{self, Basis};
use supel::factor::{Analysis, Cholesky};
use supel::job::Job;
use supel::model::Model;
use supel::modes::{self, Component, ModeSource, Retained};
use supel::partition::Partition;
use supel::{input, rigid};
use supel_runtime::{Direction, Matrix, Precision, RecoveredDof, Recovery, Superelement, Tensors};

use crate::Result;

/// The same superelement with the displacements of every node of the model as recovered rows.
///
/// The stages run again as they did for the superelement; equal input gives equal bits.
///
/// # Errors
/// Those of the stages.
pub fn with_interior(superelement: &Superelement, job: &Job) -> Result<Superelement> {
    let partition = Partition::new(&Model::new(input::read(&job.model)?)?, &job.interfaces)?;
    let psi = rows(&partition, job)?;
    let labels = partition.transformation.rows.len() / 3;
    let dofs =
        (1..=labels as i64).flat_map(|node| [0, 1, 2].map(|d| RecoveredDof { node, direction: Direction::ALL[d] }));
    let recovery = Recovery::new(psi, dofs.collect(), Precision::Double)?;
    let tensors = Tensors { recovery: Some(recovery), ..superelement.tensors().clone() };
    Ok(Superelement::new(tensors, superelement.metadata().clone())?)
}

/// Ψ in the units of the model, n × r.
fn rows(partition: &Partition, job: &Job) -> Result<Matrix> {
    let (free, _) = rigid::rigid_body_modes(partition)?;
    let analysis = Analysis::of(partition)?;
    let sigma = modes::shift_of_factor(partition, &free);
    let factor = Cholesky::new(&analysis, partition.pencil(), sigma, &|dof| partition.name_of(dof))?;
    let constraint = basis::constraint_modes(partition, &factor, &free);
    let (free, _) = rigid::with_mechanisms(partition, &constraint, free)?;
    let (k_ii, m_ii) = (partition.internal_stiffness(), partition.internal_mass());
    let component = Component::new(partition, (&k_ii, &m_ii), &analysis, &factor, &free, &constraint);
    let search = modes::Search::new(component, &job.reduction)?;
    let found = search.lowest(modes::SEED)?;
    let (found, _) = modes::certified(&search, &search.problem, found, search.edge(), job.run.certify)?;
    let retained = Retained::new(component, search.problem.boundary, found);
    let basis = Basis::new(&constraint, retained.columns.clone(), &m_ii);

    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let shape = partition.scaling.shape_unit();
    let of_dof = |dof: usize, j: usize| match (dof < n_i, j < n_b) {
        (true, true) => basis.constraint_modes[(dof, j)],
        (true, false) => shape * basis.dynamic_modes[(dof, j - n_b)],
        (false, _) => f64::from(u8::from(dof - n_i == j)),
    };
    let rows = &partition.transformation.rows;
    let of_row = |i: usize, j: usize| rows[i].entries().map(|(dof, factor)| factor * of_dof(dof as usize, j)).sum();
    Ok(Matrix::from_fn(rows.len(), basis.n_reduced(), of_row))
}
