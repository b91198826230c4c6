//! Modes in a result file of CalculiX (`.frd`), in text and binary: the displacements of a frequency step at its nodes, with the frequencies.
//!
//! A block of results has a head with the frequency, the number of its nodes, the kind of the step and how it is written; the name of the
//! result with one line for each component; and a line or record for each node. Displacements go to the rows of K and M by node and
//! direction. Every row needs one. What stands at nodes without a row is left out: supports and constraints have taken these rows out of
//! the matrices.

use std::collections::HashMap;

use super::allowance::Claim;
use super::banner::excerpt;
use super::file_start::FileStart;
use super::fortran::{real, whole};
use super::mesh::CellMesh;
use super::mesh::frd::{Block, check_count, elements, nodes, raw_line};
use super::mesh::stream::{Form, Stream};
use super::mode_format::{ModeSource, ReadModes};
use super::mode_matrix::NUMBER;
use super::value_unit::ValueUnit;
use crate::dofs::Direction;
use crate::error::{Error, Result};
use crate::number::counted;

/// Bytes that the rows of a node take.
const NODE: u64 = 64;
/// Digits of a number as `%12.5E` writes it, and of one of 32 bits.
const TEXT_DIGITS: u32 = 6;
const SINGLE_DIGITS: u32 = 7;
/// Columns of a number.
const NUMBER_WIDTH: usize = 12;
/// The kind of a frequency step in the head of a block.
const MODAL: i64 = 2;

const OF_HEAD: &str = "the head of a block of results: its value, number of nodes, kind of step and form";
const OF_COMPONENTS: &str = "the name of a result and its components";
const OF_VALUES: &str = "the values of a node";
const SEVERAL: &str = "those of one frequency step: name it as in `job.frd:2`";

/// Whether a file is a result file of CalculiX.
pub(super) fn begins(start: &FileStart<'_>) -> bool {
    start.head.starts_with(b"    1C")
}

/// The modes of the only frequency step, or of the one that is named by its number.
///
/// # Errors
/// [`Error::ModesNodes`]; [`Error::MeshText`] and [`Error::MeshBinary`] for what is no result file; [`Error::MemoryRead`]; those of
/// reading the file.
pub(super) fn modes(source: &ModeSource<'_>) -> Result<ReadModes> {
    let no_number = |name: &str| wrong(source, format!("{name:?} for the number of a step"), SEVERAL);
    let step = source.member.as_deref().map(|name| name.parse::<i64>().map_err(|_| no_number(name))).transpose()?;
    let claim = source.allowance.claim(&source.file);
    let mut modes = Modes::of(Places::of(source, &claim)?);
    let mut stream = Stream::open(&source.file)?;
    let mut mesh = CellMesh::default();
    let mut at = Step::default();
    while let Some(line) = stream.raw_line()? {
        let text = line.trim_ascii_start();
        if !text.is_empty() {
            modes.is_ended = text.starts_with(b"9999");
        }
        match () {
            () if text.starts_with(b"2C") => nodes(&mut stream, text, &mut mesh, &claim)?,
            () if text.starts_with(b"3C") => elements(&mut stream, text, &mut mesh, &claim)?,
            () if text.starts_with(b"1PSTEP") => at = Step { number: last_number(text), diameter: None },
            () if text.starts_with(b"1PHID") => at.diameter = last_number(text).filter(|diameter| *diameter >= 0),
            () if text.starts_with(b"100C") => {
                let block = Head::read(&mut stream, &line)?;
                match block.is_mode() && step.is_none_or(|step| at.number == Some(step)) {
                    true => modes.take((&mut stream, &block), &at, source, &claim)?,
                    false => block.skip(&mut stream)?,
                }
            }
            () => {}
        }
    }
    modes.into_read(source, step)
}

/// The step that the blocks to come are of.
#[derive(Clone, Copy, Debug, Default)]
struct Step {
    number: Option<i64>,
    /// Nodal diameter of modes of a sector; none for modes of the whole.
    diameter: Option<i64>,
}

fn last_number(line: &[u8]) -> Option<i64> {
    line.split(u8::is_ascii_whitespace).rfind(|word| !word.is_empty()).and_then(whole)
}

fn wrong(source: &ModeSource<'_>, found: impl Into<String>, expected: &'static str) -> Error {
    Error::ModesNodes { path: source.file.clone(), found: found.into(), expected }
}

/// A block of results up to its values.
struct Head {
    /// The frequency, in a frequency step.
    value: f64,
    n_nodes: u64,
    kind: i64,
    block: Block,
    name: Vec<u8>,
    /// Components that the file has of each node.
    n_written: usize,
}

impl Head {
    /// Reads the lines that follow the first one.
    fn read(stream: &mut Stream, line: &[u8]) -> Result<Self> {
        let field = |from: usize, width: usize| line.get(from..line.len().min(from + width)).unwrap_or_default();
        let value = real(field(12, NUMBER_WIDTH)).filter(|value| value.is_finite());
        let n_nodes = whole(field(24, 12)).and_then(|count| u64::try_from(count).ok());
        let form = last_number(line).and_then(|form| u64::try_from(form).ok());
        let block = form.and_then(|form| Block::of_form(form, Block::Double));
        let (Some(value), Some(n_nodes), Some(kind), Some(block)) = (value, n_nodes, whole(field(56, 2)), block) else {
            return Err(stream.error(format!("`{}`", excerpt(line)), OF_HEAD));
        };
        let (name, n_written) = components(stream)?;
        Ok(Self { value, n_nodes, kind, block, name, n_written })
    }

    /// Whether it holds a mode, or a part of one.
    fn is_mode(&self) -> bool {
        self.kind == MODAL && self.name.starts_with(b"DISP")
    }

    /// Goes over the values.
    fn skip(&self, stream: &mut Stream) -> Result<()> {
        self.each_node(stream, |_, _, _| Ok(())).map(drop)
    }

    /// Hands on the label of each node and its values; the number of nodes.
    fn each_node(&self, stream: &mut Stream, mut take: impl FnMut(&Stream, i64, &[f64]) -> Result<()>) -> Result<u64> {
        let mut values = Vec::with_capacity(self.n_written);
        let mut n_read = 0;
        loop {
            values.clear();
            let label = match self.block {
                Block::Text(width) => match text_node(stream, (width, self.n_written), &mut values)? {
                    Some(label) => label,
                    None => break,
                },
                _ if n_read == self.n_nodes => break,
                _ => self.binary_node(stream, &mut values)?,
            };
            n_read += 1;
            take(stream, label, &values)?;
        }
        stream.form = Form::Text;
        Ok(n_read)
    }

    fn binary_node(&self, stream: &mut Stream, values: &mut Vec<f64>) -> Result<i64> {
        stream.form = Form::LittleEndian;
        let label = stream.int(OF_VALUES)?;
        for _ in 0..self.n_written {
            values.push(match self.block {
                Block::Single => f32::from_le_bytes(stream.bytes(OF_VALUES)?).into(),
                _ => stream.any_real(OF_VALUES)?,
            });
        }
        Ok(label)
    }

    /// Digits that each number has; none where it has all.
    fn digits(&self) -> Option<u32> {
        match self.block {
            Block::Text(_) => Some(TEXT_DIGITS),
            Block::Single => Some(SINGLE_DIGITS),
            Block::Double => None,
        }
    }
}

/// The name of a result, and how many of its components are written: a length that a reader computes itself is not.
fn components(stream: &mut Stream) -> Result<(Vec<u8>, usize)> {
    /// More components than a result has.
    const MAX_COMPONENTS: i64 = 64;
    let first = raw_line(stream, OF_COMPONENTS)?;
    let field = |line: &[u8], from: usize, width: usize| -> Vec<u8> {
        line.get(from..line.len().min(from + width)).unwrap_or_default().trim_ascii().to_vec()
    };
    let count = whole(&field(&first, 13, 5)).filter(|count| (1..=MAX_COMPONENTS).contains(count));
    let Some(count) = count.filter(|_| first.starts_with(b" -4")) else {
        return Err(stream.error(format!("`{}`", excerpt(&first)), OF_COMPONENTS));
    };
    let mut n_written = 0;
    for _ in 0..count {
        let line = raw_line(stream, OF_COMPONENTS)?;
        if !line.starts_with(b" -5") {
            return Err(stream.error(format!("`{}`", excerpt(&line)), OF_COMPONENTS));
        }
        n_written += usize::from(whole(&field(&line, 33, 5)).is_none_or(|is_computed| is_computed == 0));
    }
    Ok((field(&first, 5, 8), n_written))
}

/// The label of a node, its values behind it and on lines that go on; none at the end of the block.
fn text_node(stream: &mut Stream, (width, n): (usize, usize), values: &mut Vec<f64>) -> Result<Option<i64>> {
    let line = raw_line(stream, OF_VALUES)?;
    if line.starts_with(b" -3") {
        return Ok(None);
    }
    let label = line.get(3..3 + width).and_then(whole).filter(|_| line.starts_with(b" -1"));
    let Some(label) = label else { return Err(stream.error(format!("`{}`", excerpt(&line)), OF_VALUES)) };
    let mut line = line;
    loop {
        let fields = line.get(3 + width..).unwrap_or_default().chunks(NUMBER_WIDTH);
        for field in fields {
            let value = real(field).ok_or_else(|| stream.error(format!("`{}`", excerpt(field)), OF_VALUES))?;
            values.push(value);
        }
        if values.len() > n {
            return Err(stream
                .error(format!("`{}`", excerpt(&line)), format!("{n} values of 12 characters, and nothing behind")));
        }
        if values.len() == n {
            return Ok(Some(label));
        }
        line = raw_line(stream, OF_VALUES)?;
        if !line.starts_with(b" -2") {
            return Err(stream.error(format!("`{}`", excerpt(&line)), OF_VALUES));
        }
    }
}

/// The rows of the matrices by node and direction.
struct Places {
    n_rows: usize,
    /// For each node its rows along x, y and z.
    of_node: HashMap<i64, [Option<u32>; 3]>,
}

impl Places {
    fn of(source: &ModeSource<'_>, claim: &Claim<'_>) -> Result<Self> {
        const NO_MAP: &str =
            "the dof map of the matrices, as in --dofs job.dof: it says which node and direction each row is";
        const DISPLACED: &str = "rows that are displacements of nodes: a result file of CalculiX has nothing else";
        let left = &source.rows.left;
        if left.iter().all(|(_, dof)| dof.is_none()) {
            return Err(wrong(source, "displacements of nodes, and no row whose node is known", NO_MAP));
        }
        claim.add(NODE * left.len() as u64)?;
        let mut of_node: HashMap<i64, [Option<u32>; 3]> = HashMap::new();
        for (row, dof) in left {
            let axis =
                dof.and_then(|dof| Some((dof, Direction::ALL[..3].iter().position(|axis| *axis == dof.direction)?)));
            let Some((dof, axis)) = axis else {
                let what = dof.map_or_else(|| "which no node has".to_owned(), |dof| format!("which is {dof}"));
                return Err(wrong(source, format!("nothing for row {}, {what}", row + 1), DISPLACED));
            };
            of_node.entry(dof.node).or_default()[axis] = Some(*row as u32);
        }
        Ok(Self { n_rows: source.rows.n, of_node })
    }
}

/// The modes that were read.
struct Modes {
    places: Places,
    columns: Vec<Vec<f64>>,
    hertz: Vec<f64>,
    /// The step that they are of.
    step: Option<i64>,
    digits: Option<u32>,
    /// Displacements of a mode that belong to no row, and those of them that are not zero, at most.
    n_without_row: usize,
    n_moving: usize,
    /// Whether the last line is the one that ends a file.
    is_ended: bool,
}

impl Modes {
    fn of(places: Places) -> Self {
        let (columns, hertz) = (Vec::new(), Vec::new());
        Self { places, columns, hertz, step: None, digits: None, n_without_row: 0, n_moving: 0, is_ended: false }
    }

    /// Reads the values of a block as the next mode.
    fn take(
        &mut self,
        (stream, block): (&mut Stream, &Head),
        step: &Step,
        source: &ModeSource<'_>,
        claim: &Claim<'_>,
    ) -> Result<()> {
        self.refuse_other(block, step, source)?;
        claim.add(NUMBER * self.places.n_rows as u64)?;
        let mut column = vec![0.0; self.places.n_rows];
        source.rows.left.iter().for_each(|(row, _)| column[*row] = f64::NAN);
        let (mut n_without_row, mut n_moving) = (0, 0);
        let n_read = block.each_node(stream, |stream, label, values| {
            let rows = self.places.of_node.get(&label).copied().unwrap_or_default();
            for (row, value) in rows.into_iter().zip(values) {
                if !value.is_finite() {
                    return Err(stream.error(format!("{value} at node {label}"), "a finite number"));
                }
                match row {
                    Some(row) if column[row as usize].is_nan() => column[row as usize] = *value,
                    Some(_) => return Err(stream.error(format!("node {label} twice"), "one line for each node")),
                    None => {
                        n_without_row += 1;
                        n_moving += usize::from(*value != 0.0);
                    }
                }
            }
            Ok(())
        })?;
        check_count(stream, (n_read, block.n_nodes), "nodes with values")?;
        refuse_missing(source, &column)?;
        self.n_without_row = self.n_without_row.max(n_without_row);
        self.n_moving = self.n_moving.max(n_moving);
        self.step = step.number;
        self.digits = block.digits();
        self.hertz.push(block.value);
        self.columns.push(column);
        Ok(())
    }

    /// Refuses what is no real mode of the step that those before are of.
    fn refuse_other(&self, block: &Head, step: &Step, source: &ModeSource<'_>) -> Result<()> {
        const REAL: &str = "real modes of the whole model, as *FREQUENCY writes them";
        if block.name != b"DISP" || block.n_written != 3 {
            let name = excerpt(&block.name);
            let components = counted(block.n_written, "component", "components");
            return Err(wrong(source, format!("modes as {name} of {components}"), REAL));
        }
        if let Some(diameter) = step.diameter {
            return Err(wrong(source, format!("modes of a sector, of nodal diameter {diameter}"), REAL));
        }
        if !self.columns.is_empty() && self.step != step.number {
            let [first, second] = [self.step, step.number].map(|step| step.unwrap_or_default());
            return Err(wrong(source, format!("modes of the steps {first} and {second}"), SEVERAL));
        }
        if self.columns.len() == self.places.n_rows {
            return Err(Error::ModesColumns {
                path: source.file.clone(),
                found: self.columns.len() as u64 + 1,
                n_rows: self.places.n_rows,
            });
        }
        Ok(())
    }

    fn into_read(self, source: &ModeSource<'_>, step: Option<i64>) -> Result<ReadModes> {
        const WRITE: &str = "displacements of a frequency step, which *NODE FILE with U in it writes";
        if self.columns.is_empty() {
            let of_step = step.map_or_else(String::new, |step| format!(" of step {step}"));
            return Err(wrong(source, format!("no modes{of_step}"), WRITE));
        }
        Ok(ReadModes {
            notes: self.left_out().into_iter().chain(self.unended()).collect(),
            values: Some((ValueUnit::Hertz, self.hertz)),
            program: Some("CalculiX"),
            digits: self.digits,
            ..ReadModes::of_columns(self.columns)
        })
    }

    /// That modes may be missing behind the last one, in words.
    fn unended(&self) -> Option<String> {
        let note =
            "the file has no line 9999 at its end, as CalculiX writes it: it may be cut short, and modes be missing";
        (!self.is_ended).then(|| note.to_owned())
    }

    /// What belongs to no row, in words.
    fn left_out(&self) -> Vec<String> {
        let n_at_rest = self.n_without_row - self.n_moving;
        let at_rest = "K and M have no row for them, as where a support has taken it out";
        let moving =
            "K and M have no row for them, as where a constraint has taken it out, and nothing here looks at them";
        [(n_at_rest, "zero", at_rest), (self.n_moving, "not zero", moving)]
            .into_iter()
            .filter(|(count, _, _)| *count > 0)
            .map(|(count, value, why)| {
                let displacements = counted(count, "displacement", "displacements");
                format!("{displacements} of a mode in the file, {value}, left out: {why}")
            })
            .collect()
    }
}

/// Refuses a mode that has no value for a row that is left of the model.
fn refuse_missing(source: &ModeSource<'_>, column: &[f64]) -> Result<()> {
    const ALL: &str = "one of every node that has rows: *NODE FILE without NSET and without OUTPUT=2D, and the dof map of these matrices";
    let mut missing = source.rows.left.iter().filter(|(row, _)| column[*row].is_nan());
    let Some((row, dof)) = missing.next() else { return Ok(()) };
    let first = dof.map_or_else(|| format!("row {}", row + 1), |dof| dof.to_string());
    let others = match missing.count() {
        0 => String::new(),
        count => format!(" and of {}", counted(count, "row more", "rows more")),
    };
    Err(wrong(source, format!("no displacement of {first}{others}"), ALL))
}
