//! Matrices of Abaqus by nodes and degrees of freedom: lines `node, dof, node, dof, value`, what `*MATRIX OUTPUT` writes unless it is told
//! otherwise, and what `*MATRIX INPUT` reads.
//!
//! A symmetric matrix is one triangle or both. Nodes that Abaqus makes for itself have negative labels; degrees of freedom beyond 6 are
//! those of temperatures and pressures. Neither moves with the component, so that both are scalar.

use std::path::Path;

use rayon::prelude::*;

use super::banner::{excerpt, is_comment};
use super::blocks::{BLOCK_BYTES, count_lines, for_each_batch};
use super::file_start::FileStart;
use super::format::{Format, MatrixFormat, MatrixSource, ReadMatrix, Sureness};
use super::fortran::{real, whole};
use super::labels::LabelledEntries;
use super::row_label::RowLabel;
use crate::error::{Error, Result};
use crate::job::Layout;
use crate::sparse::Declared;

const EXPECTED: &str = "five numbers, `node, dof, node, dof, value`";

/// `*MATRIX OUTPUT, FORMAT=MATRIX INPUT` and `FORMAT=LABELS`.
pub(super) struct AbaqusLabels;

impl Format for AbaqusLabels {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        let first = start.lines().find(|line| !is_comment(line));
        // A head that ends within the only line tells less than a whole one.
        if first.is_some_and(|line| entry(line).is_ok()) { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl MatrixFormat for AbaqusLabels {
    fn layout(&self) -> Layout {
        Layout::AbaqusLabels
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        let path = source.file.as_path();
        let declared = Declared::General;
        let mut entries = LabelledEntries::new(source, declared);
        let mut n_lines = 0;
        let ending = for_each_batch(path, BLOCK_BYTES, |batch| {
            let parsed: Vec<_> = batch.par_iter().map(|text| parse(text)).collect();
            for (text, parsed) in batch.iter().zip(parsed) {
                let parsed = parsed.map_err(|fault| fault.into_error(path, n_lines))?;
                parsed.into_iter().try_for_each(|(at, value)| entries.push(source, at, value))?;
                n_lines += count_lines(text);
            }
            Ok(())
        })?;
        if entries.is_empty() {
            return Err(Error::NoData { path: path.to_owned(), expected: "lines `node, dof, node, dof, value`" });
        }
        entries.into_matrix(source, declared, (ending.digest, ending.last_line))
    }
}

type Entry = ([RowLabel; 2], f64);

/// What is wrong with a line, and its number within the text, from 0.
struct Fault {
    line: u64,
    found: String,
    expected: &'static str,
}

impl Fault {
    fn into_error(self, path: &Path, n_before: u64) -> Error {
        Error::MatrixFormat {
            path: path.to_owned(),
            format: "matrix lines of Abaqus",
            place: format!("line {}", n_before + self.line + 1),
            found: self.found,
            expected: self.expected.into(),
        }
    }
}

/// The entries of whole lines.
fn parse(text: &[u8]) -> std::result::Result<Vec<Entry>, Fault> {
    let mut entries = Vec::with_capacity(count_lines(text) as usize + 1);
    for (line, number) in text.split(|byte| *byte == b'\n').zip(0..) {
        let line = line.trim_ascii();
        if line.is_empty() || is_comment(line) {
            continue;
        }
        let entry = entry(line).map_err(|expected| Fault { line: number, found: excerpt(line), expected })?;
        entries.push(entry);
    }
    Ok(entries)
}

/// The entry of a line; what was expected where it is none.
fn entry(line: &[u8]) -> std::result::Result<Entry, &'static str> {
    let mut fields = line.split(|byte| matches!(byte, b',' | b' ' | b'\t')).filter(|field| !field.is_empty());
    let mut next = || fields.next().ok_or(EXPECTED);
    let mut label = || {
        let (node, component) = (whole(next()?), whole(next()?));
        let component = component.and_then(|component| u8::try_from(component).ok());
        let label = node.zip(component).map(|(node, component)| RowLabel { node, component });
        label.ok_or("a label of a node and the number of a degree of freedom")
    };
    let (row, col) = (label()?, label()?);
    let value = real(next()?).ok_or(EXPECTED)?;
    match (value.is_finite(), fields.next()) {
        (_, Some(_)) => Err(EXPECTED),
        (false, None) => Err("a finite number"),
        (true, None) => Ok(([row, col], value)),
    }
}
