//! CGNS in HDF5: unstructured zones with their sections of elements and boundary conditions.
//!
//! Every node of a CGNS tree is a group, and its data are the dataset ` data` in it. What a node is, is told by the names that CGNS fixes
//! for its children, as labels are texts of attributes, which are not read.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::dataset::Dataset;
use super::group::{Group, Member};
use super::mesh::Mesh;
use crate::error::{Error, Result};
use crate::input::cell_kind::{Kind, Known, kind};
use crate::input::faces::{Gathered, Shape};
use crate::input::mesh::named_apart;
use crate::number::counted;

/// The dataset of a node of the tree.
const DATA: &str = " data";
/// The type of sections whose elements say their types one by one.
const MIXED: i64 = 20;

/// Whether a file has a base with a zone of coordinates.
pub(super) fn is_of(root: &Group<'_>) -> Result<bool> {
    Ok(!zones(root)?.is_empty())
}

/// Reads nodes, sections of elements as groups, and boundary conditions as groups.
pub(super) fn read(root: &Group<'_>) -> Result<Mesh> {
    let mut coordinates: Vec<[f64; 3]> = Vec::new();
    let (mut of_nodes, mut of_elements) = (BTreeMap::new(), BTreeMap::new());
    let mut source = String::new();
    for zone in zones(root)? {
        let first = coordinates.len();
        let (own, own_source) = points_of(&zone)?;
        let nodes = first..first + own.len();
        coordinates.extend(own);
        source = own_source;
        let sections = sections(&zone, nodes.clone())?;
        for section in &sections {
            let members = of_elements.entry(section.name.clone()).or_insert_with(Vec::new);
            members.extend(section.elements.iter().flat_map(|(_, nodes)| nodes.iter().copied()));
        }
        boundary_conditions(&zone, (nodes, &sections), (&mut of_nodes, &mut of_elements))?;
    }
    for groups in [&mut of_nodes, &mut of_elements] {
        for members in groups.values_mut() {
            members.sort_unstable();
            members.dedup();
        }
    }
    Ok(Mesh { labels: None, coordinates, source, groups: named_apart(of_nodes, [("elements", of_elements)]) })
}

pub(super) fn read_cells(root: &Group<'_>, faces: &mut Gathered<'_>) -> Result<Known> {
    let mut first = 0;
    for zone in zones(root)? {
        let n_sizes = zone.find_dataset(DATA)?.map(|sizes| sizes.shape()).transpose()?;
        if n_sizes.is_some_and(|shape| shape.iter().product::<usize>() != 3) {
            return Ok(Known::Not("a structured zone".to_owned()));
        }
        let n_nodes = points_of(&zone)?.0.len();
        for section in sections(&zone, first..first + n_nodes)? {
            for (number, nodes) in &section.elements {
                match element(*number) {
                    Some((_, Kind::Faced(cell))) => faces.add(cell, nodes)?,
                    Some((_, Kind::Faceless)) => {}
                    _ => return Ok(Known::Not(format!("elements of type {number}"))),
                }
            }
        }
        first += n_nodes;
    }
    Ok(Known::All)
}

/// The zones of all bases.
fn zones<'a>(root: &Group<'a>) -> Result<Vec<Group<'a>>> {
    let mut zones = Vec::new();
    for base in root.groups()? {
        for zone in base.groups()? {
            if zone.member("GridCoordinates")? == Some(Member::Group) {
                zones.push(zone);
            }
        }
    }
    Ok(zones)
}

fn points_of(zone: &Group<'_>) -> Result<(Vec<[f64; 3]>, String)> {
    let mut points: Vec<[f64; 3]> = Vec::new();
    for (axis, name) in ["CoordinateX", "CoordinateY", "CoordinateZ"].into_iter().enumerate() {
        let path = format!("GridCoordinates/{name}/{DATA}");
        let dataset = if axis == 0 { Some(zone.dataset(&path)?) } else { zone.find_dataset(&path)? };
        let Some(dataset) = dataset else { continue };
        let values = dataset.reals()?.values;
        if axis == 0 {
            points = vec![[0.0; 3]; values.len()];
        }
        if values.len() != points.len() {
            let expected = format!("{}, as for x", points.len());
            return Err(dataset.wrong_shape(counted(values.len(), "value", "values"), expected));
        }
        points.iter_mut().zip(values).for_each(|(point, value)| point[axis] = value);
    }
    Ok((points, zone.child_name("GridCoordinates")))
}

/// Elements of a section.
struct Section {
    name: String,
    /// Number of the first element.
    first: i64,
    /// Type and nodes of each.
    elements: Vec<(i64, Vec<usize>)>,
}

fn sections(zone: &Group<'_>, nodes: Range<usize>) -> Result<Vec<Section>> {
    let mut sections = Vec::new();
    for group in zone.groups()? {
        if group.member("ElementConnectivity")? != Some(Member::Group) {
            continue;
        }
        let connectivity = group.dataset(&format!("ElementConnectivity/{DATA}"))?;
        let range = group.dataset(&format!("ElementRange/{DATA}"))?.integers()?;
        let numbers = connectivity.integers()?;
        refuse_parents_alone(&group, &connectivity, &numbers)?;
        let number = match group.find_dataset(DATA)? {
            Some(data) => data.integers()?.first().copied().unwrap_or_default(),
            // meshio states no type and writes tetrahedra alone.
            None => 10,
        };
        let name = group.name().rsplit('/').next().unwrap_or_default().to_owned();
        let elements = elements(&connectivity, &numbers, number, &nodes)?;
        sections.push(Section { name, first: range.first().copied().unwrap_or(1), elements });
    }
    Ok(sections)
}

/// Refuses a section whose faces are given by the elements that they belong to, in place of nodes.
fn refuse_parents_alone(section: &Group<'_>, connectivity: &Dataset<'_>, numbers: &[i64]) -> Result<()> {
    let has_nodes = numbers.iter().any(|number| *number != 0);
    if has_nodes || numbers.is_empty() || section.member("ParentElements")?.is_none() {
        return Ok(());
    }
    Err(Error::MeshUnsupported {
        path: connectivity.path().to_owned(),
        object: connectivity.name().to_owned(),
        found:
            "faces that are given by the elements they belong to (ParentElements), with zeros in place of their nodes"
                .to_owned(),
        expected: "the nodes of each face – write them into ElementConnectivity, or leave the section out",
    })
}

fn elements(
    connectivity: &Dataset<'_>,
    numbers: &[i64],
    number: i64,
    nodes: &Range<usize>,
) -> Result<Vec<(i64, Vec<usize>)>> {
    let unsupported = |number: i64| Error::MeshUnsupported {
        path: connectivity.path().to_owned(),
        object: connectivity.name().to_owned(),
        found: format!("elements of type {number}"),
        expected: "elements to the second order, or a mixture of them",
    };
    let mut elements = Vec::new();
    let mut at = 0;
    while at < numbers.len() {
        let own = if number == MIXED { numbers[at] } else { number };
        at += usize::from(number == MIXED);
        let Some((n_nodes, _)) = element(own) else { return Err(unsupported(own)) };
        let Some(labels) = at.checked_add(n_nodes).and_then(|end| numbers.get(at..end)) else {
            let expected = format!("{n_nodes} more for the element that begins at value {at}");
            return Err(connectivity.wrong_shape(counted(numbers.len(), "value", "values"), expected));
        };
        let index = |(corner, label): (usize, &i64)| {
            Ok(nodes.start + connectivity.checked_index(at + corner, *label, 1, nodes.len())?)
        };
        elements.push((own, labels.iter().enumerate().map(index).collect::<Result<Vec<usize>>>()?));
        at += n_nodes;
    }
    Ok(elements)
}

/// Groups of members.
type Groups = BTreeMap<String, Vec<usize>>;

/// The nodes of boundary conditions, which list nodes, or elements by their numbers.
fn boundary_conditions(
    zone: &Group<'_>,
    (nodes, sections): (Range<usize>, &[Section]),
    (of_nodes, of_elements): (&mut Groups, &mut Groups),
) -> Result<()> {
    let conditions = zone.find_group("ZoneBC")?.map(|group| group.groups()).transpose()?.unwrap_or_default();
    for condition in conditions {
        let name = condition.name().rsplit('/').next().unwrap_or_default().to_owned();
        let place = condition.find_dataset(&format!("GridLocation/{DATA}"))?.map(|text| text.integers()).transpose()?;
        let place: String =
            place.unwrap_or_default().iter().filter_map(|c| u8::try_from(*c).ok()).map(char::from).collect();
        let list = |name: &str| condition.find_dataset(&format!("{name}/{DATA}"));
        for (kind, is_range) in
            [("PointList", false), ("PointRange", true), ("ElementList", false), ("ElementRange", true)]
        {
            let Some(dataset) = list(kind)? else { continue };
            let numbers = dataset.integers()?;
            let is_of_nodes = kind.starts_with("Point") && matches!(place.trim_end_matches('\0').trim(), "" | "Vertex");
            let listed: BTreeSet<i64> = if is_range { BTreeSet::new() } else { numbers.iter().copied().collect() };
            let is_member = |number: i64| match numbers[..] {
                [first, last] if is_range => (first..=last).contains(&number),
                _ => listed.contains(&number),
            };
            if is_of_nodes {
                let members = (1..).zip(nodes.clone()).filter(|(number, _)| is_member(*number)).map(|(_, node)| node);
                of_nodes.entry(name.clone()).or_default().extend(members);
                continue;
            }
            for section in sections {
                let numbered = (section.first..).zip(&section.elements).filter(|(number, _)| is_member(*number));
                let members = numbered.flat_map(|(_, (_, nodes))| nodes.iter().copied());
                of_elements.entry(name.clone()).or_default().extend(members);
            }
        }
    }
    Ok(())
}

/// Number of nodes and kind of an element type of CGNS.
fn element(number: i64) -> Option<(usize, Kind)> {
    let faced = |shape, n_nodes| Some((n_nodes, kind(shape, n_nodes)));
    match number {
        2 => Some((1, Kind::Faceless)),
        3 => Some((2, Kind::Faceless)),
        4 => Some((3, Kind::Faceless)),
        5 => faced(Shape::Triangle, 3),
        6 => faced(Shape::Triangle, 6),
        7 => faced(Shape::Quadrilateral, 4),
        8 => faced(Shape::Quadrilateral, 8),
        9 => faced(Shape::Quadrilateral, 9),
        10 => faced(Shape::Tetrahedron, 4),
        11 => faced(Shape::Tetrahedron, 10),
        12 => faced(Shape::Pyramid, 5),
        13 => faced(Shape::Pyramid, 14),
        14 => faced(Shape::Wedge, 6),
        15 => faced(Shape::Wedge, 15),
        16 => faced(Shape::Wedge, 18),
        17 => faced(Shape::Brick, 8),
        18 => faced(Shape::Brick, 20),
        19 => faced(Shape::Brick, 27),
        21 => faced(Shape::Pyramid, 13),
        _ => None,
    }
}
