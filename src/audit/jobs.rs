//! Two jobs key by key: what they ask for, and how it is to be done.

use serde_json::Value;

use crate::error::{Result, json_value};
use crate::job::{Job, Role, schema};

/// What two jobs differ in.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Differences {
    /// Keys that decide what is made.
    pub(super) wanted: Vec<String>,
    /// Keys that decide how.
    pub(super) way: Vec<String>,
}

/// The keys in which two jobs differ, by their dotted names.
///
/// # Errors
/// [`crate::error::Error::NotJson`] where the path of a file is not UTF-8.
pub(super) fn differences(one: &Job, other: &Job) -> Result<Differences> {
    let mut keys = Vec::new();
    compare(&json_value("the job", one)?, &json_value("the job", other)?, "", &mut keys);
    let mut found = Differences::default();
    let schema = schema();
    for (key, is_missing) in keys {
        match Role::of(&schema, &key) {
            Role::Place => {}
            Role::PlaceOfOne if !is_missing => {}
            Role::Way => found.way.push(key),
            Role::Result | Role::PlaceOfOne => found.wanted.push(key),
        }
    }
    Ok(found)
}

/// Collects the keys whose values differ, and whether one of the two lacks the key.
fn compare(one: &Value, other: &Value, key: &str, keys: &mut Vec<(String, bool)>) {
    match (one, other) {
        (Value::Object(one), Value::Object(other)) => {
            let mut names: Vec<&String> = one.keys().chain(other.keys()).collect();
            names.sort();
            names.dedup();
            for name in names {
                let below = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                compare(one.get(name).unwrap_or(&Value::Null), other.get(name).unwrap_or(&Value::Null), &below, keys);
            }
        }
        (Value::Array(one), Value::Array(other)) if one.len() == other.len() => {
            for (index, (one, other)) in one.iter().zip(other).enumerate() {
                compare(one, other, &format!("{key}[{index}]"), keys);
            }
        }
        _ if one != other => keys.push((key.to_owned(), one.is_null() || other.is_null())),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(text: &str) -> Job {
        let text =
            format!("{text}\n[[interface]]\nname = \"hub\"\nnodes = [1, 2]\n[write]\nsuperelement = \"x.supel\"\n");
        Job::parse(&text, std::path::Path::new("job.toml")).expect("a job")
    }

    const MODEL: &str = "[model]\nstiffness = \"K\"\nmass = \"M\"\n";

    #[test]
    fn places_do_not_count_and_wishes_do() {
        let one = job(&format!("{MODEL}[reduction]\nmethod = \"herting\"\nmodes = {{ count = 4 }}"));
        let mut moved = one.clone();
        moved.model.stiffness = "elsewhere/K".into();
        moved.write.html = Some("page.html".into());
        moved.run.memory_gib = Some(2.0);
        assert_eq!(differences(&one, &moved).expect("names in UTF-8"), Differences::default());
        let mut other = one.clone();
        other.interfaces[0].name = "foot".to_owned();
        other.reduction.modes = Some(crate::job::ModeSelection::UpTo { up_to_hz: 100.0 }.into());
        other.reduction.eigensolver = crate::job::Eigensolver::Arpack;
        other.model.nodes = Some("mesh.med".into());
        other.model.mass = None;
        let found = differences(&one, &other).expect("names in UTF-8");
        let wanted =
            ["interface[0].name", "model.mass", "model.nodes", "reduction.modes.count", "reduction.modes.up_to_hz"];
        assert_eq!(found.wanted, wanted);
        assert_eq!(found.way, ["reduction.eigensolver"]);
    }
}
