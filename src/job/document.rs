//! The job document: TOML or JSON, every key known, every mistake located.
//!
//! Keys and kinds of values are checked before values are read, see [`shape`]: the words of a deserialiser are those of its author.

use std::io::Read;
use std::path::Path;

use super::shape::{self, Entry, Leaf, Tree};
use super::types::Job;
use super::whole;
use crate::error::{Error, Result};
use crate::regular_file;

/// How a job document is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notation {
    /// TOML.
    Toml,
    /// JSON.
    Json,
}

impl Notation {
    /// By the extension, otherwise by the content: a JSON job starts with a brace, which no TOML document does.
    pub fn of(text: &str, path: &Path) -> Self {
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("toml") => Self::Toml,
            Some("json") => Self::Json,
            _ if text.trim_start().starts_with('{') => Self::Json,
            _ => Self::Toml,
        }
    }
}

/// The longest job document: a million labels of interface nodes, written as JSON with a line for each.
const MAX_BYTES: u64 = 1 << 24;

/// The text of the document at `path`.
pub(crate) fn text_of(path: &Path) -> Result<String> {
    let failed = |source| Error::Read { path: path.to_owned(), source };
    let wrong = |message: String| Error::JobSyntax { path: path.to_owned(), line: None, message };
    let mut bytes = Vec::new();
    regular_file::open(path)?.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(wrong(format!("longer than {MAX_BYTES} bytes; no job document is, is this a matrix?")));
    }
    String::from_utf8(bytes).map_err(|fault| {
        let at = fault.utf8_error().valid_up_to();
        let found = if regular_file::is_utf16(fault.as_bytes()) {
            "text in UTF-16".to_owned()
        } else {
            format!("byte {at} is not UTF-8 text")
        };
        wrong(format!("{found} – expected a job document in TOML or JSON – write the file as UTF-8"))
    })
}

pub(super) fn parse(text: &str, path: &Path) -> Result<Job> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    match Notation::of(text, path) {
        Notation::Toml => {
            let failure = |what: &str, error: toml::de::Error| toml_failure(what, &error, text, path);
            let table = toml::de::DeTable::parse(text).map_err(|error| failure("this is no TOML: ", error))?;
            shape::check(&toml_table(table.get_ref(), text), path)?;
            toml::from_str(text).map_err(|error| failure("", error))
        }
        Notation::Json => {
            let failure = |what: &str, error: serde_json::Error| json_failure(what, &error, path);
            let value: serde_json::Value =
                serde_json::from_str(text).map_err(|error| failure("this is no JSON: ", error))?;
            shape::check(&json_tree(&value), path)?;
            serde_json::from_str(text).map_err(|error| failure("", error))
        }
    }
}

fn toml_table<'a>(table: &'a toml::de::DeTable<'_>, text: &str) -> Tree<'a> {
    let entry =
        |(key, value): (&'a toml::Spanned<toml::de::DeString<'_>>, &'a toml::Spanned<toml::de::DeValue<'_>>)| {
            let line = Some(line_at(text, key.span().start));
            Entry { key: key.get_ref(), line, value: toml_value(value.get_ref(), text) }
        };
    let mut entries: Vec<Entry<'a>> = table.iter().map(entry).collect();
    // The table is sorted by key; the first mistake of the document is the one to report.
    entries.sort_by_key(|entry| entry.line);
    Tree::Table(entries)
}

fn toml_value<'a>(value: &'a toml::de::DeValue<'_>, text: &str) -> Tree<'a> {
    use toml::de::DeValue::{Array, Boolean, Datetime, Float, Integer, String, Table};
    Tree::Leaf(match value {
        Table(table) => return toml_table(table, text),
        Array(items) => return Tree::List(items.iter().map(|item| toml_value(item.get_ref(), text)).collect()),
        String(text) => Leaf::Text(text),
        Integer(number) => {
            let whole = i64::from_str_radix(number.as_str(), number.radix()).ok();
            Leaf::Number { written: number, whole }
        }
        Float(number) => {
            let whole = number.as_str().parse().ok().and_then(whole::of_real);
            Leaf::Number { written: number, whole }
        }
        Boolean(truth) => Leaf::Truth(*truth),
        Datetime(date) => Leaf::Date(date),
    })
}

fn json_tree(value: &serde_json::Value) -> Tree<'_> {
    use serde_json::Value::{Array, Bool, Null, Number, Object, String};
    Tree::Leaf(match value {
        Object(map) => {
            let entry = |(key, value)| Entry { key, line: None, value: json_tree(value) };
            return Tree::Table(map.iter().map(|(key, value)| (key.as_str(), value)).map(entry).collect());
        }
        Array(items) => return Tree::List(items.iter().map(json_tree).collect()),
        Null => return Tree::Null,
        String(text) => Leaf::Text(text),
        Bool(truth) => Leaf::Truth(*truth),
        Number(number) => {
            let whole =
                number.as_i64().or_else(|| number.as_f64().filter(|_| number.is_f64()).and_then(whole::of_real));
            Leaf::Number { written: number, whole }
        }
    })
}

/// What is wrong with a TOML document, and in which line.
pub(crate) fn toml_failure(what: &str, error: &toml::de::Error, text: &str, path: &Path) -> Error {
    Error::JobSyntax {
        path: path.to_owned(),
        line: error.span().map(|span| line_at(text, span.start)),
        message: what.to_owned() + &error.message().replace('\n', ", "),
    }
}

fn json_failure(what: &str, error: &serde_json::Error, path: &Path) -> Error {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    Error::JobSyntax {
        path: path.to_owned(),
        line: (error.line() > 0).then_some(error.line()),
        message: what.to_owned() + text.strip_suffix(&place).unwrap_or(&text),
    }
}

fn line_at(text: &str, offset: usize) -> usize {
    text.bytes().take(offset).filter(|byte| *byte == b'\n').count() + 1
}
