//! Nodes, cells and groups of a mesh as the reader of a format leaves them.

use std::collections::{BTreeMap, HashMap};
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

/// The groups of a mesh under one name each. Where a group of elements has the name of a group of nodes, in whatever case, and other nodes,
/// it is called `NAME (elements)`, and a surface `NAME (surface)`.
pub(in crate::input) fn named_apart(
    nodes: BTreeMap<String, Vec<usize>>,
    others: impl IntoIterator<Item = (&'static str, BTreeMap<String, Vec<usize>>)>,
) -> BTreeMap<String, Vec<usize>> {
    let mut groups = nodes;
    for (kind, others) in others {
        // Names of one kind are different as the file has them.
        let mut taken: HashMap<String, Vec<String>> = HashMap::new();
        groups.keys().for_each(|name| taken.entry(name.to_ascii_uppercase()).or_default().push(name.clone()));
        for (name, members) in others {
            if groups.get(&name).is_some_and(|same| *same == members) {
                continue;
            }
            let mut alike = taken.get(&name.to_ascii_uppercase()).into_iter().flatten();
            let is_taken = alike.any(|known| groups.get(known).is_some_and(|other| *other != members));
            groups.insert(if is_taken { format!("{name} ({kind})") } else { name }, members);
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups<const N: usize>(named: [(&str, &[usize]); N]) -> BTreeMap<String, Vec<usize>> {
        named.into_iter().map(|(name, members)| (name.to_owned(), members.to_vec())).collect()
    }

    #[test]
    fn names_that_differ_in_case_alone_are_told_apart_by_what_they_are() {
        let found = named_apart(
            groups([("hub", &[1]), ("Foot", &[2, 3])]),
            [
                ("elements", groups([("HUB", &[4, 5]), ("foot", &[2, 3]), ("Skin", &[6]), ("SKIN", &[7])])),
                ("surface", groups([("Hub", &[8]), ("skin", &[9]), ("Foot", &[2, 3])])),
            ],
        );
        let expected = groups([
            ("hub", &[1]),
            ("HUB (elements)", &[4, 5]),
            ("Hub (surface)", &[8]),
            // Both spellings name the same nodes.
            ("Foot", &[2, 3]),
            ("foot", &[2, 3]),
            // Two groups of elements: the file tells them apart itself.
            ("Skin", &[6]),
            ("SKIN", &[7]),
            ("skin (surface)", &[9]),
        ]);
        assert_eq!(found, expected);
    }
}
