//! Parts of any size for benchmarks: a bulky solid, a slender one, a lattice of beams, each with two faces to hold it by.
//!
//! Millimetre, tonne, second; steel. Nothing is aligned with the axes but the two faces.

use std::str::FromStr;

use crate::frame::{Inertia, Section, frame};
use crate::model::{Material, Model};
use crate::tetrahedra::TetMesh;

/// The material of every part.
pub const MATERIAL: Material = Material::STEEL_MM_T_S;
/// The groups of nodes on the two faces.
pub const FACES: [&str; 2] = ["BASE", "TIP"];

/// What kind of structure a part is; the factor of K fills in as in three, two or one dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// A block with four feet, a boss, and holes along and across.
    Bulky,
    /// A crankshaft of two throws.
    Slender,
    /// Beams along the edges of a lattice of cells.
    Lattice,
}

impl Family {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Bulky, Self::Slender, Self::Lattice];

    /// Its name in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bulky => "bulky",
            Self::Slender => "slender",
            Self::Lattice => "lattice",
        }
    }

    /// The axis across both faces.
    pub fn axis(self) -> usize {
        match self {
            Self::Bulky => 2,
            Self::Slender | Self::Lattice => 0,
        }
    }

    /// Cells of the coarsest mesh, and the edge of one in mm.
    fn coarse(self) -> ([usize; 3], f64) {
        match self {
            Self::Bulky => ([5, 5, 6], 20.0),
            Self::Slender => ([14, 6, 2], 20.0),
            Self::Lattice => ([2, 1, 1], 100.0),
        }
    }

    /// Whether a cell of the coarsest mesh is material.
    fn holds(self, [i, j, k]: [usize; 3]) -> bool {
        match self {
            Self::Bulky => match k {
                0 => i % 4 == 0 && j % 4 == 0,
                5 => [i, j] == [2, 2],
                // Four bores along z, and a channel along y.
                _ => (i % 2 == 0 || j % 2 == 0) && [i, k] != [2, 2],
            },
            // Each throw: a journal, a web, a pin, a web; then the last journal.
            Self::Slender => match i % 6 {
                0 | 1 => j < 2,
                3 | 4 => j >= 4,
                _ => true,
            },
            Self::Lattice => true,
        }
    }
}

impl FromStr for Family {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = Self::ALL.map(Self::name).join(", ");
        Self::ALL.into_iter().find(|family| family.name() == name).ok_or(format!("'{name}' is none of {names}"))
    }
}

/// A part with its matrices; the nodes of its two faces are the groups [`FACES`].
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its kind.
    pub family: Family,
    /// K and M, free-free.
    pub model: Model,
    /// The mesh of a solid.
    pub solid: Option<TetMesh>,
    /// Where the two faces lie along [`Family::axis`], mm.
    pub faces: [f64; 2],
}

impl Part {
    /// The part whose number of degrees of freedom is nearest to `dofs` among the meshes of its family.
    ///
    /// Refinement splits the coarse cells into 1, 2, 3 … along x, then y, then z, so that sizes follow closely and the
    /// shape never changes. A lattice grows instead: beams stay as long as they are, ten elements each.
    pub fn new(family: Family, dofs: usize) -> Self {
        let (coarse, edge) = family.coarse();
        let splits = |level: usize| std::array::from_fn::<_, 3, _>(|d| 1 + (level + 2 - d) / 3);
        let cells = |level| std::array::from_fn::<_, 3, _>(|d| coarse[d] * splits(level)[d]);
        let level_holds = |level| {
            let splits = splits(level);
            move |cell: [usize; 3]| family.holds(std::array::from_fn(|d| cell[d] / splits[d]))
        };
        let n_of = |level| match family {
            Family::Lattice => 6 * Beams::count_nodes(cells(level)),
            _ => 3 * TetMesh::count_nodes(cells(level), level_holds(level)),
        };
        let above = (0..).find(|&level| n_of(level) >= dofs).unwrap_or(0);
        let level = (above.saturating_sub(1)..=above).min_by_key(|&level| n_of(level).abs_diff(dofs)).unwrap_or(above);
        let size = match family {
            Family::Lattice => cells(level).map(|n| edge * n as f64),
            _ => coarse.map(|n| edge * n as f64),
        };
        let axis = family.axis();
        let map = |t: [f64; 3]| warped(t, size, axis);
        let (mut model, solid) = if family == Family::Lattice {
            let beams = Beams::new(cells(level));
            let nodes: Vec<[f64; 3]> = beams.nodes.into_iter().map(map).collect();
            (frame(&nodes, &beams.edges, &Section::round(4.0), &MATERIAL, Inertia::Consistent), None)
        } else {
            let mesh = TetMesh::structured(cells(level), map, level_holds(level));
            (mesh.assemble(&MATERIAL), Some(mesh))
        };
        let faces = [0.0, size[axis]];
        for (name, at) in FACES.iter().zip(faces) {
            model.add_group(name, |x| x[axis] == at);
        }
        Self { family, model, solid, faces }
    }
}

/// A point of the unit cube in a bowed, twisted block whose two faces across `axis` stay plane.
///
/// Polynomials only, whose values are the same on every machine.
fn warped(t: [f64; 3], size: [f64; 3], axis: usize) -> [f64; 3] {
    let [p, q] = [(axis + 1) % 3, (axis + 2) % 3];
    let bulge = t[axis] * (1.0 - t[axis]);
    let mut x: [f64; 3] = std::array::from_fn(|d| size[d] * t[d]);
    x[axis] += 0.2 * size[p] * bulge * (t[p] - 0.5);
    x[p] += 0.2 * size[p] * bulge * (1.0 + t[q]);
    x[q] += 0.3 * size[q] * bulge * (0.5 - t[p]);
    x
}

/// The edges of all cells of a lattice on the unit cube, each cut into beams.
struct Beams {
    nodes: Vec<[f64; 3]>,
    edges: Vec<[usize; 2]>,
}

impl Beams {
    /// Elements of one edge.
    const ELEMENTS: usize = 10;

    fn count_nodes(cells: [usize; 3]) -> usize {
        let corners = cells.map(|n| n + 1);
        let struts: usize = (0..3).map(|d| corners.iter().product::<usize>() / corners[d] * cells[d]).sum();
        corners.iter().product::<usize>() + struts * (Self::ELEMENTS - 1)
    }

    fn new(cells: [usize; 3]) -> Self {
        let [nx, ny, nz] = cells.map(|n| n + 1);
        let at = |p: [f64; 3]| std::array::from_fn(|d| p[d] / cells[d] as f64);
        let (mut nodes, mut edges) = (Vec::new(), Vec::new());
        let grid = || (0..nz).flat_map(|k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])));
        nodes.extend(grid().map(|p| at(p.map(|c| c as f64))));
        for (first, p) in grid().enumerate() {
            for (d, stride) in [1, nx, nx * ny].into_iter().enumerate().filter(|&(d, _)| p[d] < cells[d]) {
                let mut last = first;
                for element in 1..Self::ELEMENTS {
                    let mut between = p.map(|c| c as f64);
                    between[d] += element as f64 / Self::ELEMENTS as f64;
                    edges.push([last, nodes.len()]);
                    last = nodes.len();
                    nodes.push(at(between));
                }
                edges.push([last, first + stride]);
            }
        }
        Self { nodes, edges }
    }
}
