//! Types of elements of Gmsh, by their numbers.

use crate::input::cell_kind::{Kind, kind};
use crate::input::faces::Shape;

/// A type of elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ElementKind {
    pub(super) dimension: u8,
    pub(super) n_nodes: usize,
    pub(super) kind: Kind,
    /// Where the nodes stand that VTK has at 0, 1, 2 …; none where the order is that of VTK.
    order: Option<&'static [usize]>,
}

/// Gmsh lists the edges of a cell by their first corner, and then by their second.
const TETRAHEDRON: &[usize] = &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8];
const PYRAMID: &[usize] = &[0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12];
const WEDGE: &[usize] = &[0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11];
const BRICK: &[usize] = &[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15];

/// Numbers, dimensions and numbers of nodes of the types that have no faces here: points, lines and cells of higher order.
const OTHERS: [(i64, u8, usize); 44] = [
    (15, 0, 1),
    (1, 1, 2),
    (8, 1, 3),
    (26, 1, 4),
    (27, 1, 5),
    (28, 1, 6),
    (62, 1, 7),
    (63, 1, 8),
    (64, 1, 9),
    (65, 1, 10),
    (66, 1, 11),
    (20, 2, 9),
    (21, 2, 10),
    (22, 2, 12),
    (23, 2, 15),
    (24, 2, 15),
    (25, 2, 21),
    (42, 2, 28),
    (43, 2, 36),
    (44, 2, 45),
    (45, 2, 55),
    (46, 2, 66),
    (36, 2, 16),
    (37, 2, 25),
    (38, 2, 36),
    (39, 2, 12),
    (40, 2, 16),
    (47, 2, 49),
    (48, 2, 64),
    (49, 2, 81),
    (29, 3, 20),
    (30, 3, 35),
    (31, 3, 56),
    (71, 3, 84),
    (72, 3, 120),
    (90, 3, 40),
    (91, 3, 75),
    (106, 3, 126),
    (92, 3, 64),
    (93, 3, 125),
    (94, 3, 216),
    (95, 3, 343),
    (118, 3, 30),
    (119, 3, 55),
];

impl ElementKind {
    /// The type of a number; none where nothing is known of it.
    pub(super) fn of(number: i64) -> Option<Self> {
        let faced = |shape, n_nodes, order| {
            let dimension = if matches!(shape, Shape::Triangle | Shape::Quadrilateral) { 2 } else { 3 };
            Some(Self { dimension, n_nodes, kind: kind(shape, n_nodes), order })
        };
        match number {
            2 => faced(Shape::Triangle, 3, None),
            3 => faced(Shape::Quadrilateral, 4, None),
            4 => faced(Shape::Tetrahedron, 4, None),
            5 => faced(Shape::Brick, 8, None),
            6 => faced(Shape::Wedge, 6, None),
            7 => faced(Shape::Pyramid, 5, None),
            9 => faced(Shape::Triangle, 6, None),
            10 => faced(Shape::Quadrilateral, 9, None),
            11 => faced(Shape::Tetrahedron, 10, Some(TETRAHEDRON)),
            12 => faced(Shape::Brick, 27, Some(BRICK)),
            13 => faced(Shape::Wedge, 18, Some(WEDGE)),
            14 => faced(Shape::Pyramid, 14, Some(PYRAMID)),
            16 => faced(Shape::Quadrilateral, 8, None),
            17 => faced(Shape::Brick, 20, Some(BRICK)),
            18 => faced(Shape::Wedge, 15, Some(WEDGE)),
            19 => faced(Shape::Pyramid, 13, Some(PYRAMID)),
            _ => {
                let (_, dimension, n_nodes) = *OTHERS.iter().find(|(known, ..)| *known == number)?;
                let kind = if dimension < 2 { Kind::Faceless } else { Kind::Unknown };
                Some(Self { dimension, n_nodes, kind, order: None })
            }
        }
    }

    /// Nodes in the order of VTK.
    pub(super) fn ordered<'a>(self, nodes: &'a [u32]) -> impl Iterator<Item = u32> + 'a {
        let order = self.order.unwrap_or_default();
        (0..nodes.len()).map(move |at| nodes[order.get(at).copied().unwrap_or(at)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An edge of Gmsh's reference cells, by the manual: sorted by their corners; the last two of a tetrahedron are not.
    #[test]
    fn edges_come_in_the_order_of_vtk() {
        let sorted = |edges: &[[usize; 2]]| {
            let mut edges: Vec<[usize; 2]> = edges.iter().map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
            edges.sort_unstable();
            edges
        };
        for number in [17, 18, 19] {
            let element = ElementKind::of(number).expect("a type");
            let Kind::Faced(cell) = element.kind else { panic!("a cell with faces") };
            let own = sorted(cell.edges());
            let n_corners = element.n_nodes - own.len();
            let nodes: Vec<u32> = (0..element.n_nodes as u32).collect();
            let found: Vec<[usize; 2]> =
                element.ordered(&nodes).skip(n_corners).map(|node| own[node as usize - n_corners]).collect();
            let expected: Vec<[usize; 2]> = cell.edges().iter().map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
            assert_eq!(found, expected, "{number}");
        }
        let tetrahedron = ElementKind::of(11).expect("a type");
        assert_eq!(tetrahedron.ordered(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]).collect::<Vec<_>>()[8..], [9, 8]);
        assert_eq!((ElementKind::of(0), ElementKind::of(-1), ElementKind::of(9999)), (None, None, None));
    }
}
