//! The rigid directions in which a component is examined.

use faer::Mat;

use super::evidence::{Evidence, NAMES};
use crate::dense;
use crate::dofs::Direction;
use crate::model::{Frame, Site};
use crate::partition::Partition;
use crate::sparse::product;

/// Motions of the component as a whole, by name.
pub(super) struct Directions {
    /// `translation x`, `rotation z`, `rigid-body mode 2`.
    pub(super) names: Vec<String>,
    /// The motions, n' × k.
    pub(super) motions: Mat<f64>,
    /// uᵀMu of each.
    pub(super) masses: Vec<f64>,
    /// Whether each moves a dof that the job holds.
    pub(super) are_held: Vec<bool>,
}

/// Share of the largest modal mass below which a motion moves no mass, as a rotation about the line on which all mass lies.
const NOTHING: f64 = 1e-12;

impl Directions {
    /// The unit translations and the unit rotations about the middle of the mass, whether K lets them pass or not;
    /// without coordinates the rigid-body modes.
    pub(super) fn of(evidence: &Evidence<'_>) -> Self {
        match evidence.partition.sites() {
            Some(sites) => Self::unit_motions(evidence.partition, &sites),
            None => Self::rigid_body_modes(evidence),
        }
    }

    /// The motions that K lets pass: the unit motions where they are that, else the rigid-body modes by number.
    pub(super) fn free(evidence: &Evidence<'_>) -> Self {
        if evidence.rigid.is_classical { Self::of(evidence) } else { Self::rigid_body_modes(evidence) }
    }

    fn rigid_body_modes(evidence: &Evidence<'_>) -> Self {
        let motions = evidence.rigid.orthonormal.clone();
        let names = (1..=motions.ncols()).map(|mode| format!("rigid-body mode {mode}")).collect();
        let n = motions.ncols();
        Self { names, masses: vec![1.0; n], are_held: vec![false; n], motions }
    }

    fn unit_motions(partition: &Partition, sites: &[Option<Site>]) -> Self {
        let centre = middle_of_mass(partition, sites);
        let every: Vec<usize> = (0..sites.len()).collect();
        let motions = partition.rigid_motions(&every, centre);
        let momenta = product(&partition.mass, motions.as_ref());
        let of = |j: usize| dense::dot(dense::column(motions.as_ref(), j), dense::column(momenta.as_ref(), j));
        let masses: Vec<f64> = (0..6).map(of).collect();
        let largest = |range: std::ops::Range<usize>| masses[range].iter().copied().fold(0.0, f64::max);
        let of_kind = [largest(0..3), largest(3..6)];
        let moving: Vec<usize> = (0..6).filter(|j| masses[*j] > NOTHING * of_kind[j / 3]).collect();
        let are_held = partition.held.moved_by(centre, Frame::of(sites, &every).size);
        Self {
            are_held: moving.iter().map(|j| are_held[*j]).collect(),
            names: moving.iter().map(|j| NAMES[*j].to_owned()).collect(),
            motions: dense::columns(motions.as_ref(), &moving),
            masses: moving.iter().map(|j| masses[*j]).collect(),
        }
    }

    /// The unit motions; none without coordinates.
    pub(super) fn of_unit_motions(evidence: &Evidence<'_>) -> Option<Self> {
        let found = evidence.partition.sites().map(|sites| Self::unit_motions(evidence.partition, &sites))?;
        (found.count() > 0).then_some(found)
    }

    /// An acceleration along a unit motion in words: `acceleration along x`, `angular acceleration about z`.
    pub(super) fn acceleration(&self, direction: usize) -> String {
        let axis = self.names[direction].rsplit(' ').next().unwrap_or_default();
        if self.turns(direction) {
            format!("angular acceleration about {axis}")
        } else {
            format!("acceleration along {axis}")
        }
    }

    /// Whether a direction is a unit rotation.
    pub(super) fn turns(&self, direction: usize) -> bool {
        self.names[direction].starts_with("rotation")
    }

    pub(super) fn count(&self) -> usize {
        self.names.len()
    }
}

/// The mean position of the translations, weighted with the diagonal of M: near the centre of mass, which is close
/// enough for rotations that are examined one by one.
fn middle_of_mass(partition: &Partition, sites: &[Option<Site>]) -> [f64; 3] {
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    let at_node = sites.iter().enumerate().filter_map(|(row, site)| Some((row, (*site)?)));
    for (row, site) in at_node.filter(|(_, site)| site.direction <= Direction::Uz) {
        let weight = partition.mass.get(row, row).copied().unwrap_or(0.0);
        (0..3).for_each(|axis| sum[axis] += weight * site.position[axis]);
        total += weight;
    }
    if total > 0.0 { sum.map(|sum| sum / total) } else { [0.0; 3] }
}
