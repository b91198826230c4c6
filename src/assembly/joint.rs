//! Which node of one interface is joined with which of another, and whether the two may be.

use supel_runtime::Direction;

use super::absence::{Absence, absence};
use super::component::{Component, distance};
use super::place::Place;
use crate::error::{Error, Result};

/// How far nodes that are joined may be from each other, relative to the smaller of the two components.
const SAME_PLACE: f64 = 1e-6;
/// Rounding of a coordinate in single precision, which some meshes have.
const SINGLE_PRECISION: f64 = 1.2e-7;
/// How far entries of two frames may differ: rotations from seven printed digits are one.
const SAME_FRAME: f64 = 1e-6;

/// Two places that become one.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    pub(super) a: Place,
    pub(super) b: Place,
    /// Pairs of coordinates.
    pub(super) dofs: Vec<[usize; 2]>,
    /// Directions of each of the two, with their coordinates, in which the other one is at rest.
    pub(super) at_rest: [Vec<(Direction, usize)>; 2],
    /// How far the two are from each other, where they have positions.
    pub(super) distance: Option<f64>,
}

/// The pairs of two interfaces: of one node each, of nodes at the same places, of rows in their order.
///
/// # Errors
/// [`Error::JoinUnits`], [`Error::JoinNodes`], [`Error::JoinPosition`], [`Error::JoinDofs`].
pub(super) fn pairs(components: &[Component], (a, b): (&[Place], &[Place]), names: (&str, &str)) -> Result<Vec<Pair>> {
    let [of_a, of_b] = [a, b].map(|places| &components[places[0].component]);
    same_units(of_a, of_b)?;
    let count =
        |text: &str, places: &[Place]| format!("{text} ({})", crate::number::counted(places.len(), "node", "nodes"));
    let unmatched = |node: String| Error::JoinNodes { a: count(names.0, a), b: count(names.1, b), node };
    if a.len() != b.len() {
        return Err(unmatched("each of them".to_owned()));
    }
    let tolerance = tolerance((of_a, of_b), (a, b));
    let mut left: Vec<&Place> = b.iter().collect();
    let mut pairs = Vec::new();
    for node in a {
        let apart = |other: &Place| Some(distance(node.position.as_ref()?, other.position.as_ref()?));
        let nearest = match node.position {
            Some(_) => (0..left.len()).min_by(|i, j| {
                let [i, j] = [i, j].map(|at| apart(left[*at]).unwrap_or(f64::INFINITY));
                i.total_cmp(&j)
            }),
            // Rows are joined in the order in which they are named.
            None => (!left.is_empty()).then_some(0),
        };
        let Some(nearest) = nearest else { return Err(unmatched(node.name.clone())) };
        let partner = left.remove(nearest);
        if partner.position.is_some() != node.position.is_some() {
            return Err(Error::JoinDofs {
                a: node.name.clone(),
                b: partner.name.clone(),
                dofs: [node, partner].map(Place::directions),
            });
        }
        let distance = apart(partner);
        if let Some(distance) = distance.filter(|distance| *distance > tolerance) {
            if a.len() > 1 {
                return Err(unmatched(node.name.clone()));
            }
            return Err(Error::JoinPosition { a: node.name.clone(), b: partner.name.clone(), distance, tolerance });
        }
        let dofs = common_dofs(node, partner)?;
        let at_rest = [(node, partner), (partner, node)].map(|(of, with)| at_rest(components, of, with));
        pairs.push(Pair { a: node.clone(), b: partner.clone(), dofs, at_rest, distance });
    }
    Ok(pairs)
}

fn same_units(a: &Component, b: &Component) -> Result<()> {
    let units = |component: &Component| component.superelement.metadata().units.clone();
    match (units(a), units(b)) {
        (Some(of_a), Some(of_b)) if of_a != of_b => {
            Err(Error::JoinUnits { a: a.name.clone(), b: b.name.clone(), units: [of_a, of_b] })
        }
        _ => Ok(()),
    }
}

/// A millionth of the smaller component, and what single precision makes of coordinates far from their origin.
fn tolerance((a, b): (&Component, &Component), places: (&[Place], &[Place])) -> f64 {
    let sizes = [a, b].map(Component::size).into_iter().filter(|size| *size > 0.0);
    let positions = places.0.iter().chain(places.1).filter_map(|place| place.position);
    let farthest = positions.flatten().fold(0.0, |most: f64, coordinate| most.max(coordinate.abs()));
    SAME_PLACE * sizes.reduce(f64::min).unwrap_or(0.0) + SINGLE_PRECISION * farthest
}

/// The coordinates of the directions that both have.
fn common_dofs(a: &Place, b: &Place) -> Result<Vec<[usize; 2]>> {
    let common = a.dofs.iter().filter_map(|(direction, of_a)| Some([*of_a, b.coordinate(*direction)?]));
    let common: Vec<[usize; 2]> = common.collect();
    if common.is_empty() {
        let dofs = [a, b].map(Place::directions);
        return Err(Error::JoinDofs { a: a.name.clone(), b: b.name.clone(), dofs });
    }
    Ok(common)
}

/// The directions of a node in which the node that it is joined with is at rest, with their coordinates.
fn at_rest(components: &[Component], of: &Place, with: &Place) -> Vec<(Direction, usize)> {
    let Some(node) = with.whole else { return Vec::new() };
    let is_at_rest = |direction: Direction| {
        let is_absent = with.coordinate(Some(direction)).is_none();
        is_absent && absence(&components[with.component].superelement, node, direction) == Absence::AtRest
    };
    let own = of.dofs.iter().filter_map(|(direction, at)| Some(((*direction)?, *at)));
    own.filter(|(direction, _)| is_at_rest(*direction)).collect()
}

/// By how many degrees the axes of two nodes are turned against each other; none where they are the same or nobody knows them.
pub(super) fn turned(a: &Place, b: &Place) -> Option<f64> {
    let (of_a, of_b) = a.frame.zip(b.frame)?;
    let difference = of_a.as_flattened().iter().zip(of_b.as_flattened()).map(|(a, b)| (a - b).abs());
    (difference.fold(0.0, f64::max) > SAME_FRAME).then(|| angle(&of_a, &of_b))
}

/// By how many degrees one frame is turned against another: 1 + 2 cos φ is the trace of AᵀB.
fn angle(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> f64 {
    let trace: f64 = a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| a * b).sum();
    (0.5 * (trace - 1.0)).clamp(-1.0, 1.0).acos().to_degrees()
}
