//! What solves with K_II make of their roundings, here and in the reduction.
//!
//! ```text
//! (K_II + δK) x = f + δf      |δK x| + |δf| ≤ c ε (|K_II||x| + |f|)       backward error of any stable solve, c a small number
//! g = ± ε (|K_II||x| + |f|)   n_I × k                                     signs at random, row by row
//! e = K_II⁻¹ g                                                            what they make of x
//! γ = max ‖e‖ / ‖Dg‖          D = diag(1/√K_ii)                            the gain: conditioning as it is, in energy and in inertia
//! ```
//! |f| stands for the terms that f was summed from. One sample says little: its part along the softest motion may happen to be small. The
//! gain is the largest of all columns so far, with several samples of each where they are few, and an error is γ ‖Dg‖ of its own column.

use faer::{Mat, MatRef};

use super::interior::{Interior, column_products};
use crate::dense;
use crate::partition::Partition;
use crate::random::SplitMix64;
use crate::sparse::{product, product_and_terms};

/// Samples at least: that all have less than a tenth of their usual part along one motion has a chance of 10⁻⁹.
const SAMPLES: usize = 8;
/// Seed of the signs.
const SEED: u64 = 0x5167_5eed;

/// Sizes of some motions of the interior, column by column.
pub(super) struct Lengths {
    /// √(eᵀK_II e).
    pub(super) energy: Vec<f64>,
    /// √(eᵀM_II e).
    pub(super) inertia: Vec<f64>,
    /// The largest displacement at a row that the file recovers.
    pub(super) displacement: Vec<f64>,
}

impl Lengths {
    pub(super) fn of(partition: &Partition, motions: MatRef<'_, f64>) -> Self {
        let pencil = partition.internal();
        let [energy, inertia] = [pencil.stiffness, pencil.mass].map(|matrix| {
            let squares = column_products(product(matrix, motions).as_ref(), motions);
            squares.into_iter().map(|square| square.max(0.0).sqrt()).collect()
        });
        let n_i = partition.n_internal;
        let at_row = |row: usize, j: usize| {
            let entries = partition.transformation.rows[row].entries().filter(|(dof, _)| (*dof as usize) < n_i);
            entries.map(|(dof, factor)| factor * motions[(dof as usize, j)]).sum::<f64>().abs()
        };
        let rows = &partition.recovered.rows;
        let largest = |j: usize| rows.iter().map(|(row, _)| at_row(*row, j)).fold(0.0, f64::max);
        Self { energy, inertia, displacement: (0..motions.ncols()).map(largest).collect() }
    }

    fn all(&self) -> [&Vec<f64>; 3] {
        [&self.energy, &self.inertia, &self.displacement]
    }

    fn all_mut(&mut self) -> [&mut Vec<f64>; 3] {
        [&mut self.energy, &mut self.inertia, &mut self.displacement]
    }

    /// Adds others, of as many motions.
    pub(super) fn add(&mut self, others: &Self) {
        for (own, others) in self.all_mut().into_iter().zip(others.all()) {
            own.iter_mut().zip(others).for_each(|(own, other)| *own += other);
        }
    }

    /// Of combinations of these motions, however these are mixed among themselves: by Schwarz no more than ‖s‖ ‖e‖, where mixtures have the errors
    /// of one another.
    pub(super) fn mixed(&self, shares: MatRef<'_, f64>) -> Self {
        let of = |sizes: &Vec<f64>| {
            let all = dense::norm(sizes);
            (0..shares.ncols()).map(|j| all * dense::norm(dense::column(shares, j))).collect()
        };
        let [energy, inertia, displacement] = self.all().map(of);
        Self { energy, inertia, displacement }
    }

    /// Of combinations of these motions: what they add up to at most.
    pub(super) fn summed(&self, shares: MatRef<'_, f64>) -> Self {
        let [energy, inertia, displacement] = self.all().map(|sizes| dense::summed_sizes(sizes, shares));
        Self { energy, inertia, displacement }
    }
}

/// What some equations K_II x = f are summed from.
#[derive(Clone, Copy)]
pub(super) struct Terms<'a> {
    /// x, n_I × k.
    pub(super) x: MatRef<'a, f64>,
    /// |f| or more, n_I × k.
    pub(super) loads: MatRef<'a, f64>,
}

/// The gains γ of energy, inertia and displacement, as large as any sample so far has shown them.
pub(super) struct Gains {
    /// D.
    scale: Vec<f64>,
    gains: [f64; 3],
    random: SplitMix64,
}

impl Gains {
    pub(super) fn new(partition: &Partition) -> Self {
        let diagonal = partition.internal().stiffness.diagonal();
        let scale = diagonal.into_iter().map(|k| if k > 0.0 { k.sqrt().recip() } else { 1.0 }).collect();
        Self { scale, gains: [0.0; 3], random: SplitMix64::new(SEED) }
    }

    /// What roundings of these equations leave open of x.
    pub(super) fn errors(&mut self, partition: &Partition, interior: &Interior<'_>, terms: Terms<'_>) -> Lengths {
        let (_, mut sizes) = product_and_terms(partition.internal().stiffness, terms.x);
        sizes += terms.loads;
        sizes *= faer::Scale(f64::EPSILON);
        let of_column =
            |column: &[f64]| dense::norm(&column.iter().zip(&self.scale).map(|(g, d)| g * d).collect::<Vec<f64>>());
        let norms: Vec<f64> = (0..sizes.ncols()).map(|j| of_column(dense::column(sizes.as_ref(), j))).collect();
        let loaded: Vec<usize> = (0..norms.len()).filter(|j| norms[*j] > 0.0).collect();
        if !loaded.is_empty() {
            self.sample(partition, interior, (&sizes, &norms, &loaded));
        }
        let [energy, inertia, displacement] = self.gains.map(|gain| norms.iter().map(|norm| gain * norm).collect());
        Lengths { energy, inertia, displacement }
    }

    /// Takes samples of these sizes, of each column that has any and of each several times where there are few.
    fn sample(
        &mut self,
        partition: &Partition,
        interior: &Interior<'_>,
        (sizes, norms, loaded): (&Mat<f64>, &[f64], &[usize]),
    ) {
        let n_samples = loaded.len().max(SAMPLES);
        let column = |sample: usize| loaded[sample % loaded.len()];
        let mut forces = Mat::zeros(sizes.nrows(), n_samples);
        self.random.fill(forces.as_mut());
        for j in 0..n_samples {
            let (of, norm) = (dense::column(sizes.as_ref(), column(j)), norms[column(j)]);
            let signed = dense::column_mut(forces.as_mut(), j).iter_mut().zip(of);
            signed.for_each(|(force, size)| *force = force.signum() * size / norm);
        }
        let lengths = Lengths::of(partition, interior.known_in_size(forces.as_ref()).as_ref());
        for (gain, of_samples) in self.gains.iter_mut().zip(lengths.all()) {
            *gain = dense::worst(of_samples.iter().copied().chain([*gain]));
        }
    }
}
