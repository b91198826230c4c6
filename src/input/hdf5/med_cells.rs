//! Cells of a MED mesh: a group for each kind, with the first node of every cell, then the second, and so on.

use super::cells::{add, known_groups, unfilled};
use super::group::Group;
use super::med;
use crate::error::Result;
use crate::input::cell_kind::{Kind, Known, kind};
use crate::input::faces::{Gathered, Shape};

pub(super) fn read(root: &Group<'_>, faces: &mut Gathered<'_>) -> Result<Known> {
    let step = med::step(&med::mesh(root)?)?;
    let kinds = match known_groups(step.find_group("MAI")?, kind_of)? {
        Ok(kinds) => kinds,
        Err(unknown) => return Ok(unknown),
    };
    for (group, cell) in kinds {
        let connectivity = group.dataset("NOD")?;
        let numbers = connectivity.integers()?;
        let n_cells = numbers.len() / cell.n_nodes();
        let stated = connectivity.integer_attribute("NBR")?;
        if !numbers.len().is_multiple_of(cell.n_nodes()) || stated.is_some_and(|n| usize::try_from(n) != Ok(n_cells)) {
            return Err(unfilled(&connectivity, numbers.len(), (cell, stated)));
        }
        // Numbers of nodes are places in the file, whatever labels they have.
        add(faces, (&connectivity, &numbers), cell, (1, |at, corner| corner * n_cells + at))?;
        group.h5().keep(0)?;
    }
    Ok(Known::All)
}

/// What a group of cells holds, by its name.
fn kind_of(name: &str) -> Kind {
    match name {
        "PO1" | "SE2" | "SE3" | "SE4" => Kind::Faceless,
        "TR3" => kind(Shape::Triangle, 3),
        "TR6" => kind(Shape::Triangle, 6),
        "TR7" => kind(Shape::Triangle, 7),
        "QU4" => kind(Shape::Quadrilateral, 4),
        "QU8" => kind(Shape::Quadrilateral, 8),
        "QU9" => kind(Shape::Quadrilateral, 9),
        "TE4" => kind(Shape::Tetrahedron, 4),
        "T10" => kind(Shape::Tetrahedron, 10),
        "PY5" => kind(Shape::Pyramid, 5),
        "P13" => kind(Shape::Pyramid, 13),
        "PE6" => kind(Shape::Wedge, 6),
        "P15" => kind(Shape::Wedge, 15),
        "P18" => kind(Shape::Wedge, 18),
        "HE8" => kind(Shape::Brick, 8),
        "H20" => kind(Shape::Brick, 20),
        "H27" => kind(Shape::Brick, 27),
        _ => Kind::Unknown,
    }
}
