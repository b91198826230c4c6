//! Columns of a result, a value for every row of the files, on the dofs of a partition.

use super::strayed::Strayed;
use crate::input::ModeRounding;
use crate::partition::{DofOrigin, Partition};
use crate::sparse::diagonal;

/// Puts columns on the dofs of a partition.
pub(super) struct Carrier<'a> {
    partition: &'a Partition,
    /// √K_ii of each dof, which makes displacements and rotations comparable.
    sizes: Vec<f64>,
}

/// A column on the dofs.
pub(super) struct Carried {
    /// The displacement of the file that an entry of one stands for: a power of two that brings the largest entry into [1, 2).
    pub(super) unit: f64,
    /// How far rows without a dof of their own are from where the dofs have them.
    pub(super) strayed: Strayed,
    /// What the numbers of the column may be off by, relative to the largest of them.
    pub(super) rounding: f64,
}

impl<'a> Carrier<'a> {
    pub(super) fn of(partition: &'a Partition) -> Self {
        let root = |stiffness: f64| stiffness.max(0.0).sqrt();
        Self { partition, sizes: diagonal(&partition.stiffness).into_iter().map(root).collect() }
    }

    /// Puts a column on the dofs; none for a column of zeros.
    pub(super) fn carry(&self, column: &[f64], rounding: ModeRounding, dofs: &mut [f64]) -> Option<Carried> {
        let rows = &self.partition.model.rows;
        let value = |row: usize| column[rows.of(row)];
        let largest = (0..self.partition.transformation.rows.len()).fold(0.0f64, |max, row| max.max(value(row).abs()));
        if largest == 0.0 {
            return None;
        }
        let unit = largest.log2().floor().clamp(-1022.0, 1023.0).exp2();
        for (to, dof) in dofs.iter_mut().zip(&self.partition.dofs) {
            if let DofOrigin::Row(row) = dof.origin {
                *to = value(row) / unit;
            }
        }
        let rounding = ModeRounding { absolute: rounding.absolute / unit, ..rounding };
        let strayed = self.strayed(|row| value(row) / unit, largest / unit, (rounding, dofs));
        Some(Carried { unit, strayed, rounding: rounding.relative + rounding.absolute * unit / largest })
    }

    /// The row that is furthest from where the dofs have it, compared with what the digits allow.
    fn strayed(&self, value: impl Fn(usize) -> f64, largest: f64, (rounding, dofs): (ModeRounding, &[f64])) -> Strayed {
        let followers = &self.partition.followers;
        let sizes: Vec<f64> = followers.iter().map(|follower| follower.stiffness.max(0.0).sqrt()).collect();
        let of_followers = followers.iter().zip(&sizes).map(|(follower, size)| size * value(follower.row).abs());
        let of_dofs = dofs.iter().zip(&self.sizes).map(|(value, size)| size * value.abs());
        let largest_scaled = of_followers.chain(of_dofs).fold(0.0, f64::max);
        let mut worst = Strayed::default();
        for (at, (follower, size)) in followers.iter().zip(&sizes).enumerate() {
            let (mut moved, mut terms, mut factors) = (0.0, 0.0, 0.0);
            for (dof, factor) in self.partition.transformation.rows[follower.row].entries() {
                moved += factor * dofs[dof as usize];
                terms += (factor * dofs[dof as usize]).abs();
                factors += factor.abs();
            }
            let own = value(follower.row);
            // The zero of a held row is written exactly, however few digits a file has.
            let of_digits = match factors > 0.0 {
                true => rounding.relative * (own.abs() + terms) + rounding.absolute * (1.0 + factors),
                false => 0.0,
            };
            let scaled = if largest_scaled > 0.0 { size / largest_scaled } else { 0.0 };
            let share = scaled.max(1.0 / largest);
            let found =
                Strayed { value: (own - moved).abs() * share, of_digits: of_digits * share, follower: Some(at) };
            if found.is_worse_than(&worst) {
                worst = found;
            }
        }
        worst
    }
}
