//! Cells of meshes: how many corners they have, and which of their nodes are on which face.
//!
//! Corners come first in every format, those of a bottom before those of a top. The nodes in the middle of edges follow, and of
//! wedges and bricks in two orders: bottom, top, upright (VTK, MED) or bottom, upright, top (Exodus, MOAB). Nodes in the middle of
//! faces and of the cell come last, in orders that differ too.

/// The shape of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Shape {
    Triangle,
    Quadrilateral,
    Tetrahedron,
    Pyramid,
    Wedge,
    Brick,
}

/// A shape with its number of nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) struct Cell {
    shape: Shape,
    n_nodes: usize,
}

/// Edges as pairs of corners, in the order of the nodes in their middles.
pub(in super::super) type Edges = &'static [[usize; 2]];

const TRIANGLE: Edges = &[[0, 1], [1, 2], [2, 0]];
const QUADRILATERAL: Edges = &[[0, 1], [1, 2], [2, 3], [3, 0]];
const TETRAHEDRON: Edges = &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
const PYRAMID: Edges = &[[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]];
const WEDGE: [Edges; 2] = [
    &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
    &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 4], [2, 5], [3, 4], [4, 5], [5, 3]],
];
const BRICK: [Edges; 2] = [
    &[[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]],
    &[[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 5], [2, 6], [3, 7], [4, 5], [5, 6], [6, 7], [7, 4]],
];

impl Cell {
    /// The cell of a shape with so many nodes, if formats know one.
    pub(in super::super) fn new(shape: Shape, n_nodes: usize) -> Option<Self> {
        let known: &[usize] = match shape {
            Shape::Triangle => &[3, 6, 7],
            Shape::Quadrilateral => &[4, 8, 9],
            Shape::Tetrahedron => &[4, 10],
            Shape::Pyramid => &[5, 13, 14],
            Shape::Wedge => &[6, 15, 18],
            Shape::Brick => &[8, 20, 27],
        };
        known.contains(&n_nodes).then_some(Self { shape, n_nodes })
    }

    /// The cell of a shape with nodes at its corners alone.
    pub(in super::super) fn linear(shape: Shape) -> Self {
        let n_nodes = match shape {
            Shape::Triangle => 3,
            Shape::Quadrilateral | Shape::Tetrahedron => 4,
            Shape::Pyramid => 5,
            Shape::Wedge => 6,
            Shape::Brick => 8,
        };
        Self { shape, n_nodes }
    }

    pub(in super::super) fn n_nodes(self) -> usize {
        self.n_nodes
    }

    pub(in super::super) fn shape(self) -> Shape {
        self.shape
    }

    /// The edges, in the order of VTK, MED, Abaqus and CalculiX.
    pub(in super::super) fn edges(self) -> Edges {
        self.orders()[0]
    }

    /// The places of these corners, and behind them of the nodes on edges between them in the order of VTK, MED, Abaqus and CalculiX.
    pub(in super::super) fn nodes_on(self, corners: &[usize]) -> Vec<usize> {
        let has_middles = self.n_nodes > self.n_corners();
        let is_between = |edge: &[usize; 2]| has_middles && edge.iter().all(|corner| corners.contains(corner));
        let edges = self.edges().iter().zip(self.n_corners()..);
        let middles = edges.filter(|(edge, _)| is_between(edge)).map(|(_, middle)| middle);
        corners.iter().copied().chain(middles).collect()
    }

    /// A cell that is a face itself.
    pub(super) fn is_surface(self) -> bool {
        matches!(self.shape, Shape::Triangle | Shape::Quadrilateral)
    }

    /// Corners, which are the first nodes.
    pub(in super::super) fn n_corners(self) -> usize {
        Self::linear(self.shape).n_nodes
    }

    /// The first node that is at no corner and on no edge.
    pub(in super::super) fn first_central(self) -> usize {
        let n_edges = if self.n_nodes == self.n_corners() { 0 } else { self.orders()[0].len() };
        self.n_corners() + n_edges
    }

    /// The edges in each order that nodes in their middles may have; without such nodes they have none.
    pub(in super::super) fn orders(self) -> &'static [Edges] {
        match self.shape {
            Shape::Triangle => &[TRIANGLE],
            Shape::Quadrilateral => &[QUADRILATERAL],
            Shape::Tetrahedron => &[TETRAHEDRON],
            Shape::Pyramid => &[PYRAMID],
            Shape::Wedge => &WEDGE,
            Shape::Brick => &BRICK,
        }
    }

    /// Corners of each face, one after the other along its border.
    pub(super) fn faces(self) -> &'static [&'static [usize]] {
        match self.shape {
            Shape::Triangle => &[&[0, 1, 2]],
            Shape::Quadrilateral => &[&[0, 1, 2, 3]],
            Shape::Tetrahedron => &[&[0, 1, 2], &[0, 1, 3], &[1, 2, 3], &[0, 2, 3]],
            Shape::Pyramid => &[&[0, 1, 2, 3], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]],
            Shape::Wedge => &[&[0, 1, 2], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
            Shape::Brick => &[&[0, 1, 2, 3], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]],
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    const SHAPES: [(Shape, usize); 6] = [
        (Shape::Triangle, 3),
        (Shape::Quadrilateral, 4),
        (Shape::Tetrahedron, 6),
        (Shape::Pyramid, 8),
        (Shape::Wedge, 9),
        (Shape::Brick, 12),
    ];

    /// Borders of faces are edges; of a volume each edge is on two faces.
    #[test]
    fn faces_are_bounded_by_edges() {
        for (shape, n_edges) in SHAPES {
            let cell = Cell::linear(shape);
            for order in cell.orders() {
                let sorted = |[a, b]: [usize; 2]| [a.min(b), a.max(b)];
                let mut uses: BTreeMap<[usize; 2], usize> = order.iter().map(|edge| (sorted(*edge), 0)).collect();
                assert_eq!(uses.len(), n_edges, "{shape:?}");
                for face in cell.faces() {
                    for at in 0..face.len() {
                        let edge = sorted([face[at], face[(at + 1) % face.len()]]);
                        *uses.get_mut(&edge).unwrap_or_else(|| panic!("{shape:?} {edge:?}")) += 1;
                    }
                }
                let expected = if cell.is_surface() { 1 } else { 2 };
                assert!(uses.values().all(|n| *n == expected), "{shape:?}");
            }
        }
    }
}
