//! The JSON document that `schemas/examination.schema.json` describes.

use serde::ser::{Serialize, SerializeStruct, Serializer};
use serde_json::json;

use super::examined::Examined;
use crate::error::Result;
use crate::input::MatrixFacts;
use crate::job::Layout;
use crate::report::{Generator, json_text};

/// Version of the document's layout.
const FORMAT_VERSION: u32 = 1;

impl Examined {
    /// The JSON document; numbers that are not finite become `null`.
    ///
    /// # Errors
    /// [`crate::error::Error::NotJson`]; nothing in it can have it.
    pub fn to_json(&self) -> Result<String> {
        json_text("the answer", self)
    }
}

impl Serialize for Examined {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let Self { findings, grounded, n_massless, extents, units, interfaces, facts, body, .. } = self;
        let matrix = |facts: &MatrixFacts| {
            let format = facts.layout.map(Layout::name);
            json!({
                "n_nonzeros": facts.n_nonzeros,
                "digits": facts.digits.significant,
                "format": format,
                "triangle": facts.triangle,
                "digest": facts.digest,
            })
        };
        let matrices = facts.as_ref().map(|facts| facts.matrices.each_ref().map(matrix));
        let mut document = serializer.serialize_struct("Examination", 14)?;
        document.serialize_field("format_version", &FORMAT_VERSION)?;
        document.serialize_field("generator", &Generator::default())?;
        document.serialize_field("severity", &self.severity())?;
        document.serialize_field("findings", findings)?;
        document.serialize_field("stiffness", &matrices.as_ref().map(|[stiffness, _]| stiffness))?;
        document.serialize_field("mass", &matrices.as_ref().map(|[_, mass]| mass))?;
        document.serialize_field("model", &body.as_ref().map(|body| &body.model))?;
        document.serialize_field("rigid_body", &body.as_ref().map(|body| &body.rigid_body.grounding))?;
        document.serialize_field("grounded", grounded)?;
        document.serialize_field("n_massless", n_massless)?;
        document.serialize_field("extents", extents)?;
        document.serialize_field("units", units.guesses())?;
        document.serialize_field("modes", &body.as_ref().map(|body| &body.reduction.modes))?;
        document.serialize_field("interfaces", interfaces)?;
        document.end()
    }
}
