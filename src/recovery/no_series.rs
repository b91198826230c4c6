//! What stands for a VTKHDF file in a program without HDF5.

use std::path::Path;

use super::vtk_grid::{Cells, Field, Values};
use crate::error::{Error, Result};

/// A file that cannot be made.
pub enum Series {}

impl Series {
    /// Refuses the file.
    ///
    /// # Errors
    /// [`Error::FeatureMissing`], always.
    pub fn create(path: &Path, _: usize, _: &Cells, _: &[Field]) -> Result<Self> {
        Err(Error::FeatureMissing { path: path.to_owned(), feature: "hdf5" })
    }

    /// There is no such file.
    ///
    /// # Errors
    /// None.
    pub fn push(&mut self, _: f64, _: Option<&[[f64; 3]]>, _: &[Values<'_>]) -> Result<()> {
        match *self {}
    }

    /// There is no such file.
    ///
    /// # Errors
    /// None.
    pub fn finish(self) -> Result<()> {
        match self {}
    }
}
