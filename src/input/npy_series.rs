//! A superelement of Exudyn in NumPy arrays one after another in a file, as `ObjectFFRFreducedOrderInterface.SaveToFile` writes with `.npy`.
//!
//! The arrays have no names in the file: their order is that of the program. Python objects among them are passed over, up to where the
//! next array begins.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use super::mode_format::{ModeSource, ReadModes};
use super::npy_header::{Failure, Header, MAGIC};
use super::numpy_array::{Array, stored_as};
use crate::error::{Error, Result};
use crate::regular_file;

const FORMAT: &str = "series of NumPy arrays";
/// The first arrays of a file in their order.
const NAMES: [&str; 6] =
    ["fileVersion", "modeBasis", "trigList", "postProcessingModes", "massMatrixReduced", "stiffnessMatrixReduced"];
const PYTHON_OBJECTS: &str = "|O";

/// The array of a name, with nothing behind it.
///
/// # Errors
/// [`Error::MatrixName`] where Exudyn writes none of this name; [`Error::MatrixFormat`] where there are fewer arrays, or other ones; those of
/// reading the file.
pub(super) fn array<'a>(path: &'a Path, name: &'a str) -> Result<Array<'a, impl Read>> {
    let Some(at) = NAMES.iter().position(|known| *known == name) else {
        let holds = NAMES.iter().map(|name| (*name).to_owned()).collect();
        return Err(Error::MatrixName { path: path.to_owned(), name: name.to_owned(), holds });
    };
    let mut series = Series { path, source: BufReader::new(regular_file::open(path)?), name: "" };
    for name in &NAMES[..at] {
        series.name = name;
        series.skip()?;
    }
    series.name = name;
    Array::open(path, FORMAT, name, series.next()?)
}

/// The modes in the columns of an array that is named.
///
/// # Errors
/// The errors of [`array`] and of [`Array::modes`].
pub(super) fn modes(source: &ModeSource<'_>) -> Result<ReadModes> {
    array(&source.file, source.member.as_deref().unwrap_or_default())?.modes(source)
}

/// The arrays of a file.
struct Series<'a> {
    path: &'a Path,
    source: BufReader<File>,
    /// What the next array is called.
    name: &'a str,
}

impl Series<'_> {
    fn failed(&self, source: std::io::Error) -> Error {
        Error::Read { path: self.path.to_owned(), source }
    }

    fn wrong(&self, found: impl Into<String>) -> Error {
        Error::MatrixFormat {
            path: self.path.to_owned(),
            format: FORMAT,
            place: self.name.to_owned(),
            found: found.into(),
            expected: "the arrays that Exudyn writes one after another".into(),
        }
    }

    fn header(&mut self) -> Result<Header> {
        Header::read(&mut self.source).map_err(|failure| match failure {
            Failure::Found(found) => self.wrong(found),
            Failure::Read(source) => self.failed(source),
        })
    }

    /// Bytes of the numbers behind a header; none of Python objects.
    fn n_bytes(&self, header: &Header) -> Result<Option<u64>> {
        if header.descr == PYTHON_OBJECTS {
            return Ok(None);
        }
        let size = stored_as(&header.descr).map(|(kind, _)| kind.size() as u64);
        let bytes = size.zip(header.n_numbers()).and_then(|(size, n)| n.checked_mul(size));
        match bytes.filter(|bytes| i64::try_from(*bytes).is_ok()) {
            Some(bytes) => Ok(Some(bytes)),
            None => Err(self.wrong(format!("an array of type {} and shape {:?}", header.descr, header.shape))),
        }
    }

    /// Goes behind the next array.
    fn skip(&mut self) -> Result<()> {
        let header = self.header()?;
        match self.n_bytes(&header)? {
            Some(bytes) => self.source.seek_relative(bytes as i64).map_err(|error| self.failed(error)),
            None => self.skip_objects(),
        }
    }

    /// Goes to the beginning of the next array: Python objects do not say how long they are.
    fn skip_objects(&mut self) -> Result<()> {
        let mut n_matched = 0;
        while n_matched < MAGIC.len() {
            let path = self.path;
            let buffer = self.source.fill_buf().map_err(|source| Error::Read { path: path.to_owned(), source })?;
            let Some(byte) = buffer.first().copied() else {
                return Err(self.wrong("the end of the file behind Python objects"));
            };
            // The first byte of the mark is not in it again.
            n_matched = match () {
                () if byte == MAGIC[n_matched] => n_matched + 1,
                () if byte == MAGIC[0] => 1,
                () => 0,
            };
            self.source.consume(1);
        }
        self.source.seek_relative(-(MAGIC.len() as i64)).map_err(|error| self.failed(error))
    }

    /// The bytes of the next array from its header on.
    fn next(mut self) -> Result<impl Read> {
        let begin = self.source.stream_position().map_err(|error| self.failed(error))?;
        let header = self.header()?;
        let Some(bytes) = self.n_bytes(&header)? else { return Err(self.wrong("Python objects")) };
        self.source.seek(SeekFrom::Start(begin)).map_err(|error| self.failed(error))?;
        Ok(self.source.take(header.length.saturating_add(bytes)))
    }
}
