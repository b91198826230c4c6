//! Groups of a MED mesh. A node or element belongs to one family, and a family to any number of named groups.

use std::collections::{BTreeMap, BTreeSet};

use super::attribute;
use super::dataset::Dataset;
use super::file::H5;
use super::group::Group;
use crate::error::{Error, Result};
use crate::input::mesh::named_apart;
use crate::number::counted;

/// Names of the groups of each family number.
type Families = BTreeMap<i64, Vec<String>>;
/// More groups than the nodes and elements of a real mesh belong to, on average.
const MAX_GROUPS_EACH: usize = 64;
/// Bytes of a node in a group.
const MEMBER: u64 = 24;
/// Members after which their memory is claimed.
const MEMBERS_PER_CLAIM: usize = 1 << 14;

/// Node indices of each group.
type Groups = BTreeMap<String, BTreeSet<usize>>;

/// Groups that are being filled. A family may name any number of groups, and any number of nodes a family.
struct Sets<'a> {
    groups: Groups,
    h5: &'a H5<'a>,
    n_steps: usize,
    limit: usize,
}

impl<'a> Sets<'a> {
    fn new(step: &Group<'a>) -> Self {
        Self { groups: Groups::new(), h5: step.h5(), n_steps: 0, limit: 0 }
    }

    /// So many nodes or corners of elements come.
    fn expect(&mut self, n_values: usize) {
        self.limit = self.limit.saturating_add(n_values.saturating_mul(MAX_GROUPS_EACH));
    }

    /// Puts a node into groups.
    fn add(&mut self, names: &[String], node: usize) -> Result<()> {
        for name in names {
            self.n_steps += 1;
            if self.n_steps.is_multiple_of(MEMBERS_PER_CLAIM) {
                self.h5.hold(MEMBER * MEMBERS_PER_CLAIM as u64)?;
            }
            if self.n_steps > self.limit {
                let (path, object, limit) = (self.h5.path().to_owned(), "/FAS".to_owned(), self.limit);
                return Err(Error::Hdf5Depth { path, object, limit, counted: "members of groups" });
            }
            self.groups.entry(name.clone()).or_default().insert(node);
        }
        Ok(())
    }
}

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
    let listed = |groups: Groups| groups.into_iter().map(|(name, nodes)| (name, nodes.into_iter().collect())).collect();
    Ok(named_apart(listed(of_nodes), [("elements", listed(of_elements))]))
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

fn node_groups(families: &Families, step: &Group<'_>, n_nodes: usize) -> Result<Groups> {
    let mut sets = Sets::new(step);
    let Some(family) = step.find_dataset("NOE/FAM")? else {
        return Ok(Groups::new());
    };
    let numbers = family.integers()?;
    if numbers.len() != n_nodes {
        return Err(family.wrong_shape(
            counted(numbers.len(), "value", "values"),
            format!("one for each of {}", counted(n_nodes, "node", "nodes")),
        ));
    }
    sets.expect(n_nodes);
    for (node, number) in numbers.iter().enumerate() {
        sets.add(families.get(number).map_or(&[], Vec::as_slice), node)?;
    }
    Ok(sets.groups)
}

fn element_groups(families: &Families, step: &Group<'_>, n_nodes: usize) -> Result<Groups> {
    let mut sets = Sets::new(step);
    if families.is_empty() {
        return Ok(Groups::new());
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
    Ok(sets.groups)
}

/// Adds the nodes of all elements of one kind; `NOD` holds the first node of every element, then the second, and so on.
fn add_elements(
    sets: &mut Sets<'_>,
    families: &Families,
    numbers: &[i64],
    connectivity: &Dataset<'_>,
    n_nodes: usize,
) -> Result<()> {
    let nodes = connectivity.integers()?;
    let n_elements = numbers.len();
    if nodes.is_empty() || !nodes.len().is_multiple_of(n_elements) {
        let expected = format!("a multiple of the {n_elements} elements");
        return Err(connectivity.wrong_shape(counted(nodes.len(), "value", "values"), expected));
    }
    sets.expect(nodes.len());
    for (position, &node) in nodes.iter().enumerate() {
        let Some(names) = families.get(&numbers[position % n_elements]) else {
            continue;
        };
        let node = connectivity.checked_index(position, node, 1, n_nodes)?;
        sets.add(names, node)?;
    }
    Ok(())
}
