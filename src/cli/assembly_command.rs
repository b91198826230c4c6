//! What was typed of an assembly, checked: components, and what joins, holds and loads them.

use std::path::{Path, PathBuf};

use super::superelement_flags::AssemblyFlags;
use crate::assembly::PointMass;
use crate::error::{Error, Result};

/// Squares of masses and frequencies are multiplied with those of others.
const LARGEST: f64 = 1e100;

/// An assembly to be made.
#[derive(Debug)]
pub(super) struct AssemblyCommand {
    /// Each with its name in the assembly.
    pub(super) components: Vec<(String, PathBuf)>,
    /// Pairs of selections.
    pub(super) joins: Vec<(String, String)>,
    pub(super) fixes: Vec<String>,
    pub(super) masses: Vec<(String, PointMass)>,
}

impl AssemblyCommand {
    /// # Errors
    /// [`Error::FlagText`] for text that a flag cannot have, [`Error::JobNumber`] for a mass out of range.
    pub(super) fn build(files: &[String], flags: AssemblyFlags) -> Result<Self> {
        let AssemblyFlags { join, fix, mass } = flags;
        Ok(Self {
            components: files.iter().map(|text| component(text)).collect(),
            joins: join.iter().map(|text| joined(text)).collect::<Result<_>>()?,
            fixes: fix,
            masses: mass.iter().map(|text| loaded(text)).collect::<Result<_>>()?,
        })
    }
}

/// NAME=FILE, or a file, whose name without its extension is that of the component. A file with such a name of its own is a file.
fn component(text: &str) -> (String, PathBuf) {
    match text.split_once('=') {
        Some((name, path)) if !name.is_empty() && !Path::new(text).exists() => (name.to_owned(), path.into()),
        _ => {
            let path = PathBuf::from(text);
            let stem = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
            (stem, path)
        }
    }
}

/// Two interfaces of one text.
pub(super) fn joined(text: &str) -> Result<(String, String)> {
    let expected = "two interfaces, as in a.hub=b.pin";
    match text.split_once('=') {
        Some((a, b)) if !a.is_empty() && !b.is_empty() => Ok((a.to_owned(), b.to_owned())),
        _ => Err(Error::FlagText { flag: "--join", text: text.to_owned(), expected }),
    }
}

/// NODE=MASS or NODE=MASS,IXX,IYY,IZZ.
fn loaded(text: &str) -> Result<(String, PointMass)> {
    let wrong = || Error::FlagText {
        flag: "--mass",
        text: text.to_owned(),
        expected: "an interface and a mass, as in a.tip=2.5, or with moments of inertia, a.tip=2.5,0.1,0.1,0.2",
    };
    let (place, numbers) = text.rsplit_once('=').filter(|(place, _)| !place.is_empty()).ok_or_else(wrong)?;
    let numbers: Option<Vec<f64>> = numbers.split(',').map(|number| number.trim().parse().ok()).collect();
    let key = format!("--mass {place}");
    let range = "zero or more, and at most 1e100";
    let numbers = numbers.ok_or_else(wrong)?.into_iter().map(|number| in_range(&key, number, range));
    match numbers.collect::<Result<Vec<f64>>>()?[..] {
        [mass] => Ok((place.to_owned(), PointMass { mass, inertia: [0.0; 3] })),
        [mass, x, y, z] => Ok((place.to_owned(), PointMass { mass, inertia: [x, y, z] })),
        _ => Err(wrong()),
    }
}

/// A number that a key or flag may have.
pub(super) fn in_range(key: &str, value: f64, expected: &'static str) -> Result<f64> {
    let is_in_range = (0.0..=LARGEST).contains(&value);
    if is_in_range { Ok(value) } else { Err(Error::JobNumber { key: key.to_owned(), value, expected }) }
}
