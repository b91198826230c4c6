//! Rows that carry next to all of the mass, whose sums leave few digits for what the others do.

use std::fmt;

use super::Model;
use crate::sparse::{Leading, diagonal};

/// Rows with the share of a few nodes in M, and all others.
#[derive(Clone, Debug, PartialEq)]
pub struct HeavyRows {
    /// What the heaviest is called.
    pub heaviest: String,
    /// How many times the mass of all others together it carries.
    pub ratio: f64,
}

/// Rows that are heavy together differ by no more.
const ALIKE: f64 = 10.0;
/// More rows than four nodes have are a part of the structure.
const MOST_ROWS: usize = 12;
/// Times the mass of everything else from which on a word is said. Engineers take a thousand for as good as a support.
const TOLD_FROM: f64 = 1e3;
/// Translations of a node, each of which has its mass.
const DIRECTIONS: f64 = 3.0;

impl Model {
    /// The rows that carry a thousand times the mass of all others and more, where there are such rows. Rotations and rows without a node have
    /// units of their own and are not compared.
    pub(super) fn heavy_rows(&self) -> Option<HeavyRows> {
        let masses = diagonal(&self.mass);
        let is_translation = |row: usize| match self.dofs.as_ref().map(|dofs| dofs[row]) {
            Some(Some(dof)) => !dof.direction.is_rotation(),
            Some(None) => false,
            None => true,
        };
        let rows: Vec<usize> = (0..masses.len()).filter(|row| is_translation(*row)).collect();
        let heaviest = rows.iter().copied().max_by(|a, b| masses[*a].total_cmp(&masses[*b]))?;
        let (heavy, others): (Vec<usize>, Vec<usize>) =
            rows.into_iter().partition(|row| ALIKE * masses[*row] >= masses[heaviest]);
        // Of a mesh by itself nearly all rows are alike, and nothing is summed.
        if heavy.len() > MOST_ROWS {
            return None;
        }
        // What elements share out between their nodes belongs to both.
        let of_row = |row: usize| {
            let entries = Leading::from(&self.mass).entries(row).filter(|(other, _)| is_translation(*other));
            entries.map(|(_, value)| value).sum::<f64>()
        };
        let rest = others.into_iter().map(of_row).sum::<f64>() / DIRECTIONS;
        let ratio = masses[heaviest] / rest;
        (rest > 0.0 && ratio >= TOLD_FROM).then(|| HeavyRows { heaviest: self.names().full(heaviest), ratio })
    }
}

impl fmt::Display for HeavyRows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { heaviest, ratio } = self;
        write!(
            f,
            "{heaviest} carries {ratio:.0e} times the mass of everything else: sums over both keep that many times fewer digits of what \
             the rest does by itself, and a check past its limit may show no more than that; check the unit of the mass; for a support \
             let the scene hold the node, or take {TOLD_FROM:.0e} times the mass of the rest"
        )
    }
}
