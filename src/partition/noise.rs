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
//! Sums of numbers that were rounded before they were added round together wherever they have a number in common. Where no more than
//! c numbers are of one size, a rounding is in c entries at most, and the square of their sum is no more than c times that of their
//! squares:
//! ```text
//! |xᵀEx| ≤ √(2 ln(2/p)/3) (c Σ h² w² x̃_i² x̃_j²)^½        over all entries, but for a chance of p
//! ```
//!
//! Rigid patches and dofs that others follow by constraints are made of sums of entries, which were rounded before: their entries are
//! taken as the model has them.

use faer::MatRef;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::partition::Partition;
use super::roundings::{Entry, Roundings};
use crate::dense;
use crate::error::Uncertain;
use crate::sparse::{HalfUnits, Leading, Rounding, absolute_product};

/// p: the chance that roundings of one matrix make more of the energy of one motion than is said.
pub const CHANCE_OF_MORE: f64 = 1e-12;
/// How much larger than their sum the terms of a patch of a mesh are, at most: by about the number of layers of elements that it ties.
const LARGEST_OF_MESHES: f64 = 1e3;
/// Columns that one reading of the entries serves.
pub(super) const WIDTH: usize = 8;

/// Of some columns: Σ h (Q⁺ + Q⁻) and Σ h² (Q⁺² + Q⁻²), or Σ h |w x̃_i x̃_j| and Σ h² w² x̃_i² x̃_j² of sums of parts.
type Sums = [[f64; WIDTH]; 2];

impl Partition {
    /// What rounding of the data of K can make of xᵀKx of each column, x of n' rows, or of n_I where the interface is held: certainly
    /// for data in binary, but for a chance of [`CHANCE_OF_MORE`] where they are decimal digits.
    ///
    /// # Panics
    /// Where x has other rows.
    pub fn energy_noise(&self, x: MatRef<'_, f64>) -> Vec<f64> {
        assert!(x.nrows() == self.n_dofs() || x.nrows() == self.n_internal, "{} rows of {}", x.nrows(), self.n_dofs());
        if !self.has_few_digits() {
            let sizes = dense::absolute(x);
            let terms = absolute_product(Leading::new(&self.stiffness, x.nrows()), x);
            return dense::dots(sizes.as_ref(), terms.as_ref())
                .iter()
                .map(|sum| self.precision.stiffness.relative * sum)
                .collect();
        }
        let rounding = self.precision.stiffness;
        let of = || Roundings::of(&self.stiffness, &self.transformation, &self.patches, rounding);
        self.noise_of((self.roundings.get_or_init(of), rounding, self.scaling.stiffness_unit()), x)
    }

    /// What rounding of the data of M can make of xᵀMx of each column, as [`Self::energy_noise`]; nothing where every entry of M is
    /// known to a share of itself.
    pub fn mass_noise(&self, x: MatRef<'_, f64>) -> Option<Vec<f64>> {
        let rounding = self.precision.mass;
        if !rounding.is_beyond_entries() {
            return None;
        }
        let of = || Roundings::of(&self.mass, &self.transformation, &self.mass_patches, rounding);
        Some(self.noise_of((self.mass_roundings.get_or_init(of), rounding, self.scaling.mass_unit()), x))
    }

    fn noise_of(&self, of: (&Roundings, Rounding, f64), x: MatRef<'_, f64>) -> Vec<f64> {
        let panels = (0..x.ncols()).step_by(WIDTH);
        panels.flat_map(|first| self.panel_noise(of, x.subcols(first, WIDTH.min(x.ncols() - first)))).collect()
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
        self.precision.stiffness.is_coarse()
    }

    /// Why the entries of K are known to less than double precision; none where they are not.
    pub fn uncertain(&self) -> Option<Uncertain> {
        self.has_few_digits().then(|| self.precision.stiffness.cause())
    }

    fn panel_noise(&self, (roundings, rounding, unit): (&Roundings, Rounding, f64), x: MatRef<'_, f64>) -> Vec<f64> {
        let extended = self.extended(x);
        let of_task = |entries: &&[Entry]| {
            let half_units = HalfUnits::new(rounding, unit);
            Arch::new().dispatch(TaskSums {
                entries,
                extended: &extended,
                half_units,
                is_of_parts: rounding.is_of_parts,
            })
        };
        let tasks = roundings.tasks();
        let parts: Vec<Sums> = tasks.par_iter().map(of_task).collect();
        let tail = (2.0 * (2.0 / CHANCE_OF_MORE).ln() / 3.0).sqrt();
        (0..x.ncols())
            .map(|j| {
                let [all, squares] = [0, 1].map(|which| parts.iter().map(|part| part[which][j]).sum::<f64>());
                all.min(tail * (if rounding.is_of_parts { rounding.n_alike * squares } else { squares }).sqrt())
            })
            .collect()
    }

    /// What rounding of T, and of TᵀKT and TᵀMT to doubles, can make of xᵀKx − λ xᵀMx of each column, x of n' rows or of n_I where the
    /// interface is held.
    ///
    /// ```text
    /// f = K x̃ − λ M x̃                                      at rows that patches and constraints move, x̃ = T x
    /// 4 ε Σ (|T||x|)_i |f_i|                                 a lever is the difference of two coordinates, each rounded; two more for weights
    /// ε Σ |x_p| ((|TᵀKT| + λ|TᵀMT|)|x|)_p                    over the dofs p that rows follow
    /// ```
    pub fn rounding_of_patches(&self, x: MatRef<'_, f64>, lambda: &[f64]) -> Vec<f64> {
        const ROUNDINGS_OF_A_LEVER: f64 = 4.0;
        let followed = self.transformation.followed();
        let leading = |matrix| Leading::new(matrix, x.nrows());
        let mut found = vec![0.0; x.ncols()];
        if !followed.contains(&true) {
            return found;
        }
        for (first, found) in (0..x.ncols()).step_by(WIDTH).zip(found.chunks_mut(WIDTH)) {
            let panel = x.subcols(first, found.len());
            let lambda = &lambda[first..first + found.len()];
            let moved = self.extended(panel);
            let mut forces = vec![[0.0; WIDTH]; self.patches.rows.len()];
            self.patches.add_forces(&moved, &[1.0; WIDTH], &mut forces);
            let mut minus = [0.0; WIDTH];
            minus.iter_mut().zip(lambda).for_each(|(minus, lambda)| *minus = -lambda);
            self.mass_patches.add_forces(&moved, &minus, &mut forces);
            let [of_stiffness, of_mass] =
                [&self.stiffness, &self.mass].map(|matrix| absolute_product(leading(matrix), panel));
            let sizes: Vec<[f64; WIDTH]> = self.at_patches(panel, f64::abs).collect();
            for (j, found) in found.iter_mut().enumerate() {
                let levers = forces.iter().zip(&sizes).map(|(force, size)| (force[j] * size[j]).abs()).sum::<f64>();
                let entry = |p: usize| panel[(p, j)].abs() * (of_stiffness[(p, j)] + lambda[j].abs() * of_mass[(p, j)]);
                let entries = (0..panel.nrows()).filter(|p| followed[*p]).map(entry).sum::<f64>();
                *found = f64::EPSILON * (ROUNDINGS_OF_A_LEVER * levers + entries);
            }
        }
        found
    }

    /// T x at the dofs of the partition and at the rows of patches, row by row; zeros behind the rows and columns of x.
    pub(super) fn extended(&self, x: MatRef<'_, f64>) -> Vec<[f64; WIDTH]> {
        let mut extended = vec![[0.0; WIDTH]; self.n_dofs()];
        for (j, column) in x.col_iter().enumerate() {
            extended.iter_mut().zip(column.iter()).for_each(|(row, value)| row[j] = *value);
        }
        extended.extend(self.at_patches(x, |term| term));
        extended
    }

    /// Sums of what `of` makes of the terms of T x, at the rows of patches.
    fn at_patches(&self, x: MatRef<'_, f64>, of: impl Fn(f64) -> f64) -> impl Iterator<Item = [f64; WIDTH]> {
        self.patches.rows.iter().map(move |entries| {
            let mut sums = [0.0; WIDTH];
            for (dof, factor) in entries {
                sums.iter_mut().zip(row_of(x, *dof as usize)).for_each(|(sum, value)| *sum += of(factor * value));
            }
            sums
        })
    }
}

/// The sums of a task over its entries, those of one size together.
struct TaskSums<'a> {
    entries: &'a [Entry],
    extended: &'a [[f64; WIDTH]],
    half_units: HalfUnits,
    is_of_parts: bool,
}

impl TaskSums<'_> {
    /// With two weights of the terms w x̃_i x̃_j of entries of one size, and what these are in the sums.
    #[inline(always)]
    fn of(mut self, weights: impl Fn(f64) -> [f64; 2], of_size: impl Fn([f64; 2]) -> [f64; 2]) -> Sums {
        let mut sums = Sums::default();
        for of_one_size in self.entries.chunk_by(|a, b| a.value.abs() == b.value.abs()) {
            let h = self.half_units.of(of_one_size[0].value.abs());
            let mut of_terms = [[0.0; WIDTH]; 2];
            for entry in of_one_size {
                let sign = if entry.row == entry.col { entry.value.signum() } else { 2.0 * entry.value.signum() };
                let (a, b) = (&self.extended[entry.row as usize], &self.extended[entry.col as usize]);
                for j in 0..WIDTH {
                    let [first, second] = weights(sign * a[j] * b[j]);
                    of_terms[0][j] += first;
                    of_terms[1][j] += second;
                }
            }
            for j in 0..WIDTH {
                let [all, squares] = of_size([of_terms[0][j], of_terms[1][j]]);
                sums[0][j] += h * all;
                sums[1][j] += h * h * squares;
            }
        }
        sums
    }
}

impl WithSimd for TaskSums<'_> {
    type Output = Sums;

    /// In the widest vectors that the processor has; a product and a sum are rounded one by one all the same.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Sums {
        let positive = |term: f64| if term > 0.0 { term } else { 0.0 };
        match self.is_of_parts {
            true => self.of(|term| [term.abs(), term * term], |of_terms| of_terms),
            false => self.of(|term| [positive(term), positive(-term)], |[a, b]| [a + b, a * a + b * b]),
        }
    }
}

/// A row of x; zeros behind its last one, where the interface is held.
fn row_of(x: MatRef<'_, f64>, row: usize) -> [f64; WIDTH] {
    std::array::from_fn(|j| if row < x.nrows() && j < x.ncols() { x[(row, j)] } else { 0.0 })
}
