//! Nodes, cells and groups of a mesh as the reader of a format leaves them.

use std::collections::BTreeMap;
use std::path::Path;

use crate::dofs::Nodes;
use crate::error::Result;
use crate::input::Allowance;
use crate::input::faces::{Cell, Gathered};
use crate::input::node_frames::NodeFrames;
use crate::input::patch::{PatchFaces, Patches};

/// A mesh as the reader of its format leaves it.
#[derive(Debug, Default)]
pub(in crate::input) struct CellMesh {
    /// Label, position and groups of each node.
    pub(in crate::input) nodes: Nodes,
    /// Cells with faces, in the order of the file.
    pub(in crate::input) cells: Vec<Cells>,
    /// What the mesh has that is not read, in words; then no face is known.
    pub(in crate::input) unread: Option<String>,
    /// BLAKE3 of the files that this one refers to, where it does.
    pub(in crate::input) data_digest: Option<String>,
    /// The axes of nodes that have their own.
    pub(in crate::input) frames: Option<NodeFrames>,
}

/// Cells of one kind.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::input) struct Cells {
    /// Their kind.
    pub(in crate::input) cell: Cell,
    /// Indices of their nodes, cell after cell.
    pub(in crate::input) nodes: Vec<u32>,
}

impl Cells {
    /// Hands on each cell with the indices of its nodes.
    pub(in crate::input) fn each(&self, mut take: impl FnMut(Cell, &[usize]) -> Result<()>) -> Result<()> {
        let mut indices = Vec::new();
        for nodes in self.nodes.chunks_exact(self.cell.n_nodes()) {
            indices.clear();
            indices.extend(nodes.iter().map(|node| *node as usize));
            take(self.cell, &indices)?;
        }
        Ok(())
    }
}

impl CellMesh {
    /// Adds a cell; its nodes are indices.
    pub(in crate::input) fn add(&mut self, cell: Cell, nodes: impl IntoIterator<Item = u32>) {
        match self.cells.last_mut() {
            Some(last) if last.cell == cell => last.nodes.extend(nodes),
            _ => self.cells.push(Cells { cell, nodes: nodes.into_iter().collect() }),
        }
    }

    /// The faces of patches whose nodes are those of the mesh.
    ///
    /// # Errors
    /// [`crate::error::Error::MemoryRead`].
    pub(in crate::input) fn faces(
        &self,
        path: &Path,
        patches: &Patches,
        allowance: &Allowance,
    ) -> Result<Vec<PatchFaces>> {
        let mut faces = Gathered::new(path, patches, allowance)?;
        if let Some(what) = &self.unread {
            return Ok(faces.unknown(&format!("the mesh has what supel does not read, {what}")));
        }
        self.cells.iter().try_for_each(|cells| cells.each(|cell, nodes| faces.add(cell, nodes)))?;
        faces.into_centroids()
    }
}

/// The groups of a mesh under one name each. Where a group of elements has the name of a group of nodes and other nodes, it is called
/// `NAME (elements)`, and a surface `NAME (surface)`.
pub(in crate::input) fn named_apart(
    nodes: BTreeMap<String, Vec<usize>>,
    others: impl IntoIterator<Item = (&'static str, BTreeMap<String, Vec<usize>>)>,
) -> BTreeMap<String, Vec<usize>> {
    let mut groups = nodes;
    for (kind, others) in others {
        for (name, members) in others {
            match groups.get(&name) {
                Some(same) if *same == members => {}
                Some(_) => drop(groups.insert(format!("{name} ({kind})"), members)),
                None => drop(groups.insert(name, members)),
            }
        }
    }
    groups
}
