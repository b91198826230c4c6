//! What each row of the matrices stands for: `node.direction` line by line as CalculiX writes it, a table with a node
//! and a direction column, or the usual order where counts leave no doubt. A table may have scalar dofs, which no node has.

use std::collections::HashMap;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use super::allowance::Allowance;
use super::banner::excerpt;
use super::file_start::FileStart;
use super::format::{DirectionBase, DofMapFormat, Format, ReadDofs, Sureness};
use super::row_label::{RowLabel, scalar_component};
use super::source::{Source, read_error};
use super::table::{FirstLine, Row, Table, is_node_column, open_first_line};
use crate::dofs::{Direction, Dof, DofMap, Nodes};
use crate::error::{Error, Result};

const EXPECTED: &str = "lines `node.direction`, or a header with the columns node and dof";
const DIRECTIONS: &str = "1 to 6 for ux, uy, uz, rx, ry, rz";
const DIRECTIONS_FROM_ZERO: &str = "0 to 5 for ux, uy, uz, rx, ry, rz, as the column counts from zero";
const DIRECTIONS_OR_NAMES: &str = "1 to 6 or ux, uy, uz, rx, ry, rz";

/// Lines `node.direction` and tables, plain or gzipped.
pub(super) struct DofText;

impl Format for DofText {
    fn sureness(&self, _: &FileStart<'_>) -> Sureness {
        Sureness::Possible
    }
}

impl DofMapFormat for DofText {
    fn read(&self, path: &Path, n: usize, _: &Allowance) -> Result<ReadDofs> {
        read(path, n)
    }
}

fn read(path: &Path, n: usize) -> Result<ReadDofs> {
    let first = open_first_line(path, EXPECTED)?;
    let is_table = first.text.contains(|c: char| c.is_alphabetic() || matches!(c, ',' | ';' | '\t'));
    if is_table { read_table(path, first, n) } else { read_lines(path, first, n) }
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
    let at_node = |&node: &i64| directions.iter().map(move |&direction| Some(Dof { node, direction }));
    Ok(nodes.labels.iter().flat_map(at_node).collect())
}

/// Checks that every node of a dof map has a position; returns how many nodes no row uses.
pub(super) fn check_nodes(dofs: &[Option<Dof>], path: &Path, nodes: &Nodes, nodes_path: &Path) -> Result<usize> {
    // A mesh may have any number of nodes, the map has no more than the matrices have rows.
    let at_nodes = || dofs.iter().enumerate().filter_map(|(row, dof)| Some((row, (*dof)?.node)));
    let mut is_there: HashMap<i64, bool> = at_nodes().map(|(_, node)| (node, false)).collect();
    let mut n_unused = 0;
    for label in &nodes.labels {
        match is_there.get_mut(label) {
            Some(is_there) => *is_there = true,
            None => n_unused += 1,
        }
    }
    let missing = || at_nodes().filter(|(_, node)| !is_there[node]);
    match missing().next() {
        Some((row, node)) => {
            let missing = ListedRows::of(missing().map(|(row, _)| row)).to_string();
            let (path, nodes) = (path.to_owned(), nodes_path.to_owned());
            Err(Error::DofNodeMissing { path, row: row + 1, node, nodes, missing })
        }
        None => Ok(n_unused),
    }
}

fn read_lines(path: &Path, mut first: FirstLine, n: usize) -> Result<ReadDofs> {
    let mut read = ReadDofs::new(Vec::new(), 0);
    read.take(parse_line(path, first.line, &first.text)?, n);
    let mut line = first.line;
    let mut bytes = Vec::new();
    while next_line(path, &mut first.rest, line + 1, &mut bytes)? {
        line += 1;
        let text = bytes.trim_ascii();
        if !text.is_empty() {
            read.take(parse_line(path, line, &String::from_utf8_lossy(text))?, n);
        }
    }
    Ok(read)
}

/// The next line into `bytes`; false at the end.
fn next_line(path: &Path, rest: &mut BufReader<Source>, line: u64, bytes: &mut Vec<u8>) -> Result<bool> {
    /// The longest line; a label and a direction take twenty-two characters.
    const MAX_LINE_BYTES: usize = 256;
    bytes.clear();
    let n_read = rest.by_ref().take(MAX_LINE_BYTES as u64 + 1).read_until(b'\n', bytes);
    if n_read.map_err(|error| read_error(path, error))? > MAX_LINE_BYTES {
        return Err(Error::LineTooLong { path: path.to_owned(), line, limit: MAX_LINE_BYTES });
    }
    Ok(!bytes.is_empty())
}

impl ReadDofs {
    fn take(&mut self, dof: Dof, n: usize) {
        self.n_rows += 1;
        if self.dofs.len() < n {
            self.dofs.push(Some(dof));
        }
    }
}

fn parse_line(path: &Path, line: u64, text: &str) -> Result<Dof> {
    let parts = text.split_once('.').and_then(|(node, direction)| Some((node.parse::<i64>().ok()?, direction)));
    let Some((node, direction)) = parts.filter(|(_, direction)| direction.bytes().all(|byte| byte.is_ascii_digit()))
    else {
        return Err(Error::DofText { path: path.to_owned(), line, found: excerpt(text.as_bytes()) });
    };
    match direction.parse().ok().and_then(|number| numbered(number, DirectionBase::One)) {
        Some(direction) => Ok(Dof { node, direction }),
        None => Err(direction_error(path, line, node, direction, DIRECTIONS)),
    }
}

fn read_table(path: &Path, first: FirstLine, n: usize) -> Result<ReadDofs> {
    let mut table = Table::new(path, first);
    let node_column = table.require("node", EXPECTED, is_node_column)?;
    let direction_column = table.require("dof", EXPECTED, is_direction_column)?;
    let row_column = table.find(|name| matches!(name, "row" | "index" | "equation"));
    let header = table.name(direction_column);
    let mut rows: Vec<(Option<i64>, Typed)> = Vec::new();
    let (mut n_rows, mut first_number, mut has_zero) = (0, None, false);
    // The first direction that there is not, counted from zero and from one; which count it is, is known after all rows.
    let mut unknown: [Option<(u64, i64, String)>; 2] = [None, None];
    while let Some(row) = table.next_row()? {
        if let Some(column) = row_column {
            check_row_number(path, &row, column, n_rows as u64, &mut first_number)?;
        }
        n_rows += 1;
        let text = row.text(direction_column).to_lowercase();
        let typed = Typed::of(&text);
        let node = node_of(&row, node_column, typed)?;
        has_zero |= typed == Typed::Number(0);
        for (unknown, base) in unknown.iter_mut().zip([DirectionBase::Zero, DirectionBase::One]) {
            let is_scalar = matches!(typed, Typed::Scalar(_));
            if let (None, false, Some(node), None) = (&unknown, is_scalar, node, typed.direction(base)) {
                *unknown = Some((row.line, node, text.clone()));
            }
        }
        if rows.len() < n {
            rows.push((node, typed));
        }
    }
    if n_rows == 0 {
        return Err(Error::NoData { path: path.to_owned(), expected: "rows of node and direction below the header" });
    }
    let says_zero = ["0=", "0 =", "0-based", "zero"].iter().any(|mark| header.contains(mark));
    let [unknown_from_zero, unknown_from_one] = unknown;
    let (base, unknown, expected) = if says_zero || has_zero {
        (DirectionBase::Zero, unknown_from_zero, DIRECTIONS_FROM_ZERO)
    } else {
        (DirectionBase::One, unknown_from_one, DIRECTIONS_OR_NAMES)
    };
    if let Some((line, node, text)) = unknown {
        return Err(direction_error(path, line, node, &text, expected));
    }
    let dofs = rows.iter().map(|(node, typed)| Some(Dof { node: (*node)?, direction: typed.direction(base)? }));
    let scalars = rows.iter().enumerate().filter_map(|(row, (node, typed))| match typed {
        Typed::Scalar(component) => Some((row, RowLabel { node: (*node)?, component: *component })),
        Typed::Number(_) | Typed::Name(_) | Typed::Other => None,
    });
    Ok(ReadDofs { base, scalars: scalars.collect(), ..ReadDofs::new(dofs.collect(), n_rows) })
}

/// The label of a row, which that of a scalar dof may lack.
fn node_of(row: &Row<'_>, column: usize, typed: Typed) -> Result<Option<i64>> {
    match typed {
        Typed::Scalar(_) if row.text(column).is_empty() => Ok(None),
        _ => row.integer(column).map(Some),
    }
}

/// A direction as it is typed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Typed {
    Number(u8),
    Name(Direction),
    /// No direction of a node, with the number that the program gives it.
    Scalar(u8),
    /// Neither a small number nor a name.
    Other,
}

impl Typed {
    fn of(text: &str) -> Self {
        match (text.parse(), scalar_component(text)) {
            (Ok(number), _) => Self::Number(number),
            (Err(_), Some(component)) => Self::Scalar(component),
            (Err(_), None) => named(text).map_or(Self::Other, Self::Name),
        }
    }

    fn direction(self, base: DirectionBase) -> Option<Direction> {
        match self {
            Self::Number(number) => numbered(number, base),
            Self::Name(direction) => Some(direction),
            Self::Scalar(_) | Self::Other => None,
        }
    }
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

fn numbered(number: u8, base: DirectionBase) -> Option<Direction> {
    let index = if base == DirectionBase::Zero { number } else { number.checked_sub(1)? };
    Direction::ALL.get(usize::from(index)).copied()
}

pub(super) fn named(text: &str) -> Option<Direction> {
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

/// Checks that no two rows are one degree of freedom.
pub(super) fn check_repeated(path: &Path, dofs: &[Option<Dof>]) -> Result<()> {
    let mut first_rows: HashMap<Dof, usize> = HashMap::with_capacity(dofs.len());
    let repeating =
        |(row, dof): (usize, &Option<Dof>)| (*first_rows.entry((*dof)?).or_insert(row) != row).then_some(row);
    let repeated = ListedRows::of(dofs.iter().enumerate().filter_map(repeating));
    let Some((row, dof)) = repeated.first().and_then(|row| Some((row, dofs[row]?))) else { return Ok(()) };
    let Dof { node, direction } = dof;
    let (path, first_row, repeated) = (path.to_owned(), first_rows[&dof] + 1, repeated.to_string());
    Err(Error::DofRepeated { path, row: row + 1, first_row, node, direction, repeated })
}

/// The first of some rows, and how many there are.
struct ListedRows {
    first: Vec<usize>,
    count: usize,
}

impl ListedRows {
    const SHOWN: usize = 4;

    /// Rows from zero, in ascending order.
    fn of(rows: impl Iterator<Item = usize>) -> Self {
        let (mut first, mut count) = (Vec::new(), 0);
        for row in rows {
            if count < Self::SHOWN {
                first.push(row);
            }
            count += 1;
        }
        Self { first, count }
    }

    fn first(&self) -> Option<usize> {
        self.first.first().copied()
    }
}

impl std::fmt::Display for ListedRows {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let rows: Vec<String> = self.first.iter().map(|row| (row + 1).to_string()).collect();
        let more = if self.count > self.first.len() { ", …" } else { "" };
        let noun = if self.count == 1 { "row" } else { "rows" };
        write!(f, "{} {noun} ({}{more})", self.count, rows.join(", "))
    }
}
