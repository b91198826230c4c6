//! Node tables: `node,x,y,z` in any order among other columns.

use std::collections::HashMap;
use std::path::Path;

use super::allowance::Allowance;
use super::file_start::FileStart;
use super::format::{Format, NodeFormat, ReadNodes, Sureness};
use super::table::{Table, is_node_column, open_first_line};
use crate::dofs::Nodes;
use crate::error::{Error, Result};

const EXPECTED: &str = "a header with the columns node, x, y, z";

/// Bytes of a node: label, position, and the line it is known by.
const NODE: u64 = 64;
/// Rows after which their memory is claimed.
const ROWS_PER_CLAIM: usize = 1 << 8;

/// Tables of nodes, plain or gzipped.
pub(super) struct NodeTable;

impl Format for NodeTable {
    fn sureness(&self, _: &FileStart<'_>) -> Sureness {
        Sureness::Possible
    }
}

impl NodeFormat for NodeTable {
    fn read(&self, path: &Path, allowance: &Allowance) -> Result<ReadNodes> {
        read(path, allowance).map(|nodes| ReadNodes::along_the_axes(nodes, None))
    }
}

fn read(path: &Path, allowance: &Allowance) -> Result<Nodes> {
    let claim = allowance.claim(path);
    let mut table = Table::new(path, open_first_line(path, EXPECTED)?);
    let label_column = table.require("node", EXPECTED, is_node_column)?;
    let axes = [("x", "x"), ("y", "y"), ("z", "z")];
    let mut columns = [0; 3];
    for (column, (name, wanted)) in columns.iter_mut().zip(axes) {
        *column = table.require(name, EXPECTED, |name| name == wanted)?;
    }
    let mut nodes = Nodes::default();
    let mut lines: HashMap<i64, u64> = HashMap::new();
    while let Some(row) = table.next_row()? {
        let node = row.integer(label_column)?;
        if let Some(first_line) = lines.insert(node, row.line) {
            return Err(Error::NodeRepeated { path: path.to_owned(), line: row.line, node, first_line });
        }
        if nodes.labels.len().is_multiple_of(ROWS_PER_CLAIM) {
            claim.add(NODE * ROWS_PER_CLAIM as u64)?;
        }
        nodes.labels.push(node);
        nodes.coordinates.push([row.number(columns[0])?, row.number(columns[1])?, row.number(columns[2])?]);
    }
    if nodes.labels.is_empty() {
        return Err(Error::NoData { path: path.to_owned(), expected: "rows of node, x, y, z below the header" });
    }
    Ok(nodes)
}
