//! The schemas of the repository; they refer to each other by the names of their files.

use std::error::Error;
use std::path::Path;

use jsonschema::{Retrieve, Uri, Validator};
use serde_json::Value;

struct Folder;

impl Retrieve for Folder {
    fn retrieve(&self, uri: &Uri<String>) -> Result<Value, Box<dyn Error + Send + Sync>> {
        let path = uri.path().as_str();
        Ok(read(path.rsplit('/').next().unwrap_or(path))?)
    }
}

fn read(file: &str) -> std::io::Result<Value> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../schemas").join(file);
    Ok(serde_json::from_slice(&std::fs::read(path)?)?)
}

/// The validator of `schemas/NAME.schema.json`, which is a schema itself.
pub fn validator(name: &str) -> Validator {
    let schema = read(&format!("{name}.schema.json")).expect("a schema");
    jsonschema::meta::validate(&schema).expect("the schema itself is valid");
    jsonschema::options().with_retriever(Folder).build(&schema).expect("a schema")
}

/// What is wrong with a document.
#[track_caller]
pub fn assert_follows(validator: &Validator, document: &Value) {
    let wrong: Vec<String> = validator.iter_errors(document).map(|error| error.to_string()).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}
