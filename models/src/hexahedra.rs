//! Solids of 8-node hexahedra: BRICK and any mesh of them.

use std::collections::BTreeMap;

use crate::element::hexahedron;
use crate::model::{Assembler, Material, Model};

/// A mesh of 8-node hexahedra.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HexMesh {
    /// Position of each node.
    pub nodes: Vec<[f64; 3]>,
    /// Nodes of each element, from zero, in the order of [`crate::element::HEX_CORNERS`].
    pub elements: Vec<[u32; 8]>,
    /// Named groups of nodes, from zero.
    pub groups: BTreeMap<String, Vec<u32>>,
}

impl HexMesh {
    /// A structured mesh of the unit cube, mapped; `holds` decides which cells exist. Node order is x fastest.
    pub fn structured(
        cells: [usize; 3],
        map: impl Fn([f64; 3]) -> [f64; 3],
        holds: impl Fn([usize; 3]) -> bool,
    ) -> Self {
        let [nx, ny, nz] = cells;
        let grid = |i: usize, j: usize, k: usize| i + (nx + 1) * (j + (ny + 1) * k);
        let mut mesh = Self::default();
        let mut elements = Vec::new();
        for (k, j, i) in (0..nz).flat_map(|k| (0..ny).flat_map(move |j| (0..nx).map(move |i| (k, j, i)))) {
            if holds([i, j, k]) {
                let face = |k| [grid(i, j, k), grid(i + 1, j, k), grid(i + 1, j + 1, k), grid(i, j + 1, k)];
                let [[a, b, c, d], [e, f, g, h]] = [face(k), face(k + 1)];
                elements.push([a, b, c, d, e, f, g, h]);
            }
        }
        let mut used = vec![None; (nx + 1) * (ny + 1) * (nz + 1)];
        elements.iter().flatten().for_each(|&corner| used[corner] = Some(0));
        for (point, number) in used.iter_mut().enumerate().filter(|(_, number)| number.is_some()) {
            *number = Some(mesh.nodes.len() as u32);
            let index = [point % (nx + 1), point / (nx + 1) % (ny + 1), point / ((nx + 1) * (ny + 1))];
            mesh.nodes.push(map(std::array::from_fn(|d| index[d] as f64 / cells[d] as f64)));
        }
        mesh.elements = elements.iter().map(|corners| corners.map(|corner| used[corner].unwrap_or(0))).collect();
        mesh
    }

    /// Appends another mesh; nodes closer than the tolerance in every coordinate become one.
    ///
    /// The tolerance must be far below the distance of distinct nodes and far above rounding.
    pub fn merge(&mut self, other: &Self, tolerance: f64) {
        // Half a step of offset keeps coordinates that are multiples of the tolerance away from the border of a bin.
        let key = |x: [f64; 3]| x.map(|c| (c / tolerance + 0.25).floor() as i64);
        let mut known: BTreeMap<[i64; 3], u32> = (0..).zip(&self.nodes).map(|(number, &x)| (key(x), number)).collect();
        let numbers: Vec<u32> = other
            .nodes
            .iter()
            .map(|&x| {
                *known.entry(key(x)).or_insert_with(|| {
                    self.nodes.push(x);
                    self.nodes.len() as u32 - 1
                })
            })
            .collect();
        self.elements.extend(other.elements.iter().map(|corners| corners.map(|corner| numbers[corner as usize])));
    }

    /// Adds the group of the nodes whose position satisfies a condition.
    pub fn add_group(&mut self, name: &str, holds: impl Fn([f64; 3]) -> bool) {
        let members = (0..).zip(&self.nodes).filter(|&(_, &x)| holds(x)).map(|(number, _)| number).collect();
        self.groups.insert(name.to_owned(), members);
    }

    /// K and M with three displacements a node; nodes are labelled from one.
    ///
    /// # Panics
    /// If an element is turned inside out.
    pub fn assemble(&self, material: &Material) -> Model {
        let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
        for element in &self.elements {
            let matrices = hexahedron(&element.map(|node| self.nodes[node as usize]), material);
            let dofs: [u32; 24] = std::array::from_fn(|i| 3 * element[i / 3] + (i % 3) as u32);
            stiffness.add_element(&dofs, &matrices.stiffness);
            for direction in 0..3 {
                // Directions do not couple in M: only the stored thirds enter.
                let rows: [u32; 8] = std::array::from_fn(|a| dofs[3 * a + direction]);
                let block = std::array::from_fn(|a| std::array::from_fn(|b| matrices.mass[3 * a][3 * b]));
                mass.add_element(&rows, &block);
            }
        }
        let mut model = Model::node_major(self.nodes.clone(), &[0, 1, 2], stiffness, mass);
        let labelled = |members: &Vec<u32>| members.iter().map(|&node| i64::from(node) + 1).collect();
        model.groups = self.groups.iter().map(|(name, members)| (name.clone(), labelled(members))).collect();
        model
    }
}

/// BRICK: a block of `cells` equal hexahedra with one corner at the origin, free-free.
///
/// Six groups name its faces: `XMIN`, `XMAX`, `YMIN`, `YMAX`, `ZMIN`, `ZMAX`.
pub fn brick(cells: [usize; 3], size: [f64; 3], material: &Material) -> Model {
    let mut mesh = HexMesh::structured(cells, |t| std::array::from_fn(|d| t[d] * size[d]), |_| true);
    for (axis, letter) in ["X", "Y", "Z"].iter().enumerate() {
        mesh.add_group(&format!("{letter}MIN"), |x| x[axis] == 0.0);
        mesh.add_group(&format!("{letter}MAX"), |x| x[axis] == size[axis]);
    }
    mesh.assemble(material)
}
