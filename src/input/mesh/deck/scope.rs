//! What a deck says of the mesh of one part or instance, or of all of it: nodes, elements, and what sets and surfaces name.

use super::elements::ElementType;
use super::lines::Place;

/// Nodes, elements, sets and surfaces that share their labels and names.
#[derive(Clone, Debug, Default)]
pub(super) struct Scope {
    /// Name of the instance; none of a flat deck and of the assembly.
    pub(super) instance: Option<String>,
    pub(super) nodes: NodeList,
    pub(super) elements: ElementList,
    /// What sets of nodes get, in the order of the deck.
    pub(super) node_sets: Vec<SetLine>,
    /// What sets of elements get, in the order of the deck.
    pub(super) element_sets: Vec<SetLine>,
    /// What surfaces get, in the order of the deck.
    pub(super) surfaces: Vec<SurfaceLine>,
}

/// Which labels a set lists.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum SetKind {
    Nodes,
    Elements,
}

impl Scope {
    /// What sets of a kind get.
    pub(super) fn sets(&self, kind: SetKind) -> &[SetLine] {
        match kind {
            SetKind::Nodes => &self.node_sets,
            SetKind::Elements => &self.element_sets,
        }
    }

    /// The sets of a kind, for new ones.
    pub(super) fn sets_mut(&mut self, kind: SetKind) -> &mut Vec<SetLine> {
        match kind {
            SetKind::Nodes => &mut self.node_sets,
            SetKind::Elements => &mut self.element_sets,
        }
    }
}

/// Nodes as a deck lists them.
#[derive(Clone, Debug, Default)]
pub(super) struct NodeList {
    pub(super) labels: Vec<i64>,
    pub(super) coordinates: Vec<[f64; 3]>,
    pub(super) places: Vec<Place>,
}

/// Elements as a deck lists them.
#[derive(Clone, Debug, Default)]
pub(super) struct ElementList {
    pub(super) labels: Vec<i64>,
    /// Type of each.
    pub(super) types: Vec<ElementType>,
    /// The first of its nodes in `nodes`.
    pub(super) starts: Vec<usize>,
    /// Labels of nodes, element after element.
    pub(super) nodes: Vec<i64>,
    pub(super) places: Vec<Place>,
    /// The name of the first type that is not known, as it is written.
    pub(super) unknown: Option<String>,
    /// Elements of the type `C3D8I`.
    pub(super) n_incompatible: usize,
}

impl ElementList {
    /// Labels of the nodes of an element.
    pub(super) fn nodes_of(&self, element: usize) -> &[i64] {
        let end = self.starts.get(element + 1).copied().unwrap_or(self.nodes.len());
        &self.nodes[self.starts[element]..end]
    }
}

/// Stands before the names of sets and surfaces of the assembly where an instance has their part in it: the parts of an instance have names
/// of their own.
const OF_ASSEMBLY: char = '\u{1}';

/// What an instance calls its part of a set or a surface of the assembly.
pub(super) fn of_assembly(name: &str) -> String {
    format!("{OF_ASSEMBLY}{name}")
}

/// The name that a set or a surface of the assembly has there; none of others.
pub(super) fn name_in_assembly(name: &str) -> Option<&str> {
    name.strip_prefix(OF_ASSEMBLY)
}

/// Something that a set gets.
#[derive(Clone, Debug)]
pub(super) struct SetLine {
    /// Name of the set.
    pub(super) set: String,
    pub(super) added: Added,
    pub(super) place: Place,
}

/// Members of a set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Added {
    /// The labels from one to another in steps, as far as there are such.
    Range { first: i64, last: i64, step: i64 },
    /// The members of another set.
    Set(String),
    /// The nodes of a set of elements.
    NodesOf(String),
    /// Nothing, so that the set is there.
    Nothing,
}

/// Something that a surface gets.
#[derive(Clone, Debug)]
pub(super) struct SurfaceLine {
    /// Name of the surface.
    pub(super) surface: String,
    pub(super) of: Added,
    pub(super) face: Face,
    pub(super) place: Place,
}

/// Which nodes of its elements or nodes a surface has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Face {
    /// Of elements those on this face.
    Labelled(String),
    /// Of elements those on faces that no other element of them has.
    Free,
    /// Of nodes all.
    Nodes,
    /// The nodes and faces of another surface.
    OfSurface,
}
