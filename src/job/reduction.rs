//! The reduction that a job asks for: method and modes.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use super::interface_part::InterfacePart;
use super::method::Method;
use super::ranges::{LARGEST, SMALLEST};
use crate::eigen::Eigensolver;

/// Method and modes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend(
    "if" = { "properties": { "method": { "const": "guyan" } } },
    "then" = { "not": { "required": ["modes"] } },
    "allOf" = [{
        "if": { "properties": { "method": { "const": "mode-acceleration" } } },
        "then": { "required": ["modes"], "properties": { "modes": { "required": ["file"] } } },
        "else": { "properties": { "modes": { "not": { "required": ["file"] } } } },
    }, {
        "if": { "properties": { "method": { "const": "mixed-interface" } } },
        "then": { "required": ["held"] },
        "else": { "not": { "required": ["held"] } },
    }],
))]
pub struct ReductionJob {
    /// The method.
    pub method: Method,
    /// How many elastic modes, or the file that has them with mode acceleration; Guyan's method keeps none. Where it is absent, the band of
    /// the scene decides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modes: Option<ModesJob>,
    /// Whether inertia-relief modes join the basis: the answers to unit accelerations of the free component, which the methods of free
    /// modes have anyway.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub inertia_relief: bool,
    /// What is held while mixed-interface modes are computed: `"base"`, an interface, or `"hub.ux"`, a direction of one; the rest of the
    /// interfaces is free. An empty list holds nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held: Option<Vec<InterfacePart>>,
    /// Which eigensolver finds them.
    #[serde(default)]
    #[schemars(extend("x-role" = "way"))]
    pub eigensolver: Eigensolver,
}

impl ReductionJob {
    /// A method with its modes, found by Lanczos.
    pub fn new(method: Method, modes: ModeSelection) -> Self {
        let (inertia_relief, eigensolver) = (false, Eigensolver::default());
        Self { method, modes: Some(modes.into()), inertia_relief, held: None, eigensolver }
    }

    /// The modes that the job asks to be computed: none, where the method has none, a file has them, or the scene decides.
    pub fn wanted(&self) -> ModeSelection {
        match self.modes {
            Some(ModesJob::Computed(selection)) => selection,
            Some(ModesJob::Accepted { .. } | ModesJob::File { .. }) | None => ModeSelection::Count { count: 0 },
        }
    }

    /// The file of the modes, where one has them.
    pub fn modes_file(&self) -> Option<&Path> {
        match &self.modes {
            Some(ModesJob::File { file }) => Some(file),
            Some(ModesJob::Accepted { .. } | ModesJob::Computed(_)) | None => None,
        }
    }

    /// Whether inertia-relief modes are part of the basis.
    pub fn has_inertia_relief(&self) -> bool {
        self.inertia_relief || self.method.has_inertia_relief()
    }
}

/// The modes of a reduction.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(deny_unknown_fields)]
pub enum ModesJob {
    /// They are computed.
    Computed(ModeSelection),
    /// `{ accept = true }`: the fewest with which the reduced model meets what the scene accepts.
    Accepted {
        /// Always `true`.
        #[schemars(extend("const" = true))]
        accept: bool,
    },
    /// `{ file = "modes.mtx" }`: a file has them.
    File {
        /// Matrix Market, NumPy (`.npy`), or a dataset in an HDF5 file as in `model.h5:/V`: a mode in each column, a value for every row of
        /// the matrices. Frequencies are not needed.
        #[schemars(length(min = 1))]
        #[schemars(extend("x-role" = "place-of-one"))]
        file: PathBuf,
    },
}

/// How many elastic modes are kept.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(deny_unknown_fields)]
pub enum ModeSelection {
    /// `{ count = 40 }`, extended to complete clusters.
    Count {
        /// The number.
        count: usize,
    },
    /// `{ up_to_hz = 1000 }`.
    UpTo {
        /// The highest frequency.
        #[schemars(extend("minimum" = SMALLEST, "maximum" = LARGEST))]
        up_to_hz: f64,
    },
}

impl From<ModeSelection> for ModesJob {
    fn from(selection: ModeSelection) -> Self {
        Self::Computed(selection)
    }
}

// A derived untagged enum would answer every mistake with "did not match any variant".
impl<'de> Deserialize<'de> for ModesJob {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        ModeTable::deserialize(deserializer)?.try_into().map_err(serde::de::Error::custom)
    }
}

/// The keys of `modes`; exactly one of them is there.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ModeTable {
    #[serde(default, deserialize_with = "super::whole::size")]
    count: Option<usize>,
    up_to_hz: Option<f64>,
    accept: Option<bool>,
    file: Option<PathBuf>,
}

impl TryFrom<ModeTable> for ModesJob {
    type Error = &'static str;

    fn try_from(table: ModeTable) -> std::result::Result<Self, Self::Error> {
        match table {
            ModeTable { count: Some(count), up_to_hz: None, accept: None, file: None } => {
                Ok(ModeSelection::Count { count }.into())
            }
            ModeTable { count: None, up_to_hz: Some(up_to_hz), accept: None, file: None } => {
                Ok(ModeSelection::UpTo { up_to_hz }.into())
            }
            ModeTable { count: None, up_to_hz: None, accept: Some(true), file: None } => {
                Ok(Self::Accepted { accept: true })
            }
            ModeTable { count: None, up_to_hz: None, accept: None, file: Some(file) } => Ok(Self::File { file }),
            _ => Err("expected exactly one of `count`, `up_to_hz`, `accept = true` and `file`"),
        }
    }
}
