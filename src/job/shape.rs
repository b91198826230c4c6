//! The shape of a job document, compared with the schema before any value is read: every key known, every value of a kind that may stand
//! at its place.
//!
//! A deserialiser says what it expected in the words of its language ("usize", "struct"), without the key. It would also take a list for a
//! table and give its elements to the keys in their order, which nobody means.

use std::fmt::Display;
use std::path::Path;

use serde_json::Value;

use super::schema::{self, Place};
use crate::error::{Error, Result};

/// Above this Jaro-Winkler similarity a known key is offered for an unknown one; below it the offer would be noise.
const SIMILAR: f64 = 0.75;
/// Characters of a value that a message quotes.
const QUOTED: usize = 60;

/// A document: its tables, lists, keys and values.
pub(super) enum Tree<'a> {
    Table(Vec<Entry<'a>>),
    List(Vec<Tree<'a>>),
    /// JSON's `null`, which a deserialiser takes for a key that is left out.
    Null,
    Leaf(Leaf<'a>),
}

/// A key of a table with its line, where that is known.
pub(super) struct Entry<'a> {
    pub(super) key: &'a str,
    pub(super) line: Option<usize>,
    pub(super) value: Tree<'a>,
}

/// A single value; a document may hold a million of them.
pub(super) enum Leaf<'a> {
    Text(&'a str),
    /// A number as it is written; the whole number that it is, if it is one that can be counted with.
    Number {
        written: &'a dyn Display,
        whole: Option<i64>,
    },
    Truth(bool),
    Date(&'a dyn Display),
}

impl Leaf<'_> {
    fn words(&self) -> String {
        match self {
            Self::Text(text) => format!("{:?}", text.chars().take(QUOTED).collect::<String>()),
            Self::Number { written, .. } => written.to_string().chars().take(QUOTED).collect(),
            Self::Truth(truth) => truth.to_string(),
            Self::Date(date) => format!("the date {date}"),
        }
    }

    fn is_one_of(&self, allowed: &Place<'_>) -> bool {
        allowed.choices.iter().any(|choice| self.is_of(choice))
    }

    /// Whether a value of this kind may stand where the schema has `choice`. Ranges are judged later.
    fn is_of(&self, choice: &Value) -> bool {
        let kind = choice["type"].as_str();
        match self {
            Self::Text(text) => match schema::words(choice) {
                words if words.is_empty() => kind == Some("string"),
                words => words.contains(text),
            },
            Self::Number { whole, .. } if kind == Some("integer") => {
                whole.is_some_and(|whole| choice["minimum"].as_i64().is_none_or(|least| whole >= least))
            }
            Self::Number { .. } => kind == Some("number"),
            Self::Truth(_) => kind == Some("boolean"),
            Self::Date(_) => false,
        }
    }
}

/// Compares a document with the schema.
///
/// # Errors
/// [`Error::JobKey`] for a key that no job has, [`Error::JobSyntax`] for a value of another kind or a missing key.
pub(super) fn check(tree: &Tree<'_>, path: &Path) -> Result<()> {
    let schema = schema::schema();
    let all = schema::allowed(&schema, "");
    Shape { schema: &schema, path }.check(tree, ("", &all), (None, ""))
}

struct Shape<'a> {
    schema: &'a Value,
    path: &'a Path,
}

impl Shape<'_> {
    /// `pattern` is the place with `[]` for every list, `place` the same with element numbers; `line` is that of its key.
    fn check(
        &self,
        tree: &Tree<'_>,
        (pattern, allowed): (&str, &Place<'_>),
        (line, place): (Option<usize>, &str),
    ) -> Result<()> {
        let wrong = |found: &str| {
            let name = if place.is_empty() { "the job".to_owned() } else { format!("`{place}`") };
            self.wrong(line, format!("{name} is {found} – expected {}", expected(allowed)))
        };
        match tree {
            Tree::Leaf(leaf) if leaf.is_one_of(allowed) => Ok(()),
            Tree::Leaf(leaf) => wrong(&leaf.words()),
            Tree::Null => self.wrong(line, format!("`{place}` is null – expected a value, or the key left out")),
            Tree::List(items) => {
                let Some([shortest, longest]) = allowed.list_lengths() else { return wrong("a list") };
                // An empty list of any length is named by what it should hold.
                let is_too_short = shortest == longest && items.len() < shortest;
                if is_too_short || items.len() > longest {
                    return wrong(&format!("a list of {}", items.len()));
                }
                let pattern = format!("{pattern}[]");
                let of_items = schema::allowed(self.schema, &pattern);
                let is_right = |item: &Tree<'_>| matches!(item, Tree::Leaf(leaf) if leaf.is_one_of(&of_items));
                items.iter().enumerate().filter(|(_, item)| !is_right(item)).try_for_each(|(item_idx, item)| {
                    self.check(item, (&pattern, &of_items), (line, &format!("{place}[{item_idx}]")))
                })
            }
            Tree::Table(_) if allowed.tables().next().is_none() => wrong("a table"),
            Tree::Table(entries) => {
                let known = allowed.keys();
                for entry in entries {
                    let here = join(place, entry.key);
                    if !known.contains(&entry.key) {
                        let (path, suggestion) = (self.path.to_owned(), nearest(entry.key, &known));
                        return Err(Error::JobKey { path, line: entry.line, key: here, suggestion });
                    }
                    let pattern = join(pattern, entry.key);
                    let of_value = schema::allowed(self.schema, &pattern);
                    self.check(&entry.value, (&pattern, &of_value), (entry.line.or(line), &here))?;
                }
                self.check_required(entries, allowed, (line, place))
            }
        }
    }

    /// Refuses a table that lacks a key, or has keys of two tables of which one may stand there.
    fn check_required(
        &self,
        entries: &[Entry<'_>],
        allowed: &Place<'_>,
        (line, place): (Option<usize>, &str),
    ) -> Result<()> {
        let has = |key: &str| entries.iter().any(|entry| entry.key == key);
        let tables: Vec<&Value> = allowed.tables().collect();
        if let [only] = tables.as_slice() {
            return match schema::required(only).find(|key| !has(key)) {
                Some(key) => self.wrong(line, format!("`{}` is missing", join(place, key))),
                None => Ok(()),
            };
        }
        let is_this = |table: &&Value| {
            schema::required(table).all(has) && entries.iter().all(|entry| table["properties"].get(entry.key).is_some())
        };
        if tables.iter().any(is_this) {
            return Ok(());
        }
        let quoted = |key: &str| format!("`{key}`");
        let choices: Vec<String> = tables.iter().flat_map(|table| schema::required(table)).map(quoted).collect();
        let found: Vec<String> = entries.iter().map(|entry| quoted(entry.key)).collect();
        let found = if found.is_empty() { "is empty".to_owned() } else { format!("has {}", listed(&found, "and")) };
        self.wrong(line, format!("`{place}` {found} – expected exactly one of {}", listed(&choices, "and")))
    }

    fn wrong(&self, line: Option<usize>, message: String) -> Result<()> {
        Err(Error::JobSyntax { path: self.path.to_owned(), line, message })
    }
}

/// What may stand at a place, in words.
fn expected(allowed: &Place<'_>) -> String {
    let mut words: Vec<String> = Vec::new();
    let mut add = |word: String| {
        if !words.contains(&word) {
            words.push(word);
        }
    };
    for choice in &allowed.choices {
        schema::words(choice).iter().for_each(|word| add(format!("{word:?}")));
        match choice["type"].as_str() {
            Some("string") if schema::words(choice).is_empty() => add(match choice["examples"][0].as_str() {
                Some(example) => format!("a text such as {example:?}"),
                None => "a text".to_owned(),
            }),
            Some("integer") if choice["minimum"].as_i64() == Some(0) => add("a whole number, zero or more".to_owned()),
            Some("integer") => add(match (choice["minimum"].as_i64(), choice["maximum"].as_i64()) {
                (Some(least), Some(most)) => format!("a whole number from {least} to {most}"),
                _ => "a whole number".to_owned(),
            }),
            Some("number") => add("a number".to_owned()),
            Some("boolean") => add("true or false".to_owned()),
            Some("array") => add(match schema::list_length(choice) {
                [shortest, longest] if shortest == longest => format!("a list of {longest}"),
                _ => "a list".to_owned(),
            }),
            _ => {}
        }
    }
    let keys = allowed.keys();
    if !keys.is_empty() {
        add(format!("a table with keys of {}", keys.join(", ")));
    }
    listed(&words, "or")
}

/// `a`, `a or b`, `a, b or c`.
fn listed(words: &[String], last: &str) -> String {
    match words {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., end] => format!("{} {last} {end}", first.join(", ")),
    }
}

fn join(place: &str, key: &str) -> String {
    if place.is_empty() { key.to_owned() } else { format!("{place}.{key}") }
}

/// The known name that looks most like another, where one does.
pub(crate) fn nearest(key: &str, known: &[&str]) -> Option<String> {
    let key = key.to_lowercase();
    known
        .iter()
        .map(|candidate| (strsim::jaro_winkler(&key, candidate), candidate))
        .filter(|(similarity, _)| *similarity >= SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| (*candidate).to_owned())
}
