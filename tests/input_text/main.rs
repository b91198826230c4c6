//! Text input: matrices, dof maps and node tables, as written by finite element programs and as damaged on the way.

mod corpus;
mod damage;
mod matrix_errors;
mod reading;
mod tables;

use std::io::Write;
use std::path::{Path, PathBuf};

use supel::error::{Error, Result};
use supel::input::{Input, read};
use supel::job::ModelJob;

/// A folder of files made for one test.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, bytes).expect("a file");
        path
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }
}

/// A job that reads these two matrices and nothing else.
pub(crate) fn job(stiffness: &Path, mass: &Path) -> ModelJob {
    ModelJob { stiffness: stiffness.to_owned(), mass: Some(mass.to_owned()), ..ModelJob::default() }
}

/// Reads one text as both matrices.
pub(crate) fn read_text(text: impl AsRef<[u8]>) -> Result<Input> {
    let folder = Folder::new();
    let path = folder.write("a.mtx", text);
    read(&job(&path, &path))
}

/// The error of a text that must not be read.
pub(crate) fn error_of(text: impl AsRef<[u8]>) -> Error {
    read_text(text).expect_err("an error")
}

/// The rows of the stiffness matrix, dense.
pub(crate) fn dense(input: &Input) -> Vec<Vec<f64>> {
    let matrix = &input.stiffness.matrix;
    let mut rows = vec![vec![0.0; matrix.cols()]; matrix.rows()];
    for (value, (row, col)) in matrix {
        rows[row as usize][col as usize] += value;
    }
    rows
}

pub(crate) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(bytes).expect("compression in memory");
    encoder.finish().expect("compression in memory")
}

/// The file of a matrix in Matrix Market form.
pub(crate) fn mtx(symmetry: &str, n: usize, entries: &[(usize, usize, f64)]) -> String {
    let mut text = format!("%%MatrixMarket matrix coordinate real {symmetry}\n{n} {n} {}\n", entries.len());
    for (row, col, value) in entries {
        text += &format!("{row} {col} {value:e}\n");
    }
    text
}
