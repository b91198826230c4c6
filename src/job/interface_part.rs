//! A part of the interface by name: an interface, or a direction of one.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::dofs::Direction;

/// An interface, `base`, or a direction of one, `hub.ux`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(extend("minLength" = 1, "examples" = ["base", "hub.ux"]))]
pub struct InterfacePart(pub String);

impl InterfacePart {
    /// The interface it names, and the direction where it names one. A name wins over a direction: an interface may be called `hub.ux`.
    pub fn of(&self, is_interface: impl Fn(&str) -> bool) -> Option<(&str, Option<Direction>)> {
        if is_interface(&self.0) {
            return Some((&self.0, None));
        }
        let (name, direction) = self.ending()?;
        is_interface(name).then_some((name, Some(direction)))
    }

    /// What stands before the direction that it ends with, and that direction; none where it ends with none.
    pub fn ending(&self) -> Option<(&str, Direction)> {
        let (name, direction) = self.0.rsplit_once('.')?;
        let direction = Direction::ALL.into_iter().find(|known| known.to_string() == direction)?;
        Some((name, direction))
    }
}
