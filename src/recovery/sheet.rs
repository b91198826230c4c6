//! Tables of results, which grow state by state.

use std::fmt::Write as _;
use std::io::Write;
use std::path::Path;

use super::motion_series::MotionSeries;
use super::state::{Order, State};
use super::states::States;
use crate::error::{Error, Result};

/// One kind of results.
pub trait Sheet {
    /// Names of its columns after those of the state, where these derivatives of the coordinates are known.
    fn columns(&self, orders: &[Order]) -> Vec<&'static str>;

    /// Writes the rows of a state, each of them after `start`, which has the number and the time of the state.
    ///
    /// # Errors
    /// What overflows, in words.
    fn rows(&self, state: &State, start: &str, text: &mut String) -> Result<(), String>;
}

/// A sheet and the file that it fills.
pub struct SheetOutput<'a> {
    /// The results.
    pub sheet: &'a dyn Sheet,
    /// What the file will be called.
    pub path: &'a Path,
    /// The file.
    pub out: &'a mut dyn Write,
}

/// Fills all sheets, and the series if there is one, with all states, and says how many these are. Memory holds one state and its rows at a time.
///
/// # Errors
/// The errors of [`States::advance`]; [`Error::StateRange`] where a result overflows; [`Error::Write`].
pub fn fill(
    states: &mut States,
    outputs: &mut [SheetOutput<'_>],
    mut series: Option<&mut MotionSeries<'_>>,
) -> Result<u64> {
    let (orders, has_times) = (states.orders(), states.has_times());
    let table = states.path().to_owned();
    for output in outputs.iter_mut() {
        let of_state = if has_times { "state,time," } else { "state," };
        output.put(&format!("{of_state}{}\n", output.sheet.columns(&orders).join(",")))?;
    }
    let (mut text, mut n_states) = (String::new(), 0);
    while let Some(state) = states.advance()? {
        let time = state.time.map(|time| format!("{},", number(time))).unwrap_or_default();
        let start = format!("{},{time}", state.number);
        let overflow = |what| Error::StateRange { path: table.clone(), number: state.number, what };
        for output in outputs.iter_mut() {
            text.clear();
            output.sheet.rows(state, &start, &mut text).map_err(overflow)?;
            output.put(&text)?;
        }
        if let Some(series) = &mut series {
            series.push(state)?.map_err(overflow)?;
        }
        n_states = state.number;
    }
    Ok(n_states)
}

impl SheetOutput<'_> {
    fn put(&mut self, text: &str) -> Result<()> {
        let failed = |source| Error::Write { path: self.path.to_owned(), source };
        self.out.write_all(text.as_bytes()).map_err(failed)
    }
}

/// The shortest number from which the double comes back.
fn number(value: f64) -> String {
    format!("{value:e}")
}

/// Writes values as the last fields of a row.
///
/// # Errors
/// `what` where one of them is not finite.
pub(super) fn end_row(text: &mut String, values: &[f64], what: impl FnOnce() -> String) -> Result<(), String> {
    if values.iter().any(|value| !value.is_finite()) {
        return Err(what());
    }
    for value in values {
        let _ = write!(text, ",{value:e}");
    }
    text.push('\n');
    Ok(())
}
