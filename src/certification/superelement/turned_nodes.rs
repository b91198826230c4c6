//! Coordinates of a superelement at nodes that have axes of their own.
//!
//! ```text
//! Ψ_file    its basis along the rows of the files; the column of a kept row moves that row by one: the node's own direction
//! R         r × r, orthogonal: the three coordinates of such a node along the axes of the model, q_file = R q
//! Ψ_file R, RᵀK̂R, RᵀM̂R    the same superelement along the axes of the model
//! ```
//! What a coordinate is, its column says, along the axes in which the basis is written. So K̂ and M̂ are ordered and coordinates are found in
//! the rows of the files, and what has all three directions of a node is then turned with the rows. A node of which fewer are kept has no
//! direction of the model as a coordinate: those it has stay as they are, and are no part of the interface.

use std::collections::HashSet;

use faer::Mat;

use super::files::{ForeignSuperelement, ReducedMatrix};
use super::interface::{Interface, interface};
use crate::dofs::Dof;
use crate::number::counted;
use crate::partition::Partition;
use crate::verification::check::Check;

/// A superelement whose coordinates are found among the rows of a model.
pub struct Placed {
    /// The superelement along the axes of the model, its matrices in the order of its basis.
    pub given: ForeignSuperelement,
    /// The rows of the model that it keeps.
    pub interface: Interface,
    /// What is to be known of both, one sentence each.
    pub notes: Vec<String>,
    /// C-13, where its matrices name their rows.
    pub names: Option<Check>,
}

/// Three coordinates of a node, by their numbers from zero, and the axes that they are along.
struct Block {
    coordinates: [usize; 3],
    rows: [usize; 3],
    axes: [[f64; 3]; 3],
}

impl ForeignSuperelement {
    /// The superelement along the axes of the model, its matrices in the order of its basis.
    #[must_use]
    pub fn placed(self, partition: &Partition) -> Placed {
        let along_files = interface(partition, &self);
        let dofs: HashSet<Dof> = partition.dofs.iter().filter_map(|reduced| reduced.dof).collect();
        let (given, reordered) = self.in_order_of_basis(&along_files, |dof| dofs.contains(dof));
        let (reordered, names) = reordered.unzip();
        let Some(turning) = given.basis.turning.clone() else {
            return Placed { given, interface: along_files, notes: reordered.into_iter().collect(), names };
        };
        let rows = &partition.model.rows;
        let of_row: Vec<(usize, usize)> =
            along_files.coordinates.iter().map(|(row, at)| (rows.of(*row), *at)).collect();
        let coordinate = |row: u32| of_row.iter().find(|(own, _)| *own == row as usize).map(|(_, at)| *at);
        let mut blocks = Vec::new();
        let mut n_apart = 0;
        for (rows, axes) in turning.blocks() {
            match rows.map(coordinate) {
                [Some(x), Some(y), Some(z)] => {
                    blocks.push(Block { coordinates: [x, y, z], rows: rows.map(|row| row as usize), axes: *axes });
                }
                own => n_apart += own.iter().flatten().count(),
            }
        }
        let given = given.turned(&blocks);
        let interface = interface(partition, &given);
        let notes = reordered.into_iter().chain(notes(3 * blocks.len(), n_apart)).collect();
        Placed { given, interface, notes, names }
    }

    fn turned(mut self, blocks: &[Block]) -> Self {
        self.basis = self.basis.along_model();
        for block in blocks {
            let own = block.coordinates.map(|at| std::mem::take(&mut self.basis.columns[at]));
            for (k, at) in block.coordinates.into_iter().enumerate() {
                let sum = |row: usize| (0..3).map(|of| block.axes[of][k] * own[of][row]).sum();
                let mut column: Vec<f64> = (0..own[k].len()).map(sum).collect();
                // Rows turned to and fro are what they were, but for rounding.
                block.rows.iter().enumerate().for_each(|(of, row)| column[*row] = if of == k { 1.0 } else { 0.0 });
                self.basis.columns[at] = column;
            }
            [&mut self.stiffness, &mut self.mass].into_iter().for_each(|matrix| matrix.turn(block));
        }
        self
    }
}

impl ReducedMatrix {
    /// RᵀAR. A sum of at most nine entries has the roundings of each: relative ones relative to the sum of their sizes, and of absolute ones
    /// (|R|ᵀ·1)² ≤ 3 times one.
    fn turn(&mut self, block: &Block) {
        let signed = |of: usize, k: usize| block.axes[of][k];
        self.values = congruent(&self.values, block.coordinates, signed);
        self.sizes = congruent(&self.sizes, block.coordinates, |of, k| signed(of, k).abs());
        if self.rounding[1] > 0.0 {
            self.rounding[1] *= 3.0;
        }
    }
}

/// SᵀAS with the identity for S but for three coordinates.
fn congruent(matrix: &Mat<f64>, coordinates: [usize; 3], of: impl Fn(usize, usize) -> f64) -> Mat<f64> {
    let turned = |matrix: &Mat<f64>| {
        let mut turned = matrix.clone();
        for i in 0..matrix.nrows() {
            for (k, at) in coordinates.into_iter().enumerate() {
                turned[(i, at)] = (0..3).map(|own| matrix[(i, coordinates[own])] * of(own, k)).sum();
            }
        }
        turned
    };
    let of_columns = turned(matrix);
    turned(&of_columns.transpose().to_owned()).transpose().to_owned()
}

/// What is said of coordinates that were turned, and of those that could not be.
fn notes(n_turned: usize, n_apart: usize) -> impl Iterator<Item = String> {
    let turned = (n_turned > 0).then(|| {
        let coordinates = counted(n_turned, "coordinate", "coordinates");
        format!("{coordinates} are along the axes of their nodes, as the rows of K are, and were turned with them to those of the model")
    });
    let apart = (n_apart > 0).then(|| {
        let coordinates = counted(n_apart, "coordinate is along an axis", "coordinates are along axes");
        format!("{coordinates} of a node of which the superelement has not all three: no direction of the model, and no part of its interface")
    });
    turned.into_iter().chain(apart)
}
