//! Degrees of freedom that the job holds at rest.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::node_selection::{NodeSelection, Region};
use super::selection::{self, Selection};
use crate::dofs::Direction;
use crate::error::{Error, Result, Selector};

/// Degrees of freedom with u = 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FixedJob {
    /// Name for messages and the report, unique among those held.
    #[schemars(regex(pattern = r"\S"))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Which nodes of the model.
    pub nodes: NodeSelection,
    /// Directions in which they are held; all that a node has where absent.
    #[schemars(length(min = 1), extend("uniqueItems" = true))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dofs: Option<Vec<Direction>>,
}

/// Labels or rows that a sentence lists; of more it says how many.
const LISTED: usize = 6;

impl FixedJob {
    /// Its name, or its place in the job where it has none.
    pub fn title(&self, index: usize) -> String {
        self.name.clone().unwrap_or_else(|| format!("fixed[{index}]"))
    }

    /// What it selects, with the name for messages.
    pub fn selection(&self, index: usize) -> Selection<'_> {
        Selection { selector: Selector::Fixed(self.title(index)), nodes: &self.nodes, directions: self.dofs.as_deref() }
    }

    /// What it takes for granted of the simulation, in a sentence without the size of the model.
    pub fn assumption(&self, index: usize) -> String {
        let directions = match &self.dofs {
            Some(directions) => directions.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "),
            None => "every direction".to_owned(),
        };
        let (what, places) = match &self.nodes {
            NodeSelection::Group(text) => ("nodes", format!("of {text}")),
            NodeSelection::Labels(labels) => ("nodes", listed(labels)),
            NodeSelection::Region { within } => ("nodes", format!("in a {}", region_word(within))),
            NodeSelection::Rows { rows } => return format!("{} is at rest: rows {}", self.title(index), listed(rows)),
        };
        format!("{} is at rest: {directions} of the {what} {places}", self.title(index))
    }
}

fn region_word(region: &Region) -> &'static str {
    match region {
        Region::Box { .. } => "box",
        Region::Plane { .. } => "slab about a plane",
        Region::Cylinder { .. } => "cylinder",
        Region::Sphere { .. } => "sphere",
    }
}

/// The first few, and how many there are in all.
fn listed<T: ToString>(items: &[T]) -> String {
    let first: Vec<String> = items.iter().take(LISTED).map(ToString::to_string).collect();
    let first = first.join(", ");
    if items.len() > LISTED { format!("{first} and {} more", items.len() - LISTED) } else { first }
}

pub(super) fn validate(fixed: &[FixedJob]) -> Result<()> {
    for (index, held) in fixed.iter().enumerate() {
        let place = format!("fixed[{index}]");
        if held.name.as_ref().is_some_and(|name| name.trim().is_empty()) {
            return Err(Error::JobEmpty { key: format!("{place}.name"), expected: "a name, or the key left out" });
        }
        if fixed[..index].iter().any(|other| other.name.is_some() && other.name == held.name) {
            return Err(Error::FixedTwice { name: held.title(index) });
        }
        let selection = held.selection(index);
        selection::validate(&selection, &place)?;
        selection::directions(&selection, &place)?;
        if matches!(held.nodes, NodeSelection::Rows { .. }) && held.dofs.is_some() {
            return Err(Error::InterfaceConflict {
                selector: selection.selector,
                key: "dofs".to_owned(),
                situation: "rows, each of which is one degree of freedom",
                remedy: "",
            });
        }
    }
    Ok(())
}
