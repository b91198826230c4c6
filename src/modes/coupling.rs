//! What each mode contributes at the interface, to outputs inside and under loads, and which modes nothing excites and nothing observes.
//!
//! ```text
//! x, xᵀMx = 1, xᵀKx = λ                       a mode, n'
//! free interface dof i        K_ii x_i² / λ          its displacement
//! held interface dof i        r_i² / (K_ii λ)        its reaction, r = (K − λM) x
//! output o = tᵀu              (tᵀx)² / (λ Σ t_k² / K_kk)
//! load f                      (fᵀx)² / (λ Σ f_k² / K_kk)
//! c                           the root of the sum over the interface, of that over outputs, or of a load: the largest
//! ```
//! Each term compares what the mode does at a place with what the stiffness of that dof does alone, so that displacements, rotations, forces
//! and loads count alike. Where c is zero the mode is an eigenvector of the component however its interface is held, loaded or joined:
//! (K − λM) x = 0 in every row, with x zero at all that acts on it. Nothing starts it and nothing sees it, acceleration of the whole
//! included: λ xᵀMU = xᵀKU, which is a reaction of the interface.
//!
//! # What rounding makes of zero
//! A computed mode has of a neighbour at distance g what rounding and its residual mix in, θ = φ/g + √(ρλ/g), where φ moves the eigenvalue by
//! rounding and ρλ is what the residual leaves in doubt, the square of it over g. So a coupling up to 100 θ times the largest of all modes is
//! zero as far as arithmetic tells. Where that is more than 10⁻⁶ of the largest, arithmetic does not tell, and the mode counts as seen. Modes of
//! one cluster share a space in which any basis is one of modes: they are seen together or not at all.

use std::ops::Range;

use faer::{Mat, MatRef};

use crate::dense;
use crate::eigen::{ModeError, Modes, are_clustered};
use crate::job::Boundary;
use crate::partition::Partition;
use crate::sparse::{diagonal, product};

/// How far roundings may exceed their estimate.
const ROUNDINGS: f64 = 100.0;
/// Share of the largest coupling up to which one may be called rounding. What a mode does to the rest goes with the square of it, 10⁻¹².
pub const MAX_UNSEEN_COUPLING: f64 = 1e-6;
/// Backward error beyond which a mode is not known well enough to be called unseen.
const SETTLED: f64 = 1e-10;

/// What a mode contributes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// c.
    pub size: f64,
    /// That of its cluster, the root of the sum of squares, over the largest of all modes.
    pub share: f64,
    /// Up to which c is rounding.
    pub rounding: f64,
    /// Whether interface, outputs or loads see the mode.
    pub is_seen: bool,
}

/// The couplings of modes with shapes on n' or, of the held interface, n_I dofs; `gravity` is the one direction in which it acts, zero where it
/// acts in none.
pub(crate) fn couplings(
    partition: &Partition,
    (modes, boundary): (&Modes, Boundary),
    gravity: Option<[f64; 3]>,
) -> Vec<Coupling> {
    let shapes = whole(partition, modes.shapes.as_ref());
    let stiffness: Vec<f64> = diagonal(&partition.stiffness).into_iter().map(f64::abs).collect();
    let mut largest = at_interface(partition, (modes, shapes.as_ref(), boundary), &stiffness);
    let at_outputs = at_outputs(partition, shapes.as_ref(), &stiffness);
    let under_loads = under_loads(partition, shapes.as_ref(), (&stiffness, gravity));
    for (j, largest) in largest.iter_mut().enumerate() {
        for square in [at_outputs[j], under_loads[j]] {
            if dense::worse(square, *largest) {
                *largest = square;
            }
        }
    }
    let sizes: Vec<f64> = largest.iter().zip(&modes.lambda).map(|(square, lambda)| (square / lambda).sqrt()).collect();
    judged(modes, &sizes)
}

/// The shapes on all dofs.
fn whole(partition: &Partition, shapes: MatRef<'_, f64>) -> Mat<f64> {
    let n = shapes.nrows();
    Mat::from_fn(partition.n_dofs(), shapes.ncols(), |i, j| if i < n { shapes[(i, j)] } else { 0.0 })
}

/// λc² at the interface.
fn at_interface(
    partition: &Partition,
    (modes, shapes, boundary): (&Modes, MatRef<'_, f64>, Boundary),
    stiffness: &[f64],
) -> Vec<f64> {
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let held = partition.held_under(boundary);
    let images = held.contains(&true).then(|| [&partition.stiffness, &partition.mass].map(|a| product(a, shapes)));
    let of_mode = |j: usize| {
        let of_dof = |i: usize| {
            let row = n_i + i;
            match &images {
                Some([force, momentum]) if held[i] => {
                    share((force[(row, j)] - modes.lambda[j] * momentum[(row, j)]).powi(2), stiffness[row])
                }
                _ => stiffness[row] * shapes[(row, j)].powi(2),
            }
        };
        (0..n_b).map(of_dof).sum()
    };
    (0..shapes.ncols()).map(of_mode).collect()
}

/// λc² at the outputs.
fn at_outputs(partition: &Partition, shapes: MatRef<'_, f64>, stiffness: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; shapes.ncols()];
    for output in &partition.outputs {
        let entries: Vec<(u32, f64)> = partition.transformation.rows[output.row].entries().collect();
        let flexibility: f64 = entries.iter().map(|(k, t)| share(t * t, stiffness[*k as usize])).sum();
        for (j, sum) in sums.iter_mut().enumerate() {
            let moved: f64 = entries.iter().map(|(k, t)| t * shapes[(*k as usize, j)]).sum();
            *sum += share(moved * moved, flexibility);
        }
    }
    sums
}

/// The largest λc² of a load, gravity on a component that is held among them.
fn under_loads(
    partition: &Partition,
    shapes: MatRef<'_, f64>,
    (stiffness, direction): (&[f64], Option<[f64; 3]>),
) -> Vec<f64> {
    let mut largest = vec![0.0; shapes.ncols()];
    let mut take = |load: &[f64]| {
        let flexibility: f64 = load.iter().zip(stiffness).map(|(f, k)| share(f * f, *k)).sum();
        for (j, largest) in largest.iter_mut().enumerate() {
            let square = share(dense::dot(load, dense::column(shapes, j)).powi(2), flexibility);
            if dense::worse(square, *largest) {
                *largest = square;
            }
        }
    };
    let loads = partition.loads.vectors.as_ref();
    (0..loads.ncols()).for_each(|load| take(dense::column(loads, load)));
    if let Some(gravity) = &partition.gravity {
        let axes = gravity.loads.as_ref();
        match direction {
            None => (0..axes.ncols()).for_each(|axis| take(dense::column(axes, axis))),
            Some(along) => {
                let load: Vec<f64> =
                    (0..axes.nrows()).map(|i| (0..3).map(|axis| along[axis] * axes[(i, axis)]).sum()).collect();
                take(&load);
            }
        }
    }
    largest
}

/// a/b, zero of nothing.
fn share(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / b }
}

/// Which couplings are rounding, cluster by cluster.
fn judged(modes: &Modes, sizes: &[f64]) -> Vec<Coupling> {
    let Modes { lambda, errors, next, .. } = modes;
    let largest = dense::worst(sizes.iter().copied());
    let mut couplings = Vec::with_capacity(sizes.len());
    for Range { start: first, end } in clusters(lambda) {
        let below = if first == 0 { lambda[0] } else { lambda[first] - lambda[first - 1] };
        let above = lambda.get(end).copied().or(*next).map_or(f64::INFINITY, |above| above - lambda[end - 1]);
        let gap = below.min(above);
        let mixed_in = |(error, lambda): (&ModeError, &f64)| {
            error.rounding_floor / gap + (error.residual_bar * lambda / gap).sqrt()
        };
        let cluster = errors[first..end].iter().zip(&lambda[first..end]);
        let rounding = ROUNDINGS * dense::worst(cluster.map(mixed_in)) * largest;
        let size = sizes[first..end].iter().map(|size| size * size).sum::<f64>().sqrt();
        // Where nothing acts and nothing looks, or a dof has no stiffness of its own, there is nothing to compare with.
        let is_known = (gap > 0.0 && largest > 0.0 && largest.is_finite() && rounding <= MAX_UNSEEN_COUPLING * largest)
            && errors[first..end].iter().all(|error| error.backward <= SETTLED);
        let is_seen = !(is_known && size <= rounding);
        let of_largest = |size: f64| if largest > 0.0 { size / largest } else { f64::INFINITY };
        let share = of_largest(size);
        couplings.extend(sizes[first..end].iter().map(|size| Coupling { size: *size, share, rounding, is_seen }));
    }
    couplings
}

/// Runs of eigenvalues that are one cluster.
pub(crate) fn clusters(lambda: &[f64]) -> Vec<Range<usize>> {
    let mut clusters = Vec::new();
    let mut first = 0;
    for end in 1..=lambda.len() {
        if end == lambda.len() || !are_clustered(lambda[end - 1], lambda[end]) {
            clusters.push(first..end);
            first = end;
        }
    }
    clusters
}
