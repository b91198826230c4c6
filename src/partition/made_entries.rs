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
use super::roundings::{Entry, PatchEntries, own_entries};
use crate::sparse::{SparseMatrix, diagonal, ends};

impl Partition {
    /// What these roundings can make of xᵀKx − λ xᵀMx of each column, x of n' rows or of n_I where the interface is held; none where the entries
    /// are those that were read.
    pub fn rounding_of_made_entries(&self, x: MatRef<'_, f64>, lambda: &[f64]) -> Vec<f64> {
        let mut found = vec![0.0; x.ncols()];
        let weights: Vec<f64> = lambda.iter().map(|lambda| lambda.abs()).collect();
        let matrices = [
            (&self.stiffness, &self.patches, self.precision.stiffness.made, vec![1.0; lambda.len()]),
            (&self.mass, &self.mass_patches, self.precision.mass.made, weights),
        ];
        for (matrix, patches, made, weights) in matrices.into_iter().filter(|(_, _, made, _)| *made > 0.0) {
            let entries = self.entries_by_size(matrix, patches);
            let panels = found.chunks_mut(WIDTH).zip(weights.chunks(WIDTH));
            for (first, (found, weights)) in (0..x.ncols()).step_by(WIDTH).zip(panels) {
                let sums = sums_of(&entries, &self.extended(x.subcols(first, found.len())));
                let columns = found.iter_mut().zip(weights).zip(sums);
                columns.for_each(|((found, weight), sum)| *found += 0.5 * f64::EPSILON * made * weight * sum);
            }
        }
        found
    }

    /// s_ij, one of each pair, at places of the motion extended by the rows of patches.
    fn entries_by_size(&self, matrix: &SparseMatrix, patches: &PatchEntries) -> Vec<Entry> {
        let mut diagonal = diagonal(matrix);
        diagonal.resize(matrix.rows() + patches.rows.len(), 0.0);
        for entry in patches.entries.iter().filter(|entry| entry.row == entry.col) {
            diagonal[entry.row as usize] = entry.value;
        }
        let mut entries = own_entries(matrix, &self.transformation);
        entries.extend_from_slice(&patches.entries);
        for Entry { row, col, value } in &mut entries {
            *value = value.abs().max(ends(&diagonal, *row as usize, *col as usize));
        }
        entries
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
