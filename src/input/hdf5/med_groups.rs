//! Groups of a MED mesh. A node or element belongs to one family, and a family to any number of named groups.

use std::collections::{BTreeMap, BTreeSet};

use super::attribute;
use super::dataset::Dataset;
use super::file::Group;
use crate::error::{Error, Result};

/// Names of the groups of each family number.
type Families = BTreeMap<i64, Vec<String>>;
/// Node indices of each group.
type Sets = BTreeMap<String, BTreeSet<usize>>;

/// The groups of nodes, and the groups of elements as the nodes of their elements.
pub(super) fn read_groups(
    root: &Group<'_>,
    mesh: &Group<'_>,
    step: &Group<'_>,
    n_nodes: usize,
) -> Result<BTreeMap<String, Vec<usize>>> {
    let mesh_name = mesh.name().rsplit('/').next().unwrap_or_default();
    let Some(families) = root.find_group("FAS")?.map(|fas| fas.find_group(mesh_name)).transpose()?.flatten() else {
        return Ok(BTreeMap::new());
    };
    let of_nodes = node_groups(&read_families(&families, "NOEUD")?, step, n_nodes)?;
    let of_elements = element_groups(&read_families(&families, "ELEME")?, step, n_nodes)?;
    let mut groups = of_nodes;
    for (name, nodes) in of_elements {
        match groups.get(&name) {
            Some(same) if *same == nodes => {}
            Some(_) => drop(groups.insert(format!("{name} (elements)"), nodes)),
            None => drop(groups.insert(name, nodes)),
        }
    }
    Ok(groups.into_iter().map(|(name, nodes)| (name, nodes.into_iter().collect())).collect())
}

/// Families with their group names; those without names say nothing to a user.
fn read_families(families: &Group<'_>, kind: &str) -> Result<Families> {
    let mut names = Families::new();
    let Some(of_kind) = families.find_group(kind)? else {
        return Ok(names);
    };
    for family in of_kind.groups()? {
        let number = attribute::integers(family.h5(), family.location(), family.name(), "NUM")?;
        let Some(number) = number.and_then(|v| v.first().copied()) else {
            let (path, object) = (family.h5().path().to_owned(), format!("{}@NUM", family.name()));
            return Err(Error::Hdf5Missing { path, object, kind: "attribute" });
        };
        if let Some(table) = family.find_dataset("GRO/NOM")? {
            let of_family = names.entry(number).or_default();
            of_family.extend(table.names()?.into_iter().filter(|name| !name.is_empty()));
        }
    }
    Ok(names)
}

fn node_groups(families: &Families, step: &Group<'_>, n_nodes: usize) -> Result<Sets> {
    let mut sets = Sets::new();
    let Some(family) = step.find_dataset("NOE/FAM")? else {
        return Ok(sets);
    };
    let numbers = family.integers()?;
    if numbers.len() != n_nodes {
        return Err(family.wrong_shape(format!("{} values", numbers.len()), format!("one for each of {n_nodes} nodes")));
    }
    for (node, number) in numbers.iter().enumerate() {
        for name in families.get(number).into_iter().flatten() {
            sets.entry(name.clone()).or_default().insert(node);
        }
    }
    Ok(sets)
}

fn element_groups(families: &Families, step: &Group<'_>, n_nodes: usize) -> Result<Sets> {
    let mut sets = Sets::new();
    if families.is_empty() {
        return Ok(sets);
    }
    let kinds = step.find_group("MAI")?.map(|mai| mai.groups()).transpose()?.unwrap_or_default();
    for kind in kinds {
        let Some(family) = kind.find_dataset("FAM")? else {
            continue;
        };
        let numbers = family.integers()?;
        if !numbers.iter().any(|n| families.contains_key(n)) {
            continue;
        }
        if kind.member("INN")?.is_some() {
            let (path, object) = (kind.h5().path().to_owned(), kind.name().to_owned());
            let found = "a group of polygons or polyhedra".to_owned();
            let expected = "groups of elements with a fixed number of nodes";
            return Err(Error::MeshUnsupported { path, object, found, expected });
        }
        add_elements(&mut sets, families, &numbers, &kind.dataset("NOD")?, n_nodes)?;
    }
    Ok(sets)
}

/// Adds the nodes of all elements of one kind; `NOD` holds the first node of every element, then the second, and so on.
fn add_elements(
    sets: &mut Sets,
    families: &Families,
    numbers: &[i64],
    connectivity: &Dataset<'_>,
    n_nodes: usize,
) -> Result<()> {
    let nodes = connectivity.integers()?;
    let n_elements = numbers.len();
    if nodes.is_empty() || !nodes.len().is_multiple_of(n_elements) {
        let expected = format!("a multiple of the {n_elements} elements");
        return Err(connectivity.wrong_shape(format!("{} values", nodes.len()), expected));
    }
    for (position, &node) in nodes.iter().enumerate() {
        let Some(names) = families.get(&numbers[position % n_elements]) else {
            continue;
        };
        let node = connectivity.checked_index(position, node, 1, n_nodes)?;
        for name in names {
            sets.entry(name.clone()).or_default().insert(node);
        }
    }
    Ok(())
}
