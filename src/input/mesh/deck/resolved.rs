//! The sets and surfaces of a scope as the nodes that they stand for, and its cells.

use std::collections::BTreeMap;
use std::path::PathBuf;

use super::lines::{DeckLines, Place};
use super::scope::{Added, Face, Scope, SetLine, SurfaceLine, of_assembly};
use super::surfaces::free_faces;
use crate::error::{Error, Result};
use crate::input::banner::excerpt;
use crate::input::cell_kind::Kind;
use crate::input::mesh::cell_mesh::CellMesh;
use crate::input::mesh::groups::Sets;
use crate::input::mesh::labels::Labels;

/// Groups of nodes by name.
type Groups = BTreeMap<String, Vec<usize>>;

/// The groups of a scope: of sets of nodes, of sets of elements, of surfaces.
pub(super) struct Resolved {
    pub(super) groups: [Groups; 3],
}

/// A scope whose labels can be found.
struct Found<'a> {
    lines: &'a DeckLines,
    scope: &'a Scope,
    nodes: Labels,
    /// Index of the first node of the scope among all.
    first: u32,
    elements: Labels,
    path: PathBuf,
    /// Nodes and corners of elements.
    n_items: usize,
}

impl Resolved {
    /// Resolves a scope whose nodes have these labels and indices from `first` on; its cells go to the mesh.
    pub(super) fn new(
        lines: &DeckLines,
        scope: &Scope,
        (labels, first): (&[i64], u32),
        mesh: &mut CellMesh,
    ) -> Result<Self> {
        // Labels of nodes were compared before.
        let nodes = Labels::new(labels).unwrap_or_else(|_| Labels::none());
        let elements = Labels::new(&scope.elements.labels).map_err(|[one, other]| {
            let [place, again] = [one, other].map(|at| scope.elements.places[at]);
            let (_, line) = lines.at(place);
            let found = format!("element {} once more, after line {line}", scope.elements.labels[one]);
            lines.error_at(again, found, "one element of a label")
        })?;
        let n_items = labels.len() + scope.elements.nodes.len();
        let path = lines.at(Place::default()).0;
        let found = Found { lines, scope, nodes, first, elements, path, n_items };
        found.cells(mesh)?;
        let (of_nodes, of_elements) = found.sets()?;
        let of_surfaces = found.surfaces(&of_nodes, &of_elements)?;
        let of_elements = of_elements.iter().map(|(name, elements)| (name.to_owned(), found.nodes_of(elements)));
        let of_elements: Groups = of_elements.filter(|(_, nodes)| !nodes.is_empty()).collect();
        Ok(Self { groups: [of_nodes.into_groups(), of_elements, of_surfaces.into_groups()] })
    }

    /// Names of all groups.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.groups.iter().flat_map(|groups| groups.keys().map(String::as_str))
    }
}

/// The set of a name in a scope: its own, otherwise its part of one of the assembly.
fn found(sets: &Sets, name: &str) -> Option<usize> {
    sets.find(name).or_else(|| sets.find(&of_assembly(name)))
}

impl Found<'_> {
    /// Puts the cells into the mesh; every node of an element must be there.
    fn cells(&self, mesh: &mut CellMesh) -> Result<()> {
        let elements = &self.scope.elements;
        if let Some(name) = &elements.unknown {
            mesh.unread.get_or_insert_with(|| format!("elements of type {}", excerpt(name.as_bytes())));
        }
        for element in 0..elements.labels.len() {
            let nodes = elements.nodes_of(element);
            let Kind::Faced(cell) = elements.types[element].kind else { continue };
            let missing = nodes.iter().find(|label| self.nodes.find(**label).is_none());
            if let Some(label) = missing {
                let found = format!("node {label} in element {}", elements.labels[element]);
                return Err(self.lines.error_at(elements.places[element], found, "a node that is defined below *NODE"));
            }
            mesh.add(cell, nodes.iter().filter_map(|label| Some(self.first + self.nodes.find(*label)?)));
        }
        Ok(())
    }

    /// The sets of nodes and of elements.
    fn sets(&self) -> Result<(Sets, Sets)> {
        let mut of_elements = Sets::default();
        for line in &self.scope.element_sets {
            self.add(&mut of_elements, line, (&self.elements, 0), None)?;
        }
        let mut of_nodes = Sets::default();
        for line in &self.scope.node_sets {
            self.add(&mut of_nodes, line, (&self.nodes, self.first), Some(&mut of_elements))?;
        }
        Ok((of_nodes, of_elements))
    }

    /// Adds one line to a set. Labels that nothing has are left out, as both programs do.
    fn add(
        &self,
        sets: &mut Sets,
        line: &SetLine,
        (labels, first): (&Labels, u32),
        of_elements: Option<&mut Sets>,
    ) -> Result<()> {
        let set = sets.named(&line.set);
        let members: Vec<u32> = match &line.added {
            Added::Nothing => Vec::new(),
            Added::Range { first: from, last, step } => {
                labels.range(*from, *last, *step).map(|index| first + index).collect()
            }
            Added::Set(name) => match found(sets, name) {
                Some(other) => sets.members(other).to_vec(),
                None => return Err(self.no_set(name, line.place)),
            },
            Added::NodesOf(name) => match of_elements.and_then(|sets| Some((found(sets, name)?, sets))) {
                Some((other, sets)) => self.nodes_of(sets.members(other)).into_iter().map(|node| node as u32).collect(),
                None => return Err(self.no_set(name, line.place)),
            },
        };
        sets.extend(set, members, (&self.path, self.n_items))
    }

    fn no_set(&self, name: &str, place: Place) -> Error {
        self.lines.error_at(place, format!("the set {}", excerpt(name.as_bytes())), "a set that is defined above")
    }

    /// The nodes of elements, ascending.
    fn nodes_of(&self, elements: &[u32]) -> Vec<usize> {
        let labels = elements.iter().flat_map(|element| self.scope.elements.nodes_of(*element as usize));
        let mut nodes: Vec<usize> =
            labels.filter_map(|label| Some((self.first + self.nodes.find(*label)?) as usize)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// The surfaces as their nodes.
    fn surfaces(&self, of_nodes: &Sets, of_elements: &Sets) -> Result<Sets> {
        let mut surfaces = Sets::default();
        for line in &self.scope.surfaces {
            let surface = surfaces.named(&line.surface);
            let nodes = match &line.face {
                Face::Nodes => self.members(line, (of_nodes, &self.nodes, self.first))?,
                Face::OfSurface => self.members(line, (&surfaces, &Labels::none(), 0))?,
                face => {
                    let elements = self.members(line, (of_elements, &self.elements, 0))?;
                    let labels = match face {
                        Face::Labelled(face) => self.on_face(&elements, face, line)?,
                        _ => free_faces(&self.scope.elements, &elements),
                    };
                    labels.iter().filter_map(|label| Some(self.first + self.nodes.find(*label)?)).collect()
                }
            };
            surfaces.extend(surface, nodes, (&self.path, self.n_items))?;
        }
        Ok(surfaces)
    }

    /// The nodes or elements that a line of a surface names.
    fn members(&self, line: &SurfaceLine, (sets, labels, first): (&Sets, &Labels, u32)) -> Result<Vec<u32>> {
        match &line.of {
            Added::Set(name) | Added::NodesOf(name) => {
                let members = found(sets, name).map(|set| sets.unsorted(set).to_vec());
                members.ok_or_else(|| self.no_set(name, line.place))
            }
            Added::Range { first: label, .. } => {
                Ok(labels.find(*label).map(|index| first + index).into_iter().collect())
            }
            Added::Nothing => Ok(Vec::new()),
        }
    }

    /// Labels of the nodes on a face of elements.
    fn on_face(&self, elements: &[u32], face: &str, line: &SurfaceLine) -> Result<Vec<i64>> {
        let list = &self.scope.elements;
        let mut labels = Vec::new();
        for element in elements {
            let at = *element as usize;
            let Some(places) = list.types[at].nodes_on(face) else {
                if list.types[at].kind == Kind::Unknown {
                    continue;
                }
                let found = format!("the face {} of element {}", excerpt(face.as_bytes()), list.labels[at]);
                return Err(self.lines.error_at(line.place, found, "a face that its type has, as S1"));
            };
            let nodes = list.nodes_of(at);
            labels.extend(places.iter().filter_map(|place| nodes.get(*place)));
        }
        Ok(labels)
    }
}
