//! Faces of the surface of a component between recovered nodes, as its mesh has them.

use alloc::vec::Vec;

use crate::error::{FileError, Result};

/// How many nodes a face may have: corners, then the nodes in the middles of its edges in the same order, then the one in its middle.
/// Three, six and seven are triangles; four, eight and nine are quadrilaterals.
const NODES_OF_FACE: [usize; 6] = [3, 4, 6, 7, 8, 9];

/// Faces between recovered nodes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecoveredFaces {
    /// Numbers of the nodes of all faces, one face after the other.
    nodes: Vec<usize>,
    /// Where each face ends among these.
    ends: Vec<usize>,
}

impl RecoveredFaces {
    /// Faces by the numbers of their nodes, from 0 in the order of [`Recovery::labels`](crate::Recovery::labels), of which there are
    /// `n_nodes`: corners along the border, counterclockwise as seen from outside, nodes in the middles of the edges behind them from
    /// that between the first two corners on, and the node in the middle of the face.
    ///
    /// # Errors
    ///
    /// [`FileError::RecoveryFace`] where a face has another number of nodes than 3, 4, 6, 7, 8 or 9, one that is not there, or one twice.
    pub fn new<'a>(faces: impl IntoIterator<Item = &'a [usize]>, n_nodes: usize) -> Result<Self> {
        let mut all = Self::default();
        for (number, face) in faces.into_iter().enumerate() {
            let wrong = |found| Err(FileError::RecoveryFace { face: number, found });
            if !NODES_OF_FACE.contains(&face.len()) {
                return wrong(format!("{} nodes; expected 3, 4, 6, 7, 8 or 9", face.len()));
            }
            if let Some(node) = face.iter().find(|node| **node >= n_nodes) {
                return wrong(format!("node {node}; expected 0 to {}", n_nodes.saturating_sub(1)));
            }
            if let Some((_, node)) = face.iter().enumerate().find(|(at, node)| face[..*at].contains(node)) {
                return wrong(format!("node {node} twice"));
            }
            all.nodes.extend_from_slice(face);
            all.ends.push(all.nodes.len());
        }
        Ok(all)
    }

    /// Faces from the tensors of a file: nodes of all faces, and where each face begins among them, with their end.
    pub(crate) fn from_file(nodes: &[i64], offsets: &[i64], n_nodes: usize) -> Result<Self> {
        let n_faces = offsets.len().saturating_sub(1);
        let wrong = |face, found| FileError::RecoveryFace { face, found };
        if offsets.first() != Some(&0) || offsets.last().copied() != i64::try_from(nodes.len()).ok() {
            return Err(FileError::RecoveryFaceOffsets { n_ids: nodes.len() });
        }
        // A number beyond the address space is no node either.
        let ids: Vec<usize> = nodes.iter().map(|node| usize::try_from(*node).unwrap_or(usize::MAX)).collect();
        let mut faces: Vec<&[usize]> = Vec::with_capacity(n_faces);
        for (face, ends) in offsets.windows(2).enumerate() {
            let range = usize::try_from(ends[0]).ok().zip(usize::try_from(ends[1]).ok());
            let own = range.and_then(|(begin, end)| ids.get(begin..end));
            faces.push(own.ok_or_else(|| wrong(face, format!("offsets {} and {}", ends[0], ends[1])))?);
        }
        Self::new(faces, n_nodes)
    }

    /// The nodes of each face, by their numbers.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[usize]> {
        let begin = |face: usize| face.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.ends.iter().enumerate().map(move |(face, end)| &self.nodes[begin(face)..*end])
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.ends.len()
    }

    /// Numbers of the nodes of all faces, one face after the other.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Where each face begins among [`Self::nodes`], and their end.
    pub fn offsets(&self) -> impl Iterator<Item = usize> {
        core::iter::once(0).chain(self.ends.iter().copied())
    }
}
