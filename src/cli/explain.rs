//! `supel explain`: the page of a code, or all codes.

use serde_json::json;

use super::answer::Terminal;
use super::codes::{Entry, Kind, all};
use super::exit_code::ExitCode;
use super::text_flags::ExplainFlags;
use crate::error::{Error, Result, json_value};
use crate::job::nearest;
use crate::report::page::{Page, Paint, Tone, WIDTH};
use crate::report::{table, value_text};

/// Version of the document's layout.
const FORMAT_VERSION: u32 = 1;

pub(super) fn run(flags: &ExplainFlags, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let entries = all();
    let entries = match &flags.code {
        None => entries,
        Some(code) => vec![found(entries, code)?],
    };
    let text = match (flags.json, &entries[..]) {
        (true, _) => {
            let entries = json_value("the codes", &entries)?;
            value_text(&json!({ "format_version": FORMAT_VERSION, "entries": entries }))
        }
        (false, [only]) => page(only, terminal.paint),
        (false, entries) => list(entries, terminal.paint),
    };
    terminal.answer(&text);
    Ok(ExitCode::Done)
}

/// The entry of a code as it may be typed: in lower case, in brackets, without what all errors begin with, a number with any zeros before it.
fn found(entries: Vec<Entry>, typed: &str) -> Result<Entry> {
    let code = typed.trim().trim_start_matches("error").trim_matches(['[', ']']).to_uppercase().replace('_', "-");
    let of_code = |code: &str| entries.iter().find(|entry| without_zeros(&entry.code) == without_zeros(code));
    let of_kind = |kind: &str| of_code(&format!("{kind}-{code}"));
    let entry = of_code(&code).or_else(|| ["E", "W"].into_iter().find_map(of_kind));
    entry.cloned().ok_or_else(|| {
        let known: Vec<String> = entries.iter().map(|entry| entry.code.to_lowercase()).collect();
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        let like = |code: &str| nearest(code, &known);
        let suggestion = like(&code).or_else(|| like(&format!("E-{code}"))).map(|code| code.to_uppercase());
        Error::CodeUnknown { code: typed.to_owned(), suggestion }
    })
}

/// What a code begins with, and its number without the zeros before it.
fn without_zeros(code: &str) -> (&str, &str) {
    let (kind, rest) = code.split_once('-').unwrap_or((code, ""));
    (kind, rest.trim_start_matches('0'))
}

fn kind(entry: &Entry) -> String {
    match (entry.kind, entry.exit_code) {
        (Kind::Error, Some(code)) => format!("error, exit code {code}"),
        (Kind::Error, None) => "error".to_owned(),
        (Kind::Warning, _) => "warning: the run goes on; with --strict it counts as a failed check".to_owned(),
        (Kind::Check, _) => "check of a report".to_owned(),
    }
}

fn page(entry: &Entry, paint: Paint) -> String {
    let mut page = Page::new(paint);
    page.line(Page::toned(&entry.code, Tone::Heading));
    page.entry("is", &kind(entry));
    page.entry("means", &entry.what);
    page.entry("what to do", &entry.remedy);
    page.into_text()
}

fn list(entries: &[Entry], paint: Paint) -> String {
    let mut page = Page::new(paint);
    let widest = entries.iter().map(|entry| table::width(&entry.code)).max().unwrap_or(0);
    let mut heading = String::new();
    for entry in entries {
        let of_entry = match (entry.kind, entry.exit_code) {
            (Kind::Error, Some(code)) => format!("Errors, exit code {code}"),
            (Kind::Error, None) => "Errors".to_owned(),
            (Kind::Warning, _) => "Warnings".to_owned(),
            (Kind::Check, _) => "Checks".to_owned(),
        };
        if of_entry != heading {
            page.heading(&of_entry);
            heading = of_entry;
        }
        let code = table::pad(&entry.code, widest, table::Align::Left);
        let what = table::shorten(&entry.what, WIDTH - widest - 4);
        page.spans(&["  ".into(), (&code).into(), "  ".into(), Page::toned(&what, Tone::Faint)]);
    }
    page.line("");
    page.line("supel explain CODE prints all of one.");
    page.into_text()
}
