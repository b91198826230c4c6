//! Interfaces and held dofs as flags name them.

use super::flags::ModelFlags;
use crate::dofs::Direction;
use crate::error::{Error, Result};
use crate::job::{Coupling, FixedJob, InterfaceJob, NodeSelection};

/// The interfaces of the flags: the direct ones, then the rigid ones, each in the order typed.
pub(super) fn interfaces(model: &ModelFlags) -> Result<Vec<InterfaceJob>> {
    let direct = model.interface.iter().map(|text| interface("--interface", text, Coupling::Direct));
    let rigid = model.rigid_interface.iter().map(|text| interface("--rigid-interface", text, Coupling::Rigid));
    direct.chain(rigid).collect()
}

fn interface(flag: &'static str, text: &str, coupling: Coupling) -> Result<InterfaceJob> {
    let wrong = |expected| Error::FlagText { flag, text: text.to_owned(), expected };
    let (name, nodes) = text.split_once('=').ok_or_else(|| wrong("NAME=NODES, as in hub=12,17,19"))?;
    let nodes = nodes_of(nodes).map_err(wrong)?;
    Ok(InterfaceJob::new(name, nodes, coupling))
}

/// The held dofs of `--fix`, in the order typed.
pub(super) fn fixed(fix: &[String]) -> Result<Vec<FixedJob>> {
    let of_flag = |text: &String| {
        let wrong = |expected| Error::FlagText { flag: "--fix", text: text.clone(), expected };
        let (name, nodes) = text.split_once('=').ok_or_else(|| wrong("NAME=NODES[:DOFS], as in foot=12,17:ux,uy"))?;
        let (nodes, dofs) = match nodes.rsplit_once(':').map(|(nodes, last)| (nodes, directions(last))) {
            // `group:ux` is the group of that name.
            Some((nodes, Some(dofs))) if nodes != "group" => (nodes, Some(dofs)),
            _ => (nodes, None),
        };
        Ok(FixedJob { name: Some(name.to_owned()), nodes: nodes_of(nodes).map_err(wrong)?, dofs })
    };
    fix.iter().map(of_flag).collect()
}

/// The nodes that follow the name in a flag; what was expected where they are none.
fn nodes_of(text: &str) -> std::result::Result<NodeSelection, &'static str> {
    if text.starts_with("group:") {
        return Ok(NodeSelection::Group(text.to_owned()));
    }
    if let Some(rows) = text.strip_prefix("rows:") {
        let rows = numbers(rows).ok_or("row numbers from zero, as in hub=rows:0,1,2")?;
        return Ok(NodeSelection::Rows { rows });
    }
    numbers(text).map(NodeSelection::Labels).ok_or("node labels, group:NAME or rows:0,1,2 after the =")
}

fn directions(text: &str) -> Option<Vec<Direction>> {
    let direction = |word: &str| Direction::ALL.into_iter().find(|direction| direction.to_string() == word.trim());
    text.split(',').map(direction).collect()
}

pub(super) fn numbers<T: std::str::FromStr>(text: &str) -> Option<Vec<T>> {
    text.split(',').map(|number| number.trim().parse().ok()).collect()
}
