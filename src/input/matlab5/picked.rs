//! Which of the arrays of a file is meant.

use std::path::Path;

use super::element::{Array, Content, FORMAT};
use super::file::{Step, walk};
use crate::error::{Error, Result};
use crate::input::MatrixRole;
use crate::input::named::chosen;

const EXPECTED: &str = "real matrices, sparse or of numbers, at the top level of the file or in a struct";

/// Whether an array may be the one that is meant.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Candidate {
    Matrix,
    /// Where the file has no other.
    LastResort,
    None,
}

/// What `take` makes of the array of this name, or without one of the only one that may be meant.
///
/// # Errors
/// [`Error::MatrixNone`]; [`Error::MatrixUnread`]; those of [`chosen`], of reading the file and of `take`.
pub(super) fn picked<T>(
    path: &Path,
    (member, role): (Option<&str>, MatrixRole),
    candidate: impl Fn(&Array) -> Candidate,
    mut take: impl FnMut(&Array, &mut Content<'_>) -> Result<T>,
) -> Result<T> {
    let (mut names, mut last_resorts, mut others, mut position) = (Vec::new(), Vec::new(), Vec::new(), 0);
    walk(path, |array, _| {
        let name = || array.name.clone();
        match (array.unread(), candidate(array)) {
            (None, Candidate::Matrix) => names.push((position, name())),
            (None, Candidate::LastResort) => last_resorts.push((position, name())),
            (Some(found), _) if member == Some(&array.name) => {
                let (path, place, found) = (path.to_owned(), name(), found.to_owned());
                return Err(Error::MatrixUnread { path, format: FORMAT, place, found, expected: EXPECTED });
            }
            (unread, _) => others.push(format!("{} ({})", array.name, unread.unwrap_or_else(|| array.class.name()))),
        }
        position += 1;
        Ok(Step::Skip)
    })?;
    // A model of one row has no larger matrix.
    let names = if names.is_empty() { last_resorts } else { names };
    if names.is_empty() {
        return Err(Error::MatrixNone { path: path.to_owned(), format: FORMAT, holds: others, expected: EXPECTED });
    }
    let listed: Vec<&str> = names.iter().map(|(_, name)| name.as_str()).collect();
    let wanted = names[chosen(path, &listed, member, role)?].0;
    let (mut position, mut found) = (0, None);
    walk(path, |array, content| {
        position += 1;
        if position - 1 < wanted {
            return Ok(Step::Skip);
        }
        found = Some(take(array, content)?);
        Ok(Step::Stop)
    })?;
    found.ok_or_else(|| Error::Changed { path: path.to_owned() })
}
