//! The JSON Schema of a job, made from its types: their fields, values, ranges and descriptions.

use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};

use super::types::Job;

/// The schema of a job document.
pub fn schema() -> Value {
    let schema = SchemaSettings::draft2020_12().into_generator().into_root_schema_for::<Job>();
    let mut schema = schema.to_value();
    plain(&mut schema);
    if let Value::Object(root) = &mut schema {
        root.insert("title".to_owned(), "supel job".into());
    }
    schema
}

/// What a key of the job decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// What is made.
    Result,
    /// Where files are, or how they are to be read: nothing of the superelement.
    Place,
    /// Where a file is of which it matters whether there is one.
    PlaceOfOne,
    /// How the same result is found and proved.
    Way,
}

impl Role {
    /// The role of a key, by `run.certify` or `load[0].file` for instance.
    pub fn of(schema: &Value, key: &str) -> Self {
        let mut tables = alternatives(schema, schema);
        let mut word = None;
        for step in key.split('.') {
            let (name, n_lists) = (step.split('[').next().unwrap_or(step), step.matches('[').count());
            let values: Vec<&Value> = tables.iter().filter_map(|table| table.get("properties")?.get(name)).collect();
            word = values.iter().find_map(|value| value.get("x-role")?.as_str());
            tables = values.into_iter().flat_map(|value| alternatives(schema, value)).collect();
            for _ in 0..n_lists {
                let items = tables.iter().filter_map(|list| list.get("items"));
                tables = items.flat_map(|item| alternatives(schema, item)).collect();
            }
        }
        match word {
            Some("place") => Self::Place,
            Some("place-of-one") => Self::PlaceOfOne,
            Some("way") => Self::Way,
            _ => Self::Result,
        }
    }
}

/// What may stand at a place of a job, each choice a part of the schema.
pub(super) struct Place<'a> {
    pub(super) choices: Vec<&'a Value>,
}

impl<'a> Place<'a> {
    /// The tables that may.
    pub(super) fn tables(&self) -> impl Iterator<Item = &'a Value> {
        self.choices.iter().copied().filter(|choice| choice.get("properties").is_some())
    }

    /// The keys of all these, sorted.
    pub(super) fn keys(&self) -> Vec<&'a str> {
        let objects = self.tables().filter_map(|table| table["properties"].as_object());
        let mut keys: Vec<&str> = objects.flat_map(Map::keys).map(String::as_str).collect();
        keys.sort_unstable();
        keys.dedup();
        keys
    }

    /// How many elements a list may have, at least and at most; none where no list belongs.
    pub(super) fn list_lengths(&self) -> Option<[usize; 2]> {
        let lists = self.choices.iter().filter(|choice| choice["type"] == "array");
        lists.map(|list| list_length(list)).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
    }
}

/// How many elements a list may have by the schema, at least and at most.
pub(super) fn list_length(list: &Value) -> [usize; 2] {
    let bound = |key: &str, none: usize| list[key].as_u64().map_or(none, |n| n as usize);
    [bound("minItems", 0), bound("maxItems", usize::MAX)]
}

/// The words of which a value must be one; none where any text may stand.
pub(super) fn words(choice: &Value) -> Vec<&str> {
    let listed = choice["enum"].as_array().into_iter().flatten();
    choice.get("const").into_iter().chain(listed).filter_map(Value::as_str).collect()
}

/// The keys that a table must have.
pub(super) fn required(table: &Value) -> impl Iterator<Item = &str> {
    table["required"].as_array().into_iter().flatten().filter_map(Value::as_str)
}

/// What may stand at a place of a job, by `interface[].nodes` for instance: `[]` stands for each element of a list.
pub(super) fn allowed<'a>(schema: &'a Value, place: &str) -> Place<'a> {
    let mut choices = alternatives(schema, schema);
    let followed = |parts: Vec<&'a Value>| parts.into_iter().flat_map(|part| alternatives(schema, part)).collect();
    for step in place.split('.').filter(|step| !step.is_empty()) {
        let (key, n_lists) = (step.trim_end_matches("[]"), step.matches("[]").count());
        choices = followed(choices.iter().filter_map(|table| table.get("properties")?.get(key)).collect());
        for _ in 0..n_lists {
            let items = |list: &&'a Value| -> Vec<&'a Value> {
                let own = list["prefixItems"].as_array().into_iter().flatten();
                list.get("items").into_iter().chain(own).collect()
            };
            choices = followed(choices.iter().flat_map(items).collect());
        }
    }
    Place { choices }
}

/// What a part of the schema allows, references and choices followed.
fn alternatives<'a>(schema: &'a Value, part: &'a Value) -> Vec<&'a Value> {
    let target = part.get("$ref").and_then(Value::as_str).and_then(|to| schema.pointer(to.trim_start_matches('#')));
    if let Some(target) = target {
        return alternatives(schema, target);
    }
    // Choices next to keys of its own are conditions on them, not other tables.
    let mut keys = ["oneOf", "anyOf"].into_iter().filter(|_| part.get("properties").is_none());
    let choices = keys.find_map(|key| part.get(key)?.as_array());
    choices
        .map_or_else(|| vec![part], |choices| choices.iter().flat_map(|choice| alternatives(schema, choice)).collect())
}

/// Leaves out what tells nothing of a document: sizes of numbers, and nothing in place of a value, which is a key left out. Descriptions
/// are one line.
fn plain(part: &mut Value) {
    match part {
        Value::Array(list) => list.iter_mut().for_each(plain),
        Value::Object(fields) => {
            if fields.get("format").is_some_and(Value::is_string) {
                fields.remove("format");
            }
            if let Some(Value::String(description)) = fields.get_mut("description") {
                *description = description.replace('\n', " ");
            }
            without_null(fields);
            fields.values_mut().for_each(plain);
        }
        _ => {}
    }
}

fn without_null(fields: &mut Map<String, Value>) {
    if let Some(Value::Array(types)) = fields.get_mut("type") {
        types.retain(|name| name != "null");
        if let [only] = types.as_slice() {
            let only = only.clone();
            fields.insert("type".to_owned(), only);
        }
    }
    let is_null = |choice: &Value| choice.get("type").is_some_and(|name| name == "null");
    let Some(Value::Array(choices)) = fields.get_mut("anyOf") else { return };
    if !choices.iter().any(is_null) {
        return;
    }
    choices.retain(|choice| !is_null(choice));
    if let [Value::Object(only)] = choices.as_mut_slice() {
        let only = std::mem::take(only);
        fields.remove("anyOf");
        // What stands at the place itself says more than what is true of the type everywhere.
        for (key, value) in only {
            fields.entry(key).or_insert(value);
        }
    }
}
