//! Arrays of whole numbers at nodes and cells, which make groups.

use std::collections::BTreeMap;

use super::group::{Group, Member};
use crate::error::Result;
use crate::input::mesh::vtk::Tags;

/// The arrays of a group that have one whole number for each item.
pub(super) fn tags_of(group: Option<Group<'_>>) -> Result<Tags> {
    let mut tags: Tags = BTreeMap::new();
    let Some(group) = group else { return Ok(tags) };
    for (name, member) in group.members()? {
        if member != Member::Dataset {
            continue;
        }
        let dataset = group.dataset(&name)?;
        if dataset.shape()?.len() == 1 && dataset.is_whole()? {
            tags.insert(name, dataset.integers()?);
        }
    }
    Ok(tags)
}
