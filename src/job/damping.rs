//! Damping of the component that the superelement carries.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::json;

use super::ranges::{LARGEST, not_large, not_negative, number};
use crate::error::{Error, Result};

/// Damping that is made from the reduced matrices, and what damping may do to rigid-body motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ComponentDampingJob {
    /// Rayleigh damping, in proportion to mass and stiffness.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rayleigh: Option<RayleighJob>,
    /// Modal damping, by shares of critical damping.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modal: Option<ModalDampingJob>,
    /// What becomes of damping that resists rigid-body motion of the component.
    #[serde(default, skip_serializing_if = "RigidMotionDamping::is_refused")]
    #[schemars(extend("default" = "refuse"))]
    pub rigid_motion: RigidMotionDamping,
}

/// What becomes of damping that resists rigid-body motion of the component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum RigidMotionDamping {
    /// It is an error: nothing inside a body resists its motion as a whole.
    #[default]
    Refuse,
    /// It is meant, as of a body in a fluid or on dampers to the ground.
    Resist,
}

impl RigidMotionDamping {
    fn is_refused(&self) -> bool {
        *self == Self::Refuse
    }
}

/// C = α M + β K.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RayleighJob {
    /// α, one over the unit of time.
    #[schemars(extend("minimum" = 0, "maximum" = LARGEST))]
    pub mass: f64,
    /// β, in the unit of time.
    #[schemars(extend("minimum" = 0, "maximum" = LARGEST))]
    pub stiffness: f64,
    /// What the share of the mass acts on.
    #[serde(default, skip_serializing_if = "MassActsOn::is_motion")]
    #[schemars(extend("default" = "motion"))]
    pub mass_acts_on: MassActsOn,
}

/// What damping in proportion to the mass acts on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum MassActsOn {
    /// The whole motion, that as a rigid body among it.
    #[default]
    Motion,
    /// The deformation: what is left of the motion without the rigid-body motion of the same momentum.
    Deformation,
}

impl MassActsOn {
    fn is_motion(&self) -> bool {
        *self == Self::Motion
    }
}

/// Shares ζ of critical damping of the elastic modes that the reduced component has with its interface free.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(deny_unknown_fields)]
pub enum ModalDampingJob {
    /// `{ ratio = 0.01 }`: the same for every mode.
    Ratio {
        /// ζ.
        #[schemars(extend("minimum" = 0, "exclusiveMaximum" = 1))]
        ratio: f64,
    },
    /// `{ ratios = [0.01, 0.02] }`: by modes in the order of their frequencies; the last one holds for all that follow.
    Ratios {
        /// ζ of each mode.
        #[schemars(schema_with = "ratios_schema")]
        ratios: Vec<f64>,
    },
    /// `{ table = [[10, 0.01], [500, 0.03]] }`: by frequencies in Hz, straight between them, and constant beyond the first and the last.
    Table {
        /// Frequency in Hz and ζ there, in ascending order.
        #[schemars(schema_with = "table_schema")]
        table: Vec<[f64; 2]>,
    },
}

// A derived untagged enum would answer every mistake with "did not match any variant".
impl<'de> Deserialize<'de> for ModalDampingJob {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        ModalTable::deserialize(deserializer)?.try_into().map_err(serde::de::Error::custom)
    }
}

/// The keys of `modal`; exactly one of them is there.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ModalTable {
    ratio: Option<f64>,
    ratios: Option<Vec<f64>>,
    table: Option<Vec<[f64; 2]>>,
}

impl TryFrom<ModalTable> for ModalDampingJob {
    type Error = &'static str;

    fn try_from(table: ModalTable) -> std::result::Result<Self, Self::Error> {
        match table {
            ModalTable { ratio: Some(ratio), ratios: None, table: None } => Ok(Self::Ratio { ratio }),
            ModalTable { ratio: None, ratios: Some(ratios), table: None } => Ok(Self::Ratios { ratios }),
            ModalTable { ratio: None, ratios: None, table: Some(table) } => Ok(Self::Table { table }),
            _ => Err("expected exactly one of `ratio`, `ratios` and `table`"),
        }
    }
}

impl ModalDampingJob {
    /// ζ of a mode by its number, from zero among the elastic ones, and its frequency in Hz.
    pub fn ratio_of(&self, mode: usize, frequency_hz: f64) -> f64 {
        match self {
            Self::Ratio { ratio } => *ratio,
            Self::Ratios { ratios } => ratios.get(mode).or(ratios.last()).copied().unwrap_or_default(),
            Self::Table { table } => interpolated(table, frequency_hz),
        }
    }

    /// How many modes are named one by one.
    pub fn n_named(&self) -> usize {
        match self {
            Self::Ratios { ratios } => ratios.len(),
            Self::Ratio { .. } | Self::Table { .. } => 0,
        }
    }
}

/// Straight between the rows of a table that ascends, constant beyond its ends.
fn interpolated(table: &[[f64; 2]], x: f64) -> f64 {
    let above = table.partition_point(|[at, _]| *at <= x);
    match (above.checked_sub(1).map(|below| table[below]), table.get(above)) {
        (Some([_, low]), None) => low,
        (None, Some([_, high])) => *high,
        (Some([left, low]), Some([right, high])) => low + (high - low) * ((x - left) / (right - left)),
        (None, None) => 0.0,
    }
}

impl ComponentDampingJob {
    /// Whether it makes damping of the reduced matrices.
    pub fn has_law(&self) -> bool {
        self.rayleigh.is_some() || self.modal.is_some()
    }
}

/// One share of critical damping or more.
fn ratios_schema(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "minItems": 1, "items": ratio() })
}

fn table_schema(_: &mut SchemaGenerator) -> Schema {
    let frequency = json!({ "type": "number", "minimum": 0, "maximum": LARGEST });
    let row = json!({ "type": "array", "prefixItems": [frequency, ratio()], "minItems": 2, "maxItems": 2 });
    json_schema!({ "type": "array", "minItems": 1, "uniqueItems": true, "items": row })
}

fn ratio() -> serde_json::Value {
    json!({ "type": "number", "minimum": 0, "exclusiveMaximum": 1 })
}

pub(super) fn validate(damping: &ComponentDampingJob) -> Result<()> {
    if let Some(RayleighJob { mass, stiffness, .. }) = damping.rayleigh {
        not_large("damping.rayleigh.mass", mass)?;
        not_large("damping.rayleigh.stiffness", stiffness)?;
    }
    let listed = |key: &str, n: usize| match n {
        0 => Err(Error::JobEmpty { key: key.to_owned(), expected: "a row at least" }),
        _ => Ok(()),
    };
    match &damping.modal {
        None => Ok(()),
        Some(ModalDampingJob::Ratio { ratio }) => share("damping.modal.ratio", *ratio),
        Some(ModalDampingJob::Ratios { ratios }) => {
            listed("damping.modal.ratios", ratios.len())?;
            ratios.iter().enumerate().try_for_each(|(at, ratio)| share(&format!("damping.modal.ratios[{at}]"), *ratio))
        }
        Some(ModalDampingJob::Table { table }) => {
            listed("damping.modal.table", table.len())?;
            for (at, [frequency, ratio]) in table.iter().enumerate() {
                let key = format!("damping.modal.table[{at}]");
                not_large(&format!("{key}[0]"), *frequency)?;
                share(&format!("{key}[1]"), *ratio)?;
                if at > 0 && *frequency <= table[at - 1][0] {
                    return Err(number(format!("{key}[0]"), *frequency, "a frequency above that of the row before"));
                }
            }
            Ok(())
        }
    }
}

fn share(key: &str, ratio: f64) -> Result<()> {
    not_negative(key, ratio)?;
    if ratio < 1.0 { Ok(()) } else { Err(number(key.to_owned(), ratio, "a share of critical damping below 1")) }
}
