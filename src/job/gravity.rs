//! What gravity, and acceleration of the whole component, the simulation has.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::ranges;
use crate::error::Result;

/// Whether there is gravity, or its direction in the axes of the model where it has one alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected true, false or a direction [x, y, z]")]
pub enum GravityJob {
    /// `true`: in any direction. `false`: neither gravity nor acceleration of the whole deflects the component.
    Anywhere(bool),
    /// `[0, 0, -1]`: in this direction of the model alone, whose length does not matter.
    Along([f64; 3]),
}

impl GravityJob {
    /// The one direction in which gravity acts, of unit length; zero where there is none, nothing where it may act in any.
    pub fn direction(self) -> Option<[f64; 3]> {
        match self {
            Self::Anywhere(true) => None,
            Self::Anywhere(false) => Some([0.0; 3]),
            Self::Along(direction) => {
                let largest = direction.iter().fold(0.0f64, |max, x| max.max(x.abs()));
                let scaled = direction.map(|x| x / largest);
                let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
                Some(scaled.map(|x| x / length))
            }
        }
    }

    pub(super) fn validate(self) -> Result<()> {
        match self {
            Self::Anywhere(_) => Ok(()),
            Self::Along(direction) => ranges::direction("scene.gravity", &direction),
        }
    }
}
