//! Matrix Market: one triangle of a symmetric or skew matrix, every entry of any other. The shortest decimal form of a double brings it back.

use std::io::{Result, Write};

use super::content::{Content, Shape};

pub(super) fn write(content: Content<'_>, out: &mut impl Write) -> Result<()> {
    let Content { matrix, shape, .. } = content;
    let is_written = |row: usize, col: usize| shape == Shape::General || col <= row;
    let rows = || matrix.outer_iterator().enumerate();
    let n_written: usize =
        rows().map(|(row, view)| view.indices().iter().filter(|col| is_written(row, **col as usize)).count()).sum();
    writeln!(out, "%%MatrixMarket matrix coordinate real {}", shape.name())?;
    writeln!(out, "{} {} {n_written}", matrix.rows(), matrix.cols())?;
    for (row, view) in rows() {
        for (col, value) in view.iter().filter(|(col, _)| is_written(row, *col)) {
            writeln!(out, "{} {} {value:e}", row + 1, col + 1)?;
        }
    }
    Ok(())
}
