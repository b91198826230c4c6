//! What rounding makes of the forces of motions without energy.
//!
//! ```text
//! I, J                    the displacements of a node, or its rotations
//! ε Σ_J max|K_IJ| |q|_J   of entries, at every dof of I; |q|_J sums the moduli at the dofs of J
//! ε |K| |x| |θ|           of coordinates; |x| is the distance of a node from the origin, θ the angle that a motion turns by
//! ```
//! Whoever writes K turns elements to the axes of the model three rows at a time, by cosines that are known to ε: an entry is off by ε of
//! the largest of its block. In a slender part that lies askew the block has the stiffness along the part, which is a million times that
//! across it. Elements are made of differences of coordinates, and each of these is known to ε|x|: the part turns about levers that are as
//! uncertain, which weighs more the farther it is from the origin and the thinner it is. All roundings count with one sign, so that the sum is
//! a bound and no factor is added to it.

use std::collections::BTreeMap;

use faer::{Mat, MatRef};

use super::energy::residuals;
use super::residual::{FORCE_ASKED, Residual};
use crate::dense;
use crate::partition::{DofOrigin, Partition, ReducedDof};
use crate::sparse::{Leading, absolute_product, product_and_terms};

/// Motions by coordinates: the dofs that they move, and by which angle each of them turns these.
pub(super) struct Turned<'a> {
    pub(super) dofs: &'a [usize],
    pub(super) angles: &'a dyn Fn() -> Vec<f64>,
}

/// The residual of motions that no coordinates are known of.
pub(crate) fn residual_of(partition: &Partition, q: MatRef<'_, f64>) -> Residual {
    let (forces, terms) = product_and_terms(&partition.stiffness, q);
    residual(partition, q, [forces.as_ref(), terms.as_ref()], None)
}

/// The residual of motions from their forces and the terms of these.
pub(super) fn residual(
    partition: &Partition,
    q: MatRef<'_, f64>,
    [forces, terms]: [MatRef<'_, f64>; 2],
    turned: Option<Turned<'_>>,
) -> Residual {
    let values = residuals(forces, terms);
    let pairs = |roundings: &[f64]| {
        let pairs =
            values.iter().zip(roundings).map(|(value, rounding)| Residual { value: *value, rounding: *rounding });
        pairs.fold(Residual::default(), Residual::and)
    };
    if values.iter().all(|value| *value <= FORCE_ASKED) {
        return pairs(&vec![0.0; values.len()]);
    }
    let mut explained = of_entries(partition, q);
    if let Some(turned) = turned {
        explained += of_coordinates(partition, &turned);
    }
    pairs(&residuals(explained.as_ref(), terms))
}

/// What rounding of the entries of K makes of the forces of motions.
fn of_entries(partition: &Partition, q: MatRef<'_, f64>) -> Mat<f64> {
    let blocks = blocks(partition);
    let n_blocks = blocks.iter().max().map_or(0, |last| last + 1);
    let mut moved = Mat::<f64>::zeros(n_blocks, q.ncols());
    let mut rows_of = vec![Vec::new(); n_blocks];
    for (dof, block) in blocks.iter().enumerate() {
        rows_of[*block].push(dof);
        (0..q.ncols()).for_each(|j| moved[(*block, j)] += q[(dof, j)].abs());
    }
    let stiffness = Leading::from(&partition.stiffness);
    let mut forces = Mat::<f64>::zeros(q.nrows(), q.ncols());
    let (mut largest, mut coupled) = (vec![0.0f64; n_blocks], Vec::new());
    for rows in &rows_of {
        for (col, value) in rows.iter().flat_map(|row| stiffness.entries(*row)) {
            let block = blocks[col];
            if largest[block] == 0.0 && value != 0.0 {
                coupled.push(block);
            }
            largest[block] = largest[block].max(value.abs());
        }
        for j in 0..q.ncols() {
            let force: f64 = coupled.iter().map(|block| largest[*block] * moved[(*block, j)]).sum();
            rows.iter().for_each(|row| forces[(*row, j)] = f64::EPSILON * force);
        }
        coupled.drain(..).for_each(|block| largest[block] = 0.0);
    }
    forces
}

/// The number of the block of each dof: one dof by itself where nothing tells what its node moves along.
fn blocks(partition: &Partition) -> Vec<usize> {
    const ALONE: u8 = 2;
    let key = |(number, dof): (usize, &ReducedDof)| {
        let direction = dof.site.map(|site| site.direction).or(dof.dof.map(|dof| dof.direction));
        match (dof.origin, direction) {
            (DofOrigin::Row(_) | DofOrigin::PatchNode(..), Some(direction)) => {
                (dof.node as usize, u8::from(direction.is_rotation()))
            }
            _ => (number, ALONE),
        }
    };
    let mut numbers = BTreeMap::new();
    let keys = partition.dofs.iter().enumerate().map(key);
    keys.map(|key| {
        let next = numbers.len();
        *numbers.entry(key).or_insert(next)
    })
    .collect()
}

/// What rounding of coordinates makes of them.
fn of_coordinates(partition: &Partition, turned: &Turned<'_>) -> Mat<f64> {
    let angles = (turned.angles)();
    let mut off = Mat::<f64>::zeros(partition.n_dofs(), angles.len());
    for dof in turned.dofs {
        let Some(site) = partition.dofs[*dof].site.filter(|site| !site.direction.is_rotation()) else { continue };
        let lever = f64::EPSILON * dense::norm(&site.position);
        angles.iter().enumerate().for_each(|(j, angle)| off[(*dof, j)] = lever * angle);
    }
    absolute_product(&partition.stiffness, off.as_ref())
}
