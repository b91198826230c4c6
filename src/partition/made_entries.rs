//! What the roundings of K and M that adding up and turning have made can make of the quotient of a motion.
//!
//! ```text
//! |ΔA_ij| ≤ c ε/2 s_ij,  s_ij = max(|A_ij|, √(A_ii A_jj))      c of [`Rounding::made`]
//! ε/2 Σ (c_K s_ij(K) + |λ| c_M s_ij(M)) |x̃_i||x̃_j|                over all entries; x̃ = T x, xᵀMx = 1
//! ```
//! Entries that rigid patches and constraints have taken up are taken as the model has them.

use faer::MatRef;

use super::noise::WIDTH;
use super::partition::Partition;
use super::roundings::{Entry, PatchEntries};
use super::transformation::DofOrigin;
use crate::sparse::{SparseMatrix, diagonal, ends};

impl Partition {
    /// What these roundings can make of xᵀKx − λ xᵀMx of each column, x of n' rows or of n_I where the interface is held; none where the entries
    /// are those that were read.
    pub fn rounding_of_made_entries(&self, x: MatRef<'_, f64>, lambda: &[f64]) -> Vec<f64> {
        let mut found = vec![0.0; x.ncols()];
        let matrices = [
            (&self.stiffness, &self.patches, self.precision.stiffness.made),
            (&self.mass, &self.mass_patches, self.precision.mass.made),
        ];
        for (which, (matrix, patches, made)) in matrices.into_iter().enumerate().filter(|(_, (_, _, made))| *made > 0.0)
        {
            let entries = self.entries_by_size(matrix, patches);
            for (first, found) in (0..x.ncols()).step_by(WIDTH).zip(found.chunks_mut(WIDTH)) {
                let sums = sums_of(&entries, &self.extended(x.subcols(first, found.len())));
                for (j, found) in found.iter_mut().enumerate() {
                    let weight = if which == 0 { 1.0 } else { lambda[first + j].abs() };
                    *found += 0.5 * f64::EPSILON * made * weight * sums[j];
                }
            }
        }
        found
    }

    /// s_ij of the upper triangle, at places of the motion extended by the rows of patches.
    fn entries_by_size(&self, matrix: &SparseMatrix, patches: &PatchEntries) -> Vec<Entry> {
        let followed = self.transformation.followed();
        let is_own = |dof: usize| matches!(self.dofs[dof].origin, DofOrigin::Row(_)) && !followed[dof];
        let mut diagonal = diagonal(matrix);
        diagonal.resize(matrix.rows() + patches.rows.len(), 0.0);
        for entry in patches.entries.iter().filter(|entry| entry.row == entry.col) {
            diagonal[entry.row as usize] = entry.value;
        }
        let own = (0..matrix.rows()).filter(|row| is_own(*row)).flat_map(|row| {
            let view = matrix.outer_view(row);
            let columns = view.iter().flat_map(|view| view.iter()).map(|(col, value)| (col, *value));
            let upper: Vec<(usize, f64)> = columns.filter(|(col, _)| *col <= row && is_own(*col)).collect();
            upper.into_iter().map(move |(col, value)| Entry { row: row as u32, col: col as u32, value })
        });
        let sized = |entry: Entry| {
            let ends = ends(&diagonal, entry.row as usize, entry.col as usize);
            Entry { value: entry.value.abs().max(ends), ..entry }
        };
        own.chain(patches.entries.iter().copied()).map(sized).collect()
    }
}

/// Σ s_ij |x̃_i||x̃_j| over both triangles.
fn sums_of(entries: &[Entry], moved: &[[f64; WIDTH]]) -> [f64; WIDTH] {
    let mut sums = [0.0; WIDTH];
    for Entry { row, col, value } in entries {
        let size = if row == col { *value } else { 2.0 * value };
        let pairs = moved[*row as usize].iter().zip(&moved[*col as usize]);
        sums.iter_mut().zip(pairs).for_each(|(sum, (a, b))| *sum += size * (a * b).abs());
    }
    sums
}
