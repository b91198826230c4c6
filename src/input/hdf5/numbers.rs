//! Numbers of a dataset or attribute, converted here and not by the library.
//!
//! Its conversions trust the bit layout that a file states for a type, and a damaged one makes them write past their
//! buffers. So values are read only where the type is exactly one of this machine's, or of the few others that are known bit by bit, and
//! widened afterwards.

use std::io::Cursor;

use hdf5_metno::types::{FixedAscii, FloatSize, IntSize, TypeDescriptor};
use hdf5_metno::{Container, Datatype, H5Type};

use super::file::is_out_of_memory;
use super::other_types;
use crate::input::raw_numbers::{self, Endian, Failure, Kind};

/// Decimal digits of a 32-bit float.
const DIGITS_F32: u32 = 7;
/// Decimal digits of a 64-bit float.
const DIGITS_F64: u32 = 17;

/// Why numbers could not be read.
pub(super) enum Refusal {
    /// The type, in words.
    Type(String),
    /// A value that would become another one: its position, itself, and what could be read.
    Value(usize, String, &'static str),
    Library(hdf5_metno::Error),
}

/// Real numbers and the decimal digits their storage carries.
pub(super) struct Reals {
    pub(super) values: Vec<f64>,
    pub(super) digits: u32,
}

/// All values as real numbers, in storage order.
pub(super) fn reals(container: &Container) -> Result<Reals, Refusal> {
    if let Some(stored) = of_other_type(container)? {
        let (values, digits) = (unlike(container, stored, raw_numbers::reals)?, stored.0.digits().min(DIGITS_F64));
        return Ok(Reals { values, digits });
    }
    let (values, digits) = match descriptor(container)? {
        TypeDescriptor::Float(FloatSize::U8) => (read::<f64>(container)?, DIGITS_F64),
        TypeDescriptor::Float(FloatSize::U4) => (widened::<f32, f64>(container)?, DIGITS_F32),
        _ => (exact(&integers(container)?)?, DIGITS_F64),
    };
    Ok(Reals { values, digits })
}

/// Whole numbers as the doubles that equal them.
fn exact(integers: &[i64]) -> Result<Vec<f64>, Refusal> {
    let equals = |integer: i64| integer as f64 as i128 == i128::from(integer);
    match integers.iter().position(|&integer| !equals(integer)) {
        Some(position) => Err(Refusal::Value(
            position,
            integers[position].to_string(),
            "real numbers, or whole ones that a double equals",
        )),
        None => Ok(integers.iter().map(|&integer| integer as f64).collect()),
    }
}

/// All values as whole numbers, in storage order.
pub(super) fn integers(container: &Container) -> Result<Vec<i64>, Refusal> {
    if let Some(stored) = of_other_type(container)?.filter(|(kind, _)| kind.is_whole()) {
        return unlike(container, stored, raw_numbers::wholes);
    }
    match descriptor(container)? {
        TypeDescriptor::Integer(IntSize::U1) => widened::<i8, i64>(container),
        TypeDescriptor::Integer(IntSize::U2) => widened::<i16, i64>(container),
        TypeDescriptor::Integer(IntSize::U4) => widened::<i32, i64>(container),
        TypeDescriptor::Integer(IntSize::U8) => read::<i64>(container),
        TypeDescriptor::Unsigned(IntSize::U1) => widened::<u8, i64>(container),
        TypeDescriptor::Unsigned(IntSize::U2) => widened::<u16, i64>(container),
        TypeDescriptor::Unsigned(IntSize::U4) => widened::<u32, i64>(container),
        TypeDescriptor::Unsigned(IntSize::U8) => {
            let values = read::<u64>(container)?;
            if let Some(position) = values.iter().position(|value| i64::try_from(*value).is_err()) {
                return Err(Refusal::Value(position, values[position].to_string(), "whole numbers below 2^63"));
            }
            Ok(values.into_iter().map(u64::cast_signed).collect())
        }
        other => Err(Refusal::Type(other.to_string())),
    }
}

/// How numbers are stored that are not as this machine's.
fn of_other_type(container: &Container) -> Result<Option<(Kind, Endian)>, Refusal> {
    Ok(other_types::stored_as(&container.dtype().map_err(Refusal::Library)?))
}

/// All values of another type, as `taken` makes them of their bytes.
fn unlike<T>(
    container: &Container,
    stored: (Kind, Endian),
    taken: impl FnOnce(&mut Cursor<Vec<u8>>, (Kind, Endian), u64) -> Result<Vec<T>, Failure>,
) -> Result<Vec<T>, Refusal> {
    let mut bytes = Cursor::new(other_types::bytes(container).map_err(Refusal::Library)?);
    let (size, n_bytes) = (stored.0.size(), bytes.get_ref().len());
    taken(&mut bytes, stored, (n_bytes / size) as u64).map_err(|failure| match failure {
        Failure::Value(position) => {
            let position = position as usize;
            let number: String =
                bytes.get_ref()[position * size..].iter().take(size).map(|byte| format!("{byte:02x}")).collect();
            Refusal::Value(position, format!("bytes {number}"), "numbers that a double equals, whole ones below 2^63")
        }
        Failure::Cut(_) | Failure::Read(_) | Failure::Refused(_) => Refusal::Library("the values end too soon".into()),
    })
}

/// All values of exactly this type.
pub(super) fn read<T: H5Type>(container: &Container) -> Result<Vec<T>, Refusal> {
    let datatype = container.dtype().map_err(Refusal::Library)?;
    if !datatype.is::<T>() {
        let words = datatype.to_descriptor().map_or_else(|e| e.to_string(), |d| d.to_string());
        return Err(Refusal::Type(format!("{words} in another byte order or bit layout than this machine's")));
    }
    container.as_reader().no_convert().read_raw::<T>().map_err(Refusal::Library)
}

/// All values of a type of one byte each that is a character. Only the library knows whether a zero ends or fills up a text; of one byte it
/// has nothing to convert beyond that byte.
pub(super) fn characters(container: &Container) -> Result<Vec<u8>, Refusal> {
    let datatype = container.dtype().map_err(Refusal::Library)?;
    if datatype.size() != 1 {
        return Err(Refusal::Type(format!("characters of {} bytes", datatype.size())));
    }
    let values = container.as_reader().read_raw::<FixedAscii<1>>().map_err(Refusal::Library)?;
    Ok(values.iter().map(|value| value.as_bytes().first().copied().unwrap_or(0)).collect())
}

/// All values of this type, of whose texts the library alone knows how they end: every number must be one of this machine's.
pub(super) fn read_with_text<T: H5Type>(container: &Container) -> Result<Vec<T>, Refusal> {
    let datatype = container.dtype().map_err(Refusal::Library)?;
    let found = described(&datatype)?;
    if found != T::type_descriptor() || datatype.size() != size_of::<T>() {
        return Err(Refusal::Type(found.to_string()));
    }
    container.as_reader().read_raw::<T>().map_err(Refusal::Library)
}

/// The type of the values.
pub(super) fn descriptor(container: &Container) -> Result<TypeDescriptor, Refusal> {
    let datatype = container.dtype().map_err(Refusal::Library)?;
    described(&datatype)
}

fn described(datatype: &Datatype) -> Result<TypeDescriptor, Refusal> {
    let refusal =
        |e: hdf5_metno::Error| if is_out_of_memory(&e) { Refusal::Library(e) } else { Refusal::Type(e.to_string()) };
    datatype.to_descriptor().map_err(refusal)
}

fn widened<T: H5Type, U: From<T>>(container: &Container) -> Result<Vec<U>, Refusal> {
    Ok(read::<T>(container)?.into_iter().map(U::from).collect())
}
