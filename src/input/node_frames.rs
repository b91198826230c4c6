//! Nodes whose displacements are along axes of their own: a table, or what decks say.
//!
//! ```text
//! node,x1,x2,x3,y1,y2,y3    x along one direction, y along what another leaves across it; directions have any length
//! ```

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::allowance::Allowance;
use super::decimal::Decimal;
use super::in_line::Off;
use super::table::{Row, Table, is_node_column, open_first_line};
use crate::dofs::{Axes, AxisDigits, DofMap, RoundedAxes};
use crate::error::{Error, Result};
use crate::sparse::Turning;

const EXPECTED: &str = "a header with the columns node, x1, x2, x3, y1, y2, y3";
const NAMES: [&str; 9] = ["x1", "x2", "x3", "y1", "y2", "y3", "z1", "z2", "z3"];
/// Bytes of a node and its axes.
const NODE: u64 = 128;
/// Rows after which their memory is claimed.
const ROWS_PER_CLAIM: usize = 1 << 8;
/// How far a third axis may be from the one that the others make: what axes of four digits leave.
const THIRD: f64 = 1e-3;
/// How far a length may be from one for a direction to be that of an axis with all its digits.
const WHOLE: f64 = 1e-14;

/// The axes of nodes, and where they are from.
#[derive(Clone, Debug)]
pub(super) struct NodeFrames {
    /// Axes of each node that has its own.
    pub(super) axes: BTreeMap<i64, Axes>,
    /// Nodes that are stated to be along the axes of the model; a table states none.
    pub(super) along_model: BTreeSet<i64>,
    /// Those that look rounded, and to how many decimals.
    pub(super) rounded: BTreeMap<i64, AxisDigits>,
    /// File and line of the first.
    pub(super) place: (PathBuf, u64),
}

impl NodeFrames {
    /// The rows that they turn, and at how many nodes.
    ///
    /// # Errors
    /// [`Error::FrameRows`] where a node lacks rows of one of its directions.
    pub(super) fn turning(&self, dofs: &DofMap) -> Result<(Turning, usize)> {
        let mut of_node: BTreeMap<i64, [Option<u32>; 6]> = BTreeMap::new();
        for (dof, row) in dofs.iter().zip(0u32..) {
            if let Some(dof) = dof.filter(|dof| self.axes.contains_key(&dof.node)) {
                of_node.entry(dof.node).or_default()[dof.direction as usize] = Some(row);
            }
        }
        let mut blocks = Vec::new();
        for (node, rows) in &of_node {
            for part in [[rows[0], rows[1], rows[2]], [rows[3], rows[4], rows[5]]] {
                match part {
                    [None, None, None] => {}
                    [Some(x), Some(y), Some(z)] => blocks.push(([x, y, z], self.axes[node])),
                    _ => return Err(self.lacking(*node, rows)),
                }
            }
        }
        Ok((Turning::new(dofs.len(), blocks), of_node.len()))
    }

    /// The axes that look rounded; none where there are none.
    pub(super) fn rounded(&self) -> Option<RoundedAxes> {
        (!self.rounded.is_empty()).then(|| RoundedAxes { path: self.place.0.clone(), of_node: self.rounded.clone() })
    }

    fn lacking(&self, node: i64, rows: &[Option<u32>; 6]) -> Error {
        let there = crate::dofs::Direction::ALL.iter().zip(rows).filter(|(_, row)| row.is_some());
        let there: Vec<String> = there.map(|(direction, _)| direction.to_string()).collect();
        Error::FrameRows { path: self.place.0.clone(), node, found: there.join(", ") }
    }
}

/// Reads the table of a job.
///
/// # Errors
/// A file that cannot be read or is no such table; [`Error::FrameAxes`]; [`Error::NodeRepeated`]; [`Error::MemoryRead`].
pub(super) fn node_frames(path: &Path, allowance: &Allowance) -> Result<NodeFrames> {
    let claim = allowance.claim(path);
    let mut table = Table::new(path, open_first_line(path, EXPECTED)?);
    let label_column = table.require("node", EXPECTED, is_node_column)?;
    let mut columns = [0; 6];
    for (column, name) in columns.iter_mut().zip(NAMES) {
        *column = table.require(name, EXPECTED, |known| known == name)?;
    }
    let third: Option<Vec<usize>> = NAMES[6..].iter().map(|name| table.find(|known| known == *name)).collect();
    let mut frames = NodeFrames {
        axes: BTreeMap::new(),
        along_model: BTreeSet::new(),
        rounded: BTreeMap::new(),
        place: (path.to_owned(), 1),
    };
    let mut digits = TableDigits::default();
    let mut lines: BTreeMap<i64, u64> = BTreeMap::new();
    while let Some(row) = table.next_row()? {
        let (node, line) = (row.integer(label_column)?, row.line);
        if let Some(first_line) = lines.insert(node, line) {
            return Err(Error::NodeRepeated { path: path.to_owned(), line, node, first_line });
        }
        if lines.len() % ROWS_PER_CLAIM == 1 {
            claim.add(NODE * ROWS_PER_CLAIM as u64)?;
        }
        let [x, y] = [vector(&row, &columns[..3])?, vector(&row, &columns[3..])?];
        let wrong =
            |found: String| Error::FrameAxes { path: path.to_owned(), line, found: format!("node {node} has {found}") };
        let axes = Off::of_text([x, y].as_flattened())
            .spanned(x, y)
            .ok_or_else(|| wrong(format!("x along {x:?} and y along {y:?}, which span no plane")))?;
        if let Some(third) = &third {
            let z = vector(&row, third)?;
            let off = crate::dofs::unit(z).iter().zip(axes[2]).fold(0.0, |off: f64, (a, b)| off.max((a - b).abs()));
            if off.is_nan() || off > THIRD {
                return Err(wrong(format!("z along {z:?}, where x and y make it {:?}", axes[2])));
            }
        }
        digits.take(node, line, [x, y]);
        frames.axes.insert(node, axes);
    }
    frames.rounded = digits.rounded();
    if frames.axes.is_empty() {
        return Err(Error::NoData { path: path.to_owned(), expected: "rows of node and axes below the header" });
    }
    Ok(frames)
}

fn vector(row: &Row<'_>, columns: &[usize]) -> Result<[f64; 3]> {
    Ok([row.number(columns[0])?, row.number(columns[1])?, row.number(columns[2])?])
}

/// The decimals of a table of axes.
#[derive(Default)]
struct TableDigits {
    /// Line of each node, and its directions.
    of_node: BTreeMap<i64, (u64, [[f64; 3]; 2])>,
}

impl TableDigits {
    fn take(&mut self, node: i64, line: u64, directions: [[f64; 3]; 2]) {
        self.of_node.insert(node, (line, directions));
    }

    /// To how many decimals its large components are known: those that it has, and where small ones have more, as a format of significant digits
    /// writes them, as many as such digits.
    fn decimals(&self) -> i32 {
        let (mut most, mut digits, mut most_of_large) = (0, 0, 0);
        for value in
            self.of_node.values().flat_map(|(_, directions)| directions.as_flattened()).filter(|value| **value != 0.0)
        {
            let decimal = Decimal::of(*value);
            most = decimal.n_decimals().max(most);
            digits = (decimal.n_digits as i32).max(digits);
            // From a tenth to one.
            if decimal.exponent == -1 {
                most_of_large = decimal.n_decimals().max(most_of_large);
            }
        }
        let is_of_digits = most > digits && most_of_large == digits;
        if is_of_digits { digits } else { most }
    }

    /// The nodes whose axes look rounded. A table of few decimals has them for all of its numbers: zeros and ones were rounded too.
    fn rounded(&self) -> BTreeMap<i64, AxisDigits> {
        let most = self.decimals();
        let fewest = |directions: &[[f64; 3]; 2]| directions.iter().filter_map(|of| rounded_to(*of, most)).min();
        let is_coarse =
            (1..AxisDigits::ENOUGH).contains(&most) && self.of_node.values().any(|(_, of)| fewest(of).is_some());
        let of_table = is_coarse.then_some(most);
        let of = |(node, (line, own)): (&i64, &(u64, [[f64; 3]; 2]))| {
            Some((*node, AxisDigits { line: *line, decimals: of_table.or_else(|| fewest(own))? }))
        };
        self.of_node.iter().filter_map(of).collect()
    }
}

/// The most decimals that a component of a direction has.
fn decimals(direction: [f64; 3]) -> i32 {
    let of = direction.iter().filter(|value| **value != 0.0).map(|value| Decimal::of(*value).n_decimals());
    of.max().unwrap_or(0)
}

/// The decimals, `most` at most, that a direction of about unit length looks rounded to, none for other directions, which are as they are
/// meant. Of a length that is one to its last bit it is told from few decimals alone.
fn rounded_to(direction: [f64; 3], most: i32) -> Option<i32> {
    let off = (direction.iter().map(|value| value * value).sum::<f64>().sqrt() - 1.0).abs();
    let decimals = decimals(direction).min(most);
    let is_near = off <= 2.0 * 10f64.powi(-decimals) && (off > WHOLE || decimals < AxisDigits::ENOUGH);
    (decimals > 0 && is_near).then_some(decimals)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_of_few_digits_look_rounded() {
        for (direction, expected) in [
            ([0.66667, 0.66667, -0.33333], Some(5)),
            ([0.71, 0.71, 0.0], Some(2)),
            ([0.9, 0.5, 0.0], Some(1)),
            ([0.6, 0.8, 0.0], Some(1)),
            ([0.6, 0.799999, 0.000123], Some(6)),
            ([1.0, 1.0, 0.0], None),
            ([0.0, 0.0, 2.5], None),
            ([0.5f64.sqrt(), -(0.5f64.sqrt()), 0.0], None),
        ] {
            assert_eq!(rounded_to(direction, 17), expected, "{direction:?}");
        }
    }

    #[test]
    fn zeros_and_ones_of_a_table_of_few_decimals_were_rounded_too() {
        let mut digits = TableDigits::default();
        digits.take(4, 2, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        assert!(digits.rounded().is_empty());
        digits.take(7, 3, [[0.71, 0.71, 0.0], [-0.71, 0.71, 0.0]]);
        let two = |line| AxisDigits { line, decimals: 2 };
        assert_eq!(digits.rounded(), BTreeMap::from([(4, two(2)), (7, two(3))]));
        digits.take(9, 4, [[0.66667, 0.66667, -0.33333], [-0.66667, 0.33333, 0.66667]]);
        assert_eq!(digits.rounded(), BTreeMap::from([(7, two(3)), (9, AxisDigits { line: 4, decimals: 5 })]));
    }
}
