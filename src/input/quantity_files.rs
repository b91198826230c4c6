//! Quantities that follow from displacements: the rows of a recovery matrix, and a table of their names.
//!
//! ```text
//! R    m × n    a row for each quantity, a column for each row of the matrices: Matrix Market, `coordinate` or `array`
//! ```

use std::collections::HashMap;
use std::path::Path;

use supel_runtime::Quantity;

use super::allowance::{Allowance, Claim};
use super::rectangular::{Content, RectangularFile};
use super::table::{Table, open_first_line};
use crate::error::{Error, Result};
use crate::job::QuantitiesJob;
use crate::regular_file::{digest, unchanged};

/// Bytes of an entry: its row, its column and its value.
const ENTRY: u64 = 16;
/// Bytes of a name and a unit with what tells it from others.
const NAME: u64 = 128;
/// Entries and names after which their memory is claimed.
const PER_CLAIM: usize = 1 << 8;

/// Rows of quantities as they were read.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantityRows {
    /// What each row is.
    pub names: Vec<Quantity>,
    /// Entries of R other than zero: quantity and row of the files, both from zero, and value.
    pub entries: Vec<(u32, u32, f64)>,
    /// BLAKE3 digests of the files of R and of the names, lower-case hexadecimal.
    pub digests: [String; 2],
}

/// Reads the files of the quantities of a job; `n_rows` are the rows of K and M as they are in their files.
///
/// # Errors
/// Files that cannot be read or are no Matrix Market file and no table; [`Error::QuantitySize`] where R has another size than names and
/// matrices; [`Error::QuantityName`] where a row has no name of its own; [`Error::MemoryRead`]; [`Error::Changed`].
pub fn quantity_rows(job: &QuantitiesJob, n_rows: usize, allowance: &Allowance) -> Result<QuantityRows> {
    let of_names = unchanged(&job.names, || Ok((names(&job.names, allowance)?, digest(&job.names)?)));
    let (names, of_names) = of_names?;
    let content = Content::Quantities { n_names: names.len(), n_rows };
    let (entries, of_matrix) = unchanged(&job.matrix, || matrix(&job.matrix, content, &allowance.claim(&job.matrix)))?;
    Ok(QuantityRows { names, entries, digests: [of_matrix, of_names] })
}

const EXPECTED: &str = "a header with the column name, and unit where there is one";

fn names(path: &Path, allowance: &Allowance) -> Result<Vec<Quantity>> {
    let claim = allowance.claim(path);
    let mut table = Table::new(path, open_first_line(path, EXPECTED)?);
    let name_column = table.require("name", EXPECTED, |name| name == "name")?;
    let unit_column = table.find(|name| name == "unit");
    let mut lines: HashMap<String, u64> = HashMap::new();
    let mut names = Vec::new();
    while let Some(row) = table.next_row()? {
        let name = row.text(name_column).to_owned();
        let unit = unit_column.map_or_else(String::new, |column| row.text(column).to_owned());
        let line = row.line;
        if name.is_empty() {
            return Err(Error::QuantityName { path: path.to_owned(), line, found: "no name".to_owned() });
        }
        if let Some(first) = lines.insert(name.clone(), line) {
            let found = format!("`{name}` again, first at line {first}");
            return Err(Error::QuantityName { path: path.to_owned(), line, found });
        }
        if names.len().is_multiple_of(PER_CLAIM) {
            claim.add(NAME * PER_CLAIM as u64)?;
        }
        names.push(Quantity { name, unit });
    }
    if names.is_empty() {
        return Err(Error::NoData { path: path.to_owned(), expected: "a row for each quantity below the header" });
    }
    Ok(names)
}

type Entries = Vec<(u32, u32, f64)>;

fn matrix(path: &Path, content: Content<'_>, claim: &Claim<'_>) -> Result<(Entries, String)> {
    let file = RectangularFile::open(path, content)?;
    let mut entries = Vec::new();
    let digest = file.read(|entry| {
        if entry.value != 0.0 {
            if entries.len().is_multiple_of(PER_CLAIM) {
                claim.add(ENTRY * PER_CLAIM as u64)?;
            }
            entries.push((entry.row as u32, entry.column as u32, entry.value));
        }
        Ok(())
    })?;
    Ok((entries, digest))
}
