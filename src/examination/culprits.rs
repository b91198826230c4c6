//! Which dofs hold a component that should be free.
//!
//! ```text
//! t_a      n' × 1   the unit translation along axis a
//! K t_a    zero in every row that nothing holds, because elements give no force under translation
//! ```
//! A spring to the ground leaves its own stiffness in its own row. Where supports took rows out of K, the rows of their neighbours are
//! touched, in all directions.

use faer::Mat;
use serde::Serialize;

use crate::dense;
use crate::dofs::Direction;
use crate::partition::Partition;
use crate::sparse::product_and_terms;

/// Rows that are listed.
const LISTED: usize = 5;
/// Share of its terms from which on a force is no rounding of a text of six digits.
const NO_ROUNDING: f64 = 1e-5;
/// A spring to the ground changes a row by its own stiffness and no other one: from so many rows on, supports took dofs out.
const MOST_SPRINGS: usize = 12;

/// A dof that is held.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Culprit {
    /// Node and direction.
    pub dof: String,
    /// The force on it under a unit translation along its direction, in the user's units: the stiffness of a spring there.
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
        let least = NO_ROUNDING.max(dense::NOISE_FACTOR * rounding);
        let is_touched =
            |row: usize, axis: usize| forces[(row, axis)].abs() > least * terms[(row, axis)].max(diagonal[row].abs());
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
            own.is_some_and(|own| {
                forces[(*row, own)] > 0.0 && (0..3).all(|axis| axis == own || !is_touched(*row, axis))
            })
        };
        let are_springs = touched.len() <= MOST_SPRINGS && touched.iter().all(is_alone);
        let force = |row: usize| own_axis(row).map_or(0.0, |axis| forces[(row, axis)].abs());
        let mut order = touched.clone();
        order.sort_by(|a, b| force(*b).total_cmp(&force(*a)));
        let unit = partition.scaling.stiffness_unit();
        let culprit = |row: &usize| Culprit {
            dof: partition.name_of(*row),
            stiffness: force(*row) * unit,
            share: force(*row) / diagonal[*row],
        };
        Some(Self { culprits: order.iter().take(LISTED).map(culprit).collect(), n_touched: touched.len(), are_springs })
    }
}

/// Typical distance of coupled nodes; none without coordinates.
pub(super) fn spacing(partition: &Partition) -> Option<f64> {
    /// Rows that are looked at.
    const SAMPLE: usize = 500;
    let sites = partition.sites()?;
    let n = sites.len();
    let nearest = |row: usize| {
        let own = sites[row]?.position;
        let entries = partition.stiffness.outer_view(row)?;
        let others = entries.indices().iter().filter_map(|col| sites[*col as usize]);
        let distance = |other: [f64; 3]| (0..3).map(|axis| (other[axis] - own[axis]).powi(2)).sum::<f64>().sqrt();
        others.map(|site| distance(site.position)).filter(|distance| *distance > 0.0).reduce(f64::min)
    };
    let mut found: Vec<f64> = (0..n).step_by(n.div_ceil(SAMPLE).max(1)).filter_map(nearest).collect();
    found.sort_by(f64::total_cmp);
    found.get(found.len() / 2).copied()
}

/// The extents of the component along the axes; none without coordinates.
pub(super) fn extents(partition: &Partition) -> Option<[f64; 3]> {
    let sites = partition.sites()?;
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for site in sites.iter().flatten() {
        for axis in 0..3 {
            low[axis] = low[axis].min(site.position[axis]);
            high[axis] = high[axis].max(site.position[axis]);
        }
    }
    Some([0, 1, 2].map(|axis| high[axis] - low[axis]))
}

/// M t summed over the rows of one direction: the mass of the component along the axis that has most of it; none without coordinates.
pub(super) fn total_mass(partition: &Partition) -> Option<f64> {
    let sites = partition.sites()?;
    let every: Vec<usize> = (0..sites.len()).collect();
    let motions = partition.rigid_motions(&every, [0.0; 3]).as_ref().subcols(0, 3).to_owned();
    let momenta: Mat<f64> = crate::sparse::product(&partition.mass, motions.as_ref());
    let masses = dense::dots(motions.as_ref(), momenta.as_ref());
    Some(masses.into_iter().fold(0.0, f64::max) * partition.scaling.mass_unit())
}
