//! The grid points of a Nastran deck as nodes: where they are in the basic system, whatever CP they are given in, and along which axes their
//! rows are.

use std::path::{Path, PathBuf};

use super::allowance::Allowance;
use super::bulk_lines::included_files;
use super::bulk_start::is_bulk;
use super::file_start::FileStart;
use super::format::{Format, NodeFormat, ReadNodes, Sureness};
use super::nastran_frames::grid_points;
use crate::error::{Error, Result};

/// Bytes of a grid point: its entry, its label and its position.
const NODE: u64 = 128;

/// GRID of bulk data, with CP and its systems. Elements are not read.
pub(super) struct NastranNodes;

impl Format for NastranNodes {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        if is_bulk(start) { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl NodeFormat for NastranNodes {
    fn read(&self, path: &Path, allowance: &Allowance) -> Result<ReadNodes> {
        let (nodes, along_frames) = grid_points(path)?;
        if nodes.labels.is_empty() {
            return Err(Error::NoData { path: path.to_owned(), expected: "GRID entries of bulk data" });
        }
        allowance.claim(path).add(NODE * nodes.labels.len() as u64)?;
        Ok(ReadNodes { along_frames, ..ReadNodes::along_the_axes(nodes, None) })
    }

    fn referenced_files(&self, path: &Path) -> Vec<PathBuf> {
        included_files(path)
    }
}
