//! The nodes of the superelement's interface and the rows of the model that they stand for.

use super::axes::Frame;
use super::fitted::Fit;
use super::unloaded::Unloaded;
use crate::dofs::Direction;
use crate::job::Coupling;

/// One node of the superelement's interface.
#[derive(Clone, Debug, PartialEq)]
pub struct InterfaceNode {
    /// Name of the job's interface it came from.
    pub name: String,
    /// Label of the model's node; none for a rigid patch and for rows without a dof map.
    pub label: Option<i64>,
    /// Position, where coordinates are known.
    pub position: Option<[f64; 3]>,
    /// What its position was fitted from, where it was.
    pub fit: Option<Fit>,
    /// Its axes; none where they are those of the model.
    pub axes: Option<Frame>,
    /// Its directions, in the order of the interface dofs; empty where the model has no dof map.
    pub directions: Vec<Direction>,
    /// How it couples to the model.
    pub coupling: Coupling,
    /// Nodes of the model it stands for.
    pub n_nodes: usize,
}

/// An interface node with the rows it owns.
#[derive(Clone, Debug)]
pub(super) struct Resolved {
    pub(super) node: InterfaceNode,
    pub(super) rows: Rows,
    /// Directions of a patch that the scene says are at rest; no directions of the node any more.
    pub(super) grounded: Vec<Direction>,
    /// The carrier that the scene says moves it, by its place among the interfaces.
    pub(super) carrier: Option<usize>,
}

impl Resolved {
    /// A node of which the scene says nothing.
    pub(super) fn new(node: InterfaceNode, rows: Rows) -> Self {
        Self { node, rows, grounded: Vec::new(), carrier: None }
    }
}

/// The rows of the model that an interface node stands for.
#[derive(Clone, Debug)]
pub(super) enum Rows {
    /// The node's own rows, one for each interface dof.
    Own(Vec<usize>),
    /// All rows of a patch that moves with the node as a rigid body.
    Patch(Vec<usize>),
    /// The rows of a patch whose mean motion is that of the node.
    Average {
        /// Translations, node by node.
        rows: Vec<usize>,
        /// The weight of each, positive.
        weights: Vec<f64>,
    },
}

impl Rows {
    /// The rows, whatever they are of.
    pub(super) fn all(&self) -> &[usize] {
        let (Self::Own(rows) | Self::Patch(rows) | Self::Average { rows, .. }) = self;
        rows
    }

    /// The rows of a patch; none where they are the node's own.
    pub(super) fn of_patch(&self) -> Option<&[usize]> {
        if matches!(self, Self::Own(_)) { None } else { Some(self.all()) }
    }
}

/// All interfaces of a job, resolved.
#[derive(Clone, Debug, Default)]
pub(super) struct Interfaces {
    /// Nodes that have coordinates, then those that the scene leaves without any.
    pub(super) list: Vec<Resolved>,
    /// How many have coordinates.
    pub(super) n_kept: usize,
    /// What the scene says that no load acts on.
    pub(super) unloaded: Unloaded,
}

impl Interfaces {
    /// Interfaces of which the scene says nothing.
    pub(super) fn all(list: Vec<Resolved>) -> Self {
        Self { n_kept: list.len(), list, unloaded: Unloaded::default() }
    }

    /// The nodes that have coordinates, and the others; what is unloaded of all of them.
    pub(super) fn into_nodes(self) -> ([Vec<InterfaceNode>; 2], Unloaded) {
        let mut nodes: Vec<InterfaceNode> = self.list.into_iter().map(|resolved| resolved.node).collect();
        let left_out = nodes.split_off(self.n_kept);
        ([nodes, left_out], self.unloaded)
    }
}

/// The names of interface nodes by their number: those that have coordinates, then the others.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeNames<'a>(pub(super) [&'a [InterfaceNode]; 2]);

impl<'a> NodeNames<'a> {
    pub(super) fn of(self, number: usize) -> &'a str {
        let [kept, left_out] = self.0;
        kept.get(number).or_else(|| left_out.get(number - kept.len())).map_or("", |node| &node.name)
    }
}
