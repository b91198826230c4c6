//! Arrays, and the numbers in their parts.

use std::io::Read;
use std::path::Path;

use crate::error::{Error, Result};
use crate::input::indices::Indices;
use crate::input::raw_numbers::{self, Endian, Failure, Kind, fill};

/// What messages call the format.
pub(super) const FORMAT: &str = "MATLAB level 5";
/// The most bytes of dimensions and names.
const MAX_SHORT: u32 = 1 << 14;
/// The longest name of a field.
const MAX_FIELD_NAME: usize = 64;
/// Type of an array.
pub(super) const MATRIX: u32 = 14;
/// Marks among the flags of an array.
const COMPLEX: u32 = 0x0800;
const LOGICAL: u32 = 0x0200;

/// Type and length of the element of these eight bytes, which may hold its content in the last four.
pub(super) fn tag(bytes: &[u8; 8], endian: Endian) -> (u32, u32) {
    let (first, second) = words(bytes, endian);
    if first >> 16 == 0 { (first, second) } else { (first & 0xffff, first >> 16) }
}

fn words(bytes: &[u8; 8], endian: Endian) -> (u32, u32) {
    let word = |at: usize| {
        let bytes = [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
        if endian == Endian::Little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) }
    };
    (word(0), word(4))
}

/// How the numbers of an element of this type are stored.
fn kind_of(element: u32) -> Option<Kind> {
    Some(match element {
        1 => Kind::I8,
        2 => Kind::U8,
        3 => Kind::I16,
        4 => Kind::U16,
        5 => Kind::I32,
        6 => Kind::U32,
        7 => Kind::F32,
        9 => Kind::F64,
        12 => Kind::I64,
        13 => Kind::U64,
        _ => return None,
    })
}

/// What an array is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    Sparse,
    Double,
    Single,
    Whole,
    Other(u32),
}

impl Class {
    fn of(number: u32) -> Self {
        match number {
            5 => Self::Sparse,
            6 => Self::Double,
            7 => Self::Single,
            8..=15 => Self::Whole,
            other => Self::Other(other),
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Sparse => "sparse",
            Self::Double => "double",
            Self::Single => "single",
            Self::Whole => "whole numbers",
            Self::Other(1) => "a cell array",
            Self::Other(2) => "a struct",
            Self::Other(4) => "text",
            Self::Other(_) => "an object",
        }
    }

    /// Digits that its values have room for.
    pub(super) fn digits(self) -> u32 {
        if self == Self::Single { Kind::F32.digits() } else { u32::MAX }
    }
}

/// An array up to its name.
pub(super) struct Array {
    pub(super) name: String,
    pub(super) class: Class,
    pub(super) shape: [u64; 2],
    n_dimensions: usize,
    flags: u32,
}

impl Array {
    pub(super) fn read(content: &mut Content<'_>) -> Result<Self> {
        let flags = content.short("flags")?;
        let flags = flags.first().copied().unwrap_or_default() as u32;
        let class = Class::of(flags & 0xff);
        // An object of later versions has no dimensions.
        let is_opaque = flags & 0xff == 17;
        let dimensions = if is_opaque { Vec::new() } else { content.short("dimensions")? };
        let name = content.short("name")?;
        let size = |at: usize| dimensions.get(at).and_then(|size| u64::try_from(*size).ok()).unwrap_or(0);
        let name = name.iter().filter_map(|byte| u8::try_from(*byte).ok()).map(char::from).collect();
        Ok(Self { name, class, shape: [size(0), size(1)], n_dimensions: dimensions.len(), flags })
    }

    /// Whether it can be a matrix of a model: numbers of two dimensions, as many rows as columns.
    pub(super) fn is_matrix(&self) -> bool {
        let is_square = self.shape[0] == self.shape[1] && (self.shape[0] > 0 || self.class == Class::Sparse);
        self.is_table() && is_square
    }

    /// Whether it is numbers of two dimensions.
    pub(super) fn is_table(&self) -> bool {
        !matches!(self.class, Class::Other(_)) && self.n_dimensions == 2
    }

    /// Whether it is one number, as they lie next to matrices in most files.
    pub(super) fn is_single(&self) -> bool {
        self.shape == [1, 1] && self.class != Class::Sparse
    }

    /// Whether it is one struct, whose fields follow.
    pub(super) fn is_struct(&self) -> bool {
        self.class == Class::Other(2) && self.shape == [1, 1] && self.n_dimensions == 2
    }

    /// Why it cannot be read, where that is not its size.
    pub(super) fn unread(&self) -> Option<&'static str> {
        match self.class {
            Class::Other(_) => Some(self.class.name()),
            _ if self.flags & COMPLEX != 0 => Some("a complex matrix"),
            _ if self.flags & LOGICAL != 0 => Some("a matrix of true and false"),
            _ => None,
        }
    }
}

/// The content of an array, read part by part.
pub(super) struct Content<'a> {
    path: &'a Path,
    /// Where the array begins in the file.
    at: u64,
    endian: Endian,
    source: Box<dyn Read + 'a>,
}

impl<'a> Content<'a> {
    pub(super) fn new(path: &'a Path, at: u64, endian: Endian, source: Box<dyn Read + 'a>) -> Self {
        Self { path, at, endian, source }
    }

    fn error(&self, part: &str, found: String, expected: &str) -> Error {
        let (path, expected) = (self.path.to_owned(), expected.to_owned());
        Error::MatrixFormat {
            path,
            format: FORMAT,
            place: format!("{part} of the array at byte {}", self.at),
            found,
            expected: expected.into(),
        }
    }

    fn exactly<const N: usize>(&mut self, part: &str) -> Result<[u8; N]> {
        let mut bytes = [0; N];
        match fill(&mut self.source, &mut bytes) {
            Ok(n_read) if n_read == N => Ok(bytes),
            Ok(_) => Err(self.error(part, "the end of the array".to_owned(), "more of it")),
            Err(error) => Err(self.error(part, error.to_string(), "compressed data that are whole")),
        }
    }

    /// The numbers of the next part, as `read` takes them from their bytes.
    fn part<T>(
        &mut self,
        part: &str,
        read: impl FnOnce(&mut dyn Read, (Kind, Endian), u64) -> std::result::Result<T, Failure>,
    ) -> Result<(T, Kind)> {
        let bytes: [u8; 8] = self.exactly(part)?;
        let (element, length) = tag(&bytes, self.endian);
        let Some(kind) = kind_of(element) else {
            return Err(self.error(part, format!("an element of type {element}"), "numbers"));
        };
        let n = u64::from(length) / kind.size() as u64;
        let stored = (kind, self.endian);
        let is_small = words(&bytes, self.endian).0 >> 16 != 0;
        let outcome = if is_small {
            if length > 4 {
                return Err(self.error(part, format!("{length} bytes in a small element"), "four at most"));
            }
            read(&mut &bytes[4..4 + length as usize], stored, n)
        } else {
            read(&mut self.source, stored, n)
        };
        let values = outcome.map_err(|failure| match failure {
            Failure::Refused(error) => *error,
            Failure::Cut(n) => self.error(part, format!("the end of the array after {n} numbers"), "more of them"),
            Failure::Value(at) => self.error(part, format!("a number at {at} that cannot be kept"), "another one"),
            Failure::Read(error) => self.error(part, error.to_string(), "data that are whole"),
        })?;
        if !is_small {
            let n_padding = (u64::from(length).next_multiple_of(8) - n * kind.size() as u64) as usize;
            let mut padding = [0; 16];
            // The last part of a compressed array may go without.
            fill(&mut self.source, &mut padding[..n_padding])
                .map_err(|error| self.error(part, error.to_string(), "data that are whole"))?;
        }
        Ok((values, kind))
    }

    /// Names of the fields of a struct.
    pub(super) fn field_names(&mut self, array: &Array) -> Result<Vec<String>> {
        let part = format!("{} names of fields", array.name);
        let length = self.short(&part)?.first().and_then(|length| usize::try_from(*length).ok()).unwrap_or(0);
        if !(1..=MAX_FIELD_NAME).contains(&length) {
            return Err(self.error(&part, format!("names of {length} characters"), "64 at most"));
        }
        let names = self.short(&part)?;
        let text = |name: &[i64]| {
            name.iter()
                .take_while(|byte| **byte != 0)
                .filter_map(|byte| u8::try_from(*byte).ok())
                .map(char::from)
                .collect()
        };
        Ok(names.chunks(length).map(text).collect())
    }

    /// The content of the next field of a struct; none where it is empty.
    pub(super) fn field(&mut self, array: &Array, name: &str) -> Result<Option<Content<'_>>> {
        let part = format!("{}.{name}", array.name);
        let bytes: [u8; 8] = self.exactly(&part)?;
        match tag(&bytes, self.endian) {
            (MATRIX, 0) => Ok(None),
            (MATRIX, length) => {
                let source: Box<dyn Read + '_> = Box::new((&mut self.source).take(length.into()));
                Ok(Some(Content { path: self.path, at: self.at, endian: self.endian, source }))
            }
            (other, _) => Err(self.error(&part, format!("an element of type {other}"), "an array")),
        }
    }

    /// Goes over what is left.
    pub(super) fn skip(mut self) -> Result<()> {
        let skipped = std::io::copy(&mut self.source, &mut std::io::sink());
        skipped.map(drop).map_err(|error| self.error("the rest", error.to_string(), "data that are whole"))
    }

    /// A part of few whole numbers.
    fn short(&mut self, part: &str) -> Result<Vec<i64>> {
        let numbers = self.part(part, |mut source, stored, n| {
            if n * stored.0.size() as u64 > u64::from(MAX_SHORT) {
                return Err(Failure::Cut(0));
            }
            raw_numbers::wholes(&mut source, stored, n)
        })?;
        Ok(numbers.0)
    }

    /// A part of whole numbers.
    pub(super) fn wholes(&mut self, array: &Array, part: &str) -> Result<Vec<i64>> {
        let part = format!("{} {part}", array.name);
        Ok(self.part(&part, |mut source, stored, n| raw_numbers::wholes(&mut source, stored, n))?.0)
    }

    /// A part of indices.
    pub(super) fn indices(&mut self, array: &Array, part: &str) -> Result<Indices> {
        let part = format!("{} {part}", array.name);
        Ok(self.part(&part, |mut source, stored, n| raw_numbers::indices(&mut source, stored, n))?.0)
    }

    /// A part of real numbers, and the digits that they have room for.
    pub(super) fn reals(&mut self, array: &Array, part: &str) -> Result<(Vec<f64>, u32)> {
        let part = format!("{} {part}", array.name);
        let (values, kind) = self.part(&part, |mut source, stored, n| raw_numbers::reals(&mut source, stored, n))?;
        Ok((values, kind.digits()))
    }

    /// Hands the real numbers of a part to `take`, which must be so many; the digits that they have room for.
    pub(super) fn each_real(
        &mut self,
        array: &Array,
        expected: u64,
        mut take: impl FnMut(u64, f64) -> Result<()>,
    ) -> Result<u32> {
        let (n, kind) = self.part(&array.name, |mut source, stored, n| {
            // More numbers than the dimensions say have no place.
            let n_taken = n.min(expected);
            raw_numbers::each_real(&mut source, stored, n_taken, |at, value| {
                take(at, value).map_err(|error| Failure::Refused(Box::new(error)))
            })?;
            Ok(n)
        })?;
        if n != expected {
            return Err(self.error(&array.name, format!("{n} numbers"), &format!("{expected}, as its dimensions say")));
        }
        Ok(kind.digits())
    }
}
