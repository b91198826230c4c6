//! Matrices in the HDF5 database of MSC Nastran: `/NASTRAN/RESULT/MATRIX/GENERAL` has a table of matrices, one of columns and one of
//! entries, in which all matrices follow one another.

use super::convention::Told;
use super::group::Group;
use super::nastran_records::{Column, Entry, Identity};
use crate::error::{Error, Result};
use crate::input::MatrixRole;
use crate::input::compressed::{Compressed, Major};
use crate::input::named::chosen;

/// FORM of a symmetric matrix, of which a table may have both triangles or one.
const SYMMETRIC: i64 = 6;
const PLACE: &str = "NASTRAN/RESULT/MATRIX/GENERAL";

/// The tables of matrices, where a file has them.
pub(super) fn tables<'a>(root: &Group<'a>) -> Result<Option<Group<'a>>> {
    let Some(group) = root.find_group(PLACE)? else { return Ok(None) };
    Ok(group.find_dataset("IDENTITY")?.map(|_| group))
}

/// The matrix that is wanted, by name or role, its name, and what the table says of it.
pub(super) fn read(group: &Group<'_>, wanted: Option<&str>, role: MatrixRole) -> Result<(Compressed, String, Told)> {
    let path = group.h5().path();
    let identities: Vec<Identity> = group.dataset("IDENTITY")?.records_with_text()?;
    let names: Vec<String> = identities.iter().map(|identity| identity.name.as_str().trim().to_owned()).collect();
    let listed: Vec<&str> = names.iter().map(String::as_str).collect();
    let wanted = wanted.map(|name| name.trim_start_matches('/'));
    let at = chosen(path, &listed, wanted, role)?;
    let (identity, name) = (&identities[at], names[at].clone());
    let columns: Vec<Column> = group.dataset("COLUMN")?.records()?;
    let entries: Vec<Entry> = group.dataset("DATA")?.records()?;
    let outside = |what: &str| Error::MatrixFormat {
        path: path.to_owned(),
        format: "MSC Nastran",
        place: format!("{name} in {}", group.child_name("IDENTITY")),
        found: format!("{what} beyond the end of its table"),
        expected: "a matrix that lies within the tables".into(),
    };
    let part = |first: i64, n: i64, length: usize| {
        let (first, n) = (usize::try_from(first).ok()?, usize::try_from(n).ok()?);
        first.checked_add(n).filter(|end| *end <= length).map(|end| first..end)
    };
    let own = part(identity.first_column, identity.columns, columns.len()).ok_or_else(|| outside("columns"))?;
    let data = part(identity.first_entry, identity.n_entries, entries.len()).ok_or_else(|| outside("entries"))?;
    let pointers = columns[own].iter().map(|column| column.position.saturating_sub(identity.first_entry));
    let pointers: Vec<i64> = pointers.chain([identity.n_entries]).collect();
    let indices = entries[data.clone()].iter().map(|entry| entry.row).collect();
    let values = entries[data].iter().map(|entry| entry.value).collect();
    let parts = ["COLUMN", "DATA", "DATA"].map(|table| format!("{} of {name}", group.child_name(table)));
    let count = |number: i64| u64::try_from(number).unwrap_or(u64::MAX);
    let shape = [count(identity.rows), count(identity.columns)];
    let told = if identity.form == SYMMETRIC { Told::Symmetric } else { Told::Columns };
    Ok((Compressed::new(Major::Columns, shape, pointers, indices, values, parts), name, told))
}
