//! Lengths, mass and speed of a component, in the units of its files: what its system of units is guessed from.

use std::collections::BTreeMap;

use faer::Mat;

use crate::dense;
use crate::model::Site;
use crate::partition::Partition;
use crate::sparse::diagonal;

/// What is measured of a component.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub(super) mass: f64,
    /// That of all nodes but the heaviest tenth, which point masses are among.
    pub(super) light_mass: f64,
    pub(super) extents: [f64; 3],
    /// The typical distance of neighbours.
    pub(super) spacing: f64,
    /// The typical K_ii / M_ii of the translation of a node that is stiffest.
    pub(super) ratio: f64,
    /// What its nodes have.
    pub(super) nodes: NodeKind,
}

/// What the nodes of a component have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NodeKind {
    /// Translations alone, as those of solids, which lie on the surface of the component.
    Translations,
    /// Rotations as well, as those of beams and shells, which lie within it.
    Rotations,
}

impl Sizes {
    /// Measures a component; none without coordinates, or without mass.
    pub(super) fn of(partition: &Partition) -> Option<Self> {
        let sites = partition.sites()?;
        let has_rotations = sites.iter().flatten().any(|site| site.direction.is_rotation());
        let mass = total_mass(partition)?;
        Some(Self {
            mass,
            light_mass: mass * light_share(partition, &sites)?,
            extents: extents(partition)?,
            spacing: spacing(partition)?,
            ratio: stiffest_ratio(partition, &sites)?,
            nodes: if has_rotations { NodeKind::Rotations } else { NodeKind::Translations },
        })
    }
}

/// Whether some rows are of no node.
pub(super) fn has_rows_without_place(partition: &Partition) -> bool {
    partition.sites().is_some_and(|sites| sites.iter().any(Option::is_none))
}

/// The median over nodes of the largest K_ii / M_ii of their translations: members along it and not across it make it, where bending is
/// softer by orders.
fn stiffest_ratio(partition: &Partition, sites: &[Option<Site>]) -> Option<f64> {
    let (stiffness, mass) = (diagonal(&partition.stiffness), diagonal(&partition.mass));
    let ratios = largest_of_nodes(partition, sites, |row| (mass[row] > 0.0).then(|| stiffness[row] / mass[row]));
    Some(ratios.get(ratios.len() / 2)? * partition.scaling.eigenvalue_unit())
}

/// The share of the mass that is not at the heaviest tenth of the nodes, by M_ii of their translations. Where no node is a point mass it is
/// a third and more, which matters to no guess of a density.
fn light_share(partition: &Partition, sites: &[Option<Site>]) -> Option<f64> {
    let mass = diagonal(&partition.mass);
    let masses = largest_of_nodes(partition, sites, |row| Some(mass[row]));
    let (light, _) = masses.split_at(masses.len() - masses.len().div_ceil(10));
    let [light, all] = [light, &masses[..]].map(|masses| masses.iter().sum::<f64>());
    (all > 0.0).then(|| light / all)
}

/// The largest value of the translations of each node that have one, ascending.
fn largest_of_nodes(partition: &Partition, sites: &[Option<Site>], value: impl Fn(usize) -> Option<f64>) -> Vec<f64> {
    let mut of_node: BTreeMap<u32, f64> = BTreeMap::new();
    for (row, dof) in partition.dofs.iter().enumerate() {
        let is_translation = sites[row].is_some_and(|site| !site.direction.is_rotation());
        if let Some(value) = value(row).filter(|_| is_translation) {
            let largest = of_node.entry(dof.node).or_default();
            *largest = largest.max(value);
        }
    }
    let mut values: Vec<f64> = of_node.into_values().collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Typical distance of coupled nodes; none without coordinates.
fn spacing(partition: &Partition) -> Option<f64> {
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
fn total_mass(partition: &Partition) -> Option<f64> {
    let sites = partition.sites()?;
    let every: Vec<usize> = (0..sites.len()).collect();
    let motions = partition.rigid_motions(&every, [0.0; 3]).as_ref().subcols(0, 3).to_owned();
    let momenta: Mat<f64> = crate::sparse::product(&partition.mass, motions.as_ref());
    let masses = dense::dots(motions.as_ref(), momenta.as_ref());
    Some(masses.into_iter().fold(0.0, f64::max) * partition.scaling.mass_unit())
}
