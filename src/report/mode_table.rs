//! Natural frequencies and their error bars in columns that are read downwards.

use super::page::{Page, Tone};
use super::table::{self, Align};
use crate::number;

/// Modes stand in this many columns.
const COLUMNS: usize = 3;

/// Longer lists of modes are shortened to their first and last ones.
const SHOWN: usize = 36;

/// How many of the last modes a shortened list keeps.
const SHOWN_AT_END: usize = 3;

/// Significant digits of a frequency: enough to see every error bar that engineering cares about.
const DIGITS: i32 = 9;

/// A mode as it is listed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mode {
    /// Number of the mode, from one.
    pub(crate) number: usize,
    /// Natural frequency.
    pub(crate) frequency_hz: f64,
    /// Its error bar, where it is known.
    pub(crate) error_bar_hz: Option<f64>,
}

pub(crate) fn mode_table(page: &mut Page, modes: &[Mode]) {
    let Some(highest) = modes.iter().map(|mode| mode.frequency_hz).reduce(f64::max) else {
        return;
    };
    let decimals = usize::try_from(DIGITS - 1 - number::decade(highest)).unwrap_or(0).min(9);
    let row = |mode: &Mode| {
        let bar = mode.error_bar_hz.map(|bar| format!("± {}", number::scientific(bar, 2))).unwrap_or_default();
        [mode.number.to_string(), format!("{:.decimals$}", mode.frequency_hz), bar]
    };
    let is_long = modes.len() > SHOWN;
    let n_first = if is_long { SHOWN - SHOWN_AT_END } else { modes.len() };
    let (first, rest) = modes.split_at(n_first);
    let (hidden, last) = rest.split_at(if is_long { rest.len() - SHOWN_AT_END } else { 0 });
    let shown: Vec<[String; 3]> = first.iter().chain(last).map(row).collect();
    let cells: Vec<String> = table::columns(&shown, [Align::Right, Align::Right, Align::Left])
        .iter()
        .map(|[number, frequency, bar]| format!("{number}  {frequency} {bar}"))
        .collect();
    page.line("");
    let caption = Page::toned("mode, natural frequency and error bar in Hz", Tone::Faint);
    page.spans(&["  ".into(), caption]);
    let n_rows = cells.len().div_ceil(COLUMNS);
    for row_idx in 0..n_rows {
        let line: Vec<&str> = cells.iter().skip(row_idx).step_by(n_rows).map(String::as_str).collect();
        page.line(&format!("  {}", line.join("    ")));
    }
    if let (Some(from), Some(to)) = (hidden.first(), hidden.last()) {
        let hint = format!("modes {} to {} are listed with --json", from.number, to.number);
        page.spans(&["  ".into(), Page::toned(&hint, Tone::Faint)]);
    }
}
