//! Whether a selection of nodes selects something.

use std::collections::BTreeSet;

use super::interface::{InterfaceJob, NodeSelection, Region};
use super::ranges::{self, direction, finite, not_negative, number, positive};
use crate::error::{Error, Result};

pub(super) fn selection(interface: &InterfaceJob, place: &str) -> Result<()> {
    let key = format!("{place}.nodes");
    let repeats = |what: Option<String>| match what {
        Some(what) => Err(Error::InterfaceRepeats { interface: interface.name.clone(), what }),
        None => Ok(()),
    };
    match &interface.nodes {
        NodeSelection::Labels(labels) if labels.is_empty() => {
            Err(Error::JobEmpty { key, expected: "the labels of one or more nodes" })
        }
        NodeSelection::Rows { rows } if rows.is_empty() => {
            Err(Error::JobEmpty { key: key + ".rows", expected: "the numbers of one or more rows" })
        }
        NodeSelection::Labels(labels) => repeats(first_repeated(labels).map(|label| format!("node {label}"))),
        NodeSelection::Rows { rows } => repeats(first_repeated(rows).map(|row| format!("row {row}"))),
        NodeSelection::Region { within } => region(within, &format!("{key}.within")),
        NodeSelection::Group(text) => match interface.nodes.group_name() {
            Some(name) if !name.is_empty() => Ok(()),
            _ => Err(Error::InterfaceNodes { interface: interface.name.clone(), text: text.clone() }),
        },
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
