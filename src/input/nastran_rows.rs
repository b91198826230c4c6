//! The rows of Nastran matrices from bulk data: those that EXTRN lists for an external superelement, else all of GRID and SPOINT in the
//! order of their labels, six for a grid point and one for a scalar point, which is the g-set.

use std::collections::BTreeMap;
use std::path::Path;

use super::allowance::Allowance;
use super::bulk_cards::{Cards, wrong};
use super::bulk_start::is_bulk;
use super::file_start::FileStart;
use super::format::{DofMapFormat, Format, ReadDofs, Sureness};
use super::fortran::whole;
use super::nastran_frames::grid_frames;
use super::row_label::RowLabel;
use crate::error::{Error, Result};
use crate::number::counted;

/// Directions of a grid point.
const DIRECTIONS: std::ops::RangeInclusive<u8> = 1..=6;

/// EXTRN, GRID and SPOINT of bulk data and punch files.
pub(super) struct NastranRows;

impl Format for NastranRows {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        if is_bulk(start) { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl DofMapFormat for NastranRows {
    fn read(&self, path: &Path, n: usize, _: &Allowance) -> Result<ReadDofs> {
        let listed = extern_rows(path)?;
        let labels = if listed.is_empty() { all_rows(path, n)? } else { listed };
        if labels.is_empty() {
            return Err(Error::NoData {
                path: path.to_owned(),
                expected: "EXTRN, GRID or SPOINT entries of bulk data",
            });
        }
        let n_rows = labels.len();
        let labels = &labels[..n.min(n_rows)];
        let dofs = labels.iter().map(|label| label.dof()).collect();
        let scalars = labels.iter().copied().enumerate().filter(|(_, label)| label.dof().is_none()).collect();
        Ok(ReadDofs { scalars, frames: grid_frames(path), ..ReadDofs::new(dofs, n_rows) })
    }
}

/// Pairs of a label and its components, in their order.
fn extern_rows(path: &Path) -> Result<Vec<RowLabel>> {
    let mut rows = Vec::new();
    let mut cards = Cards::open(path, "EXTRN")?;
    while let Some(card) = cards.advance()? {
        for pair in card.fields.chunks(2).filter(|pair| pair.iter().any(|field| !field.is_empty())) {
            let node = whole(&pair[0]).filter(|node| *node > 0);
            let node = node.ok_or_else(|| wrong(&card.place, &pair[0], "a grid point or scalar point"))?;
            let components = pair.get(1).map_or(&b""[..], Vec::as_slice);
            if matches!(components, b"" | b"0") {
                rows.push(RowLabel { node, component: 0 });
                continue;
            }
            for digit in components {
                let component = digit.wrapping_sub(b'0');
                if !DIRECTIONS.contains(&component) {
                    return Err(wrong(&card.place, components, "components from 1 to 6"));
                }
                rows.push(RowLabel { node, component });
            }
        }
    }
    Ok(rows)
}

/// The g-set. Ranges of scalar points may be many numbers in few characters: none may make more points than the matrices have rows, `n`.
fn all_rows(path: &Path, n: usize) -> Result<Vec<RowLabel>> {
    let mut is_grid: BTreeMap<i64, bool> = BTreeMap::new();
    let mut cards = Cards::open(path, "GRID")?;
    while let Some(card) = cards.advance()? {
        let label = card.fields.first().map_or(&b""[..], Vec::as_slice);
        let node = whole(label).ok_or_else(|| wrong(&card.place, label, "the label of a grid point"))?;
        is_grid.insert(node, true);
    }
    let mut cards = Cards::open(path, "SPOINT")?;
    while let Some(card) = cards.advance()? {
        let fields: Vec<&[u8]> = card.fields.iter().map(Vec::as_slice).filter(|field| !field.is_empty()).collect();
        let number =
            |field: &[u8]| whole(field).ok_or_else(|| wrong(&card.place, field, "the label of a scalar point"));
        match fields[..] {
            [first, word, last] if word.eq_ignore_ascii_case(b"THRU") => {
                let (first, last) = (number(first)?, number(last)?);
                let n_points = u64::try_from(last.saturating_sub(first)).map_or(0, |beyond| beyond.saturating_add(1));
                if n_points.saturating_add(is_grid.len() as u64) > n as u64 {
                    let expected = format!("no more points than the {} of the matrices", counted(n, "row", "rows"));
                    return Err(wrong(&card.place, fields[2], &expected));
                }
                is_grid.extend((first..=last).map(|point| (point, false)));
            }
            _ => {
                for field in fields {
                    is_grid.insert(number(field)?, false);
                }
            }
        }
    }
    let rows = is_grid.into_iter().flat_map(|(node, is_grid)| {
        let components = if is_grid { DIRECTIONS } else { 0..=0 };
        components.map(move |component| RowLabel { node, component })
    });
    Ok(rows.collect())
}
