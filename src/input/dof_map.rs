//! What each row of the matrices stands for: `node.direction` line by line as CalculiX writes it, a table with a node
//! and a direction column, or the usual order where counts leave no doubt.

use std::collections::HashMap;
use std::io::{BufRead, Read};
use std::path::Path;

use super::banner::excerpt;
use super::source::read_error;
use super::table::{FirstLine, Row, Table, is_node_column, open_first_line};
use super::{Direction, Dof, DofMap, Nodes};
use crate::error::{Error, Result};

const EXPECTED: &str = "lines `node.direction`, or a header with the columns node and dof";
const DIRECTIONS: &str = "1 to 6 for ux, uy, uz, rx, ry, rz";
const DIRECTIONS_FROM_ZERO: &str = "0 to 5 for ux, uy, uz, rx, ry, rz, as the column counts from zero";
const DIRECTIONS_OR_NAMES: &str = "1 to 6 or ux, uy, uz, rx, ry, rz";

/// A dof map and how its directions were numbered.
pub(super) struct ReadDofs {
    /// The degree of freedom of every row.
    pub(super) dofs: DofMap,
    /// How directions are numbered.
    pub(super) base: DirectionBase,
}

/// The number of the direction ux.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DirectionBase {
    /// Directions count from 0.
    Zero,
    /// Directions count from 1, or have names.
    One,
}

/// Reads a dof map, plain or gzipped.
pub(super) fn read(path: &Path) -> Result<ReadDofs> {
    let first = open_first_line(path, EXPECTED)?;
    let is_table = first.text.contains(|c: char| c.is_alphabetic() || matches!(c, ',' | ';' | '\t'));
    let read = if is_table { read_table(path, first)? } else { read_lines(path, first)? };
    check_repeated(path, &read.dofs)?;
    Ok(read)
}

/// Three or six directions at each node, node by node, where the counts fit exactly.
pub(super) fn default_order(nodes: &Nodes, nodes_path: &Path, n: usize) -> Result<DofMap> {
    let n_nodes = nodes.labels.len();
    let directions = match n_nodes {
        0 => &[][..],
        _ if n_nodes.checked_mul(3) == Some(n) => &Direction::ALL[..3],
        _ if n_nodes.checked_mul(6) == Some(n) => &Direction::ALL[..],
        _ => &[][..],
    };
    if directions.is_empty() {
        return Err(Error::DofOrderUnknown { nodes: nodes_path.to_owned(), n_nodes, n });
    }
    let at_node = |&node: &i64| directions.iter().map(move |&direction| Dof { node, direction });
    Ok(nodes.labels.iter().flat_map(at_node).collect())
}

/// Checks that every node of a dof map has a position; returns how many nodes no row uses.
pub(super) fn check_nodes(dofs: &[Dof], path: &Path, nodes: &Nodes, nodes_path: &Path) -> Result<usize> {
    let index_of: HashMap<i64, usize> = nodes.labels.iter().enumerate().map(|(index, &label)| (label, index)).collect();
    let mut is_used = vec![false; nodes.labels.len()];
    for (row, dof) in dofs.iter().enumerate() {
        let Some(&index) = index_of.get(&dof.node) else {
            let (path, nodes) = (path.to_owned(), nodes_path.to_owned());
            return Err(Error::DofNodeMissing { path, row: row + 1, node: dof.node, nodes });
        };
        is_used[index] = true;
    }
    Ok(is_used.iter().filter(|&&used| !used).count())
}

fn read_lines(path: &Path, mut first: FirstLine) -> Result<ReadDofs> {
    /// The longest line; a label and a direction take twenty-two characters.
    const MAX_LINE_BYTES: u64 = 256;
    let mut dofs = vec![parse_line(path, first.line, &first.text)?];
    let mut line = first.line;
    let mut bytes = Vec::new();
    loop {
        bytes.clear();
        line += 1;
        let n_read = first.rest.by_ref().take(MAX_LINE_BYTES).read_until(b'\n', &mut bytes);
        if n_read.map_err(|error| read_error(path, error))? == 0 {
            return Ok(ReadDofs { dofs, base: DirectionBase::One });
        }
        let text = bytes.trim_ascii();
        if !text.is_empty() {
            dofs.push(parse_line(path, line, &String::from_utf8_lossy(text))?);
        }
    }
}

fn parse_line(path: &Path, line: u64, text: &str) -> Result<Dof> {
    let parts = text.split_once('.').and_then(|(node, direction)| Some((node.parse::<i64>().ok()?, direction)));
    let Some((node, direction)) = parts.filter(|(_, direction)| direction.bytes().all(|byte| byte.is_ascii_digit()))
    else {
        return Err(Error::DofText { path: path.to_owned(), line, found: excerpt(text.as_bytes()) });
    };
    match numbered(direction, DirectionBase::One) {
        Some(direction) => Ok(Dof { node, direction }),
        None => Err(direction_error(path, line, node, direction, DIRECTIONS)),
    }
}

fn read_table(path: &Path, first: FirstLine) -> Result<ReadDofs> {
    let mut table = Table::new(path, first);
    let node_column = table.require("node", EXPECTED, is_node_column)?;
    let direction_column = table.require("dof", EXPECTED, is_direction_column)?;
    let row_column = table.find(|name| matches!(name, "row" | "index" | "equation"));
    let header = table.name(direction_column);
    let mut rows = Vec::new();
    let mut first_number = None;
    while let Some(row) = table.next_row()? {
        if let Some(column) = row_column {
            check_row_number(path, &row, column, rows.len() as u64, &mut first_number)?;
        }
        rows.push((row.line, row.integer(node_column)?, row.text(direction_column).to_lowercase()));
    }
    if rows.is_empty() {
        return Err(Error::NoData { path: path.to_owned(), expected: "rows of node and direction below the header" });
    }
    let says_zero = ["0=", "0 =", "0-based", "zero"].iter().any(|mark| header.contains(mark));
    let has_zero = rows.iter().any(|(.., direction)| direction == "0");
    let base = if says_zero || has_zero { DirectionBase::Zero } else { DirectionBase::One };
    let expected = if base == DirectionBase::Zero { DIRECTIONS_FROM_ZERO } else { DIRECTIONS_OR_NAMES };
    let dofs = rows.iter().map(|(line, node, text)| match numbered(text, base).or_else(|| named(text)) {
        Some(direction) => Ok(Dof { node: *node, direction }),
        None => Err(direction_error(path, *line, *node, text, expected)),
    });
    Ok(ReadDofs { dofs: dofs.collect::<Result<_>>()?, base })
}

fn is_direction_column(name: &str) -> bool {
    name.starts_with("dof") || matches!(name, "direction" | "dir" | "component" | "comp")
}

/// A column of row numbers must count 0, 1, 2 … or 1, 2, 3 …: a map in another order would be misread.
fn check_row_number(path: &Path, row: &Row<'_>, column: usize, n_before: u64, first: &mut Option<u64>) -> Result<()> {
    let number: Option<u64> = row.text(column).parse().ok();
    let start = *first.get_or_insert(number.unwrap_or(0).min(1));
    let expected = start + n_before;
    if number == Some(expected) {
        return Ok(());
    }
    let found = excerpt(row.text(column).as_bytes());
    Err(Error::DofRowOrder { path: path.to_owned(), line: row.line, found, expected })
}

fn numbered(text: &str, base: DirectionBase) -> Option<Direction> {
    let number: usize = text.parse().ok()?;
    let index = if base == DirectionBase::Zero { number } else { number.checked_sub(1)? };
    Direction::ALL.get(index).copied()
}

fn named(text: &str) -> Option<Direction> {
    /// The names of finite element programs for the six directions.
    const NAMES: [[&str; 6]; 6] = [
        ["ux", "tx", "t1", "u1", "x", "dx"],
        ["uy", "ty", "t2", "u2", "y", "dy"],
        ["uz", "tz", "t3", "u3", "z", "dz"],
        ["rx", "rotx", "r1", "ur1", "drx", "thetax"],
        ["ry", "roty", "r2", "ur2", "dry", "thetay"],
        ["rz", "rotz", "r3", "ur3", "drz", "thetaz"],
    ];
    let index = NAMES.iter().position(|names| names.contains(&text))?;
    Direction::ALL.get(index).copied()
}

fn direction_error(path: &Path, line: u64, node: i64, found: &str, expected: &'static str) -> Error {
    Error::DofDirection { path: path.to_owned(), line, node, found: excerpt(found.as_bytes()), expected }
}

fn check_repeated(path: &Path, dofs: &[Dof]) -> Result<()> {
    let mut rows: HashMap<Dof, usize> = HashMap::with_capacity(dofs.len());
    for (row, &dof) in dofs.iter().enumerate() {
        if let Some(first) = rows.insert(dof, row) {
            let Dof { node, direction } = dof;
            let path = path.to_owned();
            return Err(Error::DofRepeated { path, row: row + 1, first_row: first + 1, node, direction });
        }
    }
    Ok(())
}
