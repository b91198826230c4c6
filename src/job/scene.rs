//! The scene: what the simulation will ask of the component, as far as the comparison with the full model uses it.

use std::collections::BTreeSet;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::accept::AcceptJob;
use super::interface::InterfaceJob;
use super::ranges::{LARGEST, SMALLEST, number, size};
use crate::error::{Error, Result};

/// What the simulation will ask of the component. Whatever is given here is compared, at any cost; what is absent is
/// compared with defaults where that is cheap.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneJob {
    /// Lowest and highest frequency of interest, in Hz.
    #[schemars(schema_with = "band_schema")]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band_hz: Option<[f64; 2]>,
    /// Supports under which frequencies are compared; an empty list compares none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub boundaries: Option<Vec<Support>>,
    /// Damping of the frequency response.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<DampingJob>,
    /// Errors that are accepted; beyond them the reduction fails.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accept: Option<AcceptJob>,
}

/// Damping of the component.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DampingJob {
    /// Share ζ of critical damping of every mode; the structural damping factor of K (1 + iη) is η = 2ζ.
    #[schemars(extend("minimum" = SMALLEST, "exclusiveMaximum" = 1, "default" = 0.01))]
    pub ratio: f64,
}

impl Default for DampingJob {
    /// One per cent of critical damping: welded and bolted metal.
    fn default() -> Self {
        Self { ratio: 0.01 }
    }
}

/// The words of [`Support`]; the mass is a decimal number above zero.
const PATTERN: &str =
    r"^(free|fix:.+|mass:[^=]+|mass:.+=\+?([0-9]*[1-9][0-9]*\.?[0-9]*|[0-9]*\.[0-9]*[1-9][0-9]*)([eE][-+]?[0-9]+)?)$";

/// How the component is supported while its frequencies are compared: `free`, `fix:NAME`, `mass:NAME` or `mass:NAME=2.5`, NAME being an
/// interface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
#[schemars(extend("pattern" = PATTERN, "examples" = ["fix:hub"]))]
pub enum Support {
    /// `free`: no interface held or loaded.
    Free,
    /// `fix:hub`: this interface held, the others free.
    Fixed {
        /// Name of the interface.
        interface: String,
    },
    /// `mass:hub` or `mass:hub=2.5`: a rigid mass on this interface, the others free.
    Loaded {
        /// Name of the interface.
        interface: String,
        /// The mass; that of the component where absent.
        mass: Option<f64>,
    },
}

impl Support {
    /// The interface it is about.
    pub fn interface(&self) -> Option<&str> {
        match self {
            Self::Free => None,
            Self::Fixed { interface } | Self::Loaded { interface, .. } => Some(interface),
        }
    }
}

impl std::fmt::Display for Support {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Free => f.write_str("free"),
            Self::Fixed { interface } => write!(f, "fix:{interface}"),
            Self::Loaded { interface, mass: None } => write!(f, "mass:{interface}"),
            Self::Loaded { interface, mass: Some(mass) } => write!(f, "mass:{interface}={mass}"),
        }
    }
}

impl From<Support> for String {
    fn from(support: Support) -> Self {
        support.to_string()
    }
}

impl TryFrom<String> for Support {
    type Error = String;

    fn try_from(text: String) -> std::result::Result<Self, String> {
        let expected = || format!("boundary `{text}`: expected `free`, `fix:NAME`, `mass:NAME` or `mass:NAME=2.5`");
        match text.split_once(':') {
            None if text == "free" => Ok(Self::Free),
            Some(("fix", name)) if !name.is_empty() => Ok(Self::Fixed { interface: name.to_owned() }),
            Some(("mass", rest)) if !rest.is_empty() => {
                let (name, mass) = rest.rsplit_once('=').map_or((rest, None), |(name, mass)| (name, Some(mass)));
                if name.is_empty() {
                    return Err(expected());
                }
                let mass = mass.map(str::parse).transpose().map_err(|_| expected())?;
                Ok(Self::Loaded { interface: name.to_owned(), mass })
            }
            _ => Err(expected()),
        }
    }
}

/// A boundary in words: `base held` for `fix:base`, `base loaded` for `mass:base`, `base loaded by 2.5` for `mass:base=2.5`;
/// names of others as they stand.
pub fn boundary_in_words(code: &str) -> String {
    if let Some(interface) = code.strip_prefix("fix:") {
        return format!("{interface} held");
    }
    let Some(loaded) = code.strip_prefix("mass:") else { return code.to_owned() };
    match loaded.rsplit_once('=').filter(|(_, mass)| mass.parse::<f64>().is_ok()) {
        Some((interface, mass)) => format!("{interface} loaded by {mass}"),
        None => format!("{loaded} loaded"),
    }
}

/// Two frequencies, the higher one above zero.
fn band_schema(_: &mut SchemaGenerator) -> Schema {
    let (low, high) = (
        json!({ "type": "number", "minimum": 0 }),
        json!({ "type": "number", "minimum": SMALLEST, "maximum": LARGEST }),
    );
    json_schema!({ "type": "array", "prefixItems": [low, high], "minItems": 2, "maxItems": 2 })
}

pub(super) fn validate(scene: &SceneJob, interfaces: &[InterfaceJob]) -> Result<()> {
    if let Some([low, high]) = scene.band_hz {
        if !(low.is_finite() && low >= 0.0) {
            return Err(number("scene.band_hz[0]".to_owned(), low, "zero or more"));
        }
        size("scene.band_hz[1]", high)?;
        if high <= low {
            return Err(number("scene.band_hz[1]".to_owned(), high, "a frequency above that of `band_hz[0]`"));
        }
    }
    for (index, support) in scene.boundaries.iter().flatten().enumerate() {
        let known = || -> BTreeSet<&str> { interfaces.iter().map(|interface| interface.name.as_str()).collect() };
        if let Some(name) = support.interface().filter(|name| !known().contains(name)) {
            return Err(Error::SceneInterface {
                boundary: support.to_string(),
                name: name.to_owned(),
                known: known().into_iter().map(str::to_owned).collect(),
            });
        }
        if let Support::Loaded { mass: Some(mass), .. } = support {
            size(&format!("scene.boundaries[{index}]"), *mass)?;
        }
    }
    if let Some(damping) = scene.damping {
        size("scene.damping.ratio", damping.ratio)?;
        if damping.ratio >= 1.0 {
            return Err(number("scene.damping.ratio".to_owned(), damping.ratio, "a share of critical damping below 1"));
        }
    }
    scene.accept.map_or(Ok(()), |accept| accept.validate())
}
