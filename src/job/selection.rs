//! Nodes that a part of the job selects, and whether that selects something.

use std::collections::BTreeSet;

use super::node_selection::{NodeSelection, Region};
use super::ranges::{self, direction, finite, not_negative, number, positive};
use crate::dofs::Direction;
use crate::error::{Error, Result, Selector};

/// Nodes of the model that a part of the job selects, and in which directions.
#[derive(Clone, Debug)]
pub struct Selection<'a> {
    /// Which part of the job.
    pub selector: Selector,
    /// The nodes.
    pub nodes: &'a NodeSelection,
    /// Their directions; all that they have where none are listed.
    pub directions: Option<&'a [Direction]>,
}

pub(super) fn validate(selection: &Selection<'_>, place: &str) -> Result<()> {
    let key = format!("{place}.nodes");
    let repeats = |what: Option<String>| match what {
        Some(what) => Err(Error::InterfaceRepeats { selector: selection.selector.clone(), what }),
        None => Ok(()),
    };
    match selection.nodes {
        NodeSelection::Labels(labels) if labels.is_empty() => {
            Err(Error::JobEmpty { key, expected: "the labels of one or more nodes" })
        }
        NodeSelection::Rows { rows } if rows.is_empty() => {
            Err(Error::JobEmpty { key: key + ".rows", expected: "the numbers of one or more rows" })
        }
        NodeSelection::Labels(labels) => repeats(first_repeated(labels).map(|label| format!("node {label}"))),
        NodeSelection::Rows { rows } => repeats(first_repeated(rows).map(|row| format!("row {row}"))),
        NodeSelection::Region { within } => region(within, &format!("{key}.within")),
        NodeSelection::Group(text) => match selection.nodes.group_name() {
            Some(name) if !name.is_empty() => Ok(()),
            _ => Err(Error::InterfaceNodes { selector: selection.selector.clone(), text: text.clone() }),
        },
    }
}

/// Directions where some are listed: one at least, none twice.
pub(super) fn directions(selection: &Selection<'_>, place: &str) -> Result<()> {
    let Some(directions) = selection.directions else {
        return Ok(());
    };
    if directions.is_empty() {
        return Err(Error::JobEmpty {
            key: format!("{place}.dofs"),
            expected: "one or more of ux, uy, uz, rx, ry, rz",
        });
    }
    match first_repeated(directions) {
        Some(direction) => Err(Error::InterfaceRepeats {
            selector: selection.selector.clone(),
            what: format!("direction {direction}"),
        }),
        None => Ok(()),
    }
}

fn region(region: &Region, place: &str) -> Result<()> {
    match region {
        Region::Box { min, max } => {
            finite(&format!("{place}.box.min"), min)?;
            finite(&format!("{place}.box.max"), max)?;
            match min.iter().zip(max).find(|(low, high)| low > high) {
                Some((_, high)) => {
                    Err(number(format!("{place}.box.max"), *high, "no coordinate smaller than that of `min`"))
                }
                None => Ok(()),
            }
        }
        Region::Plane { point, normal, tolerance } => {
            ranges::point(&format!("{place}.plane.point"), point)?;
            direction(&format!("{place}.plane.normal"), normal)?;
            not_negative(&format!("{place}.plane.tolerance"), *tolerance)
        }
        Region::Cylinder { from, to, radius, inner_radius } => {
            ranges::point(&format!("{place}.cylinder.from"), from)?;
            ranges::point(&format!("{place}.cylinder.to"), to)?;
            direction(&format!("{place}.cylinder.to"), &std::array::from_fn(|axis| to[axis] - from[axis]))?;
            positive(&format!("{place}.cylinder.radius"), *radius)?;
            not_negative(&format!("{place}.cylinder.inner_radius"), *inner_radius)?;
            if inner_radius > radius {
                return Err(number(format!("{place}.cylinder.inner_radius"), *inner_radius, "at most `radius`"));
            }
            Ok(())
        }
        Region::Sphere { center, radius } => {
            ranges::point(&format!("{place}.sphere.center"), center)?;
            positive(&format!("{place}.sphere.radius"), *radius)
        }
    }
}

pub(super) fn first_repeated<T: Ord + Copy>(items: &[T]) -> Option<T> {
    let mut seen = BTreeSet::new();
    items.iter().copied().find(|item| !seen.insert(*item))
}
