//! Matrix Market: K̂ and M̂ with the dof map and the nodes, as `supel reduce` reads a model.
//!
//! Modal amplitudes are scalar dofs: rows of the dof map without a node, which no rigid-body motion moves, because Ψ carries
//! rigid-body motion by the interface alone (24). Where rigid-body modes are coordinates next to an interface they do move, and the job
//! has rows only. A superelement whose interface has no positions is one of bare rows and leaves without map and nodes. Numbers have
//! seventeen digits, from which every double comes back to the bit. Where K̂ holds nothing but rounding it leaves as zero.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use supel_runtime::{Coordinate, InterfaceNode, Matrix, NamedMatrix, Quantity, Superelement, Tensors};

use super::format::{ExportedFile, Format};
use super::job_text::ModelFiles;
use super::joined::{Joined, label, packed};
use super::load_transformation::transformations;
use super::model_job::job;
use super::names::Names;
use crate::assembly::JoinedNode;
use crate::error::Result;
use crate::input::strainless::condensed_stiffness;
use crate::report::{field, printable};

/// Matrix Market files, tables and a job.
#[derive(Debug)]
pub(super) struct MatrixMarket;

impl Format for MatrixMarket {
    fn name(&self) -> &'static str {
        "matrix-market"
    }

    fn endings(&self) -> &'static [&'static str] {
        &ENDINGS
    }

    fn files(&self, superelement: &Superelement, names: &Names) -> Result<Vec<ExportedFile>> {
        let file = ExportedFile::text;
        let nodes = &superelement.metadata().interface_nodes;
        let labels = superelement.metadata().interface_labels();
        let rows = rows(superelement, &labels);
        let stiffness = condensed_stiffness(superelement)?.stiffness;
        let Tensors { mass, damping, gravity, load_vectors, recovery, quantities, matrices, .. } =
            superelement.tensors();
        let mut files = vec![file("stiffness.mtx", "stiffness", symmetric(&stiffness, &rows))];
        if mass.rows() > 0 {
            files.push(file("mass.mtx", "mass", symmetric(mass, &rows)));
        }
        let further = side_by_side(matrices);
        let arrays = [
            ("damping.mtx", "damping", damping.as_ref()),
            ("gravity.mtx", "loads of a unit gravity field along x, y, z", gravity.as_ref()),
            ("loads.mtx", "load vectors", load_vectors.as_ref()),
            ("recovery.mtx", "recovery", recovery.as_ref().map(|recovery| recovery.rows())),
            ("quantities.mtx", "quantities", quantities.as_ref()),
            ("matrices.mtx", "further matrices, next to each other", further.as_ref()),
        ];
        let arrays = arrays.into_iter().filter_map(|(ending, content, matrix)| Some((ending, content, matrix?)));
        files.extend(arrays.map(|(ending, content, matrix)| file(ending, content, array(matrix))));
        let transformations = transformations(superelement).into_iter();
        files.extend(transformations.map(|own| file(own.ending, own.content, array(&own.matrix))));
        files.extend(recovery.as_ref().map(|recovery| {
            let dofs = recovery.dofs().iter().map(|dof| (Some(dof.node), dof.direction.to_string()));
            file("recovery-dofs.csv", "node and direction of each row of the recovery", dof_map(dofs))
        }));
        files.extend(quantities.as_ref().map(|_| {
            let text = quantity_table(&superelement.metadata().quantities);
            file("quantities.csv", "name and unit of each quantity", text)
        }));
        files.extend(further.as_ref().map(|_| {
            file(
                "matrices.csv",
                "name and kind of each further matrix",
                matrix_table(&superelement.metadata().matrices),
            )
        }));
        if !nodes.is_empty() {
            files.push(file("dofs.csv", "node and direction of each row", dofs(superelement, &labels)));
            files.push(file("nodes.csv", "nodes", node_table(nodes, &labels)));
        }
        let job = job(superelement)?.ok();
        files.extend(job.map(|job| file("job.toml", JOB, job.render(&ModelFiles::exported(names)))));
        Ok(files)
    }

    fn files_of_joined(&self, joined: &Joined, names: &Names) -> Option<Vec<ExportedFile>> {
        let file = ExportedFile::text;
        let Joined { model, job, .. } = joined;
        let rows: Vec<String> = model.rows.iter().map(|row| row.name.clone()).collect();
        let mut files = vec![
            file("stiffness.mtx", "stiffness", symmetric(&packed(&model.stiffness), &rows)),
            file("mass.mtx", "mass", symmetric(&packed(&model.mass), &rows)),
        ];
        if model.loads.ncols() > 0 {
            files.push(file("loads.mtx", "load vectors", array(&packed(&model.loads))));
        }
        if !model.nodes.is_empty() {
            let named = model.rows.iter().map(|row| match row.at {
                Some((node, direction)) => (Some(label(node)), direction.to_string()),
                None => (None, SCALAR.to_owned()),
            });
            files.push(file("dofs.csv", "node and direction of each row", dof_map(named)));
            files.push(file("nodes.csv", "nodes", joined_nodes(&model.nodes)));
        }
        files.extend(job.as_ref().map(|job| file("job.toml", JOB, job.render(&ModelFiles::exported(names)))));
        Some(files)
    }
}

/// Endings of all its files.
const ENDINGS: [&str; 21] = [
    "stiffness.mtx",
    "mass.mtx",
    "damping.mtx",
    "gravity.mtx",
    "loads.mtx",
    "recovery.mtx",
    "quantities.mtx",
    "matrices.mtx",
    "ltm-acceleration.mtx",
    "net-ltm-acceleration.mtx",
    "ltm-velocity.mtx",
    "net-ltm-velocity.mtx",
    "ltm-displacement.mtx",
    "net-ltm-displacement.mtx",
    "cg-atm.mtx",
    "recovery-dofs.csv",
    "quantities.csv",
    "matrices.csv",
    "dofs.csv",
    "nodes.csv",
    "job.toml",
];

/// What the job is, for people.
const JOB: &str = "a job that reduces it again";

/// What each row is, for people.
fn rows(superelement: &Superelement, labels: &[i64]) -> Vec<String> {
    let metadata = superelement.metadata();
    let of_coordinate = |coordinate: &Coordinate| match coordinate {
        Coordinate::Interface { node, direction } => format!("node {} {direction}", labels[*node]),
        Coordinate::InterfaceRow { row } => format!("row {row} (from zero) of the model"),
        Coordinate::ElasticMode { mode, frequency_hz, .. } => format!("elastic mode {}, {frequency_hz} Hz", mode + 1),
        Coordinate::FixedInterfaceMode { mode, frequency_hz, .. } => {
            format!("fixed-interface mode {}, {frequency_hz} Hz", mode + 1)
        }
        Coordinate::MixedInterfaceMode { mode, frequency_hz, .. } => {
            format!("mixed-interface mode {}, {frequency_hz} Hz", mode + 1)
        }
        mode => mode.mode_name(&metadata.load_names).unwrap_or_default(),
    };
    metadata.coordinates.iter().map(of_coordinate).collect()
}

/// A number from which the double comes back.
fn number(value: f64) -> String {
    format!("{value:.16e}")
}

/// A matrix that is symmetric to the bit: its lower triangle, column by column, without zeros.
fn symmetric(matrix: &Matrix, rows: &[String]) -> String {
    let n = matrix.rows();
    let entries = || (0..n).flat_map(|j| (j..n).map(move |i| (i, j))).filter(|at| matrix[*at] != 0.0);
    let mut text = String::from("%%MatrixMarket matrix coordinate real symmetric\n");
    for (row, what) in rows.iter().enumerate() {
        let _ = writeln!(text, "% row {}: {}", row + 1, printable(what));
    }
    let _ = writeln!(text, "{n} {n} {}", entries().count());
    for (i, j) in entries() {
        let _ = writeln!(text, "{} {} {}", i + 1, j + 1, number(matrix[(i, j)]));
    }
    text
}

/// A matrix with all entries, column by column.
fn array(matrix: &Matrix) -> String {
    let (m, n) = (matrix.rows(), matrix.cols());
    let mut text = format!("%%MatrixMarket matrix array real general\n{m} {n}\n");
    for at in (0..n).flat_map(|j| (0..m).map(move |i| (i, j))) {
        let _ = writeln!(text, "{}", number(matrix[at]));
    }
    text
}

fn dofs(superelement: &Superelement, labels: &[i64]) -> String {
    dof_map(superelement.metadata().coordinates.iter().map(|coordinate| match coordinate {
        Coordinate::Interface { node, direction } => (Some(labels[*node]), direction.to_string()),
        _ => (None, SCALAR.to_owned()),
    }))
}

/// What the dof map says in place of a direction of a row that no node has.
const SCALAR: &str = "scalar";

fn dof_map(rows: impl Iterator<Item = (Option<i64>, String)>) -> String {
    let mut text = String::from("node,dof\n");
    for (node, dof) in rows {
        let _ = writeln!(text, "{},{dof}", node.map_or_else(String::new, |node| node.to_string()));
    }
    text
}

/// Matrices of as many rows next to each other; none where there are none.
pub(super) fn side_by_side(matrices: &[Matrix]) -> Option<Matrix> {
    let (rows, cols) = (matrices.first()?.rows(), matrices.first()?.cols());
    Some(Matrix::from_fn(rows, cols * matrices.len(), |i, j| matrices[j / cols][(i, j % cols)]))
}

fn matrix_table(matrices: &[NamedMatrix]) -> String {
    let row = |matrix: &NamedMatrix| format!("{},{}\n", field(&matrix.name), matrix.kind);
    std::iter::once("name,kind\n".to_owned()).chain(matrices.iter().map(row)).collect()
}

fn quantity_table(quantities: &[Quantity]) -> String {
    let row = |quantity: &Quantity| format!("{},{}\n", field(&quantity.name), field(&quantity.unit));
    std::iter::once("name,unit\n".to_owned()).chain(quantities.iter().map(row)).collect()
}

/// Nodes of an assembly with the interface nodes that they are.
fn joined_nodes(nodes: &[JoinedNode]) -> String {
    let mut text = String::from(NODE_TABLE);
    for (at, node) in nodes.iter().enumerate() {
        let [x, y, z] = node.position.map(number);
        let _ = writeln!(text, "{},{x},{y},{z},{}", label(at), field(&node.names.join(" + ")));
    }
    text
}

/// The first line of a table of nodes.
const NODE_TABLE: &str = "node,x,y,z,interface\n";

/// Nodes with their interfaces; dofs of one node may belong to several.
fn node_table(nodes: &[InterfaceNode], labels: &[i64]) -> String {
    let mut of_label: BTreeMap<i64, (usize, Vec<&str>)> = BTreeMap::new();
    for (index, node) in nodes.iter().enumerate() {
        of_label.entry(labels[index]).or_insert((index, Vec::new())).1.push(&node.name);
    }
    let mut text = String::from(NODE_TABLE);
    for (index, label) in labels.iter().enumerate() {
        let Some((_, names)) = of_label.get(label).filter(|(first, _)| *first == index) else { continue };
        let [x, y, z] = nodes[index].position.map(number);
        let _ = writeln!(text, "{label},{x},{y},{z},{}", field(&names.join(" + ")));
    }
    text
}
