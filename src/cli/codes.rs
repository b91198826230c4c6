//! Everything that has a code: errors, warnings and checks, each with what it means and what to do.
//!
//! Errors are those of the enum and checks those of the catalogue. Warnings, a command line that cannot be read and a defect of the
//! program are no part of the enum; their rows are those of the documentation.

use serde::Serialize;

use crate::error::{Error, ErrorClass, INTERNAL_CODE, USAGE_CODE};
use crate::verification::catalogue::{CATALOGUE, OF_RESULTS};

/// The page of errors and warnings.
const PAGE: &str = include_str!("../../docs/errors.md");

/// What a code belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    /// A run ends with it.
    Error,
    /// A run goes on after it.
    Warning,
    /// A report has it.
    Check,
}

/// A code and what is known of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Entry {
    pub(super) code: String,
    pub(super) kind: Kind,
    /// The exit code of an error.
    pub(super) exit_code: Option<u8>,
    /// What it means.
    pub(super) what: String,
    /// What to do.
    pub(super) remedy: String,
}

/// All codes: errors by exit code in the order of a run, warnings, checks.
pub(super) fn all() -> Vec<Entry> {
    let mut entries: Vec<Entry> = Error::CODES
        .iter()
        .map(|entry| Entry {
            code: entry.code.to_owned(),
            kind: Kind::Error,
            exit_code: Some(entry.class as u8),
            what: one_line(entry.what),
            remedy: entry.remedy.to_owned(),
        })
        .collect();
    let of_page = |code: &str, exit_code: u8| {
        row(code).map(|[code, what, remedy]| Entry {
            code,
            kind: Kind::Error,
            exit_code: Some(exit_code),
            what,
            remedy,
        })
    };
    entries.extend(of_page(USAGE_CODE, ErrorClass::Usage as u8));
    entries.extend(of_page(INTERNAL_CODE, 70));
    entries.sort_by_key(|entry| entry.exit_code);
    let warnings = PAGE.lines().filter(|line| line.starts_with("| `W-")).filter_map(cells);
    entries.extend(warnings.map(|[code, what, remedy]| Entry {
        code,
        kind: Kind::Warning,
        exit_code: None,
        what,
        remedy,
    }));
    entries.extend(CATALOGUE.iter().chain(OF_RESULTS).map(|entry| Entry {
        code: entry.id.to_owned(),
        kind: Kind::Check,
        exit_code: None,
        what: entry.meaning.to_owned(),
        remedy: entry.remedy.to_owned(),
    }));
    entries
}

/// The row of a code.
fn row(code: &str) -> Option<[String; 3]> {
    PAGE.lines().filter_map(cells).find(|[of_row, ..]| of_row == code)
}

/// The cells of a row of the page; none of other lines.
fn cells(line: &str) -> Option<[String; 3]> {
    let row = line.strip_prefix("| ")?.strip_suffix(" |")?;
    let mut cells = row.splitn(3, " | ").map(|cell| cell.replace('`', ""));
    Some([cells.next()?, cells.next()?, cells.next()?])
}

/// A comment of several lines, of which each begins with a blank.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('`', "")
}
