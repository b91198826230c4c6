//! Values of a dataset, read only after its header has been checked against the bytes that are there.

use std::panic::{AssertUnwindSafe, catch_unwind};

use hdf5_metno::H5Type;
use hdf5_metno::dataset::Layout;
use hdf5_metno::filters::Filter;
use hdf5_metno::types::{IntSize, TypeDescriptor};

use super::attribute;
use super::file::H5;
use super::numbers::{self, Reals, Refusal};
use crate::error::{Error, Result};
use crate::input::indices::Indices;

/// The largest expansion of deflate: 258 bytes from a code of two bits.
const DEFLATE_RATIO: u64 = 1032;
/// Bytes of a number in the form it is handed on.
const WIDENED: u64 = 8;
/// Length of a name in a table of names.
const NAME_LENGTH: usize = 80;

/// A dataset of an open file, with its path in it.
pub(super) struct Dataset<'a> {
    h5: &'a H5<'a>,
    dataset: hdf5_metno::Dataset,
    name: String,
}

impl<'a> Dataset<'a> {
    pub(super) fn new(h5: &'a H5<'a>, dataset: hdf5_metno::Dataset, name: String) -> Self {
        Self { h5, dataset, name }
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// The file.
    pub(super) fn path(&self) -> &std::path::Path {
        self.h5.path()
    }

    /// Extents of the dataset; empty for a single value.
    pub(super) fn shape(&self) -> Result<Vec<usize>> {
        Ok(self.dataset.space().map_err(|e| self.read_error(&e))?.shape())
    }

    /// The whole numbers of an attribute; none where it is absent.
    pub(super) fn integer_list_attribute(&self, name: &str) -> Result<Option<Vec<i64>>> {
        attribute::integers(self.h5, &self.dataset, &self.name, name)
    }

    /// A whole-number attribute with one value.
    pub(super) fn integer_attribute(&self, name: &str) -> Result<Option<i64>> {
        let values = attribute::integers(self.h5, &self.dataset, &self.name, name)?;
        Ok(values.and_then(|v| v.first().copied()))
    }

    /// All values as real numbers, in storage order.
    pub(super) fn reals(&self) -> Result<Reals> {
        if self.checked_len()? == 0 {
            return Ok(Reals { values: Vec::new(), digits: u32::MAX });
        }
        numbers::reals(&self.dataset).map_err(|e| self.refused(e, "real numbers"))
    }

    /// All values as real numbers, as MATLAB stores them: single bytes are marks of true and false to it.
    ///
    /// # Errors
    /// [`Error::Hdf5Type`] for marks; what [`Self::reals`] returns.
    pub(super) fn reals_of_matlab(&self) -> Result<Reals> {
        match self.descriptor()? {
            Some(TypeDescriptor::Unsigned(IntSize::U1)) => {
                Err(self.refused(Refusal::Type("marks of true and false".to_owned()), "real numbers"))
            }
            _ => self.reals(),
        }
    }

    /// All values as whole numbers, in storage order.
    pub(super) fn integers(&self) -> Result<Vec<i64>> {
        if self.checked_len()? == 0 {
            return Ok(Vec::new());
        }
        numbers::integers(&self.dataset).map_err(|e| self.refused(e, "whole numbers"))
    }

    /// All values as indices from zero, of numbers that count from `first`.
    pub(super) fn indices(&self, first: i64) -> Result<Indices> {
        Ok(self.integers()?.into_iter().map(|number| number.saturating_sub(first)).collect())
    }

    /// Whether its values are whole numbers.
    pub(super) fn is_whole(&self) -> Result<bool> {
        Ok(matches!(self.descriptor()?, Some(TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_))))
    }

    /// The type of the values; `None` where it is one that has no name here.
    fn descriptor(&self) -> Result<Option<TypeDescriptor>> {
        match numbers::descriptor(&self.dataset) {
            Ok(descriptor) => Ok(Some(descriptor)),
            Err(Refusal::Library(e)) => Err(self.read_error(&e)),
            Err(_) => Ok(None),
        }
    }

    /// All records, of exactly this layout.
    pub(super) fn records<T: H5Type>(&self) -> Result<Vec<T>> {
        if self.checked_len()? == 0 {
            return Ok(Vec::new());
        }
        numbers::read(&self.dataset).map_err(|e| self.refused(e, "records of MSC Nastran"))
    }

    /// All records of these fields, with texts that end as they may.
    pub(super) fn records_with_text<T: H5Type>(&self) -> Result<Vec<T>> {
        if self.checked_len()? == 0 {
            return Ok(Vec::new());
        }
        numbers::read_with_text(&self.dataset).map_err(|e| self.refused(e, "records of MSC Nastran"))
    }

    /// A table of names of 80 characters each: padded with blanks or ended by a zero byte.
    pub(super) fn names(&self) -> Result<Vec<String>> {
        if self.checked_len()? == 0 {
            return Ok(Vec::new());
        }
        let flat = self.shape()?.last() == Some(&NAME_LENGTH);
        let read = match numbers::descriptor(&self.dataset) {
            Ok(TypeDescriptor::Integer(IntSize::U1)) if flat => {
                numbers::read::<i8>(&self.dataset).map(|names| names.chunks_exact(NAME_LENGTH).map(text_of).collect())
            }
            Ok(_) => numbers::read::<[i8; NAME_LENGTH]>(&self.dataset)
                .map(|names| names.iter().map(|name| text_of(name)).collect()),
            Err(refusal) => Err(refusal),
        };
        read.map_err(|e| self.refused(e, "names of 80 characters"))
    }

    /// A table of characters, a row for each name; empty where characters are stored in another way.
    pub(super) fn short_names(&self) -> Result<Vec<String>> {
        let shape = self.shape()?;
        let (&[_, length], Some(TypeDescriptor::FixedAscii(1))) = (&shape[..], self.descriptor()?) else {
            return Ok(Vec::new());
        };
        self.checked_len()?;
        let read = numbers::characters(&self.dataset).map_err(|e| self.refused(e, "characters"))?;
        Ok(read
            .chunks(length)
            .map(|name| text_of(&name.iter().map(|c| c.cast_signed()).collect::<Vec<i8>>()))
            .collect())
    }

    /// The error for a dataset of the wrong length.
    pub(super) fn wrong_shape(&self, found: String, expected: String) -> Error {
        Error::Hdf5Shape { path: self.h5.path().to_owned(), object: self.name.clone(), found, expected }
    }

    /// The zero-based index that `number`, counted from `first`, stands for among `n` things.
    pub(super) fn checked_index(&self, position: usize, number: i64, first: i64, n: usize) -> Result<usize> {
        let index = number.checked_sub(first).and_then(|i| usize::try_from(i).ok()).filter(|&i| i < n);
        index.ok_or_else(|| Error::Hdf5Index {
            path: self.h5.path().to_owned(),
            dataset: self.name.clone(),
            position,
            found: number,
            first,
            last: first.saturating_add_unsigned(n as u64).saturating_sub(1),
        })
    }

    /// The zero-based indices that all its numbers, counted from `first`, stand for among `n` things.
    ///
    /// # Errors
    /// A number that stands for none of them; those of reading.
    pub(super) fn checked_indices(&self, first: i64, n: usize) -> Result<Vec<usize>> {
        let index = |(position, number): (usize, &i64)| self.checked_index(position, *number, first, n);
        self.integers()?.iter().enumerate().map(index).collect()
    }

    /// Number of values, once it is certain that the stored bytes can hold them.
    fn checked_len(&self) -> Result<usize> {
        let space = self.dataset.space().map_err(|e| self.read_error(&e))?;
        if space.is_null() {
            return Ok(0);
        }
        let shape = space.shape();
        let n_values = shape.iter().try_fold(1_usize, |n, &d| n.checked_mul(d)).filter(|&n| n == space.size());
        let item = self.dataset.dtype().map_err(|e| self.read_error(&e))?.size() as u64;
        let n_bytes = n_values.and_then(|n| (n as u64).checked_mul(item));
        if n_bytes == Some(0) {
            return Ok(0);
        }
        let ratio = self.check_storage()?;
        let available = self.dataset.storage_size().min(self.h5.n_bytes()).saturating_mul(ratio);
        let chunk = self.dataset.dcpl().and_then(|plist| plist.get_chunk()).map_err(|e| self.read_error(&e))?;
        let chunk = chunk.unwrap_or_default();
        let chunk_bytes = chunk.iter().try_fold(item, |n, &d| n.checked_mul(d as u64));
        let chunk_fits = chunk_bytes.is_some_and(|n| n <= self.h5.n_bytes().saturating_mul(ratio));
        match (n_values, n_bytes) {
            (Some(n_values), Some(n_bytes)) if n_bytes <= available && chunk_fits => {
                self.h5.hold(n_bytes.saturating_add(WIDENED * n_values as u64))?;
                Ok(n_values)
            }
            _ => {
                let promised = format!("a shape of {shape:?} in chunks of {chunk:?} with {item} bytes each");
                let (path, object) = (self.h5.path().to_owned(), self.name.clone());
                Err(Error::Hdf5Size { path, object, promised, available })
            }
        }
    }

    /// Refuses values in other files and filters whose expansion has no bound; gives the largest expansion.
    fn check_storage(&self) -> Result<u64> {
        let plist = self.dataset.dcpl().map_err(|e| self.read_error(&e))?;
        let (path, object) = (self.h5.path().to_owned(), self.name.clone());
        let layout = plist.get_layout().map_err(|e| self.read_error(&e))?;
        let external = plist.get_external().map_err(|e| self.read_error(&e))?;
        if !external.is_empty() || !matches!(layout, Layout::Compact | Layout::Contiguous | Layout::Chunked) {
            return Err(Error::Hdf5ExternalStorage { path, object });
        }
        let mut ratio = 1;
        // The binding slices by the number of parameters that the file states, and panics where there are more than 32.
        let Ok(filters) = catch_unwind(AssertUnwindSafe(|| plist.get_filters())) else {
            return Err(Error::Hdf5Filter { path, object, filter: "of more than 32 parameters".to_owned() });
        };
        for filter in filters.map_err(|e| self.read_error(&e))? {
            match filter {
                Filter::Shuffle | Filter::Fletcher32 => {}
                Filter::Deflate(_) if ratio == 1 => ratio = DEFLATE_RATIO,
                other => {
                    return Err(Error::Hdf5Filter { path, object, filter: filter_name(&other) });
                }
            }
        }
        Ok(ratio)
    }

    fn refused(&self, refusal: Refusal, expected: &'static str) -> Error {
        let (path, object) = (self.h5.path().to_owned(), self.name.clone());
        match refusal {
            Refusal::Type(found) => Error::Hdf5Type { path, object, found, expected },
            Refusal::Value(position, found, expected) => Error::Hdf5Value { path, object, position, found, expected },
            Refusal::Library(error) => self.read_error(&error),
        }
    }

    fn read_error(&self, error: &hdf5_metno::Error) -> Error {
        self.h5.read_error(&self.name, error)
    }
}

/// What a user knows a filter as.
fn filter_name(filter: &Filter) -> String {
    match filter {
        Filter::Deflate(_) => "deflate, a second time".to_owned(),
        Filter::SZip(..) => "szip".to_owned(),
        Filter::NBit => "nbit".to_owned(),
        Filter::ScaleOffset(_) => "scale-offset".to_owned(),
        Filter::User(32000, _) => "lzf".to_owned(),
        Filter::User(32001, _) => "blosc".to_owned(),
        Filter::User(32015, _) => "zstd".to_owned(),
        other => format!("{other:?}"),
    }
}

/// Characters up to a zero byte, without trailing blanks; bytes that are not UTF-8 are taken as Latin-1.
fn text_of(name: &[i8]) -> String {
    let bytes: Vec<u8> = name.iter().take_while(|&&c| c != 0).map(|&c| c.cast_unsigned()).collect();
    let text = String::from_utf8(bytes).unwrap_or_else(|e| e.as_bytes().iter().copied().map(char::from).collect());
    text.trim_end().to_owned()
}
