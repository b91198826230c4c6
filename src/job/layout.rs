//! Formats of matrices by name.

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A format of matrices, named where the content of a file leaves several.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// Matrix Market with its banner.
    MatrixMarket,
    /// Lines `row column value`, as CalculiX writes them, and Abaqus with FORMAT=COORDINATE.
    Coordinate,
    /// Sparse matrices of `scipy.sparse.save_npz`, dense ones of `numpy.savez`.
    Npz,
    /// A dense matrix of `numpy.save`.
    Npy,
    /// MATLAB level 5, before version 7.3.
    Matlab5,
    /// OUTPUT4 of Nastran, text or binary.
    Op4,
    /// DMIG of Nastran, in bulk data or a punch file.
    Dmig,
    /// Lines `node, dof, node, dof, value`, which Abaqus writes unless it is told otherwise.
    AbaqusLabels,
    /// Matrices of a linear user element, as `*SUBSTRUCTURE MATRIX OUTPUT` of Abaqus and CalculiX writes them.
    UserElement,
    /// Harwell-Boeing and Rutherford-Boeing, HBMAT of Ansys.
    HarwellBoeing,
    /// HDF5: MATLAB v7.3, PETSc, anndata, h5sparse, Exudyn, Octave, Julia, Binsparse, MSC Nastran.
    Hdf5,
    /// What supel itself writes: K̂, M̂ and further matrices of a superelement.
    Superelement,
}

impl Layout {
    /// Its name in a job and on the command line.
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }
}
