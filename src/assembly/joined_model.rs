//! The assembly as one model: its matrices with nothing held, what each row is, and what is left to be joined.
//!
//! Joined coordinates are one row. Two interface nodes are one node where they are joined or are the same node of one component, unless both
//! have a direction of their own there, as the two sides of a ball joint have: then they are two nodes at one place.

use std::collections::{BTreeMap, BTreeSet};

use faer::Mat;
use supel_runtime::{Coordinate, Direction};

use super::assembly::Assembly;
use super::component::Component;
use crate::error::{Error, Result};

/// An assembly as one model.
#[derive(Clone, Debug)]
pub struct JoinedModel {
    /// Σ B_cᵀ K̂_c B_c, n × n, held rows among them.
    pub stiffness: Mat<f64>,
    /// Σ B_cᵀ M̂_c B_c and the masses that were added, n × n.
    pub mass: Mat<f64>,
    /// The rigid-body motions of the whole with nothing held, at unit modal mass, n × their number.
    pub rigid: Mat<f64>,
    /// What each row is.
    pub rows: Vec<JoinedRow>,
    /// The nodes; none where a component has interface rows without nodes.
    pub nodes: Vec<JoinedNode>,
    /// What can still be joined: interfaces that are not joined, and those that were named to be kept.
    pub interfaces: Vec<JoinedSelection>,
    /// What is held.
    pub fixed: Vec<JoinedSelection>,
    /// Load vectors of the components, n × their number.
    pub loads: Mat<f64>,
    /// The name of each, `COMPONENT.LOAD`, and whether its component has a residual vector for it.
    pub load_names: Vec<(String, bool)>,
    /// Those left out, all of which is on held dofs.
    pub loads_on_held: Vec<String>,
}

/// A row of the matrices.
#[derive(Clone, Debug, PartialEq)]
pub struct JoinedRow {
    /// What messages call it.
    pub name: String,
    /// Number of its node and its direction; none for modal amplitudes, and where there are no nodes.
    pub at: Option<(usize, Direction)>,
    /// Whether it is a modal amplitude.
    pub is_amplitude: bool,
}

/// A node.
#[derive(Clone, Debug, PartialEq)]
pub struct JoinedNode {
    /// The interface nodes that it is, `COMPONENT.INTERFACE` or `COMPONENT.INTERFACE.NODE`.
    pub names: Vec<String>,
    /// Where it is.
    pub position: [f64; 3],
    /// Its directions and their rows.
    pub rows: BTreeMap<Direction, usize>,
}

/// Some dofs under a name that no other selection of its kind has.
#[derive(Clone, Debug, PartialEq)]
pub struct JoinedSelection {
    /// `COMPONENT.INTERFACE`.
    pub name: String,
    /// Its dofs.
    pub members: Members,
}

/// The dofs of a selection.
#[derive(Clone, Debug, PartialEq)]
pub enum Members {
    /// Numbers of nodes, and the directions of them; none for all that they have.
    Nodes {
        /// Numbers of the nodes.
        nodes: Vec<usize>,
        /// Their directions.
        dofs: Option<Vec<Direction>>,
    },
    /// Numbers of rows.
    Rows(Vec<usize>),
}

impl JoinedModel {
    /// How many rows are held.
    pub fn n_fixed(&self) -> usize {
        self.n_dofs(&self.fixed)
    }

    /// How many rows are those of interfaces.
    pub fn n_interface(&self) -> usize {
        self.n_dofs(&self.interfaces)
    }

    fn n_dofs(&self, selections: &[JoinedSelection]) -> usize {
        let of = |selection: &JoinedSelection| match &selection.members {
            Members::Rows(rows) => rows.len(),
            Members::Nodes { nodes, dofs: Some(dofs) } => nodes.len() * dofs.len(),
            Members::Nodes { nodes, dofs: None } => nodes.iter().map(|node| self.nodes[*node].rows.len()).sum(),
        };
        selections.iter().map(of).sum()
    }
}

impl Assembly {
    /// The assembly as one model. `kept` names joined interfaces that remain interfaces, as `--keep` does; the others become interior.
    ///
    /// # Errors
    /// [`Error::AssemblyName`] for a name that is not there; [`Error::JoinUnits`] where components have different units, joined or not;
    /// [`Error::DenseEigen`].
    pub fn model(&self, kept: &[String]) -> Result<JoinedModel> {
        self.same_units()?;
        let mut kept_coordinates = BTreeSet::new();
        for text in kept {
            let places = self.places("--keep", text)?;
            kept_coordinates.extend(places.iter().flat_map(|place| place.dofs.iter().map(|(_, at)| *at)));
        }
        let assembled = self.assembled_free()?;
        let pencil = assembled.pencil;
        let numbers: Vec<usize> = assembled.blocks.iter().flatten().flatten().copied().collect();
        let sites = self.sites(&numbers);
        let mut rows = self.rows(&numbers);
        let has_rows = sites.iter().any(|site| site.position.is_none());
        let nodes = if has_rows { Vec::new() } else { nodes(&sites) };
        for (number, node) in nodes.iter().enumerate() {
            node.rows.iter().for_each(|(direction, row)| rows[*row].at = Some((number, *direction)));
        }
        let held: BTreeSet<usize> = self.held_coordinates().iter().map(|at| numbers[*at]).collect();
        let shared = shared(&numbers);
        let is_left = |site: &Site, dof: &SiteDof| {
            let is_joined = site.dofs.iter().any(|dof| shared.contains(&dof.row));
            !held.contains(&dof.row) && (!is_joined || kept_coordinates.contains(&dof.coordinate))
        };
        let interfaces = selections(&sites, &rows, &nodes, &is_left);
        let fixed = selections(&sites, &rows, &nodes, &|_, dof| held.contains(&dof.row));
        let (loads, load_names, loads_on_held) = self.loads(&numbers, rows.len(), &held);
        let (stiffness, mass, rigid) = (pencil.stiffness, pencil.mass, pencil.rigid);
        Ok(JoinedModel { stiffness, mass, rigid, rows, nodes, interfaces, fixed, loads, load_names, loads_on_held })
    }

    fn same_units(&self) -> Result<()> {
        let labelled =
            |component: &Component| Some((component.name.clone(), component.superelement.metadata().units.clone()?));
        let mut labels = self.components.iter().filter_map(labelled);
        let Some((a, of_a)) = labels.next() else { return Ok(()) };
        match labels.find(|(_, units)| *units != of_a) {
            Some((b, of_b)) => Err(Error::JoinUnits { a, b, units: [of_a, of_b] }),
            None => Ok(()),
        }
    }

    /// Rows with their names, those of the first coordinates that they are.
    fn rows(&self, numbers: &[usize]) -> Vec<JoinedRow> {
        let mut rows: Vec<JoinedRow> = Vec::new();
        let of_components = self
            .components
            .iter()
            .flat_map(|component| (0..component.n_coordinates()).map(move |coordinate| (component, coordinate)));
        for ((component, coordinate), number) in of_components.zip(numbers) {
            // The first coordinates of rows come in the order of these.
            if *number == rows.len() {
                let what = &component.superelement.metadata().coordinates[coordinate];
                let (name, is_amplitude) = (component.name_of(coordinate), !what.is_interface());
                rows.push(JoinedRow { name, at: None, is_amplitude });
            }
        }
        rows
    }

    /// The interface nodes and the interface rows of all components.
    fn sites(&self, numbers: &[usize]) -> Vec<Site> {
        let mut sites = Vec::new();
        let mut first = 0;
        for (index, component) in self.components.iter().enumerate() {
            let metadata = component.superelement.metadata();
            let dof = |at: usize, direction| SiteDof { direction, coordinate: first + at, row: numbers[first + at] };
            let mut at = 0;
            for node in &metadata.interface_nodes {
                let dofs = node.dofs.iter().zip(at..).map(|(direction, at)| dof(at, Some(*direction))).collect();
                at += node.dofs.len();
                let n_alike = metadata.interface_nodes.iter().filter(|other| other.name == node.name).count();
                let label = node.label.filter(|_| n_alike > 1).map(|label| format!(".{label}")).unwrap_or_default();
                let interface = format!("{}.{}", component.name, node.name);
                let (name, own) = (format!("{interface}{label}"), node.label.map(|label| (index, label)));
                sites.push(Site { interface, name, own, position: Some(node.position), dofs });
            }
            for (at, coordinate) in metadata.coordinates.iter().enumerate() {
                if let Coordinate::InterfaceRow { row } = coordinate {
                    let interface = format!("{}.rows", component.name);
                    let name = format!("{interface}:{row}");
                    sites.push(Site { interface, name, own: None, position: None, dofs: vec![dof(at, None)] });
                }
            }
            first += component.n_coordinates();
        }
        sites
    }

    /// B_cᵀ f of the load vectors of all components that load rows which are not held, and their names; and the names of the others.
    fn loads(
        &self,
        numbers: &[usize],
        n: usize,
        held: &BTreeSet<usize>,
    ) -> (Mat<f64>, Vec<(String, bool)>, Vec<String>) {
        let (mut loads, mut names, mut on_held) = (Vec::new(), Vec::new(), Vec::new());
        let mut first = 0;
        for component in &self.components {
            let metadata = component.superelement.metadata();
            if let Some(vectors) = &component.superelement.tensors().load_vectors {
                for (column, name) in metadata.load_names.iter().enumerate() {
                    let mut load = vec![0.0; n];
                    (0..vectors.rows()).for_each(|i| load[numbers[first + i]] += vectors[(i, column)]);
                    let name = format!("{}.{name}", component.name);
                    if (0..n).all(|row| load[row] == 0.0 || held.contains(&row)) {
                        on_held.push(name);
                        continue;
                    }
                    loads.push(load);
                    let is_its_own = |coordinate: &Coordinate| matches!(coordinate, Coordinate::ResidualVector { load } if *load == column);
                    names.push((name, metadata.named_columns().any(is_its_own)));
                }
            }
            first += component.n_coordinates();
        }
        (Mat::from_fn(n, loads.len(), |i, j| loads[j][i]), names, on_held)
    }
}

/// An interface node, or an interface row.
struct Site {
    /// `COMPONENT.INTERFACE`.
    interface: String,
    /// The same with its label where the interface has several nodes.
    name: String,
    /// Its component and its label there.
    own: Option<(usize, i64)>,
    /// None for rows.
    position: Option<[f64; 3]>,
    dofs: Vec<SiteDof>,
}

struct SiteDof {
    direction: Option<Direction>,
    /// Among all coordinates of the components.
    coordinate: usize,
    row: usize,
}

/// Rows that are several coordinates.
fn shared(numbers: &[usize]) -> BTreeSet<usize> {
    let mut seen = BTreeSet::new();
    numbers.iter().copied().filter(|number| !seen.insert(*number)).collect()
}

/// The nodes that interface nodes make, each row in one of them.
fn nodes(sites: &[Site]) -> Vec<JoinedNode> {
    let mut nodes: Vec<JoinedNode> = Vec::new();
    let mut own: BTreeMap<(usize, i64), usize> = BTreeMap::new();
    let mut node_of: BTreeMap<usize, usize> = BTreeMap::new();
    for site in sites {
        let Some(position) = site.position else { continue };
        let directed = || site.dofs.iter().filter_map(|dof| Some((dof.direction?, dof.row)));
        let met = directed().filter_map(|(_, row)| node_of.get(&row)).chain(site.own.and_then(|of| own.get(&of)));
        let is_one = |node: &usize| directed().all(|(d, row)| nodes[*node].rows.get(&d).is_none_or(|own| *own == row));
        let node = met.copied().find(is_one);
        let left: Vec<(Direction, usize)> = directed().filter(|(_, row)| !node_of.contains_key(row)).collect();
        if node.is_none() && left.is_empty() {
            continue;
        }
        let node = node.unwrap_or_else(|| {
            nodes.push(JoinedNode { names: Vec::new(), position, rows: BTreeMap::new() });
            nodes.len() - 1
        });
        node_of.extend(left.iter().map(|(_, row)| (*row, node)));
        nodes[node].rows.extend(left);
        nodes[node].names.push(site.name.clone());
        site.own.into_iter().for_each(|of| {
            own.entry(of).or_insert(node);
        });
    }
    nodes
}

/// The dofs that `takes` takes, in selections of one name for each interface, or of several where its nodes take part with different
/// directions. A row is taken once.
fn selections(
    sites: &[Site],
    rows: &[JoinedRow],
    nodes: &[JoinedNode],
    takes: &dyn Fn(&Site, &SiteDof) -> bool,
) -> Vec<JoinedSelection> {
    let mut taken = BTreeSet::new();
    let mut selections: Vec<JoinedSelection> = Vec::new();
    let mut first = 0;
    while first < sites.len() {
        let interface = &sites[first].interface;
        let of_interface = sites[first..].iter().take_while(|site| site.interface == *interface);
        let n = of_interface.clone().count();
        let dofs = of_interface.flat_map(|site| site.dofs.iter().filter(|dof| takes(site, dof)).map(|dof| dof.row));
        let own: Vec<usize> = dofs.filter(|row| taken.insert(*row)).collect();
        let groups = if nodes.is_empty() { of_rows(own) } else { of_nodes(&own, rows, nodes) };
        let n_groups = groups.len();
        for members in groups {
            let of_group = match &members {
                Members::Nodes { nodes, .. } if n_groups > 1 => format!("{interface}.{}", nodes[0] + 1),
                _ => interface.clone(),
            };
            let name = unlike(of_group, &selections);
            selections.push(JoinedSelection { name, members });
        }
        first += n;
    }
    selections
}

fn of_rows(rows: Vec<usize>) -> Vec<Members> {
    if rows.is_empty() { Vec::new() } else { vec![Members::Rows(rows)] }
}

/// Nodes that take part with the same directions, together.
fn of_nodes(own: &[usize], rows: &[JoinedRow], nodes: &[JoinedNode]) -> Vec<Members> {
    let mut of_node: Vec<(usize, BTreeSet<Direction>)> = Vec::new();
    for (node, direction) in own.iter().filter_map(|row| rows[*row].at) {
        match of_node.iter_mut().find(|(known, _)| *known == node) {
            Some((_, directions)) => drop(directions.insert(direction)),
            None => of_node.push((node, BTreeSet::from([direction]))),
        }
    }
    let mut groups: Vec<(Option<Vec<Direction>>, Vec<usize>)> = Vec::new();
    for (node, directions) in of_node {
        let is_all = directions.len() == nodes[node].rows.len();
        let dofs = (!is_all).then(|| directions.into_iter().collect());
        match groups.iter_mut().find(|(known, _)| *known == dofs) {
            Some((_, members)) => members.push(node),
            None => groups.push((dofs, vec![node])),
        }
    }
    groups.into_iter().map(|(dofs, nodes)| Members::Nodes { nodes, dofs }).collect()
}

/// A name that no selection has yet.
fn unlike(name: String, selections: &[JoinedSelection]) -> String {
    let is_free = |name: &String| !selections.iter().any(|selection| selection.name == *name);
    let further = (2..).map(|number| format!("{name} ({number})"));
    std::iter::once(name.clone()).chain(further).find(is_free).unwrap_or(name)
}
