//! What rounding of the entries of K can make of an energy xᵀKx.
//!
//! ```text
//! x̃ = T x                     the motion at every row of the model
//! h(v)                        half a unit of the last digit of an entry of size v
//! Q⁺(v), Q⁻(v)                sums of the positive and of the negative w x̃_i x̃_j over the entries of size v; w = 2 off the diagonal
//! |xᵀEx| ≤ Σ h (Q⁺ + Q⁻)                                 whatever the roundings
//! |xᵀEx| ≤ √(2 ln(2/p)/3) (Σ h² (Q⁺² + Q⁻²))^½           but for a chance of p
//! ```
//! The first bound is far too large in practice: roundings have either sign, and a sum of N of them grows like √N. The second one
//! takes the roundings of different numbers as independent and even within half a unit. Such a number times a weight c has the
//! moments of a normal one of variance c²h²/3 at most (its sinh(t)/t ≤ exp(t²/6)), so that a sum of them exceeds t with a
//! probability below 2 exp(−3t² / 2Σc²h²) (Hoeffding 1963, with the variance of uniform numbers).
//!
//! Equal numbers round equally. Elements of one shape give one number at many places, with one rounding. Numbers that are equal only
//! after rounding have different roundings. Of all ways to part the entries of one size into groups that round alike,
//! Q⁺² + Q⁻² is the largest sum of squares, and therefore a bound for each of them.
//!
//! Rigid patches are made of sums of entries, which were rounded before: their entries are taken as the model has them.

use faer::MatRef;
use rayon::prelude::*;

use super::partition::Partition;
use super::roundings::{Entry, Roundings};
use crate::dense;
use crate::sparse::absolute_product;

/// p: the chance that roundings of one matrix make more of the energy of one motion than is said.
pub const CHANCE_OF_MORE: f64 = 1e-12;
/// Share of its own size that half a unit of the last digit is at least, in units of that of the smallest number of as many digits:
/// single precision counts as seven digits, and is coarser than these where the first of them is a nine.
const LEAST_SHARE: f64 = 1.0 / 8.0;
/// How much larger than their sum the terms of a patch of a mesh are, at most: by about the number of layers of elements that it ties.
const LARGEST_OF_MESHES: f64 = 1e3;
/// Columns that one reading of the entries serves.
const WIDTH: usize = 8;

/// Σ h (Q⁺ + Q⁻) and Σ h² (Q⁺² + Q⁻²) of some columns.
type Sums = [[f64; 2]; WIDTH];

impl Partition {
    /// What rounding of the data of K can make of xᵀKx of each column, x of n' rows, or of n_I where the interface is held: certainly
    /// for data in binary, but for a chance of [`CHANCE_OF_MORE`] where they are decimal digits.
    ///
    /// # Panics
    /// Where x has other rows.
    pub fn energy_noise(&self, x: MatRef<'_, f64>) -> Vec<f64> {
        assert!(x.nrows() == self.n_dofs() || x.nrows() == self.n_internal, "{} rows of {}", x.nrows(), self.n_dofs());
        if !self.has_few_digits() {
            let sizes = faer::Mat::from_fn(x.nrows(), x.ncols(), |i, j| x[(i, j)].abs());
            let terms = absolute_product(crate::sparse::Leading::new(&self.stiffness, x.nrows()), x);
            return dense::dots(sizes.as_ref(), terms.as_ref())
                .iter()
                .map(|sum| self.precision.stiffness * sum)
                .collect();
        }
        let roundings = self.roundings.get_or_init(|| Roundings::of(&self.stiffness, &self.dofs, &self.patches));
        let panels = (0..x.ncols()).step_by(WIDTH);
        panels.flat_map(|first| self.panel_noise(roundings, x.subcols(first, WIDTH.min(x.ncols() - first)))).collect()
    }

    /// Terms of xᵀKx that cancelled when rigid patches took up entries of K, of each column: Σ |x̃_i||K_ij||x̃_j| inside the patches, where
    /// a penalty between nodes of one patch leaves no other trace than its rounding. Nothing for patches of a mesh, whose terms
    /// are of the size of their sum.
    pub(crate) fn patch_terms(&self, x: MatRef<'_, f64>) -> Vec<f64> {
        let mut terms = vec![0.0; x.ncols()];
        if self.cancellation < LARGEST_OF_MESHES {
            return terms;
        }
        let is_patch = |row: u32| row as usize >= self.n_dofs();
        for (first, terms) in (0..x.ncols()).step_by(WIDTH).zip(terms.chunks_mut(WIDTH)) {
            let extended = self.extended(x.subcols(first, terms.len()));
            for entry in self.patches.entries.iter().filter(|entry| is_patch(entry.row) && is_patch(entry.col)) {
                let (a, b) = (&extended[entry.row as usize], &extended[entry.col as usize]);
                let size = if entry.row == entry.col { entry.value.abs() } else { 2.0 * entry.value.abs() };
                terms.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += size * (a * b).abs());
            }
        }
        terms
    }

    /// Whether the entries of K were rounded to fewer digits than double precision has.
    pub fn has_few_digits(&self) -> bool {
        self.precision.stiffness > f64::EPSILON
    }

    fn panel_noise(&self, roundings: &Roundings, x: MatRef<'_, f64>) -> Vec<f64> {
        let extended = self.extended(x);
        let unit = self.scaling.stiffness_unit();
        let of_task = |task: &&[Entry]| {
            let mut sums = Sums::default();
            for of_one_size in task.chunk_by(|a, b| a.value.abs() == b.value.abs()) {
                let h = half_unit(of_one_size[0].value.abs() * unit, self.precision.stiffness) / unit;
                let mut weights = [[0.0f64; 2]; WIDTH];
                for entry in of_one_size {
                    let sign = if entry.row == entry.col { entry.value.signum() } else { 2.0 * entry.value.signum() };
                    let (a, b) = (&extended[entry.row as usize], &extended[entry.col as usize]);
                    for (weight, (a, b)) in weights.iter_mut().zip(a.iter().zip(b)) {
                        let product = sign * a * b;
                        weight[0] += product.max(0.0);
                        weight[1] += (-product).max(0.0);
                    }
                }
                for (sum, [positive, negative]) in sums.iter_mut().zip(weights) {
                    sum[0] += h * (positive + negative);
                    sum[1] += h * h * (positive * positive + negative * negative);
                }
            }
            sums
        };
        let tasks = roundings.tasks();
        let parts: Vec<Sums> = tasks.par_iter().map(of_task).collect();
        let tail = (2.0 * (2.0 / CHANCE_OF_MORE).ln() / 3.0).sqrt();
        (0..x.ncols())
            .map(|j| {
                let [all, squares] = [0, 1].map(|which| parts.iter().map(|part| part[j][which]).sum::<f64>());
                all.min(tail * squares.sqrt())
            })
            .collect()
    }

    /// T x at the dofs of the partition and at the rows of patches, row by row.
    fn extended(&self, x: MatRef<'_, f64>) -> Vec<[f64; WIDTH]> {
        let mut extended = vec![[0.0; WIDTH]; self.n_dofs() + self.patches.rows.len()];
        for j in 0..x.ncols() {
            let column = dense::column(x, j);
            extended.iter_mut().zip(column).for_each(|(row, value)| row[j] = *value);
        }
        let (own, patches) = extended.split_at_mut(self.n_dofs());
        for (row, entries) in patches.iter_mut().zip(&self.patches.rows) {
            for (dof, factor) in entries {
                row.iter_mut().zip(own[*dof as usize]).for_each(|(row, value)| *row += factor * value);
            }
        }
        extended
    }
}

/// Half a unit of the last digit of a number of this size, where such a half is `precision` of the smallest number of as many
/// digits.
fn half_unit(size: f64, precision: f64) -> f64 {
    let mut decade = 10f64.powi(size.log10().floor() as i32);
    // A logarithm may round up just below a power of ten; a decade that is too small would promise too much.
    if 10.0 * decade <= size {
        decade *= 10.0;
    }
    precision * decade.max(LEAST_SHARE * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_unit_is_that_of_the_last_digit() {
        // Four digits: 1.234e3 is known to 0.5, 9.876e-5 to 0.5e-8.
        let precision = 0.5e-3;
        for (size, half) in [(1234.0, 0.5), (1000.0, 0.5), (6.5e2, 0.05), (1.0e-300, 0.5e-303)] {
            let found = half_unit(size, precision);
            assert!((found / half - 1.0).abs() < 1e-12, "{size}: {found}");
        }
        // Of a nine no less than an eighth of its size.
        assert_eq!(half_unit(9.876e-5, precision), precision * 9.876e-5 / 8.0);
    }
}
