//! Formats that matrices are written in, and that of meshes.

use std::path::Path;

use clap::ValueEnum;
use supel_runtime::StagedWriter;

use super::by_columns::ByColumns;
use super::content::Content;
use super::{matlab, matrix_market, npz, op4};
use crate::error::{Error, Result};

/// A format that matrices, or meshes, are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// Matrix Market.
    MatrixMarket,
    /// MATLAB v7.3, which is HDF5.
    Matlab,
    /// `scipy.sparse.save_npz`.
    Npz,
    /// OUTPUT4 of Nastran as text.
    Op4,
    /// OUTPUT4 of Nastran in binary.
    Op4Binary,
    /// VTKHDF, of a mesh in place of a matrix.
    Vtkhdf,
}

impl Target {
    /// The format that the ending of a name says.
    pub fn of_ending(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        Some(match ending.as_str() {
            "mtx" | "mm" => Self::MatrixMarket,
            "mat" | "h5" | "hdf5" => Self::Matlab,
            "npz" => Self::Npz,
            "op4" => Self::Op4,
            "vtkhdf" => Self::Vtkhdf,
            _ => return None,
        })
    }

    /// Its name, as it is typed.
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// Writes a matrix.
    ///
    /// # Errors
    /// [`Error::Write`]; [`Error::FeatureMissing`] for HDF5 in a program without it; [`Error::FlagText`] for a matrix of more rows than the
    /// format has digits for, and for the format of meshes.
    pub fn write(self, content: Content<'_>, path: &Path, out: &mut StagedWriter) -> Result<()> {
        let failed = |source| Error::Write { path: path.to_owned(), source };
        match self {
            Self::MatrixMarket => matrix_market::write(content, out).map_err(failed),
            Self::Npz => npz::write(content, out).map_err(failed),
            Self::Op4 if content.matrix.rows() > op4::MAX_ROWS_IN_TEXT => Err(Error::FlagText {
                flag: "--to",
                text: self.name(),
                expected: "op4-binary, as the fields of the text have too few digits for so many rows",
            }),
            Self::Op4 => op4::write_text(content.name, &ByColumns::of(content), out).map_err(failed),
            Self::Op4Binary => op4::write_binary(content.name, &ByColumns::of(content), out).map_err(failed),
            Self::Matlab => matlab::write(content.name, &ByColumns::of(content), path, out),
            Self::Vtkhdf => Err(Error::FlagText { flag: "--to", text: self.name(), expected: "a format of matrices" }),
        }
    }
}
