//! Cells of a MOAB file: a group for each kind, with a row of file ids for each cell.

use super::cells::{add, known_groups};
use super::group::Group;
use crate::error::Result;
use crate::input::cell_kind::{Kind, Known, kind};
use crate::input::faces::{Gathered, Shape};

pub(super) fn read(root: &Group<'_>, faces: &mut Gathered<'_>) -> Result<Known> {
    let tstt = root.group("tstt")?;
    let first = tstt.dataset("nodes/coordinates")?.integer_attribute("start_id")?.unwrap_or(1);
    let kinds = match known_groups(tstt.find_group("elements")?, kind_of)? {
        Ok(kinds) => kinds,
        Err(unknown) => return Ok(unknown),
    };
    for (group, cell) in kinds {
        let connectivity = group.dataset("connectivity")?;
        let shape = connectivity.shape()?;
        let numbers = connectivity.integers()?;
        if shape.len() != 2 || shape[1] != cell.n_nodes() {
            let expected = format!("shape [n, {}]", cell.n_nodes());
            return Err(connectivity.wrong_shape(format!("shape {shape:?}"), expected));
        }
        add(faces, (&connectivity, &numbers), cell, (first, |at, corner| at * cell.n_nodes() + corner))?;
        group.h5().keep(0)?;
    }
    Ok(Known::All)
}

/// What a group of cells holds, by its name: that of a shape and a number of nodes.
fn kind_of(name: &str) -> Kind {
    let digits = name.find(|c: char| c.is_ascii_digit()).unwrap_or(name.len());
    let (shape, n_nodes) = name.split_at(digits);
    let of = |shape| n_nodes.parse().map_or(Kind::Unknown, |n_nodes| kind(shape, n_nodes));
    match shape {
        "Vertex" | "Edge" => Kind::Faceless,
        "Tri" => of(Shape::Triangle),
        "Quad" => of(Shape::Quadrilateral),
        "Tet" => of(Shape::Tetrahedron),
        "Pyramid" => of(Shape::Pyramid),
        "Prism" => of(Shape::Wedge),
        "Hex" => of(Shape::Brick),
        _ => Kind::Unknown,
    }
}
