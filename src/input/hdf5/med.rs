//! `.med`: the format of Code_Aster and Salome.

use super::attribute;
use super::group::{Group, Member};
use super::med_groups::read_groups;
use super::mesh::{Mesh, points};
use crate::error::{Error, Result};
use crate::number::counted;

/// Reads the one mesh of a MED file with its labels and its node and element groups.
pub(super) fn read(root: &Group<'_>) -> Result<Mesh> {
    let mesh = mesh(root)?;
    let n_axes = dimension(&mesh)?;
    let step = step(&mesh)?;
    let nodes = step.group("NOE")?;
    let coordinates = nodes.dataset("COO")?;
    let values = coordinates.reals()?.values;
    let n_nodes = values.len() / n_axes;
    let stated = coordinates.integer_attribute("NBR")?;
    if !values.len().is_multiple_of(n_axes) || stated.is_some_and(|n| usize::try_from(n) != Ok(n_nodes)) {
        let stated = stated.map_or_else(|| "some".to_owned(), |n| n.to_string());
        let expected = format!("{n_axes} for each of {stated} nodes");
        return Err(coordinates.wrong_shape(counted(values.len(), "value", "values"), expected));
    }
    let labels = match nodes.find_dataset("NUM")? {
        Some(numbers) => Some((numbers.integers()?, numbers.name().to_owned())),
        None => None,
    };
    let groups = read_groups(root, &mesh, &step, n_nodes)?;
    let coordinates_by_node = points(&by_node(&values, n_nodes, n_axes), n_axes);
    Ok(Mesh { labels, coordinates: coordinates_by_node, source: coordinates.name().to_owned(), groups })
}

/// The one mesh of a file.
pub(super) fn mesh<'a>(root: &Group<'a>) -> Result<Group<'a>> {
    let meshes = root.group("ENS_MAA")?;
    only(meshes.groups()?, &meshes, "mesh")
}

/// The one computation step of a mesh, each of which has a group; files of version 2 have none.
pub(super) fn step<'a>(mesh: &Group<'a>) -> Result<Group<'a>> {
    if mesh.member("NOE")? == Some(Member::Group) { mesh.group("") } else { only(mesh.groups()?, mesh, "step") }
}

/// The one group of a list.
fn only<'a>(mut groups: Vec<Group<'a>>, parent: &Group<'a>, kind: &'static str) -> Result<Group<'a>> {
    match groups.pop() {
        Some(group) if groups.is_empty() => Ok(group),
        last => {
            let found = groups.iter().chain(&last).map(|g| g.name().to_owned()).collect();
            let (path, object) = (parent.h5().path().to_owned(), parent.name().to_owned());
            Err(Error::MeshNotOne { path, object, found, kind })
        }
    }
}

/// Number of coordinates of a node, in a cartesian frame.
fn dimension(mesh: &Group<'_>) -> Result<usize> {
    let number = |name| attribute::integers(mesh.h5(), mesh.location(), mesh.name(), name);
    let first = |values: Option<Vec<i64>>| values.and_then(|v| v.first().copied());
    let unsupported = |name: &str, found: i64, expected| {
        let (path, object) = (mesh.h5().path().to_owned(), format!("{}@{name}", mesh.name()));
        Err(Error::MeshUnsupported { path, object, found: found.to_string(), expected })
    };
    if let Some(frame @ 1..) = first(number("REP")?) {
        return unsupported("REP", frame, "0, cartesian coordinates");
    }
    match first(number("ESP")?) {
        Some(1) => Ok(1),
        Some(2) => Ok(2),
        Some(3) => Ok(3),
        Some(other) => unsupported("ESP", other, "1, 2 or 3 space dimensions"),
        None => {
            let (path, object) = (mesh.h5().path().to_owned(), format!("{}@ESP", mesh.name()));
            Err(Error::Hdf5Missing { path, object, kind: "attribute" })
        }
    }
}

/// MED stores all x, then all y, then all z.
fn by_node(values: &[f64], n_nodes: usize, n_axes: usize) -> Vec<f64> {
    let mut turned = Vec::with_capacity(values.len());
    for node in 0..n_nodes {
        turned.extend((0..n_axes).map(|axis| values[axis * n_nodes + node]));
    }
    turned
}
