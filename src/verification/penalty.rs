//! Rows whose stiffness takes the digits that checks ask for: penalties that tie dofs to each other.
//!
//! ```text
//! u |x_i| (|K||x|)_i        what rounding of row i makes of the energy of a motion x of unit modal mass, u the precision of K
//! c_i                       how many times stiffer row i is than the softest row that it is coupled with, directly or over one stiff row
//! ```
//! What a penalty costs is not known from its size: one that holds a dof costs nothing, for nothing moves there, and one that ties two
//! moving dofs costs its size times ε, because its terms cancel. So the roundings of the motions are added up as they are and with
//! the stiffness of their neighbours in place of that of the stiff rows. Where the first is more than the accuracy asked for and
//! most of it is gone in the second, the stiff rows have taken the digits.

use faer::MatRef;

use super::evidence::Evidence;
use super::limits::{ENERGY_ASKED, FREQUENCY_ASKED};
use crate::dense;
use crate::dofs::Direction;
use crate::partition::{DofOrigin, Partition};
use crate::sparse::{Leading, diagonal, panels, product_and_terms};

/// How many times stiffer than a neighbour a row of a mesh is, at most: the corner of a solid has an eighth of the stiffness inside, and
/// elements next to each other grade by ten.
pub(crate) const LARGEST_OF_MESHES: f64 = 100.0;
/// Share of the roundings that the stiff rows have where they cost a digit.
const ONE_DIGIT: f64 = 10.0;

/// Rows that take digits from what they touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Penalties {
    /// How many.
    pub n_rows: usize,
    /// What the stiffest is called.
    pub stiffest: String,
    /// How many times stiffer it is than a row it is coupled with.
    pub ratio: f64,
    /// What roundings make of an energy, relative to that of the first elastic mode or to its own.
    pub noise: f64,
    /// What is asked for.
    pub asked: f64,
    /// What roundings would make of it if these rows were as stiff as their neighbours.
    pub noise_without: f64,
}

/// The motion that the stiff rows cost most.
struct Worst {
    /// Noise over what is asked for.
    excess: f64,
    noise: f64,
    asked: f64,
    noise_without: f64,
    /// Stiff rows with more than their share of the roundings.
    rows: Vec<usize>,
}

/// Stiff rows that cost the rigid-body motions or the modes digits that are asked for; `first` is the first elastic eigenvalue.
pub fn penalties(evidence: &Evidence<'_>, first: Option<f64>) -> Option<Penalties> {
    let (partition, retained) = (evidence.partition, evidence.retained);
    let n = partition.n_dofs();
    let mut contrast = contrasts(partition);
    // What rigid patches have taken up is no row of K any more: all of it together stands behind the rows.
    contrast.push(partition.cancellation);
    if contrast.iter().all(|ratio| *ratio < LARGEST_OF_MESHES) {
        return None;
    }
    let modes = &retained.modes;
    let first = first.filter(|first| *first > 0.0).or(modes.lambda.first().copied()).or(modes.next)?;
    let precision = f64::EPSILON.max(partition.precision.stiffness.relative);
    let mut worst: Option<Worst> = None;
    let mut look = |stiffness: Leading<'_>, x: MatRef<'_, f64>, scale: &dyn Fn(usize) -> f64, asked: f64| {
        for columns in panels(x.ncols()) {
            let panel = x.get(.., columns.clone());
            let (_, terms) = product_and_terms(stiffness, panel);
            let of_patches = partition.patch_terms(panel);
            for (at, j) in columns.enumerate() {
                let (x, terms) = (dense::column(panel, at), dense::column(terms.as_ref(), at));
                let mut cost: Vec<f64> = x.iter().zip(terms).map(|(x, t)| precision * x.abs() * t / scale(j)).collect();
                cost.resize(n, 0.0);
                cost.push(precision * of_patches[at] / scale(j));
                let found = of_motion(&cost, &contrast, asked);
                let is_worse = |found: &Worst| worst.as_ref().is_none_or(|worst| found.excess > worst.excess);
                if let Some(found) = found.filter(is_worse) {
                    worst = Some(found);
                }
            }
        }
    };
    look(partition.pencil().stiffness, evidence.rigid.massive(), &|_| first, ENERGY_ASKED);
    // Shapes of mixed boundaries have all rows.
    let whole = Leading::new(&partition.stiffness, modes.shapes.nrows());
    look(whole, modes.shapes.as_ref(), &|j| modes.lambda[j], FREQUENCY_ASKED);
    let Worst { noise, asked, noise_without, rows, .. } = worst?;
    let stiffness = diagonal(&partition.stiffness);
    let size = |row: usize| stiffness.get(row).copied().unwrap_or(f64::INFINITY);
    let stiffest = rows.iter().copied().max_by(|a, b| size(*a).total_cmp(&size(*b)))?;
    Some(Penalties {
        n_rows: rows.len(),
        stiffest: if stiffest < n { partition.name_of(stiffest) } else { taken_up(partition).to_owned() },
        ratio: contrast[stiffest],
        noise,
        asked,
        noise_without,
    })
}

/// What K has taken up whose rows are gone.
fn taken_up(partition: &Partition) -> &'static str {
    match partition.interface.iter().any(|node| node.coupling.is_patch()) {
        true => "nodes of a rigid patch",
        false => "dofs that constraints tie",
    }
}

/// What the stiff rows cost one motion, where that is a digit and more than is asked for.
fn of_motion(cost: &[f64], contrast: &[f64], asked: f64) -> Option<Worst> {
    let noise: f64 = cost.iter().sum();
    let is_stiff = |row: usize| contrast[row] >= LARGEST_OF_MESHES;
    let without = |(row, cost): (usize, &f64)| if is_stiff(row) { cost / contrast[row] } else { *cost };
    let noise_without: f64 = cost.iter().enumerate().map(without).sum();
    let is_costly = noise > asked && ONE_DIGIT * noise_without <= noise;
    let share = noise / cost.len() as f64;
    let rows = || (0..cost.len()).filter(|row| is_stiff(*row) && cost[*row] > share).collect();
    is_costly.then(|| Worst { excess: noise / asked, noise, asked, noise_without, rows: rows() })
}

/// How many times stiffer each row is than the softest one it is coupled with, directly or over a stiff row: a node that nothing but ties
/// hold, as a mass at the end of a rigid link, has none but stiff neighbours. Over more rows than one the stiff part of a structure of
/// two materials would be a tie.
fn contrasts(partition: &Partition) -> Vec<f64> {
    let contrast = Contrast::of(partition);
    let direct: Vec<f64> = (0..partition.n_dofs()).map(|row| contrast.over(row, |_| 1.0)).collect();
    let of_stiff = |row: usize| if direct[row] >= LARGEST_OF_MESHES { direct[row] } else { 1.0 };
    (0..partition.n_dofs()).map(|row| contrast.over(row, of_stiff)).collect()
}

/// Stiffness of rows compared with that of rows they are coupled with, by stiffness and by stiffness over mass: the second
/// alone takes a heavy neighbour for a soft one. Translations are compared with translations and rotations with rotations, as far as
/// that is known: a slender beam is far stiffer against stretching than against rotation of its ends.
struct Contrast<'a> {
    partition: &'a Partition,
    /// K_ii.
    stiffness: Vec<f64>,
    /// M_ii.
    mass: Vec<f64>,
}

impl<'a> Contrast<'a> {
    fn of(partition: &'a Partition) -> Self {
        Self { partition, stiffness: diagonal(&partition.stiffness), mass: diagonal(&partition.mass) }
    }

    /// How many times stiffer a row is than the softest that it is coupled with, times what that one is stiffer than others.
    fn over(&self, row: usize, beyond: impl Fn(usize) -> f64) -> f64 {
        let entries = self.partition.pencil().stiffness.entries(row);
        let is_coupled = |(other, value): &(usize, f64)| *other != row && *value != 0.0 && self.is_like(row, *other);
        let coupled = entries.filter(is_coupled);
        coupled.fold(1.0, |most: f64, (other, _)| most.max(self.ratio(row, other) * beyond(other)))
    }

    fn ratio(&self, row: usize, other: usize) -> f64 {
        let (k, m) = (&self.stiffness, &self.mass);
        let of_stiffness = k[row] / k[other];
        if m[row] > 0.0 && m[other] > 0.0 { of_stiffness.min(of_stiffness * m[other] / m[row]) } else { of_stiffness }
    }

    /// Whether both are translations or both rotations, as far as that is known, and the other one has stiffness.
    fn is_like(&self, row: usize, other: usize) -> bool {
        let kind = |row: usize| {
            let dof = &self.partition.dofs[row];
            if matches!(dof.origin, DofOrigin::Distortion(..)) {
                return Some(false);
            }
            let direction = dof.dof.map(|dof| dof.direction).or(dof.site.map(|site| site.direction));
            direction.map(Direction::is_rotation)
        };
        let (a, b) = (kind(row), kind(other));
        self.stiffness[other] > 0.0 && (a.is_none() || b.is_none() || a == b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stiff_rows_are_named_where_they_cost_a_digit_that_is_asked_for() {
        let contrast = [1.0, 1e4, 1e4, 50.0];
        let named = |cost: [f64; 4], asked: f64| of_motion(&cost, &contrast, asked).map(|worst| worst.rows);
        assert_eq!(named([1e-12, 1e-7, 2e-7, 1e-12], 1e-9), Some(vec![1, 2]));
        // Nothing that is asked for is lost; nothing moves at the stiff rows; a mesh is as stiff as that; others lose as much.
        assert_eq!(named([1e-12, 1e-10, 2e-10, 1e-12], 1e-9), None);
        assert_eq!(named([1e-7, 1e-30, 1e-30, 1e-7], 1e-9), None);
        assert_eq!(named([1e-12, 1e-12, 1e-12, 1e-7], 1e-9), None);
        assert_eq!(named([1e-7, 1e-7, 1e-7, 1e-12], 1e-9), None);
    }
}
