//! Result files of CalculiX (`.frd`), in text and binary: nodes and elements. They have no groups. Their modes are read by
//! [`crate::input::frd_modes`].
//!
//! Numbers stand in columns of fixed width, so that neighbours may touch.

use std::path::Path;

use super::cell_mesh::CellMesh;
use super::labels::{LABEL, Labels};
use super::stream::{Form, Stream};
use crate::error::{Error, Result};
use crate::input::Allowance;
use crate::input::allowance::Claim;
use crate::input::banner::excerpt;
use crate::input::cell_kind::{Kind, kind};
use crate::input::faces::Shape;
use crate::input::file_start::FileStart;
use crate::input::format::Sureness;
use crate::input::fortran;

/// Bytes that a node takes.
const NODE: u64 = 32 + LABEL;
/// Bytes that an element takes at most.
const ELEMENT: u64 = 160;
/// Items after which their memory is claimed.
const ITEMS_PER_CLAIM: u64 = 1 << 10;

const OF_NODES: &str = "a node: number and three coordinates";
const OF_ELEMENTS: &str = "an element: number, type and nodes";

/// Whether a file is a result file.
pub(super) fn sureness(start: &FileStart<'_>) -> Sureness {
    if start.head.starts_with(b"    1C") { Sureness::Certain } else { Sureness::Unlikely }
}

/// How a block is written: the last number of its head.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::input) enum Block {
    /// Text with numbers of nodes in so many columns.
    Text(usize),
    /// Numbers of 32 or 64 bits.
    Single,
    Double,
}

/// Reads nodes and elements of a result file; of results nothing.
pub(super) fn read(path: &Path, allowance: &Allowance) -> Result<CellMesh> {
    let claim = allowance.claim(path);
    let mut stream = Stream::open(path)?;
    let mut mesh = CellMesh::default();
    while let Some(line) = stream.rest_of_line()? {
        match line.get(..2) {
            Some(b"2C") => nodes(&mut stream, &line, &mut mesh, &claim)?,
            Some(b"3C") => {
                elements(&mut stream, &line, &mut mesh, &claim)?;
                break;
            }
            // What comes behind nodes and elements are results.
            Some(b"1P") => break,
            _ => {}
        }
    }
    if mesh.nodes.labels.is_empty() {
        return Err(Error::NoData {
            path: path.to_owned(),
            expected: "nodes in a block 2C (CalculiX: *NODE FILE in a step)",
        });
    }
    Ok(mesh)
}

/// Number of items and form of a block, from its first line.
fn head(stream: &Stream, line: &[u8], double: Block) -> Result<(u64, Block)> {
    let text = String::from_utf8_lossy(line);
    let numbers: Vec<u64> = text.split_ascii_whitespace().skip(1).filter_map(|word| word.parse().ok()).collect();
    match numbers.last().and_then(|form| Block::of_form(*form, double)) {
        Some(block) => Ok((numbers[0], block)),
        None => Err(stream.error(format!("`{}`", excerpt(line)), "the number of items and a form from 0 to 3")),
    }
}

impl Block {
    /// The block of a form; `double` is what the last form stands for.
    pub(in crate::input) fn of_form(form: u64, double: Self) -> Option<Self> {
        match form {
            0 => Some(Self::Text(5)),
            1 => Some(Self::Text(10)),
            2 => Some(Self::Single),
            3 => Some(double),
            _ => None,
        }
    }
}

/// Reads a block of nodes, of which the first line was read.
pub(in crate::input) fn nodes(stream: &mut Stream, line: &[u8], mesh: &mut CellMesh, claim: &Claim<'_>) -> Result<()> {
    let (n, block) = head(stream, line, Block::Double)?;
    let mut at = 0;
    loop {
        if at % ITEMS_PER_CLAIM == 0 {
            claim.add(NODE * ITEMS_PER_CLAIM)?;
        }
        let (label, point) = match block {
            Block::Text(width) => {
                let line = raw_line(stream, OF_NODES)?;
                if line.starts_with(b" -3") {
                    break;
                }
                node_of_line(stream, &line, width)?
            }
            _ if at == n => break,
            _ => binary_node(stream, block)?,
        };
        mesh.nodes.labels.push(label);
        mesh.nodes.coordinates.push(point);
        at += 1;
    }
    stream.form = Form::Text;
    check_count(stream, (at, n), "nodes")
}

/// Makes sure that a block has as many items as its head says. Some programs write none there.
pub(in crate::input) fn check_count(stream: &Stream, (found, stated): (u64, u64), items: &str) -> Result<()> {
    if found == stated || stated == 0 {
        return Ok(());
    }
    Err(stream.error(format!("{found} {items}"), format!("{stated}, as the head of the block says")))
}

fn node_of_line(stream: &Stream, line: &[u8], width: usize) -> Result<(i64, [f64; 3])> {
    /// Columns of a coordinate.
    const COORDINATE: usize = 12;
    let wrong = || stream.error(format!("`{}`", excerpt(line)), OF_NODES);
    let field = |from: usize, width: usize| line.get(from..line.len().min(from + width)).map(<[u8]>::trim_ascii);
    let label = field(3, width).and_then(whole).filter(|_| line.starts_with(b" -1")).ok_or_else(wrong)?;
    let mut point = [0.0; 3];
    for (axis, coordinate) in point.iter_mut().enumerate() {
        let field = field(3 + width + axis * COORDINATE, COORDINATE).unwrap_or_default();
        *coordinate = fortran::real(field).filter(|value| value.is_finite()).ok_or_else(wrong)?;
    }
    let rest = line.get(3 + width + 3 * COORDINATE..).unwrap_or_default();
    if rest.trim_ascii().is_empty() { Ok((label, point)) } else { Err(wrong()) }
}

fn binary_node(stream: &mut Stream, block: Block) -> Result<(i64, [f64; 3])> {
    stream.form = Form::LittleEndian;
    let label = stream.int(OF_NODES)?;
    let mut point = [0.0; 3];
    for coordinate in &mut point {
        *coordinate = match block {
            Block::Single => f32::from_le_bytes(stream.bytes(OF_NODES)?).into(),
            _ => stream.any_real(OF_NODES)?,
        };
    }
    if point.iter().any(|coordinate| !coordinate.is_finite()) {
        return Err(stream.error(format!("node {label} at {point:?}"), "finite coordinates"));
    }
    Ok((label, point))
}

/// Reads a block of elements, of which the first line was read.
pub(in crate::input) fn elements(
    stream: &mut Stream,
    line: &[u8],
    mesh: &mut CellMesh,
    claim: &Claim<'_>,
) -> Result<()> {
    let labels = Labels::new(&mesh.nodes.labels).map_err(|[first, _]| {
        stream.error(format!("node {} twice", mesh.nodes.labels[first]), "one node of a number")
    })?;
    let (n, block) = head(stream, line, Block::Single)?;
    let mut at = 0;
    loop {
        if at % ITEMS_PER_CLAIM == 0 {
            claim.add(ELEMENT * ITEMS_PER_CLAIM)?;
        }
        let (number, nodes) = match block {
            Block::Text(width) => {
                let line = raw_line(stream, OF_ELEMENTS)?;
                if line.starts_with(b" -3") {
                    break;
                }
                let (number, n_nodes) = element_head(stream, &line, width)?;
                (number, element_nodes(stream, n_nodes, width)?)
            }
            _ if at == n => break,
            _ => binary_element(stream)?,
        };
        add(stream, (number, &nodes), &labels, mesh)?;
        at += 1;
    }
    stream.form = Form::Text;
    check_count(stream, (at, n), "elements")
}

/// Type of an element and number of its nodes.
fn element_head(stream: &Stream, line: &[u8], width: usize) -> Result<(i64, usize)> {
    let number = line.get(3 + width..line.len().min(8 + width)).map(<[u8]>::trim_ascii).and_then(whole);
    let number = number.filter(|_| line.starts_with(b" -1"));
    let known = number.and_then(|number| Some((number, n_nodes(number)?)));
    known.ok_or_else(|| stream.error(format!("`{}`", excerpt(line)), OF_ELEMENTS))
}

fn element_nodes(stream: &mut Stream, n_nodes: usize, width: usize) -> Result<Vec<i64>> {
    let mut nodes = Vec::with_capacity(n_nodes);
    while nodes.len() < n_nodes {
        let line = raw_line(stream, OF_ELEMENTS)?;
        let fields = line.strip_prefix(b" -2").map(|rest| rest.chunks(width).map(|field| whole(field.trim_ascii())));
        let found: Option<Vec<i64>> = fields.and_then(Iterator::collect);
        match found {
            Some(found) if !found.is_empty() => nodes.extend(found),
            _ => return Err(stream.error(format!("`{}`", excerpt(&line)), OF_ELEMENTS)),
        }
    }
    nodes.truncate(n_nodes);
    Ok(nodes)
}

fn binary_element(stream: &mut Stream) -> Result<(i64, Vec<i64>)> {
    stream.form = Form::LittleEndian;
    stream.int(OF_ELEMENTS)?;
    let number = stream.int(OF_ELEMENTS)?;
    for _of_group_and_material in 0..2 {
        stream.int(OF_ELEMENTS)?;
    }
    let n =
        n_nodes(number).ok_or_else(|| stream.error(format!("an element of type {number}"), "a type from 1 to 12"))?;
    let nodes = (0..n).map(|_| stream.int(OF_ELEMENTS)).collect::<Result<_>>()?;
    Ok((number, nodes))
}

fn add(stream: &Stream, (number, nodes): (i64, &[i64]), labels: &Labels, mesh: &mut CellMesh) -> Result<()> {
    let Kind::Faced(cell) = kind_of(number) else { return Ok(()) };
    let index = |label: &i64| {
        labels.find(*label).ok_or_else(|| stream.error(format!("node {label} in an element"), "a node of the block 2C"))
    };
    let indices = nodes.iter().map(index).collect::<Result<Vec<u32>>>()?;
    mesh.add(cell, indices);
    Ok(())
}

fn n_nodes(number: i64) -> Option<usize> {
    const N_NODES: [usize; 12] = [8, 6, 4, 20, 15, 10, 3, 6, 4, 8, 2, 3];
    N_NODES.get(usize::try_from(number).ok()?.checked_sub(1)?).copied()
}

fn kind_of(number: i64) -> Kind {
    let shape = match number {
        1 | 4 => Shape::Brick,
        2 | 5 => Shape::Wedge,
        3 | 6 => Shape::Tetrahedron,
        7 | 8 => Shape::Triangle,
        9 | 10 => Shape::Quadrilateral,
        _ => return Kind::Faceless,
    };
    kind(shape, n_nodes(number).unwrap_or_default())
}

/// A line with the blanks at its start.
pub(in crate::input) fn raw_line(stream: &mut Stream, expected: &str) -> Result<Vec<u8>> {
    match stream.raw_line()? {
        Some(line) => Ok(line),
        None => Err(stream.error("the end of the file", expected)),
    }
}

fn whole(field: &[u8]) -> Option<i64> {
    std::str::from_utf8(field).ok()?.parse().ok()
}
