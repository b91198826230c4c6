//! The job document: TOML or JSON, every key known, every mistake located.
//!
//! Keys are checked before values are read, because the place and the nearest known key tell a user more than the
//! list of expected keys that a deserialiser gives.

use std::io::Read;
use std::path::Path;

use super::schema::{self, Allowed};
use super::types::Job;
use crate::error::{Error, Result};
use crate::regular_file;

/// Above this Jaro-Winkler similarity a known key is offered for an unknown one; below it the offer would be noise.
const SIMILAR: f64 = 0.75;

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
pub(super) fn text_of(path: &Path) -> Result<String> {
    let failed = |source| Error::Read { path: path.to_owned(), source };
    let wrong = |message: String| Error::JobSyntax { path: path.to_owned(), line: None, message };
    let mut bytes = Vec::new();
    regular_file::open(path)?.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(wrong(format!("longer than {MAX_BYTES} bytes; no job document is, is this a matrix?")));
    }
    String::from_utf8(bytes).map_err(|fault| {
        let at = fault.utf8_error().valid_up_to();
        wrong(format!("byte {at} is not UTF-8 text; expected a job document in TOML or JSON"))
    })
}

pub(super) fn parse(text: &str, path: &Path) -> Result<Job> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    match Notation::of(text, path) {
        Notation::Toml => {
            let failure = |error: toml::de::Error| toml_failure(&error, text, path);
            let table = toml::de::DeTable::parse(text).map_err(failure)?;
            check_keys(&toml_table(table.get_ref(), text), path)?;
            toml::from_str(text).map_err(failure)
        }
        Notation::Json => {
            let failure = |error: serde_json::Error| json_failure(&error, path);
            let value: serde_json::Value = serde_json::from_str(text).map_err(failure)?;
            check_keys(&json_tree(&value), path)?;
            serde_json::from_str(text).map_err(failure)
        }
    }
}

/// The shape of a document: its tables, lists and keys, without the values.
enum Tree {
    Table(Vec<Entry>),
    List(Vec<Tree>),
    /// JSON's `null`, which a deserialiser takes for a key that is left out.
    Null,
    Leaf,
}

struct Entry {
    key: String,
    line: Option<usize>,
    value: Tree,
}

fn toml_table(table: &toml::de::DeTable<'_>, text: &str) -> Tree {
    let entry = |(key, value): (&toml::Spanned<_>, &toml::Spanned<toml::de::DeValue<'_>>)| {
        let name: &toml::de::DeString<'_> = key.get_ref();
        let line = Some(line_at(text, key.span().start));
        Entry { key: name.to_string(), line, value: toml_value(value.get_ref(), text) }
    };
    let mut entries: Vec<Entry> = table.iter().map(entry).collect();
    // The table is sorted by key; the first mistake of the document is the one to report.
    entries.sort_by_key(|entry| entry.line);
    Tree::Table(entries)
}

fn toml_value(value: &toml::de::DeValue<'_>, text: &str) -> Tree {
    match value {
        toml::de::DeValue::Table(table) => toml_table(table, text),
        toml::de::DeValue::Array(items) => {
            Tree::List(items.iter().map(|item| toml_value(item.get_ref(), text)).collect())
        }
        _ => Tree::Leaf,
    }
}

fn json_tree(value: &serde_json::Value) -> Tree {
    match value {
        serde_json::Value::Object(map) => Tree::Table(
            map.iter().map(|(key, value)| Entry { key: key.clone(), line: None, value: json_tree(value) }).collect(),
        ),
        serde_json::Value::Array(items) => Tree::List(items.iter().map(json_tree).collect()),
        serde_json::Value::Null => Tree::Null,
        _ => Tree::Leaf,
    }
}

fn check_keys(tree: &Tree, path: &Path) -> Result<()> {
    Keys { schema: schema::schema(), path }.check(tree, "", (None, ""))
}

/// The keys that the types of a job have, and what may stand at them.
///
/// A deserialiser would take a list for a table and give its elements to the keys in their order, which nobody means, or leave out what
/// stands behind the third coordinate of a point.
struct Keys<'a> {
    schema: serde_json::Value,
    path: &'a Path,
}

impl Keys<'_> {
    /// `pattern` is the place with `[]` for every list, `place` the same with element numbers; `line` is that of its key.
    fn check(&self, tree: &Tree, pattern: &str, (line, place): (Option<usize>, &str)) -> Result<()> {
        let wrong = |found: &str, expected: &str| {
            let name = if place.is_empty() { "the job".to_owned() } else { format!("`{place}`") };
            let message = format!("{name} is {found} – expected {expected}");
            Err(Error::JobSyntax { path: self.path.to_owned(), line, message })
        };
        if matches!(tree, Tree::Leaf) {
            return Ok(());
        }
        let Allowed { keys, longest_list } = schema::allowed(&self.schema, pattern);
        match (tree, keys) {
            (Tree::Leaf, _) => Ok(()),
            (Tree::Null, _) => wrong("null", "a value, or the key left out"),
            (Tree::List(_), Some(known)) if longest_list.is_none() => {
                wrong("a list", &format!("a table with keys of {}", known.join(", ")))
            }
            (Tree::List(items), _) if longest_list.is_some_and(|longest| items.len() > longest) => {
                wrong(&format!("a list of {}", items.len()), &format!("{}", longest_list.unwrap_or_default()))
            }
            (Tree::List(items), _) => items.iter().enumerate().try_for_each(|(item_idx, item)| {
                self.check(item, &format!("{pattern}[]"), (line, &format!("{place}[{item_idx}]")))
            }),
            (Tree::Table(_), None) => wrong("a table", "a text, a number, a list or a word, as docs/job.md says"),
            (Tree::Table(entries), Some(known)) => entries.iter().try_for_each(|entry| {
                let here = join(place, &entry.key);
                if !known.contains(&entry.key) {
                    let (path, suggestion) = (self.path.to_owned(), nearest(&entry.key, &known));
                    return Err(Error::JobKey { path, line: entry.line, key: here, suggestion });
                }
                self.check(&entry.value, &join(pattern, &entry.key), (entry.line.or(line), &here))
            }),
        }
    }
}

fn join(place: &str, key: &str) -> String {
    if place.is_empty() { key.to_owned() } else { format!("{place}.{key}") }
}

fn nearest(key: &str, known: &[String]) -> Option<String> {
    let key = key.to_lowercase();
    known
        .iter()
        .map(|candidate| (strsim::jaro_winkler(&key, candidate), candidate))
        .filter(|(similarity, _)| *similarity >= SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate.clone())
}

fn toml_failure(error: &toml::de::Error, text: &str, path: &Path) -> Error {
    Error::JobSyntax {
        path: path.to_owned(),
        line: error.span().map(|span| line_at(text, span.start)),
        message: error.message().replace('\n', ", "),
    }
}

fn json_failure(error: &serde_json::Error, path: &Path) -> Error {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    Error::JobSyntax {
        path: path.to_owned(),
        line: (error.line() > 0).then_some(error.line()),
        message: text.strip_suffix(&place).unwrap_or(&text).to_owned(),
    }
}

fn line_at(text: &str, offset: usize) -> usize {
    text.bytes().take(offset).filter(|byte| *byte == b'\n').count() + 1
}
