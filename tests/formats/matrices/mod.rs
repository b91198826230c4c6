//! Every format of matrices: files that other programs wrote (`fixtures/matrices`), and the same files damaged.

mod ambiguity;
#[cfg(feature = "hdf5")]
mod converted;
mod corpus;
mod damage;
#[cfg(feature = "hdf5")]
mod halves;
#[cfg(feature = "hdf5")]
mod hdf5;
mod nastran;
#[cfg(feature = "hdf5")]
mod oracle;
mod reading;
mod refused;
mod user_element;

use std::path::{Path, PathBuf};

use supel::error::{Error, Result};
use supel::input::{Input, read};
use supel::job::ModelJob;
use supel::sparse::SparseMatrix;

/// A file of the fixtures, with the name of a matrix in it after a colon where there is one.
fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/matrices").join(name)
}

/// A job that reads these two matrices and nothing else.
fn job(stiffness: &Path, mass: &Path) -> ModelJob {
    ModelJob { stiffness: stiffness.to_owned(), mass: Some(mass.to_owned()), ..ModelJob::default() }
}

/// Reads two files of the fixtures.
fn pair(stiffness: &str, mass: &str) -> Result<Input> {
    read(&job(&fixture(stiffness), &fixture(mass)))
}

/// The stiffness of a file that may hold nothing else.
fn stiffness(path: &Path) -> Result<SparseMatrix> {
    read(&job(path, &fixture("m.mtx"))).map(|input| input.stiffness.matrix)
}

/// The error of a file of this content.
fn error_of(name: &str, content: impl AsRef<[u8]>) -> Error {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, content).expect("written");
    stiffness(&path).expect_err("an error")
}
