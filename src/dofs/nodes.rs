//! Nodes of a mesh.

use std::collections::BTreeMap;

/// Nodes with their labels, coordinates and named groups.
#[derive(Clone, Debug, Default)]
pub struct Nodes {
    /// Label of each node.
    pub labels: Vec<i64>,
    /// Position of each node.
    pub coordinates: Vec<[f64; 3]>,
    /// Named groups, each a list of indices into `labels`.
    pub groups: BTreeMap<String, Vec<usize>>,
}
