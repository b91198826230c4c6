//! Matrices of linear user elements, which `*SUBSTRUCTURE MATRIX OUTPUT` and `*ELEMENT MATRIX OUTPUT` of Abaqus and CalculiX write.
//!
//! ```text
//! *USER ELEMENT, NODES=3, LINEAR
//! ** ELEMENT NODES
//! ** 101, 102, 103             in comments; a node may come once for each of its dofs
//! 1, 2                         dofs of the first node and of those that follow
//! 3, 6                         from the third node on: dof 6
//! *MATRIX, TYPE=STIFFNESS
//! k11,                         the upper triangle, column by column
//! k12, k22
//! ```
//! An unsymmetric matrix (UNSYMM in the first line) has all of its entries, column by column. Rows have names where nodes and dofs name each
//! of them once. Abaqus does not say in a document what it lists for amplitudes of modes: otherwise rows are in the order of the file.

use std::collections::HashSet;
use std::path::Path;

use super::MatrixRole;
use super::assembled::Collector;
use super::banner::excerpt;
use super::blocks::LastLine;
use super::file_start::FileStart;
use super::format::{Format, MatrixFormat, MatrixSource, OrderSource, ReadMatrix, Sureness};
use super::fortran::{real, whole};
use super::lines::Lines;
use super::named::chosen;
use super::row_label::RowLabel;
use crate::error::{Error, Result};
use crate::job::Layout;
use crate::sparse::{Given, MAX_ORDER};

const FORMAT: &str = "matrices of a user element";
/// More degrees of freedom than a node has.
const MAX_DOFS: usize = 64;

/// Matrices of a linear user element.
pub(super) struct UserElement;

impl Format for UserElement {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        let first = start.lines().find(|line| !line.starts_with(b"**")).unwrap_or_default();
        if keyword(first).0 == "*USERELEMENT" { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl MatrixFormat for UserElement {
    fn layout(&self) -> Layout {
        Layout::UserElement
    }

    fn has_members(&self) -> bool {
        true
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        let path = source.file.as_path();
        let element = Element::read(path)?;
        let names: Vec<&str> = element.matrices.iter().map(|(name, _)| name.as_str()).collect();
        if names.is_empty() {
            let expected = "matrices as *SUBSTRUCTURE MATRIX OUTPUT with OUTPUT FILE=USER DEFINED writes them";
            return Err(Error::MatrixNone { path: path.to_owned(), format: FORMAT, holds: Vec::new(), expected });
        }
        let (_, line) = element.matrices[chosen(path, &names, source.member.as_deref(), source.role)?];
        element.matrix(source, line)
    }
}

/// A keyword in capitals without blanks, and what follows it.
fn keyword(line: &[u8]) -> (String, String) {
    let text: String = line.iter().filter(|byte| !byte.is_ascii_whitespace()).map(|byte| char::from(*byte)).collect();
    let text = text.to_ascii_uppercase();
    match text.split_once(',') {
        Some((name, rest)) => (name.to_owned(), rest.to_owned()),
        None => (text, String::new()),
    }
}

fn wrong(path: &Path, line: u64, found: impl Into<String>, expected: &'static str) -> Error {
    let (path, place) = (path.to_owned(), format!("line {line}"));
    Error::MatrixFormat { path, format: FORMAT, place, found: found.into(), expected: expected.into() }
}

/// The fields of a line, those of comments without their asterisks.
fn fields(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let is_separator = |byte: &u8| matches!(byte, b',' | b' ' | b'\t' | b'*');
    line.split(is_separator).filter(|field| !field.is_empty())
}

/// What a file says of an element, and where its matrices begin.
#[derive(Default)]
struct Element {
    is_unsymmetric: bool,
    nodes: Vec<i64>,
    /// How many there are by the keyword, which comments need not list.
    n_nodes: usize,
    /// Degrees of freedom of each node from a position on, from zero.
    dofs: Vec<(usize, Vec<u8>)>,
    /// What each matrix is called, and its line.
    matrices: Vec<(String, u64)>,
}

/// What the lines to come are.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    /// Nothing that is known.
    Other,
    /// Comments that list nodes.
    Nodes,
    /// Degrees of freedom.
    Dofs,
}

impl Element {
    fn read(path: &Path) -> Result<Self> {
        let mut lines = Lines::open(path)?;
        let (mut element, mut n_elements, mut part) = (Self::default(), 0, Part::Other);
        while lines.advance()? {
            let (line, number) = (lines.line().trim_ascii(), lines.number());
            if let Some(comment) = line.strip_prefix(b"**") {
                part = element.comment(comment, part);
            } else if line.starts_with(b"*") {
                let (name, rest) = keyword(line);
                n_elements += u32::from(name == "*USERELEMENT");
                if n_elements > 1 {
                    return Err(wrong(path, number, "a second element", "the matrices of one element or substructure"));
                }
                part = element.keyword((&name, &rest), number);
            } else if part != Part::Other && !line.is_empty() {
                element.take_dofs(line).ok_or_else(|| {
                    wrong(path, number, format!("`{}`", excerpt(line)), "numbers of degrees of freedom of a node")
                })?;
                part = Part::Dofs;
            }
        }
        Ok(element)
    }

    fn comment(&mut self, comment: &[u8], part: Part) -> Part {
        let words = comment.trim_ascii().to_ascii_uppercase();
        if words.starts_with(b"ELEMENT NODES") {
            return Part::Nodes;
        }
        let listed: Option<Vec<i64>> = fields(comment).map(whole).collect();
        match listed {
            Some(listed) if part == Part::Nodes => self.nodes.extend(listed),
            _ => {}
        }
        part
    }

    fn keyword(&mut self, (name, rest): (&str, &str), line: u64) -> Part {
        let mut parameters = rest.split(',');
        match name {
            "*USERELEMENT" => {
                let n_nodes = parameters.clone().find_map(|parameter| parameter.strip_prefix("NODES="));
                self.n_nodes = n_nodes.and_then(|n| n.parse().ok()).unwrap_or(0);
                self.is_unsymmetric = parameters.any(|parameter| parameter == "UNSYMM");
                return Part::Dofs;
            }
            "*MATRIX" => {
                let kind = parameters.find_map(|parameter| parameter.strip_prefix("TYPE="));
                self.matrices.push((kind.unwrap_or("matrix").to_owned(), line));
            }
            _ => {}
        }
        Part::Other
    }

    /// Takes a line of degrees of freedom; none where it is no such line.
    fn take_dofs(&mut self, line: &[u8]) -> Option<()> {
        let mut numbers = fields(line);
        let from = match self.dofs.is_empty() {
            true => 0,
            false => usize::try_from(whole(numbers.next()?)?.checked_sub(1)?).ok()?,
        };
        let dofs: Vec<u8> =
            numbers.map(|field| whole(field).and_then(|dof| u8::try_from(dof).ok())).collect::<Option<_>>()?;
        let is_behind = self.dofs.last().is_none_or(|(before, _)| *before < from);
        (!dofs.is_empty() && dofs.len() <= MAX_DOFS && is_behind).then(|| self.dofs.push((from, dofs)))
    }

    /// Rows that nodes and degrees of freedom make.
    fn n_rows(&self) -> usize {
        let n_listed = if self.nodes.is_empty() { self.n_nodes } else { self.nodes.len() };
        let ends = self.dofs.iter().skip(1).map(|(from, _)| *from).chain([n_listed]);
        let n_nodes = self.dofs.iter().zip(ends).map(|((from, dofs), end)| dofs.len() * end.saturating_sub(*from));
        n_nodes.fold(0, usize::saturating_add)
    }

    /// The name of each row, where there are n and each names one.
    fn labels(&self, n: usize) -> Option<Vec<RowLabel>> {
        if self.n_rows() != n {
            return None;
        }
        let mut lists = self.dofs.iter().peekable();
        let (mut labels, mut dofs): (Vec<RowLabel>, &[u8]) = (Vec::with_capacity(n), &[]);
        for (at, node) in self.nodes.iter().enumerate() {
            if let Some((_, list)) = lists.next_if(|(from, _)| *from <= at) {
                dofs = list;
            }
            labels.extend(dofs.iter().map(|dof| RowLabel { node: *node, component: *dof }));
        }
        let mut seen = HashSet::with_capacity(n);
        (labels.len() == n && labels.iter().all(|label| seen.insert(*label))).then_some(labels)
    }

    /// The matrix whose keyword is in a line.
    fn matrix(&self, source: &MatrixSource<'_>, keyword: u64) -> Result<ReadMatrix> {
        let path = source.file.as_path();
        let mut lines = Lines::open(path)?;
        let mut entries = Entries::new(self, source);
        while lines.advance()? {
            let (line, number) = (lines.line().trim_ascii(), lines.number());
            match () {
                () if number <= keyword || line.starts_with(b"**") => {}
                () if line.starts_with(b"*") => break,
                () => {
                    for field in
                        line.split(|byte| matches!(byte, b',' | b' ' | b'\t')).filter(|field| !field.is_empty())
                    {
                        let value = real(field).filter(|value| value.is_finite());
                        let found = || wrong(path, number, format!("`{}`", excerpt(field)), "finite numbers");
                        entries.push(value.ok_or_else(found)?, number)?;
                    }
                }
            }
        }
        let (entries, n) = entries.ended(lines.number())?;
        let declared = source.role.undeclared();
        let Some(labels) = self.labels(n as usize) else {
            let mut input = entries.into_matrix(source, (n, declared), lines.digest()?)?;
            input.notes.given = Given::Whole;
            return Ok(ReadMatrix {
                input,
                order: OrderSource::SizeLine,
                last_line: LastLine::Terminated,
                labels: None,
                frames: Ok(None),
            });
        };
        let mut order: Vec<u32> = (0..n).collect();
        match source.role {
            MatrixRole::Reduced => order.sort_by_key(|row| labels[*row as usize].place_in_superelement(*row as usize)),
            _ => order.sort_unstable_by_key(|row| labels[*row as usize]),
        }
        let mut rank = vec![0; labels.len()];
        order.iter().zip(0..).for_each(|(row, place)| rank[*row as usize] = place);
        let mut input = entries.renumbered(&rank).into_matrix(source, (n, declared), lines.digest()?)?;
        input.notes.given = Given::Whole;
        let labels = Some(order.iter().map(|row| labels[*row as usize]).collect());
        Ok(ReadMatrix { input, order: OrderSource::Labels, last_line: LastLine::Terminated, labels, frames: Ok(None) })
    }
}

/// The entries of a matrix as they come.
struct Entries<'a> {
    path: &'a Path,
    collector: Collector<'a>,
    /// Rows of an unsymmetric matrix.
    n_rows: Option<usize>,
    /// Row and column of the next entry.
    next: [u32; 2],
}

impl<'a> Entries<'a> {
    fn new(element: &Element, source: &'a MatrixSource<'a>) -> Self {
        let collector = Collector::new(source, source.role.undeclared());
        let n_rows = element.is_unsymmetric.then(|| element.n_rows());
        Self { path: &source.file, collector, n_rows, next: [0, 0] }
    }

    fn push(&mut self, value: f64, line: u64) -> Result<()> {
        let [row, col] = self.next;
        let last_row = self.n_rows.map_or(col as usize, |n| n.saturating_sub(1));
        if col as usize >= self.n_rows.unwrap_or(MAX_ORDER) {
            let expected = "as many numbers as the nodes and degrees of freedom of the element make";
            return Err(wrong(self.path, line, "more numbers", expected));
        }
        if value != 0.0 || row == col {
            self.collector.push(row, col, value)?;
        }
        if self.n_rows.is_none() && value != 0.0 && row != col {
            self.collector.push(col, row, value)?;
        }
        self.next = if row as usize == last_row { [0, col + 1] } else { [row + 1, col] };
        Ok(())
    }

    /// The entries and the order of the matrix, at the end of its numbers.
    fn ended(self, line: u64) -> Result<(Collector<'a>, u32)> {
        let [row, n] = self.next;
        if row != 0 || n == 0 || self.n_rows.is_some_and(|n_rows| n_rows != n as usize) {
            let found = format!("the end of the matrix in row {} of column {}", row + 1, n + 1);
            return Err(wrong(self.path, line, found, "numbers up to the last row of a column"));
        }
        Ok((self.collector, n))
    }
}
