//! The elements of a file one after another.

use std::io::{BufReader, Read};
use std::path::Path;

use flate2::read::ZlibDecoder;

use super::element::{Array, Content, FORMAT, MATRIX, tag};
use crate::error::{Error, Result};
use crate::input::raw_numbers::{Endian, fill};
use crate::input::source::{Source, read_error};

/// Bytes of the head of a file.
const HEAD: usize = 128;
const COMPRESSED: u32 = 15;
const UNDAMAGED: &str = "compressed data that are not damaged";

/// What is done with an array.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    Skip,
    Stop,
}

/// The order of the bytes of a file, judged by its head; none where it is no file of level 5.
pub(super) fn endian(head: &[u8]) -> Option<Endian> {
    match head.get(HEAD - 4..HEAD)? {
        [0, 1, b'I', b'M'] => Some(Endian::Little),
        [1, 0, b'M', b'I'] => Some(Endian::Big),
        _ => None,
    }
}

/// Hands every array of a file to `each`, with its content behind its name.
pub(super) fn walk(path: &Path, mut each: impl FnMut(&Array, &mut Content<'_>) -> Result<Step>) -> Result<()> {
    let mut source = BufReader::with_capacity(1 << 16, Source::open(path)?);
    let mut head = [0; HEAD];
    let n_read = fill(&mut source, &mut head).map_err(|error| read_error(path, error))?;
    let wrong = |at: u64, found: String, expected: &str| wrong(path, at, found, expected);
    let Some(endian) = endian(&head[..n_read]) else {
        return Err(wrong(0, format!("{n_read} bytes that are no head"), "the head of a MATLAB file, 128 bytes"));
    };
    let mut at = HEAD as u64;
    loop {
        let mut bytes = [0; 8];
        let n_read = fill(&mut source, &mut bytes).map_err(|error| read_error(path, error))?;
        if n_read == 0 {
            return Ok(());
        }
        if n_read < bytes.len() {
            return Err(wrong(at, "the end of the file".to_owned(), "an element"));
        }
        let (kind, length) = tag(&bytes, endian);
        let mut part = source.by_ref().take(length.into());
        let step = match kind {
            COMPRESSED => packed((path, at, endian), &mut part, &mut each)?,
            MATRIX => {
                let mut content = Content::new(path, at, endian, Box::new(&mut part));
                visit(&mut content, &mut each)?
            }
            _ => Step::Skip,
        };
        if step == Step::Stop {
            return Ok(());
        }
        std::io::copy(&mut part, &mut std::io::sink()).map_err(|error| read_error(path, error))?;
        if part.limit() > 0 {
            return Err(wrong(at, "the end of the file".to_owned(), &format!("an element of {length} bytes")));
        }
        at += 8 + u64::from(length);
        // Elements that are not compressed end at a multiple of eight.
        let padding = if kind == COMPRESSED { 0 } else { u64::from(length).next_multiple_of(8) - u64::from(length) };
        std::io::copy(&mut source.by_ref().take(padding), &mut std::io::sink())
            .map_err(|error| read_error(path, error))?;
        at += padding;
    }
}

fn wrong(path: &Path, at: u64, found: String, expected: &str) -> Error {
    let (path, place, expected) = (path.to_owned(), format!("byte {at}"), expected.to_owned());
    Error::MatrixFormat { path, format: FORMAT, place, found, expected: expected.into() }
}

/// Hands the array in a compressed element, which begins at byte `at` of the file, to `each`.
fn packed(
    (path, at, endian): (&Path, u64, Endian),
    part: &mut impl Read,
    each: &mut impl FnMut(&Array, &mut Content<'_>) -> Result<Step>,
) -> Result<Step> {
    let damaged = |error: std::io::Error| wrong(path, at, error.to_string(), UNDAMAGED);
    let mut inflated = ZlibDecoder::new(part);
    let mut inner = [0; 8];
    let n_read = fill(&mut inflated, &mut inner).map_err(damaged)?;
    let length = match tag(&inner, endian) {
        (MATRIX, length) if n_read == inner.len() => length,
        (other, _) => return Err(wrong(path, at, format!("a compressed element of type {other}"), "a matrix")),
    };
    let mut content = Content::new(path, at, endian, Box::new(inflated.by_ref().take(length.into())));
    let step = visit(&mut content, each)?;
    if step == Step::Stop {
        // The checksum stands behind what is packed, and is compared where that ends.
        content.skip()?;
        if fill(&mut inflated, &mut [0]).map_err(damaged)? > 0 {
            return Err(wrong(path, at, "more than its one array".to_owned(), UNDAMAGED));
        }
    }
    Ok(step)
}

/// Hands an array to `each`, or the fields of a struct by their names behind that of the struct. Structs in structs are left out.
fn visit(content: &mut Content<'_>, each: &mut impl FnMut(&Array, &mut Content<'_>) -> Result<Step>) -> Result<Step> {
    let array = Array::read(content)?;
    if !array.is_struct() {
        return each(&array, content);
    }
    for name in content.field_names(&array)? {
        let Some(mut field) = content.field(&array, &name)? else { continue };
        let mut of_field = Array::read(&mut field)?;
        of_field.name = format!("{}.{name}", array.name);
        if each(&of_field, &mut field)? == Step::Stop {
            return Ok(Step::Stop);
        }
        field.skip()?;
    }
    Ok(Step::Skip)
}
