//! Tables of states: a column for each coordinate of a superelement in any order, a row for each state, and times where they are known.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::table::{Table, open_first_line};
use crate::error::{Error, Result};
use crate::job::nearest;

const EXPECTED: &str = "a header of the coordinates and a row for each state";
/// The column of the times.
const TIME: &str = "time";

/// A table of states being read, its header taken.
pub struct StateTable {
    path: PathBuf,
    table: Table,
    /// The column of each coordinate.
    columns: Vec<usize>,
    time: Option<usize>,
}

/// Where a state stands in its table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateRow {
    /// Line number in the file, from 1.
    pub line: u64,
    /// Its time, where the table has a column for that.
    pub time: Option<f64>,
}

impl StateTable {
    /// Opens a table, plain or gzipped, for coordinates of these names. Instead of its name a coordinate may have its number, q1 to qr.
    ///
    /// # Errors
    /// A file that cannot be read or has no header; [`Error::StateColumn`] where a coordinate has no column, a column no coordinate, or
    /// one of them stands twice.
    pub fn open(path: &Path, names: &[String]) -> Result<Self> {
        let table = Table::new(path, open_first_line(path, EXPECTED)?);
        let wrong = |found: String, suggestion: Option<String>| {
            Err(Error::StateColumn { path: path.to_owned(), found, n: names.len(), suggestion })
        };
        let numbers: Vec<String> = (1..=names.len()).map(|number| format!("q{number}")).collect();
        let mut known: HashMap<&str, usize> = numbers.iter().map(String::as_str).zip(0..).collect();
        known.extend(names.iter().map(String::as_str).zip(0..));
        let (mut of_coordinate, mut time) = (vec![None; names.len()], None);
        for (column, name) in table.header().iter().enumerate() {
            let place = match known.get(name.as_str()) {
                Some(&coordinate) => &mut of_coordinate[coordinate],
                None if name.eq_ignore_ascii_case(TIME) => &mut time,
                None => {
                    let names: Vec<&str> = names.iter().map(String::as_str).collect();
                    return wrong(format!("column `{name}`, which is no coordinate"), nearest(name, &names));
                }
            };
            if place.replace(column).is_some() {
                return wrong(format!("two columns of `{name}`"), None);
            }
        }
        match of_coordinate.iter().position(Option::is_none) {
            Some(missing) => wrong(format!("no column `{}`", names[missing]), None),
            None => {
                Ok(Self { path: path.to_owned(), table, columns: of_coordinate.into_iter().flatten().collect(), time })
            }
        }
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it has a column of times.
    pub fn has_times(&self) -> bool {
        self.time.is_some()
    }

    /// Reads the next state into `values`, one for each coordinate; none at the end of the table.
    ///
    /// # Errors
    /// A row that has another number of fields than the header, or a field that is no finite number.
    ///
    /// # Panics
    /// Where `values` has not one place for each coordinate.
    pub fn advance(&mut self, values: &mut [f64]) -> Result<Option<StateRow>> {
        assert_eq!(values.len(), self.columns.len(), "a place for each coordinate");
        let Some(row) = self.table.next_row()? else { return Ok(None) };
        for (value, column) in values.iter_mut().zip(&self.columns) {
            *value = row.number(*column)?;
        }
        let time = self.time.map(|column| row.number(column)).transpose()?;
        Ok(Some(StateRow { line: row.line, time }))
    }
}
