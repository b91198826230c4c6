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
    /// The role of a key, by `run.certify` for instance. Keys inside lists decide what is made.
    pub fn of(schema: &Value, key: &str) -> Self {
        let mut tables = alternatives(schema, schema);
        let mut word = None;
        for step in key.split('.') {
            let values: Vec<&Value> = tables.iter().filter_map(|table| table.get("properties")?.get(step)).collect();
            word = values.iter().find_map(|value| value.get("x-role")?.as_str());
            tables = values.into_iter().flat_map(|value| alternatives(schema, value)).collect();
        }
        match word {
            Some("place") => Self::Place,
            Some("place-of-one") => Self::PlaceOfOne,
            Some("way") => Self::Way,
            _ => Self::Result,
        }
    }
}

/// What may stand at a place of a job.
pub(super) struct Allowed {
    /// The keys of every table that may; none where no table belongs.
    pub(super) keys: Option<Vec<String>>,
    /// How long a list that may; none where no list belongs.
    pub(super) longest_list: Option<usize>,
}

/// What may stand at a place of a job, by `interface[].nodes` for instance: `[]` stands for each element of a list.
pub(super) fn allowed(schema: &Value, place: &str) -> Allowed {
    let mut tables = alternatives(schema, schema);
    for step in place.split('.').filter(|step| !step.is_empty()) {
        let (key, n_lists) = (step.trim_end_matches("[]"), step.matches("[]").count());
        tables = tables.iter().filter_map(|table| table.get("properties")?.get(key)).collect();
        tables = tables.iter().flat_map(|value| alternatives(schema, value)).collect();
        for _ in 0..n_lists {
            tables = tables.iter().filter_map(|list| list.get("items")).collect();
            tables = tables.iter().flat_map(|value| alternatives(schema, value)).collect();
        }
    }
    let objects = tables.iter().filter_map(|table| table.get("properties")?.as_object());
    let mut keys: Vec<String> = objects.flat_map(Map::keys).cloned().collect();
    keys.sort();
    keys.dedup();
    let lists = tables.iter().filter(|choice| choice.get("type").is_some_and(|name| name == "array"));
    let longest = |list: &&Value| list.get("maxItems").and_then(Value::as_u64).map_or(usize::MAX, |n| n as usize);
    Allowed { keys: (!keys.is_empty()).then_some(keys), longest_list: lists.map(longest).max() }
}

/// What a part of the schema allows, references and choices followed.
fn alternatives<'a>(schema: &'a Value, part: &'a Value) -> Vec<&'a Value> {
    let target = part.get("$ref").and_then(Value::as_str).and_then(|to| schema.pointer(to.trim_start_matches('#')));
    if let Some(target) = target {
        return alternatives(schema, target);
    }
    let choices = ["oneOf", "anyOf"].into_iter().find_map(|key| part.get(key)?.as_array());
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
