//! Every field of a metadata document, changed one at a time without knowing what it means.

use std::collections::BTreeSet;

use serde_json::{Value, json};

/// One change of one field.
pub(super) struct Change {
    /// The field, `coordinates[].error_bar_hz`: `[]` stands for any element of a list.
    pub(super) field: String,
    /// What is done to it.
    pub(super) what: &'static str,
    /// The document after it.
    pub(super) document: Value,
}

/// Words of which one is as valid as another.
const WORDS: &[&[&str]] = &[
    &["herting", "craig-bampton", "rubin", "macneal", "mixed-interface", "guyan", "mode-acceleration"],
    &["ux", "uy", "uz", "rx", "ry", "rz"],
    &["pass", "warn", "fail"],
    &["geometric", "algebraic"],
    &["lanczos", "arpack"],
    &["none", "count", "full"],
    &["direct", "rigid"],
    &["double", "single"],
    &["add", "refuse"],
    &["elastic_mode", "fixed_interface_mode", "mixed_interface_mode"],
];

/// What stands where a document may hold nothing.
fn in_place_of_nothing(field: &str) -> Option<Value> {
    Some(match field {
        "units" => json!("other"),
        "interface_nodes[].label" => json!(7),
        "validity.band_hz" => json!([0.0, 1.0]),
        "model.mass_properties" => {
            json!({"mass": 1.0, "center_of_mass": [0.0, 0.0, 0.0], "inertia": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]})
        }
        _ => return None,
    })
}

/// The change of an empty list, named after its elements.
const ADDED: &str = "one added";

/// What an empty list may hold.
fn in_empty_list(field: &str) -> Option<Value> {
    Some(match field {
        "dropped" => json!({"column": {"kind": "inertia_relief", "index": 0}, "reason": "for no reason"}),
        "validity.assumptions" => json!("no load acts in between"),
        "flags" => json!("singular_mass"),
        _ => return None,
    })
}

/// All changes of a document, of the first element of each list and the last.
pub(super) fn changes(document: &Value) -> Vec<Change> {
    let mut changes = Vec::new();
    walk(document, document, &mut Vec::new(), &mut changes);
    changes
}

/// The first and the last element, or the largest of some numbers: the others may be rounding of it.
fn chosen(list: &[Value]) -> BTreeSet<usize> {
    let size = |value: &Value| value.as_f64().map(f64::abs);
    let is_vector = list.iter().all(|value| value.as_f64().is_some() && value.as_i64().is_none());
    if is_vector {
        let largest = (0..list.len()).max_by(|a, b| size(&list[*a]).partial_cmp(&size(&list[*b])).expect("numbers"));
        return largest.into_iter().collect();
    }
    [0, list.len().saturating_sub(1)].into_iter().filter(|at| *at < list.len()).collect()
}

#[derive(Clone)]
enum Step {
    Key(String),
    At(usize),
}

/// The name of a place in a document.
fn name(path: &[Step]) -> String {
    let mut name = String::new();
    for step in path {
        match step {
            Step::Key(key) if name.is_empty() => name.push_str(key),
            Step::Key(key) => {
                name.push('.');
                name.push_str(key);
            }
            Step::At(_) => name.push_str("[]"),
        }
    }
    name
}

fn at<'a>(document: &'a mut Value, path: &[Step]) -> &'a mut Value {
    path.iter().fold(document, |value, step| match step {
        Step::Key(key) => &mut value[key.as_str()],
        Step::At(index) => &mut value[*index],
    })
}

fn walk(document: &Value, value: &Value, path: &mut Vec<Step>, changes: &mut Vec<Change>) {
    let field = name(path);
    let mut push = |what: &'static str, new: Value| {
        let mut altered = document.clone();
        *at(&mut altered, path) = new;
        let of_element = if what == ADDED { "[]" } else { "" };
        changes.push(Change { field: format!("{field}{of_element}"), what, document: altered });
    };
    match value {
        Value::Null => in_place_of_nothing(&field).into_iter().for_each(|new| push("put in", new)),
        Value::Bool(flag) => push("turned round", (!flag).into()),
        Value::Number(number) => match number.as_i64() {
            Some(integer) => push("one more", (integer + 1).into()),
            None => {
                let value = number.as_f64().expect("a number");
                push("changed by a thousandth", if value == 0.0 { 1e-3.into() } else { (value * 1.001).into() });
            }
        },
        Value::String(text) => {
            let words = WORDS.iter().find(|words| words.contains(&text.as_str()));
            let next = words.map(|words| {
                let place = words.iter().position(|word| word == text).expect("among them");
                words[(place + 1) % words.len()].to_owned()
            });
            push("another word", next.unwrap_or_else(|| other(text)).into());
        }
        Value::Array(list) => {
            match in_empty_list(&field) {
                Some(new) if list.is_empty() => push(ADDED, json!([new])),
                _ if list.is_empty() => {}
                _ => {
                    push("emptied", json!([]));
                    push("last left out", list[..list.len() - 1].into());
                }
            }
            for index in chosen(list) {
                path.push(Step::At(index));
                walk(document, &list[index], path, changes);
                path.pop();
            }
        }
        Value::Object(fields) => {
            for (key, value) in fields {
                path.push(Step::Key(key.clone()));
                if !value.is_null() && is_optional(&name(path)) {
                    let mut altered = document.clone();
                    let (parent, whole) = (&path[..path.len() - 1], name(path));
                    at(&mut altered, parent)[key] = Value::Null;
                    changes.push(Change { field: whole, what: "taken out", document: altered });
                }
                walk(document, value, path, changes);
                path.pop();
            }
            if field == "inputs" {
                let mut more = fields.clone();
                more.insert("damping".into(), json!("0".repeat(64)));
                changes_of_inputs(document, &field, [("one added", more), ("one taken out", fewer(fields))], changes);
            }
        }
    }
}

fn fewer(fields: &serde_json::Map<String, Value>) -> serde_json::Map<String, Value> {
    fields.iter().skip(1).map(|(key, value)| (key.clone(), value.clone())).collect()
}

fn changes_of_inputs(
    document: &Value,
    field: &str,
    new: [(&'static str, serde_json::Map<String, Value>); 2],
    changes: &mut Vec<Change>,
) {
    for (what, fields) in new {
        let mut altered = document.clone();
        altered[field] = fields.into();
        changes.push(Change { field: field.to_owned(), what, document: altered });
    }
}

/// What a document may do without.
fn is_optional(field: &str) -> bool {
    const OPTIONAL: &[&str] = &[
        "model.mass_properties",
        "validity.band_hz",
        "job.damping",
        "job.model.dofs",
        "job.model.expect",
        "job.model.mass",
        "job.model.nodes",
        "job.model.units",
        "job.reduction.held",
        "job.scene",
        "job.write.quantities",
        "job.write.recovery",
    ];
    OPTIONAL.contains(&field)
}

/// Another text of the same kind: hexadecimal digits stay digits.
fn other(text: &str) -> String {
    let is_digest = text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
    match text.chars().next() {
        Some(first) if is_digest => format!("{}{}", if first == '0' { '1' } else { '0' }, &text[1..]),
        _ => format!("{text}x"),
    }
}

/// The names of all fields that a schema knows, but for what is inside of the job, which has a schema of its own.
pub(super) fn fields_of(schema: &Value) -> BTreeSet<String> {
    let mut fields = BTreeSet::new();
    collect(schema, schema, "", &mut fields);
    fields
}

fn collect(schema: &Value, part: &Value, field: &str, fields: &mut BTreeSet<String>) {
    if let Some(reference) = part["$ref"].as_str() {
        let key = reference.strip_prefix("#/$defs/").expect("a definition of the schema");
        return collect(schema, &schema["$defs"][key], field, fields);
    }
    let below = |key: &str| if field.is_empty() { key.to_owned() } else { format!("{field}.{key}") };
    let alternatives = ["oneOf", "anyOf"].into_iter().filter_map(|key| part[key].as_array()).flatten();
    let mut is_leaf = true;
    for alternative in alternatives {
        collect(schema, alternative, field, fields);
        is_leaf = false;
    }
    for (key, value) in part["properties"].as_object().into_iter().flatten() {
        collect(schema, value, &below(key), fields);
        is_leaf = false;
    }
    if part["items"].is_object() {
        collect(schema, &part["items"], &format!("{field}[]"), fields);
        is_leaf = false;
    }
    let is_nothing = part["type"] == "null";
    if is_leaf && !field.is_empty() && !is_nothing {
        fields.insert(field.to_owned());
    }
}
