//! Which dofs hold a component that should be free.
//!
//! ```text
//! t_a      n' × 1   the unit translation along axis a
//! K t_a    zero in every row that nothing holds, because elements give no force under translation
//! ```
//! A spring to the ground leaves its own stiffness in its own row. Where supports took rows out of K, the rows of their neighbours are
//! touched, in all directions.

use serde::Serialize;

use crate::dense;
use crate::dofs::Direction;
use crate::partition::Partition;
use crate::sparse::product_and_terms;

/// Rows that are listed.
const LISTED: usize = 5;
/// Share of its terms from which on a force is no rounding, of a text of six digits or of single precision.
const NO_ROUNDING: f64 = 1e-5;
/// How far the force of a spring stands out of what nine rows in ten have of rounding.
const STANDS_OUT: f64 = 1e3;
/// A spring to the ground changes a row by its own stiffness and no other one: from so many rows on, supports took dofs out.
const MOST_SPRINGS: usize = 12;

/// A dof that is held.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Culprit {
    /// Node and direction.
    pub dof: String,
    /// The force on it under a unit translation along its direction, in the user's units: the stiffness of a spring there, which may be
    /// negative.
    pub stiffness: f64,
    /// That over the stiffness of the dof itself.
    pub share: f64,
}

/// What holds a component against translations.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Grounded {
    /// The first of the dofs that are held, the stiffest first.
    pub culprits: Vec<Culprit>,
    /// How many there are.
    pub n_touched: usize,
    /// Whether they look like springs to the ground, and not like neighbours of dofs that supports took out.
    pub are_springs: bool,
}

impl Grounded {
    /// Looks for rows that translations make forces in; none without coordinates.
    pub(super) fn of(partition: &Partition) -> Option<Self> {
        let sites = partition.sites()?;
        let every: Vec<usize> = (0..sites.len()).collect();
        let motions = partition.rigid_motions(&every, [0.0; 3]).as_ref().subcols(0, 3).to_owned();
        let (forces, terms) = product_and_terms(&partition.stiffness, motions.as_ref());
        let diagonal = crate::sparse::diagonal(&partition.stiffness);
        let rounding = partition.precision.stiffness.share.max(f64::EPSILON);
        let share = |row: usize, axis: usize| forces[(row, axis)].abs() / terms[(row, axis)].max(diagonal[row].abs());
        let least = NO_ROUNDING.min(STANDS_OUT * usual_share(&share, sites.len()));
        let least = least.max(dense::NOISE_FACTOR * rounding);
        let is_touched = |row: usize, axis: usize| share(row, axis) > least;
        let own_axis = |row: usize| match sites[row]?.direction {
            Direction::Ux => Some(0),
            Direction::Uy => Some(1),
            Direction::Uz => Some(2),
            Direction::Rx | Direction::Ry | Direction::Rz => None,
        };
        let touched: Vec<usize> =
            every.iter().copied().filter(|row| (0..3).any(|axis| is_touched(*row, axis))).collect();
        let is_alone = |row: &usize| {
            let own = own_axis(*row);
            own.is_some_and(|own| is_touched(*row, own) && (0..3).all(|axis| axis == own || !is_touched(*row, axis)))
        };
        let are_springs = touched.len() <= MOST_SPRINGS && touched.iter().all(is_alone);
        let force = |row: usize| own_axis(row).map_or(0.0, |axis| forces[(row, axis)]);
        let mut order = touched.clone();
        order.sort_by(|a, b| force(*b).abs().total_cmp(&force(*a).abs()));
        let unit = partition.scaling.stiffness_unit();
        let culprit = |row: &usize| Culprit {
            dof: partition.name_of(*row),
            stiffness: force(*row) * unit,
            share: force(*row).abs() / diagonal[*row].abs(),
        };
        Some(Self { culprits: order.iter().take(LISTED).map(culprit).collect(), n_touched: touched.len(), are_springs })
    }
}

/// What nine rows in ten have at most of the share of a force in its terms, by the largest of each row.
fn usual_share(share: &impl Fn(usize, usize) -> f64, n_rows: usize) -> f64 {
    let of_row = |row: usize| (0..3).map(|axis| share(row, axis)).filter(|share| share.is_finite()).fold(0.0, f64::max);
    let mut shares: Vec<f64> = (0..n_rows).map(of_row).collect();
    shares.sort_by(f64::total_cmp);
    shares.get(n_rows * 9 / 10).copied().unwrap_or(0.0)
}
