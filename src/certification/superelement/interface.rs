//! Which rows of the model a foreign superelement keeps as coordinates.

use std::collections::BTreeMap;

use super::files::ForeignSuperelement;
use crate::dofs::{Direction, Dof};
use crate::job::{Coupling, FixedJob, InterfaceJob, Job, NodeSelection};
use crate::partition::{DofOrigin, Partition};

/// Nodes that are an interface each; more of them are one together.
const MOST_NODES: usize = 8;

/// The rows that a superelement keeps.
#[derive(Clone, Debug, Default)]
pub struct Interface {
    /// For each kept row of the model its coordinate, from zero.
    pub coordinates: BTreeMap<usize, usize>,
    /// Their numbers in the files.
    pub rows: Vec<usize>,
    /// What a job has in their place.
    pub jobs: Vec<InterfaceJob>,
    /// What each of these coordinates is called.
    pub names: BTreeMap<usize, String>,
    /// Node and direction of each of these coordinates, where a map tells them.
    pub dofs: BTreeMap<usize, Dof>,
    /// Names of rows that no coordinate moves, though nothing holds them.
    pub at_rest: Vec<String>,
}

impl Interface {
    /// A job of the model with these rows at rest; none where there are none.
    pub fn held(&self, job: &Job) -> Option<Job> {
        if self.rows.is_empty() {
            return None;
        }
        let name = Some("interface of the superelement".to_owned());
        let at_rest = FixedJob { name, nodes: NodeSelection::Rows { rows: self.rows.clone() }, dofs: None };
        let fixed = job.fixed.iter().cloned().chain([at_rest]).collect();
        Some(Job { fixed, ..job.clone() })
    }
}

/// The rows that have a coordinate of their own: it moves them by one and no other coordinate moves them, and it does so with no other row.
/// Rows that the partition holds, or that follow others, are none.
pub fn interface(partition: &Partition, foreign: &ForeignSuperelement) -> Interface {
    let columns = &foreign.basis.columns;
    let rounding = foreign.basis.rounding;
    let is_one = |value: f64| (value - 1.0).abs() <= rounding.relative + rounding.absolute;
    let (mut rows_of, mut at_rest) = (vec![Vec::new(); columns.len()], BTreeMap::new());
    for (at, dof) in partition.dofs.iter().enumerate() {
        let DofOrigin::Row(row) = dof.origin else { continue };
        let in_file = partition.model.rows.of(row);
        let mut moving = columns.iter().enumerate().filter(|(_, column)| column[in_file] != 0.0);
        match (moving.next(), moving.next()) {
            (None, _) => drop(at_rest.insert(row, partition.name_of(at))),
            (Some((coordinate, column)), None) if is_one(column[in_file]) => rows_of[coordinate].push((row, at)),
            _ => {}
        }
    }
    let own: BTreeMap<usize, (usize, usize)> = rows_of
        .into_iter()
        .enumerate()
        .filter_map(|(coordinate, rows)| match rows[..] {
            [(row, at)] => Some((row, (coordinate, at))),
            _ => None,
        })
        .collect();
    let rows = own.keys().map(|row| partition.model.rows.of(*row)).collect();
    let jobs = jobs(own.iter().map(|(row, (_, at))| (partition.model.rows.of(*row), partition.dofs[*at].dof)));
    let names = own.values().map(|(coordinate, at)| (*coordinate, partition.name_of(*at))).collect();
    let dofs = own.values().filter_map(|(coordinate, at)| Some((*coordinate, partition.dofs[*at].dof?))).collect();
    let coordinates = own.into_iter().map(|(row, (coordinate, _))| (row, coordinate)).collect();
    Interface { coordinates, rows, names, dofs, jobs, at_rest: at_rest.into_values().collect() }
}

/// An interface for each node where there are a few, in the order of their first rows; otherwise one of all rows.
fn jobs(rows: impl Iterator<Item = (usize, Option<Dof>)>) -> Vec<InterfaceJob> {
    let (rows, dofs): (Vec<usize>, Vec<Option<Dof>>) = rows.unzip();
    let mut nodes: Vec<(i64, Vec<Direction>)> = Vec::new();
    for Dof { node, direction } in dofs.iter().copied().collect::<Option<Vec<Dof>>>().unwrap_or_default() {
        match nodes.iter_mut().find(|(label, _)| *label == node) {
            Some((_, directions)) => directions.push(direction),
            None => nodes.push((node, vec![direction])),
        }
    }
    let of_node = |(label, mut directions): (i64, Vec<Direction>)| {
        directions.sort_unstable();
        let job = InterfaceJob::new(format!("node {label}"), NodeSelection::Labels(vec![label]), Coupling::Direct);
        InterfaceJob { dofs: Some(directions), ..job }
    };
    match nodes.len() {
        _ if rows.is_empty() => Vec::new(),
        1..=MOST_NODES => nodes.into_iter().map(of_node).collect(),
        _ => vec![InterfaceJob::new("interface", NodeSelection::Rows { rows }, Coupling::Direct)],
    }
}
