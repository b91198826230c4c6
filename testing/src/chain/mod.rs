//! The stages of a reduction run on generated models, and a dense twin of each model to judge them by.
//!
//! The twin is made from the model's own entries and from the definition of a rigid patch, without a line of the
//! library; it shares with the partition only the order of the degrees of freedom and the powers of two taken out.

pub mod certified;
mod twin;

use supel::basis::{Basis, DynamicColumns, retained_columns};
use supel::constraint::FreeAtZero;
use supel::constraint::{ConstraintModes, constraint_modes, with_mechanisms};
use supel::coordinates;
use supel::dofs::{Direction, Dof, DofMap, Nodes};
use supel::eigen::{Factored, ModalProblem, ModeRequest, Modes, Wanted, elastic_modes};
use supel::error::Error;
use supel::factor::Cholesky;
use supel::input::{Digits, Input, MatrixInput};
pub use supel::job::Method;
use supel::job::{
    Boundary, Coupling, Eigensolver, InterfaceJob, ModeOrigin, ModeSelection, NodeSelection, ReductionJob,
};
use supel::model::Model;
use supel::modes::{Component, Retained};
use supel::partition::{self, Partition};
use supel::plan::Relief;
use supel::random::SEED;
use supel::reduction::Reduction;
use supel::rigid::{self, RigidBodyModes};
use supel::sparse::{AssemblyNotes, Declared, SparseMatrix, Triplets};
use supel_models as models;
use supel_models::model::Entry;

pub use twin::{
    EPS, Twin, absolute, against_bound, column_difference, dense, difference, mean_motion, psi, spectrum, terms,
};

/// A generated model as the readers would hand it over.
pub fn input(model: &models::Model) -> Input {
    let dofs = model
        .dofs
        .iter()
        .map(|&(node, direction)| Some(Dof { node, direction: Direction::ALL[usize::from(direction)] }));
    let dofs: DofMap = dofs.collect();
    let index = |label: &i64| model.labels.iter().position(|other| other == label).expect("a node of the model");
    let groups = model.groups.iter().map(|(name, members)| (name.clone(), members.iter().map(index).collect()));
    let nodes = Nodes { labels: model.labels.clone(), coordinates: model.nodes.clone(), groups: groups.collect() };
    Input {
        stiffness: matrix(model.n, &model.stiffness),
        mass: matrix(model.n, &model.mass),
        cells: Vec::new(),
        nodes: (!dofs.is_empty()).then_some(nodes),
        dofs: (!dofs.is_empty()).then_some(dofs),
        labels: Default::default(),
        rows: Default::default(),
        constraints: None,
        internal_forces: None,
        turning: None,
        axes: None,
        digests: Default::default(),
        notes: Vec::new(),
    }
}

fn matrix(n: usize, entries: &[Entry]) -> MatrixInput {
    let notes = AssemblyNotes::default();
    MatrixInput {
        matrix: sparse(n, entries),
        notes,
        digits: Digits::DOUBLE,
        path: "generated".into(),
        layout: None,
        digest: String::new(),
    }
}

/// The matrix of all entries of both triangles.
pub fn sparse(n: usize, entries: &[Entry]) -> SparseMatrix {
    let mut triplets = Triplets::default();
    entries.iter().for_each(|&(row, col, value)| triplets.push(row, col, value));
    triplets.assemble(n, Declared::General, "generated".as_ref()).expect("both triangles of a general matrix").0
}

/// An interface of the nodes themselves.
pub fn direct(name: &str, labels: &[i64]) -> InterfaceJob {
    interface(name, NodeSelection::Labels(labels.to_vec()), Coupling::Direct)
}

/// One rigid node that carries a group.
pub fn rigid_group(name: &str) -> InterfaceJob {
    interface(name, NodeSelection::Group(format!("group:{name}")), Coupling::Rigid)
}

/// Rows as interface dofs.
pub fn rows(name: &str, rows: &[usize]) -> InterfaceJob {
    interface(name, NodeSelection::Rows { rows: rows.to_vec() }, Coupling::Direct)
}

/// An interface with the centroid as origin and all dofs.
pub fn interface(name: &str, nodes: NodeSelection, coupling: Coupling) -> InterfaceJob {
    InterfaceJob::new(name, nodes, coupling)
}

/// Everything the stages handed on.
pub struct Chain {
    pub partition: Partition,
    pub rigid: RigidBodyModes,
    pub constraint: ConstraintModes<'static>,
    pub modes: Modes,
    pub named: DynamicColumns,
    pub basis: Basis<'static>,
    pub reduction: Reduction,
}

/// The partition of a generated model.
pub fn partition(model: &models::Model, interfaces: &[InterfaceJob]) -> Result<Partition, Error> {
    let model = Model::new(input(model))?;
    let tied = partition::nodes_of_patches(&model, interfaces);
    Partition::new(coordinates::compared(model, (&[], supel::job::Mechanisms::default()), &tied)?, interfaces)
}

/// The partition and its rigid-body modes, from coordinates where there are any.
pub fn rigid_of(model: &models::Model, interfaces: &[InterfaceJob]) -> Result<(Partition, RigidBodyModes), Error> {
    let partition = partition(model, interfaces)?;
    let rigid = rigid::rigid_body_modes(&partition)?.0;
    Ok((partition, rigid))
}

/// Reduces a generated model with `count` expansion modes.
pub fn reduce(
    model: &models::Model,
    interfaces: &[InterfaceJob],
    method: Method,
    count: usize,
) -> Result<Chain, Error> {
    let (partition, rigid) = rigid_of(model, interfaces)?;
    rigid::interface_rank(&partition, &rigid)?;
    let analysis = partition.analysis()?;
    let factor = Cholesky::new(&analysis, partition.pencil(), 0.0, &|dof| partition.name_of(dof))?;
    let constraint = constraint_modes(&partition, &factor, &rigid);
    let (rigid, _) = with_mechanisms(&partition, &constraint, rigid)?;
    // Guyan's method keeps none.
    let count = if method.modes() == ModeOrigin::Computed { count } else { 0 };
    let request = ModeRequest { wanted: Wanted::Count(count), eigensolver: Eigensolver::Lanczos, seed: SEED };
    let precision = partition.precision;
    let boundary = method.boundary();
    let modes = match boundary {
        Boundary::FixedInterface => {
            let problem = ModalProblem::of(partition.internal(), precision);
            elastic_modes(problem, &Factored::new(&factor, 0.0), request)?
        }
        // Mixed boundaries need a job that says what they hold.
        Boundary::FreeInterface | Boundary::MixedInterface => {
            let operator = FreeAtZero::new(&factor, &partition.stiffness, &constraint, &rigid)?;
            let problem = ModalProblem::of(partition.pencil(), precision).deflating(rigid.deflated());
            elastic_modes(problem, &operator, request)?
        }
    };
    let component = Component::new(&partition, &analysis, &factor, &rigid, Some(&constraint));
    let retained = Retained::of(modes, boundary);
    let job = ReductionJob::new(method, ModeSelection::Count { count });
    let named = retained_columns(component, &constraint, Relief::of_reduction(&job), &retained);
    let basis = Basis::new(&constraint, &named, partition.internal().mass);
    let reduction = Reduction::new(&partition, &basis, &rigid).with_mass_of(&job, &basis, &retained)?;
    let modes = retained.modes;
    Ok(Chain { partition, rigid, constraint, modes, named, basis, reduction })
}
