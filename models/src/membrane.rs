//! A plane model of 4-node quadrilaterals, two displacements a node.

use crate::element::quadrilateral;
use crate::model::{Assembler, Material, Model};

/// A rectangle of plane-stress quadrilaterals in the plane z = 0, unit thickness, free: three rigid-body modes.
///
/// Groups `XMIN`, `XMAX`, `YMIN`, `YMAX` name its edges.
pub fn membrane(cells: [usize; 2], size: [f64; 2], material: &Material) -> Model {
    let [nx, ny] = cells;
    let grid = |i: usize, j: usize| (i + (nx + 1) * j) as u32;
    let nodes: Vec<[f64; 3]> = (0..=ny)
        .flat_map(|j| (0..=nx).map(move |i| [i as f64 / nx as f64 * size[0], j as f64 / ny as f64 * size[1], 0.0]))
        .collect();
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    for (i, j) in (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j))) {
        let corners = [grid(i, j), grid(i + 1, j), grid(i + 1, j + 1), grid(i, j + 1)];
        let matrices = quadrilateral(&corners.map(|c| [nodes[c as usize][0], nodes[c as usize][1]]), material, 1.0);
        let dofs: [u32; 8] = std::array::from_fn(|a| 2 * corners[a / 2] + (a % 2) as u32);
        stiffness.add_element(&dofs, &matrices.stiffness);
        for direction in 0..2 {
            let rows: [u32; 4] = std::array::from_fn(|a| dofs[2 * a + direction]);
            mass.add_element(&rows, &std::array::from_fn(|a| std::array::from_fn(|b| matrices.mass[2 * a][2 * b])));
        }
    }
    let mut model = Model::node_major(nodes, &[0, 1], stiffness, mass);
    for (axis, letter) in ["X", "Y"].iter().enumerate() {
        model.add_group(&format!("{letter}MIN"), |x| x[axis] == 0.0);
        model.add_group(&format!("{letter}MAX"), |x| x[axis] == size[axis]);
    }
    model
}
