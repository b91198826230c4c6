//! `.h5m`: the format of MOAB. Nodes, elements and sets share one numbering, the file ids.

use super::group::{Group, Member};
use super::mesh::{Mesh, points_of_rows};
use super::moab_sets::read_sets;
use crate::error::{Error, Result};

/// Reads nodes with their file ids as labels, and the sets that carry a boundary condition number.
pub(super) fn read(root: &Group<'_>) -> Result<Mesh> {
    let tstt = root.group("tstt")?;
    let dataset = tstt.dataset("nodes/coordinates")?;
    let coordinates = points_of_rows(&dataset)?;
    let first = dataset.integer_attribute("start_id")?.unwrap_or(1);
    let n_nodes = coordinates.len() as i64;
    let Some(end) = first.checked_add(n_nodes).filter(|_| first >= 0) else {
        let (path, object) = (root.h5().path().to_owned(), format!("{}@start_id", dataset.name()));
        let expected = "the file id of the first node";
        return Err(Error::Hdf5Type { path, object, found: first.to_string(), expected });
    };
    let groups = match tstt.member("sets")? {
        Some(Member::Group) => read_sets(&tstt, first..end)?,
        _ => Default::default(),
    };
    let source = dataset.name().to_owned();
    Ok(Mesh { labels: Some(((first..end).collect(), source.clone())), coordinates, source, groups })
}
