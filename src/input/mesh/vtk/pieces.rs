//! Points, cells and arrays of one or several pieces, put together.

use std::collections::BTreeMap;

use super::cell_type::kind_of;
use crate::input::cell_kind::Kind;
use crate::input::mesh::cell_mesh::{CellMesh, named_apart};
use crate::input::tag_groups::tag_groups;

/// Arrays of whole numbers by name.
pub(in crate::input) type Tags = BTreeMap<String, Vec<i64>>;

/// An unstructured grid that is being put together.
#[derive(Debug, Default)]
pub(in crate::input) struct Pieces {
    pub(in crate::input) points: Vec<[f64; 3]>,
    /// Numbers of the points of all cells, one cell after the other, from zero for all pieces.
    connectivity: Vec<u32>,
    /// Where each cell ends in it.
    ends: Vec<usize>,
    types: Vec<i64>,
    point_tags: Tags,
    cell_tags: Tags,
}

/// One piece.
#[derive(Debug, Default)]
pub(in crate::input) struct Piece {
    /// Three coordinates of each point.
    pub(in crate::input) points: Vec<f64>,
    pub(in crate::input) connectivity: Vec<i64>,
    /// Where the cells begin, with or without a zero in front, and end.
    pub(in crate::input) offsets: Vec<i64>,
    pub(in crate::input) types: Vec<i64>,
    pub(in crate::input) point_tags: Tags,
    pub(in crate::input) cell_tags: Tags,
}

/// What is wrong with a piece: what was found, and what was expected.
pub(in crate::input) type Wrong = (String, String);

impl Pieces {
    /// Adds a piece.
    pub(in crate::input) fn add(&mut self, piece: Piece) -> Result<(), Wrong> {
        let (n_before, n_cells_before) = (self.points.len(), self.types.len());
        if !piece.points.len().is_multiple_of(3) {
            return Err((format!("{} coordinates", piece.points.len()), "three for each point".to_owned()));
        }
        if let Some(at) = piece.points.iter().position(|value| !value.is_finite()) {
            return Err((
                format!("{} as a coordinate of point {}", piece.points[at], at / 3),
                "a finite number".to_owned(),
            ));
        }
        self.points.extend(piece.points.chunks_exact(3).map(|point| [point[0], point[1], point[2]]));
        let n_points = self.points.len() - n_before;
        let n_cells = piece.types.len();
        let ends = match piece.offsets.len().checked_sub(n_cells) {
            Some(0) => &piece.offsets[..],
            Some(1) if piece.offsets[0] == 0 => &piece.offsets[1..],
            _ => {
                let found = format!("{} offsets for {n_cells} cells", piece.offsets.len());
                return Err((found, "one for each cell, or one more".to_owned()));
            }
        };
        let first = self.connectivity.len();
        let mut last = 0;
        for end in ends {
            let is_right = *end >= last && usize::try_from(*end).is_ok_and(|end| end <= piece.connectivity.len());
            if !is_right {
                return Err((
                    format!("the offset {end}"),
                    "offsets that ascend to the number of points of all cells".to_owned(),
                ));
            }
            self.ends.push(first + *end as usize);
            last = *end;
        }
        for point in &piece.connectivity {
            match u32::try_from(*point) {
                Ok(index) if (index as usize) < n_points => self.connectivity.push(n_before as u32 + index),
                _ => {
                    return Err((
                        format!("the point {point} in a cell"),
                        format!("points from 0 to {}", n_points.max(1) - 1),
                    ));
                }
            }
        }
        self.connectivity.truncate(self.ends.last().copied().unwrap_or(first));
        self.types.extend(piece.types);
        for (own, tags, n_old, n_new) in [
            (&mut self.point_tags, piece.point_tags, n_before, n_points),
            (&mut self.cell_tags, piece.cell_tags, n_cells_before, n_cells),
        ] {
            // An array that only some pieces have, or that has several numbers each, is no mark.
            let fits = |values: &Vec<i64>| values.len() == n_new;
            own.retain(|name, _| tags.get(name).is_some_and(fits));
            for (name, values) in tags.into_iter().filter(|(_, values)| fits(values)) {
                if n_old == 0 || own.contains_key(&name) {
                    own.entry(name).or_default().extend(values);
                }
            }
        }
        Ok(())
    }

    /// The mesh: labels from one, groups from arrays.
    pub(in crate::input) fn into_mesh(self) -> CellMesh {
        let mut mesh = CellMesh::default();
        let mut first = 0;
        let starts: Vec<usize> = self.ends.iter().map(|end| std::mem::replace(&mut first, *end)).collect();
        for ((start, end), number) in starts.iter().zip(&self.ends).zip(&self.types) {
            match kind_of(*number, end - start) {
                Kind::Faced(cell) => mesh.add(cell, self.connectivity[*start..*end].iter().copied()),
                Kind::Faceless => {}
                Kind::Unknown => {
                    mesh.unread.get_or_insert_with(|| format!("cells of type {number} with {} points", end - start));
                }
            }
        }
        let of_points = self.point_tags.iter().filter(|(name, _)| !is_own(name));
        let of_points = of_points.flat_map(|(name, tags)| tag_groups(name, tags)).collect();
        let nodes_of = |cells: Vec<usize>| -> Vec<usize> {
            let mut nodes: Vec<usize> = cells
                .into_iter()
                .flat_map(|cell| &self.connectivity[starts[cell]..self.ends[cell]])
                .map(|node| *node as usize)
                .collect();
            nodes.sort_unstable();
            nodes.dedup();
            nodes
        };
        let of_cells = self.cell_tags.iter().filter(|(name, _)| !is_own(name));
        let of_cells = of_cells.flat_map(|(name, tags)| tag_groups(name, tags));
        let of_cells: BTreeMap<String, Vec<usize>> = of_cells.map(|(name, cells)| (name, nodes_of(cells))).collect();
        mesh.nodes.groups = named_apart(of_points, [("elements", of_cells)]);
        mesh.nodes.labels = (1..=self.points.len() as i64).collect();
        mesh.nodes.coordinates = self.points;
        mesh
    }
}

/// Arrays that VTK makes for itself.
fn is_own(name: &str) -> bool {
    matches!(name, "vtkGhostType" | "vtkOriginalPointIds" | "vtkOriginalCellIds" | "GlobalNodeId" | "GlobalElementId")
}
