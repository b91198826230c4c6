//! Types of cells of VTK, by their numbers.

use crate::input::cell_kind::{Kind, kind};
use crate::input::faces::Shape;

/// What a cell of a type with so many nodes is.
pub(super) fn kind_of(number: i64, n_nodes: usize) -> Kind {
    let (shape, own) = match number {
        1..=4 | 21 | 35 | 68 | 75 => return Kind::Faceless,
        5 => (Shape::Triangle, 3),
        9 => (Shape::Quadrilateral, 4),
        10 => (Shape::Tetrahedron, 4),
        12 => (Shape::Brick, 8),
        13 => (Shape::Wedge, 6),
        14 => (Shape::Pyramid, 5),
        22 => (Shape::Triangle, 6),
        23 => (Shape::Quadrilateral, 8),
        24 => (Shape::Tetrahedron, 10),
        25 => (Shape::Brick, 20),
        26 => (Shape::Wedge, 15),
        27 => (Shape::Pyramid, 13),
        28 => (Shape::Quadrilateral, 9),
        29 => (Shape::Brick, 27),
        32 => (Shape::Wedge, 18),
        34 => (Shape::Triangle, 7),
        // Lagrange cells have any order; those of the second are known.
        69 => (Shape::Triangle, n_nodes),
        70 => (Shape::Quadrilateral, n_nodes),
        71 => (Shape::Tetrahedron, n_nodes),
        72 => (Shape::Brick, n_nodes),
        73 => (Shape::Wedge, n_nodes),
        _ => return Kind::Unknown,
    };
    if own == n_nodes { kind(shape, own) } else { Kind::Unknown }
}
