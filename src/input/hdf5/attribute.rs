//! Attributes: whole numbers attached to a group or dataset.
//!
//! Texts are not read. Most programs write them with variable length, which puts them into the global heap of the file,
//! and a damaged heap makes the library loop for ever or read beyond its buffers. No format needs them: members and shapes
//! tell as much.

use hdf5_metno::{Attribute, Location};

use super::file::H5;
use super::numbers::{self, Refusal};
use crate::error::{Error, Result};

/// More numbers than any attribute read here has; an attribute lives in an object header of at most 64 KiB.
const MAX_VALUES: usize = 8192;

/// The attribute of that name, if there is one.
fn find(h5: &H5, location: &Location, object: &str, name: &str) -> Result<Option<Attribute>> {
    let names = location.attr_names().map_err(|e| h5.read_error(object, &e))?;
    if !names.iter().any(|n| n == name) {
        return Ok(None);
    }
    let attribute = location.attr(name).map_err(|e| h5.read_error(object, &e))?;
    let shape = attribute.get_shape().map_err(|e| h5.read_error(object, &e))?;
    let n_values = shape.iter().try_fold(1_usize, |n, &d| n.checked_mul(d));
    if n_values.is_some_and(|n| n <= MAX_VALUES) {
        return Ok(Some(attribute));
    }
    let found = format!("shape {shape:?}");
    let expected = format!("at most {MAX_VALUES} values in an attribute");
    Err(Error::Hdf5Shape { path: h5.path().to_owned(), object: format!("{object}@{name}"), found, expected })
}

/// The whole numbers of an attribute; `None` if it is absent.
pub(super) fn integers(h5: &H5, location: &Location, object: &str, name: &str) -> Result<Option<Vec<i64>>> {
    let Some(attribute) = find(h5, location, object, name)? else {
        return Ok(None);
    };
    numbers::integers(&attribute).map(Some).map_err(|refusal| {
        let object = format!("{object}@{name}");
        match refusal {
            Refusal::Type(found) => {
                Error::Hdf5Type { path: h5.path().to_owned(), object, found, expected: "whole numbers" }
            }
            Refusal::Value(position, found, expected) => {
                Error::Hdf5Value { path: h5.path().to_owned(), object, position, found, expected }
            }
            Refusal::Library(error) => h5.read_error(&object, &error),
        }
    })
}
