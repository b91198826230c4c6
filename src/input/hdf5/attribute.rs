//! Attributes: small texts and whole numbers beside a group or dataset.

use hdf5_metno::types::{FixedAscii, FixedUnicode, TypeDescriptor, VarLenAscii, VarLenUnicode};
use hdf5_metno::{Attribute, Location};

use super::file::H5;
use crate::error::{Error, Result};

/// More numbers than any attribute read here has; an attribute lives in an object header of at most 64 KiB.
const MAX_VALUES: usize = 8192;
/// Longer than any text that is compared; HDF5 cuts longer ones when it converts.
const MAX_TEXT: usize = 64;

/// The attribute of that name, if there is one.
fn find(h5: &H5, location: &Location, object: &str, name: &str) -> Result<Option<Attribute>> {
    let names = location.attr_names().map_err(|e| h5.read_error(object, &e))?;
    if !names.iter().any(|n| n == name) {
        return Ok(None);
    }
    let attribute = location.attr(name).map_err(|e| h5.read_error(object, &e))?;
    let n_values = attribute.shape().iter().try_fold(1_usize, |n, &d| n.checked_mul(d));
    if n_values.is_some_and(|n| n <= MAX_VALUES) {
        return Ok(Some(attribute));
    }
    let found = format!("shape {:?}", attribute.shape());
    let expected = format!("at most {MAX_VALUES} values in an attribute");
    Err(Error::Hdf5Shape {
        path: h5.path().to_owned(),
        object: format!("{object}@{name}"),
        found,
        expected,
    })
}

/// The text of an attribute; `None` if it is absent or no text.
pub(super) fn text(h5: &H5, location: &Location, object: &str, name: &str) -> Result<Option<String>> {
    let Some(attribute) = find(h5, location, object, name)? else {
        return Ok(None);
    };
    let Ok(descriptor) = attribute.dtype().and_then(|t| t.to_descriptor()) else {
        return Ok(None);
    };
    let first = match descriptor {
        TypeDescriptor::VarLenUnicode => first(&attribute, VarLenUnicode::as_bytes),
        TypeDescriptor::VarLenAscii => first(&attribute, VarLenAscii::as_bytes),
        TypeDescriptor::FixedAscii(_) => first(&attribute, FixedAscii::<MAX_TEXT>::as_bytes),
        TypeDescriptor::FixedUnicode(_) => first(&attribute, FixedUnicode::<MAX_TEXT>::as_bytes),
        _ => return Ok(None),
    };
    let text = first.map_err(|e| h5.read_error(&format!("{object}@{name}"), &e))?;
    Ok(text.map(|t| t.trim().to_owned()))
}

/// The whole numbers of an attribute; `None` if it is absent.
pub(super) fn integers(h5: &H5, location: &Location, object: &str, name: &str) -> Result<Option<Vec<i64>>> {
    let Some(attribute) = find(h5, location, object, name)? else {
        return Ok(None);
    };
    let object = format!("{object}@{name}");
    let read = |e: hdf5_metno::Error| h5.read_error(&object, &e);
    let descriptor = attribute.dtype().and_then(|t| t.to_descriptor()).map_err(read)?;
    match descriptor {
        TypeDescriptor::Integer(_) => attribute.read_raw::<i64>().map(Some).map_err(read),
        // A count above i64::MAX is refused by whoever compares it: HDF5 saturates.
        TypeDescriptor::Unsigned(_) => attribute.read_raw::<i64>().map(Some).map_err(read),
        other => {
            let path = h5.path().to_owned();
            Err(Error::Hdf5Type {
                path,
                object,
                found: other.to_string(),
                expected: "whole numbers",
            })
        }
    }
}

/// The first value of an attribute as text; `bytes` because a file may hold anything where it says UTF-8.
fn first<T: hdf5_metno::H5Type>(attribute: &Attribute, bytes: fn(&T) -> &[u8]) -> hdf5_metno::Result<Option<String>> {
    let values = attribute.read_raw::<T>()?;
    Ok(values.first().map(|v| String::from_utf8_lossy(bytes(v)).into_owned()))
}
